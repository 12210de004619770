"""A study as Slurm jobs: an array of array.sbatch for each number of ranks, and a job that collects."""

import os
import re
import shlex
import shutil
import subprocess

from ...core import environment
from ...core.errors import Unusable, counted, short

TASK = os.path.join(os.path.dirname(os.path.abspath(__file__)), "array.sbatch")  # of the array


class SubmitError(Unusable):
    """sbatch is missing or rejects the job; the message is its own."""


def ranges(numbers):
    """Returns sorted numbers in the form of sbatch's --array: 1-3,7."""
    parts = []
    for number in numbers:
        if parts and number == parts[-1][1] + 1:
            parts[-1][1] = number
        else:
            parts.append([number, number])
    return ",".join(str(low) if low == high else f"{low}-{high}" for low, high in parts)


def _sbatch(words):
    """Submits a job and returns its number."""
    if not shutil.which("sbatch"):
        raise SubmitError("--slurm: sbatch not found on PATH")
    try:
        done = subprocess.run(
            ["sbatch", "--parsable", *words],
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            errors="replace",
            check=False,
        )
    except OSError as error:
        raise SubmitError(f"sbatch: cannot be executed: {error.strerror}") from error
    if done.returncode:
        raise SubmitError(
            "sbatch: {}".format(" ".join((done.stderr or done.stdout).split()) or f"exit code {done.returncode}")
        )
    job = done.stdout.strip().split(";")[0]  # number;cluster
    if not re.fullmatch(r"[0-9]+", job):
        raise SubmitError(f"sbatch: printed {short(job) or 'nothing'} instead of a job number")
    return job


def _study_words(study):
    """Returns petsam-study's arguments for each job."""
    words = [os.path.abspath(study.table), "--directory", study.directory, "--ranks", str(study.ranks)]
    if study.checkpoint:
        words += ["--checkpoint", str(study.checkpoint)]
    turns, period, numbers = study.figures
    if turns:
        words += ["--turns", turns]
    if period:
        words += ["--period=" + ",".join(repr(value) for value in period if value is not None)]
    if numbers:
        words += ["--cycle=" + ",".join(map(str, numbers))]
    return words


def submit(study, cases, waiting, sbatch=""):
    """Submits the waiting cases of Jobs, at most its cores of ranks at once, and a job that writes the tables at the
    end; sbatch has more words for sbatch."""
    words, extra = _study_words(study), environment.split(sbatch, "--sbatch")
    program = environment.script("petsam-study")
    common = ["--", *study.words] if study.words else []
    log = "--output=" + os.path.join(study.directory, "slurm-%A_%a.out")
    jobs = []
    for ranks in sorted({case.ranks for case in waiting}):
        numbers = [case.number for case in waiting if case.ranks == ranks]
        limit = f"%{max(1, study.cores // ranks)}" if study.cores else ""
        job = _sbatch(
            [
                "--array=" + ranges(numbers) + limit,
                f"--ntasks={ranks}",
                "--chdir=" + os.getcwd(),
                log,
                f"--export=ALL,PETSAM_STUDY={program}",
                *extra,
                TASK,
                *words,
                *common,
            ]
        )
        print(f"job {job}: {counted(len(numbers), 'case')} of {counted(ranks, 'rank')}")
        jobs.append(job)
    if not jobs:
        print(f"no case to submit: none of {len(cases)} is left to run")
        return 0
    collect = shlex.join([str(program), *words, "--collect", *common])
    job = _sbatch(
        [
            "--dependency=afterany:" + ":".join(jobs),
            "--ntasks=1",
            "--chdir=" + os.getcwd(),
            "--output=" + os.path.join(study.directory, "slurm-%j.out"),
            *extra,
            "--wrap",
            collect,
        ]
    )
    print("job {}: writes {} after the others".format(job, os.path.join(study.directory, "results.csv")))
    return 0

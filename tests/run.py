#!/usr/bin/env python3
"""Runs all tests and ends with a line `N passed, N failed`.

Unit tests (CMocka programs in build/tests) run on 1 and 3 ranks; then pytest runs the whole-program tests in
tests/program. The output of failing tests and the slowest of both kinds are printed. Arguments choose tests by a
part of their name. Time limits grow with the load of the machine.

    python3 tests/run.py [--build build] [--ranks 1,3] [--units-only] [--slow] [--measure] [name ...]

With --slow it runs what it leaves out otherwise: units on 2 ranks, LONG ones on 3 too, tests marked as slow, which are
those with the mark in their file and those listed in tests/program/slow.txt. --measure runs all whole-program tests,
and writes this list anew.
"""

import argparse
import os
import re
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
TIMEOUT = 300  # seconds for one unit test program on an idle machine
SLOWEST = 30  # unit tests to print
# unit tests that run on the first number of ranks only
LONG = {"test_life", "test_embed_program", "test_lengths", "test_stepcache", "test_states"}
WORKERS = 4  # most files of whole-program tests at a time; runs on several ranks share the cores


def limit(seconds):
    """A time limit for this machine as loaded now, from that of an idle one."""
    return seconds * min(max(1.0, os.getloadavg()[0] / (os.cpu_count() or 1)), 20.0)


def environment():
    """Open MPI refuses to run as root, as a container does, unless told twice; threads of BLAS only disturb."""
    env = dict(os.environ, OMP_NUM_THREADS="1", CMOCKA_MESSAGE_OUTPUT="STDOUT")
    if os.geteuid() == 0:
        env.update(OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
    return env


def mpirun(ranks, timeout=None):
    """The launcher's words for that many ranks, on a machine with fewer cores as well; a time limit in s."""
    words = os.environ.get("MPIRUN", "mpirun").split()
    version = subprocess.run(words + ["--version"], capture_output=True, text=True, env=environment()).stdout
    if "Open MPI" in version:
        words += ["--oversubscribe"] + (["--timeout", str(int(timeout))] if timeout else [])
    return words + ["-n", str(ranks)]


def run_unit(program, launcher, folder):
    """Passed and failed tests of one program, run in a folder; its output when something failed."""
    seconds = limit(TIMEOUT)
    # ranks that wait yield their core: several runs share the cores; one rank alone needs no daemon of Open MPI
    env = dict(environment(), MPIEXEC_TIMEOUT=str(int(seconds)), OMPI_MCA_mpi_yield_when_idle="1")
    env.update(OMPI_MCA_hwloc_base_binding_policy="none")
    if not launcher:  # such programs would share a folder of Open MPI, which the first to end removes
        env.update(OMPI_MCA_ess_singleton_isolated="1", OMPI_MCA_orte_tmpdir_base=str(folder))
    try:
        done = subprocess.run(
            launcher + [str(program)], capture_output=True, text=True, env=env, timeout=seconds + 30, cwd=folder
        )
        out, code = done.stdout + done.stderr, done.returncode
    except subprocess.TimeoutExpired as error:
        out, code = f"no end after {error.timeout} s", 1
    passed = len(re.findall(r"^\[ +OK +\]", out, re.M))
    failed = len(set(re.findall(r"^\[ +FAILED +\] (\S+)", out, re.M)) - {"tests:"})
    if code and not failed:
        failed = 1
    if not code and not passed:
        failed, out = 1, out + "\nno test ran"
    return passed, failed, out if failed else ""


def take_core(cores):
    """The calling thread and its programs stay on one of these, where ranks yield to each other and none spins."""
    if cores:
        os.sched_setaffinity(0, {cores.pop()})


def run_units(programs, ranks):
    """As many programs at a time as there are cores, each in a folder of its own, on the ranks(its name) in turn."""
    launchers = {n: mpirun(n) if n > 1 else [] for n in {n for program in programs for n in ranks(program.name)}}
    cores = list(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else []
    times = []

    def run(program):
        passed = failed = 0
        for n in ranks(program.name):
            start, launcher = time.time(), launchers[n]
            with tempfile.TemporaryDirectory(prefix=f"{program.name}-") as folder:
                p, f, out = run_unit(program, launcher, folder)
            passed, failed = passed + p, failed + f
            times.append((time.time() - start, f"{program.name} on {n}"))
            said = f"{times[-1][1]}: {p} passed, {f} failed ({times[-1][0]:.1f} s)"
            print(said + ("\n" + out if out else ""), flush=True)
        return passed, failed

    with ThreadPoolExecutor(min(len(cores) or os.cpu_count() or 1, WORKERS), "", take_core, (cores,)) as pool:
        counts = list(pool.map(run, programs))
    print(f"slowest {SLOWEST} unit tests (ranks)")
    for seconds, name in sorted(times, reverse=True)[:SLOWEST]:
        print(f"{seconds:8.1f} s  {name}")
    return sum(p for p, _ in counts), sum(f for _, f in counts)


def run_pytest(build, names, slow, measure):
    python = build / "venv" / "bin" / "python"
    words = [str(python), "-m", "pytest", "-q", "-rs", "-p", "no:cacheprovider"]
    words += [str(ROOT / "tests" / "program")]
    if names:
        words += ["-k", " or ".join(names)]
    else:
        words += [] if measure else ["-m", "slow" if slow else "not slow"]
        words += ["-n", str(min(os.cpu_count() or 1, WORKERS)), "--dist", "loadfile"]
    done = subprocess.run(
        words,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        env=dict(environment(), PETSAM_BUILD=str(build), **({"PETSAM_MEASURE": "1"} if measure else {})),
    )
    print(done.stdout, flush=True)
    counts = {word: int(n) for n, word in re.findall(r"(\d+) (passed|failed|error)", done.stdout.splitlines()[-1])}
    failed = counts.get("failed", 0) + counts.get("error", 0)
    if done.returncode not in (0, 5) and not failed:
        failed = 1
    return counts.get("passed", 0), failed


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--build", default="build")
    parser.add_argument("--ranks", default="1,3")
    parser.add_argument("--units-only", action="store_true")
    parser.add_argument("--slow", action="store_true")
    parser.add_argument("--measure", action="store_true")
    parser.add_argument("names", nargs="*")
    args = parser.parse_args()
    build = (ROOT / args.build).resolve()
    programs = [p for p in sorted((build / "tests").glob("test_*")) if os.access(p, os.X_OK) and p.is_file()]
    programs = [p for p in programs if not args.names or any(n in p.name for n in args.names)]

    def ranks(name):
        if args.slow:
            return [2, 3] if name in LONG else [2]
        chosen = [int(n) for n in args.ranks.split(",")]
        return chosen[:1] if name in LONG and not args.names else chosen

    passed, failed = run_units(programs, ranks)
    if not args.units_only:
        p, f = run_pytest(build, args.names, args.slow, args.measure)
        passed, failed = passed + p, failed + f
    print(f"{passed} passed, {failed} failed")
    return 1 if failed or not passed else 0


if __name__ == "__main__":
    sys.exit(main())

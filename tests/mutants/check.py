#!/usr/bin/env python3
"""Change a line that guards correctness, and see whether the tests that should notice do.

    make check-mutants                       all of tests/mutants/*.txt
    tests/mutants/check.py verdict contact     those whose file, text or tests have one of these words

Each mutant is built in a copy of the sources and run against the unit tests, or program tests, that its entry names.
One that passes has survived: a line that nothing guards. Survivors, and entries that no longer fit the sources, are
listed, and the command ends with 1.

An entry of a list, entries being separated by empty lines, # beginning a comment line:

    src/contact/check/verdict.c              the file
    - check->cone <= limits->cone            the text to be changed, which must stand there once
    + check->cone >= 0                       what it becomes (lines of several - and + are one text)
    ! test_verdict                           the tests: a unit test program, `test_x@2` on that many ranks, or
                                             `test_x.py::test_name` of tests/program; of the table of refusals
                                             `test_refusals.py::test_name~WORD`: rows that contain WORD
"""

import argparse
import os
import queue
import shutil
import subprocess
import sys
import threading
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests"))
from run import environment, mpirun  # noqa: E402

LISTS = Path(__file__).resolve().parent
TIMEOUT = 300  # seconds for one test; a mutant that hangs is caught
COPIED = (
    "Makefile",
    "README.md",
    "LICENSE",
    "CITATION.cff",
    "CHANGES.md",
    "src",
    "include",
    "tests",
    "scripts",
    "examples",
)
OPT = "-O1"  # builds are most of the time


class Mutant(NamedTuple):
    where: str  # list and line of the entry
    file: str
    old: str
    new: str
    tests: tuple


def read_list(path):
    """The entries of a list."""
    entries, block = [], []
    for number, line in enumerate(path.read_text().splitlines() + [""], 1):
        if line.startswith("#"):
            continue
        if line.strip():
            block.append((number, line))
        elif block:
            entries.append(parse(path, block))
            block = []
    return entries


def parse(path, block):
    """One entry from its numbered lines."""
    where = f"{path.name}:{block[0][0]}"
    parts = {mark: [line[2:] for _, line in block[1:] if line[0] == mark] for mark in "-+!"}
    if len(block) != 1 + sum(len(lines) for lines in parts.values()) or not parts["-"] or not parts["!"]:
        sys.exit(f"mutants: {where}: expected a file, then lines that begin with -, + and !")
    tests = tuple(word for line in parts["!"] for word in line.split())
    return Mutant(where, block[0][1].strip(), "\n".join(parts["-"]), "\n".join(parts["+"]), tests)


def misfits(mutants):
    """Entries whose text does not stand once in its file, or that name a test which does not exist."""
    found = []
    for mutant in mutants:
        path = ROOT / mutant.file
        count = path.read_text().count(mutant.old) if path.exists() else 0
        if count != 1:
            found.append(f"{mutant.where} {mutant.file}: the text stands there {count} times")
        for test in mutant.tests:
            file, _, name = test.partition("::")
            name, _, word = name.partition("~")
            path = ROOT / "tests" / (f"program/{file}" if ".py" in test else f"unit/{file.split('@')[0]}.c")
            if not path.exists() or (name and f"def {name.split('[')[0]}(" not in path.read_text()):
                found.append(f"{mutant.where}: there is no {test}")
            if word and word not in (ROOT / "tests/program/refusals.txt").read_text():
                found.append(f"{mutant.where}: no refusal has {word}")
    return found


def make_tree(folder):
    """A copy of the sources in which mutants are built; what has been built there before is kept."""
    folder.mkdir(parents=True, exist_ok=True)
    for name in COPIED:
        copy_changed(ROOT / name, folder / name)
        for path in (folder / name).rglob("*"):
            if path.is_file() and not (ROOT / path.relative_to(folder)).exists():
                path.unlink()  # moved, or gone
    return folder


def copy_changed(source, target):
    """Copies what differs, so that what was built from the rest stays up to date."""
    files = [source] if source.is_file() else [path for path in source.rglob("*") if path.is_file()]
    for path in files:
        to = target if source.is_file() else target / path.relative_to(source)
        if "__pycache__" in path.parts or (to.exists() and to.read_bytes() == path.read_bytes()):
            continue
        to.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(path, to)


def build(tree, targets):
    """make; its complaint, or an empty text."""
    words = ["make", "-s", "OPT=" + OPT, *targets]
    done = subprocess.run(words, cwd=tree, capture_output=True, text=True)
    return "" if done.returncode == 0 else (done.stdout + done.stderr).strip()


def targets_of(tests):
    """What make must build for these tests."""
    units = {"build/tests/" + test.split("@")[0] for test in tests if ".py" not in test}
    return sorted(units | ({"all"} if any(".py" in test for test in tests) else set()))


def command_of(tree, test):
    """The words that run a test."""
    if ".py" in test:
        python = ROOT / "build" / "venv" / "bin" / "python"
        return [
            str(python),
            "-m",
            "pytest",
            "-q",
            "-x",
            "-p",
            "no:cacheprovider",
            str(tree / "tests" / "program" / test.partition("~")[0]),
        ]
    name, _, ranks = test.partition("@")
    program = [str(tree / "build" / "tests" / name)]
    return mpirun(int(ranks), TIMEOUT) + program if ranks else program


def passes(tree, test):
    """Whether a test does not notice."""
    build = str(tree / "build")
    variables = dict(environment(), PETSAM_BUILD=build, OMPI_MCA_ess_singleton_isolated="1")
    variables["PETSAM_ROWS"] = test.partition("~")[2]
    variables["OMPI_MCA_orte_tmpdir_base"] = build  # else such programs share a folder, which the first to end removes
    try:
        done = subprocess.run(
            command_of(tree, test), cwd=tree, env=variables, capture_output=True, timeout=TIMEOUT + 30
        )
    except subprocess.TimeoutExpired:
        return False
    return done.returncode == 0


def try_mutant(tree, mutant):
    """What became of a mutant: caught, SURVIVED, or why it could not be tried."""
    path = tree / mutant.file
    text = path.read_text()
    path.write_text(text.replace(mutant.old, mutant.new))
    try:
        complaint = build(tree, targets_of(mutant.tests))
        if complaint:
            return "DOES NOT BUILD: " + complaint.splitlines()[-1]
        return "SURVIVED" if all(passes(tree, test) for test in mutant.tests) else "caught"
    finally:
        path.write_text(text)


def work(tree, waiting, report):
    """Tries mutants until none is left."""
    while True:
        try:
            mutant = waiting.get_nowait()
        except queue.Empty:
            return
        report(mutant, try_mutant(tree, mutant))


def check_originals(trees, mutants):
    """The tests must pass without a change: each of them in one of the trees, which are equal."""
    tests = sorted({test for mutant in mutants for test in mutant.tests})
    for tree in trees:
        complaint = build(tree, ["-j2", *targets_of(tests)])
        if complaint:
            sys.exit("mutants: the sources do not build:\n" + complaint)
    with ThreadPoolExecutor(len(trees)) as pool:
        shares = [tests[k :: len(trees)] for k in range(len(trees))]
        failed = list(pool.map(lambda tree, share: [t for t in share if not passes(tree, t)], trees, shares))
    failed = [test for share in failed for test in share]
    if failed:
        sys.exit(f"mutants: without a change, too, fail: {' '.join(failed)}")


def all_mutants():
    """The entries of all lists."""
    return [mutant for path in sorted(LISTS.glob("*.txt")) for mutant in read_list(path)]


def chosen(mutant, word):
    """Whether a word chooses an entry."""
    return any(word in text for text in (mutant.file, mutant.old, *mutant.tests))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--trees", type=int, default=2, help="how many are built at the same time")
    parser.add_argument("words", nargs="*")
    args = parser.parse_args()
    mutants = [m for m in all_mutants() if not args.words or any(chosen(m, word) for word in args.words)]
    if misfits(mutants):
        sys.exit("mutants:\n" + "\n".join(misfits(mutants)))
    trees = [make_tree(ROOT / "build" / "mutants" / str(k)) for k in range(args.trees)]
    check_originals(trees, mutants)
    waiting, lock, results = queue.Queue(), threading.Lock(), []
    for mutant in mutants:
        waiting.put(mutant)

    def report(mutant, result):
        with lock:
            results.append((mutant, result))
            print(f"{len(results)}/{len(mutants)} {mutant.where} {mutant.file}: {result}", flush=True)

    workers = [threading.Thread(target=work, args=(tree, waiting, report)) for tree in trees]
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    bad = [(mutant, result) for mutant, result in results if result != "caught"]
    for mutant, result in bad:
        print(f"\n{mutant.where} {mutant.file}: {result}\n- {mutant.old}\n+ {mutant.new}\n! {' '.join(mutant.tests)}")
    print(f"{len(results) - len(bad)} caught, {len(bad)} not")
    return 1 if bad or not results else 0


if __name__ == "__main__":
    os.environ.setdefault("PYTHONDONTWRITEBYTECODE", "1")
    sys.exit(main())

#!/usr/bin/env python3
"""Random problems of one kind, each judged; a seed repeats its problem.

    python3 tests/program/random_problems.py KIND [--trials N] [--seed S] [--show] [--log FILE] [options of the kind]

`KIND --help` says what a kind tries, and lists its options. Prints the faults, with what repeats them, and at the end a
summary. Ends with 1 if there are faults.
"""

import argparse
import functools
import importlib
import json
import subprocess
import sys
import tempfile
import traceback
from pathlib import Path

import conftest
from kinds import Outcome

KINDS = {
    "decks": "decks for petsam-compliance: a body in many forms, with cards that change it, and damaged",
    "energies": "load cycles: the error of their dissipated energy and petsam's estimate of it",
    "heat": "frictional heat: each temperature by direct summation in numpy",
    "kills": "runs with checkpoints that are killed at random moments: the same end as without kills",
    "layered": "layered bodies: each step against an own solution of the layers in numpy",
    "lives": "joints that wear: the last step and the worn volume, by direct summation",
    "pads": "pads in plane strain against finer grids and steps: numbers that are wrong without a warning",
    "plane": "histories in plane strain: each step against dense matrices in numpy",
    "ranks": "two capabilities together on several ranks: the same bits as on one",
    "repeats": "loads that repeat, on two capabilities together: the same with kept steps and without them",
    "rolling": "steady rolling: against formulas in numpy, and within 80 products",
    "scans": "files for petsam-surface as instruments and spreadsheets write them",
    "slide": "worn surfaces that slide past each other, against finer grids and steps",
    "usual": "problems as users give them, of all kinds of gaps and bodies, against finer grids and steps",
    "yield": "bodies that yield below their surface, against finer grids and steps",
    "yields": "histories of bodies that yield: each step checked from its results alone",
    "zone": "lives in partial slip, whose scars end at a stick zone, against finer grids and steps",
}
MODULES = dict.fromkeys(("slide", "usual", "yield", "zone"), "users")  # others have the name of the kind
SEEDS = 20  # times as many as trials are tried at most, where problems are rejected


def module_of(kind):
    return importlib.import_module("kinds." + MODULES.get(kind, kind))


def add_option(parser, name, usual):
    """Adds an option of this usual value; a False one is a switch, and a tuple has the choices."""
    if usual is False:
        how = dict(action="store_true")
    elif isinstance(usual, tuple):
        how = dict(choices=usual, default=usual[0])
    else:
        how = dict(type=str if usual is None else type(usual), default=usual)
    parser.add_argument(f"--{name}", **how, **({} if usual in (None, False) else dict(help="usual: %(default)s")))


def arguments(line):
    """The options of a command line, `kind` among them; only the module of its kind is loaded."""
    form = functools.partial(argparse.RawDescriptionHelpFormatter, width=120)
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=form)
    kinds = parser.add_subparsers(dest="kind", metavar="KIND", required=True)
    for kind, about in KINDS.items():
        chosen = kind in line[:1]
        own = kinds.add_parser(
            kind, help=about, description=module_of(kind).__doc__ if chosen else None, formatter_class=form
        )
        own.add_argument("--seed", type=int, default=1, help="of the first trial; the next one has the next number")
        own.add_argument("--show", action="store_true", help="print all, not the faults alone")
        own.add_argument("--log", help="file to which a line of JSON is added for each trial")
        own.add_argument("--build", help="the build folder; else that of PETSAM_BUILD")
        for name, usual in (module_of(kind).OPTIONS if chosen else {}).items():
            add_option(own, name, usual)
    return parser.parse_args(line)


def tried(module, seed, folder, given):
    """The outcome of a trial, also of one that breaks off."""
    try:
        return module.trial(seed, folder, given)
    except (AssertionError, subprocess.TimeoutExpired):
        return Outcome(traceback.format_exc(), True)


def outcomes(module, given):
    """(seed, outcome) of so many trials, each in a folder that goes afterwards."""
    judged = 0
    for seed in range(given.seed, given.seed + SEEDS * given.trials):
        with tempfile.TemporaryDirectory(prefix="petsam-random-") as folder:
            outcome = tried(module, seed, Path(folder), given)
        if outcome:
            yield seed, outcome
            judged += 1
        if judged == given.trials:
            return


def add_line(path, **values):
    """Adds a line of JSON to a file."""
    with open(path, "a") as file:
        json.dump(values, file, default=float)
        file.write("\n")


def main(line):
    """Tries, prints and judges; returns the exit code."""
    given = arguments(line)
    if given.build:
        conftest.PROGRAM = Path(given.build).resolve() / "bin" / "petsam"
    module, found = module_of(given.kind), {}
    getattr(module, "begin", lambda: None)()
    for seed, outcome in outcomes(module, given):
        found[seed] = outcome
        if outcome.fault or outcome.telling or given.show:
            print(f"{'FAULT ' if outcome.fault else ''}seed {seed}: {outcome.text}", flush=True)
        if given.log:
            add_line(given.log, kind=given.kind, seed=seed, fault=outcome.fault, text=outcome.text, **outcome.numbers)
    summary = module.summary({seed: outcome.numbers for seed, outcome in found.items() if outcome.numbers})
    print(*summary, sep="\n")
    faults = [seed for seed, outcome in found.items() if outcome.fault]
    judged = any(outcome.fault is not None for outcome in found.values())
    print(f"{given.kind}: {len(found)} trials" + (f", {len(faults)} with a fault {faults}" if judged else ""))
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

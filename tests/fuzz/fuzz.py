#!/usr/bin/env python3
"""Fuzzing: runs petsam with malformed options, histories, HDF5 files and checkpoints, and with faults meanwhile.

    python3 tests/fuzz/fuzz.py [--build build] [--seconds 600] [--seed 1] [--ranks 1,2] [--only kind,...]

Prints a line for each failure, with what repeats it, and at the end the trials and failures of each kind. Ends with 1
after a failure. What is promised of each trial is said in trials.py.
"""

import argparse
import collections
import os
import random
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import trials


def launcher_words():
    words = os.environ.get("MPIRUN", "mpirun").split()
    version = subprocess.run(
        [*words, "--version"],
        capture_output=True,
        text=True,
        env={**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"},
    ).stdout
    return words + (["--oversubscribe"] if "Open MPI" in version else [])


def read_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", default="build", help="the build folder")
    parser.add_argument("--seconds", type=float, default=600, help="how long to go on")
    parser.add_argument("--trials", type=int, default=None, help="how many trials at most")
    parser.add_argument("--seed", type=int, default=1, help="of the first trial; the next one has the next number")
    parser.add_argument("--ranks", default="1,2", help="numbers of ranks to choose from")
    parser.add_argument("--only", default=",".join(trials.KINDS), help="kinds of trials: " + ", ".join(trials.KINDS))
    parser.add_argument("--patience", type=float, default=trials.LIMIT, help="most seconds of a run")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="trials at a time")
    return parser.parse_args()


class Campaign:
    def __init__(self, arguments):
        self.set = arguments
        self.program = Path(arguments.build).resolve() / "bin" / "petsam"
        self.kinds = arguments.only.split(",")
        unknown = set(self.kinds) - set(trials.KINDS)
        if unknown:
            raise SystemExit(f"--only {','.join(sorted(unknown))}: the kinds are {', '.join(trials.KINDS)}")
        self.ranks = [int(n) for n in arguments.ranks.split(",")]
        self.launcher = launcher_words()
        self.end = time.monotonic() + arguments.seconds
        self.codes = collections.defaultdict(collections.Counter)
        self.failures = collections.Counter()

    def work(self, seeds):
        """Trials until the time is over or no seed is left."""
        for seed in seeds:
            if time.monotonic() > self.end:
                return
            self.one(seed)

    def one(self, seed):
        """One trial, which its seed repeats."""
        chance = random.Random(seed)
        kind, ranks = chance.choice(self.kinds), chance.choice(self.ranks)
        with tempfile.TemporaryDirectory(prefix="petsam-fuzz-") as folder:
            trial = trials.Trials(self.program, folder, self.launcher, self.set.patience)
            try:
                self.codes[kind][getattr(trial, "trial_" + kind)(chance, ranks)] += 1
            except Exception as failure:
                self.failures[kind] += 1
                print(f"seed {seed}, {kind}, {ranks} ranks: {failure!r}\n  {trial.command}", flush=True)

    def run(self):
        last = sys.maxsize if self.set.trials is None else self.set.seed + self.set.trials
        seeds = iter(range(self.set.seed, last))  # its next() is atomic: each seed goes to one of the threads
        with ThreadPoolExecutor(self.set.jobs) as pool:
            list(pool.map(self.work, [seeds] * self.set.jobs))
        for kind in self.kinds:
            codes = ", ".join(f"{n} x exit {code}" for code, n in sorted(self.codes[kind].items(), key=str))
            print(f"{kind:12} {sum(self.codes[kind].values()) + self.failures[kind]:6} trials, ", end="")
            print(f"{self.failures[kind]} failures ({codes})")
        total = sum(sum(codes.values()) for codes in self.codes.values())
        print(f"{total + sum(self.failures.values())} trials, {sum(self.failures.values())} failures")
        return 1 if self.failures else 0


if __name__ == "__main__":
    sys.exit(Campaign(read_arguments()).run())

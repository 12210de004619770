"""What the programs of random problems share; the main part of tests/fuzz/layered.py, plane.py and rolling.py."""

import argparse
import collections
import tempfile
from pathlib import Path

import numpy as np


def ask(description, **usual):
    """Options of the command line, --seed among them, each with its usual value; a False one is a switch."""
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name, value in dict(usual, seed=1).items():
        how = dict(action="store_true") if value is False else dict(type=type(value), default=value)
        parser.add_argument(f"--{name}", **how)
    return parser.parse_args()


def seeds(first, count):
    """So many seeds, each with a folder of its own that goes afterwards."""
    for seed in range(first, first + count):
        with tempfile.TemporaryDirectory() as name:
            yield seed, Path(name)


def main(description, trial, numbers, count=300):
    """Tries problems, prints what repeats a failure, and numbers by kind of problem; whether any failed.

    trial(program, seed): the problem's kinds, the history of its results (None: there are none), its faults by name,
    and its options; numbers(history): what a solution cost, by name.
    """
    given = ask(description, build="build", count=count, show=False)
    program = Path(given.build).resolve() / "bin" / "petsam"
    found, failed = collections.defaultdict(list), 0
    for seed in range(given.seed, given.seed + given.count):
        kinds, history, wrong, line = trial(program, seed)
        cost = numbers(history) if history else {}
        for kind in ["all", *(kinds or ["plain"])]:
            found[kind].append(cost)
        if given.show:
            print(seed, ",".join(kinds), *(f"{name} {value:.3g}" for name, value in cost.items()), flush=True)
        if wrong:
            failed += 1
            print(f"seed {seed} ({', '.join(kinds)}): {wrong}\n    {line}", flush=True)
    for kind, costs in found.items():
        solved = [cost for cost in costs if cost]
        sums = "".join(
            f"  {name}: median {np.median([cost[name] for cost in solved]):.3g}, "
            f"most {max(cost[name] for cost in solved):.3g}"
            for name in (solved[0] if solved else [])
        )
        print(f"{kind:13} {len(costs):4}{sums}")
    print(f"{given.count} problems, {failed} failed")
    return failed > 0

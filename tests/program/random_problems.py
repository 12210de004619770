"""The main part that the programs of random problems share: tests/fuzz/layered.py, plane.py and rolling.py."""

import argparse
import collections
from pathlib import Path

import numpy as np


def main(description, trial, numbers, count=300):
    """Tries problems, prints what repeats a failure, and numbers by kind of problem; whether any failed.

    trial(program, seed): the problem's kinds, the history of its results (None: there are none), its faults by name,
    and its options; numbers(history): what a solution cost, by name.
    """
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", default="build", help="the build folder")
    parser.add_argument("--count", type=int, default=count, help="how many problems")
    parser.add_argument("--seed", type=int, default=1, help="of the first; the next one has the next number")
    parser.add_argument("--show", action="store_true", help="print a line for each problem")
    given = parser.parse_args()
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

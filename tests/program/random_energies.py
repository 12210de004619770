#!/usr/bin/env python3
"""Random load cycles: the error of their dissipated energy by the length of the steps, and petsam's estimate of it.

A ball under N that varies by 0 to 80 %, T_x, and T_y or none, out of phase or in proportion to N; 24 rows a cycle, in
one step each, against twelve. Prints the errors, and how many estimates are within a factor of 3 of errors above 0.1 %.

    python3 tests/program/random_energies.py [--trials 100] [--seed 1] [--cells 32]
"""

import sys
from pathlib import Path

import h5py
import numpy as np

import conftest
from random_problems import ask, seeds
from support import history

ROWS = 24
MANY = 12
FRICTION = 0.5


def random_case(seed, folder, cells=32):
    """Options of a ball, and a cycle of loads from full N alone on."""
    rng = np.random.default_rng(seed)
    t = 2 * np.pi * np.arange(ROWS + 1) / ROWS
    swing, follows, plane, twice = rng.choice([0, 0.2, 0.35, 0.5, 0.8]), *(rng.random(3) < [0.5, 0.5, 0.4])
    phase, size = rng.uniform(0, 2 * np.pi, 4), rng.uniform(0.2, 0.6, 2)
    n = 400 * (1 + swing * np.sin(t))
    limit = FRICTION * (n if follows else n.min())
    x = limit * size[0] * (np.sin(t + phase[0]) + 0.4 * twice * np.sin(2 * t + phase[1]))
    y = limit * size[1] * np.sin(t + phase[2]) * plane
    part = min(1, 0.85 / np.max(np.hypot(x, y) / (FRICTION * n)))
    loads = np.stack([n, part * x, part * y], axis=1).tolist()
    rows = [(0.5, loads[0][0], 0.0, 0.0)] + [(1.0 + k, *row) for k, row in enumerate(loads)]
    names = "time,load_n,load_tx,load_ty"
    case = dict(
        gap_type="sphere",
        gap_radius1=0.05,
        gap_radius2=float("inf"),
        friction=FRICTION,
        grid_n=cells,
        grid_size=1.4e-3,
        output_every=1000,
    )
    case.update({f"body{b}_{name}": value for b in (1, 2) for name, value in (("young", 200e9), ("poisson", 0.3))})
    return {**case, **history(Path(folder) / "h.csv", names, *rows)}


def compare(seed, solve, folder, cells=32):
    """Energy of the cycle, error of one step a row and its estimate (J); solve(case, steps) gives the results file."""
    case = random_case(seed, folder, cells)
    sums = []
    for steps in (MANY, 1):
        with h5py.File(solve(case, steps)) as file:
            last = slice(-ROWS * steps, None)
            sums.append([file[f"history/{name}"][last].sum() for name in ("dissipated_energy", "energy_error")])
    return sums[0][0], abs(sums[1][0] - sums[0][0]), sums[1][1]


def main():
    arguments = ask(__doc__, trials=100, cells=32)
    launcher = conftest.launcher_words()
    ratios = []
    for seed, folder in seeds(arguments.seed, arguments.trials):

        def solve(case, steps, folder=folder, seed=seed):
            done = conftest.execute(launcher, folder, [dict(case, steps=steps, output=f"{steps}.h5")], 1, None)
            if done.code:
                sys.exit(f"seed {seed}: {done.stderr}")
            return folder / f"{steps}.h5"

        energy, error, estimate = compare(seed, solve, folder, arguments.cells)
        print(
            f"seed {seed}: {energy:.3g} J, error {100 * error / energy:.3f} %, estimate {100 * estimate / energy:.3f} %"
        )
        if error > 1e-3 * energy:
            ratios.append(estimate / error)
    good = sum(1 / 3 < ratio < 3 for ratio in ratios)
    print(f"{good} of {len(ratios)} estimates within a factor of 3, ratios {min(ratios):.2g} to {max(ratios):.2g}")
    return 0


if __name__ == "__main__":
    sys.exit(main())

"""Random load cycles: the error of their dissipated energy by the length of the steps, and petsam's estimate of it.

A ball under N that varies by 0 to 80 %, T_x, and T_y or none, out of phase or in proportion to N; 24 rows a cycle, in
one step each, against twelve. Prints the errors, and how many estimates are within a factor of 3 of errors above 0.1 %.
"""

from pathlib import Path

import h5py
import numpy as np

import conftest
from kinds import Outcome
from support import history

ROWS = 24
MANY = 12
FRICTION = 0.5
OPTIONS = dict(trials=100, cells=32)


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


def trial(seed, folder, given):
    """The error and its estimate, relative to the energy."""

    def solve(case, steps):
        conftest.execute(conftest.launcher_words(), folder, [dict(case, steps=steps, output=f"{steps}.h5")], 1, 0)
        return folder / f"{steps}.h5"

    energy, error, estimate = compare(seed, solve, folder, given.cells)
    text = f"{energy:.3g} J, error {100 * error / energy:.3f} %, estimate {100 * estimate / energy:.3f} %"
    return Outcome(text, False, dict(error=error / energy, estimate=estimate / energy))


def summary(found):
    ratios = [one["estimate"] / one["error"] for one in found.values() if one["error"] > 1e-3]
    good = sum(1 / 3 < ratio < 3 for ratio in ratios)
    span = f", ratios {min(ratios):.2g} to {max(ratios):.2g}" if ratios else ""
    return [f"{good} of {len(ratios)} estimates within a factor of 3{span}"]

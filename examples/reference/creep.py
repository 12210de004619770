#!/usr/bin/env python3
"""Reads the table of creep forces, and checks a program's forces against it: python3 creep.py FORCES.csv

FORCES.csv has the columns ratio, xi, eta, phi, fx, fy, mz. Needs numpy only.
"""

import sys
from pathlib import Path

import numpy as np

INPUTS, FORCES = ("ratio", "xi", "eta", "phi"), ("fx", "fy", "mz")
TABLE = Path(__file__).with_name("creep.csv")
COLUMNS = (*INPUTS, *(f"{name}_{end}" for name in FORCES for end in ("low", "high")))


def read(path=TABLE):
    """The table as an array with the columns ratio, xi, eta, phi, fx_low, fx_high, ..., mz_high."""
    return np.genfromtxt(path, delimiter=",", names=True, ndmin=1)


def find(table, ratio, xi, eta, phi):
    """The lows and highs of fx, fy, mz of a case of the table or, by symmetry, of one with other signs; else None."""
    turn, along = np.sign(phi) or np.sign(eta) or 1, np.sign(xi) or 1  # mirrored at the plane y = 0; rolled backwards
    wanted = (ratio, abs(xi), turn * eta, abs(phi))
    rows = table[np.all([np.isclose(table[name], x) for name, x in zip(INPUTS, wanted)], axis=0)]
    if not rows.size:
        return None
    ends = np.array([[rows[0][f"{name}_{end}"] for name in FORCES] for end in ("low", "high")])
    return np.sort(ends * (along, turn, turn), axis=0)


if __name__ == "__main__":
    table, answers, off = read(), read(sys.argv[1]), []
    for row in answers:
        ends = find(table, *(row[name] for name in INPUTS))
        off += [] if ends is None else [max(a - row[n], row[n] - b, 0) for n, a, b in zip(FORCES, *ends)]
    print(f"{len(off) // 3} of {answers.size} cases in the table, {np.count_nonzero(off)} numbers outside", end=", ")
    print(f"by {max(off, default=0):.5f} at most")

#!/usr/bin/env python3
"""Computes the table of creep forces with petsam, and some of its cases a second way.

    creep_table.py compute [--ratios 0.1,1,...] [--cells 64,128,256] -o creep.csv
    creep_table.py second [--cases 40] [--seed 1] [--table creep.csv]    by cells in numpy: do the intervals overlap?
    creep_table.py picture [--table creep.csv] -o creep.png

CREEP.md has the definitions.
"""

import argparse
import csv
import itertools
import sys
import tempfile
from pathlib import Path

import numpy as np
from rolling_cells import steady
from scipy.special import ellipe, ellipk

import creep
import petsam

YOUNG, POISSON, FRICTION, LENGTH, PEAK = 210e9, 0.25, 0.3, 1e-3, 1e-3  # Pa, 1, 1, sqrt(a b) in m, p0/E*
SHEAR = YOUNG / (2 + 2 * POISSON)
RATIOS = (0.1, 0.2, 0.35, 0.6, 1.0, 1.5, 2.2, 3.5, 6.0, 10.0)
CREEPS = (0.0, 0.1, 0.25, 0.6, 1.5)
SPINS = (0.0, 0.2, 0.5, 1.2, 3.0)
ROOM = 1.15  # width of the grid over that of the contact
FLOOR = 2e-4  # no interval is narrower than twice this
SHOWN = (0.1, 0.35, 1.0, 3.5, 10.0)  # ratios of the picture
COARSE, FINE = (64, 128), 41  # cells and points of its curves, extrapolated as the table is


def cases():
    """Creepages and spin, xi and phi not negative; without spin eta neither: the rest follows by symmetry."""
    etas = sorted({sign * eta for eta in CREEPS for sign in (1, -1)})
    for xi, eta, phi in itertools.product(CREEPS, etas, SPINS):
        if (xi or eta or phi) and not (phi == 0 and eta < 0):
            yield xi, abs(eta) if eta == 0 else eta, phi


def contact(ratio):
    """Half axes and, as options, radii and N of Hertz's contact of this a/b: Johnson, Contact Mechanics, (4.26)."""
    a, b = LENGTH * np.sqrt(ratio), LENGTH / np.sqrt(ratio)
    long, short = max(a, b), min(a, b)
    m = 1 - (short / long) ** 2
    if m == 0:
        curvatures = [np.pi * PEAK / (4 * long)] * 2
    else:
        unit = PEAK * short / (m * long**2)
        curvatures = [unit * (ellipk(m) - ellipe(m)), unit * ((long / short) ** 2 * ellipe(m) - ellipk(m))]
    if a < b:
        curvatures.reverse()
    force = 2 / 3 * np.pi * a * b * PEAK * YOUNG / (2 - 2 * POISSON**2)
    radii = {f"gap_radius_{axis}": 1 / (2 * value) for axis, value in zip("xy", curvatures)}
    return (a, b), {**radii, "load_n": force}


def motion(limit, xi, eta, phi):
    """Creepages and spin (1, 1, 1/m) of a case, for mu N."""
    unit = limit / (SHEAR * LENGTH**2)
    return xi * unit, eta * unit, phi * unit / LENGTH


def relative(limit, loads):
    """T_x/(mu N), T_y/(mu N), M_z/(mu N c) of loads T_x, T_y, M_z in the last axis."""
    return np.asarray(loads) / limit / (1, 1, LENGTH)


def forces(ratio, cells, some=None):
    """The relative loads of some cases, of all of the table by default, on a grid."""
    half, options = contact(ratio)
    limit = FRICTION * options["load_n"]
    rows = [(k + 1, *motion(limit, *case)) for k, case in enumerate(some or cases())]
    with tempfile.TemporaryDirectory() as folder:
        loads = Path(folder) / "creepages.csv"
        with loads.open("w", newline="") as file:
            csv.writer(file).writerows([("time", "creep_x", "creep_y", "creep_spin"), *rows])
        run = petsam.run(
            options, history=str(loads), rolling="steady", friction=FRICTION, gap_type="ellipsoid",
            body1_young=YOUNG, body2_young=YOUNG, body1_poisson=POISSON, body2_poisson=POISSON,
            grid_n=cells, grid_size=tuple(2 * ROOM * side for side in half), output_every=len(rows),
        )  # fmt: skip
    return relative(limit, np.transpose([run.history[f"load_{name}"] for name in ("tx", "ty", "mz")]))


def intervals(grids):
    """Low and high ends from three grids, each twice as fine as the last: errors are of first order.

    Limit 2 F(h) - F(2h), -+ 1.5 times its difference from that of the coarser grids, or half of the last change.
    """
    coarse, middle, fine = grids
    limit, before = 2 * fine - middle, 2 * middle - coarse
    half = np.maximum.reduce([1.5 * abs(limit - before), abs(fine - middle) / 2, np.full(fine.shape, FLOOR)])
    return limit - half, limit + half


def compute(ratios, cells, path):
    with open(path, "w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(creep.COLUMNS)
        for ratio in ratios:
            low, high = intervals([forces(ratio, n) for n in cells])
            for case, ends in zip(cases(), zip(low, high)):
                numbers = [f"{function(end * 1e5) / 1e5:.5f}" for pair in zip(*ends) for end, function in
                           zip(pair, (np.floor, np.ceil))]  # fmt: skip
                writer.writerow([f"{ratio:g}", *(f"{value:g}" for value in case), *numbers])
            file.flush()
            print(f"a/b = {ratio:g}: widest interval {np.max(high - low):.4f}", file=sys.stderr)


def second(count, seed, path, cells=(32, 64, 128)):
    """Random cases by so many cells in numpy across the contact: their own intervals have to overlap the table's."""
    table, apart, solved = creep.read(path), 0, 0
    for row in np.random.default_rng(seed).permutation(len(table)):
        case = table[row]
        half, options = contact(case["ratio"])
        limit = FRICTION * options["load_n"]
        creepages = motion(limit, case["xi"], case["eta"], case["phi"])
        name = " ".join(f"{case[name]:g}" for name in creep.INPUTS)
        try:
            grids = [relative(limit, steady(half, n, SHEAR, POISSON, limit, creepages)[:3]) for n in cells]
        except RuntimeError as error:
            print(name, error)
            continue
        low, high = intervals(grids)
        ends = [(case[f"{force}_low"], case[f"{force}_high"]) for force in creep.FORCES]
        outside = [force for force, a, b, (c, d) in zip(creep.FORCES, low, high, ends) if a > d or b < c]
        print(name, "apart: " + ", ".join(outside) if outside else "overlap")
        apart, solved = apart + len(outside), solved + 1
        if solved == count:
            break
    print(f"{3 * solved - apart} of {3 * solved} intervals overlap")
    return apart


def along(k, values):
    """Cases of creepage along x alone (k = 0), or of spin alone (1)."""
    return [(0, 0, value) if k else (value, 0, 0) for value in values]


def picture(table_path, path):
    """T_x over xi, and T_y over phi, for some contacts: middles of the table's intervals on curves by petsam."""
    from petsam.plot.style import STYLE, colors, frame, plt, points, reduce

    table = creep.read(table_path)
    with plt.rc_context(STYLE):
        figure, panels = plt.subplots(1, 2, figsize=(9, 3.9), layout="constrained", sharey=True)
        for ratio, mark, color in zip(SHOWN, "os^Dv", colors(len(SHOWN))):
            for k, (axes, values) in enumerate(zip(panels, (CREEPS, SPINS))):
                fine = values[-1] * np.linspace(0, 1, FINE) ** 2
                grids = [forces(ratio, cells, along(k, fine[1:])) for cells in COARSE]
                axes.plot(fine, [0, *(2 * grids[1] - grids[0])[:, k]], color=color, linewidth=1.3)
                ends = np.array([creep.find(table, ratio, *case)[:, k] for case in along(k, values[1:])])
                points(axes, values[1:], ends.mean(axis=1), color, mark, markersize=5, label=f"a/b = {ratio:g}")
        frame(panels[0], "Creepage along x alone", r"creepage $\xi G c^2/(\mu N)$", r"force $T_x/(\mu N)$")
        frame(panels[1], "Spin alone", r"spin $\varphi G c^3/(\mu N)$", r"force $T_y/(\mu N)$")
        panels[1].yaxis.set_tick_params(labelleft=True)
        panels[1].legend(title="half axes")
        figure.savefig(path)
    reduce(path)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("task", choices=["compute", "second", "picture"])
    parser.add_argument("--ratios", default=",".join(f"{ratio:g}" for ratio in RATIOS))
    parser.add_argument("--cells", default="64,128,256")
    parser.add_argument("--cases", type=int, default=40)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--table", default=creep.TABLE)
    parser.add_argument("-o", "--output", default="creep.csv")
    given = parser.parse_args()
    if given.task == "second":
        sys.exit(second(given.cases, given.seed, given.table) > 0)
    if given.task == "picture":
        return picture(given.table, given.output)
    return compute([float(x) for x in given.ratios.split(",")], [int(n) for n in given.cells.split(",")], given.output)


if __name__ == "__main__":
    main()

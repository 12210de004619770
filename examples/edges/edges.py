#!/usr/bin/env python3
"""Errors of pressure, area and approach on grids of several sizes: a sphere, an ellipsoid turned on the grid and a
rounded punch, each beside the grid's centre by parts of a cell, with -edges none and reconstruct. Used by run.sh.

    python3 examples/edges/edges.py PETSAM FOLDER [CELLS...]
"""

import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

import h5py
import numpy as np
from scipy.special import ellipe, ellipk

from petsam.closed.punch import Punch, punch_approach, punch_load, punch_pressure
from petsam.plot.style import COLORS, STYLE, plt

CELLS = (32, 64, 128, 256)
PLACES = ((0.13, 0.27), (0.41, 0.07), (0.33, 0.49), (0.02, 0.31))  # of the body's centre, cells from the grid's
WAYS = ("none", "reconstruct")
LABELS = {"none": "uncorrected", "reconstruct": "reconstructed"}
MATERIAL = "-body1_young 2 -body1_poisson 0 -body2_young 2 -body2_poisson 0 -normal_rtol 1e-10".split()  # E* = 1


class Shape(NamedTuple):
    """A body whose contact is known: its gap, pressure (functions of x, y), approach, area, load, and the grid."""

    gap: object
    pressure: object
    approach: float
    area: float
    load: float
    width: float


def sphere():
    """Hertz, contact radius 1: width 3."""
    return Shape(
        lambda x, y: (x**2 + y**2) / 2,
        lambda x, y: 2 / np.pi * np.sqrt(np.clip(1 - x**2 - y**2, 0, None)),
        1.0,
        np.pi,
        4 / 3,
        3.0,
    )


def ellipsoid(ratio=1 / 3, turn=0.4):
    """Hertz, half axes 1 and `ratio`, turned by `turn`: Johnson, Contact Mechanics, section 4.2."""
    m = 1 - ratio**2
    k, e = ellipk(m), ellipe(m)
    load = 1.0
    scale = 3 * load / (2 * np.pi * m)
    curvature = scale * (k - e), scale * (e / ratio**2 - k)  # gap: these times x^2, y^2 along the axes
    c, s = np.cos(turn), np.sin(turn)

    def axes(x, y):
        return c * x + s * y, c * y - s * x

    def gap(x, y):
        u, v = axes(x, y)
        return curvature[0] * u**2 + curvature[1] * v**2

    def pressure(x, y):
        u, v = axes(x, y)
        return 3 * load / (2 * np.pi * ratio) * np.sqrt(np.clip(1 - u**2 - (v / ratio) ** 2, 0, None))

    return Shape(gap, pressure, 3 * load * k / (2 * np.pi), np.pi * ratio, load, 2.6)


def punch(flat=0.7):
    """A flat base of radius `flat` with a parabolic edge, contact radius 1."""
    body = Punch(flat, 1.0, 1.0)

    def pressure(x, y):
        r = np.hypot(x, y)
        return np.where(r < 1, punch_pressure(np.minimum(r, 1 - 1e-15), body, 1.0), 0.0)

    return Shape(
        lambda x, y: body.gap(np.hypot(x, y)),
        pressure,
        float(punch_approach(body, 1.0)),
        np.pi,
        float(punch_load(body, 1.0)),
        2.6,
    )


SHAPES = {"sphere": sphere, "ellipsoid": ellipsoid, "punch": punch}


def places(shape, n, place):
    """x and y of the cells' centres from the body's centre, (n, n)."""
    h = shape.width / n
    axis = (np.arange(n) + 0.5 - n / 2) * h
    return np.meshgrid(axis - place[0] * h, axis - place[1] * h)


def measure(petsam, folder, shape, n, place, way):
    """Relative errors of the pressure at the cells' centres (2-norm), area and approach; and what petsam printed."""
    x, y = places(shape, n, place)
    with h5py.File(folder / "gap.h5", "w") as file:
        file["height"] = shape.gap(x, y)
    # the load acts at the body's centre: y p = -M_x, x p = M_y
    my, mx = (sign * part * shape.width / n * shape.load for sign, part in zip((1, -1), place))
    field = "pressure" if way == "none" else "pressure_center"
    words = (
        f"-gap_type file -gap_file {folder}/gap.h5 -grid_n {n} -grid_size {shape.width} -load_n {shape.load!r} "
        f"-load_mx {mx!r} -load_my {my!r} -edges {way} -output {folder}/edges.h5 "
        f"-output_fields {field} -profile"
    )
    done = subprocess.run([petsam, *MATERIAL, *words.split()], capture_output=True, text=True)
    if done.returncode:
        sys.exit(done.stdout + done.stderr)
    with h5py.File(folder / "edges.h5") as file:
        exact = shape.pressure(x, y)
        error = np.linalg.norm(file[field][-1] - exact) / np.linalg.norm(exact)
        area, approach = (file["history"][name][-1] for name in ("contact_area", "disp_z"))
    return np.array([error, area / shape.area - 1, approach / shape.approach - 1]), done.stdout


def table(petsam, folder, cells=CELLS, offsets=PLACES):
    """Root mean squares over the places, by shape, way and cells."""
    errors = {}
    for name, make in SHAPES.items():
        shape = make()
        for n in cells:
            for way in WAYS:
                each = [measure(petsam, folder, shape, n, place, way)[0] for place in offsets]
                errors[name, way, n] = np.sqrt(np.mean(np.square(each), axis=0))
                print(f"{name:9} {n:4} {LABELS[way]:13}", *(f"{e:8.1e}" for e in errors[name, way, n]), flush=True)
    return errors


def draw(errors, cells, filename):
    plt.rcParams.update({**STYLE, "axes.prop_cycle": plt.cycler(color=COLORS)})
    figure, rows = plt.subplots(2, 3, figsize=(10, 6), sharex=True, constrained_layout=True)
    for column, name in enumerate(SHAPES):
        for row, (label, index) in enumerate((("pressure", 0), ("contact area", 1))):
            ax = rows[row][column]
            for way, marker in zip(WAYS, "osD"):
                ax.loglog(cells, [errors[name, way, n][index] for n in cells], f"{marker}-", label=LABELS[way])
            if row == 0:
                ax.set_title(name)
            if column == 0:
                ax.set_ylabel(f"relative error of the {label}")
            ax.set_xticks(cells, [str(n) for n in cells])
            ax.minorticks_off()
        rows[1][column].set_xlabel("cells in each direction")
    figure.legend(*rows[0][0].get_legend_handles_labels(), loc="outside upper center", ncols=3)
    figure.savefig(filename)


def main():
    petsam, folder = sys.argv[1], Path(sys.argv[2])
    cells = tuple(int(word) for word in sys.argv[3:]) or CELLS
    print("shape     cells                pressure  area     approach")
    errors = table(petsam, folder, cells)
    draw(errors, cells, folder / "edges.png")
    finest = cells[-1]
    for name in SHAPES:
        gain = errors[name, "none", finest] / errors[name, "reconstruct", finest]
        if not gain[1] > 5:
            sys.exit(f"{name}: the reconstruction gains only {gain[1]:.1f} in the area on {finest} cells")


if __name__ == "__main__":
    main()

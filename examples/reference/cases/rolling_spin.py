"""Two spheres that roll with creepages and spin, in steady state."""

import functools

import numpy as np
from common import all_covered, over_places
from rolling_cells import steady

import petsam

N, RADIUS, YOUNG, POISSON, FRICTION = 50.0, 0.02, 210e9, 0.28, 0.3
HALF = np.cbrt(0.75 * N * RADIUS / 2 / (YOUNG / (2 - 2 * POISSON**2)))  # Hertz's radius of the contact
WIDTH = 3.4e-4  # of the grid
XI, ETA, SPIN = 2e-3, 1e-3, 15.0
OPTIONS = {
    **{f"body{body}_young": YOUNG for body in (1, 2)},
    **{f"body{body}_poisson": POISSON for body in (1, 2)},
    "gap_type": "sphere",
    "gap_radius1": RADIUS,
    "gap_radius2": RADIUS,
    "friction": FRICTION,
    "rolling": "steady",
    "load_n": N,
    "creep_x": XI,
    "creep_y": ETA,
    "creep_spin": SPIN,
}
UNITS = {"load_tx": "N", "load_ty": "N", "load_mz": "N m", "stick_area": "m2", "power_per_speed": "N"}


@functools.lru_cache
def solve(cells, factor=1.0):
    return petsam.run({**OPTIONS, "grid_n": cells, "grid_size": factor * WIDTH})


def numbers(results, end=""):
    last = {name: values[-1] for name, values in results.history.items()}
    tx, ty, mz = (last[f"load_{name}{end}"] for name in ("tx", "ty", "mz"))
    return dict(zip(UNITS, (tx, ty, mz, last["stick_area"], XI * tx + ETA * ty + SPIN * mz)))


def rolls(n, factor):
    """The numbers, by cells in numpy: n over the width of the contact times that factor."""
    shear = YOUNG / (2 + 2 * POISSON)
    tx, ty, mz, stick = steady((HALF, HALF), n, shear, POISSON, FRICTION * N, (XI, ETA, SPIN), factor)
    return dict(zip(UNITS, (tx, ty, mz, stick, XI * tx + ETA * ty + SPIN * mz)))


def evidence():
    def ours(n):
        return over_places(lambda factor: numbers(solve(n, factor)), HALF * n / WIDTH)

    def others(n):
        return over_places(lambda factor: rolls(n, factor), n / 2)

    ways = {
        "petsam, 64, 128, 256, 512 cells, means of four widths": [*map(ours, (64, 128, 256, 512))],
        "cells in numpy, 32, 64, 128, 256 across, means of four widths": [*map(others, (32, 64, 128, 256))],
    }
    return all_covered(UNITS, ways)


def answers():
    return numbers(solve(256), "_extrapolated")


def draw(figure):
    figure.set_size_inches(6.0, 2.9)
    results = solve(64)
    x, y = results.x * 1e3, results.y * 1e3
    p, qx, qy = (results[name][-1] for name in ("pressure", "shear_x", "shear_y"))
    inside, some = p > 0, np.s_[2::5, 2::5]
    sticks = np.where(inside, np.hypot(qx, qy) < FRICTION * p * (1 - 1e-6), np.nan)
    axes = figure.subplots()
    axes.pcolormesh(x, y, sticks, cmap="Greys", vmin=-0.5, vmax=3)
    arrows = [np.where(inside, q, np.nan)[some] * 1e-6 for q in (qx, qy)]
    drawn = axes.quiver(x[2::5], y[2::5], *arrows)
    axes.quiverkey(drawn, 1.2, 0.88, 300, "q = 300 MPa", labelpos="E")
    axes.text(1.06, 0.7, "darker: stick", transform=axes.transAxes)
    axes.set_aspect("equal")
    axes.set_xlabel("x, mm, rolling to the right")
    axes.set_ylabel("y, mm")

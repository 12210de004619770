"""A punch with a flat base and a rounded edge: N and M_y, then T_x and M_z together."""

import halfspace
import numpy as np
import steps
from common import all_covered

import petsam

N, TILTING, FORCE, TORQUE, FRICTION, YOUNG, POISSON = 1e6, 5e3, 5e4, 800.0, 0.1, 210e9, 0.3
FLAT, EDGE, SIZE = 0.02, 0.2, 0.054
OPTIONS = {
    "grid_size": SIZE,
    **{f"body{body}_young": YOUNG for body in (1, 2)},
    **{f"body{body}_poisson": POISSON for body in (1, 2)},
    "friction": FRICTION,
    "gap_type": "punch",
    "gap_flat_radius": FLAT,
    "gap_edge_radius": EDGE,
    "load_n": N,
    "load_my": TILTING,
    "history": {"time": [0, 1], "load_tx": [0, FORCE], "load_mz": [0, TORQUE]},
    "output_every": 1000,
}
OF_PRESSURE = {"approach": "m", "tilt": "rad", "pressure_max": "Pa"}
OF_SHEAR = {"displacement": "m", "twist": "rad", "stick_area": "m2", "dissipated_energy": "J"}
STEPS = 4, 8, 16  # of petsam; those of halfspace.py are of first order, and need more


def numbers(results):
    last = {name: values[-1] for name, values in results.history.items()}
    return {
        "approach": last["disp_z"],
        "tilt": last["rot_y"],
        "pressure_max": last["pressure_max"],
        "displacement": last["disp_x"],
        "twist": last["rot_z"],
        "stick_area": last["stick_area"],
        "dissipated_energy": np.nansum(results.history["dissipated_energy"]),
    }


def own_pressure(cells):
    grid = halfspace.Grid(cells, SIZE, SIZE, YOUNG, POISSON)
    gap = np.maximum(np.hypot(grid.X, grid.Y) - FLAT, 0) ** 2 / (2 * EDGE)
    return grid, *halfspace.pressure(grid, gap, N, TILTING)


def own_shear(solved, count):
    """The same by halfspace.py, from its pressure on."""
    grid, p, _, _ = solved
    shear = halfspace.Shear(grid, FRICTION * p, torsion=True)
    energy = sum(shear.step(np.array([FORCE, 0, TORQUE]) * (k + 1) / count) for k in range(count))
    return {
        "displacement": shear.rigid[0],
        "twist": shear.rigid[2],
        "stick_area": shear.stick_area(),
        "dissipated_energy": energy,
    }


def evidence():
    # the pressure does not depend on the steps
    one = [numbers(petsam.run(OPTIONS, grid_n=n)) for n in (128, 256, 512)]
    solved = {n: own_pressure(n) for n in (24, 48, 96, 192)}
    two = [dict(zip(OF_PRESSURE, (a, b, p.max()))) for _, p, a, b in (solved[n] for n in (48, 96, 192))]
    ways = {"petsam, 128, 256, 512 cells": one, "halfspace.py, 48, 96, 192 cells": two}
    found = all_covered(OF_PRESSURE, ways)
    one = [steps.limits(lambda m, n=n: numbers(petsam.run(OPTIONS, grid_n=n, steps=m)), STEPS) for n in (64, 128, 256)]
    two = [steps.limits(lambda m, n=n: own_shear(solved[n], m)) for n in (24, 48, 96)]
    return found + all_covered(OF_SHEAR, steps.ways(one, two, "24, 48, 96", STEPS))


def answers():
    return numbers(petsam.run(OPTIONS, grid_n=256, steps=8))


def draw(figure):
    results = petsam.run(OPTIONS, grid_n=96, steps=4)
    left, right = figure.subplots(1, 2, width_ratios=(1, 1.25))
    x, y = results.x * 1e3, results.y * 1e3
    left.plot(x, results["pressure"][-1][len(y) // 2] * 1e-6)
    left.set(xlabel="x, mm", ylabel="p on y = 0, MPa", ylim=(0, None))
    qx, qy = results["shear_x"][-1], results["shear_y"][-1]
    state = results["state"][-1]
    image = right.contourf(x, y, np.where(state > 0, np.hypot(qx, qy) * 1e-6, np.nan), 8)
    every = slice(4, None, 10)
    right.quiver(x[every], y[every], qx[every, every], qy[every, every], color="white")
    right.contour(x, y, state == 1, [0.5], colors="k", linewidths=0.8)
    figure.colorbar(image, ax=right, label="|q|, MPa")
    right.set(xlabel="x, mm", ylabel="y, mm", aspect="equal")

"""A steel sphere on a plastic plane: loaded, then unloaded to half of the load."""

import functools

import numpy as np
from common import all_covered
from rings import press
from unloading import Unloading

import petsam

FULL, HALF, RADIUS, FRICTION = 20.0, 10.0, 0.01, 0.15
YOUNG, POISSON = np.array([210e9, 3e9]), np.array([0.3, 0.35])  # sphere, plane
MODULUS = 1 / np.sum((1 - POISSON**2) / YOUNG)
COMPLIANCE = (1 + POISSON) * (1 - 2 * POISSON) / YOUNG
BETA = MODULUS / 2 * (COMPLIANCE[1] - COMPLIANCE[0])
OPTIONS = {
    "grid_size": 7.4e-4,
    **{f"body{body}_young": YOUNG[body - 1] for body in (1, 2)},
    **{f"body{body}_poisson": POISSON[body - 1] for body in (1, 2)},
    "gap_type": "sphere",
    "gap_radius1": RADIUS,
    "gap_radius2": "inf",
    "friction": FRICTION,
    "output_every": 1000,
}
UNITS = {
    "approach": "m",
    "contact_radius": "m",
    "shear_max": "Pa",
    "reversal_radius": "m",
    "half_force": "N",
    "dissipated_unloading": "J",
}


@functools.lru_cache
def solve(cells, steps):
    """Steps of loading, short where N is small, then as many of unloading."""
    up = FULL * np.linspace(0, 1, steps + 1)[1:] ** 2
    down = np.linspace(FULL, HALF, steps + 1)[1:]
    return petsam.run(OPTIONS, ranks=1, grid_n=cells, history={"load_n": np.append(up, down)})


def radial(results):
    """Radius, p and outward q of all cells at the end."""
    x, y = np.meshgrid(results.x, results.y)
    r = np.hypot(x, y)
    q = (x * results["shear_x"][-1] + y * results["shear_y"][-1]) / r
    return r, results["pressure"][-1], q


def numbers(results):
    history = results.history
    r, p, q = radial(results)
    near = (np.abs(q) < FRICTION / 2 * p) & (r > 0.8 * np.sqrt(history["contact_area"][-1] / np.pi))
    area = (results.x[1] - results.x[0]) ** 2
    return {
        "approach": history["disp_z"][-1],
        "contact_radius": np.sqrt(history["contact_area"][-1] / np.pi),
        "shear_max": history["shear_max"][-1],
        "reversal_radius": np.polyfit(q[near] * 1e-6, r[near], 2)[-1],  # r by q is smooth there
        "half_force": results["shear_x"][-1][:, results.x > 0].sum() * area,
        "dissipated_unloading": history["dissipated_energy"][np.argmax(history["load_n"]) + 1 :].sum(),
    }


@functools.lru_cache
def rings(n):
    """The states at full load and after 2 n/5 steps of unloading, the radius at full load, the numbers in SI units."""
    full = press(2 * n, FRICTION, BETA)
    state, steps = Unloading(n, FRICTION, BETA, full), 2 * n // 5
    for k in range(1, steps + 1):
        state.step(full.force * (1 + (HALF / FULL - 1) * k / steps))
    a = (2 * FULL * RADIUS / (MODULUS * full.force)) ** (1 / 3)
    stress = MODULUS * a / (2 * RADIUS)
    found = (
        a**2 / RADIUS * state.d,
        a * state.contact_radius(),
        stress * state.shear_max(),
        a * state.reversal_radius(),
        stress * a**2 / np.pi * np.sum(state.q * state.area),
        stress * a**4 / RADIUS * state.energy,
    )
    return full, state, a, dict(zip(UNITS, found))


def evidence():
    ours = [numbers(solve(cells, steps)) for cells, steps in ((64, 16), (128, 32), (256, 64))]
    others = [rings(n)[-1] for n in (50, 100, 200, 400)]
    ways = {
        "petsam, 64, 128, 256 cells, 16, 32, 64 steps up and as many down": ours,
        "50, 100, 200, 400 rings, 20, 40, 80, 160 steps down": others,
    }
    return all_covered(UNITS, ways)


def answers():
    return numbers(solve(160, 48))


def draw(figure):
    figure.set_size_inches(6.8, 3.1)
    axes = figure.subplots()
    results = solve(160, 48)
    full, state, a, _ = rings(200)
    unit = MODULUS * a / (2 * RADIUS) * 1e-6
    r, bound = state.r[: state.k] * a * 1e3, FRICTION * state.p[: state.k] * unit
    axes.plot(r, bound, lw=0.8, color="0.5", label=r"$\pm\mu p$")
    axes.plot(r, -bound, lw=0.8, color="0.5")
    axes.plot(r, state.q[: state.k] * unit, label="outward q on the plane, rings")
    axes.plot(full.r * a * 1e3, full.q * unit, "--", lw=0.9, label="outward q at full load")
    row = len(results.y) // 2
    shown = (results.x > 0) & (results["pressure"][-1][row] > 0)
    axes.plot(results.x[shown] * 1e3, results["shear_x"][-1][row][shown] * 1e-6, "k.", ms=3, label="petsam, 160 cells")
    changes = np.flatnonzero(np.diff(state.status[: state.k])) + 1
    for at, name in zip(np.append(0, changes), ("sticks", "slips", "sticks", "slips back")):
        axes.text((at / state.n + 0.01) * a * 1e3, 1.1 * bound.max(), name, fontsize="x-small")
    for at in changes:
        axes.axvline(at / state.n * a * 1e3, lw=0.5, color="0.7")
    axes.set_xlabel("r, mm")
    axes.set_ylabel("shear, MPa")
    axes.set_xlim(0)
    axes.set_ylim(-1.1 * bound.max(), 1.25 * bound.max())
    figure.legend(*axes.get_legend_handles_labels(), fontsize="x-small", loc="outside right center")

"""A sphere pressed on a rigid flat with friction: Spence."""

import functools

import numpy as np
from common import all_covered
from rings import press, pressing_energy

import petsam

N, RADIUS, YOUNG, POISSON, FRICTION = 1000.0, 0.1, 210e9, 0.3, 0.15
MODULUS = YOUNG / (1 - POISSON**2)
BETA = (1 - 2 * POISSON) / (2 - 2 * POISSON)
OPTIONS = {
    "grid_size": 1.8e-3,
    "body1_young": YOUNG,
    "body1_poisson": POISSON,
    "body2_young": "inf",
    "gap_type": "sphere",
    "gap_radius1": RADIUS,
    "gap_radius2": "inf",
    "friction": FRICTION,
    "load_n": N,
    "output_every": 1000,
}
UNITS = {"contact_radius": "m", "stick_radius": "m", "approach": "m", "shear_max": "Pa", "dissipated_energy": "J"}


@functools.lru_cache
def solve(cells, steps):
    return petsam.run({**OPTIONS, "grid_n": cells, "steps": steps})


def numbers(results):
    history = results.history
    last = {name: values[-1] for name, values in history.items()}
    return {
        "contact_radius": np.sqrt(last["contact_area"] / np.pi),
        "stick_radius": np.sqrt(last["stick_area"] / np.pi),
        "approach": last["disp_z"],
        "shear_max": last["shear_max"],
        "dissipated_energy": history["dissipated_energy"].sum(),
    }


@functools.lru_cache
def rings(n):
    """The state of n rings and its numbers in SI units."""
    state = press(n, FRICTION, BETA)
    a = (2 * N * RADIUS / (MODULUS * state.force)) ** (1 / 3)
    found = a, a * state.stick, a**2 / RADIUS * state.approach, MODULUS * a / (2 * RADIUS) * state.q.max()
    energy = MODULUS * a**5 / (2 * RADIUS**2) * pressing_energy(state, FRICTION)
    return state, dict(zip(UNITS, (*found, energy)))


def evidence():
    ours = [numbers(solve(cells, steps)) for cells, steps in ((96, 20), (192, 40), (384, 80))]
    others = [rings(n)[1] for n in (40, 80, 160, 320)]
    ways = {
        "petsam, 96, 192, 384 cells, 20, 40, 80 steps": ours,
        "axisymmetric equations, 40, 80, 160, 320 rings": others,
    }
    return all_covered(UNITS, ways)


def answers():
    return numbers(solve(128, 40))


def draw(figure):
    figure.set_size_inches(5.2, 2.9)
    axes = figure.subplots()
    results = solve(128, 40)
    row, half = len(results.y) // 2, results.x > 0
    state, found = rings(160)
    unit = MODULUS * found["contact_radius"] / (2 * RADIUS) * 1e-6
    axes.plot(state.r * found["contact_radius"] * 1e3, FRICTION * state.p * unit, label=r"$\mu p$")
    axes.plot(state.r * found["contact_radius"] * 1e3, state.q * unit, label="outward q on the sphere")
    cells = np.abs(results["shear_x"][-1][row][half]) * 1e-6
    axes.plot(results.x[half][:50:2] * 1e3, cells[:50:2], "k.", ms=3, label="q, petsam, 128 cells")
    axes.axvline(found["stick_radius"] * 1e3, lw=0.6, color="0.5")
    axes.set_xlabel("r, mm")
    axes.set_ylabel("shear, MPa")
    axes.set_ylim(0)
    axes.legend(loc="upper right")

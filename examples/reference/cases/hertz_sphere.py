"""Two spheres pressed together: Hertz."""

import mpmath as mp
import numpy as np
from common import closed

import petsam

N, RADIUS, YOUNG, POISSON = "1000", "0.2", "210e9", "0.3"  # decimal, so that mpmath reads them exactly
OPTIONS = {
    "grid_n": 512,
    "grid_size": 2.6e-3,
    **{f"body{body}_young": YOUNG for body in (1, 2)},
    **{f"body{body}_poisson": POISSON for body in (1, 2)},
    "gap_type": "sphere",
    "gap_radius1": RADIUS,
    "gap_radius2": RADIUS,
    "load_n": N,
}


def solve(**more):
    return petsam.run(OPTIONS, **more)


def evidence():
    """Johnson, Contact Mechanics (1985), eqs 4.22 to 4.24, in 30 digits."""
    with mp.workdps(30):
        n, radius = mp.mpf(N), mp.mpf(RADIUS) / 2
        e_star = mp.mpf(YOUNG) / (1 - mp.mpf(POISSON) ** 2) / 2
        a = mp.cbrt(3 * n * radius / (4 * e_star))
        how = "closed form (Johnson, Contact Mechanics, eqs 4.22 to 4.24), mpmath, 30 digits"
        return [
            closed("contact_radius", "m", a, how),
            closed("pressure_max", "Pa", 3 * n / (2 * mp.pi * a**2), how),
            closed("approach", "m", a**2 / radius, how),
            closed("elastic_energy", "J", n * a**2 / radius * 2 / 5, how),
        ]


def answers():
    last = {name: values[-1] for name, values in solve().history.items()}
    return {
        "contact_radius": np.sqrt(last["contact_area"] / np.pi),
        "pressure_max": last["pressure_max"],
        "approach": last["disp_z"],
        "elastic_energy": last["stored_energy"],
    }


def draw(figure):
    axes = figure.subplots()
    results = solve()
    axes.plot(results.x * 1e3, results["pressure"][-1][len(results.y) // 2] * 1e-6)
    axes.set_xlabel("x, mm")
    axes.set_ylabel("p, MPa")

"""A sphere under constant normal and alternating tangential force: Cattaneo and Mindlin."""

import mpmath as mp
import numpy as np
from common import closed

import petsam

N, T, RADIUS, YOUNG, FRICTION = "500", "150", "0.1", "200e9", "0.5"  # decimal, so that mpmath reads them exactly
OPTIONS = {
    "grid_n": 256,
    "grid_size": 1.8e-3,
    **{f"body{body}_young": YOUNG for body in (1, 2)},
    **{f"body{body}_poisson": 0 for body in (1, 2)},
    "gap_type": "sphere",
    "gap_radius1": RADIUS,
    "gap_radius2": "inf",
    "friction": FRICTION,
    "load_n": N,
}


def solve():
    return petsam.run(OPTIONS, history={"load_tx": [0, float(T), 0, -float(T), float(T)]})


def evidence():
    """Johnson, Contact Mechanics (1985), sections 7.2 and 7.4, and eq 3.42 for the slip at the edge, in 30 digits.

    With nu = 0 the tangential compliance is the normal one, 1/E* = 1/G.
    """
    with mp.workdps(30):
        n, t, radius, mu = mp.mpf(N), mp.mpf(T), mp.mpf(RADIUS), mp.mpf(FRICTION)
        e_star = mp.mpf(YOUNG) / 2
        a = mp.cbrt(3 * n * radius / (4 * e_star))
        part = t / (mu * n)
        c = a * mp.cbrt(1 - part)
        pressure = 3 * n / (2 * mp.pi * a**2)
        gross = mu * a**2 / radius

        def displacement(share):
            return gross * (1 - mp.cbrt((1 - share) ** 2))

        def lift(r):  # displacement outside of a Hertzian contact of radius c
            return ((2 * c**2 - r**2) * mp.asin(c / r) + r * c * mp.sqrt(1 - c**2 / r**2)) / (mp.pi * radius)

        slip = displacement(part) - mu * (a**2 / (2 * radius) - lift(a))
        # integral of the loop between its branches: d = d_turn - 2 displacement((T_turn - T)/2)
        rest = mp.cbrt((1 - part) ** 2)
        loop = mu * n * gross * (mp.mpf(24) / 5 * (1 - rest * (1 - part)) - 4 * part * (1 + rest))
        branch = mp.quad(lambda share: 2 * displacement((part - share) / 2), [-part, 0, part])
        assert abs(loop / (mu * n * (4 * part * displacement(part) - 2 * branch)) - 1) < 1e-9
        how = "closed form (Johnson, Contact Mechanics, sections 7.2 and 7.4), mpmath, 30 digits"
        return [
            closed("displacement", "m", displacement(part), how),
            closed("displacement_unloaded", "m", displacement(part) - 2 * displacement(part / 2), how),
            closed("stick_radius", "m", c, how),
            closed("shear_max", "Pa", mu * pressure * mp.sqrt(1 - c**2 / a**2), how),
            closed("slip_max", "m", slip, how),
            closed("loop_energy", "J", loop, how),
        ]


def answers():
    h = solve().history
    return {
        "displacement": h["disp_x"][1],
        "displacement_unloaded": h["disp_x"][2],
        "stick_radius": np.sqrt(h["stick_area"][1] / np.pi),
        "shear_max": h["shear_max"][1],
        "slip_max": h["slip_max"][1],
        "loop_energy": np.sum(h["dissipated_energy"][2:]),
    }


def draw(figure):
    results = solve()
    left, right = figure.subplots(1, 2)
    for step, text in ((1, "T = 150 N"), (2, "T = 0"), (3, "T = -150 N")):
        left.plot(results.x * 1e3, results["shear_x"][step][len(results.y) // 2] * 1e-6, label=text)
    left.set_xlabel("x, mm")
    left.set_ylabel("$q_x$, MPa")
    left.set_ylim(-170, 320)
    left.legend(loc="upper center", fontsize="x-small")
    turns = np.array([1, -1, 1]) * float(T)
    loads = np.concatenate([np.linspace(a, b, 41)[1:] for a, b in zip([0, *turns], turns)])
    loop = petsam.run(OPTIONS, grid_n=128, output_fields="none", history={"load_tx": [0, *loads]}).history
    right.plot(loop["disp_x"] * 1e6, loop["load_tx"])
    right.set_xlabel("$d_x$, µm")
    right.set_ylabel("T, N")

"""A cylindrical pad on a flat with bulk stress: Nowell and Hills' problem with slip to both sides."""

import numpy as np
from common import all_covered
from scipy.optimize import fsolve

import petsam

N, SHEAR, BULK, RADIUS, YOUNG, POISSON, FRICTION = 2e5, 4e4, 2e8, 50e-3, 115e9, 0.32, 0.5
OPTIONS = {
    "elasticity": "plane",
    "grid_n": 512,
    "grid_size": 1.2e-3,
    **{f"body{body}_young": YOUNG for body in (1, 2)},
    **{f"body{body}_poisson": POISSON for body in (1, 2)},
    "gap_type": "ellipsoid",
    "gap_radius_x": RADIUS,
    "gap_radius_y": "inf",
    "friction": FRICTION,
}
HISTORY = {"load_n": [N, N], "load_tx": [0, SHEAR], "bulk2_stress_xx": [0, BULK]}
E_STAR = YOUNG / (1 - POISSON**2) / 2
A = np.sqrt(4 * N * RADIUS / (np.pi * E_STAR))
Q0 = FRICTION * 2 * N / (np.pi * A)  # mu times the maximum pressure
UNITS = {
    "stick_left": "m",
    "stick_right": "m",
    "shear_max": "Pa",
    "shear_centre": "Pa",
    "slip_left": "m",
    "dissipated_energy": "J/m",
}

# ---------------------------------------------------------------- integral equation; lengths over a, shear over Q0


def share(phi):
    """Integral of w = sqrt(1 - s^2) from cos(phi) to 1."""
    return (phi - np.sin(phi) * np.cos(phi)) / 2


def cauchy(x, phi):
    """pv integrals of w/(x - s) and s w/(x - s) from cos(phi) to 1, -1 < x < 1."""
    theta = np.arccos(x)
    logarithm = np.log(np.abs(np.sin((phi - theta) / 2) / np.sin((phi + theta) / 2)))
    zeroth = np.sin(phi) + x * phi + np.sin(theta) * logarithm
    return zeroth, x * zeroth - share(phi)


def known(x, k1, k2):
    """What the unknown part of the shear has to give: pi s_b/4 less the pv integral of w G, where G is 1 up to k1,
    -1 from k2 on and linear between."""
    slope = -2 / (k2 - k1)
    left, right = cauchy(x, np.arccos(k1)), cauchy(x, np.arccos(k2))
    linear = (1 - slope * k1) * (left[0] - right[0]) + slope * (left[1] - right[1])
    return np.pi * BULK / (4 * Q0) - (np.pi * x - left[0] - right[0] + linear)


def nodes(n, k1, k2):
    """Angles t of Gauss-Chebyshev's rule and x = (k1 + k2)/2 + (k2 - k1)/2 cos(t)."""
    t = (np.arange(n) + 0.5) * np.pi / n
    return t, (k1 + k2) / 2 + (k2 - k1) / 2 * np.cos(t)


def conditions(ends, n):
    """Bounded at both ends; the sum of the shear."""
    k1, k2 = ends
    t, x = nodes(n, k1, k2)
    right = known(x, k1, k2)
    unknown = (k2 - k1) / 2 * np.mean(right * np.cos(t))
    phi1, phi2, slope = np.arccos(k1), np.arccos(k2), -2 / (k2 - k1)
    first = (np.sin(phi2) ** 3 - np.sin(phi1) ** 3) / -3  # integral of s w from k1 to k2
    between = (1 - slope * k1) * (share(phi1) - share(phi2)) + slope * first
    total = share(np.pi) - share(phi1) - share(phi2) + between + unknown
    return [np.mean(right), total - SHEAR / (Q0 * A)]


def by_equation(n):
    """All quantities from n nodes in the stick zone and in each slip zone."""
    k1, k2 = fsolve(conditions, [-0.4, 0.9], args=(n,), xtol=1e-13)
    middle, half = (k1 + k2) / 2, (k2 - k1) / 2
    t, x = nodes(n, k1, k2)
    order = np.arange(1, n)
    series = 2 / np.pi * np.mean(known(x, k1, k2) * np.cos(order[:, None] * t), axis=1)

    def slip_zone(end, side):
        """The slip at this end of the contact, and the work of friction between it and the stick zone."""
        u, weight = np.polynomial.legendre.leggauss(n)
        u, weight = (u + 1) / 2, weight / 2
        y = end + (side - end) * u**2
        decay = side * (y - middle) / half
        decay = decay - np.sqrt(decay**2 - 1)
        unknown = np.pi * (side * decay[:, None]) ** order @ series
        strain = 2 / np.pi * np.abs(known(y, k1, k2) - unknown) * 2 * abs(side - end) * u * weight
        beyond = share(np.arccos(side * y))
        return np.sum(strain), np.sum(strain * beyond)

    left, right = slip_zone(k1, -1), slip_zone(k2, 1)
    at_0 = np.arccos(-middle / half)
    centre = 1 - 2 * (0 - k1) / (k2 - k1) + series @ np.sin(order * at_0)
    return {
        "stick_left": k1 * A,
        "stick_right": k2 * A,
        "shear_max": np.sqrt(1 - k1**2) * Q0,
        "shear_centre": centre * Q0,
        "slip_left": left[0] * A * Q0 / E_STAR,
        "dissipated_energy": (left[1] + right[1]) * (A * Q0) ** 2 / E_STAR,
    }


# ---------------------------------------------------------------- petsam


def solve(**more):
    return petsam.run(OPTIONS, history=HISTORY, output_fields="usual,contact_edge,stick_edge", **more)


def by_cells(**more):
    results = solve(**more)
    history, stick = results.history, results.edge("stick_edge")[:, 0]
    middle = len(results.x) // 2
    return {
        "stick_left": stick.min(),
        "stick_right": stick.max(),
        "shear_max": history["shear_max"][-1],
        "shear_centre": results["shear_x"][-1][0, middle - 1 : middle + 1].mean(),
        "slip_left": history["slip_max"][-1],
        "dissipated_energy": history["dissipated_energy"].sum(),
    }


def evidence():
    equation = [by_equation(n) for n in (64, 128, 256, 512)]
    cells = [by_cells(grid_n=n) for n in (1024, 2048, 4096, 8192)]
    ways = {"integral equation, 64 to 512 nodes": equation, "petsam, 1024 to 8192 cells": cells}
    return all_covered(UNITS, ways)


def answers():
    return by_cells()


def draw(figure):
    axes = figure.subplots()
    results = solve()
    x, bound = results.x * 1e3, FRICTION * results["pressure"][-1][0] * 1e-6
    axes.plot(x, bound, "--", color="C0", label=r"$\mu p$")
    axes.plot(x, -bound, "--", color="C0")
    axes.plot(x, results["shear_x"][-1][0] * 1e-6, color="C1", label="q")
    axes.set_xlabel("x, mm")
    axes.set_ylabel("shear, MPa")
    axes.set_xlim(-0.5, 0.5)
    axes.set_yticks([-100, 0, 100])
    axes.legend()

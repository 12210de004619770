"""Stress below a sphere that slides."""

import subprocess
import tempfile
from pathlib import Path

import mpmath as mp
import numpy as np
from common import all_covered, closed

import petsam

N, RADIUS, YOUNG, POISSON, FRICTION = "1000", "0.1", "210e9", "0.3", "0.4"  # decimal, so that mpmath reads them exactly
DEPTHS = (1e-4, 4e-4)  # m
OPTIONS = {
    "grid_size": 3.6e-3,
    **{f"body{body}_young": YOUNG for body in (1, 2)},
    **{f"body{body}_poisson": POISSON for body in (1, 2)},
    "gap_type": "sphere",
    "gap_radius1": RADIUS,
    "gap_radius2": "inf",
    "friction": FRICTION,
}


def contact():
    """Radius of the contact and maximum pressure (Hertz), in 30 digits."""
    with mp.workdps(30):
        n, e_star = mp.mpf(N), mp.mpf(YOUNG) / (1 - mp.mpf(POISSON) ** 2) / 2
        a = mp.cbrt(3 * n * mp.mpf(RADIUS) / (4 * e_star))
        return a, 3 * n / (2 * mp.pi * a**2)


def stress(x, z, points):
    """Stresses xx, yy, zz, xz in the plane y = 0 at x and depth z: point forces (Johnson, eqs 3.18 and 3.75)
    summed over the contact, Gauss's points in the angle of sqrt(1 - r^2/a^2), equal steps around."""
    a, p0 = (float(value) for value in contact())
    nu, mu = float(POISSON), float(FRICTION)
    nodes, weights = np.polynomial.legendre.leggauss(points)
    angle = (nodes + 1) * np.pi / 4
    around = (np.arange(2 * points) + 0.5) * np.pi / points
    r = a * np.sin(angle)[:, None]
    area = (weights * np.pi / 4 * a * np.cos(angle))[:, None] * r * (np.pi / points)
    force = (p0 * np.cos(angle)[:, None] * area * np.ones(2 * points)).ravel()
    xi, eta = (r * np.cos(around)).ravel(), (r * np.sin(around)).ravel()
    found = []
    for place in np.atleast_1d(x):
        dx, dy = place - xi, -eta
        flat = dx**2 + dy**2
        rho = np.sqrt(flat + z**2)
        part = (1 - 2 * nu) / flat
        turn = (1 - z / rho) * (dx**2 - dy**2) / flat + z * dy**2 / rho**3
        back = (1 - z / rho) * (dy**2 - dx**2) / flat + z * dx**2 / rho**3
        one, two = 1 / (rho * (rho + z) ** 2), (3 * rho + z) / (rho**3 * (rho + z) ** 3)
        normal = (
            part * turn - 3 * z * dx**2 / rho**5,
            part * back - 3 * z * dy**2 / rho**5,
            -3 * z**3 / rho**5,
            -3 * z**2 * dx / rho**5,
        )
        k = 1 - 2 * nu
        shear = (
            -3 * dx**3 / rho**5 + k * (dx / rho**3 - 3 * dx * one + dx**3 * two),
            -3 * dx * dy**2 / rho**5 + k * (dx / rho**3 - dx * one + dx * dy**2 * two),
            -3 * dx * z**2 / rho**5,
            -3 * dx**2 * z / rho**5,
        )
        found.append([np.sum(force * (p + mu * q)) / (2 * np.pi) for p, q in zip(normal, shear)])
    return np.array(found).T


def mises(s):
    xx, yy, zz, xz = s
    return np.sqrt(((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2) / 2 + 3 * xz**2)


def swt(s):
    """Smith, Watson and Topper's parameter of states in y = 0: all normals by 2 degrees, then refined."""
    xx, yy, zz, xz = s
    nu, trace = float(POISSON), xx + yy + zz

    def of(angle, tilt):  # tilt: out of the plane y = 0
        c, d, e = np.cos(tilt) * np.cos(angle), np.sin(tilt), np.cos(tilt) * np.sin(angle)
        sn = c**2 * xx + d**2 * yy + e**2 * zz + 2 * c * e * xz
        strain = ((1 + nu) * sn - nu * trace) / float(YOUNG)
        return max(sn.max(), 0) * np.ptp(strain) / 2

    step, best = np.pi / 90, (0.0, 0.0)
    near = [(i * step, j * step) for i in range(-45, 45) for j in range(46)]
    for _ in range(14):
        best = max(near, key=lambda at: of(*at))
        step /= 2
        near = [(best[0] + i * step, best[1] + j * step) for i in (-1, 0, 1) for j in (-1, 0, 1)]
    return of(*max(near, key=lambda at: of(*at)))


def solve(cells):
    """The stresses below the sliding sphere in the plane y = 0 and the parameter of points that pass."""
    with petsam.Contact(**OPTIONS, grid_n=cells) as sphere:
        sphere.try_step(load_n=float(N), disp_x=1e-3)
        sphere.commit()
        x = (np.arange(cells) + 0.5 - cells / 2) * OPTIONS["grid_size"] / cells
        found = sphere.stress(depths=list(DEPTHS), section="y=0", quantities=("stress", "mises"))
        sphere.record()
        sphere.try_step(load_n=float(N), disp_x=2e-3)
        sphere.commit()
        passing = sphere.fatigue("swt", depths=DEPTHS[0], section="y=0", passing=True)
    return x, found, passing["swt"].max()


def numbers(cells):
    _, found, parameter = solve(cells)
    return {
        "mises_deep": peak(found["mises"][0, 1, 0]),
        "tension_shallow": peak(found["stress_xx"][0, 0, 0]),
        "swt_shallow": parameter,
    }


def peak(values):
    """Maximum of a smooth curve: of the parabola through the largest value and its neighbors."""
    at = int(np.argmax(values))
    one, two, three = values[at - 1 : at + 2]
    return two + (one - three) ** 2 / (8 * (2 * two - one - three))


def summed(cells):
    """The numbers by summed point forces, with so many states of the passing point."""
    x = np.linspace(-1.8e-3, 1.8e-3, cells + 1)
    shallow, deep = stress(x, DEPTHS[0], 100), stress(x, DEPTHS[1], 60)
    far = np.zeros((4, 1))
    return {
        "mises_deep": peak(mises(deep)),
        "tension_shallow": peak(shallow[0]),
        "swt_shallow": swt(np.hstack([shallow, far])),
    }


def evidence():
    grids = (129, 257, 513)
    own, other = [summed(cells) for cells in (180, 360, 720)], [numbers(cells) for cells in grids]
    with mp.workdps(30):
        p0, nu, mu = contact()[1], mp.mpf(POISSON), mp.mpf(FRICTION)
        edge = p0 * ((1 - 2 * nu) / 3 + mu * mp.pi * (4 + nu) / 8)
    ways = {"sum of point forces, 180, 360, 720 states": own, "petsam, 129, 257, 513 cells": other}
    how = "closed form (Hamilton and Goodman 1966), mpmath, 30 digits"
    return [closed("tension_edge", "Pa", edge, how), *all_covered(dict.fromkeys(own[0], "Pa"), ways)]


def tension_edge(cells):
    """The largest stress_xx of the contact's edge, as petsam-stress finds it."""
    with tempfile.TemporaryDirectory() as folder:
        contact, stresses = Path(folder) / "contact.h5", Path(folder) / "stresses.h5"
        petsam.run(OPTIONS, grid_n=cells, load_n=float(N), disp_x=1e-3, output=contact)
        program = Path(petsam.core.environment.petsam()).with_name("petsam-stress")
        words = ["-input", contact, "-output", stresses, "-depths", "0", "-quiet"]
        subprocess.run([program, *words], check=True)
        return petsam.open(stresses).history["edge_stress_xx_max"][-1]


def answers():
    return {"tension_edge": tension_edge(257), **numbers(257)}


def draw(figure):
    left, right = figure.subplots(1, 2)
    x, found, _ = solve(257)
    for row, depth in enumerate(DEPTHS):
        left.plot(x * 1e3, found["stress_xx"][0, row, 0] * 1e-6, label=f"z = {depth * 1e3:.1f} mm")
        right.plot(x * 1e3, found["mises"][0, row, 0] * 1e-6, label=f"z = {depth * 1e3:.1f} mm")
    for axes, name in ((left, r"$\sigma_{xx}$, MPa"), (right, "von Mises stress, MPa")):
        axes.set_xlabel("x, mm")
        axes.set_ylabel(name)
        axes.legend()

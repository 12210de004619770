"""Two spheres that roll with creepages and spin, in steady state."""

import functools

import numpy as np
from common import all_covered
from scipy.sparse.linalg import LinearOperator, gmres

import petsam

N, RADIUS, YOUNG, POISSON, FRICTION = 50.0, 0.02, 210e9, 0.28, 0.3
XI, ETA, SPIN = 2e-3, 1e-3, 15.0
OPTIONS = {
    "grid_size": 3.4e-4,
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
def solve(cells):
    return petsam.run({**OPTIONS, "grid_n": cells})


def numbers(results, end=""):
    last = {name: values[-1] for name, values in results.history.items()}
    tx, ty, mz = (last[f"load_{name}{end}"] for name in ("tx", "ty", "mz"))
    return dict(zip(UNITS, (tx, ty, mz, last["stick_area"], XI * tx + ETA * ty + SPIN * mz)))


def corners(n, d, function):
    """Integrals over a cell, at distances of -n to n cells, of what has this antiderivative."""
    x = d * (np.arange(-n, n + 2) - 0.5)
    f = function(x[None, :], x[:, None])
    return f[1:, 1:] - f[1:, :-1] - f[:-1, 1:] + f[:-1, :-1]


def convolution(kernel, n):
    """The function that applies a kernel, as of corners(), to n x n cells."""
    size = 3 * n
    spectrum = np.fft.rfft2(kernel, (size, size))
    return lambda q: np.fft.irfft2(spectrum * np.fft.rfft2(q, (size, size)), (size, size))[n : 2 * n, n : 2 * n]


def slip_matrix(n, d, inside):
    """q -> (u(x) - u(x + d))/d of the cells inside, and its diagonal; material enters at large x.

    Cerruti: u_2 - u_1 is (1 - nu)/(pi G) times the sum of q/r, and nu/(pi G) times that of (x^2, xy, y^2)/r^3.
    """
    shear = YOUNG / (2 + 2 * POISSON)
    along = corners(n, d, lambda x, y: y * np.arcsinh(x / np.abs(y)))  # of x^2/r^3
    across, cross = along.T, corners(n, d, lambda x, y: -np.hypot(x, y))
    whole, part = (1 - POISSON) / (np.pi * shear), POISSON / (np.pi * shear)
    kernels = (whole * (along + across) + part * along, part * cross, whole * (along + across) + part * across)
    kernels = [(k - np.pad(k, ((0, 0), (0, 1)))[:, 1:]) / d for k in kernels]
    xx, xy, yy = (convolution(k, n) for k in kernels)

    def product(q):
        fields = np.zeros((2, n, n))
        fields[:, inside] = q
        return np.array([(xx(fields[0]) + xy(fields[1]))[inside], (xy(fields[0]) + yy(fields[1]))[inside]])

    return product, kernels[0][n, n]


def rolls(n):
    """Steady rolling under Hertz's pressure on n x n cells: complementarity by Newton's method with GMRES."""
    e_star = YOUNG / (2 - 2 * POISSON**2)
    a = np.cbrt(0.75 * N * RADIUS / 2 / e_star)
    d = 2 * a / n
    x, y = np.meshgrid(*2 * [d * (np.arange(n) - (n - 1) / 2)])
    inside = np.hypot(x, y) < a
    x, y = x[inside], y[inside]
    bound = np.sqrt(1 - (x**2 + y**2) / a**2)
    bound *= FRICTION * N / (bound.sum() * d**2)
    product, diagonal = slip_matrix(n, d, inside)
    w, c, q = np.array([XI - SPIN * y, ETA + SPIN * x]), 1 / diagonal, np.zeros((2, x.size))
    for _ in range(60):
        slip = product(q) - w
        z = q - c * slip
        size = np.maximum(np.hypot(*z), 1e-300)
        stick, e = size <= bound, z / size
        residual = np.where(stick, c * slip, q - bound * e)
        if np.linalg.norm(residual) < 1e-6 * np.linalg.norm(bound):
            break
        turn = bound / size

        def derivative(v, stick=stick, e=e, turn=turn):
            v = v.reshape(2, -1)
            z = v - c * product(v)
            return np.where(stick, v - z, v - turn * (z - e * np.sum(e * z, axis=0))).ravel()

        matrix = LinearOperator(2 * (q.size,), matvec=derivative)
        q = q + gmres(matrix, -residual.ravel(), rtol=1e-3, restart=300, maxiter=1)[0].reshape(2, -1)
        q *= np.minimum(1, bound / np.maximum(np.hypot(*q), 1e-300))
    else:
        raise RuntimeError("Newton's method does not converge")
    tx, ty, mz = q[0].sum() * d**2, q[1].sum() * d**2, (x * q[1] - y * q[0]).sum() * d**2
    return dict(zip(UNITS, (tx, ty, mz, stick.sum() * d**2, XI * tx + ETA * ty + SPIN * mz)))


def evidence():
    ours = [numbers(solve(cells)) for cells in (64, 128, 256, 512)]
    others = [rolls(n) for n in (16, 32, 64)]
    ways = {"petsam, 64, 128, 256, 512 cells": ours, "cells in numpy, 16, 32, 64 across": others}
    return all_covered(UNITS, ways)


def answers():
    return numbers(solve(256), "_extrapolated")


def draw(figure):
    figure.set_size_inches(5.2, 2.9)
    results = solve(64)
    x, y = results.x * 1e3, results.y * 1e3
    p, qx, qy = (results[name][-1] for name in ("pressure", "shear_x", "shear_y"))
    inside, some = p > 0, np.s_[2::5, 2::5]
    sticks = np.where(inside, np.hypot(qx, qy) < FRICTION * p * (1 - 1e-6), np.nan)
    axes = figure.subplots()
    axes.pcolormesh(x, y, sticks, cmap="Greys", vmin=-0.5, vmax=3)
    arrows = [np.where(inside, q, np.nan)[some] * 1e-6 for q in (qx, qy)]
    drawn = axes.quiver(x[2::5], y[2::5], *arrows)
    axes.quiverkey(drawn, 1.2, 0.9, 300, "q = 300 MPa")
    axes.text(1.06, 0.7, "darker: stick", transform=axes.transAxes)
    axes.set_aspect("equal")
    axes.set_xlabel("x (mm), rolling to the right")
    axes.set_ylabel("y (mm)")

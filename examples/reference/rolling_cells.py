"""Steady rolling under Hertz's pressure by cells in numpy and scipy, which shares no code with petsam."""

import numpy as np
from scipy.sparse.linalg import LinearOperator, gmres


def corners(n, d, function):
    """Integrals over a cell of sides d, at distances of -n to n cells, of what has this antiderivative."""
    steps = np.arange(-n, n + 2) - 0.5
    f = function(d[0] * steps[None, :], d[1] * steps[:, None])
    return f[1:, 1:] - f[1:, :-1] - f[:-1, 1:] + f[:-1, :-1]


def convolution(kernel, n):
    """The function that applies a kernel, as of corners(), to n x n cells."""
    size = 3 * n
    spectrum = np.fft.rfft2(kernel, (size, size))
    return lambda q: np.fft.irfft2(spectrum * np.fft.rfft2(q, (size, size)), (size, size))[n : 2 * n, n : 2 * n]


def slip_matrix(n, d, inside, shear, poisson):
    """q -> (u(x) - u(x + d))/d of the cells inside, and its diagonal; material enters at large x.

    Cerruti: u_2 - u_1 is (1 - nu)/(pi G) times the sum of q/r, and nu/(pi G) times that of (x^2, xy, y^2)/r^3.
    """
    along = corners(n, d, lambda x, y: y * np.arcsinh(x / np.abs(y)))  # of x^2/r^3
    across = corners(n, d, lambda x, y: x * np.arcsinh(y / np.abs(x)))
    cross = corners(n, d, lambda x, y: -np.hypot(x, y))
    whole, part = (1 - poisson) / (np.pi * shear), poisson / (np.pi * shear)
    kernels = (whole * (along + across) + part * along, part * cross, whole * (along + across) + part * across)
    kernels = [(k - np.pad(k, ((0, 0), (0, 1)))[:, 1:]) / d[0] for k in kernels]
    xx, xy, yy = (convolution(k, n) for k in kernels)

    def product(q):
        fields = np.zeros((2, n, n))
        fields[:, inside] = q
        return np.array([(xx(fields[0]) + xy(fields[1]))[inside], (xy(fields[0]) + yy(fields[1]))[inside]])

    return product, kernels[0][n, n]


def steady(half, n, shear, poisson, limit, creep):
    """T_x, T_y, M_z and the area of stick of like bodies with these half axes, on n x n cells across the contact.

    shear: modulus, Pa; limit: mu N; creep: xi, eta, phi. Complementarity by Newton's method with GMRES.
    """
    xi, eta, spin = creep
    d = (2 * half[0] / n, 2 * half[1] / n)
    cell = d[0] * d[1]
    x, y = np.meshgrid(*(side * (np.arange(n) - (n - 1) / 2) for side in d))
    inside = np.hypot(x / half[0], y / half[1]) < 1
    x, y = x[inside], y[inside]
    bound = np.sqrt(1 - (x / half[0]) ** 2 - (y / half[1]) ** 2)
    bound *= limit / (bound.sum() * cell)
    product, diagonal = slip_matrix(n, d, inside, shear, poisson)
    w, c, q = np.array([xi - spin * y, eta + spin * x]), 1 / diagonal, np.zeros((2, x.size))
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
    moment = x * q[1] - y * q[0]
    return q[0].sum() * cell, q[1].sum() * cell, moment.sum() * cell, stick.sum() * cell

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


class Rolling:
    """Complementarity of like bodies on cells: q = bound of z = q - c slip, where z is not below its bound.

    product, diagonal: of slip_matrix(); w: the rigid slip; bound: mu p, both at the cells inside.
    """

    def __init__(self, product, diagonal, w, bound):
        self.product, self.c, self.w, self.bound = product, 1 / diagonal, w, bound

    def cut(self, q):
        return q * np.minimum(1, self.bound / np.maximum(np.hypot(*q), 1e-300))

    def residual(self, q):
        """The residual, its part of the bound, and what the derivative needs: stick, unit vectors of z, bound/|z|."""
        slip = self.product(q) - self.w
        z = q - self.c * slip
        size = np.maximum(np.hypot(*z), 1e-300)
        stick, e = size <= self.bound, z / size
        found = np.where(stick, self.c * slip, q - self.bound * e)
        return found, np.linalg.norm(found) / np.linalg.norm(self.bound), (stick, e, self.bound / size)

    def newton(self, found, state):
        """Newton's step from there, by GMRES."""
        stick, e, turn = state

        def derivative(v):
            v = v.reshape(2, -1)
            z = v - self.c * self.product(v)
            return np.where(stick, v - z, v - turn * (z - e * np.sum(e * z, axis=0))).ravel()

        matrix = LinearOperator(2 * (found.size,), matvec=derivative)
        return gmres(matrix, -found.ravel(), rtol=1e-2, restart=300, maxiter=1)[0].reshape(2, -1)

    def solve(self, q):
        """The shear and where it sticks, from a first guess; a step is halved until the residual falls."""
        found, size, state = self.residual(q)
        for _ in range(60):
            if size < 1e-6:
                return q, state[0]
            change, part, before = self.newton(found, state), 1.0, size
            while part > 0.01:
                trial = self.cut(q + part * change)
                found, size, state = self.residual(trial)
                if size < (1 - 0.1 * part) * before:
                    break
                part /= 2
            q = trial
        raise RuntimeError("Newton's method does not converge")


def steady(half, n, shear, poisson, limit, creep, factor=1.0):
    """T_x, T_y, M_z and the area of stick of like bodies with these half axes, on n x n cells.

    shear: modulus, Pa; limit: mu N; creep: xi, eta, phi; factor: width of the cells in all over that of the contact.
    The first guess is the solution on half as many cells.
    """
    sizes = [n]
    while sizes[0] % 2 == 0 and sizes[0] > 16:
        sizes.insert(0, sizes[0] // 2)
    part = np.zeros((2, sizes[0], sizes[0]))  # of the bound
    for m in sizes:
        part = part.repeat(m // part.shape[1], axis=1).repeat(m // part.shape[2], axis=2)
        d = [2 * factor * side / m for side in half]
        cell = d[0] * d[1]
        x, y = np.meshgrid(*(side * (np.arange(m) - (m - 1) / 2) for side in d))
        inside = np.hypot(x / half[0], y / half[1]) < 1
        x, y = x[inside], y[inside]
        bound = np.sqrt(1 - (x / half[0]) ** 2 - (y / half[1]) ** 2)
        bound *= limit / (bound.sum() * cell)
        w = np.array([creep[0] - creep[2] * y, creep[1] + creep[2] * x])
        rolling = Rolling(*slip_matrix(m, d, inside, shear, poisson), w, bound)
        q, stick = rolling.solve(part[:, inside] * bound)
        part[:, inside] = q / bound
    moment = x * q[1] - y * q[0]
    return q[0].sum() * cell, q[1].sum() * cell, moment.sum() * cell, stick.sum() * cell

"""Legendre polynomials in x times those in y, by total degree, orthonormal on the patch: a rectangle in x and y."""

from dataclasses import dataclass

import numpy as np
from numpy.polynomial import legendre


def powers(degree):
    """Degrees (m, 2) in x and y of the (degree + 1)(degree + 2)/2 functions, by total degree, x first."""
    return np.array([(total - j, j) for total in range(degree + 1) for j in range(total + 1)])


def along(degree, x, center, half):
    """Values (points, degree + 1) of the orthonormal Legendre polynomials on center - half to center + half, m^-1/2."""
    scaled = (np.asarray(x) - center) / half
    return legendre.legvander(scaled, degree) * np.sqrt((2.0 * np.arange(degree + 1) + 1.0) / (2.0 * half))


def gauss(n, center, half):
    """Points and weights of n Gauss points on center - half to center + half."""
    points, weights = legendre.leggauss(n)
    return center + half * points, half * weights


@dataclass(frozen=True)
class Patch:
    """A rectangle, m, and the degree of its polynomials."""

    center: tuple
    half: tuple
    degree: int

    @property
    def count(self):
        """Number m of the functions."""
        return (self.degree + 1) * (self.degree + 2) // 2

    def values(self, x, y):
        """Functions (points, m), 1/m, at points."""
        px, py = (along(self.degree, v, self.center[d], self.half[d]) for d, v in enumerate((x, y)))
        table = powers(self.degree)
        return px[:, table[:, 0]] * py[:, table[:, 1]]

    def quadrature(self, nx, ny):
        """Points (nx ny, 2) and weights, m2."""
        (x, wx), (y, wy) = (gauss(n, self.center[d], self.half[d]) for d, n in enumerate((nx, ny)))
        grid = np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1).reshape(-1, 2)
        return grid, np.outer(wx, wy).ravel()

    def distance(self, points):
        """Distances (points, 2) in half widths of x and y, of points (points, 3) from the rectangle at z = 0."""
        beyond = np.maximum(0.0, np.abs(points[:, :2] - np.array(self.center)) - np.array(self.half))
        return np.sqrt(np.sum(beyond**2, axis=1) + points[:, 2] ** 2)[:, None] / np.array(self.half)

    def cell_means(self, n):
        """Means (n n, m), 1/m, over the n x n equal cells of the patch, y slower than x."""
        means = []
        for d in range(2):
            edges = np.linspace(-self.half[d], self.half[d], n + 1)
            inner, weight = legendre.leggauss(self.degree // 2 + 1)
            x = 0.5 * (edges[1:] + edges[:-1])[:, None] + (self.half[d] / n) * inner
            values = along(self.degree, x.ravel(), 0.0, self.half[d]).reshape(n, inner.size, -1)
            means.append(np.einsum("cqk,q->ck", values, 0.5 * weight))
        table = powers(self.degree)
        return (means[0][None, :, table[:, 0]] * means[1][:, None, table[:, 1]]).reshape(n * n, -1)

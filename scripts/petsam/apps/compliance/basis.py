"""Legendre polynomials in x times those in y, orthonormal on the patch: a rectangle in x and y.

A degree is one number, the largest sum of the degrees in x and y, or two: the largest degree in x and that in y.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.polynomial import legendre

HALF_METRE = 0.5  # m: half width of a section's patch along y
FAR = 1e6


def powers(degree):
    """Degrees (m, 2) in x and y of the functions up to a degree, by their sum, x first."""
    nx, ny = largest(degree)
    table = [(total - j, j) for total in range(nx + ny + 1) for j in range(total + 1)]
    if np.ndim(degree) == 0:
        return np.array([pair for pair in table if sum(pair) <= degree])
    return np.array([pair for pair in table if pair[0] <= nx and pair[1] <= ny])


def largest(degree):
    """Largest degrees in x and y."""
    return (degree, degree) if np.ndim(degree) == 0 else tuple(degree)


def reduced(degree, by):
    """The degree that is lower by that number, but at least 0."""
    return max(degree - by, 0) if np.ndim(degree) == 0 else tuple(max(one - by, 0) for one in degree)


def written(degree):
    """The degree as --degree takes it."""
    return ",".join(str(one) for one in np.atleast_1d(degree))


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
    degree: int | tuple

    @cached_property
    def powers(self):
        """Degrees (m, 2) of the functions in x and y."""
        return powers(self.degree)

    @property
    def largest(self):
        """Largest degrees in x and y."""
        return largest(self.degree)

    @property
    def count(self):
        """Number m of the functions."""
        return len(self.powers)

    @property
    def narrow(self):
        """Smaller half width."""
        return min(self.half)

    @property
    def wide(self):
        """Larger half width."""
        return max(self.half)

    def values(self, x, y):
        """Functions (points, m), 1/m, at points."""
        px, py = (along(self.largest[d], v, self.center[d], self.half[d]) for d, v in enumerate((x, y)))
        return px[:, self.powers[:, 0]] * py[:, self.powers[:, 1]]

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
        """Means (cells, m), 1/m, over the n[0] x n[1] equal cells of the patch, y slower than x."""
        means = []
        for d in range(2):
            edges = np.linspace(-self.half[d], self.half[d], n[d] + 1)
            inner, weight = legendre.leggauss(self.largest[d] // 2 + 1)
            x = 0.5 * (edges[1:] + edges[:-1])[:, None] + (self.half[d] / n[d]) * inner
            values = along(self.largest[d], x.ravel(), 0.0, self.half[d]).reshape(n[d], inner.size, -1)
            means.append(np.einsum("cqk,q->ck", values, 0.5 * weight))
        table = self.powers
        return (means[0][None, :, table[:, 0]] * means[1][:, None, table[:, 1]]).reshape(n[0] * n[1], -1)


@dataclass(frozen=True)
class LinePatch(Patch):
    """That of a section in plane strain: 1 m along y, along which the functions do not vary."""

    @property
    def narrow(self):
        """Half width in x."""
        return self.half[0]

    @property
    def wide(self):
        """Half width in x."""
        return self.half[0]

    def quadrature(self, nx, ny):
        """Points (nx, 2) in the plane of the section, and weights, m2; ny: is not used."""
        x, weights = gauss(nx, self.center[0], self.half[0])
        return np.stack([x, np.zeros(nx)], axis=1), weights

    def distance(self, points):
        """Distances (points, 2) in half widths; those in y are far."""
        beyond = np.maximum(0.0, np.abs(points[:, 0] - self.center[0]) - self.half[0])
        return np.stack([np.hypot(beyond, points[:, 2]) / self.half[0], np.full(len(points), FAR)], axis=1)


def line(center, half, degree):
    """The LinePatch about x = center."""
    return LinePatch((center, 0.0), (half, HALF_METRE), (degree, 0))

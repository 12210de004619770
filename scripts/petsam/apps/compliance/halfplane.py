"""Displacement and stress in a half-plane z >= 0, in plane strain and antiplane, by tractions phi_j on its surface.

A line force, N/m, along y on the surface (Flamant; Johnson, Contact Mechanics, 1985, chapter 2), with r2 = x^2 + z^2
and t = atan2(x, z), gives

    4 pi G u_xx = -4 (1 - nu) ln(r/D) - 2 z^2/r2    4 pi G u_xz = 2 x z/r2 - 2 (1 - 2 nu) t    4 pi G u_yy = -4 ln(r/D)
    4 pi G u_zz = -4 (1 - nu) ln(r/D) + 2 z^2/r2    4 pi G u_zx = 2 x z/r2 + 2 (1 - 2 nu) t

with u_ik in i by a force in k. On the surface u_xx, u_yy and u_zz vanish at the distance D, the datum, as petsam's with
-plane_datum do.
"""

import numpy as np

from .halfspace import Fields, Mirroring


def displacement(d, poisson, datum):
    """u_ik (3, 3, ...), times 4 pi G, at differences d (3, ...) from a unit line force in k."""
    x, z = d[0], d[2]
    square = x * x + z * z
    log, turn = np.log(square / datum**2), 2.0 * (1.0 - 2.0 * poisson) * np.arctan2(x, z)
    u = np.zeros((3, 3, *x.shape))
    deep, mixed = 2.0 * z * z / square, 2.0 * x * z / square
    u[0, 0] = -2.0 * (1.0 - poisson) * log - deep
    u[1, 1] = -2.0 * log
    u[2, 2] = -2.0 * (1.0 - poisson) * log + deep
    u[0, 2], u[2, 0] = mixed - turn, mixed + turn
    return u


def gradient(d, poisson):
    """u_ik,l (3, 3, 3, ...), times 4 pi G, of the same."""
    x, z = d[0], d[2]
    square = x * x + z * z
    log, turn = 4.0 * (1.0 - poisson), 2.0 * (1.0 - 2.0 * poisson)
    g = np.zeros((3, 3, 3, *x.shape))
    for axis, own, other in ((0, x, z), (2, z, x)):
        deep = ((4.0 * z if axis == 2 else 0.0) - 4.0 * z * z * own / square) / square
        mixed = (2.0 * other - 4.0 * x * z * own / square) / square
        angle = turn * (z if axis == 0 else -x) / square
        g[0, 0, axis] = -log * own / square - deep
        g[1, 1, axis] = -4.0 * own / square
        g[2, 2, axis] = -log * own / square + deep
        g[0, 2, axis], g[2, 0, axis] = mixed - angle, mixed + angle
    return g


class LineFields(Fields):
    """Fields of all phi_j of a LinePatch in all three directions; the datum is its full width."""

    def __init__(self, patch, young, poisson):
        super().__init__(patch, young, poisson)
        self.datum = 2.0 * patch.half[0]

    def displacement(self, points):
        """As that of Fields."""
        u = self._sum(lambda d, poisson: displacement(d, poisson, self.datum), points, 3)
        return u.reshape(len(points), 3, self.columns)

    def gradient(self, points):
        """As that of Fields."""

        def kernel(d, poisson):
            return np.swapaxes(gradient(d, poisson), 1, 2).reshape(9, 3, *d.shape[1:])

        return self._sum(kernel, points, 9).reshape(len(points), 3, 3, self.columns)


class MirroredLine(Mirroring, LineFields):
    """The fields of -phi_j on the half-plane z <= 0."""


def cell_compliance(half, n, young, poisson):
    """Dense compliance (3 n, 3 n), m3/N, of n equal cells of the width of a patch, 1 m along y, with its datum."""
    h, datum = 2.0 * half / n, 2.0 * half
    ends = (np.arange(1 - n, n)[:, None] + np.array([-0.5, 0.5])) * h
    log = np.diff(ends * (np.log(np.abs(ends) / datum) - 1.0), axis=1)[:, 0]
    turn = np.pi * (1.0 - 2.0 * poisson) * np.diff(np.abs(ends), axis=1)[:, 0]
    table = np.zeros((2 * n - 1, 3, 3))
    table[:, 0, 0] = table[:, 2, 2] = -4.0 * (1.0 - poisson) * log
    table[:, 1, 1] = -4.0 * log
    table[:, 0, 2], table[:, 2, 0] = -turn, turn
    table *= 0.5 * (1.0 + poisson) / (np.pi * young)
    cell = np.arange(n)
    return table[cell[:, None] - cell + n - 1].transpose(0, 2, 1, 3).reshape(3 * n, 3 * n)

"""Displacement and stress in a half-space z >= 0 by tractions phi_j on its surface.

A point force on the surface, in x, y or z (Cerruti, Boussinesq; Johnson, Contact Mechanics, 1985, chapter 3), with
r = |x|, s = r + z and the harmonic function Psi = z ln s - r, is

    4 pi G u_ik = delta_ik/r + x_i x_k/r^3 + (1 - 2 nu) H_ik,   H_ab = -Psi,ab   H_za = -H_az = x_a/(r s)   H_zz = 1/r

(a, b one of x, y). Its gradient is in closed form below. A traction phi_j is the sum over Gauss points of the patch;
their number follows the distance of the point, by the ellipse of analyticity of 1/r.
"""

import itertools

import numpy as np

from .basis import along

ACCURACY = 1e-9  # relative accuracy of a Gauss sum
MOST = 160  # maximum number of Gauss points along a side
CHUNK = 1 << 15  # pairs of point and Gauss point at a time


def _powers(d):
    """1/r and 1/s of the differences d (3, ...)."""
    r = np.sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2])
    return 1.0 / r, 1.0 / (r + d[2])


def displacement(d, poisson):
    """u_ik (3, 3, ...), times 4 pi G, at differences d (3, ...) from a unit force in k."""
    a, b = _powers(d)
    c = 1.0 - 2.0 * poisson
    u = np.empty((3, 3, *a.shape))
    cube, side = a * a * a, c * a * b
    flat = cube - side * b
    u[0, 1] = u[1, 0] = d[0] * d[1] * flat
    for i in range(2):
        u[i, i] = a + c * b + d[i] * d[i] * flat
        u[2, i] = d[i] * (d[2] * cube + side)
        u[i, 2] = d[i] * (d[2] * cube - side)
    u[2, 2] = (1.0 + c) * a + d[2] * d[2] * cube
    return u


def _add_correction(g, d, inverse, c):
    """The gradient of (1 - 2 nu) H_ik, added to g."""
    a, b = inverse
    p = c * a * b
    q, w = p * b, p * a * (a + b)
    third, cube = q * a * (a + 2.0 * b), c * a * a * a
    for i in range(2):
        for k in range(2):
            equal = i == k
            g[i, k, 2] -= (p if equal else 0.0) - w * d[i] * d[k]
            second = (p if equal else 0.0) - w * d[i] * d[k]
            g[2, i, k] += second
            g[i, 2, k] -= second
            for m in range(2):
                line = sum(d[n] for n, pair in ((m, (i, k)), (k, (i, m)), (i, (k, m))) if pair[0] == pair[1])
                g[i, k, m] += third * (d[i] * d[k] * d[m]) - q * line
        g[2, i, 2] -= cube * d[i]
        g[i, 2, 2] += cube * d[i]
    for m in range(3):
        g[2, 2, m] -= cube * d[m]


def gradient(d, poisson):
    """u_ik,l (3, 3, 3, ...), times 4 pi G, of the same."""
    a, b = _powers(d)
    cube = a * a * a
    g = np.empty((3, 3, 3, *a.shape))
    near = [cube * one for one in d]
    fifth = -3.0 * a * a
    for i in range(3):
        for k in range(i, 3):
            outer = fifth * d[i] * near[k]
            for m in range(3):
                value = outer * d[m]
                for n, same, sign in ((k, i == m, 1.0), (i, k == m, 1.0), (m, i == k, -1.0)):
                    if same:
                        value += sign * near[n]
                g[i, k, m] = value
                g[k, i, m] = value
    _add_correction(g, d, (a, b), 1.0 - 2.0 * poisson)
    return g


def points_needed(distance, degree):
    """Returns the number of Gauss points along sides for points at distances (points, 2) from the patch in half widths.

    degree: largest ones in x and y.
    """
    distance = np.maximum(distance, 1e-3)
    ellipse = np.log(distance + np.sqrt(1.0 + distance**2))
    n = 0.5 * (-np.log(ACCURACY) / ellipse + np.array(degree)) + 2
    return np.minimum(MOST, np.ceil(n / 4.0) * 4.0).astype(int)


class Fields:
    """Fields of all phi_j in all three directions, in a material."""

    def __init__(self, patch, young, poisson):
        self.patch, self.young, self.poisson = patch, young, poisson
        self.shear = 0.5 * young / (1.0 + poisson)
        self.lame = 2.0 * self.shear * poisson / (1.0 - 2.0 * poisson)
        self.columns, self.datum = 3 * patch.count, None

    def _sum(self, kernel, points, parts):
        """Sums (points, parts, m, 3) of kernel(differences, poisson) (parts, 3, ...) over the patch."""
        points = np.asarray(points, dtype=float)
        result = np.empty((len(points), parts, self.patch.count, 3))
        counts = points_needed(self.patch.distance(points), self.patch.largest)
        for pair in np.unique(counts, axis=0):
            chosen = np.flatnonzero(np.all(counts == pair, axis=1))
            source, weight = self.patch.quadrature(*pair)
            factor = self.patch.values(*source.T) * (weight / (4.0 * np.pi * self.shear))[:, None]
            stride = max(1, CHUNK // len(source))
            for first in range(0, len(chosen), stride):
                some = chosen[first : first + stride]
                d = points[some].T[:, :, None] - np.concatenate([source.T, np.zeros((1, len(source)))])[:, None, :]
                values = kernel(d, self.poisson).reshape(-1, len(source)) @ factor
                result[some] = values.reshape(parts, 3, len(some), -1).transpose(2, 0, 3, 1)
        return result

    def displacement(self, points):
        """u (points, 3, 3 m), column 3 j + k of phi_j in direction k; m3/N: metres by a coefficient in N/m."""
        u = self._sum(displacement, points, 3)
        return u.reshape(len(points), 3, self.columns)

    def gradient(self, points):
        """u_i,l (points, 3, 3, 3 m)."""

        def kernel(d, poisson):
            return np.swapaxes(gradient(d, poisson), 1, 2).reshape(9, 3, *d.shape[1:])

        return self._sum(kernel, points, 9).reshape(len(points), 3, 3, self.columns)

    def stress_of(self, strain):
        """Hooke's law for gradients or strains (points, 3, 3, ...)."""
        trace = np.einsum("pii...->p...", strain)
        stress = self.shear * (strain + np.swapaxes(strain, 1, 2))
        for i in range(3):
            stress[:, i, i] += self.lame * trace
        return stress

    def stress(self, points):
        """sigma (points, 3, 3, 3 m)."""
        return self.stress_of(self.gradient(points))


class Several(Fields):
    """The fields of the functions of several patches of one half-space, one patch after the other."""

    def __init__(self, fields):
        super().__init__(fields[0].patch, fields[0].young, fields[0].poisson)
        self.fields, self.columns = fields, sum(one.columns for one in fields)
        self.datum = fields[0].datum

    def displacement(self, points):
        """As that of Fields."""
        return np.concatenate([one.displacement(points) for one in self.fields], axis=-1)

    def gradient(self, points):
        """As that of Fields."""
        return np.concatenate([one.gradient(points) for one in self.fields], axis=-1)


MIRROR = np.array([1.0, 1.0, -1.0])


class Mirroring(Fields):
    """Fields of -phi_j on z <= 0 by reflection of those of the class that follows it."""

    def __init__(self, patch, young, poisson):
        super().__init__(patch, young, poisson)
        self.signs = -np.tile(MIRROR, patch.count)

    def displacement(self, points):
        """As that of Fields."""
        return super().displacement(points * MIRROR) * MIRROR[:, None] * self.signs

    def gradient(self, points):
        """As that of Fields."""
        return super().gradient(points * MIRROR) * np.outer(MIRROR, MIRROR)[:, :, None] * self.signs


class Mirrored(Mirroring, Fields):
    """The fields of -phi_j on the half-space z <= 0."""


def opposite(matrix):
    """Compliance (3 n, 3 n) of a half-space as that of body 1: displacement -u by tractions -t on z <= 0."""
    sign = np.tile(MIRROR, len(matrix) // 3)
    return matrix * sign[:, None] * sign


# ---------------------------------------------------------------- the surface itself, by uniform cells


def _corner(x, y, poisson):
    """Antiderivatives of 4 pi G u_ik on the surface, integrated over x and y (..., 3, 3)."""
    r = np.hypot(x, y)
    lx, ly = (v * np.log(w + r) for v, w in ((y, x), (x, y)))
    c, nu2 = 1.0 - 2.0 * poisson, 2.0 * poisson
    out = np.zeros((*np.shape(x), 3, 3))
    out[..., 0, 0] = 2.0 * (1.0 - poisson) * ly + 2.0 * lx
    out[..., 1, 1] = 2.0 * (1.0 - poisson) * lx + 2.0 * ly
    out[..., 0, 1] = out[..., 1, 0] = -nu2 * r
    out[..., 2, 2] = 2.0 * (1.0 - poisson) * (lx + ly)
    square = np.log(x**2 + y**2)
    out[..., 2, 0] = c * (0.5 * y * square + x * np.arctan(y / x))
    out[..., 2, 1] = c * (0.5 * x * square + y * np.arctan(x / y))
    out[..., :2, 2] = -out[..., 2, :2]
    return out


def cell_compliance(half, n, young, poisson):
    """Dense compliance (3 cells, 3 cells), m3/N, of n[0] x n[1] cells of a rectangle: displacement of centres by
    pressures."""
    nx, ny = n
    h = 2.0 * np.array(half) / n
    ix, iy = np.meshgrid(np.arange(1 - nx, nx), np.arange(1 - ny, ny))
    total = 0.0
    for sx in (-1, 1):
        for sy in (-1, 1):
            total = total + sx * sy * _corner((ix + 0.5 * sx) * h[0], (iy + 0.5 * sy) * h[1], poisson)
    total *= 0.5 * (1.0 + poisson) / (np.pi * young)
    row, column = (v.ravel() for v in np.indices((ny, nx)))
    dense = total[row[:, None] - row + ny - 1, column[:, None] - column + nx - 1]
    return dense.transpose(0, 2, 1, 3).reshape(3 * nx * ny, 3 * nx * ny)


def _correlation(degree, half, d):
    """Returns int p_a(x + d) p_b(x) dx (points, degree + 1, degree + 1) of the polynomials over their overlap."""
    low, high = np.maximum(-half, -half - d), np.minimum(half, half - d)
    points, weights = np.polynomial.legendre.leggauss(degree + 1)
    x = 0.5 * (low + high)[:, None] + 0.5 * (high - low)[:, None] * points
    values = [along(degree, v.ravel(), 0.0, half).reshape(*x.shape, -1) for v in (x + d[:, None], x)]
    return np.einsum("pqa,pqb,pq->pab", *values, 0.5 * (high - low)[:, None] * weights)


def projected(patch, young, poisson):
    """<phi_i, K phi_j> (3 m, 3 m) of the half-space, m3/N, to rounding: r times the kernel depends on the angle
    alone, so that in polar coordinates of the difference all integrands are smooth."""
    n = 2 * max(patch.largest) + 12
    t, weight = np.polynomial.legendre.leggauss(n)
    t, weight = 0.5 * (1.0 + t), 0.5 * weight
    sides = 2.0 * np.array(patch.half)
    table = patch.powers
    total = np.zeros((patch.count, 3, patch.count, 3))
    for sx, sy, swapped in itertools.product((1, -1), (1, -1), (False, True)):
        # triangle between an axis and the diagonal, collapsed: d = u (1, v) or u (v, 1), its corner at d = 0
        u, v = (w.ravel() for w in np.meshgrid(t, t))
        d = np.stack([u * v, u] if swapped else [u, u * v], axis=1) * sides * (sx, sy)
        measure = np.outer(weight, weight).ravel() * u * sides[0] * sides[1]
        difference = np.stack([*d.T, np.zeros(len(d))])
        kernel = displacement(difference, poisson) * (measure * 0.5 * (1.0 + poisson) / (np.pi * young))
        cx, cy = (_correlation(patch.largest[axis], patch.half[axis], d[:, axis]) for axis in range(2))
        pairs = cx[:, table[:, 0][:, None], table[:, 0]] * cy[:, table[:, 1][:, None], table[:, 1]]
        total += np.einsum("pab,ijp->aibj", pairs, kernel, optimize=True)
    return total.reshape(3 * patch.count, 3 * patch.count)

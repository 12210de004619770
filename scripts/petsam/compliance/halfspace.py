"""Displacement and stress in a half-space z >= 0 by tractions phi_j on its surface.

A point force on the surface, in x, y or z (Cerruti, Boussinesq; Johnson, Contact Mechanics, 1985, chapter 3), with
r = |x|, s = r + z and the harmonic function Psi = z ln s - r, is

    4 pi G u_ik = delta_ik/r + x_i x_k/r^3 + (1 - 2 nu) H_ik,   H_ab = -Psi,ab   H_za = -H_az = x_a/(r s)   H_zz = 1/r

(a, b one of x, y). Its gradient is in closed form below. A traction phi_j is the sum over Gauss points of the patch;
their number follows the distance of the point, by the ellipse of analyticity of 1/r.
"""

import itertools

import numpy as np

from .basis import along, powers

ACCURACY = 1e-9  # of a Gauss sum
MOST = 160  # Gauss points along a side
CHUNK = 1 << 16  # pairs of point and Gauss point at a time
DELTA = np.eye(3)


def _powers(d):
    """1/r and 1/s of the differences (..., 3)."""
    r = np.sqrt(np.einsum("...i,...i", d, d))
    return 1.0 / r, 1.0 / (r + d[..., 2])


def displacement(d, poisson):
    """u_ik (..., 3, 3), times 4 pi G, of a unit force in k at the origin of d (..., 3)."""
    a, b = _powers(d)
    c = 1.0 - 2.0 * poisson
    u = np.einsum("...,ik->...ik", a, DELTA) + np.einsum("...,...i,...k->...ik", a**3, d, d)
    flat = d[..., :2]
    u[..., :2, :2] += c * (
        np.einsum("...,ik->...ik", b, DELTA[:2, :2]) - np.einsum("...,...i,...k->...ik", a * b**2, flat, flat)
    )
    side = c * (a * b)[..., None] * flat
    u[..., 2, :2] += side
    u[..., :2, 2] -= side
    u[..., 2, 2] += c * a
    return u


def gradient(d, poisson):
    """u_ik,l (..., 3, 3, 3), times 4 pi G, of the same."""
    a, b = _powers(d)
    c = 1.0 - 2.0 * poisson
    near = (a**3)[..., None] * d
    g = -3.0 * np.einsum("...,...i,...k,...l->...ikl", a**5, d, d, d)
    g += np.einsum("il,...k->...ikl", DELTA, near) + np.einsum("kl,...i->...ikl", DELTA, near)
    g -= np.einsum("ik,...l->...ikl", DELTA, near)
    e, flat = DELTA[:2, :2], d[..., :2]
    line = (a * b**2)[..., None] * flat
    third = np.einsum("ik,...l->...ikl", e, line) + np.einsum("il,...k->...ikl", e, line)
    third += np.einsum("kl,...i->...ikl", e, line)
    third -= np.einsum("...,...i,...k,...l->...ikl", a**3 * b**2 + 2.0 * a**2 * b**3, flat, flat, flat)
    second = np.einsum("...,ik->...ik", a * b, e)
    second -= np.einsum("...,...i,...k->...ik", a**3 * b + a**2 * b**2, flat, flat)
    g[..., :2, :2, :2] -= c * third
    g[..., :2, :2, 2] -= c * second
    g[..., 2, :2, :2] += c * second
    g[..., :2, 2, :2] -= c * second
    g[..., 2, :2, 2] -= c * near[..., :2]
    g[..., :2, 2, 2] += c * near[..., :2]
    g[..., 2, 2, :] -= c * near
    return g


def points_needed(distance, degree):
    """Gauss points along a side for a point that many half widths away from the patch."""
    distance = np.maximum(distance, 1e-3)
    ellipse = np.log(distance + np.sqrt(1.0 + distance**2))
    n = 0.5 * (-np.log(ACCURACY) / ellipse + degree) + 2
    return np.minimum(MOST, np.ceil(n / 4.0) * 4.0).astype(int)


class Fields:
    """Fields of all phi_j in all three directions, in a material."""

    def __init__(self, patch, young, poisson):
        self.patch, self.young, self.poisson = patch, young, poisson
        self.shear = 0.5 * young / (1.0 + poisson)
        self.lame = 2.0 * self.shear * poisson / (1.0 - 2.0 * poisson)
        self.columns = 3 * patch.count

    def _sum(self, kernel, points, parts):
        """Sums (points, parts, m, 3) of kernel(differences) (..., parts, 3) over the patch."""
        points = np.asarray(points, dtype=float)
        result = np.empty((len(points), parts, self.patch.count, 3))
        counts = points_needed(self.patch.distance(points), self.patch.degree)
        for pair in np.unique(counts, axis=0):
            chosen = np.flatnonzero(np.all(counts == pair, axis=1))
            source, weight = self.patch.quadrature(*pair)
            factor = self.patch.values(*source.T) * (weight / (4.0 * np.pi * self.shear))[:, None]
            stride = max(1, CHUNK // len(source))
            for first in range(0, len(chosen), stride):
                some = chosen[first : first + stride]
                d = np.repeat(points[some][:, None, :], len(source), axis=1)
                d[..., :2] -= source
                values = kernel(d).reshape(len(some), len(source), -1)
                summed = np.matmul(factor.T, values).reshape(len(some), self.patch.count, parts, 3)
                result[some] = summed.transpose(0, 2, 1, 3)
        return result

    def displacement(self, points):
        """u (points, 3, 3 m), column 3 j + k of phi_j in direction k; m3/N: metres by a coefficient in N/m."""
        u = self._sum(lambda d: displacement(d, self.poisson), points, 3)
        return u.reshape(len(points), 3, self.columns)

    def gradient(self, points):
        """u_i,l (points, 3, 3, 3 m)."""

        def kernel(d):
            return np.swapaxes(gradient(d, self.poisson), -1, -2).reshape(*d.shape[:-1], 9, 3)

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
    """Dense compliance (3 n n, 3 n n), m3/N, of n x n cells of a rectangle: displacement of centres by pressures."""
    h = 2.0 * np.array(half) / n
    ix, iy = np.meshgrid(np.arange(1 - n, n), np.arange(1 - n, n))
    total = 0.0
    for sx in (-1, 1):
        for sy in (-1, 1):
            total = total + sx * sy * _corner((ix + 0.5 * sx) * h[0], (iy + 0.5 * sy) * h[1], poisson)
    total *= 0.5 * (1.0 + poisson) / (np.pi * young)
    row, column = (v.ravel() for v in np.indices((n, n)))
    dense = total[row[:, None] - row + n - 1, column[:, None] - column + n - 1]
    return dense.transpose(0, 2, 1, 3).reshape(3 * n * n, 3 * n * n)


def _correlation(degree, half, d):
    """int p_a(x + d) p_b(x) dx (points, degree + 1, degree + 1) of the orthonormal polynomials, where both are."""
    low, high = np.maximum(-half, -half - d), np.minimum(half, half - d)
    points, weights = np.polynomial.legendre.leggauss(degree + 1)
    x = 0.5 * (low + high)[:, None] + 0.5 * (high - low)[:, None] * points
    values = [along(degree, v.ravel(), 0.0, half).reshape(*x.shape, -1) for v in (x + d[:, None], x)]
    return np.einsum("pqa,pqb,pq->pab", *values, 0.5 * (high - low)[:, None] * weights)


def projected(patch, young, poisson):
    """<phi_i, K phi_j> (3 m, 3 m) of the half-space, m3/N, to rounding: r times the kernel depends on the angle
    alone, so that in polar coordinates of the difference all integrands are smooth."""
    n = 2 * patch.degree + 12
    t, weight = np.polynomial.legendre.leggauss(n)
    t, weight = 0.5 * (1.0 + t), 0.5 * weight
    sides = 2.0 * np.array(patch.half)
    table = powers(patch.degree)
    total = np.zeros((patch.count, 3, patch.count, 3))
    for sx, sy, swapped in itertools.product((1, -1), (1, -1), (False, True)):
        # triangle between an axis and the diagonal, collapsed: d = u (1, v) or u (v, 1), its corner at d = 0
        u, v = (w.ravel() for w in np.meshgrid(t, t))
        d = np.stack([u * v, u] if swapped else [u, u * v], axis=1) * sides * (sx, sy)
        measure = np.outer(weight, weight).ravel() * u * sides[0] * sides[1]
        difference = np.concatenate([d, np.zeros((len(d), 1))], axis=1)
        kernel = displacement(difference, poisson) * (measure * 0.5 * (1.0 + poisson) / (np.pi * young))[:, None, None]
        cx, cy = (_correlation(patch.degree, patch.half[axis], d[:, axis]) for axis in range(2))
        pairs = cx[:, table[:, 0][:, None], table[:, 0]] * cy[:, table[:, 1][:, None], table[:, 1]]
        total += np.einsum("pab,pij->aibj", pairs, kernel, optimize=True)
    return total.reshape(3 * patch.count, 3 * patch.count)

"""Files of bodies' compliances: of an elastic layer bonded to a rigid base, exact, and of any matrix."""

import functools

import h5py
import numpy as np
from scipy.special import spherical_jn


def powers(degree):
    """Powers (m, 2) of the Legendre products, by total degree."""
    return np.array([(total - j, j) for total in range(degree + 1) for j in range(total + 1)])


def wave(k, thickness, poisson):
    """Displacements (x, z) by tractions (x, z) of a plane wave, and y by y; an infinite thickness: the half-space."""
    _, moved, by = airy(k, thickness, poisson)
    shear = 0.5 / (1 + poisson)
    return moved(0.0) @ by, (1 if np.isinf(thickness) else np.tanh(k * thickness)) / (shear * k)


def airy(k, thickness, poisson):
    """Of a depth: Airy's function and its derivatives by each constant, and the displacements; and the constants by
    the tractions.

    E = 1. The function is (a + b z) exp(-kz) + (c + d z) exp(k(z - thickness)), bonded at z = thickness.
    """
    shear = 0.5 / (1 + poisson)
    deep = np.isinf(thickness)

    def at(z):
        """The function and its first three derivatives by each unknown."""
        rows = []
        for sign, shift in ((-1, 0.0),) if deep else ((-1, 0.0), (1, thickness)):
            e, s = np.exp(sign * k * (z - shift)), sign * k
            rows += [[e * s**n for n in range(4)], [e * (s**n * z + n * s ** max(n - 1, 0)) for n in range(4)]]
        return np.array(rows).T

    def moved(z):
        f = at(z)
        x = ((1 - poisson) * f[2] + poisson * k**2 * f[0]) / (2j * shear * k)
        slope = ((1 - poisson) * f[3] + poisson * k**2 * f[1]) / (2j * shear * k)
        return np.array([x, (-1j * k * f[1] / shear - slope) / (1j * k)])

    top = at(0.0)
    rows = [1j * k * top[1], k**2 * top[0]]  # q and p
    if not deep:
        rows += list(moved(thickness))
    unit = np.zeros((len(rows), 2))
    unit[:2] = np.eye(2)
    return at, moved, np.linalg.solve(np.array(rows), unit)


@functools.lru_cache
def layer(thickness, degree, poisson=0.3):
    """D (m, 3, m, 3) of a layer on a rigid base, E = 1, patch [-1, 1]^2."""
    nodes, weights = np.polynomial.legendre.leggauss(140)
    most = 19 / thickness
    ks, weights = 0.5 * most * (nodes + 1), 0.5 * most * weights
    angles = 2 * np.pi * (np.arange(180) + 0.5) / 180
    table = powers(degree)
    order = np.arange(degree + 1)
    result = 0
    for k, weight in zip(ks, weights):
        here, there = wave(k, thickness, poisson), wave(k, np.inf, poisson)
        plane, out = here[0] - there[0], here[1] - there[1]
        hats = [
            np.sqrt((2 * order + 1) / 2) * 2 * (-1j) ** order * spherical_jn(order, (k * d)[:, None])
            for d in (np.cos(angles), np.sin(angles))
        ]
        phi = hats[0][:, table[:, 0]] * hats[1][:, table[:, 1]]
        e = np.stack([np.cos(angles), np.sin(angles), 0 * angles], axis=1)
        s = np.stack([-np.sin(angles), np.cos(angles), 0 * angles], axis=1)
        z = np.broadcast_to([0, 0, 1], e.shape)

        def product(a, b):
            return np.einsum("ta,tb->tab", a, b)

        c = plane[0, 0] * product(e, e) + plane[1, 1] * product(z, z) + out * product(s, s)
        c = c + plane[0, 1] * product(e, z) + plane[1, 0] * product(z, e)
        result = result + weight * k * np.einsum("ti,tab,tj->iajb", phi.conj(), c, phi) * (2 * np.pi / 180)
    return (result / (2 * np.pi) ** 2).real


def wave_stress(k, z, thickness, poisson):
    """Stress (3, 3, 3) of such a wave along x at a depth, by tractions along x, y, z."""
    at, _, by = airy(k, thickness, poisson)
    f = at(z) @ by  # of x and z
    s = np.zeros((3, 3, 3), dtype=complex)
    plane = [0, 2]
    s[0, 0, plane], s[2, 2, plane] = f[2], -(k**2) * f[0]
    s[1, 1] = poisson * (s[0, 0] + s[2, 2])
    s[0, 2, plane] = s[2, 0, plane] = -1j * k * f[1]
    if np.isinf(thickness):
        along, across = np.exp(-k * z), np.exp(-k * z)
    else:
        along, across = (g(k * (thickness - z)) / np.cosh(k * thickness) for g in (np.sinh, np.cosh))
    s[0, 1, 1] = s[1, 0, 1] = 1j * along
    s[1, 2, 1] = s[2, 1, 1] = -across
    return s


@functools.lru_cache
def layer_stress(thickness, degree, points, deepest, poisson=0.3):
    """Axes x, y, z and the stresses (m, 3, nz, ny, nx, 6) of the layer less those of the half-space."""
    x, z = np.linspace(-1, 1, points), np.linspace(0, deepest, points)
    nodes, weights = np.polynomial.legendre.leggauss(48)
    most = 12 / (thickness - deepest / 2)
    ks, weights = 0.5 * most * (nodes + 1), 0.5 * most * weights
    angles = 2 * np.pi * (np.arange(72) + 0.5) / 72
    table, order = powers(degree), np.arange(degree + 1)
    cos, sin, zero = np.cos(angles), np.sin(angles), 0 * angles
    turn = np.stack([np.stack(row, -1) for row in ([cos, -sin, zero], [sin, cos, zero], [zero, zero, zero + 1])], -2)
    result = np.zeros((points, points**2, len(table) * 18), dtype=complex)
    for k, weight in zip(ks, weights):
        hats = [
            np.sqrt((2 * order + 1) / 2) * 2 * (-1j) ** order * spherical_jn(order, (k * d)[:, None])
            for d in (cos, sin)
        ]
        phi = hats[0][:, table[:, 0]] * hats[1][:, table[:, 1]]
        way = np.exp(1j * k * (cos[:, None, None] * x + sin[:, None, None] * x[:, None])).reshape(len(angles), -1)
        for n, depth in enumerate(z):
            s = wave_stress(k, depth, thickness, poisson) - wave_stress(k, depth, np.inf, poisson)
            s = np.einsum("tai,tbj,ijc,tdc->tabd", turn, turn, s, turn)[:, [0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]]
            by = np.einsum("tm,tsd->tmds", phi, s).reshape(len(angles), -1)
            result[n] += weight * k * 2 * np.pi / len(angles) / (2 * np.pi) ** 2 * (way.T @ by)
    shape = (points, points, points, len(table), 3, 6)
    return x, x, z, result.real.reshape(shape).transpose(3, 4, 0, 1, 2, 5)


def write(path, compliance, half=1.0, center=(0.0, 0.0), young=1.0, poisson=0.3, table=None, cases=None, stress=None):
    """A file; `half` scales a compliance of the patch [-1, 1]^2 and E = 1."""
    m = len(compliance)
    degree = next(n for n in range(40) if (n + 1) * (n + 2) // 2 >= m)
    with h5py.File(path, "w") as f:
        f.attrs.update(petsam_compliance=1, young=young, poisson=poisson, method="image", degree=degree)
        f.attrs.update(source="test", source_sha256="0" * 64)
        f["frame/origin"], f["frame/axes"] = np.zeros(3), np.eye(3)
        f["patch/center"], f["patch/half"] = np.array(center), np.broadcast_to(half, 2) * 1.0
        f["basis/degree_xy"] = powers(degree)[:m] if table is None else table
        f["compliance"] = compliance * half / (1 if np.isinf(young) else young)
        for name, field in (cases or {}).items():
            f[f"cases/{name}/displacement"] = field
        for name, value in (stress or {}).items():
            f[f"stress/{name}"] = value
    return path

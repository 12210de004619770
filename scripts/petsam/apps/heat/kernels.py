"""The temperature of a half-space's surface by heat that changes periodically in time, as a convolution.

A flux exp(i w t) through a cell, the rest of the surface being insulated, makes the temperature

    int exp(-kappa r)/(2 pi lam r) dA exp(i w t),   kappa = sqrt(i w/D),   Re kappa > 0,

lam being the conductivity and D = lam/(rho c) the diffusivity. Near the cell the integral is a sum over its corners in
polar coordinates, whose radial part is closed; farther away it is taken by Gauss points.

Source: Carslaw and Jaeger 1959, Conduction of Heat in Solids, ch. X.
"""

import numpy as np
import scipy.fft
from numpy.typing import ArrayLike

NEAR, MIDDLE = 4, 12  # lags in cells from which on the integral is one of 8 x 8, of 4 x 4 points
ANGLES = 40  # points of the integral around a corner


def _rule(count):
    """Gauss points and weights on (-1/2, 1/2)."""
    points, weights = np.polynomial.legendre.leggauss(count)
    return 0.5 * points, 0.5 * weights


def _corner(x, y, kappa):
    """The integral of exp(-kappa r)/r over the rectangle from 0 to (x, y), with the signs of both."""
    points, weights = _rule(ANGLES)
    total = 0.0
    for near, far in ((np.abs(x), np.abs(y)), (np.abs(y), np.abs(x))):  # the triangle at each side
        end = np.arcsinh(far / near)[..., None]
        cosh = np.cosh(end * (points + 0.5))
        radial = near[..., None] if kappa == 0 else -np.expm1(-kappa * near[..., None] * cosh) / (kappa * cosh)
        total = total + np.sum(end * weights * radial, axis=-1)
    return np.sign(x) * np.sign(y) * total


def _by_points(x, y, cell, kappa, count):
    """The integral by count x count Gauss points."""
    points, weights = _rule(count)
    total = np.zeros(np.broadcast(x, y).shape, dtype=complex)
    for u, a in zip(points, weights):
        for v, b in zip(points, weights):
            r = np.hypot(x + u * cell[0], y + v * cell[1])
            total += a * b * np.exp(-kappa * r) / r
    return total * cell[0] * cell[1]


def harmonic(x: ArrayLike, y: ArrayLike, cell: tuple[float, float], kappa: complex) -> np.ndarray:
    """The integral of exp(-kappa r)/(2 pi r) over a cell, m, complex, of the shape of the distances x, y of its centre
    from the point (m); its sides along x and y (m); kappa (1/m) is 0, or has a positive real part."""
    x, y = np.broadcast_arrays(np.asarray(x, dtype=float), np.asarray(y, dtype=float))
    away = np.maximum(np.abs(x) / cell[0], np.abs(y) / cell[1])
    a, b = 0.5 * cell[0], 0.5 * cell[1]
    found = np.empty(x.shape, dtype=complex)
    close = (away < NEAR) | (kappa == 0)
    p, q = x[close], y[close]
    found[close] = (
        _corner(p + a, q + b, kappa) - _corner(p - a, q + b, kappa)
        - _corner(p + a, q - b, kappa) + _corner(p - a, q - b, kappa)
    )  # fmt: skip
    for these, count in ((~close & (away < MIDDLE), 8), (~close & (away >= MIDDLE), 4)):
        found[these] = _by_points(x[these], y[these], cell, kappa, count)
    return found / (2 * np.pi)


class Conductor:
    """The operator from a periodic flux on cells to the temperature of a half-space's surface at their centres: shape
    (intervals, ny, nx) in equal intervals of the period (s), sides of a cell along x and y (m), conductivity, W/(m K),
    and capacity, density times specific heat, J/(m3 K)."""

    def __init__(
        self,
        shape: tuple[int, int, int],
        cell: tuple[float, float],
        period: float,
        conductivity: float,
        capacity: float,
    ) -> None:
        self.shape, self.padded = shape, tuple(scipy.fft.next_fast_len(2 * n) for n in shape[1:])
        order = np.arange(shape[0] // 2 + 1)
        self.kappa = np.sqrt(2j * np.pi * order / period * capacity / conductivity)
        y, x = (np.abs(np.fft.fftfreq(n) * n)[: n // 2 + 1] for n in self.padded)
        x, y = np.meshgrid(x * cell[0], y * cell[1])
        fold = [np.abs(np.rint(np.fft.fftfreq(n) * n)).astype(int) for n in self.padded]
        self._fold = np.ix_(*fold)  # kernels and their transforms are even: a quarter is enough
        quarter = tuple(slice(0, n) for n in x.shape)
        self._spectrum = np.array([
            scipy.fft.fft2((harmonic(x, y, cell, kappa) / conductivity)[self._fold])[quarter] for kappa in self.kappa
        ])  # fmt: skip
        wave_y, wave_x = (2 * np.pi * np.abs(np.fft.fftfreq(n, d)) for n, d in zip(self.padded, cell[::-1]))
        square = np.add.outer(wave_y**2, wave_x**2)
        square[0, 0] = (0.5 * np.pi / max(n * d for n, d in zip(self.padded, cell[::-1]))) ** 2
        self._square, self._conductivity = square, conductivity

    def symbol(self, k: int) -> np.ndarray:
        """The temperature of each wave of the harmonic k by a unit of its flux, K m2/W, on the padded grid."""
        return 1 / (self._conductivity * np.sqrt(self._square + self.kappa[k] ** 2))

    def response(self, k: int) -> np.ndarray:
        """The transform of the kernel of the harmonic k, K m2/W, on the padded grid."""
        return self._spectrum[k][self._fold]

    def __call__(self, flux: np.ndarray) -> np.ndarray:
        """The temperature by a flux (W/m2), both (intervals, ny, nx), relative to that of the bulk, K."""
        return applied(flux, self.padded, self.response)


def applied(field, padded, factor):
    """A field (intervals, ny, nx) whose transforms in time and space are multiplied by factor(k) of the harmonic k."""
    count, ny, nx = field.shape
    waves = scipy.fft.rfft(field, axis=0)
    for k, wave in enumerate(waves):
        waves[k] = scipy.fft.ifft2(scipy.fft.fft2(wave, padded) * factor(k))[:ny, :nx]
    return scipy.fft.irfft(waves, count, axis=0)

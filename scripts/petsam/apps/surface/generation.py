"""Random surfaces of a given power spectrum, periodic over the grid, with Gaussian or other heights.

The spectrum C(q) (m^4, q in rad/m) is isotropic and two-dimensional: the mean square height is the integral of C over
all wave vectors. A self-affine surface has C ~ q^(-2 (1 + H)) between its longest and its shortest wavelength (B. N. J.
Persson and others, Journal of Physics: Condensed Matter 17 (2005) R1-R62). The waves of a seed depend on the size and
the shortest wavelength only: a finer grid shows the same surface.

Other heights are a function of the Gaussian ones, point by point (M. Grigoriu, Journal of Engineering Mechanics 110
(1984) 610-620): of a table of heights and the share of points below them, or the cubic polynomial that has a given
skewness and kurtosis (A. I. Fleishman, Psychometrika 43 (1978) 521-532). This changes the spectrum somewhat, and adds
waves shorter than the shortest.
"""

import numpy as np
from scipy.optimize import least_squares
from scipy.special import ndtr

from ...core.errors import Error
from ...core.texttable import Text
from ...core.units import shown

MOST = 1 << 13  # waves along a side
FOLD = 2.0  # within so many rms heights, 95 % of the points, higher Gaussian heights become higher ones


def tabulated(path):
    """The spectrum of a table of q (rad/m) and C (m^4), linear in logarithms, 0 outside; its shortest wavelength."""
    table, *_ = Text(path).table
    if table.shape[1] != 2 or table.shape[0] < 2 or not np.all(table > 0.0) or not np.all(np.diff(table[:, 0]) > 0.0):
        raise Error(f"{path}: expected lines of q (rad/m), increasing, and C (m^4), both above 0")
    q, c = np.log(table).T
    inside = lambda k: (k >= q[0] - 1e-9) & (k <= q[-1] + 1e-9)  # noqa: E731
    return lambda k: np.where(inside(np.log(k)), np.exp(np.interp(np.log(k), q, c)), 0.0), 2.0 * np.pi / table[-1, 0]


def cubic(skewness, kurtosis):
    """The function of Gaussian heights of mean square 1 to those of mean 0, mean square 1 with these moments."""

    def moments(v):
        b, c, d = v
        return (
            b * b + 6 * b * d + 2 * c * c + 15 * d * d - 1.0,
            2 * c * (b * b + 24 * b * d + 105 * d * d + 2) - skewness,
            24 * (b * d + c * c * (1 + b * b + 28 * b * d) + d * d * (12 + 48 * b * d + 141 * c * c + 225 * d * d))
            - (kurtosis - 3.0),
        )

    found = least_squares(moments, (1.0, skewness / 6.0, 0.0), xtol=1e-15, ftol=1e-15, gtol=1e-15)
    b, c, d = found.x
    g = np.linspace(-FOLD, FOLD, 101)
    if np.abs(found.fun).max() > 1e-9 or np.min(b + g * (2.0 * c + g * 3.0 * d)) < 0.0:
        raise Error(
            f"no heights of skewness {skewness:g} and kurtosis {kurtosis:g} by a cubic polynomial; use a kurtosis "
            f"nearer to {3.0 + 1.5 * skewness**2:.3g}, or a table (--distribution)"
        )
    return lambda g: -c + g * (b + g * (c + g * d))


def distributed(path):
    """The function of Gaussian heights of mean square 1 to those of a table of heights (m) and shares below them."""
    table, *_ = Text(path).table
    good = table.shape[1] == 2 and table.shape[0] >= 2 and np.all(np.diff(table, axis=0) > 0.0)
    if not good or table[0, 1] < 0.0 or table[-1, 1] > 1.0:
        raise Error(f"{path}: expected lines of a height (m) and the share of points below it, 0 to 1, both increasing")
    return lambda g: np.interp(ndtr(g), table[:, 1], table[:, 0])


def shaped(values, function, rms=None):
    """Heights of another distribution, of mean 0; scaled to the rms height (m) if given."""
    values = function(values / np.sqrt(np.mean(values**2)))
    values = values - values.mean()
    return values if rms is None else values * (rms / np.sqrt(np.mean(values**2)))


def heights(spectrum, n, size, shortest, seed=0, rms=None):
    """Heights (ny, nx), m, with mean 0, of waves down to the shortest; scaled to the rms height (m) if given."""
    counts = [int(np.floor(side / shortest * (1.0 + 1e-9))) for side in size]
    for count, cells, side in zip(counts, n, size):
        if cells < 2 * count + 1:
            raise Error(
                f"the shortest wavelength {shown(shortest)} has {cells / side * shortest:.3g} cells of the grid; "
                "use more than 2: a finer --grid-n, or longer --wavelengths"
            )
        if count > MOST:
            raise Error(f"{count} waves along a side of {shown(side)}; use at most {MOST}: longer --wavelengths")
    kx, ky = np.arange(counts[0] + 1), np.arange(-counts[1], counts[1] + 1)
    random = np.random.default_rng(seed).standard_normal((ky.size, kx.size, 2))
    q = 2.0 * np.pi * np.hypot(kx[None, :] / size[0], ky[:, None] / size[1])
    cell = (2.0 * np.pi) ** 2 / (size[0] * size[1])
    known = np.zeros(q.shape)
    known[q > 0.0] = spectrum(q[q > 0.0]) * cell
    # half of the waves stand for all; those of kx = 0 are two times there
    waves = np.sqrt(known) * (random[..., 0] + 1j * random[..., 1]) / np.sqrt(2.0)
    waves[ky > 0, 0] = np.conj(waves[ky < 0, 0][::-1])
    whole = np.zeros((n[1], n[0] // 2 + 1), dtype=complex)
    whole[ky % n[1], : kx.size] = waves
    values = np.fft.irfft2(whole, s=(n[1], n[0])) * n[0] * n[1]
    found = float(np.sqrt(np.mean(values**2)))
    if not found > 0.0:
        raise Error(
            f"the spectrum has no wave between {shown(shortest)} and the size; use a larger --size or --wavelengths"
        )
    return values if rms is None else values * (rms / found)

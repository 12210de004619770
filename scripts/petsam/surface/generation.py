"""Random surfaces: Gaussian heights of a given power spectrum, periodic over the grid.

The spectrum C(q) (m^4, q in rad/m) is isotropic and two-dimensional: the mean square height is the integral of C over
all wave vectors. A self-affine surface has C ~ q^(-2 (1 + H)) between its longest and its shortest wavelength (B. N. J.
Persson and others, Journal of Physics: Condensed Matter 17 (2005) R1-R62). The waves of a seed depend on the size and
the shortest wavelength only: a finer grid shows the same surface.
"""

import numpy as np

from ..errors import Error
from .lengths import shown
from .tables import read_table

RESOLVED = 2.0  # cells in the shortest wavelength at least
MOST = 1 << 13  # waves along a side


def self_affine(hurst, longest, shortest):
    """The spectrum, without its factor, as a function of q."""
    low, high = 2.0 * np.pi / longest, 2.0 * np.pi / shortest
    slack = 1.0 + 1e-9
    return lambda q: np.where((q * slack >= low) & (q <= high * slack), q ** (-2.0 * (1.0 + hurst)), 0.0)


def tabulated(path):
    """The spectrum of a table of q (rad/m) and C (m^4), linear in logarithms, 0 outside; its shortest wavelength."""
    table, _ = read_table(path)
    if table.shape[1] != 2 or table.shape[0] < 2 or not np.all(table > 0.0) or not np.all(np.diff(table[:, 0]) > 0.0):
        raise Error(f"{path}: expected lines of q (rad/m), increasing, and C (m^4), both above 0")
    q, c = np.log(table).T
    inside = lambda k: (k >= q[0] - 1e-9) & (k <= q[-1] + 1e-9)  # noqa: E731
    return lambda k: np.where(inside(np.log(k)), np.exp(np.interp(np.log(k), q, c)), 0.0), 2.0 * np.pi / table[-1, 0]


def heights(spectrum, n, size, shortest, seed=0, rms=None):
    """Heights (ny, nx), m, with mean 0, of waves down to the shortest; scaled to the rms height (m) if given."""
    counts = [int(np.floor(side / shortest * (1.0 + 1e-9))) for side in size]
    for count, cells, side in zip(counts, n, size):
        if cells < RESOLVED * count + 1:
            raise Error(
                f"the shortest wavelength {shown(shortest)} has {cells / side * shortest:.3g} cells of the grid; "
                f"use at least {RESOLVED:g}: a finer --grid-n, or longer --wavelengths"
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

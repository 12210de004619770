"""The flux through the spots of a contact between two conductors, by conjugate gradients with Fourier transforms.

Bodies of conductivities lam1, lam2 (W/(m K), or S/m) are insulated outside of the cells that conduct. With V the
difference of their potentials far away, q the flux density through a cell, and r the resistance of a film on it,

    (K + r) q = V,    K q = (1/lam1 + 1/lam2) int q dA'/(2 pi R).

K is the operator of the normal problem with 2/E* replaced by 1/lam1 + 1/lam2: for half-spaces the potential at the
centres of cells with constant flux, for one period the exact relation of each wave without the mean one, since that is
what the bodies conduct without a contact. Gas of conductivity lam in a gap g is r = (g + M)/lam on the cells that are
open, M the length of the temperature jump.

Sources: J. R. Barber, Proc. R. Soc. A 459 (2003) 53 (K and the contact stiffness); R. Holm, Electric Contacts (1967).
"""

from typing import Optional

import numpy as np
from numpy.typing import ArrayLike

from ..core.errors import Error

MOST = 500  # steps of conjugate gradients; 10 to 50 are usual


def _corner(x, y):
    """The integral of 1/R over the rectangle from 0 to (x, y), with the signs of both."""
    return x * np.arcsinh(y / np.abs(x)) + y * np.arcsinh(x / np.abs(y))


def _symbol(shape, cell, periodic):
    """The transform of K for a sum of resistivities of 1 m K/W, and the shape that is transformed."""
    ny, nx = shape
    if periodic:
        k = 2 * np.pi * np.hypot(*np.meshgrid(np.fft.rfftfreq(nx, cell[0]), np.fft.fftfreq(ny, cell[1])))
        k[0, 0] = np.inf
        return 1 / k, shape
    padded = 2 * ny, 2 * nx
    x, y = ((np.fft.fftfreq(n) * n)[:n] * width for n, width in ((padded[1], cell[0]), (padded[0], cell[1])))
    x, y = np.meshgrid(x, y)
    a, b = cell[0] / 2, cell[1] / 2
    kernel = _corner(x + a, y + b) - _corner(x - a, y + b) - _corner(x + a, y - b) + _corner(x - a, y - b)
    return np.fft.rfft2(kernel / (2 * np.pi)), padded


def _waves(shape, cell):
    """abs(k) of the waves of a field, with that of the longest one for the mean."""
    k = 2 * np.pi * np.hypot(*np.meshgrid(np.fft.rfftfreq(shape[1], cell[0]), np.fft.fftfreq(shape[0], cell[1])))
    k[0, 0] = np.pi / max(shape[0] * cell[1], shape[1] * cell[0])
    return k


def conduct(
    conducts: ArrayLike,
    cell: tuple[float, float],
    resistivity: float,
    resistance: Optional[ArrayLike] = None,
    periodic: bool = False,
    rtol: float = 1e-8,
) -> np.ndarray:
    """The flux density through cells for a difference of potentials of 1.

    Parameters
    ----------
    conducts : array_like of bool
        The cells through which flux passes, (ny, nx).
    cell : pair of floats
        Widths of a cell along x and y, m.
    resistivity : float
        1/lam1 + 1/lam2 of the bodies, m K/W, or Ohm m.
    resistance : array_like, optional
        Of a film or gas on each cell, (ny, nx) or a number, K m2/W, or Ohm m2; None: none.
    periodic : bool
        Whether the field is one period of both bodies; else they are half-spaces.
    rtol : float
        Relative residual at which the solution is accepted.

    Returns
    -------
    ndarray
        Flux density, (ny, nx), W/(m2 K), or S/m2; 0 on cells that do not conduct.

    Raises
    ------
    Error
        If no cell conducts, a number is not positive, or the iteration does not converge.
    """
    cells = np.asarray(conducts, dtype=bool)
    if cells.ndim != 2 or not cells.any():
        raise Error("conduction: no cell conducts: there is no contact, and no gas in the gap")
    if not resistivity > 0 or not np.isfinite(resistivity):
        raise Error(f"conduction: a sum of resistivities of {resistivity:g}: conductivities must be finite and above 0")
    film = np.broadcast_to(np.asarray(0.0 if resistance is None else resistance, dtype=float), cells.shape)
    if not np.all(film[cells] >= 0) or not np.all(np.isfinite(film[cells])):
        raise Error("conduction: resistances of films and gas must be finite numbers >= 0")
    if periodic and cells.all() and not film.any():
        raise Error("conduction: all cells of the period touch without a film: the interface has no resistance")
    symbol, padded = _symbol(cells.shape, cell, periodic)
    symbol, mask, film = resistivity * symbol, cells.astype(float), np.where(cells, film, 0.0)

    def apply(q):
        spread = np.fft.irfft2(np.fft.rfft2(q, padded) * symbol, padded)[: cells.shape[0], : cells.shape[1]]
        return mask * spread + film * q

    return _solve(apply, _preconditioner(cells, cell, resistivity, film), cells, rtol)


def _preconditioner(cells, cell, resistivity, film):
    """
    The inverse of each wave with the harmonic mean m of the resistances, between weights sqrt(m/(r + c)), c that of a
    cell by its own flux: films and gas differ by orders of magnitude from cell to cell.
    """
    own = film + resistivity * _corner(cell[0] / 2, cell[1] / 2) * 4 / (2 * np.pi)
    mean = 1 / np.mean(1 / own[cells])
    weights = np.where(cells, np.sqrt(mean / own), 0.0)
    inverse = 1 / (resistivity / _waves(cells.shape, cell) + (mean if film.any() else 0.0))
    return lambda field: weights * np.fft.irfft2(np.fft.rfft2(weights * field) * inverse, cells.shape)


def _solve(apply, precondition, cells, rtol):
    """Conjugate gradients for a potential of 1 on the cells."""
    q, residual = np.zeros(cells.shape), cells.astype(float)
    enough = rtol * np.sqrt(np.vdot(residual, residual))
    direction = precondition(residual)
    product = np.vdot(residual, direction)
    for _ in range(MOST):
        applied = apply(direction)
        step = product / np.vdot(direction, applied)
        q += step * direction
        applied *= step
        residual -= applied
        if np.sqrt(np.vdot(residual, residual)) <= enough:
            return q
        z = precondition(residual)
        product, last = np.vdot(residual, z), product
        direction *= product / last
        direction += z
    raise Error(f"conduction: no convergence within {MOST} iterations: resistances may differ by too many orders")

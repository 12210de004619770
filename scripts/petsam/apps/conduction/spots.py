"""The flux through the spots of a contact between two conductors, by conjugate gradients with Fourier transforms.

Bodies of conductivities lam1, lam2 (W/(m K), or S/m) are insulated outside of the cells that conduct. With V the
difference of their potentials far away, q the flux density through a cell, and r the resistance of a film on it,

    (K + r) q = V,    K q = (1/lam1 + 1/lam2) int q dA'/(2 pi R).

K is the operator of the normal problem with 2/E* replaced by 1/lam1 + 1/lam2: for half-spaces the potential at the
centres of cells with constant flux, for one period the exact relation of each wave without the mean one, since that is
what the bodies conduct without a contact. Gas of conductivity lam in a gap g is r = (g + M)/lam on the cells that are
open, M the length of the temperature jump. With layers 1/lam is F(k) of a wave (layers.py).

A field of one period that is its own mirror image along x and along y, as a window of a surface with its mirror images
is, is solved in a quarter of it, with cosines for waves.

The preconditioner is, with c the potential of a cell by a flux of 1 through it, and m the minimum of r + c,

    P = w S w + (1 - w^2)/(r + c),    S = 1/(F(k)/k + m - c),    w = sqrt(m/(r + c)):

S couples the cells of small resistance, the spots, as bodies do; the others, of gas, conduct side by side. Applications
of K to a residual of 3e-4, of roughness on steel with 256 x 256 points in a quarter, at 5 to 80 MPa: bare 5 to 8, in
air 7 to 9, in oil 6 to 9, oil between plastics up to 23; S alone, between weights of all cells, needs 12 to 38 in air.

Sources: J. R. Barber, Proc. R. Soc. A 459 (2003) 53 (K and the contact stiffness); R. Holm, Electric Contacts (1967).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple, Optional, Union

import numpy as np
from numpy.typing import ArrayLike

from ...core.errors import Error
from .layers import Body

MOST = 500  # steps of conjugate gradients; 5 to 50 are usual


class _Waves(NamedTuple):
    """Transforms of fields of a shape, (ny, nx), and abs(k) of their waves, 0 of the mean."""

    forward: Callable
    back: Callable
    k: np.ndarray


def _waves(shape, cell):
    """The waves of one period."""
    k = 2 * np.pi * np.hypot(*np.meshgrid(np.fft.rfftfreq(shape[1], cell[0]), np.fft.fftfreq(shape[0], cell[1])))
    return _Waves(np.fft.rfft2, lambda field: np.fft.irfft2(field, shape), k)


def _cosines(shape, cell):
    """The waves of the quarter, of this shape, of a period that is its own mirror image along x and y."""
    from scipy.fft import dctn, idctn

    k = np.pi * np.hypot(*np.meshgrid(*(np.arange(n) / (n * width) for n, width in zip(shape[::-1], cell))))
    return _Waves(dctn, idctn, k)


def _over_k(bodies, k, longest):
    """The sum of F(k)/k of bodies, with the longest wave in place of the mean; inf: 0 there."""
    k = np.where(k > 0, k, longest)
    return sum(body.resistivity(k) for body in bodies) / k


def _corner(x, y, depth=0.0):
    """The integral of 1/sqrt(R^2 + depth^2) over the rectangle from 0 to (x, y), with the signs of both."""
    found = x * np.arcsinh(y / np.hypot(x, depth)) + y * np.arcsinh(x / np.hypot(y, depth))
    if depth:
        found = found - depth * np.arctan(x * y / (depth * np.sqrt(x * x + y * y + depth * depth)))
    return found


def _own(cell, bodies):
    """The potential at the centre of a cell by a flux of 1 through it, of layered bodies nearly."""
    factor = sum(body.resistivity(np.pi / np.sqrt(cell[0] * cell[1])) for body in bodies)
    return factor * 4 * _corner(cell[0] / 2, cell[1] / 2) / (2 * np.pi)


def _of_half_spaces(shape, cell, bodies):
    """K of half-spaces, a function of a field."""
    x, y = np.meshgrid(*((np.arange(n + 1) - 0.5) * width for n, width in zip(shape[::-1], cell)))
    corners = sum(weight * _corner(x, y, depth) for body in bodies for depth, weight in body.images())
    quarter = np.diff(np.diff(corners, axis=0), axis=1) / (2 * np.pi)
    # distances of 0 to n - 1 cells, then, after one that no two cells have, of -(n - 1) to -1
    kernel = np.pad(quarter, [(0, 1), (0, 1)])
    kernel = np.concatenate([kernel, kernel[-2:0:-1]])
    kernel = np.concatenate([kernel, kernel[:, -2:0:-1]], axis=1)
    padded, symbol = kernel.shape, np.fft.rfft2(kernel)
    return lambda q: np.fft.irfft2(np.fft.rfft2(q, padded) * symbol, padded)[: shape[0], : shape[1]]


def conduct(
    conducts: ArrayLike,
    cell: tuple[float, float],
    resistivity: Union[float, Sequence[Body]],
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
    resistivity : float or sequence of Body
        1/lam1 + 1/lam2 of the bodies, m K/W, or Ohm m; or the bodies, with layers on them.
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

    Examples
    --------
    >>> import numpy as np, petsam
    >>> x = (np.arange(64) - 31.5) * 1e-5
    >>> spot = np.hypot(x, x[:, None]) < 2e-4  # a circle, m
    >>> flux = petsam.conduction.conduct(spot, (1e-5, 1e-5), 2 / 50.0)  # two bodies of 50 W/(m K)
    >>> bool(abs(flux.sum() * 1e-10 / (2 * 50.0 * 2e-4 / 1.0) - 1) < 0.02)  # 2 a lam, of Holm
    True
    """
    cells = np.asarray(conducts, dtype=bool)
    if cells.ndim != 2 or not cells.any():
        raise Error("conduction: no cell conducts: there is no contact, and no gas in the gap")
    bodies = _bodies(resistivity)
    film = np.broadcast_to(np.asarray(0.0 if resistance is None else resistance, dtype=float), cells.shape)
    if not np.all(film[cells] >= 0) or not np.all(np.isfinite(film[cells])):
        raise Error("conduction: resistances of films and gas must be finite numbers >= 0")
    if periodic and cells.all() and not film.any():
        raise Error("conduction: all cells of the period touch without a film: the interface has no resistance")
    film, own = np.where(cells, film, 0.0), _own(cell, bodies)
    longest = np.pi / max(n * width for n, width in zip(cells.shape[::-1], cell))
    folds = periodic and _is_mirrored(cells, film, own, rtol)
    if folds:
        cells, film = _quarter(cells) > 0.5, _quarter(film)
    waves = (_cosines if folds else _waves)(cells.shape, cell)
    spread = _of_waves(waves, bodies) if periodic else _of_half_spaces(cells.shape, cell, bodies)
    mask = cells.astype(float)
    precondition = _preconditioner(waves, _over_k(bodies, waves.k, longest), cells, film + own, own)
    q = _solve(lambda q: mask * spread(q) + film * q, precondition, cells, rtol)
    return np.pad(q, [(0, n) for n in q.shape], mode="symmetric") if folds else q


def _bodies(resistivity):
    """The bodies of a sum of resistivities, or as given; Error for wrong numbers."""
    if isinstance(resistivity, (float, int, np.number)):
        if not resistivity > 0 or not np.isfinite(resistivity):
            raise Error(
                f"conduction: a sum of resistivities of {resistivity:g}: conductivities must be finite and above 0"
            )
        return (Body(1 / float(resistivity)),)
    return tuple(Body(*body).checked() for body in resistivity)


def _is_mirrored(cells, film, own, rtol):
    """True if the field is its own mirror image along x and y; resistances up to rtol, as the flux through all cells
    has an error of its square by that: turned round, the difference has the other sign and the flux is the same."""
    return all(
        n % 2 == 0
        and np.array_equal(cells, np.flip(cells, d))
        and bool(np.all(np.abs(film - np.flip(film, d)) <= rtol * (film + own)))
        for d, n in enumerate(cells.shape)
    )


def _quarter(field):
    """The first quarter of a field, the mean of the four."""
    ny, nx = (n // 2 for n in field.shape)
    return sum(np.flip(field, axes)[:ny, :nx] for axes in ((), 0, 1, (0, 1))) / 4


def _of_waves(waves, bodies):
    """K of one period, a function of a field."""
    symbol = _over_k(bodies, waves.k, np.inf)
    return lambda q: waves.back(waves.forward(q) * symbol)


def _preconditioner(waves, symbol, cells, total, own):
    """P, a function of a field, with F(k)/k of waves and the sum of each cell's resistance and own."""
    least = total[cells].min()
    share = np.where(cells, least / total, 0.0)
    weights, rest = np.sqrt(share), np.where(cells, (1.0 - share) / total, 0.0)
    inverse = 1 / (symbol + (least - own))
    return lambda field: weights * waves.back(waves.forward(weights * field) * inverse) + rest * field


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

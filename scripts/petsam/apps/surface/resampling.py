"""A map on another grid, of means over its cells.

Values are taken as means over their cells. Their running integral, a cubic spline through the cells' edges, gives the
mean over any other cell. So the mean of the surface is kept, waves that coarser cells cannot show are damped instead of
falsified, and a surface of second order is kept exactly.
"""

from dataclasses import replace

import numpy as np

from ...core.errors import Error
from ...core.units import shown
from .basics import SAME

BLOCK = 256  # columns at a time: the spline takes several times their memory


def _along_rows(values, old, new):
    """Means over cells between the edges `new` of rows of means over cells between the edges `old`."""
    from scipy.interpolate import CubicSpline

    result = np.empty((len(new) - 1, values.shape[1]))
    for first in range(0, values.shape[1], BLOCK):
        part = values[:, first : first + BLOCK]
        base = part.mean(axis=0)  # small numbers are rounded less
        integral = np.zeros((len(old), part.shape[1]))
        np.cumsum((part - base) * np.diff(old)[:, None], axis=0, out=integral[1:])
        means = np.diff(CubicSpline(old, integral, axis=0)(new), axis=0) / np.diff(new)[:, None]
        result[:, first : first + BLOCK] = means + base
    return result


def resampled(one, n=None, size=None):
    """The map on n cells in x, y (None: cells about as wide as they are) over a size about its centre (None: all)."""
    wanted = tuple(size or one.size)
    for d in (0, 1):
        if wanted[d] > one.size[d] * (1.0 + SAME):
            raise Error(
                "{}: --grid-size: {} in {}, but the map has only {} there".format(
                    one.name, shown(wanted[d]), "xy"[d], shown(one.size[d])
                )
            )
    n = tuple(n or (max(2, round(one.n[d] * wanted[d] / one.size[d])) for d in (0, 1)))
    values = one.values
    for d in (1, 0):
        if n[d] == one.n[d] and abs(wanted[d] - one.size[d]) <= SAME * one.size[d]:
            continue
        # over cells, from the middle
        old = np.arange(one.n[d] + 1) - one.n[d] / 2
        half = min(wanted[d] / one.size[d], 1.0) * one.n[d] / 2
        new = np.linspace(-half, half, n[d] + 1)
        values = _along_rows(values, old, new) if d else _along_rows(values.T, old, new).T
    return replace(one, values=np.ascontiguousarray(values), size=wanted, places=None)

"""Points x, y, z of a regular grid in any order, and profiles x, z, in texts."""

import numpy as np

from ...core.errors import Error, counted
from .. import headers
from ..basics import SAME
from ..doubts import FEWEST, NARROW
from .stated import Reader, Stated
from .texts import left_out, need_mentioned, unread

EVEN = 1e-3  # relative difference of a size and of what positions span
ROUNDED = 0.1  # of a step: deviation of positions, which are printed with few digits
FILLED = 0.5  # share of the points of a grid that a list has at least: instruments leave out those without a height


class Axis:
    """Even positions in a column of numbers: their count, step, and the place of each number."""

    def __init__(self, column):
        self.n, self.step, self.index = 0, 0.0, None
        if column.size < 2 or not np.all(np.isfinite(column)):
            return
        rising = np.sort(column)
        gaps = np.diff(rising)
        starts = np.flatnonzero(gaps > 0.5 * gaps.max()) + 1  # of the next position
        if not gaps.max() > 0.0:
            return
        centres = np.array([part.mean() for part in np.split(rising, starts)])
        step = (centres[-1] - centres[0]) / (centres.size - 1)
        index = np.rint((column - centres[0]) / step)
        near = np.abs(column - centres[0] - index * step) <= ROUNDED * step
        if np.all(near) and np.unique(index).size == centres.size:
            self.n, self.step, self.index = centres.size, float(step), index.astype(int)


def _agreed(path, one, other):
    """One of two units (m), None where there is neither; Error where they differ."""
    if one and other and abs(one - other) > SAME * one:
        raise Error(f"{path}: its header and the heads of its columns give different units: correct one of them")
    return one or other


def _stated(source, values, spans, remarks):
    """The statements about values whose columns span lengths along x, y in the file's unit."""
    path, header = source.path, source.header()
    heads = headers.of_columns(path, source.text.header, source.text.table[0].shape[1])
    lateral = _agreed(path, heads.lateral, header.lateral)
    unit = _agreed(path, heads.unit, header.unit)
    if unit is None:
        need_mentioned(path, header, source.how.units)
    sides = headers.size_of(path, header, values.shape[::-1])
    size = tuple(span * lateral for span in spans) if lateral else None
    for side, span in zip(sides, spans):
        if side and lateral and abs(side - span * lateral) > EVEN * side:
            raise Error(f"{path}: its positions and the size in its header contradict each other: correct one of them")
    remarks = (*left_out(source.text.table[1]), *remarks, "positions left out: the middle is x = y = 0")
    return Stated(
        values, unit, size, top=False, remarks=remarks, doubts=unread(header), lines={**header.lines, **heads.lines},
        sides=(None, None) if size else sides, spans=None if lateral else spans,
    )  # fmt: skip


class Points(Reader):
    """Lines x, y, z, of which absent points and further columns are said; heads of columns may state units."""

    family = "table"
    states = ("unit", "size", "first row", "missing points")

    def recognizes(self, source):
        """By a regular grid of the first two columns, each point once, with half of its points at least."""
        return source.is_list and self._axes(source) is not None

    @staticmethod
    def _axes(source):
        """The axes of a list of points, or None."""
        values = source.text.table[0]
        rows, columns = values.shape
        if not 3 <= columns <= NARROW or rows < 4:
            return None
        x, y = (Axis(values[:, d]) for d in (0, 1))
        if min(x.n, y.n) < 2 or not FILLED * x.n * y.n <= rows <= x.n * y.n:
            return None
        return (x, y) if np.unique(x.index + y.index * x.n).size == rows else None

    def read(self, source):
        """The heights on the grid."""
        values = source.text.table[0]
        x, y = self._axes(source)
        heights = np.full((y.n, x.n), np.nan)
        heights[y.index, x.index] = values[:, 2]
        absent = heights.size - len(values)
        remarks = [f"points x, y, z of {x.n} x {y.n} places"]
        remarks += [f"{counted(absent, 'point')} absent: taken as missing"] if absent else []
        more = values.shape[1] - 3
        remarks += [] if more < 1 else ["column 4 left out" if more == 1 else f"columns 4 to {more + 3} left out"]
        return _stated(source, heights, (x.n * x.step, y.n * y.step), remarks)


class Profile(Reader):
    """Lines x, z with even x that rises or falls throughout: a profile (1, nx), for plane strain."""

    family = "table"
    states = ("unit", "size", "missing points")

    def recognizes(self, source):
        """By two columns, the first of which rises or falls in even steps."""
        if not source.is_list or source.text.table[0].shape[1] != 2 or len(source.text.table[0]) < FEWEST:
            return False
        x = source.text.table[0][:, 0]
        steps = np.diff(x)
        return bool(Axis(x).n == len(steps) + 1 and (np.all(steps > 0.0) or np.all(steps < 0.0)))

    def read(self, source):
        """The heights, from the smallest x on."""
        values = source.text.table[0]
        axis = Axis(values[:, 0])
        heights = np.empty((1, axis.n))
        heights[0, axis.index] = values[:, 1]
        return _stated(source, heights, (axis.n * axis.step,), [f"profile x, z of {axis.n} points"])

"""Points x, y, z of a regular grid in any order, and profiles x, z: in texts, and in arrays of any format."""

import numpy as np

from ....core.errors import Error, counted
from .. import headers
from ..basics import SAME
from ..doubts import FEWEST, LIST, NARROW, need_map
from .stated import Reader, Stated
from .texts import left_out, need_mentioned, unread

EVEN = 1e-3  # relative difference of a size and of what positions span
ROUNDED = 0.1  # of a step: deviation of positions, which are printed with few digits
DIGITS = 12  # at most, with which positions are taken for rounded
EXACT = 1e-12  # relative error of a number of few digits in double precision
DOUBLE = 1.4  # of a step: gaps of positions beyond which one may be absent
CLOSEST = 1.1  # of half a unit of the last digit: step of positions beyond which they may be rounded ones
REPEATED = 3  # such gaps from which on they are those of rounding
FILLED = 0.5  # share of the points of a grid that a list has at least: instruments leave out those without a height
CENTRED = "positions left out: the middle is x = y = 0"


class Axis:
    """Even positions in a column of numbers: count, step, place of each number, and whether they are of few digits.

    Positions of few digits are even within half a unit of their last digit, others within ROUNDED of a step.
    """

    def __init__(self, column):
        self.n, self.step, self.index, self.rounded = 0, 0.0, None, False
        if column.size < 2 or not np.all(np.isfinite(column)) or not np.ptp(column) > 0.0:
            return
        rising, place = np.unique(column, return_inverse=True)
        half = _half_unit(rising)
        gaps = np.diff(rising)
        near = np.concatenate([[0], np.cumsum(gaps > 0.5 * gaps.max())])  # of numbers that differ little
        sets = [near] if near[-1] + 1 == rising.size else [near, np.arange(rising.size)]
        for index in sets:
            self.step, self.rounded = _even(index, rising, half)
            if self.step:
                self.n, self.index = int(index[-1]) + 1, index[place]
                return

    @classmethod
    def along(cls, column):
        """The axis of numbers that rise or fall throughout; few digits may have made neighbours the same."""
        axis = cls(column)
        steps = np.diff(column)
        if not np.all(np.isfinite(column)) or not (np.all(steps >= 0.0) or np.all(steps <= 0.0)):
            axis.n = 0
        elif axis.n < column.size:
            order, rising = np.arange(column.size), np.sort(column)
            half = _half_unit(rising)
            axis.step, axis.rounded = _even(order, rising, half)
            few = axis.step > CLOSEST * half.max()  # else there are too many numbers for their digits
            axis.n, axis.index = (column.size if few else 0), (order if column[-1] > column[0] else order[::-1])
        return axis

    def remark(self, name):
        """Returns a remark on positions of few digits, in a list; none for others."""
        said = f"positions {name} have few digits: taken for even, with a step of {self.step:.6g}"
        return [said] if self.rounded else []


def _half_unit(values):
    """Half a unit of the last digit of each number, as written with so many decimals, or with so many digits."""
    largest = np.max(np.abs(values))
    power = np.floor(np.log10(np.where(values == 0.0, largest, np.abs(values))))
    whole = int(np.floor(np.log10(largest)))
    units = []
    for of in (whole, power):  # the first digit of the largest number, or of each
        for digits in range(DIGITS):
            unit = 10.0 ** (of - digits)
            if np.all(np.abs(values - np.rint(values / unit) * unit) <= EXACT * largest):
                units.append(np.broadcast_to(unit, values.shape))
                break
    return 0.5 * np.max(units, axis=0) if units else np.zeros(values.shape)


def _even(index, values, half):
    """Step of numbers in even places, 0.0 where they lie in none; whether they do but for their few digits.

    half: what rounding may have moved each number by. Where a few gaps alone are twice as wide as the others, positions
    are absent rather than rounded.
    """
    from scipy.optimize import linprog

    step, first = np.polyfit(index, values, 1)
    if not step > 0.0:
        return 0.0, False
    if np.all(np.abs(values - first - step * index) <= ROUNDED * step):
        return float(step), False
    wide = np.count_nonzero(np.diff(values) > DOUBLE * step * np.diff(index)) if index[-1] + 1 == index.size else 1
    if not np.any(half) or 0 < wide < REPEATED:
        return 0.0, False
    slack = half + EXACT * np.max(np.abs(values))
    lines = np.column_stack([np.ones(index.size), index])
    fit = linprog(
        [0.0, 0.0], np.vstack([lines, -lines]), np.concatenate([values + slack, slack - values]), bounds=(None, None)
    )
    return (float(step), True) if fit.status == 0 else (0.0, False)


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
    remarks = (*left_out(source.text), *remarks, CENTRED)
    return Stated(
        values, unit, size, top=False, remarks=remarks, doubts=unread(header), lines={**header.lines, **heads.lines},
        sides=(None, None) if size else sides, spans=None if lateral else spans, layout="grid",
    )  # fmt: skip


def _lattice(values):
    """Axes x and y of points on a regular grid, each once, with half of its points at least; None of others."""
    rows, columns = values.shape
    if not 3 <= columns <= NARROW or rows < 4:
        return None
    x, y = (Axis(values[:, d]) for d in (0, 1))
    if min(x.n, y.n) < 2 or not FILLED * x.n * y.n <= rows <= x.n * y.n:
        return None
    return (x, y) if np.unique(x.index + y.index * x.n).size == rows else None


def _line(values):
    """The axis of a profile x, z, whose x rises or falls throughout in even steps; None of others."""
    if values.shape[1] != 2 or len(values) < FEWEST:
        return None
    axis = Axis.along(values[:, 0])
    return axis if axis.n == len(values) else None


def _heights(values, axes):
    """The heights of points on the axes x and y, and what is said of them."""
    x, y = axes
    heights = np.full((y.n, x.n), np.nan)
    heights[y.index, x.index] = values[:, 2]
    absent, more = heights.size - len(values), values.shape[1] - 3
    remarks = [f"points x, y, z of {x.n} x {y.n} places", *x.remark("x"), *y.remark("y")]
    remarks += [f"{counted(absent, 'point')} absent: taken as missing"] if absent else []
    remarks += [] if more < 1 else ["column 4 left out" if more == 1 else f"columns 4 to {more + 3} left out"]
    return heights, (x.n * x.step, y.n * y.step), remarks


def _profile(values, axis):
    """The heights of a profile, from the smallest x on, and what is said of them."""
    heights = np.empty((1, axis.n))
    heights[0, axis.index] = values[:, 1]
    return heights, (axis.n * axis.step,), [f"profile x, z of {axis.n} points", *axis.remark("x")]


def as_map(path, stated):
    """The statements with points or a profile in an array as a map; Error where the values are no map of heights.

    Whatever the format is, maps come through here.
    """
    if stated.layout == "grid":
        return stated
    if stated.layout == "array":
        values = np.asarray(stated.values, dtype=np.float64)
        for table in (values, values.T):
            axes, axis = (_lattice(table), _line(table)) if len(table) >= LIST else (None, None)
            if axes or axis:
                heights, spans, remarks = _heights(table, axes) if axes else _profile(table, axis)
                remarks = (*stated.remarks, *remarks, CENTRED)
                return stated._replace(values=heights, spans=spans, top=False, remarks=remarks, layout="grid")
    first = stated.lines.get("values")
    text = stated.layout != "array"
    need_map(f"{path}: line {first}" if first else path, stated.values, text, stated.layout == "library")
    return stated


class Points(Reader):
    """Lines x, y, z, of which absent points and further columns are said; heads of columns may state units."""

    family = "table"
    states = ("unit", "size", "first row", "missing points")

    def recognizes(self, source):
        """By a regular grid of the first two columns, each point once, with half of its points at least."""
        return source.is_list and _lattice(source.text.table[0]) is not None

    def read(self, source):
        """The heights on the grid."""
        values = source.text.table[0]
        return _stated(source, *_heights(values, _lattice(values)))


class Profile(Reader):
    """Lines x, z with even x that rises or falls throughout: a profile (1, nx), for plane strain."""

    family = "table"
    states = ("unit", "size", "missing points")

    def recognizes(self, source):
        """By two columns, the first of which rises or falls in even steps."""
        return source.is_list and _line(source.text.table[0]) is not None

    def read(self, source):
        """The heights, from the smallest x on."""
        values = source.text.table[0]
        return _stated(source, *_profile(values, _line(values)))

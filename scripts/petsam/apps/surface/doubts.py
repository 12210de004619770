"""Arrays of numbers that are no map of heights - points, profiles, positions beside the heights - and doubtful maps."""

import numpy as np

from ...core.errors import Error, counted
from ...core.units import shown

NARROW = 6  # columns of a list of points: x, y, z, and up to three more
LIST = 9  # rows from which on an array of so few columns is a list in any case
STEPS = 0.1  # deviation of the steps of positions from their mean: they are printed with few digits
FEWEST = 5  # positions that are recognized
JUMP = 3.0  # of a first column of uneven positions from the next: over that between the next two, rms
REPEATED = 3  # times from which on a value that lies apart from all others may be that of missing points
STAND_INS = (999.0, 9999.0, 99999.0, 999999.0, 999.9, 999.99, 9999.9, 9999.99, 32767.0, 32768.0)
SQUARE = 1e-6  # deviation of the ratio of the widths of square cells from 1
GRID = 8  # points along x and y from which on offsets of rows and outliers are looked for
WHITE = 1.0  # mean square of successive differences over the variance: 2 of offsets by chance, near 0 of a form
APART = 1.0  # rms of the steps from row to row over the rms of what else changes there
LINES = 32  # rows and columns from which on their variances are compared
TIMES = 6.0  # variance between rows over that between columns
REMOVED = 1e-9  # variance between columns over that between rows, below which they have been removed
NOTED = 0.05  # rms of what changes from row to row as a whole over the rms of all changes: below, it matters little
WIDE = 1.0  # m: few instruments measure a surface of this size
FEW = 1e-3  # share of the points that outliers are at most


def _list(path, what, more):
    return Error(
        f"{path}: {what}: a map has one line per y and one number per x{more}; write a true map that is as "
        "narrow as HDF5 with its axes x and y"
    )


def need_map(path, values, text, library=False):
    """Error where the array in a file, without axes, is a list of points or profiles, or has positions beside it.

    text: whether it is that of a text file, whose lines are points; else a list may lie along the columns, too.
    library: whether the library that reads points has been asked already.
    """
    rows, columns = values.shape
    if min(rows, columns) < 2:
        return
    if library:
        reads = keep = "; points x, y, z need a full regular grid, each once: interpolate them"
    else:
        reads = "; points x, y, z on a regular grid are read: interpolate these to one"
        keep = "; points x, y, z with more columns are read on a regular grid, each once: interpolate these to one"
    if columns == 3 and (text or rows >= LIST):
        raise _list(path, "three numbers a line are points x, y, z", reads)
    if columns == 2 and (text or rows >= LIST):
        raise _list(
            path,
            "two numbers a line are a profile x, z",
            "; a profile is read where x rises in even steps, 5 or more: interpolate it",
        )
    if columns <= NARROW and (rows > columns if text else rows >= LIST):
        raise _list(path, f"{columns} numbers a line are points with more than their height", keep)
    if not text and rows <= 3 and columns >= LIST:
        raise _list(path, f"{rows} rows of {columns} numbers are points or a profile", "")
    if text and columns <= NARROW and _is_grid(values):
        raise _list(path, f"{columns} numbers a line, the first two on a grid, are points x, y, z with more", keep)
    _need_heights(path, values)


def _is_grid(values):
    """True if the first two columns run through a grid of points, each once."""
    places = values[:, :2]
    if not np.all(np.isfinite(places)):
        return False
    counts = [np.unique(column).size for column in places.T]
    return counts[0] * counts[1] == len(values) and len(np.unique(places, axis=0)) == len(values) and min(counts) > 1


def _even(line):
    """Step of evenly spaced, rising or falling numbers; 0 of others."""
    steps = np.diff(line)
    if len(steps) < FEWEST - 1 or not np.all(np.isfinite(steps)):
        return 0.0
    mean = steps.mean()
    return mean if np.all(np.abs(steps - mean) <= STEPS * abs(mean)) else 0.0


def _positions(values):
    """True if the first row is even and no continuation of the next two rows, as that of a tilted plane is."""
    first, second, third = (row[1:] for row in values[:3])  # the corner may hold anything
    step = _even(first)
    return bool(step and not abs(step - 2 * _slope(second) + _slope(third)) <= 0.5 * abs(step)) or _uneven(values)


def _uneven(values):
    """True if the first row alone rises or falls throughout, and lies apart from the next two: uneven positions."""
    first, second, third = (row[1:] for row in values[:3])
    if first.size < GRID or not np.all(np.isfinite(values[:3, 1:])):
        return False
    one, two, three = (bool(np.all(steps > 0.0) or np.all(steps < 0.0)) for steps in np.diff(values[:3, 1:], axis=1))
    apart, near = (np.sqrt(np.mean(np.square(steps))) for steps in (first - second, second - third))
    return one and not two and not three and apart > JUMP * near


def _slope(row):
    """Mean step of a row."""
    steps = np.diff(row)
    return float(np.mean(steps[np.isfinite(steps)])) if np.any(np.isfinite(steps)) else np.nan


def _need_heights(path, values):
    if min(values.shape) < 3:
        return
    for name, found, cure in (
        ("first row", values, "--skip-rows 1"),
        ("last row", values[::-1], "remove it"),
        ("first column", values.T, "--skip-columns 1"),
        ("last column", values.T[::-1], "remove it"),
    ):
        if _positions(found):
            both = " (with the row and the column: both options)" if _positions(values) and _positions(values.T) else ""
            raise Error(
                f"{path}: its {name} rises or falls throughout, unlike the others: positions, not heights: "
                f"in a text {cure}{both}, in an array leave it out"
            )


# ---------------------------------------------------------------- maps that may be spoilt


def _apart(values):
    """Rms of the offsets of rows in m, 0 where the rows lie at no offsets by chance."""
    if min(values.shape) < GRID:
        return 0.0
    steps = np.diff(values, axis=0)
    middles = np.median(steps, axis=1)
    middles = middles - np.mean(middles)
    rest = np.sqrt(np.mean((steps - np.median(steps, axis=1)[:, None]) ** 2))
    offsets = np.median(values, axis=1)
    offsets = offsets - np.polyval(np.polyfit(np.arange(offsets.size), offsets, 1), np.arange(offsets.size))
    spread = np.mean(offsets**2)
    white = spread > 0.0 and np.mean(np.diff(offsets) ** 2) >= WHITE * spread
    return float(np.sqrt(spread)) if white and np.sqrt(np.mean(middles**2)) > APART * rest else 0.0


def _varies(values):
    """Mean square of the changes from row to row of whole rows, but for a form of second order, 0 where they change
    smoothly; that of all changes."""
    steps = np.diff(values, axis=0)
    middles = np.median(steps, axis=1)
    numbers = np.linspace(-1.0, 1.0, middles.size)
    middles = middles - np.polyval(np.polyfit(numbers, middles, 1), numbers)
    whole = np.mean(middles**2)
    rough = np.mean(np.diff(middles) ** 2) >= WHITE * whole
    return float(whole), float(np.mean((steps - np.mean(steps)) ** 2)), bool(rough)


def _streaks(values):
    """How many times the variance between rows is that between columns; 0 where it does not matter."""
    if min(values.shape) < LINES:
        return 0.0
    (rows, all_rows, rough), (columns, *_) = _varies(values), _varies(values.T)
    matters = rough and rows > NOTED**2 * all_rows and rows > TIMES * columns
    return rows / columns if matters and columns > REMOVED * rows else 0.0


def _outliers(values):
    """Heights above or below their neighbours, of a few points that are most of peak to valley; none otherwise."""
    from scipy.ndimage import median_filter

    if min(values.shape) < 2 * GRID:
        return values[:0]
    apart = np.abs(values - median_filter(values, size=3, mode="nearest"))
    count = max(1, int(FEW * values.size))
    far = np.argpartition(apart, -count, axis=None)[-count:]
    rest = np.delete(values, far)
    if not np.ptp(values) > 2.0 * np.ptp(rest):
        return values[:0]
    return np.array([v for v in values.flat[far] if v < rest.min() or v > rest.max()])


def _missing(values):
    """The value that the lowest or the highest points all have, far from all others; None without such points."""
    for value in (np.min(values), np.max(values)):
        rest = values[values != value]
        repeated = REPEATED <= values.size - rest.size < rest.size
        if repeated and np.ptp(rest) > 0.0 and np.min(np.abs(rest - value)) > 0.5 * np.ptp(rest):
            return float(value)
    return None


def of_stand_in(values):
    """A text about a number of a file that lies apart from all others, and that programs write for a missing point.

    _missing() finds those that stand at several points, whatever they are.
    """
    finite = values[np.isfinite(values)]
    for value in (finite.min(), finite.max()) if finite.size else ():
        rest = finite[finite != value]
        if abs(value) in STAND_INS and rest.size and np.min(np.abs(rest - value)) > 0.5 * np.ptp(rest):
            points = counted(finite.size - rest.size, "point")
            return [f"the number {value:g} is at {points}, far from all others: give --missing {value:g} if it is none"]
    return []


def of_size(high, wide, more=""):
    """Texts about heights of this peak to valley beyond the size, m, and about a size beyond measured ones."""
    texts = []
    if high > wide:
        texts.append(f"peak to valley {shown(high)} is more than the size {shown(wide)}: check the unit{more}")
    if wide >= WIDE:
        texts.append(
            f"the surface is {wide:.4g} m wide: check its unit; --size or --pixel, as in 1um, overrule such a size of "
            "a file; a number alone is in m"
        )
    return texts


def of_cells(one):
    """Texts about cells that would be square with x and y exchanged, or with one more row or column."""
    (nx, ny), (x, y) = one.n, one.size
    if one.is_profile:
        return []
    for count, cure in (
        ((ny, nx), "give --transpose if a line of the file, or the first index, is x"),
        ((nx, ny + 1), "add the row, or give --pixel, if the file lacks one"),
        ((nx + 1, ny), "add the column, or give --pixel, if the file lacks one"),
    ):
        exchanged = count == (ny, nx)  # else a few points are as many by chance
        if (exchanged or min(nx, ny) >= GRID) and _square(count, (x, y)) and not _square(one.n, (x, y)):
            return [
                "its cells are {} x {}, and would be square with {} x {} points: {}".format(
                    *map(shown, one.cell), *count, cure
                )
            ]
    return []


def _square(n, size):
    """True if cells are square."""
    return abs(size[0] * n[1] / (size[1] * n[0]) - 1.0) <= SQUARE


def doubts(one):
    """Texts of what may be wrong with a map without missing points."""
    texts = []
    for name, values in (("rows", one.values), ("columns", one.values.T)):
        offset, times = _apart(values), _streaks(values)
        if times and not offset:
            other = "columns" if name == "rows" else "rows"
            texts.append(
                f"the variance between its {name} is {times:.3g} times that between its {other}: unless the surface "
                f"has a lay, these are offsets of a scanner: remove them by --level {name}"
            )
        if offset:
            texts.append(
                f"its {name} lie at random offsets of {shown(offset)} rms, which bear the contact on single {name}: a "
                f"scanner's are removed by --level {name}"
            )
    value, far = _missing(one.values), _outliers(one.values)
    if value is not None:
        count = int(np.sum(one.values == value))
        texts.append(
            f"{counted(count, 'point')} of {one.values.size} all lie at {shown(value)}, apart from the others: if they "
            "are missing, give this value by --missing, in the file's unit"
        )
    elif far.size:
        worst = far[np.argmax(np.abs(far - np.median(one.values)))]
        texts.append(
            f"{counted(far.size, 'point')} of {one.values.size}, the farthest at {shown(float(worst))}, "
            "more than double peak to valley: outliers of the instrument would bear the contact alone: replace them "
            "by --outliers, or cut them off by --window"
        )
    return texts

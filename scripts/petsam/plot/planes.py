"""Maps of a study's columns over two inputs: regimes with their borders, numbers as contours, criteria as lines."""

import numpy as np
from matplotlib.colors import ListedColormap, LogNorm
from matplotlib.patches import Patch

from ..core.errors import Error, Unusable, short
from ..results.sliding import REGIMES
from .colours import log_ticks
from .style import COLORS, bar, logarithmic, need_few, plt
from .tables import matching, need_case, numbers, titled
from .units import label, number, scale

TINTS = ("#dfe3ee", "#8fb8d8", "#f5e0a0", "#cc79a7")  # of the regimes
HATCHES = ("", "", "//", "xx")  # of the regimes: where they slide as a whole, for eyes and prints without colours
HATCHED = "0.55"
FILLED = 0.5  # of a grid of the distinct values that must have cases, or they are drawn as points
LEVELS = 12
LEAST = 0.01  # relative width of a logarithmic scale at least
FINE = 400  # points of a map of regimes in each direction
TITLES = {"regime": "fretting regime"}
LARGER = "the border lies at larger displacements and tangential loads,\nor at smaller normal loads and friction"
SMALLER = "the border lies at smaller displacements and tangential loads,\nor at larger normal loads and friction"
BEYOND = {"stick": LARGER, "partial slip": LARGER, "gross slip": SMALLER}


def _grid(study, over, name, where, option="--scalar"):
    """Distinct values of both inputs, and the column on their grid (y, x), NaN where no case has a number."""
    x, y, values = (
        numbers(study, one, option)[0] for one, option in zip((*over, name), ("--against", "--against", option))
    )
    chosen = matching(study, where) & np.isfinite(x) & np.isfinite(y) & np.isfinite(values)
    need_case(study, name, option, chosen)
    (xs, i), (ys, j) = (np.unique(one[chosen], return_inverse=True) for one in (x, y))
    if xs.size < 2 or ys.size < 2:
        raise Error(f"{study.path}: --against {','.join(over)}: a map needs two values of each; use inputs that vary")
    grid, places = np.full((ys.size, xs.size), np.nan), set(zip(i.tolist(), j.tolist()))
    if len(places) < i.size:
        text = f"{i.size} cases at {len(places)} places; choose cases of the other inputs by --where"
        raise Error(f"{study.path}: --against {','.join(over)}: {text}")
    grid[j, i] = values[chosen]
    return _factor(study, over[0])[0] * xs, _factor(study, over[1])[0] * ys, grid


def _factor(study, name):
    """Factor and unit of an input on its axis, the same for all columns that are drawn over it."""
    values, unit = numbers(study, name, "--against")
    return scale(unit, values, powers=True)


def _between(values, log):
    """FINE points from the first to the last value, and the weights of all values in each: linear on the axis."""
    at = np.log(values) if log else values
    fine = np.linspace(at[0], at[-1], FINE)
    weights = np.array([np.interp(fine, at, row) for row in np.eye(at.size)])
    return np.exp(fine) if log else fine, weights


def _regimes(panel, xs, ys, grid, logs):
    """Areas of the regimes: at each place the one with the largest share of the cases about it, interpolated."""
    (x, across), (y, up) = _between(xs, "x" in logs), _between(ys, "y" in logs)
    shares = np.array([up.T @ (grid == k) @ across for k in range(len(REGIMES))])
    shown = np.ma.masked_where(up.T @ np.isfinite(grid) @ across < 1.0 - 1e-9, np.argmax(shares, axis=0))
    panel.pcolormesh(x, y, shown, cmap=ListedColormap(TINTS), vmin=-0.5, vmax=len(REGIMES) - 0.5, shading="nearest")
    for k in np.unique(shown.compressed()):
        inside = np.ma.masked_where(shown.mask, shown == k)
        panel.contour(x, y, inside, levels=[0.5], colors="black", linewidths=1.2)
        if HATCHES[k]:
            hatched = panel.contourf(x, y, inside, levels=[0.5, 1.5], colors="none", hatches=[HATCHES[k]])
            hatched.set(edgecolor=HATCHED, linewidth=0.0)
    known = sorted({int(value) for value in grid[np.isfinite(grid)]})
    if len(known) == 1:
        _say_uniform(panel, known[0], np.isfinite(grid).sum())
    look = {"edgecolor": HATCHED, "linewidth": 0.0}
    return [Patch(facecolor=TINTS[k], hatch=HATCHES[k], label=REGIMES[k], **look) for k in known]


def _say_uniform(panel, regime, count):
    """Writes into a map without a border which regime all of it is, and where another one is to be looked for."""
    words = f"all {count} cases: {REGIMES[regime]}"
    text = "\n".join(filter(None, (words, BEYOND.get(REGIMES[regime]))))
    box = {"facecolor": "white", "edgecolor": "0.5", "linewidth": 0.6, "boxstyle": "round,pad=0.5"}
    panel.text(0.5, 0.5, text, transform=panel.transAxes, ha="center", va="center", fontsize=9, bbox=box)


def _need_positive(study, name, values, option):
    """Raises Error if a column that is to be drawn on a logarithmic scale has a value that is not positive."""
    least = float(np.nanmin(values))
    if not least > 0.0:
        raise Error(f"{study.path}: --log {option}: {name} has the value {least:g}; omit it")


def _levels(values):
    """Levels of contours on a logarithmic scale, and its norm."""
    low, high = float(np.nanmin(values)), float(np.nanmax(values))
    high = max(high, low * (1.0 + LEAST))  # where all values are the same
    return np.geomspace(low, high, LEVELS + 1), LogNorm(low, high)


def _values(panel, xs, ys, grid, text, log):
    """Contours of numbers, or coloured points where the cases fill no grid; text is that of the colour bar."""
    some, norm, levels = np.isfinite(grid), None, LEVELS
    if log:
        levels, norm = _levels(grid)
    if some.mean() < FILLED:
        j, i = np.nonzero(some)
        image = panel.scatter(xs[i], ys[j], c=grid[some], cmap="viridis", norm=norm, s=36)
    else:
        image = panel.contourf(xs, ys, np.ma.masked_invalid(grid), levels=levels, cmap="viridis", norm=norm)
        image.drawn = xs, ys, grid
    beside = bar(panel, image, text)
    if log:
        places = log_ticks(norm, 7)
        places = places if len(places) > 1 else [norm.vmin, norm.vmax]  # less than a decade
        beside.set_ticks(places, labels=[f"{value:.3g}" for value in places])
        beside.ax.minorticks_off()


def _column(panel, study, name, places, log):
    """A column over two inputs, places their values and the column's on their grid."""
    if log:
        _need_positive(study, name, places[-1], "colors")
    factor, unit = scale(numbers(study, name, "--scalar")[1], places[-1], powers=True)
    _values(panel, *places[:2], factor * places[-1], label(titled(name), unit), log)


def _border(panel, study, over, where, name, limit, color):
    """The line on which a column has a value; nothing where no case is on one of its sides."""
    xs, ys, grid = _grid(study, over, name, where, "--border")
    known = grid[np.isfinite(grid)]
    if known.min() < limit < known.max():
        if known.min() > 0.0:  # lives span decades
            grid, level = np.log(grid), np.log(limit)
        else:
            level = limit
        panel.contour(
            xs, ys, np.ma.masked_invalid(grid), levels=[level], colors=[color], linewidths=1.8, linestyles="solid"
        )
    factor, unit = scale(numbers(study, name, "--border")[1], abs(limit))
    side = "" if known.min() < limit < known.max() else ": all below" if known.max() <= limit else ": all above"
    text = f"{titled(name)} = {number(factor * limit, 6)} {unit}".rstrip() + side
    return plt.Line2D([], [], color=color, linewidth=1.8, label=text)


def planes(study, over, names=None, where=(), borders=(), logs=()):
    """Columns (the regime) over two inputs: a panel each, with lines where other columns have the values of borders;
    logs are what is logarithmic: x, y, colors."""
    if len(over) != 2:
        raise Error(f"{study.path}: --against {short(','.join(over))}: expected X,Y")
    names = names or ["regime"]
    need_few(len(names), "columns")
    if "colors" in logs and set(names) == {"regime"}:
        raise Unusable(f"{study.path}: --log colors: the regime has no numbers; name a column by --scalar")
    axes_logs = [letter for letter in logs if letter in "xy"]
    columns = min(2, len(names))
    height = -(-len(names) // columns)
    size = (6.4 * columns, 4.6 * height)
    figure, axes = plt.subplots(height, columns, figsize=size, squeeze=False, layout="constrained")
    for panel, name in zip(axes.flat, names):
        panel.grid(False)
        logarithmic(panel, axes_logs)
        xs, ys, grid = _grid(study, over, name, where)
        for letter in axes_logs:
            which = "xy".index(letter)
            _need_positive(study, over[which], (xs, ys)[which], letter)
        handles = []
        if name == "regime":
            handles = _regimes(panel, xs, ys, grid, axes_logs)
        else:
            _column(panel, study, name, (xs, ys, grid), "colors" in logs)
        j, i = np.nonzero(np.isfinite(grid))
        panel.plot(xs[i], ys[j], ".", color="0.25", markersize=3.0, clip_on=False)
        for (criterion, limit), color in zip(borders, COLORS[1:] * len(borders)):
            handles.append(_border(panel, study, over, where, criterion, limit, color))
        texts = [label(titled(one), _factor(study, one)[1]) for one in over]
        title = TITLES.get(name, titled(name))
        panel.set(xlabel=texts[0], ylabel=texts[1])
        panel.set_title(title, pad=6 + 15 * -(-len(handles) // 2))  # above the legend
        if handles:
            panel.legend(handles=handles, loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=2)
    for panel in axes.flat[len(names) :]:
        panel.set_axis_off()
    return figure

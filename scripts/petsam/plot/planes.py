"""Maps of a study's columns over two inputs: regimes with their borders, numbers as contours, criteria as lines."""

import numpy as np
from matplotlib.colors import ListedColormap
from matplotlib.patches import Patch

from ..errors import Error, short
from ..sliding import REGIMES
from .style import COLORS, bar, logarithmic, need_few, plt
from .tables import matching, numbers
from .units import label, largest, plain, scale, written

TINTS = ("#dfe3ee", "#8fa0d8", "#e9a03b", "#c44e52")  # of the regimes
FILLED = 0.5  # of a grid of the distinct values that must have cases, or they are drawn as points
LEVELS = 12


def _grid(study, over, name, where, option="--scalar"):
    """Distinct values of both inputs, and the column on their grid (y, x), NaN where no case has a number."""
    x, y, values = (
        numbers(study, one, option)[0] for one, option in zip((*over, name), ("--against", "--against", option))
    )
    chosen = matching(study, where) & np.isfinite(x) & np.isfinite(y) & np.isfinite(values)
    if not chosen.any():
        raise Error(f"{study.path}: {option} {short(name)}: no chosen case has a number; use another column")
    (xs, i), (ys, j) = (np.unique(one[chosen], return_inverse=True) for one in (x, y))
    if xs.size < 2 or ys.size < 2:
        raise Error(f"{study.path}: --against {','.join(over)}: a map needs two values of each; use inputs that vary")
    grid, places = np.full((ys.size, xs.size), np.nan), set(zip(i.tolist(), j.tolist()))
    if len(places) < i.size:
        text = f"{i.size} cases at {len(places)} places; choose cases of the other inputs by --where"
        raise Error(f"{study.path}: --against {','.join(over)}: {text}")
    grid[j, i] = values[chosen]
    return xs, ys, grid


def _edges(values, log):
    """Borders between the cells about values, halfway on the axis."""
    at = np.log(values) if log else values
    middle = 0.5 * (at[1:] + at[:-1])
    edges = np.concatenate([[at[0] - (middle[0] - at[0])], middle, [at[-1] + (at[-1] - middle[-1])]])
    return np.exp(edges) if log else edges


def _regimes(panel, xs, ys, grid, logs):
    """Cells of the regimes, with lines between cells of different ones."""
    x, y = _edges(xs, "x" in logs), _edges(ys, "y" in logs)
    panel.pcolormesh(x, y, np.ma.masked_invalid(grid), cmap=ListedColormap(TINTS), vmin=-0.5, vmax=len(REGIMES) - 0.5)
    for j, i in np.argwhere(np.isfinite(grid)):
        if i + 1 < xs.size and np.isfinite(grid[j, i + 1]) and grid[j, i + 1] != grid[j, i]:
            panel.plot([x[i + 1]] * 2, y[j : j + 2], color="black", linewidth=1.4)
        if j + 1 < ys.size and np.isfinite(grid[j + 1, i]) and grid[j + 1, i] != grid[j, i]:
            panel.plot(x[i : i + 2], [y[j + 1]] * 2, color="black", linewidth=1.4)
    known = sorted({int(value) for value in grid[np.isfinite(grid)]})
    return [Patch(color=TINTS[k], label=REGIMES[k]) for k in known]


def _values(panel, xs, ys, grid, name, unit):
    """Contours of numbers, or coloured points where the cases fill no grid."""
    factor, prefixed = scale(unit, largest([grid]))
    some = np.isfinite(grid)
    if some.mean() < FILLED:
        j, i = np.nonzero(some)
        image = panel.scatter(xs[i], ys[j], c=factor * grid[some], cmap="viridis", s=36)
    else:
        image = panel.contourf(xs, ys, np.ma.masked_invalid(factor * grid), levels=LEVELS, cmap="viridis")
        image.drawn = xs, ys, factor * grid
    bar(panel, image, label(plain(name), prefixed))


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
    unit = written(numbers(study, name, "--border")[1])
    side = "" if known.min() < limit < known.max() else ": all below" if known.max() <= limit else ": all above"
    text = f"{plain(name)} = {limit:g} {'' if unit == '1' else unit}".rstrip() + side
    return plt.Line2D([], [], color=color, linewidth=1.8, label=text)


def planes(study, over, names=None, where=(), borders=(), logs=()):
    """Columns (the regime) over two inputs: a panel each, with lines where other columns have the values of borders."""
    if len(over) != 2:
        raise Error(f"{study.path}: --against {short(','.join(over))}: expected X,Y")
    names = names or ["regime"]
    need_few(len(names), "columns")
    columns = min(2, len(names))
    height = -(-len(names) // columns)
    size = (6.4 * columns, 4.6 * height)
    figure, axes = plt.subplots(height, columns, figsize=size, squeeze=False, layout="constrained")
    for panel, name in zip(axes.flat, names):
        panel.grid(False)
        logarithmic(panel, logs)
        xs, ys, grid = _grid(study, over, name, where)
        for letter, values in zip("xy", (xs, ys)):
            if letter in logs and not values[0] > 0.0:
                raise Error(
                    f"{study.path}: --log {letter}: {over['xy'.index(letter)]} has the value {values[0]:g}; omit it"
                )
        handles = []
        if name == "regime":
            handles = _regimes(panel, xs, ys, grid, logs)
        else:
            _values(panel, xs, ys, grid, name, numbers(study, name, "--scalar")[1])
        j, i = np.nonzero(np.isfinite(grid))
        panel.plot(xs[i], ys[j], ".", color="0.25", markersize=3.0, clip_on=False)
        for (criterion, limit), color in zip(borders, COLORS[1:] * len(borders)):
            handles.append(_border(panel, study, over, where, criterion, limit, color))
        texts = [label(plain(one), written(study.unit_of_input(one))) for one in over]
        panel.set(xlabel=texts[0], ylabel=texts[1])
        if handles:
            panel.legend(handles=handles, loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=2)
    for panel in axes.flat[len(names) :]:
        panel.set_axis_off()
    return figure

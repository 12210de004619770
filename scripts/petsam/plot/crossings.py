"""Profiles of fields along x and y through a point, of results.Results.

A saved step is given as a pair (Results, index into its saved fields), and read no further than is drawn.
"""

import numpy as np

from ..core.errors import Error
from ..results.fields import DEPTHS, OPEN
from . import noise, symbols
from .fields import OF_CONTACT
from .style import colors, heading, logarithmic, plt
from .units import label, largest, number, plain, scale

ROWS = (
    (("pressure",), "pressure $p$", "$p$", "Pa", False),
    (("shear_x", "shear_y"), "shear $q_x$ (line), $q_y$ (dashed), $\\pm\\mu p$ (dots)", "$q$", "Pa", True),
    (("slip_x", "slip_y"), "slip $s_x$ (line), $s_y$ (dashed)", "$s$", "m", False),
    (DEPTHS, "removed depth $w_1$ (line), $w_2$ (dashed)", "$w$", "m", False),
)  # names, title, symbol, unit, whether it is bounded by friction


def sides_of(files):
    """The axes along which there is something to draw: 0 for x and 1 for y, which plane problems do not have."""
    return (0,) if all(one.is_plane for one in files) else (0, 1)


def crossing(results, axis, at):
    """Number of the row (axis 0) or column (axis 1) of cells nearest to the point at."""
    across = (results.y, results.x)[axis]
    if across.size == 1:
        return 0
    half = 0.5 * (across[1] - across[0])
    if not across[0] - half <= at[1 - axis] <= across[-1] + half:
        raise Error("{}: --at {:g},{:g}: is not on the grid".format(results.path, *at))
    return int(np.argmin(np.abs(across - at[1 - axis])))


def _profile(results, index, axis, at, names, whole):
    """Fields along x (axis 0) or y (axis 1) through the cells nearest to the point at; NaN where slip does not exist,
    0 where a field of another file is not in this one."""
    every = (slice(0, results.y.size), slice(0, results.x.size))
    window = whole if isinstance(whole, tuple) else every if whole else results.contact_window(index)
    along = (results.x, results.y)[axis]
    k = crossing(results, axis, at)
    rows, columns = (slice(k, k + 1), window[1]) if axis == 0 else (window[0], slice(k, k + 1))
    part = {"rows": rows, "columns": columns}
    x = along[window[1 - axis]]
    has = [name for name in names if name in results.fields or name in results.vectors]
    data = {
        **dict.fromkeys(names, np.zeros(x.size)),
        **{name: results.quantity(name, index, **part).ravel() for name in has},
    }
    if "state" in results.fields and any(name in OF_CONTACT for name in names):
        is_open = results.field("state", index, **part).ravel() == OPEN
        data.update({name: np.where(is_open, np.nan, data[name]) for name in names if name in OF_CONTACT})
    return {**data, "along": x}


def _bounds(axes, data, mu, color, length, factor):
    """Dots at +-mu p."""
    for sign in (1.0, -1.0):
        y = sign * factor * mu * data["pressure"]
        axes.plot(length * data["along"], y, ":", color=color, linewidth=0.9, alpha=0.7)


def _panel(axes, lines, names, length, factor, friction):
    """Lines of the components names of every snapshot; with friction, if a number, the bounds +-mu p behind."""
    for data, color, mu, text in lines:
        if friction and mu > 0.0 and "pressure" in data:
            _bounds(axes, data, mu, color, length, factor)
        for name, style in zip(names, ("-", "--")):
            text_of_line = text if style == "-" else None
            look = {"color": color, "linewidth": 1.3, "label": text_of_line}
            axes.plot(length * data["along"], factor * data[name], style, **look)


def _rows(snapshots, names):
    """Returns the content of each row of panels: names, title, symbol, unit, and True if it is bounded by friction."""
    if names:
        for results, _ in snapshots:
            for name in names:
                results.need_quantity(name, "--field")
        described = [symbols.field(snapshots[0][0], name) for name in names]
        return [((name,), *texts, False) for name, texts in zip(names, described)]
    fields = {name for results, _ in snapshots for name in results.fields}
    rows = [row for row in ROWS if any(name in fields for name in row[0])]
    if not rows:
        snapshots[0][0].need_quantity("pressure")
    return rows


def profiles(snapshots, at=(0.0, 0.0), whole=False, names=None, limits=None, logs=()):
    """Fields along x (left) and y (right; not of plane problems): those named, or pressure, shear, slip and depths."""
    if limits and len(names or ()) != 1:
        raise Error("--limits: expected one field, by --field")
    rows = _rows(snapshots, names)
    read = list(dict.fromkeys(name for row in rows for name in row[0]))
    tints = colors(len(snapshots))
    sides = sides_of(results for results, _ in snapshots)
    lines = [
        [
            (
                _profile(results, index, axis, at, read, whole),
                tint,
                results.friction(index),
                plain(results.title(index)),
            )
            for (results, index), tint in zip(snapshots, tints)
        ]
        for axis in sides
    ]
    every = [line[0] for side in lines for line in side]
    length, unit = scale("m", *(data["along"] for data in every))
    tops = [largest(data[name] for data in every for name in row[0]) for row in rows]
    if not names:
        by_name = {row[0][0]: top for row, top in zip(rows, tops)}
        files = list(dict.fromkeys(one for one, _ in snapshots))
        tops = [0.0 if noise.is_nothing(row[0][0], by_name, files) else top for row, top in zip(rows, tops)]
    shown = [(row, top) for row, top in zip(rows, tops) if top > 0.0] or [(rows[0], 0.0)]
    size = (11.0 if len(sides) > 1 else 7.2, 2.7 * len(shown) + (0.4 if len(shown) > 1 else 1.2))
    shared = {"sharey": "row", "sharex": "col", "constrained_layout": True}
    figure, axes = plt.subplots(len(shown), len(sides), figsize=size, squeeze=False, **shared)
    for panels, ((group, text, symbol, base, friction), top) in zip(axes, shown):
        factor, prefixed = scale(base, max(map(abs, limits)) if limits else top)
        for panel, side in zip(panels, lines):
            _panel(panel, side, group, length, factor, friction)
            logarithmic(panel, logs)
            panel.set(**({"ylim": [factor * value for value in limits]} if limits else {}))
        panels[0].set(ylabel=label(symbol, prefixed))
        panels[0].set_title(text, loc="left", fontsize=9.5)
    axes[-1, 0].set_xlabel(label("$x$", unit))
    if len(sides) > 1:
        axes[-1, 0].set_xlabel(f"{label('$x$', unit)}  at $y$ = {number(length * at[1])} {unit}")
        axes[-1, 1].set_xlabel(f"{label('$y$', unit)}  at $x$ = {number(length * at[0])} {unit}")
    if len(snapshots) > 1:
        names, marks = axes[0, 0].get_legend_handles_labels()[::-1]
        figure.legend(marks, names, loc="outside upper center", ncols=2)  # above the panels: curves are anywhere within
    else:
        figure.suptitle(heading([snapshots[0][0]], *snapshots[0]), fontsize=9, color="0.35")
    return figure

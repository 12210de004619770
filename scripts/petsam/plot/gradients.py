"""Where a micrometre counts: the derivatives of numbers by the gap and by friction in each cell, of results.Results.

They are drawn as the change of the number by a patch of the surface, which does not depend on the cells: a square with
a power of ten as its side; in plane strain a strip of this width.
"""

import numpy as np

from ..core.errors import Error
from ..results.fields import OPEN, STICK
from . import colours, outlines
from .fields import Layout
from .style import bar, curve, extent, field, named, need_few, note, plt
from .units import label, largest, number, plain, scale

GAP, FRICTION = 1e-6, 0.01  # m, 1: the changes of a patch
PART = 0.01  # of the contact that a patch has at most
MARGIN = 0.15  # about the cells that count, over their extent
# of contact and of stick
EDGES = {"contact_edge": (lambda state: state != OPEN, "-"), "stick_edge": (lambda state: state == STICK, "--")}
LINE = {"color": "0.2", "linewidth": 0.6}
PERCENTILE = 97.0  # of the cells, which the colours by the gap hold: the others are along the edges
REMARK = "contact (line) and stick (dashed) of the last saved step"


class Patch:
    """The patch whose changes are drawn of a file: side (m), and what it is called."""

    def __init__(self, results):
        self.power = 1 if results.is_plane else 2
        area = largest([results.history["contact_area"].astype(float)])
        self.side = 10.0 ** np.floor(np.log10(PART * area) / self.power + 1e-9) if area > 0.0 else GAP
        factor, unit = scale("m", self.side)
        text = f"{number(factor * self.side)} {unit}"
        self.name = f"a strip of {text}" if results.is_plane else f"{text} x {text}"

    def changes(self, results, one):
        """Changes by the gap and by friction, (ny, nx) each, and their unit: of the number, or its own if it is 0."""
        cell = (results.x[1] - results.x[0]) * (1.0 if results.is_plane else results.y[1] - results.y[0])
        size, unit = (one.value / 100.0, "%") if one.value else (1.0, one.unit)
        factor = self.side**self.power / cell / size
        return (GAP * factor * one.gap, FRICTION * factor * one.friction), unit

    @property
    def titles(self):
        """The titles of both panels."""
        return f"1 µm removed on {self.name}", f"friction {FRICTION:g} higher on {self.name}"


def drawn(results):
    """The gradients of a file that have both fields."""
    return [one for one in results.gradients.values() if one.has_fields]


def _window(one, whole):
    """Rows and columns of the cells that count, and a margin."""
    counts = (one.gap != 0.0) | (np.nan_to_num(one.friction) != 0.0)
    slices = []
    for axis, size in zip((1, 0), counts.shape):
        cells = np.flatnonzero(counts.any(axis=axis))
        more = int(np.ceil(MARGIN * np.ptp(cells))) + 1 if cells.size else 0
        every = whole or not cells.size
        slices.append(slice(0, size) if every else slice(max(0, cells[0] - more), min(size, cells[-1] + 1 + more)))
    return slices


def _read(results, one, whole):
    """Returns the fields, titles and axes to draw of a gradient on its window."""
    patch, (rows, columns) = Patch(results), _window(one, whole)
    changes, unit = patch.changes(results, one)
    x, y = results.x[columns], results.y[rows]
    saved = "state" in results.fields and results.times.size
    state = results.field("state", -1, rows, columns) if saved else np.full((y.size, x.size), OPEN)
    edges = {} if results.is_plane else {"extent": extent(x, y)}
    held = results.edges if saved and not results.is_plane else []
    factor, base = scale(one.unit, abs(one.value))
    about = f"{plain(one.name)}: {number(factor * one.value)} {base}".rstrip()
    about = f"{plain(results.label)}, {about}" if named([results]) else about
    fields = [values[rows, columns] for values in changes]
    return {
        "fields": fields,
        "titles": patch.titles,
        "unit": unit,
        "x": x,
        "y": y,
        "state": state,
        "lines": {name: outlines.lines(results.edge(name), float(results.x[1] - results.x[0])) for name in held},
        "about": about,
        **edges,
    }


def _map(panel, one, values, layout, length, percentile):
    """A map with the edges of contact and of stick."""
    shown = colours.choose("of_gradient", [values], one["unit"], colours.Choice(percentile=percentile))
    edges = [length * value for value in one["extent"]]
    image = field(panel, shown.factor * values, edges, color_map=shown.color_map, norm=shown.norm)
    bar(panel, image, shown.text("change"), layout.height, extend=shown.extend)
    for name, (inside, dash) in EDGES.items():
        cells = inside(one["state"]).astype(float)
        if one["lines"].get(name):
            outlines.draw(panel, name, one["lines"][name], length)
        elif np.ptp(cells):
            look = {"colors": LINE["color"], "linewidths": LINE["linewidth"], "linestyles": dash}
            panel.contour(length * one["x"], length * one["y"], cells, [0.5], **look)
    layout.number(panel)
    return shown.remark


def _curve(panel, one, values, length):
    """A curve over x with the edges of contact and of stick; no remark."""
    factor, unit = scale(one["unit"], values)
    x = length * one["x"]
    panel.axhline(0.0, color="0.6", linewidth=0.8)
    for inside, dash in EDGES.values():
        for turn in np.flatnonzero(np.diff(inside(one["state"][0]).astype(int))):
            panel.axvline(0.5 * (x[turn] + x[turn + 1]), linestyle=dash, **LINE)
    panel.plot(x, factor * values[0], **curve(x.size, color="#0072b2"))
    panel.set(xlim=(x[0], x[-1]), ylabel=label("change", unit))
    return ""


def _need_drawn(one):
    """Error for a file without a gradient that may be drawn."""
    if drawn(one):
        return
    cure = "use petsam -gradient NAME, without -gradient_of, or with both"
    if not one.parameters.get("closed", 1):
        cure = "a run writes to it, or was killed, and derivatives come at its end: let it end"
    raise Error(f"{one.path}: --gradient: has no gradient by gap and friction: {cure}")


def gradient(files, whole=False):
    """Changes by the gap (left) and by friction (right), of every gradient of every file."""
    for one in files:
        _need_drawn(one)
        if one.is_plane != files[0].is_plane:
            raise Error(f"{one.path}: --gradient: plane problems do not go into a picture of others")
    data = [_read(one, each, whole) for one in files for each in drawn(one)]
    need_few(len(data), "gradients")
    length, unit = scale("m", *(axis for one in data for axis in (one["x"], one["y"])))
    if files[0].is_plane:
        layout, size = None, (9.4, 2.7 * len(data) + 0.6)
    else:
        layout = Layout(data, 2, side=3.2)
        size = layout.size
    rows, columns = (len(data), 2) if layout is None else (layout.rows, layout.columns)
    figure, axes = plt.subplots(rows, columns, figsize=size, squeeze=False, layout="constrained")
    for row, one in enumerate(data):
        for column, (values, title) in enumerate(zip(one["fields"], one["titles"])):
            panel = axes[layout.place(row, column, 2) if layout else (row, column)]
            if layout:
                remark = _map(panel, one, values, layout, length, None if column else PERCENTILE)
            else:
                remark = _curve(panel, one, values, length)
            panel.set_title(f"{one['about']}\n{title}", loc="left", fontsize=9.5)
            panel.set_xlabel("\n".join(part for part in (label("$x$", unit), remark) if part))
            if layout and layout.is_left(column):
                panel.set_ylabel(label("$y$", unit))
    if any((one["state"] != OPEN).any() for one in data):
        note(figure, REMARK, 8.5)
    return figure

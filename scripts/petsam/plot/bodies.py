"""Pictures of the stresses in a body; each function takes stresses.Stresses and gives a matplotlib figure.

A step is given as a pair (Stresses, index). Depth points down. Places of maximum values are marked.
"""

import numpy as np
from matplotlib.patheffects import withStroke
from matplotlib.ticker import MaxNLocator
from matplotlib.transforms import Bbox

from ..core.errors import Error
from ..results.stresses import FATIGUE
from .fields import PIXELS, Layout
from .style import DAMAGE, bar, colors, cross, extent, field, heading, named, need_few, note, plt
from .units import label, largest, number, plain, scale

SYMBOLS = {name: f"$\\sigma_{{{name}}}$" for name in ("xx", "yy", "zz", "xy", "xz", "yz")}
SHORT = {
    "crossland": "Crossland", "dang_van": "Dang Van", "findley": "Findley", "swt": "SWT", "fatemi_socie": "FS",
    "ruiz_1": "Ruiz 1", "ruiz_2": "Ruiz 2",
}  # fmt: skip
LEVELS = 24  # of colours
LINES = 8  # contours with a number
FEW = 2  # of them that a layer has at least
STRESSES = ("xx", "yy", "zz", "xy", "xz", "yz")
OTHERS = {
    "principal_1": "$\\sigma_1$", "principal_2": "$\\sigma_2$", "principal_3": "$\\sigma_3$",
    "shear_max": "$\\tau_{max}$", "mises": "$\\sigma_M$",
}  # fmt: skip
COMPONENTS = (*STRESSES, *OTHERS)
LABEL, MARK = "label", "mark"  # ids of the numbers of contours and of marks
SAME = 1e-9  # part of the greatest depth within which two depths are an interface from above and from below
PLANES = 4  # of maps in a picture without --depth


def _dataset(component):
    return "stress_" + component if component in STRESSES else component


def _component(dataset):
    return dataset.removeprefix("stress_")


def _symbol(component):
    return SYMBOLS.get(component) or OTHERS[component]


def _have(files, name):
    return all(name in file for file in files)


def _one(files, component):
    """The requested component, if it is there; None stands for xx, or else von Mises."""
    if component is None:
        component = "xx" if _have(files, "stress_xx") or not _have(files, "mises") else "mises"
    for file in files:
        file.need(_dataset(component))
    return component


def _columns(files, component):
    """Datasets of a picture and their titles: von Mises, if it is there, and the component."""
    columns = [("mises", "von Mises stress")] if _have(files, "mises") else []
    component = _one(files, component)
    if component != "mises" or not columns:
        columns.append((_dataset(component), f"stress {_symbol(component)}"))
    return columns


def _is_signed(name):
    return name not in ("mises", "shear_max")


def _line(file, at):
    """Returns a section of the file: its direction and coordinates; slices of rows and columns; name and place of the
    other coordinate.

    Of maps it is the row nearest to y of `at`.
    """
    everything = slice(None)
    if file.along == "y":
        return "y", file.y, everything, everything, ("x", file.x[0])
    row = file.nearest_row(at[1])
    return "x", file.x, slice(row, row + 1), everything, ("y", file.y[row])


def _at(where, length, unit):
    return f"  at ${where[0]}$ = {number(length * where[1])} {unit}"


def _section(file, name, index, at, depths=slice(None)):
    """Values (z, along) of a quantity on a section."""
    _, _, rows, columns, _ = _line(file, at)
    values = file.field(name, index, depths, rows, columns)
    return values.reshape(values.shape[0], -1)


def _contours(axes, along, z, values, low, high, color_map):
    """Colours and lines of values (z, along) between limits; one depth is a line."""
    axes.grid(False)
    if not high > low:
        high = low + 1.0
    levels, lines = np.linspace(low, high, LEVELS + 1), MaxNLocator(LINES).tick_values(low, high)[1:-1]
    for part in _layers(z):
        image = axes.contourf(along, z[part], np.clip(values[part], low, high), levels=levels, cmap=color_map)
        image.drawn = along, z[part], values[part]
        own = _lines(lines, values[part])
        drawn = axes.contour(along, z[part], values[part], levels=own, colors="0.25", linewidths=0.5)
        numbered(axes, drawn)
    axes.set_ylim(z[-1], z[0])
    return image


def numbered(axes, lines, style=lambda value: number(value, 3)):
    """Writes numbers on contours; untangle() takes away those that lie on others."""
    for text in axes.clabel(lines, fmt=style, fontsize=6.5, inline=False, colors="0.15"):
        text.set(gid=LABEL, path_effects=[withStroke(linewidth=1.5, foreground="white", alpha=0.8)])


def _lines(usual, values):
    """Contours of a layer: the picture's, or closer ones where these leave most of a layer without a number."""
    low, high = float(np.min(values)), float(np.max(values))
    crossing = np.count_nonzero((usual > low) & (usual < high))
    return usual if crossing >= FEW or not high > low else MaxNLocator(FEW + 1).tick_values(low, high)[1:-1]


def _layers(z):
    """Slices of the depths between interfaces, which stand twice, seen from above and from below. The jump there is no
    slope, along which all contours would run. A layer of one depth has no area."""
    ends = [0, *(np.flatnonzero(np.diff(z) <= SAME * z[-1]) + 1), z.size]
    return [slice(first, last) for first, last in zip(ends[:-1], ends[1:]) if last - first > 1]


def _limits(name, component, top, limits):
    """Lowest and highest value of the colours (Pa): those given are of the component."""
    if limits and name == _dataset(component):
        return limits
    return (-top if _is_signed(name) else 0.0), top


def _ring(axes, x, y):
    """A mark around the top of a curve, which it does not hide."""
    axes.plot(x, y, "o", color="black", markersize=9, markerfacecolor="none", markeredgewidth=1.0, clip_on=False)


def untangle(figure):
    """Take away numbers of contours that lie on one another, on a mark, or across the border."""
    figure.draw_without_rendering()  # which lays the panels out
    for axes in figure.axes:
        room, taken = axes.get_window_extent(), []
        for mark in (line for line in axes.lines if line.get_gid() == MARK):
            x, y = axes.transData.transform(mark.get_xydata()[0])
            half = 0.5 * mark.get_markersize() * figure.dpi / 72.0
            taken.append(Bbox.from_extents(x - half, y - half, x + half, y + half))
        for text in [text for text in axes.texts if text.get_gid() == LABEL]:
            box = text.get_window_extent().padded(1.0)
            corners = box.x0 >= room.x0 and box.x1 <= room.x1 and box.y0 >= room.y0 and box.y1 <= room.y1
            if corners and not any(box.overlaps(other) for other in taken):
                taken.append(box)
            else:
                text.remove()


def _extremes(name, values):
    """The maximum, and the minimum of a stress that has a sign."""
    high = f"maximum {number(np.max(values))}"
    return f"{high}, minimum {number(np.min(values))}" if _is_signed(name) else high


def _title(panel, text, remark, when):
    """Writes the title above the map, where nothing hides it: the quantity, and below it the step."""
    panel.set_title(f"{text}: {remark}\n{when}".rstrip(), fontsize=9.5)


def sections(steps, component=None, at=(0.0, 0.0), limits=None):
    """Von Mises and a component of the stress over depth: one row per step, one scale per column."""
    need_few(len(steps), "steps and files")
    for file, _ in steps:
        if file.z.size < 2:
            raise Error(f"{file.path}: has one depth; a section needs several")
    columns = _columns([file for file, _ in steps], component)
    length, unit = scale("m", max(np.ptp(_line(file, at)[1]) for file, _ in steps) / 2)
    size = (6.0 * len(columns), 3.3 * len(steps) + 0.3)
    figure, axes = plt.subplots(len(steps), len(columns), figsize=size, squeeze=False, constrained_layout=True)
    for column, (name, text) in enumerate(columns):
        data = [_section(file, name, index, at) for file, index in steps]
        top = largest(data)
        low, high = _limits(name, component or "xx", top, limits)
        factor, prefixed = scale("Pa", max(abs(low), abs(high)))
        colours = "RdBu_r" if _is_signed(name) else "viridis"
        for row, ((file, index), values) in enumerate(zip(steps, data)):
            panel, (axis, along, _, _, where) = axes[row, column], _line(file, at)
            image = _contours(
                panel, length * along, length * file.z, factor * values, factor * low, factor * high, colours
            )
            k, i = np.unravel_index(np.argmax(np.abs(values)), values.shape)
            cross(panel, length * along[i], length * file.z[k], MARK)
            panel.set(
                xlabel=label(f"${axis}$", unit) + _at(where, length, unit),
                ylabel=label("depth $z$", unit) if column == 0 else "",
            )
            bar(panel, image, label(_symbol(_component(name)), prefixed))
            when = heading([one for one, _ in steps], file, index)
            _title(panel, text, f"{_extremes(name, factor * values)} {prefixed}", when)
    untangle(figure)
    return figure


def profiles(steps, component=None, at=(0.0, 0.0)):
    """Draws a component of the stress along the section at its first depth, which is the surface if it is included."""
    figure, axes = plt.subplots(figsize=(7.6, 4.4), constrained_layout=True)
    component = _one([file for file, _ in steps], component)
    data = [_section(file, _dataset(component), index, at, slice(0, 1))[0] for file, index in steps]
    length, unit = scale("m", max(np.ptp(_line(file, at)[1]) for file, _ in steps) / 2)
    factor, prefixed = scale("Pa", *data)
    for (file, index), values, tint in zip(steps, data, colors(len(steps))):
        axis, along, _, _, where = _line(file, at)
        axes.plot(length * along, factor * values, color=tint, linewidth=1.3, label=plain(file.title(index)))
    if len(steps) > 1:
        axes.legend(loc="best")
    else:
        note(figure, heading([steps[0][0]], *steps[0]))
    axes.axhline(0.0, color="0.6", linewidth=0.8)
    depth = "on the surface" if file.z[0] == 0 else f"at z = {file.z[0]:.4g} m"
    axes.set(
        xlabel=label(f"${axis}$", unit) + _at(where, length, unit),
        ylabel=label(_symbol(component), prefixed),
        title=f"stress {_symbol(component)} {depth}",
    )
    return figure


def _stride(file):
    return max(1, -(-max(file.y.size, file.x.size) // PIXELS))


def _planes(file, depths):
    """Numbers of the planes that are drawn: those nearest to depths (m), or some from the first to the last."""
    if depths:
        return [file.nearest_plane(z) for z in depths]
    return sorted({round(k) for k in np.linspace(0, file.z.size - 1, min(PLANES, file.z.size))})


def maps(steps, component=None, depths=None, limits=None):
    """Von Mises and a component of the stress over planes: one row per step and depth, one scale a column."""
    rows = [(file, index, k) for file, index in steps for k in _planes(file, depths)]
    for file, _ in steps:
        if file.along:
            raise Error(f"{file.path}: holds a section; maps need whole planes")
    need_few(len(rows), "steps, depths and files")
    columns = _columns([file for file, _ in steps], component)
    length, unit = scale("m", max(np.ptp(file.x) for file, _ in steps) / 2)
    edges = [extent(file.x, file.y, 1.0 / length, _stride(file)) for file, _, _ in rows]
    layout = Layout([{"extent": one} for one in edges], len(columns), side=3.2)
    figure, axes = plt.subplots(layout.rows, layout.columns, figsize=layout.size, squeeze=False, layout="compressed")
    for column, (name, text) in enumerate(columns):
        data = []
        for file, index, k in rows:
            part = slice(None, None, _stride(file))
            data.append(file.field(name, index, slice(k, k + 1), part, part)[0])
        top = largest(data)
        low, high = _limits(name, component or "xx", top, limits)
        factor, prefixed = scale("Pa", max(abs(low), abs(high)))
        colours = "RdBu_r" if _is_signed(name) else "viridis"
        for row, ((file, index, k), values) in enumerate(zip(rows, data)):
            panel = axes[layout.place(row, column, len(columns))]
            image = field(panel, factor * values, edges[row], factor * low, factor * high, colours)
            panel.set(xlabel=label("$x$", unit), ylabel=label("$y$", unit) if layout.is_left(column) else "")
            layout.number(panel)
            bar(panel, image, label(_symbol(_component(name)), prefixed), layout.height)
            most = f"{_extremes(name, factor * values)} {prefixed}"
            depth = f"$z$ = {length * file.z[k]:.4g} {unit}, {most}{layout.remark}"
            _title(panel, text, depth, heading([one for one, _ in steps], file, index))
    return figure


def fatigue(files, at=(0.0, 0.0)):
    """Fatigue parameters over a section, or over the first plane, with the maximum marked: all of one file; of several
    those that each has, a row per file and one scale per parameter."""
    names = [name for name in files[0].fatigue if _have(files, name)]
    for one in files:
        if not one.fatigue:
            raise Error(f"{one.path}: has no fatigue parameter (petsam-stress -fatigue)")
    if not names:
        raise Error(f"{files[0].path}: shares no fatigue parameter with {files[-1].path}; draw them one by one")
    for one in files:
        if (one.along is None) != (files[0].along is None):
            raise Error(f"{one.path}: sections and maps do not go into one picture; draw them one by one")
    file = files[0]
    columns = min(2, len(names)) if len(files) == 1 else len(names)
    rows = -(-len(names) // columns) * len(files)
    need_few(rows * columns, "parameters and files")
    ratio = np.ptp(file.x) / np.ptp(file.y) if file.along is None else 1.0
    size = (5.6 * columns, (4.6 / min(max(1.0, ratio), 2.5) if file.along is None else 3.6) * rows + 0.3)
    figure, axes = plt.subplots(
        rows, columns, figsize=size, squeeze=False, layout="compressed" if file.along is None else "constrained"
    )
    tops = {name: _span([_fatigue_values(one, name, at)[0] for one in files]) for name in names}
    for panel, (one, name) in zip(axes.flat, ((one, name) for one in files for name in names)):
        _fatigue_panel(panel, one, name, at, tops[name])
        if len(files) > 1:
            panel.set_title(f"{plain(one.label)}: {panel.get_title()}", fontsize=9)
    for panel in axes.flat[len(names) * len(files) :]:
        panel.set_axis_off()
    if len(files) == 1 and named(files):
        figure.suptitle(plain(file.label), fontsize=9, color="0.35")
    untangle(figure)
    return figure


def _span(arrays):
    """The least, at most 0, and the largest of the finite values in arrays."""
    values = np.concatenate([one[np.isfinite(one)] for one in arrays])
    return min(0.0, float(np.min(values))), float(np.max(values))


def _fatigue_values(file, name, at):
    """Values of a parameter on a plane or a section; names and coordinates along it and across, and where it is."""
    if file.along is None:
        return file.field(name, depths=slice(0, 1))[0], "x", file.x, ("z", file.z[0]), "y", file.y
    axis, along, _, _, where = _line(file, at)
    return _section(file, name, 0, at), axis, along, where, "z", file.z


def _fatigue_panel(panel, file, name, at, span):
    values, axis, along, where, other, down = _fatigue_values(file, name, at)
    some = np.isfinite(values)
    k, i = np.unravel_index(np.argmax(np.where(some, values, -np.inf)), values.shape)
    high, base = float(values[k, i]), file.unit(name)
    factor, prefixed = scale(base, abs(span[1]))
    length, unit = scale("m", np.ptp(along) / 2)
    limits = (factor * span[0], factor * span[1])
    if file.along is None:
        image = field(panel, factor * values, extent(file.x, file.y, 1.0 / length), *limits, DAMAGE)
    elif some.all(axis=1).sum() > 1:
        image = _contours(panel, length * along, length * down, factor * values, *limits, DAMAGE)
    else:  # on one depth only
        image = None
        panel.plot(length * along, factor * values[k], color=colors(1)[0], linewidth=1.3)
    if image is None:
        _ring(panel, length * along[i], factor * high)
        panel.set(ylabel=label(FATIGUE[name], prefixed))
    else:
        cross(panel, length * along[i], length * down[k], MARK)
        panel.set(ylabel=label("depth $z$" if other == "z" else "$y$", unit))
        bar(panel, image, label(SHORT[name], prefixed))
    place = f"${axis}$ = {number(length * along[i])} {unit}, ${other}$ = {number(length * down[k])} {unit}"
    panel.set_xlabel(label(f"${axis}$", unit) + _at(where, length, unit))
    panel.set_title(f"{FATIGUE[name]}\nmaximum {number(factor * high)} {prefixed} at {place}", fontsize=9)

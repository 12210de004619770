"""Pictures of wear: the fretting log, scars, and quantities over the cycles; each function gives a matplotlib figure.

A fretting log is the family of loops of a wear simulation: the tangential load of a cycle over its displacement. Cycles
are numbered in thousands or millions, and coloured in their order, dark to bright: they range over decades, from 0.
"""

import numpy as np

from ..core.errors import Error
from ..results.fields import BLOCK
from .crossings import crossing, sides_of
from .loops import LOOPS, cycle_energy, loop_axes, loop_energy, spread
from .measured import read_profiles
from .style import colors, curve, named, need_few, note, over_cycles, plt, tint
from .symbols import SYMBOLS
from .units import counted, label, largest, number, plain, scale

LINES = 10  # default number of lines of a scar
# names in /wear, of both bodies or of the joint, and what they are called
LIFE = (
    (("volume1", "volume2"), "removed volume"),
    (("depth_max1", "depth_max2"), "maximum depth"),
    (("dissipated_energy",), "dissipated energy of a cycle"),
    (("contact_area",), "contact area"),
    (("pressure_max",), "maximum pressure"),
)
MEASURED = (":", "--", "-.")  # lines of measured profiles
BODIES = (".-", "s--")  # lines of the first and the second body that wears
LOOK = {"linewidth": 1.2, "markersize": 3.5, "markerfacecolor": "white"}


def _legend(panel, title):
    panel.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), title=title, borderaxespad=0.3)


# ---------------------------------------------------------------- the fretting log


def _closed(values):
    """Returns the values of a loop, closed at its beginning."""
    return np.concatenate([values[-1:], values])


def logged(one):
    """Returns the rows of /wear whose loops are drawn: the first, the last, and others that divide the wear evenly."""
    volume = one.wear["volume1"] + one.wear["volume2"]
    wanted = np.linspace(volume[0], volume[-1], LOOPS)
    return sorted({0, volume.size - 1, *(int(np.argmin(np.abs(volume - part))) for part in wanted[1:-1])})


def _of_life(one, names, wanted):
    """Cycles, energies and points (name: values) of the loops of a life: of the computed cycles nearest to those
    wanted, or of some."""
    cycles = one.wear["cycle"]
    rows = sorted({int(np.argmin(np.abs(cycles - cycle))) for cycle in wanted}) if wanted else logged(one)
    loops = [one.of_computed_cycle(cycle) for cycle in cycles[rows]]
    points = [lambda name, steps=steps: _closed(one.history[name][steps]) for steps in loops]
    friction = one.wear["dissipated_energy"][rows]
    energies = [loop_energy(one, names, values, energy) for values, energy in zip(points, friction)]
    return cycles[rows], np.array(energies), points


def _of_history(one, names, found, wanted):
    """Does the same for a history without wear over cycles."""
    if not len(found):
        raise Error(f"{one.path}: --fretting-log: has no whole cycle, by {found.manner}; see --turns and --period")
    chosen = [found.numbered(number) for number in wanted or spread(len(found))]
    points = [lambda name, rows=cycle.rows: one.series(name)[rows] for cycle in chosen]
    energies = [cycle_energy(one, names, cycle) for cycle in chosen]
    return np.array([float(cycle.number) for cycle in chosen]), np.array(energies), points


def _loops(panel, one, factors, loops):
    """Draws the loops of one file's cycles."""
    cycles, energies, points = loops
    factor, words = counted(cycles[-1])
    joules, unit = scale(one.work_unit, energies)
    for k, (cycle, energy, values) in enumerate(zip(cycles, energies, points)):
        y, x = (size * values(name) for name, (size, _) in factors.items())
        text = f"{factor * cycle:.3g}: {joules * energy:.3g} {unit}"
        panel.plot(x, y, color=tint(k, cycles.size), label=text, **curve(x.size, markersize=3.0))
    _legend(panel, f"{words}: energy of the loop")


def fretting_log(files, pair=None, find=None, wanted=None):
    """Loops of some cycles, or of those wanted, one panel per file; pair names the load (that which does most work).

    For wear over cycles these are computed cycles, for another history those of find(file), petsam.cycles.Cycles.
    """
    need_few(len(files), "files")
    need_few(len(wanted or ()), "cycles")
    for one in files:
        if find is None:
            one.need_life()
    factors = loop_axes(files, pair)
    names = tuple(factors)
    data = [
        _of_life(one, names, wanted) if one.has_life else _of_history(one, names, find(one), wanted) for one in files
    ]
    figure, axes = plt.subplots(
        1, len(files), figsize=(6.9 * len(files), 4.8), squeeze=False, sharex=True, sharey=True, constrained_layout=True
    )
    force, way = ((SYMBOLS[name], unit) for name, (_, unit) in factors.items())
    for panel, one, loops in zip(axes[0], files, data):
        _loops(panel, one, factors, loops)
        panel.set_title(plain(one.label) if named(files) else "", fontsize=9.5)
        panel.set_xlabel(label(*way))
    axes[0, 0].set_ylabel(label(*force))
    return figure


# ---------------------------------------------------------------- scars


def scar_steps(one):
    """Returns the default indices into the fields for a scar: ends of the saved cycles, or the last saved step."""
    ends = one.cycle_ends if one.has_life else [one.of_last()]
    return ends if len(ends) <= LINES else [ends[round(k)] for k in np.linspace(0, len(ends) - 1, LINES)]


def deepest(one, name, index):
    """Returns the largest removed depth of a saved step (m), and its place (x, y), m."""
    best = (-1.0, (0.0, 0.0))
    for start in range(0, one.y.size, BLOCK):
        block = one.field(name, index, slice(start, start + BLOCK))
        row, column = np.unravel_index(np.argmax(block), block.shape)
        best = max(best, (float(block[row, column]), (float(one.x[column]), float(one.y[start + row]))))
    return best


def worn(one, index):
    """Fields of removed depth of the bodies that have worn until a saved step, and their deepest points."""
    found = {name: deepest(one, name, index) for name in one.depths}
    return {name: point for name, (depth, point) in found.items() if depth > 0.0}


def _line(one, name, index, axis, at):
    """A removed depth along x (axis 0) or y (axis 1) through a point."""
    k = crossing(one, axis, at)
    part = {"rows" if axis == 0 else "columns": slice(k, k + 1)}
    return one.field(name, index, **part).ravel()


def _scar_rows(steps, at):
    """Returns the content of each row of panels: a file, its indices, a field of removed depth, and the point it goes
    through."""
    rows = []
    for one in dict.fromkeys(one for one, _ in steps):
        if not one.depths:
            raise Error(
                f"{one.path}: has no removed depth (petsam -wear_coefficient1 or -wear_energy1; -output_fields)"
            )
        indices = [index for other, index in steps if other is one]
        rows += [(one, indices, name, at or point) for name, point in worn(one, max(indices)).items()]
    if not rows:
        raise Error(f"{steps[0][0].path}: nothing has worn in the steps that are drawn")
    need_few(len(rows), "scars")
    return rows


def _window(lines, whole):
    """Returns the part of lines in which any shows a removed depth, with a margin."""
    cells = np.flatnonzero(np.any(np.array(lines) > 0.0, axis=0))
    if whole or not cells.size:
        return slice(None)
    more = 2 + (cells[-1] - cells[0]) // 7
    return slice(max(0, cells[0] - more), cells[-1] + more + 1)


def _names(one, indices):
    """Returns the labels of a scar's lines, and the title of their legend."""
    if not one.has_life:
        return [f"{one.steps[index]}" for index in indices], "step"
    factor, words = counted(max(one.cycles[index] for index in indices))
    return [f"{factor * one.cycles[index]:.4g}" for index in indices], words


def _scar_panel(panel, row, axis, units, whole, files):
    """Lines of one scar along an axis; units are those of lengths and of depths, files those of the picture."""
    one, indices, name, at = row
    (length, unit), (factor, _) = units
    lines = [_line(one, name, index, axis, at) for index in indices]
    part = _window(lines, whole)
    along = length * (one.x, one.y)[axis][part]
    texts, _ = _names(one, indices)
    for k, (values, text) in enumerate(zip(lines, texts)):
        panel.plot(along, factor * values[part], color=tint(k, len(lines)), linewidth=1.3, label=text)
    who = f"{plain(one.label)}: " if named(files) else ""
    across = f"${'yx'[axis]}$ = {number(length * at[1 - axis])} {unit}"
    where = "" if one.is_plane or one.is_steady else f" along ${'xy'[axis]}$ at {across}"
    panel.set_title(f"{who}body {name[-1]}{where}", fontsize=9)
    panel.set_xlabel(label(f"${'xy'[axis]}$", unit))


def _measured_rows(rows, measured):
    """Returns the rows that have profiles beside them, and the profiles: of the body that is named, else of the last
    one that wears."""
    if not measured:
        return (), None
    body, path = measured
    bodies = sorted({row[2][-1] for row in rows})
    if body and body not in bodies:
        raise Error(f"--measured {body}:{path}: body {body} does not wear")
    return [row for row in rows if row[2][-1] == (body or bodies[-1])], read_profiles(path)


def _draw_measured(panel, profiles, units):
    """Measured profiles as removed depths, within the panel's length."""
    x, heights = profiles
    limits = panel.get_xlim()
    if units[0][0] * x.max() < limits[0] or units[0][0] * x.min() > limits[1]:
        raise Error(f"--measured: the profile lies from {x.min():g} to {x.max():g} m, beside the scar: check its unit")
    for k, (name, height) in enumerate(heights.items()):
        text = f"measured: {plain(name)}" if len(heights) > 1 else "measured"
        style = MEASURED[k % len(MEASURED)]
        panel.plot(units[0][0] * x, -units[1][0] * height, style, color="black", linewidth=1.0, label=text)
    panel.set_xlim(limits)
    panel.legend(handles=panel.lines[-len(heights) :], loc="lower right")


def scar_steps_of(files):
    """Pairs of a file and an index into its fields, for each of its default steps."""
    return [(one, k) for one in files for k in scar_steps(one)]


def scar(steps, at=None, whole=False, measured=None):
    """Removed depth along x (left) and y (right) through its deepest point: one row per body, one line per step.

    Of plane problems along x only, of running bands across them. measured: a body, "1", "2" or "", and the name of a
    file with profiles along the first of these that are drawn beside it.
    """
    need_few(len(steps), "steps and files")
    rows = _scar_rows(steps, at)
    beside, profiles = _measured_rows(rows, measured)
    files = list(dict.fromkeys(one for one, _ in steps))
    sides = (1,) if all(one.is_steady for one in files) else sides_of(files)
    depth = largest(
        _line(one, name, index, axis, point)
        for one, indices, name, point in rows
        for index in indices
        for axis in sides
    )
    units = scale("m", *(axis for one, _ in steps for axis in (one.x, one.y))), scale("m", depth)
    size = (11.5 if len(sides) > 1 else 7.5, 3.2 * len(rows) + 0.3)
    figure, axes = plt.subplots(
        len(rows), len(sides), figsize=size, squeeze=False, sharey="row", constrained_layout=True
    )
    for panels, row in zip(axes, rows):
        for axis, panel in zip(sides, panels):
            _scar_panel(panel, row, axis, units, whole, files)
        if row in beside:
            _draw_measured(panels[0], profiles, units)
        panels[0].invert_yaxis()  # shared
        panels[0].set_ylabel(label(f"removed depth $w_{row[2][-1]}$", units[1][1]))
        _legend(panels[-1], _names(row[0], row[1])[1])
    return figure


# ---------------------------------------------------------------- the life


def _worn_bodies(files):
    """Numbers of the bodies that wear in any of the files."""
    return [body for body in "12" if any(np.any(one.wear["volume" + body]) for one in files)]


def _life_panel(panel, files, names, title):
    """One quantity over the cycles; of two bodies that wear the second one is dashed."""
    bodies = _worn_bodies(files) or ["1"]
    if len(names) > 1:
        names = [name for name in names if name[-1] in bodies]
        title += f" of body {bodies[0]}" if len(names) == 1 else ""
    factor, unit = scale(files[0].wear_units[names[0]], *(one.wear[name] for one in files for name in names))
    for one, color in zip(files, colors(len(files))):
        for name, style in zip(names, BODIES):
            panel.plot(one.wear["cycle"], factor * one.wear[name], style, color=color, **LOOK)
    over_cycles(panel, [one.wear["cycle"] for one in files])
    panel.set(ylabel=label(title, unit))


def _life_legend(panel, files):
    """Draws the legend of the lines of all panels in a panel of its own; a user's label of a single line is above the
    panels."""
    panel.set_axis_off()
    for one, color in zip(files, colors(len(files))):
        panel.plot([], [], color=color, label=plain(one.label))
    if len(_worn_bodies(files)) > 1:
        for body, style in zip("12", BODIES):
            panel.plot([], [], style, color="0.35", label=f"body {body}", **LOOK)
    if len(panel.lines) > 1:
        panel.legend(loc="center")
    elif named(files):
        note(panel.figure, plain(files[0].label))


def life(files):
    """Volume, maximum depth, energy, contact area and maximum pressure over the cycles, one line per file."""
    for one in files:
        one.need_life()
    figure, axes = plt.subplots(2, 3, figsize=(12.6, 6.2), sharex=True, constrained_layout=True)
    figure.get_layout_engine().set(w_pad=0.12)  # inches: long labels keep off the panel beside them
    for panel, (names, title) in zip(axes.flat, LIFE):
        _life_panel(panel, files, names, title)
        panel.tick_params(labelbottom=True)
    _life_legend(axes.flat[-1], files)
    return figure

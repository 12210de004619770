"""The pictures of petsam-plot; each function takes results.Results and gives a matplotlib figure.

A saved step is given as a pair (Results, index into its saved fields), and read no further than is drawn. Axes carry
units with the prefix that suits the values.
"""

import numpy as np
from matplotlib.colors import ListedColormap

from ..errors import Error, short
from ..results import DEPTHS, OPEN, SLIP, STICK
from .style import colors, extent, field, plt
from .units import label, largest, plain, scale

FIELDS = ("pressure", "shear_x", "shear_y", "slip_x", "slip_y", "state")  # of maps and profiles
VOLUMES = ("wear_volume1", "wear_volume2")
STATES = {OPEN: ("open", "#f4f4f4"), STICK: ("stick", "#3b4cc0"), SLIP: ("slip", "#e9a03b")}
PIXELS = 1200  # of a map in each direction: more cells than the eye and the paper hold
PANELS = 64  # of a picture at most, one below the other or side by side

# the loads and what they work on
PAIRS = {
    "tx": ("load_tx", "disp_x"), "ty": ("load_ty", "disp_y"), "mz": ("load_mz", "rot_z"),
    "n": ("load_n", "disp_z"), "mx": ("load_mx", "rot_x"), "my": ("load_my", "rot_y"),
}  # fmt: skip
SYMBOLS = {
    "load_n": "$N$", "load_tx": "$T_x$", "load_ty": "$T_y$", "load_mx": "$M_x$", "load_my": "$M_y$", "load_mz": "$M_z$",
    "disp_z": "$d_z$", "disp_x": "$d_x$", "disp_y": "$d_y$", "rot_x": "$r_x$", "rot_y": "$r_y$", "rot_z": "$r_z$",
    "dissipated_energy": "dissipated energy, sum",
    "wear_volume1": "volume removed of body 1", "wear_volume2": "volume removed of body 2",
}  # fmt: skip
COLUMNS = (
    ("pressure", "pressure $p$", "Pa"),
    ("shear", "shear $|q|$", "Pa"),
    ("slip", "slip $|s|$", "m"),
    ("state", "state", ""),
)


def need_few(count, what):
    if count > PANELS:
        raise Error(f"{count} {what} in one picture; expected at most {PANELS}")


# ---------------------------------------------------------------- maps


def _map_data(results, index, whole):
    """Fields of one snapshot on the window of its contact, no more cells than the picture has pixels."""
    rows, columns = (slice(0, results.y.size), slice(0, results.x.size)) if whole else results.contact_window(index)
    stride = max(1, -(-max(rows.stop - rows.start, columns.stop - columns.start) // PIXELS))

    def read(name):
        return results.field(name, index, rows, columns, stride)

    state = read("state")
    slip = np.where(state == OPEN, np.nan, np.hypot(read("slip_x"), read("slip_y")))
    return {
        "extent": extent(results.x[columns], results.y[rows], stride=stride),
        "state": state,
        "slip": slip,
        "pressure": read("pressure"),
        "shear": np.hypot(read("shear_x"), read("shear_y")),
        **{name: read(name) for name in results.depths},
        "edges": [results.edge(name, index) for name in results.edges],
    }


def _map_columns(data):
    """Name, title and unit of what is drawn of all steps: fields, and the removed depths of bodies that have worn."""
    worn = [name for name in DEPTHS if largest(one[name] for one in data if name in one) > 0.0]
    return [*COLUMNS, *((name, f"depth removed of body {name[-1]}, $w_{name[-1]}$", "m") for name in worn)]


def _map(axes, data, name, factor, length, vmax):
    edges = [length * value for value in data["extent"]]
    if name == "state":
        return field(axes, data[name], edges, -0.5, 2.5, ListedColormap([STATES[k][1] for k in sorted(STATES)]))
    return field(axes, factor * data[name], edges, 0.0, vmax or 1.0)


def maps(snapshots, whole=False):
    """Pressure, |q|, |s|, state and removed depths: a row a snapshot, one scale a column."""
    need_few(len(snapshots), "steps and files")
    data = [_map_data(results, index, whole) for results, index in snapshots]
    length, unit = scale("m", largest(np.array(one["extent"]) for one in data))
    columns = _map_columns(data)
    size = (3.5 * len(columns), 2.9 * len(data) + 0.3)
    figure, axes = plt.subplots(len(data), len(columns), figsize=size, squeeze=False, constrained_layout=True)
    for column, (name, text, base) in enumerate(columns):
        top = largest(one[name] for one in data if name in one)
        factor, prefixed = scale(base, top) if base else (1.0, "")
        for row, one in enumerate(data):
            panel = axes[row, column]
            if name not in one:  # a file without wear
                panel.set_axis_off()
                continue
            image = _map(panel, one, name, factor, length, factor * top)
            panel.set(
                xlabel=label("$x$", unit),
                ylabel=label("$y$", unit) if column == 0 else "",
                title=text if row == 0 else "",
            )
            for points in one["edges"]:
                panel.plot(*(length * points.T), ".", color="white" if base else "black", markersize=1.0)
            bar = figure.colorbar(image, ax=panel, aspect=25, label=label(text.split()[-1], prefixed) if base else "")
            if name == "state":
                bar.set_ticks(sorted(STATES), labels=[STATES[k][0] for k in sorted(STATES)])
    for row, (results, index) in enumerate(snapshots):
        axes[row, 0].annotate(
            plain(results.title(index)),
            (0.03, 0.97),
            xycoords="axes fraction",
            va="top",
            fontsize=8,
            color="white",
            bbox={"facecolor": "black", "alpha": 0.45, "linewidth": 0, "pad": 2},
        )
    return figure


# ---------------------------------------------------------------- profiles


def crossing(results, axis, at):
    """Number of the row (axis 0) or column (axis 1) of cells nearest to the point at."""
    across = (results.y, results.x)[axis]
    half = 0.5 * (across[1] - across[0])
    if not across[0] - half <= at[1 - axis] <= across[-1] + half:
        raise Error("{}: --at {:g},{:g}: is not on the grid".format(results.path, *at))
    return int(np.argmin(np.abs(across - at[1 - axis])))


def _profile(results, index, axis, at, whole):
    """Fields along x (axis 0) or y (axis 1) through the cells nearest to the point at."""
    window = (slice(0, results.y.size), slice(0, results.x.size)) if whole else results.contact_window(index)
    along = (results.x, results.y)[axis]
    k = crossing(results, axis, at)
    rows, columns = (slice(k, k + 1), window[1]) if axis == 0 else (window[0], slice(k, k + 1))
    data = {
        name: results.field(name, index, rows, columns).ravel()
        for name in ("pressure", "shear_x", "shear_y", "slip_x", "slip_y", "state", *results.depths)
    }
    for name in ("slip_x", "slip_y"):
        data[name] = np.where(data["state"] == OPEN, np.nan, data[name])
    return {**dict.fromkeys(DEPTHS, np.zeros_like(data["pressure"])), **data, "along": along[window[1 - axis]]}


def _profile_panel(axes, lines, names, length, factor, friction):
    """Lines of the components names of every snapshot; with friction, if a number, the bounds +-mu p behind."""
    for data, color, mu, text in lines:
        if friction and mu > 0.0:
            for sign in (1.0, -1.0):
                axes.plot(
                    length * data["along"],
                    sign * factor * mu * data["pressure"],
                    ":",
                    color=color,
                    linewidth=0.9,
                    alpha=0.7,
                )
        for name, style in zip(names, ("-", "--")):
            axes.plot(
                length * data["along"],
                factor * data[name],
                style,
                color=color,
                linewidth=1.3,
                label=text if style == "-" else None,
            )


def profiles(snapshots, at=(0.0, 0.0), whole=False):
    """Pressure, shear, slip and removed depths along x (left) and y (right)."""
    tints = colors(len(snapshots))
    lines = [
        [
            (_profile(results, index, axis, at, whole), tint, results.friction(index), plain(results.title(index)))
            for (results, index), tint in zip(snapshots, tints)
        ]
        for axis in (0, 1)
    ]
    every = [line[0] for side in lines for line in side]
    length, unit = scale("m", largest(data["along"] for data in every))
    rows = [
        (("pressure",), "pressure $p$", "Pa", False),
        (("shear_x", "shear_y"), "shear $q_x$ (line), $q_y$ (dashed), $\\pm\\mu p$ (dots)", "Pa", True),
        (("slip_x", "slip_y"), "slip $s_x$ (line), $s_y$ (dashed)", "m", False),
        (DEPTHS, "removed depth $w_1$ (line), $w_2$ (dashed)", "m", False),
    ]
    tops = [largest(data[name] for data in every for name in row[0]) for row in rows]
    shown = [(row, top) for row, top in zip(rows, tops) if top > 0.0] or [(rows[0], 0.0)]
    figure, axes = plt.subplots(
        len(shown),
        2,
        figsize=(11.0, 2.7 * len(shown) + 0.4),
        squeeze=False,
        sharey="row",
        sharex="col",
        constrained_layout=True,
    )
    for panels, ((names, text, base, friction), top) in zip(axes, shown):
        factor, prefixed = scale(base, top)
        for panel, side in zip(panels, lines):
            _profile_panel(panel, side, names, length, factor, friction)
        symbol = {"pressure": "$p$", "shear_x": "$q$", "slip_x": "$s$", "wear_depth1": "$w$"}[names[0]]
        panels[0].set(ylabel=label(symbol, prefixed))
        panels[0].set_title(text, loc="left", fontsize=9.5)
    axes[-1, 0].set_xlabel("{}  at $y$ = {:.4g} {}".format(label("$x$", unit), length * at[1], unit))
    axes[-1, 1].set_xlabel("{}  at $x$ = {:.4g} {}".format(label("$y$", unit), length * at[0], unit))
    if len(snapshots) > 1:
        axes[0, 0].legend(loc="lower center")  # below the pressure
    else:
        figure.suptitle(plain(snapshots[0][0].title(snapshots[0][1])), fontsize=9, color="0.35")
    return figure


# ---------------------------------------------------------------- loops and histories


def busiest(results):
    """The pair of load and displacement whose product varies most; None where none does."""

    def work(pair):
        load, way = (results.series(name) for name in PAIRS[pair])
        return float(np.ptp(load) * np.ptp(way))

    # the tangential loads before the normal ones: these dissipate nothing
    best = max(("tx", "ty", "mz"), key=work)
    if work(best) > 1e-9 * work("n"):
        return best
    return "n" if work("n") > 0.0 else None


def of_computed(results):
    """What a sum over the steps of a life has to say: the cycles between those computed are not in it."""
    return " in the computed cycles" if results.has_life else ""


def loop_axes(results, pair=None):
    """The load and the displacement of a loop, and of each the factor and the unit that suit all files."""
    pair = pair or busiest(results[0])
    if pair is None:
        raise Error(f"{results[0].path}: no load varies, a loop needs several steps")
    return {name: scale(results[0].units[name], largest(one.series(name) for one in results)) for name in PAIRS[pair]}


def loop(results, pair=None):
    """A load over its displacement, of every file; steps without a solution are left out."""
    for one in results:
        one.need_solution()
    factors = loop_axes(results, pair)
    force, way = factors
    figure, axes = plt.subplots(figsize=(6.4, 4.8), constrained_layout=True)
    for one, tint in zip(results, colors(len(results))):
        x, y = (factors[name][0] * one.series(name) for name in (way, force))
        energy = float(np.sum(one.series("dissipated_energy")))
        factor, unit = scale("J", energy)
        axes.plot(
            x,
            y,
            ".-",
            color=tint,
            linewidth=1.2,
            markersize=4.0,
            label=f"{plain(one.label)}: {factor * energy:.4g} {unit} dissipated" + of_computed(one),
        )
        axes.plot(
            x[-1],
            y[-1],
            "o",
            color=tint,
            markersize=6.0,
            markerfacecolor="white",
            label="last step" if one is results[-1] else None,
        )
    axes.set(xlabel=label(SYMBOLS[way], factors[way][1]), ylabel=label(SYMBOLS[force], factors[force][1]))
    axes.legend(loc="upper left")
    axes.margins(y=0.15)
    return figure


def _series(results, name):
    """Times and values of /history/name of the steps that have a solution; of the dissipated energy the sum.

    The status is that of all steps: it tells which of them have none.
    """
    if name == "status":
        status, time = results.history[name], results.history["time"]
        complete = min(status.size, time.size)
        return time[:complete], status[:complete].astype(float)
    values = results.series(name).astype(float)
    return results.series("time"), np.cumsum(values) if name == "dissipated_energy" else values


def _varying(results):
    """Names that a picture of the history shows by itself: what is zero but for rounding does not vary."""
    length = max(largest((one.x, one.y)) for one in results)
    force, way = (
        max(largest(one.series(name) for one in results) for name in names)
        for names in (("load_n", "load_tx", "load_ty"), ("disp_z", "disp_x", "disp_y"))
    )
    size = {"N": force, "N m": force * length, "m": way, "rad": way / length}
    loads = [
        name
        for pair in PAIRS.values()
        for name in pair
        if any(np.ptp(one.series(name)) > 1e-9 * size.get(one.units[name], 0.0) for one in results)
    ]
    shared = [name for name in VOLUMES if all(name in one.history for one in results)]
    worn = [name for name in shared if any(np.any(one.series(name)) for one in results)]
    # of a life the sum of the energy over the computed cycles says nothing
    energy = [] if any(one.has_life for one in results) else ["dissipated_energy"]
    return [*loads, "contact_area", "stick_area", *worn, *energy, "tangential_iterations"]


def history(results, names=None):
    """Datasets of /history over time, a panel each, a line a file; of steps without a solution the status alone."""
    for one in results:
        one.need_solution()
        for name in names or ():
            if name not in one.history:
                raise Error(
                    "{}: --names {}: has no such dataset; it has {}".format(
                        one.path, short(name), ", ".join(sorted(one.history))
                    )
                )
    names = names or _varying(results)
    need_few(len(names), "datasets")
    columns = min(3, len(names))
    rows = -(-len(names) // columns)
    figure, axes = plt.subplots(
        rows, columns, figsize=(4.2 * columns, 2.6 * rows + 0.3), squeeze=False, sharex=True, constrained_layout=True
    )
    for panel, name in zip(axes.flat, names):
        factor, unit = scale(results[0].units[name], largest(_series(one, name)[1] for one in results))
        for one, tint in zip(results, colors(len(results))):
            time, values = _series(one, name)
            panel.plot(time, factor * values, ".-", color=tint, linewidth=1.1, markersize=3.0, label=plain(one.label))
        panel.set(ylabel=label(SYMBOLS.get(name) or plain(name.replace("_", " ")), unit))
    for panel in axes.flat[len(names) :]:
        panel.set_axis_off()
    for panel in axes.flat[max(0, len(names) - columns) : len(names)]:
        panel.set_xlabel("time, s")
        panel.tick_params(labelbottom=True)
    axes.flat[0].legend(loc="best")
    return figure

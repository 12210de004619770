"""A picture of a load history: loads and moments over time, the path of T, and the path of the contact's centre."""

import numpy as np
from matplotlib.figure import Figure

from ...plot.style import colors, curve, drawn, note, plt
from ...plot.units import label, plain, scale
from ...results.file import Results
from .resultants import SYMBOLS, History

NODES = 4000  # that are drawn
# three panels over time beside two that are as wide as high
PLACES = [["shear", "path"], ["shear", "path"], ["normal", "path"], ["normal", "centre"], ["moments", "centre"],
          ["moments", "centre"]]  # fmt: skip


def _over_time(panel, found, names, unit, what):
    """Loads over time, by their columns."""
    for name, tint in zip(names, colors()):
        values = next(column.values for column in found.table() if column.name == name)
        panel.plot(
            found.times, unit[0] * np.array(values), color=tint, label=f"${SYMBOLS[name]}$", **curve(found.times.size)
        )
    panel.set(xlabel=label("time", "s"), ylabel=label(what, unit[1]))
    if len(names) > 1:
        panel.legend()


def _path(panel, x, y, unit, tint):
    """A path in a plane, whose first point is marked."""
    panel.plot(unit[0] * x, unit[0] * y, color=tint, **curve(x.size))
    first = np.flatnonzero(np.isfinite(x))[:1]
    panel.plot(
        unit[0] * x[first], unit[0] * y[first], "o", color=tint, markersize=7, fillstyle="none", label="first row"
    )


def _center(panel, found):
    """The path of the contact's centre over the nodes."""
    unit = scale("m", found.x[:, :2] if np.any(found.x[:, :2]) else found.center)
    few = found.x[:: max(1, len(found.x) // NODES)]
    panel.plot(unit[0] * few[:, 0], unit[0] * few[:, 1], ".", color="0.75", markersize=2.5, label="nodes")
    _path(panel, *found.center.T, unit, colors()[3])
    panel.set(xlabel=label("$x$", unit[1]), ylabel=label("$y$", unit[1]), title="centre of the contact")
    panel.set_aspect("equal", adjustable="datalim")
    panel.legend()


@drawn(History)
def loads(found: History) -> Figure:
    """T, N and the moments over time, the path of T, and that of the contact's centre.

    Parameters
    ----------
    found : loads.History
        The history, of petsam.loads.history().

    Returns
    -------
    matplotlib.figure.Figure
    """
    tangential = found.loads[:, 1:3]
    shear, normal, moment = scale("N", tangential), scale("N", found.loads[:, 0]), scale("N m", found.loads[:, 3:])
    figure, panels = plt.subplot_mosaic(PLACES, figsize=(9.6, 8.4), layout="constrained")
    _over_time(panels["shear"], found, ["load_tx", "load_ty"], shear, "tangential force")
    _over_time(panels["normal"], found, ["load_n"], normal, f"${SYMBOLS['load_n']}$")
    _over_time(panels["moments"], found, ["load_mx", "load_my", "load_mz"], moment, "moment")
    side = panels["path"]
    t_x, t_y = tangential.T
    _path(side, t_x, t_y, shear, colors()[2])
    side.set(xlabel=label("$T_x$", shear[1]), ylabel=label("$T_y$", shear[1]))
    side.set_aspect("equal", adjustable="datalim")
    side.legend()
    _center(panels["centre"], found)
    note(figure, f"{plain(found.name)}: {found.x.shape[0]} nodes, forces on body {found.on[-1]} of the analysis")
    return figure


@drawn(History, Results)
def loads_beside(found: History, results: Results) -> Figure:
    """Pressure and shear of the analysis beside those of petsam, along y = 0 at the last saved step.

    Parameters
    ----------
    found : loads.History
        The history, of forces in a file with CPRESS.
    results : Results
        Of a run with this history.

    Returns
    -------
    matplotlib.figure.Figure
    """
    nodes, row = found.line(float(results.times[-1])), int(np.argmin(np.abs(results.y)))
    shear = np.hypot(*(results.field(f"shear_{axis}", -1)[row] for axis in "xy"))
    ours = {"pressure": results.field("pressure", -1)[row], "shear": shear}
    length = scale("m", nodes["x"])
    figure, panels = plt.subplots(1, 2, figsize=(9.6, 4.0), layout="constrained")
    for panel, name, symbol in zip(panels, ours, ("$p$", "$|q|$")):
        unit = scale("Pa", ours[name], nodes[name])
        panel.plot(length[0] * results.x, unit[0] * ours[name], color=colors()[0], label="petsam")
        panel.plot(
            length[0] * nodes["x"], unit[0] * nodes[name], "o", color=colors()[1], markersize=4, label="analysis"
        )
        panel.set(xlabel=label("$x$", length[1]), ylabel=label(f"{name} {symbol}", unit[1]))
        panel.legend()
    note(figure, f"{plain(found.name)}: along $y$ = 0, {plain(results.when(-1))}")
    return figure

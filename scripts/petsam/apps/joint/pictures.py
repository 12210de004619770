"""Pictures of what petsam.joint has found: interfaces, backbones and their bands, responses, wear."""

from __future__ import annotations

import itertools
from collections.abc import Mapping
from typing import Optional

import numpy as np
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Patch as Key
from matplotlib.patheffects import withStroke
from numpy.typing import ArrayLike

from ...core.errors import Error
from ...plot.fields import STATES
from ...plot.style import bar, colors, drawn, logarithmic, plt
from ...plot.units import label as labelled
from ...plot.units import plain, scale
from ...results.fields import OPEN, SLIP
from .backbones import MODAL, Backbone
from .balance import Response
from .bands import ASSEMBLED, NUMBERS, Band
from .properties import Interface
from .saved import Saved
from .wearing import Wear

WHOLE = {"axes.formatter.useoffset": False}  # ticks have whole numbers, not what is beyond an offset
THIN = {"markersize": 5.0, "linewidth": 1.0, "capsize": 3.0}
RINGS = {"markersize": 5, "markerfacecolor": "white", "linewidth": 1.0, "zorder": 2}
MARKS = "os^Dv"
HATCH, HATCHED = "////", "0.25"  # of what slips


@drawn(Interface)
def interface(found: Interface) -> Figure:
    """The stiffnesses, the real contact area and, where it is computed, the conductance over the pressure.

    Parameters
    ----------
    found : joint.Interface
        The interface, of petsam.joint.interface().

    Returns
    -------
    matplotlib.figure.Figure
    """
    conducts = found.conductors is not None and "h" in found.numbers
    count = 3 if conducts else 2
    figure, (left, right, *more) = plt.subplots(1, count, figsize=(4.0 * count, 3.4), layout="constrained")
    pressure = found.numbers["pressure"] / 1e6
    for axes, name, label, unit, color, look in (
        (left, "k_n", "normal", 1e-12, colors()[0], {"marker": "o"}),
        (left, "k_n_loading", "normal, loading", 1e-12, colors()[3], {"marker": "s"}),
        # the curves along x and y often lie on one another: the rings of x are around the crosses of y
        (left, "k_t_x", "tangential, $x$", 1e-12, colors()[1], {"marker": "o", "ms": 8.0}),
        (left, "k_t_y", "tangential, $y$", 1e-12, colors()[2], {"marker": "x", "linestyle": "--"}),
        (right, "area", "real contact area", 100.0, colors()[0], {"marker": "o"}),
    ):
        if name not in found.numbers:
            continue
        spread = found.spread.get(name)
        look = {"ms": 5.0, "linewidth": 1.2, "markerfacecolor": "none", "capsize": 3.0, **look}
        bars = None if spread is None else unit * spread
        axes.errorbar(pressure, unit * found.numbers[name], bars, color=color, label=label, **look)
    for axes, label in ((left, "contact stiffness, N/µm per mm²"), (right, "real contact area, %")):
        axes.set(xlabel="nominal pressure, MPa", ylabel=label)
        logarithmic(axes, "xy")
    left.legend()
    for axes in more:
        _conductance(axes, found, 0)
    return figure


def _conductance(axes, found, k):
    """The k-th interface's conductance per area over the pressure."""
    look = {"ms": 5.0, "linewidth": 1.2, "markerfacecolor": "none", "capsize": 3.0, "marker": "osD^v"[k % 5]}
    color = colors()[k % len(colors())]
    pressure, spread = found.numbers["pressure"] / 1e6, found.spread.get("h")
    axes.errorbar(pressure, found.numbers["h"], spread, color=color, label=_conducting(found.conductors), **look)
    unit = "S/m²" if found.conductors.electrical else "W/(m² K)"
    axes.set(xlabel="nominal pressure, MPa", ylabel=f"contact conductance, {unit}")
    logarithmic(axes, "xy")
    axes.legend()


def _changes(ax, first, what):
    """Title and label of changes of a frequency, whose first value stands in the title."""
    ax.axhline(0.0, color="0.4", linewidth=0.8, linestyle="--")
    ax.set(title=f"Frequency: {first:.6g} Hz {what}", ylabel="change of frequency, %")


def _relative(frequency, first):
    """Change of a frequency, %."""
    return 100.0 * (np.asarray(frequency) / first - 1.0)


def _say_last(ax, x, y, above=True):
    """Writes the last value, %, beside its point."""
    text = f"{y[-1]:.2g} %".replace("-", "\N{MINUS SIGN}")
    place = {"xytext": (-7, 0), "textcoords": "offset points", "ha": "right", "va": "bottom" if above else "top"}
    ax.annotate(text, (x[-1], y[-1]), fontsize=9, **place)


@drawn(Backbone, style=WHOLE)
def backbone(found: Backbone) -> Figure:
    """Change of the frequency, and damping, over the amplitude.

    Parameters
    ----------
    found : joint.Backbone
        The backbone.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, (left, right) = plt.subplots(1, 2, figsize=(8.0, 3.4), layout="constrained")
    reach, damping = 1e6 * found.amplitude, 100.0 * (found.damping + found.viscous)
    title = "Damping by friction" + (" and material" if np.any(found.viscous > 0.0) else "")
    right.set(title=title, ylabel="damping, % of critical")
    _changes(left, found.linear, "while all that touches sticks")
    label = "modal amplitude, 1e-6 m kg$^{1/2}$" if found.unit == MODAL else "amplitude, µm"
    for ax, values, above in ((left, _relative(found.frequency, found.linear), False), (right, damping, True)):
        ax.plot(reach, values, "o-", color=colors()[0], **RINGS)
        _say_last(ax, reach, values, above)
        ax.set_xlabel(label)
    logarithmic(left, "x")
    logarithmic(right, "xy" if np.all(found.damping > 0.0) else "x")
    return figure


def _hatched(ax, x, y, inside):
    """Hatches some cells, for eyes and prints without colours."""
    if np.any(inside):
        marked = ax.contourf(x, y, inside, levels=[0.5, 1.5], colors="none", hatches=[HATCH])
        marked.set(edgecolor=HATCHED, linewidth=0.0)


def _keys():
    """Returns the entries of the legend of zones."""
    hatched = {SLIP: {"hatch": HATCH, "edgecolor": HATCHED, "linewidth": 0.0}}
    shown = [(STATES[k], hatched.get(k, {})) for k in sorted(STATES) if k != OPEN]
    return [Key(facecolor=tint, label=word, **look) for (word, tint), look in shown]


def _bolts_of(bolts, x, y):
    """Returns the bolts whose axes cross a patch, {name: (x, y, diameter)}, m."""
    return {name: one for name, one in (bolts or {}).items() if x[0] <= one[0] <= x[-1] and y[0] <= one[1] <= y[-1]}


def _mark_bolts(ax, bolts):
    """Section of each bolt, and its name, in mm."""
    for name, (x, y, diameter) in bolts.items():
        turn = np.linspace(0.0, 2.0 * np.pi, 60)
        for look in ({"color": "white", "linewidth": 2.4}, {"color": "black", "linewidth": 1.2, "linestyle": "--"}):
            ax.plot(1e3 * (x + 0.5 * diameter * np.cos(turn)), 1e3 * (y + 0.5 * diameter * np.sin(turn)), **look)
        edge = [withStroke(linewidth=2.5, foreground="white")]
        ax.text(1e3 * x, 1e3 * y, name, ha="center", va="center", path_effects=edge)


def _line(left, right, x, fields, highest):
    """Pressure (MPa) and state of the cells of a section over x, mm; the states with the pressure as their height."""
    pressure, states = fields
    width = np.diff(x).mean()
    left.step(x, pressure, where="mid", color=colors()[0])
    for k, (_, tint) in STATES.items():
        chosen = (states == k) & (pressure > 0.0)
        look = {"hatch": HATCH, "edgecolor": HATCHED, "linewidth": 0.0} if k == SLIP else {}
        right.bar(x[chosen], pressure[chosen], width, color=tint, **look)
    right.legend(handles=_keys(), loc="upper center", bbox_to_anchor=(0.5, -0.16), ncols=2)
    for ax in (left, right):
        ax.set(xlabel="$x$, mm", ylabel="pressure in the preload, MPa", xlim=(x[0], x[-1]), ylim=(0.0, 1.05 * highest))


@drawn(Backbone, style={"axes.grid": False})
def slip_zones(found: Backbone, *, bolts: Optional[Mapping[str, ArrayLike]] = None) -> Figure:
    """The patches of a backbone, one below the other: pressure in the preload, and where the largest amplitude makes
    them slip. Those of sections are lines over x.

    Parameters
    ----------
    found : joint.Backbone
        The backbone.
    bolts : dict, optional
        {name: (x, y, diameter)} of bolts that are drawn on maps, m, as joint.Pair has them in `places`.

    Returns
    -------
    matplotlib.figure.Figure
    """
    tints = [STATES[k][1] for k in sorted(STATES)]
    size = (8.0, 3.4 * len(found.names))
    figure, rows = plt.subplots(len(found.names), 2, figsize=size, layout="constrained", squeeze=False)
    highest = 1e-6 * max(float(np.max(one)) for one in found.pressure)  # one scale of all patches
    for k, ((left, right), (x, y)) in enumerate(zip(rows, found.axes)):
        if len(y) == 1:
            _line(left, right, 1e3 * x, (1e-6 * found.pressure[k][0], found.states[k][0]), highest)
            left.set_title(f"{found.names[k]}: preload")
            right.set_title(f"{found.names[k]}: largest amplitude")
            continue
        pressed = np.where(found.pressure[k] > 0.0, 1e-6 * found.pressure[k], np.nan)
        left.set_facecolor(STATES[OPEN][1])
        mesh = left.pcolormesh(1e3 * x, 1e3 * y, pressed, cmap="viridis", vmin=0.0, vmax=highest, rasterized=True)
        bar(left, mesh, "pressure $p$, MPa")
        given = dict(cmap=ListedColormap(tints), vmin=-0.5, vmax=len(tints) - 0.5, rasterized=True)
        right.pcolormesh(1e3 * x, 1e3 * y, found.states[k], **given)
        _hatched(right, 1e3 * x, 1e3 * y, np.asarray(found.states[k]) == SLIP)
        right.legend(handles=_keys(), loc="upper center", bbox_to_anchor=(0.5, -0.16), ncols=2)
        near = _bolts_of(bolts, x, y)
        name = ", ".join([found.names[k], *(f"bolt {one}" for one in near)])
        for ax, title in ((left, "preload"), (right, "largest amplitude")):
            _mark_bolts(ax, near)
            ax.set(xlabel="$x$, mm", ylabel="$y$, mm", aspect="equal", title=f"{name}: {title}")
    return figure


@drawn(Band, style=WHOLE)
def band(found: Band) -> Figure:
    """The bands of the frequency's change and of damping over the amplitude.

    Parameters
    ----------
    found : joint.Band
        The band.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, axes = plt.subplots(1, 2, figsize=(8.0, 3.4), layout="constrained")
    reach = 1e6 * found.given.amplitude[: found.count]
    first = found.given.linear
    of_name = (lambda values: _relative(values, first), 100.0 / first), (lambda values: 100.0 * values, 100.0)
    for ax, name, (shown, factor) in zip(axes, NUMBERS, of_name):
        low, high = (shown(one) for one in found.limits(name))
        ax.fill_between(reach, low, high, color="0.85", label="all assemblies")
        for color, mark, (assembly, one) in zip(colors(), MARKS, found.backbones.items()):
            values = shown(one.numbers[name][: found.count])
            error = factor * found.deviation(name) if found.scatter and assembly == ASSEMBLED else None
            ax.errorbar(reach, values, error, color=color, label=assembly, marker=mark, markerfacecolor="none", **THIN)
        ax.set(xlabel="amplitude, µm")
    _changes(axes[0], first, "while all that touches sticks")
    axes[1].set(title="Damping by friction", ylabel="damping, % of critical")
    axes[1].legend()
    logarithmic(axes[0], "x")
    logarithmic(axes[1], "xy" if np.all(found.given.damping > 0.0) else "x")
    return figure


@drawn(Response, style=WHOLE)
def response(found: Response) -> Figure:
    """Amplitude and phase over the frequency.

    Parameters
    ----------
    found : joint.Response
        The response.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, (left, right) = plt.subplots(1, 2, figsize=(8.0, 3.4), layout="constrained")
    left.plot(found.frequency, 1e6 * found.amplitude, "o-", color=colors()[0], markersize=4.0)
    left.set(xlabel="frequency, Hz", ylabel="amplitude, µm")
    logarithmic(left, "y")
    right.plot(found.frequency, np.degrees(found.phase), "o-", color=colors()[0], markersize=4.0)
    right.set(xlabel="frequency, Hz", ylabel="phase, degrees")
    return figure


@drawn(Wear, style=WHOLE)
def joint_wear(found: Wear) -> Figure:
    """Change of the frequency, and damping, over the cycles.

    Parameters
    ----------
    found : joint.Wear
        The wear of the joint.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, axes = plt.subplots(1, 2, figsize=(8.0, 3.4), layout="constrained")
    first = found.numbers["frequency"][0]
    of_name = (_relative(found.frequency, first), 100.0 / first), (100.0 * found.damping, 100.0)
    for ax, name, (values, factor) in zip(axes, ("frequency", "damping"), of_name):
        error = factor * found.numbers[f"{name}_error"]
        ax.errorbar(found.cycles, values, error, color=colors()[0], marker="o", markerfacecolor="white", **THIN)
        ax.set_xscale("symlog", linthresh=max(found.cycles[1], 1.0))
        ax.set(xlabel="cycles")
    _changes(axes[0], first, "without wear")
    axes[1].set(title="Damping by friction", ylabel="damping, % of critical")
    return figure


SAVED = {  # of the columns of a file: the one below, and those that are drawn over it
    Interface: ("pressure", ("k_n", "k_t_x", "k_t_y", "area", "h")),
    Backbone: ("amplitude", ("frequency", "damping")),
    Band: ("amplitude", ("frequency", "damping")),
    Response: ("frequency", ("amplitude", "phase")),
    Wear: ("cycles", ("frequency", "damping")),
}


@drawn(Saved, style=WHOLE)
def saved(found: Saved) -> Figure:
    """Columns of a table over the first one of its kind; of a band a curve for each assembly.

    Parameters
    ----------
    found : joint.Saved
        The table, of petsam.joint.read().

    Returns
    -------
    matplotlib.figure.Figure
    """
    columns = {column.name: column for column in found.table()}
    below, names = SAVED[found.kind]
    shown = [columns[name] for name in names if name in columns]
    curves = np.array(
        columns["assembly"].values if "assembly" in columns else np.full(np.shape(columns[below].values), "")
    )
    figure, axes = plt.subplots(1, len(shown), figsize=(4.0 * len(shown), 3.4), layout="constrained", squeeze=False)
    for ax, column in zip(axes[0], shown):
        for name, color, mark in zip(dict.fromkeys(curves), itertools.cycle(colors()), itertools.cycle(MARKS)):
            x, y = (np.array(one.values)[curves == name] for one in (columns[below], column))
            factors = [scale(one.unit, one.values, powers=True) for one in (columns[below], column)]
            ax.plot(factors[0][0] * x, factors[1][0] * y, mark + "-", color=color, label=name or None, **RINGS)
        heads = [labelled(plain(one.name), unit) for one, (_, unit) in zip((columns[below], column), factors)]
        ax.set(xlabel=heads[0], ylabel=heads[1])
    if "assembly" in columns:
        axes[0][0].legend()
    return figure


@drawn(Interface)
def conductance(*found: Interface) -> Figure:
    """The conductance per area over the pressure, of one interface or of several: bare, with a film, with gas.

    Parameters
    ----------
    *found : joint.Interface
        Interfaces with a conductance, all thermal or all electrical, of petsam.joint.interface().

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    Error
        Without a conductance, or if thermal and electrical ones are mixed.
    """
    if not found or any(one.conductors is None for one in found):
        raise Error("conductance: expected interfaces with a conductance: compute them with conductivity")
    electrical = {one.conductors.electrical for one in found if one.conductors}
    if len(electrical) > 1:
        raise Error("conductance: thermal and electrical conductances have different units: draw one picture of each")
    figure, axes = plt.subplots(figsize=(5.0, 3.4), layout="constrained")
    for k, one in enumerate(found):
        _conductance(axes, one, k)
    return figure


def _conducting(conductors):
    """Returns the names of the conductors, in a few words."""
    words = (
        ("layers on the bodies", any(conductors.layers)),
        ("film on the spots", conductors.has_film),
        ("gas in the gap", conductors.gas),
    )
    return " and ".join(word for word, there in words if there) or "spots alone"

"""Pictures of what petsam.joint has found: interfaces, backbones and their bands, responses, wear."""

import numpy as np
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Patch as Key

from ..core.errors import Error
from ..joint.backbone import MODAL, Backbone
from ..joint.balance import Response
from ..joint.band import ASSEMBLED, NUMBERS, Band
from ..joint.interfaces import Interface
from ..joint.wear import Wear
from .fields import OPEN, STATES
from .style import COLORS, STYLE, WHOLE, drawn, logarithmic, plt


@drawn(STYLE, Interface)
def interface(found: Interface) -> Figure:
    """The stiffnesses and the real contact area over the pressure.

    Parameters
    ----------
    found : joint.Interface
        The interface, of petsam.joint.interface().

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, (left, right) = plt.subplots(1, 2, figsize=(8.0, 3.4), layout="constrained")
    pressure = found.numbers["pressure"] / 1e6
    for axes, name, label, unit, color, look in (
        (left, "k_n", "normal", 1e-12, COLORS[0], {"marker": "o"}),
        (left, "k_n_loading", "normal, loading", 1e-12, COLORS[3], {"marker": "s"}),
        # the curves along x and y often lie on one another: the rings of x are around the crosses of y
        (left, "k_t_x", "tangential, $x$", 1e-12, COLORS[1], {"marker": "o", "ms": 8.0}),
        (left, "k_t_y", "tangential, $y$", 1e-12, COLORS[2], {"marker": "x", "linestyle": "--"}),
        (right, "area", "real contact area", 100.0, COLORS[0], {"marker": "o"}),
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
    return figure


@drawn(WHOLE, Backbone)
def backbone(found: Backbone) -> Figure:
    """Frequency and damping over the amplitude.

    Parameters
    ----------
    found : joint.Backbone
        The backbone.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, (left, right) = plt.subplots(1, 2, figsize=(8.0, 3.4), layout="constrained")
    reach = 1e6 * found.amplitude
    left.axhline(found.linear, color="0.4", linewidth=0.8, linestyle="--", label="all that touches sticks")
    left.plot(reach, found.frequency, "o-", color=COLORS[0], markersize=4.0)
    label = "modal amplitude, 1e-6 m kg$^{1/2}$" if found.unit == MODAL else "amplitude, µm"
    left.set(xlabel=label, ylabel="frequency, Hz")
    left.legend()
    right.plot(reach, 100.0 * (found.damping + found.viscous), "o-", color=COLORS[0], markersize=4.0)
    right.set(xlabel=label, ylabel="damping, % of critical")
    logarithmic(left, "x")
    logarithmic(right, "xy" if np.all(found.damping > 0.0) else "x")
    return figure


@drawn({**STYLE, "axes.grid": False}, Backbone)
def slip_zones(found: Backbone) -> Figure:
    """The patches of a backbone, one below the other: pressure in the preload, and where the largest amplitude makes
    them slip.

    Parameters
    ----------
    found : joint.Backbone
        The backbone.

    Returns
    -------
    matplotlib.figure.Figure
    """
    words, tints = zip(*(STATES[k] for k in sorted(STATES)))
    size = (8.0, 3.4 * len(found.names))
    figure, rows = plt.subplots(len(found.names), 2, figsize=size, layout="constrained", squeeze=False)
    for k, ((left, right), (x, y)) in enumerate(zip(rows, found.axes)):
        pressed = np.where(found.pressure[k] > 0.0, 1e-6 * found.pressure[k], np.nan)
        mesh = left.pcolormesh(1e3 * x, 1e3 * y, pressed, cmap="viridis", vmin=0.0, rasterized=True)
        figure.colorbar(mesh, ax=left, label="pressure, MPa")
        given = dict(cmap=ListedColormap(tints), vmin=-0.5, vmax=len(tints) - 0.5, rasterized=True)
        right.pcolormesh(1e3 * x, 1e3 * y, found.states[k], **given)
        keys = [Key(color=tint, label=word) for word, tint in zip(words, tints) if word != STATES[OPEN][0]]
        right.legend(handles=keys, loc="upper center", bbox_to_anchor=(0.5, -0.16), ncols=2)
        for ax, title in ((left, "preload"), (right, "largest amplitude")):
            ax.set(xlabel="x, mm", ylabel="y, mm", aspect="equal", title=f"{found.names[k]}, {title}")
    return figure


@drawn(WHOLE, Band)
def band(found: Band) -> Figure:
    """The bands of frequency and damping over the amplitude.

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
    for ax, name, factor in zip(axes, NUMBERS, (1.0, 100.0)):
        low, high = (factor * one for one in found.limits(name))
        ax.fill_between(reach, low, high, color="0.85", label="all assemblies")
        for color, (assembly, one) in zip(COLORS, found.backbones.items()):
            values = factor * one.numbers[name][: found.count]
            error = factor * found.deviation(name) if found.scatter and assembly == ASSEMBLED else None
            ax.errorbar(reach, values, error, color=color, marker="o", markersize=3.0, label=assembly)
        ax.set(xlabel="amplitude, µm")
    axes[0].set(ylabel="frequency, Hz")
    axes[1].set(ylabel="damping by friction, % of critical")
    axes[0].legend()
    logarithmic(axes[0], "x")
    logarithmic(axes[1], "xy" if np.all(found.given.damping > 0.0) else "x")
    return figure


@drawn(WHOLE, Response)
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
    left.plot(found.frequency, 1e6 * found.amplitude, "o-", color=COLORS[0], markersize=4.0)
    left.set(xlabel="frequency, Hz", ylabel="amplitude, µm")
    logarithmic(left, "y")
    right.plot(found.frequency, np.degrees(found.phase), "o-", color=COLORS[0], markersize=4.0)
    right.set(xlabel="frequency, Hz", ylabel="phase, degrees")
    return figure


@drawn(WHOLE, Wear)
def joint_wear(found: Wear) -> Figure:
    """Frequency and damping over the cycles.

    Parameters
    ----------
    found : joint.Wear
        The wear of the joint.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, axes = plt.subplots(1, 2, figsize=(8.0, 3.4), layout="constrained")
    for ax, name, factor in zip(axes, ("frequency", "damping"), (1.0, 100.0)):
        values, error = (factor * found.numbers[one] for one in (name, f"{name}_error"))
        ax.errorbar(found.cycles, values, error, color=COLORS[0], marker="o", markersize=4.0)
        ax.set_xscale("symlog", linthresh=max(found.cycles[1], 1.0))
        ax.set(xlabel="cycles")
    axes[0].set(ylabel="frequency, Hz")
    axes[1].set(ylabel="damping by friction, % of critical")
    return figure


@drawn(STYLE, Interface)
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
    electrical = {one.conductors.electrical for one in found}
    if len(electrical) > 1:
        raise Error("conductance: thermal and electrical conductances have different units: draw one picture of each")
    figure, axes = plt.subplots(figsize=(5.0, 3.4), layout="constrained")
    for k, one in enumerate(found):
        spread = one.spread.get("h")
        look = {"ms": 5.0, "linewidth": 1.2, "markerfacecolor": "none", "capsize": 3.0, "marker": "osD^v"[k % 5]}
        axes.errorbar(
            one.pressure / 1e6, one.h, spread, color=COLORS[k % len(COLORS)], label=_conducting(one.conductors), **look
        )
    unit = "S/m²" if electrical.pop() else "W/(m² K)"
    axes.set(xlabel="nominal pressure, MPa", ylabel=f"contact conductance, {unit}")
    logarithmic(axes, "xy")
    axes.legend()
    return figure


def _conducting(conductors):
    """What conducts, in a few words."""
    film = "film on the spots" if conductors.film else ""
    return " and ".join(word for word in (film, "gas in the gap" if conductors.gas else "") if word) or "spots alone"

"""Pictures of fitted loops: measured points and fit of the first and the last cycle, friction over the cycles."""

from collections.abc import Mapping

import numpy as np
from matplotlib.figure import Figure

from ...plot.style import colors, curve, drawn, note, plt
from ...plot.units import label, plain, scale
from .scars import Scar
from .series import Result

SIDE = 4.4, 3.8  # inches of a panel


def _points(panel, x, y, tint, **style):
    """Values as points of that colour, small ones where they are many."""
    style = {"marker": "o", "markersize": 4.4 if curve(len(x))["marker"] else 2.2, "markerfacecolor": "white", **style}
    panel.plot(x, y, color=tint, linestyle="none", **style)


def _loop(panel, one, title, length, force):
    """The measured loop of a cycle, and its fit above it."""
    loop, (d, q) = one.loops[0], one.curves[0]
    _points(panel, length[0] * loop.displacement, force[0] * loop.force, colors()[0], label="measured", zorder=1)
    if one.state != "rejected":
        panel.plot(length[0] * d, force[0] * q, color=colors()[1], linewidth=1.4, label="fit")
    panel.set(xlabel=label("displacement", length[1]), ylabel=label("force", force[1]), title=title)
    panel.legend(loc="upper left")


def _over_cycles(panel, found):
    """Friction with its 95 % over the cycles; where the loops do not hold it, their energy."""
    each = found.each or [found.fit] * len(found.numbers)
    friction = np.array([one.friction for one in each])
    deviation = np.nan_to_num([one.friction_sd for one in each])
    if np.isfinite(friction).any():
        panel.errorbar(found.numbers, friction, 2.0 * deviation, color=colors()[2], fmt="none", alpha=0.5)
        _points(panel, found.numbers, friction, colors()[2])
        panel.set(xlabel="cycle", ylabel="friction", title="friction, bars of 95 %")
    else:
        factor, unit = scale("J", found.energy)
        _points(panel, found.numbers, factor * found.energy, colors()[2])
        panel.set(xlabel="cycle", ylabel=label("dissipated energy", unit), title="energy of the loops")


@drawn(Result)
def fit(found: Result) -> Figure:
    """Measured loops of the first and of the last cycle with their fits, and friction or energy over the cycles.

    Parameters
    ----------
    found : Result

    Returns
    -------
    matplotlib.figure.Figure
    """
    fits = [found.each[0], found.each[-1]] if found.each else [found.fit]
    titles = ["first cycle", "last cycle"] if len(fits) > 1 else ["first loop"]
    count = len(fits) + (len(found.numbers) > 1)
    figure, axes = plt.subplots(1, count, figsize=(SIDE[0] * count, SIDE[1]), squeeze=False, layout="constrained")
    length = scale("m", *(one.loops[0].displacement for one in fits))
    force = scale("N", *(one.loops[0].force for one in fits))
    for panel, one, title in zip(axes[0], fits, titles):
        _loop(panel, one, title, length, force)
    if len(fits) > 1:  # with one scale
        axes[0, 1].sharex(axes[0, 0])
        axes[0, 1].sharey(axes[0, 0])
    if count > len(fits):
        _over_cycles(axes[0, -1], found)
    note(figure, f"friction: {found.state}")
    return figure


@drawn(Mapping)
def scar_fit(found: Mapping[str, Scar]) -> Figure:
    """Measured profiles of scars with their fits.

    Parameters
    ----------
    found : dict
        {name: Scar}.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, panel = plt.subplots(figsize=(6.4, 4.2), layout="constrained")
    length = scale("m", *(scar.x for scar in found.values()))
    height = scale("m", *(scar.height for scar in found.values()))
    for (name, scar), tint in zip(found.items(), colors(len(found))):
        _points(panel, length[0] * scar.x, height[0] * scar.height, tint, zorder=1, label=plain(name))
        text = (
            "no numbers" if scar.doubt else f"{scar.coefficient:.3g} \N{PLUS-MINUS SIGN} {scar.coefficient_sd:.2g} 1/Pa"
        )
        panel.plot(length[0] * scar.x, height[0] * scar.curve, color=tint, linewidth=1.4, label=text)
    panel.set(xlabel=label("$x$", length[1]), ylabel=label("height", height[1]))
    panel.legend(loc="best")
    return figure

"""Pictures of fitted loops: measured points and fit of the first and the last cycle, friction over the cycles."""

from collections.abc import Mapping

import numpy as np
from matplotlib.figure import Figure

from ...plot.style import colors, plt
from .scars import Scar
from .series import Result


def fit(found: Result) -> Figure:
    """Measured loops with their fit, and friction and energy over the cycles.

    Parameters
    ----------
    found : Result

    Returns
    -------
    matplotlib.figure.Figure
    """
    several = len(found.numbers) > 1
    figure, axes = plt.subplots(1, 2 if several else 1, figsize=(10.0 if several else 5.6, 4.2), squeeze=False,
                                constrained_layout=True)  # fmt: skip
    left = axes[0, 0]
    fits = [found.each[0], found.each[-1]] if found.each else [found.fit]
    names = ["first cycle", "last cycle"] if len(fits) > 1 else ["measured"]
    for one, name, tint in zip(fits, names, colors(len(fits))):
        loop, (d, q) = one.loops[0], one.curves[0]
        left.plot(1e6 * loop.displacement, loop.force, ".", color=tint, markersize=3.0, label=name)
        if one.state != "rejected":
            left.plot(1e6 * d, q, color=tint, linewidth=1.0, label="fit")
    left.set(xlabel="displacement, µm", ylabel="force, N", title=found.state)
    left.legend(loc="best", fontsize=8)
    if several:
        right = axes[0, 1]
        each = found.each or [found.fit] * len(found.numbers)
        friction = np.array([one.friction for one in each])
        deviation = np.nan_to_num([one.friction_sd for one in each])
        if np.isfinite(friction).any():
            low, high = friction - 2.0 * deviation, friction + 2.0 * deviation
            right.vlines(found.numbers, low, high, color=colors(1)[0], linewidth=1.2, alpha=0.5)
            right.plot(found.numbers, friction, "o", color=colors(1)[0], markersize=4.0)
            right.set(xlabel="cycle", ylabel="friction, with 95 %")
        else:
            right.plot(found.numbers, 1e6 * found.energy, "o", color=colors(1)[0], markersize=4.0)
            right.set(xlabel="cycle", ylabel="dissipated energy, uJ")
    return figure


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
    figure, panel = plt.subplots(figsize=(6.4, 4.2), constrained_layout=True)
    for (name, scar), tint in zip(found.items(), colors(len(found))):
        panel.plot(1e3 * scar.x, 1e6 * scar.height, ".", color=tint, markersize=4.0, label=name)
        text = "no numbers" if scar.doubt else f"{scar.coefficient:.3g} +- {scar.coefficient_sd:.2g} 1/Pa"
        panel.plot(1e3 * scar.x, 1e6 * scar.curve, color=tint, linewidth=1.0, label=text)
    panel.set(xlabel="x, mm", ylabel="height, µm")
    panel.legend(loc="best", fontsize=8)
    return figure

"""A picture of a map: the map, and profiles through its middle along x and y."""

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, MaxNLocator
from mpl_toolkits.axes_grid1 import make_axes_locatable

from ...core.units import shown
from ...plot.style import colors, drawn, extent, field, note, plt
from ...plot.units import label, scale
from .basics import QUANTITIES
from .maps import Map, peak_to_valley, rms_height, rms_slope

CELLS = 1200  # of a map in x or y that are drawn
SIDE = 6.5  # inches of the map's longer side
TICKS = 6  # along the longer side
NARROW = 0.25  # share of the longer side that has room for one tick only
WIDE = 1.5  # ratio of the sides from which on the profiles are below the map


def _quantity(one, unit):
    return label("separation" if one.quantity == "separation" else "height", unit)


def _map(figure, axes, one, lateral, height):
    stride = max(1, -(-max(one.n) // CELLS))
    x, y = one.axis(0), one.axis(1)
    values = one.values[::stride, ::stride] * height[0]
    image = field(axes, values, extent(x, y, 1.0 / lateral[0], stride), values.min(), values.max())
    axes.set(xlabel=label("x", lateral[1]), ylabel=label("y", lateral[1]), aspect="equal")
    for d, scaled in enumerate((axes.xaxis, axes.yaxis)):
        share = min(1.0, one.size[d] / one.size[1 - d])
        few = FixedLocator([one.center[d] * lateral[0]])  # where two labels would collide
        scaled.set_major_locator(few if share < NARROW else MaxNLocator(max(2, round(TICKS * share))))
    # as tall as the map, whatever that is
    beside = make_axes_locatable(axes).append_axes("right", size=0.15, pad=0.12)
    ticks = MaxNLocator(max(2, round(TICKS * min(1.0, one.size[1] / one.size[0]))))
    figure.colorbar(image, cax=beside, label=_quantity(one, height[1]), ticks=ticks)


def _profiles(axes, one, lateral, height):
    row, column = (n // 2 for n in one.values.shape)
    texts = ("y = {}", "x = {}")
    places = (one.axis(1)[row], one.axis(0)[column])
    if one.is_profile:
        axes.plot(one.axis(0) * lateral[0], one.values[0] * height[0], color=colors()[0], linewidth=1.0)
        axes.set(xlabel=label("x", lateral[1]), ylabel=_quantity(one, height[1]))
        return
    for d, values in enumerate((one.values[row], one.values[:, column])):
        name = f"along {'xy'[d]}, " + texts[d].format(shown(places[d])).replace(" um", " µm")
        axes.plot(one.axis(d) * lateral[0], values * height[0], color=colors()[d], linewidth=1.0, label=name)
    axes.set(xlabel=label("x or y", lateral[1]), ylabel=_quantity(one, height[1]))
    axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=2)  # where no curve can be


@drawn(Map)
def surface(one: Map) -> Figure:
    """A map, and profiles through its middle along x and y; a profile alone.

    Parameters
    ----------
    one : surface.Map
        The map.

    Returns
    -------
    matplotlib.figure.Figure
    """
    lateral = scale("m", *(one.axis(k) for k in range(1 if one.is_profile else 2)))
    height = scale("m", one.values)
    ratio = one.size[1] / one.size[0]
    if one.is_profile:
        figure, second = plt.subplots(figsize=(SIDE + 1.5, 4.3))
    elif ratio < 1.0 / WIDE:
        heights = (SIDE * ratio + 1.0, 3.5)
        figure, (first, second) = plt.subplots(2, 1, height_ratios=heights, figsize=(SIDE + 1.5, sum(heights) + 0.8))
    else:
        widths = (SIDE * min(1.0, 0.65 / ratio) + 1.8, 6.0)
        figure, (first, second) = plt.subplots(1, 2, width_ratios=widths, figsize=(sum(widths), 4.8))
    figure.set_layout_engine("tight")
    if not one.is_profile:
        _map(figure, first, one, lateral, height)
    _profiles(second, one, lateral, height)
    numbers = f"Sq {shown(rms_height(one))}, Sdq {rms_slope(one):.3g}, peak to valley {shown(peak_to_valley(one))}"
    note(figure, f"{QUANTITIES[one.quantity]}: {numbers}".replace(" um", " µm"), 10)
    return figure


def finite(one):
    """True if the map can be drawn: it must not overflow."""
    return bool(np.all(np.isfinite(one.values)))

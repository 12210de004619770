"""Changes of a figure that has been drawn: parts of its axes, its width, its numbers as CSV."""

import numpy as np
from matplotlib.lines import Line2D
from matplotlib.text import Text

from ..core.errors import Error
from ..core.line import wrote
from ..core.tables import Column, csv_text
from ..core.words import Measured
from .style import plt
from .units import bracketed, of_label

INCH = 25.4  # mm
NAMES = ("panel", "curve", "x_label", "y_label", "x", "y", "value")  # of the columns of numbers
LEAST = 4.5  # points of a text in a picture of a given width


def _panels(figure):
    """Panels with data, without colour bars."""
    return [panel for panel in figure.axes if panel.axison and panel.has_data() and panel.get_label() != "<colorbar>"]


def adapt(figure, x_limits=None, y_limits=None, width=None):
    """Show parts of the axes only (SI units); an axis that points down stays so. Width in mm, texts in proportion."""
    panels = _panels(figure)
    shared = [next(filter(None, (getattr(one, f"get_{n}label")() for one in panels)), "") for n in "xy"]
    for n, limits in enumerate((x_limits, y_limits)):
        ranges = []  # of the data
        for panel in panels if limits else ():
            axis, change = ((panel.xaxis, panel.set_xlim), (panel.yaxis, panel.set_ylim))[n]
            text = axis.get_label_text() or shared[n]
            si, unit = of_label(text)
            if isinstance(limits, Measured):
                limits.need(si, f"--{'xy'[n]}lim, of {text}")
            ranges.append(np.sort((panel.dataLim.intervalx, panel.dataLim.intervaly)[n]) * unit)
            low, high = (value / unit for value in limits)
            change(*((high, low) if axis.get_inverted() else (low, high)))
        if ranges and all(one[1] < limits[0] or one[0] > limits[1] for one in ranges):
            raise Error(
                f"--{'xy'[n]}lim {limits[0]:g},{limits[1]:g}: nothing is drawn there: "
                f"the data reach from {min(one[0] for one in ranges):.4g} to {max(one[1] for one in ranges):.4g}"
            )
    if width:
        inches = figure.get_size_inches()
        part = width / INCH / inches[0]
        figure.set_size_inches(part * inches)
        figure.scaled = part  # of colour bars
        for text in figure.findobj(Text):
            text.set_fontsize(max(part * text.get_fontsize(), LEAST))
        for line in figure.findobj(Line2D):
            line.set(linewidth=part * line.get_linewidth(), markersize=part * line.get_markersize())
        for panel in figure.axes:
            low = max(part * plt.rcParams["font.size"], LEAST)
            panel.tick_params(which="both", labelsize=low, length=3.5 * part, width=0.8 * part, pad=3.5 * part)


def _grids(panel):
    """Coordinates and values of maps and filled contours: x, y, (y, x)."""
    for image in panel.images:
        values = np.ma.getdata(image.get_array()).astype(float)  # what has the colour of the open surface, too
        low_x, high_x, low_y, high_y = image.get_extent()
        rows, columns = values.shape[:2]
        across, up = (high_x - low_x) / columns, (high_y - low_y) / rows
        x, y = low_x + across * (np.arange(columns) + 0.5), low_y + up * (np.arange(rows) + 0.5)
        yield x, y, values
    yield from (one.drawn for one in panel.collections if hasattr(one, "drawn"))


def _rows(figure):
    """Yields panel, curve, labels of the axes, x, y, and of maps the value, for each point."""
    for number, panel in enumerate(_panels(figure), 1):
        title = " ".join((panel.get_title() or panel.get_title("left") or str(number)).split())
        about = [bracketed(text) for text in (panel.get_xlabel() or "x", panel.get_ylabel() or "y")]
        for line in (line for line in panel.lines if np.size(line.get_xdata()) > 1):
            label = line.get_label()
            name = "" if label.startswith("_") else label
            for x, y in zip(*(np.asarray(data, dtype=float) for data in line.get_data())):
                yield title, name, *about, repr(float(x)), repr(float(y)), ""
        for x, y, values in _grids(panel):
            for j, i in np.argwhere(np.isfinite(values)):
                yield title, "", *about, *(repr(float(one)) for one in (x[i], y[j], values[j, i]))


def write(figure, path, mode="w"):
    """One row per point: panel, curve, labels of the axes, x, y; of maps the value. The numbers are in the units that
    the labels have in brackets, as each panel has its own."""
    columns = [Column(name, "", "", values) for name, values in zip(NAMES, zip(*_rows(figure)))]
    text = csv_text(columns or [Column(name, "", "", []) for name in NAMES])
    with open(path, mode, encoding="utf-8", newline="") as file:
        file.write(text if mode == "w" else text.partition("\n")[2])
    if mode == "w":
        wrote(path)

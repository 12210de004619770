"""What is done to a figure when it has been drawn: parts of its axes, its width, its numbers as CSV."""

import csv

import numpy as np
from matplotlib.lines import Line2D
from matplotlib.text import Text

from .style import plt
from .units import size_of

INCH = 25.4  # mm
LEAST = 4.5  # points of a text in a picture of a given width


def _panels(figure):
    """Panels with data, without colour bars."""
    return [panel for panel in figure.axes if panel.axison and panel.has_data() and panel.get_label() != "<colorbar>"]


def adapt(figure, x_limits=None, y_limits=None, width=None):
    """Show parts of the axes only (SI units); an axis that points down stays so. Width in mm, texts in proportion."""
    panels = _panels(figure)
    shared = [next(filter(None, (getattr(one, f"get_{n}label")() for one in panels)), "") for n in "xy"]
    for panel in panels:
        for limits, text, axis, change in (
            (x_limits, shared[0], panel.xaxis, panel.set_xlim),
            (y_limits, shared[1], panel.yaxis, panel.set_ylim),
        ):
            if limits:
                low, high = (value / size_of(axis.get_label_text() or text) for value in limits)
                change(*((high, low) if axis.get_inverted() else (low, high)))
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
        values = np.ma.filled(np.ma.asarray(image.get_array(), dtype=float), np.nan)
        low_x, high_x, low_y, high_y = image.get_extent()
        rows, columns = values.shape[:2]
        across, up = (high_x - low_x) / columns, (high_y - low_y) / rows
        x, y = low_x + across * (np.arange(columns) + 0.5), low_y + up * (np.arange(rows) + 0.5)
        yield x, y, values
    yield from (one.drawn for one in panel.collections if hasattr(one, "drawn"))


def write(figure, path, mode="w"):
    """One row per point: panel, curve, labels of the axes, x, y; of maps the value. Units are those of the labels."""
    with open(path, mode, encoding="utf-8", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        if mode == "w":
            table.writerow(["panel", "curve", "x_label", "y_label", "x", "y", "value"])
        for number, panel in enumerate(_panels(figure), 1):
            title = " ".join((panel.get_title() or panel.get_title("left") or str(number)).split())
            about = [panel.get_xlabel() or "x", panel.get_ylabel() or "y"]
            for line in (line for line in panel.lines if np.size(line.get_xdata()) > 1):
                label = line.get_label()
                name = "" if label.startswith("_") else label
                for x, y in zip(*(np.asarray(data, dtype=float) for data in line.get_data())):
                    table.writerow([title, name, *about, repr(float(x)), repr(float(y)), ""])
            for x, y, values in _grids(panel):
                for j, i in np.argwhere(np.isfinite(values)):
                    numbers = (x[i], y[j], values[j, i])
                    table.writerow([title, "", *about, *(repr(float(number)) for number in numbers)])
    if mode == "w":
        print("wrote " + path)

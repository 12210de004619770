"""Fields over the saved steps of results as pictures of which a slider shows one step: in pages and notebooks."""

import itertools

import numpy as np
from matplotlib.text import Text
from matplotlib.ticker import MaxNLocator

from ..core.errors import counted
from ..results.fields import OPEN
from . import colours, crossings, fields, looks, noise, page, symbols
from .style import drawn

STEPS = 20  # saved steps at most, chosen evenly
FIELDS = 4  # beside each other at most, besides the state
STATE = "state"
BYTES = 1100000  # of all pictures of a slider at most
DPI = 110  # pixels per inch
WIDTH = 100.0  # mm of a map
TEXT = 8.0  # points of a text at least
TICKS = 4  # intervals along x at most
LINES = ("shear", "slip")  # in plane strain their components along x
NUMBERS = itertools.count(1)  # of the sliders of a process, whose names differ


def chosen(results):
    """Indices of the saved steps that are shown."""
    count = results.times.size
    return np.unique(np.linspace(0, count - 1, min(count, STEPS)).round().astype(int)).tolist()


def window(results, indices):
    """The rows and columns that hold the contact of all steps."""
    parts = [results.contact_window(index) for index in indices]
    return tuple(slice(min(one[k].start for one in parts), max(one[k].stop for one in parts)) for k in (0, 1))


def _span(results, indices, name, part):
    """Least and largest value of a field in these steps, 0 among them; of slip in the contact."""
    low = high = 0.0
    for index in indices:
        values = results.quantity(name, index, *part)
        if name in fields.OF_CONTACT and "state" in results.fields:
            values = values[results.field("state", index, *part) != OPEN]
        values = values[np.isfinite(values)]
        low, high = min(low, float(np.min(values, initial=0.0))), max(high, float(np.max(values, initial=0.0)))
    return low, high


def spans(results, indices, part):
    """{field: its range} of the fields that are shown: those that differ from zero in some step."""
    names = [name for name in fields.usual(results) if not results.flags(name)]
    if results.is_plane:
        names = [name + "_x" if name in LINES and name + "_x" in results.fields else name for name in names]
    found = {name: _span(results, indices, name, part) for name in [*names, *results.depths]}
    tops = {name: max(-low, high) for name, (low, high) in found.items()}
    shown = [name for name, top in tops.items() if top > 0.0 and not noise.is_nothing(name, tops, [results])]
    ranges = {name: found[name] for name in (shown or names[:1])[:FIELDS]}
    if STATE in results.fields and not results.is_plane:
        ranges[STATE] = (0.0, 1.0)  # of flags, whose colours need no range
    return ranges


@drawn()
def _picture(results, index, name, span, part):
    if results.is_plane:
        span = span if span[1] > span[0] else None
        figure = crossings.profiles([(results, index)], whole=part, names=[name], limits=span)
    else:
        limits = span if span[1] > span[0] else None
        figure = fields.maps([(results, index)], part, [name], colours.Choice(limits))
    looks.adapt(figure, width=WIDTH)
    for panel in figure.axes:
        panel.tick_params(labelsize=TEXT)
        if panel.images or panel.lines:  # no bar of colours
            panel.xaxis.set_major_locator(MaxNLocator(TICKS))
    for text in figure.findobj(Text):
        text.set_fontsize(max(text.get_fontsize(), TEXT))
    return figure


def _frame(results, index, ranges, part, first):
    """The pictures of one step, and what step it is."""
    when = results.when(index) or f"step {results.steps[index]}"
    shown = []
    for name, span in ranges.items():
        title = symbols.field(results, name)[0].replace("$", "")
        figure = _picture(results, index, name, span, part)
        shown.append(page.figure(page.image(figure, f"{title} of {when}", DPI, lines=False), f"{title}, {when}"))
    return page.element("div", *shown, class_="frame", data_when=when, hidden=None if first else True)


def slider(results, most=BYTES):
    """The pictures of the saved steps and the slider that chooses one, as HTML; of a single step without the slider.

    Where the pictures of all steps that chosen() names would be larger than `most` bytes, every second one is left out.
    """
    indices = chosen(results)
    part = window(results, indices)
    ranges = spans(results, indices, part)
    first = _frame(results, indices[-1], ranges, part, True)  # the last step is seen first, and without JavaScript
    while len(indices) > 2 and len(first) * len(indices) > most:
        indices = indices[::-2][::-1]
    others = [_frame(results, index, ranges, part, False) for index in indices[:-1]]
    return page.element("div", *_choice(results, len(indices)), page.joined([*others, first]), class_="slider")


def _choice(results, count):
    if count < 2:
        return []
    name = f"petsam-step-{next(NUMBERS)}"
    hint = page.element("span", " (arrow keys move it)", class_="screen")
    label = page.element("label", "Saved step", hint, for_=name)
    last = str(count - 1)
    # the name and the numbers are this module's own
    given = f'type="range" id="{name}" min="0" max="{last}" step="1" value="{last}"'
    said = page.element("output", results.when(results.times.size - 1), for_=name)
    saved = results.times.size
    left = f"{counted(count, 'picture')} of {saved} saved steps. " if count < saved else ""
    note = page.element("p", f"{left}All steps have one scale.")
    return [page.element("div", label, page.Html(f"<input {given}>"), said, class_="choice"), note]


class View:
    """Fields over the saved steps of Results, with a slider; a notebook shows it."""

    def __init__(self, results):
        self.path, self.inner = results.path, slider(results)

    def __repr__(self):
        return f"View({self.path!r}: a notebook shows it)"

    def _repr_html_(self):
        """The slider, its look and its script."""
        parts = [page.Html(f"<style>{page.CSS}</style>"), self.inner, page.Html(f"<script>{page.SCRIPT}</script>")]
        return str(page.element("div", *parts, class_="petsam"))

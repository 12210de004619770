"""How all pictures look: matplotlib without a screen, the house's style and colours, and what many pictures share."""

import functools
import os
import re

import matplotlib

if os.environ["MPLBACKEND"] == "Agg":  # see __init__.py: also where matplotlib has been imported before
    matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (the backend is chosen first)
import numpy as np  # noqa: E402
from matplotlib.ticker import LogFormatterMathtext, MaxNLocator  # noqa: E402
from PIL import Image  # noqa: E402  (comes with matplotlib)

from ..core.errors import Error  # noqa: E402
from ..core.line import wrote  # noqa: E402
from .saving import DPI, write  # noqa: E402
from .units import plain  # noqa: E402

STYLE = {
    "font.size": 10, "axes.grid": True, "grid.color": "0.92", "axes.axisbelow": True,
    "axes.spines.top": False, "axes.spines.right": False, "axes.titlesize": 11,
    "legend.frameon": False, "legend.fontsize": 8.5, "legend.title_fontsize": 9,
    "savefig.dpi": DPI, "mathtext.fontset": "dejavusans",
}  # fmt: skip
COLORS = ("#0072b2", "#d55e00", "#009e73", "#e69f00", "#cc79a7", "#5a5a5a")  # of Okabe and Ito: for all eyes
PANELS = 64  # maximum panels of a picture, one below the other or side by side
MARKED = 80  # points of a curve up to which each is marked; more would form a band
TURNS = 20  # of the abscissa, of ten cycles; with more a curve over it is drawn as points
BINS = 1500  # parts of an axis of time, more than a panel has pixels: of each the extremes are drawn
DAMAGE = "YlOrRd"  # colours of what is zero over most of a picture: light there, as paper is
CLOSED = {"color": "0.35", "linewidth": 1.2}  # the line of a closed-form solution


def drawn(*kinds, style=None):
    """Makes a function that draws a figure draw it in the house's style, and more of it if given; pyplot, which would
    show it twice in a notebook, forgets the figure. With kinds it draws nothing else than objects of these classes, the
    first of the first one, and further ones of the last."""

    def of(draw):
        @functools.wraps(draw)
        def drawing(*given, **options):
            for one, kind in zip(given, [*kinds, *kinds[-1:] * len(given)]):
                need_kind(draw.__name__, [one], kind.__name__, lambda one, kind=kind: isinstance(one, kind))
            with plt.rc_context({**STYLE, **(style or {})}):
                figure = draw(*given, **options)
            plt.close(figure)
            return figure

        return drawing

    return of


def need_kind(name, given, kind, fits):
    """Raises Error unless what a picture of this name is given is of the kind that it draws."""
    for one in given:
        if isinstance(one, (str, os.PathLike)):
            raise Error(f"{name}: {one}: expected {kind}, not a file's name: open it first")
        if not fits(one):
            raise Error(f"{name}: expected {kind}, not {type(one).__name__}")


def colors(count=6):
    """Returns so many colours, by default all of COLORS; of a continuous sequence if there are more."""
    return COLORS[:count] if count <= len(COLORS) else [plt.cm.viridis(t) for t in np.linspace(0.0, 0.9, count)]


def tint(index, count):
    """Colour of the index-th of count load levels; index may lie between two."""
    return plt.get_cmap("plasma")(0.88 * index / max(1, count - 1))


def points(axes, x, y, color, mark="o", **style):
    """White points with a coloured edge above all lines, as computed values are drawn; "o-": joined by a line."""
    style = {"markersize": 3.6, "markerfacecolor": "white", "zorder": 3, **style}
    axes.plot(x, y, mark, color=color, **style)


def joined(axes, x, y, color, mark, **style):
    """The larger points of a quantity that depends on a few parameters, joined by a thin line."""
    points(axes, x, y, color, mark, **{"markersize": 5, "linewidth": 1.0, "zorder": 2, **style})


def cross(axes, x, y, gid=None):
    """A black cross with a white edge at a point, whole on the edge of a panel too."""
    axes.plot(x, y, "+", color="white", markersize=11, markeredgewidth=2.6, clip_on=False, zorder=5, gid=gid)
    axes.plot(x, y, "+", color="black", markersize=9, markeredgewidth=1.2, clip_on=False, zorder=6)


def need_few(count, what):
    """Raises Error if a picture would have too many panels."""
    if count > PANELS:
        raise Error(f"{count} {what} in one picture; expected at most {PANELS}")


def curve(count, **style):
    """Style of a curve of so many points: points joined by a line when they are few, else a line, the thinner the more
    there are."""
    if count <= MARKED:
        return {"marker": ".", "linestyle": "-", "linewidth": 1.1, "markersize": 4.0, **style}
    return {"marker": "", "linestyle": "-", "linewidth": 1.1 if count <= 600 else 0.6, **style}


def scattered(x, **style):
    """The same of a curve over any quantity x: points without lines when there are more than MARKED and x turns back
    more than TURNS times, where the lines would be a solid block. A loop that is passed a few times keeps them.
    """
    moves = np.sign(np.diff(x[np.isfinite(x)]))
    moves = moves[moves != 0.0]
    if x.size <= MARKED or np.count_nonzero(np.diff(moves)) <= TURNS:
        return curve(x.size, **style)
    size = float(np.clip(90.0 / np.sqrt(x.size), 1.2, 3.0))
    return {"marker": ".", "linestyle": "none", "markersize": size, "markeredgewidth": 0.0, **style}


BARS = dict(fmt="none", elinewidth=1.2, alpha=0.5)  # errorbar() draws nothing but the bars


def outlined(x, y):
    """The points of a curve over x, or when they are many and x rises, the first, the last and the extremes of each of
    BINS parts: it looks the same."""
    if x.size <= 4 * BINS or not np.all(np.diff(x) >= 0.0):
        return x, y
    edges = np.unique(np.linspace(0, x.size, BINS + 1).astype(int))
    kept = {0, x.size - 1}
    for low, high in zip(edges[:-1], edges[1:]):
        part = np.where(np.isfinite(y[low:high]), y[low:high], 0.0)
        kept.update((low, high - 1, low + int(np.argmin(part)), low + int(np.argmax(part))))
    kept = sorted(kept)
    return x[kept], y[kept]


def ticks(count, most, least=2):
    """Places of about so many numbers on an axis, at least and at most so many."""
    return MaxNLocator(int(np.clip(count, least, most)), steps=[1, 2, 2.5, 5, 10])


def bar(panel, image, text, height=2.4, **more):
    """A colour bar beside a map and as tall as it; height, in inches, is room for so many numbers."""
    beside = panel.inset_axes([1.0, 0.0, 1.0, 1.0], transform=panel.transAxes)
    beside.set_axes_locator(_Beside(panel))
    drawn = panel.figure.colorbar(image, cax=beside, label=text, **more)
    if "ticks" not in more and image.norm.__class__.__name__ == "Normalize":
        drawn.locator = ticks(height / 0.3, 7, 3)
        drawn.update_ticks()
    drawn.outline.set_linewidth(0.6)
    return drawn


class _Beside:
    """Place of a colour bar: some points right of a map, of a fixed width, whatever the map's size."""

    GAP, WIDTH = 0.08, 0.12  # inches

    def __init__(self, panel):
        self.panel = panel

    def __call__(self, _axes, _renderer):
        figure = self.panel.figure
        inches = figure.get_size_inches()[0] / getattr(figure, "scaled", 1.0)
        box = self.panel.get_position()
        return type(box).from_bounds(box.x1 + self.GAP / inches, box.y0, self.WIDTH / inches, box.height)


def frame(axes, title, x, y, x_limits=None, y_limits=None):
    """Title, labels and limits of a panel; without limits these follow the data."""
    limits = {"xlim": x_limits, "ylim": y_limits}
    axes.set(title=title, xlabel=x, ylabel=y, **{name: pair for name, pair in limits.items() if pair})


def field(axes, values, edges, low=0.0, high=None, color_map="viridis", norm=None):
    """A map of values (ny, nx), the first row below; edges as of extent(); colours from low to high, or by a norm."""
    style = {"origin": "lower", "interpolation": "nearest", "extent": edges, "cmap": color_map}
    axes.grid(False)
    limits = {"norm": norm} if norm is not None else {"vmin": low, "vmax": high}
    return axes.imshow(values, **limits, **style)


class _Plain(LogFormatterMathtext):
    """Numbers of a logarithmic axis as they are written elsewhere: 30, not 3 times 10 to the first; of those between
    the decades no more than there is room for."""

    GLYPH, LINE = 0.1, 0.2  # inches of a digit and of a line of text
    # decades on the axis at most, and the first digits that are written
    ROOM = ((0.2, range(1, 10)), (0.45, (1, 2, 3, 4, 5, 6, 8)), (0.9, (1, 2, 3, 5)), (2.2, (1, 2, 5)))

    def __call__(self, x, pos=None):
        if not x > 0.0:
            return ""
        low, high = sorted(self.axis.get_view_interval())
        decades = np.log10(high / low) if low > 0.0 else np.inf
        first = x / 10.0 ** np.floor(np.log10(x) + 1e-9)
        digits = next((digits for most, digits in self.ROOM if decades <= most), (1,))
        if abs(first - round(first)) < 1e-6 and round(first) not in digits:
            return ""
        if 1e-3 <= abs(x) < 1e5:
            return f"{x:g}"
        power = f"10^{{{int(np.floor(np.log10(x) + 1e-9))}}}"
        return f"$\\mathdefault{{{power}}}$" if abs(first - 1.0) < 1e-6 else f"${first:g}\\cdot{power}$"

    def format_ticks(self, values):
        """The numbers, without those that would lie on the decades' or on one before."""
        decades = [] if self is self.axis.get_major_formatter() else list(self.axis.get_majorticklocs())
        low, high = sorted(self.axis.get_view_interval())
        name, box, taken = self.axis.axis_name, self.axis.axes.get_window_extent(), []
        inches = (box.width if name == "x" else box.height) / self.axis.figure.dpi
        inches /= getattr(self.axis.figure, "scaled", 1.0)  # the texts are as much smaller
        labels = []
        for x in [*decades, *values]:
            text = self(x) if low <= x <= high else ""
            count = len(re.sub(r"\\[a-z]+|[${}^]", "", text)) + text.count("cdot")
            half = 0.5 * (self.GLYPH * count if name == "x" else self.LINE)
            at = inches * np.log(x / low) / np.log(high / low) if text and low > 0.0 else 0.0
            free = all(abs(at - other) > half + reach for other, reach in taken)
            labels.append(text if free else "")
            taken += [(at, half)] if text and free else []
        return labels[len(decades) :]


def logarithmic(panel, axes):
    """Logarithmic axes x, y or both."""
    for name in axes:
        panel.set(**{f"{name}scale": "log"})
        axis = getattr(panel, name + "axis")
        axis.set_major_formatter(_Plain())
        axis.set_minor_formatter(_Plain())
        long, short = (matplotlib.rcParams[f"{name}tick.{size}.size"] for size in ("major", "minor"))
        pad = matplotlib.rcParams[f"{name}tick.major.pad"]
        axis.set_tick_params(which="minor", pad=pad + long - short)  # all numbers as far from the axis


def over_cycles(panel, cycles):
    """An axis of numbers of cycles, arrays: logarithmic, with 0 at its left, when they span two decades."""
    first, last = (
        pick([pick(one[one > 0.0], initial=start) for one in cycles])
        for pick, start in ((np.min, np.inf), (np.max, 0.0))
    )
    panel.set_xlabel("cycles")
    if last >= 100.0 * first:
        decades = range(int(np.round(np.log10(first))), int(np.floor(np.log10(last))) + 1)
        panel.set_xscale("symlog", linthresh=10.0 ** decades[0], linscale=1.0)
        panel.set_xlim(-0.08 * 10.0 ** decades[0], 1.25 * last)  # with room for whole marks
        panel.minorticks_off()
        panel.set_xticks([0.0, *(10.0**n for n in decades)], ["0", *(f"$10^{{{n}}}$" for n in decades)])


def log_ticks(axes, values):
    """Two logarithmic scales, with these values alone at x."""
    axes.set(xscale="log", yscale="log")
    axes.set_xticks(values, [f"{value:g}" for value in values])
    axes.minorticks_off()


def thinned(cells, count):
    """About count of the cells (numbers in a row), every m-th.

    m is odd, so that the choice can be symmetric about the middle whether the number of cells is odd or even.
    """
    step = max(1, cells.size // count) | 1
    rest = (cells.size - 1) % step
    return cells[(rest + step * (rest % 2)) // 2 :: step]


def extent(x, y, unit=1.0, stride=1):
    """Edges, over a unit, of what imshow draws of the cells with centres x and y when it gets every stride-th."""
    half_x, half_y = (0.5 * stride * (axis[1] - axis[0]) for axis in (x, y))
    x, y = x[::stride], y[::stride]
    return [edge / unit for edge in (x[0] - half_x, x[-1] + half_x, y[0] - half_y, y[-1] + half_y)]


def note(figure, text, size=9):
    """A grey line above a figure."""
    figure.suptitle(text, fontsize=size, color="0.35")


def named(files):
    """True where a picture has to name its files: there are several, or the one has a label of the user's."""
    return len(files) > 1 or files[0].label != os.path.splitext(os.path.basename(files[0].path))[0]


def heading(files, one, index):
    """Returns the name of a step above a panel: the name of its file if there are several, and its time. It is empty
    for the last step of a single file, which is drawn unless another is asked for."""
    if named(list(dict.fromkeys(files))):
        return plain(one.title(index))
    return "" if len(files) == 1 and one.is_last(index) else plain(one.when(index))


def reach(values, along, part=0.1, margin=0.2):
    """First and last place along the last axis of values where they exceed a part of their maximum, with a margin."""
    large = along[np.any(values > part * np.max(values), axis=tuple(range(values.ndim - 1)))]
    room = margin * (large[-1] - large[0])
    return max(along[0], large[0] - room), min(along[-1], large[-1] + room)


def save(figure, directory, name):
    """Write one PNG of 256 colours and close the figure."""
    path = os.path.join(directory, name)
    write(figure, path)
    reduce(path)
    wrote(path)


def fewer(image):
    """An image of 256 colours, with which a PNG has a third of its size."""
    # the method of the least maximum error: others give thin bands of a colour map the colours of another one
    method = {"method": Image.Quantize.MAXCOVERAGE, "kmeans": 2, "dither": Image.Dither.NONE}
    return image.convert("RGB").quantize(256, **method)


def reduce(path):
    """Leave a PNG 256 colours."""
    with Image.open(path) as image:
        few = fewer(image)
    few.save(path, optimize=True, dpi=[DPI] * 2)

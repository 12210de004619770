"""Maps of fields over the surface, of results.Results.

A saved step is given as a pair (Results, index into its saved fields), and read no further than is drawn. Maps of
grids that are twice as wide as high are drawn below each other, others side by side, more than four in two rows.
"""

import textwrap

import numpy as np
from matplotlib.colors import ListedColormap, Normalize

from ..core.errors import Error
from ..results.fields import DEPTHS, EDGES, OPEN, SLIP, STICK
from . import colours, noise, outlines, symbols
from .style import bar, extent, field, heading, need_few, plt, ticks
from .units import label, largest, scale

USUAL = (
    "pressure",
    "shear",
    "slip",
    "power_density",
    "state",
)  # drawn unless fields are named, as far as the file has them
VELOCITY = ("slip_velocity_x", "slip_velocity_y")  # arrows on the state
ARROWS = 18  # along the longer side of a map at most
LONGEST = 0.9  # length of the longest arrow over the distance between two
OF_CONTACT = ("slip", "slip_x", "slip_y", "slip_velocity", *VELOCITY)  # exist in the contact only
TRACTIONS = ("pressure", "shear", "power_density")  # beginnings of names of what is zero without contact
STATES = {OPEN: ("open", "#f4f4f4"), STICK: ("stick", "#3b4cc0"), SLIP: ("slip", "#e9a03b")}
PIXELS = 1200  # of a map in each direction: more cells than the eye and the paper hold
WIDE = 2.0  # width over height from which maps stand below each other
FLAT = 12.0  # width over height of a map at most: what is longer is stretched, and says so
ABREAST = 4  # maps of a snapshot side by side at most; more are drawn in two rows
SIDE, LONG = 2.4, 7.0  # inches of a map: its height side by side, its width one below the other
ONE = 5.0  # inches of the longer side of a map that is alone
NARROW = 1.7  # inches of a map's width below which the numbers of x stand upright


def usual(results):
    """Names of the fields that a map shows of a file by itself."""
    computed = (*results.vectors, *results.products)
    names = [name for name in USUAL if results.has([name]) or name in computed]
    return names or [name for name in results.fields if name not in DEPTHS][:8]


def _read(results, index, names, whole):
    """Fields of one snapshot on the window of its contact, or on that given, (rows, columns), no more cells than the
    picture has pixels."""
    every = (slice(0, results.y.size), slice(0, results.x.size))
    rows, columns = whole if isinstance(whole, tuple) else every if whole else results.contact_window(index)
    stride = max(1, -(-max(rows.stop - rows.start, columns.stop - columns.start) // PIXELS))
    part = {"rows": rows, "columns": columns, "stride": stride}
    data = {name: results.quantity(name, index, **part) for name in names}
    masked = [name for name in names if name in OF_CONTACT or name.startswith(TRACTIONS)]
    if masked and "state" in results.fields:
        is_open = results.field("state", index, **part) == OPEN
        for name in masked:
            if name in OF_CONTACT:
                data[name] = np.where(is_open, np.nan, data[name])
            else:  # adhesion pulls where the surfaces do not touch, too; tables have the zeros
                data[name] = np.ma.masked_where(is_open & (data[name] == 0.0), data[name])
    edges = extent(results.x[columns], results.y[rows], stride=stride)
    if "state" in names and results.has(VELOCITY):
        data["arrows"] = _arrows(results, index, **part)
    cell = float(results.x[1] - results.x[0])
    lines = {name: outlines.lines(results.edge(name, index), cell) for name in results.edges}
    return {**data, "extent": edges, "edges": lines}


def _arrows(results, index, rows, columns, stride):
    """Places and slip velocities of some of the cells that slip, in steady rolling: x, y (m), v_x, v_y; and how far
    the places are apart (m)."""
    state, *velocity = (results.field(name, index, rows, columns, stride) for name in ("state", *VELOCITY))
    every = -(-max(state.shape) // ARROWS)
    some = slice(every // 2, None, every)
    slips = state[some, some] == SLIP
    x, y = np.meshgrid(results.x[columns][::stride][some], results.y[rows][::stride][some])
    apart = every * stride * float(min(results.x[1] - results.x[0], results.y[1] - results.y[0]))
    return [*(values[slips] for values in (x, y, *(one[some, some] for one in velocity))), apart]


def _gather(snapshots, names, whole):
    """The data of all snapshots, and the names of the fields that are drawn: those of bodies that have worn, too."""
    if names:
        for results, _ in snapshots:
            for name in names:
                if name in EDGES:
                    raise Error(f"{results.path}: --field {name}: is an edge, which maps show by themselves")
                results.need_quantity(name, "--field")
        return [_read(*one, names, whole) for one in snapshots], list(names)
    wanted = {results: usual(results) for results, _ in snapshots}
    if not any(wanted.values()):
        results = snapshots[0][0]
        results.need_quantity("pressure")
    data = [_read(*one, [*wanted[one[0]], *one[0].depths], whole) for one in snapshots]
    worn = [name for name in DEPTHS if largest(one[name] for one in data if name in one) > 0.0]
    shown = list(dict.fromkeys([*(name for fields in wanted.values() for name in fields), *worn]))
    tops = {name: largest(one[name] for one in data if name in one) for name in shown}
    something = [name for name in shown if not noise.is_nothing(name, tops, list(wanted))]
    return data, something or shown


class Layout:
    """Where the maps go, and how large they are: the extent of each snapshot (data), the number of fields, and the
    height of maps that stand side by side (inches)."""

    def __init__(self, data, fields, side=SIDE):
        sizes = np.array([[one["extent"][1] - one["extent"][0], one["extent"][3] - one["extent"][2]] for one in data])
        width, height = sizes.max(axis=0)
        self.ratio = width / height
        self.stacked = self.ratio >= WIDE
        self.stretch = self.ratio / min(max(self.ratio, 1.0 / FLAT), FLAT)  # of y over x as it is drawn
        shown = self.ratio / self.stretch
        alone = fields == 1 and len(data) == 1
        if self.stacked:
            self.abreast = 1
            self.rows, self.columns = len(data) * fields, 1
            self.width = LONG
            self.height = LONG / shown
        else:
            self.abreast = fields if fields <= ABREAST else -(-fields // 2)
            self.rows, self.columns = len(data) * -(-fields // self.abreast), self.abreast
            side = ONE if alone else side
            self.height = side / min(1.0, shown) if not alone else side / max(1.0, shown)
            self.height = min(self.height, 6.0)
            self.width = self.height * shown
        # a map that is alone is as high as its figure lets it be, and has numbers and labels at both sides
        self.pitch = (
            self.width + (2.1 if alone and not self.stacked else 1.5),
            self.height + (0.85 if self.stacked else 0.95),
        )

    @property
    def size(self):
        """Width and height of the figure, inches."""
        return self.columns * self.pitch[0] + 0.2, self.rows * self.pitch[1] + 0.2

    def wrapped(self, text):
        """A text in lines that a map has room for."""
        return "\n".join(textwrap.wrap(text, max(12, int(11 * self.pitch[0])), break_long_words=False))

    def number(self, panel):
        """Sets the numbers on the axes of a map, as many as fit; and its shape."""
        panel.set_aspect(self.stretch)
        panel.xaxis.set_major_locator(ticks(self.width / 0.55, 9))
        panel.yaxis.set_major_locator(ticks(self.height / 0.35, 6))
        if self.width < NARROW:
            panel.tick_params(axis="x", labelrotation=90)
        panel.tick_params(labelsize=8 if min(self.width, self.height) < 1.5 else 10)

    @property
    def remark(self):
        """Returns the note on a stretched map."""
        if np.isclose(self.stretch, 1.0):
            return ""
        axis, times = ("y", self.stretch) if self.stretch > 1.0 else ("x", 1.0 / self.stretch)
        return f" (${axis}$ is stretched {times:.3g} times)"

    def place(self, snapshot, column, fields):
        """Row and column of the panel of a snapshot's field."""
        row, column = divmod(column, self.abreast)
        return snapshot * -(-fields // self.abreast) + row, column

    def is_left(self, column):
        """Returns true if the map of a field begins a row."""
        return column % self.abreast == 0


def _colours_of_state(results, name, values):
    """Colours, places and words of a field of flags, such as the state."""
    words = results.flags(name)
    count = max([*words, int(np.max(values, initial=0))]) + 1
    tints = [STATES[k][1] if k in STATES else plt.get_cmap("tab10")(k % 10) for k in range(count)]
    texts = [words.get(k, str(k)) for k in range(count)]
    return ListedColormap(tints), (-0.5, count - 0.5), texts


def _draw(panel, one, name, shown, layout, length):
    """One map and its colour bar; shown is Colours, or (colour map, limits, words) of flags."""
    edges = [length * value for value in one["extent"]]
    if isinstance(shown, colours.Colours):
        # a product of masked numbers would lose those under the mask, which tables have
        values = np.ma.array(shown.factor * np.ma.getdata(one[name]), mask=np.ma.getmask(one[name]))
        image = field(panel, values, edges, color_map=shown.color_map, norm=shown.norm)
        image.cmap = image.cmap.with_extremes(bad=STATES[OPEN][1], under=image.cmap(0.0))
        drawn = bar(panel, image, shown.text(one["symbols"][name]), layout.height, extend=shown.extend)
        drawn.ax.yaxis.label.set_fontsize(8 if layout.height < 1.2 else 9)
        if type(shown.norm) is not Normalize:
            places = colours.log_ticks(shown.norm, np.clip(layout.height / 0.3, 3, 9))
            drawn.set_ticks(places, labels=[f"{value:g}" for value in places])
            drawn.ax.minorticks_off()
    else:
        tints, limits, words = shown
        image = field(panel, one[name], edges, *limits, tints)
        drawn = bar(panel, image, "", layout.height, ticks=range(len(words)))
        drawn.set_ticks(range(len(words)), labels=words)
    drawn.ax.tick_params(labelsize=8)
    if name == "state" and "arrows" in one:
        _draw_arrows(panel, length, *one["arrows"])
    for edge, lines in one["edges"].items():
        outlines.draw(panel, edge, lines, length)
    panel.set(xlim=edges[:2], ylim=edges[2:])
    layout.number(panel)


def _draw_arrows(panel, length, x, y, v_x, v_y, apart):
    """Arrows of the slip velocity, the longest from one place to the next, and what this length stands for."""
    longest = float(np.max(np.hypot(v_x, v_y), initial=0.0))
    if longest > 0.0:
        look = {"color": "black", "width": 0.1 * LONGEST * apart * length, "headwidth": 4.0, "units": "xy"}
        scaled = {"angles": "xy", "scale_units": "xy", "scale": longest / (LONGEST * apart * length)}
        panel.quiver(length * x, length * y, v_x, v_y, pivot="mid", **scaled, **look)
        panel.remark = f"longest arrow: slip velocity of {longest:.2g} $V$"


def _titles(panel, layout, title, heading):
    """The field's title above a map, and above that of the first field what the snapshot is."""
    wrapped = layout.wrapped(title)
    if layout.stacked:
        panel.set_title(title, loc="left", fontsize=10)
        panel.set_title(heading, loc="right", fontsize=8.5, color="0.35")
        return
    panel.set_title(wrapped, fontsize=10.5)
    if heading:
        above = (22.0 + 13.0 * wrapped.count("\n")) / 72.0 / layout.height
        panel.set_title(heading, loc="left", y=1.0 + above, fontsize=8.5, color="0.35")


def maps(snapshots, whole=False, names=None, choice=None):
    """Fields of every snapshot, one scale a field: those named, or pressure, |q|, |s|, state and removed depths."""
    if choice and choice.limits and len(names or ()) != 1:
        raise Error("--limits: expected one field, by --field")
    for results, _ in snapshots:
        if results.is_plane:
            raise Error(f"{results.path}: --maps: is a plane problem, one row of cells: use --profiles")
    data, names = _gather(snapshots, names, whole)
    layout = Layout(data, len(names))
    need_few(layout.rows, "steps and files")
    length, unit = scale("m", *(np.array(one["extent"]) for one in data))
    figure, axes = plt.subplots(layout.rows, layout.columns, figsize=layout.size, squeeze=False, layout="constrained")
    for column, name in enumerate(names):
        having = [(one, results) for one, (results, _) in zip(data, snapshots) if name in one]
        title, symbol, base = symbols.field(having[0][1], name)
        if having[0][1].flags(name):
            shown = _colours_of_state(having[0][1], name, np.concatenate([one[name].ravel() for one, _ in having]))
        else:
            shown = colours.choose(name, [one[name] for one, _ in having], base, choice)
        for row, (one, (results, index)) in enumerate(zip(data, snapshots)):
            panel = axes[layout.place(row, column, len(names))]
            if name not in one:  # a file without wear
                panel.set_axis_off()
                continue
            one.setdefault("symbols", {})[name] = symbol
            _draw(panel, one, name, shown, layout, length)
            _titles(
                panel,
                layout,
                title,
                heading([one for one, _ in snapshots], results, index) + layout.remark if column == 0 else "",
            )
            remark = layout.wrapped(getattr(shown, "remark", getattr(panel, "remark", "")))
            panel.set(xlabel="\n".join(part for part in (label("$x$", unit), remark) if part))
            panel.set(ylabel=label("$y$", unit) if layout.is_left(column) else "")
    for panel in axes.flat:
        if not panel.images:  # behind the last field
            panel.set_axis_off()
    return figure

"""Maps from files: NumPy, text, HDF5, and the formats of the library SurfaceTopography.

The command line gives all that is not in the file.
"""

import os
import sys
from typing import NamedTuple

import numpy as np

from ..core.errors import Error, short
from ..core.files import decoded, need_regular
from ..core.hdf5 import DAMAGED, opened
from ..core.lengths import KNOWN, UNITS, metres, shown
from . import headers
from .doubts import need_map, of_cells
from .maps import QUANTITIES, SAME, new_map, turned
from .tables import empty_line, header_lines, read_table

FORMATS = ("npy", "table", "hdf5", "surfacetopography")
ENDINGS = {".npy": "npy", ".csv": "table", ".txt": "table", ".h5": "hdf5", ".hdf5": "hdf5"}
LIBRARY = "SurfaceTopography"
EVEN = 1e-3  # maximum relative difference of the distances of cells
THEIRS = {"A": "angstrom"}  # SurfaceTopography's names that are not ours


class Stated(NamedTuple):
    """Statements of a file about its values (all lengths in m); None where it makes none."""

    values: np.ndarray  # (rows, columns)
    unit: float = None
    size: tuple = None
    center: tuple = None
    quantity: str = None
    top: bool = None  # whether the first row has the largest y
    remarks: tuple = ()
    doubts: tuple = ()  # texts of warnings
    sides: tuple = (None, None)  # size along x, y of a file that may state only one of them
    lines: dict = {}  # of the statements unit, x and y in a text
    name: str = ""  # of the dataset
    spans: tuple = None  # size along x, y in a unit that the file does not state


# ---------------------------------------------------------------- kinds of file


def _read_npy(path, _):
    try:
        values = np.load(path, allow_pickle=False)
    except OSError:
        raise
    except Exception as error:  # the header is read as Python, so a damaged one raises anything
        raise Error(f"{path}: is not an array of NumPy: {short(error)}") from error
    if not isinstance(values, np.ndarray) or values.dtype.kind not in "iuf":
        raise Error(f"{path}: contains no array of real numbers")
    if values.ndim != 2:
        raise Error(f"{path}: has shape {values.shape}: a map has two dimensions, (ny, nx)")
    need_map(path, values, text=False)
    return Stated(values)


def _unread(header):
    """Warnings of the lines of a header that no rule understands."""
    return tuple(
        f"line {number}: {short(line)}: is not understood: make sure that it agrees with the options"
        for number, line in header.unread
    )


def _need_mentioned(path, header, options):
    """Error where the units in a header's brackets do not contain that of the option."""
    if header.unit is None and header.mentioned and options.units:
        if not any(np.isclose(metres(name), options.units, rtol=SAME, atol=0.0) for name in header.mentioned):
            raise Error(
                f"{path}: its header has {', '.join(header.mentioned)}, which contradicts --units: give the file's unit"
            )


def _read_table(path, options):
    values, left_out, first = read_table(path, options.decimal, options.skip_rows, options.skip_columns)
    header = headers.stated(path, header_lines(path, options.decimal, options.skip_rows))
    need_map(f"{path}: line {first}", values, text=True)
    _need_mentioned(path, header, options)
    remarks = (f"{left_out} header line{'s' if left_out > 1 else ''} left out",) if left_out else ()
    x, y = headers.size_of(path, header, values.shape[::-1])
    size = (x, y) if x and y else None
    doubts, empty = _unread(header), empty_line(path, first)
    if empty:
        doubts += (f"line {empty} is empty: if it ends a map, leave out what follows it, or give each map a file",)
    return Stated(values, header.unit, size, None, None, header.top, remarks, doubts, (x, y), header.lines)


def _attribute(path, data, name):
    """A text attribute, or None."""
    value = data.attrs.get(name)
    value = decoded(value) if isinstance(value, bytes) else value
    if value is not None and not isinstance(value, str):
        raise Error(f"{path}: {data.name}: its attribute {name} is not a text")
    return value


def _unit(path, data, name):
    """Metres of the unit in the attribute; None without it."""
    text = _attribute(path, data, "units")
    if text is not None and metres(text) is None:
        raise Error(f"{path}: {name}: its attribute units is {short(text)!r}; use one of {KNOWN}")
    return None if text is None else metres(text)


def _size(path, data):
    """The attribute size along x, y in m, or None."""
    if "size" not in data.attrs:
        return None
    size = np.asarray(data.attrs["size"])
    if size.shape != (2,) or size.dtype.kind not in "iuf" or not np.all((size > 0) & np.isfinite(size)):
        raise Error(f"{path}: {data.name}: its attribute size is not two positive numbers: x, y in m")
    return tuple(map(float, size))


def _axis(path, file, name, n, bare=False):
    """Width, centre, and whether it falls, of an axis beside the dataset; None if there is none, or without units.

    bare: take an axis without units for one in m.
    """
    if name not in file or getattr(file[name], "shape", None) != (n,) or n < 2:
        return None
    unit = _unit(path, file[name], name) or (1.0 if bare else None)
    if unit is None:
        return None
    if file[name].dtype.kind not in "iuf":
        raise Error(f"{path}: {name} is no axis of numbers")
    axis = file[name][:] * unit
    steps = np.diff(axis)
    if not np.all(np.abs(steps - steps.mean()) <= EVEN * abs(steps.mean())) or not steps.mean():
        raise Error(f"{path}: {name} is not even: a map has cells of one width")
    width, middle = abs(steps.mean()) * n, (axis[0] + axis[-1]) / 2
    return width, middle if abs(middle) > SAME * width else 0.0, steps.mean() < 0.0  # 0 but for rounding


def read_hdf5(path, dataset=None, bare=False):
    """The statements of an HDF5 file about a dataset; bare: axes without units are in m, as petsam takes lengths."""
    return _guarded(path, lambda: _of_hdf5(path, dataset, bare))


def _read_hdf5(path, options):
    stated = _of_hdf5(path, options.dataset)
    if stated.size is None:
        need_map(path, stated.values, text=False)
    return stated


def _of_hdf5(path, dataset, bare=False):
    import h5py

    with opened(path) as file:
        name = (dataset or ("separation" if bare and "separation" in file else "height")).strip("/")
        name = name if name in file or dataset else "separation"
        data = file.get(name)
        if data is None and not dataset:
            raise Error(f"{path}: no dataset height or separation; choose another by --dataset")
        if not isinstance(data, h5py.Dataset) or data.ndim != 2 or data.dtype.kind not in "iuf":
            raise Error(f"{path}: has no dataset /{name} of shape (ny, nx); choose another by --dataset")
        if "scale_factor" in data.attrs or "add_offset" in data.attrs:
            raise Error(
                f"{path}: /{name}: its attributes scale_factor or add_offset show that it is packed; unpack it first"
            )
        values = data[:]
        quantity = _attribute(path, data, "quantity")
        if quantity is not None and quantity not in QUANTITIES:
            known = ", ".join(QUANTITIES)
            raise Error(f"{path}: /{name}: its attribute quantity is {short(quantity)!r}; use one of {known}")
        unit, group, size = _unit(path, data, "/" + name), data.parent, _size(path, data)
        axes = [_axis(path, group, letter, n, bare) for letter, n in zip("xy", values.shape[::-1])]
    if None in axes:
        return Stated(values, unit, size, quantity=quantity, name=name)
    x, y = axes
    if x[2]:
        values = values[:, ::-1]
    if size and not np.allclose(size, (x[0], y[0]), rtol=EVEN, atol=0.0):
        raise Error(f"{path}: /{name}: its attribute size and the axes x and y contradict each other: remove one")
    return Stated(values, unit, (x[0], y[0]), (x[1], y[1]), quantity, y[2], name=name)


def _library(path):
    """The library for instruments' files."""
    try:
        import SurfaceTopography.IO as library
    except ImportError as error:
        raise Error(
            f"{path}: such a file is read by the library {LIBRARY}, which {sys.executable} has not ({error}): "
            f"{sys.executable} -m pip install {LIBRARY}"
        ) from error
    return library


def _channel(path, reader, wanted):
    """The channel of that number, from 0, or name; without one that of the heights, the first."""
    names = [channel.name for channel in reader.channels]
    if wanted is None:
        return reader.default_channel
    if wanted in names:
        return reader.channels[names.index(wanted)]
    if wanted.isdigit() and int(wanted) < len(names):
        return reader.channels[int(wanted)]
    stated = ", ".join(f"{k} {short(name)}" for k, name in enumerate(names))
    raise Error(f"{path}: --channel {short(wanted)}: use one of {stated}")


def _read_instrument(path, options):
    library = _library(path)
    try:
        with library.open_topography(path) as reader:
            kind = type(reader).__name__
            channel = _channel(path, reader, options.channel)
            if channel.dim != 2:
                raise Error(f"{path}: {short(channel.name)} is a line, not a map: use another file or --channel")
            sizes = channel.physical_sizes
            unknown = {} if sizes is not None else {"physical_sizes": tuple(map(float, channel.nb_grid_pts))}
            topography = channel.topography(**unknown)
            heights, text = topography.heights(), channel.unit
            names = [one.name for one in reader.channels]
    except Error:
        raise
    except Exception as error:  # of a library that raises whatever a reader meets
        reason = type(error).__name__
        if reason == "CannotDetectFileFormat":  # its text is that of each of its readers
            raise Error(
                f"{path}: has no format known to {LIBRARY}: write the heights as a text of one line per y, or as HDF5"
            ) from error
        raise Error(f"{path}: {LIBRARY} cannot read it: {error or reason}") from error
    heights = np.ma.filled(np.ma.asarray(heights, dtype=float), np.nan)
    unit = None if text is None else metres(THEIRS.get(text, text))
    if text is not None and unit is None:
        raise Error(
            f"{path}: {short(channel.name)} is in {short(text)}, not in one of {KNOWN}; choose another by --channel"
        )
    remarks = ()
    if len(names) > 1:
        remarks = (f"channel {short(channel.name)} of {', '.join(short(name) for name in names)}",)
    size = tuple(side * unit for side in sizes) if unit and sizes is not None else None
    top = False  # the library's first index is x, and its y goes up
    if kind == "AscReader":  # but those of a text are as in the file
        need_map(path, heights.T, text=True, library=True)
        top = headers.stated(path, header_lines(path)).top
    spans = None
    if kind == "XYZReader":
        _need_grid(path, heights, options)
        spans = sizes if unit is None else None
    return Stated(heights.T, unit, size, top=top, remarks=remarks, spans=spans)


def _need_grid(path, heights, options):
    """Error unless the heights are those of all points of a text, on a full regular grid."""
    values, *_ = read_table(path, options.decimal, options.skip_rows, options.skip_columns)
    points = values[:, :3] if values.shape[1] >= 3 else np.empty((0, 3))
    axes = [np.unique(points[:, d], return_inverse=True) for d in (0, 1)]
    grid = np.full([axis.size for axis, _ in axes], np.nan)
    grid[axes[0][1], axes[1][1]] = points[:, 2]
    if grid.shape != heights.shape or grid.size != len(points) or not _proportional(grid, heights):
        raise Error(
            f"{path}: its points x, y, z are not those of a full regular grid, each once: interpolate them, and save "
            "the heights as a map"
        )


def _proportional(one, other):
    """Whether two arrays are the same but for a unit."""
    scale = np.max(np.abs(one)) or 1.0
    return bool(np.allclose(one / scale, other / (np.max(np.abs(other)) or 1.0), rtol=0.0, atol=1e-6))


READERS = {"npy": _read_npy, "table": _read_table, "hdf5": _read_hdf5, "surfacetopography": _read_instrument}


# ---------------------------------------------------------------- files and options together


def _agreed(path, stated, given, option):
    """The value in the file or of the option; None without either, an Error if they contradict each other."""
    if stated is None or given is None:
        return given if stated is None else stated
    if not (stated == given if isinstance(stated, (str, bool)) else np.allclose(stated, given, rtol=SAME, atol=0.0)):
        raise Error(f"{path}: contradicts {option}: leave the option out")
    return stated


def _at(path, stated, name):
    """The path, with the line of a text in which a statement is."""
    return f"{path}: line {stated.lines[name]}" if name in stated.lines else path


def _need_sides(path, stated, given):
    """Error where a side of the given size contradicts that of the file."""
    for letter, side, one in zip("xy", stated.sides, given or (None, None)):
        if side and one and not np.isclose(side, one, rtol=SAME, atol=0.0):
            raise Error(
                f"{_at(path, stated, letter)}: is {shown(side)} along {letter}, which contradicts --size or --pixel: "
                "leave the option out, or correct it"
            )


def _need_spans(path, spans, given):
    """Error where a given size is no multiple, by a unit, of the size that points x, y span in a unit they lack."""
    if spans and given:
        units = [side / span for side, span in zip(given, spans)]
        if not any(np.allclose(units, one, rtol=EVEN, atol=0.0) for one in UNITS.values()):
            raise Error(
                "{}: its x and y span {:.6g} x {:.6g}, which contradicts --size or --pixel: give these numbers with "
                "their unit, as in --size {:.6g}um,{:.6g}um".format(path, *spans, *spans)
            )


def _need(path, kind, quantity, unit, size):
    """An Error that names all that is given neither in the file nor by an option."""
    lacking = [
        text
        for value, text in (
            (quantity, "whether it holds heights (--body 1 or --body 2) or a separation (--separation)"),
            (unit, "in which unit (--units um or another)"),
            (size, "how large the surface is (--size X[,Y] or --pixel DX[,DY])"),
        )
        if value is None
    ]
    if lacking:
        hint = "" if kind != "table" else f"; a header may, for {LIBRARY}: --format surfacetopography"
        raise Error(f"{path}: does not say {'; nor '.join(lacking)}: give the options{hint}")


def _kind(path, options):
    return options.format or ENDINGS.get(os.path.splitext(path)[1].lower(), "surfacetopography")


def _guarded(path, read):
    """What read() returns of a file; whatever a damaged one raises as an Error."""
    try:
        if need_regular(path).st_size == 0:
            raise Error(f"{path}: is empty")
        return read()
    except MemoryError as error:
        raise Error(f"{path}: is too large for the memory") from error
    except DAMAGED as error:
        raise Error(f"{path}: cannot be read: {getattr(error, 'strerror', None) or short(error)}") from error


def _stated(path, options):
    """The statements of the file."""
    stated = _guarded(path, lambda: READERS[_kind(path, options)](path, options))
    for option, given, said in (
        ("transpose", options.transpose, stated.size or stated.spans or max(stated.sides, key=bool)),
        ("depths", options.depths, stated.quantity),
    ):
        if given and said is not None:
            what = "which direction is x" if option == "transpose" else "what its values are"
            raise Error(f"{path}: already states {what}: leave out --{option}")
    return stated


def _top(path, stated, options):
    """Whether the first row has the largest y, and remarks to print."""
    if stated.top is None:
        turned_round = "" if options.first_row else "; --first-row top turns it round"
        place = "largest" if options.first_row == "top" else "smallest"
        return options.first_row == "top", [f"first row at the {place} y{turned_round}"]
    if options.first_row and (options.first_row == "top") != stated.top:
        raise Error(f"{path}: already states the direction of y: leave out --first-row")
    return stated.top, []


def read_map(path, options, quantity):
    """The map of a file, its first row at the smallest y, and remarks and doubts about the reading.

    quantity: of the options, or None. options: of the command line, see command.py.
    """
    stated = _stated(path, options)
    values = np.asarray(stated.values, dtype=np.float64)  # before it is scaled: single precision would stay so
    values = values.T if options.transpose else values
    quantity = _agreed(path, stated.quantity, quantity, "--body or --separation")
    alone = quantity is None and len(options.files) == 1 and _kind(path, options) == "surfacetopography"
    quantity = "height2" if alone else quantity  # instruments measure heights; which body's the remark says
    unit = _agreed(_at(path, stated, "unit"), stated.unit, options.units, "--units")
    given = options.size or options.pixel and tuple(w * n for w, n in zip(options.pixel, values.shape[::-1]))
    _need_sides(path, stated, given)
    _need_spans(path, stated.spans, given)
    size = _agreed(path, stated.size, given, "--size or --pixel")
    _need(path, _kind(path, options), quantity, unit, size)
    if options.missing is not None:
        values = np.where(values == options.missing, np.nan, values)
    one = new_map(values * (-unit if options.depths else unit), size, quantity, path, stated.center or (0.0, 0.0))
    top, remarks = _top(path, stated, options)
    if alone:
        remarks.append("taken for heights of body 2; --body 1 or --separation takes them for another")
    if quantity == "height1" and stated.quantity is None and not options.mirror:
        remarks.append(
            "x and y are petsam's, as seen from above; seen from its own side, body 1 is mirrored: --mirror x or y"
        )
    more = of_cells(one) if options.size and stated.size is None else []
    return turned(one, top, options.mirror or ""), [*stated.remarks, *remarks], [*stated.doubts, *more]

"""Files of instruments, by the library SurfaceTopography, which states unit and size of over thirty kinds."""

import warnings

import numpy as np

from ....core import units
from ....core.arrays import real
from ....core.errors import Error, library, short
from ....core.hdf5 import opened
from ....core.texttable import Text
from .. import headers
from .arrays import chosen
from .hdf import contents
from .points import Axis
from .stated import Reader, Stated

LIBRARY = "SurfaceTopography"
MATLAB = "MatReader"
ARRAYS = (MATLAB, "NPYReader", "H5Reader")  # formats of arrays, which say nothing of their indices
OF_VALID = b"X;Y;valid"  # header of profiles .hfm, whose third column the library leaves out
NUMBERS = {"double", "single", *(f"{sign}int{bits}" for sign in ("", "u") for bits in (8, 16, 32, 64))}  # of Matlab
THEIRS = {"A": "angstrom"}  # SurfaceTopography's names that are not ours


class Instrument(Reader):
    """A file of an instrument: the library states unit, size and which row is on top."""

    family = "surfacetopography"
    states = ("unit", "size", "first row", "missing points")

    def recognizes(self, source):
        """Any file, as the library has signs of its own."""
        return True

    def read(self, source):
        """The channel of the heights, or the one that is wanted."""
        return _read(source)


def _channel(path, reader, wanted):
    """The channel of that number, from 0, or name; without one that of the heights, the first."""
    names = [channel.name for channel in reader.channels]
    if wanted in names:
        return reader.channels[names.index(wanted)]
    if wanted is not None and wanted.isdigit() and int(wanted) < len(names):
        return reader.channels[int(wanted)]
    if type(reader).__name__ == MATLAB:
        return reader.channels[names.index(chosen(path, _inside(path), "--channel", wanted))]
    if wanted is None:
        return reader.default_channel
    stated = ", ".join(f"{k} {short(name)}" for k, name in enumerate(names))
    raise Error(f"{path}: --channel {short(wanted)}: use one of {stated}")


def _inside(path):
    """Shapes of the arrays in a file of Matlab by their names, as of arrays.chosen()."""
    from scipy.io import matlab

    try:
        return {name: shape if kind in NUMBERS else kind for name, shape, kind in matlab.whosmat(path)}
    except NotImplementedError:  # version 7.3, which is HDF5
        with opened(path) as file:
            shapes = contents(file)
        return {
            name: shape if isinstance(shape, str) else shape[::-1] for name, shape in shapes.items() if name[0] != "#"
        }


def _line(source, name, topography):
    """The heights of a line as a map of one column, in the library's order of indices, and its size."""
    heights = real(topography.heights())
    if source.start.startswith(OF_VALID):
        heights = np.where(source.text.table[0][:, 2] > 0.0, heights, np.nan)
    if topography.is_uniform:
        (size,) = topography.physical_sizes
        return heights[:: -1 if size < 0.0 else 1, None], (abs(size),)  # below 0 where positions fall
    axis = Axis.along(real(topography.positions()))
    if axis.n != heights.size:
        raise Error(
            f"{source.path}: {short(name)} is a profile x, z, which is read where x rises in even steps: interpolate it"
        )
    ordered = np.empty((axis.n, 1))
    ordered[axis.index, 0] = heights
    return ordered, (axis.n * axis.step,)


def _opened(source):
    """Reads with the library: kind of file, name of the channel, heights, size, unit, and names of all channels."""
    path, wanted = source.path, source.how.channel
    their = library(LIBRARY + ".IO", f"{path}: such a file")
    try:
        with their.open_topography(path) as reader, warnings.catch_warnings():
            warnings.simplefilter("error", np.exceptions.ComplexWarning)  # of numbers whose imaginary part is left out
            channel = _channel(path, reader, wanted)
            sizes = channel.physical_sizes
            unknown = (
                {} if sizes is not None else {"physical_sizes": tuple(map(float, np.atleast_1d(channel.nb_grid_pts)))}
            )
            topography = channel.topography(**unknown)
            if channel.dim == 2:
                heights = real(topography.heights())
            else:
                heights, spans = _line(source, channel.name, topography)
                sizes = None if unknown and topography.is_uniform else spans
            names = [one.name for one in reader.channels]
            return type(reader).__name__, channel.name, heights, sizes, channel.unit, names
    except Error:
        raise
    except Exception as error:  # of a library that raises whatever a reader meets
        reason = type(error).__name__
        cure = "write the heights as a text of one line per y, or as HDF5"
        if source.is_printable:
            cure = f"give --format table, which takes lines of numbers, or {cure}"
        if reason == "CannotDetectFileFormat":  # its text is that of each of its readers
            raise Error(f"{path}: has no format known to {LIBRARY}: {cure}") from error
        raise Error(f"{path}: {LIBRARY} cannot read it: {short(error) or reason}: {cure}") from error


def _read(source):
    path = source.path
    kind, name, heights, sizes, text, names = _opened(source)
    unit = None if text is None else units.size(THEIRS.get(text, text))
    if text is not None and unit is None:
        raise Error(
            f"{path}: {short(name)} is in {short(text)}, not in one of {units.names()}; choose another by --channel"
        )
    remarks = ()
    if len(names) > 1:
        remarks = (f"channel {short(name)} of {', '.join(short(one) for one in names)}",)
    size = tuple(side * unit for side in sizes) if unit and sizes is not None else None
    if kind in ARRAYS:  # their rows are y, as those of any array
        return Stated(heights, unit, size, remarks=remarks, layout="array" if sizes is None else "grid")
    top = False  # the library's first index is x, and its y goes up
    layout, spans = "array" if sizes is None else "grid", None
    if heights.shape[1] == 1:
        layout, spans = "grid", sizes if unit is None else None
    elif kind == "AscReader":  # but those of a text are as in the file
        layout, top = "library", headers.stated(path, Text(path).header).top
    elif kind == "XYZReader":
        _need_grid(source, heights)
        layout, spans = "grid", sizes if unit is None else None
    return Stated(heights.T, unit, size, top=top, remarks=remarks, spans=spans, layout=layout)


def _need_grid(source, heights):
    """Error unless the heights are those of all points of a text, on a full regular grid."""
    values, *_ = source.text.table
    points = values[:, :3] if values.shape[1] >= 3 else np.empty((0, 3))
    axes = [np.unique(points[:, d], return_inverse=True) for d in (0, 1)]
    grid = np.full([axis.size for axis, _ in axes], np.nan)
    grid[axes[0][1], axes[1][1]] = points[:, 2]
    if grid.shape != heights.shape or grid.size != len(points) or not _proportional(grid, heights):
        raise Error(
            f"{source.path}: its points x, y, z are not those of a full regular grid, each once: interpolate them, and "
            "save the heights as a map"
        )


def _proportional(one, other):
    """True if two arrays are the same but for a unit."""
    scale = np.max(np.abs(one)) or 1.0
    return bool(np.allclose(one / scale, other / (np.max(np.abs(other)) or 1.0), rtol=0.0, atol=1e-6))

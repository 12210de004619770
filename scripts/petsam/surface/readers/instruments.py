"""Files of instruments, by the library SurfaceTopography, which states unit and size of over thirty kinds."""

import numpy as np

from ...core import units
from ...core.arrays import real
from ...core.errors import Error, library, short
from .. import headers
from ..doubts import need_map
from ..tables import Text
from .stated import Reader, Stated

LIBRARY = "SurfaceTopography"
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
    if wanted is None:
        return reader.default_channel
    if wanted in names:
        return reader.channels[names.index(wanted)]
    if wanted.isdigit() and int(wanted) < len(names):
        return reader.channels[int(wanted)]
    stated = ", ".join(f"{k} {short(name)}" for k, name in enumerate(names))
    raise Error(f"{path}: --channel {short(wanted)}: use one of {stated}")


def _read(source):
    path, how = source.path, source.how
    their = library(LIBRARY + ".IO", f"{path}: such a file")
    try:
        with their.open_topography(path) as reader:
            kind = type(reader).__name__
            channel = _channel(path, reader, how.channel)
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
    heights = real(heights)
    unit = None if text is None else units.size(THEIRS.get(text, text))
    if text is not None and unit is None:
        raise Error(
            f"{path}: {short(channel.name)} is in {short(text)}, not in one of {units.names()}; choose another by "
            "--channel"
        )
    remarks = ()
    if len(names) > 1:
        remarks = (f"channel {short(channel.name)} of {', '.join(short(name) for name in names)}",)
    size = tuple(side * unit for side in sizes) if unit and sizes is not None else None
    top = False  # the library's first index is x, and its y goes up
    if kind == "AscReader":  # but those of a text are as in the file
        need_map(path, heights.T, text=True, library=True)
        top = headers.stated(path, Text(path).header).top
    spans = None
    if kind == "XYZReader":
        _need_grid(source, heights)
        spans = sizes if unit is None else None
    return Stated(heights.T, unit, size, top=top, remarks=remarks, spans=spans)


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
    """Whether two arrays are the same but for a unit."""
    scale = np.max(np.abs(one)) or 1.0
    return bool(np.allclose(one / scale, other / (np.max(np.abs(other)) or 1.0), rtol=0.0, atol=1e-6))

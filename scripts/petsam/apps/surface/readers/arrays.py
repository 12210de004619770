"""Arrays of NumPy, and the choice of one of the arrays in a file."""

import numpy as np

from ....core.errors import Error, short
from ..doubts import FEWEST
from .stated import ARRAYS, OTHERS, TEXTS, ZIP, Reader, Stated

REAL = "iuf"  # kinds of NumPy's real numbers
NONE = "no real numbers"
LISTED = 12  # arrays that a message names at most


class Npy(Reader):
    """.npy: an array (ny, nx), or (1, nx) of a profile, which states nothing; .npz: arrays with names."""

    family = "npy"

    def recognizes(self, source):
        """By its name, or by its first bytes under a name of a text or of other arrays."""
        if source.ending in (".npy", ".npz"):
            return not source.is_hdf5
        return source.ending in TEXTS + OTHERS + ARRAYS and source.is_numpy

    def read(self, source):
        """The array."""
        path = source.path
        try:
            values = np.load(path, allow_pickle=False)
            remarks = ()
            if source.start.startswith(ZIP):
                with values:
                    values, remarks = _member(path, values, source.how.dataset)
        except (OSError, Error):
            raise
        except Exception as error:  # the header is read as Python, so a damaged one raises anything
            raise Error(f"{path}: is not an array of NumPy: {short(error)}") from error
        if not isinstance(values, np.ndarray) or values.dtype.kind not in REAL:
            raise Error(f"{path}: contains no array of real numbers")
        if values.ndim != 2:
            raise Error(
                f"{path}: has shape {values.shape}: a map has two dimensions, (ny, nx), and a profile has (1, nx)"
            )
        return Stated(values, remarks=remarks)


def _member(path, file, wanted):
    """The array of an .npz that is wanted, or its only map, and what to print."""
    shapes = {}
    for name in file.files:
        try:
            one = file[name]
        except ValueError:  # of objects
            shapes[name] = NONE
            continue
        shapes[name] = one.shape if one.dtype.kind in REAL else NONE
    name = chosen(path, shapes, "--dataset", wanted)
    return file[name], told(name, shapes)


def chosen(path, shapes, option, wanted=None):
    """The name of the array that is wanted, or of the only map in a file, or of its only line where it has no map.

    shapes: of all arrays by their names; a text of what it is instead for one that has no real numbers.
    """
    if wanted is not None:
        if wanted not in shapes:
            raise Error(f"{path}: {option} {short(wanted)}: is not in it: {listed(shapes, option)}")
        return wanted
    flat = _flat(shapes)
    maps = [name for name, shape in flat.items() if min(shape) > 1]
    found = maps or list(flat)
    if len(found) != 1:
        what = f"{len(found)} {'maps' if maps else 'profiles'}" if found else "no map (ny, nx)"
        raise Error(f"{path}: contains {what}: {listed(shapes, option)}")
    return found[0]


def told(name, shapes):
    """Remarks about the array that was chosen of several."""
    return (f"{short(name)} of {', '.join(short(one) for one in shapes)}",) if len(shapes) > 1 else ()


def listed(shapes, option):
    """Lists the arrays of a file, and says how to choose one."""
    texts = [
        f"{short(name)} ({shape if isinstance(shape, str) else ' x '.join(map(str, shape)) or 'one number'})"
        for name, shape in list(shapes.items())[:LISTED]
    ]
    if not texts:
        return "it has no arrays: write the heights as one (ny, nx)"
    more = f" and {len(shapes) - LISTED} more" if len(shapes) > LISTED else ""
    cure = f"choose one by {option} NAME" if _flat(shapes) else "write the heights as an array (ny, nx), or (1, nx)"
    return f"it has {', '.join(texts)}{more}: {cure}"


def _flat(shapes):
    """The arrays with rows and columns that may be a map or a line."""
    found = {name: shape for name, shape in shapes.items() if not isinstance(shape, str) and len(shape) == 2}
    return {name: shape for name, shape in found.items() if min(shape) > 1 or min(shape) == 1 and max(shape) >= FEWEST}

"""Arrays of NumPy."""

import numpy as np

from ...core.errors import Error, short
from ..doubts import need_map
from .stated import NUMPY, OTHERS, TEXTS, Reader, Stated


class Npy(Reader):
    """.npy: an array (ny, nx), or (1, nx) of a profile, which states nothing."""

    family = "npy"

    def recognizes(self, source):
        """By its name, or by its first bytes under a name of a text."""
        return source.ending == ".npy" or source.ending in TEXTS + OTHERS and source.start.startswith(NUMPY)

    def read(self, source):
        """The array."""
        path = source.path
        try:
            values = np.load(path, allow_pickle=False)
        except OSError:
            raise
        except Exception as error:  # the header is read as Python, so a damaged one raises anything
            raise Error(f"{path}: is not an array of NumPy: {short(error)}") from error
        if not isinstance(values, np.ndarray) or values.dtype.kind not in "iuf":
            raise Error(f"{path}: contains no array of real numbers")
        if values.ndim != 2:
            raise Error(
                f"{path}: has shape {values.shape}: a map has two dimensions, (ny, nx), and a profile has (1, nx)"
            )
        need_map(path, values, text=False)
        return Stated(values)

"""Grids of geographic programs, which drawings of surfaces are saved as, too: Esri's and Surfer's ASCII grids."""

import numpy as np

from ....core.errors import Error, short
from ....core.files import text_of
from .stated import Reader, Stated

BLANK = 1.70141e38  # of Surfer's missing points; larger ones, too


def _numbers(path, words, count):
    """So many words as numbers."""
    try:
        values = np.array([float(word) for word in words])
    except ValueError as error:
        raise Error(f"{path}: has a word that is no number: {short(error)}: export it again") from error
    if values.size != count:
        raise Error(f"{path}: has {values.size} numbers, and its header has {count}: export it again")
    return values


class Esri(Reader):
    """Esri's grid: ncols, nrows, cellsize, NODATA_value; the first row is on top."""

    family = "table"
    states = ("size in a unit that it lacks", "first row", "missing points")

    def recognizes(self, source):
        """By its first word."""
        return source.is_text and source.start[:6].lower() == b"ncols "

    def read(self, source):
        """The header's words, and the numbers after it."""
        path = source.path
        lines = [line.split() for line in text_of(path).split("\n") if line.strip()]
        header = {line[0].lower(): line[1] for line in lines[:8] if len(line) == 2 and line[0][0].isalpha()}
        try:
            nx, ny, cell = (kind(header[name]) for kind, name in ((int, "ncols"), (int, "nrows"), (float, "cellsize")))
            missing = float(header["nodata_value"]) if "nodata_value" in header else None
        except (KeyError, ValueError) as error:
            raise Error(f"{path}: its header lacks a number: {short(error)}: export the grid again") from error
        if min(nx, ny) < 1 or not 0.0 < cell < np.inf:
            raise Error(f"{path}: its header has {nx} x {ny} cells of {cell:g}: export the grid again")
        words = [word for line in lines[len(header) :] for word in line]
        values = _numbers(path, words, nx * ny).reshape(ny, nx)
        return Stated(values, top=True, spans=(cell * nx, cell * ny), missing=missing, layout="grid")


class Surfer(Reader):
    """Surfer's grid: DSAA, numbers of points, limits of x, y and z, and the heights from the smallest y on."""

    family = "table"
    states = ("size in a unit that it lacks", "first row", "missing points")

    def recognizes(self, source):
        """By its first word."""
        return source.is_text and source.start[:4] == b"DSAA"

    def read(self, source):
        """The header's numbers, and those after it."""
        path = source.path
        words = text_of(path).split()[1:]
        nx, ny, x0, x1, y0, y1 = _numbers(path, words[:6], 6)
        if not (min(nx, ny) >= 2 and nx == int(nx) and ny == int(ny) and x1 > x0 and y1 > y0):
            raise Error(f"{path}: its header has {nx:g} x {ny:g} points over no width: export the grid again")
        values = _numbers(path, words[8:], int(nx * ny)).reshape(int(ny), int(nx))
        values[np.abs(values) >= BLANK * (1.0 - 1e-5)] = np.nan
        spans = (x1 - x0) * nx / (nx - 1), (y1 - y0) * ny / (ny - 1)
        return Stated(values, top=False, spans=spans, layout="grid")

"""A map of a surface: how it is turned and cut, and the numbers that describe it."""

from __future__ import annotations

import os
from dataclasses import dataclass, replace

import numpy as np

from ...core.errors import Error, counted, short
from ...core.tables import Column, Tabled
from ...core.units import shown
from . import filling, levels, resampling, spikes, writing
from .basics import QUANTITIES, SAME

SMALLEST = 2  # points in x and y: petsam's smallest grid
HIGHEST = 1e4  # values over the size, beyond which they are none of a surface


@dataclass(frozen=True)
class Map(Tabled):
    """A map of heights, or of the separation of two bodies, on cells; a profile, for plane strain, has one row.

    Attributes
    ----------
    values : ndarray
        Means over the cells, (ny, nx), m, NaN where one is missing; the first row has the smallest y.
    size, center : tuple
        Full width, and position of the middle, (x, y), m.
    quantity : str
        A key of QUANTITIES: height1, height2 or separation.
    name : str
        For messages.
    places : tuple or None
        Numbers of its rows and columns in the file, from 0, (rows, columns); None after resampling.
    remarks, doubts : tuple of str
        What was done to the map, and what may be wrong with its file.
    """

    values: np.ndarray
    size: tuple
    center: tuple
    quantity: str
    name: str
    places: tuple
    remarks: tuple = ()
    doubts: tuple = ()

    def __repr__(self):
        sides = " x ".join(shown(side) for side in self.size)
        return f"Map({short(self.name)}: {QUANTITIES[self.quantity]}, {self.n[0]} x {self.n[1]} cells, {sides})"

    @property
    def n(self) -> tuple:
        """Cells in x, y."""
        return self.values.shape[::-1]

    @property
    def is_profile(self) -> bool:
        """True if the map is one row, for plane strain."""
        return len(self.values) == 1

    @property
    def wide(self) -> float:
        """The larger side, m; of a profile that along x."""
        return self.size[0] if self.is_profile else max(self.size)

    @property
    def cell(self) -> tuple:
        """Width of a cell in x, y, m."""
        return tuple(size / n for size, n in zip(self.size, self.n))

    def axis(self, d: int) -> np.ndarray:
        """Centres of the cells along one direction.

        Parameters
        ----------
        d : int
            0 for x, 1 for y.

        Returns
        -------
        ndarray
            Coordinates, (nx,) or (ny,), m.
        """
        return self.center[d] + ((np.arange(self.n[d]) + 0.5) / self.n[d] - 0.5) * self.size[d]

    def separation(self) -> np.ndarray:
        """The values as a separation: a peak of either body reduces it.

        Returns
        -------
        ndarray
            Separation, (ny, nx), m.
        """
        return self.values if self.quantity == "separation" else -self.values

    def _done(self, one, remark):
        """The changed map with a remark more."""
        return replace(one, remarks=(*self.remarks, remark)) if remark else one

    def cut(self, x0: float, x1: float, y0: float = 0.0, y1: float = 0.0) -> Map:
        """The cells whose centres lie in a window.

        Parameters
        ----------
        x0, x1, y0, y1 : float
            Limits of the window, m; of a profile x0 and x1 alone.

        Returns
        -------
        Map

        Raises
        ------
        Error
            If the window contains fewer than 2 cells in a direction.
        """
        one = cut(self, (x0, x1, y0, y1))
        return self._done(one, "cut to {} x {} points".format(*one.n))

    def without_outliers(self, fill: str = "smooth") -> Map:
        """The map with spikes of a few points, far from their neighbours, replaced as missing points are.

        Parameters
        ----------
        fill : str
            How, as of fill(): "smooth" or "nearest".

        Returns
        -------
        Map
            The number of the spikes is in its remarks.
        """
        holes = np.isnan(self.values)
        found = spikes.found(self.values)
        if not np.any(found):
            return self._done(self, "no outliers found")
        one = filling.filled(replace(self, values=np.where(found, np.nan, self.values)), fill)[0]
        one = replace(one, values=np.where(holes, np.nan, one.values))
        count = counted(int(np.count_nonzero(found)), "outlier")
        far = self.values[found][np.argmax(np.abs(self.values[found] - np.nanmedian(self.values)))]
        return self._done(one, f"{count} replaced ({fill}), the farthest at {shown(float(far))}")

    def fill(self, how: str | None = "smooth") -> Map:
        """The map with its missing points replaced.

        Parameters
        ----------
        how : str or None
            "smooth" from their border, or "nearest"; None: there must be none.

        Returns
        -------
        Map

        Raises
        ------
        Error
            If all points are missing, or some for None.
        """
        one, count = filling.filled(self, how)
        return self._done(one, count and f"{counted(count, 'missing point')} filled ({how})")

    def level(self, kind: str = "tilt") -> Map:
        """The map without mean, tilt or form, or without offsets of rows or columns.

        Parameters
        ----------
        kind : str
            One of levels.KINDS: "none", "mean", "tilt", "second-order", "sphere", "cylinder", "rows" or "columns".

        Returns
        -------
        Map

        Raises
        ------
        Error
            If the map is too small for a sphere or cylinder, or none fits.
        """
        return self._done(*levels.levelled(self, kind))

    def resample(self, n: tuple[int, int] | None = None, size: tuple[float, float] | None = None) -> Map:
        """The map on other cells about its centre: means over the new cells.

        Parameters
        ----------
        n : tuple of ints, optional
            Cells in x, y; None: about as wide as they are.
        size : tuple of floats, optional
            Full width in x, y, m; None: all of the map.

        Returns
        -------
        Map

        Raises
        ------
        Error
            If the size is larger than that of the map.
        """
        one = resampling.resampled(self, n, size)
        return self._done(one, "from {} x {} points to {} x {} cells".format(*self.n, *one.n))

    def table(self) -> list[Column]:
        """Columns x, y and the values.

        Returns
        -------
        list of tables.Column
            A row for each cell.
        """
        x, y = np.meshgrid(self.axis(0), self.axis(1))
        texts = {"x": x, "y": y, writing.dataset(self): self.values}
        about = ("of the cell's centre", "of the cell's centre", QUANTITIES[self.quantity])
        return [Column(name, "m", text, part.ravel()) for (name, part), text in zip(texts.items(), about)]

    def write(self, path: str | os.PathLike, command: str = "") -> None:
        """Writes HDF5 for petsam's -gap_file and -gap_rough_file; replaces a file of that name when all is written.

        Parameters
        ----------
        path : str or path
            Name of the file.
        command : str
            Words that made the map, an attribute of the file.

        Raises
        ------
        Error
            If the file cannot be written.
        """
        writing.write(self, path, command)


def new_map(values, size, quantity, name, center=(0.0, 0.0)):
    """A map of values as they are in a file, whose first row has the smallest y."""
    rows, columns = values.shape
    if columns < SMALLEST:
        raise Error(f"{name}: has {rows} x {columns} points (rows x columns): a map has at least 2 x 2")
    values = np.array(values, dtype=np.float64)  # a copy: the array may be read-only, or in another order
    values[~np.isfinite(values)] = np.nan
    largest = np.max(np.abs(values), initial=0.0, where=~np.isnan(values))
    one = Map(values, tuple(size), tuple(center), quantity, name, tuple(np.arange(n) for n in values.shape))
    if largest > HIGHEST * one.wide:
        raise Error(
            f"{name}: has values up to {largest:.3g} m: give the value of missing points by --missing, "
            "in the file's unit"
        )
    return one


def turned(one, top, mirror):
    """The map with its first row at the largest y (top), and mirrored along x or y ("x", "y", "")."""
    rows = slice(None, None, -1 if top != (mirror == "y") else 1)
    columns = slice(None, None, -1 if mirror == "x" else 1)
    places = (one.places[0][rows], one.places[1][columns])
    return replace(one, values=one.values[rows, columns], places=places)


def cut(one, window):
    """The cells whose centres lie in a window X0, X1, Y0, Y1 (m)."""
    chosen = []
    for d, (first, last) in enumerate((window[:2], window[2:])):
        axis = one.axis(d)
        if d == 1 and one.is_profile:
            chosen.append(slice(0, 1))
            continue
        inside = np.flatnonzero((axis >= first) & (axis <= last))
        if inside.size < SMALLEST:
            edges = [one.center[d] + side * one.size[d] / 2 for side in (-1, 1)]
            raise Error(
                "{}: --window: {} = {:g} ... {:g} m contains {} cells; use at least 2 of the map, "
                "which goes from {:g} to {:g} m".format(one.name, "xy"[d], first, last, inside.size, *edges)
            )
        chosen.append(slice(inside[0], inside[-1] + 1))
    x, y = chosen
    values = one.values[y, x]
    center = [(one.axis(d)[part][0] + one.axis(d)[part][-1]) / 2 for d, part in enumerate(chosen)]
    size = [cell * n for cell, n in zip(one.cell, values.shape[::-1])]
    places = (one.places[0][y], one.places[1][x])
    return replace(one, values=values, size=tuple(size), center=tuple(center), places=places)


def combined(one: Map, other: Map) -> Map:
    """The separation of two surfaces on the same cells, centre on centre.

    Parameters
    ----------
    one, other : Map
        The maps; of heights one of each body's.

    Returns
    -------
    Map

    Raises
    ------
    Error
        If both are heights of one body, or their cells differ.
    """
    if one.quantity == other.quantity != "separation":
        body = one.quantity[-1]
        raise Error(
            f"{one.name} and {other.name}: both are heights of body {body}: give --body 1,2, or convert one of them "
            f"again, by --body {3 - int(body)}; body 1 is turned over, --mirror x or y, if it was measured from its "
            "own side"
        )
    if one.n != other.n or not np.allclose(one.size, other.size, rtol=SAME, atol=0.0):
        texts = ["{} x {} cells on {} x {}".format(*m.n, *map(shown, m.size)) for m in (one, other)]
        raise Error(
            f"{other.name}: {texts[1]}, but {one.name}: {texts[0]}: bring both to one grid by --grid-n and --grid-size"
        )
    values = one.separation() + other.separation()
    name = f"{one.name} and {other.name}"
    return replace(one, values=values, quantity="separation", name=name, remarks=(), doubts=())


# ---------------------------------------------------------------- numbers


def rms_height(one):
    """Sq: root mean square of the heights about their mean, m."""
    return float(np.std(one.values))


def moments(one):
    """Ssk and Sku: skewness and kurtosis of the heights; 0 and 0 of a plane."""
    values = (one.values - np.mean(one.values)) / (np.std(one.values) or 1.0)
    return float(np.mean(values**3)), float(np.mean(values**4))


def rms_slope(one):
    """Sdq: root mean square of the gradient, between the centres of neighbouring cells."""
    along = [np.diff(one.values, axis=1 - d) / one.cell[d] for d in range(1 if one.is_profile else 2)]
    return float(np.sqrt(sum(np.mean(slope**2) for slope in along)))


def peak_to_valley(one):
    """Largest less smallest height, m."""
    return float(np.ptp(one.values))

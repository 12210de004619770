"""A map of a surface: how it is turned and cut, and the numbers that describe it."""

from dataclasses import dataclass, replace

import numpy as np

from ..core.errors import Error
from ..core.lengths import shown

QUANTITIES = {
    "height1": "heights of body 1, peaks positive",
    "height2": "heights of body 2, peaks positive",
    "separation": "separation of the bodies",
}
SMALLEST = 2  # points in x and y: petsam's smallest grid
HIGHEST = 1e4  # values over the size, beyond which they are none of a surface
SAME = 1e-6  # relative difference of lengths that are meant to be the same


@dataclass(frozen=True)
class Map:
    """Values (ny, nx) in m, NaN where one is missing; the first row has the smallest y. Each is that of a cell."""

    values: np.ndarray
    size: tuple  # full width in x, y, m
    center: tuple  # m
    quantity: str  # a key of QUANTITIES
    name: str  # for messages
    places: tuple  # numbers of the rows and the columns in the file, from 0

    @property
    def n(self):
        """Cells in x, y."""
        return self.values.shape[::-1]

    @property
    def cell(self):
        """Width of a cell in x, y, m."""
        return tuple(size / n for size, n in zip(self.size, self.n))

    def axis(self, d):
        """Centres of the cells along x (0) or y (1), m."""
        return self.center[d] + ((np.arange(self.n[d]) + 0.5) / self.n[d] - 0.5) * self.size[d]

    def separation(self):
        """The values as a separation: a peak of either body reduces it."""
        return self.values if self.quantity == "separation" else -self.values


def new_map(values, size, quantity, name, center=(0.0, 0.0)):
    """A map of values as they are in a file, whose first row has the smallest y."""
    if min(values.shape) < SMALLEST:
        rows, columns = values.shape
        raise Error(f"{name}: has {rows} x {columns} points (rows x columns): a map has at least 2 x 2")
    values = np.array(values, dtype=np.float64)  # a copy: the array may be read-only, or in another order
    values[~np.isfinite(values)] = np.nan
    largest = np.max(np.abs(values), initial=0.0, where=~np.isnan(values))
    if largest > HIGHEST * max(size):
        raise Error(
            f"{name}: has values up to {largest:.3g} m: give the value of missing points by --missing, "
            "in the file's unit"
        )
    return Map(values, tuple(size), tuple(center), quantity, name, tuple(np.arange(n) for n in values.shape))


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


def combined(one, other):
    """The separation of two surfaces on the same cells, centre on centre; of heights one of each body's."""
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
    return replace(one, values=values, quantity="separation", name=f"{one.name} and {other.name}")


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
    along = [np.diff(one.values, axis=1 - d) / one.cell[d] for d in (0, 1)]
    return float(np.sqrt(sum(np.mean(slope**2) for slope in along)))


def peak_to_valley(one):
    """Largest less smallest height, m."""
    return float(np.ptp(one.values))

"""The fields and numbers of one saved step: petsam.Snapshot."""

from functools import cached_property

import numpy as np

from ..core.errors import Error
from .datafile import need_index
from .file import Results


class Snapshot:
    """The fields and numbers of one saved step by the names of the results file: snapshot["pressure"], ["load_n"].

    A field has the shape (ny, nx) and is read when it is first asked for.

    Parameters
    ----------
    results : Results
        The file, whose fields these are.
    index : int
        Of the saved step, from 0, or from the end with -1; of_step(K) is that of load step K.

    Attributes
    ----------
    x, y : ndarray
        Cell centres, (nx,) and (ny,), m.
    dx, dy : float
        Widths of a cell, m; in plane strain dy is 1.
    parameters : dict
        {name of an option: value}.

    Raises
    ------
    NotSaved
        If there is no saved step of this index.
    Error
        If the file is none of petsam.
    """

    def __init__(self, results: Results, index: int = -1) -> None:
        if not isinstance(results, Results):
            raise Error(f"{results.path}: holds no results of petsam")
        self.results = results
        self._fields: dict[str, np.ndarray] = {}
        need_index(results, index)
        self.index = index
        self.x, self.y, self.parameters = results.x, results.y, results.parameters
        self.dx, self.dy = (float(axis[1] - axis[0]) if axis.size > 1 else 1.0 for axis in (self.x, self.y))

    def __repr__(self):
        step, time = self.results.steps[self.index], self.results.times[self.index]
        return f"Snapshot({self.results.path!r}, load step {step} at {time:.6g} s, {self.x.size} x {self.y.size} cells)"

    def __getitem__(self, name):
        if name in self.results.history:
            value = self.results.history[name][self.results.row(self.index)]
            return value if value.ndim else value.item()
        if name not in self._fields:
            self._fields[name] = self.results.field(name, self.index)
        return self._fields[name]

    @cached_property
    def r(self) -> np.ndarray:
        """Distance of the cells' centres from x = y = 0, (ny, nx), m."""
        return np.hypot(self.x[None, :], self.y[:, None])

    @cached_property
    def shear(self) -> np.ndarray:
        """Magnitude of the shear |q|, (ny, nx), Pa."""
        return np.hypot(self["shear_x"], self["shear_y"])

    @cached_property
    def slip(self) -> np.ndarray:
        """Magnitude of the slip |s|, (ny, nx), m."""
        return np.hypot(self["slip_x"], self["slip_y"])

    @property
    def row(self) -> int:
        """Number of the row nearest to y = 0."""
        return int(np.argmin(np.abs(self.y)))

    def radius(self, area: str) -> float:
        """The radius of the disc of an area.

        Parameters
        ----------
        area : str
            "contact_area" or "stick_area".

        Returns
        -------
        float
            Radius, m.

        Raises
        ------
        Error
            If there is no such number.
        """
        return np.sqrt(self[area] / np.pi)

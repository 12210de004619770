"""The stresses of a cycle and its fatigue parameters: of a file of petsam-stress, or of petsam.Contact.fatigue()."""

import functools
import os
from collections.abc import Iterator, Mapping
from typing import Any, Optional, Union

import numpy as np

from ...core.errors import Error, short, there_are
from ...core.files import decoded
from ...results.stresses import FATIGUE, Stresses


def terms(angle: float) -> dict[str, float]:
    """{name: factor}: the sum of factors times stresses is the stress on planes normal to the surface, by the angle,
    degrees, of their normal to x."""
    cosine, sine = np.cos(np.deg2rad(angle)), np.sin(np.deg2rad(angle))
    found = {"stress_xx": cosine**2, "stress_yy": sine**2, "stress_xy": 2.0 * sine * cosine}
    return {name: term for name, term in found.items() if abs(term) > 1e-15}


class Cycle:
    """Stresses and fatigue parameters of a cycle at points.

    Parameters
    ----------
    source : petsam.Stresses or mapping
        File of petsam-stress, or the arrays by name of petsam.Contact.fatigue().
    label : str
        Name of a mapping in messages and tables; a file has its own.
    **constants
        Of a mapping the constants of the body, young (Pa) and poisson; a file has its own.

    Attributes
    ----------
    x, y, z : ndarray
        Coordinates of the points, (nx,), (ny,), (nz,), m; the first depth z is 0.
    steps : int
        Number of steps.
    constants : dict
        Young's modulus (Pa) and Poisson's ratio of the body; with layers at each depth, (nz, 1, 1).
    layered : bool
        Whether the body has layers.
    error : float
        Estimated error of the largest tractions of the run (-errors companion), relative; NaN: unknown.
    path, label : str
        Names in messages, and in tables.

    Raises
    ------
    Error
        If there is no step, or the first depth is not 0.
    """

    layered = False

    def __init__(
        self, source: Union[Stresses, Mapping[str, Any]], label: str = "the contact", **constants: Any
    ) -> None:
        self.source = source
        if isinstance(source, Stresses):
            self.file: Optional[Stresses] = source
            self.arrays: Mapping[str, Any] = {}
            self.path, self.label = source.path, source.label
            self.x, self.y, self.z, self.steps = source.x, source.y, source.z, source.times.size
            self.constants = self._moduli(source.parameters)
            self.error = float(source.parameters.get("traction_error", np.nan))
        else:
            self.file, self.arrays = None, source
            self.path, self.label = label, os.path.splitext(os.path.basename(label))[0]
            self.x, self.y, self.z = (np.asarray(source[name]) for name in "xyz")
            self.steps, self.constants, self.error = np.size(source["time"]), constants, np.nan
        if not self.steps:
            raise Error(f"{self.path}: has no load steps: give the stresses of all steps of a cycle")
        if self.z[0] != 0.0:
            raise Error(f"{self.path}: its first depth is {self.z[0]:g} m; give petsam-stress depths from 0 on")

    def _moduli(self, of):
        """Young's modulus and Poisson's ratio of the body; with layers at each depth, (z, 1, 1), or {} of a profile."""
        body = f"body{of['body']:.0f}_"
        self.layered = any(body + name in of for name in ("layer_young", "layer_file"))
        if not self.layered:
            return {name: float(of[name]) for name in ("young", "poisson")}
        if body + "layer_thickness" not in of:
            return {}
        # at an interface the depth itself is above it, the next number below
        layer = np.searchsorted(np.cumsum(of[body + "layer_thickness"]), self.z)
        count, found = np.size(of[body + "layer_young"]), {}
        for name in ("young", "poisson"):
            values = np.append(np.broadcast_to(of[f"{body}layer_{name}"], count), of.get(body + name, np.nan))
            found[name] = values[layer][:, None, None]
        return found

    @property
    def averaged(self) -> float:
        """Length over which the stresses have been averaged (petsam-stress -fatigue_length), m; 0: not at all."""
        return float(self.file.parameters.get("fatigue_length", 0.0)) if self.file else 0.0

    @property
    def doubt(self) -> str:
        """Warning of petsam-stress that the steps are no closed cycle, or more than one; "" for none."""
        words = self.file.parameters.get("cycle_warning", "") if self.file else ""
        return short(decoded(words) if isinstance(words, bytes) else words, 480)

    def __contains__(self, name):
        return name in self.source and name not in ("x", "y", "z", "time")

    @property
    def names(self) -> list[str]:
        """Names of the quantities and parameters."""
        names = self.file.file if self.file else self.arrays
        return [name for name in names if name in self and name != "history" and "_normal_" not in name]

    def need(self, name: str) -> None:
        """Checks that the cycle has a quantity.

        Parameters
        ----------
        name : str
            Name of a quantity or a parameter.

        Raises
        ------
        Error
            If it has no such quantity.
        """
        if name not in self:
            raise Error(f"{self.path}: has no {short(name)} (petsam-stress){there_are(name, self.names, 'it has')}")

    def _part(self, name, rows=slice(None), columns=slice(None)):
        """Values (steps, z, y, x) of a quantity, step by step; of a parameter one."""
        self.need(name)
        for step in range(1 if name in FATIGUE else self.steps):
            if self.file:
                yield self.file.field(name, step, rows=rows, columns=columns)
            else:
                values = np.asarray(self.arrays[name])
                yield (values if name in FATIGUE else values[step])[:, rows, columns]

    def unit(self, name: str) -> str:
        """The unit of a quantity or a parameter.

        Parameters
        ----------
        name : str
            Its name.

        Returns
        -------
        str
            "Pa", "J/m2" or another; "1" of a number without one.
        """
        return self.file.unit(name) if self.file else {"fatemi_socie": "1", "ruiz_1": "J/m2"}.get(name, "Pa")

    def maximum(self, name: str) -> np.ndarray:
        """The largest value over the steps.

        Parameters
        ----------
        name : str
            Name of a quantity or a parameter.

        Returns
        -------
        ndarray
            Largest values, (z, y, x), in its unit.

        Raises
        ------
        Error
            If the cycle has no such quantity.
        """
        return functools.reduce(np.fmax, self._part(name))

    def on_plane(
        self, angle: float = 0.0, row: Optional[int] = None, column: Optional[int] = None
    ) -> Iterator[np.ndarray]:
        """The stress on planes normal to the surface, step by step.

        Parameters
        ----------
        angle : float
            Angle of the plane's normal to x, degrees.
        row, column : int, optional
            Indices along y and x; None: all of them.

        Returns
        -------
        iterator of ndarray
            Of each step the stress, (z, y, x), Pa; (z, 1, 1) below a point.

        Raises
        ------
        Error
            If the cycle lacks a stress.
        """
        of = terms(angle)
        window = [slice(None) if index is None else slice(index, index + 1) for index in (row, column)]
        for parts in zip(*(self._part(name, *window) for name in of)):
            yield sum(term * part for term, part in zip(of.values(), parts))

    def extremes(self, angle: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
        """Maximum and minimum of the stress on planes normal to the surface over the steps.

        Parameters
        ----------
        angle : float
            Angle of the plane's normal to x, degrees.

        Returns
        -------
        tuple of two ndarrays
            Maximum and minimum, (z, y, x), Pa.

        Raises
        ------
        Error
            If the cycle lacks a stress.
        """
        steps = self.on_plane(angle)
        high = low = next(steps)
        for values in steps:
            high, low = np.fmax(high, values), np.fmin(low, values)
        return high, low

    def hot_spot(self, name: str) -> tuple[int, int]:
        """The place of the largest value on the surface.

        Parameters
        ----------
        name : str
            Name of a quantity or a parameter.

        Returns
        -------
        tuple of two ints
            Row and column, indices along y and x.

        Raises
        ------
        Error
            If the cycle has no such quantity, or it has no value on the surface.
        """
        top = self.maximum(name)[0]
        if not np.isfinite(top).any():
            raise Error(f"{self.path}: {name} has no value on the surface; name another parameter by --hot")
        row, column = np.unravel_index(np.nanargmax(top), top.shape)
        return int(row), int(column)

    def nearest(self, x: float, y: float) -> tuple[int, int]:
        """The point nearest to a place.

        Parameters
        ----------
        x, y : float
            The place, m.

        Returns
        -------
        tuple of two ints
            Row and column, indices along y and x.

        Raises
        ------
        Error
            If the place is beyond the outermost cells.
        """
        return self._index("y", self.y, y), self._index("x", self.x, x)

    def _index(self, letter, axis, wanted):
        """Index of the nearest of the points along an axis; Error beyond the outermost cells."""
        half = 0.5 * (axis[1] - axis[0]) if axis.size > 1 else np.inf
        if not axis[0] - half <= wanted <= axis[-1] + half:
            limits = f"{axis[0]:g} to {axis[-1]:g} m"
            raise Error(f"{self.path}: --at: {letter} = {wanted:g} m is not on the points, {limits}; choose one there")
        return int(np.argmin(np.abs(axis - wanted)))

    def line(self, name: str, row: int, column: int) -> np.ndarray:
        """The largest value over the steps along the depth below a point.

        Parameters
        ----------
        name : str
            Name of a quantity or a parameter.
        row, column : int
            Indices of the point along y and x.

        Returns
        -------
        ndarray
            Largest values, (z,), in its unit.

        Raises
        ------
        Error
            If the cycle has no such quantity.
        """
        window = (slice(row, row + 1), slice(column, column + 1))
        return np.fmax.reduce([part[:, 0, 0] for part in self._part(name, *window)])

    def stress_line(self, angle: float, row: int, column: int) -> np.ndarray:
        """The stress on planes normal to the surface along the depth below a point.

        Parameters
        ----------
        angle : float
            Angle of the plane's normal to x, degrees.
        row, column : int
            Indices of the point along y and x.

        Returns
        -------
        ndarray
            Stress, (time, z), Pa.

        Raises
        ------
        Error
            If the cycle lacks a stress.
        """
        return np.array([part[:, 0, 0] for part in self.on_plane(angle, row, column)])


__all__ = ["Cycle"]


def __dir__():
    return __all__

"""Creep forces of elliptic contacts from a table: CreepTable, by libpetsam's functions of include/petsam/creep.h.

The header describes the axes and the splines of a table, scripts/maintain/creepfile.py its file.
"""

from __future__ import annotations

import ctypes
import os
import weakref
from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple, Optional, Union

import numpy as np
from numpy.typing import ArrayLike

from ...contact.shared import library
from ...core import arrays
from ...core.errors import Error, WrongArgument, short
from ...core.files import need_regular

MESSAGE, SHOWN, INVALID = 256, 150, 2  # bytes of a message and of a file's name in it, status: as the header has them


class _Table(ctypes.Structure):
    """The first members of the header's petsam_creep_table."""

    _fields_ = (
        ("n", ctypes.c_int * 4), ("cells", ctypes.c_int), ("first", ctypes.c_double), ("last", ctypes.c_double),
        ("poisson", ctypes.c_double), ("error", ctypes.c_double * 4),
    )  # fmt: skip


class Forces(NamedTuple):
    """Creep forces Fx and Fy, N, and Mz, N m, (..., 3), and their derivatives by xi, eta, phi and N, the half axes
    held, (..., 3, 4), or None."""

    force: np.ndarray
    derivative: Optional[np.ndarray]


@dataclass(frozen=True)
class FallingFriction:
    """Friction that falls with the slip velocity, as by -friction_law falling, for CreepTable.forces().

    Parameters
    ----------
    static : float
        Coefficient of friction without slip.
    kinetic : float
        That at high speed.
    half_speed : float
        Speed at which half of the way is done, m/s.

    Raises
    ------
    Error
        If a number is out of range.
    """

    static: float
    kinetic: float
    half_speed: float

    def __post_init__(self) -> None:
        if not (0.0 < self.kinetic <= self.static < np.inf and 0.0 < self.half_speed < np.inf):
            raise Error(
                f"FallingFriction {self.static:g}, {self.kinetic:g}, {self.half_speed:g}: expected two coefficients of "
                "friction, the second one not above the first, and a speed in m/s"
            )

    def __call__(self, speed: np.ndarray) -> np.ndarray:
        """The coefficient of friction.

        Parameters
        ----------
        speed : ndarray
            Slip velocity, m/s.

        Returns
        -------
        ndarray
        """
        return self.kinetic + (self.static - self.kinetic) * np.exp2(-speed / self.half_speed)


def slip(a: ArrayLike, b: ArrayLike, xi: ArrayLike, eta: ArrayLike, phi: ArrayLike) -> np.ndarray:
    """The rigid slip over the rolled distance: the root of its mean square, weighted by Hertz's pressure, by the half
    axes along and across the rolling direction (m), creepages, and spin (1/m)."""
    contacts, shape = _rows(*[0.0] * 4, a, b, xi, eta, phi)
    one = library().petsam_creep_slip
    return np.reshape([one(at) for at in _addresses(contacts)], shape)


class CreepTable:
    """A table of creep forces.

    Parameters
    ----------
    path : path
        The file, made by `make creep-table`.

    Attributes
    ----------
    range : tuple of float
        First and last a/b.
    poisson : float
        Poisson's ratio of the bodies.
    cells : int
        Cells along an axis of the grids that it is made with.
    error : tuple of float
        Error of the forces of its nodes, over mu N (Mz: mu N c): median, 90 %, worst, and the number of cases.

    Raises
    ------
    Error
        If the file is none, is damaged, or of another version.
    MissingFile
        If there is no such file.
    """

    def __init__(self, path: Union[str, os.PathLike[str]]) -> None:
        need_regular(path)
        self._library, self._path = library(), os.path.abspath(path)
        name, message = os.fsencode(path), ctypes.create_string_buffer(MESSAGE)
        loaded = self._library.petsam_creep_load(name, message)
        if not loaded:
            text = message.value.removeprefix(name[:SHOWN] + b": ").decode()
            raise Error(f"{os.fspath(path)}: {text}")
        self._table = ctypes.c_void_p(loaded)
        weakref.finalize(self, self._library.petsam_creep_free, self._table)
        table = _Table.from_address(loaded)
        self.range = float(np.exp(table.first)), float(np.exp(table.last))
        self.poisson, self.cells, self.error = table.poisson, table.cells, tuple(table.error)

    @classmethod
    def open(cls, path: Union[str, os.PathLike[str]]) -> CreepTable:
        """The table of a file: CreepTable(path).

        Parameters
        ----------
        path : path
            The file, made by `make creep-table`.

        Returns
        -------
        CreepTable
        """
        return cls(path)

    def __reduce__(self):
        """Another process, and a copy, read the file again."""
        return type(self), (self._path,)

    def factors(self, ratio: np.ndarray, poisson: np.ndarray) -> np.ndarray:
        """X/xi', Y/eta', Z/phi'.

        Parameters
        ----------
        ratio : ndarray
            a/b, (m,).
        poisson : ndarray
            Poisson's ratio, (m,).

        Returns
        -------
        ndarray
            (m, 3).
        """
        given = np.broadcast_arrays(np.asarray(ratio, float), poisson)
        found = np.empty((given[0].size, 3))
        for one, of, out in zip(*given, _addresses(found)):
            self._library.petsam_creep_factors(self._table, ctypes.c_double(one), ctypes.c_double(of), out)
        return found

    def forces(
        self,
        load: ArrayLike,
        half_axes: tuple[ArrayLike, ArrayLike],
        creepages: tuple[ArrayLike, ArrayLike, ArrayLike],
        friction: Union[ArrayLike, Callable[[np.ndarray], np.ndarray]],
        material: tuple[ArrayLike, ArrayLike] = (82e9, 0.28),
        speed: ArrayLike = 0.0,
        derivative: bool = False,
    ) -> Forces:
        """Creep forces of elliptic contacts; all arguments are numbers or arrays of one shape.

        Parameters
        ----------
        load : float or ndarray
            N, N; 0 or less: no forces.
        half_axes : tuple
            a along and b across the rolling direction, m; beyond the table's range of a/b its end is taken.
        creepages : tuple
            xi, eta and the spin phi, 1/m; a positive creepage gives a positive force.
        friction : float, ndarray or callable
            mu; a function of the slip velocity (m/s), such as FallingFriction.
        material : tuple
            G, Pa, and Poisson's ratio, equal in both bodies.
        speed : float or ndarray
            Rolling speed for a function of friction, m/s.
        derivative : bool
            Whether to return the derivative, at a fixed coefficient of friction.

        Returns
        -------
        Forces

        Raises
        ------
        Error
            If an argument is no number, or out of range.
        """
        shear, poisson = material
        if callable(friction):
            friction = friction(np.abs(speed) * slip(*half_axes, *creepages))
        force, slopes = self._forces(shear, poisson, load, friction, *half_axes, *creepages)
        return Forces(force, slopes if derivative else None)

    def _forces(self, *numbers):
        """Forces and derivatives of contacts of these numbers, in the header's order."""
        contacts, shape = _rows(*numbers)
        force, slopes = np.empty((len(contacts), 3)), np.empty((len(contacts), 3, 4))
        one, each = self._library.petsam_creep_forces, map(_addresses, (contacts, force, slopes))
        invalid = [one(self._table, *addresses) == INVALID for addresses in zip(*each)]
        if any(invalid):
            raise Error(f"creep forces: {_fault(contacts[invalid])}")
        return force.reshape(*shape, 3), slopes.reshape(*shape, 3, 4)

    def scaled(self, ratio: np.ndarray, vector: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The forces in the table's units.

        Parameters
        ----------
        ratio : ndarray
            a/b, (m,).
        vector : ndarray
            X, Y, Z, (m, 3).

        Returns
        -------
        forces : ndarray
            Fx/(mu N), Fy/(mu N), Mz/(mu N c), (m, 3).
        slopes : ndarray
            Their derivative by X, Y, Z, (m, 3, 3).
        """
        root = np.sqrt(ratio)
        units = self.factors(ratio, self.poisson)
        force, slopes = self._forces(1.0, self.poisson, 1.0, 1.0, root, 1.0 / root, *(vector / units).T)
        return force, slopes[:, :, :3] / units[:, None, :]


def _rows(*numbers):
    """Contacts as the header has them, (m, 9), from numbers or arrays of one shape, and that shape."""
    given = _alike("creep forces", *numbers)
    rows = np.stack([one.ravel() for one in given], -1)
    return np.ascontiguousarray(rows), given[0].shape


def _alike(what, *given):
    """Arrays of real numbers of one shape, of numbers and arrays; `what` they are for, in the message of others."""
    found = []
    for values in given:
        try:
            found.append(arrays.real(values))
        except (TypeError, ValueError):
            raise WrongArgument(f"{what}: {short(repr(values))}: expected a number or an array of numbers") from None
    try:
        return np.broadcast_arrays(*found)
    except ValueError:
        shapes = ", ".join(dict.fromkeys(str(one.shape) for one in found if one.ndim))
        raise WrongArgument(f"{what}: arrays have the shapes {shapes}: give numbers, or arrays of one shape") from None


def _addresses(array):
    """Addresses of the rows of an array."""
    first, step = array.ctypes.data, array.strides[0]
    return [ctypes.c_void_p(first + k * step) for k in range(len(array))]


def _fault(contacts):
    """Why the library finds a contact invalid."""
    with np.errstate(over="ignore"):
        if not np.isfinite(contacts.sum(axis=1)).all():
            return "an argument is not finite: check load, half axes, creepages, friction and material"
    if not (contacts[:, [0, 4, 5]] > 0.0).all():
        return "half axes (m) and shear modulus (Pa) must be above 0"
    return "expected Poisson's ratios from 0 to 0.5 and coefficients of friction of 0 or more"

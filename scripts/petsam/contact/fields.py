"""Fields of a contact: those that it has found, and the gap and friction that it is given."""

from __future__ import annotations

from typing import Optional

import numpy as np
from numpy.typing import ArrayLike

from ..core import arrays
from .handle import Handle
from .shared import encoded, pointer


class Fields(Handle):
    """Fields of a contact by their names."""

    def field(self, name: str, out: Optional[np.ndarray] = None) -> np.ndarray:
        """A field of the tried step, else of the committed one; also contact["pressure"].

        Parameters
        ----------
        name : str
            Its name in results files.
        out : ndarray, optional
            An array to write to: of (rows, nx) doubles, contiguous.

        Returns
        -------
        ndarray
            This rank's rows, (rows, nx), in SI units.

        Raises
        ------
        ContactError
            If there is no such field, or no step.
        ValueError
            If out has another shape or type.
        TypeError
            If the name is no text, or out no array.
        """
        shape = (self.rows, self.n[0])
        if out is None:
            out = np.empty(shape)
        elif not isinstance(out, np.ndarray):
            raise TypeError(f"out: expected an array, and not {type(out).__name__}")
        elif out.shape != shape or out.dtype != np.float64 or not out.flags.carray:
            raise ValueError(f"out is not a contiguous array of doubles of shape {shape} that can be written to")
        if not isinstance(name, str):
            raise TypeError(f"{name!r} is no name of a field")
        self._ask("get_field", name, pointer(out))
        return out

    __getitem__ = field

    def set_field(self, name: str, values: ArrayLike) -> None:
        """Gives the gap or the friction; also contact["gap"] = values, and contact.gap = values.

        Parameters
        ----------
        name : str
            "gap", the separation of the undeformed, unworn bodies, m, or "friction".
        values : array_like
            This rank's rows, (rows, nx), or a number.

        Raises
        ------
        ContactError
            If there is no such field, or a value is out of range.
        ValueError
            If the shape is another one.
        TypeError
            If the name is no text, or the values are no real numbers.
        """
        values = arrays.real(values) if np.ma.isMA(values) else np.asarray(values)
        if not isinstance(name, str):
            raise TypeError(f"{name!r} is no name of a field: expected gap or friction")
        if values.dtype.kind not in "biufO":
            raise TypeError(f"{name}: expected real numbers, and not {values.dtype}")
        values = np.array(np.broadcast_to(values, (self.rows, self.n[0])), dtype=float, order="C")
        self._call("set_field", encoded(name), pointer(values))
        self._given[name] = values

    __setitem__ = set_field

    def _set_gap(self, values):
        self.set_field("gap", values)

    # given fields cannot be read back: field("gap") is the gap of the deformed bodies
    gap = property(None, _set_gap, doc="The separation of the undeformed, unworn bodies, m; to be set.")

    def _set_friction(self, values):
        self.set_field("friction", values)

    friction = property(None, _set_friction, doc="The coefficient of friction, a number or a field; to be set.")

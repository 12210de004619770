"""Derivatives of a number of a load history by all of its parameters, in one pass back over its steps.

    contact = petsam.Contact(..., slip_direction="end")
    contact.record_gradient()
    contact.run({"time": [0, 1, 2], "load_n": [100, 100, 100], "load_tx": [0, 20, -20]})
    found = contact.gradient("energy")
    found.value, found["gap"], found["friction"], found["load_tx"]

The pass back is the library's (src/post/gradient).
"""

import ctypes
import warnings
from typing import TYPE_CHECKING

import numpy as np

from .results.gradients import MODULI, Gradient

if TYPE_CHECKING:
    from .contact import Contact

LOADS = ("load_n", "load_tx", "load_ty", "load_mx", "load_my", "load_mz")
WAYS = ("disp_z", "disp_x", "disp_y", "rot_x", "rot_y", "rot_z")
BULK = tuple(f"bulk{body}_stress_{name}" for body in (1, 2) for name in ("xx", "yy", "xy"))
WEAR = ("wear_coefficient", "wear_energy")


class OneSidedWarning(UserWarning):
    """A gradient where cells are on the border of their set: it holds to one side."""


def compute(contact: "Contact", name: str, steps: tuple[int, int], moduli: bool, rtol: float) -> Gradient:
    """The gradient of the recorded steps of a contact.

    Parameters
    ----------
    contact : Contact
    name : str
    steps : tuple of int
        First and last step, -1: the usual ones.
    moduli : bool
    rtol : float

    Returns
    -------
    Gradient

    Raises
    ------
    ContactError
        If there is no such number or step.

    Warns
    -----
    OneSidedWarning
        If cells are on the border of their set.
    """
    count = ctypes.c_int()
    contact._call("gradient", name.encode(), *steps, int(moduli), ctypes.c_double(rtol), ctypes.byref(count))

    def get(what, *shape):
        found = np.empty(shape)
        contact._call("get_gradient", what.encode(), found.ctypes.data_as(ctypes.POINTER(ctypes.c_double)))
        return found

    def number(what):
        return float(get(what, 1)[0])

    cells = contact.rows, contact.n[0]
    by_step = {one: get(one, count.value) for one in (*LOADS, *WAYS, *BULK)}
    numbers = {one: values for one, values in by_step.items() if not np.isnan(values).all()}
    numbers.update({one: number(one) for one in (*WEAR, *(MODULI if moduli else ()))})
    borders = int(number("borders"))
    if borders:
        warnings.warn(
            f"gradient of {name}: {borders} cells are on the border of their set: it holds to one side",
            OneSidedWarning,
            stacklevel=3,
        )
    return Gradient(
        name, number("value"), get("gap", *cells), get("friction", *cells), numbers, borders, number("residual")
    )

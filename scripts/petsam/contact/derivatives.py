"""The derivatives of a number of the recorded steps of a contact, by one pass back of the library."""

import ctypes
import warnings
from collections.abc import Sequence
from contextlib import suppress
from typing import Optional

import numpy as np

from ..core.errors import Error
from ..results.gradients import Gradient
from .handle import Handle

LOADS = ("load_n", "load_tx", "load_ty", "load_mx", "load_my", "load_mz")
WAYS = ("disp_z", "disp_x", "disp_y", "rot_x", "rot_y", "rot_z")
BULK = tuple(f"bulk{body}_stress_{name}" for body in (1, 2) for name in ("xx", "yy", "xy"))
WEAR = ("wear_coefficient", "wear_energy")
USUAL = ("gap", "friction", *LOADS, *WAYS, *BULK, *WEAR)  # parameters of a gradient unless others are given


class OneSidedWarning(UserWarning):
    """A gradient where cells are on the border of their set: it holds to one side."""


def compute(contact: Handle, name: str, of: Optional[Sequence[str]], steps: tuple[int, int], rtol: float) -> Gradient:
    """The Gradient of a number over recorded steps of a contact, by the parameters `of`: Contact.gradient() explains
    it."""
    count, unit, text = ctypes.c_int(), ctypes.c_char_p(), None if of is None else ",".join(of).encode()
    contact._call(
        "gradient", name.encode(), *steps, text, ctypes.c_double(rtol), ctypes.byref(count), ctypes.byref(unit)
    )

    def get(what, *shape):
        found = np.empty(shape)
        contact._call("get_gradient", what.encode(), found.ctypes.data_as(ctypes.POINTER(ctypes.c_double)))
        return found

    def number(what):
        return float(get(what, 1)[0])

    cells, columns = (contact.rows, contact.n[0]), (*LOADS, *WAYS, *BULK)
    wanted = USUAL if of is None else of
    by_step = {one: get(one, count.value) for one in wanted if one in columns}
    numbers = {one: values for one, values in by_step.items() if not np.isnan(values).all()}
    for one in wanted:
        if one not in ("gap", "friction", *columns):
            with suppress(*([Error] if of is None else [])):  # by wear unless it is named only if the bodies wear
                numbers[one] = number(one)
    borders = int(number("borders"))
    if borders:
        warnings.warn(
            f"gradient of {name}: {borders} cells are on the border of their set: it holds to one side",
            OneSidedWarning,
            stacklevel=3,
        )
    gap, friction = (get(one, *cells) if one in wanted else None for one in ("gap", "friction"))
    own = (unit.value or b"").decode()
    return Gradient(name, number("value"), gap, friction, numbers, borders, number("residual"), own)

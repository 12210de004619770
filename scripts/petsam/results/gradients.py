"""Derivatives of a number of a run by all of its parameters: of Contact.gradient(), and of /gradient of a file."""

from dataclasses import dataclass, field
from typing import Optional, Union

import h5py
import numpy as np

from ..core.errors import Error, there_are
from ..core.files import decoded

MODULI = ("body1_young", "body1_poisson", "body2_young", "body2_poisson")
NAMED = ("gap", "friction", "wear_coefficient", "wear_energy", *MODULI)  # they exist if they are named


@dataclass(repr=False)
class Gradient:
    """The derivatives of a number; see Contact.gradient(). In `numbers` they are by given loads, displacements and bulk
    stresses of each step, (steps,); by the coefficients of wear, of both bodies alike; if they were wanted by moduli
    and shape."""

    name: str  # of the number
    value: float  # the number itself: J, N, N m, m, rad, m3 or Pa
    gap: Optional[np.ndarray]  # by the gap without load in each cell, per m, (ny, nx) or this rank's rows; or None
    friction: Optional[np.ndarray]  # by the coefficient in each cell; their sum is that by the coefficient; or None
    numbers: dict  # {name: derivative} by other parameters
    borders: int  # cells on the border of their set in some step; with any, the gradient is one-sided
    residual: float  # largest relative residual of the systems, which are solved to rtol
    unit: str  # of the number
    # {name: error} with -errors companion: relative, of the derivative by all cells or steps together
    errors: dict = field(default_factory=dict)

    def keys(self) -> list[str]:
        """The names of the parameters by which there are derivatives."""
        fields = {"gap": self.gap, "friction": self.friction}
        return [*(name for name, field in fields.items() if field is not None), *self.numbers]

    def __iter__(self):
        return iter(self.keys())

    def __contains__(self, name: object) -> bool:
        return name in self.keys()

    def __repr__(self):
        unit = f" {self.unit}" if self.unit else ""
        return f"Gradient({self.name} {self.value:.6g}{unit}, by {', '.join(self.keys())})"

    @property
    def has_fields(self) -> bool:
        """True if it has the derivatives by the gap and by friction."""
        return self.gap is not None and self.friction is not None

    def __getitem__(self, name: str) -> Union[float, np.ndarray]:
        """A derivative by the name of its parameter: gap, friction, load_tx, disp_x, body1_young, ..."""
        every = {"gap": self.gap, "friction": self.friction, **self.numbers}
        every = {one: derivative for one, derivative in every.items() if derivative is not None}
        if name not in every and (name in NAMED or name.startswith("gap_")):
            raise Error(f'gradient: {name}: it was not computed: give of=["{name}"], -gradient_of {name}')
        if name not in every:
            raise Error(f"gradient: {name}: there is no derivative by it{there_are(name, list(every))}")
        return every[name]


def _text(value):
    return decoded(value) if isinstance(value, bytes) else str(value)


def _one(name: str, of: h5py.Group) -> Optional[Gradient]:
    """The gradient in a group; None: the run ended before it was written."""
    if not {"value", "residual", "borders"} <= of.attrs.keys() or any(data is None for data in of.values()):
        return None
    numbers = {key: float(value) for key, value in of.attrs.items() if key != "units"}
    numbers |= {key: data[:] for key, data in of.items() if data.ndim == 1}
    gap, friction = (of[key][:] if key in of else None for key in ("gap", "friction"))
    errors = {key[: -len("_error")]: numbers.pop(key) for key in list(numbers) if key.endswith("_error")}
    borders, residual, unit = int(numbers.pop("borders")), numbers.pop("residual"), _text(of.attrs["units"])
    return Gradient(name, numbers.pop("value"), gap, friction, numbers, borders, residual, unit, errors)


def read(group: Optional[h5py.Group], closed: bool = True) -> dict[str, Gradient]:
    """Returns the gradients {name of the number: Gradient} of a results file, from its group /gradient; none of None.
    If the file is not `closed`, the run may have been killed while it wrote one of them, which is left out."""
    found = {}
    for name, of in () if group is None else group.items():
        try:
            one = _one(name, of)
        except (OSError, RuntimeError):
            if closed:
                raise
            one = None
        if one is not None:
            found[name] = one
    return found

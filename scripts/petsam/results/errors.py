"""The errors of the numbers of results: the group /errors that petsam -errors companion writes."""

from typing import Any, NamedTuple

from ..core.files import decoded
from ..core.tables import Column, Tabled

NUMBERS = {
    "value": "the number; of what each step adds to, the sum over the steps of this run",
    "error": "estimated error relative to the number",
    "by_cells": "the part of it by the cells",
    "by_steps": "the part of it by the steps",
    "by_layers": "the part of it by the layers of bodies that yield",
    "by_mesh": "the part of it by the finite elements of bodies' compliances",
    "factor": "factor of narrower cells, more steps or more layers for an error of 4 %",
    "half": "the number on half the cells",
    "quarter": "the number on a quarter of the cells",
    "other": "the number with other steps, on half or a quarter of the cells",
}
OF_NUMBER = ("value", "half", "quarter", "other")  # in the unit of the row


class NumberError(NamedTuple):
    """A number with its estimated error.

    Attributes
    ----------
    value : float
        The number of the last step, or the sum over the steps of the run; after a restart, of those since.
    unit : str
        Its unit.
    error : float
        Error relative to the number; NaN: unknown.
    by_cells, by_steps, by_layers, by_mesh : float
        The parts of it.
    cause : str
        The largest part: "cells", "steps", "layers" or "mesh".
    factor : float
        How many times narrower cells, or more steps, make that part 4 %.
    half, quarter, other : float
        The number on half and on a quarter of the cells in x and y, and with other steps on one of these; NaN: none.
    """

    value: float
    unit: str
    error: float
    by_cells: float
    by_steps: float
    by_layers: float
    by_mesh: float
    cause: str
    factor: float
    half: float
    quarter: float
    other: float

    def __str__(self) -> str:
        return f"{self.value:.6g} {self.unit} +-{100 * self.error:.2g} %"


class Errors(dict, Tabled):
    """{name: NumberError}, in the order of the file; a table, too."""

    def table(self) -> list:
        """The columns: name, unit, cause and the numbers of NumberError.

        Returns
        -------
        list of Column
            Each with its name, unit, meaning and values (core/tables.py).
        """
        rows = list(self.values())
        return [
            Column("name", "", "name of the number", list(self)),
            Column("unit", "", "unit of value, half, quarter and other", [row.unit for row in rows]),
            *(
                Column(name, "" if name in OF_NUMBER else "1", text, [getattr(row, name) for row in rows])
                for name, text in NUMBERS.items()
            ),
            Column("cause", "", "the larger part of the error", [row.cause for row in rows]),
        ]


def read(group: Any, closed: bool = True) -> Errors:
    """The errors of a file that is open.

    Parameters
    ----------
    group : h5py.Group or None
        Its group /errors.
    closed : bool
        False: the run may have been killed while it wrote them.

    Returns
    -------
    Errors
        None of None, or of a run that did not reach its end.
    """
    if group is None:
        return Errors()
    try:
        return _of(group)
    except (OSError, RuntimeError):
        if closed:
            raise
        return Errors()


def _of(group: Any) -> Errors:
    rows = min(len(column) for column in group.values())  # 0: the run did not reach its end
    texts = {name: [decoded(value) for value in group[name][:rows]] for name in ("name", "unit", "cause")}
    none = [0.0] * rows  # of causes that files of earlier versions do not have
    numbers = {name: group[name][:rows].tolist() if name in group else none for name in NUMBERS}
    columns: dict[str, list] = {**texts, **numbers}
    names = columns.pop("name")
    return Errors((name, NumberError(**{key: of[k] for key, of in columns.items()})) for k, name in enumerate(names))


__all__ = ["Errors", "NumberError"]


def __dir__():
    return __all__

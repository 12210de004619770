"""Tables that results of joints have written as CSV, for reports and pictures."""

import os
from dataclasses import dataclass
from typing import Union

from ...core.brief import brief
from ...core.errors import Error
from ...core.tables import Column, Tabled, read_csv
from .backbones import COLUMNS, Backbone
from .balance import RESPONSE, Response
from .bands import Band
from .conductance import ELECTRICAL, columns_of
from .properties import COLUMNS as OF_INTERFACE
from .properties import Interface
from .ways import ERRORS as OF_FORMULA
from .wearing import WEAR, Wear

# by the first column: the kind of result, and the meanings of its columns
KINDS = {
    "pressure": (Interface, OF_INTERFACE),
    "alpha": (Backbone, COLUMNS),
    "assembly": (Band, COLUMNS),
    "frequency": (Response, RESPONSE),
    "cycles": (Wear, WEAR),
}
ERRORS = {f"{name}_error": ("1", text) for name, text in OF_FORMULA.items()}


@brief
@dataclass
class Saved(Tabled):
    """A table from a CSV file of a joint.

    Attributes
    ----------
    kind : type
        Class of the result that wrote it: Interface, Backbone, Band, Response or Wear.
    columns : list of tables.Column
        Its columns, with a row for each line of the file.
    """

    kind: type
    columns: list[Column]

    def table(self) -> list[Column]:
        return self.columns


def read(path: Union[str, os.PathLike]) -> Saved:
    """Reads a table that petsam-joint or to_csv() has written.

    Parameters
    ----------
    path : str
        The CSV file.

    Returns
    -------
    Saved
        Its table, whose report() writes a page.

    Raises
    ------
    Error
        If the file is no such table.
    """
    columns = read_csv(path)
    if columns[0].name not in KINDS:
        known = f"tables of petsam-joint begin with one of {', '.join(KINDS)}"
        cure = "results.h5 beside it" if columns[0].name == "case" else "one of those, or results of petsam -output"
        raise Error(f"{path}: its first column is {columns[0].name}: {known}; give {cure}")
    kind, own = KINDS[columns[0].name]
    electrical = any(column.unit in ELECTRICAL.values() for column in columns)
    texts = {
        "assembly": ("", "the assembly"),
        **columns_of(electrical),
        **ERRORS,
        **own,
        "note": ("", "about the numbers"),
    }
    return Saved(kind, [column._replace(text=_text(column.name, texts)) for column in columns])


def _text(name, known):
    """The meaning of a column, or its name in words."""
    if name in known:
        return known[name][1]
    number = name.removesuffix("_spread")
    if number != name and number in known:
        return f"standard deviation: {known[number][1]}"
    return name.replace("_", " ")

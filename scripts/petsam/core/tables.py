"""Tables as CSV: columns with a name, a unit and a meaning; heads are `name [unit]`, of texts the name alone."""

import csv
import dataclasses
import io
import os
import re
from typing import Any, NamedTuple, Union

from .errors import Error, library
from .files import need_replaceable, text_of
from .shown import Shown

HEAD = re.compile(r"(.*?)(?: \[(.*)\])?", re.DOTALL)


class Column(NamedTuple):
    """A column: its name, its unit ("1" of a number without one, "" of a text), what it means, and a value per row."""

    name: str
    unit: str
    text: str
    values: object

    @classmethod
    def headed(cls, head, text, values):
        """The column of a head, whose name and unit are "" where it has none."""
        name, unit = HEAD.fullmatch(head).groups()
        return cls(name, unit or "", text, values)

    @classmethod
    def noted(cls, columns, sentence):
        """Columns with one more, note, that has a sentence about all numbers in each row."""
        return [*columns, cls("note", "", "about the numbers", [sentence] * len(columns[0].values))]


def head(name, unit):
    """The head of a column in a file: pressure [Pa]."""
    return f"{name} [{unit}]" if unit else name


def csv_text(columns, form=repr):
    """The table as a text; form(number) writes a number, and None is an empty cell."""
    out = io.StringIO()
    rows = csv.writer(out, lineterminator="\n")
    rows.writerow([head(column.name, column.unit) for column in columns])
    for values in zip(*(column.values for column in columns)):
        rows.writerow([_cell(column, value, form) for column, value in zip(columns, values)])
    return out.getvalue()


def _cell(column, value, form):
    if column.unit == "" or value is None:
        return value
    return form(value if isinstance(value, int) else float(value))


def write_csv(path, columns, form=repr):
    """Writes the table to a file; raises Unwritable where none can be written."""
    need_replaceable(path)
    with open(path, "w", encoding="utf-8", newline="") as file:
        file.write(csv_text(columns, form))


def read_csv(path):
    """The columns of a file of write_csv(), whose meanings are empty; raises Error where it is none."""
    reader = csv.reader(text_of(path).split("\n"))
    try:
        (first, heads), *numbered = [(reader.line_num, row) for row in reader if row] or [(1, [])]
    except csv.Error as error:
        raise Error(f"{path}: line {reader.line_num}: {error}: give a table of comma-separated values") from None
    rows = [row for _, row in numbered]
    if not rows:
        raise Error(f"{path}: no table: expected a line of heads, as name [unit], and lines of values")
    columns = [Column.headed(text, "", None) for text in heads]
    for k, one in enumerate(columns, 1):
        if not one.name.strip():
            raise Error(f"{path}: line {first}: column {k} has no name: give one, as pressure [Pa]")
    for line, row in numbered:
        if len(row) != len(heads):
            raise Error(f"{path}: line {line}: has {len(row)} values, and there are {len(heads)} columns")
    return [one._replace(values=_values(path, one, values)) for one, values in zip(columns, zip(*rows))]


def _values(path, one, values):
    """The values of a column: texts, or with a unit numbers; an empty cell is NaN."""
    if not one.unit:
        return list(values)
    try:
        return [float(value or "nan") for value in values]
    except ValueError as error:
        raise Error(f"{path}: column {head(one.name, one.unit)}: {error}") from None


def to_dataframe(columns):
    """The table as one of pandas, which must be installed; columns have their names, units stand in .attrs["units"]."""
    table = library("pandas").DataFrame({column.name: column.values for column in columns})
    table.attrs["units"] = {column.name: column.unit for column in columns}
    return table


def column(unit, text=""):
    """A field of a dataclass of Tabled that is a column of its table, with the field's name."""
    return dataclasses.field(metadata={"column": (unit, text)})


def _fields(kind):
    return (
        [one for one in dataclasses.fields(kind) if "column" in one.metadata] if dataclasses.is_dataclass(kind) else []
    )


class Tabled(Shown):
    """Base of classes with a table(), by default of the fields by column(): writes its columns as CSV, as a table of
    pandas and on a page, and reads a class of such fields alone."""

    form = staticmethod(repr)  # writes a number of the CSV
    unknown = "no error of the grid is known"  # begins the sentence of results that have none

    def table(self) -> list:
        """The columns.

        Returns
        -------
        list of tables.Column
            Name, unit, meaning and values of each.
        """
        own: list[dataclasses.Field] = _fields(type(self))
        if not own:
            raise NotImplementedError
        columns = [(one.name, one.metadata["column"]) for one in own]
        return [Column(name, unit, text, getattr(self, name)) for name, (unit, text) in columns]

    @classmethod
    def read(cls, path):
        """Reads a file of to_csv() as an object of this class; Error if it has other columns."""
        columns, own = read_csv(path), [(one.name, one.metadata["column"][0]) for one in _fields(cls)]
        if [(one.name, one.unit) for one in columns] != own:
            heads = [", ".join(head(*one[:2]) for one in found) for found in (columns, own)]
            raise Error(f"{path}: its columns are {heads[0]}: give a table with the columns {heads[1]}")
        numpy = library("numpy")
        return cls(**{one.name: numpy.array(one.values) for one in columns})

    def to_csv(self, path: Union[str, os.PathLike], *which: str) -> None:
        """Writes table(*which) as CSV, with heads `name [unit]`, to the file of this name."""
        write_csv(path, self.table(*which), self.form)

    def to_dataframe(self, *which: str) -> Any:
        """table(*which) as one of pandas, which must be installed; units stand in .attrs["units"]."""
        return to_dataframe(self.table(*which))

"""Measured profiles beside computed scars: a CSV of heights of the worn surface over x."""

from ..core import units
from ..core.errors import Error, short
from ..core.texttable import Table


def _size(table, name):
    """The size of the unit of a column in m."""
    unit = table.units.get(name)
    size = units.size(unit or "")
    if size is None:
        head = f"{name} [{unit}]" if unit else name or "without a name"
        raise Error(
            f"{table.path}: line {table.head}: column {short(head)}: expected a name and a unit of length, such as "
            f"x [mm] or height [um]; units are {units.names()}"
        )
    return size


def read_profiles(path):
    """The profiles of a file: x (m), and heights (m) by name.

    As of every table of texts, with any separator. The first line names the columns with their units, x first: x [mm],
    test1 [um], ...; of a running band y. Heights are those of the worn surface over the unworn one: a scar is negative.
    """
    table = Table(path, None, "point", "numbers")
    sizes = {name: _size(table, name) for name in (*table.others, *table.columns)}
    if next(iter(sizes)) not in ("x", "y"):
        raise Error(
            f"{path}: line {table.head}: column {short(table.words[0])}: expected x (or y) first, such as x [mm]"
        )
    numbers, columns = table.rows()
    if len(columns) < 2 or len(numbers) < 2:
        raise Error(f"{path}: expected a line of column names, x [mm],height [um], and two lines of numbers or more")
    x, *heights = (sizes[name] * values for name, values in columns.items())
    return x, dict(zip(list(columns)[1:], heights))

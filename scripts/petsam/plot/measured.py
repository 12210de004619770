"""Measured profiles beside computed scars: a CSV of heights of the worn surface over x."""

import csv

import numpy as np

from ..core import tables, units
from ..core.errors import Error, short
from ..core.files import need_regular


def _column(path, number, head):
    """Name of a column, and the size of its unit in m, of a head such as x [mm]."""
    name, unit = tables.split(head.strip())
    size = units.size(unit)
    if size is None:
        raise Error(f"{path}, line {number}: column {short(head)}: expected a name and a unit of length, such as "
                    f"x [mm] or height [um]; units are {units.names()}")  # fmt: skip
    return name, size


def _values(path, number, cells, count):
    try:
        values = [float(cell) for cell in cells]
    except ValueError as error:
        raise Error(f"{path}, line {number}: {error}") from error
    if len(values) != count or not np.all(np.isfinite(values)) or "_" in "".join(cells):  # float() takes 1_000
        raise Error(f"{path}, line {number}: expected {count} finite numbers, as many as there are columns")
    return values


def read_profiles(path):
    """The profiles of a file: x (m), and heights (m) by name.

    Lines that begin with # are comments. The first other line names the columns with their units, x first: x [mm],
    test1 [um], ...; of a running band y. Heights are those of the worn surface over the unworn one: a scar is negative.
    """
    need_regular(path)
    try:
        with open(path, encoding="utf-8-sig", newline="") as file:
            lines = [(n, line) for n, line in enumerate(file, 1) if line.strip() and not line.startswith("#")]
        rows = [(n, next(csv.reader([line]))) for n, line in lines]
    except (UnicodeDecodeError, csv.Error) as error:
        raise Error(f"{path}: is no table in CSV: {error}") from error
    if len(rows) < 3 or len(rows[0][1]) < 2:
        raise Error(
            f"{path}: expected a line of column names with commas, x [mm],height [um], and two lines of numbers or more"
        )
    number, names = rows[0]
    columns = [_column(path, number, name) for name in names]
    if columns[0][0] not in ("x", "y"):
        raise Error(f"{path}, line {number}: column {short(names[0])}: expected x (or y) first, such as x [mm]")
    if len({name for name, _ in columns[1:]}) < len(columns) - 1:
        raise Error(f"{path}, line {number}: two columns have the same name")
    table = np.array([_values(path, n, cells, len(columns)) for n, cells in rows[1:]])
    table *= [factor for _, factor in columns]
    return table[:, 0], dict(zip([name for name, _ in columns[1:]], table.T[1:]))

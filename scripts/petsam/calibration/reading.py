"""A laboratory's file of loops: a table of displacement and force over time, or of the peaks of each cycle.

Lines before the head are skipped. The head names columns with their units: `Displacement (um);Friction force (N)`,
x [mm], F / N. Fields are separated by tabs, semicolons or commas; where they are not by commas, decimals may have them.
"""

import csv
import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Optional

import numpy as np

from ..core import units
from ..core.errors import Error, short, there_are
from ..core.files import text_of

MISSING = ("", "nan", "n/a", "-", "--", "null", "none", "1.#qnan", "#n/a", "lost")
NUMBER = re.compile(rf"{units.NUMBER}")
UNIT = re.compile(r"^(?P<name>.*?)\s*(?:\[(?P<a>[^\]]*)\]|\((?P<b>[^)]*)\)|/\s*(?P<c>\S+))\s*$")
QUANTITIES = {"displacement": "m", "force": "N", "time": "s", "energy": "J"}
WORDS = {
    "displacement": ("displacement", "stroke", "position", "slip", "disp", "weg", "x", "d"),
    "force": ("friction", "tangential", "force", "shear", "kraft", "q", "f", "t"),
}
PEAK = re.compile(r"amplitude|\*|max|peak", re.IGNORECASE)


@dataclass(frozen=True)
class Record:
    """What a file holds, in SI units; lost points are NaN.

    Parameters
    ----------
    path : str
    displacement, force : ndarray
        (n,), m and N; of peaks the amplitudes of each cycle.
    time : ndarray, optional
        (n,), s.
    cycle : ndarray, optional
        (n,), the number of the cycle of each row.
    energy : ndarray, optional
        (n,), J, of peaks.
    peaks : bool
        The rows are cycles.
    notes : list of str
        What was done to the data.
    """

    path: str
    displacement: np.ndarray
    force: np.ndarray
    time: Optional[np.ndarray] = None
    cycle: Optional[np.ndarray] = None
    energy: Optional[np.ndarray] = None
    peaks: bool = False
    notes: list = field(default_factory=list)


def _cells(line, separator):
    return [cell.strip() for cell in next(csv.reader([line], delimiter=separator))]


def _separator(lines):
    """What separates the fields: the first of tab, semicolon and comma that most lines have; else blanks."""
    for one in "\t;,":
        if sum(one in line for line in lines) > 0.6 * len(lines):
            return one
    return None


def _split(lines):
    separator = _separator(lines)
    if separator is None:
        return [line.split() for line in lines], None
    return [_cells(line, separator) for line in lines], separator


def _number(text, comma):
    """The number of a cell, NaN of one that is missing; None of another text."""
    text = text.strip().strip('"')
    if text.lower() in MISSING:
        return np.nan
    if comma:
        text = text.replace(",", ".")
    return float(text) if NUMBER.fullmatch(text) else None


def _head(rows, comma):
    """Index of the head: the row of texts before the first row of the same width with two numbers or more."""
    for k, row in enumerate(rows[1:], 1):
        found = sum(_number(cell, comma) is not None and bool(cell) for cell in row)
        texts = all(_number(cell, comma) is None for cell in rows[k - 1])
        if found >= 2 and texts and len(rows[k - 1]) == len(row):
            return k - 1
    return None


def _means(name, what):
    """Whether a column may be meant by its name."""
    words = name.lower().replace("_", " ").split()
    return any(word in words or len(word) > 2 and word in name.lower() for word in WORDS[what])


def _named(cell):
    """Name and unit of a head; the unit is None where there is none."""
    found = UNIT.match(cell.strip().strip('"'))
    if not found:
        return cell.strip().strip('"'), None
    return found["name"].strip() or cell, next((found[k].strip() for k in "abc" if found[k]), "")


def _quantity(unit):
    """Quantity of a unit of a head, and its size; "" of none, None of an unknown one."""
    if unit in (None, "", "-", "1"):
        return "", 1.0
    if re.fullmatch(r".*N/(mm|m|cm)", unit):
        return "N/m", 1.0
    for si in QUANTITIES.values():
        size = units.size(unit, si)
        if size:
            return si, size
    return None, 1.0


def _choose(path, what, columns, given):
    """The column of a quantity: the one that is given by name, else the only one, else that of a known word."""
    si = QUANTITIES[what]
    if given:
        chosen = [one for one in columns if one[0].lower() == given.lower()]
        if not chosen:
            raise Error(
                f"{path}: --{what} {short(given)}: no such column{there_are(given, [one[0] for one in columns])}"
            )
        if chosen[0][1] != si:
            raise Error(f"{path}: column {short(chosen[0][0])}: has no unit of {what}; units are {units.names(si)}")
        return chosen[0]
    fitting = [one for one in columns if one[1] == si]
    if not fitting:
        bare = [one for one in columns if one[1] in ("", None) and _means(one[0], what)]
        if bare:
            raise Error(
                f"{path}: column {short(bare[0][0])}: has no unit of {what} in the head, such as "
                f"{'Displacement (um)' if si == 'm' else 'Force (N)'}; units are {units.names(si)}"
            )
        raise Error(
            f"{path}: no column of a {what}: name it with its unit, such as {what} [{'um' if si == 'm' else 'N'}]"
        )
    if len(fitting) > 1:
        known = [one for one in fitting if _means(one[0], what)]
        if len(known) == 1:
            return known[0]
        names = ", ".join(short(one[0]) for one in fitting)
        raise Error(f"{path}: columns {names} may be the {what}: choose one by --{what} NAME")
    return fitting[0]


def read(path, displacement: Optional[str] = None, force: Optional[str] = None) -> Record:
    """Reads a laboratory's file.

    Parameters
    ----------
    path : path
    displacement, force : str, optional
        Names of the columns, where several may be meant.

    Returns
    -------
    Record

    Raises
    ------
    Error
        If the file is no such table, a column lacks its unit, or the force is one per length.
    """
    lines = [(n, line) for n, line in enumerate(text_of(path).splitlines(), 1) if line.strip()]
    lines = [(n, line) for n, line in lines if not line.lstrip().startswith(("#", "%", "//"))]
    if len(lines) < 3:
        raise Error(f"{path}: expected a head with names and units, and rows of numbers")
    rows, separator = _split([line for _, line in lines])
    comma = separator in (";", "\t", None)
    start = _head(rows, comma)
    if start is None:
        raise Error(
            f"{path}: no line of names above the rows of numbers: name the columns, Displacement (um);Force (N)"
        )
    columns = _columns(path, rows[start])
    body, numbers = rows[start + 1 :], [number for number, _ in lines[start + 1 :]]
    return _record(str(path), columns, _values(path, columns, body, numbers, comma), displacement, force)


def _columns(path, head):
    """(name, quantity, size of its unit, place, unit) of the columns."""
    columns = []
    for k, cell in enumerate(head):
        name, unit = _named(cell)
        si, size = _quantity(unit)
        columns.append((name, si, size, k, unit))
        if si == "N/m":
            raise Error(f"{path}: column {short(name)}: is a force per length, {unit}: multiply by the length")
    return columns


def _values(path, columns, body, numbers, comma):
    """The numbers of the rows, NaN where there is none."""
    width = len(columns)
    values = np.full((len(body), width), np.nan)
    for i, (row, number) in enumerate(zip(body, numbers)):
        if len(row) > width and any(row[width:]) or len(row) < 2:
            raise Error(f"{path}, line {number}: has {len(row)} fields, the head has {width}")
        for k, cell in enumerate(row[:width]):
            value = _number(cell, comma)
            if value is not None:
                values[i, k] = value
            elif columns[k][1] in ("m", "N"):  # others may be texts or dates
                raise Error(f"{path}, line {number}: column {short(columns[k][0])}: {short(cell)} is no number")
    return values


def _record(path, columns, values, displacement, force):
    notes, found = [], {}
    for what, given in (("displacement", displacement), ("force", force)):
        name, _, size, k, unit = _choose(path, what, columns, given)
        found[what] = (name, values[:, k] * size)
        notes.append(f"{what}: {name} [{unit}]")
    other = {si: values[:, k] * size for _, si, size, k, _ in columns if si in ("s", "J")}
    cycle = next((values[:, k] for name, si, _, k, _ in columns if si == "" and "cycle" in name.lower()), None)
    lost = int(np.sum(~np.isfinite(found["displacement"][1] + found["force"][1])))
    if lost:
        notes.append(f"{lost} rows have lost points")
    peaks = all(PEAK.search(name) for name, _ in found.values())
    known = np.isfinite(found["displacement"][1] + found["force"][1])
    if known.sum() < (1 if peaks else 20):
        raise Error(f"{path}: {int(known.sum())} rows of numbers are too few: a loop needs 20 points or more")
    return Record(
        path, found["displacement"][1], found["force"][1], other.get("s"), cycle, other.get("J"), peaks, notes
    )  # fmt: skip


def same_units(records: Sequence[Record]) -> bool:
    """Whether all records are of peaks, or none is."""
    return len({one.peaks for one in records}) < 2

"""A laboratory's file of loops: a table of displacement and force over time, or of the peaks of each cycle.

Lines before the head are skipped; a comment just above the numbers may be the head. All rows have as many fields as the
head: one that has lost a field would have another's numbers.
"""

import os
import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Optional, Union

import numpy as np

from ...core.brief import brief
from ...core.errors import Error, counted, short
from ...core.texttable import Form, Text
from . import heads

FORM = Form(missing=("lost",), comments=("#", "%", "//"))
CUT = re.compile(r"[+-]?0\d+")  # no number begins so, but decimals do
PEAK = re.compile(r"amplitude|\*|max|peak", re.IGNORECASE)


@brief
@dataclass(frozen=True)
class Record:
    """The contents of a file, in SI units; lost points are NaN.

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


def _number(text):
    """The number of a cell, NaN of one that is missing; None of another text. A comma within a cell is no separator."""
    value = FORM.number(text.strip('"').replace(",", "."))
    return None if value is not None and np.isinf(value) else value


def _texts(row):
    """True if a row has texts, and no number."""
    values = [_number(cell) for cell in row]
    return None in values and all(value is None or np.isnan(value) for value in values)


def _numbers(row):
    """True if a row has two numbers or more."""
    return sum(bool(cell) and _number(cell) is not None for cell in row) >= 2


def _ends(row, width):
    """True if a row has this many cells, or empty ones behind them."""
    return len(row) >= width and not any(row[width:])


def _columns(text, lines, rows):
    """The columns, and the place of the first row of numbers."""
    path = text.path
    first = next((k for k, row in enumerate(rows) if _numbers(row) and not lines[k][2]), None)
    if first is None:
        raise Error(f"{path}: expected a head with names and units, and rows of numbers")
    for k in range(first, len(rows)):  # numbers of an instrument's header have texts of another width above them
        width = len(rows[k])
        above = [text.head(*lines[j][:2], text.separator, width) for j in range(max(0, k - 2), k)]
        if not _numbers(rows[k]) or not above or not _ends(rows[k], len(above[-1])) or not _texts(above[-1]):
            continue
        named = len(above) == 2 and len(above[0]) == len(above[-1]) and _texts(above[0])
        return heads.columns(path, text.heads(above[-1], above[0] if named else None)), k
    number, width = lines[first][0], len(rows[first])
    if first and _texts(rows[first - 1]):
        raise Error(
            f"{path}, line {number}: has {counted(width, 'field')}, the line above it has {len(rows[first - 1])} "
            f"({short(lines[first - 1][1].strip())}): name each column once, Displacement (um);Force (N), and separate "
            "names and numbers alike"
        )
    raise Error(f"{path}: no line of names above the rows of numbers: name the columns, Displacement (um);Force (N)")


def read(path: Union[str, os.PathLike], displacement: Optional[str] = None, force: Optional[str] = None) -> Record:
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
    text = Text(path, FORM)
    if len(text.kept) < 2:
        raise Error(f"{path}: expected a head with names and units, and rows of numbers")
    lines = text.every
    rows = [text.words(number, line, text.separator) for number, line, _ in lines]
    columns, start = _columns(text, lines, rows)
    body = [(number, row) for (number, _, comment), row in zip(lines[start:], rows[start:]) if not comment]
    values, notes = _values(path, columns, body)
    return _record(str(path), columns, values, displacement, force, notes)


def _values(path, columns, body):
    """The numbers of the rows, NaN where there is none, and notes."""
    width, used = len(columns), []
    values = np.full((len(body), width), np.nan)
    for i, (number, row) in enumerate(body):
        if not _ends(row, width):
            raise Error(
                f"{path}, line {number}: has {counted(len(row), 'field')}, the head has {width}: mark a lost point by "
                "an empty field or nan"
            )
        for k, cell in enumerate(row[:width]):
            value = _number(cell)
            if value is not None:
                values[i, k] = value
            if columns[k].si in ("m", "N"):  # others may be texts or dates
                used.append((number, k, cell.strip('" ')))
                if value is None:
                    raise Error(f"{path}, line {number}: column {short(columns[k].name)}: {short(cell)} is no number")
    return values, _check_signs(path, used)


def _check_signs(path, used):
    """Raises Error for numbers (line, column, cell) whose commas may be those between thousands, or separators; returns
    notes of what is taken for granted."""
    commas, points = ([one for one in used if sign in one[2]] for sign in ",.")
    if commas and points:
        raise Error(
            f"{path}, line {commas[0][0]}: {short(commas[0][2])} has a comma, and {short(points[0][2])} in line "
            f"{points[0][0]} a point: write all decimals alike, without signs between thousands"
        )
    notes = []
    for k in sorted({k for _, k, _ in commas}):
        own = [one for one in used if one[1] == k and not np.isnan(_number(one[2]))]
        comma = [one for one in own if "," in one[2]]
        plain = next((one for one in own if "," not in one[2] and _number(one[2])), None)
        if not all(FORM.thousands(cell) for _, _, cell in comma):
            continue
        notes.append(f"the comma of {short(comma[0][2])} is taken for a decimal one")
        if plain:
            raise Error(
                f"{path}, line {comma[0][0]}: the comma of {short(comma[0][2])} may be one between thousands, as "
                f"{short(plain[2])} in line {plain[0]} has none: write the numbers without it"
            )
    cut = next((one for one in used if CUT.fullmatch(one[2])), None)
    if cut:
        raise Error(
            f"{path}, line {cut[0]}: {short(cut[2])} is what stands behind a decimal comma: separate the fields by "
            "semicolons"
        )
    return notes


def _record(path, columns, values, displacement, force, notes):
    found = {}
    for what, given in (("displacement", displacement), ("force", force)):
        one = heads.given(path, what, given, columns) if given else heads.choose(path, what, columns)
        found[what] = (one.name, values[:, one.place] * one.size)
        notes.append(f"{what}: {one.name} [{one.unit}]")
    other = {one.si: values[:, one.place] * one.size for one in columns if one.fits("s") or one.fits("J")}
    cycle = next((values[:, one.place] for one in columns if one.si == "" and "cycle" in one.name.lower()), None)
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
    """True if all records are of peaks, or none is."""
    return len({one.peaks for one in records}) < 2

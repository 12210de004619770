"""Maps in text files: one line per row of the map, one column per point; errors name the line."""

import re

import numpy as np

from ..core.errors import Error, short
from ..core.files import SAMPLE, decoded, lines_of

COMMENTS = ("#", "%")  # of lines that never have numbers of the map
# missing points as instruments and spreadsheets write them
MISSING = {"", "nan", "na", "n/a", "bad", "null", "none", "-", "--", "***", "---", "#n/a"}
DECIMAL_COMMA = re.compile(r"[+-]?\d*,\d+(?:[eE][+-]?\d+)?")


def _text(path):
    """The file's text, whatever its header's letters are written in."""
    with open(path, "rb") as file:
        data = file.read()
    text = decoded(data)
    if "\0" in text[:SAMPLE]:
        raise Error(f"{path}: is not a text")
    return text


def _lines(path, skip):
    """Numbers, from 1, and contents of the lines that are not empty, skipped or comments."""
    for number, line in enumerate(lines_of(_text(path)), 1):
        if number > skip and line.strip() and not line.lstrip().startswith(COMMENTS):
            yield number, line


def _separator(line):
    """What separates the numbers of a line; None: white space."""
    return next((mark for mark in (";", "\t", ",") if mark in line), None)


def _has_decimal_commas(words, separator):
    """Whether some of the words are numbers with a comma for a point."""
    return separator != "," and any(DECIMAL_COMMA.fullmatch(word) for word in words)


def _words(line, decimal):
    """The words of a line, and their separator."""
    separator = _separator(line.replace(",", "") if decimal == "comma" else line)
    if separator == "," and all(DECIMAL_COMMA.fullmatch(word) for word in line.split()) and len(line.split()) > 1:
        separator = None  # 0,1 0,2 0,3
    words = [word.strip() for word in line.split(separator)]
    return words, separator


def _number(word):
    """A word as a number, NaN for a missing point; None for another text."""
    if word.lower() in MISSING:
        return np.nan
    try:
        return float(word)
    except ValueError:
        return None


def _row(path, number, words, separator, decimal):
    """The numbers of a line."""
    if decimal == "comma":
        words = [word.replace(",", ".") for word in words]
    try:
        return np.array([float(word) for word in words])
    except ValueError:
        values = [_number(word) for word in words]
    if None in values:
        word = words[values.index(None)]
        if decimal != "comma" and _has_decimal_commas(words, separator):
            raise Error(f"{path}: line {number}: {short(word)} has a decimal comma: give --decimal comma")
        column = values.index(None) + 1
        raise Error(
            f"{path}: line {number}, column {column}: {short(repr(word))} is not a number; "
            "--skip-rows and --skip-columns skip text and other columns"
        )
    return np.array(values, dtype=float)


def _is_header(words, decimal):
    """Whether no word is a number, so that the line can only name something."""
    words = [word.replace(",", ".") for word in words] if decimal == "comma" else words
    return not any(_number(word) is not None and word for word in words)


def read_table(path, decimal="point", skip_rows=0, skip_columns=0):
    """Values (rows, columns) of a text file, NaN where one is missing; how many header lines; line of the first row."""
    rows, header, first = [], 0, 0
    for number, line in _lines(path, skip_rows):
        words, separator = _words(line, decimal)
        if not rows and _is_header(words, decimal) and not _has_decimal_commas(words, separator):
            header += 1
            continue
        row = _row(path, number, words[skip_columns:], separator, decimal)
        if rows and row.size != rows[0].size:
            raise Error(f"{path}: line {number} has {row.size} numbers, line {first} has {rows[0].size}")
        first = first or number
        rows.append(row)
    if not rows:
        raise Error(f"{path}: contains no numbers")
    values = np.array(rows)
    if values.shape[1] > 1 and np.all(np.isnan(values[:, -1])) and line.rstrip(" ").endswith((",", ";", "\t")):
        values = values[:, :-1]  # every line ends with a separator
    return values, header, first


def empty_line(path, first):
    """The first empty line between rows of numbers, which may end a map; None without one, or where most rows have
    one between them. first: line of the first row."""
    full = [number for number, line in enumerate(lines_of(_text(path)), 1) if number >= first and line.strip()]
    before = [one for one, other in zip(full, full[1:]) if other > one + 1]
    return before[0] + 1 if 0 < len(before) < len(full) // 2 else None


def header_lines(path, decimal="point", skip_rows=0):
    """Numbers and texts of the lines that are no rows of the map: skipped ones, comments, and those before the rows."""
    found, rows = [], False
    for number, line in enumerate(lines_of(_text(path)), 1):
        words, separator = _words(line, decimal)
        of_map = not _is_header(words, decimal) or _has_decimal_commas(words, separator)
        if number <= skip_rows or line.lstrip().startswith(COMMENTS):
            found += [(number, line)] if line.strip() else []
        elif line.strip() and not rows and not of_map:
            found.append((number, line))
        rows = rows or number > skip_rows and of_map and not line.lstrip().startswith(COMMENTS)
    return found

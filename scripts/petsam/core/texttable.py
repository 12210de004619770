"""Tables in text files: one line per row, one word per number; errors name the line."""

import csv
import re
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from .errors import Error, short
from .files import SAMPLE, decoded, lines_of

COMMENTS = ("#", "%")  # of lines that never have numbers of the map
# missing points as instruments and spreadsheets write them
MISSING = {
    "", "nan", "na", "n/a", "bad", "null", "none", "-", "--", "***", "---", "#n/a", "#value!", "#num!", "#div/0!",
}  # fmt: skip
OF_MICROSOFT = re.compile(r"[+-]?1[.,]#(?:qnan|snan|ind|inf)\d*")  # as its C library prints no number
DECIMAL_COMMA = re.compile(r"[+-]?\d*,\d+(?:[eE][+-]?\d+)?")
THOUSANDS = re.compile(r"[+-]?[1-9]\d{0,2}(?:,\d{3})+")
HEAD = re.compile(r"\s*(.*?)\s*(?:[\[(]\s*([^\])]*?)\s*[\])])?\s*")  # x [mm], fx (N)
QUOTED = re.compile(r'"[^"]*"')


@dataclass(frozen=True)
class Form:
    """How the words of a text are read: all that it does not state."""

    decimal: str = None  # "point" or "comma"; None: as the file shows where it can only be one of them
    skip_rows: int = 0
    skip_columns: int = 0
    missing: tuple = ()  # words of missing points, in small letters, beside the usual ones


def _text(path):
    """The file's text, whatever its header's letters are written in."""
    with open(path, "rb") as file:
        data = file.read()
    text = decoded(data)
    if "\0" in text[:SAMPLE]:
        raise Error(f"{path}: is not a text, as it has bytes of 0: save it as a text in UTF-8")
    return text


def _separator(line):
    """What separates the numbers of a line; None: white space."""
    return next((mark for mark in (";", "\t", ",") if mark in line), None)


def _has_decimal_commas(words, separator):
    """Whether some of the words are numbers with a comma for a point."""
    return separator != "," and any(DECIMAL_COMMA.fullmatch(word) for word in words)


def split(line, decimal=None):
    """The words of a line, and their separator, which commas within quotation marks are not."""
    if '"' in line:
        separator = _separator(QUOTED.sub("", line))
        rows = list(csv.reader([line], delimiter=separator or " ", skipinitialspace=True))
        words = [word.strip() for word in (rows[0] if rows else [])]
        return words, '"' if separator == "," and any(map(DECIMAL_COMMA.fullmatch, words)) else separator
    separator = _separator(line.replace(",", "") if decimal == "comma" else line)
    if separator == "," and all(DECIMAL_COMMA.fullmatch(word) for word in line.split()) and len(line.split()) > 1:
        separator = None  # 0,1 0,2 0,3
    return [word.strip() for word in line.split(separator)], separator


def _number(word, missing=()):
    """A word as a number, NaN for a missing point; None for another text."""
    small = word.lower()
    if small in MISSING or small in missing or OF_MICROSOFT.fullmatch(small):
        return np.nan
    try:
        return float(word)
    except ValueError:
        return None


def _decimal(lines):
    """ "comma" where words between semicolons, tabs or quotation marks can only be numbers with decimal commas."""
    found = False
    for _, line in lines:
        words, separator = split(line)
        numbers = [word for word in words if DECIMAL_COMMA.fullmatch(word)]
        if any("." in word and _number(word) is not None for word in words):
            return None
        if numbers and separator not in (";", "\t", '"'):
            return None
        found = found or not all(THOUSANDS.fullmatch(word) for word in numbers)
    return "comma" if found else None


def _row(path, number, words, separator, form, decimal):
    """The numbers of a line."""
    if decimal == "comma":
        words = [word.replace(",", ".") for word in words]
    try:
        return np.array([float(word) for word in words])
    except ValueError:
        values = [_number(word, form.missing) for word in words]
    if None in values:
        word = words[values.index(None)]
        if decimal != "comma" and _has_decimal_commas(words, separator):
            raise Error(f"{path}: line {number}: {short(word)} has a decimal comma: give --decimal comma")
        column = form.skip_columns + values.index(None) + 1
        raise Error(
            f"{path}: line {number}, column {column}: {short(repr(word))} is not a number; "
            "--skip-rows and --skip-columns skip text and other columns, --missing names a word of missing points"
        )
    return np.array(values, dtype=float)


def _is_header(words, decimal, missing=()):
    """Whether no word is a number, so that the line can only name something."""
    words = [word.replace(",", ".") for word in words] if decimal == "comma" else words
    return not any(_number(word, missing) is not None and word for word in words)


def _first_row(lines, form, decimal):
    """Place in a list of lines of the first one that is a row; all before it are a header.

    A line with a text and numbers, as "Profile 1", is a header where it has not as many words as most lines, or where a
    line of texts alone follows.
    """
    counts = [len(split(line, decimal)[0]) for _, line in lines]
    usual = max(set(counts), key=counts.count) if counts else 0
    for k, (_, line) in enumerate(lines):
        words, separator = split(line, decimal)
        if _is_header(words, decimal, form.missing) and not _has_decimal_commas(words, separator):
            continue
        texts = [word for word in words if word[:1].isalpha() and _number(word, form.missing) is None]
        after = _is_header(split(lines[k + 1][1], decimal)[0], decimal, form.missing) if k + 1 < len(lines) else False
        if not texts or counts[k] == usual and not after:
            return k
    return len(lines)


def _columns(values, words):
    """How many columns stand before the empty last ones, which separators at the end of every line make.

    words: of the last line, without those of columns that are skipped; an empty word is not one that stands for a
    missing point.
    """
    count = values.shape[1]
    while count > 1 and not words[count - values.shape[1] - 1] and np.all(np.isnan(values[:, count - 1])):
        count -= 1
    return count


class Text:
    """A text of numbers, whose file is read once, and whose header is looked for once.

    Parameters
    ----------
    path : path
        The file.
    form : Form
        How its words are read.
    """

    def __init__(self, path, form=Form()):  # noqa: B008 - it is never changed
        self.path, self.form = path, form
        self.empty_columns = 0  # the last ones, which are left out of the table once it is read

    @cached_property
    def lines(self):
        """All lines, the first of which has number 1."""
        return lines_of(_text(self.path))

    @cached_property
    def kept(self):
        """Numbers and contents of the lines that are not empty, skipped or comments."""
        return [
            (number, line)
            for number, line in enumerate(self.lines, 1)
            if number > self.form.skip_rows and line.strip() and not line.lstrip().startswith(COMMENTS)
        ]

    @cached_property
    def decimal(self):
        """The decimal sign, "point" or "comma"; None for a point that nothing states."""
        return self.form.decimal or _decimal(self.kept)

    @cached_property
    def before(self):
        """How many of the lines kept stand before the first row."""
        return _first_row(self.kept, self.form, self.decimal)

    @cached_property
    def table(self):
        """Values (rows, columns), NaN where one is missing; how many header lines; line of the first row."""
        rows, first = [], self.kept[self.before][0] if self.before < len(self.kept) else 0
        for number, line in self.kept[self.before :]:
            words, separator = split(line, self.decimal)
            row = _row(self.path, number, words[self.form.skip_columns :], separator, self.form, self.decimal)
            if rows and row.size != rows[0].size:
                raise Error(f"{self.path}: line {number} has {row.size} numbers, line {first} has {rows[0].size}")
            rows.append(row)
        if not rows:
            raise Error(f"{self.path}: contains no numbers")
        values = np.array(rows)
        columns = _columns(values, words)
        self.empty_columns = values.shape[1] - columns
        return values[:, :columns], self.before, first

    @cached_property
    def header(self):
        """Numbers and texts of the lines that are no rows of the map: skipped ones, comments, those before the rows."""
        before = {number for number, _ in self.kept[: self.before]}
        return [
            (number, line)
            for number, line in enumerate(self.lines, 1)
            if line.strip()
            and (number <= self.form.skip_rows or number in before or line.lstrip().startswith(COMMENTS))
        ]

    def empty_line(self):
        """The first empty line between rows of numbers, which may end a map; None without one, or where most rows have
        one between them."""
        first = self.table[2]
        full = [number for number, line in enumerate(self.lines, 1) if number >= first and line.strip()]
        before = [one for one, other in zip(full, full[1:]) if other > one + 1]
        return before[0] + 1 if 0 < len(before) < len(full) // 2 else None


class Table:
    """A text with a head: names of its columns with their units, and numbers.

    Parameters
    ----------
    path : path
        The file.
    known : mapping
        Names of columns, and what each is called here.
    row, kind : str
        What a line is for, and what lines are of, for messages.
    """

    def __init__(self, path, known, row, kind):
        self.path, self.kind, text = path, kind, Text(path)
        self.lines, self.decimal = text.kept, text.decimal
        if not self.lines:
            raise Error(f"{path}: is empty: give a head and a line per {row}")
        self.head, line = self.lines[0]
        self.columns, self.units, self.others = {}, {}, []
        words = split(line, self.decimal)[0]
        for k, word in enumerate(words):
            name, unit = HEAD.fullmatch(word).groups()
            other, name = name, known.get(" ".join(name.lower().split()))
            if name in self.columns:
                raise Error(f"{path}: line {self.head}: two columns are {name}: remove one")
            if name:
                self.columns[name], self.units[name] = k, unit or None
            else:
                self.others.append(other)
        self.count = len(words)

    def need(self, names, what):
        """Raises Error unless the columns are there."""
        lacking = [name for name in names if name not in self.columns]
        if lacking:
            raise Error(f"{self.path}: line {self.head}: has no column {', '.join(lacking)}: {what}")

    def unit(self, group, names):
        """The unit that the heads of these columns, of a group, state; None where they state none."""
        found = {self.units[name] for name in names if name in self.columns}
        if len(found) > 1:
            shown = ", ".join(sorted(short(one or "none") for one in found))
            raise Error(
                f"{self.path}: line {self.head}: its columns of {group} are in several units ({shown}): use one"
            )
        return found.pop() if found else None

    def rows(self):
        """The number of each line, and {name: (n,)} of the columns."""
        names, numbers, found = list(self.columns), [], []
        places = [self.columns[name] for name in names]
        for number, line in self.lines[1:]:
            words = split(line, self.decimal)[0]
            if len(words) != self.count:
                raise Error(
                    f"{self.path}: line {number} has {len(words)} words, line {self.head} has {self.count} heads"
                )
            found.append([self._number(number, names[k], words[place]) for k, place in enumerate(places)])
            numbers.append(number)
        if not found:
            raise Error(f"{self.path}: has a head, but no lines of {self.kind} below it")
        return numbers, dict(zip(names, np.array(found).T))

    def _number(self, line, name, word):
        try:
            value = float(word.replace(",", ".") if self.decimal == "comma" else word)
        except ValueError:
            value = np.nan
        if not np.isfinite(value) or "_" in word:
            shown = short(word) or "an empty word"
            raise Error(f"{self.path}: line {line}: {shown} in column {name} is no finite number: correct it")
        return value

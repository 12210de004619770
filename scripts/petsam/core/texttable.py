"""Tables in text files, of instruments, spreadsheets and other programs: the one reader of them.

A text has lines, the first of which has number 1; errors name the file and the line. A line that begins with the sign
of a comment is one; every other line that is not empty is a row: words between semicolons, tabs, commas or blanks, of
which those in quotation marks may have these within. A word is a text or a number, with a decimal point or, where
nothing else can be meant, a decimal comma; some words stand for a missing number.

A head is the row that names the columns, each with its unit: x [mm], fx (N), F / N, d_um, Weg in mm, or with the units
in the row below. Headed is a head and rows of as many words; Table is one whose words are numbers. Text.table is a map:
rows of as many numbers each, and before them a header, in which anything may stand.
"""

import csv
import re
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple, Optional

import numpy as np

from . import units
from .errors import Error, counted, short
from .files import text_of

COMMENTS = ("#", "%")  # of lines that never have numbers of the map
# missing points as instruments and spreadsheets write them
MISSING = {
    "", "nan", "na", "n/a", "bad", "null", "none", "-", "--", "***", "---", "#n/a", "#value!", "#num!", "#div/0!",
}  # fmt: skip
OF_MICROSOFT = re.compile(r"[+-]?1[.,]#(?:qnan|snan|ind|inf)\d*")  # as its C library prints no number
DECIMAL_COMMA = re.compile(r"[+-]?\d*,\d+(?:[eE][+-]?\d+)?")
THOUSANDS = re.compile(r"[+-]?[1-9]\d{0,2}(?:,\d{3})+")
QUOTED = re.compile(r'"[^"]*"')
BRACKETED = re.compile(r"(?P<name>.*?)[\s,:]*(?:\[(?P<a>[^\]]*)\]|\((?P<b>[^)]*)\)|\{(?P<c>[^}]*)\}|<(?P<d>[^>]*)>)")
DIVIDED = re.compile(r"(?P<name>.*?)\s*/\s*(?P<a>\S+)")
BEHIND = re.compile(r"(?P<name>.*?[^\s_,.:;-])(?:[\s_,.:;-]+in)?[\s_,.:;-]+(?P<a>[^\s_,.:;-]+)", re.IGNORECASE)
ENGLISH = ("in",)  # units that are words, too: not taken from a name


@dataclass(frozen=True)
class Form:
    """How the words of a text are read: all that it does not state."""

    decimal: Optional[str] = None  # "point" or "comma"; None: as the file shows where it can only be one of them
    skip_rows: int = 0
    skip_columns: int = 0
    missing: tuple = ()  # words of missing points, in small letters, beside the usual ones
    comments: tuple = COMMENTS
    behind: bool = False  # whether comments may stand behind words, too

    def number(self, word):
        """A word as a number, NaN for a missing point; None for another text."""
        return number_of(word, self.missing)

    def words(self, line):
        """The words of a line, whatever separates them."""
        return split(line, self.decimal)[0]

    @staticmethod
    def thousands(word):
        """True if the commas of a word may be those between thousands."""
        return THOUSANDS.fullmatch(word) is not None


def separator_of(line):
    """Returns the separator of the words of a line; None: white space."""
    line = QUOTED.sub("", line)
    return next((mark for mark in (";", "\t", ",") if mark in line), None)


def _has_decimal_commas(words, separator):
    """True if some of the words are numbers with a comma for a point."""
    return separator != "," and any(DECIMAL_COMMA.fullmatch(word) for word in words)


def split(line, decimal=None):
    """The words of a line, and their separator, which commas within quotation marks are not."""
    separator = separator_of(line.replace(",", "") if decimal == "comma" and '"' not in line else line)
    if '"' in line:
        try:
            words = words_of(line, separator)
        except ValueError:  # the quotation mark is a letter
            words = [word.strip() for word in line.split(separator)]
        return words, '"' if separator == "," and any(map(DECIMAL_COMMA.fullmatch, words)) else separator
    if separator == "," and all(DECIMAL_COMMA.fullmatch(word) for word in line.split()) and len(line.split()) > 1:
        separator = None  # 0,1 0,2 0,3
    return words_of(line, separator), separator


def words_of(line, separator):
    """The words of a line between these separators; ValueError of a quote that does not end on it."""
    if '"' not in line:
        return [word.strip() for word in line.split(separator)]
    reader = csv.reader([line.strip(), ""], delimiter=separator or " ", skipinitialspace=True)
    try:
        words = [word.strip() for word in next(reader)]
    except csv.Error as error:
        raise ValueError(error) from error
    if reader.line_num > 1:
        raise ValueError("a quote is not closed on its line")
    return words


def number_of(word, missing=()):
    """A word as a number, NaN for a missing point; None for another text."""
    small = word.lower()
    if small in MISSING or small in missing or OF_MICROSOFT.fullmatch(small):
        return np.nan
    try:
        return float(word) if word.isascii() and "_" not in word else None  # float() takes 1_000, and Arabic digits
    except ValueError:
        return None


def _decimal(rows):
    """ "comma" where numbers can only have decimal commas; rows: words, and whether no comma separates them."""
    found = False
    for words, sure in rows:
        numbers = [word for word in words if DECIMAL_COMMA.fullmatch(word)]
        if any("." in word and number_of(word) is not None for word in words):
            return None
        if numbers and not sure:
            return None
        found = found or not all(map(Form.thousands, numbers))
    return "comma" if found else None


def _row(path, number, words, separator, form, decimal):
    """The numbers of a line."""
    if decimal == "comma":
        words = [word.replace(",", ".") for word in words]
    try:
        if not any("_" in word for word in words):
            return np.array([float(word) for word in words])
    except ValueError:
        pass
    values = [form.number(word) for word in words]
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


def _is_header(words, decimal, form):
    """True if no word is a number, so that the line can only name something."""
    words = [word.replace(",", ".") for word in words] if decimal == "comma" else words
    return not any(form.number(word) is not None and word for word in words)


def _first_row(lines, form, decimal):
    """Place in a list of lines of the first one that is a row; all before it are a header.

    A line with a text and numbers, as "Profile 1", is a header where it has not as many words as most lines, or where a
    line of texts alone follows.
    """
    counts = [len(split(line, decimal)[0]) for _, line in lines]
    usual = max(set(counts), key=counts.count) if counts else 0
    for k, (_, line) in enumerate(lines):
        words, separator = split(line, decimal)
        if _is_header(words, decimal, form) and not _has_decimal_commas(words, separator):
            continue
        texts = [word for word in words if word[:1].isalpha() and form.number(word) is None]
        after = _is_header(split(lines[k + 1][1], decimal)[0], decimal, form) if k + 1 < len(lines) else False
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
    """The text of a file, or `text`, whose words are read by a Form; file and header are read once."""

    def __init__(self, path, form=Form(), text=None):  # noqa: B008 - it is never changed
        self.path, self.form, self._text = path, form, text
        self.empty_columns = 0  # the last ones, which are left out of the table once it is read

    @cached_property
    def lines(self):
        """All lines, the first of which has number 1."""
        return re.split(r"\r\n|\r|\n", text_of(self.path) if self._text is None else self._text)

    def is_comment(self, line):
        """True if a line is a comment."""
        return line.lstrip().startswith(self.form.comments)

    @cached_property
    def kept(self):
        """Numbers and contents of the lines that are not empty, skipped or comments."""
        lines = self.lines
        if self.form.behind:
            sign = re.compile("|".join(map(re.escape, self.form.comments)))
            lines = [sign.split(line)[0] for line in lines]
        return [
            (number, line)
            for number, line in enumerate(lines, 1)
            if number > self.form.skip_rows and line.strip() and not self.is_comment(line)
        ]

    @cached_property
    def every(self):
        """Number, contents and whether it is a comment, of the lines that have more than the sign of one; comments are
        without it, and without quotation marks."""
        signs, found = "".join(self.form.comments), []
        for number, line in enumerate(self.lines, 1):
            comment = self.is_comment(line)
            line = line.strip().lstrip(signs).replace('"', "").strip() if comment else line
            found += [(number, line, comment)] if line.strip() else []
        return found

    @cached_property
    def separator(self):
        """The separator of the words of most lines."""
        signs = [split(line)[1] for _, line in self.kept]
        usual = max(dict.fromkeys(signs), key=signs.count, default=None)
        return "," if usual == '"' else usual

    def heads(self, words, before=None):
        """The Heads of the words just above rows of numbers. Where these are units, names are in the row before,
        `before`; all are empty without one."""
        if are_units(words):
            return heads_of(self.path, before or [""] * len(words), words)
        return heads_of(self.path, words)

    def words(self, number, line, separator):
        """The words of a line between these separators."""
        try:
            return words_of(line, separator)
        except ValueError as error:
            raise Error(f"{self.path}: line {number}: {error}") from error

    def head(self, number, line, separator, width):
        """The words of a head above rows of so many words: where blanks separate them, names may have blanks, too, and
        are what two blanks or a bracket end."""
        words = self.words(number, line, separator)
        if separator is None and len(words) != width:
            for other in (re.split(r"\s{2,}", line.strip()), re.findall(r"[^\[({]*[\[({][^\])}]*[\])}]", line)):
                if len(other) == width:
                    return [word.strip() for word in other]
        return words

    def headed(self, row, kind, separators=None):
        """The text as a head and rows of as many words: see Headed."""
        return Headed(self, row, kind, separators)

    def rows(self, separator):
        """Numbers of the lines kept, and their words between these separators."""
        return [(number, self.words(number, line, separator)) for number, line in self.kept]

    @cached_property
    def decimal(self):
        """The decimal sign, "point" or "comma"; None for a point that nothing states."""
        rows = (split(line) for _, line in self.kept)
        return self.form.decimal or _decimal((words, separator in (";", "\t", '"')) for words, separator in rows)

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
            if line.strip() and (number <= self.form.skip_rows or number in before or self.is_comment(line))
        ]

    def empty_line(self):
        """The first empty line between rows of numbers, which may end a map; None without one, or where most rows have
        one between them."""
        first = self.table[2]
        full = [number for number, line in enumerate(self.lines, 1) if number >= first and line.strip()]
        before = [one for one, other in zip(full, full[1:]) if other > one + 1]
        return before[0] + 1 if 0 < len(before) < len(full) // 2 else None


class Head(NamedTuple):
    """The head of a column: its name, its unit as it is written or None, the whole word, and whether name and unit are
    one word: d_um."""

    name: str
    unit: Optional[str]
    word: str
    joined: bool = False

    @property
    def measure(self):
        """The unit of SI of its quantity, and the size of its unit, as of measure()."""
        return measure(self.unit)


def measure(unit):
    """The unit of SI of a unit's quantity, and its size; "" of a number without one, None of an unknown one."""
    unit = (unit or "").strip()
    if unit in ("", "-", "1"):
        return "", 1.0
    si = units.quantity(unit)
    return si, units.size(unit, si) if si else 1.0


def _in_brackets(found):
    return next(found[k].strip() for k in "abcd" if found[k] is not None)


def bare(word):
    """A unit without quotation marks and brackets around it."""
    word = word.strip().strip('"').strip()
    found = BRACKETED.fullmatch(word)
    return _in_brackets(found) if found and not found["name"] else word


def _is_unit(word):
    """True if a word is a unit, or a ratio of two, or is in brackets."""
    word, unit = word.strip(), bare(word)
    ratio = unit.count("/") == 1 and all(measure(part)[0] for part in unit.split("/"))
    return measure(unit)[0] is not None or ratio or word[:1] in ("[", "(", "{", "<") and word[-1] in "])}>"


def are_units(words):
    """True if all words are units, in brackets or not, and one of them is known."""
    return any(measure(bare(word))[0] for word in words) and all(map(_is_unit, words))


def head_of(word):
    """The Head of a word."""
    word = word.strip().strip('"').strip()
    found = BRACKETED.fullmatch(word)
    if found:
        return Head(found["name"].strip(), _in_brackets(found), word)
    found = DIVIDED.fullmatch(word)
    if found:
        before = re.split(r"[\s_]+", found["name"])[-1]
        if measure(before)[0] and (before != found["name"] or not measure(found["a"])[0]):  # Q N/mm
            return Head(found["name"][: -len(before)].strip(" _") or word, f"{before}/{found['a']}", word)
        return Head(found["name"] or word, found["a"], word)
    found = BEHIND.fullmatch(word)
    if found and found["a"] not in ENGLISH and measure(found["a"])[0]:
        return Head(found["name"], found["a"], word, joined=True)
    return Head(word, None, word)


def heads_of(path, words, below=None):
    """The Heads of words, and of those of the row of units below them where there is one."""
    found = [head_of(word) for word in words]
    for k, text in enumerate(below or ()):
        if not text.strip():
            continue
        one, unit = found[k], bare(text)
        stated = one.unit is not None and not one.joined
        if stated and measure(one.unit)[0] and measure(one.unit) != measure(unit):
            raise Error(f"{path}: column {short(one.word)}: the line below states {short(unit)}: remove one")
        found[k] = Head(one.name if stated else one.word, unit, one.word)
    return found


class Headed:
    """A head (`words`, in the line `head`), and rows of as many words. Messages name a row's purpose, `row`, and the
    content of rows, `kind`. `separators` may separate the words, the last one where the head has none; None for any, or
    blanks."""

    def __init__(self, text, row, kind, separators=None):
        self.path, self.kind, self.text = text.path, kind, text
        if not self.text.kept:
            raise Error(f"{self.path}: is empty: give a head and a line per {row}")
        self.head, line = self.text.kept[0]
        separator = separator_of(line)
        if separators and separator not in separators:
            separator = separators[-1]
        (_, self.words), *self._rows = self.text.rows(separator)
        if self._rows:
            self.words = self.text.head(self.head, line, separator, len(self._rows[0][1]))

    @cached_property
    def decimal(self):
        """The decimal sign, "point" or "comma"; None for a point that nothing states."""
        return self.text.form.decimal or _decimal((words, True) for _, words in self._rows)

    @cached_property
    def body(self):
        """Number and words of each row below the head."""
        for number, words in self._rows:
            if len(words) != len(self.words):
                here, above = counted(len(words), "word"), counted(len(self.words), "head")
                raise Error(f"{self.path}: line {number} has {here}, line {self.head} has {above}")
        if not self._rows:
            raise Error(f"{self.path}: has a head, but no lines of {self.kind} below it")
        return self._rows


class Table(Headed):
    """A head of names with their units, and numbers: the place and the unit or None of each column, and `others`, heads
    that are not known. `known` has the names of columns and their names here; with None each has the name of its
    head."""

    def __init__(self, path, known, row, kind):
        super().__init__(Text(path), row, kind)
        below = self._rows[0][1] if self._rows else []
        below = self._rows.pop(0)[1] if len(below) == len(self.words) and are_units(below) else None
        self.columns, self.units, self.others = {}, {}, []
        for k, one in enumerate(heads_of(path, self.words, below)):
            name, unit = one.name, one.unit
            if known is not None:
                whole = name != one.word and _plain(one.word) in known  # what looks like a unit is of the name
                name, unit = known.get(_plain(one.word if whole else name)), None if whole else unit
            if name in self.columns:
                raise Error(f"{path}: line {self.head}: two columns are {name}: remove one")
            if name:
                self.columns[name], self.units[name] = k, unit
            else:
                self.others.append(one.name if one.name and measure(one.unit)[0] is not None else one.word)

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
        values = [[self._number(*row, *column) for column in self.columns.items()] for row in self.body]
        return [number for number, _ in self.body], dict(zip(self.columns, np.array(values).T))

    def _number(self, line, words, name, place):
        word = words[place]
        value = number_of(word.replace(",", ".") if self.decimal == "comma" else word)
        if value is None or not np.isfinite(value):
            shown = short(word) or "an empty word"
            cure = "write it with a decimal point" if DECIMAL_COMMA.fullmatch(word) else "correct it"
            raise Error(f"{self.path}: line {line}: {shown} in column {name} is no finite number: {cure}")
        return value


def _plain(name):
    """A name in small letters, with single blanks."""
    return " ".join(name.lower().split())

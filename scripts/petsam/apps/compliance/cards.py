"""The cards of a deck (.inp): keywords with their parameters and data lines, and the numbers in these."""

import os
from dataclasses import dataclass, field

import numpy as np

from ...core.errors import Error, short
from ...core.files import text_of

DEPTH = 10  # depth of files that include files
FILES = 1000  # number of included files
LARGEST = 2**62  # label of a node or element


class Line(list):
    """The words of a data line, with the file and the line where they are."""

    __slots__ = ("number", "path")

    def __init__(self, words, path, number):
        super().__init__(words)
        self.path, self.number = path, number

    @property
    def place(self):
        """The place for messages."""
        return f"{self.path}:{self.number}"

    def with_words(self, words):
        """Other words in the same place."""
        return Line(words, self.path, self.number)


def trimmed(line):
    """The words of a data line without empty ones at its end."""
    count = len(line)
    while count and not line[count - 1]:
        count -= 1
    return line.with_words(line[:count])


@dataclass
class Card:
    """A keyword with its parameters and data lines."""

    name: str
    parameters: dict
    place: str
    lines: list = field(default_factory=list)

    def need(self, name):
        """Returns a parameter that must exist."""
        if not self.parameters.get(name):
            raise Error(f"{self.place}: *{self.name} has no {name}=: give it")
        return self.parameters[name]


class Cards:
    """Gathers the cards of a deck, with included files in their places."""

    def __init__(self, path):
        self.found, self.files, self.quoted = [], 0, {}
        self._read(path, text_of(path), [])

    def _read(self, path, text, outer):
        """Reads the text of a file, which the files `outer` include."""
        lines = [(number, line.strip()) for number, line in enumerate(text.split("\n"), 1)]
        lines = iter([(number, line) for number, line in lines if line and not line.startswith("**")])
        for number, line in lines:
            if line.startswith("*"):
                while line.endswith(","):  # the keyword goes on in the next line
                    more = next(lines, (0, "*"))[1]
                    if not more[:1].isalpha():
                        raise Error(
                            f"{path}:{number}: the keyword ends with a comma, but no parameter follows: remove it"
                        )
                    line += more
                self._take(line, path, number, outer)
            elif self.found:
                words = [word.strip().strip('"') for word in line.split(",")]
                self.found[-1].lines.append(Line(words, path, number))
            else:
                raise Error(f"{path}:{number}: {short(line)} stands before the first keyword: begin with one, as *NODE")

    def _take(self, line, path, number, outer):
        """Adds the card of a keyword line, or the cards of the file that it includes."""
        name, *words = [word.strip() for word in line[1:].split(",")]
        place = f"{path}:{number}"
        parameters = {}
        for key, _, value in (word.partition("=") for word in words if word):
            key, value = " ".join(key.upper().split()), value.strip()
            if key in parameters:
                raise Error(f"{place}: {short(key)} is given twice: remove one")
            parameters[key] = self._unquoted(value, place)
        card = Card(" ".join(name.upper().split()), parameters, place)
        if card.name == "INCLUDE":
            self._include(card, path, outer)
        else:
            self.found.append(card)

    def _unquoted(self, value, place):
        """A value without quotation marks, in which case counts: such names are one here, if they differ in it only."""
        if not value.startswith('"'):
            return value
        value = value.strip('"')
        if self.quoted.setdefault(value.upper(), value) != value:
            raise Error(
                f'{place}: "{short(value)}" and "{short(self.quoted[value.upper()])}" differ in case only, which is '
                "not supported: rename one"
            )
        return value

    def _include(self, card, path, outer):
        """Reads the file that *INCLUDE names."""
        if len(card.parameters) > 1:
            other = next(name for name in card.parameters if name != "INPUT")
            raise Error(f"{card.place}: {short(other)} of *INCLUDE is not supported: remove it")
        chain = [*outer, path]
        inner = _found(card, chain)
        self.files += 1
        try:
            if os.path.realpath(inner) in map(os.path.realpath, chain):
                raise Error(f"{inner}: decks include each other: remove this card")
            if len(chain) > DEPTH or self.files > FILES:
                raise Error(f"{inner}: limits {DEPTH} files deep, {FILES} in all: write them into one file")
            text = text_of(inner)
        except (Error, OSError) as error:
            text = str(error) if isinstance(error, Error) else f"{inner}: {error.strerror or error}"
            raise Error(f"{card.place}: *INCLUDE: {text}") from error
        self._read(inner, text, chain)


def _found(card, chain):
    """The file that a card *INCLUDE of the last of these files names: beside this file, or beside the first one, which
    is where Abaqus and CalculiX look for it; raises Error if both places have one."""
    inner, first = (os.path.join(os.path.dirname(path), card.need("INPUT")) for path in (chain[-1], chain[0]))
    if not os.path.exists(first):
        return inner
    if os.path.exists(inner) and not os.path.samefile(inner, first):
        raise Error(f"{card.place}: *INCLUDE: {inner} and {first} both exist: rename one, or give its whole path")
    return first


def read_cards(path):
    """Returns the deck's cards, with included files in their places."""
    return Cards(path).found


def number_of(card, word, kind=float, line=None):
    """The number of a word of a card, which must be one; line: its data line."""
    place = line.place if line is not None else card.place
    try:
        number = kind(word.replace("D", "E").replace("d", "e") if kind is float else word)
        if "_" in word or not word.isascii():
            raise ValueError
    except ValueError:
        what = "integer" if kind is int else "number"
        raise Error(f"{place}: {short(word) or 'an empty word'} in *{card.name} is no {what}: correct it") from None
    if kind is float and not np.isfinite(number):
        raise Error(f"{place}: {short(word)} in *{card.name} is not finite: correct it")
    if kind is int and abs(number) >= LARGEST:
        raise Error(f"{place}: {short(word)} in *{card.name} is too large, limit {LARGEST:g}: number from 1")
    return number

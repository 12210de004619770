"""Errors that the commands report in one line: their message contains all that a user needs."""

import errno
import importlib
import os
import sys

USAGE, FILE, UNSETTLED, UNBALANCED, EDGE = 2, 3, 10, 11, 12  # exit codes, as in petsam
LINE, PART = 4000, 80  # maximum characters of a message, and of a part of one that comes from a file


class Error(Exception):
    """A file or value that cannot be read, found or understood; lines of an example are printed below the message.

    code is the exit code of a command that ends with it.
    """

    code = FILE
    example = ()


class Unusable(Error):
    """An option or a value that cannot be used, has no effect, or leaves nothing: bad usage."""

    code = USAGE


class WrongArgument(Unusable, TypeError, ValueError):
    """An argument that a function cannot use; it is a TypeError and a ValueError, too, as functions of Python raise."""


class Missing(Error):
    """A missing file, program or library."""


class MissingFile(Missing, FileNotFoundError):
    """A missing file, which is a FileNotFoundError, too.

    Parameters
    ----------
    path : path
        The file.

    Attributes
    ----------
    filename : str
        The file.
    """

    code = FILE

    def __init__(self, path: str) -> None:
        super().__init__(errno.ENOENT, "no such file", os.fspath(path))

    def __str__(self):
        return f"{self.filename}: {self.strerror}"

    def __reduce__(self):
        return type(self), (self.filename,)


def library(name, read=None):
    """A library, or a module of it, that few need; Missing says how it is installed, and what is read by it."""
    try:
        return importlib.import_module(name)
    except ImportError as error:
        package = name.partition(".")[0]
        lacks = f"{name} is not installed"
        if read:
            lacks = f"{read} is read by the library {package}, which {sys.executable} has not ({error})"
        raise Missing(f"{lacks}: {sys.executable} -m pip install {package}") from error


def short(text, most=PART):
    """Returns a text, or a part of a message that comes from a file, without line breaks and characters that a terminal
    cannot show; one with more characters than `most` is cut."""
    text = str(text)
    if len(text) > most:
        half = (most - 5) // 2
        text = text[:half] + " ... " + text[-half:]
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode("ascii") for c in text)


def counted(count, noun):
    """A number with its noun, such as 1 case, 2 cases."""
    return f"{count} {noun}" + "s" * (count != 1)


def slips(tried, name):
    """Number of letters omitted, inserted, changed, or swapped with the next one, between two words."""
    before, last = [], [*range(len(name) + 1)]
    for i, one in enumerate(tried):
        row = [i + 1]
        for j, other in enumerate(name):
            row.append(min(last[j] + (one != other), last[j + 1] + 1, row[j] + 1))
            if i and j and one == name[j - 1] and tried[i - 1] == other:
                row[-1] = min(row[-1], before[j - 1] + 1)
        before, last = last, row
    return last[-1]


def _within(word, name):
    """True if a name has all letters of a word in their order, so that only some are missing."""
    left = iter(name)
    return all(letter in left for letter in word)


def nearest(tried, names):
    """Returns the name of which a word may be a misspelling, in a list; an empty one if none is near.

    A word of less than 3 letters has no slips, one of less than 5 has 1, of less than 10 up to 2, a longer one up to 3.
    The beginning of a single name, of 3 letters or more, is near, too. Of
    equally near names one of which letters are missing goes first. Case does not count, and - is as _.
    """

    def plain(word):
        return str(word).lower().replace("-", "_")

    length = len(str(tried))
    most = 0 if length < 3 else 1 if length < 5 else 2 if length < 10 else 3
    near = [
        (slips(plain(tried), plain(name)), not _within(plain(tried), plain(name)), k)
        for k, name in enumerate(names)
        if abs(len(name) - length) <= most
    ]
    least = min(near, default=(most + 1, False, 0))
    begun = [name for name in names if length > 2 and plain(name).startswith(plain(tried))]
    return [names[least[2]]] if least[0] <= most else begun if len(begun) == 1 else []


def there_are(tried, names, there="there are"):
    """Returns the end of a message about an unknown name: a similar name, if there is one, and all names."""
    names, tried = list(names), str(tried)
    near = nearest(tried, names) or [name for name in names if tried in name.split("_")][:3]
    have = f"{there} {', '.join(names)}" if names else f"{there} none"
    return f": is {' or '.join(near)} meant? {have[0].upper() + have[1:]}" if near else f"; {have}"

"""Options of the program as words of a command line, from names and values of Python."""

import os

import numpy as np

from .errors import Error, short

SWITCHES = {"errors": ("closed", "companion")}  # words that False and True stand for


class OptionError(Error, TypeError, ValueError):
    """An option whose name or value cannot be written on a command line."""


def one_case(names, where=""):
    """Raises OptionError for names that differ in the case of their letters only, which the program takes for one."""
    seen = {}
    for name in names:
        first = seen.setdefault(str(name).lower(), name)
        if first != name:
            raise OptionError(f"{where}{short(first)} and {short(name)} are one name to petsam: remove one of them")


def words(options):
    """Returns words -NAME and VALUE of options without the dash: {name: value}.

    A value is a number, a text, True or False, a path, or a sequence of numbers or texts; None leaves the option out.
    """
    found = []
    one_case(name for name, value in options.items() if value is not None)
    for name, value in options.items():
        if not isinstance(name, str) or not name.replace("_", "").isalnum():
            raise OptionError(f"{short(repr(name))} is no name of an option: give it without a dash, as grid_n")
        if value is not None:
            found += ["-" + name, _value(name, value)]
    return found


def line(options):
    """Returns the words as one line, in which those with blanks are in quotation marks."""
    return " ".join(_quoted(word) for word in words(options))


def _value(name, value):
    dimensions = 0 if isinstance(value, os.PathLike) else _dimensions(value)
    if dimensions > 1:
        raise OptionError(f"{name}: expected one value or a sequence of them, not an array of {dimensions} dimensions")
    return ",".join(_word(name, one) for one in value) if dimensions else _word(name, value)


def _dimensions(value):
    try:
        return np.ndim(value)
    except ValueError:  # rows of different lengths
        return 2


def _word(name, value):
    if isinstance(value, np.ndarray) and value.ndim == 0:
        value = value[()]
    if isinstance(value, (bool, np.bool_)):
        return SWITCHES.get(name, ("false", "true"))[bool(value)]
    if isinstance(value, (int, np.integer)):
        return str(int(value))
    if isinstance(value, (str, os.PathLike)):
        text = os.fspath(value)
        if isinstance(text, str) and "\0" not in text:
            return text
    elif hasattr(value, "__float__"):
        return repr(float(value))
    cure = ": write it to a file by its write(), and give that name" if hasattr(value, "write") else ""
    raise OptionError(f"{name}: {short(repr(value))} is neither a number nor a text{cure}")


def _quoted(word):
    if '"' in word:
        raise OptionError(f"{short(word)}: a value cannot hold a quotation mark")
    return f'"{word}"' if any(c.isspace() for c in word) else word

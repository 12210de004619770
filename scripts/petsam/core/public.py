"""Public functions and classes: short signatures, and an Error for arguments of a wrong kind, missing or unknown ones.

The public list of a part gives its functions and classes by public(), classes with their methods, and so are the
classes of what these functions return. An argument is checked by its hint where that is of numbers, arrays of numbers,
texts, functions or classes of the package, and where the function itself has no Error for it; values that have no such
hint, and ranges, are the function's own affair. The message has the meaning of the argument by the docstring.
"""

import dataclasses
import functools
import inspect
import os
import re
import sys
import typing
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Optional

import numpy as np
from numpy.typing import ArrayLike

from . import arrays, keywords, units, words
from .errors import Error, WrongArgument, short, there_are

LONG = 160  # characters of a signature with its hints: beyond it they are left to the docstring
LARGE = 40  # and of a default
# warnings name the line of a call by its depth, and leave out frames with this name of a file
FRAME = "<importlib._bootstrap of petsam>"
TEXTS = (str, os.PathLike)
RAW = (TypeError, ValueError, AttributeError, IndexError, KeyError)  # errors that say nothing of arguments
_made: dict[Any, Any] = {}


class _Short:
    """A default that is too long for a signature."""

    def __repr__(self):
        return "..."


def public(found: Any) -> Any:
    """Returns a function, or a class whose objects users make, that checks its arguments; others as they are."""
    if not inspect.isfunction(found) and (not inspect.isclass(found) or issubclass(found, BaseException)):
        return found
    if found in _made:
        return _made[found]
    made = found
    if inspect.isclass(found):
        if "__init__" in vars(found) or not issubclass(found, (dict, list)):  # these have no signature of their own
            _show(found, inspect.signature(found))
        if "__init__" in vars(found) and "Parameters" in keywords.sections(found.__doc__)[1]:
            found.__init__ = _checked(found.__init__, found.__name__, found.__doc__)
        for kind in found.__mro__:
            if kind.__module__.startswith("petsam."):
                _check_methods(kind)
    else:
        made = _checked(found, found.__name__, found.__doc__)
        _show(made, inspect.signature(found))
        if getattr(sys.modules[found.__module__], found.__name__, None) is found:
            setattr(sys.modules[found.__module__], found.__name__, made)
    _made[found] = _made[made] = made
    return made


def _check_methods(kind):
    """Makes the methods of a class, without a leading underscore, check their arguments."""
    for name, one in list(vars(kind).items()):
        binding = type(one) if isinstance(one, (classmethod, staticmethod)) else None
        function = one.__func__ if binding else one
        if name.startswith("_") or not inspect.isfunction(function) or function in _made:
            continue
        made = _checked(function, f"{kind.__name__}.{name}", function.__doc__, None if binding else kind)
        _made[function] = _made[made] = made
        setattr(kind, name, binding(made) if binding else made)


def _show(found, signature):
    """Leaves the hints of a long signature, and long defaults, to the docstring."""
    if len(str(signature)) > LONG:
        plain = [
            one.replace(annotation=one.empty, default=_Short() if len(repr(one.default)) > LARGE else one.default)
            if one.default is not one.empty
            else one.replace(annotation=one.empty)
            for one in signature.parameters.values()
        ]
        found.__signature__ = signature.replace(parameters=plain, return_annotation=signature.empty)


def _checked(function, owner, text, kind=None):
    """The function with a check of its arguments: its own errors of it go first, and objects that were given texts are
    checked once they are made. `kind`: the class of a method, whose first argument is an object of it."""
    call = _Call(function, owner, text, kind)

    @functools.wraps(function)
    def checked(*args: Any, **given: Any) -> Any:
        __tracebackhide__ = True
        try:
            found = function(*args, **given)
        except (Error, *RAW) as error:
            said = call.fault(error, args, given)
            if said is None:
                raise
            raise WrongArgument(said) from error
        texts = [value for value in (*args, *given.values()) if isinstance(value, (str, bytes))]
        if function.__name__ == "__init__" and texts and (one := call.wrong(args, given)):
            raise WrongArgument(one[1])
        if type(found).__module__.startswith("petsam."):
            public(type(found))
        return found

    checked.__code__ = checked.__code__.replace(co_filename=FRAME)
    return checked


class _Call:
    """The arguments of a function with their kinds by their hints, and messages about those of a call."""

    def __init__(self, function, owner, text, kind):
        self.name, self.text, self.signature, self.kind = owner, text, inspect.signature(function), kind
        several = (inspect.Parameter.VAR_POSITIONAL, inspect.Parameter.VAR_KEYWORD)
        single = {name: one for name, one in self.signature.parameters.items() if one.kind not in several}
        home = vars(sys.modules[function.__module__])
        hints = {name: _hint(one.annotation, home) for name, one in single.items()}
        if kind and single:
            hints[next(iter(single))] = kind
        self.kinds = {name: good for name, good in ((name, _kind(hint)) for name, hint in hints.items()) if good}

    def wrong(self, args, given):
        """The name of an argument of a wrong kind and the message about it; None: there is none."""
        values = self.signature.bind(*args, **given).arguments
        for name, value in values.items():
            kind = self.kinds.get(name)
            if kind and not kind[0](value) and value is not self.signature.parameters[name].default:
                return name, _message(self.owner(args), name, value, kind[1], self.text)
        return None

    def fault(self, error, args, given):
        """The message about the arguments of a call that has ended with an error; None where that says it."""
        own = isinstance(error, Error)
        try:
            one = self.wrong(args, given)
        except TypeError:
            return None if own else self._unfit(self.owner(args), error)
        return None if not one or own and (one[0] in str(error) or "number" not in one[1]) else one[1]

    def owner(self, args):
        """The name of the function, of a method with the class of its object."""
        if self.kind and args and isinstance(args[0], self.kind):
            return f"{type(args[0]).__name__}.{self.name.rpartition('.')[2]}"
        return self.name

    def _unfit(self, owner, error):
        """The message about a call that lacks arguments, or has unknown ones or too many."""
        said, names = str(error).rpartition("() ")[2], re.findall(r"'(\w+)'", str(error))
        shown = [name for name in self.signature.parameters if name != "self"]
        if "self" in names:
            cure = ": call it as a method of an object"
        elif names and names[0] in shown:
            meant = ((name, _about(_meaning(name, self.text))) for name in names)
            cure = ": give " + ", ".join(f"{name} ({about})" if about else name for name, about in meant)
        else:
            cure = there_are(names[0] if names else "", shown, "its arguments are")
        return f"{owner}: {said}{cure}"


def _hint(hint, home):
    """Returns the type of a hint; Any if it cannot be found."""
    if not isinstance(hint, str):
        return hint
    fields = [vars(sys.modules[kind.__module__]) for kind in home.values() if dataclasses.is_dataclass(kind)]
    for names in (home, *fields):
        try:
            return eval(hint, dict(names))  # of the package's own source
        except Exception:
            continue
    return Any


def _article(name):
    return "an" if name[0] in "AEIOU" else "a"


def _kind(hint: Any) -> Optional[tuple[Callable[[Any], bool], str]]:
    """A check of values by their hint, and its kind in words; None where nothing is checked."""
    origin, parts = typing.get_origin(hint), typing.get_args(hint)
    if hint == ArrayLike:
        return _numeric, "a number or an array of numbers"
    if hint in (float, int):
        return _real, "a number" if hint is float else "a whole number"
    if hint is np.ndarray:
        return _numeric, "an array of numbers"
    if Mapping in (hint, origin) or origin is dict:
        return lambda value: isinstance(value, Mapping), "a mapping of names and values"
    if inspect.isclass(hint) and (hint in TEXTS or hint.__module__.startswith("petsam.")) and origin is None:
        names: dict[Any, str] = {str: "a text", os.PathLike: "a path"}
        name = names.get(hint, f"{_article(hint.__name__)} {hint.__name__} of petsam")
        taken = (str, os.PathLike) if hint is str else hint
        return lambda value: isinstance(value, taken), name
    if origin is typing.Union or str(origin) == "<class 'types.UnionType'>":
        return _either([_kind(part) for part in parts if part is not type(None)], type(None) in parts)
    if origin in (tuple, Sequence, list) and parts and {*parts} <= {float, int, Ellipsis}:
        count = 0 if Ellipsis in parts or origin is not tuple else len(parts)
        return lambda value: _several(value, count), f"{count or 'several'} numbers"
    return None


def _either(kinds, empty):
    """A check by one of several kinds."""
    if None in kinds:
        return None
    names = " or ".join(dict.fromkeys(name for _, name in kinds))
    return lambda value: empty and value is None or any(good(value) for good, _ in kinds), names


def _real(value):
    """True of a number, and of what a library takes for one."""
    return hasattr(value, "__float__") or hasattr(value, "__index__")


def _numeric(value):
    """True of a number and of an array of numbers."""
    if isinstance(value, np.ndarray):
        return value.dtype.kind in "biufcO"
    if not isinstance(value, (str, bytes, list, tuple)):
        return value is not None
    try:
        arrays.real(value)
    except (TypeError, ValueError):
        return False
    return not isinstance(value, (str, bytes)) and not any(isinstance(one, str) for one in value)


def _several(value, count):
    """True of so many numbers; 0: of any number."""
    return _numeric(value) and hasattr(value, "__len__") and (not count or len(value) == count)


def _meaning(name, text):
    """The meaning of an argument by a docstring; empty where it has none."""
    entry = keywords.entries(keywords.sections(text)[1].get("Parameters", "")).get(name, "")
    return " ".join(entry.partition("\n")[2].split())


def _about(meaning):
    """The first sentence of a meaning."""
    return meaning.partition(". ")[0].rstrip(".")


def _message(owner, name, value, kind, text):
    """Names the argument, what was given, and its meaning by the docstring, and how a text is written."""
    meaning = _meaning(name, text)
    about = _about(meaning)
    cure = _cure(name, value, meaning)
    return f"{owner}: {name} {short(repr(value))}: expected {kind}{f' ({about})' if about else ''}{cure}"


def _cure(name, value, meaning):
    """How a text that is a number with its unit is written, in the unit that its meaning names."""
    given = value if isinstance(value, (tuple, list)) else [value]
    try:
        found = [_written(one, meaning) for one in given]
    except Error:
        return ""
    if None in found or not any(isinstance(one, str) for one in given):
        return ""
    return f": write {name}=" + (f"({', '.join(found)})" if given is value else found[0])


def _written(value, meaning):
    """A number, or a text that is one, as it is written in Python; None of one in a unit of another quantity."""
    if not isinstance(value, str):
        return repr(value)
    found = words.measured(value, "a number", 1)
    number, unit = found[0], found.unit
    if not unit:
        return f"{number:.12g}"
    sizes = [units.size(word, unit) for word in re.findall(r"[^\W\d_][\w/^]*", meaning)]
    size = next((size for size in sizes if size), None)
    return f"{number / size:.12g}" if size else None

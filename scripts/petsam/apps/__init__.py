"""The applications: what engineers do with contacts. Each is a folder, and nothing outside of it names it.

A folder has __init__.py with its record (core/part.py), and whichever it needs of command.py, pictures.py, report.py
and the modules that compute. It uses the storeys below (scripts/README.md), and of another application its public list
only. petsam.joint is petsam.apps.joint, and the program petsam-joint its command.
"""

import importlib
import pkgutil
import warnings
from functools import cache

from ..core.part import Part

OWN = ("names", "records")  # functions here, whose names no application can have


def names() -> list[str]:
    """Returns the names of all applications: those of their folders."""
    found = [module.name for module in pkgutil.iter_modules(__path__) if module.ispkg]
    return sorted(name for name in found if name.isidentifier() and name not in OWN)


def records() -> list[Part]:
    """Returns the records of all applications; one that has none, or a wrong one, is left out with a warning."""
    return list(_records(tuple(names())))


@cache
def _records(names):
    plot = importlib.import_module("..plot", __name__)
    known = {*plot.PART.listed, *(module.name for module in pkgutil.iter_modules(plot.__path__))}
    found = []
    for name in names:
        try:
            found.append(_checked(importlib.import_module("." + name, __name__).PART, found, known))
        except Exception as error:
            text = f"petsam.apps.{name} is left out: {type(error).__name__}: {error}"
            warnings.warn(text, RuntimeWarning, stacklevel=3)
    return tuple(found)


def _checked(record, others, known):
    """The record, if it states what is there, and nothing that another one or `known`, what plot has, stands for."""
    pictures = [name for names in record.pictures.values() for name in names]
    tables = [*record.columns, *(column for one in others for column in one.columns)]
    functions = [name for names in record.expressions.values() for name in names]
    called = {name for one in others for names in one.expressions.values() for name in names}
    taken = {
        "top": [name for name in record.top if name not in record.listed],
        "tables": [
            *(name for name in record.tables if name not in record.listed),
            *(column for column in record.columns if tables.count(column) > 1),
        ],
        "expressions": [name for name in functions if name in called],
        "pictures": [name for name in pictures if name in known or any(one.pictured(name) for one in others)],
    }
    for field, wrong in taken.items():
        if wrong:
            raise ValueError(f"{field} of its record: {', '.join(wrong)}: is not in its list, or has another meaning")
    return record


def __getattr__(name):
    if name in names():
        return importlib.import_module("." + name, __name__)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__():
    return [*names(), *OWN]

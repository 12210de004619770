"""The applications: what engineers do with contacts. Each is a folder, and nothing outside of it names it.

A folder has __init__.py with its record (core/part.py), and whichever it needs of command.py, pictures.py, report.py
and the modules that compute. It uses the storeys below (scripts/README.md), and of another application its public list
only. petsam.joint is petsam.apps.joint, and the program petsam-joint its command.
"""

import importlib
import pkgutil

from ..core.part import Part


def names() -> list[str]:
    """Returns the names of all applications: those of their folders."""
    return sorted(module.name for module in pkgutil.iter_modules(__path__) if module.ispkg)


def records() -> list[Part]:
    """Returns the records of all applications."""
    return [importlib.import_module("." + name, __name__).PART for name in names()]


def __getattr__(name):
    if name in names():
        return importlib.import_module("." + name, __name__)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__():
    return [*names(), "names", "records"]

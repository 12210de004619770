"""The record of a part of the package: what it is for, its names, its command, its pictures.

A part is a package that users know by its name, as petsam.plot or petsam.joint. Its __init__.py has its record, and
imports nothing that needs a library; modules are imported when one of their names is first used:

    PART = Part(__name__, names={"structure": ("Patch", "Structure")})
    __all__, __getattr__, __dir__ = PART.face()

Launchers, man pages, completion, the tables that petsam-plot reads, pictures, reports and the reference of the package
follow from the records.
"""

import importlib
import importlib.util
import sys
from collections.abc import Callable, Mapping
from types import ModuleType
from typing import Any, NamedTuple


def _public(found):
    """Returns the object of a name, with a check of its arguments, which needs libraries."""
    from .public import public

    return public(found)


class Part(NamedTuple):
    """The record of a part."""

    package: str  # its name in Python: __name__
    names: Mapping[str, tuple[str, ...]] = {}  # what users call, by module; of an empty name modules themselves
    top: tuple[str, ...] = ()  # of these the names that petsam itself has, too
    quiet: bool = False  # the program hides warnings of numbers that overflow and of letters that a font lacks
    libraries: tuple[str, ...] = ("numpy", "h5py", "matplotlib")  # that the program needs
    see: tuple[str, ...] = ("petsam", "petsam-plot")  # programs that its man page names
    pictures: Mapping[str, tuple[str, ...]] = {}  # functions that petsam.plot has, by module
    report: str = ""  # module with contents(found) of pages, where the usual ones of plot/founds.py lack something
    expressions: Mapping[str, tuple[str, ...]] = {}  # functions of numbers in the tables of petsam-study, by module
    tables: Mapping[str, tuple[str, ...]] = {}  # first columns of CSV files, by the function or class that read them

    @property
    def name(self) -> str:
        """The part's name, as users know it: petsam.NAME."""
        return self.package.rpartition(".")[2]

    @property
    def about(self) -> str:
        """Its purpose, which is the first line of its docstring."""
        return (sys.modules[self.package].__doc__ or "").partition("\n")[0].rstrip(".")

    @property
    def command(self) -> str:
        """The program, petsam-NAME, whose main() is in command.py: it returns the exit code, or None for 0; empty where
        there is none."""
        return f"petsam-{self.name}" if importlib.util.find_spec(f"{self.package}.command") else ""

    @property
    def listed(self) -> list[str]:
        """The public list."""
        return sorted(name for names in self.names.values() for name in names)

    @property
    def columns(self) -> list[str]:
        """The first columns of its tables."""
        return [column for columns in self.tables.values() for column in columns]

    def module(self, name: str) -> ModuleType:
        """Imports a module of the part."""
        return importlib.import_module("." + name, self.package)

    def find(self, name: str) -> Any:
        """Returns what a name of the public list stands for."""
        for module, names in self.names.items():
            if name in names:
                return _public(getattr(self.module(module), name)) if module else self.module(name)
        raise AttributeError(f"module {self.package!r} has no attribute {name!r}")

    def pictured(self, name: str) -> bool:
        """Returns whether the part has a picture of this name."""
        return any(name in names for names in self.pictures.values())

    def picture(self, name: str) -> Any:
        """Returns a picture; None of a name that is none."""
        home = next((module for module, names in self.pictures.items() if name in names), None)
        return _public(getattr(self.module(home), name)) if home else None

    def reader(self, column: str) -> Any:
        """Returns the function that reads a table by the name of its first column; None of one that is unknown."""
        home = next((name for name, columns in self.tables.items() if column in columns), None)
        return getattr(self.find(home), "read", self.find(home)) if home else None

    def face(self) -> tuple[list[str], Callable[[str], Any], Callable[[], list[str]]]:
        """Returns __all__, __getattr__ and __dir__ of the part's package."""
        return self.listed, self.find, lambda: self.listed

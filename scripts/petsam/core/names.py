"""Names of parts in import statements: `from petsam.joint import Structure` is that of petsam.apps.joint.

A finder of Python's import system gives a module that is already there another name, with all modules below it; no
module is loaded twice.
"""

import importlib
import sys
from collections.abc import Callable
from importlib.abc import Loader
from importlib.machinery import ModuleSpec
from types import ModuleType
from typing import Any, Optional


class Names:
    """A finder: place(NAME) is where the module petsam.NAME is, as ".apps.joint"; None of a name that is none."""

    def __init__(self, package: str, place: Callable[[str], Optional[str]]) -> None:
        self.begin, self.package, self.place = package + ".", package, place

    def find_spec(self, name: str, path: Any = None, target: Any = None) -> Optional[ModuleSpec]:
        """Returns the spec of a module with another name; None of others, which the next finder looks for."""
        if not name.startswith(self.begin):
            return None
        first, _, below = name[len(self.begin) :].partition(".")
        place = self.place(first)
        home = f"{self.package}{place}.{below}".rstrip(".")
        if place is None or home == name:
            return None
        return ModuleSpec(name, _There(home)) if self._exists(home) else None

    def _exists(self, home):
        if home in sys.modules:
            return True
        from importlib.util import find_spec  # whose import takes as long as that of the package

        return find_spec(home) is not None


class _There(Loader):
    """A loader that returns a module which has a spec of its own already."""

    def __init__(self, home):
        self.home, self.spec = home, None

    def create_module(self, spec: ModuleSpec) -> ModuleType:
        home = self.home
        module = importlib.import_module(home)
        self.spec = module.__spec__
        return module

    def exec_module(self, module: ModuleType) -> None:
        module.__spec__ = self.spec


def provide(package: str, place: Callable[[str], Optional[str]]) -> None:
    """Lets import statements find the parts of a package by place(NAME)."""
    sys.meta_path.insert(0, Names(package, place))

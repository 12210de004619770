"""Methods of results whose functions are those of a package above: report() draws by petsam.plot.

A package may import those below it only. So the package's __init__.py, which names all, provides such functions here
by provide(), and a method takes them by provided() when it is called.
"""

import os
from collections.abc import Callable
from typing import Any, Union

_loaders: dict[str, Callable[[], Callable]] = {}


def provide(name: str, load: Callable[[], Callable]) -> None:
    """Makes a function available by its name; load() returns it, and is called at each use."""
    _loaders[name] = load


def provided(name: str) -> Callable[..., Any]:
    """Returns the function of this name."""
    return _loaders[name]()


class Shown:
    """A result that has a report as a page."""

    def report(self, path: Union[str, os.PathLike]) -> None:
        """Writes a page of HTML with the inputs, numbers, errors and pictures of these results.

        Parameters
        ----------
        path : str
            Name of the page, which ends in .html; an older one is replaced.

        Raises
        ------
        Error
            If the page cannot be written, or no step has a solution.
        """
        provided("report")(self, path)

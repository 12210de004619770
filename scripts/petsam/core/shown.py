"""Functions of packages above: report() of results draws by petsam.plot, which draws what applications have found.

A package may import those below it only. So the package's __init__.py, which names all, provides such functions here
by provide(), and who needs one takes it by provided() when it is called.
"""

import os
from collections.abc import Callable, Mapping
from typing import Any, Optional, Union

from .part import Part

_loaders: dict[str, Callable[[], Callable]] = {}


def provide(name: str, load: Callable[[], Callable]) -> None:
    """Makes a function available by its name; load() returns it, and is called at each use."""
    _loaders[name] = load


def provided(name: str) -> Callable[..., Any]:
    """Returns the function of this name."""
    return _loaders[name]()


def applications() -> list[Part]:
    """Returns the records of all applications."""
    return provided("applications")()


def application_of(found: Any) -> Optional[Part]:
    """Returns the record of the application whose class a result has; None of another."""
    return next((one for one in applications() if type(found).__module__.startswith(one.package + ".")), None)


class Shown:
    """A result that has a report as a page."""

    def report(self, path: Union[str, os.PathLike], inputs: Optional[Mapping[str, Any]] = None) -> None:
        """Writes a page of HTML with the inputs, numbers, errors and pictures of these results. Its path ends in .html;
        an older page is replaced. `inputs` are {name: value} of those that a result of an application does not have
        itself. Raises an Error if the page cannot be written, or no step has a solution."""
        provided("report")(self, path, inputs)

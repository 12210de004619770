"""The Python side of petsam.

    import petsam
    results = petsam.open("sphere.h5")
    print(results.history["stick_area"][-1], results.field("pressure").max())

Contact         a contact in this process: steps, stiffness, fields, stresses, fatigue
run             a run of the program, whose results it returns
open            reading of files: Results of petsam, Stresses of petsam-stress, the Study of petsam-study
results         what open() returns
cycles          cycles of a load history and their energies: results.cycles, and
sliding         regime, energy ratio, sliding ratio of a cycle; slip amplitudes: results.sliding
contact         contacts, and what is computed of them; of these
gradient        derivatives of a number of a history by all parameters: Contact.gradient(); for optimisers
uncertainty     standard deviation of such a number by roughness and parameters, and their shares
closed          closed-form solutions of contact mechanics
materials       constants of materials by name
plot            pictures by name, of files and of what applications have found: petsam-plot
apps            the applications, petsam.joint, petsam.wheel and others: petsam.apps.records() has their purposes
core            what all parts share: errors, files, HDF5, units, command lines, search for petsam and its libraries

Importing this package alone needs only the standard library: each part imports its libraries when it is used, and is
available by its name, petsam.cycles or petsam.closed.plane, with an import statement and without. An application is
called as its command: petsam.joint is that of petsam-joint.
"""

import importlib
import os

from .core import names as _names
from .core import shown as _shown
from .core.errors import Error, Missing, MissingFile
from .core.version import __version__ as __version__

TYPE_CHECKING = False  # checkers of types take it for True; to import typing here would slow the start of every command
if TYPE_CHECKING:
    from typing import Any, Optional, Union

    from . import closed
    from .contact.errors import (
        AdviceWarning,
        ContactError,
        CycleWarning,
        EdgeContact,
        EdgeContactWarning,
        NoEquilibrium,
        NotConverged,
        PrescribedError,
        WearWarning,
    )
    from .contact.inprocess import Contact
    from .contact.running import run
    from .core import materials
    from .results import cycles
    from .results.file import Results
    from .results.snapshot import Snapshot
    from .results.stresses import Stresses
    from .results.studies import Study

__all__ = [
    "AdviceWarning",
    "Contact",
    "ContactError",
    "CycleWarning",
    "EdgeContact",
    "EdgeContactWarning",
    "Error",
    "Missing",
    "MissingFile",
    "NoEquilibrium",
    "NotConverged",
    "PrescribedError",
    "Results",
    "Snapshot",
    "Stresses",
    "Study",
    "WearWarning",
    "closed",
    "cycles",
    "materials",
    "open",
    "run",
]

# names that need libraries; their modules are imported at their first use
_HOMES = {
    **dict.fromkeys(
        (
            "AdviceWarning", "ContactError", "CycleWarning", "EdgeContact", "EdgeContactWarning", "NoEquilibrium",
            "NotConverged", "PrescribedError", "WearWarning",
        ),
        ".contact.errors",
    ),
    "Contact": ".contact.inprocess",
    "Results": ".results.file",
    "Snapshot": ".results.snapshot",
    "Stresses": ".results.stresses",
    "Study": ".results.studies",
    "run": ".contact.running",
}  # fmt: skip
# parts with a name here, and where they are; the applications are found by their folders
_PARTS = {
    **{name: "." + name for name in ("apps", "closed", "contact", "core", "plot", "results")},
    **{name: ".contact." + name for name in ("gradient", "uncertainty")},
    **{name: ".results." + name for name in ("cycles", "sliding")},
    "materials": ".core.materials",
}


def _applications():
    return importlib.import_module(".apps", __name__)


def _place(name):
    """Where a part is, relative to this package; None of a name that is none."""
    if name in _PARTS:
        return _PARTS[name]
    application = not name.startswith("_") and name not in (*__all__, "apps") and name in _applications().names()
    return ".apps." + name if application else None


def _public(found):
    """A function or a class that checks its arguments, which needs libraries."""
    from .core.public import public

    return public(found)


def __getattr__(name):
    if name in _HOMES:
        return _public(getattr(importlib.import_module(_HOMES[name], __name__), name))
    if _place(name):
        module = importlib.import_module(_place(name), __name__)
        for one in vars(module).keys() & {*vars(module).get("__all__", ())}:
            _public(vars(module)[one])
        return module
    for one in [] if name.startswith("_") else _applications().records():
        if name in one.top:
            return one.find(name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


_names.provide(__name__, _place)
# for packages below plot and the applications
_shown.provide("applications", lambda: _applications().records)
_shown.provide("report", lambda: __getattr__("plot").report)
_shown.provide("view", lambda: __getattr__("plot").view)


def __dir__():
    tops = {name for one in _applications().records() for name in one.top}
    listed = {*__all__, *_PARTS, *_applications().names(), *tops} - {"contact", "core"}
    return sorted({*listed, "__doc__", "__file__", "__name__", "__version__"})


def open(path: "Union[str, os.PathLike]", label: "Optional[str]" = None) -> "Any":
    """Opens a file of petsam, of petsam-stress, or petsam-study's results.h5.

    Parameters
    ----------
    path : path
        The file.
    label : str, optional
        Its name in pictures; the file's name.

    Returns
    -------
    Results, Stresses or Study
        By what is in the file.

    Raises
    ------
    MissingFile
        If there is no such file; it is a FileNotFoundError, too.
    Error
        If the file cannot be read.

    Examples
    --------
    >>> import petsam
    >>> ball = dict(gap_type="sphere", gap_radius1=5e-3, gap_radius2="inf", body1_young=210e9, body1_poisson=0.3)
    >>> ball.update(body2_young=210e9, body2_poisson=0.3, grid_n=16, grid_size=3e-4, friction=0.3)
    >>> petsam.run(ball, load_n=10.0, output="ball.h5").close()
    >>> with petsam.open("ball.h5") as results:
    ...     round(float(results.history["load_n"][-1]), 6)
    10.0
    """
    from .results.stresses import open_any

    found = open_any(path, label)
    _public(type(found))
    return found

"""The Python side of petsam.

    import petsam
    results = petsam.open("sphere.h5")
    print(results.history["stick_area"][-1], results.field("pressure").max())

Contact         a contact in this process: steps, stiffness, fields, stresses, fatigue (contact.py)
run             a run of the program, whose results it returns (running.py)
open            reading of files (results/): Results of petsam, Stresses of petsam-stress, the Study of petsam-study
results         what open() returns; cycles of a load history and their energies, regimes of slip
cycles          results.cycles, and
sliding         results.sliding: regime, energy ratio, sliding ratio of a cycle; slip amplitudes
Element         a contact as a force element of a time integration or of a static solver (joint/element.py)
joint           contact stiffness and damping of rough interfaces per area; joints in a structure
profiles        wheel and rail: patches, creepages and forces from two profiles
calibration     friction, rig stiffness, wear from measured loops: petsam-fit
conduction      thermal and electrical conductance of contacts: conduction.of(contact, lam1, lam2)
gradient        derivatives of a number of a history by all parameters: Contact.gradient(); for optimisers
uncertainty     standard deviation of such a number by roughness and parameters, and their shares
heat            temperatures by the friction of a cycle at a frequency: heat.work(results).temperatures(50)
closed          closed-form solutions of contact mechanics
materials       constants of materials by name
lives           lives, safety factors, short cracks: petsam-fatigue
loads           load histories from the contact forces of a structural analysis: petsam-loads
plot            pictures by name, of files and of what the parts above have found: petsam-plot
study           many runs from a table: petsam-study
compliance      real bodies from finite elements: petsam-compliance
surface         measured surfaces into petsam's HDF5: petsam-surface
core            what all parts share: errors, files, HDF5, units, search for petsam and its libraries
commands        the command lines of the programs petsam-plot, petsam-study, ...

Importing this package alone needs only the standard library: each part imports its libraries when it is used, and is
available by its name, petsam.cycles or petsam.closed.plane, without a separate import.
"""

import importlib
import os

from .core import shown as _shown
from .core.errors import Error, Missing, MissingFile
from .core.version import __version__ as __version__

TYPE_CHECKING = False  # checkers of types take it for True; to import typing here would slow the start of every command
if TYPE_CHECKING:
    from typing import Any, Optional, Union

    from . import closed
    from .contact import (
        AdviceWarning,
        Contact,
        ContactError,
        CycleWarning,
        EdgeContact,
        EdgeContactWarning,
        NoEquilibrium,
        NotConverged,
        PrescribedError,
        WearWarning,
    )  # fmt: skip
    from .core import materials
    from .joint.element import Element
    from .results import cycles
    from .results.file import Results
    from .results.snapshot import Snapshot
    from .results.stresses import Stresses
    from .results.studies import Study
    from .running import run

__all__ = [
    "AdviceWarning",
    "Contact",
    "ContactError",
    "CycleWarning",
    "EdgeContact",
    "EdgeContactWarning",
    "Element",
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
    "AdviceWarning": ".contact",
    "Contact": ".contact",
    "ContactError": ".contact",
    "CycleWarning": ".contact",
    "EdgeContact": ".contact",
    "EdgeContactWarning": ".contact",
    "Element": ".joint.element",
    "NoEquilibrium": ".contact",
    "NotConverged": ".contact",
    "PrescribedError": ".contact",
    "Results": ".results.file",
    "Snapshot": ".results.snapshot",
    "Stresses": ".results.stresses",
    "Study": ".results.studies",
    "WearWarning": ".contact",
    "run": ".running",
}

_PARTS = (
    "calibration", "closed", "compliance", "conduction", "gradient", "heat", "joint", "lives", "loads", "materials",
    "plot", "profiles", "results", "study", "surface", "uncertainty",
)  # fmt: skip
_OF_RESULTS = ("cycles", "sliding")  # parts of results with a name of their own


def __getattr__(name):
    if name == "materials":
        return importlib.import_module(".core.materials", __name__)
    if name in _PARTS or name == "core":
        return importlib.import_module("." + name, __name__)
    if name in _OF_RESULTS:
        return importlib.import_module(".results." + name, __name__)
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(importlib.import_module(_HOMES[name], __name__), name)


# for methods of packages below plot
_shown.provide("report", lambda: __getattr__("plot").report)
_shown.provide("view", lambda: __getattr__("plot").view)


def __dir__():
    return sorted({*__all__, *_PARTS, *_OF_RESULTS, "__doc__", "__file__", "__name__", "__version__"})


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
    """
    from .results.stresses import open_any

    return open_any(path if isinstance(path, os.PathLike) else os.fsdecode(path), label)

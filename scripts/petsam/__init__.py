"""The Python side of petsam.

    import petsam
    results = petsam.open("sphere.h5")
    print(results.history["stick_area"][-1], results.field("pressure").max())

Contact         a contact in this process: steps, stiffness, fields, stresses, fatigue (contact.py)
run             a run of the program, whose results it returns (running.py)
open            reading of files: Results of petsam (results.py), Stresses of petsam-stress (stresses.py), the table of
                petsam-study (studies.py)
cycles          cycles of a load history and their energies
Element         a contact as a force element of a time integration or of a static solver (element.py)
joint           contact stiffness and damping of rough interfaces per area; joints in a structure
closed          closed-form solutions of contact mechanics
lives           lives, safety factors, short cracks: petsam-fatigue
sliding         regime, energy ratio, sliding ratio of a cycle; slip amplitudes
plot            pictures: petsam-plot
study           many runs from a table: petsam-study
compliance      real bodies from finite elements: petsam-compliance
surface         measured surfaces into petsam's HDF5: petsam-surface
comparison      common parts of the examples' comparisons with other solutions
isolation       reading of files that may be damaged, in a child process
environment     search for the interpreter, its libraries and petsam

Importing this package alone needs only the standard library: each part imports its libraries when it is used, and is
available by its name, petsam.cycles or petsam.closed.plane, without a separate import.
"""

import importlib
import os

from .errors import Error, Missing, MissingFile

__version__ = "1.0.0"
__all__ = [
    "AdviceWarning",
    "Contact",
    "ContactError",
    "CycleWarning",
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
    "open",
    "run",
]

# names that need libraries; their modules are imported at their first use
_HOMES = {
    "AdviceWarning": ".contact",
    "Contact": ".contact",
    "ContactError": ".contact",
    "CycleWarning": ".contact",
    "EdgeContactWarning": ".contact",
    "Element": ".element",
    "NoEquilibrium": ".contact",
    "NotConverged": ".contact",
    "PrescribedError": ".contact",
    "Results": ".results",
    "Snapshot": ".results",
    "Stresses": ".stresses",
    "Study": ".studies",
    "WearWarning": ".contact",
    "run": ".running",
}

_PARTS = ("closed", "compliance", "cycles", "joint", "lives", "plot", "sliding", "study", "surface")
_INTERNAL = ("comparison", "environment", "isolation")  # parts for petsam's own commands, examples and tests


def __getattr__(name):
    if name in _PARTS or name in _INTERNAL:
        return importlib.import_module("." + name, __name__)
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(importlib.import_module(_HOMES[name], __name__), name)


def __dir__():
    return sorted({*__all__, *_PARTS, "__doc__", "__file__", "__name__", "__version__"})


def open(path, label=None):
    """Opens a file: returns the Results of petsam, the Stresses of petsam-stress, or the Study of petsam-study's
    results.h5.

    Raises Error if it cannot be read, and MissingFile, which is a FileNotFoundError, too, if there is none.

    label names it in pictures (the file's name).
    """
    from .stresses import open_any

    return open_any(path if isinstance(path, os.PathLike) else os.fsdecode(path), label)

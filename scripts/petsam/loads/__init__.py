"""Load histories from the contact forces of a structural analysis: petsam-loads.

    forces = petsam.loads.read("contact.csv", length="mm", force="N")
    found = petsam.loads.history(forces, frame=((5, 0, 0), (-1, 0, 1), (1, 0, 1)), patch="FLANK")
    found.write("flank.csv")  # for -history
    petsam.plot.loads(found)

read      forces at nodes over time, of a file of any of the formats (reading.py)
history   the loads of one patch in its frame: a History with table(), rows, notes (resultants.py)

forces      forces at nodes, and patches of them
gathering   rows of a file as arrays over times and nodes
texts       tables with a head
calculix    CalculiX's .dat and .frd
abaqus      Abaqus's reports
automatic   a frame by the forces
doubts      remarks about a history: pull, moments beyond the patch, motion
"""

import importlib

_HOMES = {"Forces": "forces", "History": "resultants", "history": "resultants", "read": "reading"}
__all__ = sorted(_HOMES)


def __getattr__(name):
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(importlib.import_module("." + _HOMES[name], __name__), name)


def __dir__():
    return __all__

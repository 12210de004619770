"""Pictures of results, as files and as pages.

They have names (pictures.py), as petsam.plot.maps(results) and petsam.plot.loop(results, other); keywords that many of
them have are in keywords.py.

fields and crossings draw fields over the surface and along x and y, gradients derivatives in each cell, series scalars
over time or over one another, loops and wear cycles and scars, bodies stresses, tables and planes studies. Applications
bring their own pictures, which have their names here, too: petsam.plot.surface(map). kinds lists the pictures that suit
a file; reports makes a page of a file or of what an application has found, with the terms of heads, the verdict of
checks, the tables of sheets, the slider of frames and the elements of page. outlines draws the edges that a file has,
colours chooses the colours of maps, symbols what known quantities are called, units the prefixes; style has the look of
all, saving writes files. command is petsam-plot, with arguments and uses.
"""

import importlib
import os
import sys

from ..core.part import Part
from ..core.shown import applications

if "ipykernel" not in sys.modules or "MPLBACKEND" not in os.environ:  # a notebook shows pictures by its own backend
    os.environ["MPLBACKEND"] = "Agg"  # no screen is needed; matplotlib refuses to start with a name it does not know

PART = Part(
    __name__,
    names={
        "pictures": (
            "energy", "fatigue", "fretting_log", "gradient", "history", "life", "loop", "maps", "profiles", "regimes",
            "scar", "sections", "stress_maps", "stress_profiles", "study",
        ),
        "reports": ("report", "view"),
    },
    quiet=True,
    see=("petsam", "petsam-stress"),
)  # fmt: skip


def __dir__():
    return sorted(
        [*PART.listed, *(name for one in applications() for names in one.pictures.values() for name in names)]
    )


def __getattr__(name):
    if name == "__all__":
        return __dir__()
    if name in PART.listed:
        return PART.find(name)
    if name.startswith("__"):
        raise AttributeError(name)
    try:
        return importlib.import_module("." + name, __name__)
    except ModuleNotFoundError as error:
        if error.name != f"{__name__}.{name}":
            raise
    for one in applications():
        if one.pictured(name):
            return one.picture(name)
    raise AttributeError(f"no picture {name}: there are {', '.join(__dir__())}")

"""Pictures of results: by name in pictures.py, as petsam.plot.maps(results), petsam.plot.loop(results, other).

fields and crossings draw fields over the surface and along x and y, gradients derivatives in each cell, series scalars
over time or over one another, loops and wear cycles and scars, bodies stresses, tables and planes studies;
of_compliance, of_lives, of_loads, of_surface and of_joints what these parts of the package have found. kinds lists the
pictures that suit a file; reports makes a page of a file or of results of a joint, with the tables of sheets and
joints, the slider of frames and the elements of page. colours chooses the colours of maps, symbols what known
quantities are called, units the prefixes; style has the look of all, saving writes files.
"""

import importlib
import os
import sys

if "ipykernel" not in sys.modules or "MPLBACKEND" not in os.environ:  # a notebook shows pictures by its own backend
    os.environ["MPLBACKEND"] = "Agg"  # no screen is needed; matplotlib refuses to start with a name it does not know

# functions and their modules, which load matplotlib at the first use
_HOMES = {
    "pictures": (
        "energy", "fatigue", "fretting_log", "gradient", "history", "life", "loop", "maps", "profiles", "regimes",
        "scar", "sections", "stress_maps", "stress_profiles", "study",
    ),
    "reports": ("report", "view"),
    "of_joints": ("backbone", "band", "conductance", "interface", "joint_wear", "response", "saved", "slip_zones"),
    "of_calibration": ("fit", "scar_fit"),
    "of_compliance": ("compliance",),
    "of_lives": ("lives",),
    "of_loads": ("loads", "loads_beside"),
    "of_profiles": ("over_y", "wheels", "worn_profile"),
    "of_surface": ("surface",),
}  # fmt: skip
__all__ = sorted(name for names in _HOMES.values() for name in names)


def __getattr__(name):
    for home, names in _HOMES.items():
        if name in names:
            return getattr(importlib.import_module("." + home, __name__), name)
    if name.startswith("__"):
        raise AttributeError(name)
    try:
        return importlib.import_module("." + name, __name__)
    except ModuleNotFoundError as error:
        if error.name != f"{__name__}.{name}":
            raise
        raise AttributeError(f"no picture {name}: there are {', '.join(__all__)}") from None


def __dir__():
    return __all__

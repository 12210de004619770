"""The one table of units: those that petsam takes after a number (declared.py), and the spellings of instruments."""

import math
import re

from .declared import FOLLOWING

# other spellings of lengths, of src/ground/file/lengths.c and of instruments; words may be plural
LENGTHS = {
    "meter": 1.0, "metre": 1.0, "km": 1e3, "kilometer": 1e3, "kilometre": 1e3,
    "cm": 1e-2, "centimeter": 1e-2, "centimetre": 1e-2, "millimeter": 1e-3,
    "millimetre": 1e-3, "\u00b5m": 1e-6, "\u03bcm": 1e-6, "micrometer": 1e-6, "micrometre": 1e-6, "micron": 1e-6,
    "nanometer": 1e-9, "nanometre": 1e-9, "pm": 1e-12, "picometer": 1e-12, "picometre": 1e-12, "angstrom": 1e-10,
    "\u00c5": 1e-10, "in": 0.0254, "inch": 0.0254, "mil": 2.54e-5,
}  # fmt: skip
KGF = 9.80665  # N
MICRO = "\u00b5", "\u03bc"  # its sign in Latin-1, and the Greek letter
OTHERS = {
    "Hz": {"Hz": 1.0, "kHz": 1e3, "1/s": 1.0},
    "m2": {"m2": 1.0, "cm2": 1e-4, "mm2": 1e-6, "um2": 1e-12},
    "kg/m3": {"kg/m3": 1.0, "g/cm3": 1e3, "t/mm3": 1e12},
    "degrees": {"degrees": 1.0, "deg": 1.0},
    "rad": {"deg": math.pi / 180.0, "degrees": math.pi / 180.0},
    "m/s": {"km/h": 1.0 / 3.6},
    "rad/s": {
        "rad/s": 1.0,
        "mrad/s": 1e-3,
        "1/s": 1.0,
        "deg/s": math.pi / 180.0,
        "rpm": math.pi / 30.0,
        "1/min": math.pi / 30.0,
    },
    "kg": {"kg": 1.0, "g": 1e-3, "mg": 1e-6},
    "Pa m^1/2": {
        "Pa m^1/2": 1.0,
        "MPa m^1/2": 1e6,
        "Pam^1/2": 1.0,
        "MPam^1/2": 1e6,
        "Pa sqrt(m)": 1.0,
        "MPa sqrt(m)": 1e6,
    },
    "N": {"N": 1.0, "newton": 1.0, "Newton": 1.0, "daN": 10.0, "kgf": KGF, "gf": 1e-3 * KGF, "lbf": 0.45359237 * KGF},
    "J": {"J": 1.0, "mJ": 1e-3, "uJ": 1e-6, "nJ": 1e-9},
    "J/m": {"J/m": 1.0, "mJ/m": 1e-3},
    "m3": {"m3": 1.0, "mm3": 1e-9, "um3": 1e-18},
    "N/m": {"N/um": 1e6, "kN/mm": 1e6, "N/nm": 1e9},
    "Pa/m": {"Pa/m": 1.0, "MPa/mm": 1e9, "N/mm3": 1e9},
}
PLURAL = 4  # letters of a word at least that may have an s
NUMBER = r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?"


def of(unit):
    """{name: size in the unit of SI} of all units of a quantity, that of SI the first."""
    found = {name: 10.0**power for name, (si, power) in FOLLOWING.items() if si == unit}
    return {**found, **(LENGTHS if unit == "m" else {}), **OTHERS.get(unit, {})}


def size(name, unit="m"):
    """The size of a unit in that of SI, as 1e-3 of "mm"; of one with a factor, as 1e-4 of "0.1mm"; None if unknown."""
    known, name = of(unit), name.strip()
    for sign in MICRO:
        name = name if name in known else name.replace(sign, "u")
    if name not in known and len(name) > PLURAL and name.endswith("s"):
        name = name[:-1]
    if name in known:
        return known[name]
    found = re.fullmatch(rf"({NUMBER})\s*(\S.*)", name)
    factor = float(found[1]) if found and found[2] in known else 0.0
    return factor * known[found[2]] if 0.0 < factor < float("inf") else None


def quantity(name):
    """The unit of SI of the quantity that a unit is of; "" of an empty name, None of one that is not known."""
    known = dict.fromkeys(["m", *OTHERS, *(si for si, _ in FOLLOWING.values())])  # degrees before rad
    return next((unit for unit in known if size(name, unit)), None) if name.strip() else ""


def names(unit="m"):
    """The usual names of the units of a quantity, as a text for messages."""
    shown = {"m": ("m", "cm", "mm", "um", "nm", "pm", "angstrom", "in")}
    return ", ".join(shown.get(unit) or of(unit))


def shown(value):
    """A length (m) for a reader: 12.5 um."""
    for name in ("mm", "um", "nm"):
        if abs(value) >= of("m")[name]:
            return f"{value / of('m')[name]:.4g} {name}"
    return f"{value / 1e-9:.4g} nm" if value else "0"

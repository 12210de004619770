"""Units of length, the same as petsam's (src/ground/file/lengths.c), and lengths on the command line."""

import argparse
import re

from .errors import short

KNOWN = "m, cm, mm, um, nm, pm, angstrom, in"
UNITS = {
    "m": 1.0, "meter": 1.0, "metre": 1.0, "cm": 1e-2, "centimeter": 1e-2, "centimetre": 1e-2,
    "mm": 1e-3, "millimeter": 1e-3, "millimetre": 1e-3, "um": 1e-6, "\u00b5m": 1e-6, "\u03bcm": 1e-6,
    "micrometer": 1e-6, "micrometre": 1e-6, "micron": 1e-6, "nm": 1e-9, "nanometer": 1e-9, "nanometre": 1e-9,
    "pm": 1e-12, "picometer": 1e-12, "picometre": 1e-12, "angstrom": 1e-10, "\u00c5": 1e-10,
    "in": 0.0254, "inch": 0.0254,
}  # fmt: skip
NUMBER = r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?"
LARGEST_RATIO = 100.0  # of the two sides of a surface: beyond it, the comma was a decimal comma
SHOWN = ((1e-3, "mm"), (1e-6, "um"), (1e-9, "nm"))


def metres(unit):
    """Metres of a unit; None for one that is not known."""
    unit = unit.strip()
    return UNITS.get(unit[:-1] if len(unit) > 4 and unit.endswith("s") else unit)


def unit(text):
    """Reader of a unit for argparse: its metres."""
    value = metres(text)
    if value is None:
        raise argparse.ArgumentTypeError(f"{short(text) or repr('')}: expected one of {KNOWN}")
    return value


def _split(text):
    """Number and unit ("" without one) of a length."""
    found = re.fullmatch(rf"\s*({NUMBER})\s*(\D*?)\s*", text)
    if not found or (found.group(2) and metres(found.group(2)) is None):
        raise argparse.ArgumentTypeError(
            f"{short(text) or repr('')}: expected a length, such as 1e-3 (m) or 1mm; units are {KNOWN}"
        )
    return float(found.group(1)), found.group(2)


def lengths(text):
    """Lengths separated by commas, m."""
    pairs = [_split(word) for word in text.split(",")]
    if len({bool(name) for _, name in pairs}) > 1:
        raise argparse.ArgumentTypeError(
            f"{short(text)}: give each number its unit, or none (m); decimals have a point"
        )
    return [value * (metres(name) if name else 1.0) for value, name in pairs]


def sides(text):
    """Reader of one or two positive lengths for argparse, x and y."""
    values = lengths(text)
    if len(values) > 2 or not all(0.0 < value < float("inf") for value in values):
        raise argparse.ArgumentTypeError(f"{short(text)}: expected one or two lengths above 0: X[,Y]")
    x, y = values[0], values[-1]
    if max(x, y) > LARGEST_RATIO * min(x, y):
        raise argparse.ArgumentTypeError(f"{short(text)}: is {x:g} m x {y:g} m: decimals have a point, not a comma")
    return x, y


def several(count, form):
    """Reader of so many lengths for argparse; form describes them."""

    def read(text):
        values = lengths(text)
        if len(values) != count:
            raise argparse.ArgumentTypeError(f"{short(text)}: expected {form}")
        return tuple(values)

    return read


def shown(value):
    """A length (m) for a reader."""
    for size, name in SHOWN:
        if abs(value) >= size:
            return f"{value / size:.4g} {name}"
    return f"{value / 1e-9:.4g} nm" if value else "0"

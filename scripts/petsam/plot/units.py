"""Units of axes, with the prefix that suits the values."""

import numpy as np

from ..errors import short

POWERS = {"m2": 2, "m3": 3}
PREFIXES = ((1e9, "G"), (1e6, "M"), (1e3, "k"), (1.0, ""), (1e-3, "m"), (1e-6, "µ"), (1e-9, "n"))
NUMBERS = ((1e9, "billion "), (1e6, "million "), (1e3, "thousand "))


def scale(unit, largest):
    """Factor and unit with the prefix in which largest has up to three digits before the point.

    Volumes go from 0.001 to six digits: from µm³ to mm³ it is nine.
    """
    if unit in ("1", "s") or not np.isfinite(largest) or largest == 0.0:
        return 1.0, "" if unit == "1" else plain(unit)
    power = POWERS.get(unit, 1)
    least = 1e-3 if unit == "m3" else 1.0
    # no kilometres, and no kilo-radians
    prefixes = [(size**power, prefix) for size, prefix in PREFIXES if size <= 1.0 or unit not in ("m", *POWERS, "rad")]
    size, prefix = next((pair for pair in prefixes if largest >= least * pair[0]), prefixes[-1])
    return 1.0 / size, prefix + {"m2": "m²", "m3": "m³", "N m": "N m"}.get(unit, plain(unit))


def counted(largest):
    """Factor and words in which up to so many cycles are told."""
    size, word = next((pair for pair in NUMBERS if largest >= pair[0]), (1.0, ""))
    return 1.0 / size, word + "cycles"


def label(text, unit):
    """Text with its unit, as an axis' label."""
    return f"{text}, {unit}" if unit else text


def largest(arrays):
    """Largest magnitude of the finite numbers in arrays, 0 without any."""
    finite = (np.abs(a[np.isfinite(a)]) for a in arrays)
    return max((float(np.max(a)) for a in finite if a.size), default=0.0)


def plain(text):
    """A text that is no part of the program, for a picture: matplotlib would take $ and a leading _ as its own."""
    text = short(text).replace("$", r"\$")
    return " " + text if text.startswith("_") else text

"""Units of axes, with the prefix that suits the values."""

import numpy as np

from ..errors import short

PREFIXES = ((1e9, "G"), (1e6, "M"), (1e3, "k"), (1.0, ""), (1e-3, "m"), (1e-6, "µ"), (1e-9, "n"))


def scale(unit, largest):
    """Factor and unit with the prefix in which largest has up to three digits before the point."""
    if unit in ("1", "s") or not np.isfinite(largest) or largest == 0.0:
        return 1.0, "" if unit == "1" else plain(unit)
    power = 2 if unit == "m2" else 1
    # no kilometres, and no kilo-radians
    prefixes = [(size**power, prefix) for size, prefix in PREFIXES if size <= 1.0 or unit not in ("m", "m2", "rad")]
    size, prefix = next((pair for pair in prefixes if largest >= pair[0]), prefixes[-1])
    return 1.0 / size, prefix + {"m2": "m²", "N m": "N m"}.get(unit, plain(unit))


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

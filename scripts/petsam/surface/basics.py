"""What all modules here share: the quantities of a map, a length for a reader, and when two lengths are the same."""

from ..core import units

QUANTITIES = {
    "height1": "heights of body 1, peaks positive",
    "height2": "heights of body 2, peaks positive",
    "separation": "separation of the bodies",
}
SAME = 1e-6  # relative difference of lengths that are meant to be the same
SHOWN = ("mm", "um", "nm")


def shown(value):
    """A length (m) for a reader."""
    for name in SHOWN:
        if abs(value) >= units.size(name):
            return f"{value / units.size(name):.4g} {name}"
    return f"{value / 1e-9:.4g} nm" if value else "0"

"""Units, sizes and missing values as words of an option, or as numbers of Python."""

import numpy as np

from ..core import units, words
from ..core.errors import Error

LARGEST_RATIO = 100.0  # of the two sides of a surface: beyond it, the comma was a decimal comma
SIDES = "one or two lengths above 0, such as 1e-3 (m) or 1mm: X[,Y]"


def unit(given):
    """Metres of a unit: "um", "0.1mm", or a number; None for None."""
    if isinstance(given, str):
        found = units.size(given)
        if found is None:
            raise words.WordError(given, f"a unit of length, also with a factor as 0.1mm: one of {units.names()}")
        return found
    if given is not None and not 0.0 < given < np.inf:
        raise Error(f"units = {given}: use a number of metres above 0, or a name")
    return given


def sides(given):
    """Two positive lengths, along x and y, of a text or of one number or two; None for None."""
    if given is None:
        return None
    if isinstance(given, str):
        values = words.numbers(given, SIDES, "m", words.positive, (1, 2))
    else:
        values = [float(value) for value in np.atleast_1d(given)]
        if len(values) > 2 or not all(map(words.positive, values)):
            raise Error(f"{given}: expected {SIDES}")
    x, y = values[0], values[-1]
    if max(x, y) > LARGEST_RATIO * min(x, y):
        raise Error(f"{given}: is {x:g} m x {y:g} m: decimals have a point, not a comma")
    return x, y


def missing(given):
    """The value of missing points: a number, or the word that it is in a text; None for None."""
    try:
        return None if given is None else float(given)
    except ValueError:
        return given

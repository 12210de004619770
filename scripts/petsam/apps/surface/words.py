"""Units, sizes and missing values as words of an option, or as numbers of Python."""

import numpy as np

from ...core import units, words
from ...core.errors import Error


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
        return words.sides(given)
    return words.sides(",".join(repr(float(value)) for value in np.atleast_1d(given)))


def missing(given):
    """The value of missing points: a number, or the word that it is in a text; None for None."""
    try:
        return None if given is None else float(given)
    except ValueError:
        return given

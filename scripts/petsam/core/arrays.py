"""Arrays of real numbers that users give."""

import numpy as np

from .errors import WrongArgument, short


def real(values):
    """An array of real numbers; masked points are NaN, as they have none. Raises TypeError or ValueError for others."""
    if np.iscomplexobj(values):
        raise TypeError("complex numbers")
    return np.ma.filled(np.ma.asarray(values, dtype=float), np.nan) if np.ma.isMA(values) else np.asarray(values, float)


def alike(what, *given):
    """Arrays of real numbers of one shape, of numbers and arrays; `what` they are for, in the message of others."""
    found = []
    for values in given:
        try:
            found.append(real(values))
        except (TypeError, ValueError):
            raise WrongArgument(f"{what}: {short(repr(values))}: expected a number or an array of numbers") from None
    try:
        return np.broadcast_arrays(*found)
    except ValueError:
        shapes = ", ".join(dict.fromkeys(str(one.shape) for one in found if one.ndim))
        raise WrongArgument(f"{what}: arrays have the shapes {shapes}: give numbers, or arrays of one shape") from None

"""Arrays of real numbers that users give."""

import numpy as np


def real(values):
    """An array of real numbers; masked points are NaN, as they have none. Raises TypeError or ValueError for others."""
    if np.iscomplexobj(values):
        raise TypeError("complex numbers")
    return np.ma.filled(np.ma.asarray(values, dtype=float), np.nan) if np.ma.isMA(values) else np.asarray(values, float)

"""Broyden's rank-one changes of a matrix of slopes by what a step has shown."""

import numpy as np


def updated(slopes: np.ndarray, moved: np.ndarray, changed: np.ndarray) -> np.ndarray:
    """Returns the slopes (m, n) that give a change of values (m,) for a step of the unknowns (n,), and are unchanged
    for steps across it; a step of 0 changes nothing."""
    square = moved @ moved
    return slopes + np.outer(changed - slopes @ moved, moved) / square if square > 0.0 else slopes

"""Broyden's rank-one changes of a matrix of slopes by what a step has shown."""

import numpy as np


def updated(slopes: np.ndarray, moved: np.ndarray, changed: np.ndarray) -> np.ndarray:
    """Returns the slopes (m, n) that give a change of values (m,) for a step of the unknowns (n,), and are unchanged
    for steps across it; a step of 0 changes nothing."""
    square = moved @ moved
    return slopes + np.outer(changed - slopes @ moved, moved) / square if square > 0.0 else slopes


def updated_inverse(inverse: np.ndarray, moved: np.ndarray, changed: np.ndarray) -> np.ndarray:
    """Returns the inverse (n, n) of the updated slopes from the inverse of the slopes, the step of the unknowns and the
    change of the values, (n,)."""
    turned = inverse @ changed
    return inverse + np.outer(moved - turned, moved @ inverse) / (moved @ turned)

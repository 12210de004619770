"""Broyden's rank-one changes of a matrix of slopes by what a step has shown."""

import numpy as np


def updated(slopes: np.ndarray, moved: np.ndarray, changed: np.ndarray) -> np.ndarray:
    """The slopes that give a change of values for a step, and are unchanged for steps across it.

    Parameters
    ----------
    slopes : ndarray
        Of the values by the unknowns, (m, n).
    moved : ndarray
        The step of the unknowns, (n,); 0: nothing is known.
    changed : ndarray
        The change of the values, (m,).

    Returns
    -------
    ndarray
        (m, n).
    """
    square = moved @ moved
    return slopes + np.outer(changed - slopes @ moved, moved) / square if square > 0.0 else slopes


def updated_inverse(inverse: np.ndarray, moved: np.ndarray, changed: np.ndarray) -> np.ndarray:
    """The inverse of the updated slopes, from their inverse.

    Parameters
    ----------
    inverse : ndarray
        Of the slopes, (n, n).
    moved, changed : ndarray
        The step of the unknowns and the change of the values, (n,).

    Returns
    -------
    ndarray
        (n, n).
    """
    turned = inverse @ changed
    return inverse + np.outer(moved - turned, moved @ inverse) / (moved @ turned)

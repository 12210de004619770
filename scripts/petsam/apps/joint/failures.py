"""Errors of steps of patches and structure, and systems of equations that may have no solution."""

from __future__ import annotations

import numpy as np

from ...contact.errors import StepError
from ...core.errors import Unusable


class NoSolution(Unusable):
    """Equilibrium of patches and structure was not found, or the contact leaves its patch."""


class Apart(NoSolution):
    """The structure pulls the bodies apart."""


BEYOND = (StepError, Apart)  # of a guess that contacts do not bear
ENDS = (NoSolution, *BEYOND)  # of a step


def solved(matrix, right, fails="structure and sticking contacts leave a motion without stiffness: support it"):
    try:
        return np.linalg.solve(matrix, right)
    except np.linalg.LinAlgError:
        raise NoSolution(fails) from None

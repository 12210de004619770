"""Errors and warnings of contacts: in this process, and in runs of the program."""

from __future__ import annotations

import errno
import os
import re
from collections.abc import Sequence
from typing import Any

from ..core.errors import EDGE, FILE, UNBALANCED, UNSETTLED, Error, MissingFile

_MISSING = f": cannot be read: {os.strerror(errno.ENOENT)}"  # end of the library's message about a missing file


class ContactError(Error):
    """A call that was rejected.

    Parameters
    ----------
    code : int
        Exit code: 2 a wrong argument, 3 a file, 10 to 12 those of steps, others of PETSc.
    message : str
        What is wrong.

    Attributes
    ----------
    results : Results or None
        Of petsam.run(): the steps so far.
    step : Step or None
        The step that failed, if one did.
    steps : list of Step or Cycle
        Of Contact.run() and Contact.live(): those before it; of an EdgeContact those up to it.
    """

    results: Any = None
    step: Any = None
    steps: Sequence = ()

    def __init__(self, code: int, message: str) -> None:
        super().__init__(code, message)  # makes it picklable
        self.code, self.message = code, message

    def __str__(self):
        return self.message

    def __reduce__(self):
        """Another process gets it without the results, which are an open file."""
        return type(self), self.args, {name: value for name, value in vars(self).items() if name != "results"}


class StepError(ContactError):
    """A step that cannot be taken: one that was rejected, or that has no solution."""


class PrescribedError(StepError, TypeError):
    """A prescribed value of a step was rejected: an unknown name, two names for one component, a value out of range.

    Parameters
    ----------
    code, message : int, str
        See ContactError.
    """


class MissingInput(ContactError, MissingFile):
    """A file that an option names is missing."""

    def __init__(self, code, message):
        MissingFile.__init__(self, re.sub(r"^-\w+ ", "", message.removesuffix(_MISSING)))
        self.args, self.code, self.message = (code, message), code, message


class NotConverged(StepError):
    """A step or a stiffness did not converge.

    Parameters
    ----------
    code, message : int, str
        See ContactError.
    """

    code = UNSETTLED


class NoEquilibrium(StepError):
    """No equilibrium exists: of a step by gross slip, or by a moment that no pressure balances.

    Parameters
    ----------
    code, message : int, str
        See ContactError.
    """

    code = UNBALANCED


class EdgeContact(ContactError):
    """The contact has reached the edge of the grid, which ends a run; `allow_edge_contact` lets it go on.

    Parameters
    ----------
    code, message : int, str
        See ContactError.
    """

    code = EDGE


class EdgeContactWarning(UserWarning):
    """The contact has reached the edge of the grid: the answer depends on the grid."""


class WearWarning(UserWarning):
    """A step wears so much that the pressure of the next ones is uneven from cell to cell, and wrong."""


class AdviceWarning(UserWarning):
    """A solution is right for its grid, but may not be intended: for example unresolved cells, units, or sizes."""


class CycleWarning(UserWarning):
    """The recorded steps are not a closed cycle, or not a steady one."""


def error_of(code: int, message: str) -> ContactError:
    """Returns the exception for an exit code of the library or of the program, with its message."""
    if code == FILE and message.endswith(_MISSING):
        return MissingInput(code, message)
    kinds = {kind.code: kind for kind in (NotConverged, NoEquilibrium, EdgeContact)}
    return kinds.get(code, ContactError)(code, message)

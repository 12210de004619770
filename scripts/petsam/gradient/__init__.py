"""Derivatives of a number of a load history by all of its parameters, in one pass back over its steps.

    import petsam
    contact = petsam.Contact(..., slip_direction="end")
    tape = petsam.gradient.record(contact, {"time": [0, 1, 2], "load_n": [100, 100, 100], "load_tx": [0, 20, -20]})
    found = petsam.gradient.of(tape, "energy")
    found.value, found["gap"], found["friction"], found["load_tx"], found["body1_young"]

halfspace  displacements of half-spaces by tractions, as convolutions, with their constants
tape       a history whose steps are recorded
adjoint    the adjoint system of a step
backward   the pass back: objectives, and what is read off
"""

from .backward import Gradient, OneSidedWarning, of
from .tape import Tape, record

__all__ = ["Gradient", "OneSidedWarning", "Tape", "of", "record"]

"""Reading of nodal forces from a file of any of the formats, which its text shows."""

from __future__ import annotations

import os

from ...core.files import text_of
from . import abaqus, calculix, texts
from .forces import Forces
from .gathering import Given


def read(
    path: str | os.PathLike, deck: str | os.PathLike | None = None, length: str | None = None, force: str | None = None
) -> Forces:
    """Reads forces at nodes over time.

    Parameters
    ----------
    path : path
        A table with a head (label, x, y, z, fx, fy, fz, time or increment), .dat or .frd of CalculiX, or a field output
        report of Abaqus, in text or in comma-separated values, with CNORMF and CSHEARF.
    deck : path, optional
        The deck (.inp): coordinates where the file has none, and sets.
    length, force : str, optional
        Units of coordinates and forces, such as "mm" and "N", where the file does not state them.

    Returns
    -------
    Forces
        In SI units.

    Raises
    ------
    petsam.Error
        For a file that cannot be read or lacks something, with its line and the cure.
    """
    path = os.fspath(path)
    given = Given(None if deck is None else os.fspath(deck), length, force)
    text = text_of(path)
    if calculix.is_frd(text):
        return calculix.read_frd(path, given)
    if calculix.is_dat(text):
        return calculix.read_dat(path, given)
    if abaqus.is_printed(text):
        abaqus.refuse_printed(path)
    if abaqus.is_report(text) or abaqus.is_values(text):
        return abaqus.read(path, given)
    return texts.read(path, given)

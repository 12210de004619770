"""Reads a profile from a file of SIMPACK or of columns."""

import os
import warnings
from typing import Optional, Union

from ..core.errors import Error
from . import columns, simpack
from .profile import Profile, ProfileWarning

SIMPACK = {".prr": "rail", ".prw": "wheel"}


def read(
    path: Union[str, os.PathLike],
    kind: Optional[str] = None,
    unit: Optional[str] = None,
    z: Optional[str] = None,
    mirror: bool = False,
) -> Profile:
    """A profile from a file.

    Parameters
    ----------
    path : path
        A file of SIMPACK (.prr, .prw), or columns y, z and a weight or none.
    kind : str, optional
        rail or wheel; files of SIMPACK state it.
    unit : str, optional
        Unit of length of columns: mm, m, in, ...; files of SIMPACK state it.
    z : str, optional
        Direction of z of columns, down or up; in files of SIMPACK it is down, and up turns one over that has it up.
    mirror : bool
        True: y has the other sign than in the file, for a file whose y is not to the field side.

    Returns
    -------
    Profile

    Raises
    ------
    Error
        If something is not stated or states twice what differs, or the file cannot be read; with file and line.
    MissingFile
        If there is no such file.

    Notes
    -----
    A ProfileWarning is issued of holes between the points, and of noise.
    """
    found = _read(os.fspath(path), kind, unit, z, mirror)
    for text in found.doubts():
        warnings.warn(text, ProfileWarning, stacklevel=2)
    return found


def _read(name, kind, unit, z, mirror):
    stated = SIMPACK.get(os.path.splitext(name)[1].lower())
    if stated is None:
        found = columns.read(name, kind or "", unit or "", z or "")
        return found.mirrored() if mirror else found
    if unit is not None:
        raise Error(f"{name}: unit={unit!r}: a file of SIMPACK has its unit in units.len.f: omit it")
    if z not in (None, "down", "up"):
        raise Error(f"{name}: z={z!r}: expected down or up")
    found = simpack.read(name)
    if found.kind != (kind or found.kind):
        raise Error(
            f"{name}: states the profile of a {found.kind}, and not of a {kind}: omit kind, or take another file"
        )
    if z == "up":
        found = Profile(found.y, -found.z, found.kind, found.weights, found.name)
    return found.mirrored() if mirror else found

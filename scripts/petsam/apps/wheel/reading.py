"""Reads a profile from a file of SIMPACK, of MiniProf or of columns."""

import os
import warnings
from dataclasses import replace
from typing import Optional, Union

from ...core.errors import Error
from . import columns, miniprof, simpack
from .profile import Profile, ProfileWarning, Taken

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
        A file of SIMPACK (.prr, .prw), of MiniProf (.whl, .ban, .mpt, or with a line ColumnDef), or columns y, z and a
        weight or none.
    kind : str, optional
        rail or wheel; files of SIMPACK state it.
    unit : str, optional
        Unit of length of columns: mm, m, in, ...; files of SIMPACK state it, those of MiniProf are in mm.
    z : str, optional
        Direction of z of columns, down or up; in files of SIMPACK and wheels of MiniProf it is down, and up turns one
        over that has it up; of rails of MiniProf it is found.
    mirror : bool
        True: y has the other sign than in the file, for a file whose y is not to the field side.

    Returns
    -------
    Profile

    Raises
    ------
    Error
        If something is not stated or states twice what differs, points go or jump back, or the file cannot be read;
        with file and line.
    MissingFile
        If there is no such file.

    Notes
    -----
    A ProfileWarning is issued of holes between the points, of noise, and of points that step back by up to 0.5 mm,
    which are removed.
    """
    found, folds = _read(os.fspath(path), kind, unit, z, mirror).without_folds()
    found.need_forward()
    for text in filter(None, [folds, *found.doubts()]):
        warnings.warn(text, ProfileWarning, stacklevel=2)
    return found


def _read(name, kind, unit, z, mirror):
    if SIMPACK.get(os.path.splitext(name)[1].lower()):
        found = _simpack(name, kind, unit, z)
    elif miniprof.is_one(name):
        found = miniprof.read(name, kind or "", unit or "", z or "")
    else:
        found = columns.read(name, kind or "", unit or "", z or "")
    return replace(found.mirrored(), taken=Taken(found.taken.z, True)) if mirror else found


def _simpack(name, kind, unit, z):
    if unit is not None:
        raise Error(f"{name}: unit={unit!r}: a file of SIMPACK has its unit in units.len.f: omit it")
    if z not in (None, "down", "up"):
        raise Error(f"{name}: z={z!r}: expected down or up")
    found = simpack.read(name)
    if found.kind != (kind or found.kind):
        raise Error(
            f"{name}: states the profile of a {found.kind}, and not of a {kind}: omit kind, or take another file"
        )
    return replace(found, z=-found.z, taken=Taken("up")) if z == "up" else found

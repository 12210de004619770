"""Examination of an HDF5 file before it is opened.

HDF5 follows the addresses in a file, and on a damaged one it may crash or never end. The program petsam-examine
(src/front/examine) reads the file first, as the C library has it do.

Without the program, as where the package alone is installed, files are opened without an examination.
"""

import functools
import os
import subprocess
from pathlib import Path
from typing import Any

from . import environment
from .errors import Error, Missing
from .files import state_of

SECONDS = 60.0  # that an examination may take

_seen: dict[
    str, tuple[Any, bool]
] = {}  # path: the state of the file that has been examined last, and whether HDF5 ends on it


class Damaged(Error):
    """A file on which HDF5 crashes, or does not end."""


@functools.lru_cache(maxsize=8)
def _beside(petsam):
    """The path of petsam-examine in the library's folder beside a program, or None."""
    path = Path(petsam).resolve().parents[1] / "lib" / "petsam" / "petsam-examine"
    return str(path) if os.access(path, os.X_OK) else None


def _program():
    try:
        return _beside(environment.petsam())
    except Missing:
        return None


def _ends(program, path):
    """True if the program reads the file to its end: it writes a character when it begins, and one when it ends."""
    try:
        done = subprocess.run(
            [program, path], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
            timeout=SECONDS,
        )  # fmt: skip
    except subprocess.TimeoutExpired:
        return False
    except (OSError, ValueError):
        return True
    return len(done.stdout) != 1


def need_readable(path: str) -> None:
    """Raises Damaged if HDF5 cannot read the structure of an existing file; it is read once in each of its states."""
    now = state_of(path)
    name = os.path.abspath(path)
    if now is None:
        return
    if _seen.get(name, (None,))[0] != now:
        program = _program()
        _seen[name] = now, program is None or _ends(program, name)
    if not _seen[name][1]:
        raise Damaged(f"{path}: is damaged")

"""Files that the commands write as HDF5: one of another origin is never replaced, one of theirs only by a whole one."""

import contextlib
import os

import h5py

from .errors import Error
from .files import need_folder, need_replaceable
from .isolation import reading
from .results import DAMAGED


def need_own(path, sign, command):
    """Error where the name is that of a file that this command, whose root attribute is `sign`, has not written."""
    need_replaceable(path)
    if not os.path.exists(path):
        return
    need_folder(os.path.dirname(os.path.realpath(path)), path)  # in which the new file is written first
    try:
        with reading(path), h5py.File(path, "r") as file:
            own = sign in file.attrs
    except DAMAGED:
        own = False
    if not own:
        raise Error(f"{path}: exists and was not written by {command}; choose another name by --output")


@contextlib.contextmanager
def replacing(path):
    """An open HDF5 file, which takes this name when all is written; a symbolic link stays one."""
    path = os.path.realpath(path)
    part = f"{path}.{os.getpid()}.tmp"
    try:
        with h5py.File(part, "w") as file:
            yield file
        os.replace(part, path)
    except OSError as error:
        raise Error(f"{path}: cannot be written: {error.strerror or error}") from error
    finally:
        if os.path.exists(part):
            os.remove(part)

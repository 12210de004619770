"""HDF5 files of this package: opened() to read them, replacing() to write them.

While a process has a file open, HDF5 opens it once more in the state of the first time: steps that a run has written
since are missing, or lie beyond the end that HDF5 has noted. HDF5 compares files by their numbers in the system, but
never takes two objects of Python for the same file: fresh() opens a file in its present state.

A file of another origin is never replaced, one of the commands' own only by a whole one.
"""

import atexit
import contextlib
import os
import weakref

import h5py

from .errors import Error
from .examine import need_readable
from .files import need_folder, need_replaceable
from .version import __version__

# exceptions that h5py raises for a file that is damaged, or has another layout
DAMAGED = (OSError, LookupError, ValueError, TypeError, AttributeError, RuntimeError, ArithmeticError, MemoryError)

_files: weakref.WeakValueDictionary[int, h5py.File] = weakref.WeakValueDictionary()  # those that are open


class _Bytes:
    """The bytes of a file for h5py. The position is its own: that of the system would be shared with a forked child."""

    def __init__(self, path):
        self._number = None
        self._number, self._at = os.open(path, os.O_RDONLY | os.O_CLOEXEC), 0

    def __del__(self):
        if self._number is not None:
            os.close(self._number)

    def seek(self, offset, whence=os.SEEK_SET):
        """Sets the position."""
        base = {os.SEEK_SET: 0, os.SEEK_CUR: self._at}
        self._at = offset + (base[whence] if whence in base else os.fstat(self._number).st_size)
        return self._at

    def tell(self):
        """The position."""
        return self._at

    def readinto(self, target):
        """Fills the target from the position on, or as far as the file reaches; returns the number of bytes."""
        target, done = memoryview(target).cast("B"), 0
        while done < len(target) and (count := os.preadv(self._number, [target[done:]], self._at + done)):
            done += count
        self._at += done
        return done

    def read(self, size):
        """Bytes from the position on."""
        target = bytearray(size)
        return bytes(target[: self.readinto(target)])


def fresh(path):
    """An open h5py.File of the file as it is now, for reading; raises examine.Damaged for one on which HDF5 crashes."""
    need_readable(path)
    file = h5py.File(_Bytes(path), "r")
    _files[id(file)] = file
    return file


@atexit.register
def _close():
    """Closes all files before Python ends: HDF5 would read from objects of an interpreter that is no more."""
    for file in list(_files.values()):
        file.close()


@contextlib.contextmanager
def opened(path):
    """An open HDF5 file, for reading; it is examined first, as HDF5 may crash on a damaged one.

    Raises examine.Damaged for a file on which HDF5 crashes, and one of DAMAGED for others that cannot be read.
    """
    need_readable(path)
    with h5py.File(path, "r") as file:
        yield file


def need_own(path, sign, command):
    """Error where the name is that of a file that this command, whose root attribute is `sign`, has not written."""
    need_replaceable(path)
    if not os.path.exists(path):
        return
    need_folder(os.path.dirname(os.path.realpath(path)), path)  # in which the new file is written first
    try:
        with opened(path) as file:
            own = sign in file.attrs
    except DAMAGED:
        own = False
    if not own:
        raise Error(f"{path}: exists and was not written by {command}; choose another name by --output")


@contextlib.contextmanager
def replacing(path, sign=""):
    """An open HDF5 file, which takes this name when all is written; a symbolic link stays one. `sign`: root attribute
    by which need_own() knows it, with the version of petsam."""
    path = os.path.realpath(path)
    part = f"{path}.{os.getpid()}.tmp"
    try:
        with h5py.File(part, "w") as file:
            if sign:
                file.attrs[sign] = __version__
            yield file
        os.replace(part, path)
    except OSError as error:
        raise Error(f"{path}: cannot be written: {error.strerror or error}") from error
    finally:
        if os.path.exists(part):
            os.remove(part)

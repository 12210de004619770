"""The shared library libpetsam, loaded by ctypes, and what it is given: texts, names, numbers, arrays."""

from __future__ import annotations

import ctypes
import os
import re
import shutil
import threading
from pathlib import Path

from ..core import options as command_line
from ..core.environment import PREFIX, TREE
from ..core.errors import Missing, short
from ..core.version import __version__
from .errors import PrescribedError

lock = threading.RLock()  # one thread at a time may be in the library
_library = None


def _candidates():
    """Possible places of libpetsam: $PETSAM_LIBRARY, the build tree, the prefix of these scripts or of petsam."""
    if os.environ.get("PETSAM_LIBRARY"):
        return [os.environ["PETSAM_LIBRARY"]]
    folders = [TREE / "build" / "lib", PREFIX / "lib"]
    program = os.environ.get("PETSAM") or shutil.which("petsam")
    if program:
        folders.append(Path(program).resolve().parents[1] / "lib")
    # a wheel has the library only under the version of its interface
    names = ("libpetsam.so", "libpetsam.so." + ".".join(__version__.split(".")[:2]))
    return [*[str(folder / name) for folder in folders for name in names if (folder / name).exists()], "libpetsam.so"]


def _share_mpi():
    """Make MPI's symbols visible to the modules that it loads itself; HDF5's would disturb h5py's own."""
    try:
        with open("/proc/self/maps") as maps:
            names = {line.split()[-1] for line in maps if "/libmpi.so" in line}
    except OSError:
        return
    for name in names:
        ctypes.CDLL(name, mode=ctypes.RTLD_GLOBAL)


def _find():
    reason = ""
    for name in _candidates():
        try:
            found = ctypes.CDLL(name)
            for text in ("message", "warning", "field_name", "number_name", "step_name", "stress_name"):
                getattr(found, f"petsam_{text}").restype = ctypes.c_char_p
            found.petsam_destroy.restype = None
            found.petsam_creep_load.restype, found.petsam_creep_slip.restype = ctypes.c_void_p, ctypes.c_double
            return found
        except OSError as error:
            reason = reason or str(error)
        except AttributeError:
            reason = reason or f"{name} is another library, or an older one"
    raise Missing(
        f"no libpetsam ({reason}): it is sought as PETSAM_LIBRARY, in build/lib, beside these scripts, and in lib "
        "beside the bin of a petsam on the PATH"
    )


def library() -> ctypes.CDLL:
    """libpetsam, loaded once; Missing if there is none."""
    global _library
    with lock:
        if _library is None:
            found = _find()
            _share_mpi()
            _library = found
    return _library


def encoded(words):
    """Encodes text for the library, which would end it at a NUL."""
    if "\0" in words:
        raise ValueError(f"{short(repr(words))}: expected words without a NUL character")
    return words.encode()


def joined(function, names):
    """Encodes names for the library, which counts them by the commas between them: one name for each value."""
    for name in names:
        if not re.fullmatch(r"[^\s,;#\"]+", name):
            what = f"{short(repr(name))} is no name: give one name for each value, without commas or blanks"
            raise PrescribedError(2, f"{function}: {what}")
    try:
        command_line.one_case(names)
    except command_line.OptionError as error:
        raise PrescribedError(2, f"{function}: {error}") from None
    return encoded(",".join(names))


def real(value, name):
    """Returns a C double; TypeError names the argument."""
    try:
        return ctypes.c_double(value)
    except TypeError as error:
        raise TypeError(f"{name}: {error}: give a number in SI units") from None


def pointer(array):
    return array.ctypes.data_as(ctypes.c_void_p)

"""Checks a name before it is opened: a pipe would wait for ever, and a device never ends."""

import os
import stat

from .errors import FILE, Error, MissingFile


def need_regular(path):
    """Returns the status of a regular file; raises MissingFile if there is none, and Error if it is not a regular file.

    Raises another OSError if the file cannot be reached.
    """
    try:
        status = os.stat(path)
    except FileNotFoundError:
        raise MissingFile(path) from None
    except ValueError as error:  # a NUL in the name
        raise Error(f"{path}: is no file's name") from error
    if stat.S_ISDIR(status.st_mode):
        raise Error(f"{path}: is a directory")
    if not stat.S_ISREG(status.st_mode):
        raise Error(f"{path}: is not a regular file")
    return status


class Unwritable(Error):
    """A file that cannot be written."""

    code = FILE


def need_replaceable(path):
    """Raises Error if the name is not that of a regular file, and Unwritable if no file can be written there.

    Commands call it before their work, for each file that they will write.
    """
    if os.path.lexists(path) and os.path.exists(path):
        need_regular(path)
        if not os.access(path, os.W_OK):
            raise Unwritable(f"{path}: cannot be written: permission denied; choose another name")
        return
    need_folder(os.path.dirname(os.path.realpath(path)), path)


def need_folder(folder, path):
    """Raises Unwritable for the file of this path if no file can be made in its folder."""
    reason = None
    if not os.path.lexists(folder):
        reason = f"its folder {folder} does not exist"
    elif not os.path.isdir(folder):
        reason = f"its folder {folder} is a file"
    else:
        trial = os.path.join(folder, f".petsam.{os.getpid()}.tmp")  # permissions alone do not tell, as of root
        try:
            os.close(os.open(trial, os.O_CREAT | os.O_EXCL | os.O_WRONLY, 0o600))
            os.remove(trial)
        except OSError as error:
            reason = f"its folder {folder}: {error.strerror or error}"
    if reason:
        raise Unwritable(f"{path}: cannot be written: {reason}; make it, or choose another name")


def same(one, other):
    """Returns true if two names belong to the same existing file."""
    try:
        return os.path.samefile(one, other)
    except OSError:
        return False

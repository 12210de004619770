"""Checks a name before it is opened: a pipe would wait for ever, and a device never ends."""

import os
import stat

from .errors import Error, MissingFile


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


def need_replaceable(path):
    """Raises Error if the name is not that of a regular file."""
    if os.path.lexists(path) and os.path.exists(path):
        need_regular(path)


def same(one, other):
    """Returns true if two names belong to the same existing file."""
    try:
        return os.path.samefile(one, other)
    except OSError:
        return False

"""What a name stands for, before it is opened: a pipe would wait for ever, a device never ends."""

import os
import stat

from .errors import Error


def need_regular(path):
    """Status of a regular file; OSError where there is none, Error where it is something else."""
    try:
        status = os.stat(path)
    except ValueError as error:  # a NUL in the name
        raise Error(f"{path}: is no file's name") from error
    if stat.S_ISDIR(status.st_mode):
        raise Error(f"{path}: is a directory")
    if not stat.S_ISREG(status.st_mode):
        raise Error(f"{path}: is not a regular file")
    return status


def need_replaceable(path):
    """Error where the name is that of something which is not a regular file."""
    if os.path.lexists(path) and os.path.exists(path):
        need_regular(path)


def same(one, other):
    """Whether two names are those of one file that exists."""
    try:
        return os.path.samefile(one, other)
    except OSError:
        return False

"""Errors that the commands report in one line: their message says all that a user needs."""

import sys

USAGE, FILE = 2, 3  # exit codes, as petsam's


class Error(Exception):
    """Something that cannot be read, found or understood."""


class Missing(Error):
    """A file, a program or a library that is not there."""


def fail(command, error, code=FILE):
    """Print the error of a command; the exit code."""
    if isinstance(error, OSError):
        error = f"{error.filename or 'writing'}: {error.strerror}"
    print(f"{command}: error: {error}", file=sys.stderr)
    return code

"""Errors that the commands report in one line: their message contains all that a user needs."""

import argparse
import difflib
import errno
import importlib
import os
import re
import sys

USAGE, FILE = 2, 3  # exit codes, as in petsam
UNEXPECTED = 1
INTERRUPTED = 130
TRACEBACK = "PETSAM_TRACEBACK"  # environment variable: print the traceback of an unexpected error
LINE = 4000  # maximum characters of a message


class Error(Exception):
    """A file or value that cannot be read, found or understood; lines of an example are printed below the message."""

    example = ()


class Useless(Error):
    """An option that has no effect, or that leaves nothing: bad usage."""


class Missing(Error):
    """A missing file, program or library."""


class MissingFile(Missing, FileNotFoundError):
    """A missing file, which is a FileNotFoundError, too.

    Parameters
    ----------
    path : path
        The file.

    Attributes
    ----------
    filename : str
        The file.
    """

    code = FILE

    def __init__(self, path: str) -> None:
        super().__init__(errno.ENOENT, "no such file", os.fspath(path))

    def __str__(self):
        return f"{self.filename}: {self.strerror}"

    def __reduce__(self):
        return type(self), (self.filename,)


def library(name):
    """A library that only one form of results needs; Missing says how it is installed."""
    try:
        return importlib.import_module(name)
    except ImportError as error:
        raise Missing(f"{name} is not installed: {sys.executable} -m pip install {name}") from error


def one_line(text, most=LINE):
    """Returns the text without line breaks and characters that a terminal cannot show; a long one is cut."""
    text = str(text)
    if len(text) > most:
        half = (most - 5) // 2
        text = text[:half] + " ... " + text[-half:]
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode("ascii") for c in text)


def short(text):
    """Returns the same for a part of a message that comes from a file."""
    return one_line(text, 80)


def counted(count, noun):
    """A number with its noun, such as 1 case, 2 cases."""
    return f"{count} {noun}" + "s" * (count != 1)


def there_are(tried, names, there="there are"):
    """Returns the end of a message about an unknown name: a similar name, if there is one, and all names."""
    names, tried = list(names), str(tried)
    near = difflib.get_close_matches(tried, names, 1) or [name for name in names if tried in name.split("_")][:3]
    have = f"{there} {', '.join(names)}" if names else f"{there} none"
    return f": is {' or '.join(near)} meant? {have[0].upper() + have[1:]}" if near else f"; {have}"


def fail(command, error, code=FILE):
    """Prints the error of a command; returns the exit code."""
    if isinstance(error, OSError) and not isinstance(error, Error):
        error = f"{error.filename or 'writing'}: {error.strerror or error}"
    print(f"{command}: error: {one_line(error)}", file=sys.stderr)
    for line in getattr(error, "example", ()):
        print("  " + line, file=sys.stderr)
    return code


class Parser(argparse.ArgumentParser):
    """A command line whose errors are printed in one line, without the usage before it."""

    def error(self, message):
        """Ends with the message; for an unknown option adds a similar one, if there is one."""
        self.exit(fail(self.prog, f"{message}{self.meant(message)}; see {self.prog} --help", USAGE))

    def meant(self, message):
        """Returns an option similar to the first one that a message does not recognize."""
        found = re.match(r"unrecognized arguments: --?([a-z][\w-]*)", message)
        names = [name for name in self._option_string_actions if name.startswith("--")]
        near = found and difflib.get_close_matches("--" + found[1].replace("_", "-"), names, 1)
        return f": is {near[0]} meant?" if near else ""


def joined(words):
    """Joins values that begin with a minus to their options, as argparse would take them for options."""
    found = []
    for word in words:
        if found and re.match(r"-[\d.]", word) and re.fullmatch(r"--[a-z][a-z-]*", found[-1]):
            found[-1] += "=" + word
        else:
            found.append(word)
    return found


def _flush():
    """Flushes the output here, not when Python ends and errors could not be reported."""
    try:
        sys.stdout.flush()
    except OSError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        raise


def guarded(command, body):
    """Returns the exit code of body(), which is a command; unexpected errors end with a line, too."""
    for number, name in enumerate(("stdin", "stdout", "stderr")):
        if getattr(sys, name) is None:  # closed: the next opened file would get its number
            setattr(sys, name, os.fdopen(os.open(os.devnull, os.O_RDWR), "r" if number == 0 else "w"))
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="backslashreplace")  # names of files may not be text
    try:
        try:
            return body()
        finally:
            _flush()
    except KeyboardInterrupt:
        return INTERRUPTED
    except OSError as error:
        return fail(command, error)
    except Exception as error:
        if os.environ.get(TRACEBACK):
            raise
        text = f"unexpected {type(error).__name__}: {error} (set {TRACEBACK}=1 to see where)"
        return fail(command, text, UNEXPECTED)

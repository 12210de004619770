"""Errors that the commands report in one line: their message contains all that a user needs."""

import argparse
import difflib
import os
import re
import sys

USAGE, FILE = 2, 3  # exit codes, as petsam's
UNEXPECTED = 1
INTERRUPTED = 130
TRACEBACK = "PETSAM_TRACEBACK"  # environment variable: show where an unexpected error comes from
LINE = 4000  # characters of a message at most


class Error(Exception):
    """Something that cannot be read, found or understood; lines of an example are printed below the message."""

    example = ()


class Missing(Error):
    """A file, a program or a library that is not there."""


def one_line(text, most=LINE):
    """The text without line breaks and what else a terminal cannot show, cut in the middle when it is long."""
    text = str(text)
    if len(text) > most:
        half = (most - 5) // 2
        text = text[:half] + " ... " + text[-half:]
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode("ascii") for c in text)


def short(text):
    """The same for a part of a message that comes from a file."""
    return one_line(text, 80)


def counted(count, noun):
    """A number with its noun, such as 1 case, 2 cases."""
    return f"{count} {noun}" + "s" * (count != 1)


def there_are(tried, names, there="there are"):
    """The end of a message about a name that does not exist: which one is meant, if one is near, and all that do."""
    names, tried = list(names), str(tried)
    near = difflib.get_close_matches(tried, names, 1) or [name for name in names if tried in name.split("_")][:3]
    have = f"{there} {', '.join(names)}" if names else f"{there} none"
    return f": is {' or '.join(near)} meant? {have[0].upper() + have[1:]}" if near else f"; {have}"


def fail(command, error, code=FILE):
    """Print the error of a command; the exit code."""
    if isinstance(error, OSError):
        error = f"{error.filename or 'writing'}: {error.strerror or error}"
    print(f"{command}: error: {one_line(error)}", file=sys.stderr)
    for line in getattr(error, "example", ()):
        print("  " + line, file=sys.stderr)
    return code


class Parser(argparse.ArgumentParser):
    """A command line whose errors are one line as all others are, without the usage before it."""

    def error(self, message):
        """End with the message; of an unknown option with that which is meant, if one is near."""
        self.exit(fail(self.prog, f"{message}{self.meant(message)}; see {self.prog} --help", USAGE))

    def meant(self, message):
        """Which option may be meant by the first one that a message does not recognize."""
        found = re.match(r"unrecognized arguments: --?([a-z][\w-]*)", message)
        names = [name for name in self._option_string_actions if name.startswith("--")]
        near = found and difflib.get_close_matches("--" + found[1].replace("_", "-"), names, 1)
        return f": is {near[0]} meant?" if near else ""


def joined(words):
    """Words in which a value that begins with a minus is joined to its option: argparse would take it for one."""
    found = []
    for word in words:
        if found and re.match(r"-[\d.]", word) and re.fullmatch(r"--[a-z][a-z-]*", found[-1]):
            found[-1] += "=" + word
        else:
            found.append(word)
    return found


def _flush():
    """What has been printed reaches its destination here, not when Python ends, where nobody could report it."""
    try:
        sys.stdout.flush()
    except OSError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        raise


def guarded(command, body):
    """Exit code of body(), which is a command: errors that it does not foresee end with a line, too."""
    for number, name in enumerate(("stdin", "stdout", "stderr")):
        if getattr(sys, name) is None:  # closed: the next file to be opened would get its number
            setattr(sys, name, os.fdopen(os.open(os.devnull, os.O_RDWR), "r" if number == 0 else "w"))
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="backslashreplace")  # names of files need not be text
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

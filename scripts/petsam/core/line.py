"""Common parts of all command lines: the parser, reading of words, the picture's options, errors and exit codes."""

import argparse
import os
import re
import sys
import warnings

from . import words
from .errors import FILE, LINE, USAGE, Error, nearest, short

DPI = 150  # pixels per inch of a PNG: for the screen
RANGE = (10, 1200)
UNEXPECTED = 1  # exit codes beside those of core/errors.py
INTERRUPTED = 130
TRACEBACK = "PETSAM_TRACEBACK"  # environment variable: print the traceback of an unexpected error


def word(reader, /, *given, besides=(), to=None, **options):
    """A reader for argparse's type of one that takes a word first, and then these arguments, as those of core/words.py:
    its errors become argparse's, which name the option. Words of `besides` stay as they are; `to` makes the option's
    value of what is read."""

    def read(text):
        try:
            if text in besides:
                return text
            found = reader(text, *given, **options)
            return found if to is None else to(found)
        except Error as error:
            raise argparse.ArgumentTypeError(str(error)) from error

    return read


class Parser(argparse.ArgumentParser):
    """A command line whose errors are printed in one line, without the usage before it. Names of options are given in
    full, and an unknown one is reported before all else; its description keeps its lines unless another formatter_class
    is given. `texts`: options whose values may be any word that begins with a minus."""

    def __init__(self, *, texts=(), formatter_class=argparse.RawDescriptionHelpFormatter, **given):
        super().__init__(formatter_class=formatter_class, allow_abbrev=False, **given)
        self.texts = texts

    def parse_known_args(self, args=None, namespace=None):
        args = self.joined(sys.argv[1:] if args is None else args)
        self._need_known(args)
        return super().parse_known_args(args, namespace)

    def _need_known(self, words):
        """Ends with a message where options are unknown, unless help is asked for."""
        words = words[: words.index("--")] if "--" in words else words
        unknown = [word for word in words if self._is_unknown(word)]
        if unknown and not {"-h", "--help"} & {*words}:
            self.error("unrecognized arguments: " + " ".join(unknown))

    def _is_unknown(self, word):
        known = self._option_string_actions
        if not re.match(r"-[^\d.]", word) or " " in word or word.partition("=")[0] in known:
            return False
        return word.startswith("--") or word[:2] not in known

    def error(self, message):
        """Ends with the message; for an unknown option adds a similar one, if there is one."""
        self.exit(fail(self.prog, f"{message}{self.meant(message)}; see {self.prog} --help", USAGE))

    def meant(self, message):
        """Returns an option similar to the first one that a message does not recognize."""
        found = re.match(r"unrecognized arguments: --?([a-zA-Z][\w-]*)", message)
        names = [name[2:] for name in self._option_string_actions if name.startswith("--")]
        near = found and nearest(found[1], names)
        return f": is --{near[0]} meant?" if near else ""

    def joined(self, words):
        """Joins values that begin with a minus to their options, as argparse would take them for options: numbers, and
        any word after the options of `texts`."""
        found = []
        for word in words:
            before = found[-1] if found else ""
            if before in self.texts or (re.match(r"-[\d.]", word) and re.fullmatch(r"--[a-z][a-z0-9-]*", before)):
                found[-1] += "=" + word
            else:
                found.append(word)
        return found

    def add_resolution(self, group=None):
        """Adds --dpi, to a group of options if it is given."""
        form = "a whole number from {} to {}".format(*RANGE)
        kind = word(words.integer, form, least=RANGE[0], most=RANGE[1])
        text = "pixels per inch of a PNG, {} to {} ({}); journals ask for 300".format(*RANGE, DPI)
        (group or self).add_argument("--dpi", type=kind, default=DPI, metavar="N", help=text)

    def add_cycles(self, group, turns, period):
        """Adds --turns and --period to a group of options, the two ways to find cycles, with what they say of them;
        a period has its start, or None."""
        how = group.add_mutually_exclusive_group()
        how.add_argument("--turns", metavar="NAME", help=turns)
        kind = word(
            words.numbers, "a time above 0, or T,START: 20ms,1s", "s", count=(1, 2),
            together=lambda found: found[0] > 0.0, to=lambda found: (*found, None)[:2],
        )  # fmt: skip
        how.add_argument("--period", type=kind, metavar="T[,START]", help=period)

    def add_choice(self, group):
        """Adds --no-picture to a group of options, and --dpi, which has no meaning beside it."""
        one = group.add_mutually_exclusive_group()
        one.add_argument("--no-picture", action="store_true", help="draw none")
        self.add_resolution(one)


def wrote(*names):
    """Prints a line for each file that a command has written."""
    for name in names:
        print(f"wrote {name}")


def fail(command, error, code=FILE):
    """Prints the error of a command; returns the exit code."""
    if isinstance(error, OSError) and not isinstance(error, Error):
        error = f"{error.filename or 'writing'}: {error.strerror or error}"
    print(f"{command}: error: {short(error, LINE)}", file=sys.stderr)
    for line in getattr(error, "example", ()):
        print("  " + line, file=sys.stderr)
    return code


def _flush():
    """Flushes the output here, not when Python ends and errors could not be reported."""
    try:
        sys.stdout.flush()
    except OSError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        raise


def guarded(command, body, quiet=False):
    """Returns the exit code of body(), which is a command, 0 of none; unexpected errors end with a line, too. `quiet`:
    without warnings of numbers that overflow and of letters that a font lacks."""
    for number, name in enumerate(("stdin", "stdout", "stderr")):
        if getattr(sys, name) is None:  # closed: the next opened file would get its number
            setattr(sys, name, os.fdopen(os.open(os.devnull, os.O_RDWR), "r" if number == 0 else "w"))
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="backslashreplace")  # names of files may not be text
    try:
        try:
            with warnings.catch_warnings():
                if quiet:
                    warnings.simplefilter("ignore")
                return body() or 0
        finally:
            _flush()
    except KeyboardInterrupt:
        return INTERRUPTED
    except (Error, OSError) as error:
        return fail(command, error, getattr(error, "code", FILE))
    except Exception as error:
        if os.environ.get(TRACEBACK):
            raise
        text = f"unexpected {type(error).__name__}: {error} (set {TRACEBACK}=1 to see where)"
        return fail(command, text, UNEXPECTED)

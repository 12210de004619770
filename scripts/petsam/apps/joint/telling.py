"""Lines that the actions of petsam-joint print: numbers, the warnings of a computation; and the page of --report."""

import contextlib
import sys
import warnings

from ...core.line import wrote

OF_FILES = ("output", "report", "dpi")  # options of the written files


@contextlib.contextmanager
def recorded(kind):
    """Collects warnings, all of this kind, for tell()."""
    with warnings.catch_warnings(record=True) as found:
        warnings.simplefilter("always", kind)
        yield found


def write_page(args, result):
    """Writes the page of --report, if it is given, with the options as inputs."""
    if args.report:
        result.report(args.report, _given(args))
        wrote(args.report)


def _given(args):
    """{name: text} of the action, the file, and the options as they are given, but those of the written files."""
    shown, rest = {"action": args.action, "file": args.file}, iter(args.given)
    for one in rest:
        if not one.startswith("--"):
            continue
        option, _, value = one.partition("=")
        name = option[2:]
        if getattr(args, name.replace("-", "_")) is True:
            value = "yes"
        value = value or next(rest, "")
        if name not in OF_FILES:
            shown[name] = f"{shown[name]}, {value}" if name in shown else value
    return shown


def tell(result, found):
    """Prints the table and the warnings."""
    print("\n".join(result.lines()))
    for text in dict.fromkeys(str(one.message).strip() for one in found):
        print(f"petsam-joint: warning: {text}", file=sys.stderr)

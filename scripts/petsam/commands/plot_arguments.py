"""The command line of petsam-plot."""

import argparse
import math
import os
import re
import sys

from ..core.errors import short
from ..plot import bodies
from ..results.cycles import PAIRS, read_period
from .line import Parser, add_resolution, joined

FORMATS = (".png", ".pdf", ".svg")
WIDTHS = (30.0, 2000.0)  # mm of a picture
SCALES = ("colors", "x", "y")  # that may be logarithmic


def numbers(kind):
    """Reader of a comma-separated list for argparse."""

    def read(text):
        try:
            return [kind(word) for word in text.split(",")]
        except ValueError as error:
            reason = "expected numbers separated by commas" if kind is float else "expected whole numbers and commas"
            raise argparse.ArgumentTypeError(f"{short(text) or repr('')}: {reason}") from error

    return read


def steps(text):
    """Reader of FIRST:LAST for argparse; None where one is left out."""
    parts = text.split(":")
    try:
        first, last = (int(part) if part.strip() else None for part in parts)
    except ValueError:
        first = last = None
    if (first, last) == (None, None) or 0 in (first, last):
        raise argparse.ArgumentTypeError(f"{short(text) or repr('')}: expected load steps FIRST:LAST, FIRST: or :LAST")
    return first, last


def point(text):
    """Reader of a point X,Y for argparse."""
    values = numbers(float)(text)
    if len(values) != 2:
        raise argparse.ArgumentTypeError(f"{short(text)}: expected X,Y")
    return values


def limits(text):
    """Reader of LOW,HIGH for argparse."""
    values = numbers(float)(text)
    if len(values) != 2 or not all(map(math.isfinite, values)) or not values[0] < values[1]:
        raise argparse.ArgumentTypeError(f"{short(text)}: expected LOW,HIGH, the lower one first")
    return values


def period(text):
    """Reader of T or T,START for argparse."""
    try:
        return read_period(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{short(text)}: expected a positive time, or T,START, in s") from None


def measured(text):
    """Reader of a body, 1: or 2:, which may be left out, and a file for argparse."""
    if not text or re.fullmatch(r"\d:.*", text) and (text[0] not in "12" or not text[2:]):
        raise argparse.ArgumentTypeError(f"{short(text) or repr('')}: expected a file, or 1:FILE, 2:FILE")
    return (text[0], text[2:]) if re.match("[12]:", text) else ("", text)


def percentile(text):
    """Reader of a percentile for argparse."""
    values = numbers(float)(text)
    if len(values) != 1 or not 0.0 < values[0] <= 100.0:
        raise argparse.ArgumentTypeError(f"{short(text)}: expected a number above 0, at most 100")
    return values[0]


def width(text):
    """Reader of a picture's width, mm, for argparse."""
    values = numbers(float)(text)
    if len(values) != 1 or not WIDTHS[0] <= values[0] <= WIDTHS[1]:
        raise argparse.ArgumentTypeError("{}: expected millimetres from {:g} to {:g}".format(short(text), *WIDTHS))
    return values[0]


def names(text):
    """Reader of a list of names for argparse."""
    words = text.split(",")
    if not text or not all(words) and len(words) == 1:
        raise argparse.ArgumentTypeError("expected names separated by commas")
    return words


def scales(text):
    """Reader of what is logarithmic for argparse."""
    words = text.split(",")
    for word in words:
        if word not in SCALES:
            raise argparse.ArgumentTypeError(f"{short(word) or repr('')}: expected {', '.join(SCALES)}")
    return words


def condition(text):
    """Reader of NAME=VALUE for argparse."""
    name, equal, value = text.partition("=")
    if not (name and equal and value):
        raise argparse.ArgumentTypeError(f"{short(text) or repr('')}: expected NAME=VALUE")
    return name, value


def limit(text):
    """Reader of NAME=VALUE, with a number, for argparse."""
    name, value = condition(text)
    values = numbers(float)(value)
    if len(values) != 1 or not math.isfinite(values[0]):
        raise argparse.ArgumentTypeError(f"{short(text)}: expected NAME=VALUE with one number")
    return name, values[0]


class _Scalars(argparse.Action):
    """Keeps the spelling of the option, too: messages name it."""

    def __call__(self, parser, namespace, values, option_string=None):
        namespace.scalar, namespace.spelling = values, option_string


def _pictures(parser):
    kinds = parser.add_argument_group("pictures")
    kinds.add_argument("--maps", action="store_true", help="fields over the surface; stresses over planes")
    kinds.add_argument("--profiles", action="store_true", help="fields along x and y; a stress on the surface")
    kinds.add_argument("--sections", action="store_true", help="von Mises and another stress over depth")
    kinds.add_argument("--component", choices=bodies.COMPONENTS, help="that other stress (xx)")
    kinds.add_argument("--fatigue", action="store_true", help="fatigue parameters, with the place of the maximum")
    kinds.add_argument("--loop", action="store_true", help="a load over its displacement, of --cycle or of all steps")
    kinds.add_argument("--load", choices=tuple(PAIRS), help="the loops' load (that which does the most work)")
    kinds.add_argument("--energy", action="store_true", help="dissipated energy of every cycle")
    kinds.add_argument("--history", action="store_true", help="scalars over time or a creepage, or over --against")
    kinds.add_argument("--fretting-log", action="store_true", help="loops of up to eight cycles, with their energy")
    kinds.add_argument("--scar", action="store_true", help="removed depth along x and y through its deepest point")
    kinds.add_argument(
        "--measured", type=measured, metavar="[BODY:]FILE.csv",
        help="heights of a worn surface beside its scar: columns with their units, x first: x_mm,height_um "
        "(of the last body that wears)",
    )  # fmt: skip
    kinds.add_argument("--life", action="store_true", help="volume, depth, energy, area and pressure over cycles")


def _quantities(parser):
    what = parser.add_argument_group("what is drawn")
    what.add_argument(
        "--field", type=names, metavar="NAME,...",
        help="fields of maps and profiles, by the names in the file; NAME of NAME_x and NAME_y is the magnitude "
        "(pressure, shear, slip, state)",
    )  # fmt: skip
    what.add_argument(
        "--scalar", "--names", dest="scalar", type=names, action=_Scalars, metavar="NAME,...",
        help="scalars of /history, of a matrix stiffness.load_tx.disp_x, or columns of a study (those that vary)",
    )  # fmt: skip
    what.add_argument(
        "--against",
        metavar="NAME",
        help="over which scalar, or column (time; the creepage that varies; the input with most values); "
        "of a study X,Y: a map of --scalar (the regime)",
    )
    what.add_argument("--by", metavar="NAME", help="of a study: the column that the curves' colours stand for")
    what.add_argument(
        "--where", type=condition, action="append", default=[], metavar="NAME=VALUE",
        help="of a study: only cases with this value",
    )  # fmt: skip
    what.add_argument(
        "--border", type=limit, action="append", default=[], metavar="NAME=VALUE",
        help="of a map of a study: a line where this column has the value",
    )  # fmt: skip


def _steps(parser):
    title = "steps (the last saved; of a scar all saved cycles)"
    group = parser.add_argument_group(title)
    which = group.add_mutually_exclusive_group()
    which.add_argument(
        "--step", type=numbers(int), metavar="K,...", help="load steps from 1, as petsam prints them; -1 is the last"
    )
    which.add_argument("--time", type=numbers(float), metavar="T,...", help="the saved steps nearest to times, s")
    which.add_argument(
        "--cycle", type=numbers(float), metavar="C,...",
        help="cycles from 1, -1 is the last: their loops, or ends; of a wear simulation the saved cycles nearest to C",
    )  # fmt: skip
    group.add_argument(
        "--range", type=steps, metavar="FIRST:LAST",
        help="only these load steps in histories and loops, from 1, -1 is the last: 33: leaves out the first 32",
    )  # fmt: skip
    title = "cycles (by reversals of the displacement that does the most work)"
    how = parser.add_argument_group(title).add_mutually_exclusive_group()
    how.add_argument("--turns", metavar="NAME", help="by reversals of another scalar of /history")
    how.add_argument(
        "--period",
        type=period,
        metavar="T[,START]",
        help="by time, s (START: 0, or the first time if that is later than T)",
    )


def _look(parser):
    look = parser.add_argument_group("look")
    look.add_argument(
        "--at", type=point, metavar="X,Y", help="where profiles cross, m (0,0; a scar's: where it is deepest)"
    )
    look.add_argument("--depth", type=numbers(float), metavar="Z,...", help="planes of stresses nearest to z, m (some)")
    look.add_argument("--whole-grid", action="store_true", help="maps and profiles of the grid, not of the contact")
    look.add_argument(
        "--limits", type=limits, metavar="LOW,HIGH", help="of the one --field, or --component, in SI units"
    )
    look.add_argument(
        "--percentile", type=percentile, metavar="P",
        help="colours up to this percentile of the cells that are not 0 (100, less where peaks would darken the rest)",
    )  # fmt: skip
    for letter in "xy":
        look.add_argument(
            f"--{letter}lim", type=limits, metavar="LOW,HIGH", help=f"part of the {letter} axis, in SI units"
        )
    look.add_argument(
        "--width",
        type=width,
        metavar="MM",
        help="width of the picture, mm; texts are scaled, to no less than 4.5 points",
    )
    look.add_argument("--log", type=scales, default=[], metavar="WHAT,...", help="logarithmic colors, x, y")
    look.add_argument("--labels", metavar="TEXT,...", help="the files' names in the pictures (their file names)")
    look.add_argument("-o", "--output", metavar="NAME", help="name of the picture; it may end in .png, .pdf or .svg")
    look.add_argument("--csv", metavar="NAME.csv", help="write the numbers of all that is drawn")
    look.add_argument("--format", choices=[end[1:] for end in FORMATS], help="instead of an end of the name (png)")
    add_resolution(look)


def _check(parser, options):
    """End with a message where options do not go together."""
    if options.labels and len(options.labels.split(",")) != len(options.files):
        parser.error(f"--labels: expected as many as files, {len(options.files)}")
    ending = os.path.splitext(options.output or "")[1].lower()
    if re.fullmatch(r"\.[a-z]\w*", ending) and ending not in FORMATS:
        formats = ", ".join(FORMATS[:-1]) + " or " + FORMATS[-1]
        parser.error(f"--output {short(options.output)}: expected a name that ends in {formats}, or has no ending")
    if options.format and ending in FORMATS and ending != "." + options.format:
        parser.error(f"--format {options.format}: contradicts the ending of {options.output}: remove one of the two")
    if options.limits and len(options.field or ()) != 1 and not options.component:
        parser.error("--limits: is for one field or stress; name it by --field, or --component")
    if options.limits and options.percentile:
        parser.error("--percentile: not allowed with --limits")


def _read(parser, words):
    parser.add_argument(
        "files", nargs="+", metavar="FILE.h5", help="of petsam, petsam-stress or petsam-study; several are compared"
    )
    for group in (_pictures, _quantities, _steps, _look):
        group(parser)
    parser.set_defaults(spelling="--scalar")
    options = parser.parse_args(joined(words))
    _check(parser, options)
    return options


def read(description):
    """Read the command line."""
    form = argparse.RawDescriptionHelpFormatter
    return _read(Parser(prog="petsam-plot", description=description, formatter_class=form), sys.argv[1:])

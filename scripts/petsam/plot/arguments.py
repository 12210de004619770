"""The command line of petsam-plot."""

import argparse
import os
import re
import sys
from functools import partial

from ..core import words
from ..core.errors import short
from ..core.line import Parser, word
from ..results.cycles import PAIRS
from . import bodies, page

FORMATS = (".png", ".pdf", ".svg")
WIDTHS = (0.03, 2.0)  # m of a picture
SCALES = ("colors", "x", "y")  # that may be logarithmic


# readers of words, which several commands have
POINT = word(words.numbers, "X,Y, such as 0.1mm,0", "m", count=2)
LIMITS = word(words.limits)
NAMES = word(words.names)


def numbers(unit="1", example="numbers separated by commas"):
    """Reader of numbers of a unit, separated by commas."""
    return word(words.numbers, example, unit)


def measured(text):
    """A body, 1: or 2:, which may be left out, and a file."""
    if not text or re.fullmatch(r"\d:.*", text) and (text[0] not in "12" or not text[2:]):
        raise words.WordError(text, "a file, or 1:FILE, 2:FILE")
    return (text[0], text[2:]) if re.match("[12]:", text) else ("", text)


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
        "--measured", type=word(measured), metavar="[BODY:]FILE.csv",
        help="heights of a worn surface beside its scar: columns with their units, x first: x [mm],height [um] "
        "(of the last body that wears)",
    )  # fmt: skip
    kinds.add_argument("--life", action="store_true", help="volume, depth, energy, area and pressure over cycles")
    kinds.add_argument(
        "--gradient", action="store_true", help="where 1 um and friction count: change of the numbers of -gradient"
    )


def _quantities(parser):
    what = parser.add_argument_group("what is drawn")
    what.add_argument(
        "--field", type=NAMES, metavar="NAME,...",
        help="fields of maps and profiles, by the names in the file; NAME of NAME_x and NAME_y is the magnitude "
        "(pressure, shear, slip, state)",
    )  # fmt: skip
    what.add_argument(
        "--scalar", "--names", dest="scalar", type=NAMES, action=_Scalars, metavar="NAME,...",
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
        "--where", type=word(words.named, "NAME=VALUE", reader=str), action="append", default=[], metavar="NAME=VALUE",
        help="of a study: only cases with this value",
    )  # fmt: skip
    one = partial(words.measured, form="a number", count=1)
    border = word(words.named, "NAME=VALUE with one number", reader=one)
    what.add_argument(
        "--border", type=border, action="append", default=[], metavar="NAME=VALUE",
        help="of a map of a study: a line where this column has the value",
    )  # fmt: skip


def _steps(parser):
    title = "steps (the last saved; of a scar all saved cycles)"
    group = parser.add_argument_group(title)
    which = group.add_mutually_exclusive_group()
    which.add_argument(
        "--step",
        type=word(words.integers),
        metavar="K,...",
        help="load steps from 1, as petsam prints them; -1 is the last",
    )
    which.add_argument("--time", type=numbers("s", "times separated by commas, such as 20ms,40ms"), metavar="T,...",
        help="the saved steps nearest to times, s",
    )  # fmt: skip
    which.add_argument(
        "--cycle", type=numbers(), metavar="C,...",
        help="cycles from 1, -1 is the last: their loops, or ends; of a wear simulation the saved cycles nearest to C",
    )  # fmt: skip
    steps = word(words.bounds, "load steps FIRST:LAST, FIRST: or :LAST", allowed=bool, together=any)
    group.add_argument(
        "--range", type=steps, metavar="FIRST:LAST",
        help="only these load steps in histories and loops, from 1, -1 is the last: 33: leaves out the first 32",
    )  # fmt: skip
    title = "cycles (by reversals of the displacement that does the most work)"
    parser.add_cycles(
        parser.add_argument_group(title), "by reversals of another scalar of /history",
        "by time, such as 20ms (START: 0, or the first time if that is later than T)",
    )  # fmt: skip


def _look(parser):
    look = parser.add_argument_group("look")
    look.add_argument(
        "--at",
        type=POINT,
        metavar="X,Y",
        help="where profiles cross, such as 0.1mm,0 (0,0; a scar's: where it is deepest)",
    )
    look.add_argument("--depth", type=numbers("m", "depths separated by commas, such as 0.1mm,0.2mm"), metavar="Z,...",
        help="planes of stresses nearest to these depths (some)",
    )  # fmt: skip
    look.add_argument(
        "--whole-grid", action="store_true", help="maps, profiles and gradients of the grid, not of the contact"
    )
    look.add_argument(
        "--limits", type=LIMITS, metavar="LOW,HIGH", help="of the one --field, or --component: -50MPa,50MPa"
    )
    look.add_argument(
        "--percentile", metavar="P",
        type=word(words.number, "a number above 0, at most 100", above=0.0, most=100.0),
        help="colours up to this percentile of the cells that are not 0 (100, less where peaks would darken the rest)",
    )  # fmt: skip
    for letter in "xy":
        look.add_argument(
            f"--{letter}lim", type=LIMITS, metavar="LOW,HIGH", help=f"part of the {letter} axis, such as 0,2mm"
        )
    form = "millimetres from {:g} to {:g}, or a length such as 9cm".format(*(1e3 * width for width in WIDTHS))
    look.add_argument(
        "--width",
        type=word(words.number, form, "m", least=WIDTHS[0], most=WIDTHS[1], bare="mm", to=lambda metres: 1e3 * metres),
        metavar="MM",
        help="width of the picture, mm; texts are scaled, to no less than 4.5 points",
    )
    look.add_argument(
        "--log",
        type=word(words.names, ", ".join(SCALES), known=SCALES),
        default=[],
        metavar="WHAT,...",
        help="logarithmic colors, x, y",
    )
    look.add_argument("--labels", metavar="TEXT,...", help="the files' names in the pictures (their file names)")
    look.add_argument("-o", "--output", metavar="NAME", help="name of the picture; it may end in .png, .pdf or .svg")
    look.add_argument("--csv", metavar="NAME.csv", help="write the numbers of all that is drawn")
    look.add_argument(
        "--report", type=word(page.name), metavar="NAME.html",
        help="write one page instead of pictures: inputs, numbers, errors, check, history, and the pictures",
    )  # fmt: skip
    look.add_argument("--format", choices=[end[1:] for end in FORMATS], help="instead of an end of the name (png)")
    parser.add_resolution(look)


def _check_report(parser, options):
    """End with a message where options do not go together with a page."""
    if len(options.files) > 1:
        parser.error(f"--report {short(options.report)}: is of one file; {len(options.files)} are given")
    for name in ("output", "csv", "format"):
        if getattr(options, name):
            parser.error(f"--{name}: not allowed with --report, which writes one page")


def _check(parser, options):
    """End with a message where options do not go together."""
    if options.report:
        _check_report(parser, options)
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


def _read(parser, given):
    parser.add_argument(
        "files",
        nargs="+",
        metavar="FILE.h5",
        help="of petsam, petsam-stress or petsam-study; several are compared; also an application's table for a report",
    )
    for group in (_pictures, _quantities, _steps, _look):
        group(parser)
    parser.set_defaults(spelling="--scalar")
    options = parser.parse_args(given)
    _check(parser, options)
    return options


def read(description):
    """Read the command line."""
    return _read(Parser(prog="petsam-plot", description=description), sys.argv[1:])

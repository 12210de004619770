"""Draw what petsam has computed: maps, profiles, fretting loops, histories, wear; stresses of petsam-stress, fatigue.

    petsam-plot sphere.h5                          all pictures that the file is good for
    petsam-plot --loop -o loop.pdf a.h5 b.h5       one picture, two files compared
    petsam-plot --maps --step 20,-1 strokes.h5     two steps below each other
    petsam-plot --scar --cycle 0,1e5,1e6 life.h5    removed depth at three saved cycles of a life
    petsam-plot --sections --component xx stress.h5     stresses under the surface, by petsam-stress

Without a kind given, maps and profiles of the last saved step are drawn, and of several solved load steps the loop
and the history too; of a life of many cycles (-wear_cycles) its fretting log, scar and life instead of these; of a file
of petsam-stress its section or maps, the profile, and fatigue parameters if it has them.
Each picture is a file NAME_maps.png and so on; NAME is the first file's, in the current directory.
"""

import argparse
import os
import warnings

from .. import isolation
from ..errors import Error, Parser, fail, guarded, short
from ..files import need_replaceable, same
from ..results import DAMAGED, NotSaved
from ..stresses import Stresses, open_any
from . import bodies, pictures, wear
from .style import STYLE, plt

OF_LIFE = ("fretting-log", "scar", "life")
OF_RESULTS = ("maps", "profiles", "loop", "history", *OF_LIFE)
OF_STRESSES = ("maps", "sections", "profiles", "fatigue")
KINDS = tuple(dict.fromkeys(OF_STRESSES[:3] + OF_RESULTS + OF_STRESSES))  # in the order in which they are drawn
FORMATS = (".png", ".pdf")
ORIGIN = (0.0, 0.0)
DPI = (10, 1200)
PIXELS = 300e6  # of a PNG at most: matplotlib holds them all


def numbers(kind):
    """Reader of a comma-separated list for argparse."""

    def read(text):
        try:
            return [kind(word) for word in text.split(",")]
        except ValueError as error:
            reason = "expected numbers separated by commas" if kind is float else "expected whole numbers and commas"
            raise argparse.ArgumentTypeError(f"{short(text) or repr('')}: {reason}") from error

    return read


def point(text):
    """Reader of a point X,Y for argparse."""
    values = numbers(float)(text)
    if len(values) != 2:
        raise argparse.ArgumentTypeError(f"{short(text)}: expected X,Y")
    return values


def resolution(text):
    """Reader of the pixels an inch for argparse."""
    try:
        value = int(text)
    except ValueError:
        value = 0
    if not DPI[0] <= value <= DPI[1]:
        raise argparse.ArgumentTypeError("{}: expected a whole number from {} to {}".format(short(text), *DPI))
    return value


def arguments():
    """Read the command line."""
    parser = Parser(prog="petsam-plot", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="+", metavar="FILE.h5", help="of petsam or petsam-stress; several are compared")
    kinds = parser.add_argument_group("pictures")
    kinds.add_argument(
        "--maps", action="store_true", help="pressure, shear, slip, state, wear over the surface; stresses over planes"
    )
    kinds.add_argument(
        "--profiles", action="store_true", help="pressure, shear, slip, wear along x and y; a stress on the surface"
    )
    kinds.add_argument("--sections", action="store_true", help="von Mises and another stress over depth")
    kinds.add_argument("--component", choices=bodies.COMPONENTS, help="that other stress (xx)")
    kinds.add_argument("--fatigue", action="store_true", help="fatigue parameters, with the place of the largest")
    kinds.add_argument("--loop", action="store_true", help="a load over its displacement")
    kinds.add_argument("--load", choices=tuple(pictures.PAIRS), help="the loops' load (that which does the most work)")
    kinds.add_argument("--history", action="store_true", help="scalars over time")
    kinds.add_argument("--names", metavar="NAME,...", help="the history's datasets (loads that vary, areas, energy)")
    kinds.add_argument("--fretting-log", action="store_true", help="loops of the computed cycles of a life")
    kinds.add_argument("--scar", action="store_true", help="removed depth along x and y through its deepest point")
    kinds.add_argument("--life", action="store_true", help="volume, depth, energy, area and pressure over cycles")
    which = parser.add_argument_group(
        "steps (the last saved; of a scar all saved cycles)"
    ).add_mutually_exclusive_group()
    which.add_argument(
        "--step", type=numbers(int), metavar="K,...", help="load steps from 1, as petsam prints them; -1 is the last"
    )
    which.add_argument("--time", type=numbers(float), metavar="T,...", help="the saved steps nearest to times, s")
    which.add_argument(
        "--cycle", type=numbers(float), metavar="C,...", help="ends of the saved cycles of a life nearest to C"
    )
    look = parser.add_argument_group("look")
    look.add_argument(
        "--at", type=point, metavar="X,Y", help="where profiles cross, m (0,0; a scar's: where it is deepest)"
    )
    look.add_argument("--depth", type=numbers(float), metavar="Z,...", help="planes of stresses nearest to z, m (some)")
    look.add_argument("--whole-grid", action="store_true", help="maps and profiles of the grid, not of the contact")
    look.add_argument("--labels", metavar="TEXT,...", help="the files' names in the pictures (their file names)")
    look.add_argument("-o", "--output", metavar="NAME", help="name of the picture; it may end in .png or .pdf")
    look.add_argument("--format", choices=("png", "pdf"), help="instead of an end of the name (png)")
    look.add_argument("--dpi", type=resolution, default=150, help="pixels an inch of a PNG, 10 to 1200 (150)")
    options = parser.parse_args()
    if options.names == "":
        parser.error("--names: expected names of datasets")
    if options.labels and len(options.labels.split(",")) != len(options.files):
        parser.error(f"--labels: expected as many as files, {len(options.files)}")
    ending = os.path.splitext(options.output or "")[1].lower()
    if options.format and ending in FORMATS and ending != "." + options.format:
        parser.error(f"--format {options.format}: the name {options.output} says otherwise")
    return options


def asked(options):
    """The kinds of picture that the options name."""
    kinds = [kind for kind in KINDS if getattr(options, kind.replace("-", "_"))]
    implied = [("loop", options.load and "fretting-log" not in kinds), ("history", options.names)]
    kinds += [kind for kind, given in implied if given]
    return [kind for kind in KINDS if kind in kinds]


def chosen(options, results):
    """The kinds of picture asked for, or all that the files are good for."""
    kinds = asked(options)
    stresses = isinstance(results[0], Stresses)
    for one in results:
        if isinstance(one, Stresses) != stresses:
            raise Error(f"{one.path}: results of petsam and of petsam-stress do not go into one picture")
    allowed = OF_STRESSES if stresses else OF_RESULTS
    for kind in kinds:
        if kind not in allowed:
            program = "petsam-stress" if stresses else "petsam"
            raise Error(f"{results[0].path}: --{kind}: a file of {program}, of which there are {', '.join(allowed)}")
    if kinds:
        return kinds
    if stresses:
        return stress_kinds(results)
    return result_kinds(results)


def result_kinds(results):
    """What results of petsam are good for; of one that lacks fields, a picture whose message says so."""
    fields = ["maps", "profiles"] if all(one.has(pictures.FIELDS) for one in results) else []
    if all(one.has_life for one in results):
        scars = any(wear.worn(one, one.of_last()) for one in results)
        return [*fields, "fretting-log", *(["scar"] if scars else []), "life"]
    several = any(one.solved.size > 1 for one in results)
    return [*fields, *(["loop", "history"] if several else [])] or ["maps"]


def stress_kinds(files):
    """What files of stresses are good for; of one that lacks stresses, a picture whose message says so."""
    kinds = []
    if any(name in file for file in files for name in ("stress_xx", "mises")):
        if not any(file.along for file in files):
            kinds.append("maps")
        elif all(file.along and file.z.size > 1 for file in files):
            kinds.append("sections")
        kinds.append("profiles")
    if len(files) == 1 and files[0].fatigue:
        kinds.append("fatigue")
    return kinds or ["profiles"]


def snapshots(options, results):
    """Pairs of a file and an index into its fields, for each step asked for."""
    try:
        if options.time:
            return [(one, one.of_time(time)) for one in results for time in options.time]
        if options.cycle:
            return [(one, one.of_cycle(cycle)) for one in results for cycle in options.cycle]
        if options.step:
            return [(one, one.of_step(step)) for one in results for step in options.step]
        return [(one, one.of_last()) for one in results]
    except NotSaved as error:
        raise Error(f"{error.path}: --{error.wanted}: {error.reason}") from error


def path(options, kind, alone):
    """The picture's file: exactly the name given when it is the only picture of one kind asked for."""
    base, ending = os.path.splitext(options.output or os.path.basename(options.files[0]))
    if options.output and ending.lower() not in FORMATS:
        base, ending = options.output, ""
    if not options.output or not ending:
        ending = "." + (options.format or "png")
    return "{}{}{}".format(base, "" if alone and options.output else "_" + kind, ending)


def draw_stresses(options, files, kind):
    """One picture of stresses, a matplotlib figure."""
    if kind == "fatigue":
        if len(files) > 1:
            raise Error(f"{files[1].path}: --fatigue: draws one file at a time")
        return bodies.fatigue(files[0], options.at or ORIGIN)
    if options.cycle:
        raise Error(f"{files[0].path}: --cycle: a file of petsam-stress, which has steps")
    steps = snapshots(options, files)
    if kind == "maps":
        return bodies.maps(steps, options.component, options.depth)
    return getattr(bodies, kind)(steps, options.component, options.at or ORIGIN)


def draw_wear(options, results, kind):
    """One picture of wear, a matplotlib figure."""
    if kind == "life":
        return wear.life(results)
    if kind == "fretting-log":
        return wear.fretting_log(results, options.load)
    given = options.step or options.time or options.cycle
    steps = snapshots(options, results) if given else [(one, k) for one in results for k in wear.scar_steps(one)]
    return wear.scar(steps, options.at, options.whole_grid)


def draw(options, results, kind):
    """One picture, a matplotlib figure."""
    if isinstance(results[0], Stresses):
        return draw_stresses(options, results, kind)
    if kind == "maps":
        return pictures.maps(snapshots(options, results), options.whole_grid)
    if kind == "profiles":
        return pictures.profiles(snapshots(options, results), options.at or ORIGIN, options.whole_grid)
    if kind in OF_LIFE:
        return draw_wear(options, results, kind)
    if kind == "loop":
        return pictures.loop(results, options.load)
    return pictures.history(results, options.names.split(",") if options.names else None)


def save(options, figure, name):
    """Write one picture, which replaces no results and nothing that is not a file."""
    need_replaceable(name)
    for one in options.files:
        if same(one, name):
            raise Error(f"{name}: would replace the results; --output gives another name")
    width, height = (options.dpi * inches for inches in figure.get_size_inches())
    if not name.lower().endswith(".pdf") and width * height > PIXELS:
        raise Error(f"{name}: {width:.0f} x {height:.0f} pixels are too many; see --dpi")
    figure.savefig(name, dpi=options.dpi)
    plt.close(figure)
    print("wrote " + name)


def draw_all(options):
    """All pictures that are asked for."""
    labels = options.labels.split(",") if options.labels else [None] * len(options.files)
    results = [open_any(name, label) for name, label in zip(options.files, labels)]
    kinds = chosen(options, results)
    with plt.rc_context(STYLE):
        for kind in kinds:
            try:
                save(options, draw(options, results, kind), path(options, kind, len(kinds) == 1))
            except OSError:  # of the picture; those of the results have been taken for Errors
                raise
            except DAMAGED as error:
                # numbers that overflow in matplotlib, more than the memory holds
                text = f"the {kind} of {options.files[0]} cannot be drawn: {error or type(error).__name__}"
                raise Error(text) from error


def carry_out(options):
    """The exit code; in a child, as all files are read here."""
    warnings.simplefilter("ignore")  # of numbers that overflow and of letters that a font lacks
    try:
        draw_all(options)
    except Error as error:
        return fail("petsam-plot", error)
    return 0


def main():
    """Exit code: 0, 2 for bad usage, 3 for a file that cannot be read or written."""

    def parent():
        options = arguments()

        def child(_):
            return guarded("petsam-plot", lambda: carry_out(options))

        (code,) = isolation.each(child, [None])
        return fail("petsam-plot", code) if isinstance(code, Error) else code

    return guarded("petsam-plot", parent)

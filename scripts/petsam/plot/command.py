"""Draw what petsam has computed: maps, profiles, fretting loops, cycles, histories, wear; stresses, fatigue; studies.

    petsam-plot sphere.h5                           all pictures that the file is good for
    petsam-plot --maps --step 20,-1 strokes.h5      two steps below each other
    petsam-plot --field shear_x --limits -50MPa,50MPa -o shear.svg sphere.h5       one field with limits of its own
    petsam-plot --loop -o loop.pdf a.h5 b.h5        one picture, two files compared
    petsam-plot --loop --cycle 1,10,-1 strokes.h5   loops of three cycles
    petsam-plot --energy --period 20ms random.h5    dissipated energy of every period
    petsam-plot --scalar contact_area --against load_n a.h5 b.h5               any scalar of /history over any other
    petsam-plot --loop --range 33:64 strokes.h5     load steps 33 to 64 only
    petsam-plot --scalar stick_area --against load_tx --by friction study/results.h5       a study's table
    petsam-plot --fatigue --width 180 --csv both.csv a_fatigue.h5 b_fatigue.h5     two pads, also as numbers
    petsam-plot --against load_tx,friction --border life=1e6 study/results.h5   its regimes over two inputs
    petsam-plot --scar --cycle 0,1e5,1e6 life.h5    removed depth at three saved cycles
    petsam-plot --scar --cycle -1 --measured 2:profile.csv life.h5     a measured profile beside body 2's
    petsam-plot --report run.html sphere.h5         a page: inputs, numbers, errors, check, history, pictures
    petsam-plot --report joint.html joint.csv       a page of a table that the command of an application has written
    petsam-plot --sections --component xx stress.h5     stresses under the surface, by petsam-stress

Without a kind given, maps and profiles of the last saved step are drawn, and of several solved load steps the loop, if
friction works, and the history, of three cycles or more their loops and energies, too; of a wear simulation
(-wear_cycles) its fretting log, scar and curves over the cycles instead of these; of steady rolling the creep curve,
and arrows of the slip velocity on the map of stick and slip; with derivatives (-gradient) where a micrometre and
friction count; of a file of petsam-stress its section or maps, the profile, and fatigue parameters if it has them; of
results.h5 of petsam-study the results that vary, over the input with the most values. Constant scalars and fields that
are zero to rounding are drawn only by name.
An option that none of the pictures uses is rejected.
Each picture is a file NAME_maps.png and so on in the current directory; NAME is the first file's, of results.h5 of a
study its folder's. An older picture of this name is replaced.
"""

import contextlib
import os

from ..core.errors import Error
from ..core.files import need_folder, need_replaceable, same
from ..core.hdf5 import DAMAGED
from ..core.line import wrote
from ..core.shown import applications
from ..core.tables import read_csv
from ..results.file import NotSaved
from ..results.stresses import Stresses, open_any
from ..results.studies import Study
from . import arguments, looks, pictures, reports, saving, tables, uses
from . import kinds as kinds_of
from .arguments import FORMATS
from .keywords import LOOK
from .kinds import STUDY
from .style import STYLE, plt

TABLE = ".csv"  # end of the name of a table of an application
OF_RESULTS, OF_STRESSES = tuple(kinds_of.OF_RESULTS), tuple(kinds_of.OF_STRESSES)
KINDS = tuple(dict.fromkeys(OF_STRESSES[:3] + OF_RESULTS + OF_STRESSES))  # in the order in which they are drawn


def asked(options):
    """The kinds of picture that the options name."""
    kinds = [kind for kind in KINDS if getattr(options, kind.replace("-", "_"))]
    of_cycles = any(kind in kinds for kind in ("fretting-log", "energy"))
    implied = [
        ("loop", options.load and not of_cycles),
        ("history", options.scalar or options.against),
        ("maps", options.field and not any(kind in kinds for kind in ("maps", "profiles"))),
        ("energy", (options.turns or options.period) and not kinds and not options.cycle),
    ]
    kinds += [kind for kind, given in implied if given]
    return [kind for kind in KINDS if kind in kinds]


def chosen(options, results):
    """The kinds of picture that are requested, or all that the files contain data for."""
    kinds = asked(options)
    for one in results:
        if type(one) is not type(results[0]):
            raise Error(f"{one.path}: results of {results[0].program} and of {one.program} do not go into one picture")
    if isinstance(results[0], Study):
        return study_kinds(results, kinds)
    stresses = isinstance(results[0], Stresses)
    allowed = OF_STRESSES if stresses else OF_RESULTS
    for kind in kinds:
        if kind not in allowed:
            there = ", ".join(allowed)
            raise Error(f"{results[0].path}: --{kind}: not for files of {results[0].program}; use one of {there}")
    if kinds:
        return of_field(options, results, kinds)
    if stresses:
        return kinds_of.of_stresses(results)
    if options.range:
        return ["loop", "history"]
    if options.cycle and not all(one.has_life for one in results):
        return ["loop"]
    return kinds_of.of_results(results)


def of_field(options, results, kinds):
    """The kinds asked for, where the one that --field means is the profile of a line."""
    return ["profiles"] if kinds == ["maps"] and not options.maps and getattr(results[0], "is_plane", False) else kinds


def study_kinds(studies, kinds):
    """The one picture of studies, or an Error where another one is asked for."""
    for kind in kinds:
        if kind != "history":  # which --scalar means
            raise Error(f"{studies[0].path}: --{kind}: a table of petsam-study, drawn by --scalar, --against and --by")
    return [STUDY]


def path(options, kind, alone):
    """The picture's file: exactly the name given when it is the only picture of one kind asked for."""
    file = options.files[0]
    if kind == STUDY and os.path.basename(file) == "results.h5":  # as all studies have
        file = os.path.dirname(os.path.abspath(file))
    base, ending = os.path.splitext(options.output or os.path.basename(file))
    if options.output and ending.lower() not in FORMATS:
        base, ending = options.output, ""
    if not options.output or not ending:
        ending = "." + (options.format or "png")
    return "{}{}{}".format(base, "" if alone and options.output else "_" + kind, ending)


def need_units(options, results):
    """Raises Error where --limits or --border has a unit that is not that of its field, stress or column."""
    if options.limits and options.limits.unit:
        name = options.component or options.field[0]
        unit = "Pa" if options.component else results[0].about(name)[0]
        options.limits.need(unit, f"{results[0].path}: --limits, of {name}")
    for name, value in options.border:
        value.need(tables.numbers(results[0], name, "--border")[1], f"{results[0].path}: --border {name}")


def draw(options, results, kind):
    """One picture, a matplotlib figure."""
    function = uses.function(kind, options, results)
    words = {name: getattr(options, name) for name in (*uses.parameters(function), *LOOK)}
    given = {name: value for name, value in words.items() if value is not None and value is not False}
    if function is pictures.history:
        given["option"] = options.spelling
    if function is pictures.regimes:
        if len(results) > 1:
            raise Error(f"{results[1].path}: --against {options.against}: maps are of one study; give one file")
        given["against"] = options.against.split(",")
        given["border"] = [(name, value) for name, (value,) in options.border]
    return function(*results, **given)


def save(options, figure, name, table="w"):
    """Writes one picture, and its values as a table; refuses to replace results, or anything that is not a file."""
    for written, option in ((name, "--output"), (options.csv, "--csv")):
        if written:
            need_replaceable(written)
        for one in options.files if written else ():
            if same(one, written):
                raise Error(f"{written}: would replace the results; {option} gives another name")
    if options.csv:
        looks.write(figure, options.csv, table)
    saving.write(figure, name, options.dpi)
    wrote(name)


def need_options(options, results):
    """Error where an option is given that the files have no use for."""
    for name, given in (("by", options.by), ("where", options.where), ("border", options.border)):
        if given and not isinstance(results[0], Study):
            raise Error(f"{results[0].path}: --{name}: is for results.h5 of petsam-study")
    for name in ("turns", "period", "cycle", "step", "time"):
        if getattr(options, name) and isinstance(results[0], Study):
            raise Error(f"{results[0].path}: --{name}: a table of petsam-study, which has no steps")
    for name in ("turns", "period", "field", "scalar", "against"):
        if getattr(options, name) and isinstance(results[0], Stresses):
            raise Error(f"{results[0].path}: --{name}: a file of petsam-stress, whose stresses --component names")


def usable(options, results):
    """The kinds of picture; Error where an option has no use for them or for the files."""
    need_options(options, results)
    kinds = chosen(options, results)
    uses.need_use(options, results, kinds)
    need_units(options, results)
    return kinds


@contextlib.contextmanager
def drawing(options, what):
    """Context in which something is drawn: what prevents it is an Error."""
    try:
        yield
    except NotSaved as error:  # of what --step, --time, --cycle or --range has asked for
        raise Error(f"{error.path}: --{error.wanted}: {error.reason}") from error
    except OSError:  # of the picture; those of the results have been taken for Errors
        raise
    except DAMAGED as error:
        # numbers that overflow in matplotlib, more than the memory holds
        raise Error(f"the {what} of {options.files[0]} cannot be drawn: {error or type(error).__name__}") from error


def write_report(options, results):
    """The page of a file, with the pictures that are asked for."""
    reports.need(results[0], options.report)
    kinds = usable(options, results)
    if not asked(options) and not uses.given(options):
        kinds = reports.once(results[0], kinds)
    with plt.rc_context(STYLE), drawing(options, "report"):
        figures = {kind: draw(options, results, kind) for kind in kinds}
        reports.write(results[0], options.report, figures, options.dpi)
    wrote(options.report)


def read_table(file):
    """The result of a table that an application has written, and the application, by the name of the first column."""
    first = read_csv(file)[0].name
    known = [one for one in applications() if one.tables]
    for one in known:
        if read := one.reader(first):
            return read(file), one
    begin = "; ".join(f"tables of {one.command} begin with one of {', '.join(one.columns)}" for one in known)
    cure = "results.h5 beside it" if first == "case" else "one of those, or results of petsam -output"
    raise Error(f"{file}: its first column is {first}: {begin}; give {cure}")


def write_table(options):
    """The page of a table of an application, whose pictures no option changes."""
    file = options.files[0]
    found, application = read_table(file)
    if not options.report:
        raise Error(f"{file}: a table of {application.command} is drawn on a page: give --report NAME.html")
    for name in (*asked(options), *uses.given(options)):
        raise Error(f"{file}: --{name}: has no effect on the page of a table: remove it")
    if same(file, options.report):
        raise Error(f"{options.report}: would replace the table; give another name")
    with drawing(options, "report"):
        reports.report(found, options.report)
    wrote(options.report)


def draw_all(options):
    """All pictures that are asked for."""
    if options.report:
        need_replaceable(options.report)
    if os.path.splitext(options.files[0])[1].lower() == TABLE:
        write_table(options)
        return
    if not options.report:
        need_folder(os.path.dirname(os.path.realpath(options.output or "picture")), options.output or "pictures")
    if options.csv:
        need_replaceable(options.csv)
    labels = options.labels.split(",") if options.labels else [None] * len(options.files)
    results = [open_any(*one) for one in zip(options.files, labels)]
    if options.report:
        write_report(options, results)
        return
    kinds = usable(options, results)
    with plt.rc_context(STYLE):  # of the picture that is written, too
        for kind in kinds:
            with drawing(options, kind):
                name, mode = path(options, kind, len(kinds) == 1), "w" if kind == kinds[0] else "a"
                save(options, draw(options, results, kind), name, mode)


def main():
    """Exit code: 0, 2 for bad usage, 3 for a file that cannot be read or written."""
    return draw_all(arguments.read(__doc__))

"""Friction and rig stiffness from a laboratory's loops, coefficients of wear from the worn volume.

    petsam-fit loops.csv --normal 100N --shape sphere.opts -o test
    petsam-fit small.csv large.csv --normal 100N,100N --shape sphere.opts --lean -o test
    petsam-fit loops.csv --normal 100N --shape sphere.opts --life 18000 --volume 1.2e6um3,10% --body 2 -o test
    petsam-fit --scar profile.csv --life 18000 --shape cylinder.opts --body 2 -o test
    petsam-fit --plan --normal 100N --shape sphere.opts --friction 0.6 --rig 20N/um --noise 20nm,1N

A file has columns of displacement and force, named with their units: `Displacement (um);Friction force (N)`, x [mm],
d_um, or with the units in the line below; decimals with point or comma, lost points as empty cells. Cycles are cut at
the least displacement, drift and offset are removed. shape.opts has petsam's options of bodies and gap: one push of
petsam serves all coefficients of friction (a ball's is in closed form). Where the loops do not hold the friction, a
lower bound is printed, and where the model does not hold, no number at all: the exit code is then 10. --scar finds the
coefficient of wear from the profile of a scar, heights over x (x [mm],height [um]): shape.opts then has all of the
test, with -history, -slide and coefficients from which it begins.

-o NAME writes NAME.json, NAME-cycles.csv (friction, rig, energy of each cycle), NAME-friction.csv (for -wear_friction),
where friction changes, NAME.opts, with which petsam computes the contact's loop, its history NAME-loop.csv,
NAME-life.opts for a wear simulation of all cycles, where friction changes or wear is known, and a picture.
"""

import json
import math
import sys
from functools import partial

import numpy as np

from ...core import words
from ...core.errors import Error, Unusable, counted, short
from ...core.files import need_replaceable
from ...core.line import Parser, word, wrote
from ...plot.measured import read_profiles
from . import cutting, peaks, planning, push, reading, results, scars, series
from .results import Unsettled, plain

WRITTEN = (
    ".json",
    "-cycles.csv",
    "-friction.csv",
    ".opts",
    "-life.opts",
    "-life.csv",
    "-loop.csv",
    ".png",
    "-scar.png",
)
part = partial(words.number, form="a part from 0 to below 1: 0.5% or 0.005", least=0.0, below=1.0)


def _with_deviation(form, reader):
    """Reader of VALUE,BAND, whose deviation is 0 where it is left out."""
    return word(words.each, form, reader, part, rest=(0.0,))


def _test_options(parser):
    need = parser.add_argument_group("the test")
    newton = word(words.numbers, "normal loads above 0: 100N, or one for each file", "N", above=0.0)
    need.add_argument("--normal", type=newton, metavar="N", help="normal load, or one for each file")
    need.add_argument("--shape", metavar="NAME.opts", required=True, help="petsam's options of bodies, gap and grid")
    length = word(words.number, "a length above 0, such as 10mm", "m", above=0.0)
    need.add_argument("--width", type=length, metavar="L", help="length of a contact in plane strain")
    need.add_argument("--displacement", metavar="NAME", help="column of the displacement, where several may be meant")
    need.add_argument("--force", metavar="NAME", help="column of the force")
    chosen = word(
        words.bounds, "cycles FIRST:LAST, from 1: 2: or 3:10", least=1,
        together=lambda found: (found[0] or 1) <= (found[1] or math.inf),
        to=lambda found: slice((found[0] or 1) - 1, found[1]),
    )  # fmt: skip
    need.add_argument("--cycles", type=chosen, default=slice(None), metavar="FIRST:LAST", help="of each file (all)")
    rig = parser.add_argument_group("the rig")
    stiffness = word(words.number, "a stiffness above 0 with its unit, such as 20N/um", "N/m", above=0.0)
    rig.add_argument("--rig", type=stiffness, metavar="K", help="stiffness of the rig, if it is known: 20N/um")
    rig.add_argument(
        "--lean", action="store_true", help="a spring beside the contact, whose force grows while it slides"
    )
    form = "parts from 0 to below 1, of the loss and its deviation: 0.5% or 1%,0.3%"
    rig.add_argument(
        "--loss",
        type=_with_deviation(form, part),
        metavar="PART,BAND",
        help="force of the rig's own loop over the amplitude: 0.5%% or, with its deviation, 1%%,0.3%% (0,0.5%%)",
    )
    need.add_argument(
        "--shape-band",
        type=word(part),
        metavar="PART",
        help="deviation of the contact's compliance from that of the shape, of a ball a third of the radius' (5%%)",
    )


def _wear_options(parser):
    wear = parser.add_argument_group("wear")
    form = "a volume above 0 and its deviation, from 0 to below 1: 1.2e6um3,10%"
    volume = partial(words.number, unit="m3", above=0.0)
    wear.add_argument(
        "--volume",
        type=_with_deviation(form, volume),
        metavar="V,BAND",
        help="worn volume and its deviation: 1.2e6um3,10%%",
    )
    wear.add_argument("--scar", metavar="FILE.csv", help="profile of the worn surface over x; a scar is negative")
    wear.add_argument(
        "--split", action="store_true", help="with --scar: the other body's coefficient by its shape, too"
    )
    wear.add_argument("--body", choices=("1", "2"), default="2", help="that has lost it (2)")
    least = word(words.number, "a number of cycles above 0", above=0.0)
    wear.add_argument("--life", type=least, metavar="N", help="cycles of the whole test (those of the files)")


def _plan_options(parser):
    plan = parser.add_argument_group("planning")
    plan.add_argument("--plan", action="store_true", help="how well which strokes would give the friction")
    plan.add_argument("--friction", type=word(words.number, "a friction above 0", above=0.0), help="assumed")
    noise = (partial(words.number, unit=unit, above=0.0) for unit in ("m", "N"))
    form = "two numbers above 0, of displacement and force: 20nm,1N"
    plan.add_argument(
        "--noise",
        type=word(words.each, form, *noise),
        metavar="D,F",
        help="of displacement and force: 20nm,1N (0.5 %% of both)",
    )
    plan.add_argument("--wanted", type=word(part), default=0.02, metavar="PART", help="deviation of the friction (2%%)")


def arguments(given):
    """Reads the command line."""
    parser = Parser(
        prog="petsam-fit", description=__doc__
    )  # fmt: skip
    parser.add_argument("files", nargs="*", metavar="LOOPS.csv", help="measured loops; several are one test")
    for group in (_test_options, _wear_options, _plan_options):
        group(parser)
    out = parser.add_argument_group("output")
    out.add_argument("-o", "--output", metavar="NAME", help="NAME.json and so on")
    parser.add_choice(out)
    options = parser.parse_args(given)
    return _checked(parser, options)


def _check_plan(parser, options):
    """Ends the command for options that do not fit to --plan."""
    if options.plan:
        if options.files:
            parser.error(f"--plan: nothing is measured yet: leave out {short(options.files[0])}")
        for name in ("friction", "rig"):
            if getattr(options, name) is None:
                parser.error(f"--plan: needs --{name}, an assumed one")
    elif not options.files and not options.scar:
        parser.error("LOOPS.csv is missing, or --scar, or --plan")
    if (options.files or options.plan) and not options.normal:
        parser.error("--normal is missing: the normal load")
    for name in ("friction", "noise"):
        if getattr(options, name) is not None and not options.plan:
            parser.error(f"--{name}: is for --plan")


def _checked(parser, options):
    """The options, or the end of the command for those that do not fit."""
    _check_plan(parser, options)
    if not options.files and not options.plan:
        options.normal = options.normal or [0.0]
    if options.split and not options.scar:
        parser.error("--split: is for --scar")
    if options.scar and not options.life:
        parser.error("--scar: needs --life, the cycles of the test")
    count = len(options.files) or 1
    if len(options.normal) not in (1, count):
        parser.error(f"--normal: {counted(count, 'file')}: give one number, or as many")
    options.normal = options.normal * count if len(options.normal) == 1 else options.normal
    if options.life and not (options.volume or options.scar):
        parser.error("--life: is for --volume and --scar")
    if options.volume and not options.files:
        parser.error("--volume: needs the loops, whose energy has worn it")
    return options


def _outputs(options):
    """Refuses outputs that are inputs, or cannot be written."""
    if not options.output:
        return
    for end in WRITTEN:
        name = options.output + end
        said = f"-o {short(options.output)}: {name} would replace a file that is read: choose another name"
        need_replaceable(name, (*options.files, options.shape, options.scar), Unusable(said))


def _plan(options):
    one = push.of_shape(options.shape, options.normal[0], options.width)
    found = planning.plan(one, options.friction, options.rig, options.noise, wanted=options.wanted)
    print(f"push: {one.text}; contact without slip {one.stiffness / 1e6:.4g} N/um")
    print(f"deviation of the friction, in per cent of {options.friction:g}, by ten loops of 200 points:")
    print(f"  {'loops':62} {'stroke/um':>9} {'force/N':>8} {'friction':>9} {'+ loss':>8} {'+ lean':>8} {'+ shape':>8}")
    for name, stroke, force, row in zip(found.loops, found.stroke, found.force, found.deviation):
        cells = " ".join(f"{100 * value:8.2g}" for value in row)
        print(f"  {name:62} {1e6 * stroke:9.4g} {force:8.4g}  {cells}")
    print(found.advice())
    if options.output:
        found.to_csv(options.output + ".csv")
        wrote(options.output + ".csv")


def _measure(options, scar):
    records = [reading.read(path, options.displacement, options.force) for path in options.files]
    if not reading.same_units(records):
        raise Error(f"{options.files[0]}: some files have loops and others peaks only: evaluate them apart")
    if records[0].peaks:
        return _peaks(options, records)
    pushes = [push.of_shape(options.shape, normal, options.width) for normal in options.normal]
    files = [cutting.cycles(one, normal, options.cycles) for one, normal in zip(records, options.normal)]
    for record, one in zip(records, files):
        for note in (*record.notes, *one.notes):
            print(f"{record.path}: {note}")
    fixed = {"compliance": 1.0 / options.rig} if options.rig else {}
    if options.loss is not None:
        fixed["loss"] = options.loss if options.loss[1] else options.loss[0]
    if options.shape_band is not None:
        fixed["scale"] = (1.0, options.shape_band) if options.shape_band else 1.0
    found = series.analyse(files, pushes, ("lean",) if options.lean else (), **fixed)
    for line in results.lines(found, pushes[0]):
        print(line)
    worn = None
    if options.volume:
        worn = results.wear(found, *options.volume, options.life)
        print(results.worn_line(worn, options.body))
    if options.output:
        _write(options, found, pushes[0], worn, scar)
    return Unsettled.code if found.state == "rejected" else 0


def _peaks(options, records):
    for record, normal in zip(records, options.normal):
        found = peaks.of_peaks(record, normal)
        print(f"{record.path}: {len(record.force)} cycles, peaks only: friction at least {found.friction_at_least:.4g}")
        if np.isfinite(found.energy_ratio).any():
            print(
                f"energy ratio {np.nanmin(found.energy_ratio):.3g} to {np.nanmax(found.energy_ratio):.3g}: "
                f"{int(np.sum(found.gross))} cycles of gross slip (above 0.2)"
            )
        else:
            print("no energies: whether the contact slides is not known from peaks")
    if options.output:
        print("-o: nothing is written: peaks hold no loop to be fitted")
    return 0


def _write(options, found, one, worn, scar):
    name, written = options.output, []
    with open(name + ".json", "w", encoding="utf-8") as file:
        json.dump({**results.as_json(found, worn, options.body), **scar}, file, indent=1)
        file.write("\n")
    written.append(name + ".json")
    found.to_csv(name + "-cycles.csv")
    written.append(name + "-cycles.csv")
    if found.state == "changes":
        results.write_friction(found, name + "-friction.csv")
        written.append(name + "-friction.csv")
    if found.identifiable:
        written += results.write_options(found, one, options.shape, options.width, name, worn, options.body)
    if not options.no_picture:
        from ...plot import saving
        from . import pictures

        saving.write(pictures.fit(found), name + ".png", options.dpi)
        written.append(name + ".png")
    wrote(*written)


def _scar(options):
    """The coefficient of wear from each profile of the file; the numbers of JSON, and the exit code."""
    x, profiles = read_profiles(options.scar)
    one, found = None, {}
    for name, height in profiles.items():
        scar, one = scars.fit_profile(options.shape, options.life, x, height, options.body, one=one)
        print(f"{options.scar}: {name}: body {options.body}: {_scar_line(scar)}")
        found[name] = scar
    first, more = next(iter(found.values())), {}
    doubts = [scar.doubt for scar in found.values()]
    if options.split:
        for name, scar in list(found.items())[:1]:
            parted = scars.split(options.shape, options.life, scar.x, scar.height, options.body)
            ratio = f"{parted.ratio:.2g} +- {parted.ratio_sd:.2g}, by the shape of the scar"
            ratio = f": no number: {parted.doubt}" if parted.doubt else f" {ratio}"
            print(f"{options.scar}: {name}: coefficient of the other body over it{ratio}")
            doubts.append(parted.doubt)
            more = {"wear_split": plain(parted.ratio), "wear_split_sd": plain(parted.ratio_sd)}
    if options.output and not options.no_picture:
        from ...plot import saving
        from . import pictures

        saving.write(pictures.scar_fit(found), options.output + "-scar.png", options.dpi)
        wrote(options.output + "-scar.png")
    numbers = {
        f"wear_coefficient{options.body}": plain(first.coefficient),
        f"wear_coefficient{options.body}_sd": plain(first.coefficient_sd),
        "wear_doubt": first.doubt or first.warning or None,
        **more,
    }
    return numbers, Unsettled.code if any(doubts) else 0


def _scar_line(scar):
    """The line that is printed of a profile."""
    parts = f"noise {100 * scar.by_noise:.2g} %" + (f", grid {100 * scar.by_grid:.2g} %" if scar.by_grid >= 0 else "")
    number = f"Archard's coefficient {scar.coefficient:.4g} +- {scar.coefficient_sd:.2g} 1/Pa ({parts})"
    return (
        f"{f'no numbers: {scar.doubt}' if scar.doubt else number}; misfit {1e6 * scar.misfit:.3g} um, neighbours' "
        f"correlation {scar.neighbours:.2f}, shift {1e6 * scar.shift:.3g} um"
        + (f"; warning: {scar.warning}" if scar.warning else "")
    )


def carry_out(options):
    """Read, fit, print and draw; exit code."""
    _outputs(options)
    if options.plan:
        return _plan(options)
    worn, code = _scar(options) if options.scar else ({}, 0)
    if options.files:
        return _measure(options, worn) or code
    if options.output:
        with open(options.output + ".json", "w", encoding="utf-8") as file:
            json.dump({**worn, "units": "1/Pa"}, file, indent=1)
        wrote(options.output + ".json")
    return code


def main():
    """Exit code: 0, 2 for bad usage, 3 for a file that cannot be read or written, or lacks data, 10 for no numbers."""
    return carry_out(arguments(sys.argv[1:]))

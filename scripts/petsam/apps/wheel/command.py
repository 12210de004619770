"""Wheel and rail: a wheelset in equilibrium on its track, its patches, creepages, forces and wear.

    petsam-wheel --wheel s1002 --rail uic60 --cant 1:40 --load 100kN --y 3mm --yaw 2mrad --speed 20 -o one
    petsam-wheel --wheel s1002 --rail uic60 --cant 1:40 --load 100kN --y -6mm:6mm:121 --speed 20 -o sweep
    petsam-wheel --wheel new.prw --rail worn.prr --table vehicle.csv --cores 2 -o many
    petsam-wheel --wheel s1002 --rail uic60 --cant 1:40 --table vehicle.csv --distance 100000km --wear 1e-14 -o life

Axes: x forward, y to the right, z down; y = 0 is the middle of the track. Both wheels and both rails have one profile,
the left ones as mirror images. Profiles are s1002, uic60, files of SIMPACK (.prw, .prr) or MiniProf (.whl, .ban, .mpt),
or columns y and z, whose unit and direction of z --unit and --z give; y is towards the field side.

Height and roll follow from the axle load and the balance of moments about x, the lateral force from y, or y from
--lateral. A table is a text with a head of names with units, y [mm],yaw [mrad],speed [km/h],load [kN],weight, and a
line per position. It may also have vy, vz, roll_rate, yaw_rate, pitch_rate, lateral, offset, height, load_right and
load_left (the vertical forces of both wheels instead of the axle load), and roll, which is compared with the one that
is found. Without a pitch rate the wheelset rolls freely: without torque about its axle, neither driven nor braked; with
--rolling radii at the speed over the mean of its rolling radii.

The residual is what is left of the balance of forces or moments, relative to the axle load.

Where left and right differ, --wheel, --rail and --radius take LEFT,RIGHT, profiles with y to the field side. Materials
are names, as steel, or Young's modulus and Poisson's ratio, 210GPa,0.3.

A wheel is derailed where its contact is beyond the steepest place of its flange, towards the tip, and may climb where
Y/Q, its lateral over its vertical force, is above Nadal's limit (tan d - mu)/(1 + mu tan d) of the steepest place. A
wheelset that is held aside by a force at the axle's height tips over before its flange is steep: give --height.

-o NAME writes NAME.csv: a row for each patch with contact point, angle, creepages, forces in the patch (n, fx, fs) and
in the track (track_fx ...), all on the rail, maximum pressure, area, stick area, T-gamma, Y/Q and the state; NAME.png,
of one position the sections with pressure and slip of each patch, of a sweep contact points, rolling radius difference,
equivalent conicity (EN 15302) and T-gamma. With --wear NAME-wear.csv has the depth per distance of each place of the
profile by the mean of all positions, and with --distance the profile after it, its estimated error, and NAME-wear.png.
"""

import argparse
import contextlib
import math
import os
import re
import sys
import warnings
from functools import partial

import numpy as np

from ...core import materials, tables, words
from ...core.environment import cores as all_cores
from ...core.errors import Error, Missing, MissingFile, Unusable, counted, short
from ...core.files import need_replaceable, same
from ...core.line import Parser, add_choice, guarded, joined, word
from ...core.progress import Progress
from . import derailing
from .words import choice, pair, slope

SMOOTHED = 0.03  # change of the largest pressure by half the smoothing without a remark
ROLL = 1e-3  # rad by which the roll of a table may differ without a remark
SHOWN = 12  # positions whose patches are printed, and failures
EVERY = 2.0  # s between two lines of progress
WIDE, POINTS = 8e-3, 81  # m and number of displacements of the rigid geometry
JUMPS = 10  # of the profile over the distance
BUILT = ("s1002", "uic60")
KINDS = ("wheel", "rail")
PLACE = "y, or y and z, of a point in the rail's profile: -36mm or -36mm,0mm"
BOTH = "; of wheel and rail --z WHEEL,RAIL"  # where their files differ
# quantities of petsam.wheel, and their options
OPTIONS = {
    **{name.replace("-", "_"): f"--{name}" for name in (
        "gauge", "gauge-height", "gauge-position", "cant", "radius", "friction", "cell", "y", "yaw", "load", "lateral",
        "offset", "height", "distance", "jumps", "law", "speed",
    )},
    "coefficient": "--wear",
}  # fmt: skip


def material(text):
    """Young's modulus (Pa) and Poisson's ratio of an elastic material, by its name or numbers."""
    young, poisson = materials.elastic(text)
    if not (1e5 < young < math.inf and 0.0 <= poisson < 0.5):
        raise words.WordError(text, "an elastic material: a modulus that is finite, and a ratio from 0 to below 0.5")
    return young, poisson


def _length(form):
    return word(words.number, form, "m")


def _profiles(one):
    group = one.add_argument_group("profiles")
    profiles = word(pair, "one profile, or two of LEFT,RIGHT", whole=os.path.lexists)
    for name, made, ending in (("wheel", "s1002", ".prw"), ("rail", "uic60", ".prr")):
        group.add_argument(f"--{name}", required=True, type=profiles, metavar="PROFILE",
                           help=f"{made}, a file {ending} or of MiniProf, columns y and z; or LEFT,RIGHT")  # fmt: skip
    group.add_argument("--unit", type=word(pair, "a unit of length, mm, or two of WHEEL,RAIL"), metavar="UNIT",
                       help="unit of length of columns: mm; or WHEEL,RAIL")  # fmt: skip
    form = "down or up, or two of WHEEL,RAIL"
    direction = partial(choice, form=form, known=("down", "up"))
    group.add_argument("--z", type=word(pair, form, direction), metavar="down|up",
                       help="direction of z in the files, or WHEEL,RAIL; of columns it must be given")  # fmt: skip
    group.add_argument("--mirror", choices=("wheel", "rail", "both"), help="profiles whose y is to the gauge side")
    group.add_argument("--smooth", type=word(words.number, "a length above 0: 4mm", "m", words.positive), metavar="L",
                       help="smooth measured profiles: 4mm for 1 um of noise, 8mm for 5 um")  # fmt: skip
    group = one.add_argument_group("track and wheelset")
    form = "an inclination towards the middle: 1:40 or 0.025 (rad); 0 of a profile in its place"
    group.add_argument(
        "--cant", type=word(slope, form), default=0.0, metavar="1:N", help="of the rails, to the middle (0)"
    )
    group.add_argument("--gauge", type=_length("a length: 1435mm"), default=1.435, metavar="L", help="(1435mm)")
    group.add_argument("--gauge-height", type=_length("a length: 14mm"), default=0.014, metavar="L",
                       help="depth below the rails' tops where the gauge counts (14mm)")  # fmt: skip
    group.add_argument("--gauge-position", type=word(words.numbers, PLACE, "m", count=(1, 2)), metavar="Y[,Z]",
                       help="y in the rail's profile that is at half the gauge, and z at its top, instead")  # fmt: skip
    group.add_argument("--curve", type=_length("a radius, positive to the right: 300m"), metavar="R",
                       help="radius of a curve, positive to the right (straight)")  # fmt: skip
    radii = word(words.numbers, "a length, or two of LEFT,RIGHT: 460mm", "m", count=(1, 2),
                 to=lambda found: (found[0], found[-1]))  # fmt: skip
    group.add_argument("--radius", type=radii, default=(0.46, 0.46), metavar="L",
                       help="nominal, of both wheels, or LEFT,RIGHT (460mm)")  # fmt: skip
    group.add_argument("--flange-back", type=_length("a length: 1360mm"), default=1.36, metavar="L",
                       help="distance of the backs of both flanges (1360mm)")  # fmt: skip
    group.add_argument("--flange-position", type=_length("a length: -70mm"), default=-0.07, metavar="L",
                       help="y of the flange's back in the wheel's profile (-70mm)")  # fmt: skip
    for name in ("wheel", "rail"):
        group.add_argument(f"--{name}-material", type=word(material), metavar="MATERIAL",
                           help="steel or another name, or modulus and ratio, 210GPa,0.3 (steel)")  # fmt: skip
    coefficient = word(
        words.number, "a coefficient of friction from 0 to below 10", allowed=lambda mu: 0.0 <= mu < 10.0
    )
    group.add_argument("--friction", type=coefficient, default=0.3, metavar="MU", help="(0.3)")
    group.add_argument("--cell", type=_length("a length: 0.2mm"), default=2e-4, metavar="L", help="of a grid (0.2mm)")


def _positions(one):
    group = one.add_argument_group("positions")
    sweep = word(words.span, "a lateral displacement, or FIRST:LAST:COUNT: 3mm or -6mm:6mm:121", "m", count=1)
    group.add_argument("--y", type=sweep, metavar="Y", help="lateral displacement, or FIRST:LAST:COUNT")
    angle = word(words.number, "an angle: 2mrad, 0.002 (rad) or 0.1deg", "rad")
    group.add_argument("--yaw", type=angle, metavar="A", help="2mrad, 0.002 (rad) or 0.1deg (0)")
    speed = word(words.number, "a speed above 0: 20 (m/s) or 72km/h", "m/s", words.positive)
    group.add_argument("--speed", type=speed, metavar="V", help="forward speed: 20 (m/s) or 72km/h")
    newton = word(words.number, "a force above 0: 100kN", "N", words.positive)
    group.add_argument("--load", type=newton, metavar="N", help="axle load with the weight of the wheelset")
    group.add_argument(
        "--offset", type=_length("a length: 10mm"), metavar="L", help="y of its line in the wheelset (0)"
    )
    group.add_argument("--lateral", type=word(words.number, "a force: 10kN", "N"), metavar="N",
                       help="lateral force on the wheelset, to the right, instead of --y")  # fmt: skip
    group.add_argument("--height", type=_length("a length: 0.46m"), metavar="L",
                       help="z of the lateral force below the axle; negative above it (0)")  # fmt: skip
    group.add_argument("--rolling", choices=("free", "radii"), default="free",
                       help="without a pitch rate: without torque (free), or by the mean of both radii")  # fmt: skip
    group.add_argument("--table", metavar="FILE.csv", help="positions of a simulation of the vehicle")
    whole = word(words.integer, "a whole number, 1 or more", words.within(1))
    group.add_argument("--cores", type=whole, metavar="N", help="processes (all available cores)")
    group = one.add_argument_group("wear of the wheel")
    coefficient = word(words.number, "a coefficient above 0: 1e-14", allowed=words.positive)
    group.add_argument("--wear", type=coefficient, metavar="K", help="coefficient of wear: 1e-14 (m3/J, or 1/Pa)")
    group.add_argument(
        "--law", choices=("energy", "archard"), help="volume per frictional work (default), or per force and slip"
    )
    distance = word(words.number, "a distance above 0: 100000km or 1e8 (m)", "m", words.positive)
    group.add_argument("--distance", type=distance, metavar="D", help="update the profile over it: 100000km")
    even = word(words.integer, "an even number, 2 or more", lambda value: value >= 2 and value % 2 == 0)
    group.add_argument("--jumps", type=even, metavar="N", help="updates of the profile over the distance (10)")


def _parser():
    one = Parser(
        prog="petsam-wheel", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )  # fmt: skip
    _profiles(one)
    _positions(one)
    out = one.add_argument_group("output")
    out.add_argument("-o", "--output", metavar="NAME", help="NAME.csv, NAME.png and so on")
    add_choice(out)
    return one


def _has_own(name, quantity):
    """True if a profile has its own unit or z: one of a formula, or of SIMPACK, whose files state their unit."""
    return name.lower() in BUILT or quantity == "unit" and name.lower().endswith((".prr", ".prw"))


def _check_profiles(parser, options):
    """Ends the command for units and directions of z of profiles that have their own."""
    for quantity in ("unit", "z"):
        given = getattr(options, quantity)
        own = [all(_has_own(name, quantity) for name in getattr(options, kind)) for kind in KINDS]
        if given is None or not any(own):
            continue
        if all(own):
            parser.error(f"--{quantity}: is of files of columns, and none is given: remove it")
        if given[0] != given[1]:
            k = own.index(True)
            parser.error(
                f"--{quantity} {','.join(given)}: {getattr(options, KINDS[k])[0]} has its own: give that of the "
                f"{KINDS[1 - k]} alone, --{quantity} {given[1 - k]}"
            )


def _check_positions(parser, options):
    """Ends the command for options of positions that do not fit."""
    if options.table is not None:
        for name in ("y", "yaw", "lateral", "offset", "height"):
            if getattr(options, name) is not None:
                parser.error(f"--{name}: --table has it as a column: remove it")
        return
    for name in ("load", "speed"):
        if getattr(options, name) is None:
            parser.error(f"--{name} is missing: give it, or --table")
    if (options.y is None) == (options.lateral is None):
        parser.error("give --y, --lateral or --table, and only one of them")


def arguments(given):
    """Reads the command line."""
    parser = _parser()
    options = parser.parse_args(joined(given))
    _check_profiles(parser, options)
    _check_positions(parser, options)
    if options.wear is None:
        for name in ("law", "distance"):
            if getattr(options, name) is not None:
                parser.error(f"--{name}: needs --wear, the coefficient of wear")
    elif _unlike(options):
        parser.error("--wear: both sides wear alike: give one profile to --wheel and to --rail, one length to --radius")
    if options.jumps is not None and options.distance is None:
        parser.error("--jumps: needs --distance")
    return options


def _outputs(options):
    """Names of the files that are written; ends with an error where one cannot be."""
    if not options.output:
        return []
    endings = [".csv", *([] if options.no_picture else [".png"])]
    if options.wear is not None:
        endings += ["-wear.csv", *(["-wear.png"] if options.distance and not options.no_picture else [])]
    for name in (options.output + ending for ending in endings):
        if any(same(name, path) for path in (*options.wheel, *options.rail, options.table) if path):
            raise Unusable(f"-o {short(options.output)}: {name} would replace a file that is read: choose another name")
        need_replaceable(name)
    return endings


@contextlib.contextmanager
def _named(option):
    """Errors of what an option names have the option before them; those of a file that cannot be read, too."""
    try:
        yield
    except MissingFile as error:
        raise Missing(f"{option}: {error}") from error
    except OSError as error:
        raise Error(f"{option}: {error.filename or 'file'}: {error.strerror or error}") from error
    except Error as error:
        text = f"{option}: {_optioned(error)}"
        raise type(error)(text) if type(error) in (Error, Unusable) else error from error


def _read(options, kind, side):
    """A profile of the left (0) or right (1) side by its name or from its file."""
    from .. import wheel as profiles

    name = getattr(options, kind)[side]
    if name.lower() in BUILT:
        found = getattr(profiles, name.lower())()
        if found.kind != kind:
            raise Unusable(f"--{kind} {name}: is the profile of a {found.kind}: give --{found.kind} {name}")
        if options.mirror in (kind, "both"):
            raise Unusable(f"--mirror {options.mirror}: {name} has y to the field side: remove it")
    else:
        mirror = options.mirror in (kind, "both")
        unit, z = (given and given[KINDS.index(kind)] for given in (options.unit, options.z))
        with _named(f"--{kind}"):
            found = profiles.read(name, kind, None if _has_own(name, "unit") else unit, z, mirror)
    if not options.smooth:
        return found
    with _named(f"--smooth {options.smooth:g}"):
        return found.smoothed(options.smooth)


def _optioned(error):
    """A message of the profiles with the command's options in place of Python's arguments."""
    text = str(error)
    for old, new in (
        ("read(..., z='up') turns it over", f"give --z up{BOTH}"),
        ("read(..., z='down') turns it over", f"give --z down{BOTH}"), ("without cant=", "without --cant"),
        *((f"mirror=True {to} read() of the {kind}", f"--mirror {kind}") for to in ("to", "of") for kind in KINDS),
        (", or mirror.y = 1 in the file, or take mirrored()", ", or mirror.y = 1 in the file"),
        ("smoothed(0.004)", "--smooth 4mm"), ("smoothed(0.008)", "--smooth 8mm"),
        ("unit='mm'", "--unit mm"), ("z='down' or z='up'", "--z down or --z up"),
        ("check gauge", "check --gauge"), ("give height,", "give --height,"),
        ("give a gauge_height", "give a --gauge-height"), ("or gauge_position", "or --gauge-position"),
        ("give tape_line, y where the radius is the nominal one, or shift", "shift"),
        ("flange_position", "--flange-position"), ("flange_back", "--flange-back"),
    ):  # fmt: skip
        text = text.replace(old, new)
    return re.sub(rf"^(?:{'|'.join(OPTIONS)})(?= |:)", lambda found: OPTIONS[found[0]], text)


def _reworded(error):
    """The error with the command's options."""
    return type(error)(_optioned(error)) if type(error) in (Error, Unusable) else error


def _vehicle(options):
    """Rails and wheels."""
    from .. import wheel as profiles

    sides = [(_read(options, "rail", k), _read(options, "wheel", k), options.radius[k])
             for k in ((1, 0) if _unlike(options) else (1,))]  # fmt: skip
    if options.curve is not None and not abs(options.curve) >= 10.0:
        raise Unusable(f"--curve {options.curve:g}: expected the radius in m, at least 10, positive to the right")
    curvature = 0.0 if options.curve is None else 1.0 / options.curve
    placed = [
        (
            profiles.Track(rail, options.gauge, options.gauge_height, options.cant, curvature, options.gauge_position),
            profiles.Wheelset(wheel, radius, options.flange_back, options.flange_position),
        )
        for rail, wheel, radius in sides
    ]
    given = {name: getattr(options, f"{name}_material") for name in ("rail", "wheel")}
    bodies = {name: profiles.Material(*numbers) for name, numbers in given.items() if numbers}
    settings = profiles.Settings(cell=options.cell, **bodies)
    left = placed[1] if len(placed) > 1 else None
    return profiles.Vehicle(*placed[0], options.friction, settings, left, options.rolling)


def _unlike(options):
    """True if left and right differ."""
    return any(left != right for left, right in (options.wheel, options.rail, options.radius))


def _states(options):
    """The positions."""
    from .. import wheel as profiles

    if options.table is not None:
        with _named("--table"):
            states, ignored = profiles.read_positions(options.table, options.load, options.speed)
        if ignored:
            _warn(f"{options.table}: columns that are not used: {', '.join(map(short, ignored))}")
        return states
    load = profiles.Load(options.load, options.offset or 0.0, options.lateral, options.height or 0.0)
    places = [0.0] if options.y is None else options.y
    return [
        profiles.State(profiles.Position(y=float(y), yaw=options.yaw or 0.0, speed=options.speed), load) for y in places
    ]


def _warn(text):
    print(f"petsam-wheel: warning: {_optioned(text)}", file=sys.stderr)


def _need_ready(options, vehicle, states):
    """Raises Unusable for wheels beside their rails, and wear that cannot be followed, before anything is solved."""
    from . import Position, wearing

    with vehicle.axle() as axle:
        try:
            axle.rigid(Position())
        except Error as error:
            raise Unusable(str(error).partition(": ")[2]) from error
    if options.wear is None:
        return
    law = wearing.Law(options.law or "energy", options.wear)
    with _named(f"--table {options.table}") if options.table else contextlib.nullcontext():
        wearing.shares(states)
    if options.distance is not None:
        wearing.need_shallow(vehicle, states, options.distance, law, options.jumps or JUMPS)


def carry_out(options):
    """Reads, solves, prints and writes; exit code."""
    from .. import wheel as profiles

    endings = _outputs(options)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        try:
            vehicle, states = _vehicle(options), _states(options)
            _need_ready(options, vehicle, states)
        except Error as error:
            raise _reworded(error) from error
    for text in dict.fromkeys(str(one.message) for one in caught if issubclass(one.category, UserWarning)):
        if not (options.smooth and "from point to point" in text):
            _warn(text)
    cores = options.cores or all_cores()
    if len(states) == 1:
        cores = 1
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of the vehicle: printed above
        found = profiles.solve_all(vehicle, states, cores, Progress("position", every=EVERY))
    table = found.table()
    _print(options, found, table)
    wrote = []
    if options.output:
        tables.write_csv(options.output + ".csv", table)
        wrote.append(".csv")
        if ".png" in endings:
            _picture(options, vehicle, found)
            wrote.append(".png")
    if options.wear is not None:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", profiles.ProfileWarning)  # of the vehicle: printed above
            try:
                wrote += _wear(options, vehicle, states, cores, endings)
            except Error as error:
                raise _reworded(error) from error
    if wrote:
        print("wrote " + ", ".join(options.output + ending for ending in wrote))
    return 0


def _print(options, found, table):
    """The equilibria and patches of few positions; of all, failures and warnings."""
    columns = {column.name: column.values for column in table}
    solved = {number: k for k, number in reversed([*enumerate(columns["position"])]) if columns["ws_y"][k] is not None}
    for number, k in [*sorted(solved.items())][:SHOWN]:
        y, z, roll, lateral, difference = (
            columns[name][k] for name in ("ws_y", "ws_z", "ws_roll", "ws_lateral", "radius_difference")
        )
        left = max(abs(columns[name][k]) for name in ("force_error", "moment_error"))
        print(f"position {number}: y {1e3 * y:.4f} mm, z {1e3 * z:.4f} mm, roll {1e3 * roll:.5f} mrad, lateral "
              f"force {lateral:.5g} N, rolling radius difference {1e3 * difference:.4f} mm, "
              f"residual {left:.1g}")  # fmt: skip
        for row in [j for j, one in enumerate(columns["position"]) if one == number]:
            _print_patch({name: values[row] for name, values in columns.items()})
    if len(solved) > SHOWN:
        print(f"{counted(len(solved), 'position')} solved of {len(found.states)}; the first {SHOWN} are shown")
    for number, failure in found.failures[:SHOWN]:
        line = found.states[number - 1].line
        _warn(f"position {number}{f' (line {line})' if line else ''}: {failure}")
    if len(found.failures) > SHOWN:
        _warn(f"{len(found.failures)} positions have no equilibrium in all; the column note names each")
    for text in dict.fromkeys(
        re.sub(r"[-+]?\d[\d.]*(e[-+]?\d+)? ?", "... ", note) for one in found.found for note in one.notes
    ):
        _warn(f"{text} (see the column note)")
    _compare_roll(options, found)
    if options.smooth:
        _doubt_smoothing(options, found)


def _print_patch(row):
    print(f"  {row['side']:5} y {1e3 * row['y']:9.3f} mm, angle {row['angle']:8.4f}, creepages {row['creep_x']:.3e} "
          f"{row['creep_s']:.3e} {row['creep_spin']:.3e}/m, N {row['n']:.5g} N, Fx {row['fx']:.4g} N, Fs "
          f"{row['fs']:.4g} N, p_max {row['p_max'] / 1e6:.4g} MPa, T-gamma {row['t_gamma']:.4g} N"
          f"{_climbing(row)}")  # fmt: skip


def _climbing(row):
    """The state of a wheel that may climb or is derailed, for its line."""
    if row["state"] == derailing.STATES[0]:
        return ""
    here = derailing.nadal(abs(row["angle"]), row["friction"])
    return (
        f"; {row['state'].upper()}: Y/Q {row['y_over_q']:.3f}, Nadal's limit {row['nadal']:.3f} at the flange's "
        f"steepest place, {here:.3f} at this angle"
    )


def _highest(found):
    """The largest maximum pressure of all positions, Pa, and the position; 0 and None without one."""
    rows = {column.name: column.values for column in found.table()}
    solved = [(p, number) for p, number in zip(rows["p_max"], rows["position"]) if p is not None and np.isfinite(p)]
    return max(solved, default=(0.0, None))


def _doubt_smoothing(options, found):
    """Warns where the largest pressure is another one with half the smoothing: it takes the profiles' own curvatures
    away, or leaves some of their noise."""
    from .. import wheel as profiles

    highest, number = _highest(found)
    if number is None:
        return
    half = argparse.Namespace(**{**vars(options), "smooth": 0.5 * options.smooth})
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        other, _ = _highest(profiles.solve_all(_vehicle(half), [found.states[number - 1]], 1))
    if other and abs(other / highest - 1.0) > SMOOTHED:
        _warn(
            f"--smooth {1e3 * options.smooth:g}mm: position {number}: p_max is {highest / 1e6:.4g} MPa, and "
            f"{other / 1e6:.4g} MPa with half of it: smoothing flattens curves of the profiles, too, and noise that is "
            "left raises pressures: their error is of the order of this difference; measure with less noise"
        )


def _compare_roll(options, found):
    """Warns where the roll of a table is another one than that of the equilibrium."""
    rolls = found.of("ws_roll")
    apart = [(abs(roll - state.roll), state) for roll, state in zip(rolls, found.states) if state.roll is not None]
    apart = [one for one in apart if np.isfinite(one[0])]
    if apart and max(one[0] for one in apart) > ROLL:
        most, state = max(apart, key=lambda one: one[0])
        _warn(
            f"{options.table}: line {state.line}: roll differs by {most:.3g} rad from that of the equilibrium: check "
            "its unit and sign (positive: right wheel down), profiles, --cant and --gauge"
        )


def _picture(options, vehicle, found):
    """Writes NAME.png: of one position its patches, else numbers over y."""
    from ...plot import saving
    from .. import wheel as profiles
    from . import pictures

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        with vehicle.axle() as axle:
            if len(found.states) == 1:
                figure = pictures.wheels(vehicle, axle.solve(found.states[0].position, found.states[0].load))
            else:
                figure = pictures.over_y(profiles.geometry(axle, np.linspace(-WIDE, WIDE, POINTS)), found)
    saving.write(figure, options.output + ".png", options.dpi)


def _wear(options, vehicle, states, cores, endings):
    """Prints the wear and writes its files; their endings."""
    from ...plot import saving
    from .. import wheel as profiles
    from . import pictures, wearing

    law = wearing.Law(options.law or "energy", options.wear)
    if options.distance is None:
        profile, rates, failures = wearing.rates(vehicle, states, law, cores)
        print(f"wear: at most {rates.max():.4g} m per m, at y {1e3 * profile.y[int(np.argmax(rates))]:.2f} mm")
        columns = [
            tables.Column("y", "m", "of the profile", profile.y), tables.Column("z", "m", "down", profile.z),
            tables.Column("depth_per_distance", "1", "worn depth per distance", rates),
        ]  # fmt: skip
    else:
        report = Progress("jump", every=EVERY)
        worn = profiles.wear(vehicle, states, options.distance, law, options.jumps or JUMPS, cores, report)
        deepest, error = worn.deepest
        print(f"wear: {1e6 * deepest:.4g} +- {1e6 * error:.2g} um at most after {options.distance / 1e3:g} km; "
              f"worn area {1e6 * worn.area[-1]:.4g} mm2")  # fmt: skip
        columns, failures = worn.table(), worn.failures
    for text in failures[:SHOWN]:
        _warn(f"wear: {text}")
    if not options.output:
        return []
    tables.write_csv(options.output + "-wear.csv", columns)
    if "-wear.png" in endings:
        saving.write(pictures.worn_profile(worn), options.output + "-wear.png", options.dpi)
    return [ending for ending in endings if ending.startswith("-wear")]


def main():
    """Exit code: 0, 2 for bad usage, 3 for a file that cannot be read or written, 11 without any equilibrium."""
    return guarded("petsam-wheel", lambda: carry_out(arguments(sys.argv[1:])))

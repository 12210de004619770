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
in the track (track_fx ...), all on the rail, maximum pressure, area, stick area, T-gamma, Y/Q and the state, and in
NAME_error the error of each by the cells: it is estimated from a solution on cells twice as wide, as that behind +- in
the printed lines; NAME.png, of one position the sections with pressure and slip of each patch, of a sweep contact
points, rolling radius difference, equivalent conicity (EN 15302) and T-gamma. With --wear NAME-wear.csv has the depth
per distance of each place of the profile by the mean of all positions, and with --distance the profile after it, its
estimated error, and NAME-wear.png.
"""

import sys
import warnings

import numpy as np

from ...core.environment import cores as all_cores
from ...core.errors import Error, Unusable, short
from ...core.files import need_replaceable
from ...core.line import Parser, wrote
from ...core.progress import Progress
from ...core.tables import Tabled
from .inputs import need_ready, states_of, vehicle_of
from .options import JUMPS, add_positions, add_profiles, check_positions, check_profiles, reworded, unlike, warn
from .printing import SHOWN, print_all

EVERY = 2.0  # s between two lines of progress
WIDE, POINTS = 8e-3, 81  # m and number of displacements of the rigid geometry


def _parser():
    one = Parser(
        prog="petsam-wheel", description=__doc__,
    )  # fmt: skip
    add_profiles(one)
    add_positions(one)
    out = one.add_argument_group("output")
    out.add_argument("-o", "--output", metavar="NAME", help="NAME.csv, NAME.png and so on")
    one.add_choice(out)
    return one


def arguments(given):
    """Reads the command line."""
    parser = _parser()
    options = parser.parse_args(given)
    check_profiles(parser, options)
    check_positions(parser, options)
    if options.wear is None:
        for name in ("law", "distance"):
            if getattr(options, name) is not None:
                parser.error(f"--{name}: needs --wear, the coefficient of wear")
    elif unlike(options):
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
        said = f"-o {short(options.output)}: {name} would replace a file that is read: choose another name"
        need_replaceable(name, (*options.wheel, *options.rail, options.table), Unusable(said))
    return endings


def carry_out(options):
    """Reads, solves, prints and writes; exit code."""
    from .. import wheel as profiles

    endings = _outputs(options)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        try:
            vehicle, states = vehicle_of(options), states_of(options)
            need_ready(options, vehicle, states)
        except Error as error:
            raise reworded(error) from error
    for text in dict.fromkeys(str(one.message) for one in caught if issubclass(one.category, UserWarning)):
        if not (options.smooth and "from point to point" in text):
            warn(text)
    cores = options.cores or all_cores()
    if len(states) == 1:
        cores = 1
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of the vehicle: printed above
        found = profiles.solve_all(vehicle, states, cores, Progress("position", every=EVERY), errors=True)
    table = found.table()
    print_all(options, found, table)
    written = []
    if options.output:
        found.to_csv(options.output + ".csv")
        written.append(".csv")
        if ".png" in endings:
            _picture(options, vehicle, found)
            written.append(".png")
    if options.wear is not None:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", profiles.ProfileWarning)  # of the vehicle: printed above
            try:
                written += _wear(options, vehicle, states, cores, endings)
            except Error as error:
                raise reworded(error) from error
    wrote(*(options.output + ending for ending in written))
    return 0


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
        worn = wearing.rates(vehicle, states, law, cores)
        rates, where = worn.depth_per_distance, worn.y[int(np.argmax(worn.depth_per_distance))]
        print(f"wear: at most {rates.max():.4g} m per m, at y {1e3 * where:.2f} mm; {Tabled.unknown} for it")
    else:
        report = Progress("jump", every=EVERY)
        worn = profiles.wear(vehicle, states, options.distance, law, options.jumps or JUMPS, cores, report)
        deepest, error = worn.deepest
        print(f"wear: {1e6 * deepest:.4g} +- {1e6 * error:.2g} um at most after {options.distance / 1e3:g} km; "
              f"worn area {1e6 * worn.area[-1]:.4g} mm2")  # fmt: skip
    for text in worn.failures[:SHOWN]:
        warn(f"wear: {text}")
    if not options.output:
        return []
    worn.to_csv(options.output + "-wear.csv")
    if "-wear.png" in endings:
        saving.write(pictures.worn_profile(worn), options.output + "-wear.png", options.dpi)
    return [ending for ending in endings if ending.startswith("-wear")]


def main():
    """Exit code: 0, 2 for bad usage, 3 for a file that cannot be read or written, 11 without any equilibrium."""
    return carry_out(arguments(sys.argv[1:]))

"""The options of petsam-wheel, what of them goes together, and their names in messages of petsam.wheel."""

import math
import os
import re
import sys
from functools import partial

from ...core import materials, words
from ...core.errors import Error, Unusable
from ...core.line import word
from .words import choice, pair, slope

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


def add_profiles(one):
    """Adds the options of profiles, track and wheelset."""
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
    group.add_argument("--smooth", type=word(words.number, "a length above 0: 4mm", "m", above=0.0), metavar="L",
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
    coefficient = word(words.number, "a coefficient of friction from 0 to below 10", least=0.0, below=10.0)
    group.add_argument("--friction", type=coefficient, default=0.3, metavar="MU", help="(0.3)")
    group.add_argument("--cell", type=_length("a length: 0.2mm"), default=2e-4, metavar="L", help="of a grid (0.2mm)")


def add_positions(one):
    """Adds the options of positions and wear."""
    group = one.add_argument_group("positions")
    sweep = word(words.span, "a lateral displacement, or FIRST:LAST:COUNT: 3mm or -6mm:6mm:121", "m", count=1)
    group.add_argument("--y", type=sweep, metavar="Y", help="lateral displacement, or FIRST:LAST:COUNT")
    angle = word(words.number, "an angle: 2mrad, 0.002 (rad) or 0.1deg", "rad")
    group.add_argument("--yaw", type=angle, metavar="A", help="2mrad, 0.002 (rad) or 0.1deg (0)")
    speed = word(words.number, "a speed above 0: 20 (m/s) or 72km/h", "m/s", above=0.0)
    group.add_argument("--speed", type=speed, metavar="V", help="forward speed: 20 (m/s) or 72km/h")
    newton = word(words.number, "a force above 0: 100kN", "N", above=0.0)
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
    whole = word(words.integer, "a whole number, 1 or more", least=1)
    group.add_argument("--cores", type=whole, metavar="N", help="processes (all available cores)")
    group = one.add_argument_group("wear of the wheel")
    coefficient = word(words.number, "a coefficient above 0: 1e-14", above=0.0)
    group.add_argument("--wear", type=coefficient, metavar="K", help="coefficient of wear: 1e-14 (m3/J, or 1/Pa)")
    group.add_argument(
        "--law", choices=("energy", "archard"), help="volume per frictional work (default), or per force and slip"
    )
    distance = word(words.number, "a distance above 0: 100000km or 1e8 (m)", "m", above=0.0)
    group.add_argument("--distance", type=distance, metavar="D", help="update the profile over it: 100000km")
    even = word(words.integer, "an even number, 2 or more", lambda value: value >= 2 and value % 2 == 0)
    group.add_argument("--jumps", type=even, metavar="N", help="updates of the profile over the distance (10)")


def has_own(name, quantity):
    """True if a profile has its own unit or z: one of a formula, or of SIMPACK, whose files state their unit."""
    return name.lower() in BUILT or quantity == "unit" and name.lower().endswith((".prr", ".prw"))


def check_profiles(parser, options):
    """Ends the command for units and directions of z of profiles that have their own."""
    for quantity in ("unit", "z"):
        given = getattr(options, quantity)
        own = [all(has_own(name, quantity) for name in getattr(options, kind)) for kind in KINDS]
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


def check_positions(parser, options):
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


def optioned(error):
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


def reworded(error):
    """The error with the command's options."""
    return type(error)(optioned(error)) if type(error) in (Error, Unusable) else error


def unlike(options):
    """True if left and right differ."""
    return any(left != right for left, right in (options.wheel, options.rail, options.radius))


def warn(text):
    print(f"petsam-wheel: warning: {optioned(text)}", file=sys.stderr)

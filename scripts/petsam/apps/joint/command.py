"""Stiffness and damping of a joint, for a structural analysis.

    petsam-joint stiffness scan.h5 --pressure 1MPa:50MPa:12 --friction 0.4 --body1 steel --body2 steel -o interface
    petsam-joint backbone lap.h5 --contact lap.opts --preload B1=12kN --sensor TIP:z --amplitudes 1um:0.1mm:9 -o out
    petsam-joint band lap.h5 --contact lap.opts --preload B1=12kN --sensor TIP:z --amplitudes 1um:0.1mm:5
    petsam-joint wear lap.h5 --contact worn.opts --preload B1=12kN --sensor TIP:z --amplitudes 50um --cycles 1e4,1e5,1e6
    petsam-joint response lap.h5 --contact lap.opts --preload B1=12kN --force TIP:z=0.5N --frequencies 110Hz:118Hz:17

stiffness: scan.h5 is a surface or a separation that petsam-surface has written. Prints, for each nominal pressure, the
normal and the tangential stiffness per area of the interface alone, the real contact area, and the energy of a loop of
the shear; with the standard deviation of five windows of the surface, and the exponent chi and the weight beta of an
Iwan element. The loops follow from the approach over the pressure by a formula, and one window is computed to check it;
--full computes the loops of all windows, which dissimilar bodies and a hardness always need. --normal-only leaves the
shear out. --conductivity adds the thermal conductance per area of the interface alone, or with --electrical the
electrical one, of layers, films and gas, too. -o NAME writes NAME.csv with all numbers, NAME.json, elements for
tmdsimpy and pyHarm, NAME.inp, the interaction for a deck of Abaqus, and NAME.png; with --normal-only NAME.csv and
NAME.png. With --conductivity NAME.inp has the conductance, too, also with --normal-only, and NAME-calculix.inp is the
interaction for a deck of CalculiX (of a current as one of heat, since it has no electrical contact).

backbone: lap.h5 is a pair of bodies with bolts and modes that petsam-compliance --pair has written; each of its patches
is a contact with the options of --contact, whose origin is the patch's centre. Tightens the bolts and prints frequency
and damping of a mode over its amplitude, by friction in the joint alone: by quasi-static modal analysis, or with
--harmonics by harmonic balance. -o NAME writes NAME.csv, NAME.png and NAME-contact.png, which shows the pressure in the
preload and where the contact slips.

band: prints the range of the backbone over the histories of assembly: bolts in the given and in the reverse order,
without friction until all are tightened, and after a vibration at the largest amplitude. With --scatter also the
standard deviation by those of friction and preload. -o NAME writes NAME.csv and NAME.png.

wear: prints frequency, damping and the bolts' tension over the cycles of a vibration that wears the contact, whose
options give the wear coefficients. -o NAME writes NAME.csv and NAME.png.

response: prints the response of the same to a harmonic force over its frequency, by harmonic balance, with the damping
of the material and of friction. -o NAME writes NAME.csv and NAME.png.

--report NAME.html writes a page of any of these: the table with its errors, the pictures, and the options as inputs.
"""

import argparse
import contextlib
import sys
import warnings
from functools import partial

import numpy as np

from ...contact.inprocess import AdviceWarning
from ...core import materials, words
from ...core.errors import Unusable, short
from ...core.files import need_regular, need_replaceable
from ...core.line import Parser, add_resolution, guarded, joined, word
from ...core.progress import Progress, to_stderr
from ...plot import page
from ...plot.saving import DPI, write
from . import PART
from .backbones import backbone
from .balance import forced, need_steps
from .bands import band
from .interfaces import interface
from .pair import Pair, contents
from .structure import ENDS
from .sweep import BackboneWarning
from .wearing import rising, wear
from .words import either, file_name

OF_FILES = ("output", "report", "dpi")  # options of the written files
BESIDE = (".h5", ".hdf5", ".txt", ".csv", ".npy")  # endings of --film
BEYOND = 3.0  # the modes of a structure say nothing of frequencies above this ratio to the highest


def _conductivity(text):
    """A conductivity, or the name of a material that has one."""
    if not materials.has(text):
        return words.number(text, allowed=words.positive)
    materials.conductivity(text)
    return text


def _spans(form, example, unit, geometric=True):
    """Reader of FIRST:LAST:COUNT, or of values above 0 separated by commas."""
    form = f"FIRST:LAST:COUNT, or {form} above 0 separated by commas: {example}"
    return word(words.span, form, unit, words.positive, geometric=geometric)


def _from(least):
    """Reader of a whole number from this one on."""
    return word(words.integer, f"a whole number, {least} or more", words.within(least))


def _both(form, first, second):
    """Reader of FIRST,SECOND, each by its reader."""
    return word(words.each, form, first, second)


def _stiffness_options(one):
    group = one.add_argument_group("stiffness")
    group.add_argument(
        "--pressure",
        type=_spans("pressures", "1MPa:50MPa:12", "Pa"),
        help="nominal pressures: FIRST:LAST:COUNT or P,P,...",
    )
    group.add_argument("--friction", type=word(words.number), help="coefficient of friction; not with --normal-only")
    for body in "12":
        group.add_argument(
            f"--body{body}", type=word(materials.elastic), metavar="MATERIAL",
            help=f"material of body {body}: {', '.join(materials.TABLE)}, or Young's modulus and Poisson's ratio, "
            "210GPa,0.3",
        )  # fmt: skip
    group.add_argument(
        "--hardness",
        type=word(words.number, "a pressure above 0, such as 5GPa", "Pa", words.positive),
        help="maximum pressure, where the surfaces yield: 5GPa",
    )
    group.add_argument("--shear", type=word(words.number), help="shear of the loop over friction times pressure (0.5)")
    group.add_argument("--periodic", action="store_true", default=None, help="the surface repeats itself: no windows")
    group.add_argument(
        "--full", action="store_true", default=None, help="compute the loops of all windows instead of one"
    )
    group.add_argument(
        "--normal-only", action="store_true", default=None,
        help="normal stiffness, real contact area and separation alone, without friction",
    )  # fmt: skip
    form = "those of both bodies, two numbers above 0, or materials: 50,50 or steel,copper"
    group.add_argument(
        "--conductivity", metavar="LAM1,LAM2", type=_both(form, _conductivity, _conductivity),
        help="conductivities of both bodies, W/(m K), or materials, for the conductance; with --electrical S/m",
    )  # fmt: skip
    group.add_argument(
        "--electrical", action="store_true", default=None, help="a current instead of heat: units S/m, S/m2, Ohm m2"
    )
    form = "a number, 0 or more, or a file with one at each point: 1e-6, film.h5"
    resistance = partial(words.number, allowed=words.not_negative)
    group.add_argument(
        "--film", metavar="R",
        type=word(either, form, resistance, partial(file_name, form=form, endings=BESIDE)),
        help="resistance of a film on the spots per area, m2 K/W, or Ohm m2, or a file with one at each point of the "
        "surface: a text, or HDF5 with a dataset film",
    )  # fmt: skip
    form = "THICKNESS,CONDUCTIVITY, a length and a number above 0, or a material: 2um,317 or 2um,gold"
    layer = _both(form, partial(words.number, unit="m", allowed=words.positive), _conductivity)
    for body in "12":
        group.add_argument(
            f"--layer{body}", type=layer, metavar="T,LAM", action="append",
            help=f"thickness and conductivity, or material, of a conducting layer on body {body}: 2um,gold; may "
            "be repeated from the surface inwards",
        )  # fmt: skip
    form = "LAM,M, a conductivity above 0 and a length, 0 or more: 0.026,0.37um"
    jump = partial(words.number, unit="m", allowed=words.not_negative)
    group.add_argument(
        "--gas", type=_both(form, partial(words.number, allowed=words.positive), jump), metavar="LAM,M",
        help="conductivity of what fills the gap, W/(m K), and length of the temperature jump: air 0.026,0.37um",
    )  # fmt: skip
    group.add_argument("--cores", type=_from(1), help="processes for the windows (all available cores)")
    group.add_argument(
        "--area",
        type=word(words.number, "an area above 0, such as 2mm2", "m2", words.positive),
        help="area of the elements in NAME.json, such as 2mm2 (1 m2: they are per area)",
    )


def _structure_options(one):
    group = one.add_argument_group("backbone, band, wear and response")
    group.add_argument("--contact", metavar="NAME", help="file of petsam's options: -grid_n, -friction, -gap_type, ...")
    group.add_argument(
        "--preload", type=word(words.named, "BOLT=FORCE, such as B1=12kN", "N", words.not_negative),
        action="append", metavar="BOLT=N",
        help="initial tension of a bolt, such as B1=12kN; may be repeated: bolts are tightened in this order",
    )  # fmt: skip
    group.add_argument("--sensor", metavar="NAME:D", help="where the amplitude is, and its direction x, y or z")
    group.add_argument(
        "--damping",
        type=word(words.number, "a part of critical damping"),
        help="damping of the material, as a part of critical damping (0)",
    )
    group.add_argument(
        "--harmonics", type=_from(0), help="how many are balanced (backbone 0: quasi-static; response 3)"
    )
    group = one.add_argument_group("backbone, band and wear")
    group.add_argument("--mode", type=_from(1), help="number of the mode while all that touches sticks (1)")
    group.add_argument(
        "--amplitudes",
        type=_spans("lengths", "1um:0.1mm:12", "m"),
        help="at the sensor: FIRST:LAST:COUNT, such as 1um:0.1mm:12",
    )
    group.add_argument(
        "--degree-check", action="store_true", default=None,
        help="also the largest amplitude with polynomials of a degree lower by 2",
    )  # fmt: skip
    form = "friction=S or preload=S, a standard deviation as a part of it: friction=0.1"
    scatter = word(words.named, form, allowed=words.part, known="friction|preload")
    group.add_argument(
        "--scatter", type=scatter, action="append", metavar="NAME=S",
        help="standard deviation of friction or preload as a part of it, may be repeated: friction=0.1",
    )  # fmt: skip
    cycles = word(words.numbers, "rising whole numbers above 0: 1e4,1e5,1e6", together=rising, to=np.array)
    group.add_argument("--cycles", type=cycles, help="of the vibration that wears, for the numbers: 1e4,1e5,1e6")
    group = one.add_argument_group("response")
    group.add_argument(
        "--force",
        type=word(words.named, "SENSOR:D=FORCE, such as TIP:z=0.5N", "N", words.positive),
        metavar="SENSOR:D=N",
        help="amplitude of the force, and where it acts; also the sensor",
    )
    group.add_argument(
        "--frequencies", type=_spans("frequencies", "110Hz:118Hz:17", "Hz", geometric=False),
        help="of the force, Hz, in the order of computation: FIRST:LAST:COUNT, such as 110:118:17",
    )  # fmt: skip


def _parser():
    one = Parser(
        prog="petsam-joint",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    one.add_argument("action", choices=list(ACTIONS), help="what is computed")
    one.add_argument("file", help="of petsam-surface (stiffness) or of petsam-compliance --pair")
    one.add_argument(
        "--steps", type=_from(1), help="load steps of a half cycle (8, response 16) or quarter (stiffness 8)"
    )
    one.add_argument("-o", "--output", metavar="NAME", help="write NAME.csv and NAME.png, and other files of NAME")
    one.add_argument(
        "--report", type=word(page.name), metavar="NAME.html", help="write a page with inputs, numbers and pictures"
    )
    add_resolution(one)
    _stiffness_options(one)
    _structure_options(one)
    return one


def _need(reader, args):
    """Ends with an error unless the options are those of the action; sets those that were not given."""
    needed, usual, _ = ACTIONS[args.action]
    for name in sorted({name for needs, others, _ in ACTIONS.values() for name in (*needs, *others)}):
        option, given = f"--{name.replace('_', '-')}", getattr(args, name)
        if name not in needed and name not in usual:
            owners = [action for action, (needs, others, _) in ACTIONS.items() if name in needs or name in others]
            if given is not None:
                reader.error(f"{option} is for petsam-joint {' or '.join(owners)}: remove it")
        elif given is None and name in needed:
            reader.error(f"petsam-joint {args.action} needs {option}")
        elif given is None:
            setattr(args, name, usual[name])


def _run():
    reader = _parser()
    args = reader.parse_args(joined(sys.argv[1:]))
    _need(reader, args)
    if args.dpi != DPI and not args.output:
        raise Unusable("--dpi: is for the picture, which --output writes; give both or none")
    if args.area is not None and not args.output:
        raise Unusable("--area: is for NAME.json, which --output writes; give both or none")
    if args.report:
        need_replaceable(args.report)
    return ACTIONS[args.action][2](args)


def _stiffness(args):
    loops = dict(friction=args.friction, shear=args.shear, steps=args.steps, full=args.full, area=args.area)
    if args.normal_only:
        for name, value in loops.items():
            if value is not None:
                raise Unusable(
                    f"--{name}: is for loops of the shear, which --normal-only leaves out: remove one of both"
                )
    elif args.friction is None:
        raise Unusable("petsam-joint stiffness needs --friction, or --normal-only")
    conducting = _conducting(args)
    for ending in _stiffness_files(args) if args.output else ():
        need_replaceable(args.output + ending)
    options = {name: value for name, value in loops.items() if value is not None and name != "area"}
    options.update(periodic=args.periodic, normal_only=bool(args.normal_only), cores=args.cores)
    for body, (young, poisson) in (("body1", args.body1), ("body2", args.body2)):
        options.update({f"{body}_young": young, f"{body}_poisson": poisson})
    if args.hardness:
        options["pressure_limit"] = args.hardness
    with _recorded(AdviceWarning) as found:
        windows = _progress("window")
        told = dict(report=windows, estimate=windows.estimate)
        result = interface(args.file, args.pressure, **told, **conducting, **options)
    _print(result, found)
    _write_stiffness(args, result)
    _report(args, result)
    return 0


def _conducting(args):
    """The options of the conductance; ends with an error where they need --conductivity."""
    names = ("electrical", "film", "gas", "layer1", "layer2")
    given = {name: getattr(args, name) for name in names if getattr(args, name) is not None}
    if args.conductivity is None:
        for name in given:
            raise Unusable(f"--{name}: is for the conductance: give --conductivity LAM1,LAM2, too")
        return {}
    return {"conductivity": args.conductivity, **{name.replace("layer", "layers"): one for name, one in given.items()}}


def _stiffness_files(args):
    """Endings of the files that stiffness writes."""
    endings = [".csv", ".png", *([] if args.normal_only else [".json", ".inp"])]
    if args.conductivity is not None:
        endings = [*dict.fromkeys([*endings, ".inp"]), "-calculix.inp"]
    return endings


def _write_stiffness(args, result):
    """Writes the files of --output, if it is given."""
    if not args.output:
        return
    ways = {
        ".csv": result.to_csv,
        ".json": lambda path: result.to_json(path, args.area or 1.0),
        ".inp": result.to_abaqus,
        "-calculix.inp": result.to_calculix,
        ".png": lambda path: write(PART.picture("interface")(result), path, args.dpi),
    }
    for ending in _stiffness_files(args):
        ways[ending](args.output + ending)


def _progress(what):
    """The Progress of units that begin now."""
    return Progress(what, _tell)


_tell = to_stderr


@contextlib.contextmanager
def _recorded(kind):
    """Collects warnings, all of this kind, for _print()."""
    with warnings.catch_warnings(record=True) as found:
        warnings.simplefilter("always", kind)
        yield found


def _report(args, result):
    """Writes the page of --report, if it is given, with the options as inputs."""
    if args.report:
        from ...plot.reports import report

        report(result, args.report, _given(args, joined(sys.argv[1:])))


def _given(args, given):
    """{name: text} of the action, the file, and the options as they are given, but those of the written files."""
    shown, rest = {"action": args.action, "file": args.file}, iter(given)
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


def _print(result, found):
    """Prints the table and the warnings."""
    print("\n".join(result.lines()))
    for text in dict.fromkeys(str(one.message).strip() for one in found):
        print(f"petsam-joint: warning: {text}", file=sys.stderr)


def _sensor(text, pair, option="--sensor"):
    """(modes,) displacement of the sensor NAME:D by each modal coordinate."""
    name, _, direction = text.partition(":")
    if name not in pair.sensors or direction not in ("x", "y", "z"):
        raise Unusable(
            f"{option} {short(text)}: expected NAME:x, :y or :z with a sensor of {pair.path}: "
            f"{', '.join(pair.sensors) or 'it has none; make it with --sensor NAME=NODE'}"
        )
    return pair.sensors[name][:, "xyz".index(direction)]


def _judged(args):
    """{bolt: N} of --preload; ends with an error, before anything is computed, where a file is missing or could not be
    written, and where the options do not fit the pair."""
    for ending in (".csv", ".png", "-contact.png") if args.output else ():
        need_replaceable(args.output + ending)
    need_regular(args.contact)
    preload = dict(args.preload or [])
    if len(preload) < len(args.preload or []):
        raise Unusable("--preload: a bolt is given twice; give each once, in the order of tightening")
    pair = contents(args.file, preload)
    for option, place in (("--sensor", args.sensor), ("--force", args.force and args.force[0])):
        if place:
            _sensor(place, pair, option)
    if (args.mode or 1) > pair.omega.size:
        raise Unusable(f"mode {args.mode}: the structure has modes 1 to {pair.omega.size}")
    if args.harmonics:
        need_steps(args.steps, args.harmonics)
    return preload


def _pair(args, preload, **more):
    return Pair(args.file, preload, damping=args.damping or 0.0, options_file=args.contact, **more)


def _tell_tensions(pair, preload):
    for name, tension in pair.tensions.items():
        given = preload.get(name, 0.0)
        print(f"bolt {name}: {tension:.6g} {pair.unit} left of {given:g} {pair.unit} after all are tightened")
        if not tension > 0.0:
            print(f"petsam-joint: warning: bolt {name} bears no tension: a bolt here has no slack", file=sys.stderr)


def _write(args, result, picture):
    if args.output:
        result.to_csv(args.output + ".csv")
        write(PART.picture(picture)(result), args.output + ".png", args.dpi)


def _backbone(args):
    preload = _judged(args)
    given = dict(mode=args.mode, steps=args.steps, harmonics=args.harmonics)

    def compute(lower, amplitudes):
        pair = _pair(args, preload, lower=lower)
        given.update(sensor=_sensor(args.sensor, pair), report=_progress("amplitude"))
        return pair, backbone(pair.structure, amplitudes, **given)

    with _recorded(BackboneWarning) as found:
        pair, result = compute(0, args.amplitudes)
    _tell_tensions(pair, preload)
    _print(result, found)
    if args.degree_check:
        print(_degree_line(args, compute, pair, result))
    _write(args, result, "backbone")
    if args.output:
        write(PART.picture("slip_zones")(result, bolts=pair.places), args.output + "-contact.png", args.dpi)
    _report(args, result)
    return 0


def _band(args):
    preload = _judged(args)
    given = dict(mode=args.mode, steps=args.steps, harmonics=args.harmonics)
    make = lambda preload, **changes: _pair(args, preload, **changes)  # noqa: E731
    with _recorded(BackboneWarning) as found:
        sensor = lambda pair: _sensor(args.sensor, pair)  # noqa: E731
        spread = dict(args.scatter or [])
        result = band(make, preload, args.amplitudes, sensor, spread, _progress("assembly"), **given)
    _print(result, found)
    _write(args, result, "band")
    _report(args, result)
    return 0


def _wear(args):
    if len(args.amplitudes) != 1:
        raise Unusable(f"--amplitudes: petsam-joint wear needs one amplitude, not {len(args.amplitudes)}")
    preload = _judged(args)
    pair = _pair(args, preload)
    sensor = _sensor(args.sensor, pair)

    def tension(structure):
        return {f"{name} [{pair.unit}]": left for name, left in pair.left(structure).items()}

    with _recorded(BackboneWarning) as found:
        given = dict(mode=args.mode, sensor=sensor, steps=args.steps, measure=tension, report=_progress("vibration"))
        result = wear(pair.structure, args.amplitudes[0], args.cycles, **given)
    _print(result, found)
    _write(args, result, "joint_wear")
    _report(args, result)
    return 0


def _check_frequencies(given, structure):
    """Error for frequencies above all modes, as those in rad/s or rpm are."""
    highest = structure.stuck_modes()[0].max() / (2.0 * np.pi)
    if min(given) > BEYOND * highest:
        raise Unusable(
            f"--frequencies {min(given):g} Hz and more: are above {BEYOND:g} times that of the highest mode while all "
            f"that touches sticks, {highest:.4g} Hz: give Hz, not rad/s or rpm"
        )


def _response(args):
    preload = _judged(args)
    place, amplitude = args.force
    pair = _pair(args, preload)
    driven = _sensor(place, pair, "--force")
    sensor = _sensor(args.sensor, pair) if args.sensor else driven
    _check_frequencies(args.frequencies, pair.structure)
    given = dict(steps=args.steps, harmonics=args.harmonics, report=_progress("frequency"))
    with _recorded(BackboneWarning) as found:
        result = forced(pair.structure, amplitude * driven, args.frequencies, sensor, **given)
    _tell_tensions(pair, preload)
    _print(result, found)
    _write(args, result, "response")
    _report(args, result)
    return 0


def _degree_line(args, compute, pair, result):
    """Returns a line on the change at the maximum amplitude by polynomials of a degree lower by 2."""
    if pair.degree <= 1:
        return f"--degree-check: the file has {pair.functions} polynomials and no lower degree: nothing is compared"
    last = len(result.alpha) - 1
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", BackboneWarning)
            _, other = compute(2, args.amplitudes[last : last + 1])
    except ENDS as error:
        return f"degree lower by 2: {error}"
    frequency = other.frequency[-1] / result.frequency[-1] - 1.0
    damping = other.damping[-1] / result.damping[-1] - 1.0 if result.damping[-1] else float("nan")
    return f"degree lower by 2: frequency {frequency:+.1e}, damping {damping:+.1e} at the largest amplitude"


# for each action: options it needs, others with their defaults, the function
ACTIONS = {
    "stiffness": (
        ("pressure", "body1", "body2"),
        dict(
            friction=None,
            hardness=None,
            shear=None,
            periodic=False,
            area=None,
            steps=None,
            full=None,
            normal_only=None,
            cores=None,
            conductivity=None,
            electrical=None,
            film=None,
            gas=None,
            layer1=None,
            layer2=None,
        ),
        _stiffness,
    ),
    "backbone": (
        ("contact", "amplitudes", "sensor"),
        dict(preload=None, mode=1, damping=0.0, harmonics=0, degree_check=False, steps=8),
        _backbone,
    ),
    "band": (
        ("contact", "amplitudes", "sensor"),
        dict(preload=None, mode=1, damping=0.0, harmonics=0, scatter=None, steps=8),
        _band,
    ),
    "wear": (("contact", "amplitudes", "sensor", "cycles"), dict(preload=None, mode=1, steps=8), _wear),
    "response": (
        ("contact", "force", "frequencies"),
        dict(preload=None, sensor=None, damping=0.0, harmonics=3, steps=16),
        _response,
    ),
}


def main():
    """Runs the command; returns its exit code."""
    return guarded("petsam-joint", _run)

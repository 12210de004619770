"""petsam-joint backbone, band, wear and response: what a pair of bodies with bolts does in a vibration."""

import sys
import warnings

import numpy as np

from ...core.errors import Unusable, short
from ...core.files import need_regular, need_replaceable
from ...core.line import wrote
from ...core.progress import Progress
from ...plot.saving import write
from . import PART
from .backbones import backbone
from .balance import forced, need_steps
from .bands import band
from .failures import ENDS
from .pair import Pair, contents
from .sweep import BackboneWarning
from .telling import recorded, tell, write_page
from .wearing import wear

BEYOND = 3.0  # the modes of a structure say nothing of frequencies above this ratio to the highest


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
        wrote(args.output + ".csv", args.output + ".png")


def of_backbone(args):
    """Computes, prints and writes the backbone; exit code."""
    preload = _judged(args)
    given = dict(mode=args.mode, steps=args.steps, harmonics=args.harmonics)

    def compute(lower, amplitudes):
        pair = _pair(args, preload, lower=lower)
        given.update(sensor=_sensor(args.sensor, pair), report=Progress("amplitude"))
        return pair, backbone(pair.structure, amplitudes, **given)

    with recorded(BackboneWarning) as found:
        pair, result = compute(0, args.amplitudes)
    _tell_tensions(pair, preload)
    tell(result, found)
    if args.degree_check:
        print(_degree_line(args, compute, pair, result))
    _write(args, result, "backbone")
    if args.output:
        write(PART.picture("slip_zones")(result, bolts=pair.places), args.output + "-contact.png", args.dpi)
        wrote(args.output + "-contact.png")
    write_page(args, result)
    return 0


def of_band(args):
    """Computes, prints and writes the band over the histories of assembly; exit code."""
    preload = _judged(args)
    given = dict(mode=args.mode, steps=args.steps, harmonics=args.harmonics)
    make = lambda preload, **changes: _pair(args, preload, **changes)  # noqa: E731
    with recorded(BackboneWarning) as found:
        sensor = lambda pair: _sensor(args.sensor, pair)  # noqa: E731
        spread = dict(args.scatter or [])
        result = band(make, preload, args.amplitudes, sensor, spread, Progress("assembly"), **given)
    tell(result, found)
    _write(args, result, "band")
    write_page(args, result)
    return 0


def of_wear(args):
    """Computes, prints and writes what wear does over the cycles; exit code."""
    if len(args.amplitudes) != 1:
        raise Unusable(f"--amplitudes: petsam-joint wear needs one amplitude, not {len(args.amplitudes)}")
    preload = _judged(args)
    pair = _pair(args, preload)
    sensor = _sensor(args.sensor, pair)

    def tension(structure):
        return {f"{name} [{pair.unit}]": left for name, left in pair.left(structure).items()}

    with recorded(BackboneWarning) as found:
        given = dict(mode=args.mode, sensor=sensor, steps=args.steps, measure=tension, report=Progress("vibration"))
        result = wear(pair.structure, args.amplitudes[0], args.cycles, **given)
    tell(result, found)
    _write(args, result, "joint_wear")
    write_page(args, result)
    return 0


def _check_frequencies(given, structure):
    """Error for frequencies above all modes, as those in rad/s or rpm are."""
    highest = structure.stuck_modes()[0].max() / (2.0 * np.pi)
    if min(given) > BEYOND * highest:
        raise Unusable(
            f"--frequencies {min(given):g} Hz and more: are above {BEYOND:g} times that of the highest mode while all "
            f"that touches sticks, {highest:.4g} Hz: give Hz, not rad/s or rpm"
        )


def of_response(args):
    """Computes, prints and writes the response to a harmonic force; exit code."""
    preload = _judged(args)
    place, amplitude = args.force
    pair = _pair(args, preload)
    driven = _sensor(place, pair, "--force")
    sensor = _sensor(args.sensor, pair) if args.sensor else driven
    _check_frequencies(args.frequencies, pair.structure)
    given = dict(steps=args.steps, harmonics=args.harmonics, report=Progress("frequency"))
    with recorded(BackboneWarning) as found:
        result = forced(pair.structure, amplitude * driven, args.frequencies, sensor, **given)
    _tell_tensions(pair, preload)
    tell(result, found)
    _write(args, result, "response")
    write_page(args, result)
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

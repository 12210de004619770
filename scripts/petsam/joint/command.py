"""Stiffness per area of a joint's contact, for a structural analysis.

    petsam-joint stiffness scan.h5 --pressure 1MPa:50MPa:12 --friction 0.4 --body1 steel --body2 steel -o interface

scan.h5 is a surface or a separation that petsam-surface has written. Prints, for each nominal pressure, the normal and
the tangential stiffness per area of the interface alone, the real contact area, and the energy of a loop of the shear;
with the standard deviation of five windows of the surface, and the exponent chi and the weight beta of an Iwan element.
-o NAME writes NAME.csv with all numbers, NAME.json, elements for tmdsimpy and pyHarm, NAME.inp, the interaction for a
deck of Abaqus, and NAME.png.
"""

import argparse
import re
import sys
import warnings

import h5py
import numpy as np

from ..contact import AdviceWarning
from ..errors import FILE, USAGE, Error, Parser, fail, guarded, joined, short
from ..files import need_regular, need_replaceable
from ..plot.saving import DPI, add_resolution, write
from . import interface

MATERIALS = {"steel": (210e9, 0.3), "aluminium": (70e9, 0.33), "titanium": (115e9, 0.32), "nickel": (205e9, 0.3)}
PASCALS = {"": 1.0, "Pa": 1.0, "kPa": 1e3, "MPa": 1e6, "GPa": 1e9}


class Unreadable(Error):
    """A file that is no surface."""

    code = FILE


def stress(text):
    """Reader of a stress for argparse: a number in Pa, or with its unit."""
    found = re.fullmatch(r"([0-9.]+(?:[eE][+-]?[0-9]+)?)(Pa|kPa|MPa|GPa|)", text)
    try:
        value = float(found[1]) * PASCALS[found[2]]
    except (TypeError, ValueError):
        value = -1.0
    if not 0.0 < value < float("inf"):
        what = "expected a stress above 0, such as 5e6 (Pa) or 5MPa"
        raise argparse.ArgumentTypeError(f"{short(text) or repr('')}: {what}")
    return value


def pressures(text):
    """Reader of pressures for argparse: FIRST:LAST:COUNT in geometric steps, or P,P,..."""
    words = text.split(":")
    if len(words) == 1:
        return np.array([stress(word) for word in text.split(",")])
    if len(words) != 3 or not words[2].isdigit() or not 2 <= int(words[2]) <= 1000:
        raise argparse.ArgumentTypeError(f"{short(text)}: expected FIRST:LAST:COUNT, or pressures separated by commas")
    return np.array([float(f"{p:.12g}") for p in np.geomspace(stress(words[0]), stress(words[1]), int(words[2]))])


def material(text):
    """Reader of a body's material for argparse: a name, or E,NU."""
    if text in MATERIALS:
        return MATERIALS[text]
    words = text.split(",")
    try:
        young, poisson = float("inf") if words[0] == "inf" else stress(words[0]), float(words[1])
    except (argparse.ArgumentTypeError, ValueError, IndexError):
        young = poisson = -1.0
    if len(words) != 2 or young < 0 or not 0.0 <= poisson < 0.5:
        raise argparse.ArgumentTypeError(
            f"{short(text)}: expected {', '.join(MATERIALS)}, or Young's modulus (inf: rigid) and Poisson's ratio: "
            "210GPa,0.3"
        )
    return young, poisson


def read_separation(path):
    """Separation (m) of a file of petsam-surface, and the distance of its points along x and y."""
    need_regular(path)
    try:
        with h5py.File(path) as file:
            name = next(name for name in ("separation", "height") if name in file)
            values, x, y = file[name][()].astype(float), file["x"][()], file["y"][()]
            if values.shape != (y.size, x.size) or min(values.shape) < 4:
                raise ValueError(f"/{name} has the shape {values.shape}")
            missing = values.size - np.isfinite(values).sum()
            if missing:
                raise ValueError(
                    f"/{name} has no number at {missing} of {values.size} points; see petsam-surface --fill"
                )
            sign = 1.0 if name == "separation" else -1.0
            return sign * values, (float(x[1] - x[0]), float(y[1] - y[0]))
    except (OSError, LookupError, ValueError, TypeError, StopIteration) as error:
        reason = short(error) or "no dataset height or separation"
        raise Unreadable(f"{path}: no surface of petsam-surface: {reason}") from error


def _parser():
    one = Parser(
        prog="petsam-joint",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    one.add_argument("action", choices=["stiffness"], help="stiffness: stiffness and damping per area of an interface")
    one.add_argument("surface", help="file of petsam-surface: heights, or a separation")
    one.add_argument(
        "--pressure", type=pressures, required=True, help="nominal pressures (Pa): FIRST:LAST:COUNT or P,P,..."
    )
    one.add_argument("--friction", type=float, required=True, help="coefficient of friction")
    for body in "12":
        one.add_argument(
            f"--body{body}", type=material, required=True, metavar="MATERIAL",
            help=f"material of body {body}: {', '.join(MATERIALS)}, or Young's modulus and Poisson's ratio, 210GPa,0.3",
        )  # fmt: skip
    one.add_argument("--hardness", type=stress, help="maximum pressure (Pa), where the surfaces yield")
    one.add_argument("--shear", type=float, default=0.5, help="shear of the loop over friction times pressure (0.5)")
    one.add_argument("--steps", type=int, default=8, help="load steps of a quarter of the loop (8)")
    one.add_argument("--periodic", action="store_true", help="the surface repeats itself: no windows of it")
    one.add_argument(
        "--area", type=float, default=1.0, help="area of the elements in NAME.json, m2 (1: they are per area)"
    )
    one.add_argument("-o", "--output", metavar="NAME", help="write NAME.csv, NAME.json, NAME.inp and NAME.png")
    add_resolution(one)
    return one


def _run():
    args = _parser().parse_args(joined(sys.argv[1:]))
    if args.steps < 1:
        raise Error(f"--steps {args.steps}: expected 1 or more")
    if args.dpi != DPI and not args.output:
        raise Error("--dpi: is for the picture, which --output writes; give both or none")
    if not 0.0 < args.area < float("inf"):
        raise Error(f"--area {args.area:g}: expected an area above 0, in m2")
    for ending in (".csv", ".json", ".inp", ".png") if args.output else ():
        need_replaceable(args.output + ending)
    separation, spacing = read_separation(args.surface)
    options = dict(friction=args.friction, shear=args.shear, steps=args.steps)
    for body, (young, poisson) in (("body1", args.body1), ("body2", args.body2)):
        options.update({f"{body}_young": young, f"{body}_poisson": poisson})
    if args.hardness:
        options["pressure_limit"] = args.hardness
    compute = interface.of_interface if args.periodic else interface.of_windows
    if not args.periodic:
        options["report"] = lambda k, count: print(f"window {k} of {count}", file=sys.stderr, flush=True)
    with warnings.catch_warnings(record=True) as found:
        warnings.simplefilter("always", AdviceWarning)
        result = compute(separation, spacing, args.pressure, **options)
    print("\n".join(result.table()))
    for one in found:
        print(f"petsam-joint: warning: {one.message}", file=sys.stderr)
    if args.output:
        result.to_csv(args.output + ".csv")
        result.to_json(args.output + ".json", args.area)
        result.to_abaqus(args.output + ".inp")
        write(result.plot(), args.output + ".png", args.dpi)
    return 0


def _main():
    try:
        return _run()
    except Error as error:
        return fail("petsam-joint", error, getattr(error, "code", USAGE))


def main():
    """Runs the command; returns its exit code."""
    return guarded("petsam-joint", _main)

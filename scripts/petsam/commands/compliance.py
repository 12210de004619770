"""Compute how a real body deforms beyond a half-space, for petsam's -body1_compliance and -body2_compliance.

    petsam-compliance --mesh block.inp --units mm --contact TOP --fixed BOTTOM --frame 0,0,0 --patch 2.4mm
    petsam-compliance --mesh beam.inp --units mm --contact TOP --fixed ENDS --frame 0,0,0:1,0,0 --patch 3mm,2mm \\
        --degree 6 --case pull=1 -o beam.h5
    petsam-compliance --mesh lap.inp --units mm --contact LOWER --pair UPPER --fixed CLAMP --patch 36mm,20mm \\
        --degree 12,6 --bolt B1=TOP_WASHER,BOTTOM_WASHER:8mm --modes 12 --sensor TIP=1234 -o lap.h5

Reads a CalculiX deck (.inp) of solid elements: C3D20, C3D20R, C3D8I, C3D10 and others, isotropic elastic materials.
The stiffness is assembled here, that of C3D8I by CalculiX. The contact is on the patch, a rectangle about --center in
the plane z = 0 of the frame, whose z points into the body; it lies on the surface --contact. The body is held at the
nodes of --fixed; the nodes of --symmetry do not leave their plane: of half of a body whose halves are loaded alike. A
load case is a step of the deck, with *CLOAD, *DLOAD, *DSLOAD or *BOUNDARY, without contact. Writes HDF5 and a picture
beside it.

With --pair the deck has both bodies, and bolts join them. The file is the compliance of both, for -body2_compliance:
displacement of body 2 minus that of body 1. Unit initial tension of a bolt is the load case bolt_NAME, and a mode
without contact the load case modeK. With --free instead of --fixed nothing holds the pair, as a structure that hangs on
strings: the bolts must join the bodies. Rigid motions of the whole do not move the contact and are left out, their
inertia balances load cases, and modes are elastic ones. Each material needs *DENSITY.
"""

import argparse
import collections
import math
import os
import re
import shlex
import sys
import warnings

from .. import plot
from ..compliance import basis, model, several, writing
from ..compliance.units import UNITS
from ..core import isolation
from ..core.errors import Error, Parser, fail, guarded, joined, short
from ..core.files import need_replaceable, same
from ..core.hdf5 import need_own
from ..core.lengths import lengths, shown, sides
from ..core.lengths import several as numbers
from ..plot.saving import add_choice, write

HIGHEST = 10  # highest degree that petsam reads
HIGHEST_EACH, MOST_FUNCTIONS = 24, 325  # the same of degrees in x and y, and the number of their products
NAME = re.compile(r"[A-Za-z0-9_]{1,20}")
Bolt = collections.namedtuple("Bolt", "name surfaces diameter young")
MOST_CASES, MOST_OF_PAIR = 8, 40
LONGEST = 20  # letters of the name of a load case
PAIR_ONLY = ("bolt", "modes", "sensor")
RESERVED = ("closing", "closing_by")  # names beside those of bolts in the file
PROGRAM = "petsam-compliance"


def frame(text):
    """Reads a frame for argparse: an origin, a direction x and a direction z."""
    parts = [re.split(r",", part) for part in text.split(":")]
    try:
        vectors = [[float(word) for word in part] for part in parts]
    except ValueError:
        vectors = []
    if not 1 <= len(vectors) <= 3 or not all(len(vector) == 3 for vector in vectors):
        raise argparse.ArgumentTypeError(
            f"{short(text)}: expected ORIGIN[:X[:Z]], each of them three numbers: 0,0,0:1,0,0"
        )
    return vectors


def case(text):
    """Reads a load case for argparse."""
    name, _, step = text.partition("=")
    if not NAME.fullmatch(name) or not step.isdecimal():
        raise argparse.ArgumentTypeError(
            f"{short(text)}: expected NAME=STEP, a name of at most 20 letters, digits or _ and a step of the deck"
        )
    return name, int(step)


def degree(text):
    """Reads a degree for argparse: of all products, or largest ones in x and y."""
    words = text.split(",")
    most = HIGHEST if len(words) == 1 else HIGHEST_EACH
    if len(words) > 2 or not all(word.isdecimal() and int(word) <= most for word in words):
        raise argparse.ArgumentTypeError(
            f"{short(text)}: expected an integer from 0 to {HIGHEST}, or two from 0 to {HIGHEST_EACH} for x and y: 12,6"
        )
    if len(words) == 1:
        return int(text)
    found = tuple(int(word) for word in words)
    count = len(basis.powers(found))
    if count > MOST_FUNCTIONS:
        raise argparse.ArgumentTypeError(
            f"{short(text)} gives {count} polynomials, limit {MOST_FUNCTIONS}: lower the degree in one direction"
        )
    return found


def bolt(text):
    """Reads a bolt for argparse."""
    name, _, rest = text.partition("=")
    surfaces, *numbers = rest.split(":")
    both = surfaces.split(",")
    if not NAME.fullmatch(name) or name in RESERVED or len(both) != 2 or not all(both) or len(numbers) not in (1, 2):
        raise argparse.ArgumentTypeError(
            f"{short(text)}: expected NAME=SURFACE1,SURFACE2:DIAMETER[:YOUNG], as in B1=HEAD,NUT:8mm"
        )
    if len("bolt_" + name) > LONGEST:
        raise argparse.ArgumentTypeError(f"{short(name)}: use a name of at most {LONGEST - len('bolt_')} letters")
    young = positive(numbers[1]) if len(numbers) == 2 else None
    return Bolt(name, tuple(both), length(numbers[0]), young)


def positive(text):
    """Reads a modulus for argparse."""
    try:
        value = float(text)
    except ValueError:
        value = 0.0
    if not 0.0 < value < float("inf"):
        raise argparse.ArgumentTypeError(f"{short(text)}: expected a modulus above 0, in Pa")
    return value


def modes(text):
    """Reads a number of modes for argparse."""
    if not text.isdecimal() or not 1 <= int(text) <= MOST_OF_PAIR:
        raise argparse.ArgumentTypeError(f"{short(text)}: expected an integer from 1 to {MOST_OF_PAIR}")
    return int(text)


def sensor(text):
    """Reads a sensor for argparse."""
    name, _, node = text.partition("=")
    if not NAME.fullmatch(name) or not node:
        raise argparse.ArgumentTypeError(f"{short(text)}: expected NAME=NODE, a node of the deck or a set of one node")
    return name, node


def length(text):
    """Reads a length above 0 for argparse."""
    values = lengths(text)
    if len(values) != 1 or not 0.0 < values[0] < float("inf"):
        raise argparse.ArgumentTypeError(f"{short(text)}: expected a length above 0")
    return values[0]


def _body_options(parser):
    body = parser.add_argument_group("the body")
    body.add_argument("--mesh", required=True, metavar="NAME.inp", help="CalculiX deck with mesh, sets and materials")
    body.add_argument("--contact", metavar="SURFACE", help="element surface of the deck on which the patch lies")
    body.add_argument("--fixed", action="append", metavar="NSET", help="node set held in x, y, z; may be repeated")
    body.add_argument(
        "--symmetry", action="append", metavar="NSET", help="node set in a plane of symmetry; may be repeated"
    )
    body.add_argument("--units", choices=tuple(UNITS), default="m", help="m: m, N, Pa; mm: mm, N, MPa (m)")
    body.add_argument(
        "--frame",
        type=frame,
        metavar="ORIGIN[:X[:Z]]",
        help="of the contact in the deck's coordinates and units; Z points into the body (0,0,0:1,0,0, surface normal)",
    )
    body.add_argument("--case", type=case, action="append", metavar="NAME=STEP", help="load case: a step of the deck")


def _pair_options(parser):
    pair = parser.add_argument_group("a pair: both bodies in one mesh, body 2 with --contact")
    pair.add_argument("--pair", metavar="SURFACE", help="element surface of body 1 that faces --contact")
    pair.add_argument(
        "--bolt",
        type=bolt,
        action="append",
        metavar="NAME=S1,S2:D[:E]",
        help="bolt from washer surface S1 on body 1 to S2 on body 2, its diameter and its modulus, Pa (the bodies'); "
        "may be repeated",
    )
    pair.add_argument(
        "--free", action="store_true", default=None, help="instead of --fixed: nothing holds the bodies; needs *DENSITY"
    )
    pair.add_argument("--modes", type=modes, metavar="N", help="number of modes without contact; needs *DENSITY")
    pair.add_argument(
        "--sensor",
        type=sensor,
        action="append",
        metavar="NAME=NODE",
        help="node, or set of one node, whose modes are written",
    )


def parser():
    """Creates the parser of the command line."""
    found = Parser(prog=PROGRAM, description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    _body_options(found)
    _pair_options(found)
    patch = found.add_argument_group("the patch")
    patch.add_argument("--patch", type=sides, required=True, metavar="X[,Y]", help="full widths: 2e-3 (m) or 2mm")
    patch.add_argument(
        "--center",
        type=numbers(2, "X,Y"),
        action="append",
        metavar="X,Y",
        help="its centre in the frame (0,0); repeated: several patches of a pair, all of one size",
    )
    patch.add_argument(
        "--degree",
        type=degree,
        default=6,
        metavar="N|NX,NY",
        help=f"of the polynomials: the sum in x and y, 0 to {HIGHEST}, or the largest in x and in y, up to "
        f"{HIGHEST_EACH} (6)",
    )
    method = found.add_argument_group("method")
    method.add_argument("--method", choices=("auto", "image", "cutoff"), default="auto", help="(auto: image if valid)")
    method.add_argument(
        "--stiffness",
        choices=("own", "calculix"),
        help="what assembles it: petsam, or CalculiX (own; elements C3D8I: calculix)",
    )
    method.add_argument("--coarse-mesh", metavar="NAME.inp", help="a coarser deck, to estimate the error of the mesh")
    method.add_argument("--depth", type=length, metavar="Z", help="of the stress points (the patch's smaller width)")
    method.add_argument("--no-stress", dest="stress", action="store_false", help="omit stresses below the surface")
    out = found.add_argument_group("output")
    out.add_argument("-o", "--output", metavar="NAME.h5", help="(the deck's name, here)")
    out.add_argument("--picture", metavar="NAME.png", help="(beside the output)")
    add_choice(out)
    return found


def _check_free(reader, options):
    """Checks what belongs to --free."""
    if options.fixed:
        reader.error("--free holds nothing: remove it, or --fixed")
    if not options.pair:
        reader.error(
            "--free is for a pair: a body alone moves away under the loads of its contact: hold it by --fixed, or give "
            "the surface of body 1 by --pair"
        )


def _check_pair(reader, options):
    """Checks --pair and what belongs to it, or to one body alone."""
    if not options.pair:
        for name in PAIR_ONLY:
            if getattr(options, name):
                reader.error(f"--{name} is for a pair: give the surface of body 1 by --pair, or remove it")
    elif options.depth or options.method == "cutoff":
        name = "--depth" if options.depth else "--method cutoff"
        reader.error(f"{name} is not for a pair, which has no stresses and the method image only: remove it")
    elif options.symmetry:
        reader.error("--symmetry: a pair is given as a whole: remove it, or give one body alone, without --pair")


def _check_cases(reader, options):
    """Checks the names and the numbers of load cases, patches, bolts and sensors."""
    options.bolt, options.sensor = options.bolt or [], options.sensor or []
    options.center = options.center or [(0.0, 0.0)]
    if len(options.center) > 1 and not options.pair:
        reader.error("--center: several patches are for a pair: give the surface of body 1 by --pair, or one centre")
    if len(options.center) > 1 and any(re.fullmatch(several.NAME + r"[0-9]+", name) for name, _ in options.case):
        reader.error(f"--case: {several.NAME} with a number is a name of the file's own: give another one")
    if options.sensor and not options.modes:
        reader.error("--sensor needs --modes: give their number, or remove it")
    if len({name for name, _ in options.sensor}) < len(options.sensor):
        reader.error("--sensor: give each name once")
    names = [name for name, _ in options.case] + [f"bolt_{one.name}" for one in options.bolt]
    names += [f"mode{k}" for k in range(1, 1 + (options.modes or 0))]
    most = MOST_OF_PAIR if options.pair else MOST_CASES
    if len(set(names)) < len(names) or len(names) > most:
        bolts = ", with those of --bolt and --modes" if options.pair else ""
        reader.error(f"--case: give each name once, at most {most} of them{bolts}")


def arguments(words):
    """Reads the command line."""
    reader = parser()
    options = reader.parse_args(joined(words))
    if options.free:
        _check_free(reader, options)
    for name in ("contact",) if options.free else ("contact", "fixed"):
        if getattr(options, name) is None:
            other = ", or --free for a pair that nothing holds" if name == "fixed" and options.pair else ""
            reader.error(f"--mesh needs --{name}{other}")
    options.frame = options.frame or [[0.0, 0.0, 0.0]]
    options.case, options.symmetry, options.fixed = options.case or [], options.symmetry or [], options.fixed or []
    _check_pair(reader, options)
    _check_cases(reader, options)
    options.ccx = os.environ.get("CCX", "ccx")
    base = os.path.splitext(os.path.basename(options.mesh))[0]
    options.output = options.output or base + ".h5"
    options.picture = options.picture or os.path.splitext(options.output)[0] + ".png"
    if not options.picture.lower().endswith(".png"):
        reader.error(f"--picture: {short(options.picture)}: use a name that ends in .png")
    return options


def description(found):
    """Returns lines that describe a Joined."""
    body = found.bodies[0]
    lines = [
        f"half-space  E = {body.young:.6g} Pa, nu = {body.poisson:.6g}",
        *(["body 1      E = {:.6g} Pa, nu = {:.6g}".format(*body.other)] if body.other else []),
    ]
    for one in found.bodies:
        lines += _patch(one)
    if len(found.bodies) > 1:
        far = ", ".join(str(sum(case.unit == several.UNIT for case in one.cases.values())) for one in found.bodies)
        lines.append(
            f"coupling    load cases of the other patches: {far}; they miss {found.missed:.1e} of the half-space's"
        )
        lines.append(f"            smallest eigenvalue of all patches {found.least:.3g}")
    return lines + _joint(body)


def _patch(body):
    """Returns lines that describe the patch of a Body."""
    m = body.patch.count
    lines = [
        "patch       {} x {} about x = {:g} m, y = {:g} m".format(
            *(shown(2.0 * half) for half in body.patch.half), *body.patch.center
        ),
        f"functions   {m} of degree {basis.written(body.patch.degree)} in each direction, method {body.method}",
        *(f"            {text}" for text in body.remarks),
        "checks      asymmetry {:.1e}, smallest eigenvalue {:.3g} relative to the half-space".format(
            body.checks["asymmetry"], body.checks["smallest_eigenvalue"]
        ),
    ]
    if "degree_change" in body.checks:
        lower = basis.written(basis.reduced(body.patch.degree, 2))
        lines.append(f"            degree {lower} changes the correction by {body.checks['degree_change']:.1e}")
    if "mesh_change" in body.checks:
        lines.append(f"            the coarser mesh changes the compliance by {body.checks['mesh_change']:.1e}")
    lines += [
        f"load case   {name}: the polynomials miss {one.rest:.1e} of its field"
        for name, one in body.cases.items()
        if one.unit != several.UNIT
    ]
    return lines


def _joint(body):
    """Returns lines that describe the bolts and modes of a Body."""
    lines = []
    for one in body.bolts:
        left = 1.0 - one.stiffness * one.closing @ body.cases[f"bolt_{one.name}"].displacement
        lines.append(
            f"bolt        {one.name}: {one.stiffness:.4g} N/m, {shown(one.diameter)} x {shown(one.length)}, without "
            f"contact {max(0.0, left[0, 0]):.2g} of its tension is left"
        )
    if body.modes:
        lines.append("modes, Hz   " + ", ".join(f"{omega / (2.0 * math.pi):.6g}" for omega in body.modes.omega))
        if body.modes.rigid is not None:
            lines.append(
                f"            six rigid motions are left out, at most {body.modes.rigid[-1] / (2.0 * math.pi):.1e} Hz"
            )
        lines.append(
            f"            orthonormal within {body.modes.mass_error:.1e}, smallest eigenvalue without them "
            f"{body.checks['residual_eigenvalue']:.3g}"
        )
    return lines


def carry_out(options, words):
    """Computes, writes, draws and prints; in a child process, as it may read an HDF5 file."""
    inputs = [name for name in (options.mesh, options.coarse_mesh) if name]
    for name in [options.output] + ([] if options.no_picture else [options.picture]):
        if any(same(name, path) for path in inputs):
            raise Error(f"{name}: is an input file; choose another name by --output")
    need_own(options.output, writing.SIGN, PROGRAM)
    if not options.no_picture:
        need_replaceable(options.picture)
    command = shlex.join([PROGRAM, *words])
    progress = model.Progress(sys.stderr)
    found = model.computed(options.mesh, options, command, progress)
    body = found.bodies[0]
    for text in body.remarks:
        if text.startswith("warning: "):
            print(f"{PROGRAM}: {text}", file=sys.stderr)
    writing.write(found, options.output)
    if not options.no_picture:
        write(plot.compliance(found.bodies), options.picture, options.dpi)
    print(f"{options.output}: compliance of {options.mesh}")
    print("\n".join("  " + line for line in description(found) if "warning: " not in line))
    if not options.no_picture:
        print("wrote " + options.picture)
    if len(found.bodies) > 1:
        return
    name = shlex.quote(options.output)
    print(
        f"options for petsam:\n  -body2_compliance {name} -body2_young {body.young:.10g} "
        f"-body2_poisson {body.poisson:.10g}"
        + (" -body1_young {:.10g} -body1_poisson {:.10g}".format(*body.other) if body.other else "")
    )


def _child(options, words):
    warnings.simplefilter("ignore")
    try:
        carry_out(options, words)
    except (Error, OSError) as error:
        return fail(PROGRAM, error)
    return 0


def main():
    """Returns the exit code: 0, 2 for bad usage, 3 for a file or a body that is rejected."""

    def parent():
        words = sys.argv[1:]
        options = arguments(words)
        (code,) = isolation.each(lambda _: _child(options, words), [None])
        return fail(PROGRAM, code) if isinstance(code, Error) else code

    return guarded(PROGRAM, parent)

"""Compute how a real body deforms beyond a half-space, for petsam's -body1_compliance and -body2_compliance.

    petsam-compliance --mesh block.inp --units mm --contact TOP --fixed BOTTOM --frame 0,0,0 --patch 2.4mm
    petsam-compliance --mesh beam.inp --units mm --contact TOP --fixed ENDS --frame 0,0,0:1,0,0 --patch 3mm,2mm \\
        --degree 6 --case pull=1 -o beam.h5
    petsam-compliance --mesh lap.inp --units mm --contact LOWER --pair UPPER --fixed CLAMP --patch 36mm,20mm \\
        --degree 12,6 --bolt B1=TOP_WASHER,BOTTOM_WASHER:8mm --modes 12 --sensor TIP=1234 -o lap.h5

Reads a CalculiX deck (.inp) of solid elements: C3D20, C3D20R, C3D8I, C3D10 and others, isotropic elastic materials. The
stiffness is assembled here, that of C3D8I by CalculiX. Linear elements (C3D8, C3D4, CPE4 and others) make a body too
stiff: they become quadratic ones on straight edges. The error by the mesh is estimated and stored. The contact is on
the patch, a rectangle about --center in the plane z = 0 of the frame, whose z points into the body; it lies on the
surface --contact. The body is held at the nodes of --fixed; the nodes of --symmetry do not leave their plane: of half
of a body whose halves are loaded alike. The frame of the contact is that of body 2: x, y and z are right-handed, with z
into body 2 and y = z x x. A load case is a step of the deck, with *CLOAD, *DLOAD, *DSLOAD or *BOUNDARY, without
contact. Writes HDF5 and a picture beside it.

Instead of a deck a file that the library meshio reads (of Gmsh, Abaqus, Nastran, Salome and others), with --young and
--poisson or --material, and sets by their names, physical groups of Gmsh, too. Instead of a set or a surface a box
gives its nodes or outer faces by coordinates: two corners in the mesh's units, 0,0,4:4,4,4, inf for no limit.

With --pair the deck has both bodies, and bolts join them. The file is the compliance of both, for -body2_compliance:
displacement of body 2 minus that of body 1. Unit initial tension of a bolt is the load case bolt_NAME, and a mode
without contact the load case modeK. With --free instead of --fixed nothing holds the pair, as a structure that hangs on
strings: the bolts must join the bodies. Rigid motions of the whole do not move the contact and are left out, their
inertia balances load cases, and modes are elastic ones. Each material needs *DENSITY.
"""

import math
import os
import re
import shlex
import sys
import time
from functools import partial

from ...core import materials, words
from ...core.errors import Unusable, short
from ...core.files import need_replaceable
from ...core.frames import Frame
from ...core.hdf5 import need_own
from ...core.line import Parser, word, wrote
from ...core.units import shown
from ...plot.saving import write
from . import basis, model, several, writing
from .settings import HIGHEST, HIGHEST_EACH, MOST_OF_PAIR, NAME, Bolt, Settings, need_bolt, need_degree, need_sense
from .units import UNITS

PROGRAM = "petsam-compliance"
RIGID = {6: "six", 4: "four"}  # motions of bodies, of sections
SECONDS = 5.0  # between two lines of progress
MODULUS, LENGTH = "a modulus above 0, such as 210GPa", "a length above 0, such as 1e-3 (m) or 1mm"
modulus = partial(words.number, form=MODULUS, unit="Pa", above=0.0)
length = partial(words.number, form=LENGTH, unit="m", above=0.0)


def degree(found):
    """The degree of all products, or the largest ones in x and y, of one number or two."""
    value = found[0] if len(found) == 1 else tuple(found)
    need_degree(value)
    return value


def bolt(text):
    """A bolt. Its surfaces may be boxes, which have commas and a colon."""
    name, _, rest = text.partition("=")
    point = r"[^,:]+,[^,:]+,[^,:]+"
    surface = rf"({point}:{point}|[^,:]+)"
    found = re.fullmatch(rf"{surface},{surface}:([^:]+)(?::([^:]+))?", rest)
    need_bolt(name if found else "", text)
    return Bolt(name, found.groups()[:2], length(found[3]), None if found[4] is None else modulus(found[4]))


def _body_options(parser):
    body = parser.add_argument_group("the body")
    body.add_argument(
        "--mesh",
        required=True,
        metavar="NAME",
        help="CalculiX deck (.inp), or a file that meshio reads, with --young, --poisson",
    )
    body.add_argument("--contact", metavar="SURFACE", help="element surface on which the patch lies, or box")
    body.add_argument(
        "--fixed", action="append", metavar="NSET", help="node set held in x, y, z, or box; may be repeated"
    )
    body.add_argument(
        "--symmetry", action="append", metavar="NSET", help="node set in a plane of symmetry; may be repeated"
    )
    body.add_argument("--units", choices=tuple(UNITS), default="m", help="m: m, N, Pa; mm: mm, N, MPa (m)")
    body.add_argument(
        "--frame",
        type=word(Frame.read),
        default=((0.0, 0.0, 0.0),),
        metavar="ORIGIN[:X[:Z]]",
        help="of the contact in the deck's coordinates and units; Z points into the body (0,0,0:1,0,0, surface normal)",
    )
    for name, form, unit, ends, text in (
        ("young", MODULUS, "Pa", dict(above=0.0), "Young's modulus of a mesh without materials, Pa"),
        ("poisson", "a ratio from -1 to 0.5", "1", dict(above=-1.0, below=0.5), "its Poisson's ratio"),
        ("density", "a density above 0, in kg/m3", "kg/m3", dict(above=0.0), "its density, kg/m3"),
    ):
        reads = word(words.named, form, unit, **ends, bare="")
        body.add_argument(f"--{name}", type=reads, action="append", metavar="[SET=]VALUE", help=text)
    body.add_argument(
        "--material", type=word(words.named, "[SET=]NAME, such as steel", reader=materials.find, bare=""),
        action="append", metavar="[SET=]NAME",
        help="the three of a material by its name, where they are not given: steel, Ti-6Al-4V, ... (petsam.materials)",
    )  # fmt: skip
    form = "NAME=STEP, a name of at most 20 letters, digits or _ and a step of the deck"
    case = word(words.named, form, reader=partial(words.integer, least=0), known=NAME)
    body.add_argument("--case", type=case, action="append", metavar="NAME=STEP", help="load case: a step of the deck")


def _pair_options(parser):
    pair = parser.add_argument_group("a pair: both bodies in one mesh, body 2 with --contact")
    pair.add_argument("--pair", metavar="SURFACE", help="element surface of body 1 that faces --contact")
    pair.add_argument(
        "--bolt",
        type=word(bolt),
        action="append",
        metavar="NAME=S1,S2:D[:E]",
        help="bolt from washer surface S1 on body 1 to S2 on body 2, its diameter and its modulus, Pa (the bodies'); "
        "may be repeated",
    )
    pair.add_argument(
        "--free", action="store_true", help="instead of --fixed: nothing holds the bodies; needs *DENSITY"
    )
    pair.add_argument(
        "--modes",
        type=word(words.integer, f"an integer from 1 to {MOST_OF_PAIR}", least=1, most=MOST_OF_PAIR),
        default=0,
        metavar="N",
        help="number of modes without contact; needs *DENSITY",
    )
    pair.add_argument(
        "--sensor",
        type=word(words.named, "NAME=NODE, a node of the deck or a set of one node", reader=str, known=NAME),
        action="append",
        metavar="NAME=NODE",
        help="node, or set of one node, whose modes are written",
    )


def parser():
    """Creates the parser of the command line."""
    found = Parser(prog=PROGRAM, description=__doc__)
    _body_options(found)
    _pair_options(found)
    patch = found.add_argument_group("the patch")
    patch.add_argument(
        "--patch", type=word(words.sides), required=True, metavar="X[,Y]", help="full widths: 2mm; X of a section"
    )
    patch.add_argument(
        "--center",
        type=word(words.numbers, "X,Y", "m", count=2),
        action="append",
        metavar="X,Y",
        help="its centre in the frame (0,0); repeated: several patches of a pair, all of one size",
    )
    form = f"an integer from 0 to {HIGHEST}, or two from 0 to {HIGHEST_EACH} for x and y: 12,6"
    patch.add_argument(
        "--degree",
        type=word(words.integers, form, least=0, count=(1, 2), to=degree),
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
    method.add_argument(
        "--keep-elements", action="store_true", help="keep linear elements, which make a body too stiff (raised)"
    )
    method.add_argument("--coarse-mesh", metavar="NAME", help="a coarser one: how much it changes the compliance")
    method.add_argument(
        "--depth", type=word(length), metavar="Z", help="of the stress points (the patch's smaller width)"
    )
    method.add_argument("--no-stress", dest="stress", action="store_false", help="omit stresses below the surface")
    out = found.add_argument_group("output")
    out.add_argument("-o", "--output", metavar="NAME.h5", help="(the deck's name, here)")
    out.add_argument("--picture", metavar="NAME.png", help="(beside the output)")
    found.add_choice(out)
    return found


def _material(given, name):
    """A number, or {set: number}, of the values of an option that may be repeated; None without one."""
    if given is None:
        return None
    if len(dict(given)) < len(given) or len(given) > 1 and "" in dict(given):
        raise Unusable(f"--{name}: give one value for all elements, or SET=VALUE once for each set")
    return dict(given).get("", dict(given))


def _with_named(options, name):
    """The values of an option for all elements or for sets, and those of the named materials where it has none."""
    given = getattr(options, name)
    have = dict(given or ())
    named = [(group, getattr(one, name)) for group, one in options.material or () if group not in have]
    return [*(given or ()), *named] or None


def settings(options):
    """The Settings of the command line, which are checked."""
    of_body = tuple(_material(_with_named(options, name), name) for name in ("young", "poisson", "density"))
    found = Settings(
        contact=options.contact,
        patch=options.patch,
        centers=tuple(tuple(one) for one in options.center or [(0.0, 0.0)]),
        supports=tuple(options.fixed or ()),
        symmetry=tuple(options.symmetry or ()),
        free=options.free,
        units=options.units,
        frame=options.frame,
        pair=options.pair,
        bolts=tuple(options.bolt or ()),
        modes=options.modes,
        sensors=tuple(options.sensor or ()),
        cases=tuple(options.case or ()),
        degree=options.degree,
        method=options.method,
        stiffness=options.stiffness,
        keep_elements=options.keep_elements,
        depth=options.depth,
        stress=options.stress,
        coarse=options.coarse_mesh,
        materials=None if of_body == (None, None, None) else of_body,
        ccx=os.environ.get("CCX", "ccx"),
    )
    need_sense(found)
    return found


def arguments(given):
    """Reads the command line; what is to be computed of it as `settings`."""
    reader = parser()
    options = reader.parse_args(given)
    try:
        options.settings = settings(options)
    except Unusable as error:
        reader.error(str(error))
    base = os.path.splitext(os.path.basename(options.mesh))[0]
    options.output = options.output or base + ".h5"
    if options.picture and options.no_picture:
        reader.error("--picture: --no-picture draws none: remove one of both")
    options.picture = options.picture or os.path.splitext(options.output)[0] + ".png"
    if not options.picture.lower().endswith(".png"):
        reader.error(f"--picture: {short(options.picture)}: use a name that ends in .png")
    return options


def description(found):
    """Returns lines that describe a Compliance."""
    body = found.bodies[0]
    lines = [
        f"half-space  E = {body.young:.6g} Pa, nu = {body.poisson:.6g}",
        *(["body 1      E = {:.6g} Pa, nu = {:.6g}".format(*body.other)] if body.other else []),
    ]
    if body.mesh.told:
        lines.insert(0, f"elements    {body.mesh.told}")
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
    where = "{} x {} about x = {:g} m, y = {:g} m".format(
        *(shown(2.0 * half) for half in body.patch.half), *body.patch.center
    )
    if isinstance(body.patch, basis.LinePatch):
        where = f"{shown(2.0 * body.patch.half[0])} about x = {body.patch.center[0]:g} m, of a section"
    lines = [
        f"patch       {where}",
        f"functions   {m} of degree {basis.written(body.patch.degree)} in each direction, method {body.method}",
        *(f"            {text}" for text in body.remarks),
        "checks      asymmetry {:.1e}, smallest eigenvalue {:.3g} relative to the half-space".format(
            body.checks["asymmetry"], body.checks["smallest_eigenvalue"]
        ),
    ]
    if "degree_change" in body.checks:
        lower = basis.written(basis.reduced(body.patch.degree, 2))
        lines.append(f"            degree {lower} changes the correction by {body.checks['degree_change']:.1e}")
    if body.mesh_error is not None:
        lines.append(f"            the mesh makes an error of about {body.mesh_error:.1e} of the compliance")
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
    lines, unit = [], "N/m" if body.datum is None else "N/m2"
    for one in body.bolts:
        left = 1.0 - one.stiffness * one.closing @ body.cases[f"bolt_{one.name}"].displacement
        lines.append(
            f"bolt        {one.name}: {one.stiffness:.4g} {unit}, {shown(one.diameter)} x {shown(one.length)}, without "
            f"contact {max(0.0, left[0, 0]):.2g} of its tension is left"
        )
    if body.modes:
        lines.append("modes, Hz   " + ", ".join(f"{omega / (2.0 * math.pi):.6g}" for omega in body.modes.omega))
        if body.modes.rigid is not None:
            lines.append(
                f"            {RIGID[len(body.modes.rigid)]} rigid motions are left out, at most "
                f"{body.modes.rigid[-1] / (2.0 * math.pi):.1e} Hz"
            )
        lines.append(
            f"            orthonormal within {body.modes.mass_error:.1e}, smallest eigenvalue without them "
            f"{body.checks['residual_eigenvalue']:.3g}"
        )
    return lines


def carry_out(options, given):
    """Computes, writes, draws and prints."""
    for name in [options.output] + ([] if options.no_picture else [options.picture]):
        need_replaceable(name, (options.mesh, options.coarse_mesh))
    need_own(options.output, writing.SIGN, PROGRAM)
    command = shlex.join([PROGRAM, *given])
    start = time.monotonic()

    def say(text):
        print(f"  {time.monotonic() - start:.0f} s: {text}", file=sys.stderr, flush=True)

    found = model.computed(options.mesh, options.settings, command, say, SECONDS)
    body = found.bodies[0]
    for text in body.remarks:
        if text.startswith("warning: "):
            print(f"{PROGRAM}: {text}", file=sys.stderr)
    writing.write(found, options.output)
    if not options.no_picture:
        from . import pictures

        write(pictures.compliance(found), options.picture, options.dpi)
    print(f"{options.output}: compliance of {options.mesh}")
    print("\n".join("  " + line for line in description(found) if "warning: " not in line))
    wrote(options.output, *([] if options.no_picture else [options.picture]))
    if len(found.bodies) > 1:
        return
    name = shlex.quote(options.output)
    plane = "" if body.datum is None else "-elasticity plane "
    print(
        f"options for petsam:\n  {plane}-body2_compliance {name} -body2_young {body.young:.10g} "
        f"-body2_poisson {body.poisson:.10g}"
        + (" -body1_young {:.10g} -body1_poisson {:.10g}".format(*body.other) if body.other else "")
    )


def main():
    """Returns the exit code: 0, 2 for bad usage, 3 for a file or a body that is rejected."""
    given = sys.argv[1:]
    return carry_out(arguments(given), given)

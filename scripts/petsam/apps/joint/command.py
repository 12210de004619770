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

import sys

from ...core.errors import Unusable
from ...core.files import need_replaceable
from ...core.line import Parser, word
from .options import add_stiffness, add_structure, whole
from .stiffnesses import of_stiffness
from .vibrations import of_backbone, of_band, of_response, of_wear
from .words import ending


def _parser():
    page = word(ending, form="a name that ends in .html", endings=(".html",))
    one = Parser(prog="petsam-joint", description=__doc__)
    one.add_argument("action", choices=list(ACTIONS), help="what is computed")
    one.add_argument("file", help="of petsam-surface (stiffness) or of petsam-compliance --pair")
    one.add_argument(
        "--steps", type=whole(1), help="load steps of a half cycle (8, response 16) or quarter (stiffness 8)"
    )
    one.add_argument("-o", "--output", metavar="NAME", help="write NAME.csv and NAME.png, and other files of NAME")
    one.add_argument("--report", type=page, metavar="NAME.html", help="write a page with inputs, numbers and pictures")
    one.add_resolution()
    add_stiffness(one)
    add_structure(one)
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


def main():
    """Runs the command; returns its exit code."""
    reader = _parser()
    args = reader.parse_args()
    args.given = reader.joined(sys.argv[1:])
    _need(reader, args)
    if args.dpi != reader.get_default("dpi") and not args.output:
        raise Unusable("--dpi: is for the picture, which --output writes; give both or none")
    if args.area is not None and not args.output:
        raise Unusable("--area: is for NAME.json, which --output writes; give both or none")
    if args.report:
        need_replaceable(args.report)
    return ACTIONS[args.action][2](args)


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
        of_stiffness,
    ),
    "backbone": (
        ("contact", "amplitudes", "sensor"),
        dict(preload=None, mode=1, damping=0.0, harmonics=0, degree_check=False, steps=8),
        of_backbone,
    ),
    "band": (
        ("contact", "amplitudes", "sensor"),
        dict(preload=None, mode=1, damping=0.0, harmonics=0, scatter=None, steps=8),
        of_band,
    ),
    "wear": (("contact", "amplitudes", "sensor", "cycles"), dict(preload=None, mode=1, steps=8), of_wear),
    "response": (
        ("contact", "force", "frequencies"),
        dict(preload=None, sensor=None, damping=0.0, harmonics=3, steps=16),
        of_response,
    ),
}

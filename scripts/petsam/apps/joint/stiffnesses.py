"""petsam-joint stiffness: the numbers of an interface over the pressure."""

from ...contact.errors import AdviceWarning
from ...core.errors import Unusable
from ...core.files import need_replaceable
from ...core.line import wrote
from ...core.progress import Progress
from ...plot.saving import write
from . import PART
from .interfaces import interface
from .telling import recorded, tell, write_page


def of_stiffness(args):
    """Computes, prints and writes the numbers; exit code."""
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
    with recorded(AdviceWarning) as found:
        windows = Progress("window")
        told = dict(report=windows, estimate=windows.estimate)
        result = interface(args.file, args.pressure, **told, **conducting, **options)
    tell(result, found)
    _write_stiffness(args, result)
    write_page(args, result)
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
        wrote(args.output + ending)

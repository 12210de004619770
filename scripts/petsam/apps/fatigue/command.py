"""Lives, safety factors and short cracks from the stresses of a fretting cycle, as petsam-stress writes them.

    petsam-fatigue fatigue.h5                                 the largest parameter's place, and values over its depth
    petsam-fatigue --material ti64.yaml fatigue.h5            all that its constants are good for
    petsam-fatigue --at -5e-4,0 --quantity stress_xx,swt --csv line.csv fatigue.h5       numbers below another place
    petsam-fatigue --material ti64.yaml --counts 1e4,20 low.h5 high.h5       damage of a spectrum of two blocks

Each file holds one closed cycle (petsam-stress -fatigue swt,findley -quantities stress -depths 0:3e-4:61). Lives:
Smith-Watson-Topper and Fatemi-Socie of the file's parameters, Basquin of the stress range on planes normal to the
surface. Safety factors: the limit relative to Findley's, Crossland's or Dang Van's parameter. Crack: a straight-fronted
crack grows along the line from the surface, normal to it; its range of K, El Haddad's threshold, the length of arrest.
Files are the blocks of a spectrum: damage is Palmgren and Miner's sum over --counts, which repeats until it is 1.
Constants, in SI units or with their unit (1.76GPa), in a YAML file of lines NAME: VALUE or by --constant:
"""

import os
import sys

import numpy as np

from ...core import words
from ...core.errors import Error, short
from ...core.files import need_replaceable
from ...core.line import Parser, word, wrote
from ...core.progress import Progress
from ...plot import saving
from ...results.stresses import Stresses
from . import evaluation, materials, spectrum, strength
from .stresses import Cycle

SECONDS = 5.0  # between two lines of progress, most lives take less
ROWS = 10  # number of printed rows of the line
CRITERIA = tuple(evaluation.CRITERIA)
MOST = f"{strength.MOST:.0e}".replace("+", "")


def arguments(given):
    """Reads the command line."""
    table = (f"  {name:16} {one.unit:9} {one.meaning}" for name, one in materials.CONSTANTS.items())
    parser = Parser(prog="petsam-fatigue", description=__doc__ + "\n".join(table))
    parser.add_argument(
        "files", nargs="+", metavar="FILE.h5", help="of petsam-stress; several are blocks of a spectrum"
    )
    what = parser.add_argument_group("what is computed")
    what.add_argument(
        "--material", metavar="NAME.yaml", help="constants of the material: a file, or its name, as 7075-T6"
    )
    constant = word(
        words.named, "NAME=VALUE, such as sigma_f=1.76GPa", reader=str,
        to=lambda found: (found[0], materials.checked(*found)),
    )  # fmt: skip
    what.add_argument(
        "--constant",
        type=constant,
        action="append",
        default=[],
        metavar="NAME=VALUE",
        help="a constant, such as sigma_f=1.76GPa (the file's)",
    )
    what.add_argument(
        "--criteria",
        type=word(words.names, known=CRITERIA, what="criterion"),
        metavar="NAME,...",
        help=f"of {', '.join(CRITERIA)} (all with constants and data)",
    )
    what.add_argument(
        "--counts", type=word(words.numbers), metavar="N,...", help="cycles of each file in the spectrum (1)"
    )
    what.add_argument(
        "--plane",
        type=word(words.number, "degrees from -180 to 180", "degrees", least=-180.0, most=180.0),
        default=0.0,
        metavar="DEGREES",
        help="angle of the plane's normal to x (0)",
    )
    where = parser.add_argument_group("line along the depth").add_mutually_exclusive_group()
    where.add_argument(
        "--at",
        type=word(words.numbers, "X,Y, such as 0.1mm,0", "m", count=2),
        metavar="X,Y",
        help="below this place, such as -0.5mm,0",
    )
    where.add_argument(
        "--hot", metavar="NAME", help="below the maximum of this parameter on the surface (the first one)"
    )
    out = parser.add_argument_group("output")
    out.add_argument(
        "--quantity", type=word(words.names), metavar="NAME,...", help="on the line, maxima of the cycle (parameters)"
    )
    out.add_argument("--csv", metavar="NAME.csv", help="write the lines: columns name [unit], SI")
    out.add_argument("--labels", metavar="TEXT,...", help="the files' names in the picture (their file names)")
    out.add_argument("-o", "--output", metavar="NAME", help="picture: .png, .pdf or .svg (NAME_depth.png of the file)")
    parser.add_choice(out)
    options = parser.parse_args(given)
    options.counts = options.counts or [1.0] * len(options.files)
    if len(options.counts) != len(options.files) or not all(0.0 < count < np.inf for count in options.counts):
        parser.error(f"--counts: {len(options.files)} files need as many numbers above 0")
    if options.labels and len(options.labels.split(",")) != len(options.files):
        parser.error(f"--labels: {len(options.files)} files need as many names")
    if options.output and options.no_picture:
        parser.error("--output: --no-picture draws none: remove one of both")
    base = os.path.splitext(os.path.basename(options.files[0]))[0]
    options.output = options.output or base + "_depth.png"
    if not options.output.lower().endswith((".png", ".pdf", ".svg")):
        parser.error(f"--output {short(options.output)}: use a name that ends in .png, .pdf or .svg")
    return options


def _where(one):
    return f"at x = {one.x:.4g} m, y = {one.y:.4g} m, z = {one.z:.4g} m"


def _lived(life):
    if np.isinf(life):
        return f"more than {MOST} cycles"
    return f"{life:.4g} cycles" + (", fails at once" if life <= strength.LEAST else "")


def _report(found, name, several):
    """Prints the least lives or factors of every cycle, and of a spectrum, of several blocks or counts, the damage."""
    title, is_life = evaluation.CRITERIA[name][0], name in evaluation.LIVES
    for cycle, least, bounds in zip(found.cycles, found.least[name], found.bounds[name]):
        text = f"life {_lived(least.value)}" if is_life else f"safety factor {least.value:.4g}"
        if bounds:
            text += f" ({_shown(bounds[0])} to {_shown(bounds[1])} by {100 * cycle.error:.2g} % of the tractions)"
        mean = f", of means over {cycle.averaged:g} m" if cycle.averaged else ""
        doubt = "; see the warning" if cycle.doubt else ""
        print(f"{cycle.path}: {title}: {text} {_where(least)}{mean}{doubt}")
    if is_life and several:
        most = found.damage[name]
        repeats = f", {1.0 / most.value:.4g} repeats" if most.value > 0.0 else ""
        print(f"spectrum: {title}: damage {most.value:.4g} {_where(most)}{repeats}")


def _shown(value):
    """Formats a number of the line; only lives may be infinite."""
    return ">" + MOST if np.isinf(value) else f"{value:.4g}"


def _print_line(line):
    """Some rows of a line's columns; a factor is the limit over its parameter."""
    columns = {name: column for name, column in line.columns.items() if not name.startswith("factor")}
    widths = [10, *(max(10, len(name), len(unit)) for name, (unit, _) in columns.items())]
    rows = [("z", *columns), ("m", *(unit for unit, _ in columns.values()))]
    for k in sorted({round(k) for k in np.linspace(0, line.z.size - 1, min(ROWS, line.z.size))}):
        rows.append([_shown(value) for value in (line.z[k], *(values[k] for _, values in columns.values()))])
    for row in rows:
        print("  " + "  ".join(f"{word:>{width}}" for word, width in zip(row, widths)))


def _print_crack(cycle, start, stop, from_surface):
    end = f"arrests at {stop:.4g} m" if np.isfinite(stop) else f"through all depths, to {cycle.z[-1]:.4g} m"
    if np.isinf(start):
        text = f"does not grow at any length from {cycle.z[1]:.4g} to {cycle.z[-1]:.4g} m"
    elif from_surface:
        text = f"grows from {start:.4g} m on, {end}"
    else:
        text = f"does not grow from the surface; a crack of {start:.4g} m grows, {end}"
    print(f"{cycle.path}: short crack: {text}")


def _cycles(options):
    """The cycles of the files; Error where one is no file of petsam-stress, or an output would replace it."""
    for name in [options.csv] + ([] if options.no_picture else [options.output]):
        if name:
            need_replaceable(name, options.files, Error(f"{name}: would replace the results; choose another name"))
    labels = options.labels.split(",") if options.labels else [None] * len(options.files)
    return [Cycle(Stresses(path, label)) for path, label in zip(options.files, labels)]


def _warn(cycles):
    """Warnings of cycles that petsam-stress has warned of."""
    for cycle in cycles:
        if cycle.doubt:
            print(
                f"petsam-fatigue: warning: {cycle.path}: {cycle.doubt}: the values are not those of a steady cycle"
                + ("; give petsam-stress the -steps of a later one" if cycle.doubt.startswith("not a closed") else ""),
                file=sys.stderr,
            )


def carry_out(options):
    """Compute, print and draw."""
    constants = {**(materials.named(options.material) if options.material else {}), **dict(options.constant)}
    found = spectrum.lives(
        _cycles(options), constants, counts=options.counts, criteria=options.criteria, plane=options.plane,
        below=options.at or options.hot, quantities=options.quantity, report=Progress("part", every=SECONDS),
    )  # fmt: skip
    for name in found.values:
        _report(found, name, len(found.cycles) > 1 or options.counts != [1.0])
    for k, (cycle, (_, line)) in enumerate(zip(found.cycles, found.lines)):
        if found.cracks:
            _print_crack(cycle, *found.cracks[k])
        print(f"{cycle.path}: below x = {line.x:.4g} m, y = {line.y:.4g} m ({found.place}):")
        _print_line(line)
    if options.csv:
        found.to_csv(options.csv)
        wrote(options.csv)
    if found.cycles[0].z.size > 1 and not options.no_picture:
        from . import pictures

        saving.write(pictures.lives(found), options.output, options.dpi)
        wrote(options.output)
    _warn(found.cycles)


def main():
    """Exit code: 0, 2 for bad usage, 3 for a file that cannot be read or written, or lacks data."""
    return carry_out(arguments(sys.argv[1:]))

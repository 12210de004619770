"""Turn the nodal contact forces of a structural analysis into a load history for petsam's -history.

    petsam-loads forces.csv --length mm --force N --frame auto
    petsam-loads job.rpt --deck job.inp --length mm --force N --patch FLANK --frame=5,0,0:-1,0,1:1,0,1 -o flank.csv
    petsam-loads job.frd --deck job.inp --length mm --force N --on body1 --patch LEFT --frame 0,0,0:1,0,0:0,0,-1 \\
        --patch RIGHT=4,0,0:8,4,0 --frame 6,2,0:1,0,0:0,0,-1

Reads a table (label, x, y, z, fx, fy, fz, and time or increment; heads may have units, `x [mm]`), a .dat or .frd of
CalculiX, or a field output report of Abaqus (Node Label, CNORMF, CSHEARF). Coordinates that the file lacks, and sets,
come from the deck. The table may have displacements ux, uy, uz, or other coordinates at each time.

The frame of the contact is that of petsam-compliance for body 2: x, y and z are right-handed, with z into body 2 and y
= z x x; origin, x and z are given in the analysis's coordinates and units. A force on body 2 along z is a positive N;
forces on body 1 are reversed. Moments are about the origin: M_x = -sum(y F_z - z F_y), M_y = sum(x F_z - z F_x), M_z =
sum(x F_y - y F_x). With --frame auto the origin is the mean place of the pressing forces at the largest N, z the
direction of the normal forces (CNORMF) or normal to the nodes' plane, and x along their largest extent; the frame is
printed.

Writes the history, columns time, load_n, load_tx, load_ty, load_mx, load_my, load_mz in SI units, and a picture beside
it. Prints ranges, reversals and the path of the contact's centre; warns of pull, of moments beyond the patch, and of
patches that move.
"""

import os
import re
import sys

import numpy as np

from ...core import words
from ...core.decks import Box
from ...core.errors import counted, short
from ...core.files import need_replaceable
from ...core.frames import Frame
from ...core.line import Parser, word, wrote
from ...core.units import shown
from .resultants import ROUNDING, SYMBOLS, UNKNOWN_HERE

PROGRAM = "petsam-loads"
NAME = re.compile(r"[A-Za-z0-9_][A-Za-z0-9_.-]{0,59}")


def _patch(text):
    """Name and set, or box, of a patch."""
    name, equal, where = text.partition("=")
    if not NAME.fullmatch(name) or equal and not where:
        raise words.WordError(text, "NAME, NAME=SET or NAME=X,Y,Z:X,Y,Z, a name of letters, digits, _, . and -")
    where = where or name
    if ":" in where and "," in where and not Box.of(where):
        raise words.WordError(text, "a box of two corners, NAME=0,0,0:4,4,0")
    return name, where


def parser():
    """Creates the parser of the command line."""
    found = Parser(prog=PROGRAM, description=__doc__)
    found.add_argument("file", metavar="FORCES", help="table, .dat or .frd of CalculiX, report of Abaqus")
    of = found.add_argument_group("the analysis")
    of.add_argument("--deck", metavar="NAME.inp", help="its deck: coordinates of the nodes, and sets")
    of.add_argument("--length", metavar="UNIT", help="unit of its lengths, such as mm (that of the table's heads)")
    of.add_argument("--force", metavar="UNIT", help="unit of its forces, such as N (that of the table's heads)")
    of.add_argument(
        "--on", choices=("body1", "body2"), default="body2", help="body on which the forces act; 1: reversed (body2)"
    )
    patch = found.add_argument_group("the patches")
    patch.add_argument(
        "--patch",
        type=word(_patch),
        action="append",
        metavar="NAME[=SET]",
        help="set of nodes, element surface, part instance or box X,Y,Z:X,Y,Z; may be repeated (all nodes)",
    )
    patch.add_argument(
        "--frame",
        type=word(Frame.read, besides=("auto",)),
        action="append",
        metavar="ORIGIN[:X[:Z]]",
        help="of the contact, or auto; one for all patches, or one for each, in their order",
    )
    out = found.add_argument_group("output")
    out.add_argument("-o", "--output", metavar="NAME.csv", help="of one patch (PATCH-history.csv)")
    out.add_argument("-d", "--directory", metavar="NAME", help="folder of PATCH-history.csv of each patch (here)")
    out.add_argument(
        "--compare",
        metavar="RESULTS.h5",
        help="of petsam with the history of one patch: also NAME-beside.png, CPRESS and CSHEAR of the table (columns "
        "cpress, cshear1, cshear2) beside petsam's along y = 0",
    )
    found.add_choice(out)
    return found


def arguments(given):
    """Reads the command line; patches with their frames and outputs as `wanted`."""
    reader = parser()
    options = reader.parse_args(given)
    if options.frame is None:
        reader.error("--frame: give the frame of the contact, ORIGIN:X:Z, or auto")
    base = os.path.splitext(os.path.basename(options.file))[0]
    patches = options.patch or [(base, None)]
    names = [name for name, _ in patches]
    if len(set(names)) < len(names):
        reader.error("--patch: give each name once")
    if len(options.frame) not in (1, len(patches)):
        given = f"{len(options.frame)} frames, and the number of patches is {len(patches)}"
        reader.error(f"--frame: {given}: give one for all patches, or one for each")
    if options.output and (len(patches) > 1 or options.directory):
        reader.error("--output: names the file of one patch: give --directory alone, for PATCH-history.csv of each")
    if options.output and not options.output.lower().endswith(".csv"):
        reader.error(f"--output {short(options.output)}: use a name that ends in .csv")
    if options.compare and (len(patches) > 1 or options.no_picture):
        reader.error("--compare: is for the picture of one patch: give one --patch, and no --no-picture")
    frames = options.frame * len(patches) if len(options.frame) == 1 else options.frame
    outputs = [options.output or os.path.join(options.directory or "", f"{name}-history.csv") for name in names]
    options.wanted = list(zip(patches, frames, outputs))
    return options


def _picture(output):
    return os.path.splitext(output)[0] + ".png"


def _beside(output):
    return os.path.splitext(output)[0] + "-beside.png"


def _span(values, unit, small=0.0):
    """Smallest and largest of values; those up to `small` are 0."""
    low, high = (float(end) if abs(end) > small else 0.0 for end in (np.nanmin(values), np.nanmax(values)))
    return f"{low + 0.0:.6g} {unit}" if low == high else f"{low + 0.0:.6g} to {high + 0.0:.6g} {unit}"


def description(found):
    """Returns lines that describe a History."""
    turns = {name: len(rows) for name, rows in found.turns().items()}
    nodes, rows = counted(len(found.x), "node"), counted(len(found.times), "row")
    reverse = ", reversed" if found.on == "body1" else ""
    lines = [
        UNKNOWN_HERE,
        f"forces      on body {found.on[-1]}{reverse}; {nodes}, {rows}, time {_span(found.times, 's')}",
        f"frame       {found.frame_text}" + (f", z {found.z_by}" if found.z_by else ""),
    ]
    for column, small in zip(found.table()[1:7], found.rounding):
        turned = counted(turns[column.name], "reversal")
        lines.append(f"{SYMBOLS[column.name]:<11} {_span(column.values, column.unit, small)}, {turned}")
    if np.any(np.isfinite(found.friction)):
        center = found.center[np.isfinite(found.center[:, 0])]
        way, small = np.max(np.linalg.norm(center - center[0], axis=1)), ROUNDING * np.max(np.abs(found.extent))
        x, y, way = (value if abs(value) > small else 0.0 for value in (*center[0], way))
        lines += [
            f"T/N         up to {np.nanmax(found.friction):.4g}",
            f"centre      x = {shown(x)}, y = {shown(y)} in the first row with contact, moves by up to {shown(way)}",
        ]
    return lines


def carry_out(options):
    """Reads, sums, writes, draws and prints."""
    from ...plot.saving import write
    from ...results.file import Results
    from .. import loads
    from . import pictures

    for _, _, output in options.wanted:
        drawn = [] if options.no_picture else [_picture(output)]
        for name in [output, *drawn] + ([_beside(output)] if options.compare else []):
            need_replaceable(name, (options.file, options.deck, options.compare))
    forces = loads.read(options.file, deck=options.deck, length=options.length, force=options.force)
    results = [
        (loads.history(forces, frame=axes, patch=where, on=options.on, name=name), output)
        for (name, where), axes, output in options.wanted
    ]
    for found, output in results:
        for text in found.notes:
            print(f"{PROGRAM}: warning: {short(found.name)}: {text}", file=sys.stderr)
        found.write(output)
        print(f"{output}: load history of {short(found.name)}, {options.file}")
        print("\n".join("  " + line for line in description(found)))
        wrote(output)
        if not options.no_picture:
            write(pictures.loads(found), _picture(output), options.dpi)
            wrote(_picture(output))
        if options.compare:
            with Results(options.compare) as results:
                write(pictures.loads_beside(found, results), _beside(output), options.dpi)
            wrote(_beside(output))


def main():
    """Returns the exit code: 0, 2 for bad usage, 3 for a file that is rejected."""
    return carry_out(arguments(sys.argv[1:]))

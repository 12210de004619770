"""Bring measured surfaces into petsam: units, sign, tilt and form, window, grid; two surfaces into a separation.

    petsam-surface rough.npy --body 2 --units um --size 1mm --level tilt
    petsam-surface scan.sur --body 1 --mirror x --level sphere --grid-n 512 -o top.h5
    petsam-surface top.h5 bottom.h5 -o pair.h5
    petsam-surface --self-affine 0.8 --rms 0.5um --wavelengths 500um,10um --size 1mm --grid-n 512 --seed 3 -o r3.h5

Reads NumPy's .npy and .npz, text (.csv, .txt: one line per y, one number per x; points x, y, z of a regular grid;
profiles x, z), HDF5 (.h5), and through the library SurfaceTopography from PyPI Matlab's .mat and the files of many
instruments; of several arrays in a file the only map, or the one chosen by --dataset or --channel. Writes HDF5 for
petsam's -gap_file and -gap_rough_file, and a picture beside it. Options give what the file does not contain (units,
size, body). A map is centred on x = y = 0 unless its file gives a position. Heights are positive outward, so a peak of
either body reduces the separation. Each map is oriented, cut, freed of outliers, filled, levelled and resampled, in
this order. Options apply to both files; their maps are then aligned at their centres.
Heights of body 1 and heights of body 2 make a separation.
"""

import os
import shlex
import sys
from dataclasses import replace

import numpy as np

from ...core import words
from ...core.errors import Error, short
from ...core.files import need_replaceable
from ...core.hdf5 import need_own
from ...core.line import Parser, word, wrote
from ...core.roughness import self_affine
from ...core.tables import Tabled
from ...core.units import shown
from ...plot.saving import write
from . import generation, levels, writing
from .basics import QUANTITIES
from .doubts import doubts as doubts_of
from .doubts import of_size
from .maps import combined, moments, new_map, peak_to_valley, rms_height, rms_slope
from .pictures import finite
from .reading import FORMATS, read
from .words import sides, unit

UNKNOWN_HERE = f"{Tabled.unknown} for these numbers, which are of the map's own points"
MOST = 1 << 16  # cells in x or y
OF_FILES = (
    "units", "pixel", "first_row", "transpose", "mirror", "depths", "missing", "format", "skip_rows", "skip_columns",
    "dataset", "channel", "window", "outliers", "fill", "level", "grid_size",
)  # fmt: skip

READ_BY = (
    "units", "size", "pixel", "first_row", "transpose", "mirror", "depths", "missing", "format", "decimal", "skip_rows",
    "skip_columns", "dataset", "channel",
)  # fmt: skip


def _lengths(count, form):
    """Reader of so many lengths, m."""
    return word(words.numbers, form, "m", count=count, to=tuple)


COUNT = word(words.integer, "an integer from 0", least=0)
NUMBER = word(words.number)
BODIES = word(words.names, "1 or 2, or one of them for each file: 1,2", "12", to=lambda found: [*map(int, found)])
HURST = word(words.number, "a Hurst exponent above 0, at most 1", above=0.0, most=1.0)
WINDOW = word(
    words.numbers, "four lengths X0,X1,Y0,Y1 with X0 < X1 and Y0 < Y1", "m", count=4,
    together=lambda found: found[0] < found[1] and found[2] < found[3], to=tuple,
)  # fmt: skip
# cells in x and y; 0 stands for a y that is not given
CELLS = word(
    words.integers, f"one or two integers from 2 to {MOST}: NX[,NY]", least=2, most=MOST, count=(1, 2),
    to=lambda found: (*found, 0)[:2],
)  # fmt: skip


def _file_options(parser):
    about = parser.add_argument_group("contents of the files, where a file does not state them")
    holds = about.add_mutually_exclusive_group()
    holds.add_argument("--body", type=BODIES, metavar="1|2", help="heights of this body; of two files: 1,2")
    holds.add_argument("--separation", action="store_true", help="the separation of both bodies")
    about.add_argument("--units", type=word(unit), metavar="UNIT", help="unit of the values: m, mm, um, nm, 0.1mm, ...")
    extent = about.add_mutually_exclusive_group()
    extent.add_argument("--size", type=word(sides), metavar="X[,Y]", help="full width of all cells: 1e-3 (m) or 1mm")
    extent.add_argument("--pixel", type=word(sides), metavar="DX[,DY]", help="instead: width of one cell")
    about.add_argument(
        "--first-row", choices=("bottom", "top"), help="position of the first row, in images top (bottom)"
    )
    about.add_argument("--transpose", action="store_true", help="a line of the file, or the first index, is x")
    about.add_argument("--mirror", choices=("x", "y"), help="reverse x or y, as for body 1 seen from its own side")
    about.add_argument("--depths", action="store_true", help="values are positive into the body: valleys are large")
    about.add_argument("--missing", metavar="VALUE", help="value of missing points, or in a text their word")
    reader = parser.add_argument_group("reading")
    reader.add_argument("--format", choices=FORMATS, help="format of the file (by its name)")
    reader.add_argument(
        "--decimal", choices=("point", "comma"), help="decimal sign in text files (as they show, or point)"
    )
    reader.add_argument(
        "--skip-rows", type=COUNT, default=0, metavar="K", help="lines to skip at the start of a text file"
    )
    reader.add_argument("--skip-columns", type=COUNT, default=0, metavar="K", help="columns to skip")
    reader.add_argument(
        "--dataset", metavar="NAME", help="dataset of HDF5 (/height, or /separation), array of .npz (its only map)"
    )
    reader.add_argument("--channel", metavar="NAME|K", help="channel of an instrument's file (heights)")


def _processing(parser):
    done = parser.add_argument_group("processing")
    done.add_argument("--window", type=WINDOW, metavar="X0,X1,Y0,Y1", help="keep the cells with centres in it")
    done.add_argument(
        "--outliers",
        action="store_true",
        help="replace spikes of a few points far from their neighbours, and count them",
    )
    done.add_argument(
        "--fill",
        choices=("smooth", "nearest"),
        help="fill missing points smoothly from their boundary, or by the nearest",
    )
    done.add_argument("--level", choices=levels.KINDS, default="none", help="form to remove by least squares (none)")
    done.add_argument(
        "--grid-n", type=CELLS, metavar="NX[,NY]", help="cells of a new grid; values are averaged over each"
    )
    done.add_argument(
        "--grid-size",
        type=word(sides),
        metavar="X[,Y]",
        help="full width of the new grid, about the map's centre (all)",
    )
    done.add_argument(
        "--center", type=_lengths(2, "two lengths X,Y"), metavar="X,Y", help="new position of the centre (unchanged)"
    )


def arguments(words):
    """Read the command line."""
    parser = Parser(prog="petsam-surface", description=__doc__, texts=["--missing"])
    parser.add_argument("files", nargs="*", metavar="FILE", help="one map, or two for a separation")
    _file_options(parser)
    made = parser.add_argument_group("a random surface instead of a file, with --size and --grid-n")
    kind = made.add_mutually_exclusive_group()
    kind.add_argument("--self-affine", type=HURST, metavar="H", help="self-affine with this Hurst exponent")
    kind.add_argument("--psd", metavar="TABLE", help="of a spectrum: a text of q (rad/m) and C (m^4) on each line")
    made.add_argument(
        "--rms", type=_lengths(1, "a length, such as 1um"), metavar="HEIGHT", help="rms height (that of the spectrum)"
    )
    made.add_argument(
        "--wavelengths",
        type=_lengths(2, "two lengths LONG,SHORT"),
        metavar="LONG,SHORT",
        help="of a self-affine surface",
    )
    shape = made.add_mutually_exclusive_group()
    shape.add_argument("--skewness", type=NUMBER, metavar="S", help="of the heights (0); below 0: plateaus and valleys")
    shape.add_argument(
        "--distribution",
        metavar="TABLE",
        help="of the heights: a text of a height (m) and the share below on each line",
    )
    made.add_argument("--kurtosis", type=NUMBER, metavar="K", help="of the heights (3 + 1.5 S^2); 3: as Gaussian ones")
    made.add_argument("--seed", type=COUNT, default=0, metavar="K", help="another integer is another surface (0)")
    _processing(parser)
    out = parser.add_argument_group("output")
    out.add_argument("-o", "--output", metavar="NAME.h5", help="(the first file's name, here)")
    out.add_argument("--picture", metavar="NAME.png", help="(beside the output)")
    parser.add_choice(out)
    options = parser.parse_args(words)
    _check_random(parser, options)
    if len(options.files) > 2:
        parser.error(f"{len(options.files)} files: use one, or two for a separation")
    if options.body and len(options.body) > 2:
        parser.error("--body: expected 1 or 2, or one of them for each file: 1,2")
    if options.body and len(options.body) != max(1, len(options.files)):
        parser.error("--body: give 1 or 2, and 1,2 for two files: one body for each")
    if options.separation and options.depths:
        parser.error("--depths applies to heights, not to a separation")
    base = os.path.splitext(os.path.basename(options.files[0]))[0] if options.files else "random"
    options.output = options.output or base + ".h5"
    options.picture = options.picture or os.path.splitext(options.output)[0] + ".png"
    if not options.picture.lower().endswith(".png"):
        parser.error(f"--picture: {short(options.picture)}: use a name that ends in .png")
    return options


def _check_random(parser, options):
    """End with a message where a random surface lacks something, or there is neither a file nor one."""
    random = options.self_affine is not None or options.psd
    if bool(random) == bool(options.files):
        parser.error("give one FILE or two, or a random surface by --self-affine or --psd" + " instead" * bool(random))
    given = {"--rms": options.rms, "--wavelengths": options.wavelengths}
    if not random:
        of_heights = {f"--{name}": getattr(options, name) for name in ("skewness", "kurtosis", "distribution")}
        for name, value in {**given, **of_heights}.items():
            if value is not None:
                parser.error(f"{name}: is for a random surface; use --self-affine or --psd")
        return
    for name in OF_FILES:
        if getattr(options, name) not in (None, False, 0, "none"):
            parser.error(f"--{name.replace('_', '-')}: has no effect on a random surface; omit it")
    if options.distribution and not options.psd:
        del given["--rms"]  # the table has heights
    needed = {"--size": options.size, "--grid-n": options.grid_n, **({} if options.psd else given)}
    lacking = [name for name, value in needed.items() if not value]
    if lacking:
        parser.error(f"a random surface needs {', '.join(lacking)}")
    _check_values(parser, options)


def _check_values(parser, options):
    """End with a message where the numbers of a random surface cannot be."""
    skewness = options.skewness or 0.0
    if options.kurtosis is not None and options.distribution:
        parser.error("--kurtosis: not allowed with --distribution, whose table has all moments")
    if options.kurtosis is not None and not options.kurtosis > 1.0 + skewness**2:
        parser.error(
            f"--kurtosis {options.kurtosis:g}: use more than {1.0 + skewness**2:g}, 1 and the skewness squared"
        )
    if options.psd and options.wavelengths:
        parser.error("--wavelengths: not allowed with --psd, whose table has the limits")
    if options.rms and not options.rms[0] > 0.0:
        parser.error(f"--rms {options.rms[0]:g} m: use a height above 0")
    if options.wavelengths and not options.wavelengths[0] > options.wavelengths[1] > 0.0:
        parser.error("--wavelengths: expected LONG,SHORT, the longer one first, above 0")


def random_map(options):
    """The Map of a random surface; heights of body 2 unless --body gives another."""
    if options.psd:
        spectrum, shortest = generation.tabulated(options.psd)
    else:
        shortest = options.wavelengths[1]
        spectrum = self_affine(options.self_affine, *options.wavelengths)
    rms = options.rms[0] if options.rms else None
    n = _square(options.grid_n)
    values = generation.heights(spectrum, n, options.size, shortest, options.seed, rms)
    if options.distribution:
        values = generation.shaped(values, generation.distributed(options.distribution), rms)
    elif options.skewness is not None or options.kurtosis is not None:
        skewness = options.skewness or 0.0
        kurtosis = 3.0 + 1.5 * skewness**2 if options.kurtosis is None else options.kurtosis
        values = generation.shaped(values, generation.cubic(skewness, kurtosis), float(np.sqrt(np.mean(values**2))))
    quantity = "separation" if options.separation else f"height{(options.body or [2])[0]}"
    print(f"random surface: {QUANTITIES[quantity]}\n  seed {options.seed}")
    one = new_map(values, options.size, quantity, options.output)
    warn_of_unit(one, options.output)
    return one


def warn_of_unit(one, name, more=""):
    """Warnings of heights beyond the size, and of a size beyond measured ones."""
    _warn(name, of_size(peak_to_valley(one), one.wide, more))


def _warn(name, texts):
    for text in texts:
        print(f"petsam-surface: warning: {short(name)}: {text}", file=sys.stderr)


def prepared(path, options, body):
    """The processed map of one file; prints the steps."""
    given = {name: getattr(options, name) for name in READ_BY}
    one = read(path, body=body, separation=options.separation, alone=len(options.files) == 1, **given)
    if options.window:
        one = one.cut(*options.window)
    one = one.without_outliers(options.fill or "smooth") if options.outliers else one
    one = one.fill(options.fill)
    warn_of_unit(one, path, ", and give the value of missing points by --missing")
    one = one.level(options.level)
    _warn(path, [*one.doubts, *doubts_of(one)])
    if options.grid_n or options.grid_size:
        one = one.resample(_grid(one, options.grid_n), options.grid_size)
    print(f"{path}: {QUANTITIES[one.quantity]}")
    for remark in one.remarks:
        print("  " + remark)
    return one


def _grid(one, given):
    """Cells in x, y of a new grid, or None; a profile keeps its row."""
    if not given:
        return None
    if one.is_profile and given[1]:
        raise Error(f"{one.name}: is a profile, which has cells along x only: --grid-n {given[0]}")
    return (given[0], 1) if one.is_profile else _square(given)


def _square(given):
    """Cells in x, y, of which the second may be left out."""
    return given[0], given[1] or given[0]


def description(one):
    """Lines that describe a map."""
    n, cell, size, center = one.n, one.cell, one.size, one.center
    low, high = (shown(float(value)) for value in (one.values.min(), one.values.max()))
    slopes = levels.tilt(one)
    where = [
        "cells   {} x {} of {} x {}".format(*n, *map(shown, cell)),
        "size    {} x {} about x = {:g} m, y = {:g} m".format(*map(shown, size), *center),
    ]
    if one.is_profile:
        where = [f"cells   {n[0]} of {shown(cell[0])}", f"size    {shown(size[0])} about x = {center[0]:g} m"]
    return [
        UNKNOWN_HERE,
        *where,
        f"height  Sq {shown(rms_height(one))}, peak to valley {shown(peak_to_valley(one))}, from {low} to {high}",
        "shape   skewness Ssk {:.3g}, kurtosis Sku {:.3g}".format(*moments(one)),
        f"slope   Sdq {rms_slope(one):.4g}; of the mean plane {slopes[0]:.3g} in x, {slopes[1]:.3g} in y",
    ]


def petsam_options(one, path):
    """petsam's options for the surface as the gap, and as roughness on another."""
    name = shlex.quote(path)
    if one.is_profile:
        center = f" -grid_center {one.center[0]:.10g}" if one.center[0] else ""
        grid = f"-elasticity plane -grid_n {one.n[0]} -grid_size {one.size[0]:.10g}{center}"
        return _both(one, name, grid)
    grid = "-grid_n {},{} -grid_size {:.10g},{:.10g}".format(*one.n, *one.size)
    if any(one.center):
        grid += " -grid_center {:.10g},{:.10g}".format(*one.center)
    return _both(one, name, grid)


def _both(one, name, grid):
    """The options of petsam for a file as the gap, and as roughness, on a grid."""
    which = f"_dataset /{writing.dataset(one)}" if writing.dataset(one) != "height" else ""
    gap, rough = (f" -{kind}{which}" if which else "" for kind in ("gap", "gap_rough"))
    return f"-gap_type file -gap_file {name}{gap} {grid}", f"-gap_rough_file {name}{rough} {grid}"


def carry_out(options, words):
    """Read, combine, write, draw and print."""
    for name in [options.output] + ([] if options.no_picture else [options.picture]):
        need_replaceable(name, options.files)
    need_own(options.output, writing.SIGN, "petsam-surface")
    maps = [prepared(path, options, body) for path, body in zip(options.files, options.body or [None, None])]
    maps = maps or [random_map(options)]
    one = maps[0] if len(maps) == 1 else combined(*maps)
    if options.center:
        one = replace(one, center=options.center)
    if not finite(one):
        raise Error(f"{one.name}: contains numbers that are too large")
    writing.write(one, options.output, shlex.join(["petsam-surface", *words]))
    if not options.no_picture:
        from .pictures import surface

        write(surface(one), options.picture, options.dpi)
    print(f"{options.output}: /{writing.dataset(one)}, {QUANTITIES[one.quantity]}, m")
    print("\n".join("  " + line for line in description(one)))
    wrote(options.output, *([] if options.no_picture else [options.picture]))
    gap, rough = petsam_options(one, options.output)
    print(f"options for petsam:\n  {gap}\nor, added to another gap:\n  {rough}")


def main():
    """Exit code: 0, 2 for bad usage, 3 for a file that cannot be read or written, or lacks information."""
    words = sys.argv[1:]
    return carry_out(arguments(words), words)

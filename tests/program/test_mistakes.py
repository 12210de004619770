"""What a beginner gets wrong, and that each answer is enough to mend it without documentation.

Every case is a run as a user would start it, the exit code, and what the line on stderr must say: which option, file or
line is meant, and what to write instead. Where a run goes on with a warning, results are kept. What test_bad_input.py
has is not here again: those are all wrong values; these are slips of units, names, files and habits.
"""

import re
import subprocess
import sys

import h5py
import numpy as np
import pytest

from conftest import PROGRAM, execute
from support import ROOT, SPHERE, hertz

FLAT = dict(gap_type="flat", gap_radius1=None, gap_radius2=None)
PAD = dict(FLAT, gap_type="pad", gap_half_flat_x=5e-4, gap_edge_radius_x=0.1)
PIN = dict(FLAT, gap_type="curved", gap_radius1_x=0.01, gap_radius2_x=-0.01005)
PLANE = dict(elasticity="plane", grid_n=64)
FILE = dict(gap_type="file", gap_radius1=None, gap_radius2=None, grid_n=(7, 6))
ROLLING = dict(rolling="steady", friction=0.3, output_fields="pressure")
PERIOD = dict(elasticity="periodic", grid_n=(7, 6))
HISTORY = dict(load_n=None, history="loads.csv")
DRIVEN = {**SPHERE, **HISTORY}
UNIT = "check the unit of the dataset"
LOADS = "time,load_n\n1,500\n2,1000\n"


def mistake(name, change, *words, says, code=2, files=None):
    """Options of SPHERE that are changed, further words, texts of the first line, and files by name."""
    return pytest.param(change, words, [says] if isinstance(says, str) else says, code, files or {}, id=name)


def history(name, text, says, *words, code=2, **change):
    """A history of that text instead of -load_n."""
    return mistake(f"history: {name}", dict(HISTORY, **change), *words, says=says, code=code, files={"loads.csv": text})


def options_file(name, text, says, **change):
    """An options file of that text."""
    return mistake(name, change, "-options_file", "s.opts", says=says, files={"s.opts": text})


MISTAKES = [
    # ---- numbers and units
    mistake("decimal comma", dict(grid_size="2,6e-3"), says=["-grid_size 2,6e-3", "2.6e-3, with a decimal point"]),
    mistake(
        "decimal commas in both", dict(grid_size="2,6e-3,2,6e-3"), says=["-grid_size", "decimal point, not a comma"]
    ),
    mistake("one width a thousand times the other", dict(grid_size="2.6e-3,2.6"), says=["-grid_size", "hundredfold"]),
    mistake("decimal comma of a load", dict(load_n="1000,5"), says=["-load_n 1000,5", "decimal point, not a comma"]),
    mistake("unit of another kind", dict(load_n="1kPa"), says=["-load_n 1kPa", "allowed", "N, kN, MN or mN"]),
    mistake(
        "unit as a word", {}, "-load_tx", "60", "N", says=["N: expected an option", "-load_tx 60 already has its value"]
    ),
    mistake("unknown unit", dict(body1_young="30Mpsi"), says=["-body1_young 30Mpsi", "Pa, kPa, MPa or GPa"]),
    mistake("unit of one of two", dict(grid_size="2.6mm,3"), says=["-grid_size 2.6mm,3", "each number: m, mm"]),
    mistake("decimal comma with a unit", dict(grid_size="2,6mm"), says=["-grid_size 2,6mm", "a decimal point"]),
    mistake("unit of a ratio", dict(friction="0.3Pa"), says=["-friction 0.3Pa", "without a unit"]),
    mistake("force in plane strain", dict(PLANE, load_n="1kN"), says=["-load_n 1kN", "N/m, kN/m, MN/m or N/mm"]),
    mistake("negative radius", dict(gap_radius2=-0.3), says=["-gap_radius2 -0.3", "> 0 or inf", "-gap_type curved"]),
    mistake("percent sign", dict(friction="30%"), says=["-friction 30%", "0.3, not 30"]),
    mistake("Poisson's ratio in percent", dict(body1_poisson=30.0), says=["-body1_poisson 30", "at most 0.5", "0.3"]),
    mistake("negative friction", dict(friction=-0.3), says=["-friction -0.3", ">= 0"]),
    mistake("load that pulls", dict(load_n=-1000.0), says=["-load_n -1000", ">= 0"]),
    mistake("thousands", dict(grid_n="1e3"), says=["-grid_n 1e3", "an integer"]),
    mistake("cells with an x", dict(grid_n="64x64"), says=["-grid_n 64x64", "separated by a comma"]),
    mistake("cells as two words", {}, "-grid_n", "64", "64", says=["64: expected an option", "-grid_n 64 already has"]),
    mistake("one cell", dict(grid_n=1), says=["-grid_n 1", ">= 2"]),
    mistake("no steps", {}, "-steps", "0", says=["-steps 0", ">= 1"]),
    mistake("half a step", {}, "-steps", "2.5", says=["-steps 2.5", "an integer"]),
    # ---- the command line
    mistake(
        "equals sign",
        dict(load_n=None),
        "-load_n=1000",
        says=["-load_n or -disp_z is missing", "is -load_n=1000 meant"],
    ),
    mistake(
        "equals sign in the environment's style",
        {},
        "-output=a.h5",
        says=["-output=a.h5: unknown option: is -output meant?"],
    ),
    mistake("two dashes", {}, "--load_tx", "60", says=["--load_tx 60: unknown option: is -load_tx meant?"]),
    mistake(
        "typographic dash", {}, "\u2013load_tx", "60", says=["\u2013load_tx: expected an option: it begins with a dash"]
    ),
    mistake("options file without its option", {}, "study.opts", says=["study.opts: expected an option"]),
    mistake("misspelled", {}, "-frictoin", "0.3", says=["-frictoin 0.3", "is -friction meant?"]),
    mistake("one modulus for both", {}, "-young", "210e9", says=["-young 210e9", "is -body1_young meant?"]),
    mistake("another program's name", {}, "-mu", "0.3", says=["-mu 0.3", "is -friction meant?"]),
    mistake("an underscore too many", {}, "-gap_radius_1", "0.2", says=["-gap_radius_1 0.2", "is -gap_radius1 meant?"]),
    mistake("dash for an underscore", {}, "-load-tx", "6", says=["-load-tx 6", "is -load_tx meant?"]),
    mistake("another letter", {}, "-load_x", "60", says=["-load_x", "is -load_tx meant?"]),
    mistake(
        "required, misspelled",
        dict(body1_young=None),
        "-body1_yuong",
        "210e9",
        says=["-body1_young is missing", "is -body1_yuong meant"],
    ),
    mistake(
        "required, by another name",
        dict(load_n=None),
        "-force",
        "1000",
        says=["-load_n or -disp_z is missing", "is -force meant"],
    ),
    mistake("grid of another name", dict(grid_n=None), "-grid", "64", says=["-grid_n is missing", "is -grid meant"]),
    # ---- what is missing, or contradicts
    mistake("no grid", dict(grid_n=None), says=["-grid_n is missing", "cells"]),
    mistake("no size", dict(grid_size=None), says=["-grid_size is missing", "m:", "1.5 times"]),
    mistake("no modulus", dict(body2_young=None), says=["-body2_young is missing", "Pa", "210e9", "inf"]),
    mistake(
        "no shape",
        dict(gap_type=None),
        says=["-gap_type is missing", "curved, ellipsoid, file, flat, pad, punch, roller or sphere"],
    ),
    mistake(
        "unknown shape",
        dict(gap_type="ball"),
        says=["-gap_type ball", "curved, ellipsoid, file, flat, pad, punch, roller or sphere"],
    ),
    mistake("no second radius", dict(gap_radius2=None), says=["-gap_radius2 is missing", "inf: flat"]),
    mistake("no load", dict(load_n=None), says=["-load_n or -disp_z is missing", "(N)", "(m)"]),
    mistake("load and displacement", dict(disp_z=1e-6), says=["-load_n", "-disp_z", "give one of them"]),
    mistake(
        "radius of another shape", dict(gap_radius_x=0.2), says=["-gap_radius_x 0.2", "without -gap_type ellipsoid"]
    ),
    mistake(
        "pad without its edge", dict(PAD, gap_edge_radius_x=None), says=["-gap_edge_radius_x is missing", "(m, inf"]
    ),
    mistake(
        "bore smaller than its pin",
        dict(PIN, gap_radius2_x=-0.0099),
        says=["-gap_type curved: the surfaces cross", "the limit is 0: give a negative radius of larger size"],
    ),
    mistake(
        "bore as large as its pin",
        dict(PIN, gap_radius2_x=-0.01),
        says=["-gap_type curved: the radii are equal and opposite or infinite", "clearance", "or -gap_type flat"],
    ),
    mistake("radius 0 for a flat", dict(PIN, gap_radius2_x=0), says=["-gap_radius2_x 0", "other than 0, or inf"]),
    mistake(
        "ends in plane strain", dict(PIN, gap_radius1_y=1, **PLANE), says=["-gap_radius1_y 1", "plane", "give inf"]
    ),
    mistake("edge in plane strain", dict(PAD, gap_edge_radius_y=1, **PLANE), says=["-gap_edge_radius_y 1", "give inf"]),
    mistake("angle in plane strain", dict(PIN, gap_angle=90, **PLANE), says=["-gap_angle 90", "give 0"]),
    mistake(
        "roller without a crown",
        dict(FLAT, gap_type="roller", gap_roller_radius=0.1, gap_roller_half_length=1e-2, gap_roller_drop=1e-5),
        says=["-gap_roller_crown is missing", "amplitude of the crown (m), load per length/(pi E*)"],
    ),
    mistake("file of another shape", dict(gap_file="h.h5"), says=["-gap_file", "-gap_type file", "-gap_rough_file"]),
    mistake("shape of a file without it", dict(FILE), says=["-gap_file is missing", "-gap_type file"]),
    mistake("both rigid", dict(body1_young="inf", body2_young="inf"), says=["-body1_young", "at least one"]),
    mistake("unknown coupling", dict(coupling="half"), says=["-coupling half", "none or full"]),
    mistake("unknown solver", dict(normal_type="cg"), says=["-normal_type cg", "activeset"]),
    mistake("tolerance that allows anything", dict(normal_rtol=1), says=["-normal_rtol 1", "a number > 0 and < 1"]),
    mistake("limit of time without a checkpoint", dict(max_walltime=60), says=["-max_walltime", "-checkpoint"]),
    mistake("checkpoints without a file", dict(checkpoint_every=5), says=["-checkpoint_every", "-checkpoint"]),
    mistake(
        "wear without friction", dict(friction=None, wear_coefficient1=1e-14), says=["-wear_coefficient", "-friction"]
    ),
    mistake("life without a cycle", dict(wear_coefficient1=1e-14, wear_cycles=10), says=["-wear_cycles", "-history"]),
    mistake("stiffness without results", {}, "-stiffness", says=["-stiffness", "-output"]),
    mistake(
        "edges of earlier versions",
        dict(edges="deferred"),
        says=["-edges deferred", "-edges reconstruct", "-grid_check"],
    ),
    mistake(
        "bulk stress of a rigid body", dict(body2_young="inf", bulk2_stress_xx=1e6), says=["-bulk2_stress_xx", "rigid"]
    ),
    # ---- files
    options_file(
        "byte of value 0", "-friction 0.3\n-load_n 10\x0000\n", says=["s.opts, line 2", "byte of value 0", "plain text"]
    ),
    mistake("no options file", {}, "-options_file", "s.opts", says=["s.opts", "No such file"], code=3),
    options_file(
        "value in a file",
        "# N\n-load_n 1000m\n",
        ["-options_file s.opts, line 2: -load_n 1000m: expected a number", "units allowed"],
        load_n=None,
    ),
    options_file(
        "option of a file without effect",
        "# punch\n-gap_flat_radius 3\n",
        ["-options_file s.opts, line 2: -gap_flat_radius 3: has no effect without -gap_type punch: remove it"],
    ),
    options_file("options file without dashes", "load_tx 60\n", ["s.opts, line 1: load_tx: expected an option"]),
    options_file(
        "options file with equals signs",
        "\n-load_tx=60\n",
        ["s.opts, line 2: -load_tx=60: unknown option: is -load_tx meant?"],
    ),
    options_file("options file with units", "-load_tx 60 N\n", ["s.opts line 1", "extra token N"]),
    mistake(
        "results into a folder that is not there",
        {},
        "-output",
        "new/a.h5",
        code=3,
        says=["-output new/a.h5", "folder does not exist"],
    ),
    mistake("folder as results", {}, "-output", ".", says=["-output .", "it is a folder"], code=3),
    mistake(
        "results over the surface",
        FILE,
        "-gap_file",
        "wide.h5",
        "-output",
        "wide.h5",
        says=["-output wide.h5", "-gap_file"],
    ),
    mistake(
        "results over something else",
        {},
        "-output",
        "s.txt",
        files={"s.txt": "notes"},
        code=3,
        says=["-output s.txt", "not replaced"],
    ),
    mistake("fields at times", dict(output="r.h5", output_at="1.5"), says=["-output_at 1.5", "steps or history"]),
    mistake("trial run by another name", {}, "-dryrun", says=["-dryrun", "is -dry_run meant?"]),
    mistake("trial run of nothing", dict(load_n=None), "-dry_run", says=["-load_n or -disp_z is missing"]),
    mistake("trial run with a word", {}, "-dry_run", "maybe", says=["-dry_run maybe"]),
    mistake("results as a table in capitals", {}, "-output", "R.CSV", says=["-output R.CSV", "HDF5", "name it .h5"]),
    mistake("results as a table", {}, "-output", "loads.csv", says=["-output loads.csv", "HDF5", "name it .h5"]),
    mistake("no surface", FILE, "-gap_file", "none.h5", says=["-gap_file none.h5", "No such file"], code=3),
    mistake(
        "surface as text",
        FILE,
        "-gap_file",
        "s.txt",
        files={"s.txt": "0 0 1\n"},
        code=3,
        says=["-gap_file s.txt", "not an HDF5 file", "petsam-surface"],
    ),
    mistake(
        "wrong dataset",
        FILE,
        "-gap_file",
        "wide.h5",
        "-gap_dataset",
        "/depth",
        code=3,
        says=["wide.h5", "no dataset /depth", "-gap_dataset", "it has /height, /measured/..., /notes"],
    ),
    mistake(
        "surface of another size",
        dict(FILE, grid_n=64),
        "-gap_file",
        "wide.h5",
        code=3,
        says=["wide.h5", "(6, 7)", "(64, 64)", "-grid_n 7,6"],
    ),
    mistake(
        "transposed surface",
        dict(FILE, grid_n=(6, 7)),
        "-gap_file",
        "wide.h5",
        code=3,
        says=["wide.h5", "transpose it, or give -grid_n 7,6"],
    ),
    mistake("no checkpoint", {}, "-restart", "state.h5", says=["-restart state.h5", "No such file"], code=3),
    # ---- histories
    mistake("no history", dict(HISTORY), says=["-history loads.csv", "No such file"], code=3),
    history("empty", "", ["-history loads.csv", "has no row", "time,load_n"]),
    history("only names", "time,load_n\n", ["-history loads.csv", "has no row", "a line of numbers"]),
    history("no names", "0,0\n1,1000\n", ["loads.csv, line 1", "first line must name the columns", "time,load_n"]),
    history(
        "two separators", "time,load_n\n1,2\n1;5\n", ["line 3: column time", '"1;5"', "separate columns as in the"]
    ),
    history("units", "time [s],load_n [N]\n1,x\n", ["loads.csv, line 1", "time [s]", "no unit", "is time meant?"]),
    history("unit of a load", "time,load_n (N)\n1,x\n", ["loads.csv, line 1", "load_n (N)", "is load_n meant?"]),
    history("misspelled", "time,laod_n\n1,x\n", ["line 1", "unknown column laod_n", "is load_n meant?", "load_tx"]),
    history("another letter", "time,load_x\n1,1\n", ["line 1", "unknown column load_x", "is load_tx meant?"]),
    history("unknown", "time,depth\n1,1\n", ["line 1", "unknown column depth", "expected time, load_n"]),
    history("without times", "load_n\n1000\n", ["loads.csv, line 1", "no column named time"]),
    history("twice a column", "time,load_n,load_n\n1,2,3\n", ["loads.csv, line 1", "two columns are named load_n"]),
    history("load and displacement", "time,load_n,disp_z\n1,2,3\n", ["loads.csv, line 1", "load_n and disp_z"]),
    history("decimal commas", "time;load_n\n1;1000,5\n", ["loads.csv, line 2", "1000,5", "decimal point, not a comma"]),
    history("decimal commas between commas", "time,load_n\n1,1000,5\n", ["line 2", "3 fields", "decimal point"]),
    history("units of numbers", "time,load_n\n1,1000 N\n", ["loads.csv, line 2", "load_n", "without a unit"]),
    history("gap in a row", "time,load_n\n1,\n", ["loads.csv, line 2", "load_n", "not a finite number"]),
    history("times that fall", "time,load_n\n1,2\n0.5,3\n", ["loads.csv, line 3", "time 0.5", "more than 1"]),
    history("load that pulls", "time,load_n\n1,2\n2,-3\n", ["loads.csv, line 3", "load_n -3", ">= 0"]),
    history("a workbook", "PK\3\4\0\0", ["loads.csv, line 1", "expected text", "CSV"]),
    history("value given twice", LOADS, ["-load_n", "loads.csv", "give one of them"], "-load_n", "1000"),
    history("no normal load", "time,load_tx\n1,2\n", ["-load_n or -disp_z is missing"]),
    # ---- loads that cannot be carried
    mistake(
        "force without friction",
        dict(friction=None, load_tx=60.0),
        code=11,
        says=["load_tx = 60 N", "friction: give -friction"],
    ),
    mistake("force beyond friction", dict(load_tx=600.0), code=11, says=["gross slip", "load_tx = 600 N (limit 100"]),
    mistake("force without bounds", dict(load_tx=-1e308), code=11, says=["load_tx = -1e+308 N (limit -100"]),
    mistake("moment in N mm", dict(load_my=200.0), code=11, says=["load_my = 200 N m under load_n = 1000 N", "limits"]),
    # ---- grids and units that only the solution shows
    mistake(
        "modulus in GPa",
        dict(body1_young=210.0, body2_young=210.0),
        code=12,
        says=["-gap_radius1 0.2", "check the units, N, m, Pa"],
    ),
    mistake(
        "modulus in MPa",
        dict(body1_young=210e3, body2_young=210e3),
        code=12,
        says=["-gap_radius1 0.2", "check the units, N, m, Pa"],
    ),
    mistake(
        "radii in mm",
        dict(gap_radius1=200.0, gap_radius2=200.0),
        code=12,
        says=["-grid_size 0.02", "radius1 200 (in m)"],
    ),
    mistake(
        "cylinder",
        dict(FLAT, gap_type="ellipsoid", gap_radius_x=0.1, gap_radius_y="inf"),
        code=12,
        says=["axis along y", "both x and y periodic; to continue anyway: -allow_edge_contact"],
    ),
    mistake(
        "pin that fills its bore",
        dict(PIN, **PLANE, grid_size=1.4e-3, load_n=1e5),
        code=12,
        says=["-gap_radius1_x 0.01 (in m), the limit is about 0.1", "conforming bodies need finite elements"],
    ),
    mistake(
        "bore that closes on its pin",
        dict(PIN, **PLANE, gap_radius1_x=-0.01005, gap_radius2_x=0.01, grid_size=1.4e-3, load_n=1e5),
        code=12,
        says=["conforming bodies need finite elements"],
    ),
    mistake("long pad", dict(PAD, grid_size=4e-3), code=12, says=["axis along y", "a section with loads per metre"]),
    mistake("load in mN", dict(load_n=1e6), code=12, says=["edge of the grid", "-grid_size 0.02"]),
    mistake("grid in km", dict(grid_size=2.6e-6), code=12, says=["edge of the grid", "-grid_size 0.00"]),
    mistake(
        "grid beside the contact",
        dict(grid_center="2e-3,0"),
        code=11,
        says=["lies at x = 0", "grid's cells from 0.0007"],
    ),
    mistake(
        "two planes",
        FLAT,
        code=12,
        says=["(the maximum pressure is there)", "axis along x and y", "-elasticity periodic", "-allow_edge_contact"],
    ),
]

WARNINGS = [
    mistake(
        "grid in mm", dict(grid_size=2.6), code=0, says=["2 cells across", "fewer than 14", "-grid_size 0.0026 (in m)"]
    ),
    mistake("load in kN", dict(load_n=1.0), code=0, says=["cells across", "fewer than 14", "-grid_size 0.00026"]),
    mistake("few cells", dict(grid_n=16), code=0, says=["cells across", "fewer than 14", "-grid_n "]),
    mistake("friction in percent", dict(friction=30.0), code=0, says=["friction is 30", "0.3 for 30 percent"]),
    mistake(
        "angle in degrees", dict(load_n=1000.0, rot_z=1.0), code=0, says=["a rotation of 1 is", "0.1 rad", "0.0175"]
    ),
    mistake("displacement in um", dict(disp_x=5.0), code=0, says=["5 m", "width of the contact", "unit, m"]),
    mistake("no force", dict(load_n=0.0), code=0, says=["do not touch", "normal force is 0 N", "-load_n"]),
    mistake("displacement that pulls", dict(load_n=None, disp_z=-1e-6), code=0, says=["do not touch", "must exceed 0"]),
    mistake(
        "ball that sinks in",
        dict(load_n=4e8, grid_size=0.2),
        code=0,
        says=["too large for half-space theory", "-gap_radius1 0.2", "0.1"],
    ),
    mistake("creepage in percent", dict(ROLLING, creep_x=2.0), code=0, says=["a creepage of 2 is", "1 % is 0.01"]),
    mistake(
        "spin in 1/mm", dict(ROLLING, creep_y=0.0, creep_spin=1e3), code=0, says=["creep_spin 1000 1/m", "unit, 1/m"]
    ),
    mistake(
        "spin alone",
        dict(ROLLING, creep_spin=1.0),
        code=0,
        says=["note: ", "creep_y is found, for load_ty = 0", "-creep_y 0"],
    ),
    mistake(
        "heights in um",
        {**FILE, **PERIOD},
        "-gap_file",
        "um.h5",
        code=0,
        says=["-gap_file um.h5, /height", "vary by 1.8 m", UNIT],
    ),
    mistake(
        "roughness in mm", PERIOD, "-gap_rough_file", "mm.h5", code=0, says=["-gap_rough_file", "slope", "0.5:", UNIT]
    ),
    mistake(
        "pressure above elasticity",
        dict(FILE, elasticity="periodic", grid_n=64, load_n=1e5),
        "-gap_file",
        "steep.h5",
        code=0,
        says=["maximum pressure", "of E*", "about 0.2", "unit of the dataset"],
    ),
    mistake(
        "tilted scan of a period",
        {**FILE, **PERIOD},
        "-gap_file",
        "tilt.h5",
        code=0,
        says=["-gap_file tilt.h5", "m along y, a step", "border of the period", "--level tilt"],
    ),
    mistake(
        "value of an options file in the history too",
        HISTORY,
        "-options_file",
        "s.opts",
        code=0,
        says=["-load_n of the options file is not used", "loads.csv has the column load_n"],
        files={"s.opts": "-load_n 7\n", "loads.csv": LOADS},
    ),
]


def test_there_are_fifty():
    assert len({case.id for case in MISTAKES + WARNINGS}) == len(MISTAKES) + len(WARNINGS) >= 50


@pytest.fixture
def folder(tmp_path):
    with h5py.File(tmp_path / "wide.h5", "w") as f:
        f["height"], f["notes"] = np.zeros((6, 7)), np.arange(3.0)
        f.create_group("measured")
    rough = np.cos(np.arange(42.0).reshape(6, 7))
    wave = np.cos(4 * np.pi * (np.arange(64) + 0.5) / 64)
    heights = dict(um=0.9 * rough, mm=5e-4 * rough, tilt=1e-6 * (rough + np.arange(6.0)[:, None]))
    for name, values in dict(heights, steep=9e-5 * (wave + wave[:, None])).items():
        with h5py.File(tmp_path / f"{name}.h5", "w") as f:
            f["height"] = values
    return tmp_path


def prepare(folder, change, words, files):
    for name, text in files.items():
        (folder / name).write_bytes(text.encode("latin-1"))
    options = {**SPHERE, **change}
    if "-output" not in words and not any(word.startswith("-output=") for word in words) and "-stiffness" not in words:
        options["output"] = "results.h5"
    else:
        options["output_fields"] = None
    return options


def assert_helps(done, says):
    assert done.complaint, done.stderr
    assert all(text in done.complaint[0] for text in says), (says, done.complaint)
    assert len(done.complaint[0]) <= 480 and "PETSC ERROR" not in done.stderr and "HDF5-DIAG" not in done.stderr


@pytest.mark.parametrize("change, words, says, code, files", MISTAKES)
def test_mistake_is_explained(petsam, folder, change, words, says, code, files):
    done = petsam(prepare(folder, change, words, files), *words, check=code)
    assert_helps(done, says)
    assert len(done.complaint) == (2 if code == 2 else 1), done.stderr
    assert (folder / "results.h5").exists() == (code > 3)


@pytest.mark.parametrize("change, words, says, code, files", WARNINGS)
def test_doubt_is_told_once(petsam, folder, change, words, says, code, files):
    done = petsam(prepare(folder, change, words, files), *words, check=code)
    assert_helps(done, says if says[0] == "note: " else ["warning: ", *says])
    others = [line for line in done.complaint if "_extrapolated = " not in line]  # of the grid
    assert len(others) == 1 and (folder / "results.h5").exists(), done.stderr


def test_a_coefficient_of_wear_of_another_unit_is_doubted(petsam, tmp_path):
    """1e-4 mm3/(N m) is 1e-13 1/Pa; no grid holds the scar of 1e-4 1/Pa, and none is advised."""
    (tmp_path / "c.csv").write_text("time,disp_x\n0,1e-5\n1,-1e-5\n2,1e-5\n")
    case = dict(SPHERE, grid_n=48, history="c.csv", wear_cycles=10)
    assert petsam(case, dict(wear_coefficient1=1e-13)).stderr == ""
    warning, error = petsam(case, dict(wear_coefficient1=1e-4), check=12).complaint
    assert "e+06 times the limit of a step" in warning and "1 mm3/(N m) is 1e-9 1/Pa" in warning
    assert error.endswith("check the unit of the coefficient of wear") and "-grid_size" not in error


@pytest.mark.parametrize("kind", ["periodic", "plane_periodic"])
def test_a_contact_without_an_end_has_no_cells_across(petsam, kind):
    done = petsam({**SPHERE, **FLAT, "elasticity": kind})
    assert "  contact     spans the grid\n" in done.stdout and done.stderr == ""


@pytest.mark.parametrize("slope, tilted", [(0.0, False), (3e-6, True)])
def test_a_wave_of_a_period_is_no_tilt(petsam, tmp_path, slope, tilted):
    """Its plane by least squares rises by 1.9 amplitudes, its rms is 0.7; but it goes on over the border."""
    x = (np.arange(32) + 0.5) / 32 - 0.5
    with h5py.File(tmp_path / "w.h5", "w") as f:
        f["height"] = np.tile(1e-6 * np.sin(2 * np.pi * x) + slope * x, (30, 1))
    case = {**SPHERE, **FLAT, **FILE, "grid_n": (32, 30), "elasticity": "periodic", "load_n": 30.0}
    assert ("border of the period" in petsam(case, dict(gap_file="w.h5")).stderr) == tilted


UNITS = dict(grid_size="2.6mm,2600um", body1_young="210GPa", body2_young="210e3MPa", gap_radius1="2e2mm", load_n="1kN")


def test_numbers_with_units_are_those_in_si(launcher, petsam, folder):
    """To the last bit, also among the parameters, and in petsam-stress's depths."""
    petsam(SPHERE, dict(UNITS, load_tx="60N", output="units.h5"))
    petsam(SPHERE, dict(output="si.h5", load_tx=60.0, grid_size="2.6e-3,2.6e-3", gap_radius1=0.2))
    with h5py.File(folder / "units.h5") as units, h5py.File(folder / "si.h5") as si:
        assert all(units.attrs[name] == si.attrs[name] for name in ("body1_young", "body2_young", "gap_radius1"))
        for name in ("x", "pressure", "shear_x", "history/load_n"):
            assert np.array_equal(units[name][:], si[name][:]), name
    stress = ["-input", "si.h5", "-output", "s.h5", "-depths", "0,20um,0.1mm", "-section", "y=0.1mm"]
    execute(launcher, folder, stress, 1, 0, program=PROGRAM.with_name("petsam-stress"))
    with h5py.File(folder / "s.h5") as f:
        assert f["z"][:].tolist() == [0.0, 20e-6, 0.1e-3]


# ---------------------------------------------------------------- advice that is followed helps


def advised(line, *names):
    """The words of the options that a message names, for which it would be well."""
    found = {name: re.search(rf"-{name} ([-\d.e,]+\d)", line) for name in names}
    assert all(found.values()), line
    return [word for name in names for word in ("-" + name, found[name].group(1))]


@pytest.mark.parametrize(
    "change", [dict(grid_size=2.6), dict(grid_size=9e-3), dict(grid_size=0.06, grid_n=(50, 64))], ids=str
)
@pytest.mark.parametrize("name", ["grid_size", "grid_n"])
def test_advised_grid_has_enough_cells(petsam, change, name):
    done = petsam(SPHERE, change)
    if name == "grid_n" and change["grid_size"] == 2.6:  # it would have more cells than anybody has memory for
        assert "-grid_n" not in done.complaint[0]
        return
    assert petsam(SPHERE, change, *advised(done.complaint[0], name)).stderr == ""


ELLIPSOID = dict(gap_type="ellipsoid", gap_radius1=None, gap_radius2=None, gap_radius_x=0.4, gap_radius_y=0.06)
PUNCH = dict(
    gap_type="punch", gap_radius1=None, gap_radius2=None, gap_flat_radius=2e-3, gap_edge_radius=0.05, load_n=9e3
)


@pytest.mark.parametrize(
    "change",
    [
        dict(grid_size=1.1e-3),
        dict(grid_size=1e-3, grid_n=(40, 33)),
        dict(grid_size=(1e-3, 4e-3), grid_n=(20, 80), grid_center=(2e-4, 0)),
        dict(ELLIPSOID, grid_size=1.2e-3),
        dict(PUNCH, grid_size=4e-3),
        dict(load_n=None, disp_z=2e-5, grid_size=1.3e-3),
        dict(load_my=0.4, load_mx=-0.3, grid_size=1.6e-3),
        dict(body2_young=60e9, body2_poisson=0.1, load_tx=80.0, grid_size=1.2e-3),
        dict(load_n=None, disp_z=1e-5, rot_y=5e-3, grid_size=2.3e-3),
    ],
    ids=str,
)
def test_advised_grid_holds_the_contact(petsam, change):
    done = petsam({**SPHERE, **change}, check=12)
    petsam({**SPHERE, **change}, *advised(done.complaint[-1], "grid_size", "grid_n"))


def test_advised_grid_holds_the_whole_history(petsam, folder):
    """The contact comes to the edge in an early step; what is advised is for the largest load, and keeps the cells."""
    (folder / "loads.csv").write_text("time,load_n,load_my\n1,100,0\n2,900,0\n3,5000,0.5\n4,50,0\n")
    case = dict(DRIVEN, grid_size=1.4e-3, output="out.h5")
    done = petsam(case, check=12)
    words = advised(done.complaint[0], "grid_size", "grid_n")
    assert float(words[1]) / int(words[3]) <= 1.4e-3 / 64
    radius = hertz(dict(SPHERE, load_n=5000.0)).radius
    assert 2 * radius <= float(words[1]) <= 3 * radius
    petsam(case, *words)
    with h5py.File(folder / "out.h5") as f:
        assert f["history/status"][:].tolist() == [0, 0, 0, 0]


# ---------------------------------------------------------------- once a run


def test_run_ends_at_the_edge_with_that_step(petsam, folder):
    (folder / "loads.csv").write_text("time,load_n\n1,100\n2,900\n3,5000\n4,50\n")
    case = dict(DRIVEN, grid_size=1.4e-3, output="out.h5", output_every=10)
    done = petsam(case, check=12)
    assert len(done.complaint) == 1 and "step 2" in done.complaint[0]
    with h5py.File(folder / "out.h5") as f:
        assert f["history/status"][:].tolist() == [0, 12]
        assert f["time"][:].tolist() == [2.0] and f["pressure"][-1].max() > 0
    done = petsam(case, "-allow_edge_contact")
    assert len(done.complaint) == 1 and "warning: step 2" in done.complaint[0]
    with h5py.File(folder / "out.h5") as f:
        assert f["history/status"][:].tolist() == [0, 0, 0, 0]


@pytest.mark.parametrize("ranks", [1, 3])
def test_cells_across_are_those_of_the_largest_load(petsam, folder, ranks):
    """Small contacts on the way to the load are no reason to warn, and one warning is enough for a history."""
    (folder / "loads.csv").write_text("time,load_n\n0,0\n1,1000\n2,20\n3,1000\n")
    done = petsam(DRIVEN, dict(steps=4), ranks=ranks)
    assert not done.complaint
    across = float(re.search(r"contact +([\d.]+) cells across \(step 5, at the largest load\)", done.stdout).group(1))
    assert abs(across - 64 / 1.5) <= 1
    done = petsam(DRIVEN, dict(steps=4, grid_n=18), ranks=ranks)
    assert len(done.complaint) == 1 and "12 cells across" in done.complaint[0]


def test_rough_surface_is_warned_of_once(petsam, folder):
    """Many small spots: one line that says so, and what would help."""
    rng = np.random.default_rng(3)
    with h5py.File(folder / "rough.h5", "w") as f:
        f["height"] = 1e-6 * rng.random((64, 64))
    done = petsam(SPHERE, dict(load_n=30.0), "-gap_rough_file", "rough.h5")
    assert len(done.complaint) == 1
    assert re.search(r"the contact is in \d+ spots, the narrow ones [\d.]+ cells across", done.complaint[0])
    assert ": use a file with heights at smaller distances" in done.complaint[0]


def test_spots_on_all_of_the_grid_are_told_of_without_its_width_twice(petsam, folder):
    rng = np.random.default_rng(3)
    with h5py.File(folder / "rough.h5", "w") as f:
        f["height"] = 1e-7 * rng.random((64, 64))
    done = petsam({**SPHERE, **FLAT}, dict(elasticity="periodic", load_n=100.0), "-gap_rough_file", "rough.h5")
    assert "cells across (on all of the grid), fewer than 20" in done.complaint[0]
    assert "use a file with heights" in done.complaint[0]


def test_checkpoint_says_when_it_is_written(petsam, folder):
    line = re.search(r"checkpoint +(.*)", petsam(SPHERE, dict(checkpoint="s.h5")).stdout).group(1)
    assert "s.h5: only on USR2, and on TERM or USR1 (to stop)" in line and "-checkpoint_every k" in line
    line = re.search(r"checkpoint +(.*)", petsam(SPHERE, dict(checkpoint="s.h5", checkpoint_every=7)).stdout).group(1)
    assert "after every 7 steps" in line and "-checkpoint_every k" not in line
    line = re.search(r"checkpoint +(.*)", petsam(SPHERE, dict(checkpoint="s.h5", max_walltime="1:40")).stdout).group(1)
    assert "before 100 s have passed" in line


@pytest.mark.parametrize("environment", [None, dict(PETSC_OPTIONS="-load_n 3")], ids=["command line", "PETSC_OPTIONS"])
def test_what_is_given_for_this_run_is_not_overridden(petsam, folder, environment):
    """A value for this run contradicts the history; one of a shared options file does not."""
    (folder / "loads.csv").write_text(LOADS)
    (folder / "s.opts").write_text("-load_n 7\n-load_tx 1\n")
    words = [] if environment else ["-load_n", "3"]
    done = petsam(DRIVEN, "-options_file", "s.opts", *words, check=2, environment=environment)
    assert "-load_n: loads.csv has the column load_n" in done.complaint[0]


@pytest.mark.parametrize("change", [dict(body1_young=200e9), dict(friction=0.2), dict(grid_n=32)], ids=str)
def test_restart_with_another_option_names_it(petsam, folder, change):
    (folder / "loads.csv").write_text(LOADS)
    petsam(DRIVEN, dict(checkpoint="s.h5", checkpoint_every=1))
    done = petsam(DRIVEN, dict(restart="s.h5"), change, check=2)
    assert "-restart s.h5" in done.complaint[0] and "-" + next(iter(change)) in done.complaint[0]


# ---------------------------------------------------------------- petsam-stress


@pytest.mark.parametrize(
    "words, code, says",
    [
        ([], 2, ["-input is missing", "results of petsam"]),
        (["-input", "none.h5"], 3, ["none.h5", "No such file"]),
        (["-input", "r.h5", "-output", "r.h5"], 2, ["-output r.h5", "-input"]),
        (["r.h5"], 2, ["r.h5: expected an option"]),
        (["-inptu", "r.h5"], 2, ["-input is missing", "is -inptu meant"]),
        (["-input", "r.h5", "-body", "3"], 2, ["-body 3", "from 1 to 2"]),
        (["-input", "r.h5", "-depth", "1e-5"], 2, ["-depth 1e-5", "is -depths meant?"]),
        (["-input", "r.h5", "-depths", "-1e-5"], 2, ["-depths -1e-5"]),
        (["-input", "r.h5", "-depths", "10kN"], 2, ["-depths 10kN", "first:last:number", "mm, um, nm"]),
        (["-input", "r.h5", "-depths", "0,1b"], 2, ["-depths 0,1b", "in m, mm, um, nm or as 0.5a in half widths"]),
        (["-input", "r.h5", "-depths", "0,2a,1a"], 2, ["-depths 0,2a,1a", "expected depths that increase"]),
        (["-input", "r.h5", "-cycle", "2", "-steps", "1"], 2, ["-cycle does not work with -steps", "give one of them"]),
        (["-input", "r.h5", "-cycle", "7"], 2, ["-cycle 7: the steps of that cycle are not in r.h5, those of 0 are"]),
        (["-input", "r.h5", "-cycle", "last"], 2, ["-cycle last", "a number >= 0"]),
        (["-input", "r.h5", "-section", "z=0"], 2, ["-section z=0", "x=", "y="]),
        (["-input", "r.h5", "-steps", "3"], 2, ["-steps", "no step 3", "the last is 1"]),
        (["-input", "r.h5", "-quantities", "von_mises"], 2, ["-quantities von_mises", "mises"]),
        (["-input", "r.h5", "-fatigue", "findley"], 2, ["-fatigue_findley_k is missing", "required by findley"]),
        (["-input", "wide.h5"], 3, ["wide.h5", "results file of petsam"]),
    ],
)
def test_mistake_with_stresses_is_explained(launcher, petsam, folder, words, code, says):
    if "r.h5" in words:
        petsam(SPHERE, dict(output="r.h5"))
    output = [] if "-output" in words else ["-output", "new.h5"]
    done = execute(launcher, folder, [*words, *output], 1, code, program=PROGRAM.with_name("petsam-stress"))
    complaint = [line for line in done.stderr.splitlines() if line.startswith("petsam-stress: ")]
    assert all(text in complaint[0] for text in says), (says, complaint)
    assert not (folder / "new.h5").exists()


@pytest.mark.parametrize(
    "words, code, says",
    [
        (["--filed", "pressure", "r.h5"], 2, "--filed: is --field meant?"),
        (["-step", "3", "r.h5"], 2, "-step: is --step meant?"),
        (["loads.csv"], 3, "loads.csv: is not an HDF5 file: give results of petsam -output"),
        (["wide.h5"], 3, "wide.h5: is not a results file of petsam: has no /x; petsam -output writes one"),
    ],
)
def test_mistake_with_pictures_is_explained(petsam, folder, words, code, says):
    petsam(SPHERE, dict(output="r.h5"))
    (folder / "loads.csv").write_text(LOADS)
    plot = [sys.executable, str(ROOT / "scripts" / "petsam-plot"), *words]
    done = subprocess.run(plot, cwd=folder, capture_output=True, text=True, timeout=60)
    assert done.returncode == code and says in done.stderr, done.stderr


def test_a_value_with_a_unit_in_a_step_is_explained():
    import petsam as package

    bodies = {name: value for name, value in SPHERE.items() if name not in ("load_n", "output_fields")}
    with package.Contact(**bodies) as contact:
        with pytest.raises(TypeError, match="load_n: .*give a number in SI units"):
            contact.try_step(load_n="1kN")


def test_numbers_of_another_unit_are_told(launcher, petsam, folder):
    """A bulk stress in MPa, a grid in mm, depths in um."""
    told = petsam(SPHERE, dict(bulk2_stress_xx=50, output="r.h5")).complaint
    assert any("the largest bulk stress, 50 Pa, is" in line and "check the unit, Pa" in line for line in told)
    case = dict(SPHERE, gap_radius1=2e5, gap_radius2=2e5, grid_size=1200.0, load_n=1e13)
    told = petsam(case, check=None).complaint
    assert any("the grid is 1200 m wide: check the unit, m" in line for line in told)
    stress = ["-input", "r.h5", "-output", "deep.h5", "-depths", "0.5"]
    done = execute(launcher, folder, stress, 1, 0, program=PROGRAM.with_name("petsam-stress"))
    assert "times the width of the grid: check the unit, m" in done.stderr


@pytest.mark.parametrize("cells, across", [((128, 8), None), ((16, 8), 4), ((8, 128), None), ((8, 16), 4)])
def test_a_cylinder_is_as_wide_as_it_touches(petsam, cells, across):
    """Along its axis it ends nowhere: cells there are none too few, and more of them no help."""
    axis = int(cells[0] < cells[1])
    radii = {"gap_type": "ellipsoid", "gap_radius_" + "xy"[axis]: 0.1, "gap_radius_" + "yx"[axis]: "inf"}
    size = (4e-3, 1e-4) if axis == 0 else (1e-4, 4e-3)
    case = {**SPHERE, "gap_radius1": None, "gap_radius2": None, **radii, "elasticity": "periodic"}
    done = petsam(case, dict(grid_n=cells, grid_size=size, load_n=20.0, load_tx=None))
    assert len(done.complaint) == (across is not None)
    if across:
        more = [str(int(np.ceil(n * 22 / across))) if n == 16 else str(n) for n in cells]
        assert "-grid_n " + ",".join(more) in done.complaint[0], done.complaint


def test_full_contact_of_periodic_bodies_has_no_width(petsam):
    """A few cells are all there are: nothing ends within them."""
    flat = {**SPHERE, **FLAT}
    flat.update(grid_n=16, elasticity="periodic")
    assert petsam(flat).stderr == ""

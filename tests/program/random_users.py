#!/usr/bin/env python3
"""Random problems as users give them: numbers that are wrong without a warning, and warnings of right ones.

    python3 tests/program/random_users.py [--kind usual] [--trials 100] [--seed 1] [--finer 4] [--show] [--log FILE]

Kinds: `yield`, bodies that yield below their surface; `slide`, worn surfaces that slide past each other; `zone`, lives
in partial slip, whose scars end at a stick zone; `usual`, spheres, ellipsoids, pads, cylinders, rough, layered,
dissimilar and rolling bodies, bulk stress and moments. Each is solved on its grid and by its steps, and on finer grids
by finer steps; a single step in which contact is made goes on the path that it has by definition, N first. Wrong: a
printed number, of the last step or of all steps, differs by more than 5 % and no warning names it or its cause; right:
all are within 2 %. For each wrong problem the worst number is found again on finer cells alone, and by finer steps
alone.
"""

import argparse
import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import NamedTuple

import h5py
import numpy as np

import conftest
import random_pads
from random_pads import RIGHT, WRONG, compare
from support import closed, history, words

YIELD_FINER = 2  # in three dimensions, where layers and cells take their time
SLIDE_FINER = 2  # the same
FINE_LAYERS = 64
SLACK = 1e-6  # of the normal work: energies below it are none
YIELDED = 1e-5  # plastic strain, about a hundredth of the elastic one at yield, and dent over approach: none below
RESIDUAL = 0.2  # of all plastic work: 5 % of it is the stated accuracy of residual_energy, 1 % of that work
NORMAL = ("time", "load_n", "load_mx", "load_my", "disp_z")
LAST = (
    "contact_area",
    "stick_area",
    "pressure_max",
    "shear_max",
    "slip_max",
    "disp_z",
    "plastic_max",
    "residual_energy",
)
STEADY = ("slip_velocity_max", "rolling_energy", "load_tx", "load_ty", "creep_x", "creep_y", "creep_spin")
SUMS = ("dissipated_energy", "plastic_work")
LIFE = ("volume1", "volume2", "depth_max1", "depth_max2", "pressure_max", "contact_area", "dissipated_energy")
FRICTIONAL = ("dissipated_energy", "shear_max", "slip_max", "stick_area", "last_energy")
PLASTIC = ("plastic_max", "plastic_work", "residual_z", "residual_energy")
# numbers that a warning names, or whose cause it is; others name all numbers
STATED = "error by the length of the load steps about"
NAMED = (
    (STATED, ("dissipated_energy",)),
    ("plastic_max, plastic_work and residual_z", PLASTIC),
    ("contact_area may be wrong", ("contact_area",)),
    ("largest at the surface", ("plastic_max",)),
    ("the shear and the stick area may", ("shear_max", "stick_area")),
    ("and plastic_work, the dissipated energy", ("plastic_work", "dissipated_energy", "slip_max", "stick_area")),
    ("pressure is not resolved|maximum pressure is about", ("pressure_max", "shear_max")),
    ("in the energy of the last cycle", ("dissipated_energy",)),
    ("in the worn volumes", ("volume1", "volume2")),
    ("in the maximum depths", ("depth_max1", "depth_max2")),
    ("plastic work is done in one step", ("pressure_max", "contact_area", *PLASTIC)),
    ("plastic strain below slip zones", ("plastic_max",)),
    ("slips only within a cell", ("shear_max", "slip_max", "dissipated_energy", "stick_area")),
    (
        "the load steps are long|slip zones are|widest slip zone|before cells touch|before they merge|in one step",
        FRICTIONAL,
    ),
    ("the plastic strain that it causes", PLASTIC),
    ("maximum shear there", ("shear_max",)),
    ("stick zone is|area of stick may", ("stick_area",)),
    ("in a ring", FRICTIONAL),
    ("has a tip", ("pressure_max", "shear_max")),
    ("wears in stripes", ("depth_max1", "depth_max2", "pressure_max", "shear_max", "contact_area")),
    ("since the last load reversal", ("slip_max",)),
)
MODEL = "half-space theory|linear elasticity|strains are taken as small|periodic images|less than 0.001 of it"


class Problem(NamedTuple):
    """Options but for the grid and the steps, the history, and roughness as a function of x, y."""

    name: str
    case: dict
    header: str
    rows: list
    cells: tuple
    steps: int
    heights: object = None
    most: int = 4  # times that a grid is finer


# ---------------------------------------------------------------- bodies and loads


def bodies(rng, alike):
    """Options of two bodies."""
    steel = (210e9, 0.3)
    one, other = steel, steel
    if not alike:
        one = rng.choice([70e9, 115e9, 320e9, 600e9]), rng.choice([0.2, 0.34])
    elif rng.random() < 0.3:
        one = other = rng.choice([3e9, 70e9]), rng.choice([0.34, 0.0])
    return dict(
        body1_young=float(one[0]),
        body1_poisson=float(one[1]),
        body2_young=float(other[0]),
        body2_poisson=float(other[1]),
    )


def modulus_of(case):
    names = ("body1_young", "body1_poisson", "body2_young", "body2_poisson")
    return closed.effective_modulus(*(case[name] for name in names))


def hertz(rng, case, plane, low=-3.2, high=-2.0):
    """Adds a ball or cylinder of a radius; half width, load and peak pressure of a contact at random."""
    radius, modulus = 10 ** rng.uniform(-3, -1), modulus_of(case)
    peak = modulus * 10 ** rng.uniform(low, high)
    half = radius * peak / modulus * (2 if plane else np.pi / 2)
    if plane:
        case.update(gap_type="ellipsoid", gap_radius_x=radius, gap_radius_y=float("inf"))
    else:
        case.update(gap_type="sphere", gap_radius1=radius, gap_radius2=float("inf"))
    return half, (np.pi / 2 * half if plane else 2 / 3 * np.pi * half**2) * peak, peak


def ways(rng, normal, friction, axes, moment=0.0, tension=0.0):
    """Header and rows of N, T_x and more: loading, reversals, small ones, walks, with constant and with varying N."""
    shape = rng.choice(["grows", "together", "cycle", "returns", "small", "walk"])
    last = 1 - 2 * 10 ** rng.uniform(-2, 0)
    x = dict(grows=[0, 1], together=[1], cycle=[0, 1, -1, 1], returns=[0, 1, 0], small=[0, 1, last])
    x = x.get(shape, [0, *rng.uniform(-1, 1, 3)])
    n = np.array([1, *rng.uniform(0.6, 1, 3)] if shape == "walk" else [1.0] * 4)[: len(x)]
    part = rng.uniform(0.1, 0.95) * friction
    turn = rng.choice([0, 0, rng.uniform(0.2, 1.5)]) if axes == 2 else 0
    y = np.roll(x, 1) * (np.arange(len(x)) > 0) if turn and rng.random() < 0.5 else np.array(x, float)
    columns = dict(time=np.arange(len(x)) * 1.0, load_n=normal * n, load_tx=part * normal * n * x * np.cos(turn))
    if turn:
        columns["load_ty"] = part * normal * n * y * np.sin(turn)
    if moment:
        columns["load_my"] = moment * n
    if tension:
        columns["bulk2_stress_xx"] = tension * np.array(x, float)
    if shape == "together":
        columns["time"] = columns["time"] + 1
    return ",".join(columns), [tuple(map(float, row)) for row in zip(*columns.values())]


def waves(rng, size, shortest, height):
    """A function of x, y: a roughness of this rms height whose waves are as long or longer; with the grid as period."""
    most = max(1, int(size / shortest))
    count = rng.integers(4, 12)
    k, phase = rng.integers(-most, most + 1, (count, 2)), rng.uniform(0, 2 * np.pi, count)
    weight = rng.normal(size=count) / (1 + np.hypot(*k.T))
    weight *= height / np.sqrt(0.5 * np.sum(weight**2))

    def heights(x, y):
        return sum(w * np.sin(2 * np.pi * (a * x + b * y) / size + p) for w, (a, b), p in zip(weight, k, phase))

    return heights


# ---------------------------------------------------------------- kinds


def usual(rng, seed, folder):
    name = rng.choice(
        ["sphere", "ellipsoid", "pad", "cylinder", "rough", "layered", "dissimilar", "rolling", "moments"]
    )
    if name == "pad":
        case = random_pads.random_case(seed, folder)
        rows = [tuple(map(float, row)) for row in np.loadtxt(case["history"], delimiter=",", skiprows=1, ndmin=2)]
        header = Path(case["history"]).read_text().split("\n")[0]
        cells, steps = case.pop("grid_n"), case.pop("steps")
        return Problem(name, case, header, rows, (cells,), steps)
    plane = name == "cylinder" or (name in ("rough", "layered", "dissimilar") and rng.random() < 0.5)
    case = bodies(rng, alike=name != "dissimilar")
    half, normal, peak = hertz(rng, case, plane)
    friction = rng.uniform(0.1, 0.9)
    room = rng.uniform(1.15, 1.6) * (1.2 if name in ("rough", "layered", "dissimilar", "moments") else 1)
    size = 2 * half * room
    cells = int(rng.integers(100, 201)) if plane else int(rng.integers(26, 41))
    case.update(friction=friction, grid_size=size, elasticity="plane" if plane else "halfspace")
    tension = friction * peak * 10 ** rng.uniform(-1.5, 0) if rng.random() < 0.2 and name != "rolling" else 0
    moment = normal * half * rng.uniform(0.03, 0.15) if name == "moments" else 0
    header, rows = ways(rng, normal, friction, 1 if plane else 2, moment, tension)
    heights = None
    if name == "ellipsoid":
        case.update(
            gap_type="ellipsoid",
            gap_radius_x=case["gap_radius1"] * rng.uniform(0.4, 1),
            gap_radius_y=case["gap_radius1"],
        )
        for key in ("gap_radius1", "gap_radius2"):
            del case[key]
    elif name == "rough":
        heights = waves(
            rng,
            size,
            size * rng.uniform(8, 20) / cells,
            half**2 / 2 / (case.get("gap_radius_x") or case["gap_radius1"]) * rng.uniform(0.01, 0.2),
        )
    elif name == "layered":
        thick = half * 10 ** rng.uniform(-0.7, 0.5)
        case.update(
            body2_layer_young=210e9 * 10 ** rng.uniform(-0.5, 0.5),
            body2_layer_poisson=0.25,
            body2_layer_thickness=thick,
        )
    elif name == "rolling":
        creep = friction * peak / modulus_of(case) * rng.uniform(0.2, 2, 2)
        case.update(rolling="steady", creep_x=float(creep[0]))
        if rng.random() < 0.5:
            case.update(creep_y=float(creep[1]))
        else:
            case.update(creep_spin=float(creep[1] / half))
        header, rows = "time,load_n", [(1.0, normal)]
    steps = 1 if name == "rolling" else int(rng.choice([1, 2, 4, 8]))
    return Problem(name, case, header, rows, (cells,) if plane else (cells, cells), steps, heights)


def hardening(rng, young, limit):
    """Options of a material."""
    kind = rng.choice(["perfect", "linear", "voce", "swift", "backstress"])
    return dict(
        perfect={},
        linear=dict(body2_hardening_modulus=young * rng.uniform(0.005, 0.1)),
        voce=dict(
            body2_hardening="voce", body2_voce_stress=limit * rng.uniform(0.1, 1), body2_voce_rate=rng.uniform(10, 300)
        ),
        swift=dict(
            body2_hardening="swift", body2_swift_strain=limit / young, body2_swift_exponent=rng.uniform(0.05, 0.3)
        ),
        backstress=dict(body2_backstress=f"{young * rng.uniform(0.02, 0.2)},{rng.uniform(20, 400)}"),
    )[kind]


def yields(rng, seed, folder):
    """A cylinder, mostly, or a ball on a body that yields, often coated; pressed, unloaded, loaded again, fretted."""
    plane = rng.random() < 0.8
    case = bodies(rng, alike=rng.random() < 0.6)
    if rng.random() < 0.15:
        case.update(body1_young="inf", body1_poisson=0.3)
    elastic = dict(case, body1_young=float(case["body1_young"]))
    half, normal, peak = hertz(rng, elastic, plane, -2.6, -1.9)
    case.update({key: value for key, value in elastic.items() if key.startswith("gap")})
    limit = peak / rng.uniform(1.5, 4 if plane else 5)
    case.update(body2_yield=limit, **hardening(rng, case["body2_young"], limit))
    if case["body1_young"] == case["body2_young"] and rng.random() < 0.3:
        case.update(body1_yield=limit * rng.uniform(1, 1.5))
    friction = rng.choice([0.0, rng.uniform(0.05, 0.7)]) if plane or rng.random() < 0.5 else 0.0
    shape = rng.choice(["load", "unload", "reload"]) if not friction else rng.choice(["load", "push", "fret", "both"])
    n = dict(load=[1], unload=[1, 0.1], reload=[1, 0.1, 1.1], push=[1, 1], fret=[1, 1, 1, 1], both=[1, 1, 0.2])[shape]
    t = dict(push=[0, 1], fret=[0, 1, -1, 1], both=[0, 1, 0]).get(shape, [0] * len(n))
    part = rng.uniform(0.2, 0.9) * friction
    rows = [(k + 1.0, float(normal * a), float(part * normal * a * b)) for k, (a, b) in enumerate(zip(n, t))]
    if not any(t):
        rows = [row[:2] for row in rows]
    room = rng.uniform(1.3, 1.7) if not plane else rng.uniform(5, 7)
    cells = int(rng.integers(160, 241)) if plane else int(rng.integers(24, 33))
    case.update(
        friction=float(friction), grid_size=2 * half * room, elasticity="plane_periodic" if plane else "halfspace"
    )
    header = "time,load_n,load_tx" if any(t) else "time,load_n"
    steps = int(rng.choice([1, 2, 4] if plane else [1, 2]))
    if not plane and rng.random() < 0.5:  # coated
        young = float(case["body2_young"] * 10 ** rng.uniform(-0.5, 0.5))
        case.update(
            body2_layer_young=young, body2_layer_poisson=0.25, body2_layer_thickness=half * rng.uniform(0.02, 0.3)
        )
    return Problem(
        f"{'cylinder' if plane else 'ball'} {shape}", case, header, rows, (cells,) if plane else (cells, cells), steps,
        most=4 if plane else YIELD_FINER,
    )  # fmt: skip


def slides(rng, seed, folder):
    """A cylinder, a pad, mostly, or a ball to and fro on a flat; one or both wear, by either law."""
    plane = rng.random() < 0.9
    case = bodies(rng, alike=rng.random() < 0.7)
    half, normal, peak = hertz(rng, case, plane, -3.2, -2.3)
    friction = rng.uniform(0.1, 0.9)
    stroke = half * 10 ** rng.uniform(-1, 0.7 if plane else 0.2)
    path = 4 * stroke
    # so much wear that the scar of body 2 is some approaches deep
    approach = half**2 / (case.get("gap_radius_x") or case["gap_radius1"]) / 2
    share = rng.choice([0, 0.3, 0.5, 1])
    rate = 10 ** rng.uniform(-15, -13)
    worn = rng.uniform(0.05, 3) * approach * (half + stroke) * (1 if plane else 2 * half)
    cycles = max(3, float(np.floor(worn / (rate * normal * path))))
    law, scale = ("coefficient", 1) if rng.random() < 0.6 else ("energy", 1 / friction)
    for body, part in ((1, 1 - share), (2, share)):
        if part > 0:
            case[f"wear_{law}{body}"] = float(rate * scale * part)
    wide = half * (1 + 1.2 * np.sqrt(worn / (approach * half * (1 if plane else 2 * half)))) ** 0.5
    size = 2 * (rng.uniform(1.3, 1.7) * wide + stroke)
    if plane:
        case.update(elasticity="plane", rot_y=0.0)
        cells = (int(rng.integers(100, 201)),)
        case.update(grid_size=size)
    else:
        case.update(disp_y=0.0, rot_x=0.0, rot_y=0.0, rot_z=0.0)
        side = 2 * rng.uniform(1.3, 1.7) * wide
        cells = (48, max(24, 2 * int(24 * side / size)))
        case.update(grid_size=(size, size * cells[1] / cells[0]))
    case.update(friction=friction, load_n=float(normal), slide=True, wear_cycles=cycles)
    places = (1, -1, 1) if rng.random() < 0.7 else (0, 1, -1, 0)
    rows = [(float(k), float(place * stroke)) for k, place in enumerate(places)]
    per = 2 * stroke / half
    steps = int(np.clip(np.ceil(per * rng.choice([1.5, 2.5, 5])), 2, 24))
    return Problem(
        "cylinder" if plane else "ball", case, "time,disp_x", rows, cells, steps, most=4 if plane else SLIDE_FINER
    )


def zones(rng, seed, folder):
    """A cylinder, a pad or a ball in partial slip under constant N; one or both bodies wear, by either law."""
    plane = rng.random() < 0.85
    case = bodies(rng, alike=rng.random() < 0.7)
    half, normal, peak = hertz(rng, case, plane, -3.2, -2.0)
    friction = rng.uniform(0.1, 0.9)
    radius = case.get("gap_radius_x") or case["gap_radius1"]
    room = rng.uniform(1.25, 1.7)
    if plane and rng.random() < 0.25:  # a pad as long as the cylinder's contact, under the same load
        case.update(gap_type="pad", gap_half_flat_x=half * rng.uniform(0.3, 0.9), gap_edge_radius_x=radius)
        for key in ("gap_radius_x", "gap_radius_y"):
            del case[key]
        room *= 1.2
    part = rng.uniform(0.15, 0.9)
    # so much wear that a cell at the edge would lose some hundredths of the approach, or several
    approach, share = half**2 / radius / 2, rng.choice([0, 0.3, 0.5, 1])
    slip = friction * approach * (1 - np.sqrt(1 - part))
    rate = 10 ** rng.uniform(-15, -12.5)
    cycles = max(3, float(np.floor(10 ** rng.uniform(-1.5, 1) * approach / (rate * 0.5 * peak * 4 * slip))))
    law, scale = ("coefficient", 1) if rng.random() < 0.6 else ("energy", 1 / friction)
    for body, of in ((1, 1 - share), (2, share)):
        if of > 0:
            case[f"wear_{law}{body}"] = float(rate * scale * of)
    cells = int(80 * 4 ** rng.uniform(0, 1)) if plane else int(rng.integers(28, 41))
    case.update(friction=friction, grid_size=2 * half * room, elasticity="plane" if plane else "halfspace")
    case.update(wear_cycles=cycles)
    t = friction * part * normal
    rows = [(float(k), float(normal), float(t * x)) for k, x in enumerate((0, 1, -1, 0))]
    steps = int(rng.choice([4, 8, 16]))
    name = f"{case['gap_type'] if plane else 'ball'} life"
    return Problem(name, case, "time,load_n,load_tx", rows, (cells,) if plane else (cells, cells), steps,
                   most=4 if plane else SLIDE_FINER)  # fmt: skip


KINDS = {"usual": usual, "yield": yields, "slide": slides, "zone": zones}


def random_problem(kind, seed, folder):
    return KINDS[kind](np.random.default_rng((sorted(KINDS).index(kind), seed)), seed, folder)


# ---------------------------------------------------------------- runs


def path_of(problem, steps):
    """The rows; for more steps than the one in which contact is made those of its path: N first, then the rest."""
    first, *others = problem.rows
    columns = problem.header.split(",")
    normal = [v if name in NORMAL else 0.0 for name, v in zip(columns, first)]
    if problem.steps > 1 or steps == 1 or normal == list(first) or "load_n" not in columns:
        return problem.rows
    normal[0] -= 0.5
    return [tuple(normal), first, *others]


def options_of(kind, problem, folder, cells, steps):
    """Options with so many times finer cells and steps; writes the files that they name."""
    n = [count * cells for count in problem.cells]
    case = dict(problem.case, grid_n=tuple(n), output_every=1, steps=problem.steps * steps)
    case.pop("history", None)
    if len(n) == 1:
        case["grid_n"] = n[0]
    case.update(history(Path(folder) / "loads.csv", problem.header, *path_of(problem, steps)))
    if problem.heights:
        size = problem.case["grid_size"]
        x = [(np.arange(count) + 0.5) * size / count for count in (n if len(n) == 2 else [n[0], 1])]
        with h5py.File(Path(folder) / "rough.h5", "w") as file:
            file["height"] = problem.heights(*np.meshgrid(x[0], x[1] if len(n) == 2 else [0.0]))
        case["gap_rough_file"] = "rough.h5"
    if kind == "yield":
        case.update(yield_layers=FINE_LAYERS if cells > 1 and len(n) == 1 else None, output_every=10000)
    elif kind in ("slide", "zone"):
        case.update(output_every=10000)
    return case


def said(line):
    """The error that is printed beside the dissipated energy, relative to it."""
    found = re.search(STATED + r" (\S+) %", line)
    return float(found[1]) / 100 if found else 0.0


def run(program, case, folder, timeout):
    """Exit code, warnings with errors printed beside numbers, last line of stderr; code None after so many seconds."""
    try:
        done = subprocess.run(
            [str(program), *words(dict(case, output="out.h5"))], cwd=folder, capture_output=True, text=True,
            timeout=timeout, env=conftest.environment(), stdin=subprocess.DEVNULL,
        )  # fmt: skip
    except subprocess.TimeoutExpired:
        return None, [], f"more than {timeout:g} s"
    lines = done.stderr.splitlines()
    found = [line.partition("warning: ")[2] for line in lines if "warning: " in line]
    found += [line.strip() for line in done.stdout.splitlines() if said(line) > WRONG]
    return done.returncode, [line for line in found if not re.search(MODEL, line)], (lines or [""])[-1]


def read(path):
    """Printed numbers of a run, and the least values that count, by name."""
    with h5py.File(path) as file:
        table = {name: column[:] for name, column in file["history"].items()}
        numbers = {name: table[name][-1] for name in (*LAST, *STEADY) if name in table}
        numbers.update({name: np.nansum(table[name]) for name in SUMS if name in table})
        if "residual_z" in file:
            numbers["residual_z"] = file["residual_z"][-1].max()
        if "wear" in file:
            numbers.update({name: file[f"wear/{name}"][-1] for name in LIFE if name in file["wear"]})
            for name in ("slip_max", "disp_z"):
                numbers.pop(name, None)
    work = np.nanmax(np.abs(table["load_n"] * table["disp_z"]))
    least = dict.fromkeys(("dissipated_energy", "plastic_work", "residual_energy"), SLACK * work)
    least["residual_energy"] += RESIDUAL * numbers.get("plastic_work", 0)
    least.update(stick_area=1e-3 * numbers["contact_area"], shear_max=1e-4 * numbers["pressure_max"])
    least.update(slip_max=1e-5 * np.nanmax(np.abs(table["disp_z"])), plastic_max=YIELDED)
    least["residual_z"] = YIELDED * np.nanmax(np.abs(table["disp_z"]))
    least.update(
        load_tx=1e-3 * table["load_n"][-1],
        load_ty=1e-3 * table["load_n"][-1],
        creep_x=1e-7,
        creep_y=1e-7,
        creep_spin=1e-2,
    )
    return {name: float(value) for name, value in numbers.items() if np.isfinite(value)}, least


def errors_of(found, true, least):
    return {name: compare({name: found[name]}, {name: true[name]}, least)[0] for name in true if name in found}


def named(warnings):
    """Numbers that the warnings name; None: all."""
    numbers = set()
    for line in warnings:
        names = [names for pattern, names in NAMED if re.search(pattern, line)]
        if not names or re.search(r"cells? across \(", line):
            return None
        numbers.update(*names)
    return numbers


class Trial:
    """A problem with its errors, warnings and, if it is silently wrong, what finer cells and finer steps change."""

    def __init__(self, kind, seed, program, finer, timeout):
        self.kind, self.seed, self.program, self.timeout = kind, seed, program, timeout
        self.errors, self.warnings, self.failure, self.cause, self.parts = {}, [], "", {}, {}
        with tempfile.TemporaryDirectory() as folder:
            self.folder = Path(folder)
            self.problem = random_problem(kind, seed, self.folder)
            self.finer = min(finer, self.problem.most)
            self.solve(finer)

    def numbers(self, cells, steps, **more):
        case = dict(options_of(self.kind, self.problem, self.folder, cells, steps), **more)
        code, warnings, line = run(self.program, case, self.folder, self.timeout)
        self.case = case
        if code:
            self.failure = f"exit code {code}, {cells} x finer: {line}"
        elif code is None:
            self.failure = f"{line}, {cells} x finer"
        return (None, warnings) if self.failure else (read(self.folder / "out.h5"), warnings)

    def solve(self, finer):
        found, self.warnings = self.numbers(1, 1)
        self.line = " ".join(words(self.case)) if self.failure else ""
        if self.failure:
            return
        steps = dict(zone=2).get(self.kind, self.finer if self.kind == "yield" else finer)
        steps = 1 if self.problem.name == "rolling" else steps
        fine = dict(slide=dict(wear_rtol=0.02), zone=dict(wear_rtol=5e-3)).get(self.kind, {})
        true, _ = self.numbers(self.finer, steps, **fine)
        if self.failure:
            return
        self.errors, self.true, self.found = errors_of(found[0], true[0], true[1]), true[0], found[0]
        if self.silent:
            worst = max(self.silent, key=self.silent.get)
            for part, (cells, many, words_) in dict(
                cells=(self.finer, 1, {}), steps=(1, steps, {}), jumps=(1, 1, fine)
            ).items():
                if part == "steps" and steps == 1 or part == "jumps" and not fine:
                    continue
                other, _ = self.numbers(cells, many, **words_)
                self.failure = ""
                if other and worst in other[0]:
                    self.cause[part] = errors_of(found[0], other[0], true[1])[worst]

    @property
    def wrong(self):
        return {name: error for name, error in self.errors.items() if error > WRONG}

    @property
    def silent(self):
        numbers = named(self.warnings)
        return {} if numbers is None else {name: error for name, error in self.wrong.items() if name not in numbers}

    @property
    def loud(self):
        warned = any(STATED not in line for line in self.warnings)
        return warned and bool(self.errors) and max(self.errors.values()) < RIGHT

    def tell(self):
        p = self.problem
        head = f"seed {self.seed} ({self.kind} {p.name}, {'x'.join(map(str, p.cells))} cells, {p.steps} steps): "
        if self.failure:
            return head + self.failure + (f"\n    {self.line}" if self.line else "")
        texts = sorted(self.errors.items(), key=lambda item: -item[1])[:4]
        text = head + ", ".join(f"{name} {100 * error:.2g} %" for name, error in texts)
        if self.silent:
            text += f" SILENT: {', '.join(self.silent)}; by " + ", ".join(
                f"{part} {100 * error:.2g} %" for part, error in self.cause.items()
            )
        return "\n    ".join([text + (" LOUD" if self.loud else ""), *self.warnings])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--kind", choices=sorted(KINDS), default="usual")
    parser.add_argument("--trials", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--finer", type=int, default=4)
    parser.add_argument("--timeout", type=float, default=100, help="seconds of one run")
    parser.add_argument("--show", action="store_true", help="print all problems, not only those with a fault")
    parser.add_argument("--log", help="file to which a line of JSON is added for each problem")
    given = parser.parse_args()
    trials = []
    for seed in range(given.seed, given.seed + given.trials):
        trial = Trial(given.kind, seed, conftest.PROGRAM, given.finer, given.timeout)
        trials.append(trial)
        if given.show or trial.silent or trial.loud or trial.failure:
            print(trial.tell(), flush=True)
        if given.log:
            with open(given.log, "a") as file:
                known = dict(
                    name=trial.problem.name, **{k: getattr(trial, k) for k in ("kind", "seed", "errors", "warnings")}
                )
                json.dump(dict(known, failure=trial.failure, cause=trial.cause), file)
                file.write("\n")
    solved = [trial for trial in trials if trial.errors]
    silent = [trial.seed for trial in solved if trial.silent]
    warned = [trial.seed for trial in solved if trial.wrong and not trial.silent]
    loud = [trial.seed for trial in solved if trial.loud]
    print(
        f"{given.kind}: {len(solved)} of {len(trials)} solved: {len(silent)} wrong without a warning {silent}, "
        f"{len(warned)} wrong with one, {len(loud)} right with one {loud}"
    )
    return 0


if __name__ == "__main__":
    sys.exit(main())

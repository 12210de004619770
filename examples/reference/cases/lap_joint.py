"""A bolted lap joint: petsam with the compliance of the pair, and bricks whose nodes touch."""

import subprocess
import sys
import tempfile
from pathlib import Path

import h5py
import numpy as np
from bricks import Joint, Strip, halved
from common import TOOL, all_covered

import petsam
from petsam import joint
from petsam.apps.compliance.mesh import grid_mesh
from petsam.apps.compliance.stiffness import numbers
from petsam.apps.joint.patch import DISPLACEMENTS

N, YOUNG, POISSON, FRICTION = 10e3, 210e9, 0.3, 0.2
SMALL, LARGE = 1e-7, 5.5e-6
WASHER, PATCH = 6.0, 32.0  # half the side of a washer, side of the patch, mm
REACH = 16.6  # of the nodes that may touch, mm
STEPS, CYCLES = 6, 2  # from 0 to LARGE
# three solid meshes of a strip: planes along x from the free end to the clamp, along y from the middle, along z, mm
MESHES = (
    ([-24, -20, -16, -11, -6, -2, 2, 6, 11, 16, 20, 24, 33, 46, 60], [0, 6, 11, 16, 20], [0, 3, 6, 10]),
    (
        [-24, -20, -16, -13, -9.5, -6, -3, 0, 3, 6, 9.5, 13, 16, 20, 24, 30, 39, 49, 56, 60],
        [0, 3, 6, 9.5, 13, 16.5, 20],
        [0, 2, 4.5, 7.5, 10],
    ),
    (
        [-24, -22, -19, -16.5, *range(-14, 15, 2), 16.5, 19, 22, 24, 28, 34, 42, 50, 55.5, 58.5, 60],
        [0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20],
        [0, 1.5, 3.5, 6, 8, 10],
    ),
)
# the coarsest mesh of the bricks
BRICKS = ([*range(-24, 25, 3), 30, 38, 47, 55, 60], [*range(0, 16, 3), 17.5, 20], [0, 3, 6.5, 10])


def history(steps):
    """Displacement of the end of body 1 and part of the bolt's tension, step by step; the first two are the bolt and
    the small displacement."""
    up, down = np.linspace(0, 1, steps + 1)[1:], np.linspace(1, 0, 2 * steps + 1)[1:]
    parts = np.concatenate([up] + CYCLES * [down, 1 - down])
    return [(0.0, 1.0), (SMALL, 1.0)] + [(LARGE * part, 1.0) for part in parts]


def numbers_of(steps, force, lost, pressure):
    """The required numbers from force and dissipated energy of each step."""
    bottom, energy = force[-2 * steps - 1], sum(lost[-4 * steps :])
    return {
        "force_bolted": force[0],
        "pressure_max": pressure,
        "stiffness_stuck": (force[1] - force[0]) / SMALL,
        "force_max": force[-1],
        "stiffness_secant": (force[-1] - bottom) / LARGE,
        "dissipated_energy": energy,
    }


UNITS = {
    "force_bolted": "N",
    "pressure_max": "Pa",
    "stiffness_stuck": "N/m",
    "force_max": "N",
    "stiffness_secant": "N/m",
    "dissipated_energy": "J",
}

# ---------------------------------------------------------------- petsam


def deck(path, level):
    """A CalculiX deck (mm, N, MPa) of both strips: 20-node bricks."""
    x, half, z = MESHES[level]
    mesh = grid_mesh((x, [-v for v in half[:0:-1]] + half, z), "C3D20R", 1e-6 * YOUNG, POISSON)
    block, own, first = mesh.blocks[0], mesh.nodes, 0
    washer = (own[:, 2] == z[-1]) & (np.abs(own[:, :2]).max(axis=1) <= WASHER)
    out = ["*HEADING", "lap joint"]
    for body, turn in ((1, [1, -1, -1]), (2, [-1, -1, 1])):  # z of the deck points down
        out += ["*NODE", *("{}, {:.12g}, {:.12g}, {:.12g}".format(first + n, *p) for n, p in enumerate(own * turn, 1))]
        out.append(f"*ELEMENT, TYPE=C3D20R, ELSET=BODY{body}")
        for number, nodes in zip(block.numbers, block.nodes + 1 + first):
            out += numbers([number + first, *nodes])
            out[-1] = out[-1].rstrip(",")
        out += [f"*SOLID SECTION, ELSET=BODY{body}, MATERIAL=STEEL", f"*SURFACE, NAME=TOP{body}"]
        out += [f"{element + first}, S{face + 1}" for element, face in mesh.surfaces["TOP"]]
        out.append(f"*SURFACE, NAME=WASHER{body}")
        for group in mesh.boundary():
            on = group.elements[np.all(washer[group.nodes], axis=1)]
            out += [f"{block.numbers[element] + first}, S{group.local + 1}" for element in on]
        out += [f"*NSET, NSET=END{body}", *numbers(np.flatnonzero(own[:, 0] == x[-1]) + 1 + first)]
        first += max(len(own), len(block.numbers))
    out += ["*MATERIAL, NAME=STEEL", "*ELASTIC", f"{1e-6 * YOUNG}, {POISSON}", "*STEP", "*STATIC", "*DSLOAD"]
    out += [f"WASHER{body}, P, {1e-6 * N / (4e-6 * WASHER**2)}" for body in (1, 2)] + ["*END STEP"]
    path.write_text("\n".join(out) + "\n", encoding="ascii")


def compliance(directory, level):
    """Writes the compliance of the pair, whose load case `bolt` is the tension."""
    mesh, file = directory / "lap.inp", directory / "lap.h5"
    deck(mesh, level)
    command = [TOOL, "--mesh", mesh, "--units", "mm", "--contact", "TOP2", "--pair", "TOP1", "--fixed", "END1"]
    command += ["--fixed", "END2", "--patch", f"{PATCH}mm", "--frame", "0,0,0:1,0,0:0,0,1", "--degree", "8,8"]
    command += ["--case", "bolt=1", "--no-stress", "--no-picture", "-o", file]
    subprocess.run([str(part) for part in command], check=True, stdout=subprocess.DEVNULL, stderr=sys.stderr)
    return file


def solve(level, grid_n=64, steps=STEPS, seen=None):
    """The required numbers with the compliance of a mesh; `seen` is called with the contact after each step."""
    with tempfile.TemporaryDirectory() as folder:
        pair = compliance(Path(folder), level)
        with h5py.File(pair) as data:
            coupling = data["rigid/compliance"][()]
        bodies = {f"body{k}_{name}": v for k in (1, 2) for name, v in (("young", YOUNG), ("poisson", POISSON))}
        contact = petsam.Contact(
            grid_n=grid_n,
            grid_size=1e-3 * PATCH,
            gap_type="flat",
            friction=FRICTION,
            body2_compliance=f"{pair}:1:local",
            **bodies,
        )
        # the strips' rigid motions against each other, by the tractions; the only modal force is the displacement of
        # the end of body 1, along which the mode has unit stiffness
        patch = joint.Patch(contact, list(DISPLACEMENTS), by_load=list(DISPLACEMENTS), name="contact")
        structure = joint.Structure([patch], [1.0], np.eye(6)[:, 1:2], coupling)
        structure.loads[0] = -0.1 * N
        force, lost = [], []
        for number, (distance, tension) in enumerate(history(steps)):
            structure.step([distance], [{"body2_case_bolt": tension}])
            force.append(patch.number("load_tx"))
            lost.append(patch.number("dissipated_energy"))
            if number == 0:
                pressure = patch.number("pressure_max")
            if seen:
                seen(contact, distance, force[-1])
    return numbers_of(steps, force, lost, pressure)


# ---------------------------------------------------------------- bricks


def bricks(times, steps=STEPS):
    """The required numbers by nodes of bricks that touch, the elements halved so many times."""
    strip = Strip(*(halved(lines, times) for lines in BRICKS), 1e-6 * YOUNG, POISSON, REACH, WASHER)
    both, force, lost = Joint(strip, FRICTION), [], []
    for distance, tension in history(steps):
        lost.append(1e-3 * both.step(tension * N / (4 * WASHER**2), 1e3 * distance))
        force.append(-2 * both.force[:, 0].sum())
        if len(force) == 1:
            pressure = 1e6 * (both.force[:, 2] / strip.area).max()
    return numbers_of(steps, force, lost, pressure)


def evidence():
    """petsam on three meshes of its compliance, and bricks."""
    ours = [solve(level, 32 * 2**level) for level in range(3)]
    others = [bricks(times) for times in range(3)]
    ways = {
        "petsam, 32, 64, 128 cells, compliance by three meshes": ours,
        "bricks of 8 nodes, 3, 1.5, 0.75 mm long in the contact": others,
    }
    return all_covered(UNITS, ways)


def answers():
    return solve(0, steps=4)


def draw(figure):
    left, right = figure.subplots(1, 2, width_ratios=(1.5, 1))
    left.fill_between([-24, 60], [0, 0], [10, 10], color="0.8", edgecolor="0.3")
    left.fill_between([-60, 24], [-10, -10], [0, 0], color="0.65", edgecolor="0.3")
    for side in (-1, 1):
        left.fill_between([side * 60, side * 64], [0, 0], [side * 10, side * 10], color="0.2")
        for x in (-5, 0, 5):
            left.annotate("", (x, side * 10), (x, side * 17), arrowprops={"arrowstyle": "->", "color": "C1"})
    left.annotate("N", (8, 13))
    left.annotate("d", (60, 13))
    left.annotate("", (69, 12), (58, 12), arrowprops={"arrowstyle": "->", "color": "C1"})
    left.annotate("body 1", (32, 3.5))
    left.annotate("body 2", (-46, -6.5))
    left.set(xlabel="x, mm", ylabel="z, mm", xlim=(-70, 72), ylim=(-24, 24), aspect="equal")
    places = []
    solve(0, seen=lambda _, distance, force: places.append((distance, force)))
    distance, force = np.transpose(places[-4 * STEPS - 1 :])
    line = force[2 * STEPS] + (force[-1] - force[2 * STEPS]) * distance / LARGE
    right.plot(1e6 * distance, force - line)
    right.set(xlabel="d, µm", ylabel="T less the straight line of its ends, N")

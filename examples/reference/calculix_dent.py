"""The case `indentation` in CalculiX: axisymmetric elements below a rigid sphere. Units: mm, N, MPa.

Where an element ends on the axis CalculiX leaves its face out of the contact: it has no area in the wedge into which
axisymmetric elements are expanded. So a wire, a fiftieth of an element wide, is left out and held.
"""

import re
import subprocess
import tempfile
from pathlib import Path

import numpy as np
from axisymmetric import edge, growing

FORCE, RADIUS, YOUNG, POISSON, YIELD, HARDENING = 20.0, 5.0, 210e3, 0.3, 600.0, 10e3
DEPTH = 50e-3  # of the residual stress
TOUCHING = 0.12  # radius of the surfaces that may touch
FAR = 40.0  # where the body is held
PENALTY = 50  # stiffness of the contact, in E over the size of an element
WEDGE = 180  # CalculiX's wedge of 2 degrees in the whole
OUTPUT = """*NODE PRINT, NSET=BALL, TOTALS=ONLY
RF
*NODE PRINT, NSET=TOP
U
*CONTACT PRINT
CSTR
*EL PRINT, ELSET=AXIS
S, PEEQ, COORD
*END STEP"""


def quads(first, ids):
    """Elements of a grid of nodes, a row of which lies above the next one: the lines of a deck."""
    corners = np.stack([ids[1:, :-1], ids[1:, 1:], ids[:-1, 1:], ids[:-1, :-1]], axis=-1).reshape(-1, 4)
    return [f"{first + k},{','.join(map(str, row))}" for k, row in enumerate(corners)]


def nodes(ids, x, y):
    return [f"{k},{a:.9e},{b:.9e},0." for k, a, b in zip(ids.ravel(), x.ravel(), y.ravel())]


def listed(name, numbers, kind="NSET"):
    return [f"*{kind}, {kind}={name}", *map(str, numbers)]


def deck(lines, places):
    """The sphere moves down to these places, one after the other."""
    size, n = lines[1], len(lines)
    radii = np.append(0.02 * size, lines[1:])
    x, y = np.meshgrid(radii, -lines)
    body = np.arange(1, n * n + 1).reshape(n, n)
    r = radii[radii < 1.1 * TOUCHING + size]
    ball = n * n + 1 + np.arange(2 * len(r)).reshape(2, len(r))
    low = 1 + (n - 1) ** 2 + np.arange(len(r) - 1)  # its elements
    shape = np.stack([r**2 / (2 * RADIUS) + 0.01, r**2 / (2 * RADIUS)])
    text = ["*NODE", *nodes(body, x, y), "*NODE, NSET=BALL", *nodes(ball, np.stack([r, r]), shape)]
    text += ["*ELEMENT, TYPE=CAX4, ELSET=BODY", *quads(1, body)]
    text += ["*ELEMENT, TYPE=CAX4, ELSET=SPHERE", *quads(low[0], ball)]
    text += listed("HELD", body[:, 0]) + listed("FAR", np.unique(np.append(body[-1], body[:, -1])))
    text += listed("TOP", body[0, : len(r)]) + listed("AXIS", 1 + (n - 1) * np.arange(n - 1), "ELSET")
    text += ["*SURFACE, NAME=UPPER", *(f"{1 + k}, S3" for k in range(np.searchsorted(lines, TOUCHING)))]
    text += ["*SURFACE, NAME=LOWER", *(f"{k}, S1" for k in low)]
    text += ["*MATERIAL, NAME=STEEL", "*ELASTIC", f"{YOUNG},{POISSON}"]
    text += [
        "*PLASTIC",
        f"{YIELD}, 0.",
        f"{YIELD + 0.2 * HARDENING}, 0.2",
        "*SOLID SECTION, ELSET=BODY, MATERIAL=STEEL",
    ]
    text += ["*MATERIAL, NAME=ANY", "*ELASTIC", f"{YOUNG},{POISSON}", "*SOLID SECTION, ELSET=SPHERE, MATERIAL=ANY"]
    text += ["*SURFACE INTERACTION, NAME=PAIR", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR"]
    text += [
        f"{PENALTY * YOUNG / size:.6e}",
        "*CONTACT PAIR, INTERACTION=PAIR, TYPE=SURFACE TO SURFACE",
        "UPPER, LOWER",
    ]
    text += ["*BOUNDARY", "HELD, 1", "FAR, 1, 2", "BALL, 1"]
    for place in places:
        text += ["*STEP, INC=200", "*STATIC", "1., 1., 1e-4, 1.", "*BOUNDARY", f"BALL, 2, 2, {-place:.9e}", OUTPUT]
    return "\n".join(text) + "\n"


def read(text):
    """The tables at the end of each step, {first words of the head: array}: the last ones of the times 1, 2, ..."""
    steps = {}
    for part in re.split(r"\n(?= total force)", text)[1:]:
        blocks = steps[np.ceil(float(re.search(r"time +(\S+)", part)[1]) - 1e-4)] = {}
        for block in re.split(r"\n(?= [a-z])", part):
            head, _, rows = block.strip().partition("\n")
            blocks[head.split("(")[0].strip()] = np.array(
                [row.split() for row in rows.split("\n") if row.strip()], float
            )
    return list(steps.values())


def run(folder):
    """Runs case.inp in a folder."""
    done = subprocess.run(["ccx", "case"], cwd=folder, capture_output=True, text=True)
    if "Job finished" not in done.stdout:
        raise SystemExit(f"ccx: {done.stdout[-500:]}")


def solve(lines, places):
    with tempfile.TemporaryDirectory() as folder:
        Path(folder, "case.inp").write_text(deck(lines, places), encoding="ascii")
        run(folder)
        return read(Path(folder, "case.dat").read_text(encoding="ascii"))


def means(rows, column):
    """Mean of a column over the integration points of each element."""
    numbers, at = np.unique(rows[:, 0], return_inverse=True)
    return numbers, np.bincount(at, rows[:, column]) / np.bincount(at)


def answers(size=3e-3, steps=24):
    """The numbers by elements of `size` at the contact.

    The place of the sphere under 20 N is found from a run of few steps; beyond FAR the displacement of a point force is
    added.
    """
    lines = growing(96e-3, size, FAR, 1.25)
    places = 1e-3 * np.array([0.3, 0.6, 0.9, 1.0, 1.1])
    forces = [-WEDGE * step["total force"][0, 1] for step in solve(lines, places)]
    down = np.interp(FORCE, forces, places)
    *_, pressed, released = solve(lines, [*down * np.linspace(0, 1, steps + 1)[1:], -0.1 * down])
    element, p = means(pressed["contact stress"], 2)
    top = lines[: len(pressed["displacements"])]
    gap = top**2 / (2 * RADIUS) - down - pressed["displacements"][:, 2]
    touching = top <= lines[int(element[p > 0].max())]
    _, z = means(released["global coordinates"], 3)
    _, stress = means(released["stresses"], 2)
    _, strain = means(pressed["equivalent plastic strain"], 2)
    return {
        "approach": 1e-3 * (down + FORCE * (1 - POISSON**2) / (np.pi * YOUNG * FAR)),
        "contact_radius": 1e-3 * edge(top, gap, touching),
        "pressure_max": 1e6 * p.max(),
        "plastic_strain_max": strain.max(),
        "dent": -1e-3 * released["displacements"][0, 2],
        "residual_stress": 1e6 * np.interp(DEPTH, -z, stress),
    }

"""A rigid sphere on a round plate that rests on a ring: petsam with its compliance, axisymmetric finite elements."""

import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from axisymmetric import Body, edge, halved
from common import TOOL, all_covered

import petsam

N, RADIUS, YOUNG, POISSON = 2000.0, 0.1, 210e9, 0.3
RING = (6e-3, 8e-3)
PATCH = 2.4  # mm
# three solid meshes: half of the elements along the middle square, circles beyond it, planes over the height, mm
CORE = 1.5
MESHES = (
    (2, [3.2, 5, 5.8, 6, 6.2, 7, 7.8, 8, 8.2, 10], [0, 0.5, 1.5, 2.6, 3]),
    (3, [3.2, 4.6, 5.5, 5.9, 6, 6.1, 6.5, 7, 7.5, 7.9, 8, 8.1, 8.6, 10], [0, 0.4, 1.3, 2.3, 2.8, 3]),
    (
        3,
        [3.2, 4.4, 5.3, 5.75, 5.95, 6, 6.05, 6.25, 6.6, 7, 7.4, 7.75, 7.95, 8, 8.05, 8.3, 9, 10],
        [0, 0.3, 0.9, 1.7, 2.4, 2.8, 2.95, 3],
    ),
)
# the coarsest axisymmetric mesh, mm
RADII = [*np.linspace(0, 1.2, 13), 1.35, 1.6, 2, 2.5, 3.1, 3.8, 4.5, 5.1, 5.5, 5.75, 5.9, 5.97, 6, 6.03, 6.1, 6.25]
RADII += [6.5, 7, 7.5, 7.75, 7.9, 7.97, 8, 8.03, 8.1, 8.25, 8.5, 9, 9.5, 10]
DEPTHS = [0, 0.1, 0.2, 0.3, 0.4, 0.55, 0.75, 1, 1.3, 1.6, 1.9, 2.2, 2.5, 2.75, 2.9, 2.97, 3]
OPTIONS = {
    "grid_n": 128,
    "grid_size": PATCH * 1e-3,
    "body1_young": "inf",
    "body1_poisson": POISSON,
    "body2_young": YOUNG,
    "body2_poisson": POISSON,
    "gap_type": "sphere",
    "gap_radius1": RADIUS,
    "gap_radius2": "inf",
    "load_n": N,
}


def lattice(lines):
    """Planes of elements and the middles between them, where quadratic elements have nodes."""
    return np.interp(np.arange(2 * len(lines) - 1) / 2, np.arange(len(lines)), lines)


def blocks(parts, circles):
    """Nodes in the plane: of a square and the four blocks around it, on lattices of twice as many steps as elements."""
    t = np.linspace(-1.0, 1.0, 2 * parts + 1)
    square = np.stack(np.meshgrid(CORE * t, CORE * t, indexing="ij"), axis=-1)
    side = np.stack([np.full_like(t, CORE), CORE * t], axis=-1)
    arc = np.stack([np.cos(np.pi / 4 * t), np.sin(np.pi / 4 * t)], axis=-1)
    between = [side, *(side + w * (circles[0] * arc - side) for w in (0.25, 0.5, 0.75))]
    ring = np.array(between + [radius * arc for radius in lattice(circles)])
    turns = [np.array([[c, -s], [s, c]]) for c, s in ((1, 0), (0, 1), (-1, 0), (0, -1))]
    return [square, *(ring @ turn.T for turn in turns)]


def deck(path, level):
    """A CalculiX deck (mm, N, MPa) of the plate, z = 0 its upper side, z downwards: 20-node bricks."""
    parts, circles, heights = MESHES[level]
    z = lattice(heights)
    number, points, elements, top = {}, [], [], []
    corners = [(0, 0), (2, 0), (2, 2), (0, 2)]
    middles = [(1, 0), (2, 1), (1, 2), (0, 1)]
    local = [(*c, 0) for c in corners] + [(*c, 2) for c in corners] + [(*m, 0) for m in middles]
    local += [(*m, 2) for m in middles] + [(*c, 1) for c in corners]
    for plane in blocks(parts, circles):
        for i in range(0, plane.shape[0] - 1, 2):
            for j in range(0, plane.shape[1] - 1, 2):
                for k in range(0, len(z) - 1, 2):
                    nodes = []
                    for a, b, c in local:
                        x = (*plane[i + a, j + b], z[k + c])
                        key = tuple(round(1e6 * v) for v in x)
                        if key not in number:
                            number[key] = len(points) + 1
                            points.append(x)
                        nodes.append(number[key])
                    elements.append(nodes)
                    top += [len(elements)] * (k == 0)
    x = np.array(points)
    radius = np.hypot(x[:, 0], x[:, 1])
    sets = {"FOOT": (x[:, 2] > 3.0 - 1e-6) & (radius > 6.0 - 1e-6) & (radius < 8.0 + 1e-6)}
    out = [
        "*HEADING",
        "plate",
        "*NODE",
        *("{}, {:.12g}, {:.12g}, {:.12g}".format(n, *p) for n, p in enumerate(points, 1)),
    ]
    out.append("*ELEMENT, TYPE=C3D20R, ELSET=PLATE")
    for n, nodes in enumerate(elements, 1):
        out += [", ".join(map(str, [n, *nodes[:10]])) + ",", ", ".join(map(str, nodes[10:]))]
    out += [
        "*MATERIAL, NAME=STEEL",
        "*ELASTIC",
        f"{YOUNG * 1e-6}, {POISSON}",
        "*SOLID SECTION, ELSET=PLATE, MATERIAL=STEEL",
    ]
    for name, mask in sets.items():
        out += [f"*NSET, NSET={name}", *(f"{n}," for n in np.flatnonzero(mask) + 1)]
    out += ["*SURFACE, NAME=TOP", *(f"{n}, S1" for n in top)]
    path.write_text("\n".join(out) + "\n", encoding="ascii")


def solve(level, grid_n=128):
    """The contact, with the compliance of a mesh."""
    with tempfile.TemporaryDirectory() as directory:
        mesh, file = Path(directory) / "plate.inp", Path(directory) / "plate.h5"
        deck(mesh, level)
        command = [
            TOOL,
            "--mesh",
            mesh,
            "--units",
            "mm",
            "--contact",
            "TOP",
            "--fixed",
            "FOOT",
            "--patch",
            f"{PATCH}mm",
        ]
        command += ["--frame", "0,0,0:1,0,0:0,0,1", "--no-stress", "--no-picture", "-o", file]
        subprocess.run([str(part) for part in command], check=True, stdout=subprocess.DEVNULL, stderr=sys.stderr)
        return petsam.run(OPTIONS, grid_n=grid_n, body2_compliance=str(file))


def numbers(results):
    last = {name: values[-1] for name, values in results.history.items()}
    return {
        "approach": last["disp_z"],
        "contact_radius": np.sqrt(last["contact_area"] / np.pi),
        "pressure_max": last["pressure_max"],
        "elastic_energy": last["stored_energy"],
    }


def elements(times):
    """The same by axisymmetric elements that touch the sphere themselves; and radii and pressures of the nodes."""
    r, z = (halved(1e-3 * np.array(lines), times) for lines in (RADII, DEPTHS))
    body = Body(r, z, YOUNG, POISSON)
    foot = (body.nodes[:, 1] == z[-1]) & (body.nodes[:, 0] > RING[0] - 1e-9) & (body.nodes[:, 0] < RING[1] + 1e-9)
    body.fixed |= np.repeat(foot, 2)
    gap = r**2 / (2.0 * RADIUS)
    approach, force, _ = body.press(N, gap, np.zeros(body.size), r < 8e-4)
    pressure, down = body.pressures(force), body.u[1::2][body.top]
    found = {
        "approach": approach,
        "contact_radius": edge(r, gap + down - approach, force),
        "pressure_max": pressure.max(),
        "elastic_energy": 0.5 * force @ down,
    }
    return found, r, pressure


UNITS = {"approach": "m", "contact_radius": "m", "pressure_max": "Pa", "elastic_energy": "J"}


def evidence():
    """petsam on three meshes of its compliance, and axisymmetric elements."""
    ours = [numbers(solve(level, 64 * 2**level)) for level in range(3)]
    others = [elements(times)[0] for times in range(3)]
    ways = {
        "petsam, 64, 128, 256 cells, compliance by three meshes": ours,
        "axisymmetric elements of 4 nodes, 731, 2805, 10985 nodes": others,
    }
    return all_covered(UNITS, ways)


def answers():
    return numbers(solve(1))


def draw(figure):
    left, right = figure.subplots(1, 2, width_ratios=(1.6, 1))
    _, r, pressure = elements(1)
    left.fill_between([-10, 10], [0, 0], [3, 3], color="0.85", linewidth=0)
    for side in (-1, 1):
        left.fill_between([side * 6, side * 8], [3, 3], [4, 4], color="0.4", linewidth=0)
    x = np.linspace(-6, 6, 101)
    left.plot(x, -(x**2) / 50, color="C1")
    left.annotate("rigid sphere (not to scale)", (0, -1.6), ha="center")
    left.annotate("foot: a ring", (0, 3.7), ha="center")
    left.set(xlabel="r, mm", ylabel="depth z, mm", xlim=(-11, 11), ylim=(4.6, -2.4))
    near = r < 1.2e-3
    right.plot(1e3 * r[near], 1e-6 * pressure[near])
    right.set(xlabel="r, mm", ylabel="p, MPa", xlim=(0, 1.2), ylim=(0, None))

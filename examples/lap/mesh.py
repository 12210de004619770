#!/usr/bin/env python3
"""CalculiX deck (mm, N, MPa, t) of a lap joint: two steel strips, one over the other, for one bolt or two.

    mesh.py lap lap.inp     body 2, x -150..30 mm, clamped at its end; body 1 above it, x -30..150 mm, TIP at its end
    mesh.py two two.inp     the same for two bolts at x = -30 and 30 mm: overlap -56..56 mm, ends at -160 and 160 mm
    mesh.py section s.inp   the section y = 0 of the lap in plane strain, with a bolt in each 50 mm

The contact's plane is z = 0, z points down into body 2. Strips are 50 mm wide; washers are squares. --coarse is for an
estimate of the mesh's error.
"""

import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from petsam.apps.compliance.mesh import grid_mesh
from petsam.apps.compliance.stiffness import numbers

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))  # what the examples share
from decks import write_deck  # noqa: E402

STEEL, DENSITY = (210000.0, 0.3), 7.8e-9
WASHER = 6.0  # half a side of a washer
SECTION = "section"
Y = ([3.0, 6.0, 9.0, 12.0, 15.0, 18.0, 21.0, 25.0], [6.0, 12.0, 18.0, 25.0])


@dataclass
class Strips:
    """Places (mm) of the bolts along x by the ends of their washers' names, and planes of elements: up to the overlap's
    end, beyond it, and over the height; each also coarse."""

    bolts: dict
    near: tuple
    far: tuple
    z: tuple

    def edges(self, coarse):
        """Planes of elements along x of body 1, y and z of both."""
        near, far, y, z = (both[coarse] for both in (self.near, self.far, Y, self.z))
        x, y = ([-v for v in one[::-1]] + [0.0] + one for one in (near, y))
        return np.array([*x, *far]), np.array(y), np.array(z)


STRIPS = {
    "lap": Strips(
        {"": 0.0},
        ([3.0, 6.0, 9.0, 12.0, 15.0, 18.0, 20.0, 23.0, 26.5, 30.0], [6.0, 10.0, 14.0, 18.0, 21.0, 25.0, 30.0]),
        ([36.0, 45.0, 57.0, 72.0, 90.0, 110.0, 130.0, 150.0], [40.0, 53.0, 70.0, 95.0, 120.0, 150.0]),
        ([0.0, 1.5, 3.5, 6.0, 9.0, 12.7], [0.0, 3.0, 7.0, 12.7]),
    ),
    "two": Strips(
        {"L": -30.0, "R": 30.0},
        (
            [3.0, 7.0, 11.0, 14.0, 17.0, 20.0, 22.0, 24.0, 27.0, 30.0, 33.0, 36.0, 38.0, 40.0, 43.0, 46.0, 50.0, 56.0],
            [7.0, 14.0, 19.0, 24.0, 30.0, 36.0, 41.0, 46.0, 50.0, 56.0],
        ),
        ([64.0, 76.0, 92.0, 112.0, 134.0, 160.0], [70.0, 95.0, 125.0, 160.0]),
        ([0.0, 1.5, 3.5, 6.0, 10.0], [0.0, 3.0, 6.0, 10.0]),
    ),
}


def lines(name, coarse, kind):
    """The deck of one of STRIPS, or of the lap's section."""
    if name == SECTION:
        return section_lines(STRIPS["lap"].edges(coarse))
    return strip_lines(f"{name} joint", STRIPS[name], STRIPS[name].edges(coarse), kind)


def strip_lines(title, strips, edges, kind):
    """The deck of strips with these planes of elements. Body 2 is the mesh turned about y by half a turn, without its
    height. The far ends are the sets CLAMP of body 2 and END of body 1; of strips from y = 0 on, their half, the other
    nodes at y = 0 are the set MIDDLE."""
    x, y, z = edges
    out, first, sets, plane = [f"*HEADING\n{title}, mm, N, MPa, t"], 0, [], []
    for body in (1, 2):
        mesh = grid_mesh((x, y, z), kind, *STEEL)
        # body 2 lies below, with its long end at negative x; both turns keep the orientation of the elements
        points = mesh.nodes * ([1.0, -1.0, -1.0] if body == 1 else [-1.0, -1.0, 1.0])
        block = mesh.blocks[0]
        out += ["*NODE", *("{}, {:.12e}, {:.12e}, {:.12e}".format(first + i, *p) for i, p in enumerate(points, 1))]
        out.append(f"*ELEMENT, TYPE={kind}, ELSET=BODY{body}")
        for number, nodes in zip(block.numbers, block.nodes + 1 + first):
            out += numbers([number + first, *nodes])
            out[-1] = out[-1].rstrip(",")
        out += [f"*SOLID SECTION, ELSET=BODY{body}, MATERIAL=STEEL"]
        top = [f"{element + first}, S{face + 1}" for element, face in mesh.surfaces["TOP"]]
        out += [f"*SURFACE, NAME=CONTACT{body}", *top]
        for bolt, center in strips.bolts.items():
            out += [f"*SURFACE, NAME=WASHER{body}{bolt}", *washer(mesh, points, center, z[-1], first)]
        end = np.flatnonzero(np.abs(mesh.nodes[:, 0] - x[-1]) < 1e-9)
        if body == 2:
            sets += ["*NSET, NSET=CLAMP", *numbers(end + 1 + first)]
        else:
            middle = end[np.argmin(np.abs(mesh.nodes[end]) @ [0.0, 1.0, 1.0])]
            sets += ["*NSET, NSET=TIP", f"{middle + 1 + first}", "*NSET, NSET=END", *numbers(end + 1 + first)]
        if y[0] == 0.0:
            plane += [n + 1 + first for n in np.setdiff1d(np.flatnonzero(mesh.nodes[:, 1] == 0.0), end)]
        first += max(len(mesh.nodes), len(block.numbers))
    out += ["*MATERIAL, NAME=STEEL", "*ELASTIC", "{}, {}".format(*STEEL), "*DENSITY", f"{DENSITY}"]
    return out + sets + (["*NSET, NSET=MIDDLE", *numbers(plane)] if plane else [])


def section_lines(edges):
    """The deck of the section of the lap with these planes of elements, of CPE8 in x and z."""
    (x, y, z), first = edges, 0
    out, more = ["*HEADING", "section of a lap joint, mm, N, MPa, t"], []
    mesh = grid_mesh((x, np.array([0.0, 1.0]), z), "C3D20", *STEEL)
    quads = np.concatenate([group.nodes for group in mesh.boundary() if not np.any(mesh.nodes[group.nodes][..., 1])])
    used, quads = np.unique(quads, return_inverse=True)
    nodes, quads = mesh.nodes[used], quads.reshape(-1, 8) + 1
    for body, sign in ((1, 1.0), (2, -1.0)):
        points = nodes * [sign, 1.0, -sign]
        out += ["*NODE", *("{}, {:.12e}, {:.12e}, {:.12e}".format(first + i, *p) for i, p in enumerate(points, 1))]
        out.append("*ELEMENT, TYPE=CPE8, ELSET=ALL")
        out += [", ".join(map(str, [k + first, *(one + first)])) for k, one in enumerate(quads, 1)]
        on = np.abs(points[:, 0]) <= WASHER + 1e-9
        for name, mask in (("CONTACT", nodes[:, 2] == 0.0), ("WASHER", on & (nodes[:, 2] == z[-1]))):
            held = mask[quads[:, :4] - 1] & mask[np.roll(quads[:, :4], -1, axis=1) - 1]
            more += [f"*SURFACE, NAME={name}{body}", *(f"{e + 1 + first}, S{k + 1}" for e, k in np.argwhere(held))]
        end = np.flatnonzero(nodes[:, 0] == x[-1])
        chosen = end if body == 2 else end[[np.argmin(nodes[end, 2])]]
        more += [f"*NSET, NSET={'CLAMP' if body == 2 else 'TIP'}", *numbers(chosen + 1 + first)]
        first += max(len(nodes), len(quads))
    out += ["*MATERIAL, NAME=STEEL", "*ELASTIC", "{}, {}".format(*STEEL), "*DENSITY", f"{DENSITY}"]
    return [*out, "*SOLID SECTION, ELSET=ALL, MATERIAL=STEEL", f"{2.0 * y[-1]}", *more]


def washer(mesh, points, center, height, first):
    """Faces of a washer about x = center, of a body whose nodes are at `points`."""
    on = (np.abs(mesh.nodes[:, 2] - height) < 1e-9) & (np.abs(points[:, 1]) <= WASHER + 1e-9)
    on &= np.abs(points[:, 0] - center) <= WASHER + 1e-9
    number = mesh.blocks[0].numbers
    return [
        f"{number[element] + first}, S{group.local + 1}"
        for group in mesh.boundary()
        for element, nodes in zip(group.elements, group.nodes)
        if np.all(on[nodes])
    ]


if __name__ == "__main__":
    write_deck(__doc__, (*STRIPS, SECTION), lines)

#!/usr/bin/env python3
"""CalculiX deck (mm, N, MPa, t) of a lap joint: two steel strips, one over the other, for one bolt.

    mesh.py lap lap.inp     body 2, x -150..30 mm, clamped at its end; body 1 above it, x -30..150 mm, TIP at its end

The contact's plane is z = 0, z points down into body 2. Strips are 50 mm wide and 12.7 mm high; washers are squares.
--coarse is for an estimate of the mesh's error.
"""

import numpy as np

from petsam.compliance.example import write_deck
from petsam.compliance.mesh import grid_mesh
from petsam.compliance.stiffness import numbers

STEEL, DENSITY = (210000.0, 0.3), 7.8e-9
HEIGHT, LAP, END = 12.7, 30.0, 150.0
WASHER = 6.0  # half a side of a washer


def edges(coarse):
    """Planes of elements along x of body 1, y and z of both."""
    near = [6.0, 10.0, 14.0, 18.0, 21.0, 25.0, LAP] if coarse else [3.0, 6.0, 9.0, 12.0, 15.0, 18.0, 20.0,
                                                                    23.0, 26.5, LAP]  # fmt: skip
    far = [40.0, 53.0, 70.0, 95.0, 120.0, END] if coarse else [36.0, 45.0, 57.0, 72.0, 90.0, 110.0, 130.0, END]
    y = [6.0, 12.0, 18.0, 25.0] if coarse else [3.0, 6.0, 9.0, 12.0, 15.0, 18.0, 21.0, 25.0]
    z = [0.0, 3.0, 7.0, HEIGHT] if coarse else [0.0, 1.5, 3.5, 6.0, 9.0, HEIGHT]
    both = [[-v for v in one[::-1]] + [0.0] + one for one in (near, y)]
    return np.array([*both[0], *far]), np.array(both[1]), np.array(z)


def lines(_name, coarse, kind):
    """The deck: body 2 is the mesh turned about y by half a turn, without its height."""
    x, y, z = edges(coarse)
    out, first, sets = ["*HEADING", "lap joint, mm, N, MPa, t"], 0, []
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
        faces = mesh.boundary()
        washer = [
            f"{block.numbers[e] + first}, S{g.local + 1}"
            for g in faces
            for e, nodes in zip(g.elements, g.nodes)
            if np.all(np.abs(mesh.nodes[nodes][:, 2] - HEIGHT) < 1e-9)
            and np.all(np.abs(mesh.nodes[nodes][:, :2]) <= WASHER + 1e-9)
        ]
        top = [f"{element + first}, S{face + 1}" for element, face in mesh.surfaces["TOP"]]
        out += [f"*SURFACE, NAME=CONTACT{body}", *top, f"*SURFACE, NAME=WASHER{body}", *washer]
        end = np.flatnonzero(np.abs(mesh.nodes[:, 0] - END) < 1e-9)
        if body == 2:
            sets += ["*NSET, NSET=CLAMP", *numbers(end + 1 + first)]
        else:
            middle = end[np.argmin(np.abs(mesh.nodes[end]) @ [0.0, 1.0, 1.0])]
            sets += ["*NSET, NSET=TIP", f"{middle + 1 + first}"]
        first += max(len(mesh.nodes), len(block.numbers))
    out += ["*MATERIAL, NAME=STEEL", "*ELASTIC", "{}, {}".format(*STEEL), "*DENSITY", f"{DENSITY}"]
    return out + sets


if __name__ == "__main__":
    write_deck(__doc__, ("lap",), lines)

#!/usr/bin/env python3
"""CalculiX decks (mm, N, MPa) of the two example bodies.

    mesh.py block block.inp          4 x 4 x 4 mm, clamped below; the sphere touches it 1.4 mm from an edge
    mesh.py beam beam.inp            12 x 4 x 3 mm, clamped at both ends; step 1 pulls one end by 0.006 mm

The contact's origin is the origin of the deck, z points into the body. --coarse halves the elements.
"""

import argparse
import sys

import numpy as np

from petsam.compliance.mesh import grid_mesh
from petsam.compliance.stiffness import model_lines, numbers

STEEL = (210000.0, 0.3)


def halved(edges):
    """The edges with one more between each two."""
    edges = np.array(edges, dtype=float)
    return np.sort(np.concatenate([edges, 0.5 * (edges[1:] + edges[:-1])]))


def graded(near, *far):
    """Edges symmetric about 0: elements of equal size to `near`, then planes at `far`."""
    positive = [*np.linspace(0.0, near, 4)[1:], *far]
    return np.array([-x for x in positive[::-1]] + [0.0] + positive)


def block():
    """Edges and node sets of the block."""
    x = [-1.4, -1.1, *np.linspace(-1.1, 1.1, 7)[1:], 1.6, 2.6]
    z = [0.0, 0.3, 0.7, 1.2, 1.9, 2.8, 4.0]
    return (x, graded(1.1, 1.45, 2.0), z), {"BOTTOM": lambda p: p[:, 2] > 4.0 - 1e-9}


def beam():
    """Edges and node sets of the beam."""
    x = graded(1.5, 2.1, 3.0, 4.2, 5.3, 6.0)
    z = [0.0, 0.4, 0.9, 1.5, 2.2, 3.0]
    sets = {"LEFT": lambda p: p[:, 0] < -6.0 + 1e-9, "RIGHT": lambda p: p[:, 0] > 6.0 - 1e-9}
    return (x, graded(1.5, 2.0), z), sets


def lines(name, fine, kind):
    """The deck."""
    edges, sets = {"block": block, "beam": beam}[name]()
    if fine:
        edges = [halved(e) for e in edges]
    mesh = grid_mesh(edges, kind, *STEEL, node_sets=sets)
    out = ["*HEADING", f"{name}, mm, N, MPa", *model_lines(mesh)]
    for title, nodes in mesh.node_sets.items():
        out += [f"*NSET, NSET={title}", *numbers(nodes + 1)]
    out += ["*SURFACE, NAME=TOP", *(f"{element}, S{face + 1}" for element, face in mesh.surfaces["TOP"])]
    if name == "beam":
        out += ["*STEP", "*STATIC", "*BOUNDARY", "RIGHT, 1, 1, 0.006", "*END STEP"]
    return out


def main():
    """Write one deck."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("body", choices=("block", "beam"))
    parser.add_argument("file", help="deck to write (.inp)")
    parser.add_argument("--fine", action="store_true", help="elements of half the size")
    parser.add_argument("--type", default="C3D20R", help="element type (C3D20R)")
    options = parser.parse_args()
    with open(options.file, "w", encoding="ascii") as file:
        file.write("\n".join(lines(options.body, options.fine, options.type)) + "\n")


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/env python3
"""CalculiX decks (mm, N, MPa) of the two example bodies.

    mesh.py block block.inp          4 x 4 x 4 mm, clamped below; the sphere touches it 1.4 mm from an edge
    mesh.py beam beam.inp            12 x 4 x 3 mm, clamped at both ends; step 1 pulls one end by 0.006 mm

The contact's origin is the origin of the deck, z points into the body. --coarse is for an estimate of the mesh's error.
"""

import sys
from pathlib import Path

import numpy as np

from petsam.apps.compliance.mesh import grid_mesh

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))  # what the examples share
from decks import deck_lines, write_deck  # noqa: E402

STEEL = (210000.0, 0.3)


def graded(near, *far):
    """Edges symmetric about 0: elements of equal size to `near`, then planes at `far`."""
    positive = [*np.linspace(0.0, near, 4)[1:], *far]
    return np.array([-x for x in positive[::-1]] + [0.0] + positive)


def block(coarse):
    """Edges and node sets of the block; elements are smaller beside the patch's edges and at the support."""
    near = np.linspace(-1.1, 1.1, 7)
    if coarse:
        edges = ([-1.4, *near, 1.6, 2.6], graded(1.1, 1.45, 2.0), [0.0, 0.3, 0.7, 1.2, 1.9, 2.8, 4.0])
    else:
        z = [0.0, 0.1, 0.3, 0.7, 1.3, 2.0, 2.8, 3.5, 3.85, 4.0]
        edges = ([-1.4, -1.3, *near, 1.6, 2.2, 2.5, 2.6], graded(1.1, 1.45, 1.85, 2.0), z)
    return edges, {"BOTTOM": lambda p: p[:, 2] > 4.0 - 1e-9}


def beam(coarse):
    """Edges and node sets of the beam."""
    if coarse:
        edges = (graded(1.5, 2.1, 3.0, 4.2, 5.3, 6.0), graded(1.5, 2.0), [0.0, 0.4, 0.9, 1.5, 2.2, 3.0])
    else:
        x = graded(1.5, 2.1, 3.0, 4.2, 5.0, 5.5, 5.8, 5.92, 6.0)
        edges = (x, graded(1.5, 1.85, 2.0), [0.0, 0.15, 0.4, 0.9, 1.5, 2.1, 2.6, 2.85, 3.0])
    return edges, {"LEFT": lambda p: p[:, 0] < -6.0 + 1e-9, "RIGHT": lambda p: p[:, 0] > 6.0 - 1e-9}


def lines(name, coarse, kind):
    """The deck."""
    edges, sets = {"block": block, "beam": beam}[name](coarse)
    out = deck_lines(name, grid_mesh(edges, kind, *STEEL, node_sets=sets), "TOP")
    if name == "beam":
        out += ["*STEP", "*STATIC", "*BOUNDARY", "RIGHT, 1, 1, 0.006", "*END STEP"]
    return out


if __name__ == "__main__":
    write_deck(__doc__, ("block", "beam"), lines)

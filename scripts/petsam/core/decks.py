"""Names in a deck, and boxes of two corners as words, `0,0,4:4,4,4`, in the coordinates and units of its mesh."""

import re

import numpy as np

NUMBER = r"[+-]?(?:\d+\.?\d*(?:[eE][+-]?\d+)?|\.\d+(?:[eE][+-]?\d+)?|inf)"
POINT = rf"{NUMBER},{NUMBER},{NUMBER}"
BOX = re.compile(rf"{POINT}:{POINT}")
NEAR = 1e-6  # of the extent of the mesh, by which nodes may be outside of a box


def folded(name):
    """A name of a set, surface, part or material as it is compared: without regard to case, as Abaqus and CalculiX do.

    A part of it with letters beyond ASCII stays as it is: `upper` would make one name of two, of Fuß and FUSS.
    """
    return ".".join(part.upper() if part.isascii() else part for part in name.split("."))


def inside(nodes, text):
    """Mask of the nodes in a box; its corners may be given in any order."""
    low, high = np.sort([[float(word) for word in point.split(",")] for point in text.split(":")], axis=0)
    near = NEAR * np.max(np.ptp(nodes, axis=0))
    return np.all((nodes >= low - near) & (nodes <= high + near), axis=1)

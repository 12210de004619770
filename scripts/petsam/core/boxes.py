"""Boxes of two corners as words, `0,0,4:4,4,4`, in the coordinates and units of a mesh."""

import re

import numpy as np

NUMBER = r"[+-]?(?:\d+\.?\d*(?:[eE][+-]?\d+)?|\.\d+(?:[eE][+-]?\d+)?|inf)"
POINT = rf"{NUMBER},{NUMBER},{NUMBER}"
BOX = re.compile(rf"{POINT}:{POINT}")
NEAR = 1e-6  # of the extent of the mesh, by which nodes may be outside of a box


def inside(nodes, text):
    """Mask of the nodes in a box; its corners may be given in any order."""
    low, high = np.sort([[float(word) for word in point.split(",")] for point in text.split(":")], axis=0)
    near = NEAR * np.max(np.ptp(nodes, axis=0))
    return np.all((nodes >= low - near) & (nodes <= high + near), axis=1)

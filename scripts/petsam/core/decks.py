"""Names in a deck, and boxes as words, in the coordinates and units of its mesh."""

import re
from typing import NamedTuple

import numpy as np

NUMBER = r"[+-]?(?:\d+\.?\d*(?:[eE][+-]?\d+)?|\.\d+(?:[eE][+-]?\d+)?|inf)"
POINT = rf"{NUMBER},{NUMBER},{NUMBER}"
NEAR = 1e-6  # of the extent of the mesh, by which nodes may be outside of a box


def folded(name):
    """A name of a set, surface, part or material as it is compared: without regard to case, as Abaqus and CalculiX do.

    A part of it with letters beyond ASCII stays as it is: `upper` would make one name of two, of Fuß and FUSS.
    """
    return ".".join(part.upper() if part.isascii() else part for part in name.split("."))


class Box(NamedTuple):
    """A box by its lowest and its highest corner, (3,) each."""

    low: np.ndarray
    high: np.ndarray

    @classmethod
    def of(cls, text):
        """The box of a word with two corners in any order, `0,0,4:4,4,4`; None of another word."""
        if not re.fullmatch(rf"{POINT}:{POINT}", text):
            return None
        return cls(*np.sort([[float(word) for word in point.split(",")] for point in text.split(":")], axis=0))

    def inside(self, nodes):
        """Mask of the nodes (n, 3) in the box."""
        near = NEAR * np.max(np.ptp(nodes, axis=0))
        return np.all((nodes >= self.low - near) & (nodes <= self.high + near), axis=1)

"""Forces at the nodes of a structural analysis over time: Forces, and the nodes of a patch."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from ...core.decks import Box, folded
from ...core.errors import Error, counted, short, there_are


@dataclass
class Forces:
    """Forces on the nodes of one body, in SI units and in the model's axes.

    Attributes
    ----------
    source : str
        The file.
    times : ndarray
        Time of each state, (n,), s; rising.
    labels : ndarray
        Label of each node, (m,).
    x : ndarray
        Coordinates, m: (m, 3), or (n, m, 3) of nodes that move.
    force : ndarray
        Forces, N: (n, m, 3).
    length : float
        The file's unit of length, m, which frames and boxes have.
    normal : ndarray or None
        The part of the pressure alone, N: (n, m, 3).
    couple : ndarray or None
        Moments beside the forces, N m: (n, m, 3).
    sets : dict
        {name: indices of nodes}.
    pressure : dict
        {"cpress", "cshear1", "cshear2": (n, m)}, Pa, where the file has them.
    notes : list of str
        Remarks of the reader.
    """

    source: str
    times: np.ndarray
    labels: np.ndarray
    x: np.ndarray
    force: np.ndarray
    length: float = 1.0
    normal: np.ndarray | None = None
    couple: np.ndarray | None = None
    sets: dict = field(default_factory=dict)
    pressure: dict = field(default_factory=dict)
    notes: list = field(default_factory=list)

    def __repr__(self):
        return f"Forces({short(self.source)}: {counted(len(self.labels), 'node')}, {counted(len(self.times), 'row')})"

    @property
    def start(self) -> np.ndarray:
        """Coordinates at the first time, (m, 3), m."""
        return self.x if self.x.ndim == 2 else self.x[0]

    def nodes(self, patch: str | Sequence | None = None) -> np.ndarray:
        """Indices of the nodes of a patch: the name of a set, or a box, two corners in the file's unit of length.

        Parameters
        ----------
        patch : str or tuple, optional
            The name, the box as a text `0,0,4:4,4,4` or as two points; all nodes.

        Returns
        -------
        ndarray of int
        """
        if patch is None:
            return np.arange(len(self.labels))
        if not isinstance(patch, str):
            patch = ":".join(",".join(repr(float(value)) for value in point) for point in patch)
        if box := Box.of(patch):
            found, what = np.flatnonzero(box.inside(self.start / self.length)), "box"
        else:
            found, what = self.sets.get(folded(patch)), "set"
        if found is None:
            raise Error(f"{self.source}: no set of nodes {short(patch)}{there_are(folded(patch), sorted(self.sets))}")
        if not len(found):
            raise Error(f"{self.source}: {what} {short(patch)} has none of the nodes with forces: name another one")
        return found

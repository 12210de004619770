#!/usr/bin/env python3
"""CalculiX decks (mm, N, MPa) of the two bodies of a dovetail joint: one flank of a blade's root, and of its slot.

    mesh.py blade blade.inp        half of the blade: symmetric about X = 0 (SYMMETRY), gripped at its top (GRIP)
    mesh.py disc disc.inp          the slot's lobe, held at its far side and its bottom (HELD)

Z is radial, Y axial; both bodies are 6 mm thick. The flank (FLANK) is inclined by 45 degrees; the contact's origin is
its middle, at X = 5, Z = 0. --coarse is for an estimate of the mesh's error.
"""

import sys
from pathlib import Path

import numpy as np

from petsam.apps.compliance.mesh import grid_mesh

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))  # what the examples share
from decks import deck_lines, write_deck  # noqa: E402

TITANIUM = (115000.0, 0.32)
THICKNESS = 6.0
FLANK = 2.0  # half of its length
FILLET = 1.0  # radius of the corner where the flank ends
BELOW = 1.2  # depth down to which lines of the mesh are normal to the flank
BEYOND = 4.0  # from there to the far side in the mesh's own coordinate
INNER = (1.04, 1.72, 0.48)  # along the flank, along Y and down: where the cut-off begins for a patch of 1.6 x 2.8 mm
CORNER = np.sqrt(0.5)


def fillet(sign):
    """Points (outer, middle) from the end of the flank to the vertical, along and normal to the flank: a polygon."""
    for angle in np.linspace(0.0, np.pi / 4.0, 4):
        outer = (FLANK + FILLET * np.sin(angle), -FILLET * (1.0 - np.cos(angle)))
        depth = 1.0 * BELOW
        yield sign * angle, outer, (outer[0] + depth * np.sin(angle), outer[1] + depth * np.cos(angle))


class Body:
    """A section as a strip: lines from its outline over points beneath it to its far side."""

    def __init__(self, name):
        self.disc = name == "disc"
        # directions along and normal to the flank: a right-handed system with Y, the normal into the body
        self.along = np.array([1.0, -1.0]) * CORNER * (1.0 if self.disc else -1.0)
        self.normal = np.array([1.0, 1.0]) * CORNER * (1.0 if self.disc else -1.0)
        lines = self._disc() if self.disc else self._blade()
        self.outer, self.middle, self.inner = (np.array(part, dtype=float) for part in zip(*lines))
        steps = np.linalg.norm(np.diff(self.outer, axis=0), axis=1)
        place = np.concatenate([[0.0], np.cumsum(steps)])
        start = np.flatnonzero(np.linalg.norm(self.outer - self._at(-FLANK, 0.0), axis=1) < 1e-9)[0]
        self.breaks = place - place[start] - FLANK

    def _at(self, along, depth):
        """Deck coordinates X, Z."""
        return np.array([5.0, 0.0]) + along * self.along + depth * self.normal

    def _flank(self, inner, skew):
        """Lines of the flank and of the fillet at its end; inner: their far ends; skew: of the line at its start."""
        ends = iter(inner)
        found = [(self._at(-FLANK, 0.0), self._at(-FLANK + skew, BELOW), next(ends))]
        found += [(self._at(s, 0.0), self._at(s, BELOW), next(ends)) for s in (-1.4, 1.4)]
        for _, outer, middle in fillet(1.0):
            # the body is concave there: its inside is at the other side of the arc
            found.append((self._at(*outer), self._at(*middle), next(ends)))
        return found

    def _blade(self):
        far = [(0.0, z) for z in (-3.6, -3.1, -1.2, -0.6, -0.1, 0.4, 0.9)]
        flank = self._flank(far, 0.2)
        corner, top = self._at(-FLANK, 0.0), flank[-1][0]
        below = ((corner[0], -5.0), (corner[0] - BELOW, -5.0), (0.0, -5.0))
        above = ((top[0], 8.0), (flank[-1][1][0], 8.0), (0.0, 8.0))
        return [below, *flank, above]

    def _disc(self):
        far = [(14.0, z) for z in (3.2, 2.6, -0.2, -1.4, -2.2, -3.0, -3.8)]
        flank = self._flank(far, 0.2)
        corner, bottom = self._at(-FLANK, 0.0), flank[-1][0]
        above = ((corner[0], 5.0), (corner[0] + BELOW, 5.0), (14.0, 5.0))
        below = ((bottom[0], -8.0), (flank[-1][1][0], -8.0), (14.0, -8.0))
        return [above, *flank, below]

    def place(self, points):
        """Deck coordinates (n, 3) of mesh coordinates (n, 3): along the outline, Y, depth."""
        s, y, t = points.T
        ends = [
            np.stack([np.interp(s, self.breaks, line[:, i]) for i in range(2)], axis=1)
            for line in (self.outer, self.middle, self.inner)
        ]
        near, far = (np.clip(part, 0.0, 1.0)[:, None] for part in (t / BELOW, (t - BELOW) / BEYOND))
        flat = ends[0] + near * (ends[1] - ends[0]) + far * (ends[2] - ends[1])
        return np.stack([flat[:, 0], y, flat[:, 1]], axis=1)


def graded(breaks, size):
    """Edges through all breaks, of elements of about size(x)."""
    edges = [breaks[0]]
    for low, high in zip(breaks[:-1], breaks[1:]):
        x = np.linspace(low, high, 400)
        count = np.concatenate([[0.0], np.cumsum(np.diff(x) / size(0.5 * (x[1:] + x[:-1])))])
        number = max(1, round(count[-1]))
        edges += list(np.interp(np.arange(1, number + 1) * count[-1] / number, count, x))
    return np.array(edges)


def strip(body, edges, kind):
    """The mesh of bricks, and its nodes in the mesh's own coordinates."""
    mesh = grid_mesh(edges, kind, *TITANIUM)
    plain = mesh.nodes.copy()
    mesh.nodes = body.place(plain)
    s, _, t = plain.T
    high, deepest = edges[0][-1], edges[2][-1]
    sets = {"HELD": (t > deepest - 1e-9) | (s > high - 1e-9)}
    if not body.disc:
        sets = {"SYMMETRY": t > deepest - 1e-9, "GRIP": s > high - 1e-9}
    mesh.node_sets = {name: np.flatnonzero(mask) for name, mask in sets.items()}
    block = mesh.blocks[0]
    middle = dict(zip(block.numbers.tolist(), plain[block.nodes][..., 0].mean(axis=1)))
    mesh.surfaces["FLANK"] = [face for face in mesh.surfaces.pop("TOP") if abs(middle[face[0]]) < FLANK]
    return mesh, plain


def nearest(x, *points):
    """Distance to the nearest of some points."""
    return np.min([np.abs(x - p) for p in points], axis=0)


def linear_mesh(body, coarse):
    """Edges for the compliance: elements are small where the cut-off acts, at the fillet and at the support's edges."""
    unit = 1.5 if coarse else 1.0
    ends = body.breaks[[0, -1]]

    def along(x):
        flank = np.where(np.abs(x) < INNER[0], 0.55, 0.2)
        beyond = np.maximum(0.0, np.where(x > 0.0, x - body.breaks[-2], -FLANK - x))
        return unit * np.minimum(flank + 0.5 * beyond, 0.3 + 0.5 * nearest(x, ends[1]))

    def across(x):
        return unit * np.where(np.abs(x) < INNER[1], 0.9, 0.26)

    def deep(x):
        return unit * np.where(x < INNER[2], 0.5, 0.35 + 0.5 * np.maximum(0.0, x - 2.4))

    half = 0.5 * THICKNESS
    y = graded([0.0, INNER[1], half], across)
    breaks = np.union1d(body.breaks, [-INNER[0], INNER[0]])
    return graded(breaks, along), np.array([*-y[:0:-1], *y]), graded([0.0, INNER[2], BELOW, BELOW + BEYOND], deep)


def lines(name, coarse, kind):
    """The deck."""
    body = Body(name)
    mesh, _ = strip(body, linear_mesh(body, coarse), kind)
    return deck_lines(f"dovetail, {name}", mesh, "FLANK")


if __name__ == "__main__":
    write_deck(__doc__, ("blade", "disc"), lines)

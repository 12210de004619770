"""Shape functions, faces and Gauss points of CalculiX's solid elements, and of its plane strain elements, whose faces
are edges.

The shape functions are the polynomials of a list of monomials that are 1 at one node and 0 at the others, which gives
all families by one piece of code: serendipity bricks and wedges, tetrahedra, their faces.
"""

import itertools
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Optional

import numpy as np
from numpy.polynomial import legendre


class Family:
    """Shape functions on a reference shape: nodes (k, dim) and as many exponents (k, dim)."""

    def __init__(self, nodes, exponents):
        self.nodes, self.exponents = np.array(nodes, dtype=float), np.array(exponents)
        self._coefficients = np.linalg.inv(self._monomials(self.nodes))

    def _monomials(self, points, derivative=None):
        out = np.ones((len(points), len(self.exponents)))
        one = np.ones(len(points))
        for d, x in enumerate(points.T):
            powers = (0.0 * one, one, 2.0 * x) if d == derivative else (one, x, x * x)
            out *= np.stack(powers, axis=1)[:, self.exponents[:, d]]
        return out

    def values(self, points):
        """N (points, k)."""
        return self._monomials(points) @ self._coefficients

    def gradients(self, points):
        """dN/dxi (points, k, dim)."""
        parts = [self._monomials(points, d) @ self._coefficients for d in range(points.shape[1])]
        return np.stack(parts, axis=-1)


def _serendipity(dim):
    """Exponents of which one at most is 2."""
    return [e for e in itertools.product(range(3), repeat=dim) if sum(v == 2 for v in e) <= 1]


def _total(dim, degree):
    return [e for e in itertools.product(range(degree + 1), repeat=dim) if sum(e) <= degree]


def _middles(corners, edges):
    corners = np.array(corners, dtype=float)
    return np.concatenate([corners, [0.5 * (corners[a] + corners[b]) for a, b in edges]])


_QUAD = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
_TRIANGLE = [(0, 0), (1, 0), (0, 1)]
_HEX = [(x, y, z) for z in (-1, 1) for x, y in _QUAD]
_TET = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
_WEDGE = [(x, y, z) for z in (-1, 1) for x, y in _TRIANGLE]
_RING4, _RING3 = [(0, 1), (1, 2), (2, 3), (3, 0)], [(0, 1), (1, 2), (2, 0)]
_HEX_EDGES = _RING4 + [(a + 4, b + 4) for a, b in _RING4] + [(i, i + 4) for i in range(4)]
_WEDGE_EDGES = _RING3 + [(a + 3, b + 3) for a, b in _RING3] + [(i, i + 3) for i in range(3)]
_TET_EDGES = [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)]
_LINEAR = list(itertools.product(range(2), repeat=3))
_WEDGE_LINEAR = [(*e, z) for e in _total(2, 1) for z in range(2)]
_WEDGE_SQUARE = [(*e, z) for e in _total(2, 2) for z in range(2)] + [(*e, 2) for e in _total(2, 1)]

QUAD4 = Family(_QUAD, list(itertools.product(range(2), repeat=2)))
QUAD8 = Family(_middles(_QUAD, _RING4), _serendipity(2))
TRIANGLE3 = Family(_TRIANGLE, _total(2, 1))
TRIANGLE6 = Family(_middles(_TRIANGLE, _RING3), _total(2, 2))
LINE2, LINE3 = Family([(-1,), (1,)], [(0,), (1,)]), Family([(-1,), (1,), (0,)], [(0,), (1,), (2,)])


def _line(n):
    return legendre.leggauss(n)


def square_rule(n, dim=2):
    """n^dim Gauss points on (-1, 1)^dim."""
    x, w = _line(n)
    points = np.array(list(itertools.product(x, repeat=dim)))
    return points, np.prod(list(itertools.product(w, repeat=dim)), axis=1)


def simplex_rule(n, dim=2):
    """n^dim points on the triangle or tetrahedron, by collapsing the square or cube."""
    x, w = _line(n)
    x, w = 0.5 * (1.0 + x), 0.5 * w
    points, weights = [], []
    for chosen in itertools.product(range(n), repeat=dim):
        rest, weight, point = 1.0, 1.0, []
        for i in chosen:
            point.append(rest * x[i])
            weight *= w[i] * rest
            rest *= 1.0 - x[i]
        points.append(point)
        weights.append(weight)
    return np.array(points), np.array(weights)


def wedge_rule(n):
    """n^2 points on the triangle times n along the axis."""
    flat, weight = simplex_rule(n)
    x, w = _line(n)
    points = np.array([(*p, z) for p in flat for z in x])
    return points, np.outer(weight, w).ravel()


def line_rule(n):
    """n Gauss points on (-1, 1)."""
    return square_rule(n, 1)


FACE_RULES = {2: line_rule, 3: simplex_rule, 4: square_rule}  # by the number of corners


@dataclass(frozen=True)
class Shape:
    """A solid element: its family, corners, faces (nodes by corners, then middles) and Gauss points for n a side."""

    family: Family
    corners: int
    faces: tuple
    rule: Callable[[int], tuple[np.ndarray, np.ndarray]]
    full: int  # points a side that CalculiX uses
    linear: Optional[Family] = field(repr=False, default=None)

    @property
    def flat(self):
        """True for an element of a section."""
        return self.family.nodes.shape[1] == 2

    @property
    def edges(self):
        """Ends (n, 2) of the edges by local nodes, in the order of their middle nodes; none of a linear element."""
        place, pairs = self.family.nodes, list(itertools.combinations(range(self.corners), 2))
        found = [
            next(pair for pair in pairs if np.allclose(place[list(pair)].mean(axis=0), middle))
            for middle in place[self.corners :]
        ]
        return np.array(found, dtype=int).reshape(-1, 2)

    def face_family(self, face):
        """Shape functions of a face by its number from 0."""
        count = len(self.faces[face])
        return {2: LINE2, 3: LINE3}[count] if self.flat else {3: TRIANGLE3, 4: QUAD4, 6: TRIANGLE6, 8: QUAD8}[count]

    def face_corners(self, face):
        """Number of corners of a face."""
        count = len(self.faces[face])
        if self.flat:
            return 2
        return count if count < 5 else count // 2


def _faces(corner_faces, edges):
    """Faces with the middle nodes of their edges."""
    count = 1 + max(max(face) for face in corner_faces)
    number = {frozenset(edge): count + i for i, edge in enumerate(edges)}
    out = []
    for face in corner_faces:
        ring = zip(face, face[1:] + face[:1])
        out.append(tuple(face) + tuple(number[frozenset(pair)] for pair in ring) if edges else tuple(face))
    return tuple(out)


_HEX_FACES = [(0, 1, 2, 3), (4, 7, 6, 5), (0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0)]
_TET_FACES = [(0, 1, 2), (0, 3, 1), (1, 3, 2), (2, 3, 0)]
_WEDGE_FACES = [(0, 1, 2), (3, 5, 4), (0, 3, 4, 1), (1, 4, 5, 2), (2, 5, 3, 0)]


def _cube(n):
    return square_rule(n, 3)


def _tetrahedron(n):
    return simplex_rule(n, 3)


_HEX8, _HEX20 = Family(_HEX, _LINEAR), Family(_middles(_HEX, _HEX_EDGES), _serendipity(3))
_TET4, _TET10 = Family(_TET, _total(3, 1)), Family(_middles(_TET, _TET_EDGES), _total(3, 2))
_WEDGE6, _WEDGE15 = Family(_WEDGE, _WEDGE_LINEAR), Family(_middles(_WEDGE, _WEDGE_EDGES), _WEDGE_SQUARE)

SHAPES = {
    "C3D20": Shape(_HEX20, 8, _faces(_HEX_FACES, _HEX_EDGES), _cube, 3, _HEX8),
    "C3D10": Shape(_TET10, 4, _faces(_TET_FACES, _TET_EDGES), _tetrahedron, 3, _TET4),
    "C3D15": Shape(_WEDGE15, 6, _faces(_WEDGE_FACES, _WEDGE_EDGES), wedge_rule, 3, _WEDGE6),
    "C3D8": Shape(_HEX8, 8, _faces(_HEX_FACES, []), _cube, 2, _HEX8),
    "C3D4": Shape(_TET4, 4, _faces(_TET_FACES, []), _tetrahedron, 2, _TET4),
    "C3D6": Shape(_WEDGE6, 6, _faces(_WEDGE_FACES, []), wedge_rule, 2, _WEDGE6),
}


def _edges(ring, middle):
    """The edges of an element of a section, with their middle nodes."""
    return tuple((a, b, len(ring) + i) if middle else (a, b) for i, (a, b) in enumerate(ring))


SECTIONS = {
    "CPE8": Shape(QUAD8, 4, _edges(_RING4, True), square_rule, 3, QUAD4),
    "CPE6": Shape(TRIANGLE6, 3, _edges(_RING3, True), simplex_rule, 3, TRIANGLE3),
    "CPE4": Shape(QUAD4, 4, _edges(_RING4, False), square_rule, 2, QUAD4),
    "CPE3": Shape(TRIANGLE3, 3, _edges(_RING3, False), simplex_rule, 1, TRIANGLE3),
}
SHAPES.update(SECTIONS)
LIKE = {"C3D20R": "C3D20", "C3D8I": "C3D8", "CPE8R": "CPE8"}  # of other integration, or with more modes
KINDS = {  # element types of CalculiX and the shapes they have: the ones to use first
    name: LIKE.get(name, name)
    for name in (
        "C3D20", "C3D20R", "C3D10", "C3D15", "C3D8I", "C3D8", "C3D4", "C3D6", "CPE8", "CPE8R", "CPE6", "CPE4", "CPE3"
    )
}  # fmt: skip

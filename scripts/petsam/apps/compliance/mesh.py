"""A mesh of solid elements: boundary faces, Gauss points on faces and in elements, places of points.

Or of a section in plane strain, 1 m thick: its nodes lie in a plane whose normal is `normal`, its faces are edges, and
nothing varies along the normal.
"""

from dataclasses import dataclass, field, replace
from typing import Optional

import numpy as np
from scipy.spatial import cKDTree

from ...core.brief import brief
from .shapes import FACE_RULES, KINDS, SHAPES

NEIGHBOURS = 24  # number of elements that are examined for a point
NEWTON = 12  # maximum iterations for its place in an element
INSIDE = 1e-6  # tolerance by which local coordinates may be outside


@brief
@dataclass
class Block:
    """Elements of one type: numbers in the deck, nodes (n, k) by index, moduli (n), densities (n)."""

    kind: str
    numbers: np.ndarray
    nodes: np.ndarray
    young: np.ndarray
    poisson: np.ndarray
    density: Optional[np.ndarray] = None

    @property
    def shape(self):
        """Its shape functions and faces."""
        return SHAPES[KINDS[self.kind]]


@brief
@dataclass
class Faces:
    """Element faces of one kind: elements of a block by index, the local face, and the nodes (n, k)."""

    block: int
    local: int
    elements: np.ndarray
    nodes: np.ndarray


@brief
@dataclass
class Points:
    """Gauss points of faces (n, q): coordinates, area vectors outward (weight times normal), shape functions (q, k)."""

    x: np.ndarray
    area: np.ndarray
    values: np.ndarray


@brief
@dataclass
class Mesh:
    """Nodes (n, 3), m, and blocks of elements; node sets and surfaces {name: [(element number, face from 0)]}."""

    nodes: np.ndarray
    blocks: list
    node_sets: dict = field(default_factory=dict)
    surfaces: dict = field(default_factory=dict)
    node_numbers: np.ndarray = field(default_factory=lambda: np.empty(0, int))  # of a deck; none of a mesh without one
    normal: Optional[np.ndarray] = None  # of a section
    thickness: float = 1.0  # of a section, that its forces are for, in the deck's unit

    def turned(self, origin, axes):
        """The mesh in the coordinates of a frame: axes (3, 3) are its x, y, z as rows."""
        nodes = (self.nodes - origin) @ np.asarray(axes).T
        if self.normal is None:
            return replace(self, nodes=nodes)
        nodes[:, 1] = 0.0
        return replace(self, nodes=nodes, normal=np.round(np.asarray(axes) @ self.normal))

    def used(self):
        """Nodes of the elements."""
        return np.unique(np.concatenate([block.nodes.ravel() for block in self.blocks]))

    # ---------------------------------------------------------------- faces

    def all_faces(self):
        """All faces of all elements, by block and local face."""
        for index, block in enumerate(self.blocks):
            for local, face in enumerate(block.shape.faces):
                yield Faces(index, local, np.arange(len(block.nodes)), block.nodes[:, list(face)])

    def boundary(self):
        """Faces that belong to one element only."""
        groups = list(self.all_faces())
        keys = []
        for group in groups:
            count = self.blocks[group.block].shape.face_corners(group.local)
            key = np.full((len(group.nodes), 4), -1)
            key[:, :count] = np.sort(group.nodes[:, :count], axis=1)
            keys.append(key)
        _, inverse, counts = np.unique(np.concatenate(keys), axis=0, return_inverse=True, return_counts=True)
        single = np.split((counts == 1)[inverse.ravel()], np.cumsum([len(key) for key in keys])[:-1])
        return [chosen for chosen in (some(g, mask) for g, mask in zip(groups, single)) if len(chosen.elements)]

    def surface_faces(self, name):
        """Faces of a surface of the deck."""
        wanted = self.surfaces[name]
        found = []
        for group in self.all_faces():
            numbers = self.blocks[group.block].numbers
            of_face = np.array([number for number, local in wanted if local == group.local], dtype=int)
            found.append(some(group, np.isin(numbers, of_face)))
        return [group for group in found if len(group.elements)]

    def gauss(self, faces, n):
        """Gauss points, n a side, of faces of one kind."""
        shape = self.blocks[faces.block].shape
        family = shape.face_family(faces.local)
        local, weight = FACE_RULES[shape.face_corners(faces.local)](n)
        corners = self.nodes[faces.nodes]
        values = family.values(local)
        tangents = np.einsum("qkd,nkx->nqdx", family.gradients(local), corners)
        other = tangents[:, :, 1] if self.normal is None else -self.normal
        area = -np.cross(tangents[:, :, 0], other) * weight[:, None]
        return Points(np.einsum("qk,nkx->nqx", values, corners), area, values)

    def sizes(self, faces):
        """Longest distance between neighbouring corners of each face."""
        count = self.blocks[faces.block].shape.face_corners(faces.local)
        corners = self.nodes[faces.nodes[:, :count]]
        return np.max(np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2), axis=1)

    # ---------------------------------------------------------------- volumes

    @property
    def _dimension(self):
        return 3 if self.normal is None else 2

    def volume(self, index, local, weight, elements=slice(None)):
        """Points (n, q, 3), weights (n, q), shape functions (q, k), and gradients (n, q, k, 3) of a block's
        elements."""
        block = self.blocks[index]
        corners = self.nodes[block.nodes[elements]]
        values = block.shape.family.values(local)
        gradients = block.shape.family.gradients(local)
        jacobian = jacobians(gradients, corners, self.normal)
        inverse = np.linalg.inv(jacobian)[:, :, : gradients.shape[2]]
        size = np.linalg.det(jacobian) * weight
        return (
            np.einsum("qk,nkx->nqx", values, corners),
            size,
            values,
            np.einsum("qkd,nqdx->nqkx", gradients, inverse),
        )

    def locate(self, points):
        """Block, element and local coordinates (n, 3) of points; block -1 where a point is in no element."""
        block, element = np.full(len(points), -1), np.zeros(len(points), dtype=int)
        local, best = np.zeros((len(points), self._dimension)), np.full(len(points), np.inf)
        for index, one in enumerate(self.blocks):
            corners = self.nodes[one.nodes]
            low, high = corners.min(axis=1), corners.max(axis=1)
            slack = 0.1 * (high - low).max(axis=1)[:, None]
            low, high = low - slack, high + slack
            count = min(NEIGHBOURS, len(corners))
            _, near = cKDTree(corners.mean(axis=1)).query(points, count)
            for candidate in near.reshape(len(points), count).T:
                boxed = np.all((points >= low[candidate]) & (points <= high[candidate]), axis=1)
                tried = np.flatnonzero(boxed & (best > INSIDE))
                if not len(tried):
                    continue
                place, beyond = inverse(one.shape, corners[candidate[tried]], points[tried])
                mask = beyond < best[tried]
                better = tried[mask]
                block[better], element[better] = index, candidate[better]
                local[better], best[better] = place[mask], beyond[mask]
        block[best > INSIDE] = -1
        return block, element, local

    def interpolate(self, place, field_values):
        """Values (points, ...) of a nodal field (nodes, ...) at located points."""
        block, element, local = place
        out = np.zeros((len(block), *field_values.shape[1:]))
        for index, one in enumerate(self.blocks):
            here = np.flatnonzero(block == index)
            values = one.shape.family.values(local[here])
            out[here] = np.einsum("pk,pk...->p...", values, field_values[one.nodes[element[here]]])
        return out


def jacobians(gradients, corners, normal=None):
    """Jacobians (n, q, 3, 3) of elements (n, k, 3) by gradients (q, k, dim); in a section the last column is its
    normal."""
    found = np.einsum("qkd,nkx->nqxd", gradients, corners)
    if normal is None:
        return found
    last = np.broadcast_to(np.asarray(normal)[:, None], (*found.shape[:2], 3, 1))
    return np.concatenate([found, last], axis=-1)


def some(faces, mask):
    """The chosen faces."""
    return replace(faces, elements=faces.elements[mask], nodes=faces.nodes[mask])


def outside(shape, local):
    """Returns the distance by which local coordinates are outside of the reference shape."""
    if shape.corners == 8 or shape.flat and shape.corners == 4:
        return np.max(np.abs(local), axis=1) - 1.0
    flat = local[:, : 2 if shape.corners == 6 else 3]
    out = np.maximum(np.max(-flat, axis=1), flat.sum(axis=1) - 1.0)
    return out if shape.corners == 4 or shape.flat else np.maximum(out, np.abs(local[:, 2]) - 1.0)


def inverse(shape, corners, points, family=None):
    """Returns local coordinates of points (n, 3) in elements (n, k, 3) by Newton's method, and distances outside;
    family: its shape functions, if they are not those of all nodes."""
    family = family or shape.family
    local = np.tile(family.nodes.mean(axis=0), (len(points), 1))
    for _ in range(NEWTON):
        values = family.values(local)
        rest = points - np.einsum("pk,pkx->px", values, corners)
        jacobian = np.einsum("pkd,pkx->pxd", family.gradients(local), corners)
        if shape.flat:
            step = (np.linalg.pinv(jacobian) @ rest[..., None])[..., 0]
        else:
            step = np.linalg.solve(jacobian + 1e-300 * np.eye(3), rest[..., None])[..., 0]
        local = np.clip(local + step, -3.0, 3.0)
        if np.max(np.abs(step)) < 1e-12:
            break
    beyond = np.maximum(outside(shape, local), 0.0)
    missed = np.linalg.norm(points - np.einsum("pk,pkx->px", family.values(local), corners), axis=1)
    size = np.linalg.norm(np.ptp(corners, axis=1), axis=1)
    return local, np.where(missed > 1e-6 * size, np.inf, beyond)


def grid_mesh(edges, kind="C3D20", young=1.0, poisson=0.3, node_sets=None):
    """A block of bricks between planes at edges[0], [1], [2] in x, y, z: the mesh that tests and examples use.

    Node sets: {name: function of the nodes (n, 3) that gives a mask}.
    """
    family = SHAPES[KINDS[kind]].family
    counts = [len(e) - 1 for e in edges]
    fine = [np.sort(np.concatenate([e, 0.5 * (np.array(e)[1:] + np.array(e)[:-1])])) for e in edges]
    cells = np.stack(np.meshgrid(*[np.arange(c) for c in counts], indexing="ij"), axis=-1).reshape(-1, 1, 3)
    place = (2 * cells + 1 + family.nodes.astype(int)).reshape(-1, 3)
    used, nodes = np.unique(place, axis=0, return_inverse=True)
    points = np.stack([fine[d][used[:, d]] for d in range(3)], axis=1)
    elements = nodes.reshape(len(cells), -1)
    count = len(elements)
    block = Block(kind, np.arange(1, count + 1), elements, np.full(count, young), np.full(count, poisson))
    sets = {name: np.flatnonzero(chosen(points)) for name, chosen in (node_sets or {}).items()}
    mesh = Mesh(points, [block], sets, {}, np.arange(1, len(points) + 1))
    top = [g for g in mesh.boundary() if np.all(np.abs(points[g.nodes][..., 2] - edges[2][0]) < 1e-12, axis=1).any()]
    mesh.surfaces["TOP"] = [
        (int(block.numbers[e]), g.local)
        for g in top
        for e, nodes in zip(g.elements, g.nodes)
        if np.all(points[nodes][:, 2] == edges[2][0])
    ]
    return mesh

"""Checks of the elements of a deck: turned inside out, or one in the place of another, as of a mesh given twice.

The boundary of a body is what belongs to one element only, so that elements that overlap lose or hide it.
"""

import numpy as np
from scipy.spatial import cKDTree

from ...core.errors import Error
from .mesh import inverse, jacobians, outside

NEAR = 12  # neighbours of an element whose inside is searched for its centre
DEEP = 0.05  # depth of a centre in another element, in its local coordinates, from which on they overlap
FLAT = 1e-9  # determinant at a corner by the diagonal cubed: 0 in bricks of which two corners are one
BENT = 0.35  # distance of a node from the middle of its edge, in lengths of that: 0.29 on an arc of 120 degrees
PIECE = 1 << 16  # elements at a time


def need_sound(mesh, named):
    """Raises Error if elements of a mesh are turned inside out, or overlap; named: place and label of a number."""
    for block in mesh.blocks:
        _need_upright(mesh, block, named)
    _need_apart(mesh, named)


def _need_upright(mesh, block, named):
    """Raises Error if an element is turned inside out somewhere, at a corner too, or has a node far off its edge."""
    shape = block.shape
    inner = shape.family.gradients(shape.rule(shape.full)[0])
    ends = shape.linear.gradients(shape.linear.nodes)
    wrong, bent = [], []
    for first in range(0, len(block.nodes), PIECE):
        x = mesh.nodes[block.nodes[first : first + PIECE]]
        corners = x[:, : shape.corners]
        scale = np.linalg.norm(np.ptp(corners, axis=1), axis=1)[:, None] ** shape.family.nodes.shape[1]
        good = np.all(_size(inner, x, mesh.normal) > 0.0, axis=1)
        good &= np.all(_size(ends, corners, mesh.normal) > -FLAT * scale, axis=1)
        wrong += (first + np.flatnonzero(~good)).tolist()
        bent += (first + np.flatnonzero(~_straight(shape, x))).tolist()
    for found, what in ((wrong, "is turned inside out or distorted"), (bent, "has middle nodes far off its edges")):
        if found:
            more = f", and {len(found) - 1} more" if len(found) > 1 else ""
            raise Error(
                f"{named(block.numbers[found[0]])} {what}{more}: order its nodes as Abaqus and CalculiX do for "
                f"{block.kind}"
            )


def _size(gradients, x, normal):
    """Determinants (n, q) of the Jacobian of elements x (n, k, 3)."""
    return np.linalg.det(jacobians(gradients, x, normal))


def _straight(shape, x):
    """True for elements x (n, k, 3) whose middle nodes are near the middles of their edges."""
    good = np.ones(len(x), dtype=bool)
    for k, (a, b) in enumerate(shape.edges, shape.corners):
        off = np.linalg.norm(x[:, k] - 0.5 * (x[:, a] + x[:, b]), axis=1)
        good &= off <= BENT * np.linalg.norm(x[:, a] - x[:, b], axis=1)
    return good


def _need_apart(mesh, named):
    """Raises Error if the centre of an element is inside another one."""
    corners = [mesh.nodes[block.nodes[:, : block.shape.corners]] for block in mesh.blocks]
    centers = np.concatenate([x.mean(axis=1) for x in corners])
    numbers = np.concatenate([block.numbers for block in mesh.blocks])
    for block, x in zip(mesh.blocks, corners):
        own, low, high = x.mean(axis=1), x.min(axis=1), x.max(axis=1)
        count = min(NEAR, len(x))
        _, near = cKDTree(own).query(centers, count)
        for candidate in near.reshape(len(centers), count).T:
            boxed = np.all((centers >= low[candidate]) & (centers <= high[candidate]), axis=1)
            tried = np.flatnonzero(boxed & (block.numbers[candidate] != numbers))
            if not len(tried):
                continue
            local, beyond = inverse(block.shape, x[candidate[tried]], centers[tried], block.shape.linear)
            inside = tried[(beyond == 0.0) & (outside(block.shape, local) < -DEEP)]
            if len(inside):
                one = inside[0]
                raise Error(
                    f"{named(numbers[one])} fills the same place as {named(block.numbers[candidate[one]])}: remove one "
                    "of them, as the mesh, or a part of it, is in the deck twice"
                )

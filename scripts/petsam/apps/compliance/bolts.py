"""Bolts between the bodies of a pair: a beam of round section between two washers.

A washer is a surface of the deck. Its motion is the mean displacement U and the mean rotation theta of it,

    U = int u dA / A     theta = J^-1 int r x u dA     J = int (r.r - r r') dA

with r from its centroid, so that the bolt's forces are spread over it and nothing is stiffened. The bolt is a beam by
Timoshenko, with Cowper's shear factor and Poisson's ratio of the elements of washer 1, clamped to the motions of both
washers. Initial tension F pulls the washers together. With closing = e.(U_1 - U_2), e from washer 1 to 2 and
k = E A/l, the tension is F - k closing.

In a section there is one bolt in each thickness t of it: stiffness and tensions are those of all bolts per metre, k/t.
"""

from dataclasses import dataclass

import numpy as np
from scipy import sparse

from ...core.brief import brief
from ...core.decks import folded
from ...core.errors import Error

ORDER = 4  # Gauss points along the side of a face


@brief
@dataclass
class Washer:
    """Its centre, m, the motion (6, 3 nodes) by displacements of the nodes, and the moduli (E, nu) of its elements."""

    center: np.ndarray
    motion: sparse.csr_matrix
    moduli: set


@brief
@dataclass
class Bolt:
    """Its axial stiffness, N/m, of a section N/m2, length and diameter, m, modulus, Pa; x and y (m) where its axis
    crosses the contact's plane; closing (1, 3 nodes) by displacements of the nodes, and its part of the stiffness
    matrix."""

    name: str
    stiffness: float
    length: float
    diameter: float
    young: float
    place: np.ndarray
    closing: sparse.csr_matrix
    matrix: sparse.csr_matrix


def cross(r):
    """Matrices (..., 3, 3) that multiply a vector from the left by r (..., 3), as r x."""
    return np.stack([np.cross(r, axis) for axis in np.eye(3)], axis=-1)


def washer(mesh, name):
    """The Washer of a surface of the mesh."""
    points, moduli = [], set()
    for group in mesh.surface_faces(folded(name)):
        gauss, block = mesh.gauss(group, ORDER), mesh.blocks[group.block]
        points.append((group.nodes, gauss.x, np.linalg.norm(gauss.area, axis=2), gauss.values))
        moduli |= set(zip(block.young[group.elements].tolist(), block.poisson[group.elements].tolist()))
    area = sum(weight.sum() for _, _, weight, _ in points)
    center = sum(np.einsum("nq,nqx->x", weight, x) for _, x, weight, _ in points) / area
    inertia = np.zeros((3, 3))
    mean, moment = np.zeros(len(mesh.nodes)), np.zeros((len(mesh.nodes), 3, 3))
    for nodes, x, weight, values in points:
        r = x - center
        square = np.einsum("nqi,nqj,nq->ij", r, r, weight)
        inertia += np.trace(square) * np.eye(3) - square
        np.add.at(mean, nodes, np.einsum("nq,qk->nk", weight, values))
        np.add.at(moment, nodes, np.einsum("nq,qk,nqij->nkij", weight, values, cross(r)))
    axes = np.eye(3) if mesh.normal is None else np.eye(3)[1:2]  # washers of a section turn in its plane alone
    inverse = axes.T @ np.linalg.inv(axes @ inertia @ axes.T) @ axes
    rotation = np.einsum("ij,njk->ink", inverse, moment).reshape(3, -1)
    translation = np.einsum("n,ij->inj", mean / area, np.eye(3)).reshape(3, -1)
    return Washer(center, sparse.csr_matrix(np.concatenate([translation, rotation])), moduli)


def beam(along, diameter, young, poisson):
    """Stiffness (12, 12) of a beam, by displacement and rotation of its first end, then of its second, which is `along`
    (m) from it: the inverse of the flexibility of its second end while the first one is held."""
    length = np.linalg.norm(along)
    e, one = along / length, np.eye(3)
    axial, turn = np.outer(e, e), cross(e)
    area, inertia = 0.25 * np.pi * diameter**2, np.pi * diameter**4 / 64.0
    shear = 0.5 * young / (1.0 + poisson) * area * 6.0 * (1.0 + poisson) / (7.0 + 6.0 * poisson)
    across = length**3 / (3.0 * young * inertia) + length / shear
    twist = length * (1.0 + poisson) / (young * inertia)
    bend = length / (young * inertia)
    flexibility = np.block(
        [
            [length / (young * area) * axial + across * (one - axial), -0.5 * length * bend * turn],
            [0.5 * length * bend * turn, twist * axial + bend * (one - axial)],
        ]
    )
    carried = np.block([[one, -length * turn], [np.zeros((3, 3)), one]])  # rigid motion of end 2 by that of end 1
    relative = np.concatenate([-carried, np.eye(6)], axis=1)
    return relative.T @ np.linalg.inv(flexibility) @ relative


def crossing(center, along):
    """x and y where a line through a point crosses z = 0; those of the middle of `along` if it is parallel to it."""
    part = -center[2] / along[2] if abs(along[2]) > 1e-6 * np.linalg.norm(along) else 0.5
    return (center + part * along)[:2]


def bolt(mesh, name, surfaces, diameter, young, thickness=1.0):
    """The Bolt between the washers on two surfaces; young: its modulus, Pa, or None for that of the washers; thickness:
    that of a section, m, in which there is one bolt."""
    first, second = (washer(mesh, surface) for surface in surfaces)
    along = second.center - first.center
    length = float(np.linalg.norm(along))
    if length < 1e-3 * diameter:
        raise Error(f"bolt {name}: its washers {surfaces[0]} and {surfaces[1]} have one centre: name two others")
    moduli = first.moduli | second.moduli
    if young is None and len({one for one, _ in moduli}) > 1:
        raise Error(f"bolt {name}: its washers are of several materials: give its modulus, --bolt NAME=S1,S2:D:YOUNG")
    young = min(moduli)[0] if young is None else young
    motion = sparse.vstack([first.motion, second.motion]).tocsr()
    matrix = motion.T @ sparse.csr_matrix(beam(along, diameter, young, min(first.moduli)[1])) @ motion
    closing = sparse.csr_matrix(along / length) @ (first.motion[:3] - second.motion[:3])
    stiffness = young * 0.25 * np.pi * diameter**2 / (length * thickness)
    whole = sparse.csr_matrix(0.5 * (matrix + matrix.T) / thickness)
    return Bolt(name, stiffness, length, diameter, young, crossing(first.center, along), closing.tocsr(), whole)

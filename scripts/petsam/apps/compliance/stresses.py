"""Stresses of the remaining displacements on a coarse grid of points below the patch: xx, yy, zz, xy, xz, yz."""

from dataclasses import dataclass

import numpy as np

from ...core.brief import brief
from .basis import LinePatch
from .images import FLAT
from .shapes import KINDS, SHAPES
from .stiffness import dofs, elasticity, strain_matrix

COMPONENTS = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))
POINTS = 13  # number along each axis
LINE_POINTS = 49  # the same along x, and over the depth, of a section
DEPTH = 2.0  # in half widths
COLUMNS = 200  # at a time, to save memory
TRIES = 12  # number of attempts, each with a depth smaller by a fifth


@brief
@dataclass
class Grid:
    """Points x, y, z (m) and their places in the mesh."""

    x: np.ndarray
    y: np.ndarray
    z: np.ndarray
    points: np.ndarray
    place: tuple


def grid(mesh, patch, depth=None):
    """Returns the grid of the patch down to a depth that the body has everywhere; None if there is none."""
    depth = depth or DEPTH * patch.narrow
    x, y = (np.linspace(c - h, c + h, POINTS) for c, h in zip(patch.center, patch.half))
    if isinstance(patch, LinePatch):
        x, y = np.linspace(x[0], x[-1], LINE_POINTS), np.zeros(1)
    for _ in range(TRIES):
        z = np.linspace(0.0, depth, LINE_POINTS if len(y) == 1 else POINTS)
        points = np.stack(np.meshgrid(z, y, x, indexing="ij")[::-1], axis=-1).reshape(-1, 3)
        probe = points * (1.0 - 1e-9)
        probe[:, 2] += FLAT * depth
        place = mesh.locate(probe)
        if np.all(place[0] >= 0):
            return Grid(x, y, z, points, place)
        depth *= 0.8
    return None


def of_nodes(mesh, place, displacement):
    """Stress (points, 6, columns) of nodal displacements (3 nodes, columns): averages at the nodes of the stresses
    that each element's low-order Gauss points give, interpolated linearly; each material by itself."""
    block, element, local = place
    out = np.zeros((len(block), 6, displacement.shape[1]))
    materials = {(e, nu) for b in np.unique(block) for e, nu in zip(mesh.blocks[b].young, mesh.blocks[b].poisson)}
    for moduli in materials:
        nodal, weight = np.zeros((len(mesh.nodes), 6, displacement.shape[1])), np.zeros(len(mesh.nodes))
        wanted = np.zeros(len(mesh.nodes), dtype=bool)
        here = {}
        for index, one in enumerate(mesh.blocks):
            mine = (one.young == moduli[0]) & (one.poisson == moduli[1])
            here[index] = np.flatnonzero((block == index) & mine[np.where(block == index, element, 0)])
            wanted[one.nodes[element[here[index]]]] = True
        for index, one in enumerate(mesh.blocks):
            mine = (one.young == moduli[0]) & (one.poisson == moduli[1])
            chosen = np.flatnonzero(mine & np.any(wanted[one.nodes], axis=1))
            if len(chosen):
                _add_averages(mesh, index, chosen, displacement, (nodal, weight))
        nodal /= np.maximum(weight, 1e-300)[:, None, None]
        for index, one in enumerate(mesh.blocks):
            shape, points = one.shape, here[index]
            values = shape.linear.values(local[points])
            corners = one.nodes[element[points]][:, : shape.corners]
            out[points] = np.einsum("pk,pkic->pic", values, nodal[corners])
    return out


def _add_averages(mesh, index, chosen, displacement, sums):
    """Add an element's stresses at its corners, weighted by its volume."""
    nodal, weights = sums
    block = mesh.blocks[index]
    shape = SHAPES[KINDS[block.kind]]
    local, weight = shape.rule(1 if len(shape.family.nodes) == 4 else 2)
    to_corners = np.linalg.pinv(shape.linear.values(local))
    for first in range(0, len(chosen), 64):
        some = chosen[first : first + 64]
        _, size, _, gradients = mesh.volume(index, local, weight, some)
        b = strain_matrix(gradients)
        strain = np.einsum("nqik,nkc->nqic", b, displacement[dofs(block.nodes[some])])
        stress = np.einsum("nij,nqjc->nqic", elasticity(block.young[some], block.poisson[some]), strain)
        corner = np.einsum("kq,nqic->nkic", to_corners, stress)
        volume, corners = size.sum(axis=1), block.nodes[some][:, : shape.corners]
        np.add.at(nodal, corners, corner * volume[:, None, None, None])
        np.add.at(weights, corners, np.repeat(volume[:, None], shape.corners, axis=1))


def remaining(where, remainder):
    """Stress (m, 3, nz, ny, nx, 6) of the body minus the half-space's, on the Grid, by coefficients in N/m; 1/m2."""
    pieces = np.array_split(remainder.displacement, -(-remainder.fields.columns // COLUMNS), axis=1)
    found = np.concatenate([of_nodes(remainder.mesh, where.place, piece) for piece in pieces], axis=2)
    fields, cutoff = remainder.fields, remainder.cutoff
    if cutoff:
        found += _beyond(where.points, fields, cutoff)
    shape = (len(where.z), len(where.y), len(where.x), 6)
    return found.transpose(2, 0, 1).reshape(fields.patch.count, 3, *shape)


def _beyond(points, fields, cutoff):
    """Stress of (chi - 1) times the half-space's displacements: 0 near the patch."""
    out = np.zeros((len(points), 6, fields.columns))
    chi = cutoff.values(points)
    active = np.flatnonzero(chi < 1.0)
    if len(active):
        x = points[active]
        part = fields.stress(x) * (chi[active] - 1.0)[:, None, None, None]
        outer = fields.displacement(x)[:, :, None, :] * cutoff.gradients(x)[:, None, :, None]
        part += fields.stress_of(outer)
        for k, (i, j) in enumerate(COMPONENTS):
            out[active, k] = part[:, i, j]
    return out

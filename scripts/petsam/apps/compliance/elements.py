"""Linear elements raised to quadratic ones on straight edges, and the linear displacements that quadratic ones contain.

Linear elements bend and shear too stiffly: a body of a few of them across its thickness comes out 4 to 45 % too stiff.
An edge has one middle node, whichever elements share it, and keeps that of quadratic elements beside it, so that
elements of both kinds fit together.
"""

from dataclasses import replace

import numpy as np
from scipy import sparse

from .shapes import KINDS, SHAPES

RAISED = {"C3D4": "C3D10", "C3D6": "C3D15", "C3D8": "C3D20", "CPE3": "CPE6", "CPE4": "CPE8"}
INCOMPATIBLE = {"C3D8I": "C3D20"}  # bend well, but fit to no quadratic ones: raised beside those


def linear(mesh):
    """Types of the linear elements of a mesh that raised() replaces."""
    return sorted({block.kind for block in mesh.blocks if block.kind in RAISED})


def edges(mesh):
    """Ends (n, 2), the lower index first, and middle nodes (n) of the edges of quadratic elements, each once."""
    ends, middles = [np.zeros((0, 2), dtype=int)], [np.zeros(0, dtype=int)]
    for block in mesh.blocks:
        local, corners = block.shape.edges, block.shape.corners
        ends.append(np.sort(block.nodes[:, local].reshape(-1, 2), axis=1))
        middles.append(block.nodes[:, corners:].ravel())
    found, first = np.unique(np.concatenate(ends), axis=0, return_index=True)
    return found, np.concatenate(middles)[first]


def raised(mesh, every=False):
    """The mesh with quadratic elements for its linear ones, of the same numbers and faces; every: for C3D8I, too, where
    they are alone. New nodes follow the others, and have no number."""
    kinds = {**RAISED, **(INCOMPATIBLE if every or linear(mesh) else {})}
    wanted = [block for block in mesh.blocks if block.kind in kinds]
    if not wanted:
        return mesh
    local = [SHAPES[KINDS[kinds[block.kind]]].edges for block in wanted]
    ends = [np.sort(block.nodes[:, one].reshape(-1, 2), axis=1) for block, one in zip(wanted, local)]
    have, middle = edges(replace(mesh, blocks=[block for block in mesh.blocks if block.kind not in kinds]))
    every_edge, place = np.unique(np.concatenate([have, *ends]), axis=0, return_inverse=True)
    of_edge = np.full(len(every_edge), -1)
    of_edge[place.ravel()[: len(have)]] = middle
    point = every_edge[:, 0] == every_edge[:, 1]  # of elements some of whose corners are one
    of_edge[point] = every_edge[point, 0]
    new = of_edge < 0
    of_edge[new] = len(mesh.nodes) + np.arange(np.count_nonzero(new))
    nodes = np.concatenate([mesh.nodes, mesh.nodes[every_edge[new]].mean(axis=1)])
    parts = np.split(of_edge[place.ravel()[len(have) :]], np.cumsum([len(one) for one in ends])[:-1])
    more = {id(block): part.reshape(len(block.nodes), -1) for block, part in zip(wanted, parts)}
    blocks = [
        replace(block, kind=kinds[block.kind], nodes=np.concatenate([block.nodes, more[id(block)]], axis=1))
        if id(block) in more
        else block
        for block in mesh.blocks
    ]
    return replace(mesh, nodes=nodes, blocks=blocks)


def quadratic(mesh):
    """True for a mesh without linear elements, C3D8I among them."""
    return not any(block.kind in RAISED or block.kind in INCOMPATIBLE for block in mesh.blocks)


def told(given, used):
    """The message on linear elements of a given mesh, raised or kept in the used one; empty of a mesh without any."""
    kinds = linear(given)
    if not kinds:
        return ""
    if linear(used):
        return f"{', '.join(kinds)}, linear ones, which make a body too stiff: raised without --keep-elements"
    became = ", ".join(f"{block.kind} as {other.kind}" for block, other in zip(given.blocks, used.blocks)
                       if block.kind != other.kind)  # fmt: skip
    return f"{became}, of {len(used.nodes)} nodes instead of {len(given.nodes)}: --keep-elements keeps them linear"


def new_edges(mesh):
    """Ends (n, 2) and middle nodes (n) of the edges whose middles raised() has added."""
    ends, middles = edges(mesh)
    new = middles >= len(mesh.node_numbers)
    return ends[new], middles[new]


def covered(mesh, nodes):
    """Nodes, and the new middles between two of them: what is held at both ends of an edge of a linear element is held
    along it."""
    ends, middles = new_edges(mesh)
    mask = np.zeros(len(mesh.nodes), dtype=bool)
    mask[nodes] = True
    mask[middles[np.all(mask[ends], axis=1)]] = True
    return np.flatnonzero(mask)


def averages(mesh):
    """Matrix (3 nodes, 3 nodes) that makes displacements linear along edges: the middle nodes' are the means of the
    ends'; and the mask of the nodes that are no middles."""
    ends, middles = edges(mesh)
    inner = middles != ends[:, 0]
    ends, middles = ends[inner], middles[inner]
    corner = np.ones(len(mesh.nodes), dtype=bool)
    corner[middles] = False
    own = np.flatnonzero(corner)
    rows, columns = np.concatenate([own, np.repeat(middles, 2)]), np.concatenate([own, ends.ravel()])
    values = np.concatenate([np.ones(len(own)), np.full(2 * len(middles), 0.5)])
    one = sparse.csr_matrix((values, (rows, columns)), shape=2 * (len(mesh.nodes),))
    return sparse.kron(one, sparse.identity(3), format="csr"), corner

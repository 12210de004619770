"""One sparse factorization of the supported stiffness, and its solutions."""

import numpy as np
from scipy import sparse
from scipy.sparse.csgraph import connected_components
from scipy.sparse.linalg import splu

from ..errors import Error
from .stiffness import rigid_motions

LOOSE = 1e-6  # singular value of rigid motions at the supports, below which the body can move
LEAF = 60  # nodes that are not divided further


def dissection(points, adjacency):
    """Order of the nodes by nested dissection: halves by the longer side first, then the nodes between them."""
    order = []
    stack = [(np.arange(len(points)), False)]
    other = np.zeros(len(points))
    while stack:
        nodes, ready = stack.pop()
        if ready or len(nodes) <= LEAF:
            order.append(nodes)
            continue
        x = points[nodes]
        axis = np.argmax(np.ptp(x, axis=0))
        left = x[:, axis] <= np.median(x[:, axis])
        if np.all(left):
            left = x[:, axis] < np.max(x[:, axis])
        if not np.any(left):
            order.append(nodes)
            continue
        one, two = nodes[left], nodes[~left]
        other[two] = 1.0
        between = (adjacency[one] @ other) > 0.0
        other[two] = 0.0
        stack += [(one[between], True), (one[~between], False), (two, False)]  # popped in the reverse order
    return np.concatenate(order)


def need_support(nodes, adjacency, fixed):
    """Error where a connected part of the body can move as a rigid one."""
    count, part = connected_components(adjacency, directed=False)
    for i in range(count):
        mine = np.flatnonzero(part == i)
        rows = (3 * mine[:, None] + np.arange(3)).ravel()
        held = rigid_motions(nodes[mine])[fixed[rows]]
        if len(held) < 6 or np.linalg.svd(held, compute_uv=False)[-1] < LOOSE:
            x = nodes[mine].mean(axis=0)
            raise Error(
                f"{'the body' if count == 1 else f'one of {count} parts of the body'}, about x = {x[0]:.3g}, y = "
                f"{x[1]:.3g}, z = {x[2]:.3g} m of the frame, is not supported: name node sets by --fixed that hold it"
            )


class Solver:
    """K with fixed unknowns."""

    def __init__(self, matrix, nodes, fixed):
        """fixed: mask of the unknowns (3 n) that are prescribed."""
        self.matrix, self.fixed = matrix.tocsr(), fixed
        self.free = np.flatnonzero(~fixed)
        self.held = np.flatnonzero(fixed)
        count = len(nodes)
        pattern = sparse.csr_matrix((np.ones(matrix.nnz), self.matrix.indices // 3, self.matrix.indptr))
        pick = sparse.csr_matrix((np.ones(count), (np.arange(count), 3 * np.arange(count))), shape=(count, 3 * count))
        adjacency = (pick @ pattern).tocsr()
        need_support(nodes, adjacency, fixed)
        order = dissection(nodes, adjacency)
        rows = (3 * order[:, None] + np.arange(3)).ravel()
        self.rows = rows[~fixed[rows]]
        supported = self.matrix[self.rows][:, self.rows].tocsc()
        try:
            self._factor = splu(supported, permc_spec="NATURAL", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
        except (RuntimeError, MemoryError) as error:
            raise Error(
                f"the stiffness of {len(self.rows)} unknowns cannot be factorized ({error}): "
                "support the whole body by --fixed, or use a coarser mesh"
            ) from error

    def __call__(self, force, prescribed):
        """Displacements (3 n, columns): forces (3 n, columns) on free unknowns, prescribed values (held, columns)."""
        u = np.zeros_like(force)
        u[self.held] = prescribed
        u[self.rows] = self._factor.solve(np.ascontiguousarray((force - self.matrix @ u)[self.rows]))
        return u

    def reaction(self, u, force):
        """Forces (held, columns) of the supports: K u - force."""
        return (self.matrix @ u - force)[self.held]

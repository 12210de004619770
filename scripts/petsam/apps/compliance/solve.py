"""One sparse factorization of the supported stiffness, or of one that nothing holds, and its solutions."""

import numpy as np
from scipy import linalg, sparse
from scipy.sparse.csgraph import connected_components
from scipy.sparse.linalg import splu

from ...core.errors import Error
from .stiffness import rigid_motions

LOOSE = 1e-6  # singular value of rigid motions at the supports below which the body can move
FLAT = 1e-6  # relative distance by which nodes may be off a plane of symmetry
LEAF = 60  # number of nodes up to which a part is not divided further


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


def plane_normal(points):
    """Returns the unit normal of the plane through points (n, 3); None if they lie in no plane, or on a line."""
    x = points - points.mean(axis=0)
    spread, directions = np.linalg.svd(x.T @ x)[1:]
    return directions[2] if spread[2] <= FLAT**2 * spread[0] < FLAT * spread[1] else None


def free_directions(fixed, planes):
    """Returns directions (n, 3, 3) of each node as rows, and a mask (n, 3) of the free ones.

    fixed: mask (3 n) of prescribed unknowns; planes: (nodes, normal) of symmetry.
    """
    free = ~fixed.reshape(-1, 3)
    axes = np.tile(np.eye(3), (len(free), 1, 1))
    member = np.zeros((len(free), len(planes)), dtype=bool)
    for k, (nodes, _) in enumerate(planes):
        member[nodes, k] = True
    member[~np.all(free, axis=1)] = False
    for planes_of in np.unique(member, axis=0):
        normals = np.array([normal for (_, normal), is_in in zip(planes, planes_of) if is_in])
        if len(normals):
            here = np.all(member == planes_of, axis=1)
            _, size, directions = np.linalg.svd(normals)
            axes[here] = directions
            free[here] = np.arange(3) >= np.sum(size > LOOSE)
    return axes, free


def need_support(nodes, adjacency, axes, free):
    """Raises Error if a connected part of the body can move as a rigid body."""
    count, part = connected_components(adjacency, directed=False)
    for i in range(count):
        mine = np.flatnonzero(part == i)
        motions = np.einsum("nkx,nxm->nkm", axes[mine], rigid_motions(nodes[mine]).reshape(len(mine), 3, -1))
        held = motions[~free[mine]]
        if len(held) < motions.shape[2] or np.linalg.svd(held, compute_uv=False)[-1] < LOOSE:
            x = nodes[mine].mean(axis=0)
            raise Error(
                f"{'the body' if count == 1 else f'one of {count} parts of the body'}, about x = {x[0]:.3g}, y = "
                f"{x[1]:.3g}, z = {x[2]:.3g} m of the frame, is not supported: name node sets by --fixed that hold it"
            )


class Solver:
    """K with fixed unknowns, and with planes of symmetry."""

    def __init__(self, matrix, nodes, fixed, planes=()):
        """fixed: mask of the unknowns (3 n) that are prescribed; planes: (nodes, normal) that nodes do not leave."""
        self.matrix, self.fixed = matrix.tocsr(), fixed
        self.held = np.flatnonzero(fixed)
        count = len(nodes)
        pattern = sparse.csr_matrix((np.ones(matrix.nnz), self.matrix.indices // 3, self.matrix.indptr))
        pick = sparse.csr_matrix((np.ones(count), (np.arange(count), 3 * np.arange(count))), shape=(count, 3 * count))
        adjacency = (pick @ pattern).tocsr()
        axes, free = free_directions(fixed, planes)
        need_support(nodes, adjacency, axes, free)
        order = dissection(nodes, adjacency)
        node, which = (part.ravel() for part in np.broadcast_arrays(order[:, None], np.arange(3)))
        node, which = node[free[node, which]], which[free[node, which]]
        rows, columns = 3 * node[:, None] + np.arange(3), np.tile(np.arange(len(node))[:, None], (1, 3))
        moved = (axes[node, which].ravel(), (rows.ravel(), columns.ravel()))
        self.moves = sparse.csr_matrix(moved, shape=(3 * count, len(node)))  # displacements by the free unknowns
        self.moves.eliminate_zeros()
        supported = (self.moves.T @ self.matrix @ self.moves).tocsc()
        try:
            self.factor = splu(supported, permc_spec="NATURAL", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
        except (RuntimeError, MemoryError) as error:
            raise Error(
                f"the stiffness of {len(node)} unknowns cannot be factorized ({error}): "
                "support the whole body by --fixed, or use a coarser mesh"
            ) from error

    def inverse(self, force):
        """Values of the free unknowns by forces on them."""
        return self.factor.solve(force)

    def freed(self, among):
        """Displacements (3 n) by the unknowns, as columns, that may move without all of the body moving rigidly; among:
        mask of the unknowns that may be held against that where nothing else is."""
        return self.moves.tocsc()

    def balanced(self, force):
        """The forces (3 n, columns) that deform the body."""
        return force

    def __call__(self, force, prescribed):
        """Displacements (3 n, columns): forces (3 n, columns) on free unknowns, prescribed values (held, columns)."""
        u = np.zeros_like(force)
        u[self.held] = prescribed
        return u + self.moves @ self.inverse(self.moves.T @ (force - self.matrix @ u))

    def reaction(self, u, force):
        """Forces (held, columns) of the supports: K u - force."""
        return (self.matrix @ u - force)[self.held]


def isostatic(motions):
    """As many unknowns (of 3 n) as there are motions (3 n, 6), of a section (3 n, 4), that hold a body which moves by
    these: those that bear least."""
    return linalg.qr(motions.T, mode="r", pivoting=True)[1][: motions.shape[1]]


class Floating(Solver):
    """K of bodies that are joined to each other, and held by nothing: inertia relief.

    With R, the rigid motions of unit modal mass, and A = 1 - M R R', forces f give the displacements A' C A f, C being
    the inverse of K with an isostatic hold, whichever. That is the sum over all elastic modes; the inertia of the
    motions R balances f.
    """

    def __init__(self, matrix, nodes, mass, hold=None):
        """hold: as many unknowns as rigid motions; None: those of isostatic()."""
        motions = rigid_motions(nodes)
        fixed = np.zeros(len(motions), dtype=bool)
        fixed[isostatic(motions) if hold is None else hold] = True
        super().__init__(matrix, nodes, fixed)
        self.isostatic, self.motions = self.moves, motions
        self.moves = sparse.identity(len(motions), format="csr")
        self.fixed, self.held = np.zeros_like(fixed), np.zeros(0, dtype=int)
        gram = motions.T @ (mass @ motions)
        self.rigid = linalg.solve_triangular(np.linalg.cholesky(gram), motions.T, lower=True).T
        self.inertia = mass @ self.rigid

    def freed(self, among):
        """All but as many unknowns as hold the bodies, in the order of the factorization."""
        kept = np.ones(len(among), dtype=bool)
        kept[np.flatnonzero(among)[isostatic(self.motions[among])]] = False
        order = self.isostatic.tocsc().indices
        order = np.concatenate([order, np.setdiff1d(np.arange(len(among)), order)])
        return sparse.identity(len(among), format="csc")[:, order[kept[order]]]

    def balanced(self, force):
        """A f: with the inertia of the rigid motions, in equilibrium."""
        return force - self.inertia @ (self.rigid.T @ force)

    def inverse(self, force):
        """A' C A f."""
        u = self.isostatic @ self.factor.solve(self.isostatic.T @ self.balanced(force))
        return u - self.rigid @ (self.inertia.T @ u)

    def rigid_frequencies(self):
        """Angular frequencies (6; of a section 4) of the rigid motions, rising: 0 to rounding."""
        return np.sort(np.sqrt(np.abs(linalg.eigvalsh(self.rigid.T @ (self.matrix @ self.rigid)))))

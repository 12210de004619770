"""The error of a compliance by its mesh, from what its displacements lose without their quadratic part.

The displacements that are linear along all edges are a part of those of quadratic elements. With e the difference of
the displacements w from the best ones among them, e'Ke is what linear elements lack of the compliance D. What quadratic
ones lack is a part of that, by meshes that were refined: in 30 of blocks and sections, of bricks, quadrilaterals and
wedges 1/2.8 of it at most, of tetrahedra and triangles, which lack more as linear ones, 1/7; in the median a half and a
third of these. Linear elements that are kept lack the difference to quadratic ones, too.
"""

import numpy as np
from scipy.sparse.linalg import splu

from .checks import pressure_coefficients
from .elements import averages

PART, PART_OF_SIMPLEX = 1 / 2.5, 1 / 6  # of what linear elements lack that quadratic ones do at most
SIMPLEX = ("C3D10", "CPE6")


def lacking(mesh, solver, w):
    """The compliance, (columns, columns), that linear elements lack, by the displacements w (3 nodes, columns)."""
    average, corner = averages(mesh)
    of_corners = np.repeat(corner, 3)
    moves = solver.freed(of_corners)
    allowed = (moves @ moves.T).tocsr()
    coarse = (allowed @ average @ moves[:, of_corners[moves.indices[moves.indptr[:-1]]]]).tocsr()
    rest = allowed @ (w - average @ w)
    matrix = (coarse.T @ solver.matrix @ coarse).tocsc()
    factor = splu(matrix, permc_spec="NATURAL", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    e = rest - coarse @ factor.solve(coarse.T @ (solver.matrix @ rest))
    return e.T @ (solver.matrix @ e)


def missed(mesh, solver, w):
    """An estimate of what a mesh of quadratic elements lacks of the compliance, rather too large."""
    part = PART_OF_SIMPLEX if all(block.kind in SIMPLEX for block in mesh.blocks) else PART
    return part * lacking(mesh, solver, w)


def relative(patch, missing, compliance):
    """The largest part that is missing: of the compliance as a matrix, and of its displacements by Hertz's pressure and
    by such a shear in x and in y."""
    c = pressure_coefficients(patch).reshape(-1, 3)
    parts = [np.linalg.norm(missing, 2) / np.linalg.norm(compliance, 2)]
    for turn in range(3):
        load = np.roll(c, turn, axis=1).ravel()
        parts.append(np.linalg.norm(missing @ load) / max(np.linalg.norm(compliance @ load), 1e-300))
    return float(max(parts))

"""Several patches of a pair in one plane: what the traction on one does to another.

The functions of all patches are one basis of the method of images, so that D has blocks D_PQ of each two of them. A
contact of petsam knows the half-space inside its own patch only; between two patches its field is added:

    D_PQ = <phi_i, w_j> + <phi_i, K_half-space phi_j>     i on P, j on Q

A step of a contact takes what other patches do to it as rigid motions and load cases. With L L' the half-space's
stiffness on the polynomials of a patch, the compliance of the half-space is 1 in L' D L. Of its rows of P, without P's
own columns and without the rigid motions, the singular vectors are the load cases of P, as many as have singular values
above FAR, at most MOST with the others. The rest of D_PQ is left out.
"""

import numpy as np
from scipy import linalg

from ...core.errors import Error
from . import rigid
from .cases import Case
from .halfspace import points_needed
from .result import Compliance

FAR = 1e-3  # smallest singular value, relative to the half-space
NAME = "far"  # of the load cases, with a number
MOST = 64  # load cases of a patch that petsam reads
UNIT = "m/J^0.5"  # of them at factor 1, the factor being in J^0.5
TOO_MUCH = 3.0  # what is left out, over FAR, that is warned of
NEAREST = 0.05  # least distance of two patches, in half widths


def _gaps(one, other):
    """Distances of two patches along x and y; below 0 where they overlap along it."""
    return np.abs(np.subtract(one.center, other.center)) - one.half - other.half


def need_apart(patches):
    """Raises Error unless the patches are apart."""
    for k, one in enumerate(patches):
        for number, other in enumerate(patches[:k], 1):
            gaps = _gaps(one, other)
            nearest = NEAREST * min(*one.half, *other.half)
            if np.max(gaps) < nearest:
                raise Error(
                    f"patches {number} and {k + 1} are {max(np.max(gaps), 0.0):.3g} m apart, limit {nearest:.3g} m: "
                    "use smaller ones, move them by --center, or take one for both"
                )


def between(sides, patches):
    """The half-spaces' part of D (3 m, 3 m) between patches, m3/N; 0 within each."""
    ends = np.cumsum([0] + [3 * patch.count for patch in patches])
    found = np.zeros((ends[-1], ends[-1]))
    for q, source in enumerate(patches):
        columns = slice(ends[q], ends[q + 1])
        for p, patch in enumerate(patches):
            if p == q:
                continue
            apart = np.linalg.norm(np.maximum(_gaps(patch, source), 0.0)) / patch.half
            counts = points_needed(apart[None], patch.largest)[0]
            points, weights = patch.quadrature(*counts)
            place = np.column_stack([points, np.zeros(len(points))])
            moved = sum(sign * side.fields.fields[q].displacement(place) for side, sign in zip(sides, (1, -1)))
            weighted = patch.values(*points.T).T * weights
            block = np.einsum("ip,pdc->idc", weighted, moved)
            found[ends[p] : ends[p + 1], columns] = block.reshape(-1, 3 * source.count)
    return found


def joined(bodies, matrix):
    """The Compliance of the Bodies of several patches, to which it adds load cases; matrix: D of all, symmetric."""
    root = linalg.block_diag(*(body.definite.root for body in bodies))
    left = root.T @ matrix @ root
    least = float(1.0 + min(0.0, linalg.eigvalsh(left)[0]))
    if not least > 0.0:
        raise Error(
            f"the compliance of all patches together is not positive: smallest eigenvalue {least:.3g} relative to the "
            "half-space: use a higher --degree, or smaller patches"
        )
    ends = np.cumsum([0] + [3 * body.patch.count for body in bodies])
    parts = [slice(*one) for one in zip(ends, ends[1:])]
    for part in parts:
        left[part, part] = 0.0  # is each contact's own
    spans = [_span(body, left[part]) for body, part in zip(bodies, parts)]
    every = linalg.block_diag(*spans)
    inverse = linalg.pinv(every)
    coupling = inverse @ left @ inverse.T
    missed = float(np.linalg.norm(left - every @ coupling @ every.T, 2))
    if missed > TOO_MUCH * FAR:
        bodies[0].remarks.append(
            f"warning: the load cases of the other patches miss {missed:.1e} of the half-space's compliance, as a "
            f"patch has at most {MOST} with bolts and modes: use fewer --modes, or patches that are farther apart"
        )
    sign, first = np.ones(len(coupling)), 0
    for body, span in zip(bodies, spans):
        own = slice(first, first + 6)
        coupling[own, own] = rigid.compliance(body)
        sign[own] = -1.0  # a displacement of body 1 is subtracted from that of body 2, as its load from the traction's
        first += span.shape[1]
    return Compliance(bodies, coupling * np.outer(sign, sign), missed, least)


def _span(body, rows):
    """The rigid motions (6) and the load cases that the other patches cause on a patch, as columns; adds the cases to
    the Body. The rows are those of L' D L without the patch's own columns."""
    motions = rigid.motions(body.patch).reshape(6, -1) @ body.definite.root
    whole = linalg.orth(motions.T)
    u, values, _ = linalg.svd(rows - whole @ (whole.T @ rows))
    kept = u[:, values > FAR][:, : MOST - len(body.cases)]
    fields = linalg.solve_triangular(body.definite.root, kept, trans="T", lower=True)
    for k, field in enumerate(fields.T, 1):
        body.cases[f"{NAME}{k}"] = Case(field.reshape(-1, 3), 0.0, None, UNIT)
    return np.concatenate([motions.T, kept], axis=1)

"""Compliance of a body that lies in the half-space z >= 0, has one material, and whose surface z = 0 is free outside of
the patch: the half-space's fields, taken back on all other surfaces.

u_j is the half-space's field of the traction phi_j. w_j = u - u_j is smooth near the patch and free of traction on it;
it feels the traction -T_j on free sides and the displacement -u_j on supported ones. By Betti's theorem the compliance
needs no displacement of the patch:

    D_ij = int_supported T_i.u_j - int_free T_j.u_i + w_i.f_j - R_i.g_j
    f_j = -int_free N' T_j     g_j = -u_j at supported nodes     R_i = K w_i - f_i there

The last two terms are an energy, whose error is the square of that of w.
"""

import numpy as np

from .mesh import some
from .remainder import Remainder, scatter

ORDER = 5  # Gauss points along the side of a face
POINTS = 3000  # number of points processed at a time
FLAT = 1e-6  # relative to the patch; nodes nearer to its plane lie in it


def in_plane(mesh, faces, tolerance):
    """Returns a mask of the faces that lie in z = 0."""
    return np.all(np.abs(mesh.nodes[faces.nodes][..., 2]) <= tolerance, axis=1)


def other_faces(mesh, patch, supported):
    """Returns the faces outside of the patch's plane, as (faces, mask of supported ones)."""
    tolerance = FLAT * max(patch.half)
    held = np.zeros(len(mesh.nodes), dtype=bool)
    held[supported] = True
    for group in mesh.boundary():
        beside = ~in_plane(mesh, group, tolerance)
        fixed = np.all(held[group.nodes], axis=1)
        for wanted in (True, False):
            chosen = some(group, (fixed == wanted) & (fixed | beside))
            if len(chosen.elements):
                yield chosen, wanted


def pieces(faces):
    """Returns the faces divided into pieces with about POINTS Gauss points."""
    stride = max(1, POINTS // ORDER**2)
    for first in range(0, len(faces.elements), stride):
        mask = np.zeros(len(faces.elements), dtype=bool)
        mask[first : first + stride] = True
        yield some(faces, mask)


def solved(mesh, fields, solver, supported, progress=lambda text: None):
    """Returns the Remainder of a body; supported: its supported nodes."""
    patch, columns = fields.patch, fields.columns
    force, support = (np.zeros((3 * len(mesh.nodes), columns)) for _ in range(2))
    compliance = np.zeros((columns, columns))
    groups = list(other_faces(mesh, patch, supported))
    total = sum(len(faces.elements) for faces, _ in groups)
    done = 0
    for faces, fixed in groups:
        for piece in pieces(faces):
            gauss = mesh.gauss(piece, ORDER)
            x, area = gauss.x.reshape(-1, 3), gauss.area.reshape(-1, 3)
            u = fields.displacement(x).reshape(-1, columns)
            traction = np.einsum("pikc,pk->pic", fields.stress(x), area)
            nodal = np.einsum("qk,nqic->nkic", gauss.values, traction.reshape(*gauss.x.shape, columns))
            if fixed:
                compliance += traction.reshape(-1, columns).T @ u
                scatter(support, piece.nodes, nodal)
            else:
                compliance -= u.T @ traction.reshape(-1, columns)
                scatter(force, piece.nodes, -nodal)
            done += len(piece.elements)
            progress(f"half-space fields on {done} of {total} faces")
    progress(f"{columns} solutions")
    prescribed = -fields.displacement(mesh.nodes[supported]).reshape(-1, columns)
    w = solver(force, prescribed)
    reaction = solver.reaction(w, force)
    compliance += w.T @ force - reaction.T @ prescribed
    return Remainder(mesh, fields, compliance, w, reaction + support[solver.held])

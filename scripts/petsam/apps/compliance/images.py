"""Compliance of a body that lies in the half-space z >= 0, has one material, and whose surface z = 0 is free outside of
the patch: the half-space's fields, taken back on all other surfaces.

u_j is the half-space's field of the traction phi_j. w_j = u - u_j is smooth near the patch and free of traction on it;
it feels the traction -T_j on free sides and the displacement -u_j on supported ones. By Betti's theorem the compliance
needs no displacement of the patch:

    D_ij = int_supported T_i.u_j - int_free T_j.u_i + w_i.f_j - R_i.g_j
    f_j = -int_free N' T_j     g_j = -u_j at supported nodes     R_i = K w_i - f_i there

The last two terms are an energy, whose error is the square of that of w.

The two bodies of a pair lie on either side of z = 0 and bear phi_j (z >= 0) and -phi_j (z <= 0). Each has its own
half-space's u_j, supports and free sides. Bolts between them, of stiffness K_r, take part in K and feel u_j at the
nodes: f_j contains -K_r u_j, and D_ij contains -u_i.K_r u_j, as

    D_ij = <phi_i, w_j> = a(u_i, w_j) - int T_i.w_j     a(w_j, u_i) = f_j.u_i + R_j.u_i - w_j.K_r u_i

by the half-space's equilibrium and that of w_j, where <phi_i, w> is that of w on body 2 minus w on body 1.
"""

import numpy as np

from ...core.progress import Progress
from .mesh import some
from .remainder import Remainder, half_space, scatter

ORDER = 5  # Gauss points along the side of a face
POINTS = 3000  # number of points processed at a time
FLAT = 1e-6  # relative to the patch; nodes nearer to its plane lie in it


def in_plane(mesh, faces, tolerance):
    """Returns a mask of the faces that lie in z = 0."""
    return np.all(np.abs(mesh.nodes[faces.nodes][..., 2]) <= tolerance, axis=1)


def other_faces(mesh, patch, supported):
    """Returns the faces outside of the patch's plane, as (faces, mask of supported ones)."""
    tolerance = FLAT * patch.wide
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


def solved(sides, solver, supported, progress=None, tie=None):
    """Returns the Remainder of the bodies on some Sides; supported: supported nodes; tie: stiffness of the bolts."""
    columns = sides[0].fields.columns
    force, support = (np.zeros((3 * len(sides[0].mesh.nodes), columns)) for _ in range(2))
    compliance = np.zeros((columns, columns))
    groups = [(side, *group) for side in sides for group in other_faces(side.mesh, side.fields.patch, supported)]
    total = sum(len(faces.elements) for _, faces, _ in groups)
    done, progress = 0, progress or Progress("face", None)
    progress.begin("half-space fields", "half-space fields on {} of {} faces")
    for side, faces, fixed in groups:
        for piece in pieces(faces):
            u, traction, nodal = _on_faces(side, piece)
            if fixed:
                compliance += traction.T @ u
                scatter(support, piece.nodes, nodal)
            else:
                compliance -= u.T @ traction
                scatter(force, piece.nodes, -nodal)
            done += len(piece.elements)
            progress(done, total)
    if tie is not None:
        nodes = np.unique(tie.indices // 3)
        rows = (3 * nodes[:, None] + np.arange(3)).ravel()
        u = half_space(sides, nodes).reshape(-1, columns)
        pull = tie[rows][:, rows] @ u
        force[rows] -= pull
        compliance -= u.T @ pull
    progress.begin(f"{columns} solutions")
    prescribed = -half_space(sides, supported).reshape(-1, columns)
    w = solver(force, prescribed)
    reaction = solver.reaction(w, force)
    compliance += w.T @ force - reaction.T @ prescribed
    return Remainder(sides, compliance, w, reaction + support[solver.held])


def _on_faces(side, faces):
    """Half-space displacements and tractions times areas (3 points, columns) on faces, and nodal forces of these."""
    gauss = side.mesh.gauss(faces, ORDER)
    x, area = gauss.x.reshape(-1, 3), gauss.area.reshape(-1, 3)
    columns = side.fields.columns
    u = side.fields.displacement(x).reshape(-1, columns)
    traction = np.einsum("pikc,pk->pic", side.fields.stress(x), area)
    nodal = np.einsum("qk,nqic->nkic", gauss.values, traction.reshape(*gauss.x.shape, columns))
    return u, traction.reshape(-1, columns), nodal

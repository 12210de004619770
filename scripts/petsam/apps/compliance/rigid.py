"""The part of a pair's compliance that moves one body as a whole against the other.

A body that only bolts hold moves far more as a whole than it deforms, and a contact that is solved at given
displacements would be ill-conditioned. With the motions Q of body 1, in the order d_z, d_x, d_y, r_x, r_y, r_z, the
half-space's compliance G^-1 on the polynomials and D beyond it,

    b = (Q'(D + G^-1)^-1 Q)^-1 - (Q' G Q)^-1

is what the structure adds to the compliance of a rigid motion. D - Q b Q' is positive with the half-space, as D is.
"""

import numpy as np
from scipy import linalg

from .basis import LinePatch

COMPONENTS = ("disp_z", "disp_x", "disp_y", "rot_x", "rot_y", "rot_z")


def motions(patch):
    """Coefficients (6, m, 3) of the displacement of body 1 by a unit of each component, in body 2's frame and about
    the patch's centre; zeros where the polynomials do not have it, and of a section's rotations out of its plane."""
    points, weight = patch.quadrature(patch.largest[0] + 2, patch.largest[1] + 2)
    values, (x, y), zero = patch.values(*points.T), (points - patch.center).T, np.zeros(len(points))
    one = zero + 1.0
    fields = [(zero, zero, one), (one, zero, zero), (zero, one, zero), (zero, zero, -y), (zero, zero, x)]
    if not isinstance(patch, LinePatch):  # sections turn in their plane alone
        fields.append((-y, x, zero))
    found = np.zeros((6, patch.count, 3))
    for k, field in enumerate(fields):
        field = np.stack(field, axis=1)
        coefficients = values.T @ (weight[:, None] * field)
        if np.allclose(values @ coefficients, field, rtol=1e-9, atol=1e-9 * np.abs(field).max()):
            found[k] = coefficients
    return found


def compliance(body):
    """b (6, 6), m/N, rad/N, ...: the displacement of body 1 against body 2 by loads on it, beyond the half-spaces."""
    q = motions(body.patch).reshape(6, -1)
    has = np.flatnonzero(np.any(q, axis=1))
    q = q[has]
    gram = body.definite.root @ body.definite.root.T
    whole = 0.5 * (body.compliance + body.compliance.T) + linalg.inv(gram)
    scale = 1.0 / np.sqrt(np.einsum("ij,jk,ik->i", q, gram, q))  # for the units of the components
    q = q * scale[:, None]
    b = linalg.inv(q @ linalg.solve(whole, q.T, assume_a="pos")) - linalg.inv(q @ gram @ q.T)
    values, vectors = linalg.eigh(0.5 * (b + b.T))
    b = (vectors * np.maximum(values, 0.0)) @ vectors.T * np.outer(scale, scale)
    found = np.zeros((6, 6))
    found[np.ix_(has, has)] = b
    return found

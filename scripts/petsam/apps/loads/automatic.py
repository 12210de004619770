"""The frame of a patch by its forces: --frame auto, and z of a frame without one."""

import numpy as np

from ...core.errors import Unusable
from ...core.frames import Frame

FLAT = 0.2  # thickness of the nodes over their second extent, up to which they have a plane


def pressing(forces, nodes, sign):
    """Direction into body 2, by the pressure's part of the forces at the largest resultant, or where that is not known,
    by the plane of the nodes; and a text that says by which."""
    if forces.normal is not None:
        total = sign * forces.normal[:, nodes].sum(axis=1)
        largest = total[np.argmax(np.linalg.norm(total, axis=1))]
        if np.any(largest):
            return largest / np.linalg.norm(largest), "by the sum of the normal forces"
    total = sign * forces.force[:, nodes].sum(axis=1)
    largest = total[np.argmax(np.linalg.norm(total, axis=1))]
    x = forces.start[nodes]
    _, extents, axes = np.linalg.svd(x - x.mean(axis=0), full_matrices=False) if len(nodes) > 2 else (0, [0, 0, 0], 0)
    if not extents[1] > 1e-6 * max(extents[0], 1e-300) or extents[2] > FLAT * extents[1]:
        raise Unusable(
            "--frame: its z does not follow from the nodes, which are not in a plane, nor from CNORMF: give ORIGIN:X:Z"
        )
    z = axes[2]
    if not abs(z @ largest) > 0.0:
        raise Unusable("--frame: the forces do not press on the plane of the nodes: give ORIGIN:X:Z")
    return z * np.sign(z @ largest), "by the plane of the nodes"


def of(forces, nodes, sign):
    """The Frame: origin at the mean place of the pressing forces in the row of the largest N, x along the largest
    extent of the nodes; and a text about z."""
    z, by = pressing(forces, nodes, sign)
    force = sign * forces.force[:, nodes] @ z
    row = int(np.argmax(force.sum(axis=1)))
    x = forces.start[nodes] if forces.x.ndim == 2 else forces.x[row, nodes]
    weight = np.maximum(force[row], 0.0)
    origin = weight @ x / weight.sum()
    spread = x - x.mean(axis=0)
    spread = spread - np.outer(spread @ z, z)
    values, vectors = np.linalg.eigh(spread.T @ spread)
    along = None
    if values[-1] > 0.0:
        along = vectors[:, -1] - (vectors[:, -1] @ z) * z
        along = along * np.sign(along[np.argmax(np.abs(along))])
    return Frame.of(origin, along, z, -z), by


def given(forces, frame, nodes, sign):
    """The Frame of an origin and, if given, x and z, in the model's coordinates and unit; and a text about z."""
    origin, x, z = (list(frame) + [None, None])[:3]
    by = ""
    if z is None:
        z, by = pressing(forces, nodes, sign)
    z = np.asarray(z, dtype=float)
    size = np.linalg.norm(z)
    if not size > 0.0:
        raise Unusable("--frame: its z is 0: give a direction into body 2")
    return Frame.of(np.asarray(origin, dtype=float) * forces.length, x, z, -z / size), by


def written(frame: Frame, length: float) -> str:
    """A frame as --frame has it, in the model's unit of length (m)."""

    def point(values):
        return ",".join(f"{value + 0.0:.9g}" for value in np.where(np.abs(values) < 1e-15, 0.0, values))

    return ":".join((point(frame.origin / length), point(frame.axes[0]), point(frame.axes[2])))

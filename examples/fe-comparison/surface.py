"""Tractions on the contact surface from what CalculiX prints for a deck of model.py.

The forces on the surface's nodes are those that balance the stresses of the elements beside it: the sum of
w det(J) B^T sigma over the integration points. So they carry the load exactly and know nothing of how contact is
modelled. Divided by the area that belongs to each node they are pressure and shear. (CalculiX's own nodal pressure,
CPRESS in the result file, is extrapolated from integration points; in elements that the contact's edge crosses it is
far off.)
"""

from typing import NamedTuple

import numpy as np

SAMPLES = 16  # a side of a face, for areas of contact and means of closed solutions

# corners of the hexahedron, its integration points in CalculiX's order
CORNERS = np.array([[-1, -1, -1], [1, -1, -1], [1, 1, -1], [-1, 1, -1], [-1, -1, 1], [1, -1, 1], [1, 1, 1], [-1, 1, 1]])
POINTS = np.array([[x, y, z] for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)]) / np.sqrt(3.0)


class Surface(NamedTuple):
    """The contact surface in SI units: of nodes x, y (m), area (m2), pressure, shear_x, shear_y, cpress (Pa); of faces
    samples.

    sample_r (m), sample_area (m2) and sample_gap (m) have shape (faces, samples), weights (samples, 4), face_nodes
    (faces, 4) counts in the nodes. load_n, load_tx (N) are the reactions of the whole top.
    """

    x: np.ndarray
    y: np.ndarray
    area: np.ndarray
    pressure: np.ndarray
    shear_x: np.ndarray
    shear_y: np.ndarray
    cpress: np.ndarray
    face_nodes: np.ndarray
    weights: np.ndarray
    sample_r: np.ndarray
    sample_area: np.ndarray
    sample_gap: np.ndarray
    load_n: float
    load_tx: float

    @property
    def r(self):
        """Radius of the nodes, m."""
        return np.hypot(self.x, self.y)

    def contact_radius(self, share):
        """Radius, m, of the disc with the area where the bodies overlap; share: of the surface in the model."""
        return float(np.sqrt(np.sum(self.sample_area[self.sample_gap < 0.0]) / (share * np.pi)))

    def nodal_mean(self, function):
        """Mean of function(r) over each node's area, as the nodal pressure is one."""
        return (
            gather(self.face_nodes, self.sample_area * function(self.sample_r), self.weights, self.x.size) / self.area
        )


def gather(face_nodes, values, weights, count):
    """Sum over faces and samples of values times the nodes' shape functions."""
    return np.bincount(face_nodes.ravel(), weights=(values @ weights).ravel(), minlength=count)


def read_dat(path, nodes, stresses):
    """Displacements (mm) and stresses (MPa; xx, yy, zz, xy, xz, yz) of the last step, and the top's reaction (N).

    Fills nodes (nodes, 3) and stresses (elements, 8, 6); what is not printed stays.
    """
    reaction, kind = None, None
    with open(path, encoding="ascii") as file:
        for line in file:
            words = line.split()
            if not words:
                continue
            if words[0] in ("total", "displacements", "stresses"):
                kind = words[0]
            elif kind == "total":
                reaction = np.array([float(word) for word in words])
            elif kind == "displacements":
                nodes[int(words[0]) - 1] = [float(word) for word in words[1:]]
            elif kind == "stresses":
                stresses[int(words[0]) - 1, int(words[1]) - 1] = [float(word) for word in words[2:8]]
    if reaction is None or not np.all(np.isfinite(reaction)):
        raise ValueError(path + ": no reaction: CalculiX did not finish")
    return reaction


def read_cpress(path, count):
    """CPRESS, MPa, of the first count nodes from a result file; 0 where there is none."""
    pressure, inside = np.zeros(count), False
    with open(path, encoding="ascii") as file:
        for line in file:
            if line.startswith(" -4"):
                inside = line.split()[1] == "CONTACT"
            elif inside and line.startswith(" -1") and int(line[3:13]) <= count:
                pressure[int(line[3:13]) - 1] = float(line[49:61])
    return pressure


def shape_gradients():
    """Derivatives of the hexahedron's shape functions by the local coordinates: (integration point, node, 3)."""
    factors = 1.0 + POINTS[:, None, :] * CORNERS  # (point, node, axis)
    return 0.125 * np.stack([CORNERS[:, a] * np.prod(np.delete(factors, a, axis=2), axis=2) for a in range(3)], axis=2)


def nodal_forces(nodes, elements, stresses):
    """Forces (N), shape (nodes, 3), that balance the stresses (MPa) of these elements."""
    xx, yy, zz, xy, xz, yz = np.moveaxis(stresses, -1, 0)
    sigma = np.stack([np.stack([xx, xy, xz], -1), np.stack([xy, yy, yz], -1), np.stack([xz, yz, zz], -1)], -2)
    local = shape_gradients()
    jacobian = np.einsum("pni,enj->epij", local, nodes[elements])
    gradient = np.einsum("epij,pnj->epni", np.linalg.inv(jacobian), local)
    force = np.einsum("ep,epni,epij->enj", np.linalg.det(jacobian), gradient, sigma)
    result = np.zeros_like(nodes)
    np.add.at(result, elements, force)
    return result


def read_surface(base, mesh, elements, parts, nlgeom=False, lower=False):
    """The Surface of base.dat and base.frd; elements: model.rim(); parts: models in the whole, 4 or 2.

    lower: the mirror image of the mesh is the other body, instead of the plane z = 0.
    """
    count = len(mesh.nodes)
    moved, stresses = np.zeros((2 * count, 3)), np.zeros((len(mesh.elements), 8, 6))
    reaction = read_dat(base + ".dat", moved, stresses)
    place = mesh.nodes + moved[:count] if nlgeom else mesh.nodes
    force = nodal_forces(place, mesh.elements[elements], stresses[elements])
    gap = mesh.nodes[:, 2] + moved[:count, 2]
    if lower:
        gap = gap + mesh.nodes[:, 2] - moved[count:, 2]

    middle = (np.arange(SAMPLES) + 0.5) / SAMPLES
    s, t = (v.ravel() for v in np.meshgrid(middle, middle))
    weights = np.stack([(1 - s) * (1 - t), s * (1 - t), s * t, (1 - s) * t], axis=1)
    used, face_nodes = np.unique(mesh.face_nodes, return_inverse=True)
    face_nodes = face_nodes.reshape(-1, 4)
    x, y = (1e-3 * place[used, axis] for axis in (0, 1))
    corners = np.stack([x[face_nodes], y[face_nodes]], axis=-1)
    (ax, ay), (bx, by) = ((corners[:, j] - corners[:, i]).T for i, j in ((0, 2), (1, 3)))
    sample_area = np.repeat(
        0.5 * np.abs(ax * by - ay * bx)[:, None] / len(s), len(s), axis=1
    )  # onto the plane of contact
    area = gather(face_nodes, sample_area, weights, used.size)
    traction = force[used] / area[:, None]
    return Surface(
        x,
        y,
        area,
        traction[:, 2],
        -traction[:, 0],
        -traction[:, 1],
        1e6 * read_cpress(base + ".frd", count)[used],
        face_nodes,
        weights,
        np.hypot(x[face_nodes] @ weights.T, y[face_nodes] @ weights.T),
        sample_area,
        1e-3 * gap[used][face_nodes] @ weights.T,
        -parts * reaction[2],
        parts * reaction[0],
    )

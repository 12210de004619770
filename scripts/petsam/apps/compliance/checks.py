"""Checks of a body before and after its compliance is computed."""

import numpy as np
from scipy import linalg

from ...core.errors import Error
from . import basis, halfplane, images
from .halfspace import cell_compliance, opposite

CELLS = 20  # least number of cells per side of the patch for which the definiteness is examined
PER_DEGREE = 2  # and by the degree along that side, of which they must tell the polynomials apart
ASYMMETRY = 1e-4  # largest relative asymmetry of D
CLEARANCE = 0.25  # least distance from the patch to another surface, in half widths
COARSEST = 1.3  # largest element at the nearest edge, in clearances
FLATNESS = 1e-2  # largest deviation of the surface from its plane, in half widths; more is curved
CURVED = 0.1  # largest deviation of a curved surface
INSIDE = 17  # points along a side of the patch, all of which must lie on the contact surface


def deviation(mesh, patch, contact):
    """Largest distance of the contact surface's nodes in the patch from its plane, in half widths."""
    nodes = np.unique(np.concatenate([group.nodes.ravel() for group in contact]))
    x = mesh.nodes[nodes]
    inside = np.all(np.abs(x[:, :2] - patch.center) <= 1.001 * np.array(patch.half), axis=1)
    off = np.abs(x[inside, 2]) if np.any(inside) else np.array([np.min(np.abs(x[:, 2]))])
    return float(np.max(off)) / patch.narrow


def need_plane(mesh, patch, contact):
    """Returns true if the surface counts as plane; raises Error if it is not even nearly plane."""
    off = deviation(mesh, patch, contact)
    if off > CURVED:
        raise Error(
            f"the contact surface is up to {off * patch.narrow:.3g} m off the plane of the frame, limit "
            f"{CURVED * patch.narrow:.3g} m: correct --frame, or use a smaller --patch, beside corners by --center"
        )
    return off <= FLATNESS


def need_inside(mesh, patch, contact):
    """Raises Error if a part of the patch is not on the contact surface."""
    if isinstance(patch, basis.LinePatch):
        _need_inside_line(mesh, patch, contact)
        return
    ends = [np.linspace(c - h, c + h, INSIDE) for c, h in zip(patch.center, patch.half)]
    points = np.stack(np.meshgrid(*ends), axis=-1).reshape(-1, 2)
    found = np.zeros(len(points), dtype=bool)
    slack = 1e-6 * patch.narrow
    for group in contact:
        count = mesh.blocks[group.block].shape.face_corners(group.local)
        polygons = mesh.nodes[group.nodes[:, :count], :2]
        following = np.roll(polygons, -1, axis=1)
        edges = following - polygons
        area = np.sum(polygons[..., 0] * following[..., 1] - polygons[..., 1] * following[..., 0], axis=1)
        lengths = np.linalg.norm(edges, axis=2)
        away = points[:, None, None, :] - polygons
        side = (edges[..., 0] * away[..., 1] - edges[..., 1] * away[..., 0]) * np.sign(area)[None, :, None]
        found |= np.any(np.all(side >= -slack * lengths, axis=2), axis=1)
    if not np.all(found):
        raise Error(
            "the patch is not inside the contact surface: x = {:.6g} m, y = {:.6g} m of the frame is not on it: use a "
            "smaller --patch, move it by --center, or correct --frame".format(*points[np.flatnonzero(~found)[0]])
        )


def _need_inside_line(mesh, patch, contact):
    """The same of the patch of a section."""
    points = np.linspace(patch.center[0] - patch.half[0], patch.center[0] + patch.half[0], INSIDE)
    found, slack = np.zeros(len(points), dtype=bool), 1e-6 * patch.half[0]
    for group in contact:
        low, high = np.sort(mesh.nodes[group.nodes[:, :2], 0], axis=1).T
        found |= np.any((points[:, None] >= low - slack) & (points[:, None] <= high + slack), axis=1)
    if not np.all(found):
        raise Error(
            f"the patch is not inside the contact surface: x = {points[~found][0]:.6g} m of the frame is not on it: "
            "use a smaller --patch, move it by --center, or correct --frame"
        )


def need_clearance(mesh, patch, supported):
    """Returns the clearance, m; raises Error if another surface is too near to the patch, or meshed too coarsely."""
    unit = patch.narrow
    nearest, coarse = np.inf, (0.0, 0.0, 0.0)
    for faces, _ in images.other_faces(mesh, patch, supported):
        x = mesh.gauss(faces, 2).x
        corners = mesh.nodes[faces.nodes]
        every = np.concatenate([x, corners], axis=1)
        beyond = np.maximum(0.0, np.abs(every[..., :2] - patch.center) - patch.half)
        distance = np.min(np.sqrt(np.sum(beyond**2, axis=2) + every[..., 2] ** 2), axis=1)
        nearest = min(nearest, float(distance.min()))
        size = mesh.sizes(faces)
        worst = np.argmax(size / np.maximum(distance, 1e-300))
        coarse = max(coarse, (size[worst] / max(distance[worst], 1e-300), size[worst], distance[worst]))
    if nearest < CLEARANCE * unit * (1.0 - 1e-9):
        raise Error(
            f"another surface of the body is {nearest:.3g} m from the patch, limit {CLEARANCE * unit:.3g} m, a quarter "
            "of its half width: use a smaller --patch"
        )
    if coarse[0] > COARSEST:
        raise Error(
            f"an element of {coarse[1]:.3g} m is {coarse[2]:.3g} m from the patch, limit {COARSEST:g} times that "
            "distance: use a finer mesh there"
        )
    return nearest


def asymmetry(compliance):
    """Returns the asymmetry of D, relative to its norm."""
    return float(np.linalg.norm(compliance - compliance.T, 2) / np.linalg.norm(compliance, 2))


def symmetric(compliance):
    """Returns the symmetric part, after the check of the asymmetry."""
    found = asymmetry(compliance)
    if not found <= ASYMMETRY:
        raise Error(
            f"the compliance is asymmetric by {found:.2g} of its norm, limit {ASYMMETRY:g}: use a finer mesh of the "
            "surfaces nearest to the patch"
        )
    return 0.5 * (compliance + compliance.T)


class Definiteness:
    """The half-space's compliance on cells of the patch, in the basis; other: moduli of body 1 of a pair."""

    def __init__(self, patch, young, poisson, other=None):
        self.patch = patch
        line = isinstance(patch, basis.LinePatch)
        cells = tuple(max(CELLS, PER_DEGREE * degree) for degree in patch.largest)
        cells = (cells[0], 1) if line else cells
        means = patch.cell_means(cells)
        self.area = 4.0 * patch.half[0] * patch.half[1] / (cells[0] * cells[1])
        self.means = np.kron(means, np.eye(3))  # (3 cells, 3 m)
        half_space = halfplane.cell_compliance if line else cell_compliance
        sides = (patch.half[0], cells[0]) if line else (patch.half, cells)
        self.kernel = half_space(*sides, young, poisson)
        if other:
            self.kernel += opposite(half_space(*sides, *other))
        self.factor = linalg.cho_factor(0.5 * (self.kernel + self.kernel.T))
        gram = self.area * self.means.T @ linalg.cho_solve(self.factor, self.means)
        self.root = linalg.cholesky(0.5 * (gram + gram.T), lower=True)

    def eigenvalues(self, compliance):
        """Eigenvalues (3 m) of D relative to the half-space's compliance, ascending; the body's is 1 + that."""
        return linalg.eigvalsh(self.root.T @ compliance @ self.root)

    def smallest(self, compliance):
        """Smallest eigenvalue of the body's compliance relative to the half-space's."""
        return float(1.0 + min(0.0, self.eigenvalues(compliance)[0]))

    def need_positive(self, compliance):
        """Returns the smallest eigenvalue, after a check that it is positive."""
        least = self.smallest(compliance)
        if not least > 0.0:
            sides = "{:.3g} x {:.3g} m".format(*(2.0 * half for half in self.patch.half))
            raise Error(
                f"the compliance is not positive: smallest eigenvalue {least:.3g} relative to the half-space, degree "
                f"{basis.written(self.patch.degree)}, patch {sides}: use a "
                "higher --degree or a smaller --patch"
            )
        return least


def pressure_coefficients(patch):
    """Returns c (3 m) for Hertz's pressure of mean 1 Pa on an ellipse of 0.8 times the half widths."""
    n = 4 * CELLS
    place = [(np.arange(n) + 0.5) / n * 2.0 - 1.0] * 2
    x, y = (v.ravel() for v in np.meshgrid(*place))
    if isinstance(patch, basis.LinePatch):
        y = np.zeros_like(y)
    pressure = np.sqrt(np.maximum(0.0, 1.0 - (x**2 + y**2) / 0.64))
    points = np.array(patch.center)[:, None] + np.array(patch.half)[:, None] * np.stack([x, y])
    c = np.zeros((patch.count, 3))
    c[:, 2] = (pressure / pressure.mean()) @ patch.values(*points) * (4.0 * patch.half[0] * patch.half[1] / n**2)
    return c.ravel()


def degree_changes(compliance, patch):
    """Returns the change of the correction under Hertz's pressure, L2 on the patch, for each lower degree: at an index
    from the end the one that is reduced by that number."""
    c = pressure_coefficients(patch)
    full = compliance @ c
    changes = []
    for by in range(max(patch.largest), 0, -1):
        lower = set(map(tuple, basis.powers(basis.reduced(patch.degree, by)).tolist()))
        kept = np.flatnonzero(np.repeat([tuple(pair) in lower for pair in patch.powers.tolist()], 3))
        part = np.zeros_like(full)
        part[kept] = compliance[np.ix_(kept, kept)] @ c[kept]
        changes.append(float(np.linalg.norm(full - part) / max(np.linalg.norm(full), 1e-300)))
    return changes

"""Compliance of any other body (shoulders above the plane of the patch, curved flanks, several materials) by a cut-off.

chi is 1 about the patch and falls smoothly to 0 within the neighbourhood in which the body is a half-space of one
material. w = u - chi u_j with u_j the half-space's field; with b_j = sym(u_j x grad chi)

    f_j(v) = int (sigma_j grad chi).v - (C b_j):e(v)     D_ij = w_i.f_j - int b_i:C:b_j

Only Gauss points where grad chi is not 0 are needed. D is symmetric to rounding.
"""

from dataclasses import dataclass

import numpy as np

from ...core.brief import brief
from ...core.errors import Error
from ...core.progress import Progress
from .remainder import Remainder, Side, scatter

ORDER = 4  # Gauss points along the side of an element
POINTS = 2000  # number of points processed at a time
START = 0.2  # start of the ramp, relative to the distance from the patch to the end of the ramp
WIDEST = 3.0  # half widths: largest distance of a ramp's end from the patch
NARROWEST = 0.5  # half widths: least width of a ramp
GROWTH = 0.05  # half widths by which the box grows
ELEMENTS = 4  # least number of elements along a ramp


def _ramp(t):
    """Returns a function from 1 for t <= 0 to 0 for t >= 1 with two continuous derivatives, and its derivative."""
    t = np.clip(t, 0.0, 1.0)
    return 1.0 - t**3 * (10.0 - 15.0 * t + 6.0 * t * t), -30.0 * (t * (1.0 - t)) ** 2


@brief
@dataclass
class Cutoff:
    """Box in which chi is not 0: low and high ends (3) in x, y, z; and the box of the patch, from which ramps start."""

    inner: np.ndarray
    outer: np.ndarray

    def ramps(self):
        """(axis, sign, start, end) of the five ramps."""
        for axis in range(3):
            for side, sign in ((0, -1.0), (1, 1.0)):
                if axis == 2 and side == 0:
                    continue
                near, far = self.inner[side, axis], self.outer[side, axis]
                yield axis, sign, near + START * (far - near), far

    def _parts(self, x):
        for axis, _sign, start, end in self.ramps():
            value, slope = _ramp((x[:, axis] - start) / (end - start))
            yield axis, value, slope / (end - start)

    def values(self, x):
        """chi (points)."""
        return np.prod([value for _, value, _ in self._parts(x)], axis=0)

    def gradients(self, x):
        """grad chi (points, 3)."""
        parts = list(self._parts(x))
        total = np.prod([value for _, value, _ in parts], axis=0)
        gradient = np.zeros_like(x)
        for axis, value, slope in parts:
            gradient[:, axis] += np.divide(total, value, out=np.zeros_like(total), where=value > 0.0) * slope
        return gradient


def _obstacles(mesh, supported, contact, tolerance, moduli):
    """Returns the points that the cut-off's box must not contain: of other surfaces, supports and other materials."""
    on_contact = {(g.block, g.local, e) for g in contact for e in g.elements.tolist()}
    points = [mesh.nodes[supported]]
    for group in mesh.boundary():
        kept = np.array([(group.block, group.local, e) not in on_contact for e in group.elements.tolist()])
        beside = np.any(np.abs(mesh.nodes[group.nodes][..., 2]) > tolerance, axis=1) & kept
        if np.any(beside):
            nodes = group.nodes[beside]
            points += [mesh.nodes[np.unique(nodes)], mesh.nodes[nodes].mean(axis=1)]
    for block in mesh.blocks:
        other = (block.young != moduli[0]) | (block.poisson != moduli[1])
        points.append(mesh.nodes[np.unique(block.nodes[other])])
    return np.concatenate(points)


def widest(mesh, patch, supported, contact, tolerance, moduli):
    """Returns the Cutoff with the widest ramps that fit; each side has its own width."""
    points = _obstacles(mesh, supported, contact, tolerance, moduli)
    center, half = np.array([*patch.center, 0.0]), np.array([*patch.half, 0.0])
    inner = np.stack([center - half, center + half])
    unit = patch.narrow
    outer, step = inner.copy(), GROWTH * unit
    outer[0, 2] = -2.0 * tolerance - step
    sides = [(0, 0), (1, 0), (0, 1), (1, 1), (1, 2)]
    growing = set(sides)
    while growing:
        for side, axis in sides:
            if (side, axis) not in growing:
                continue
            tried = outer.copy()
            tried[side, axis] += step if side else -step
            inside = np.all((points > tried[0] + 1e-6 * step) & (points < tried[1] - 1e-6 * step), axis=1)
            far = abs(tried[side, axis] - inner[side, axis]) > WIDEST * unit * (1.0 + 1e-9)
            if far or np.any(inside):
                growing.discard((side, axis))
            else:
                outer = tried
    narrow = min(abs(outer[side, axis] - inner[side, axis]) for side, axis in sides)
    if narrow < NARROWEST * unit * (1.0 - 1e-9):
        raise Error(
            f"only {narrow:.3g} m beside or below the patch belong to a half-space of one material, limit "
            f"{NARROWEST * unit:.3g} m, half of the patch's half width: use a smaller --patch"
        )
    return Cutoff(inner, outer)


def too_coarse(mesh, cutoff):
    """Largest element across a ramp relative to the ramp's width."""
    worst = 0.0
    for block in mesh.blocks:
        corners = mesh.nodes[block.nodes]
        low, high = corners.min(axis=1), corners.max(axis=1)
        near = np.all((high > cutoff.outer[0]) & (low < cutoff.outer[1]), axis=1)
        for axis, _, start, end in cutoff.ramps():
            across = near & (high[:, axis] > min(start, end)) & (low[:, axis] < max(start, end))
            if np.any(across):
                worst = max(worst, float(np.max((high - low)[across, axis]) / abs(end - start)))
    return worst


def solved(mesh, fields, solver, cutoff, progress=None):
    """The Remainder of a body."""
    columns = fields.columns
    force = np.zeros((3 * len(mesh.nodes), columns))
    compliance = np.zeros((columns, columns))
    work = []
    for index, block in enumerate(mesh.blocks):
        corners = mesh.nodes[block.nodes]
        near = np.all((corners.max(axis=1) > cutoff.outer[0]) & (corners.min(axis=1) < cutoff.outer[1]), axis=1)
        local, weight = block.shape.rule(ORDER)
        chosen, stride = np.flatnonzero(near), max(1, POINTS // len(weight))
        work += [(index, local, weight, chosen[i : i + stride]) for i in range(0, len(chosen), stride)]
    progress = progress or Progress("group", None)
    progress.begin("half-space fields", "half-space fields in {} of {} groups of elements")
    for done, (index, local, weight, elements) in enumerate(work, 1):
        nodal, energy = _element_forces(mesh.volume(index, local, weight, elements), fields, cutoff)
        scatter(force, mesh.blocks[index].nodes[elements], nodal)
        compliance -= energy
        progress(done, len(work))
    progress.begin(f"{columns} solutions")
    w = solver(force, np.zeros((len(solver.held), columns)))
    compliance += w.T @ force
    return Remainder([Side(mesh, fields)], compliance, w, solver.reaction(w, force), cutoff)


def _element_forces(volume, fields, cutoff):
    """Returns nodal forces (n, k, 3, columns), and int b_i:C:b_j (columns, columns), of some elements."""
    x, size, values, gradients = volume
    flat = x.reshape(-1, 3)
    slope = cutoff.gradients(flat)
    active = np.flatnonzero(np.any(slope != 0.0, axis=1))
    columns = fields.columns
    single, double = np.zeros((len(flat), 3, columns)), np.zeros((len(flat), 3, 3, columns))
    energy = np.zeros((columns, columns))
    if len(active):
        place = np.maximum(flat[active], (-np.inf, -np.inf, 0.0))
        outer = fields.displacement(place)[:, :, None, :] * slope[active][:, None, :, None]
        b = 0.5 * (outer + outer.transpose(0, 2, 1, 3))
        weighted = fields.stress_of(b) * size.ravel()[active][:, None, None, None]
        energy = b.reshape(-1, columns).T @ weighted.reshape(-1, columns)
        force = np.einsum("pijc,pj->pic", fields.stress(place), slope[active])
        single[active] = force * size.ravel()[active][:, None, None]
        double[active] = weighted
    count, q, k = gradients.shape[:3]
    nodal = np.einsum("qk,nqic->nkic", values, single.reshape(count, q, 3, columns))
    g = gradients.transpose(0, 2, 1, 3).reshape(count, k, 3 * q)
    stress = double.reshape(count, q, 3, 3, columns).transpose(0, 1, 3, 2, 4).reshape(count, 3 * q, -1)
    nodal -= np.matmul(g, stress).reshape(count, k, 3, columns)
    return nodal, energy

"""A rigid sphere on an axisymmetric body of finite elements: evidence of the cases `indentation` and `plate-on-feet`.

Quadrilaterals of four nodes in a plane of r and depth z, with the mean dilatation of each element (B-bar); von Mises
yield with isotropic linear hardening, mapped back radially; contact without friction at the nodes by an active set.
Displacements u_z point into the body.
"""

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu

GAUSS = 1.0 / np.sqrt(3.0)
ONE = np.array([1.0, 1.0, 1.0, 0.0])  # components: rr, zz, tt, rz, the last strain as an angle
NEWTON, SMALL = 60, 1e-2  # steps; relative change below which the contact is found anew


def halved(lines, times):
    """Planes of elements with each element cut in two, so many times."""
    for _ in range(times):
        lines = np.sort(np.concatenate([lines, 0.5 * (lines[1:] + lines[:-1])]))
    return lines


def growing(fine, size, far, ratio):
    """Planes of equal elements to `fine`, then of elements that grow by the ratio, to `far`."""
    lines = list(np.linspace(0.0, fine, round(fine / size) + 1))
    while lines[-1] < far:
        size *= ratio
        lines.append(lines[-1] + size)
    lines = np.array(lines)
    beyond = lines > fine
    lines[beyond] = fine + (lines[beyond] - fine) * (far - fine) / (lines[-1] - fine)
    return lines


class Body:
    """Elements, material and state of a body; `fixed`: mask of unknowns that are given."""

    def __init__(self, r, z, young, poisson, stress=np.inf, hardening=0.0):
        self.nodes = np.array([(a, b) for b in z for a in r])
        n, grid = len(r), np.arange(len(r) * len(z)).reshape(len(z), len(r))
        self.elements = np.stack([grid[:-1, :-1], grid[:-1, 1:], grid[1:, 1:], grid[1:, :-1]], axis=-1).reshape(-1, 4)
        self.top, self.size = np.arange(n), 2 * len(self.nodes)
        self.shear, self.bulk = young / (2.0 * (1.0 + poisson)), young / (3.0 * (1.0 - 2.0 * poisson))
        self.stress, self.hardening = stress, hardening
        self.matrices()
        self.plastic = np.zeros((*self.weight.shape, 4))
        self.accumulated = np.zeros(self.weight.shape)
        self.u = np.zeros(self.size)
        self.fixed = np.zeros(self.size, bool)
        self.fixed[2 * np.flatnonzero(self.nodes[:, 0] == 0.0)] = True

    def matrices(self):
        """B of each Gauss point, its dilatation replaced by the element's mean, and the points' volumes."""
        x = self.nodes[self.elements]
        count = len(x)
        self.b, self.weight, self.points = np.zeros((count, 4, 4, 8)), np.zeros((count, 4)), np.zeros((count, 4, 2))
        for k, (s, t) in enumerate(((-GAUSS, -GAUSS), (GAUSS, -GAUSS), (GAUSS, GAUSS), (-GAUSS, GAUSS))):
            signs = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)])
            shape = 0.25 * (1 + signs[:, 0] * s) * (1 + signs[:, 1] * t)
            ds, dt = 0.25 * signs[:, 0] * (1 + signs[:, 1] * t), 0.25 * signs[:, 1] * (1 + signs[:, 0] * s)
            width, height = x[:, 1, 0] - x[:, 0, 0], x[:, 3, 1] - x[:, 0, 1]
            dr, dz = 2.0 * ds / width[:, None], 2.0 * dt / height[:, None]
            at = np.einsum("n,enk->ek", shape, x)
            self.points[:, k] = at
            self.b[:, k, 0, 0::2], self.b[:, k, 1, 1::2] = dr, dz
            self.b[:, k, 2, 0::2] = shape / at[:, :1]
            self.b[:, k, 3, 0::2], self.b[:, k, 3, 1::2] = dz, dr
            self.weight[:, k] = 2.0 * np.pi * at[:, 0] * 0.25 * width * height
        dilatation = np.einsum("c,ekci->eki", ONE, self.b)
        mean = np.einsum("ek,eki->ei", self.weight, dilatation) / self.weight.sum(axis=1)[:, None]
        self.b += ONE[:, None] * (mean[:, None] - dilatation)[:, :, None, :] / 3.0
        self.rows = np.stack([2 * self.elements, 2 * self.elements + 1], axis=-1).reshape(count, 8)

    def respond(self, u):
        """Stresses, plastic strain and accumulated strain at u, forces of the nodes, and the tangent stiffness."""
        strain = np.einsum("ekci,ei->ekc", self.b, u[self.rows])
        elastic = strain - self.plastic
        volume = elastic @ ONE
        deviator = elastic - volume[..., None] / 3.0 * ONE
        deviator[..., 3] *= 0.5
        trial = 2.0 * self.shear * deviator
        double = np.array([1.0, 1.0, 1.0, 2.0])
        size = np.sqrt(trial**2 @ double)
        size[size == 0.0] = 1.0
        n = trial / size[..., None]
        excess = np.sqrt(1.5) * size - self.stress - self.hardening * self.accumulated
        step = np.where(excess > 0.0, excess / (3.0 * self.shear + self.hardening), 0.0)
        back = 1.0 - np.sqrt(6.0) * self.shear * step / size
        stress = back[..., None] * trial + self.bulk * volume[..., None] * ONE
        plastic = self.plastic + np.sqrt(1.5) * step[..., None] * n * double
        unit = np.diag([1.0, 1.0, 1.0, 0.5]) - np.outer(ONE, ONE) / 3.0
        tangent = 2.0 * self.shear * back[..., None, None] * unit + self.bulk * np.outer(ONE, ONE)
        slope = np.where(step > 0.0, 1.0 / (1.0 + self.hardening / (3.0 * self.shear)) - (1.0 - back), 0.0)
        tangent -= 2.0 * self.shear * slope[..., None, None] * n[..., :, None] * n[..., None, :]
        force = np.zeros(self.size)
        np.add.at(force, self.rows, np.einsum("ekci,ekc,ek->ei", self.b, stress, self.weight))
        product = np.matmul(tangent * self.weight[..., None, None], self.b).reshape(len(self.rows), 16, 8)
        matrix = np.matmul(self.b.reshape(len(self.rows), 16, 8).transpose(0, 2, 1), product)
        rows, columns = np.repeat(self.rows, 8, axis=1), np.tile(self.rows, (1, 8))
        stiffness = sparse.coo_matrix((matrix.ravel(), (rows.ravel(), columns.ravel())), (self.size, self.size))
        return stress, plastic, self.accumulated + step, force, stiffness.tocsr()

    def press(self, load, gap, given, closed):
        """Equilibrium under a load on the sphere, with displacements `given` where they are fixed, from the contact
        `closed`, a mask of the top's nodes. The approach, the contact's nodal forces and the mask; keeps the state."""
        normal, u = 2 * self.top + 1, self.u.copy()
        approach, scale = u[normal[0]] + gap[0], np.abs(u).max()
        closed = closed & bool(load)
        stress, plastic, accumulated, force, stiffness = self.respond(u)
        for _ in range(NEWTON):
            tied = normal[closed]
            jump = np.where(self.fixed, given - u, 0.0)
            jump[tied] = approach - gap[closed] - u[tied]
            free = np.flatnonzero(~self.fixed & ~np.isin(np.arange(self.size), tied))
            # unknowns: those of the free nodes, and the approach, which all nodes in contact share
            columns = np.concatenate([np.arange(len(free)), np.full(len(tied), len(free))])
            shape = (self.size, len(free) + bool(load))
            moves = sparse.csr_matrix((np.ones(len(columns)), (np.concatenate([free, tied]), columns)), shape)
            rest = -(moves.T @ (force + stiffness @ jump))
            if load:
                rest[-1] += load
            delta = splu((moves.T @ stiffness @ moves).tocsc(), "MMD_AT_PLUS_A", options={"SymmetricMode": True}).solve(
                rest
            )
            change = jump + moves @ delta
            for part in (1.0, 0.5, 0.25, 0.125):
                stress, plastic, accumulated, force, stiffness = self.respond(u + part * change)
                left = moves.T @ force - load * (np.arange(shape[1]) == len(free))
                if np.linalg.norm(left) < max(np.linalg.norm(rest), 1e-9 * load):
                    break
            u = u + part * change
            approach += part * delta[-1] if load else 0.0
            reaction = force[normal]
            found = np.where(closed, reaction > 0.0, u[normal] < approach - gap) & bool(load)
            moved = np.abs(change).max() / max(np.abs(u).max(), scale)
            if moved < 1e-9 and np.array_equal(found, closed):
                break
            if moved < SMALL:  # the contact is a disc; it grows by an eighth at most
                count = np.argmin(np.append(found, False))
                closed = self.top < min(count, closed.sum() + max(1, closed.sum() // 8))
        else:
            raise RuntimeError("Newton's method did not converge")
        self.u, self.plastic, self.accumulated, self.stresses = u, plastic, accumulated, stress
        return approach, np.where(closed, reaction, 0.0), closed

    def pressures(self, reaction):
        """Pressure at the nodes of the top: the linear one of these nodal forces, by lumping where it is not 0."""
        r = self.nodes[self.top, 0]
        width = np.diff(r)
        first, second = width * (2 * r[:-1] + r[1:]) / 6, width * (r[:-1] + 2 * r[1:]) / 6
        return reaction / (2.0 * np.pi * (np.append(first, 0.0) + np.append(0.0, second)))


def edge(r, gap, reaction):
    """Radius of the contact: beside it the gap grows like the power 3/2 of the distance; by two nodes near it."""
    first = np.flatnonzero(reaction > 0.0)[-1] + 2
    one, two = gap[first : first + 2] ** (2 / 3)
    return r[first] - one * (r[first + 1] - r[first]) / (two - one)


def boussinesq(nodes, young, poisson):
    """Displacements of a half-space by a unit force on its surface at the origin."""
    r, z = nodes.T
    rho = np.maximum(np.hypot(r, z), 1e-30)
    factor = (1.0 + poisson) / (2.0 * np.pi * young)
    radial = r * z / rho**3 - (1.0 - 2.0 * poisson) * r / (rho * (rho + z))
    return factor * np.stack([radial, z**2 / rho**3 + 2.0 * (1.0 - poisson) / rho], axis=1).ravel()

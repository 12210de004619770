"""Layered bodies, solved by one linear system for each wave: an independent check of petsam's recursion."""

import numpy as np


def falling(k, z, g, nu):
    """U, W, T, S of the two parts of a layer that decay downwards, z below its top; displacements times k."""
    e, kz, kappa = np.exp(-k * z), k * z, 3 - 4 * nu
    lame = -4 * g * nu * e  # Lame's first constant times the second part's dilatation
    shear, stretch = (1 - kz) * e - (kz + kappa) * e, (1 - kz - kappa) * e
    return [[e, e, -2 * g * e, -2 * g * e], [kz * e, (kz + kappa) * e, g * shear, lame + 2 * g * stretch]]


class Body:
    """Layers (modulus, Poisson's ratio, thickness) from the surface down, and a base (modulus, ratio; None: rigid)."""

    def __init__(self, layers, base):
        self.layers, self.base = layers, base

    def surface(self):
        """Shear modulus and Poisson's ratio at the surface."""
        young, nu = (self.layers or [self.base])[0][:2]
        return young / (2 * (1 + nu)), nu

    def modes(self, m, z, k):
        """U, W, T, S of the parts of layer m at a depth in it, and V, T_y of those across: (parts, 4 or 2, k)."""
        young, nu, h = [*self.layers, (*(self.base or (1, 0)), np.inf)][m]
        g = young / (2 * (1 + nu)) / self.surface()[0]
        plane, across = falling(k, z, g, nu), [[np.exp(-k * z), -g * np.exp(-k * z)]]
        if np.isfinite(h):
            plane += [[u, -w, -t, s] for u, w, t, s in falling(k, h - z, g, nu)]
            across.append([np.exp(-k * (h - z)), g * np.exp(-k * (h - z))])
        return np.array(plane), np.array(across)

    def solve(self, k, kind):
        """The parts of the first layer by unit tractions: kind 0 in the plane (by q, by p), 1 across it (by q_y)."""
        n, each, tractions = len(self.layers), (4, 2)[kind], (2, 1)[kind]
        size = each * n + (tractions if self.base else 0)
        matrix, row = np.zeros((k.size, size, size)), tractions
        for m in range(n + (1 if self.base else 0)):
            at = slice(each * m, min(each * (m + 1), size))
            top = self.modes(m, 0.0, k)[kind].transpose(2, 1, 0)
            if m == 0:
                matrix[:, :tractions, at] = top[:, -tractions:]
            else:  # displacements and tractions go on
                matrix[:, row - each : row, at] = -top
            if m < n:
                bottom = self.modes(m, self.layers[m][2], k)[kind].transpose(2, 1, 0)
                count = tractions if m + 1 == n and not self.base else each  # on a rigid base only displacements, 0
                matrix[:, row : row + count, at] = bottom[:, :count]
                row += count
        given = np.zeros((k.size, size, tractions))
        given[:, range(tractions), range(tractions)] = -1  # q is -T, p is -S
        return np.linalg.solve(matrix, given)

    def symbols(self, k):
        """zz, zr, rr, tt at the wave numbers k, times k."""
        plane, across = self.modes(0, 0.0, k)
        a, b = self.solve(k, 0)[:, : len(plane)], self.solve(k, 1)[:, : len(across)]
        g = self.surface()[0]

        def of(component, parts, solution, load):
            return (parts[:, component].T * solution[:, :, load]).sum(1) / g

        return of(1, plane, a, 1), of(0, plane, a, 1), of(0, plane, a, 0), of(0, across, b, 0)

    def stresses(self, z, k):
        """xx, zz, xz in waves (along x, of k) by q and by p at a depth: (3, 2, k); and yz, xy by q_y: (2, k)."""
        tops = np.cumsum([0.0, *(layer[2] for layer in self.layers)])
        m = int(np.searchsorted(tops, z, side="right")) - 1
        young, nu = [*self.layers, self.base][m][:2]
        g = young / (2 * (1 + nu)) / self.surface()[0]
        plane, across = self.modes(m, z - tops[m], k)
        a, b = self.solve(k, 0)[:, 4 * m :][:, : len(plane)], self.solve(k, 1)[:, 2 * m :][:, : len(across)]
        u, _, t, s = np.einsum("pck,kpl->clk", plane, a)
        v, ty = np.einsum("pck,kp->ck", across, b[:, :, 0])
        return np.array([(2 * g * u + nu * s) / (1 - nu), s, t]), np.array([ty, -g * v])

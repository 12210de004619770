"""Round contact of dissimilar bodies whose load falls in steps: p and q constant on n equal rings.

Units, signs and the state at full load are those of rings.py; displacements by the complete elliptic integrals of ring
loads (K. L. Johnson, Contact Mechanics, 1985, chapter 3). A ring sticks, so that u_r stays, or slips with q = mu p or
-mu p against the change of u_r; both are found by trial.
"""

import numpy as np
from scipy.special import ellipe, ellipkm1


class Unloading:
    """The state at the middles r of n rings, from the full load down; `energy` is dissipated since then."""

    def __init__(self, n, friction, beta, full):
        self.n, self.friction = n, friction
        ends = np.arange(n + 1) / n
        self.r = r = (ends[1:] + ends[:-1]) / 2
        self.area = np.pi * np.diff(ends**2)
        self.zz, self.rr = self.kernels(ends)
        self.zr = -beta / n * (np.triu(np.ones((n, n)), 1) + np.eye(n) / 2)
        inside = np.tril(np.ones((n, n)), -1) * self.area + np.diag(np.pi * (r**2 - ends[:-1] ** 2))
        self.rz = -beta / (2 * np.pi * r[:, None]) * inside
        self.u, self.k, self.energy = full.displacement(r), n, 0.0
        self.status = np.where(r < full.stick, 0, 1)  # 0 where a ring sticks, else the sign of q
        self.p, self.q, self.d = self.solve(full.force)
        self.u = self.rr @ self.q + self.rz @ self.p

    def kernels(self, ends):
        """u_z by p and u_r by q of each ring at the middles; a substitution removes the logarithm."""
        x, w = np.polynomial.legendre.leggauss(12)
        t, dt = ((1 + x) / 2) ** 3, 1.5 * ((1 + x) / 2) ** 2 * w
        zz = rr = 0.0
        for start, end in ((self.r, ends[:-1]), (self.r, ends[1:])):
            # each ring from the middle itself, or, where it lies elsewhere, as a difference of two such integrals
            s = start[:, None] + (end - start)[:, None] * t
            weight = np.abs(end - start)[:, None] * dt
            near, far = np.minimum(s, self.r[:, None, None]), np.maximum(s, self.r[:, None, None])
            m1 = np.maximum((far - near) * (far + near) / far**2, 1e-300)
            big_k, big_e = ellipkm1(m1), ellipe(1 - m1)
            zz = zz + np.sum(weight * s * 2 / (np.pi * far) * big_k, axis=2)
            rr = rr + np.sum(weight * s * 2 / (np.pi * near) * (big_k - big_e), axis=2)
        return zz, rr

    def solve(self, force):
        """p, q, d with the present sets: k rings in contact, and their status."""
        k, status = self.k, self.status[: self.k, None]
        a, own = np.zeros((2 * k + 1, 2 * k + 1)), np.s_[:k, :k]
        a[:k, :k], a[:k, k:-1], a[:k, -1] = self.zz[own], self.zr[own], -1
        a[k:-1, :k] = np.where(status == 0, self.rz[own], -self.friction * status * np.eye(k))
        a[k:-1, k:-1] = np.where(status == 0, self.rr[own], np.eye(k))
        a[-1, :k] = self.area[:k]
        right = np.concatenate([-(self.r[:k] ** 2) / 2, np.where(status[:, 0] == 0, self.u[:k], 0), [force]])
        x = np.linalg.solve(a, right)
        rest = np.zeros(self.n - k)
        return np.append(x[:k], rest), np.append(x[k:-1], rest), x[-1]

    def step(self, force):
        """To a smaller N."""
        for trial in range(200):
            p, q, d = self.solve(force)
            if p[self.k - 1] < 0:
                self.k -= 1
                continue
            u = self.rr @ q + self.rz @ p
            over = (self.status == 0) & (np.abs(q) > self.friction * p * (1 + 1e-9)) & (p > 0)
            back = (self.status * (u - self.u) > 1e-14) & (p > 0)
            if not np.any(over | back):
                break
            if trial > 20:  # one at a time
                worst = np.argmax(np.where(over, np.abs(q) - self.friction * p, 0) if np.any(over) else back)
                over, back = over & (np.arange(self.n) == worst), back & (np.arange(self.n) == worst)
            self.status = np.where(over, np.sign(q), np.where(back, 0, self.status))
        else:
            raise RuntimeError("stick and slip do not settle")
        slip = (self.status != 0) & (self.p > 0)  # also those that leave the contact
        self.energy += np.sum((np.abs(self.q + q) / 2 * np.abs(u - self.u) * self.area)[slip])
        self.p, self.q, self.u, self.d = p, q, u, d

    def contact_radius(self):
        """p^2 falls in a line at the edge; the last ring is only partly in contact."""
        last = np.s_[self.k - 5 : self.k - 1]
        return root(self.r[last], self.p[last] ** 2)

    def shear_max(self):
        """q at the end of the disc that sticks, where (mu p - q)^2 falls in a line and q = mu p begins."""
        first = np.argmax(self.status == 1)
        inside, outside = np.s_[first - 5 : first - 1], np.s_[first + 1 : first + 4]
        end = root(self.r[inside], (self.friction * self.p - self.q)[inside] ** 2)
        return np.polyval(np.polyfit(self.r[outside], self.q[outside], 1), end)

    def reversal_radius(self):
        """Where q changes its sign."""
        i = np.flatnonzero((self.q[1:] < 0) & (self.q[:-1] >= 0) & (self.r[1:] > 0.3))[0]
        return np.interp(0, self.q[[i + 1, i]], self.r[[i + 1, i]])


def root(x, y):
    """Where the line through these points is 0."""
    slope, base = np.polyfit(x, y, 1)
    return -base / slope

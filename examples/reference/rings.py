"""Round contact of dissimilar bodies with friction, pressed and released: axisymmetric equations in numpy.

Pressure and radial shear are sums of flat punches of radius b,

    p(r) = integral of g(b)/sqrt(b^2 - r^2) db,    q(r) = r times the integral of h(b)/sqrt(b^2 - r^2) db,    r < b < a,

whose displacements are elementary (Abel's transforms; K. L. Johnson, Contact Mechanics, 1985, chapter 3). Times E*/2,

    u_z = integral of g arcsin(min(1, b/r)) db - beta (integral of q dr from r to a),
    u_r = integral of h k(b, r)/r db - (beta/r) (integral of p r dr from 0 to r),
    k = (r^2 arcsin(b/r) - b sqrt(r^2 - b^2))/2 for b < r, pi r^2/4 beyond.

g and h are constant on rings, which are narrow at the edges of stick and contact; the equations hold at their ends:
u_z = d - r^2/2, in a disc that sticks u_r is given, beyond it q = mu p while the load grows, -mu p while it falls. For
any disc but the right one the shear has the singularity of a flat punch at the end of the disc. Units: R = 1, E* = 2,
and the radius of contact at full load is 1; u_r and q are those of the elastic bodies together.
"""

from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq


class State(NamedTuple):
    """Contact and stick radius, N, d; p, q and u_r at the radii r; elastic energy."""

    contact: float
    stick: float
    force: float
    approach: float
    r: np.ndarray
    p: np.ndarray
    q: np.ndarray
    u: np.ndarray
    energy: float
    displacement: object  # u_r at any radii


def graded(low, high, count, power, both):
    """Ends of rings, narrow at high, and at low if both."""
    t = np.linspace(-1 if both else 0, 1, count + 1)
    t = np.sign(t) * (1 - (1 - np.abs(t)) ** power)
    return low + (high - low) * (t - t[0]) / (t[-1] - t[0])


class Rings:
    """The matrices of n rings, n/2 of which stick, for p, q, u_z and u_r at the radii r."""

    def __init__(self, n, contact, stick, beta, r=None, power=2.0):
        self.m, self.beta, self.contact, self.stick = n // 2, beta, contact, stick
        self.ends = np.append(
            graded(0, stick, self.m, power, False), graded(stick, contact, n - n // 2, power, True)[1:]
        )
        self.r = r = np.append(self.ends[1] / 2, self.ends[1:]) if r is None else r
        radius, b = r[:, None], self.ends[None, :]
        inside, outside = np.minimum(b, radius), np.maximum(b, radius)
        acosh = np.arccosh(outside / radius)
        root, chord = np.sqrt(outside**2 - radius**2), np.sqrt(radius**2 - inside**2)
        slope = (outside * root - radius**2 * acosh) / 2  # integral of sqrt(b^2 - r^2)
        lens = inside * np.arcsin(inside / radius) + chord  # integral of arcsin(b/r)
        far = radius * lens / 2 + chord**3 / (6 * radius) + np.pi / 4 * radius * (outside - radius)
        self.p, self.q = np.diff(acosh), np.diff(acosh) * radius
        self.zz, self.rr = np.diff(lens + np.pi / 2 * (outside - radius)), np.diff(far)
        self.zr, self.rz = -beta * np.diff(slope), -beta / radius * np.diff(b**2 / 2 - slope)
        # a single punch of shear, as large as the disc that sticks
        inside, outside = np.minimum(stick, r), np.maximum(stick, r)
        self.single_r = (np.arcsin(inside / r) * r**2 - inside * np.sqrt(r**2 - inside**2)) / (2 * r)
        self.single_z = -beta * np.sqrt(outside**2 - r**2)

    def solve(self, bound, stuck=None):
        """The single punch, 0 for the right disc, and the state. stuck: u_r of the disc; None: the load has grown
        from 0, so that u_r is a multiple of r^2 there and h is continuous."""
        n, m, r, ends = self.ends.size - 1, self.m, self.r, self.ends
        a, right = np.zeros((2 * n + 3, 2 * n + 3)), np.zeros(2 * n + 3)  # of g, h, the punch, d, the multiple
        a[:n, :n], a[:n, n : 2 * n], a[:n, -3], a[:n, -2] = self.zz[1:], self.zr[1:], self.single_z[1:], -1
        right[:n] = -(r[1:] ** 2) / 2
        a[n, :n], a[n, n : 2 * n] = np.pi / 2 * np.diff(ends), -self.beta / 2 * np.diff(ends**2)  # r = 0
        a[n, -3:-1] = -self.beta * self.stick, -1
        a[n + 1 : -1, :n] = np.concatenate([self.rz[: m + 1], -bound * self.p[m:-1]])
        a[n + 1 : -1, n : 2 * n] = np.concatenate([self.rr[: m + 1], self.q[m:-1]])
        a[n + 1 : n + m + 2, -3] = self.single_r[: m + 1]
        if stuck is None:
            a[n + 1 : n + m + 2, -1] = -(r[: m + 1] ** 2)
            middle = (ends[1:] + ends[:-1]) / 2
            for i, j, sign in ((m - 1, m - 2, 1), (m, m + 1, -1)):  # h at the disc's end, by a line through two rings
                slope = (self.stick - middle[i]) / (middle[j] - middle[i])
                a[-1, n + i], a[-1, n + j] = sign * (1 - slope), sign * slope
        else:
            right[n + 1 : n + m + 2] = stuck(r[: m + 1])
            a[-1, -1] = 1
        x = np.linalg.solve(a, right)
        return x[-3] * np.sign(bound), self.state(x[:n], x[n : 2 * n], x[-2])

    def state(self, g, h, d):
        def displacement(r):
            other = Rings(self.ends.size - 1, self.contact, self.stick, self.beta, r)
            return other.rr @ h + other.rz @ g

        r, q, u = self.r, self.q @ h, self.rr @ h + self.rz @ g
        force = np.pi * np.sum(g * np.diff(self.ends**2))
        energy = d * force / 2 - np.pi * np.sum(g * np.diff(self.ends**4)) / 12 + np.pi * np.trapezoid(r * q * u, r)
        return State(self.contact, self.stick, force, d, r, self.p @ g, q, u, energy, displacement)


def disc(low, high, solve):
    """The state of solve(stick), between these radii, whose single punch is 0."""
    return solve(brentq(lambda stick: solve(stick)[0], low, high, xtol=1e-12))[1]


def press(n, friction, beta):
    """The state at full load; the stick radius is above 0.4."""
    return disc(0.4, 0.95, lambda stick: Rings(n, 1.0, stick, beta).solve(friction))


def pressing_energy(state, friction):
    """Dissipated until full load. At radius a u_r is a^2 U(r/a), so the rate of u_r, by a, is 2 U - r U' at a = 1; all
    energies grow like a^5."""
    rate = 2 * state.u - state.r * np.gradient(state.u, state.r)
    slip = np.s_[np.searchsorted(state.r, state.stick) :]
    return 2 * np.pi / 5 * np.trapezoid((friction * state.p * np.abs(rate) * state.r)[slip], state.r[slip])

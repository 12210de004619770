"""Spence's problem: an elastic sphere pressed on a flat of another material, with friction, by a load that grows.

While the contact grows, the *rates* are those of a flat punch of the present radius: equal normal velocity in the
contact, no radial velocity where it sticks, dq = mu dp where it slips. So the ratio of stick and contact radius c/a is
the flat punch's at every load, and the fields follow by integration over the radius. With Goodman's approximation (the
shear does not move the surface normally) there is a closed relation of c/a to mu/beta. Without it `SpencePunch` solves
the flat punch's two integral equations numerically, by collocation on rings that are fine near c and a; it shares
nothing with petsam.

References
----------
- D. A. Spence, Self similar solutions to adhesive contact problems with incremental loading, Proc. R. Soc. A 305 (1968)
  55; The Hertz contact problem with finite friction, J. Elasticity 5 (1975) 297.
- L. E. Goodman, Contact stress analysis of normally loaded rough spheres, J. Appl. Mech. 29 (1962) 515.
- K. L. Johnson, Contact Mechanics, 1985, section 5.4.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import brentq
from scipy.special import ellipe, ellipkm1


def goodman_friction(ratio: ArrayLike) -> np.ndarray:
    """The friction at a stick radius: (a/2c) ln((a + c)/(a - c)) = (mu/beta) K(sqrt(1 - c^2/a^2)) (Johnson, 5.4).

    Parameters
    ----------
    ratio : array_like
        Ratio c/a of stick and contact radius, between 0 and 1.

    Returns
    -------
    ndarray
        mu/beta, of the shape of ratio.
    """
    x = np.asarray(ratio, dtype=float)
    return np.arctanh(x) / x / ellipkm1(x**2)


def spence_friction(ratio: float, beta: float) -> float:
    """The coefficient of friction at a stick radius, with the shear's effect on the pressure.

    Parameters
    ----------
    ratio : float
        Ratio c/a of stick and contact radius, below 1.
    beta : float
        Dundurs' second constant.

    Returns
    -------
    float
        Coefficient of friction mu.
    """
    return SpencePunch(ratio, beta).friction


def spence_punch(friction: float, beta: float) -> SpencePunch:
    """The punch of a given coefficient of friction.

    Parameters
    ----------
    friction : float
        Coefficient of friction mu.
    beta : float
        Dundurs' second constant.

    Returns
    -------
    SpencePunch

    Raises
    ------
    ValueError
        If the stick radius is above 0.99 a: there is almost no slip.
    """
    low = 0.5 * goodman_ratio(friction / beta)
    high = 0.99  # mu = 1.6 at beta = 0.5; almost no slip
    return SpencePunch(brentq(lambda c: spence_friction(c, beta) - friction, low, high, xtol=1e-5), beta)


def goodman_ratio(friction_over_beta: float) -> float:
    """The stick radius at a coefficient of friction: the inverse of goodman_friction().

    Parameters
    ----------
    friction_over_beta : float
        mu/beta, above 0.

    Returns
    -------
    float
        Ratio c/a of stick and contact radius.
    """
    return brentq(lambda x: float(goodman_friction(x)) - friction_over_beta, 1e-12, 1.0 - 1e-12, xtol=1e-14)


def _graded(low, high, count, power=3.0):
    """Element ends from low to high, small at both."""
    t = np.linspace(-1.0, 1.0, count + 1)
    return low + (high - low) * 0.5 * (1.0 + np.sign(t) * (1.0 - (1.0 - np.abs(t)) ** power))


class SpencePunch:
    """Flat punch of radius 1, pressed by 1 into a half-space of E* = 2, with friction and the stick radius c.

    Parameters
    ----------
    c : float
        Ratio c/a of stick and contact radius; 1: no slip.
    beta : float
        Dundurs' second constant.
    coupled : bool
        Whether the shear moves the surface normally; False: Goodman's approximation.
    rings : int
        Number of rings.

    Attributes
    ----------
    friction : float
        The mu that makes the shear finite at c; infinite without slip.
    load_ratio, pressure_ratio : float
        Of the sphere with that mu: N and p(0) over Hertz's at equal contact radius.

    Notes
    -----
    With r = sin(theta) the unknowns are P = p cos(theta) and Q = q cos(theta), constant on each ring, so that the
    variable contains the edge's singularity. The equations are u_z = 1 at the middles of all rings, and u_r = 0 at
    those of rings that stick.
    """

    def __init__(self, c: float, beta: float, coupled: bool = True, rings: int = 140) -> None:
        stick = rings // 2 if c < 1.0 else rings
        self.c, self.beta = c, beta
        self.ends = _graded(0.0, np.arcsin(c), stick)
        if c < 1.0:
            self.ends = np.append(self.ends, _graded(np.arcsin(c), 0.5 * np.pi, rings - stick)[1:])
        self.middle = 0.5 * (self.ends[1:] + self.ends[:-1])
        r = np.sin(self.middle)
        self._pz, self._qr = self._kernels(r)
        swept_p, swept_q = -np.diff(np.cos(self.ends)), np.diff(self.ends)
        below = np.tril(np.ones((rings, rings)), -1)
        # The ring of the middle counts from its end to the middle, or from the middle to its other end.
        self._pr = -beta / r[:, None] * (below * swept_p + np.diag(np.cos(self.ends[:-1]) - np.cos(self.middle)))
        self._qz = -beta * (below.T * swept_q + np.diag(self.ends[1:] - self.middle)) if coupled else 0.0 * below
        self.stick = np.arange(rings) < stick
        self.friction = self._find_friction() if c < 1.0 else np.inf
        self.pressure, self.shear = self._solve(self.friction)
        self._ratios()

    def _kernels(self, r):
        """u_z of the pressure and u_r of the shear at r, for P = Q = 1 on each ring; substitution removes the log."""
        x, weight = np.polynomial.legendre.leggauss(12)
        t, dt = (0.5 * (1.0 + x)) ** 3, 1.5 * (0.5 * (1.0 + x)) ** 2 * weight
        low, high, middle = self.ends[:-1], self.ends[1:], 0.5 * (self.ends[1:] + self.ends[:-1])
        rings = middle.size
        pz, qr = np.zeros((r.size, rings)), np.zeros((r.size, rings))
        for start, end in ((low, middle), (high, middle)):  # towards the middle, where r may lie
            theta = end[:, None] + (start - end)[:, None] * t
            width = np.abs(end - start)[:, None] * dt
            s = np.sin(theta)[None, :, :]
            near, far = np.minimum(s, r[:, None, None]), np.maximum(s, r[:, None, None])
            m1 = np.maximum((far - near) * (far + near) / far**2, 1e-300)
            big_k, big_e = ellipkm1(m1), ellipe(1.0 - m1)
            pz += np.sum(width * s * 2.0 / (np.pi * far) * big_k, axis=2)
            qr += np.sum(width * s * 2.0 / (np.pi * near) * (big_k - big_e), axis=2)
        return pz, qr

    def _solve(self, friction):
        """P and Q for a given mu."""
        rings, n = self.middle.size, int(np.sum(self.stick))
        slip = np.where(self.stick, 0.0, friction)
        matrix = np.zeros((rings + n, rings + n))
        matrix[:rings, :rings] = self._pz + self._qz * slip
        matrix[:rings, rings:] = self._qz[:, :n]
        matrix[rings:, :rings] = (self._pr + self._qr * slip)[:n]
        matrix[rings:, rings:] = self._qr[:n, :n]
        x = np.linalg.solve(matrix, np.concatenate([np.ones(rings), np.zeros(n)]))
        return x[:rings], np.concatenate([x[rings:], slip[n:] * x[n:rings]])

    def _find_friction(self):
        """mu for which the shear has no singularity at c: Q = mu P just inside as well as outside."""
        last = int(np.sum(self.stick)) - 1

        def jump(friction):
            p, q = self._solve(friction)
            return (q[last] - friction * p[last]) / p[0]

        guess = self.beta * float(goodman_friction(self.c))
        return brentq(jump, 0.8 * guess, 3.0 * guess, rtol=1e-10, xtol=1e-300)

    def _ratios(self):
        # Frictionless: P = 2/pi, load 4 (E* = 2). The sphere is a sum of punches of radii up to a, the approach is
        # g a^2/R with g from the surface outside the punch, which must have fallen by r^2/2R when the contact arrives.
        force = 2.0 * np.pi * np.sum(self.pressure * -np.diff(np.cos(self.ends)))
        x, weight = np.polynomial.legendre.leggauss(60)
        t = (0.5 * (1.0 + x)) ** 2  # 1/rho
        dt = 0.5 * (1.0 + x) * weight
        outside = self._kernels(1.0 / t)[0] @ self.pressure
        self.approach_ratio = 0.5 / (1.0 - 2.0 * np.sum(dt * outside * t))
        self.load_ratio = self.approach_ratio * force / 4.0
        self.pressure_ratio = self.approach_ratio * self.pressure[0] * 0.5 * np.pi

    def sphere(self, r: np.ndarray) -> list[np.ndarray]:
        """The pressure and the shear of the sphere, over Hertz's p0 for the same contact radius.

        Parameters
        ----------
        r : ndarray
            Places r/a between 0 and 1, (n,).

        Returns
        -------
        pressure, shear : ndarray
            p/p0 and q/p0, (n,).
        """
        x, weight = np.polynomial.legendre.leggauss(200)
        s, ds = 0.5 * (1.0 + x), 0.5 * weight
        fields = []
        for rate in (self.pressure, self.shear):
            # p = integral of 2 g rate(r/b)/(b cos) b db over r < b < 1; b = sqrt(r^2 + (1 - r^2) s^2) takes the end out
            b = np.sqrt(r[:, None] ** 2 + (1.0 - r[:, None] ** 2) * s**2)
            value = np.interp(np.arcsin(r[:, None] / b), self.middle, rate)
            fields.append(0.5 * np.pi * self.approach_ratio * np.sqrt(1.0 - r**2) * np.sum(ds * value, axis=1))
        return fields


__all__ = ["SpencePunch", "goodman_friction", "goodman_ratio", "spence_friction", "spence_punch"]


def __dir__():
    return __all__

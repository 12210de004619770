"""Reference solutions for two load histories of a sphere: a tangential loop, and growing load on a dissimilar flat.

Conventions are those of analytic.py: SI units, relative displacements, shear positive with the load.

The loop (`masing_*`, `partial_loop_energy`, `sliding_*`) supposes constant normal load, similar materials and
Cattaneo-Mindlin's first loading. Unloading and reloading follow Masing's rule, which Mindlin and Deresiewicz derived
for this contact: the same curve, doubled in both directions.

The growing load (`goodman_friction`, `SpencePunch`) is Spence's problem: elastic sphere on a flat of another material,
friction everywhere. While the contact grows, the *rates* are those of a flat punch of the present radius: equal normal
velocity in the contact, no radial velocity where it sticks, dq = mu dp where it slips. So the ratio stick/contact
radius c/a is the flat punch's, at every load, and fields follow by integration over the radius.
With Goodman's approximation (the shear does not move the surface normally) there is a closed relation of c/a to
mu/beta. Without it `SpencePunch` solves the flat punch's two integral equations numerically, by collocation on rings
that are fine near c and a; nothing of it is shared with petsam.

Run as a program, this file checks the formulas by quadrature, limits and each other.

References
----------
- R. D. Mindlin, H. Deresiewicz, Elastic spheres in contact under varying oblique forces, J. Appl. Mech. 20 (1953) 327.
- D. A. Spence, Self similar solutions to adhesive contact problems with incremental loading, Proc. R. Soc. A 305 (1968)
  55; The Hertz contact problem with finite friction, J. Elasticity 5 (1975) 297.
- L. E. Goodman, Contact stress analysis of normally loaded rough spheres, J. Appl. Mech. 29 (1962) 515.
- K. L. Johnson, Contact Mechanics, 1985, sections 5.4 and 7.4.
"""
import sys

import numpy as np
from scipy.optimize import brentq
from scipy.special import ellipe, ellipk, ellipkm1

import analytic


# ---------------------------------------------------------------- tangential loops

def first_loading(load, limit, gross):
    """d_x, m, of the first loading to load (N); limit = mu N, gross = displacement of incipient sliding (m)."""
    return gross * (1.0 - np.cbrt(1.0 - np.asarray(load, dtype=float) / limit)**2)


def masing_displacement(load, turn_load, turn_displacement, limit, gross):
    """d_x, m, at load (N) after a turning point: the first loading's curve doubled, down or up."""
    swing = np.asarray(load, dtype=float) - turn_load
    return turn_displacement + 2.0 * np.sign(swing) * first_loading(0.5 * np.abs(swing), limit, gross)


def partial_loop_energy(amplitude, limit, gross):
    """Energy, J, that friction takes in one cycle between -amplitude and amplitude (N), amplitude <= mu N.

    Mindlin and Deresiewicz; with gross = 3 mu N (sum of (2 - nu)/G)/(16 a) it is Johnson's eq. 7.59.
    """
    t = amplitude / limit
    return 4.0 * limit * gross * (1.2 * (1.0 - np.cbrt(1.0 - t)**5) - t * (1.0 + np.cbrt(1.0 - t)**2))


def sliding_displacement_load(displacement, limit, gross):
    """T, N, of the first loading to displacement (m) >= 0; mu N beyond gross."""
    return limit * (1.0 - np.clip(1.0 - np.asarray(displacement, dtype=float) / gross, 0.0, None)**1.5)


def sliding_masing_load(displacement, turn_load, turn_displacement, limit, gross):
    """T, N, at displacement (m) after a turning point; the loop's branches end in sliding at mu N."""
    swing = np.asarray(displacement, dtype=float) - turn_displacement
    return turn_load + 2.0 * np.sign(swing) * sliding_displacement_load(0.5 * np.abs(swing), limit, gross)


def sliding_loop_energy(amplitude, limit, gross):
    """Energy, J, of one cycle between displacements -amplitude and amplitude (m) >= gross, from sliding to sliding."""
    return partial_loop_energy(limit, limit, gross) + 4.0 * limit * (amplitude - gross)


# ---------------------------------------------------------------- growing load, dissimilar materials

def dundurs_beta(g1, poisson1, g2, poisson2):
    """Dundurs' second constant; an infinite shear modulus is a rigid body. Its sign says which body is softer."""
    top = (1.0 - 2.0 * poisson1) / g1 - (1.0 - 2.0 * poisson2) / g2
    return 0.5 * top / ((1.0 - poisson1) / g1 + (1.0 - poisson2) / g2)


def goodman_friction(ratio):
    """mu/beta at which c/a = ratio: (a/2c) ln((a + c)/(a - c)) = (mu/beta) K(sqrt(1 - c^2/a^2)) (Johnson, 5.4)."""
    x = np.asarray(ratio, dtype=float)
    return np.arctanh(x) / x / ellipkm1(x**2)


def spence_friction(ratio, beta):
    """mu at which c/a = ratio < 1, with the shear's effect on the pressure."""
    return SpencePunch(ratio, beta).friction


def spence_punch(friction, beta):
    """The SpencePunch of a given mu."""
    low = 0.5 * goodman_ratio(friction / beta)
    high = 0.99  # mu = 1.6 at beta = 0.5; almost no slip
    return SpencePunch(brentq(lambda c: spence_friction(c, beta) - friction, low, high, xtol=1e-5), beta)


def goodman_ratio(friction_over_beta):
    """c/a for mu/beta."""
    return brentq(lambda x: float(goodman_friction(x)) - friction_over_beta, 1e-12, 1.0 - 1e-12, xtol=1e-14)


def _graded(low, high, count, power=3.0):
    """Element ends from low to high, small at both."""
    t = np.linspace(-1.0, 1.0, count + 1)
    return low + (high - low) * 0.5 * (1.0 + np.sign(t) * (1.0 - (1.0 - np.abs(t))**power))


class SpencePunch:
    """Flat punch of radius 1, pressed by 1 into a half-space of E* = 2, friction, stick radius c; see `friction`.

    With r = sin(theta) the unknowns are P = p cos(theta) and Q = q cos(theta), constant on each ring, which takes the
    edge's singularity into the variable; u_z = 1 is asked for at all rings' middles, u_r = 0 at those that stick.
    Attributes: c (c/a; 1: no slip), beta, friction (the mu that makes the shear finite at c), and for the sphere
    with that mu: load_ratio and pressure_ratio: N and p(0) over Hertz's at equal contact radius.
    """

    def __init__(self, c, beta, coupled=True, rings=140):
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
        # the middle's own ring counts from its end to the middle, or from the middle to its other end
        self._pr = -beta / r[:, None] * (below * swept_p + np.diag(np.cos(self.ends[:-1]) - np.cos(self.middle)))
        self._qz = -beta * (below.T * swept_q + np.diag(self.ends[1:] - self.middle)) if coupled else 0.0 * below
        self.stick = np.arange(rings) < stick
        self.friction = self._find_friction() if c < 1.0 else np.inf
        self.pressure, self.shear = self._solve(self.friction)
        self._ratios()

    def _kernels(self, r):
        """u_z of the pressure and u_r of the shear at r from each ring's P = Q = 1; substitution removes the log."""
        x, weight = np.polynomial.legendre.leggauss(12)
        t, dt = (0.5 * (1.0 + x))**3, 1.5 * (0.5 * (1.0 + x))**2 * weight
        low, high, middle = self.ends[:-1], self.ends[1:], 0.5 * (self.ends[1:] + self.ends[:-1])
        rings = middle.size
        pz, qr = np.zeros((r.size, rings)), np.zeros((r.size, rings))
        for start, end in ((low, middle), (high, middle)):  # towards the middle, where r may be
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
        t = (0.5 * (1.0 + x))**2  # 1/rho
        dt = 0.5 * (1.0 + x) * weight
        outside = self._kernels(1.0 / t)[0] @ self.pressure
        self.approach_ratio = 0.5 / (1.0 - 2.0 * np.sum(dt * outside * t))
        self.load_ratio = self.approach_ratio * force / 4.0
        self.pressure_ratio = self.approach_ratio * self.pressure[0] * 0.5 * np.pi

    def sphere(self, r):
        """p and q, over Hertz's p0 for the same contact radius, of the sphere at r/a in (0, 1), a vector."""
        x, weight = np.polynomial.legendre.leggauss(200)
        s, ds = 0.5 * (1.0 + x), 0.5 * weight
        fields = []
        for rate in (self.pressure, self.shear):
            # p = integral of 2 g rate(r/b)/(b cos) b db over r < b < 1; b = sqrt(r^2 + (1 - r^2) s^2) takes the end out
            b = np.sqrt(r[:, None]**2 + (1.0 - r[:, None]**2) * s**2)
            value = np.interp(np.arcsin(r[:, None] / b), self.middle, rate)
            fields.append(0.5 * np.pi * self.approach_ratio * np.sqrt(1.0 - r**2) * np.sum(ds * value, axis=1))
        return fields


def full_stick_load(beta):
    """Mossakovskii: load of a flat punch without slip over the frictionless one, ln((1 + beta)/(1 - beta))/(2 beta)."""
    return np.arctanh(beta) / beta


# ---------------------------------------------------------------- self-check

def _check_loops():
    for t in (0.2, 0.8, 1.0):
        load, weight = np.polynomial.legendre.leggauss(400)
        up = masing_displacement(t * load, -t, -float(first_loading(t, 1.0, 1.0)), 1.0, 1.0)
        down = masing_displacement(t * load, t, float(first_loading(t, 1.0, 1.0)), 1.0, 1.0)
        # the area between the branches, displacement over force
        area = t * np.sum(weight * (down - up))
        yield "loop energy, T = {:g} mu N".format(t), partial_loop_energy(t, 1.0, 1.0) / area - 1.0, 1e-5
        yield "the loop closes, T = {:g} mu N".format(t), float(
            masing_displacement(-t, t, first_loading(t, 1.0, 1.0), 1.0, 1.0) + first_loading(t, 1.0, 1.0)), 1e-14
    d = np.linspace(-2.0, 2.0, 400001)
    down = sliding_masing_load(d, 1.0, 2.0, 1.0, 1.0)
    up = sliding_masing_load(d, -1.0, -2.0, 1.0, 1.0)
    area = np.sum(0.5 * ((down - up)[1:] + (down - up)[:-1])) * (d[1] - d[0])
    yield "sliding loop energy", sliding_loop_energy(2.0, 1.0, 1.0) / abs(area) - 1.0, 1e-7
    # Johnson 7.59 with G = 1, nu = 0.3, mu = 1, N = 1, a = 1, both bodies
    gross = analytic.cattaneo_displacement(1.0, 0.0, 1.5 / np.pi, analytic.tangential_compliance(1.0, 0.3, 1.0, 0.3))
    t = 0.6
    johnson = 0.9 * 2.0 * 1.7 * (1.0 - 0.4**(5.0 / 3.0) - 5.0 * t / 6.0 * (1.0 + 0.4**(2.0 / 3.0)))
    yield "Johnson's form of the loop energy", partial_loop_energy(t, 1.0, gross) / johnson - 1.0, 1e-12


def _check_punch():
    plain = SpencePunch(0.5, 1e-6)
    yield "no coupling: approach, load, pressure of Hertz", np.max(np.abs(np.array(
        [plain.approach_ratio, plain.load_ratio, plain.pressure_ratio]) - 1.0)), 1e-4
    r = np.array([0.1, 0.5, 0.9])
    yield "no coupling: Hertz's pressure", np.max(np.abs(plain.sphere(r)[0] / np.sqrt(1.0 - r**2) - 1.0)), 1e-4
    for c in (0.2, 0.5, 0.8):
        punch = SpencePunch(c, 0.5, coupled=False)
        yield "Goodman's relation, c/a = {:g}".format(c), punch.friction / 0.5 / goodman_friction(c) - 1.0, 2e-3
    for beta in (0.2, 0.5):
        coarse, fine = (SpencePunch(0.5, beta, rings=n).friction for n in (70, 140))
        yield "the punch's rings, beta = {:g}".format(beta), coarse / fine - 1.0, 2e-3
        stick = SpencePunch(1.0, beta)
        force = stick.load_ratio / stick.approach_ratio
        yield "no slip: Mossakovskii's load, beta = {:g}".format(beta), force / full_stick_load(beta) - 1.0, 2e-3


def self_check():
    """Print errors and bounds, return the number of failures."""
    failed = 0
    for name, error, bound in [*_check_loops(), *_check_punch()]:
        bad = not abs(error) <= bound
        failed += bad
        print("{:60s} {:10.2e}  (<= {:.0e}){}".format(name, abs(error), bound, "  FAILED" if bad else ""))
    return failed


if __name__ == "__main__":
    sys.exit(1 if self_check() else 0)

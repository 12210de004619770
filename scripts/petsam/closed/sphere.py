"""Closed solutions for elastic bodies in contact: spheres under normal load, tangential force and torque, and
the flat punch with a rounded edge under normal load.

Conventions
-----------
SI units. A contact of two half-spaces, loaded through body 1; r is the distance from the contact's
centre. Displacements, rotations and slips are relative (body 1 against body 2), so both bodies'
compliances add: the functions take sums such as ``1/G1 + 1/G2``. Shear q is positive in the direction
of the positive load, slip is ``s = u_t - rigid`` and therefore opposite to the shear: under a positive
T_x, q_x >= 0 and s_x <= 0; under a positive M_z, q_theta >= 0.

The tangential and torsional solutions suppose that the normal load comes first and stays constant, that
the pressure is Hertz's, and that normal and tangential displacements do not couple (similar materials).

All functions accept numpy arrays wherever the argument is a coordinate. Run as a program, this file
compares every formula with a numerical quadrature and fails when one disagrees.

References
----------
- K. L. Johnson, Contact Mechanics, Cambridge University Press, 1985, chapters 3, 4 and 7.
- R. D. Mindlin, Compliance of elastic bodies in contact, J. Appl. Mech. 16 (1949) 259-268.
- J. L. Lubkin, The torsion of elastic spheres in contact, J. Appl. Mech. 18 (1951) 183-187.
- M. Hetenyi and P. H. McDonald, Contact stresses under combined pressure and twist, J. Appl. Mech. 25
  (1958) 396-401.
- I. N. Sneddon, The relation between load and penetration in the axisymmetric Boussinesq problem for a
  punch of arbitrary profile, Int. J. Eng. Sci. 3 (1965) 47-57.
- M. Ciavarella, D. A. Hills, G. Monno, The influence of rounded edges on indentation by a flat punch,
  Proc. Inst. Mech. Eng. C 212 (1998) 319-327.
"""
import sys
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq
from scipy.special import ellipe, ellipeinc, ellipkinc, ellipkm1

GAUSS_NODES, GAUSS_WEIGHTS = np.polynomial.legendre.leggauss(80)


# ---------------------------------------------------------------- material and Hertz

def shear_modulus(young, poisson):
    """Shear modulus G of one body, Pa, from Young's modulus (Pa) and Poisson's ratio."""
    return young / (2.0 * (1.0 + poisson))


def effective_modulus(young1, poisson1, young2, poisson2):
    """E*, Pa: 1/E* = (1 - nu1^2)/E1 + (1 - nu2^2)/E2 (Johnson eq. 4.3)."""
    return 1.0 / ((1.0 - poisson1**2) / young1 + (1.0 - poisson2**2) / young2)


def effective_radius(radius1, radius2):
    """R, m: 1/R = 1/R1 + 1/R2; an infinite radius is a flat."""
    return 1.0 / (1.0 / radius1 + 1.0 / radius2)


class Hertz(NamedTuple):
    """Hertz's contact: contact radius (m), greatest pressure (Pa), approach of the bodies (m)."""

    radius: float
    pressure: float
    approach: float


def hertz(load_n, radius, e_star):
    """Hertz's contact under load_n (N), effective radius (m), E* (Pa); Johnson eqs 4.22 to 4.24."""
    a = np.cbrt(3.0 * load_n * radius / (4.0 * e_star))
    return Hertz(a, 3.0 * load_n / (2.0 * np.pi * a**2), a**2 / radius)


def hertz_pressure(r, a, p0):
    """Pressure p0 sqrt(1 - r^2/a^2), Pa, at r (m); 0 outside the contact radius a (m)."""
    return p0 * np.sqrt(np.clip(1.0 - (np.asarray(r, dtype=float) / a)**2, 0.0, None))


# ---------------------------------------------------------------- Cattaneo and Mindlin

def tangential_compliance(g1, poisson1, g2, poisson2):
    """Sum over both bodies of (2 - nu)/(4 G), 1/Pa: a uniform direction's mean tangential compliance."""
    return (2.0 - poisson1) / (4.0 * g1) + (2.0 - poisson2) / (4.0 * g2)


def cattaneo_stick_radius(load_ratio, a):
    """Stick radius c = a (1 - T/(mu N))^(1/3), m; load_ratio = T/(mu N) in [0, 1] (Johnson eq. 7.40)."""
    return a * np.cbrt(1.0 - load_ratio)


def cattaneo_shear(r, a, c, mu_p0):
    """Shear q_x, Pa, at r (m): Hertz's shape of height mu_p0 (Pa) on a, less that of height mu_p0 c/a on c."""
    return hertz_pressure(r, a, mu_p0) - (hertz_pressure(r, c, mu_p0 * c / a) if c > 0.0 else 0.0)


def cattaneo_displacement(a, c, mu_p0, compliance):
    """Relative tangential displacement d_x of the bodies, m (Johnson eq. 7.42).

    compliance (1/Pa) is that of tangential_compliance(); c = 0 gives the displacement at gross slip.
    """
    return 0.5 * np.pi * compliance * mu_p0 * (a**2 - c**2) / a


def cattaneo_slip(r, a, c, mu_p0, compliance, anisotropy=0.0, angle=0.0):
    """Slip s_x <= 0, m, of the Cattaneo-Mindlin shear at (r, angle) in the contact; 0 for r <= c.

    r in m, angle in rad from the direction of the force, compliance of tangential_compliance() in 1/Pa.
    With the default anisotropy = 0 this is the mean over all angles, and it is exact for nu = 0. With
    anisotropy = sum of nu/(4 G) over both bodies (1/Pa) it is u_x minus the rigid displacement for the
    given nu (from Johnson eqs 3.91a and 3.91b). For nu > 0 neither is an exact solution of the contact
    problem, because there the shear q_y is not zero.
    """
    r = np.asarray(r, dtype=float)
    outside = np.maximum(r, c)
    inverse = np.divide(c, outside, out=np.zeros_like(outside), where=outside > 0.0)
    arc, root = np.arcsin(inverse), inverse * np.sqrt(1.0 - inverse**2)
    mean = 0.25 * np.pi * (2.0 * a**2 - r**2) - 0.5 * ((2.0 * c**2 - r**2) * arc + r**2 * root)
    mean -= 0.5 * np.pi * (a**2 - c**2)
    lobes = 0.25 * (0.5 * np.pi * r**2 - r**2 * arc - (2.0 * c**2 - r**2) * root)
    slip = mu_p0 / a * (compliance * mean + anisotropy * np.cos(2.0 * np.asarray(angle)) * lobes)
    return np.where((r > c) & (r <= a), slip, 0.0)


# ---------------------------------------------------------------- Lubkin
#
# A twist beta of a disc of radius s that sticks all over gives q = (4 G beta/pi) r/sqrt(s^2 - r^2)
# (Reissner and Sagoci). Discs of all radii from c to a, with twists f(s) ds, turn r < c as a whole; the
# shear is mu p on c < r < a when f(s) = (mu p0/(2 G)) E(k)/s, k^2 = 1 - s^2/a^2. Everything below follows.

def torsion_limit(load_n, friction, a):
    """Greatest torque 3 pi/16 mu N a, N m, at which all of the contact slips."""
    return 3.0 * np.pi / 16.0 * friction * load_n * a


def lubkin_torque_ratio(stick_ratio):
    """M_z/M_lim for stick_ratio = c/a: 64/(3 pi^2) times the integral of t^2 E(k) over [c/a, 1], k^2 = 1 - t^2."""
    x = np.asarray(stick_ratio, dtype=float)[..., None]
    t = 0.5 * (1.0 + x + (1.0 - x) * GAUSS_NODES)
    integral = 0.5 * (1.0 - x[..., 0]) * np.sum(GAUSS_WEIGHTS * t**2 * ellipe(1.0 - t**2), axis=-1)
    return 64.0 / (3.0 * np.pi**2) * integral


def lubkin_stick_radius(torque_ratio, a):
    """Stick radius c, m, for torque_ratio = M_z/M_lim in [0, 1]."""
    if not 0.0 <= torque_ratio <= 1.0:
        raise ValueError("torque_ratio must be in [0, 1], got {!r}".format(torque_ratio))
    if torque_ratio in (0.0, 1.0):
        return a * (1.0 - torque_ratio)
    return a * brentq(lambda x: float(lubkin_torque_ratio(x)) - torque_ratio, 0.0, 1.0, xtol=1e-14)


def lubkin_shear(r, a, c, mu_p0):
    """Shear q_theta, Pa, at r (m) for stick radius c: mu p outside c, and for r < c

    q = mu p {1 + (2/pi) [(K - E) F(phi, k') - K E(phi, k')]},
    k' = c/a, K and E of modulus sqrt(1 - k'^2), sin(phi) = sqrt((c^2 - r^2)/(a^2 - r^2))/k'.
    """
    full = hertz_pressure(r, a, mu_p0)
    if c <= 0.0:
        return full
    if c >= a:
        return np.zeros_like(full)
    inside = np.minimum(np.asarray(r, dtype=float), c)
    phi = np.arcsin(np.clip(np.sqrt((c**2 - inside**2) / (a**2 - inside**2)) * a / c, 0.0, 1.0))
    m = (c / a)**2
    big_k, big_e = ellipkm1(m), ellipe(1.0 - m)
    stick = (big_k - big_e) * ellipkinc(phi, m) - big_k * ellipeinc(phi, m)
    return full * (1.0 + 2.0 / np.pi * stick)


def lubkin_twist(a, c, mu_p0, compliance):
    """Relative rotation r_z of the bodies, rad: (mu p0/2) (1/G1 + 1/G2) [K(k) - E(k)], k^2 = 1 - c^2/a^2.

    compliance is 1/G1 + 1/G2 in 1/Pa. Infinite at c = 0: the limit torque is approached, not reached.
    """
    m = (c / a)**2
    return 0.5 * mu_p0 * compliance * (ellipkm1(m) - ellipe(1.0 - m))


# ---------------------------------------------------------------- flat punch with a rounded edge
#
# Separation h = 0 for r <= c, (r - c)^2/(2 R) beyond. The pressure is a sum of rigid flat punches of all radii s
# from c to the contact radius a, each of which presses a disc down by d(delta): E* d(delta)/(pi sqrt(s^2 - r^2)).
# They give the surface the shape h when delta is Abel's transform of it, delta(s) = s int_0^s h'(r)/sqrt(s^2 - r^2) dr:
#   delta(s)  = (s/R) [sqrt(s^2 - c^2) - c arccos(c/s)]
#   delta'(s) = (1/R) [2 sqrt(s^2 - c^2) - c arccos(c/s)] = (1/R) F(v),  F(v) = 2 v - c arctan(v/c), v^2 = s^2 - c^2.
# c = 0 gives Hertz.

def _rounded_punch_slope(v, c):
    """R delta'(s) = 2 v - c arctan(v/c), m, at v = sqrt(s^2 - c^2) (m)."""
    return 2.0 * v - c * np.arctan2(v, c)


def rounded_punch_gap(r, c, edge_radius):
    """Separation h, m, of the undeformed surfaces at r (m): flat up to c, of radius edge_radius beyond."""
    return np.clip(np.asarray(r, dtype=float) - c, 0.0, None)**2 / (2.0 * edge_radius)


def rounded_punch_approach(a, c, edge_radius):
    """Approach of the bodies, m, at contact radius a >= c (m)."""
    return a / edge_radius * (np.sqrt(a**2 - c**2) - c * np.arccos(c / a))


def rounded_punch_load(a, c, edge_radius, e_star):
    """Normal load, N, at contact radius a >= c (m): 2 E* times the integral of s delta'(s) over [c, a]."""
    b = np.sqrt(a**2 - c**2)
    return 2.0 * e_star / edge_radius * (2.0 / 3.0 * b**3 - 0.5 * c * a**2 * np.arccos(c / a) + 0.5 * c**2 * b)


def rounded_punch_radius(load_n, c, edge_radius, e_star):
    """Contact radius a, m, under load_n (N)."""
    low, high = c, c + np.cbrt(3.0 * load_n * edge_radius / (4.0 * e_star))
    while rounded_punch_load(high, c, edge_radius, e_star) < load_n:
        low, high = high, 2.0 * high
    return brentq(lambda a: rounded_punch_load(a, c, edge_radius, e_star) - load_n, low, high, xtol=1e-15, rtol=1e-14)


def rounded_punch_pressure(r, a, c, edge_radius, e_star):
    """Pressure, Pa, at r (m), 0 for r > a: E*/pi times the integral of delta'(s)/sqrt(s^2 - r^2) over [max(r, c), a].

    With v = e sinh(t) for r < c and v = e cosh(t) for r > c, e^2 = |c^2 - r^2|, the integral is that of the
    smooth function F(v) v/s over t, for which Gauss's rule is exact to rounding.
    """
    r = np.asarray(r, dtype=float)[..., None]
    b, flat = np.sqrt(a**2 - c**2), r < c
    e = np.sqrt(np.maximum(np.abs(c**2 - r**2), (1e-9 * a)**2))
    ratio = np.where(r < a, b / e, 1.0)
    end = np.where(flat, np.arcsinh(ratio), np.arccosh(np.maximum(ratio, 1.0)))
    t = 0.5 * end * (1.0 + GAUSS_NODES)
    v = e * np.where(flat, np.sinh(t), np.cosh(t))
    integral = np.sum(0.5 * end * GAUSS_WEIGHTS * _rounded_punch_slope(v, c) * v / np.sqrt(v**2 + c**2), axis=-1)
    return e_star / (np.pi * edge_radius) * np.where(r[..., 0] < a, integral, 0.0)


def rounded_punch_torsion_limit(a, c, edge_radius, e_star, friction):
    """Greatest torque, N m, at which all slips: mu E* pi/2 times the integral of s^2 delta'(s) over [c, a].

    (The flat punch of radius s under N carries mu N pi s/4.)
    """
    b = np.sqrt(a**2 - c**2)
    v = 0.5 * b * (1.0 + GAUSS_NODES)
    integral = 0.5 * b * np.sum(GAUSS_WEIGHTS * np.sqrt(v**2 + c**2) * v * _rounded_punch_slope(v, c))
    return 0.5 * np.pi * friction * e_star / edge_radius * integral


# ---------------------------------------------------------------- self-check by quadrature

def _segments(breaks):
    """Gauss points and weights on the intervals of breaks (..., n), with square-root ends removed."""
    t = 0.25 * np.pi * (1.0 + GAUSS_NODES)
    low, width = breaks[..., :-1, None], np.diff(breaks)[..., None]
    points = low + width * np.sin(t)**2
    weights = width * 0.25 * np.pi * np.sin(2.0 * t) * GAUSS_WEIGHTS
    shape = breaks.shape[:-1] + (-1,)
    return points.reshape(shape), weights.reshape(shape)


def _displacement(x0, angle0, a, c, traction, poisson, directions=4000):
    """Surface displacement (u_x, u_y), m, times G of one half-space, by polar quadrature about the point.

    traction(x, y) gives (q_x, q_y) on r < a and may have a kink at r = c. The point (polar x0, angle0) is
    inside a. The area element removes the singularity of the point-force solution (Johnson eqs 3.75).
    """
    px, py = x0 * np.cos(angle0), x0 * np.sin(angle0)
    angle = 2.0 * np.pi * (np.arange(directions) + 0.5) / directions
    ca, sa = np.cos(angle), np.sin(angle)
    along = px * ca + py * sa

    def crossings(radius):
        root = np.sqrt(np.clip(along**2 - x0**2 + radius**2, 0.0, None))
        return np.clip(-along - root, 0.0, None), np.clip(-along + root, 0.0, None)

    breaks = np.stack([np.zeros_like(angle), *crossings(c), crossings(a)[1]], axis=-1)
    rho, weight = _segments(breaks)
    qx, qy = traction(px + rho * ca[:, None], py + rho * sa[:, None])
    qx, qy = np.sum(weight * qx, axis=1), np.sum(weight * qy, axis=1)
    shared = poisson * (ca * qx + sa * qy)
    ux, uy = (1.0 - poisson) * qx + shared * ca, (1.0 - poisson) * qy + shared * sa
    return np.sum(ux) / directions, np.sum(uy) / directions


def _swirl(shear):
    """Traction (q_x, q_y) at (x, y) of a circumferential shear(r)."""
    def traction(x, y):
        r = np.hypot(x, y)
        return -y / r * shear(r), x / r * shear(r)
    return traction


def _check_hertz():
    """Errors of Hertz's total load and of the values of Table 1, each against 1."""
    h = hertz(1000.0, effective_radius(0.2, 0.2), effective_modulus(210e9, 0.3, 210e9, 0.3))
    r, w = _segments(np.array([0.0, h.radius]))
    force = 2.0 * np.pi * np.sum(w * r * hertz_pressure(r, h.radius, h.pressure))
    limit = torsion_limit(1000.0, 0.1, h.radius)
    yield "Hertz: integral of p is N", force / 1000.0 - 1.0, 1e-10
    yield "Hertz: a of Table 1 (0.8662 mm)", h.radius / 0.8662e-3 - 1.0, 1e-4
    yield "Hertz: p0 of Table 1 (636.3057 MPa)", h.pressure / 636.3057e6 - 1.0, 1e-6
    yield "limit torque of Table 1 (51.0257 N mm)", limit / 51.0257e-3 - 1.0, 1e-5


def _check_cattaneo(ratio, poisson):
    """Errors of force, rigid displacement and slip for a = mu p0 = G = 1 and one elastic body."""
    c = cattaneo_stick_radius(ratio, 1.0)
    compliance, anisotropy = (2.0 - poisson) / 4.0, poisson / 4.0
    rigid = cattaneo_displacement(1.0, c, 1.0, compliance)
    label = "Cattaneo T = {:g} mu N, nu = {:g}: ".format(ratio, poisson)
    r, w = _segments(np.array([0.0, c, 1.0]))
    yield label + "integral of q", 3.0 * np.sum(w * r * cattaneo_shear(r, 1.0, c, 1.0)) - ratio, 1e-10

    def traction(x, y):
        q = cattaneo_shear(np.hypot(x, y), 1.0, c, 1.0)
        return q, np.zeros_like(q)

    for radius, angle in ((0.0, 0.0), (0.9 * c, 0.4), (0.5 * (1.0 + c), 0.0), (0.5 * (1.0 + c), 1.2), (0.99, 2.0)):
        slip = _displacement(radius, angle, 1.0, c, traction, poisson)[0] - rigid
        closed = cattaneo_slip(radius, 1.0, c, 1.0, compliance, anisotropy, angle)
        yield label + "slip at r = {:.3f}, angle {:g}".format(radius, angle), (slip - closed) / rigid, 1e-6


def _check_lubkin(ratio):
    """Errors of torque, continuity and of the rigid rotation of the stick disc, for a = mu p0 = G = 1."""
    c = lubkin_stick_radius(ratio, 1.0)
    twist = lubkin_twist(1.0, c, 1.0, 1.0)
    label = "Lubkin M = {:g} M_lim: ".format(ratio)
    r, w = _segments(np.array([0.0, c, 1.0]))
    torque = 2.0 * np.pi * np.sum(w * r**2 * lubkin_shear(r, 1.0, c, 1.0)) / (np.pi**2 / 8.0)
    yield label + "integral of r q", torque - ratio, 1e-7
    jump = np.diff(lubkin_shear(np.array([c * (1.0 - 1e-12), c * (1.0 + 1e-12)]), 1.0, c, 1.0))[0]
    yield label + "q continuous at c", jump, 1e-5
    for fraction in (0.05, 0.3, 0.6, 0.9, 0.99):
        u = _displacement(fraction * c, 0.0, 1.0, c, _swirl(lambda s: lubkin_shear(s, 1.0, c, 1.0)), 0.3)[1]
        yield label + "u_theta = beta r at r = {:g} c".format(fraction), u / (twist * fraction * c) - 1.0, 1e-6
    u = _displacement(0.5 * (1.0 + c), 0.0, 1.0, c, _swirl(lambda s: lubkin_shear(s, 1.0, c, 1.0)), 0.3)[1]
    yield label + "slip opposes q", min(0.0, twist * 0.5 * (1.0 + c) - u), 0.0


def _check_lubkin_limits():
    """Errors against full stick (Reissner and Sagoci) at a small torque, and gross slip at the limit."""
    ratio = 1e-4
    c, torque = lubkin_stick_radius(ratio, 1.0), ratio * np.pi**2 / 8.0
    r = np.linspace(0.05, 0.8, 6)
    stick = 3.0 * torque * r / (4.0 * np.pi * np.sqrt(1.0 - r**2))
    shear, twist = lubkin_shear(r, 1.0, c, 1.0), lubkin_twist(1.0, c, 1.0, 1.0)
    yield "Lubkin, small torque: full-stick shear", np.max(np.abs(shear / stick - 1.0)), 1e-3
    yield "Lubkin, small torque: twist 3 M/(16 G a^3)", twist / (3.0 * torque / 16.0) - 1.0, 1e-3
    yield "Lubkin, c = 0: M = 3 pi/16 mu N a", float(lubkin_torque_ratio(0.0)) - 1.0, 1e-10
    r = np.linspace(0.1, 0.95, 6)
    ratio = lubkin_shear(r, 1.0, 1e-9, 1.0) / hertz_pressure(r, 1.0, 1.0)
    yield "Lubkin, c -> 0: q = mu p", np.max(np.abs(ratio - 1.0)), 1e-9


def _ring_displacement(x0, breaks, pressure):
    """E* times the surface displacement u_z, m Pa, at radius x0 (one of breaks) under pressure(r) (Pa), ring by ring.

    The potential of a ring of radius s is 4 s K(m)/(r + s), 1 - m = ((r - s)/(r + s))^2.
    """
    s, w = _segments(np.unique(breaks))
    return 4.0 / np.pi * np.sum(w * pressure(s) * s / (x0 + s) * ellipkm1(((x0 - s) / (x0 + s))**2))


def _check_rounded_punch():
    """Errors of load, surface shape and limit torque for Table 3 (one N and one a hundred times that), and of c = 0."""
    c, edge_radius, e_star = 0.02, 0.2, effective_modulus(210e9, 0.3, 210e9, 0.3)
    for load in (1e6, 1e8):
        a = rounded_punch_radius(load, c, edge_radius, e_star)
        approach, label = rounded_punch_approach(a, c, edge_radius), "rounded punch, {:g} N: ".format(load)

        def pressure(r, a=a):
            return rounded_punch_pressure(r, a, c, edge_radius, e_star)

        r, w = _segments(np.array([0.0, c, a]))
        yield label + "integral of p is N", 2.0 * np.pi * np.sum(w * r * pressure(r)) / load - 1.0, 1e-8
        limit = rounded_punch_torsion_limit(a, c, edge_radius, e_star, 0.1)
        yield label + "limit torque", 0.2 * np.pi * np.sum(w * r**2 * pressure(r)) / limit - 1.0, 1e-8
        for radius in (0.0, 0.5 * c, c, 0.5 * (a + c), 0.99 * a, a):
            u = _ring_displacement(radius, [0.0, radius, c, a], pressure) / e_star
            gap = u + rounded_punch_gap(radius, c, edge_radius) - approach
            yield label + "u + h = approach at r = {:.3f} a".format(radius / a), gap / approach, 1e-6
        for ratio in (1.01, 1.5):
            u = _ring_displacement(ratio * a, [0.0, c, a], pressure) / e_star
            gap = u + rounded_punch_gap(ratio * a, c, edge_radius) - approach
            yield label + "open at r = {:g} a".format(ratio), min(0.0, gap / approach), 0.0
    h = hertz(1000.0, 0.1, e_star)
    r = np.linspace(0.0, 1.1, 12) * h.radius
    yield "rounded punch, c = 0: Hertz's radius", rounded_punch_radius(1000.0, 0.0, 0.1, e_star) / h.radius - 1.0, 1e-10
    p = rounded_punch_pressure(r, h.radius, 0.0, 0.1, e_star) - hertz_pressure(r, h.radius, h.pressure)
    yield "rounded punch, c = 0: Hertz's pressure", np.max(np.abs(p)) / h.pressure, 1e-10
    limit = rounded_punch_torsion_limit(h.radius, 0.0, 0.1, e_star, 0.1) / torsion_limit(1000.0, 0.1, h.radius)
    yield "rounded punch, c = 0: limit torque of the sphere", limit - 1.0, 1e-10


def self_check():
    """Compare every formula with quadrature or its limits, print errors and bounds, return the number of failures."""
    checks = list(_check_hertz())
    for ratio in (0.1, 0.6, 0.95):
        checks += [*_check_cattaneo(ratio, 0.0), *_check_cattaneo(ratio, 0.3), *_check_lubkin(ratio)]
    checks += [*_check_lubkin_limits(), *_check_rounded_punch()]
    failed = 0
    for name, error, bound in checks:
        bad = not abs(error) <= bound
        failed += bad
        print("{:60s} {:10.2e}  (<= {:.0e}){}".format(name, abs(error), bound, "  FAILED" if bad else ""))
    return failed


if __name__ == "__main__":
    sys.exit(1 if self_check() else 0)

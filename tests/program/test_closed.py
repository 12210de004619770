"""The closed-form solutions of petsam.closed against quadrature, limits and each other, which share nothing with them.

Each check yields (what, error, bound).
"""

import numpy as np
import pytest
from scipy.special import ellipkm1

from petsam.closed.adhesion import adhesion
from petsam.closed.cattaneo import cattaneo_displacement, cattaneo_shear, cattaneo_slip, cattaneo_stick_radius
from petsam.closed.ellipse import hertz_ellipse, hertz_radii
from petsam.closed.loop import (
    first_loading,
    masing_displacement,
    partial_loop_energy,
    sliding_loop_energy,
    sliding_masing_load,
)
from petsam.closed.lubkin import lubkin_shear, lubkin_stick_radius, lubkin_torque_ratio, lubkin_twist, torsion_limit
from petsam.closed.materials import Bodies, effective_modulus, effective_radius, tangential_compliance
from petsam.closed.normal import hertz, hertz_pressure
from petsam.closed.plane import PlaneCells, contact_under_moment, plane_pressure, plane_shear, plane_tilt, stick_zone
from petsam.closed.punch import Punch, punch_approach, punch_pressure, punch_radius, punch_torsion_limit
from petsam.closed.quadrature import segments
from petsam.closed.spence import SpencePunch, goodman_friction
from petsam.closed.sphere import Spheres
from petsam.closed.stress import HERTZ_MISES, HERTZ_MISES_DEPTH, hertz_axis, hertz_surface, sliding_surface


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
    rho, weight = segments(breaks)
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
    """Errors of Hertz's total load and of the values of Table 1, each relative to 1."""
    h = hertz(1000.0, effective_radius(0.2, 0.2), effective_modulus(210e9, 0.3, 210e9, 0.3))
    r, w = segments(np.array([0.0, h.radius]))
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
    label = f"Cattaneo T = {ratio:g} mu N, nu = {poisson:g}: "
    r, w = segments(np.array([0.0, c, 1.0]))
    yield label + "integral of q", 3.0 * np.sum(w * r * cattaneo_shear(r, 1.0, c, 1.0)) - ratio, 1e-10

    def traction(x, y):
        q = cattaneo_shear(np.hypot(x, y), 1.0, c, 1.0)
        return q, np.zeros_like(q)

    for radius, angle in ((0.0, 0.0), (0.9 * c, 0.4), (0.5 * (1.0 + c), 0.0), (0.5 * (1.0 + c), 1.2), (0.99, 2.0)):
        slip = _displacement(radius, angle, 1.0, c, traction, poisson)[0] - rigid
        closed = cattaneo_slip(radius, 1.0, c, 1.0, compliance, anisotropy, angle)
        yield label + f"slip at r = {radius:.3f}, angle {angle:g}", (slip - closed) / rigid, 1e-6


def _check_lubkin(ratio):
    """Errors of torque, continuity and of the rigid rotation of the stick disc, for a = mu p0 = G = 1."""
    c = lubkin_stick_radius(ratio, 1.0)
    twist = lubkin_twist(1.0, c, 1.0, 1.0)
    label = f"Lubkin M = {ratio:g} M_lim: "
    r, w = segments(np.array([0.0, c, 1.0]))
    torque = 2.0 * np.pi * np.sum(w * r**2 * lubkin_shear(r, 1.0, c, 1.0)) / (np.pi**2 / 8.0)
    yield label + "integral of r q", torque - ratio, 1e-7
    jump = np.diff(lubkin_shear(np.array([c * (1.0 - 1e-12), c * (1.0 + 1e-12)]), 1.0, c, 1.0))[0]
    yield label + "q continuous at c", jump, 1e-5
    for fraction in (0.05, 0.3, 0.6, 0.9, 0.99):
        u = _displacement(fraction * c, 0.0, 1.0, c, _swirl(lambda s: lubkin_shear(s, 1.0, c, 1.0)), 0.3)[1]
        yield label + f"u_theta = beta r at r = {fraction:g} c", u / (twist * fraction * c) - 1.0, 1e-6
    u = _displacement(0.5 * (1.0 + c), 0.0, 1.0, c, _swirl(lambda s: lubkin_shear(s, 1.0, c, 1.0)), 0.3)[1]
    yield label + "slip opposes q", min(0.0, twist * 0.5 * (1.0 + c) - u), 0.0


def _check_lubkin_limits():
    """Errors relative to full stick (Reissner and Sagoci) at a small torque, and to gross slip at the limit."""
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
    s, w = segments(np.unique(breaks))
    return 4.0 / np.pi * np.sum(w * pressure(s) * s / (x0 + s) * ellipkm1(((x0 - s) / (x0 + s)) ** 2))


def _check_rounded_punch():
    """Errors of load, surface shape and limit torque for Table 3 (one N and one a hundred times that), and of c = 0."""
    e_star = effective_modulus(210e9, 0.3, 210e9, 0.3)
    punch = Punch(0.02, 0.2, e_star)
    c = punch.c
    for load in (1e6, 1e8):
        a = punch_radius(punch, load)
        approach, label = punch_approach(punch, a), f"rounded punch, {load:g} N: "

        def pressure(r, a=a):
            return punch_pressure(r, punch, a)

        r, w = segments(np.array([0.0, c, a]))
        yield label + "integral of p is N", 2.0 * np.pi * np.sum(w * r * pressure(r)) / load - 1.0, 1e-8
        limit = punch_torsion_limit(punch, a, 0.1)
        yield label + "limit torque", 0.2 * np.pi * np.sum(w * r**2 * pressure(r)) / limit - 1.0, 1e-8
        for radius in (0.0, 0.5 * c, c, 0.5 * (a + c), 0.99 * a, a):
            u = _ring_displacement(radius, [0.0, radius, c, a], pressure) / e_star
            gap = u + punch.gap(radius) - approach
            yield label + f"u + h = approach at r = {radius / a:.3f} a", gap / approach, 1e-6
        for ratio in (1.01, 1.5):
            u = _ring_displacement(ratio * a, [0.0, c, a], pressure) / e_star
            gap = u + punch.gap(ratio * a) - approach
            yield label + f"open at r = {ratio:g} a", min(0.0, gap / approach), 0.0
    h, round_one = hertz(1000.0, 0.1, e_star), Punch(0.0, 0.1, e_star)
    r = np.linspace(0.0, 1.1, 12) * h.radius
    yield "rounded punch, c = 0: Hertz's radius", punch_radius(round_one, 1000.0) / h.radius - 1.0, 1e-10
    p = punch_pressure(r, round_one, h.radius) - hertz_pressure(r, h.radius, h.pressure)
    yield "rounded punch, c = 0: Hertz's pressure", np.max(np.abs(p)) / h.pressure, 1e-10
    limit = punch_torsion_limit(round_one, h.radius, 0.1) / torsion_limit(1000.0, 0.1, h.radius)
    yield "rounded punch, c = 0: limit torque of the sphere", limit - 1.0, 1e-10


def _check_loops():
    for t in (0.2, 0.8, 1.0):
        load, weight = np.polynomial.legendre.leggauss(400)
        up = masing_displacement(t * load, -t, -float(first_loading(t, 1.0, 1.0)), 1.0, 1.0)
        down = masing_displacement(t * load, t, float(first_loading(t, 1.0, 1.0)), 1.0, 1.0)
        # the area between the branches, displacement over force
        area = t * np.sum(weight * (down - up))
        yield f"loop energy, T = {t:g} mu N", partial_loop_energy(t, 1.0, 1.0) / area - 1.0, 1e-5
        yield (
            f"the loop closes, T = {t:g} mu N",
            float(masing_displacement(-t, t, first_loading(t, 1.0, 1.0), 1.0, 1.0) + first_loading(t, 1.0, 1.0)),
            1e-14,
        )
    d = np.linspace(-2.0, 2.0, 400001)
    down = sliding_masing_load(d, 1.0, 2.0, 1.0, 1.0)
    up = sliding_masing_load(d, -1.0, -2.0, 1.0, 1.0)
    area = np.sum(0.5 * ((down - up)[1:] + (down - up)[:-1])) * (d[1] - d[0])
    yield "sliding loop energy", sliding_loop_energy(2.0, 1.0, 1.0) / abs(area) - 1.0, 1e-7
    # Johnson 7.59 with G = 1, nu = 0.3, mu = 1, N = 1, a = 1, both bodies
    gross = cattaneo_displacement(1.0, 0.0, 1.5 / np.pi, tangential_compliance(1.0, 0.3, 1.0, 0.3))
    t = 0.6
    johnson = 0.9 * 2.0 * 1.7 * (1.0 - 0.4 ** (5.0 / 3.0) - 5.0 * t / 6.0 * (1.0 + 0.4 ** (2.0 / 3.0)))
    yield "Johnson's form of the loop energy", partial_loop_energy(t, 1.0, gross) / johnson - 1.0, 1e-12


def _check_spence():
    plain = SpencePunch(0.5, 1e-6)
    yield (
        "no coupling: approach, load, pressure of Hertz",
        np.max(np.abs(np.array([plain.approach_ratio, plain.load_ratio, plain.pressure_ratio]) - 1.0)),
        1e-4,
    )
    r = np.array([0.1, 0.5, 0.9])
    yield "no coupling: Hertz's pressure", np.max(np.abs(plain.sphere(r)[0] / np.sqrt(1.0 - r**2) - 1.0)), 1e-4
    for c in (0.2, 0.5, 0.8):
        punch = SpencePunch(c, 0.5, coupled=False)
        yield f"Goodman's relation, c/a = {c:g}", punch.friction / 0.5 / goodman_friction(c) - 1.0, 2e-3
    for beta in (0.2, 0.5):
        coarse, fine = (SpencePunch(0.5, beta, rings=n).friction for n in (70, 140))
        yield f"the punch's rings, beta = {beta:g}", coarse / fine - 1.0, 2e-3
        stick = SpencePunch(1.0, beta)
        force = stick.load_ratio / stick.approach_ratio
        yield f"no slip: Mossakovskii's load, beta = {beta:g}", force * beta / np.arctanh(beta) - 1.0, 2e-3


def _quadrature(breaks):
    """Gauss points and weights on the intervals of sorted breaks, clustered towards both ends of each."""
    nodes, weights = np.polynomial.legendre.leggauss(120)
    t = 0.5 * (1.0 + nodes)
    points, scale = t**4 * (35.0 - 84.0 * t + 70.0 * t**2 - 20.0 * t**3), 140.0 * (t * (1.0 - t)) ** 3
    low, width = breaks[:-1, None], np.diff(breaks)[:, None]
    return (low + width * points).ravel(), (0.5 * width * weights * scale).ravel()


def _plane_displacement(x, traction, breaks, e_star):
    """Surface displacement at x, m, up to a constant: -(2/(pi E*)) times the integral of traction(s) ln|x - s|."""
    s, w = _quadrature(np.unique(np.append(breaks, x)))
    return -2.0 / (np.pi * e_star) * np.sum(w * traction(s) * np.log(np.maximum(np.abs(x - s), 1e-300)))


def _check_plane(punch, load, eccentricity, ratio, friction=0.1):
    """Errors of load, moment, shape and partial slip at M' = eccentricity P' and Q' = ratio mu P'."""
    contact = contact_under_moment(punch, load, eccentricity * load)
    label = f"e = {eccentricity / (punch.c or 1.0):g} c, c = {punch.c / contact.half_width:g} a: "
    ends, tilt = contact.ends, plane_tilt(punch, contact)
    stick = stick_zone(punch, contact, ratio * friction * load, friction)
    inner = [edge for edge in (-punch.c, punch.c) if ends[0] < edge < ends[1]]
    breaks = np.array(sorted([*ends, *stick.ends, *inner]))

    def pressure(x):
        return plane_pressure(x, punch, contact)

    def shear(x):
        return plane_shear(x, punch, contact, stick, friction)

    def gap(x):
        return _plane_displacement(x, pressure, breaks, punch.e_star) + punch.gap(x) - tilt * x

    s, w = _quadrature(breaks)
    yield label + "integral of p is P'", np.sum(w * pressure(s)) / load - 1.0, 1e-9
    yield label + "integral of x p is M'", (np.sum(w * s * pressure(s)) / load - eccentricity) / ends[1], 1e-9
    yield label + "integral of q is Q'", np.sum(w * shear(s)) / (ratio * friction * load) - 1.0, 1e-9
    m, a = contact
    scale = a**2 / punch.edge_radius
    inside = np.array([gap(m + a * z) for z in (-1.0, -0.95, -0.7, -0.3, 0.1, 0.5, 0.8, 0.97, 1.0)]) / scale
    yield label + "u + h - x r constant in the contact", np.ptp(inside), 1e-8
    outside = min(gap(m + a * z) / scale - inside[0] for z in (-1.3, -1.03, 1.03, 1.3))
    yield label + "open outside", min(0.0, outside), 0.0
    m, b = stick
    compliant = np.array(
        [_plane_displacement(m + b * z, shear, breaks, punch.e_star) for z in (-1.0, -0.9, -0.4, 0.2, 0.7, 0.95, 1.0)]
    ) / (friction * scale)
    yield label + "u_x constant in the stick zone", np.ptp(compliant), 1e-8
    slip = [
        _plane_displacement(x, shear, breaks, punch.e_star) / (friction * scale) - compliant[0]
        for x in (0.5 * (ends[0] + stick.ends[0]), 0.5 * (ends[1] + stick.ends[1]))
    ]
    yield label + "slip opposes q", max(0.0, *slip), 0.0


def _check_printed(punch, load):
    """Error against the pressure of the upright punch as Ciavarella, Hills and Monno print it."""
    contact = contact_under_moment(punch, load)
    a = contact.half_width
    phi0, phi = np.arcsin(punch.c / a), np.linspace(-1.5, 1.5, 40)
    brackets = (
        (np.pi - 2.0 * phi0) * np.cos(phi)
        + np.sin(phi) * np.log(np.abs(np.sin(phi + phi0) / np.sin(phi - phi0)))
        + np.sin(phi0) * np.log(np.abs(np.tan(0.5 * (phi + phi0)) * np.tan(0.5 * (phi - phi0))))
    )
    printed = 2.0 * load / (np.pi * a * (np.pi - 2.0 * phi0 - np.sin(2.0 * phi0))) * brackets
    error = plane_pressure(a * np.sin(phi), punch, contact) / printed - 1.0
    yield "upright: p as printed", np.max(np.abs(error)), 1e-9


def _check_cylinder(load, edge_radius, e_star):
    """Errors of half width and pressure of a cylinder, c = 0, against Hertz's."""
    contact = contact_under_moment(Punch(0.0, edge_radius, e_star), load)
    a = np.sqrt(4.0 * load * edge_radius / (np.pi * e_star))
    yield "c = 0: Hertz's half width", contact.half_width / a - 1.0, 1e-10
    x = np.linspace(-0.99, 0.99, 12) * a
    error = plane_pressure(x, Punch(0.0, edge_radius, e_star), contact) * np.pi * a / (2.0 * load)
    yield "c = 0: Hertz's pressure", np.max(np.abs(error - np.sqrt(1.0 - (x / a) ** 2))), 1e-10


def _check_strips(punch, load, eccentricity, ratio, friction=0.1):
    """Errors of the strips' solution, for 300 and 600 strips."""
    contact = contact_under_moment(punch, load, eccentricity * load)
    stick = stick_zone(punch, contact, ratio * friction * load, friction)
    for count, bound in ((300, 2e-2), (600, 1e-2)):
        x = ((np.arange(count) + 0.5) / count - 0.5) * 3.2 * punch.c
        p, q, tilt, _ = PlaneCells(punch, x).partial_slip(load, eccentricity * load, ratio * friction * load, friction)
        label = f"{count} strips, e = {eccentricity / punch.c:g} c: "
        exact = plane_pressure(x, punch, contact)
        yield label + "p, L2", np.linalg.norm(p - exact) / np.linalg.norm(exact), bound
        exact = plane_shear(x, punch, contact, stick, friction)
        yield label + "q, L2", np.linalg.norm(q - exact) / np.linalg.norm(exact), bound
        yield label + "tilt", tilt / plane_tilt(punch, contact) - 1.0 if eccentricity else tilt, 1e-2


def _check_planes():
    """Errors of the plane solutions, upright and inclined."""
    punch = Punch(1e-3, 20e-3, 115.4e9)
    yield from _check_cylinder(7.4e5, 20e-3, 115.4e9)
    yield from _check_printed(punch, 7.4e5)
    for load, eccentricity, ratio in (
        (7.4e5, 0.0, 0.6),
        (7.4e5, 0.3e-3, 0.6),
        (7.4e5, 0.3e-3, 0.95),
        (7.4e5, -0.9e-3, 0.3),
        (2e4, 0.6e-3, 0.5),
    ):
        yield from _check_plane(punch, load, eccentricity, ratio)
    for eccentricity in (0.0, 0.3e-3):
        yield from _check_strips(punch, 7.4e5, eccentricity, 0.6)


def _check_axis(poisson):
    """Errors of the stresses on the axis against the point loads of Boussinesq, a = p0 = 1."""
    r, w = segments(np.array([0.0, 1.0]))
    for z in (0.1, 0.5, 2.0):
        far, load = np.hypot(r, z), w * r * hertz_pressure(r, 1.0, 1.0)
        rr = np.sum(load * ((1.0 - 2.0 * poisson) * z / far**3 - 3.0 * r**2 * z / far**5)) / 2.0
        zz = -np.sum(load * 3.0 * z**3 / far**5)
        for name, exact, found in zip(("rr", "zz"), hertz_axis(z, 1.0, 1.0, poisson), (rr, zz)):
            yield f"Hertz, axis, nu = {poisson:g}, z = {z:g}: s_{name}", found - exact, 1e-9


def _check_surface(poisson):
    """Errors of the surface stresses by Hooke's law from displacements, differences of quadratures; a = p0 = G = 1."""
    young, h = 2.0 * (1.0 + poisson), 1e-4

    def radial(r):  # the load within r presses inwards
        s, w = segments(np.array([0.0, min(r, 1.0)]))
        return -(1.0 - 2.0 * poisson) / 2.0 * np.sum(w * s * hertz_pressure(s, 1.0, 1.0)) / r

    def hooke(along, across):
        return young / (1.0 - poisson**2) * (along + poisson * across)

    for r in (0.3, 0.8, 1.7):
        e_r, e_t = (radial(r + h) - radial(r - h)) / (2.0 * h), radial(r) / r
        pressed = poisson / (1.0 - poisson) * hertz_pressure(r, 1.0, 1.0)
        exact = hertz_surface(r, 1.0, 1.0, poisson)
        label = f"Hertz, surface, nu = {poisson:g}, r = {r:g}: "
        yield label + "s_rr", hooke(e_r, e_t) - pressed - exact[0], 1e-6
        yield label + "s_tt", hooke(e_t, e_r) - pressed - exact[1], 1e-6

    def shear(x, y):
        return hertz_pressure(np.hypot(x, y), 1.0, 1.0), np.zeros_like(x)

    def shift(x, y):
        return np.array(_displacement(np.hypot(x, y), np.arctan2(y, x), 1.0, 1.0, shear, poisson))

    for x, y in ((0.4, 0.2), (-0.6, 0.3)):
        by_x, by_y = ((shift(x + h * dx, y + h * dy) - shift(x - h * dx, y - h * dy)) / (2.0 * h)
                      for dx, dy in ((1, 0), (0, 1)))  # fmt: skip
        found = hooke(by_x[0], by_y[1]), hooke(by_y[1], by_x[0]), by_y[0] + by_x[1]
        for name, exact, value in zip(("xx", "yy", "xy"), sliding_surface(x, y, 1.0, 1.0, poisson), found):
            yield f"sliding, nu = {poisson:g}, ({x:g}, {y:g}): s_{name}", value - exact, 1e-5


def _check_mises():
    """Errors of the largest von Mises stress under Hertz's pressure and of its depth."""
    z = np.linspace(0.4, 0.6, 200001)
    rr, zz = hertz_axis(z, 1.0, 1.0, 0.3)
    k = np.argmax(rr - zz)
    yield "Hertz: maximum von Mises stress", (rr - zz)[k] - HERTZ_MISES, 1e-9
    yield "Hertz: its depth", z[k] - HERTZ_MISES_DEPTH, 1e-4


def _check_ellipse(ratio):
    """Errors of displacement and load of an ellipse by quadrature along rays from a point inside."""
    load, radii, e_star = 700.0, (0.3, 0.3 * ratio), 90e9
    a, b, p0, approach = hertz_ellipse(load, *radii, e_star)
    label = f"Hertz, radii 1 to {ratio:g}: "
    yield label + "load", 2.0 / 3.0 * np.pi * a * b * p0 / load - 1.0, 1e-12
    yield label + "inverse", np.max(np.abs(np.divide(hertz_radii(a, b, load, e_star), radii) - 1.0)), 1e-10
    angle = 2.0 * np.pi * (np.arange(2000) + 0.5) / 2000
    t, w = np.polynomial.legendre.leggauss(60)
    t, w = 0.5 * (t + 1.0), 0.5 * w
    c, s = np.cos(angle) / a, np.sin(angle) / b
    for x, y in ((0.0, 0.0), (0.5 * a, 0.3 * b), (-0.2 * a, 0.7 * b)):
        square, linear, rest = c**2 + s**2, c * x / a + s * y / b, 1.0 - (x / a) ** 2 - (y / b) ** 2
        end = (np.sqrt(linear**2 + square * rest) - linear) / square
        along = end[:, None] * (1.0 - t**2)  # which takes the root at the edge away
        pressure = np.sqrt(np.maximum(rest - 2.0 * linear[:, None] * along - square[:, None] * along**2, 0.0))
        moved = p0 / (np.pi * e_star) * np.mean(np.sum(2.0 * t * w * pressure, axis=1) * end) * 2.0 * np.pi
        rigid = approach - x**2 / (2.0 * radii[0]) - y**2 / (2.0 * radii[1])
        yield label + f"displacement at ({x / a:g} a, {y / b:g} b)", moved / rigid - 1.0, 1e-6


def _check_adhesion(reach, a):
    """Errors of Maugis' load and of the gap, inside and where the tension ends, by his pressure; w = R = E* = 1."""
    (load, approach, c, _), tension = adhesion(a, 1.0, reach, 1.0, 1.0), 1.0 / reach
    label = f"Maugis, reach {reach:g}, a = {a:g}: "

    def pressure(r):
        inside = np.sqrt(np.clip(a**2 - r**2, 1e-300, None))
        pull = tension * np.arctan(np.sqrt(c**2 - a**2) / inside) * 2.0 / np.pi
        return np.where(r < a, 2.0 / np.pi * inside - pull, -tension)

    r, w = segments(np.array([0.0, a, c]))
    yield label + "load", 2.0 * np.pi * np.sum(w * r * pressure(r)) / load - 1.0, 1e-9

    def traction(x, y):
        p = pressure(np.hypot(x, y))
        return p, np.zeros_like(p)

    for at, gap in ((0.0, 0.0), (0.6 * a, 0.0), (c * (1.0 - 1e-9), reach)):
        moved = 2.0 * _displacement(at, 0.3, c, a, traction, 0.0)[0]
        yield label + f"gap at r = {at:.3f}", at**2 / 2.0 - approach + moved - gap, 1e-5


def checks():
    """All checks."""
    for reach in (0.1, 0.6, 2.0):
        for a in (0.3, 1.4):
            yield from _check_adhesion(reach, a)
    yield from _check_hertz()
    for ratio in (1.0, 0.7, 4.0, 60.0):
        yield from _check_ellipse(ratio)
    # of a contact of 6 mm by 4 mm, by the reference program of rolling contact
    found = hertz_radii(6e-3, 4e-3, 1e4, 84e9 / (1.0 - 0.28))
    yield "Hertz, radii of an ellipse", np.max(np.abs(np.divide(found, (2.51851, 1.36949)) - 1.0)), 2e-6
    for ratio in (0.1, 0.6, 0.95):
        for poisson in (0.0, 0.3):
            yield from _check_cattaneo(ratio, poisson)
        yield from _check_lubkin(ratio)
    yield from _check_lubkin_limits()
    for poisson in (0.0, 0.3):
        yield from _check_axis(poisson)
        yield from _check_surface(poisson)
    yield from _check_mises()
    yield from _check_rounded_punch()
    yield from _check_loops()
    yield from _check_spence()
    yield from _check_planes()


@pytest.mark.slow
def test_closed_solutions_agree_with_quadrature():
    found = list(checks())
    assert len(found) > 100
    wrong = [f"{name}: {error:.2e}, at most {bound:.0e}" for name, error, bound in found if not abs(error) <= bound]
    assert not wrong, "\n".join(wrong)


def test_first_loading_of_spheres_is_the_displacement_at_the_stick_radius():
    steel = dict(body1_young=210e9, body1_poisson=0.3, body2_young=70e9, body2_poisson=0.33)
    spheres = Spheres(Bodies.of(steel), 0.02, 0.4, 50.0)
    loads = np.linspace(0.0, spheres.limit, 9)
    assert spheres.first_loading(loads) == pytest.approx(
        [spheres.displacement(spheres.stick_radius(load)) for load in loads], rel=1e-12, abs=1e-18
    )


# pull-off forces and least approaches over lambda, in Maugis' units
MAUGIS = {0.1: (1.95059, -0.46935), 0.5: (1.71825, -0.91453), 1.0: (1.60073, -0.99173), 5.0: (1.50635, -0.91394)}


@pytest.mark.parametrize("stiffness", MAUGIS)
def test_an_adhering_ball_lies_between_its_limits(stiffness):
    work, radius, e_star = 0.05, 1e-3, 1e6
    k = 4 / 3 * e_star
    reach = 2 * work / (stiffness * np.cbrt(np.pi * work * k**2 / radius))
    unit = np.cbrt(np.pi * work * radius**2 / k)
    found = adhesion(np.linspace(0, 2 * unit, 4001), work, reach, radius, e_star)
    pull, least = MAUGIS[stiffness]
    assert found.pull_off == pytest.approx(pull * np.pi * work * radius, rel=1e-5)
    assert -np.min(found.load) == pytest.approx(found.pull_off, rel=1e-6) and np.min(found.load) >= -found.pull_off
    assert np.min(found.approach) == pytest.approx(least * unit**2 / radius, rel=2e-5)


@pytest.mark.parametrize("limit, near, pull", [(0.0, 1e-12, 1.5), (np.inf, 1e6, 2.0)])
def test_limits_of_adhesion_are_those_of_short_and_long_tension(limit, near, pull):
    ball = 0.05, 1e-3, 1e6  # without its reach
    a = np.array([1e-5, 5e-5, 2e-4])
    exact, close = (adhesion(a, ball[0], reach, *ball[1:]) for reach in (limit, near))
    assert exact.pull_off == pytest.approx(pull * np.pi * ball[0] * ball[1], rel=1e-12)
    assert close.load == pytest.approx(exact.load, rel=1e-3) and close.approach == pytest.approx(
        exact.approach, rel=2e-3
    )
    assert close.pull_off == pytest.approx(exact.pull_off, rel=1e-3)
    assert exact.border == pytest.approx(a if limit == 0 else np.inf)

"""A punch with rounded edges, inclined: Ciavarella, Hills and Monno; Goryacheva, Murthy and Farris."""

import mpmath as mp
from common import closed

import petsam

N, MOMENT, SHEAR, YOUNG, POISSON, FRICTION = "1.5e6", "600", "2.7e5", "210e9", "0.3", "0.3"
FLAT, EDGE = "2e-3", "50e-3"
OPTIONS = {
    "elasticity": "plane",
    "grid_n": 512,
    "grid_size": 6e-3,
    **{f"body{body}_young": YOUNG for body in (1, 2)},
    **{f"body{body}_poisson": POISSON for body in (1, 2)},
    "gap_type": "punch",
    "gap_flat_radius": FLAT,
    "gap_edge_radius": EDGE,
    "friction": FRICTION,
    "load_n": N,
    "load_my": MOMENT,
    "load_tx": SHEAR,
}


def edges(m, a):
    """Angles of the right and the left edge of the flat base."""
    c = mp.mpf(FLAT)
    return mp.acos((c - m) / a), mp.acos((-c - m) / a)


def modulus():
    return mp.mpf(YOUNG) / (1 - mp.mpf(POISSON) ** 2) / 2


def rotation(m, a):
    """The mean of h' over the angle theta: only then the pressure is bounded at both ends."""
    phi1, phi2 = edges(m, a)
    c = mp.mpf(FLAT)
    right, left = (m - c) * phi1 + a * mp.sin(phi1), (m + c) * (mp.pi - phi2) - a * mp.sin(phi2)
    return (right + left) / (mp.pi * mp.mpf(EDGE))


def force(m, a):
    phi1, phi2 = edges(m, a)
    angles = phi1 - mp.sin(2 * phi1) / 2 + mp.pi - phi2 + mp.sin(2 * phi2) / 2
    return modulus() * a**2 / (4 * mp.mpf(EDGE)) * angles


def moment(m, a):
    """About x = 0."""
    phi1, phi2 = edges(m, a)
    about_middle = modulus() * a**3 / (12 * mp.mpf(EDGE)) * (mp.sin(phi1) ** 3 - mp.sin(phi2) ** 3)
    return about_middle + m * force(m, a)


def pressure_max(m, a):
    """Beyond the right edge, where dp/dtheta = 0."""
    phi1, phi2 = edges(m, a)

    def logarithm(phi, theta):
        return mp.log(abs(mp.sin((phi + theta) / 2) / mp.sin((phi - theta) / 2)))

    def rise(theta):
        logarithms = logarithm(phi1, theta) - logarithm(phi2, theta)
        return (mp.pi - phi2 + phi1) * mp.cos(theta) - mp.sin(theta) * logarithms + mp.sin(phi1) - mp.sin(phi2)

    theta = mp.findroot(rise, (phi1 / 2, phi1 * (1 - mp.mpf("1e-12"))), solver="anderson")
    shape = (mp.pi - phi2 + phi1) * mp.sin(theta)
    shape -= (mp.cos(phi1) - mp.cos(theta)) * logarithm(phi1, theta)
    shape += (mp.cos(phi2) - mp.cos(theta)) * logarithm(phi2, theta)
    return modulus() * a / (2 * mp.pi * mp.mpf(EDGE)) * shape


def by_quadrature(m, a):
    """Rotation, force and moment by integrals of h' over the angle, without the formulas above."""
    c, radius = mp.mpf(FLAT), mp.mpf(EDGE)

    def slope(t):
        x = m + a * mp.cos(t)
        return (max(x - c, mp.mpf(0)) + min(x + c, mp.mpf(0))) / radius

    breaks = [0, *edges(m, a), mp.pi]
    mean = mp.quad(slope, breaks) / mp.pi
    first = mp.quad(lambda t: slope(t) * mp.cos(t), breaks)
    # the integral of x p about the middle: of the second kind
    second = mp.quad(lambda t: (slope(t) - mean) * mp.cos(2 * t), breaks)
    n = modulus() * a / 2 * first
    return mean, n, modulus() * a**2 / 4 * second + m * n


def solve():
    """Middle and half width of the contact and of the stick zone."""
    n, start = mp.mpf(N), (mp.mpf("1e-4"), mp.mpf("2.6e-3"))
    contact = mp.findroot(lambda m, a: [force(m, a) / n - 1, (moment(m, a) - mp.mpf(MOMENT)) / n * 1000], start)
    tilt = rotation(*contact)
    less = n - mp.mpf(SHEAR) / mp.mpf(FRICTION)
    stick = mp.findroot(
        lambda m, a: [force(m, a) / n - less / n, (rotation(m, a) - tilt) * 1000], (mp.mpf("1.5e-4"), mp.mpf("2.3e-3"))
    )
    for zone in (contact, stick):
        for one, other in zip(by_quadrature(*zone), (f(*zone) for f in (rotation, force, moment))):
            assert abs(one / other - 1) < mp.mpf("1e-20")
    return tuple(contact), tuple(stick)


def evidence():
    with mp.workdps(30):
        contact, stick = solve()
        how = "closed form (Ciavarella, Hills, Monno 1998; Goryacheva, Murthy, Farris 2002), mpmath, 30 digits"
        return [
            closed("contact_left", "m", contact[0] - contact[1], how),
            closed("contact_right", "m", contact[0] + contact[1], how),
            closed("pressure_max", "Pa", pressure_max(*contact), how),
            closed("rotation", "rad", rotation(*contact), how),
            closed("stick_left", "m", stick[0] - stick[1], how),
            closed("stick_right", "m", stick[0] + stick[1], how),
        ]


def solve_cells():
    """A first step applies N and M_y, then T_x."""
    return petsam.run(OPTIONS, output_fields="usual,contact_edge,stick_edge")


def answers():
    results = solve_cells()
    last = {name: values[-1] for name, values in results.history.items()}
    contact, stick = (results.edge(name)[:, 0] for name in ("contact_edge", "stick_edge"))
    return {
        "contact_left": contact.min(),
        "contact_right": contact.max(),
        "pressure_max": last["pressure_max"],
        "rotation": last["rot_y"],
        "stick_left": stick.min(),
        "stick_right": stick.max(),
    }


def draw(figure):
    axes = figure.subplots()
    results = solve_cells()
    x = results.x * 1e3
    axes.plot(x, float(FRICTION) * results["pressure"][-1][0] * 1e-6, "--", label=r"$\mu p$")
    axes.plot(x, results["shear_x"][-1][0] * 1e-6, label="q")
    axes.set_xlabel("x, mm")
    axes.set_ylabel("shear, MPa")
    axes.legend(loc="upper center")

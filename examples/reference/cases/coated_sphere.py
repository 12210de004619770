"""A rigid sphere on a hard film that is bonded to steel: petsam, and an integral equation with the film's symbols."""

import functools

import numpy as np
from common import all_covered
from scipy.optimize import minimize_scalar
from scipy.special import j0, j1

import petsam

N, RADIUS, THICKNESS = 100.0, 0.01, 5e-5
FILM, BASE = (600e9, 0.2), (210e9, 0.3)  # Young's modulus, Poisson's ratio
SIZE = 3.4e-4  # m, the side of the grid
CELLS = (128, 256, 512, 1024)
UNITS = {
    "contact_radius": "m",
    "approach": "m",
    "pressure_max": "Pa",
    "surface_tension_max": "Pa",
    "interface_tension_max": "Pa",
    "elastic_energy": "J",
}


def solve(cells):
    """petsam's state under the load, and the stresses at the film's surface and above its lower face."""
    options = {"body1_young": "inf", "gap_type": "sphere", "gap_radius1": RADIUS, "gap_radius2": "inf"}
    film = {"young": FILM[0], "poisson": FILM[1], "thickness": THICKNESS}
    options |= {f"body2_layer_{name}": value for name, value in film.items()}
    contact = petsam.Contact(grid_n=cells, grid_size=SIZE, body2_young=BASE[0], body2_poisson=BASE[1], **options)
    step = contact.try_step(load_n=N)
    return contact, step, contact.stress(depths=f"0,{THICKNESS:g}-", quantities="principal")


@functools.lru_cache
def measured(cells):
    """petsam's numbers."""
    _, step, stress = solve(cells)
    return {
        "contact_radius": np.sqrt(step.contact_area / np.pi),
        "approach": step.disp_z,
        "pressure_max": step.pressure_max,
        "surface_tension_max": np.max(stress["principal_1"][0, 0]),
        "interface_tension_max": np.max(stress["principal_1"][0, 1]),
        "elastic_energy": step.stored_energy,
    }


def waves(k):
    """Under the pressure J0(k r): the displacement of the surface times k, and, at the film's surface and above its
    lower face, the parts of the radial stress over J0(k r) - J1(k r)/(k r) and over J0(k r). Papkovich and Neuber's
    potentials phi and psi in the film and in the base: 2 G u = grad(phi + z psi) - (3 - 4 nu) psi e_z, of the form
    J0(k r) exp(+-k z). Lengths are in units of the film's thickness."""

    def rows(z, sign, scale, young, nu):
        """u_r, u_z, s_zr, s_zz and the two parts of s_rr of phi and of psi = scale exp(sign k z)."""
        shear = young / (2 * (1 + nu))
        slope, curve = sign * k * scale, k**2 * scale
        phi = -k * scale / (2 * shear), slope / (2 * shear), -k * slope, curve, -curve, 0 * k
        psi = z * phi[0], z * phi[1] - (3 - 4 * nu) * scale / (2 * shear), z * phi[2] + (1 - 2 * nu) * k * scale
        return phi, psi + (z * curve - 2 * (1 - nu) * slope, -z * curve, -2 * nu * slope)

    decay, one = np.exp(-k), np.ones_like(k)
    top = np.array(rows(0, -1, one, *FILM) + rows(0, 1, decay, *FILM))
    bottom = np.array(rows(1, -1, decay, *FILM) + rows(1, 1, one, *FILM))
    below = np.array(rows(1, -1, one, *BASE))
    matrix, right = np.zeros((len(k), 6, 6)), np.zeros((len(k), 6, 1))
    matrix[:, :2, :4] = top[:, 2:4].T
    matrix[:, 2:, :4] = bottom[:, :4].T
    matrix[:, 2:, 4:] = -below[:, :4].T
    right[:, 1] = -1  # s_zz of the pressure 1
    size = np.abs(matrix).max(axis=2, keepdims=True)  # displacements and stresses differ by 1e11
    found = np.linalg.solve(matrix / size, right / size)[:, :4, 0].T
    return k * sum(found * top[:, 1]), [[sum(found * face[:, part]) for part in (4, 5)] for face in (top, bottom)]


def gauss(start, end, count):
    """Nodes and weights of an interval."""
    nodes, weights = np.polynomial.legendre.leggauss(count)
    return (start + end) / 2 + (end - start) / 2 * nodes, (end - start) / 2 * weights


def integral_equation(count):
    """With p's Hankel transform = int g cos(k t) dt the displacement under the sphere is

    int g(t) [c delta(s-t) pi/2 + (n(s-t) + n(s+t))/2] dt = approach - s^2/R after Abel's transformation, where c/k is
    the symbol of the film's material as a half-space, and n(x) the cosine transform of the rest of the symbol."""
    ends = [0, 0.5, 1, 2, 4, 6, 9, 12, 16, 20, 25]
    k, weight = (np.concatenate(part) for part in zip(*(gauss(*pair, 2 * count) for pair in zip(ends, ends[1:]))))
    symbol, stresses = waves(k)
    top = 2 * (1 - FILM[1] ** 2) / FILM[0]  # (1 - nu)/G

    def solve_radius(a):
        s, w = gauss(0, a, count)
        rest = np.cos(np.outer(s, k)) * (weight * (symbol - top)) @ np.cos(np.outer(k, s))
        full = np.append(s, a)
        edge = np.cos(np.outer(full, k)) * (weight * (symbol - top)) @ np.cos(np.outer(k, s))
        matrix = np.pi / 2 * top * np.eye(count) + rest * w
        one, square = np.linalg.solve(matrix, np.stack([np.ones(count), s**2], axis=1)).T
        # g is 0 at the edge: the right side there is what the others cause
        approach = (a**2 - edge[-1] * w @ square) / (1 - edge[-1] * w @ one)
        return s, w, approach, approach * one - square

    h, radius = THICKNESS, RADIUS / THICKNESS

    def load(a):
        s, w, approach, g = solve_radius(a)
        return 2 * np.pi * w @ g / radius * h**2 - N

    low, high = 0.5e-4 / h, 3e-4 / h
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if load(middle) < 0 else (low, middle)
    a = (low + high) / 2
    s, w, approach, g = solve_radius(a)
    approach, g = approach / radius, g / radius
    # g is even: a polynomial in s^2 that is 0 at the edge
    even = np.polynomial.Polynomial.fit((s / a) ** 2, g / (1 - (s / a) ** 2), min(count - 1, 14), domain=[0, 1])

    def slope(t):
        y = (t / a) ** 2
        return (even.deriv()(y) * (1 - y) - even(y)) * 2 * t / a**2

    theta, around = gauss(0, 1, 4 * count)  # t^2 = r^2 + (a^2 - r^2) theta^2
    r = np.linspace(0, 1, 201)[:-1] * a
    t = np.sqrt(r[:, None] ** 2 + (a**2 - r[:, None] ** 2) * theta**2)
    pressure = -np.sqrt(a**2 - r**2) * ((slope(t) / t) @ around)
    transform = np.cos(np.outer(k, s)) @ (w * g) * weight * k

    def surface(r):
        """Radial stress outside of the contact; a half-space of the film has (1 - 2 nu) N/(2 pi r^2) of it."""
        half = 1 - 2 * FILM[1]
        first, second = stresses[0][0] + half, stresses[0][1] + 1 - half
        rest = transform @ (first * (j0(k * r) - j1(k * r) / (k * r)) + second * j0(k * r))
        return half * N / (2 * np.pi * (r * h) ** 2) + rest

    def interface(r):
        """Hoop stress in the film at its lower face, where it is larger than the others."""
        first, second = stresses[1]
        return transform @ (first * j1(k * r) / (k * r) + second * j0(k * r))

    def maximum(stress, start):
        return -minimize_scalar(lambda r: -stress(r), bounds=(start, 2 * a), options={"xatol": 1e-7}).fun

    return {
        "contact_radius": a * h,
        "approach": approach * h,
        "pressure_max": np.max(pressure),
        "surface_tension_max": maximum(surface, a),
        "interface_tension_max": maximum(interface, a / 10),
        "elastic_energy": np.pi * h**3 * (approach * (w @ g) - (w @ (g * s**2)) / radius),
    }


def evidence():
    equation = [integral_equation(count) for count in (8, 16, 32, 64)]
    cells = [measured(cells) for cells in CELLS]
    ways = {"integral equation, 8 to 64 nodes": equation, "petsam, 128 to 1024 cells across": cells}
    return all_covered(UNITS, ways)


def answers():
    return measured(256)


def draw(figure):
    axes = figure.subplots()
    contact, _, stress = solve(256)
    row = len(stress["y"]) // 2
    x, tension = stress["x"][row:] * 1e3, stress["principal_1"][0, :, row, row:] * 1e-9
    axes.plot(x, contact.field("pressure")[row, row:] * 1e-9, label="pressure")
    axes.plot(x, tension[0], label="tension, surface")
    axes.plot(x, tension[1], label="tension, lower face")
    axes.set_ylim(-0.9, 2.6)
    axes.set_yticks([0, 1, 2])
    axes.set_xlabel("x, mm")
    axes.set_ylabel("stress, GPa")
    axes.legend(frameon=False)

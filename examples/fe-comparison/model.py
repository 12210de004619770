#!/usr/bin/env python3
"""Write the CalculiX model of two equal spheres that are pressed together, and then pushed sideways.

normal      a quarter of one hemisphere on a rigid frictionless plane. Two equal spheres under a normal load are mirror
            images in the plane of contact: it stays plane, and points that touch move alike, so that there is neither
            slip nor shear whatever the friction is. One sphere on that plane is the same problem, not a model of it.
tangential  halves (y >= 0) of both hemispheres with friction. A tangential load turns that symmetry into a half turn
            about the y axis: the surface of contact warps by the part of u_z that is odd in x. A rigid plane would
            resist this warping (it couples as dissimilar bodies do), so here both bodies are needed.

Bodies are hemispheres of radius R whose poles touch at the origin; their flat tops (z = R, and z = -R of the lower)
are clamped to rigid plates. Units of the deck are mm, N, MPa. Run as a program, this file writes one deck.

The mesh of a quarter is a cube of n x n x n elements about the pole, its sides bulged, that is wrapped in shells. The
nodes lie at distance d from the pole and at angle t arccos(d/2R) from the axis, 0 <= t <= 1: t = 1 is the sphere
itself, so that surface nodes lie on it exactly and the initial gap at the nodes is the sphere's. The shells grow in
geometric progression up to the flat top, about as fast as their elements grow sideways.
"""

import argparse
import sys
from typing import NamedTuple

import numpy as np

BLOCK = 1.25  # half width of the cube in contact radii, along x
BULGE = 0.5  # of its sides: 0 a cube, 1 a ball
GROWTH = 2.0  # thickness of a shell over the mean width of its elements
CONTACT_REACH = 1.6  # contact surface in contact radii from the pole


class Study(NamedTuple):
    """What a model is of: radius of each sphere (mm), expected contact radius (mm), E (MPa), nu, friction."""

    radius: float = 200.0
    contact_radius: float = 0.8662391
    young: float = 210e3
    poisson: float = 0.3
    friction: float = 0.1


class Mesh(NamedTuple):
    """Nodes (mm), elements (eight node indices each), contact faces as (element, face 1 to 6) with their four nodes."""

    nodes: np.ndarray
    elements: np.ndarray
    faces: np.ndarray
    face_nodes: np.ndarray


def element_size(study, n):
    """Width of an element under the contact, mm."""
    return BLOCK * study.contact_radius / n


# ---------------------------------------------------------------- the mesh of a quarter

# corners of each face of the 8-node hexahedron, outward
HEX_FACES = np.array([[0, 1, 2, 3], [4, 7, 6, 5], [0, 4, 5, 1], [1, 5, 6, 2], [2, 6, 7, 3], [3, 7, 4, 0]])


def block_points(n):
    """Points of the bulged cube [0, 1]^3 by their grid indices (i, j, k); x = 1 at (n, 0, 0)."""
    cube = np.stack(np.meshgrid(*3 * [np.linspace(0.0, 1.0, n + 1)], indexing="ij"), axis=-1)
    shell = np.max(cube, axis=-1, keepdims=True)
    length = np.linalg.norm(cube, axis=-1, keepdims=True)
    ball = np.divide(cube, length, out=np.zeros_like(cube), where=length > 0.0) * shell
    weight = BULGE * shell
    return (1.0 - weight) * cube + 1.15 * weight * ball


def on_sphere(distance, fraction, radius):
    """(r, z) at a distance from the pole and a fraction of the angle between axis and surface."""
    angle = fraction * np.arccos(np.clip(0.5 * distance / radius, 0.0, 1.0))
    return distance * np.sin(angle), distance * np.cos(angle)


def distance_to_top(fraction, radius):
    """Distance from the pole at which the ray of that fraction meets z = radius, by bisection."""
    low, high = np.full_like(fraction, radius), np.full_like(fraction, np.sqrt(2.0) * radius)
    for _ in range(60):
        middle = 0.5 * (low + high)
        inside = on_sphere(middle, fraction, radius)[1] < radius
        low, high = np.where(inside, middle, low), np.where(inside, high, middle)
    return 0.5 * (low + high)


def shell_quads(n, index):
    """Quads of the cube's three outer sides as (four surface nodes, their face at z = 0 or 0), normals outward."""
    quads = []
    for j in range(n):
        for k in range(n):
            corners = ((j, k), (j + 1, k), (j + 1, k + 1), (j, k + 1))
            quads.append(([index[n, a, b] for a, b in corners], 3 if k == 0 else 0))
            quads.append(([index[b, n, a] for a, b in corners], 6 if j == 0 else 0))
            quads.append(([index[a, b, n] for a, b in corners], 0))
    return np.array([q for q, _ in quads]), np.array([f for _, f in quads])


def quarter(n, study):
    """Mesh of x, y, z >= 0."""
    radius, scale = study.radius, BLOCK * study.contact_radius / (1.0 + 0.15 * BULGE)
    points = block_points(n) * scale
    outer = np.zeros(points.shape[:3], dtype=bool)
    outer[-1], outer[:, -1], outer[:, :, -1] = True, True, True
    surface = np.flatnonzero(outer)
    points = points.reshape(-1, 3)
    index = np.full(points.shape[0], -1)
    index[surface] = np.arange(surface.size)

    distance = np.linalg.norm(points, axis=1)
    azimuth = np.arctan2(points[:, 1], points[:, 0])
    fraction = np.arctan2(np.hypot(points[:, 0], points[:, 1]), points[:, 2]) / (0.5 * np.pi)
    start, end = distance[surface], distance_to_top(fraction[surface], radius)
    layers = max(2, int(np.ceil(np.log(np.mean(end / start)) / np.log(1.0 + GROWTH * 0.25 * np.pi / n))))
    shells = start * (end / start) ** (np.arange(1, layers + 1)[:, None] / layers)

    distance = np.concatenate([distance, shells.ravel()])
    azimuth = np.concatenate([azimuth, np.tile(azimuth[surface], layers)])
    fraction = np.concatenate([fraction, np.tile(fraction[surface], layers)])
    r, z = on_sphere(distance, fraction, radius)
    nodes = np.stack([r * np.cos(azimuth), r * np.sin(azimuth), z], axis=1)
    nodes[np.abs(nodes) < 1e-12 * radius] = 0.0  # on the planes of symmetry exactly

    grid = np.arange(points.shape[0]).reshape(3 * [n + 1])
    steps = ((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1))
    core = np.stack([grid[i : n + i, j : n + j, k : n + k] for i, j, k in steps], axis=-1).reshape(-1, 8)
    core_face = np.zeros((n, n, n), dtype=int)
    core_face[:, :, 0] = 1
    quads, quad_face = shell_quads(n, index.reshape(3 * [n + 1]))
    levels = [surface] + [points.shape[0] + layer * surface.size + np.arange(surface.size) for layer in range(layers)]
    wraps = [np.concatenate([low[quads], high[quads]], axis=1) for low, high in zip(levels, levels[1:])]
    elements = np.concatenate([core] + wraps)
    face = np.concatenate([core_face.ravel()] + layers * [quad_face])
    return with_contact(nodes, elements, face, CONTACT_REACH * study.contact_radius)


def with_contact(nodes, elements, face, reach):
    """The mesh whose contact faces are those (0: none) that lie within reach of the pole."""
    chosen = np.flatnonzero(face)
    corners = elements[chosen[:, None], HEX_FACES[face[chosen] - 1]]
    near = np.max(np.linalg.norm(nodes[corners], axis=2), axis=1) <= reach
    return Mesh(nodes, elements, np.stack([chosen, face[chosen]], axis=1)[near], corners[near])


# ---------------------------------------------------------------- mirror images

MIRROR_NODES = [1, 0, 3, 2, 5, 4, 7, 6]  # keeps elements right-handed
MIRROR_FACE = np.array([0, 1, 2, 3, 6, 5, 4])


def mirrored(mesh, axis):
    """The mirror image in the plane through the origin normal to axis (0, 1, 2)."""
    nodes = mesh.nodes.copy()
    nodes[:, axis] *= -1.0
    faces = np.stack([mesh.faces[:, 0], MIRROR_FACE[mesh.faces[:, 1]]], axis=1)
    return Mesh(nodes + 0.0, mesh.elements[:, MIRROR_NODES], faces, mesh.face_nodes[:, ::-1])


def joined(one, two, shared=None):
    """Both meshes in one; nodes of two marked in shared are those of one with the same number."""
    shared = np.zeros(len(two.nodes), dtype=bool) if shared is None else shared
    number = np.where(shared, np.arange(len(two.nodes)), len(one.nodes) + np.cumsum(~shared) - 1)
    faces = two.faces + np.array([len(one.elements), 0])
    return Mesh(
        np.concatenate([one.nodes, two.nodes[~shared]]),
        np.concatenate([one.elements, number[two.elements]]),
        np.concatenate([one.faces, faces]),
        np.concatenate([one.face_nodes, number[two.face_nodes]]),
    )


def half(n, study):
    """Mesh of y, z >= 0."""
    right = quarter(n, study)
    return joined(right, mirrored(right, 0), right.nodes[:, 0] == 0.0)


# ---------------------------------------------------------------- the deck


class Controls(NamedTuple):
    """What a deck may vary besides mesh and study: equation solver, contact stiffness (MPa/mm), large displacements.

    These need a law for large strains: linear between Green's strain and the second Piola-Kirchhoff stress, which
    CalculiX makes of *ELASTIC (St. Venant-Kirchhoff), or neo-Hooke's. Both are Hooke's with E and nu for small ones.
    """

    solver: str = "ITERATIVE CHOLESKY"
    stiffness: float = 0.0  # 0: default_stiffness()
    nlgeom: bool = False
    neo_hooke: bool = False


DEFAULTS = Controls()


def default_stiffness(study, n):
    """Contact stiffness, MPa/mm: ten times that of an element under the contact."""
    return 10.0 * study.young / element_size(study, n)


def on_top(mesh, study):
    """Nodes of the flat top."""
    return np.flatnonzero(np.abs(mesh.nodes[:, 2] - study.radius) < 1e-9 * study.radius)


def rim(mesh):
    """Elements with a node on the contact surface, whose stresses give the forces on it, and their nodes."""
    touching = np.zeros(len(mesh.nodes), dtype=bool)
    touching[mesh.face_nodes] = True
    elements = np.flatnonzero(np.any(touching[mesh.elements], axis=1))
    return elements, np.unique(mesh.elements[elements])


class Deck:
    """Lines of an input file."""

    def __init__(self, title):
        self.lines = ["*HEADING", title]

    def add(self, *lines):
        """Append lines."""
        self.lines += lines

    def numbers(self, kind, name, indices):
        """A set (NSET, ELSET) of nodes or elements by their index from 0, ten a line."""
        values = [str(1 + v) for v in indices]
        self.add(f"*{kind}, {kind}={name}", *(", ".join(values[i : i + 10]) + "," for i in range(0, len(values), 10)))

    def body(self, name, mesh, after=None):
        """Nodes, elements and contact surface of a body, numbered after those of another mesh."""
        node, element = (1 + len(after.nodes), 1 + len(after.elements)) if after else (1, 1)
        self.add("*NODE, NSET=N" + name)
        self.add(*("{}, {:.12g}, {:.12g}, {:.12g}".format(node + i, *p) for i, p in enumerate(mesh.nodes)))
        self.add("*ELEMENT, TYPE=C3D8, ELSET=E" + name)
        self.add(*(", ".join(map(str, (element + i, *(node + e)))) for i, e in enumerate(mesh.elements)))
        self.add(f"*SOLID SECTION, ELSET=E{name}, MATERIAL=STEEL", "*SURFACE, NAME=S" + name)
        self.add(*(f"{element + e}, S{face}" for e, face in mesh.faces))

    def material(self, study, neo_hooke):
        """Steel, or what has its E and nu."""
        law, constants = "*ELASTIC", (study.young, study.poisson)
        if neo_hooke:  # half the shear modulus, two over the bulk modulus
            law = "*HYPERELASTIC, NEO HOOKE"
            constants = (0.25 * study.young / (1.0 + study.poisson), 6.0 * (1.0 - 2.0 * study.poisson) / study.young)
        self.add("*MATERIAL, NAME=STEEL", law, "{:.12g}, {:.12g}".format(*constants))

    def contact(self, independent, stiffness, friction=0.0):
        """Surface-to-surface penalty contact of the upper body; its pressure is linear in the overclosure."""
        self.add(
            "*SURFACE INTERACTION, NAME=TOUCH", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR", f"{stiffness:.12g}"
        )
        if friction:
            self.add("*FRICTION", f"{friction:.12g}, {stiffness:.12g}")
        self.add("*CONTACT PAIR, INTERACTION=TOUCH, TYPE=SURFACE TO SURFACE", "SUPPER, S" + independent)

    def step(self, controls, boundary, *requests):
        """A static step of one increment with a prescribed displacement of the top; requests are output cards."""
        self.add(
            "*STEP, INC=100" + (", NLGEOM" if controls.nlgeom else ""),
            "*STATIC, SOLVER=" + controls.solver,
            "1., 1.",
            "*CONTROLS, PARAMETERS=FIELD",
            TOLERANCES,
            "*CONTROLS, PARAMETERS=TIME INCREMENTATION",
            ITERATIONS,
            "*BOUNDARY",
            boundary,
            *requests,
            "*END STEP",
        )

    def write(self, path):
        """Write the file."""
        with open(path, "w", encoding="ascii") as file:
            file.write("\n".join(self.lines) + "\n")


# CalculiX's own tolerance lets a frictional step end while the forces far from the contact are still a few per cent off
TOLERANCES = "2.e-4, 1.e-3, , , 2.e-4, , , "  # residual force, correction; and residual force after many iterations
ITERATIONS = "4, 8, 9, 100"  # the last: how many before the increment is given up

FIELDS = (
    "*NODE PRINT, NSET=TOP, TOTALS=ONLY",
    "RF",
    "*NODE PRINT, NSET=PRINTED",
    "U",
    "*EL PRINT, ELSET=RIM",
    "S",
    "*NODE FILE, NSET=TOP",
    "U",
    "*CONTACT FILE",
    "CSTR",
)


def normal_deck(path, n, study, displacement, controls=DEFAULTS):
    """A quarter of one hemisphere on a rigid plane, its top moved down by displacement (mm). Returns the mesh."""
    mesh = quarter(n, study)
    side = 2.0 * CONTACT_REACH * study.contact_radius
    corners = [(x, y, z) for z in (-side, 0.0) for x, y in ((-side, -side), (side, -side), (side, side), (-side, side))]
    plane = Mesh(np.array(corners), np.arange(8)[None, :], np.array([[0, 2]]), HEX_FACES[1:2])
    top = on_top(mesh, study)
    elements, printed = rim(mesh)

    deck = Deck("a sphere on a rigid frictionless plane: one of two equal spheres under a normal load")
    deck.material(study, controls.neo_hooke)
    deck.body("UPPER", mesh)
    deck.body("PLANE", plane, mesh)
    deck.contact("PLANE", controls.stiffness or default_stiffness(study, n))
    deck.numbers("NSET", "TOP", top)
    for axis, name in enumerate("XY"):
        deck.numbers("NSET", "SIDE" + name, np.setdiff1d(np.flatnonzero(mesh.nodes[:, axis] == 0.0), top))
    deck.numbers("ELSET", "RIM", elements)
    deck.numbers("NSET", "PRINTED", printed)
    deck.add("*BOUNDARY", "SIDEX, 1, 1", "SIDEY, 2, 2", "NPLANE, 1, 3", "TOP, 1, 2")
    deck.step(controls, f"TOP, 3, 3, {-displacement:.12g}", *FIELDS)
    deck.write(path)
    return mesh


def tangential_deck(path, n, study, displacement, tangential, controls=DEFAULTS):
    """Halves of both hemispheres, the upper top moved (mm) down, then along x. Returns the upper half's mesh.

    The lower half is its mirror image, with the same numbers after it.
    """
    mesh = half(n, study)
    count, top = len(mesh.nodes), on_top(mesh, study)
    side = np.setdiff1d(np.flatnonzero(mesh.nodes[:, 1] == 0.0), top)
    elements, printed = rim(mesh)

    deck = Deck("two equal spheres pressed together, then pushed sideways")
    deck.material(study, controls.neo_hooke)
    deck.body("UPPER", mesh)
    deck.body("LOWER", mirrored(mesh, 2), mesh)
    deck.contact("LOWER", controls.stiffness or default_stiffness(study, n), study.friction)
    deck.numbers("NSET", "TOP", top)
    deck.numbers("NSET", "BOTTOM", count + top)
    deck.numbers("NSET", "SIDEY", np.concatenate([side, count + side]))
    deck.numbers("ELSET", "RIM", elements)
    deck.numbers("NSET", "PRINTED", np.concatenate([printed, count + np.unique(mesh.face_nodes)]))
    deck.add("*BOUNDARY", "SIDEY, 2, 2", "BOTTOM, 1, 3", "TOP, 1, 2")
    deck.step(controls, f"TOP, 3, 3, {-displacement:.12g}")
    deck.step(controls, f"TOP, 1, 1, {tangential:.12g}", *FIELDS)
    deck.write(path)
    return mesh


def main():
    """Write one deck."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", help="deck to write (.inp)")
    parser.add_argument("--n", type=int, default=8, help="elements along the cube's edge (8)")
    parser.add_argument("--radius", type=float, default=200.0, help="of each sphere, mm (200)")
    parser.add_argument("--contact-radius", type=float, default=0.8662391, help="expected, mm (0.8662391)")
    parser.add_argument("--displacement", type=float, help="approach of the flat tops, mm (Hertz's)")
    parser.add_argument("--tangential", type=float, help="then along x, mm: both bodies with friction")
    parser.add_argument("--solver", default=DEFAULTS.solver, help="CalculiX's equation solver (ITERATIVE CHOLESKY)")
    parser.add_argument("--stiffness", type=float, default=0.0, help="of the contact, MPa/mm (10 E/element size)")
    parser.add_argument("--nlgeom", action="store_true", help="large displacements")
    parser.add_argument("--neo-hooke", action="store_true", help="neo-Hooke's law, with --nlgeom")
    options = parser.parse_args()
    if options.neo_hooke and not options.nlgeom:
        parser.error("--neo-hooke needs --nlgeom")
    if options.n < 2:
        parser.error("--n must be at least 2")

    study = Study(options.radius, options.contact_radius)
    approach = options.displacement or 2.0 * study.contact_radius**2 / study.radius
    controls = Controls(options.solver, options.stiffness, options.nlgeom, options.neo_hooke)
    if options.tangential:
        mesh = tangential_deck(options.file, options.n, study, approach, options.tangential, controls)
    else:
        mesh = normal_deck(options.file, options.n, study, 0.5 * approach, controls)
    print(f"{len(mesh.elements)} elements, {len(mesh.nodes)} nodes a body")


if __name__ == "__main__":
    sys.exit(main())

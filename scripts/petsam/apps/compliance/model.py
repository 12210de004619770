"""A body from its deck: frame, checks, stiffness, compliance, load cases, stresses."""

from __future__ import annotations

import hashlib
import os
from dataclasses import dataclass, field, replace

import numpy as np

from ...core.brief import brief
from ...core.decks import folded
from ...core.errors import Error, short
from ...core.frames import Frame
from ...core.progress import Progress
from . import (
    bolts,
    boxes,
    checks,
    cutoff,
    deck,
    elements,
    foreign,
    images,
    mesherror,
    modes,
    parts,
    section,
    several,
    stresses,
)  # fmt: skip
from . import cases as load_cases
from .basis import Patch
from .halfplane import LineFields, MirroredLine
from .halfspace import Fields, Mirrored, Several
from .remainder import Side
from .result import Compliance
from .solve import Floating, Solver, plane_normal
from .stiffness import stiffness
from .units import DENSITIES, SOFT, UNITS, need_units

DECK = ".inp"  # end of the name of a deck
BLOCK = 1 << 20
GAUSS_MORE = 3  # Gauss points along the patch in addition to its degree, for sampling fields


@brief
@dataclass
class Body:
    """A patch of a body, or of a pair: the contents of the file, or of its group for this patch."""

    young: float
    poisson: float
    method: str
    source: str
    checksum: str
    command: str
    frame: Frame
    patch: Patch
    compliance: np.ndarray
    cases: dict = field(default_factory=dict)
    stress: tuple | None = None
    checks: dict = field(default_factory=dict)
    mesh: object = None
    remarks: list = field(default_factory=list)
    other: tuple | None = None  # moduli of body 1 of a pair
    modes: object = None
    definite: object = None
    mesh_error: float | None = None  # relative, of the compliance
    datum: float | None = None  # m, of a section

    @property
    def bolts(self):
        """Bolts of a pair."""
        return self.mesh.bolts if self.mesh else []

    def closing(self, name):
        """Mutual approach (bolts) of the washers of each bolt by a load case."""
        return np.array([(one.closing @ self.cases[name].displacement)[0, 0] for one in self.bolts])


def checksum(path):
    """SHA-256 of a file."""
    digest = hashlib.sha256()
    with open(path, "rb") as file:
        while block := file.read(BLOCK):
            digest.update(block)
    return digest.hexdigest()


def opened(source, settings):
    """The name of a deck or a mesh, its SHA-256, and the Deck; boxes of the settings become its sets and surfaces."""
    if isinstance(source, (str, os.PathLike)):
        path = os.fspath(source)
        ending = os.path.splitext(path)[1].lower()
        if ending == DECK and settings.materials:
            raise Error(f"{path}: a deck has its own materials: remove --young, --poisson, --density and --material")
        of_meshio = settings.materials or ending in foreign.ENDINGS
        found = foreign.read(path, settings) if of_meshio else deck.read(path)
        return path, checksum(path), boxes.added(found, settings)
    if not hasattr(source, "cell_sets"):
        raise Error(f"mesh {short(repr(source))}: expected a file's name or a meshio.Mesh")
    found = foreign.deck_of(source, "mesh", settings)
    return "mesh", hashlib.sha256(found.mesh.nodes.tobytes()).hexdigest(), boxes.added(found, settings)


class Model:
    """The mesh in the frame's coordinates, in SI units, with its supports and its contact surface."""

    def __init__(self, source, settings, quadratic=False):
        """source: the name of a deck or of a file that meshio reads, or a meshio.Mesh; quadratic: with no linear
        elements, whatever the settings say."""
        units = UNITS[settings.units]
        self.settings, self.units = settings, units
        self.path, self.checksum, self.deck = opened(source, settings)
        path = self.path
        kept = settings.keep_elements and not quadratic
        mesh = self.deck.mesh if kept else elements.raised(self.deck.mesh, quadratic)
        self.told = elements.told(self.deck.mesh, mesh)
        if mesh.normal is not None:
            section.need_settings(settings, path)
        mesh.nodes = mesh.nodes * units.length
        for block in mesh.blocks:
            block.young *= units.stress
            block.density *= units.density
        deck.need_set(mesh.surfaces, settings.contact, "surface", path)
        held = [deck.need_set(mesh.node_sets, name, "node set", path) for name in settings.supports]
        self.supported = elements.covered(mesh, np.concatenate([np.zeros(0, dtype=int), *held]))
        symmetric = [deck.need_set(mesh.node_sets, name, "node set", path) for name in settings.symmetry]
        for name, nodes in zip(settings.symmetry, symmetric):
            if not np.setdiff1d(nodes, self.supported).size:
                raise Error(
                    f"{path}: node set {name} of --symmetry is held by --fixed: name another, or omit --symmetry"
                )
        faces = mesh.surface_faces(folded(settings.contact))
        if not faces:
            raise Error(f"{path}: surface {settings.contact} has no element faces: define it by TYPE=ELEMENT")
        outward = sum(mesh.gauss(group, 2).area.sum(axis=(0, 1)) for group in faces)
        origin, x, z = (list(settings.frame) + [None, None])[:3]
        self.frame = Frame.of(np.array(origin) * units.length, x, z, outward, mesh.normal)
        self.mesh = mesh.turned(self.frame.origin, self.frame.axes)
        self.planes = [self._plane(name, nodes) for name, nodes in zip(settings.symmetry, symmetric)]
        planes = np.concatenate([np.zeros(0, dtype=int), *(nodes for nodes, _ in self.planes)])
        self.doubts = load_cases.need_supports(self.deck, self.mesh, self.frame, units, self.supported, planes)
        self.patches = [self._patch(center) for center in settings.centers]
        several.need_apart(self.patches)
        self.patch = self.patches[0]
        self.parts, self.bolts = [parts.Part(self.mesh, faces)], []
        if settings.pair:
            self._take_pair()
        self.doubts += need_units(self)

    def _patch(self, center):
        """The patch about a centre."""
        if self.mesh.normal is not None:
            return section.patch(self.settings, center)
        return Patch(center, tuple(0.5 * side for side in self.settings.patch), self.settings.degree)

    def _take_pair(self):
        """Finds the two bodies and their bolts."""
        settings = self.settings
        for name in [settings.pair, *(surface for one in settings.bolts for surface in one.surfaces)]:
            deck.need_set(self.mesh.surfaces, name, "surface", self.path)
        components = parts.Components(self.mesh)
        links = [tuple(components.of_surface(surface) for surface in one.surfaces) for one in settings.bolts]
        for one, (first, second) in zip(settings.bolts, links):
            if first == second:
                raise Error(f"bolt {one.name}: both washers are on one body: name a surface of each body")
        self.parts = parts.pair(components, settings.contact, settings.pair, links)
        if settings.free:
            components.need_one(links)
            self.need_densities("--free")
        else:
            components.need_held(self.supported, links)
        thickness = 1.0 if self.mesh.normal is None else self.mesh.thickness * self.units.length
        self.bolts = [bolts.bolt(self.mesh, *one, thickness) for one in settings.bolts]

    def prepare_modes(self):
        """Finds what the modes need: densities, and the nodes of the sensors."""
        self.need_densities("--modes")
        self.sensors = [self._sensor(*one) for one in self.settings.sensors]

    def need_densities(self, name):
        """Raises Error unless all materials have a density that can be one; name: the option that needs it."""
        if self.deck.weightless:
            raise Error(
                f"{self.path}: material {self.deck.weightless[0]} has no *DENSITY, which {name} needs: give it in "
                f"{self.units.density_name}"
            )
        for block in self.mesh.blocks:
            wrong = (block.young > SOFT) & ((block.density < DENSITIES[0]) | (block.density > DENSITIES[1]))
            if np.any(wrong):
                raise Error(
                    f"{self.path}: a density is {block.density[wrong][0]:.3g} kg/m3, limits {DENSITIES[0]:g} and "
                    f"{DENSITIES[1]:g}: give it in {self.units.density_name}"
                )

    def _sensor(self, name, node):
        """Index of the node of a sensor, a number or a set."""
        if not node.isdecimal():
            found = deck.need_set(self.mesh.node_sets, node, "node set", self.path)
            if len(found) > 1:
                raise Error(f"{self.path}: node set {node} of --sensor {name} has {len(found)} nodes: name one node")
            return int(found[0])
        number = int(node)
        index = int(np.searchsorted(self.mesh.node_numbers, number))
        if index == len(self.mesh.node_numbers) or self.mesh.node_numbers[index] != number:
            raise Error(f"{self.path}: no node {number} of --sensor {name} in the mesh: name a node of its elements")
        return index

    def sides(self):
        """The Sides of the bodies: body 2 first."""
        kinds = (Fields, Mirrored) if self.mesh.normal is None else (LineFields, MirroredLine)
        found = []
        for one in self.parts:
            fields = [kinds[one.sign < 0](patch, *one.moduli(patch)) for patch in self.patches]
            found.append(Side(one.mesh, fields[0] if len(fields) == 1 else Several(fields)))
        return found

    def need_places(self):
        """Returns true if the surfaces of all patches count as plane; raises Error if a patch is not on them."""
        each = [(part, patch) for part in self.parts for patch in self.patches]
        plane = [checks.need_plane(part.mesh, patch, part.contact) for part, patch in each]
        for part, patch in each:
            checks.need_inside(part.mesh, patch, part.contact)
        return all(plane)

    def _plane(self, name, nodes):
        """Nodes of a plane of symmetry, and its normal in the frame's coordinates."""
        x = self.mesh.nodes[nodes]
        if self.mesh.normal is not None:  # a line of nodes is a plane along y
            x = np.concatenate([x, x + np.ptp(x) * self.mesh.normal])
        normal = plane_normal(x)
        if normal is None:
            raise Error(f"{self.path}: node set {name} of --symmetry is not a plane: name the nodes of one plane")
        off = np.abs((self.mesh.nodes[self.supported] - self.mesh.nodes[nodes].mean(axis=0)) @ normal)
        held = self.supported[off <= images.FLAT * np.ptp(self.mesh.nodes, axis=0).max()]
        return elements.covered(self.mesh, np.union1d(nodes, held)), normal


def choose(model, plane):
    """Returns `image` if it is valid, else `cutoff`, and the reason why not."""
    reasons = [
        ("the surface is curved", not plane),
        ("the body rises above the plane of the patch", plane and any(one.beyond(model.patch) for one in model.parts)),
        ("the body has several materials", not all(one.uniform() for one in model.parts)),
        ("the body has a plane of symmetry", bool(model.planes)),
    ]
    reason = ", ".join(text for text, holds in reasons if holds)
    wanted = model.settings.method
    if reason and len(model.parts) > 1:
        raise Error(
            f"{reason}: each body of a pair needs one material and a plane contact surface above which it does not "
            "rise: change the deck, or give one body alone by --contact, without --pair"
        )
    if wanted == "image" and reason:
        raise Error(f"{reason}: use --method cutoff")
    return ("cutoff" if reason or wanted == "cutoff" else "image"), reason


def _cutoff(model, plane, moduli):
    """Returns the Cutoff, and remarks."""
    mesh, patch, (part,) = model.mesh, model.patch, model.parts
    remarks = []
    if not plane:
        off = checks.deviation(mesh, patch, part.contact)
        remarks.append(f"warning: the surface is up to {off:.2g} of the patch's half width off the tangent plane")
    tolerance = max(images.FLAT * patch.wide, 0.0 if plane else checks.CURVED * patch.narrow)
    mirrored = np.concatenate([model.supported, *(nodes for nodes, _ in model.planes)])
    chi = cutoff.widest(mesh, patch, mirrored, part.contact, tolerance, moduli)
    coarse = cutoff.too_coarse(mesh, chi)
    remarks.append(f"cut-off from {chi.outer[0, :2]} to {chi.outer[1]} m")
    if coarse * cutoff.ELEMENTS > 1.0:
        remarks.append(
            f"warning: elements are up to {coarse:.2g} times as wide as the cut-off's ramp: "
            f"use at least {cutoff.ELEMENTS} across it"
        )
    return chi, remarks


def remainder(model, method, plane, progress):
    """Returns the Remainder of a Model, and its solver, after the checks of the geometry; and remarks."""
    mesh, supported, sides = model.mesh, model.supported, model.sides()
    young, remarks = sides[0].fields.young, list(model.doubts)
    if method == "image":
        each = [(part, one) for part in model.parts for one in model.patches]
        clearance = min(checks.need_clearance(part.mesh, one, supported) for part, one in each)
        remarks.append(f"nearest other surface {clearance:.4g} m from the patch")
    else:
        chi, more = _cutoff(model, plane, (young, sides[0].fields.poisson))
        remarks += more
    progress.begin("stiffness")
    matrix = stiffness(mesh, model.settings.stiffness, model.settings.ccx)
    tie = sum(one.matrix for one in model.bolts) if model.bolts else None
    fixed = np.zeros((len(mesh.nodes), 3), dtype=bool)
    fixed[supported] = True
    progress.begin("factorization")
    whole = matrix if tie is None else matrix + tie
    if model.settings.free:
        solver = Floating(whole, mesh.nodes, modes.mass(mesh))
    else:
        solver = Solver(whole, mesh.nodes, fixed.ravel(), model.planes)
    if method == "image":
        found = images.solved(sides, solver, supported, progress, tie)
        if len(model.patches) > 1:
            found.compliance += several.between(sides, model.patches)
        return found, solver, remarks
    return cutoff.solved(mesh, sides[0].fields, solver, chi, progress), solver, remarks


def _loads(model):
    """The Loads of all load cases by name: those of the deck, and unit initial tension of each bolt."""
    named = {}
    for name, step in model.settings.cases:
        named[name] = load_cases.loads(model.deck, model.mesh, model.frame, model.units, step)
    for one in model.bolts:
        named[f"bolt_{one.name}"] = load_cases.Loads(model.deck, model.mesh, model.frame, model.units)
        named[f"bolt_{one.name}"].force = one.closing.T.toarray()
    for name, loads in named.items():
        loads.name = name
    return named


def _cases(model, named, solver, found):
    """Load cases by name, each for each patch, of the Loads by name."""
    if not named:
        return {}
    jumps = [
        load_cases.Jump(model.parts, patch, [degree + GAUSS_MORE for degree in patch.largest])
        for patch in model.patches
    ]
    return {name: load_cases.cases(loads, solver, found, jumps) for name, loads in named.items()}


def _stress(model, found, cases):
    """Returns points, and stresses of the basis and of the load cases, of body 2 of a pair; None if the patch is
    curved."""
    where = stresses.grid(found.mesh, model.patch, model.settings.depth)
    if where is None:
        return None
    shape = (len(where.z), len(where.y), len(where.x), 6)
    single = {
        name: stresses.of_nodes(found.mesh, where.place, case.displacement)[..., 0].reshape(shape)
        for name, case in cases.items()
    }
    return where, stresses.remaining(where, found), single


def computed(source, settings, command="", say=None, every=0.0):
    """The Compliance of a deck or a mesh (Model); command: what made it, for the file; say: called with the lines of
    Progress, at most one in `every` seconds."""
    progress = Progress("part", say, every)
    model = Model(source, settings)
    plane = model.need_places()
    if settings.modes:
        model.prepare_modes()
    other = (
        Model(settings.coarse, settings) if settings.coarse is not None else None
    )  # to find its mistakes before the work
    loads = _loads(model)
    method, reason = choose(model, plane)
    found, solver, remarks = remainder(model, method, plane, progress)
    if reason:
        remarks.insert(0, f"method cutoff: {reason}")
    bodies = _bodies(model, found, method, command)
    bodies[0].remarks = remarks
    _add_cases(bodies, model, loads, (solver, found), progress)
    missing = _missing(source, model, (solver, found), (method, plane), progress)
    for body, own in zip(bodies, _own(model.patches)):
        body.mesh_error = mesherror.relative(body.patch, missing[own, own], body.compliance)
    if settings.stress and len(model.patches) == 1:
        progress.begin("stresses")
        bodies[0].stress = _stress(model, found, bodies[0].cases)
    if other:
        compliance = remainder(other, method, plane, progress)[0].compliance
        change = np.linalg.norm(compliance - found.compliance, 2) / np.linalg.norm(found.compliance, 2)
        bodies[0].checks["mesh_change"] = float(change)
    return several.joined(bodies, checks.symmetric(found.compliance)) if len(bodies) > 1 else Compliance(bodies)


def _missing(source, model, solution, how, progress):
    """An estimate of what the compliance lacks by the mesh; the solution is a solver and what it has found, `how` the
    method and whether the surfaces are plane."""
    (solver, found), difference = solution, 0.0
    if not elements.quadratic(model.mesh):
        model, kept = Model(source, replace(model.settings, stiffness=None), quadratic=True), found.compliance
        found, solver, _ = remainder(model, *how, progress)
        difference = found.compliance - kept
    progress.begin("the error by the mesh")
    return mesherror.missed(model.mesh, solver, found.displacement) + difference


def _own(patches):
    """Slices of the rows of the compliance of each patch."""
    ends = np.cumsum([0, *(3 * patch.count for patch in patches)])
    return [slice(*pair) for pair in zip(ends[:-1], ends[1:])]


def _bodies(model, found, method, command):
    """A Body for each patch, examined, with its own part of the compliance."""
    bodies, fields = [], found.fields
    for patch, own in zip(model.patches, _own(model.patches)):
        body = Body(
            fields.young,
            fields.poisson,
            method,
            model.path,
            model.checksum,
            command,
            model.frame,
            patch,
            found.compliance[own, own],
        )
        body.mesh, body.datum = model, fields.datum
        if model.settings.pair:
            body.other = tuple(getattr(found.sides[1].fields, name) for name in ("young", "poisson"))
        examine(body)
        bodies.append(body)
    return bodies


def _add_cases(bodies, model, loads, solution, progress):
    """Adds load cases and modes to the Bodies of the patches; the solution is a solver and what it has found."""
    solver, found = solution
    shapes = None
    if model.settings.modes:
        progress.begin(f"{model.settings.modes} modes")
        shapes = modes.found(model, solver, model.settings.modes, model.sensors)
    named = _cases(model, loads, solver, found)
    for k, body in enumerate(bodies):
        body.cases = {name: cases[k] for name, cases in named.items()}
        if shapes:
            body.modes = shapes
            body.cases.update(modes.cases(model, shapes, body.patch))
            body.checks["mass_error"] = shapes.mass_error
            body.checks["residual_eigenvalue"] = _without_modes(body)
        for name, case in body.cases.items():
            body.checks[f"rest_{name}"] = case.rest


def _without_modes(body):
    """Smallest eigenvalue of the compliance without that of the modes."""
    d = np.stack([body.cases[f"mode{k}"].coefficients.ravel() / w for k, w in enumerate(body.modes.omega, 1)])
    return body.definite.smallest(0.5 * (body.compliance + body.compliance.T) - d.T @ d)


def examine(body):
    """Writes the checks of the compliance to body.checks."""
    body.definite = definite = checks.Definiteness(body.patch, body.young, body.poisson, body.other)
    body.checks["asymmetry"] = checks.asymmetry(body.compliance)
    symmetric = checks.symmetric(body.compliance)
    body.checks["smallest_eigenvalue"] = definite.need_positive(symmetric)
    body.eigenvalues = definite.eigenvalues(symmetric)
    body.changes = checks.degree_changes(symmetric, body.patch)
    if len(body.changes) >= 2:
        body.checks["degree_change"] = body.changes[-2]

"""A body from its deck: frame, checks, stiffness, compliance, load cases, stresses."""

import time
from dataclasses import dataclass, field

import numpy as np

from ..errors import Error
from . import cases as load_cases
from . import checks, cutoff, deck, images, stresses
from .basis import Patch
from .halfspace import Fields
from .solve import Solver, plane_normal
from .stiffness import stiffness

GAUSS_MORE = 3  # Gauss points along the patch in addition to its degree, for sampling fields


@dataclass(frozen=True)
class Units:
    """Metres, pascals and newtons of a deck's units."""

    length: float
    stress: float

    @property
    def force(self):
        """Newtons."""
        return self.stress * self.length**2


UNITS = {"m": Units(1.0, 1.0), "mm": Units(1e-3, 1e6)}


@dataclass(frozen=True)
class Frame:
    """Origin (m) and x, y, z as rows, z into the body, in the model's coordinates."""

    origin: np.ndarray
    axes: np.ndarray


@dataclass
class Body:
    """The contents of the file."""

    young: float
    poisson: float
    method: str
    source: str
    command: str
    frame: Frame
    patch: Patch
    compliance: np.ndarray
    cases: dict = field(default_factory=dict)
    stress: tuple = None
    checks: dict = field(default_factory=dict)
    mesh: object = None
    remarks: list = field(default_factory=list)


def frame_of(origin, x, z, outward):
    """The Frame through an origin with directions x and z, or None, which follow from the outward area vector."""
    total = outward / max(np.linalg.norm(outward), 1e-300)
    z = -total if z is None else np.array(z) / max(np.linalg.norm(z), 1e-300)
    if total @ z > 0.0:
        raise Error("z of --frame points out of the body: reverse it")
    if x is None:
        x = (1.0, 0.0, 0.0) if abs(z[0]) < 0.9 else (0.0, 1.0, 0.0)
    x = np.array(x) - (np.array(x) @ z) * z
    if np.linalg.norm(x) < 1e-6:
        raise Error("x and z of --frame are parallel or zero: give two different directions")
    x /= np.linalg.norm(x)
    return Frame(np.array(origin, dtype=float), np.stack([x, np.cross(z, x), z]))


MEGAPASCALS = (1e3, 1e6)  # moduli of metals and plastics in MPa


class Model:
    """The mesh in the frame's coordinates, in SI units, with its supports and its contact surface."""

    def __init__(self, path, options):
        units = UNITS[options.units]
        self.path, self.options, self.units = path, options, units
        self.deck = deck.read(path)
        mesh = self.deck.mesh
        mesh.nodes = mesh.nodes * units.length
        for block in mesh.blocks:
            block.young *= units.stress
        deck.need_set(mesh.surfaces, options.contact, "surface", path)
        self.supported = np.unique(
            np.concatenate([deck.need_set(mesh.node_sets, name, "node set", path) for name in options.fixed])
        )
        symmetric = [deck.need_set(mesh.node_sets, name, "node set", path) for name in options.symmetry]
        for name, nodes in zip(options.symmetry, symmetric):
            if not np.setdiff1d(nodes, self.supported).size:
                raise Error(
                    f"{path}: node set {name} of --symmetry is held by --fixed: name another, or omit --symmetry"
                )
        faces = mesh.surface_faces(options.contact.upper())
        if not faces:
            raise Error(f"{path}: surface {options.contact} has no element faces: define it by TYPE=ELEMENT")
        outward = sum(mesh.gauss(group, 2).area.sum(axis=(0, 1)) for group in faces)
        origin, x, z = (list(options.frame) + [None, None])[:3]
        self.frame = frame_of(np.array(origin) * units.length, x, z, outward)
        self.mesh = mesh.turned(self.frame.origin, self.frame.axes)
        held = np.unique(np.concatenate([self.supported, *symmetric]))
        load_cases.need_supports(self.deck, self.mesh, self.frame, units, held)
        self.planes = [(nodes, self._normal(name, nodes)) for name, nodes in zip(options.symmetry, symmetric)]
        self.contact = faces
        self.patch = Patch(options.center, tuple(0.5 * side for side in options.patch), options.degree)

    def _normal(self, name, nodes):
        """Normal of a plane of symmetry in the frame's coordinates."""
        normal = plane_normal(self.mesh.nodes[nodes])
        if normal is None:
            raise Error(f"{self.path}: node set {name} of --symmetry is not a plane: name the nodes of one plane")
        return normal

    def moduli(self):
        """(E, nu) of the material under the patch."""
        found = set()
        for group in self.contact:
            block = self.mesh.blocks[group.block]
            x = self.mesh.nodes[group.nodes].mean(axis=1)
            inside = np.all(np.abs(x[:, :2] - self.patch.center) <= self.patch.half, axis=1)
            chosen = group.elements[inside] if np.any(inside) else group.elements
            found |= set(zip(block.young[chosen].tolist(), block.poisson[chosen].tolist()))
        if len(found) > 1:
            raise Error("the contact surface has several materials under the patch: use a smaller --patch")
        return found.pop()

    def uniform(self):
        """True if the body has only one material."""
        return len({pair for b in self.mesh.blocks for pair in zip(b.young.tolist(), b.poisson.tolist())}) == 1

    def above(self):
        """True if parts of the body lie above the plane of the patch."""
        return bool(np.min(self.mesh.nodes[:, 2]) < -images.FLAT * max(self.patch.half))


def choose(model, plane):
    """Returns `image` if it is valid, else `cutoff`, and the reason why not."""
    reasons = [
        ("the surface is curved", not plane),
        ("the body rises above the plane of the patch", plane and model.above()),
        ("the body has several materials", not model.uniform()),
        ("the body has a plane of symmetry", bool(model.planes)),
    ]
    reason = ", ".join(text for text, holds in reasons if holds)
    wanted = model.options.method
    if wanted == "image" and reason:
        raise Error(f"{reason}: use --method cutoff")
    return ("cutoff" if reason or wanted == "cutoff" else "image"), reason


class Progress:
    """Returns lines about parts of the work that take long."""

    def __init__(self, stream, seconds=5.0):
        self.stream, self.seconds = stream, seconds
        self.start = self.last = time.monotonic()

    def __call__(self, text):
        now = time.monotonic()
        if now - self.last >= self.seconds:
            self.last = now
            print(f"  {now - self.start:.0f} s: {text}", file=self.stream, flush=True)


def remainder(model, method, plane, progress):
    """Returns the Remainder of a Model, and its solver, after the checks of the geometry; and remarks."""
    mesh, patch, supported = model.mesh, model.patch, model.supported
    young, poisson = model.moduli()
    remarks = []
    if MEGAPASCALS[0] <= young < MEGAPASCALS[1] and model.options.units == "m":
        remarks.append(f"warning: Young's modulus is {young:.6g} Pa: give --units mm if the deck is in mm and MPa")
    if method == "image":
        clearance = checks.need_clearance(mesh, patch, supported)
        remarks.append(f"nearest other surface {clearance:.4g} m from the patch")
    else:
        if not plane:
            off = checks.deviation(mesh, patch, model.contact)
            remarks.append(f"warning: the surface is up to {off:.2g} of the patch's half width off the tangent plane")
        tolerance = max(images.FLAT * max(patch.half), 0.0 if plane else checks.CURVED * min(patch.half))
        mirrored = np.concatenate([supported, *(nodes for nodes, _ in model.planes)])
        chi = cutoff.widest(mesh, patch, mirrored, model.contact, tolerance, (young, poisson))
        coarse = cutoff.too_coarse(mesh, chi)
        remarks.append(f"cut-off from {chi.outer[0, :2]} to {chi.outer[1]} m")
        if coarse * cutoff.ELEMENTS > 1.0:
            remarks.append(
                f"warning: elements are up to {coarse:.2g} times as wide as the cut-off's ramp: "
                f"use at least {cutoff.ELEMENTS} across it"
            )
    progress("stiffness")
    matrix = stiffness(mesh, model.options.stiffness, model.options.ccx)
    fixed = np.zeros((len(mesh.nodes), 3), dtype=bool)
    fixed[supported] = True
    progress("factorization")
    solver = Solver(matrix, mesh.nodes, fixed.ravel(), model.planes)
    fields = Fields(patch, young, poisson)
    if method == "image":
        return images.solved(mesh, fields, solver, supported, progress), solver, remarks
    return cutoff.solved(mesh, fields, solver, chi, progress), solver, remarks


def _cases(model, solver, found):
    """Load cases by name."""
    if not model.options.case:
        return {}
    patch = model.patch
    points, _ = patch.quadrature(*(degree + GAUSS_MORE for degree in patch.largest))
    inward = max(images.FLAT, 1.01 * checks.deviation(model.mesh, patch, model.contact)) * min(patch.half)
    lift = np.concatenate([points, np.full((len(points), 1), inward)], axis=1)
    place = model.mesh.locate(lift)
    if np.any(place[0] < 0):
        raise Error("the patch is not inside the mesh: use a smaller --patch")
    cases = {}
    for name, step in model.options.case:
        loads = load_cases.loads(model.deck, model.mesh, model.frame, model.units, step)
        loads.name = name
        cases[name] = load_cases.case(loads, solver, found, patch, place, points)
    return cases


def _stress(model, found, cases):
    """Returns points, and stresses of the basis and of the load cases; None if the patch is curved."""
    where = stresses.grid(model.mesh, model.patch, model.options.depth)
    if where is None:
        return None
    shape = (len(where.z), len(where.y), len(where.x), 6)
    single = {
        name: stresses.of_nodes(model.mesh, where.place, case.displacement)[..., 0].reshape(shape)
        for name, case in cases.items()
    }
    return where, stresses.remaining(where, found), single


def computed(path, options, command, progress):
    """The Body of a deck."""
    model = Model(path, options)
    plane = checks.need_plane(model.mesh, model.patch, model.contact)
    checks.need_inside(model.mesh, model.patch, model.contact)
    other = Model(options.coarse_mesh, options) if options.coarse_mesh else None  # to find its mistakes before the work
    method, reason = choose(model, plane)
    found, solver, remarks = remainder(model, method, plane, progress)
    if reason:
        remarks.insert(0, f"method cutoff: {reason}")
    young, poisson = found.fields.young, found.fields.poisson
    body = Body(young, poisson, method, path, command, model.frame, model.patch, found.compliance)
    body.mesh, body.remarks = model, remarks
    examine(body)
    body.cases = _cases(model, solver, found)
    for name, case in body.cases.items():
        body.checks[f"rest_{name}"] = case.rest
    if options.stress:
        progress("stresses")
        body.stress = _stress(model, found, body.cases)
    if other:
        compliance = remainder(other, method, plane, progress)[0].compliance
        change = np.linalg.norm(compliance - found.compliance, 2) / np.linalg.norm(found.compliance, 2)
        body.checks["mesh_change"] = float(change)
    return body


def examine(body):
    """Writes the checks of the compliance to body.checks."""
    definite = checks.Definiteness(body.patch, body.young, body.poisson)
    body.checks["asymmetry"] = checks.asymmetry(body.compliance)
    symmetric = checks.symmetric(body.compliance)
    body.checks["smallest_eigenvalue"] = definite.need_positive(symmetric)
    body.eigenvalues = definite.eigenvalues(symmetric)
    body.changes = checks.degree_changes(symmetric, body.patch)
    if len(body.changes) >= 2:
        body.checks["degree_change"] = body.changes[-2]

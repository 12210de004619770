"""Load cases: the displacements of the patch by the loads and displacements of a step of the deck, without contact.

By Betti's theorem the coefficients need no displacement of the patch: with U_i the displacements and S_i the forces of
the supports by the traction phi_i, the loads F and the prescribed displacements g of the case give

    <phi_i, v> = F.U_i - S_i.g
"""

from dataclasses import dataclass, replace

import numpy as np

from ...core.brief import brief
from ...core.decks import folded
from ...core.errors import Error, short, there_are
from .cards import number_of, trimmed
from .checks import deviation
from .elements import new_edges
from .images import FLAT
from .keywords import CURES, WITHOUT, need_parameters, need_supported
from .remainder import scatter

REST = 1e-2  # part of the field's range; largest deviation of the polynomials
NOTHING = 1e-12  # relative to the largest; forces on nodes that are rounding
FACE_POINTS = 4  # Gauss points along the side of a loaded face
TYPES = {  # of *BOUNDARY: the directions that are held; those above 3 are rotations, which solid elements have none of
    "XSYMM": (1, 5, 6),
    "YSYMM": (2, 4, 6),
    "ZSYMM": (3, 4, 5),
    "XASYMM": (2, 3, 4),
    "YASYMM": (1, 3, 5),
    "ZASYMM": (1, 2, 6),
    "PINNED": (1, 2, 3),
    "ENCASTRE": (1, 2, 3, 4, 5, 6),
}


@brief
@dataclass
class Case:
    """Returns coefficients (m, 3), m2, the part of the field that these miss, and displacements (3 nodes, 1).

    unit: of the field at factor 1, where it is not that of a displacement.
    """

    coefficients: np.ndarray
    rest: float
    displacement: np.ndarray
    unit: str = "m"


class Loads:
    """Forces (3 nodes, 1), N, and prescribed displacements (3 nodes, 1), m, of a step."""

    def __init__(self, deck, mesh, frame, units):
        self.deck, self.mesh, self.frame, self.units = deck, mesh, frame, units
        self.force = np.zeros((3 * len(mesh.nodes), 1))
        self.moved = np.zeros((3 * len(mesh.nodes), 1))
        self.prescribed = np.zeros(3 * len(mesh.nodes), dtype=bool)
        self.along = np.zeros((len(mesh.nodes), 3), dtype=bool)  # directions of the deck that *BOUNDARY names

    def _nodes(self, card, line):
        """Indices of the nodes that the first word of a line names."""
        word = folded(line[0])
        if word in self.mesh.node_sets:
            return self.mesh.node_sets[word]
        if not word.lstrip("+-").isdecimal():
            meant = there_are(word, sorted(self.mesh.node_sets))
            raise Error(f"{line.place}: *{card.name}: no node set {short(word)}{meant}")
        number = number_of(card, word, int, line)
        index = np.searchsorted(self.mesh.node_numbers, number)
        if index == len(self.mesh.node_numbers) or self.mesh.node_numbers[index] != number:
            raise Error(f"{line.place}: no node {self.deck.label(number)} in the mesh: name a node of its elements")
        return np.array([index])

    def _direction(self, card, word, line):
        direction = number_of(card, word, int, line)
        if not 1 <= direction <= 3:
            raise Error(f"{line.place}: direction {direction}: use 1 to 3")
        return self.frame.axes[:, direction - 1]

    def _unit(self):
        """Newtons of a force of the deck: for 1 m of a section."""
        force = self.units.force
        return force if self.mesh.normal is None else force / (self.mesh.thickness * self.units.length)

    def cload(self, card, line):
        """Forces on nodes."""
        vector = self._direction(card, line[1], line) * number_of(card, line[2], line=line) * self._unit()
        self.force.reshape(-1, 3)[self._nodes(card, line)] += vector

    def boundary(self, card, line):
        """Displacements of nodes: of a type by its name, or `node or set, first, last, value`."""
        nodes, kind = self._nodes(card, line), line[1].upper()
        self.prescribed.reshape(-1, 3)[nodes] = True
        if not line[1][:1].isalpha():
            first, last = self._range(card, line)
            value = number_of(card, line[3], line=line) if len(line) > 3 else 0.0
            self.along[nodes, first - 1 : last] = True
            for direction in range(first, last + 1):
                along = self._direction(card, str(direction), line)
                self.moved.reshape(-1, 3)[nodes] += along * value * self.units.length
        elif kind not in TYPES or len(line) > 2:
            meant = there_are(kind, sorted(TYPES))
            raise Error(f"{line.place}: *BOUNDARY: {short(', '.join(line[1:]))} is no type of support{meant}")
        else:
            for direction in (one for one in TYPES[kind] if one <= 3):
                self.along[nodes, direction - 1] = True

    def follow_edges(self):
        """Lets the new middle nodes of raised elements move linearly between two ends that *BOUNDARY names."""
        ends, middles = new_edges(self.mesh)
        prescribed, moved = self.prescribed.reshape(-1, 3), self.moved.reshape(-1, 3)
        both = np.all(prescribed[ends, 0], axis=1)
        ends, middles = ends[both], middles[both]
        prescribed[middles] = True
        moved[middles] = moved[ends].mean(axis=1)
        self.along[middles] = np.all(self.along[ends], axis=1)

    def _range(self, card, line):
        """First and last direction; rotations may be held, as solid elements have none."""
        first = number_of(card, line[1], int, line)
        last = number_of(card, line[2], int, line) if len(line) > 2 and line[2] else first
        still = len(line) < 4 or number_of(card, line[3], line=line) == 0.0
        if still and 1 <= first <= last <= 6:
            return first, min(last, 3)
        if not 1 <= first <= last <= 3:
            raise Error(f"{line.place}: directions {first} to {last}: use 1 to 3")
        return first, last

    def dload(self, card, line):
        """Pressure on element faces."""
        if len(line) < 3 or line[1][:1].upper() != "P" or not line[1][1:].isdecimal():
            raise Error(f"{line.place}: {short(', '.join(line))}: only pressure P1 to P6 is supported")
        self._pressure(self.deck.faces(card, line), number_of(card, line[2], line=line))

    def dsload(self, card, line):
        """Pressure on a surface."""
        name = folded(line[0])
        if name not in self.mesh.surfaces or len(line) < 3 or line[1].upper() != "P":
            raise Error(f"{line.place}: {short(', '.join(line))}: expected `surface, P, value`")
        self._pressure(self.mesh.surfaces[name], number_of(card, line[2], line=line))

    def _pressure(self, faces, value):
        loaded = replace(self.mesh, surfaces={"": faces})
        for group in loaded.surface_faces(""):
            gauss = self.mesh.gauss(group, FACE_POINTS)
            nodal = -value * self.units.stress * np.einsum("qk,nqi->nki", gauss.values, gauss.area)
            scatter(self.force, group.nodes, nodal[..., None])


def _take(found, cards):
    for card in cards:
        need_supported(card, " in a load case")
        need_parameters(card)
        for line in card.lines:
            try:
                getattr(found, card.name.lower())(card, trimmed(line))
            except IndexError:
                raise Error(f"{line.place}: a line of *{card.name} has too few values: complete it") from None
    found.follow_edges()


def need_supports(deck, mesh, frame, units, fixed, symmetric):
    """Checks that the nodes that the deck holds in all steps are among the supported ones (`symmetric` by --symmetry);
    returns warnings about nodes that --fixed holds in more directions."""
    found = Loads(deck, mesh, frame, units)
    _take(found, deck.supports)
    free = np.setdiff1d(np.flatnonzero(found.prescribed.reshape(-1, 3)[:, 0]), [*fixed, *symmetric])
    if len(free):
        raise Error(
            f"{deck.supports[0].place}: *BOUNDARY holds node {deck.label(mesh.node_numbers[free[0]])}, which is not in "
            "--fixed or --symmetry: add its set to --fixed, or remove the card"
        )
    if mesh.normal is not None:  # decks of sections have no third direction
        found.along[np.any(found.along, axis=1)] |= np.abs(frame.axes[1]) > 0.5
    held = np.any(found.along[fixed], axis=1) & ~np.all(found.along[fixed], axis=1)
    if not np.any(held):
        return []
    node = fixed[np.flatnonzero(held)[0]]
    names = " and ".join("xyz"[k] for k in np.flatnonzero(found.along[node]))
    return [
        f"warning: {deck.supports[0].place}: *BOUNDARY holds node {deck.label(mesh.node_numbers[node])} in {names} "
        "only, and --fixed in x, y and z: give --symmetry for planes of symmetry, or hold it in the deck in all three"
    ]


def loads(deck, mesh, frame, units, step):
    """The Loads of a step, numbered from 1."""
    if not 1 <= step <= len(deck.steps):
        raise Error(f"the deck has {len(deck.steps)} steps, not step {step}: name one of them by --case NAME=STEP")
    found = Loads(deck, mesh, frame, units)
    for card in (card for earlier in deck.steps[: step - 1] for card in earlier):
        if CURES.get(card.name) == WITHOUT:  # elements that a step removes are absent in later ones, too
            need_supported(card, " before a load case")
    _take(found, deck.steps[step - 1])
    if not (np.any(found.force) or np.any(found.moved)):
        raise Error(f"step {step} has no load: give *CLOAD, *DLOAD, *DSLOAD or *BOUNDARY in it")
    return found


def cases(found, solver, remainder, jumps):
    """Returns the Case of the Loads for each patch; jumps: the Jump of each; `found.name`: in errors."""
    free = found.prescribed & ~solver.fixed
    if np.any(free):
        number = found.deck.label(found.mesh.node_numbers[np.flatnonzero(free)[0] // 3])
        raise Error(f"load case {found.name}: node {number} is prescribed but not in --fixed: add its set to --fixed")
    given = found.moved[solver.held]
    v = solver(found.force, given)
    force = solver.balanced(found.force).reshape(-1, 3)
    loaded = np.flatnonzero(np.any(np.abs(force) > NOTHING * np.abs(force).max(), axis=1))
    coefficients = np.einsum("nic,ni->c", remainder.total(loaded), force[loaded])
    coefficients -= (remainder.support.T @ given)[:, 0]
    parts = np.split(coefficients.reshape(-1, 3), np.cumsum([jump.patch.count for jump in jumps])[:-1])
    name = f"load case {found.name}"
    return [Case(part, rest(name, jump, jump(v), part), v) for jump, part in zip(jumps, parts)]


def rest(what, jump, sampled, coefficients):
    """Returns the part of a sampled field that its coefficients miss, after a check."""
    missed = np.max(np.abs(sampled - jump.patch.values(*jump.points.T) @ coefficients))
    spread = np.max(np.ptp(sampled, axis=0)) + 1e-3 * np.max(np.abs(sampled))
    if not missed <= REST * spread:
        raise Error(
            f"{what}: the polynomials miss {missed / spread:.2g} of its field on the patch, limit "
            f"{REST:g}: use a higher --degree, a finer mesh, or a load farther from the patch"
        )
    return float(missed / spread)


class Jump:
    """Displacements of the patch by those of the nodes: of the body, or of body 2 minus body 1."""

    def __init__(self, parts, patch, counts):
        """counts: numbers of Gauss points in x and y."""
        self.patch, self.parts = patch, parts
        self.points, self.weights = patch.quadrature(*counts)
        self.places = []
        for part in parts:
            inward = max(FLAT, 1.01 * deviation(part.mesh, patch, part.contact)) * patch.narrow
            lift = np.concatenate([self.points, np.full((len(self.points), 1), part.sign * inward)], axis=1)
            self.places.append(part.mesh.locate(lift))
            if np.any(self.places[-1][0] < 0):
                raise Error("the patch is not inside the mesh: use a smaller --patch")

    def __call__(self, v):
        """Values (points, 3) by displacements (3 nodes, 1)."""
        v = v.reshape(-1, 3)
        return sum(part.sign * part.mesh.interpolate(place, v) for part, place in zip(self.parts, self.places))

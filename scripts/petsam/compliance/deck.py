"""Reading a deck of CalculiX or Abaqus (.inp): nodes, solid elements, sets, surfaces, elastic materials, loads of its
steps."""

from dataclasses import dataclass

import numpy as np

from ..errors import Error, short, there_are
from .assembly import flat
from .cards import number_of, read_cards
from .mesh import Block, Mesh
from .shapes import KINDS, SHAPES

# keywords that change the stiffness or the meaning of directions, which are not supported
UNSUPPORTED = (
    "BEAM SECTION", "COUPLING", "CYCLIC SYMMETRY MODEL", "DASHPOT", "DISTRIBUTING COUPLING", "EQUATION", "GAP",
    "KINEMATIC COUPLING", "MASS", "MEMBRANE SECTION", "MPC", "PRE-TENSION SECTION", "RIGID BODY", "SHELL SECTION",
    "SPRING", "SUBMODEL", "TIE", "TRANSFORM",
)  # fmt: skip
LOADS = ("CLOAD", "DLOAD", "DSLOAD", "BOUNDARY")
UNSUPPORTED_LOADS = ("TEMPERATURE", "CFLUX", "DFLUX", "CHANGE CONTACT PAIR", "MODEL CHANGE")


@dataclass
class Deck:
    """A deck's mesh, in its own units and coordinates, the load cards of its steps, *BOUNDARY before the steps, and the
    materials in use that have no density."""

    mesh: Mesh
    element_sets: dict
    steps: list
    supports: list
    weightless: list


def _shorten(sets):
    """Names of one instance only, INSTANCE.NAME, are known as NAME as well, unless the assembly has this name."""
    short_names = [name.partition(".")[2] for name in sets]
    for name in [name for name in sets if name.partition(".")[2]]:
        one = name.partition(".")[2]
        if one not in sets and short_names.count(one) == 1:
            sets[one] = sets[name]


class Reader:
    """Gathers a deck, card by card."""

    def __init__(self, path):
        self.path = path
        self.nodes, self.elements = {}, []  # number -> x; (kind, number, nodes)
        self.node_sets, self.element_sets, self.surfaces = {}, {}, {}
        self.materials, self.densities, self.sections, self.steps, self.supports = {}, {}, [], [], []
        self._material, self._in_step = None, False
        for card in flat(read_cards(path)):
            self._take(card)
        for sets in (self.node_sets, self.element_sets, self.surfaces):
            _shorten(sets)

    def _take(self, card):
        if card.name in UNSUPPORTED:
            raise Error(f"{card.place}: *{card.name} is not supported: remove it, and mesh the body without it")
        if self._in_step and card.name in LOADS + UNSUPPORTED_LOADS:
            self.steps[-1].append(card)
        method = getattr(self, "take_" + card.name.lower().replace(" ", "_"), None)
        if method and not (self._in_step and card.name != "END STEP"):
            method(card)

    def take_boundary(self, card):
        self.supports.append(card)

    def take_step(self, _card):
        self._in_step = True
        self.steps.append([])

    def take_end_step(self, _card):
        self._in_step = False

    def take_node(self, card):
        numbers = []
        for words in card.lines:
            words = [word for word in words if word]
            if len(words) < 3:
                raise Error(f"{card.place}: a node has {len(words) - 1} coordinates: give three")
            numbers.append(number_of(card, words[0], int))
            self.nodes[numbers[-1]] = [number_of(card, word) for word in (words[1:] + ["0."])[:3]]
        self._add(self.node_sets, card.parameters.get("NSET"), numbers)

    def take_element(self, card):
        kind = card.need("TYPE").upper()
        if kind not in KINDS:
            raise Error(f"{card.place}: elements of type {short(kind)} are not supported; use {', '.join(KINDS)}")
        count = len(SHAPES[KINDS[kind]].family.nodes) + 1
        words = [number_of(card, word, int) for line in card.lines for word in line if word]
        if len(words) % count:
            raise Error(f"{card.place}: elements of type {kind} need {count - 1} nodes each")
        table = np.array(words).reshape(-1, count)
        self.elements += [(kind, int(row[0]), row[1:]) for row in table]
        self._add(self.element_sets, card.parameters.get("ELSET"), table[:, 0].tolist())

    @staticmethod
    def _add(sets, name, numbers):
        if name:
            sets.setdefault(name.upper(), []).extend(numbers)

    def _members(self, card, sets, generate):
        numbers = []
        for words in card.lines:
            words = [word for word in words if word]
            if generate:
                first, last, *stride = [number_of(card, word, int) for word in words]
                numbers += range(first, last + 1, *(stride or [1]))
                continue
            for word in words:
                numbers += sets[word.upper()] if word.upper() in sets else [number_of(card, word, int)]
        return numbers

    def take_nset(self, card):
        self._add(self.node_sets, card.need("NSET"), self._members(card, self.node_sets, "GENERATE" in card.parameters))

    def take_elset(self, card):
        members = self._members(card, self.element_sets, "GENERATE" in card.parameters)
        self._add(self.element_sets, card.need("ELSET"), members)

    def faces(self, card, words):
        """(element, local face from 0) of a data line `element or set, S1`."""
        if len(words) < 2 or words[1][:1].upper() not in ("S", "P") or not words[1][1:].isdecimal():
            raise Error(f"{card.place}: expected `element or set, S1` to S6: only element surfaces are supported")
        name = words[0].upper()
        elements = self.element_sets[name] if name in self.element_sets else [number_of(card, words[0], int)]
        return [(element, int(words[1][1:]) - 1) for element in elements]

    def take_surface(self, card):
        kind = card.parameters.get("TYPE", "ELEMENT").upper()
        found = [face for words in card.lines for face in self.faces(card, words)] if kind == "ELEMENT" else []
        self.surfaces[card.need("NAME").upper()] = found

    def take_material(self, card):
        self._material = card.need("NAME").upper()

    def take_elastic(self, card):
        if card.parameters.get("TYPE", "ISO").upper() not in ("ISO", "ISOTROPIC"):
            raise Error(f"{card.place}: only isotropic elasticity is supported: give *ELASTIC with E and nu")
        words = [word for word in card.lines[0] if word] if card.lines else []
        if len(words) < 2:
            raise Error(f"{card.place}: *ELASTIC needs E and nu")
        if len(card.lines) > 1:
            raise Error(f"{card.place}: *ELASTIC depends on the temperature: give one line, E and nu")
        young, poisson = (number_of(card, word) for word in words[:2])
        if not (young > 0.0 and -1.0 < poisson < 0.5):
            raise Error(f"{card.place}: E = {young:g}, nu = {poisson:g}: use E > 0 and -1 < nu < 0.5")
        self.materials[self._material] = (young, poisson)

    def take_density(self, card):
        words = [word for word in card.lines[0] if word] if card.lines else []
        if len(words) != 1 or len(card.lines) > 1:
            raise Error(f"{card.place}: *DENSITY needs one value, which does not depend on the temperature")
        density = number_of(card, words[0])
        if not density > 0.0:
            raise Error(f"{card.place}: density {density:g}: use a value above 0")
        self.densities[self._material] = density

    def take_solid_section(self, card):
        if "ORIENTATION" in card.parameters:
            raise Error(f"{card.place}: oriented materials are not supported: remove ORIENTATION")
        self.sections.append((card, card.need("ELSET").upper(), card.need("MATERIAL").upper()))

    # ---------------------------------------------------------------- the whole

    def _moduli(self):
        """{element number: (E, nu, density)}; a density of 0 where the material has none."""
        moduli = {}
        for card, name, material in self.sections:
            if name not in self.element_sets:
                raise Error(f"{card.place}: no element set {short(name)}")
            if material not in self.materials:
                raise Error(f"{card.place}: material {short(material)} has no *ELASTIC")
            constants = (*self.materials[material], self.densities.get(material, 0.0))
            moduli.update(dict.fromkeys(self.element_sets[name], constants))
        return moduli

    def deck(self):
        """The Deck."""
        if not self.elements:
            raise Error(f"{self.path}: has no solid elements: give a CalculiX deck with *NODE and *ELEMENT")
        moduli = self._moduli()
        used = np.unique(np.concatenate([nodes for _, _, nodes in self.elements]))
        lacking = [number for number in used.tolist() if number not in self.nodes]
        if lacking:
            raise Error(f"{self.path}: node {lacking[0]} of an element is not defined by *NODE")
        bare = [number for _, number, _ in self.elements if number not in moduli]
        if bare:
            raise Error(f"{self.path}: element {bare[0]} has no *SOLID SECTION")
        blocks = []
        for kind in sorted({kind for kind, _, _ in self.elements}):
            chosen = [(number, nodes) for other, number, nodes in self.elements if other == kind]
            constants = np.array([moduli[number] for number, _ in chosen])
            nodes = np.searchsorted(used, np.array([nodes for _, nodes in chosen]))
            blocks.append(Block(kind, np.array([n for n, _ in chosen]), nodes, *constants.T.copy()))
        points = np.array([self.nodes[number] for number in used.tolist()])
        sets = {name: np.searchsorted(used, np.intersect1d(used, n)) for name, n in self.node_sets.items()}
        weightless = sorted({material for _, _, material in self.sections if material not in self.densities})
        mesh = Mesh(points, blocks, sets, self.surfaces, used)
        return Deck(mesh, self.element_sets, self.steps, self.supports, weightless)


def read(path):
    """The Deck of a file."""
    reader = Reader(path)
    deck = reader.deck()
    deck.faces = reader.faces
    return deck


def need_set(sets, name, what, path):
    """A set by its name, which must exist and not be empty."""
    found = sets.get(name.upper())
    if found is None:
        raise Error(f"{path}: no {what} {short(name)}{there_are(name.upper(), sorted(sets))}")
    if not len(found):
        raise Error(f"{path}: {what} {short(name)} is empty: name another one")
    return found

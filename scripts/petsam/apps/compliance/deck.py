"""Reading a deck of CalculiX or Abaqus (.inp): nodes, solid elements, sets, surfaces, elastic materials, loads of its
steps."""

from dataclasses import dataclass

import numpy as np

from ...core.brief import brief
from ...core.decks import folded
from ...core.errors import Error, short, there_are
from . import section, sound
from .assembly import flat, instance_names, label_of
from .cards import number_of, read_cards, trimmed
from .keywords import IGNORED, IN_STEPS, LOADS, READ, known, need_parameters, need_supported
from .mesh import Block, Mesh
from .shapes import KINDS, SHAPES


@brief
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
    """Gathers a deck, card by card: nodes and elements first, which sets and surfaces name."""

    def __init__(self, path):
        self.path = path
        self.nodes, self.elements = {}, []  # number -> x; (kind, number, nodes)
        self.places, self.kinds = {}, {}  # of elements by number: (file, line); type
        self.node_sets, self.element_sets, self.surfaces = {}, {}, {}
        self.materials, self.densities, self.sections, self.steps, self.supports = {}, {}, [], [], []
        self._material, self._step, self.thicknesses = None, None, []
        cards = read_cards(path)
        for card in cards:
            card.name = known(card)
            if card.name in ("PART", "INSTANCE"):  # which the flat deck has no more
                need_parameters(card)
        self.instances = instance_names(cards)
        cards = flat(cards)
        for card in cards:
            self._follow(card)
            if card.name in ("NODE", "ELEMENT"):
                self._take(card)
        self._step, self.steps = None, []
        for card in cards:
            self._follow(card)
            if card.name not in ("NODE", "ELEMENT"):
                self._take(card)
        for sets in (self.node_sets, self.element_sets, self.surfaces):
            _shorten(sets)

    def _follow(self, card):
        """Follows the steps; raises Error if a card is not where it belongs."""
        if card.name == "STEP":
            self.steps.append([])
        if self._step and card.name in READ and card.name not in (*LOADS, *IN_STEPS, "END STEP"):
            raise Error(f"{card.place}: *{card.name} is inside the step of {self._step.place}: end that by *END STEP")
        if not self._step and card.name in ("CLOAD", "DLOAD", "DSLOAD", "END STEP"):
            raise Error(f"{card.place}: *{card.name} is outside of all steps: begin one by *STEP")
        if card.name in ("STEP", "END STEP"):
            self._step = card if card.name == "STEP" else None

    def _take(self, card):
        if self._step and card.name not in (*IN_STEPS, *IGNORED, "STEP"):
            self.steps[-1].append(card)  # is judged where the step is a load case
            return
        need_supported(card)
        method = getattr(self, "take_" + card.name.lower().replace(" ", "_").replace("-", "_"), None)
        if method and card.name in READ:
            method(card)

    def take_boundary(self, card):
        """Remembers supports."""
        self.supports.append(card)

    def take_node(self, card):
        """Adds nodes."""
        numbers = []
        for line in card.lines:
            words = trimmed(line)
            if len(words) < 3:
                count = max(len(words) - 1, 0)
                raise Error(f"{line.place}: a node has {count} coordinate{'s' * (count != 1)}: give three")
            number = number_of(card, words[0], int, line)
            x = [number_of(card, word or "0.", line=line) for word in (words[1:] + ["0."])[:3]]
            if self.nodes.setdefault(number, x) != x:
                raise Error(f"{line.place}: node {self.label(number)} is given twice, in two places: remove one")
            numbers.append(number)
        self._add(self.node_sets, card.parameters.get("NSET"), numbers)

    def take_element(self, card):
        """Adds elements."""
        kind = card.need("TYPE").upper()
        section.need_kind(kind, card.place)
        if kind not in KINDS:
            raise Error(f"{card.place}: elements of type {short(kind)} are not supported; use {', '.join(KINDS)}")
        count = len(SHAPES[KINDS[kind]].family.nodes) + 1
        numbers, words, first = [], [], None
        for line in card.lines:
            first = line if not words else first
            words += [number_of(card, word, int, line) for word in trimmed(line)]
            if len(words) > count:
                break
            if len(words) == count:
                self._add_element(kind, words, first)
                numbers.append(words[0])
                words = []
        if words:
            raise Error(f"{first.place}: elements of type {kind} need {count - 1} nodes each: correct this one")
        self._add(self.element_sets, card.parameters.get("ELSET"), numbers)

    def _add_element(self, kind, words, line):
        number = words[0]
        if number in self.places:
            raise Error(
                f"{line.place}: element {self.label(number)} is given twice, first in {self.place_of(number)}: remove "
                "one of them"
            )
        self.elements.append((kind, number, np.array(words[1:])))
        self.places[number], self.kinds[number] = (line.path, line.number), kind

    def place_of(self, number):
        """Where an element is defined."""
        return "{}:{}".format(*self.places[number])

    def label(self, number):
        """A label as the deck has it."""
        return label_of(number, self.instances)

    @staticmethod
    def _add(sets, name, numbers):
        if name:
            sets.setdefault(folded(name), {}).update(dict.fromkeys(numbers))

    def _members(self, card, sets, labels, what):
        """Labels of the nodes or elements of a set, of those that exist."""
        numbers = {}
        for line in card.lines:
            words = trimmed(line)
            if "GENERATE" in card.parameters:
                numbers.update(dict.fromkeys(self._generated(card, line, words, labels)))
                continue
            for word in words:
                found = sets.get(folded(word)) or self._labels(card, line, word, sets, labels, what)
                numbers.update(dict.fromkeys(found))
        return numbers

    def _labels(self, card, line, word, sets, labels, what):
        """The labels that a word names: those of a set, or itself."""
        if folded(word) in sets:
            return sets[folded(word)]
        if not word.lstrip("+-").isdecimal():
            meant = there_are(folded(word), sorted(sets))
            raise Error(f"{line.place}: *{card.name}: no {what} set {short(word)} above this line{meant}")
        number = number_of(card, word, int, line)
        if number not in labels:
            raise Error(f"{line.place}: *{card.name}: no {what} {self.label(number)} in the deck: remove it, or add it")
        return (number,)

    def _generated(self, card, line, words, labels):
        """Existing labels of a range; the range may be much longer."""
        numbers = [number_of(card, word, int, line) for word in words]
        first, last, stride = (*numbers, 1)[:3] if len(numbers) in (2, 3) else (0, 0, 0)
        if not (first <= last and stride > 0):
            raise Error(f"{line.place}: *{card.name}, GENERATE: expected `first, last, stride` with first <= last")
        every = range(first, last + 1, stride)
        if len(every) <= len(labels):
            return [number for number in every if number in labels]
        return [number for number in labels if number in every]

    def take_nset(self, card):
        """Adds nodes to a set."""
        members = self._members(card, self.node_sets, self.nodes, "node")
        if card.parameters.get("ELSET"):
            name = folded(card.parameters["ELSET"])
            if name not in self.element_sets:
                meant = there_are(name, sorted(self.element_sets))
                raise Error(f"{card.place}: *NSET: no element set {short(name)} above this line{meant}")
            wanted = self.element_sets[name]
            for _, number, nodes in self.elements:
                if number in wanted:
                    members.update(dict.fromkeys(nodes.tolist()))
        self._add(self.node_sets, card.need("NSET"), members)

    def take_elset(self, card):
        """Adds elements to a set."""
        members = self._members(card, self.element_sets, self.places, "element")
        self._add(self.element_sets, card.need("ELSET"), members)

    def faces(self, card, words):
        """(element, local face from 0) of a data line `element or set, S1`."""
        if len(words) < 2 or words[1][:1].upper() not in ("S", "P") or not words[1][1:].isdecimal():
            raise Error(f"{words.place}: expected `element or set, S1` to S6: only element surfaces are supported")
        elements = self._labels(card, words, words[0], self.element_sets, self.places, "element")
        face = int(words[1][1:])
        for number in elements:
            most = len(SHAPES[KINDS[self.kinds[number]]].faces)
            if not 1 <= face <= most:
                raise Error(
                    f"{words.place}: {short(words[1])}: element {self.label(number)} of type {self.kinds[number]} has "
                    f"the faces 1 to {most}: name one of them"
                )
        return [(element, face - 1) for element in elements]

    def take_surface(self, card):
        """Adds a surface."""
        kind, name = card.parameters.get("TYPE", "ELEMENT").upper(), folded(card.need("NAME"))
        if name in self.surfaces:
            raise Error(f"{card.place}: surface {short(name)} is given twice: rename one")
        found = [face for words in card.lines for face in self.faces(card, words)] if kind == "ELEMENT" else []
        self.surfaces[name] = found

    def take_material(self, card):
        """Begins a material."""
        self._material = folded(card.need("NAME"))
        if self._material in self.materials:
            raise Error(f"{card.place}: material {short(self._material)} is given twice: rename one")

    def _constants(self, card, known_ones):
        """The words of the only data line of a card of a material, which must be new."""
        if self._material is None:
            raise Error(f"{card.place}: *{card.name} stands before *MATERIAL: give it below")
        if self._material in known_ones:
            raise Error(f"{card.place}: material {short(self._material)} has *{card.name} twice: remove one")
        return trimmed(card.lines[0]) if card.lines else []

    def take_elastic(self, card):
        """Takes E and nu."""
        if card.parameters.get("TYPE", "ISO").upper() not in ("ISO", "ISOTROPIC"):
            raise Error(f"{card.place}: only isotropic elasticity is supported: give *ELASTIC with E and nu")
        words = self._constants(card, self.materials)
        if len(words) < 2:
            raise Error(f"{card.place}: *ELASTIC needs E and nu: give both in the next line")
        if len(card.lines) > 1:
            raise Error(f"{card.place}: *ELASTIC depends on the temperature: give one line, E and nu")
        young, poisson = (number_of(card, word, line=card.lines[0]) for word in words[:2])
        if not (young > 0.0 and -1.0 < poisson < 0.5):
            place = card.lines[0].place
            raise Error(f"{place}: E = {young:g}, nu = {poisson:g}: use E > 0 and -1 < nu < 0.5")
        self.materials[self._material] = (young, poisson)

    def take_density(self, card):
        """Takes the density."""
        words = self._constants(card, self.densities)
        if not 1 <= len(words) <= 2 or len(card.lines) > 1:
            raise Error(f"{card.place}: *DENSITY needs one value, which does not depend on the temperature")
        density = number_of(card, words[0], line=card.lines[0])
        if not density > 0.0:
            raise Error(f"{card.lines[0].place}: density {density:g}: use a value above 0")
        self.densities[self._material] = density

    def take_solid_section(self, card):
        """Remembers which elements are of which material."""
        self.sections.append((card, folded(card.need("ELSET")), folded(card.need("MATERIAL"))))
        words = trimmed(card.lines[0]) if card.lines else []
        values = [number_of(card, word, line=card.lines[0]) for word in words[:1] if word]
        self.thicknesses.append((card, values))

    # ---------------------------------------------------------------- the whole

    def _moduli(self):
        """{element number: (E, nu, density)}; a density of 0 where the material has none."""
        moduli = {}
        for card, name, material in self.sections:
            if name not in self.element_sets:
                meant = there_are(name, sorted(self.element_sets))
                raise Error(f"{card.place}: no element set {short(name)}{meant}")
            if material not in self.materials:
                raise Error(f"{card.place}: material {short(material)} has no *ELASTIC: give it E and nu")
            constants = (*self.materials[material], self.densities.get(material, 0.0))
            for number in self.element_sets[name]:
                if moduli.setdefault(number, constants) != constants:
                    raise Error(
                        f"{card.place}: element {self.label(number)} has another *SOLID SECTION of another material: "
                        "remove it from one set"
                    )
        return moduli

    def deck(self):
        """The Deck."""
        if not self.elements:
            raise Error(f"{self.path}: has no solid elements: give a CalculiX deck with *NODE and *ELEMENT")
        moduli = self._moduli()
        used = np.unique(np.concatenate([nodes for _, _, nodes in self.elements]))
        lacking = {number for number in used.tolist() if number not in self.nodes}
        if lacking:
            number, node = next((n, k) for _, n, nodes in self.elements for k in nodes.tolist() if k in lacking)
            raise Error(
                f"{self.place_of(number)}: node {self.label(node)} of an element is not defined by *NODE: add it"
            )
        bare = [number for _, number, _ in self.elements if number not in moduli]
        if bare:
            raise Error(
                f"{self.place_of(bare[0])}: element {self.label(bare[0])} has no *SOLID SECTION: name its set in one"
            )
        blocks = []
        for kind in sorted({kind for kind, _, _ in self.elements}):
            chosen = [(number, nodes) for other, number, nodes in self.elements if other == kind]
            constants = np.array([moduli[number] for number, _ in chosen])
            nodes = np.searchsorted(used, np.array([nodes for _, nodes in chosen]))
            blocks.append(Block(kind, np.array([n for n, _ in chosen]), nodes, *constants.T.copy()))
        points = np.array([self.nodes[number] for number in used.tolist()])
        sets = {name: np.searchsorted(used, np.intersect1d(used, [*n])) for name, n in self.node_sets.items()}
        weightless = sorted({material for _, _, material in self.sections if material not in self.densities})
        mesh = section.oriented(Mesh(points, blocks, sets, self.surfaces, used), self.path)
        mesh.thickness = section.thickness(self.thicknesses) if mesh.normal is not None else 1.0
        sound.need_sound(mesh, lambda n: f"{self.place_of(n)}: element {self.label(n)}")
        return Deck(mesh, self.element_sets, self.steps, self.supports, weightless)


def read(path):
    """The Deck of a file."""
    reader = Reader(path)
    deck = reader.deck()
    deck.faces, deck.label = reader.faces, reader.label
    return deck


def need_set(sets, name, what, path):
    """A set by its name, which must exist and not be empty."""
    found = sets.get(folded(name))
    if found is None:
        raise Error(f"{path}: no {what} {short(name)}{there_are(folded(name), sorted(sets))}")
    if not len(found):
        raise Error(f"{path}: {what} {short(name)} is empty: name another one")
    return found

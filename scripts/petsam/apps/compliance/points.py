"""The nodes of a deck and their sets alone: of a deck of any analysis, with contact, ties, rigid bodies, shells."""

import os
from typing import Union

import numpy as np

from ...core.decks import folded
from .assembly import LABELS, label_of
from .deck import Reader
from .keywords import need_parameters
from .shapes import KINDS, SHAPES

TAKEN = ("NODE", "NSET", "ELEMENT", "ELSET", "SURFACE")


class Points(Reader):
    """Nodes, {number: (x, y, z)} in the deck's units, node sets, {name: numbers}, and element surfaces of a deck.
    Elements of kinds that petsam does not assemble are left out of sets and surfaces."""

    def _follow(self, card):
        """Leaves steps alone: none of them is a load case here."""

    def _take(self, card):
        if card.name not in TAKEN:
            return
        if card.name == "SURFACE" and card.parameters.get("TYPE", "ELEMENT").upper() != "ELEMENT":
            return
        if card.name == "ELEMENT" and card.parameters.get("TYPE", "").upper() not in KINDS:
            self._add(self.element_sets, card.parameters.get("ELSET"), [])
            return
        if card.name != "ELEMENT":
            need_parameters(card)
        getattr(self, "take_" + card.name.lower())(card)

    def _labels(self, card, line, word, sets, labels, what):
        if what == "element" and folded(word) not in sets and word.isdecimal() and int(word) not in labels:
            return ()  # of a kind that is left out
        return super()._labels(card, line, word, sets, labels, what)

    def label(self, number):
        """A label as the deck has it: 5, or INSTANCE.5."""
        return label_of(number, self.instances)

    def before(self, place):
        """The number before the first label of an instance, by its place among the instances."""
        return LABELS * place

    def members(self, name):
        """Numbers of the nodes of a node set, or of an element surface; None without one of this name."""
        name = folded(name)
        if name in self.node_sets:
            return np.array(sorted(self.node_sets[name]), dtype=int)
        if name not in self.surfaces:
            return None
        faces, found = {}, set()
        for number, local in self.surfaces[name]:
            faces.setdefault(number, []).append(local)
        for kind, number, nodes in self.elements:
            for local in faces.get(number, ()):
                found.update(nodes[list(SHAPES[KINDS[kind]].faces[local])].tolist())
        return np.array(sorted(found), dtype=int)


def nodes_of(path: Union[str, os.PathLike]) -> Points:
    """Reads the nodes of a deck and their sets alone.

    Parameters
    ----------
    path : path
        The deck, of any analysis.

    Returns
    -------
    Points
        Nodes, node sets and element surfaces.
    """
    return Points(path)

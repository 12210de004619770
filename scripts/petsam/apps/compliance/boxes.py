"""Sets and surfaces by coordinates: by boxes (core/decks.py)."""

import numpy as np

from ...core.decks import BOX, folded, inside


def added(deck, settings):
    """The Deck, with the boxes that the settings name as node sets and as surfaces: outer faces all of whose nodes are
    in the box."""
    mesh = deck.mesh
    sensors = [node for _, node in settings.sensors]
    for text in filter(BOX.fullmatch, [*settings.supports, *settings.symmetry, *sensors]):
        mesh.node_sets[folded(text)] = np.flatnonzero(inside(mesh.nodes, text))
    washers = [name for one in settings.bolts for name in one.surfaces]
    for text in filter(BOX.fullmatch, [settings.contact, settings.pair or "", *washers]):
        mesh.surfaces[folded(text)] = faces_of(mesh, inside(mesh.nodes, text))
    return deck


def faces_of(mesh, mask):
    """(element number, local face) of the outer faces all of whose nodes a mask has."""
    found = []
    for group in mesh.boundary():
        chosen = np.all(mask[group.nodes], axis=1)
        found += [(int(number), group.local) for number in mesh.blocks[group.block].numbers[group.elements[chosen]]]
    return found

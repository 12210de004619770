"""Sets and surfaces by coordinates: by boxes (core/decks.py)."""

import numpy as np

from ...core.decks import Box, folded


def added(deck, settings):
    """The Deck, with the boxes that the settings name as node sets and as surfaces: outer faces all of whose nodes are
    in the box."""
    mesh = deck.mesh
    sensors = [node for _, node in settings.sensors]
    for text in (*settings.supports, *settings.symmetry, *sensors):
        if box := Box.of(text):
            mesh.node_sets[folded(text)] = np.flatnonzero(box.inside(mesh.nodes))
    washers = [name for one in settings.bolts for name in one.surfaces]
    for text in (settings.contact, settings.pair or "", *washers):
        if box := Box.of(text):
            mesh.surfaces[folded(text)] = faces_of(mesh, box.inside(mesh.nodes))
    return deck


def faces_of(mesh, mask):
    """(element number, local face) of the outer faces all of whose nodes a mask has."""
    found = []
    for group in mesh.boundary():
        chosen = np.all(mask[group.nodes], axis=1)
        found += [(int(number), group.local) for number in mesh.blocks[group.block].numbers[group.elements[chosen]]]
    return found

"""Sets and surfaces by coordinates: a box of two corners, `0,0,4:4,4,4`, in the mesh's coordinates and units."""

import re

import numpy as np

from .cards import folded

NUMBER = r"[+-]?(?:\d+\.?\d*(?:[eE][+-]?\d+)?|\.\d+(?:[eE][+-]?\d+)?|inf)"
POINT = rf"{NUMBER},{NUMBER},{NUMBER}"
BOX = re.compile(rf"{POINT}:{POINT}")
NEAR = 1e-6  # of the extent of the mesh, by which nodes may be outside of a box


def inside(nodes, text):
    """Mask of the nodes in a box; its corners may be given in any order."""
    low, high = np.sort([[float(word) for word in point.split(",")] for point in text.split(":")], axis=0)
    near = NEAR * np.max(np.ptp(nodes, axis=0))
    return np.all((nodes >= low - near) & (nodes <= high + near), axis=1)


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

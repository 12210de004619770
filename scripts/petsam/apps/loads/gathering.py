"""Rows of a file, one per node and time, as arrays over times and nodes; coordinates of a deck."""

from dataclasses import dataclass, field
from typing import Optional

import numpy as np

from ...core import units
from ...core.brief import brief
from ...core.decks import folded
from ...core.errors import Error, Unusable, counted, short
from ..compliance import nodes_of
from .forces import Forces

EXAMPLES = {"length": "mm", "force": "N"}
OF = {"length": "m", "force": "N"}


@dataclass
class Given:
    """Options on a file: the deck of its nodes, and the names of its units (None: not given)."""

    deck: Optional[str] = None
    length: Optional[str] = None
    force: Optional[str] = None

    def size(self, name, path, stated=None, where=""):
        """The size of the unit of `length` or `force` in SI: that of the option, or that the file states."""
        given = getattr(self, name)
        found = given if given is not None else stated
        if found is None:
            what = {"length": "coordinates", "force": "forces"}[name]
            raise Unusable(f"{path}: does not say the unit of its {what}: give --{name}, such as {EXAMPLES[name]}")
        size = units.size(found, OF[name])
        if size is None:
            raise Unusable(f"--{name} {short(found)}: use one of {units.names(OF[name])}")
        if stated is not None and size != units.size(stated, OF[name]):
            raise Unusable(f"{path}{where}: is in {short(stated)}, not in {short(found)}: remove --{name}")
        return size


@brief
@dataclass
class Rows:
    """Rows of a file in their order: columns of numbers, in the file's units, and the number of each line."""

    path: str
    labels: list = field(default_factory=list)  # of each row, like times and lines
    times: list = field(default_factory=list)
    lines: list = field(default_factory=list)
    force: list = field(default_factory=list)  # (3,) of each row
    # {"normal", "displacement", "x", "couple": list of (3,), "cpress", ...: list}, as long as the rows, or missing
    more: dict = field(default_factory=dict)
    sets: dict = field(default_factory=dict)  # {name: labels}

    def forces(self, given, x, length, force):
        """The Forces; x: {label: coordinates}, in the file's unit of length, or None where the rows have them."""
        if not len(self.labels):
            raise Error(f"{self.path}: has no forces at nodes")
        labels, node = np.unique(np.array(self.labels), return_inverse=True)
        times, row = np.unique(np.array(self.times, dtype=float), return_inverse=True)
        place = row * len(labels) + node
        self._need_single(place, labels, times)
        table = _Table(place, len(times), len(labels))
        coordinates = self._coordinates(table, x, labels)
        if "displacement" in self.more:
            moved = table.filled(self.more["displacement"]) + coordinates
            coordinates = moved if np.any(moved != moved[0]) else moved[0]
        found = Forces(self.path, times, labels, coordinates * length, table.filled(self.force) * force, length)
        if "normal" in self.more:
            found.normal = table.filled(self.more["normal"]) * force
        if "couple" in self.more:
            found.couple = table.filled(self.more["couple"]) * force * length
        for name in ("cpress", "cshear1", "cshear2"):
            if name in self.more:
                found.pressure[name] = table.filled(self.more[name]) * force / length**2
        found.sets = {folded(name): np.flatnonzero(np.isin(labels, list(some))) for name, some in self.sets.items()}
        lacking = len(times) * len(labels) - len(place)
        if lacking:
            found.notes.append(
                f"{counted(lacking, 'force')} of {counted(len(labels), 'node')} in {counted(len(times), 'row')} "
                "are not in the file: taken as 0"
            )
        _need_forces(found)
        return found

    def _need_single(self, place, labels, times):
        """Raises Error where a node has two forces at a time."""
        order = np.argsort(place, kind="stable")
        twice = np.flatnonzero(np.diff(place[order]) == 0)
        if twice.size:
            first, second = order[twice[0]], order[twice[0] + 1]
            raise Error(
                f"{self.path}: line {self.lines[second]}: node {self.labels[second]} has two forces at time "
                f"{self.times[second]:g}, the first one in line {self.lines[first]}: give the total time of all steps"
            )

    def _coordinates(self, table, x, labels):
        """Coordinates (m, 3), or (n, m, 3) where they change."""
        if x is not None:
            lacking = [k for k, label in enumerate(self.labels) if label not in x]
            if lacking:
                raise Error(
                    f"{self.path}: line {self.lines[lacking[0]]}: node {self.labels[lacking[0]]} has no coordinates: "
                    "give the deck with it by --deck"
                )
            return np.array([x[label] for label in labels.tolist()], dtype=float)
        every = table.filled(self.more["x"], np.nan)
        known = np.isfinite(every[..., 0])
        first = every[np.argmax(known, axis=0), np.arange(len(labels))]
        every = np.where(known[..., None], every, first)
        return first if np.all(every == first) else every


class _Table:
    """Rows put into their places in arrays over times and nodes."""

    def __init__(self, place, times, nodes):
        self.place, self.shape = place, (times, nodes)

    def filled(self, values, empty=0.0):
        """The array (n, m, ...), with this number where there is no row."""
        values = np.array(values, dtype=float)
        found = np.full((self.shape[0] * self.shape[1], *values.shape[1:]), empty)
        found[self.place] = values
        return found.reshape(*self.shape, *values.shape[1:])


def _need_forces(found):
    """Raises Error where no node has a force."""
    largest = float(np.max(np.abs(found.force)))
    if not largest > 0.0:
        raise Error(f"{found.source}: all forces are 0: no node is in contact, or other output is needed")


def of_deck(given, path):
    """The Points of the deck of --deck."""
    if given.deck is None:
        raise Unusable(f"{path}: has no coordinates of its nodes: give the analysis's deck by --deck")
    return nodes_of(given.deck)


def add_sets(found, deck):
    """Adds node sets and element surfaces of a deck to the sets of Forces."""
    if deck is None:
        return
    names = dict.fromkeys([*deck.node_sets, *deck.surfaces])
    for name in names:
        if name not in found.sets:
            found.sets[name] = np.flatnonzero(np.isin(found.labels, deck.members(name)))

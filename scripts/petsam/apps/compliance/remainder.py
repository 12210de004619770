"""The displacements of the body minus those of the half-space, as both methods (images.py, cutoff.py) give them."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...core.brief import brief
from .halfspace import Fields
from .mesh import Mesh


def scatter(force, nodes, values):
    """Add nodal values (n, k, 3, columns) to forces (3 nodes, columns)."""
    np.add.at(force.reshape(-1, 3, force.shape[1]), nodes, values)


@dataclass
class Side:
    """A body in its half-space: the mesh of its elements, with all nodes of the model, and the half-space's fields."""

    mesh: Mesh
    fields: Fields

    @cached_property
    def member(self):
        """Mask of its nodes."""
        found = np.zeros(len(self.mesh.nodes), dtype=bool)
        found[self.mesh.used()] = True
        return found


def half_space(sides, nodes):
    """The half-spaces' displacements (n, 3, 3 m) at nodes; 0 at those of no side."""
    u = np.zeros((len(nodes), 3, sides[0].fields.columns))
    for side in sides:
        mine = side.member[nodes]
        u[mine] = side.fields.displacement(side.mesh.nodes[nodes[mine]])
    return u


@brief
@dataclass
class Remainder:
    """By tractions phi_j: compliance D (3 m, 3 m), m3/N; the finite elements' displacements w (3 nodes, 3 m), m by N/m;
    forces of the supports (held, 3 m). The displacement is chi u + w with u the half-space's of each side, chi = 1
    without a cut-off. The first side is the body, or body 2 of a pair.
    """

    sides: list
    compliance: np.ndarray
    displacement: np.ndarray
    support: np.ndarray
    cutoff: object = None

    @property
    def mesh(self):
        """Mesh of the first side."""
        return self.sides[0].mesh

    @property
    def fields(self):
        """Fields of the first side."""
        return self.sides[0].fields

    def total(self, nodes):
        """The body's displacements (n, 3, 3 m) at nodes."""
        u = half_space(self.sides, nodes)
        if self.cutoff:
            u *= self.cutoff.values(self.mesh.nodes[nodes])[:, None, None]
        return u + self.displacement.reshape(-1, 3, self.fields.columns)[nodes]

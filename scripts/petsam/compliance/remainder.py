"""The displacements of the body minus those of the half-space, as both methods (images.py, cutoff.py) give them."""

from dataclasses import dataclass

import numpy as np

from .halfspace import Fields
from .mesh import Mesh


def scatter(force, nodes, values):
    """Add nodal values (n, k, 3, columns) to forces (3 nodes, columns)."""
    np.add.at(force.reshape(-1, 3, force.shape[1]), nodes, values)


@dataclass
class Remainder:
    """By tractions phi_j: compliance D (3 m, 3 m), m3/N; the finite elements' displacements w (3 nodes, 3 m), m by N/m;
    forces of the supports (held, 3 m). The body's displacement is chi u + w with u the half-space's, chi = 1 without a
    cut-off.
    """

    mesh: Mesh
    fields: Fields
    compliance: np.ndarray
    displacement: np.ndarray
    support: np.ndarray
    cutoff: object = None

    def total(self, nodes):
        """The body's displacements (n, 3, 3 m) at nodes."""
        x = self.mesh.nodes[nodes]
        u = self.fields.displacement(x)
        if self.cutoff:
            u *= self.cutoff.values(x)[:, None, None]
        return u + self.displacement.reshape(-1, 3, self.fields.columns)[nodes]

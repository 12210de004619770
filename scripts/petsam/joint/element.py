"""A contact as a force element of a time integration or of a static solver: Element.

    element = petsam.Element(contact, ["disp_x"], held=dict(load_n=1000.0))
    force, slope = element.try_(u), element.tangent()  # as often as the solver needs, from the committed state
    element.commit()  # at the end of the step

The force acts on the structure, whose coordinates u it resists: M u'' + K u = f + element.try_(u). force @ du is the
work on the structure, so the unit of a force is J over that of its coordinate.
"""

import numpy as np

from ..core.errors import Error
from .structure import Patch, Structure


class Element:
    """A contact between a structure and the ground, or between two bodies of a structure.

    contact      a Contact in its preload, which the element takes for its own
    coordinates  names of what the structure prescribes: "disp_x", displacements of body 1, or factors on load cases of
                 a body, "body2_case_mode1"
    held         {name: value} of what every step prescribes besides: load_n=1000.0, or displacements of 0

    u            coordinates of the last step, at first those of the preload
    force        their loads on the structure
    """

    def __init__(self, contact, coordinates, held=None):
        patch, count = Patch(contact, coordinates, held), len(coordinates)
        self._set(Structure([patch], np.ones(count), np.eye(count)))
        # modes of unit frequency and shape: the modal force of a step is u
        self._structure.z, self._structure.loads = patch.state()
        self._structure.force = self._structure.z

    def _set(self, structure):
        self._structure, self._response = structure, None

    @property
    def u(self):
        """Coordinates of the last step."""
        return self._structure.force.copy()

    @property
    def force(self):
        """Loads of the last step on the structure."""
        return self._structure.loads.copy()

    def condense(self, stiffness):
        """Puts a spring between the structure and the contact: a substructure behind the contact without inertia.

        stiffness  (n, n) of the coordinates, symmetric, or a number

        From now on u are the coordinates of the structure, and try_() solves for those of the contact. The springs of
        several calls are in series.
        """
        count = len(self._structure.z)
        spring = np.asarray(stiffness, dtype=float) * (np.eye(count) if np.ndim(stiffness) == 0 else 1.0)
        good = spring.shape == (count, count) and np.all(np.isfinite(spring)) and np.allclose(spring, spring.T)
        if not good or np.linalg.eigvalsh(spring)[0] <= 0.0:
            raise Error(f"condense: expected a positive stiffness: a number, or a symmetric ({count}, {count}) matrix")
        old = self._structure
        new = Structure(old.patches, old.omega, old.shapes, old.coupling + np.linalg.inv(spring))
        new.z, new.loads = old.z, old.loads
        new.force = new.z - new.coupling @ new.loads
        self._set(new)

    def try_(self, u):
        """Solves a step from the committed state to these coordinates; returns the force on the structure."""
        u = np.atleast_1d(np.asarray(u, dtype=float))
        if u.shape != self._structure.z.shape or not np.all(np.isfinite(u)):
            raise Error(f"try_: expected {self._structure.z.size} finite coordinates, and not {u.tolist()}")
        if self._response is None:
            self._response = self._structure.respond_to(self._structure.tangent())
        self._response = self._structure.try_step(u, response=self._response)
        return self.force

    def tangent(self, reversal=False):
        """d(force)/d(u) of the tried step, (n, n), negative where the contact resists; with reversal, as Contact's
        stiffness(), that of sticking contacts."""
        inner = self._structure.tangent(reversal)
        return np.column_stack([self._structure.respond(inner, unit)[1] for unit in np.eye(len(inner))])

    def commit(self):
        """Makes the tried step the state from which the next one continues."""
        self._structure.commit()

    def number(self, name):
        """A number of the last step: "dissipated_energy", "contact_area", ..."""
        return self._structure.patches[0].number(name)

    def copy(self):
        """Another element with a copy of the contact in its committed state; u and force are those of this element's
        last step."""
        other = object.__new__(Element)
        other._set(self._structure.copy())
        return other

    def take(self, other):
        """Takes over the committed state of another element of the same contact: a copy of the preload, for example."""
        self._structure.take(other._structure)
        self._response = None

"""A contact as a force element of a time integration or of a static solver: Element.

    element = petsam.Element(contact, ["disp_x"], held=dict(load_n=1000.0))
    force, slope = element.try_(u), element.tangent()  # as often as the solver needs, from the committed state
    element.commit()  # at the end of the step

The force acts on the structure, whose coordinates u it resists: M u'' + K u = f + element.try_(u). force @ du is the
work on the structure, so the unit of a force is J over that of its coordinate.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Optional

import numpy as np
from numpy.typing import ArrayLike

from ...contact.inprocess import Contact
from ...core.errors import Unusable
from .patch import Patch
from .structure import Structure


class Element:
    """A contact between a structure and the ground, or between two bodies of a structure.

    Parameters
    ----------
    contact : Contact
        A contact in its preload, which the element takes for its own.
    coordinates : list of str
        Names of the n values that the structure prescribes: "disp_x", displacements of body 1, or factors on load cases
        of a body, "body2_case_mode1".
    held : mapping, optional
        {name: value} of what every step prescribes besides: load_n=1000.0, or displacements of 0.

    Raises
    ------
    ContactError
        If a coordinate is none of the contact's.
    Error
        If coordinates is one name and not a list.
    """

    def __init__(
        self, contact: Contact, coordinates: Sequence[str], held: Optional[Mapping[str, float]] = None
    ) -> None:
        patch, count = Patch(contact, coordinates, held), len(coordinates)
        self._set(Structure([patch], np.ones(count), np.eye(count)))
        # modes of unit frequency and shape: the modal force of a step is u
        self._structure.z, self._structure.loads = patch.state()
        self._structure.force = self._structure.z

    def _set(self, structure):
        self._structure, self._response = structure, None

    @property
    def u(self) -> np.ndarray:
        """Coordinates of the last step, (n,), m, rad or 1; at first those of the preload."""
        return self._structure.force.copy()

    @property
    def force(self) -> np.ndarray:
        """Loads of the last step on the structure, (n,), N, N m or J."""
        return self._structure.loads.copy()

    def condense(self, stiffness: ArrayLike) -> None:
        """Puts a spring between the structure and the contact: a substructure behind the contact without inertia.

        Parameters
        ----------
        stiffness : array_like
            Stiffness of the coordinates, (n, n), symmetric and positive, or a number: their loads over the coordinates,
            such as N/m.

        Raises
        ------
        Error
            If the stiffness is not positive, or of another shape.

        Notes
        -----
        From now on u are the coordinates of the structure, and try_() solves for those of the contact. The springs of
        several calls are in series.
        """
        count = len(self._structure.z)
        spring = np.asarray(stiffness, dtype=float) * (np.eye(count) if np.ndim(stiffness) == 0 else 1.0)
        good = spring.shape == (count, count) and np.all(np.isfinite(spring)) and np.allclose(spring, spring.T)
        if not good or np.linalg.eigvalsh(spring)[0] <= 0.0:
            raise Unusable(
                f"condense: expected a positive stiffness: a number, or a symmetric ({count}, {count}) matrix"
            )
        old = self._structure
        new = Structure(old.patches, old.omega, old.shapes, old.coupling + np.linalg.inv(spring))
        new.z, new.loads = old.z, old.loads
        new.force = new.z - new.coupling @ new.loads
        self._set(new)

    def try_(self, u: ArrayLike) -> np.ndarray:
        """Solves a step from the committed state to these coordinates.

        Parameters
        ----------
        u : array_like
            Coordinates, (n,), m, rad or 1.

        Returns
        -------
        ndarray
            The force on the structure, (n,), N, N m or J.

        Raises
        ------
        Error
            If the coordinates are not n finite numbers, or no equilibrium of the contact and its springs was found.
        NoEquilibrium, NotConverged
            If the contact has no solution at these coordinates.
        """
        u = np.atleast_1d(np.asarray(u, dtype=float))
        if u.shape != self._structure.z.shape or not np.all(np.isfinite(u)):
            raise Unusable(f"try_: expected {self._structure.z.size} finite coordinates, and not {u.tolist()}")
        if self._response is None:
            self._response = self._structure.respond_to(self._structure.tangent())
        self._response = self._structure.try_step(u, response=self._response)
        return self.force

    def tangent(self, reversal: bool = False) -> np.ndarray:
        """The tangent d(force)/d(u) of the tried step, negative where the contact resists.

        Parameters
        ----------
        reversal : bool
            Whether it is that of sticking contacts: see Contact.stiffness().

        Returns
        -------
        ndarray
            Tangent, (n, n), N/m, N/rad, N m/rad, ...

        Raises
        ------
        ContactError
            If no step has been tried, or the stiffness does not converge.
        """
        inner = self._structure.tangent(reversal)
        return np.column_stack([self._structure.respond(inner, unit)[1] for unit in np.eye(len(inner))])

    def commit(self) -> None:
        """Makes the tried step the state from which the next one continues."""
        self._structure.commit()

    def number(self, name: str) -> float:
        """A number of the last step.

        Parameters
        ----------
        name : str
            Its name in /history: "dissipated_energy", "contact_area", ...

        Returns
        -------
        float
            The number, in SI units.

        Raises
        ------
        ContactError
            If there is no such number.
        """
        return self._structure.patches[0].number(name)

    def copy(self) -> Element:
        """Another element with a copy of the contact in its committed state.

        Returns
        -------
        Element
            Its u and force are those of this element's last step.
        """
        other = object.__new__(Element)
        other._set(self._structure.copy())
        return other

    def take(self, other: Element) -> None:
        """Takes over the committed state of another element of the same contact.

        Parameters
        ----------
        other : Element
            The element, for example a copy of the preload.

        Raises
        ------
        ContactError
            If the state does not fit this element's contact.
        """
        self._structure.take(other._structure)
        self._response = None

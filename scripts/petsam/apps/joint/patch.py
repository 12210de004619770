"""A contact of a structure, whose coordinates a step prescribes: Patch."""

from __future__ import annotations

import contextlib
import warnings
from collections.abc import Collection, Mapping, Sequence
from typing import Optional

import numpy as np
from numpy.typing import ArrayLike

from ...contact.errors import AdviceWarning, ContactError, EdgeContactWarning
from ...contact.inprocess import Contact
from ...core.errors import Unusable, short
from .arguments import need_timeless
from .failures import Apart, NoSolution, solved

SLIDING = ("disp_x", "disp_y", "rot_z")  # displacements whose loads friction limits
# the displacements of body 1 as a step prescribes them, in the order of a contact's stiffness, with their loads
DISPLACEMENTS = {
    "disp_z": "load_n", "disp_x": "load_tx", "disp_y": "load_ty",
    "rot_x": "load_mx", "rot_y": "load_my", "rot_z": "load_mz",
}  # fmt: skip
Held = Mapping[str, float]  # what a patch prescribes besides its coordinates


class Patch:
    """A contact of the structure.

    Parameters
    ----------
    contact : Contact
        Its committed state is the one from which the structure's steps begin.
    coordinates : list of str
        Names of what the structure prescribes: "disp_x", "body2_case_mode1", ...
    held : mapping, optional
        {name: value} of what every step prescribes besides: load_n=1000.0, or displacements of 0.
    by_load : collection of str
        Those coordinates, displacements of body 1, whose load a step prescribes instead: where the structure is softer
        than the contact, this converges better.
    name : str
        Name of the patch in tables.
    center : pair of floats
        x and y (m) of the contact's origin in the structure's frame.

    Raises
    ------
    Error
        If coordinates is one name and not a list, a name of by_load is none of them, or a body of the contact relaxes.
    """

    def __init__(
        self,
        contact: Contact,
        coordinates: Sequence[str],
        held: Optional[Held] = None,
        by_load: Collection[str] = (),
        name: str = "",
        center: ArrayLike = (0.0, 0.0),
    ) -> None:
        if isinstance(coordinates, str):
            raise Unusable(f"coordinates {short(repr(coordinates))}: expected a list of names")
        for one in by_load:
            if one not in coordinates:
                raise Unusable(f"by_load {short(repr(one))}: is none of the coordinates {', '.join(coordinates)}")
        need_timeless(contact)
        self.contact, self.coordinates, self.held, self.name = contact, list(coordinates), dict(held or {}), name
        self.by_load = np.array([name in by_load for name in self.coordinates])
        self.center = np.asarray(center, dtype=float)
        self.cases = [name for name in self.coordinates if name not in DISPLACEMENTS]
        self.given: dict[str, float] = {}  # what the last step prescribed, and the coordinates that it found
        self.outgrown = False
        self.sign = np.array([-1.0 if name in DISPLACEMENTS else 1.0 for name in self.coordinates])
        order = [*DISPLACEMENTS, *self.cases]
        self._rows = [order.index(name) for name in self.coordinates]
        self._loads = [DISPLACEMENTS.get(name, f"{name}_load") for name in self.coordinates]

    def step(self, values: np.ndarray, held: Optional[Held] = None) -> tuple[np.ndarray, np.ndarray]:
        """Tries a step of the contact from its committed state.

        Parameters
        ----------
        values : ndarray
            Of each coordinate its value, m, rad or 1, or where it is by_load the load on the structure, N, N m or J.
        held : mapping, optional
            {name: value} of what this step prescribes besides.

        Returns
        -------
        tuple of two ndarrays
            Coordinates, and loads on the structure, (n,) each.

        Raises
        ------
        NoSolution
            If the structure pulls the bodies apart.
        ContactError
            If the contact has no solution.
        """
        given = {**self.held, **(held or {})}
        for k, value in enumerate(values):
            given[self._loads[k] if self.by_load[k] else self.coordinates[k]] = value * (
                self.sign[k] if self.by_load[k] else 1.0
            )
        if given.get("load_n", 0.0) < 0.0:
            raise Apart(
                f"{self.name or 'a contact'}: the structure pulls the bodies apart with {-given['load_n']:.3g} N: use "
                "a higher preload, a smaller amplitude, or more steps"
            )
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", AdviceWarning)  # of small slip zones: the backbone has its own
            warnings.simplefilter("error", EdgeContactWarning)
            self.outgrown = False
            try:
                self.contact.try_step(**given)
            except EdgeContactWarning:
                self.outgrown = True  # the step is solved; on the way to an equilibrium it does not matter
        z = np.array(values, dtype=float)
        found, loads = self.state()
        self.given = {**dict(zip(self.coordinates, found)), **given}
        z[self.by_load] = found[self.by_load]
        return z, loads

    @property
    def limited(self) -> bool:
        """True if steps prescribe loads that friction limits."""
        return bool(np.any(self.by_load & np.isin(self.coordinates, SLIDING)))

    def need_closed(self) -> None:
        """Checks that the bodies touch where steps prescribe the normal load.

        Raises
        ------
        NoSolution
            If they do not.
        """
        if self.number("load_n") == 0.0 and "disp_z" in np.array(self.coordinates)[self.by_load]:
            raise Apart(
                f"{self.name or 'a contact'}: the bodies do not touch, load_n = 0 N, limit above 0: use a higher "
                "preload, a smaller amplitude, or a finer grid where the gap is less than the height of a cell's centre"
            )

    def need_inside(self) -> None:
        """Checks the border of the contact's grid or patch.

        Raises
        ------
        NoSolution
            If the contact of the last step reaches it.
        """
        if self.outgrown:
            raise NoSolution(
                f"{self.name or 'a contact'}: reaches the border of its grid or patch: use smaller amplitudes, a "
                "higher preload, or a larger grid and patch"
            )

    def state(self) -> tuple[np.ndarray, np.ndarray]:
        """The contact's last step.

        Returns
        -------
        tuple of two ndarrays
            Coordinates (m, rad or 1) and loads on the structure (N, N m or J), (n,) each. A factor that no step has
            given is 0.
        """
        z = np.zeros(len(self.coordinates))
        for k, name in enumerate(self.coordinates):
            with contextlib.suppress(*([ContactError] if name in self.cases else [])):
                z[k] = self.contact.number(name)
        return z, self.sign * np.array([self.contact.number(name) for name in self._loads])

    def stiffness(self, reversal: bool) -> np.ndarray:
        """The derivative of the loads on the structure by the coordinates; displacements whose loads steps give follow.

        Parameters
        ----------
        reversal : bool
            Whether it is that of sticking contacts: see Contact.stiffness().

        Returns
        -------
        ndarray
            Derivative, (n, n), N/m, N/rad, N m/rad, ...

        Raises
        ------
        ContactError
            If the stiffness does not converge, or no step has been tried.
        NoSolution
            If the displacements that follow have no stiffness.
        """
        k = np.array(self.contact.stiffness(reversal, cases=self.cases))
        given = {*self.coordinates, *self.held}
        free = [c for c, name in enumerate(DISPLACEMENTS) if name not in given and (k[c, c] > 0.0 or k[c, c] < 0.0)]
        k -= k[:, free] @ solved(k[np.ix_(free, free)], k[free])
        return self.sign[:, None] * k[np.ix_(self._rows, self._rows)]

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
        return self.contact.number(name)

    def energy_error(self) -> float:
        """The estimated error of the last step's dissipated energy.

        Returns
        -------
        float
            The error, J; NaN if it is unknown, as of a contact without companion runs (-errors companion).
        """
        return self.number("dissipated_energy_error") if self.contact.has_errors else float("nan")

    def copy(self, **options: float) -> Patch:
        """Another patch with a copy of the contact in its committed state.

        Parameters
        ----------
        **options
            Tolerances of the contact, each of which counts if it is smaller than its own.

        Returns
        -------
        Patch
        """
        made = self.contact.options
        options = {name: min(value, float(made.get(name, value))) for name, value in options.items()}
        names = [name for name, load in zip(self.coordinates, self.by_load) if load]
        return Patch(self.contact.copy(**options), self.coordinates, self.held, names, self.name, self.center)

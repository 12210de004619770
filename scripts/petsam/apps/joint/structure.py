"""Patches of contact in a linear structure: Patch, Structure.

The structure is given by modes without contact, of unit modal mass, and by what joins the patches statically. A patch
has coordinates z, values that a step of its contact prescribes: displacements of its body 1, or factors on load cases
of a body. The loads F that belong to them act on the structure. With a modal force f (of M phi_k for each mode k)

    z = Phi W^-2 f + X F(z) + R a      R'F + f_r = 0      eta_k = (f_k + Phi_k'F)/w_k^2      eta_r = a_r

Phi are the elastic modes in the coordinates, and W their angular frequencies. R are the modes without stiffness, with
their amplitudes a. X is the part of the static compliance between coordinates that the contacts' own lacks. The modes
that are not kept have stiffness, but no inertia.

If there is one patch, whose file has all its compliance, X is zero, and z needs no iteration. The loads on a body that
only its contact holds are known. Otherwise Broyden's method begins with dF/dz of the step before, or of sticking
contacts at a reversal, and takes the contacts' own stiffness where it is slow.
"""

from __future__ import annotations

import contextlib
import warnings
from collections.abc import Collection, Iterable, Mapping, Sequence
from typing import Optional

import numpy as np
from numpy.typing import ArrayLike

from ...contact.inprocess import (
    AdviceWarning,
    Contact,
    ContactError,
    EdgeContactWarning,
    NoEquilibrium,
    NotConverged,
    PrescribedError,
)
from ...core import broyden
from ...core.errors import Unusable, short
from .arguments import array, real

TOLERANCE = 1e-7  # of the work and of the energy of the errors, relative to the work of the loads
ROUGH = 1e-5  # the same where the contact's own tolerance ends the iteration
SLOW = 0.3  # ratio of successive errors above which the contacts' stiffness is computed
STIFF = 1e-3  # part of the stiffness of sticking contacts that those which slide seem to have
MOST, FEWER, DESCENTS = 25, 12, 60  # iterations; of those that others may follow
SLIDING = ("disp_x", "disp_y", "rot_z")  # displacements whose loads friction limits
# the displacements of body 1 as a step prescribes them, in the order of a contact's stiffness, with their loads
DISPLACEMENTS = {
    "disp_z": "load_n", "disp_x": "load_tx", "disp_y": "load_ty",
    "rot_x": "load_mx", "rot_y": "load_my", "rot_z": "load_mz",
}  # fmt: skip


class NoSolution(Unusable):
    """Equilibrium of patches and structure was not found, or the contact leaves its patch."""


class Apart(NoSolution):
    """The structure pulls the bodies apart."""


BEYOND = (NoEquilibrium, NotConverged, PrescribedError, Apart)  # of a guess that contacts do not bear
ENDS = (NoSolution, *BEYOND)  # of a step

Held = Mapping[str, float]  # what a patch prescribes besides its coordinates
Scale = tuple[np.ndarray, np.ndarray, np.ndarray]  # changes of z, loads and a


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
        If coordinates is one name and not a list, or a name of by_load is none of them.
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
        k -= k[:, free] @ _solved(k[np.ix_(free, free)], k[free])
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


class Structure:
    """Patches and the structure that joins them.

    Parameters
    ----------
    patches : iterable of Patch
        All their coordinates, one patch after the other, are the n coordinates below.
    omega : array_like
        Angular frequencies (rad/s) of the elastic modes without contact.
    shapes : array_like, optional
        The coordinates by a unit of each elastic mode, (n, elastic modes); for coordinates that are the modes
        themselves np.eye(n). None: zeros.
    coupling : array_like, optional
        X, the static compliance between coordinates that no contact has of itself, (n, n); None: none.
    rigid : array_like, optional
        The coordinates by a unit of each mode without stiffness, (n, r); None: the structure is supported.
    damping : float
        Damping of the material as a part of critical, of all modes while all that touches sticks.

    Attributes
    ----------
    z, loads : ndarray
        Coordinates (m, rad or 1) and loads on the structure (N, N m or J) of the last step, (n,).
    a : ndarray
        Amplitudes of the modes without stiffness, (r,), m kg^0.5.
    force : ndarray
        Modal force of the last step, (modes,), m/s2 kg^0.5.

    Raises
    ------
    Error
        For matrices of other shapes, frequencies that are not above 0, and damping outside 0 to 1.
    """

    def __init__(
        self,
        patches: Iterable[Patch],
        omega: ArrayLike = (),
        shapes: Optional[ArrayLike] = None,
        coupling: Optional[ArrayLike] = None,
        rigid: Optional[ArrayLike] = None,
        damping: float = 0.0,
    ) -> None:
        damping = real(
            "damping", damping, "a part of critical damping, from 0 to below 1", lambda part: 0.0 <= part < 1.0
        )
        self.patches, self.damping = list(patches), damping
        n = sum(len(patch.coordinates) for patch in self.patches)
        self.omega = array("omega", omega)
        self.shapes = self._matrix(shapes, (n, self.omega.size), "shapes")
        self.rigid = self._matrix(rigid, (n, None), "rigid")
        self.coupling = self._matrix(coupling, (n, n), "coupling")
        if not np.all((self.omega > 0.0) & np.isfinite(self.omega)):
            raise Unusable("omega: expected frequencies above 0; modes of 0 are given by rigid")
        self.direct = not self.rigid.size and not np.any(self.coupling)
        floats = n == self.rigid.shape[1] and np.all(self.by_load)
        self.given = floats and abs(np.linalg.det(self.rigid)) > 0.0  # the loads are known
        self.z, self.a, self.loads = np.zeros(n), np.zeros(self.rigid.shape[1]), np.zeros(n)
        self.force = np.zeros(self.modes)  # of the last step
        self.iterations: list[int] = []
        self.opens = False  # True: patches may be open, such as while bolts are tightened

    @staticmethod
    def _matrix(values, shape, name):
        rows, columns = shape
        found = np.zeros((rows, columns or 0)) if values is None else array(name, values)
        if found.ndim != 2 or found.shape[0] != rows or columns not in (None, found.shape[1]):
            raise Unusable(f"{name}: has the shape {found.shape}: expected ({rows}, {columns or 'modes'})")
        return found

    @property
    def modes(self) -> int:
        """Number of modes: elastic ones, then those without stiffness."""
        return self.omega.size + self.rigid.shape[1]

    @property
    def per_metre(self) -> bool:
        """True if a patch is of sections in plane strain: loads, energies and masses are per metre."""
        return any(len(patch.contact.y) == 1 for patch in self.patches)

    @property
    def by_load(self) -> np.ndarray:
        """(n,) mask of the coordinates whose loads steps prescribe."""
        return np.concatenate([patch.by_load for patch in self.patches])

    @property
    def names(self) -> list[str]:
        """Names of the patches."""
        return [patch.name or f"patch{k}" for k, patch in enumerate(self.patches, 1)]

    def copy(self, **options: float) -> Structure:
        """The structure with copies of its contacts in their committed states.

        Parameters
        ----------
        **options
            Tolerances of all contacts, each of which counts where it is smaller than a contact's own.

        Returns
        -------
        Structure
        """
        patches = [patch.copy(**options) for patch in self.patches]
        other = Structure(patches, self.omega, self.shapes, self.coupling, self.rigid, self.damping)
        other.z, other.a, other.loads, other.force = self.z, self.a, self.loads, self.force
        return other

    def take(self, other: Structure) -> None:
        """Takes over the state of another structure of the same patches.

        Parameters
        ----------
        other : Structure
            The structure, for example a copy of the preload.

        Raises
        ------
        ContactError
            If the state does not fit a contact.
        """
        for mine, its in zip(self.patches, other.patches):
            mine.contact.take(its.contact)
        self.z, self.a, self.loads, self.force = other.z, other.a, other.loads, other.force

    # ------------------------------------------------------------ linear

    def _split(self, values):
        ends = np.cumsum([len(patch.coordinates) for patch in self.patches])[:-1]
        return np.split(values, ends)

    def tangent(self, reversal: bool = True) -> np.ndarray:
        """The derivative of the loads of all patches by their coordinates.

        Parameters
        ----------
        reversal : bool
            Whether it is that of sticking contacts: see Contact.stiffness().

        Returns
        -------
        ndarray
            Derivative, (n, n), N/m, N/rad, N m/rad, ...; 0 between patches.

        Raises
        ------
        ContactError
            If a stiffness does not converge.
        """
        blocks = [patch.stiffness(reversal) for patch in self.patches]
        found, at = np.zeros((self.z.size, self.z.size)), 0
        for block in blocks:
            found[at : at + len(block), at : at + len(block)] = block
            at += len(block)
        return found

    def _slope(self, stiff):
        """The tangent for continued loading, and this part of that of sticking contacts."""
        slope = self.tangent(False)
        return slope + stiff * self.tangent() if stiff else slope

    def response_of(self, tangent: np.ndarray) -> np.ndarray:
        """The derivative of what steps find by what they prescribe: loads by coordinates, and the reverse where patches
        are by_load.

        Parameters
        ----------
        tangent : ndarray
            Of tangent(), (n, n).

        Returns
        -------
        ndarray
            Derivative, (n, n).

        Raises
        ------
        NoSolution
            If a contact that is given loads does not resist them.
        """
        load, rest = np.flatnonzero(self.by_load), np.flatnonzero(~self.by_load)
        found = np.zeros_like(tangent)
        inverse = _solved(
            tangent[np.ix_(load, load)],
            np.eye(len(load)),
            "a contact that is given loads does not resist them: give it friction and preload",
        )
        found[np.ix_(load, load)] = inverse
        found[np.ix_(load, rest)] = -inverse @ tangent[np.ix_(load, rest)]
        found[np.ix_(rest, load)] = tangent[np.ix_(rest, load)] @ inverse
        found[np.ix_(rest, rest)] = (
            tangent[np.ix_(rest, rest)] + tangent[np.ix_(rest, load)] @ found[np.ix_(load, rest)]
        )
        return found

    def _system(self, response):
        """Matrix of the changes of what steps prescribe, and of a, in the errors of z and of equilibrium."""
        unit = np.eye(self.z.size)
        return self._equations(
            np.where(self.by_load[:, None], response, unit), np.where(self.by_load[:, None], unit, response)
        )

    def _equations(self, z, loads):
        """Matrix of the equations in what z and loads depend on, and in a."""
        r = self.rigid.shape[1]
        return np.block([[z - self.coupling @ loads, -self.rigid], [self.rigid.T @ loads, np.zeros((r, r))]])

    def _driven(self, force):
        """Coordinates by a modal force (modes) alone, and the force on modes without stiffness."""
        elastic, free = np.split(np.asarray(force, dtype=float), [self.omega.size])
        return self.shapes @ (elastic / self.omega**2), free

    def respond(self, tangent: np.ndarray, force: ArrayLike) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Changes by a change of the modal force, where loads follow the tangent.

        Parameters
        ----------
        tangent : ndarray
            Of tangent(), (n, n).
        force : array_like
            Modal force, (modes,), m/s2 kg^0.5.

        Returns
        -------
        tuple of three ndarrays
            Changes of z and of the loads, (n,), and of a, (r,).

        Raises
        ------
        NoSolution
            If structure and contacts leave a motion without stiffness.
        """
        z, free = self._driven(force)
        n = z.size
        both = _solved(self._equations(np.eye(n), tangent), np.concatenate([z, -free]))
        return both[:n], tangent @ both[:n], both[n:]

    def modal(self, force: ArrayLike, loads: np.ndarray, a: np.ndarray) -> np.ndarray:
        """Modal coordinates by a modal force and the loads of the patches.

        Parameters
        ----------
        force : array_like
            Modal force, (modes,), m/s2 kg^0.5.
        loads : ndarray
            Loads on the structure, (n,), N, N m or J.
        a : ndarray
            Amplitudes of the modes without stiffness, (r,), m kg^0.5.

        Returns
        -------
        ndarray
            Modal coordinates, (modes,), m kg^0.5.
        """
        elastic = (np.asarray(force)[: self.omega.size] + self.shapes.T @ loads) / self.omega**2
        return np.concatenate([elastic, a])

    def flexibility(self, tangent: np.ndarray) -> np.ndarray:
        """Modal coordinates by a unit of each modal force, where loads follow the tangent.

        Parameters
        ----------
        tangent : ndarray
            Of tangent(), (n, n).

        Returns
        -------
        ndarray
            Flexibility, (modes, modes), s2.

        Raises
        ------
        NoSolution
            If structure and contacts leave a motion without stiffness.
        """
        columns = []
        for unit in np.eye(self.modes):
            _, loads, a = self.respond(tangent, unit)
            columns.append(self.modal(unit, loads, a))
        found = np.array(columns).T
        return 0.5 * (found + found.T)

    def stuck_modes(self, tangent: Optional[np.ndarray] = None, without: int = 0) -> tuple[np.ndarray, np.ndarray]:
        """The modes while all that touches sticks.

        Parameters
        ----------
        tangent : ndarray, optional
            That of tangent(), (n, n), if it is known.
        without : int
            The inertia of so many of the highest elastic modes is left out.

        Returns
        -------
        tuple of two ndarrays
            Angular frequencies (rad/s), rising, (kept,), and shapes, as columns in modal coordinates, (kept, kept);
            kept are all modes but those that are left out.

        Raises
        ------
        NoSolution
            If a mode has no positive stiffness.
        """
        tangent = self.tangent() if tangent is None else tangent
        kept = np.r_[: self.omega.size - without, self.omega.size : self.modes]
        values, vectors = np.linalg.eigh(self.flexibility(tangent)[np.ix_(kept, kept)])
        if values[0] <= 0.0:
            raise NoSolution("the structure with sticking contacts has a mode of negative stiffness")
        order = np.argsort(-values)
        shapes = vectors[:, order]
        return 1.0 / np.sqrt(values[order]), shapes * np.sign(
            shapes[np.argmax(np.abs(shapes), axis=0), range(len(order))]
        )

    # ------------------------------------------------------------ steps

    def _try(self, values, held):
        """Coordinates and loads of a tried step of all patches."""
        every = held or [None] * len(self.patches)
        found = [p.step(part, one) for p, part, one in zip(self.patches, self._split(values), every)]
        return [np.concatenate(parts) for parts in zip(*found)]

    def step(
        self,
        force: ArrayLike,
        held: Optional[Sequence[Optional[Held]]] = None,
        response: Optional[np.ndarray] = None,
        scale: Optional[Scale] = None,
    ) -> Optional[np.ndarray]:
        """Solves a step and commits it: try_step(), and commit().

        Parameters
        ----------
        force, held, response, scale
            As of try_step().

        Returns
        -------
        ndarray or None
            The response with which the next step may begin, (n, n).

        Raises
        ------
        NoSolution, ContactError
            As try_step() does.
        """
        response = self.try_step(force, held, response, scale)
        self.commit()
        return response

    def commit(self) -> None:
        """Makes the tried step of all patches the state from which the next one continues."""
        for patch in self.patches:
            patch.contact.commit()

    def try_step(
        self,
        force: ArrayLike,
        held: Optional[Sequence[Optional[Held]]] = None,
        response: Optional[np.ndarray] = None,
        scale: Optional[Scale] = None,
    ) -> Optional[np.ndarray]:
        """Solves a step under a modal force from the committed state; sets force, z, a and loads.

        Parameters
        ----------
        force : array_like
            Modal force, (modes,), m/s2 kg^0.5.
        held : sequence of mappings, optional
            For each patch {name: value} that it prescribes besides; None: what patches have.
        response : ndarray, optional
            Of respond_to(), (n, n), with which the iteration begins; None: that of the patches' last steps.
        scale : tuple of three ndarrays, optional
            Changes of z, loads and a to which the tolerance is relative; None: what the step has.

        Returns
        -------
        ndarray or None
            The response with which the next step may begin, (n, n).

        Raises
        ------
        NoSolution
            If patches and structure find no equilibrium, or a contact opens or reaches the border of its grid or patch.
        ContactError
            If a contact has no solution.
        """
        driven, free = self._driven(force)
        if self.direct:
            self.z, self.loads = self._try(driven, held)
            self.iterations.append(1)
        elif self.given:
            self.z, self.loads = self._try(_solved(self.rigid.T, -free), held)
            self.a = _solved(self.rigid, self.z - driven - self.coupling @ self.loads)
            self.iterations.append(1)
        else:
            response = self._find(driven, free, held, response, scale)
        for patch in self.patches:
            patch.need_inside()
            if not (self.opens or self.direct):
                patch.need_closed()
        self.force = np.array(force, dtype=float)
        return response

    def respond_to(self, tangent: np.ndarray) -> Optional[np.ndarray]:
        """The response with which step() may begin.

        Parameters
        ----------
        tangent : ndarray
            Of tangent(), (n, n).

        Returns
        -------
        ndarray or None
            Response, (n, n); None where steps need no iteration.

        Raises
        ------
        NoSolution
            If a contact that is given loads does not resist them.
        """
        return None if self.direct or self.given else self.response_of(tangent)

    def _find(self, driven, free, held, response, scale):
        """Solves a step; returns its last response, None where contacts slide and another one must be computed.

        A contact that slides does not bear more loads: where steps by loads find no equilibrium soon, displacements
        along the surface are prescribed instead. Where those find none either, steps by loads go on.
        """
        limited = any(patch.limited for patch in self.patches)
        if not limited:
            return self._either(driven, free, held, response, scale)
        try:
            return self._iterate(driven, free, held, response, scale, FEWER)
        except ENDS as error:
            first = error
        if self._slides(driven, free, held, scale):
            return None
        if self._by_displacements([*DISPLACEMENTS], self._descend, driven, free, held, scale):
            return None
        try:
            return self._iterate(driven, free, held, response, scale)
        except ENDS:
            raise first from None  # most often names what the contact does not bear

    def _slides(self, *step):
        """True if the step is solved by displacements along the surface."""
        return self._by_displacements(SLIDING, lambda *one: self._either(*one[:-1], None, one[-1]), *step)

    def _by_displacements(self, names, solve, *step):
        """True if solve(*step) solves the step where it prescribes these displacements, and not their loads."""
        masks = [patch.by_load for patch in self.patches]
        state = self.z, self.a, self.loads
        for patch in self.patches:
            patch.by_load = patch.by_load & ~np.isin(patch.coordinates, names)
        try:
            solve(*step)
            inside = not any(patch.outgrown for patch in self.patches)
        except ENDS:
            inside = False
        finally:
            for patch, mask in zip(self.patches, masks):
                patch.by_load = mask
        if not inside:
            self.z, self.a, self.loads = state
        return inside

    def _descend(self, driven, free, held, scale):
        """Newton's method for displacements, with the contacts' own stiffness at each of them.

        Contacts find loads to all displacements, also where they are of a few cells, which bear hardly any moment and
        whose stiffness grows as they do. Each change is halved until the error falls by a part of it, which it does
        for short ones.
        """
        at, change = np.concatenate([self.z, self.a]), np.zeros(self.z.size + self.a.size)
        response, part, last = None, 1.0, np.inf
        self.iterations.append(0)
        for self.iterations[-1] in range(1, DESCENTS + 1):
            given, a = np.split(at + part * change, [driven.size])
            with contextlib.suppress(BEYOND):
                z, loads = self._try(given, held)
                error = self._error(z, a, loads, driven, free)
                if response is None or self._worth(error, response) <= (1.0 - 0.1 * part) * last:
                    at, part = at + part * change, 1.0
                    response = self.tangent(False)
                    size = self._size(error, response, (z, loads, a), scale)
                    if size <= TOLERANCE:
                        self.z, self.a, self.loads = z, a, loads
                        return
                    change, last = _solved(self._system(response), -error), self._worth(error, response)
                    continue
            part *= 0.5
        raise NoSolution("no equilibrium by displacements")

    def _either(self, driven, free, held, response, scale):
        """_iterate(), and once more with a little stiffness, where contacts slide that leave the structure a motion
        without any."""
        try:
            return self._iterate(driven, free, held, response, scale)
        except ENDS as error:
            first = error
        try:
            return self._iterate(driven, free, held, None, scale, stiff=STIFF)
        except ENDS:
            raise first from None

    def _iterate(self, driven, free, held, response, scale, most=MOST, stiff=0.0):
        """Broyden's method for what steps prescribe, and for a; returns its last response. stiff: see _slope()."""
        z, loads, size = self.z, self.loads, np.inf
        base = np.concatenate([np.where(self.by_load, loads, z), self.a])
        change, moved = np.zeros(base.size), None
        if response is not None:
            change = _solved(self._system(response), -self._error(z, self.a, loads, driven, free))
        self.iterations.append(0)
        while True:
            self.iterations[-1] += 1
            given, a = np.split(base + change, [z.size])
            before, last = np.where(self.by_load, z, loads), size
            try:
                z, loads = self._try(given, held)
            except BEYOND:
                if self.iterations[-1] == most or not np.any(change):
                    raise
                change = 0.5 * change  # the guess is beyond what the contacts bear
                continue
            error = self._error(z, a, loads, driven, free)
            if response is None:
                response = self.response_of(self._slope(stiff))
            size = self._size(error, response, (z, loads, a), scale)
            if size <= TOLERANCE or (SLOW * last <= size <= ROUGH):
                break
            if self.iterations[-1] == most:
                raise NoSolution(
                    f"patches and structure found no equilibrium in {most} iterations, error {size:.2g}, limit "
                    f"{TOLERANCE:g}: use more steps, or smaller loads if the contacts slide as a whole"
                )
            if size > SLOW * last:
                response = self.response_of(self._slope(stiff))
            elif moved is not None:
                response = self._updated(response, change[: z.size], np.where(self.by_load, z, loads) - before)
            base, moved = base + change, True
            change = _solved(self._system(response), -error)
        self.z, self.a, self.loads = z, a, loads
        return response

    def _updated(self, response, moved, changed):
        """Broyden's response, patch by patch, by a change of what steps find."""
        response, at = response.copy(), 0
        for part, change in zip(self._split(moved), self._split(changed)):
            own = slice(at, at + part.size)
            at += part.size
            response[own, own] = broyden.updated(response[own, own], part, change)
        return response

    def _size(self, error, response, state, scale):
        """Norm of the errors: by their work, relative to that of the changes, and by the energy that they are worth,
        which sees errors of coordinates that have no load. That is relative to the work of the loads, or of the changes
        where these are larger, as in a step through zero."""
        whole = max(np.abs(z) @ np.abs(loads) for z, loads, _ in (state, scale or state))
        return max(_work(error, scale or state), np.sqrt(_part(self._worth(error, response) ** 2, whole)))

    def _worth(self, error, response):
        """Square root of twice the energy that errors are worth by the stiffness of contacts and structure."""
        with np.errstate(divide="ignore"):
            own = np.abs(np.diag(response))
            soft = np.where(self.by_load, own, 1.0 / own)  # compliance of each coordinate of the contacts
            stiff = 1.0 / (soft + np.abs(np.diag(self.coupling)))
        moved, forces = np.split(error, [len(stiff)])
        held = stiff @ self.rigid**2
        energy = stiff @ moved**2 + np.sum(np.where(forces == 0.0, 0.0, forces**2 / np.where(held > 0.0, held, 1e-300)))
        return np.sqrt(energy)

    def _error(self, z, a, loads, driven, free):
        moved = z - driven - self.coupling @ loads - self.rigid @ a
        return np.concatenate([moved, self.rigid.T @ loads + free])


def _work(error, scale):
    """The work of the errors of coordinates and of equilibrium, relative to that of the loads."""
    z, loads, a = (np.abs(one) for one in scale)
    whole = z @ loads
    return _part(np.abs(error) @ np.concatenate([loads, a]) if whole else np.abs(error).max(initial=0.0), whole)


def _part(value, whole):
    """A number relative to another one; of 0 all but 0 is infinite."""
    return float(value / whole) if whole else np.inf if value else 0.0


def _solved(matrix, right, fails="structure and sticking contacts leave a motion without stiffness: support it"):
    try:
        return np.linalg.solve(matrix, right)
    except np.linalg.LinAlgError:
        raise NoSolution(fails) from None

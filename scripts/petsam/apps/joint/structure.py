"""Steps of patches of contact in a linear structure: Structure.

If there is one patch, whose file has all its compliance, X is zero, and z needs no iteration. The loads on a body that
only its contact holds are known. Otherwise Broyden's method begins with dF/dz of the step before, or of sticking
contacts at a reversal, and takes the contacts' own stiffness where it is slow.
"""

from __future__ import annotations

import contextlib
from collections.abc import Sequence
from typing import Optional

import numpy as np
from numpy.typing import ArrayLike

from ...core import broyden
from .assembly import Assembly
from .failures import BEYOND, ENDS, NoSolution, solved
from .patch import DISPLACEMENTS, SLIDING, Held

TOLERANCE = 1e-7  # of the work and of the energy of the errors, relative to the work of the loads
ROUGH = 1e-5  # the same where the contact's own tolerance ends the iteration
SLOW = 0.3  # ratio of successive errors above which the contacts' stiffness is computed
STIFF = 1e-3  # part of the stiffness of sticking contacts that those which slide seem to have
MOST, FEWER, DESCENTS = 25, 12, 60  # iterations; of those that others may follow
Scale = tuple[np.ndarray, np.ndarray, np.ndarray]  # changes of z, loads and a


class Structure(Assembly):
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

    def _slope(self, stiff):
        """The tangent for continued loading, and this part of that of sticking contacts."""
        slope = self.tangent(False)
        return slope + stiff * self.tangent() if stiff else slope

    def _system(self, response):
        """Matrix of the changes of what steps prescribe, and of a, in the errors of z and of equilibrium."""
        unit = np.eye(self.z.size)
        return self._equations(
            np.where(self.by_load[:, None], response, unit), np.where(self.by_load[:, None], unit, response)
        )

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
            self.z, self.loads = self._try(solved(self.rigid.T, -free), held)
            self.a = solved(self.rigid, self.z - driven - self.coupling @ self.loads)
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
                    change, last = solved(self._system(response), -error), self._worth(error, response)
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
            change = solved(self._system(response), -self._error(z, self.a, loads, driven, free))
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
            change = solved(self._system(response), -error)
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

"""Patches of contact in a linear structure, and what follows from it without a step: tangent, flexibility, modes.

The structure is given by modes without contact, of unit modal mass, and by what joins the patches statically. A patch
has coordinates z, values that a step of its contact prescribes: displacements of its body 1, or factors on load cases
of a body. The loads F that belong to them act on the structure. With a modal force f (of M phi_k for each mode k)

    z = Phi W^-2 f + X F(z) + R a      R'F + f_r = 0      eta_k = (f_k + Phi_k'F)/w_k^2      eta_r = a_r

Phi are the elastic modes in the coordinates, and W their angular frequencies. R are the modes without stiffness, with
their amplitudes a. X is the part of the static compliance between coordinates that the contacts' own lacks. The modes
that are not kept have stiffness, but no inertia.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Optional

import numpy as np
from numpy.typing import ArrayLike

from ...core.errors import Unusable
from .arguments import array, real
from .failures import NoSolution, solved
from .patch import Patch


class Assembly:
    """Patches and the structure that joins them, without its steps: see Structure."""

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
        inverse = solved(
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
        both = solved(self._equations(np.eye(n), tangent), np.concatenate([z, -free]))
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

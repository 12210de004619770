"""A contact as a non-linear force of tmdsimpy (https://github.com/tmd-lab/tmdsimpy): Force.

from adapters.tmdsimpy import Force
system = tmdsimpy.VibrationSystem(M, K, ab=[0, 0])
system.add_nl_force(Force(element, Q))
"""

import numpy as np

import petsam

from .cycles import Cycles

HYSTERETIC = 1  # kind of force in tmdsimpy


class Force:
    """The force of an Element in its preload.

    element  a petsam.Element; its coordinates are Q times the degrees of freedom, counted from the preload
    Q        (n, N): coordinates of the element by the N degrees of freedom of the system
    T        (N, n): forces on the degrees of freedom by those of the coordinates; None: the transpose of Q

    As for all forces of tmdsimpy the result stands on the left side, with that of the springs: it is what the contact
    resists with, less its value in the preload. cycles.steps counts the contact's steps.
    """

    def __init__(self, element, Q, T=None):
        self.Q = np.atleast_2d(np.asarray(Q, dtype=float))
        self.T = self.Q.T if T is None else np.asarray(T, dtype=float)
        count = element.u.size
        if self.Q.shape[0] != count or self.T.shape != self.Q.T.shape:
            raise petsam.Error(f"Q: has the shape {self.Q.shape}: expected ({count}, N), and T its transpose's")
        self._element, self.cycles = element, Cycles(element)

    def nl_force_type(self):
        """The force depends on the history."""
        return HYSTERETIC

    def init_history(self):
        """Nothing is kept between calls: each begins from the preload."""

    def set_aft_initialize(self, U):
        """Cycles begin from the preload of the contact, whatever U is."""

    def force(self, U, update_hist=False):
        """Force (N,) at displacements from the preload in one step, and its derivative (N, N)."""
        if update_hist:
            raise petsam.Error(
                "update_hist: the preload of a contact is given by its own steps, before the Element is made"
            )
        moved = self._element.copy()
        force = moved.try_(moved.u + self.Q @ np.asarray(U)) - self._element.force
        return -self.T @ force, -self.T @ moved.tangent() @ self.Q

    def aft(self, U, w, h, Nt=128, tol=1e-7, calc_grad=True):
        """Coefficients of the force by those of the displacements, both (N waves,): harmonic after harmonic, and their
        derivatives by U and by w, which is zero. tol is not used: cycles are repeated until their energy settles."""
        size = self.Q.shape[1]
        given = np.reshape(U, (-1, size)) @ self.Q.T
        force, slope = self.cycles.harmonics(given, h, Nt, calc_grad)
        found = -(force @ self.T.T).ravel()
        if not calc_grad:
            return (found,)
        slope = -np.einsum("ai,winj,jb->wanb", self.T, slope, self.Q)
        return found, slope.reshape(found.size, found.size), np.zeros(found.size)

"""A contact as an element of pyHarm (pyharm-os, https://gitlab.com/drti/pyharm): Contact.

from adapters import pyharm
connector = {"type": "petsam", "connect": "beam", "element": element, "Q": Q}
pyHarm.Maestro({"plugin": [pyharm.Contact], "connectors": {"joint": connector}, ...})
"""

import numpy as np
from pyHarm.Elements.ABCElement import ABCElement

import petsam

from .cycles import Cycles


class Contact(ABCElement):
    """The force of an Element in its preload, "petsam" among the types of connectors.

    connect  name of the substructure
    element  a petsam.Element; its coordinates are Q times the degrees of freedom, counted from the preload
    Q        (n, N): coordinates of the element by the N degrees of freedom of the substructure, as in its matrices

    The residual is what the contact resists with, less its value in the preload.
    """

    factory_keyword = "petsam"

    def __init_data__(self, name, data, CS):
        self.name, self.sub, self.indices = name, data["connect"], []
        self.Q = np.atleast_2d(np.asarray(data["Q"], dtype=float))
        self.cycles, self.length = Cycles(data["element"]), 1.0
        if len(self.Q) != self.cycles.u.size:
            raise petsam.Error(f"connector {name}: Q has the shape {self.Q.shape}: expected ({self.cycles.u.size}, N)")

    def __flag_update__(self, *_):
        self.flag_nonlinear = self.flag_AFT = True

    def __str__(self):
        return f"contact {self.name} of petsam, at the substructure {self.sub}"

    def generateIndices(self, expl_dofs):
        """Finds the degrees of freedom of the substructure: harmonic after harmonic."""
        self.indices = np.flatnonzero(expl_dofs["sub"] == self.sub)
        waves = len(expl_dofs[["harm", "cs"]].drop_duplicates())
        if self.indices.size != waves * self.Q.shape[1]:
            count = self.indices.size // waves
            raise petsam.Error(
                f"connector {self.name}: Q has {self.Q.shape[1]} columns, and {self.sub} {count} of these"
            )

    def adim(self, lc, wc):
        """Displacements are relative to the length lc."""
        self.length, self.flag_adim = lc, True

    def _harmonics(self, x, tangent):
        order = np.arange(self.nh + 1) if isinstance(self.nh, int) else np.asarray(self.nh)
        given = self.length * np.reshape(x[self.indices], (-1, self.Q.shape[1])) @ self.Q.T
        return self.cycles.harmonics(given, order, self.nti, tangent)

    def evalResidual(self, x, om, **_):
        """Coefficients of the force of the contact on the left side."""
        self.R = -(self._harmonics(x, False)[0] @ self.Q).ravel()
        return self.R

    def evalJacobian(self, x, om, **_):
        """Derivative of the residual by x and, zero, by om."""
        slope = self._harmonics(x, True)[1]
        self.J = -self.length * np.einsum("ia,winj,jb->wanb", self.Q, slope, self.Q).reshape(2 * (self.indices.size,))
        self.dJdom = np.zeros((self.indices.size, 1))
        return self.J, self.dJdom

"""Conductors with layers on them: what a wave of the flux needs, and the same as images below a half-space's surface.

On a body of conductivity lam with a layer of lam_f and thickness t, perfectly bonded, a wave k of the flux q has the
potential V = q F(k)/k at the surface, with

    F = (1/lam_f) (F' + T/lam_f)/(1/lam_f + F' T),    T = tanh(k t),    F' = 1/lam,

F' being that of what lies below, so that further layers follow one by one. F is 1/lam for long waves and 1/lam_f for
short ones. For half-spaces F is written as a sum of exponentials, exp(-k d)/k being the potential of a source at the
distance R and the depth d: 1/(2 pi sqrt(R^2 + d^2)). Of one layer the depths are 2 t, 4 t, ... with weights that fall
as powers, slowly where conductivities differ much; depths in a geometric row with fitted weights give the same function
to 1e-7 by some dozens.

Source: H. S. Carslaw, J. C. Jaeger, Conduction of Heat in Solids (1959), chapter 8 (images of a layer).
"""

from collections.abc import Sequence
from typing import NamedTuple, Union

import numpy as np

from ...core import materials
from ...core.errors import Error, short

RATE = 3  # depths of images per octave: two give 2e-6 of F
BELOW = 20.0  # depth of the deepest image over the depth at which the bodies differ no longer
SHORTEST = 40.0  # exp(-SHORTEST) of a wave's amplitude passes the first layer and returns
WAVES = 10  # per image, to which weights are fitted
CUT = 1e-13  # relative singular values below which the fit is cut


class Body(NamedTuple):
    """A conductor with layers.

    Attributes
    ----------
    lam : float or str
        Conductivity, W/(m K), or S/m; or a material's name (petsam.materials), as in the layers.
    layers : sequence of (thickness, conductivity)
        Layers on it, m and W/(m K), or S/m, from the surface inwards.
    """

    lam: Union[float, str]
    layers: Sequence[tuple[float, Union[float, str]]] = ()

    def checked(self) -> "Body":
        """The body with numbers as floats.

        Returns
        -------
        Body

        Raises
        ------
        Error
            If a number is not finite and above 0, or the conductivity of a material is not known.
        """
        return Body(*self._numbers())

    def _numbers(self) -> tuple[float, tuple[tuple[float, float], ...]]:
        """The conductivity and the layers; raises Error as checked() does."""
        try:
            layers = tuple((float(thickness), materials.conductivity(lam)) for thickness, lam in self.layers)
        except (TypeError, ValueError):
            raise Error(
                f"conduction: layers {self.layers!r}: expected pairs (thickness, conductivity) from the surface inwards"
            ) from None
        try:
            own = materials.conductivity(self.lam)
        except (TypeError, ValueError):
            given = short(repr(self.lam))
            raise Error(f"conduction: conductivity {given}: give a number > 0, or the name of a material") from None
        numbers = [own, *(one for layer in layers for one in layer)]
        if not (np.isfinite(numbers).all() and min(numbers) > 0):
            text = f", layers {layers}" if layers else ""
            raise Error(f"conduction: conductivity {own:g}{text}: expected finite numbers > 0")
        return own, layers

    def resistivity(self, k: np.ndarray) -> np.ndarray:
        """F of waves.

        Parameters
        ----------
        k : ndarray
            Wave numbers, 1/m; inf is allowed.

        Returns
        -------
        ndarray
            V k/q, of the same shape, m K/W, or Ohm m.
        """
        below, layers = self._numbers()
        found = np.full(np.shape(k), 1 / below)
        for thickness, lam in reversed(layers):
            passed, own = np.tanh(np.asarray(k) * thickness), 1 / lam
            found = own * (found + own * passed) / (own + found * passed)
        return found

    def images(self) -> list[tuple[float, float]]:
        """Sources that have the body's potential at its surface.

        Returns
        -------
        list of (depth, weight)
            m, and m K/W or Ohm m, the one at the surface first.
        """
        below, layers = self._numbers()
        conductivities = [lam for _, lam in layers] + [below]
        if min(conductivities) == max(conductivities):
            return [(0.0, 1 / below)]
        lowest = 2 * layers[0][0]
        depth = 2 * sum(thickness for thickness, _ in layers)
        highest = BELOW * depth * max(conductivities) / min(conductivities)
        depths = np.geomspace(lowest, highest, int(np.ceil(RATE * np.log2(highest / lowest))) + 1)
        k = np.append(0.0, np.geomspace(1e-3 / highest, SHORTEST / lowest, WAVES * len(depths)))
        own = 1 / conductivities[0]
        weights = np.linalg.lstsq(np.exp(-k[:, None] * depths), self.resistivity(k) - own, rcond=CUT)[0]
        return [(0.0, own), *((float(d), float(one)) for d, one in zip(depths, weights))]

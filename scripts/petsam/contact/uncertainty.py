"""Standard deviation of a number of a load history, to first order, by roughness and by inaccurate parameters.

    contact.record_gradient()
    contact.run(history)
    rough = petsam.uncertainty.Roughness(rms=50e-9, hurst=0.8, shortest=0.25e-3, longest=2e-3)
    found = petsam.uncertainty.of(contact, contact.gradient("energy"), rough, friction=0.01, load_tx=1.0)
    print(found)        # the number, its standard deviation, and the share of each
    found.largest       # "roughness"

One run and one pass back give the derivatives g of the number J. The parameters are independent of one another, and
var(J) = sum of (g sd)^2 and of g'C g, in which C is the covariance of the heights: that of a stationary surface that is
periodic over the grid is circulant, and g'C g the sum over waves of their mean square height times |FFT(g)|^2.

First order omits the change of the mean: a roughness that is not small raises the mean of the maximum pressure, say,
although its standard deviation is still good.
"""

from dataclasses import dataclass
from numbers import Real
from typing import TYPE_CHECKING, Optional

import numpy as np
from numpy.typing import ArrayLike

from ..core.brief import brief
from ..core.errors import Unusable
from ..core.roughness import self_affine
from ..core.units import shown, size
from ..results.gradients import Gradient
from .gradient import whole

if TYPE_CHECKING:
    from .inprocess import Contact

RESOLVED = 2.0  # cells in the shortest wavelength, more than


@dataclass(frozen=True)
class Roughness:
    """A stationary, isotropic, self-affine roughness of the gap, in addition to its shape.

    Attributes
    ----------
    rms : float or str
        Root mean square height, m, or with its unit, "50nm".
    hurst : float
        Hurst exponent, 0 to 1: the spectrum falls as q^(-2 (1 + hurst)).
    shortest, longest : float or str
        Shortest and longest wavelength, likewise.

    Raises
    ------
    Error
        If one is not a number.
    """

    rms: float
    hurst: float
    shortest: float
    longest: float

    def __post_init__(self):
        for name, unit in {"rms": "m", "hurst": "", "shortest": "m", "longest": "m"}.items():
            given = getattr(self, name)
            value = size(given, unit) if isinstance(given, str) else given
            if not isinstance(value, Real):
                raise Unusable(f"roughness: {name} = {given!r}: give a number{', as 1e-6 or 1um' if unit else ''}")
            object.__setattr__(self, name, float(value))

    def waves(self, contact: "Contact") -> np.ndarray:
        """The mean square height of each wave that is periodic over the grid; their sum is rms^2.

        Parameters
        ----------
        contact : Contact
            Its grid.

        Returns
        -------
        ndarray
            In the order of numpy.fft.fft2, (ny, nx), m2.

        Raises
        ------
        Error
            If a value is out of range, or waves are longer than the grid or too short for its cells.
        """
        cells = [size / n for size, n in zip(contact.size, contact.n)]
        if not (self.rms >= 0.0 and 0.0 <= self.hurst <= 1.0):
            raise Unusable(f"rms = {self.rms:g}, hurst = {self.hurst:g}: give a height and an exponent from 0 to 1")
        if not self.shortest > RESOLVED * max(cells):
            raise Unusable(
                f"the shortest wavelength {shown(self.shortest)} has {self.shortest / max(cells):.3g} cells of the "
                f"grid; give more than {RESOLVED:g}: a finer grid_n, or a longer wavelength"
            )
        if not self.shortest <= self.longest <= min(contact.size):
            raise Unusable(
                f"the longest wavelength {shown(self.longest)}: give {shown(self.shortest)} (the shortest) to "
                f"{shown(min(contact.size))} (the grid): a larger grid_size, or a shorter wavelength"
            )
        kx, ky = (np.fft.fftfreq(n, cell) for n, cell in zip(contact.n, cells))
        q = 2.0 * np.pi * np.hypot(kx[None, :], ky[:, None])
        found = np.zeros(q.shape)
        found[q > 0.0] = self_affine(self.hurst, self.longest, self.shortest)(q[q > 0.0])
        if not found.any():
            raise Unusable(
                f"no wave of the grid is from {shown(self.shortest)} to {shown(self.longest)} long: give a wider range"
            )
        return self.rms**2 / found.sum() * found

    def heights(self, contact: "Contact", seed: int) -> np.ndarray:
        """A random surface of this roughness, to be added to the gap, for comparison.

        Parameters
        ----------
        contact : Contact
            Its grid.
        seed : int
            Of the random numbers.

        Returns
        -------
        ndarray
            Gaussian heights (ny, nx), m.

        Raises
        ------
        Error
            As waves().
        """
        waves = self.waves(contact)
        noise = np.random.default_rng(seed).standard_normal(waves.shape)
        return np.fft.ifft2(np.fft.fft2(noise) * np.sqrt(waves * waves.size)).real


@brief
@dataclass(frozen=True)
class Uncertainty:
    """A number and its standard deviation to first order; see of().

    Attributes
    ----------
    name : str
        Of the number.
    value : float
        The number without roughness, at the given parameters.
    sd : float
        Its standard deviation.
    parts : dict
        {name: standard deviation by this parameter or the roughness alone}, the largest first.
    """

    name: str
    value: float
    sd: float
    parts: dict

    @property
    def shares(self) -> dict:
        """{name: share of the variance}, the largest first; their sum is 1."""
        return {name: part**2 / self.sd**2 if self.sd > 0.0 else 0.0 for name, part in self.parts.items()}

    @property
    def largest(self) -> str:
        """The name of the largest part."""
        return next(iter(self.parts))

    def __str__(self):
        shares = ", ".join(f"{name} {100 * share:.3g} %" for name, share in self.shares.items())
        return f"{self.name} {self.value:.5g} +- {self.sd:.3g}: {shares}"


def of(contact: "Contact", found: Gradient, roughness: Optional[Roughness] = None, **sd: ArrayLike) -> Uncertainty:
    """The standard deviation of a number, to first order, from its derivatives.

    Parameters
    ----------
    contact : Contact
        The contact whose steps were recorded.
    found : Gradient
        Of the number, as contact.gradient() returns it; for a roughness by "gap", for moduli by these.
    roughness : Roughness, optional
        Of the gap, in addition to its shape.
    **sd
        Standard deviations by the names of the derivatives, each independent of the others: friction, body1_young,
        load_tx, wear_coefficient (of one body), ... Of friction a number is that of the coefficient of all cells, of a
        load that of all steps. An array, of the cells or of the steps, is a pattern with one unknown factor, with
        signs: load_tx=0.01 * contact's loads of each step for a load cell with an error of 1 %.

    Returns
    -------
    Uncertainty

    Raises
    ------
    Error
        If there is no derivative by a name, none is given, an sd is not finite or has another shape, or other ranks
        have rows of the contact.
    """
    whole(contact)
    parts = {name: _part(found, name, value) for name, value in sd.items()}
    if roughness is not None:
        parts["roughness"] = float(np.sqrt(np.sum(roughness.waves(contact) * np.abs(np.fft.fft2(found.gap)) ** 2)))
    if not parts:
        raise Unusable(f"{found.name}: no standard deviation: give a roughness, friction=0.01, ...")
    parts = dict(sorted(parts.items(), key=lambda pair: -pair[1]))
    return Uncertainty(found.name, found.value, float(np.sqrt(sum(part**2 for part in parts.values()))), parts)


def _part(found, name, sd):
    """The standard deviation by one parameter alone."""
    slope = np.asarray(found[name])
    try:
        numbers = np.asarray(sd, dtype=float)
    except (TypeError, ValueError):
        numbers = np.full((1, 1, 1), np.nan)
    if numbers.shape not in ((), slope.shape) or not np.isfinite(numbers).all():
        raise Unusable(f"{name} = {sd}: give a finite number, or an array of the shape {slope.shape}")
    return abs(float(np.sum(slope * numbers)))


__all__ = ["Roughness", "Uncertainty", "of"]


def __dir__():
    return __all__

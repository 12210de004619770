"""A measured loop with its noise, and what a fit of loops has found."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Optional

import numpy as np

from ...core.brief import brief

FLOOR = 2e-4  # least noise, relative to the range: that of a record of 12 bits
DEAF = 0.3  # of what is known beforehand: the least deviation in which it is measured how far loops pull it


@brief
@dataclass(frozen=True)
class Loop:
    """A closed loop of one cycle, in the order of time.

    Parameters
    ----------
    displacement, force : ndarray
        (n,), m and N; the force moves with the displacement.
    rising : ndarray
        (n,), True where the displacement rises.
    normal : float
        Normal load, N.
    given : tuple of float, optional
        Noise of displacement and force, m and N, and what is left of that of the displacement in its values, whose
        smooth part counts for the bands all the same; None: by second differences, and all of it.
    """

    displacement: np.ndarray
    force: np.ndarray
    rising: np.ndarray
    normal: float
    given: Optional[tuple] = None

    @property
    def energy(self) -> float:
        """Area of the polygon, J; not biased by white noise."""
        d, q = self.displacement, self.force
        return float(abs(0.5 * np.sum(d * np.roll(q, -1) - np.roll(d, -1) * q)))

    @property
    def energy_sd(self) -> float:
        """Its standard deviation by the noise of all points, J.

        The area is linear in each point, with the distance of its two neighbours as the factor. Measured distances are
        too large by noise, and its products with the noise of the others count half of that.
        """
        d, q = (np.roll(one, -1) - np.roll(one, 1) for one in (self.displacement, self.force))
        of_d, of_q = self.noise()
        square = 0.25 * (np.sum(d**2) * of_q**2 + np.sum(q**2) * of_d**2) - 0.5 * len(d) * (of_d * of_q) ** 2
        return float(np.sqrt(max(square, 0.0)))

    def noise(self) -> tuple[float, float]:
        """Noise of displacement and force, from second differences.

        Returns
        -------
        tuple of float
            Standard deviations, m and N.
        """
        return self.given[:2] if self.given else (noise_of(self.displacement), noise_of(self.force))


def noise_of(values: np.ndarray) -> float:
    """Standard deviation of the white noise of a smooth series, from its second differences; at least FLOOR of its
    range."""
    second = np.abs(values[:-2] - 2.0 * values[1:-1] + values[2:])
    return float(max(np.median(second) / (0.6745 * np.sqrt(6.0)), FLOOR * np.ptp(values)))


@brief
@dataclass(frozen=True)
class Fit:
    """Friction and rig as found from loops.

    Attributes
    ----------
    friction, friction_sd : float
        Coefficient of friction and its standard deviation; NaN where the loops do not hold it.
    friction_at_least : float
        Lower bound, 95 %, of a friction that is not identifiable; else NaN.
    friction_range : tuple of float
        95 %; infinite where there is no upper bound.
    state : str
        Of the friction: "known", "weak", "not identifiable", or "rejected": the model does not hold.
    compliance, compliance_sd : float
        Of the rig, m/N.
    sliding : float
        Largest shear amplitude of the loops over mu N.
    gross : bool
        The loops with that amplitude slide.
    misfit : float
        Root mean square of the residuals of the force, N.
    noise : tuple of float
        Of displacement and force, m and N.
    neighbours : float
        Correlation of neighbouring residuals.
    more : dict
        {name: (value, standard deviation)} of the other parameters that were free: lean (N/m), loss, scale.
    correlation : dict
        {name: correlation of its error with that of the friction}, of the compliance and of those in `more`.
    loops : sequence of Loop
        What was fitted.
    curves : sequence
        Displacement (m) and force (N) of the closed loop of the fit, of each.
    ends : tuple of str
        Parameters at an end of their range, for which a fit is rejected.
    """

    friction: float
    friction_sd: float
    friction_at_least: float
    friction_range: tuple
    state: str
    compliance: float
    compliance_sd: float
    sliding: float
    gross: bool
    misfit: float
    noise: tuple
    neighbours: float
    more: dict = field(default_factory=dict)
    correlation: dict = field(default_factory=dict)
    loops: Sequence = ()
    curves: Sequence = ()
    ends: tuple = ()

    @property
    def identifiable(self) -> bool:
        """True if the loops hold the friction."""
        return self.state in ("known", "weak")

    @property
    def stiffness(self) -> float:
        """Stiffness of the rig, N/m; infinite without compliance, NaN of an unknown one."""
        return np.inf if self.compliance <= 0.0 else 1.0 / self.compliance

    @property
    def stiffness_sd(self) -> float:
        """Standard deviation of the rig's stiffness, N/m."""
        return self.compliance_sd * self.stiffness**2 if self.compliance > 0.0 else np.nan

    def pull(self, name: str, value: float, deviation: float) -> float:
        """How far the loops pull a parameter from what is known of it beforehand.

        The difference of what the loops alone and what was known tell, in standard deviations of that difference: with
        both normal, that of the value found from what was known, over sqrt(deviation^2 - sd^2).

        Parameters
        ----------
        name : str
            Of a parameter in `more`.
        value, deviation : float
            What was known of it, with which it was fitted.

        Returns
        -------
        float
            1; near 0 where the loops tell nothing of it.
        """
        found, sd = self.more[name]
        return abs(found - value) / max(np.sqrt(max(deviation**2 - sd**2, 0.0)), DEAF * deviation)

    def alone(self, name: str, value: float) -> tuple[float, float]:
        """Friction and its standard deviation if a parameter of `more` had this value, by the covariance.

        Parameters
        ----------
        name : str
        value : float

        Returns
        -------
        tuple of float
        """
        if name not in self.more:
            return self.friction, self.friction_sd
        (found, sd), correlation = self.more[name], self.correlation[name]
        moved = correlation * self.friction_sd / sd * (value - found) if sd > 0.0 else 0.0
        return self.friction + moved, self.friction_sd * float(np.sqrt(max(1.0 - correlation**2, 0.0)))

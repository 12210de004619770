"""Lives of the fatigue parameters by strain-life and S-N curves, safety factors, damage of a spectrum.

Lives are cycles N, half as many as reversals 2N; inf beyond MOST, LEAST where the first reversal breaks the material.

    Smith-Watson-Topper  s_max de/2                      = sigma_f^2/E (2N)^2b + sigma_f epsilon_f (2N)^(b+c)
    Fatemi-Socie         tau_a/G (1 + k s_max/yield)     = tau_f/G (2N)^b0 + gamma_f (2N)^c0
    Basquin              s_a, with Goodman's mean stress = sigma_f (2N)^b

K. N. Smith, P. Watson, T. H. Topper, Journal of Materials 5 (1970) 767-778; A. Fatemi, D. F. Socie, Fatigue and
Fracture of Engineering Materials and Structures 11 (1988) 149-165; M. A. Miner, Journal of Applied Mechanics 12 (1945)
A159-A164.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Optional

import numpy as np
from numpy.typing import ArrayLike

from ...core.errors import WrongArgument

LEAST, MOST = 0.5, 1e12  # cycles
HALVINGS = 60  # of the interval of log N: to rounding


def _life(curve, values):
    """Cycles N at which a curve, falling with N, has the values; Error of one that rises."""
    if np.any(curve(MOST) >= curve(LEAST)):
        raise WrongArgument(
            "the curve does not fall with the cycles: its exponents are negative, give them with their sign"
        )
    values = np.asarray(values, dtype=float)
    low, high = np.full(values.shape, np.log(LEAST)), np.full(values.shape, np.log(MOST))
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        above = curve(np.exp(middle)) > values
        low, high = np.where(above, middle, low), np.where(above, high, middle)
    lives = np.where(values <= curve(MOST), np.inf, np.where(values >= curve(LEAST), LEAST, np.exp(low)))
    return np.where(np.isnan(values), np.nan, lives)


def swt(values: ArrayLike, young: ArrayLike, sigma_f: float, b: float, epsilon_f: float, c: float) -> np.ndarray:
    """Lives by Smith, Watson and Topper's parameter.

    Parameters
    ----------
    values : array_like
        Values of the parameter, Pa, of any shape.
    young : float or array_like
        Young's modulus, Pa, which fits the shape of the values.
    sigma_f, b : float
        Fatigue strength coefficient, Pa, and exponent, negative.
    epsilon_f, c : float
        Fatigue ductility coefficient and exponent, negative.

    Returns
    -------
    ndarray
        Cycles, of the shape of the values; NaN where these are NaN.

    Raises
    ------
    Error
        If the curve does not fall with the cycles.
    """
    return _life(lambda n: sigma_f**2 / young * (2 * n) ** (2 * b) + sigma_f * epsilon_f * (2 * n) ** (b + c), values)


def fatemi_socie(
    values: ArrayLike, young: ArrayLike, poisson: ArrayLike, tau_f: float, b0: float, gamma_f: float, c0: float
) -> np.ndarray:
    """Lives by Fatemi and Socie's parameter.

    Parameters
    ----------
    values : array_like
        Values of the parameter, of any shape.
    young, poisson : float or array_like
        Young's modulus, Pa, and Poisson's ratio, which fit the shape of the values.
    tau_f, b0 : float
        Fatigue strength coefficient in shear, Pa, and its exponent, negative.
    gamma_f, c0 : float
        Fatigue ductility coefficient in shear, and its exponent, negative.

    Returns
    -------
    ndarray
        Cycles, of the shape of the values; NaN where these are NaN.

    Raises
    ------
    Error
        If the curve does not fall with the cycles.
    """
    shear = young / (2.0 * (1.0 + poisson))
    return _life(lambda n: tau_f / shear * (2 * n) ** b0 + gamma_f * (2 * n) ** c0, values)


def basquin(high: ArrayLike, low: ArrayLike, sigma_f: float, b: float, ultimate: Optional[float] = None) -> np.ndarray:
    """Lives of a stress by Basquin's curve.

    Parameters
    ----------
    high, low : array_like
        Maximum and minimum of the stress, Pa, of one shape.
    sigma_f, b : float
        Fatigue strength coefficient, Pa, and exponent, negative.
    ultimate : float, optional
        Ultimate strength, Pa, for Goodman's mean-stress correction; None: without it.

    Returns
    -------
    ndarray
        Cycles, of the shape of the stresses; NaN where these are NaN.

    Raises
    ------
    Error
        If the curve does not fall with the cycles.
    """
    amplitude, mean = 0.5 * (np.asarray(high) - low), 0.5 * (np.asarray(high) + low)
    if ultimate is not None:
        rest = 1.0 - np.maximum(mean, 0.0) / ultimate
        amplitude = np.where(rest > 0.0, amplitude / np.where(rest > 0.0, rest, 1.0), np.inf)
    return _life(lambda n: sigma_f * (2 * n) ** b, amplitude)


def _of_one(curve):
    """A function of one value, and of the constants of its curve, whose life is finite: at most MOST."""
    return lambda *values: min(float(curve(*values)), MOST)


life_swt, life_fatemi_socie, life_basquin = _of_one(swt), _of_one(fatemi_socie), _of_one(basquin)


def factor(values: ArrayLike, limit: float) -> np.ndarray:
    """Safety factors: the limit relative to the values of a parameter.

    Parameters
    ----------
    values : array_like
        Values of the parameter, Pa, of any shape.
    limit : float
        Value of the parameter at the fatigue limit, Pa.

    Returns
    -------
    ndarray
        Factors, of the shape of the values; inf where these are not positive, NaN where they are NaN.
    """
    values = np.asarray(values, dtype=float)
    return np.where(
        values > 0.0, limit / np.where(values > 0.0, values, 1.0), np.where(np.isnan(values), np.nan, np.inf)
    )


def damage(lives: Sequence[np.ndarray], counts: Iterable[float]) -> np.ndarray:
    """Palmgren and Miner's sum over blocks of cycles: counts relative to lives.

    Parameters
    ----------
    lives : sequence of ndarray
        Lives of each block, cycles, all of one shape.
    counts : sequence of float
        Cycles of each block.

    Returns
    -------
    ndarray
        Damage, of the shape of the lives.
    """
    return sum(count / one for one, count in zip(lives, counts))


__all__ = ["basquin", "damage", "factor", "fatemi_socie", "swt"]


def __dir__():
    return __all__

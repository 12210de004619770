"""The colours of a map: from zero, or symmetric about it; limits that a few peaks do not set; logarithmic ones."""

from typing import NamedTuple, Optional

import numpy as np
from matplotlib.colors import LogNorm, Normalize, SymLogNorm

from ..core.errors import Error
from .units import label, scale

SIGNED, UNSIGNED = "RdBu_r", "viridis"
ENDINGS = ("_x", "_y", "_z", "_gradient")  # of names of components and derivatives, which have a sign in any case
ROUNDING = 1e-6  # of the largest value: what is negative by less is no sign
LEAST = {"power_density": 0.02}  # the same of a field that is slightly negative in some cells by its nature
PERCENTILES = (99.8, 99.0, 98.0, 95.0)  # tried in this order
PEAK = 2.0  # times the percentile: what lies above would darken the rest
DECADES = 4  # of a logarithmic scale, unless limits are given


class Choice(NamedTuple):
    """A user's choice: limits (low, high; SI units), logarithmic colours, the percentile of the top (%)."""

    limits: Optional[tuple] = None
    log: bool = False
    percentile: Optional[float] = None


class Colours(NamedTuple):
    """How a quantity is drawn: norm and color_map of its values times factor, unit, and a remark on the limits."""

    norm: object
    color_map: str
    factor: float
    unit: str
    remark: str
    extend: str

    def text(self, symbol):
        """The colour bar's label."""
        return label(symbol, self.unit)


def is_signed(name, values):
    """True if a quantity has two directions: by its name, or because some of it is negative."""
    low, high = float(np.min(values, initial=0.0)), float(np.max(values, initial=0.0))
    return name.endswith(ENDINGS) or low < -LEAST.get(name, ROUNDING) * max(high, -low)


def finite(arrays):
    """All finite numbers of arrays, one after another."""
    parts = [np.asarray(one, dtype=float).ravel() for one in arrays]
    return np.concatenate([one[np.isfinite(one)] for one in parts] or [np.zeros(0)])


def top(magnitudes, percentile=None, automatic=True):
    """The largest magnitude of the colours, and the percentile that it is, 100 of all.

    If no percentile is given, it is less than 100 if a few cells have PEAK times the values of the others.
    """
    whole = float(np.max(magnitudes, initial=0.0))
    cells = magnitudes[magnitudes > ROUNDING * whole]  # without what is open
    if not cells.size:
        return whole, 100.0
    if percentile is not None:
        if not 0.0 < percentile <= 100.0:
            raise Error(f"--percentile {percentile:g}: expected a number above 0 and at most 100")
        return float(np.percentile(cells, percentile)), percentile
    for share in PERCENTILES if automatic else ():
        value = float(np.percentile(cells, share))
        if whole > PEAK * value:
            return value, share
    return whole, 100.0


def _remark(share, whole, unit):
    """Returns a note about a limit that is a percentile; whole is the largest value, in the label's unit."""
    return "" if share >= 100.0 else f"colours hold {share:g} % of non-zero cells; maximum {whole:.3g} {unit}".rstrip()


def _log_limits(magnitudes, high, limits):
    """Limits of a logarithmic scale: some decades, or as far as the smallest magnitudes, or those given."""
    if limits:
        if not limits[0] > 0.0:
            raise Error(f"--limits {limits[0]:g},{limits[1]:g}: expected a positive lower limit with --log colors")
        return limits
    some = magnitudes[magnitudes > 0.0]
    if not some.size or not high > 0.0:
        raise Error("--log colors: no value is positive")
    return max(float(np.min(some)), high * 10.0**-DECADES) * (1.0 - 1e-9), high


def log_ticks(norm, count):
    """Numbers on a logarithmic colour bar, about so many: decades, or parts of one; of both signs about zero."""
    low = norm.linthresh if isinstance(norm, SymLogNorm) else norm.vmin
    first, last = np.ceil(np.log10(low) - 1e-9), np.floor(np.log10(norm.vmax) + 1e-9)
    found = 10.0 ** np.arange(first, last + 1)
    if found.size < 2:
        found = [value for value in np.outer(10.0 ** np.arange(first - 1, last + 2), (1, 2, 5)).ravel()]
        found = np.array([value for value in found if low <= value <= norm.vmax * (1.0 + 1e-9)])
    if isinstance(norm, SymLogNorm):
        found = found[:: -max(1, round(found.size / max(1, (count - 1) / 2)))][::-1]
        return [*(-found[::-1]), 0.0, *found]
    return list(found[:: -max(1, round(found.size / count))][::-1])


def choose(name, arrays, unit, choice=None):
    """The Colours of a quantity whose values, in the given unit, are in arrays: one scale for all of them."""
    choice = choice or Choice()
    values = finite(arrays)
    signed = is_signed(name, values)
    magnitudes = np.abs(values)
    high, share = (choice.limits[1], 100.0) if choice.limits else top(magnitudes, choice.percentile, not choice.log)
    whole = float(np.max(magnitudes, initial=0.0))
    low = choice.limits[0] if choice.limits else (-high if signed else 0.0)
    if choice.log:
        floor, high = _log_limits(magnitudes, high, None if signed and choice.limits else choice.limits)
        low = -high if signed else floor
    factor, prefixed = scale(unit, max(abs(low), abs(high)))
    low, high = factor * low, factor * high
    if not high > low:
        low, high = (-1.0, 1.0) if signed else (low, low + 1.0) if np.isfinite(low) else (0.0, 1.0)
    norm = Normalize(low, high)
    if choice.log:
        norm = SymLogNorm(factor * floor, vmin=low, vmax=high, base=10) if signed else LogNorm(low, high)
    above = bool(magnitudes.size) and factor * np.max(values) > high * (1.0 + 1e-9)
    below = (
        bool(magnitudes.size) and factor * np.min(values) < low - LEAST.get(name, 1e-9) * abs(high) and not choice.log
    )
    extend = {(True, True): "both", (True, False): "max", (False, True): "min"}.get((above, below), "neither")
    remark = _remark(share, factor * whole, prefixed)
    return Colours(norm, SIGNED if signed else UNSIGNED, factor, prefixed, remark, extend)

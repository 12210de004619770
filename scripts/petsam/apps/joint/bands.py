"""The band of frequency and damping over the histories of assembly, and their scatter.

The residual tractions of a joint depend on how it was assembled, and damping and frequency follow them. A band has the
backbones of several assemblies at the same modal forces. To first order, each parameter with a standard deviation adds
the change that it makes, by the difference of two backbones.
"""

from __future__ import annotations

import itertools
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Optional

import numpy as np
from numpy.typing import ArrayLike

from ...core.brief import brief
from ...core.errors import Unusable, short
from ...core.tables import Column, Tabled
from .arguments import positive, real
from .backbones import COLUMNS, Backbone, backbone, shake
from .failures import ENDS, NoSolution
from .numbers import UNKNOWN_HERE, columns_of, reason
from .pair import Pair
from .sweep import BackboneWarning

ASSEMBLED, REVERSED, FRICTIONLESS, SHAKEN = "as given", "bolts reversed", "without friction", "after the largest"
TEXTS = {
    ASSEMBLED: "bolts tightened in the given order, with friction",
    REVERSED: "in the reverse order",
    FRICTIONLESS: "without friction until all are tightened",
    SHAKEN: "as given, then vibrated at the largest amplitude",
}
SIDES = "lower", "higher"  # of a parameter of the scatter
NUMBERS = ("frequency", "damping")


@brief
@dataclass
class Band(Tabled):
    """Backbones of a joint.

    Attributes
    ----------
    backbones : dict
        {assembly: Backbone}, the first one as given.
    scatter : dict
        {parameter: (low, high)}, backbones with the parameter a standard deviation lower and higher.
    """

    form = staticmethod("{:.10g}".format)

    backbones: dict
    scatter: dict

    @property
    def given(self) -> Backbone:
        """The backbone as given."""
        return self.backbones[ASSEMBLED]

    @property
    def sides(self) -> dict[str, Backbone]:
        """{parameter and side: Backbone} of the scatter."""
        return {f"{name} {side}": one for name, two in self.scatter.items() for side, one in zip(SIDES, two)}

    @property
    def every(self) -> dict[str, Backbone]:
        """{assembly, or parameter and side: Backbone} of all."""
        return self.backbones | self.sides

    @property
    def count(self) -> int:
        """Number of amplitudes that all backbones have."""
        return min(len(one.alpha) for one in self.every.values())

    def limits(self, name: str) -> tuple[np.ndarray, np.ndarray]:
        """The limits of a number among all assemblies.

        Parameters
        ----------
        name : str
            "frequency" or "damping", or another number of a Backbone.

        Returns
        -------
        tuple of two ndarrays
            Lowest and highest values, (count,), in the unit of the number.
        """
        rows = np.array([one.numbers[name][: self.count] for one in self.backbones.values()])
        return rows.min(axis=0), rows.max(axis=0)

    def deviation(self, name: str, parameter: Optional[str] = None) -> np.ndarray:
        """The standard deviation of a number, to first order.

        Parameters
        ----------
        name : str
            "frequency" or "damping", or another number of a Backbone.
        parameter : str, optional
            Parameter of the scatter that causes it; None: all of them.

        Returns
        -------
        ndarray
            Standard deviation, (count,), in the unit of the number; 0 without scatter.
        """
        names = list(self.scatter) if parameter is None else [parameter]
        parts = [0.5 * np.subtract(*(one.numbers[name][: self.count] for one in self.scatter[of])) for of in names]
        return np.sqrt(np.sum(np.square(parts), axis=0)) if parts else np.zeros(self.count)

    def lines(self) -> list[str]:
        """The printed table.

        Returns
        -------
        list of str
            The assemblies, heads, and a line for each amplitude.
        """
        lines = [UNKNOWN_HERE, *(f"{name}: {TEXTS[name]}" for name in self.backbones)]
        lines += ["", f"{'amplitude/m':>12} {'f/Hz':>13} {'lowest':>13} {'highest':>13} {'zeta':>10} {'lowest':>10} "
                 f"{'highest':>10}" + (f" {'f +-':>9} {'zeta +-':>9}" if self.scatter else "")]  # fmt: skip
        f, z = (self.limits(name) for name in NUMBERS)
        of, oz = (self.deviation(name) for name in NUMBERS)
        for k in range(self.count):
            lines.append(
                f"{self.given.amplitude[k]:12.4e} {self.given.frequency[k]:13.8g} {f[0][k]:13.8g} {f[1][k]:13.8g} "
                f"{self.given.damping[k]:10.4e} {z[0][k]:10.4e} {z[1][k]:10.4e}"
                + (f" {of[k]:9.2e} {oz[k]:9.2e}" if self.scatter else "")
            )
        return lines

    def table(self) -> list[Column]:
        """The numbers of all backbones, a row for each assembly and amplitude.

        Returns
        -------
        list of tables.Column
        """
        every = list(self.every.values())
        names = [name for name, one in self.every.items() for _ in one.alpha]
        numbers = {name: np.concatenate([one.numbers[name] for one in every]) for name in every[0].numbers}
        columns = [one._replace(unit=self.given._unit(one.unit)) for one in columns_of(COLUMNS, numbers)]
        return Column.noted([Column("assembly", "", "the assembly", names), *columns], UNKNOWN_HERE)


def band(
    make: Callable[..., Pair], preload: dict, amplitudes: ArrayLike, sensor: Callable[[Pair], ArrayLike],
    scatter: Optional[dict] = None, report: Optional[Callable[[int, int, str], object]] = None, **given: Any,
) -> Band:  # fmt: skip
    """The Band of a joint.

    Parameters
    ----------
    make : callable
        Returns the joint's Pair, as make(preload, **changes); changes are options of it: frictionless=True, or
        friction_scale=1.1.
    preload : dict
        {bolt: initial tension in N} in the order of tightening.
    amplitudes : array of shape (k,)
        Displacements at the sensor, as of backbone().
    sensor : callable
        Returns, as sensor(pair), the displacement of the sensor by each modal coordinate.
    scatter : dict, optional
        {"friction": relative standard deviation, "preload": that of all bolts together}.
    report : callable, optional
        Called with the number of assemblies that are done, and of all, and the name of the last one.
    **given
        The arguments mode, steps and harmonics of backbone().

    Returns
    -------
    Band

    Raises
    ------
    Error
        For wrong values, and where the structure finds no equilibrium.
    """
    reached = positive("amplitudes", amplitudes, "lengths above 0")
    total, done = 3 + (len(preload) > 1) + 2 * len(scatter or {}), itertools.count(1)

    def one(name, preload=preload, shaken=False, **changes):
        found = solve(name, preload, shaken, changes)
        if report:
            report(next(done), total, name)
        return found

    def solve(name, preload, shaken, changes):
        try:
            pair = make(preload, **changes)
            if shaken:
                shake(pair.structure, float(np.max(reached)), given.get("mode", 1), sensor(pair))
            return backbone(pair.structure, reached, sensor=sensor(pair), **given)
        except ENDS as error:
            raise NoSolution(f"assembly {name}: {reason(error)}") from error

    found, parts = {ASSEMBLED: one(ASSEMBLED)}, {}
    reached = reached[: len(found[ASSEMBLED].alpha)]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", BackboneWarning)  # those of the first one
        if len(preload) > 1:
            found[REVERSED] = one(REVERSED, dict(reversed(preload.items())))
        found[FRICTIONLESS] = one(FRICTIONLESS, frictionless=True)
        found[SHAKEN] = one(SHAKEN, shaken=True)
        for name, value in (scatter or {}).items():
            sides = zip(SIDES, (-1.0, 1.0))
            parts[name] = tuple(one(f"{name} {side}", **_scattered(name, value, sign, preload)) for side, sign in sides)
    whole = Band(found, parts)
    _warn(whole)
    return whole


def _warn(found):
    """Warns of assemblies that end before the one as given."""
    count = found.count
    if count < len(found.given.alpha):
        ended = ", ".join(name for name, one in found.every.items() if len(one.alpha) == count)
        warnings.warn(
            f"only {count} of {len(found.given.alpha)} amplitudes: no more have a solution for the assembly {ended}",
            BackboneWarning,
            stacklevel=3,
        )


def _scattered(name, value, sign, preload):
    """Changes of make() by a standard deviation of a parameter."""
    if name not in ("friction", "preload"):
        raise Unusable(f"scatter {short(name)}: expected friction or preload")
    what = "a standard deviation as a part of it, from 0 to below 1"
    value = real(f"scatter {name}", value, what, lambda part: 0.0 <= part < 1.0)
    if name == "friction":
        return dict(friction_scale=1.0 + sign * value)
    return dict(preload={bolt: (1.0 + sign * value) * force for bolt, force in preload.items()})

"""Contact stiffness of an interface per area, from its surfaces: interface(), by of_interface() or of_windows().

The surfaces are taken as one period, so that the displacement of the bodies' mean planes is that of the interface
alone: a uniform pressure displaces nothing. So the stiffnesses are those of springs between two finite element models
whose surfaces are flat, and nothing of the bodies is counted twice. A window of a half-space would add the compliance
of the bodies below it, which depends on the window's size.
"""

from __future__ import annotations

import functools
import os
import warnings
from typing import Any, NamedTuple, Optional

import numpy as np
from numpy.typing import ArrayLike

from ...contact.errors import AdviceWarning
from ...core.errors import Unusable
from ...core.keywords import unfolded
from ..conduction import need_conducting
from .arguments import array, moduli, positive
from .conductance import Conducting, Conductors, add_resistance
from .properties import Interface, Outcome
from .surfaces import need_fitting, read_separation
from .ways import Report, Ways, computed, errors
from .windows import Window

CALLER = 6  # frames from _tell_warnings() to the code that calls a function of the public list


def _tell_warnings(found):
    """Gives one warning for all those of solutions, (place, text, kind)."""
    said = []
    for place, text, kind in found:
        if issubclass(kind, AdviceWarning):
            said.append(f"{place}: {text.partition(': use ')[0]}")
        else:
            warnings.warn(text, kind, stacklevel=CALLER)
    if said:
        text = f"{len(said)} solutions have a warning, the first at {said[0]}; finer points of the surface resolve more"
        warnings.warn(text, AdviceWarning, stacklevel=CALLER)


def mirrored(separation: np.ndarray) -> np.ndarray:
    """The separation and its mirror images beside it: repeated, it has no steps at its borders.

    Parameters
    ----------
    separation : ndarray
        Separation, (ny, nx), m.

    Returns
    -------
    ndarray
        Separation, (2 ny, 2 nx), m.
    """
    return np.pad(separation, [(0, size) for size in separation.shape], mode="symmetric")


COMMON = """
Parameters
----------
separation : array_like
    Separation, (ny, nx), m, larger where the surfaces are farther apart.
spacing : float or pair of floats
    Distance of its points along x and y, m, or one for both.
pressures : array_like
    Nominal pressures, (pressures,), Pa, rising.
report : callable, optional
    Called with the number of the windows that are done, and of all.
conductors : Conductors, optional
    The conducting bodies: the conductance is computed, too.
**bodies
    Options of the two bodies, body1_young (Pa), body1_poisson, body2_young, ..., and of the solution.

Returns
-------
Interface

Raises
------
Error
    For wrong values, a surface that cannot be read, and a pressure that closes the interface.
ContactError
    Where petsam finds no solution.
"""
of_surfaces = functools.partial(unfolded, common=COMMON)


@of_surfaces
def of_interface(
    separation: ArrayLike, spacing: ArrayLike, pressures: ArrayLike, *, ways: Ways,
    conductors: Optional[Conductors] = None, **bodies: Any,
) -> Interface:  # fmt: skip
    """The Interface of a separation that repeats itself. Warnings of its solutions are gathered in one."""
    return _of_interface(separation, spacing, pressures, ways, conductors, bodies)


@of_surfaces
def of_windows(
    separation: ArrayLike, spacing: ArrayLike, pressures: ArrayLike, *, ways: Ways, report: Optional[Report] = None,
    conductors: Optional[Conductors] = None, **bodies: Any,
) -> Interface:  # fmt: skip
    """The Interface of a measured separation: means and standard deviations of five windows of it, half as wide.

    Four windows have the corners, one the middle. Each is mirrored, so that it repeats itself.

    Parameters
    ----------
    separation : array_like
        Separation, (ny, nx), m, of 4 x 4 points or more.

    Returns
    -------
    Interface
        The means; `spread` has the standard deviations.
    """
    return _of_windows(separation, spacing, pressures, ways, conductors, bodies, report)


@of_surfaces
def interface(
    surface: Any, pressures: ArrayLike, *, spacing: Optional[ArrayLike] = None, periodic: bool = False, ways: Ways,
    report: Optional[Report] = None, conducting: Conducting, **bodies: Any,
) -> Interface:  # fmt: skip
    """The Interface of a surface: a scan in a file, a map of petsam.surface, or an array.

    Parameters
    ----------
    surface : path, petsam.surface.Map, or array_like
        Heights or a separation in a file of petsam-surface or in a map; an array (ny, nx) is the separation, m.
    spacing : float or pair of floats, optional
        Distance of the points of an array along x and y, m; files and maps have their own.
    periodic : bool
        Whether the surface repeats itself; else five windows of it give means and standard deviations.
    **bodies
        Options of the bodies, body1="steel" (petsam.materials), or body1_young (Pa, or "210GPa"), body1_poisson,
        body2_young, ..., and of the solution.

    Examples
    --------
    >>> import numpy as np, petsam
    >>> x = np.arange(16) / 16
    >>> waves = 1e-7 * (2 - np.cos(2 * np.pi * x) - np.cos(2 * np.pi * x[:, None]))  # m
    >>> found = petsam.joint.interface(
    ...     waves, [20e6, 40e6], spacing=1e-6, periodic=True, normal_only=True, body1="steel", body2="steel")
    >>> [column.name for column in found.table()][:3]
    ['pressure', 'closure', 'separation']
    """
    conductors = conducting.conductors()
    if isinstance(surface, (str, os.PathLike)):
        surface, own, doubts = read_separation(os.fspath(surface))
        for text in doubts:
            warnings.warn(text, AdviceWarning, stacklevel=3)
    elif hasattr(surface, "quantity"):
        own = tuple(side / n for side, n in zip(surface.size, surface.n))
        surface = surface.values if surface.quantity == "separation" else -surface.values
    else:
        own = spacing
        if spacing is None:
            raise Unusable("spacing: give the distance of the points of an array, m")
    if spacing is not None and own is not spacing:
        raise Unusable("spacing: the surface has its own: leave it out")
    bodies = moduli(bodies)
    if periodic:
        return _of_interface(surface, own, pressures, ways, conductors, bodies)
    return _of_windows(surface, own, pressures, ways, conductors, bodies, report)


def _of_interface(separation, spacing, pressures, ways, conductors, bodies):
    """The Interface of a separation that repeats itself."""
    separation, ways = array("separation", separation), _checked(ways, conductors, bodies)
    cuts = [_Cut(separation, "", conductors and conductors.fitted(separation.shape))]
    return _of_cuts(cuts, spacing, pressures, ways, conductors, bodies)


def _of_windows(separation, spacing, pressures, ways, conductors, bodies, report):
    """The Interface of five windows of a separation."""
    separation = array("separation", separation)
    if separation.ndim != 2 or min(separation.shape) < 4:
        raise Unusable("separation: expected a field of 4 x 4 points or more")
    ny, nx = (size // 2 for size in separation.shape)
    y, x = separation.shape[0] - ny, separation.shape[1] - nx
    places = [(0, 0), (0, x), (y, 0), (y, x), (y // 2, x // 2)]
    ways = _checked(ways, conductors, bodies)
    if conductors:
        conductors.fitted(separation.shape)
    cuts = []
    for k, (j, i) in enumerate(places, 1):

        def window(field, j=j, i=i):
            return mirrored(field[j : j + ny, i : i + nx])

        name = f" in window {k} with its mirror images"
        cuts.append(_Cut(window(separation), name, conductors and conductors.mapped(window)))
    return _of_cuts(cuts, spacing, pressures, ways, conductors, bodies, report)


def _checked(ways, conductors, bodies):
    """Checked ways; Error where conductors do not go with the options of the bodies."""
    if conductors:
        need_conducting(bodies, *conductors.layers)
    return ways.checked()


class _Cut(NamedTuple):
    """A window's separation, its name in warnings, and what conducts there."""

    field: np.ndarray
    name: str
    conductors: Optional[Conductors]


def _of_cuts(cuts, spacing, pressures, ways, conductors, bodies, report=None):
    """The Interface of windows."""
    loop, reason = ways.loop(), ways.reason(bodies)
    pressures = np.atleast_1d(array("pressures", pressures))
    for field, *_ in cuts:
        if field.ndim != 2 or not np.isfinite(field).all():
            raise Unusable(
                "separation: expected a field (ny, nx) of finite numbers: fill missing points, .fill() of a map"
            )
    if pressures.ndim != 1 or not pressures.size or not (np.diff(pressures, prepend=0.0) > 0).all():
        raise Unusable("pressures: expected positive pressures that rise")
    step = positive("spacing", spacing, "lengths above 0")
    if step.size > 2:
        raise Unusable(f"spacing {spacing!r}: expected the distance of points along x and y, or one for both")
    step = np.broadcast_to(step, 2)
    for field, *_ in cuts:
        need_fitting(field, step, pressures, loop and loop.friction, bodies)
    given = tuple(map(float, pressures))
    parts = [Window(field, step, given, loop, bodies, name, not k, own) for k, (field, name, own) in enumerate(cuts)]
    found = computed(parts, ways, reason, report)
    _tell_warnings([one for each in found for one in each.warnings])
    several, each = found[: len(parts)], found[len(parts) :]
    numbers = {name: np.mean([one.numbers[name] for one in several], axis=0) for name in several[0].numbers}
    spread = {}
    if len(parts) > 1:
        for name in numbers:
            if name != "pressure":
                spread[name] = np.std([one.numbers[name] for one in several], axis=0, ddof=1)
    add_resistance(numbers, spread)
    loading = several[0].loading
    if loop and len(parts) > 1:
        # shears over their own stiffness: a mean of the displacements would be that of compliances, and seem to slip
        loading = np.mean([one.loading * one.numbers["k_t_x"][:, None] for one in several], axis=0)
        loading /= numbers["k_t_x"][:, None]
    wrong, note = errors(several[0], each, ways, reason, given)
    return Interface(Outcome(numbers, spread, loading, wrong, note), loop, bodies, conductors)

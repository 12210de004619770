"""Contact stiffness of an interface per area, from its surfaces: interface(), by of_interface() or of_windows().

The surfaces are taken as one period, so that the displacement of the bodies' mean planes is that of the interface
alone: a uniform pressure displaces nothing. So the stiffnesses are those of springs between two finite element models
whose surfaces are flat, and nothing of the bodies is counted twice. A window of a half-space would add the compliance
of the bodies below it, which depends on the window's size.
"""

import contextlib
import json
import os
import warnings
from collections.abc import Callable
from typing import Any, NamedTuple, Optional, Union

import numpy as np
from numpy.typing import ArrayLike

from ..contact import AdviceWarning, Contact
from ..core import words
from ..core.errors import Unusable
from ..core.tables import Column, Tabled
from . import elements
from .arguments import array, integer, positive, real
from .numbers import columns_of
from .surfaces import need_fitting, read_separation

HALVES = 4  # half cycles of the loop; the last two count
NO_FIT = f"{'-':>10} {'-':>5} {'-':>8}"
LARGEST = 0.95  # shear over its limit at the end of the first loading to which elements are fitted
COLUMNS = {
    "pressure": ("Pa", "nominal pressure"),
    "closure": ("m", "approach of the mean planes since the first touch"),
    "k_n": ("Pa/m", "normal stiffness per area, d(pressure)/d(closure)"),
    "k_n_secant": ("Pa/m", "pressure over closure"),
    "k_t_x": ("Pa/m", "tangential stiffness per area along x, of sticking contacts"),
    "k_t_y": ("Pa/m", "the same along y"),
    "area": ("1", "real contact area over the nominal one"),
    "loop_amplitude": ("m", "amplitude of the displacement in a loop of the shear"),
    "loop_energy": ("J/m2", "dissipated energy of that loop per area"),
    "loop_stiffness": ("Pa/m", "secant stiffness of that loop along x"),
    "iwan_chi": ("1", "exponent of the slider limits of an Iwan element"),
    "iwan_beta": ("1", "weight of its last slider"),
    "iwan_error": ("1", "largest relative error of its loops' energy"),
    "iwan_shear_error": ("1", "the same of their shear"),
}
FITTED = [name for name in COLUMNS if name.startswith("iwan")]
COMPUTED = [name for name in COLUMNS if name not in FITTED]


class _Loop(NamedTuple):
    """A loop of the shear: coefficient of friction, amplitude over friction times pressure, steps of a quarter."""

    friction: float
    shear: float
    steps: int


class Interface(Tabled):
    """Numbers of an interface at nominal pressures, each an array: pressure, k_n, k_t_x, area ... (COLUMNS).

    Parameters
    ----------
    numbers : dict
        {name: (pressures,)} of the computed numbers, in the units of COLUMNS; those of the Iwan element are added.
    spread : dict
        {name: (pressures,)}: standard deviation of the same among the windows; empty for one window.
    friction : float
        Coefficient of friction.
    shear : float
        Amplitude of the mean shear in the loop over friction times pressure.
    bodies : dict
        Options of the bodies, as given.
    parts : ndarray
        Shears of the first loading over friction times pressure, rising, (parts,).
    loading : ndarray
        Displacements at them, (pressures, parts), m, to which the Iwan element is fitted; of windows the mean,
        weighted by their k_t_x.
    """

    def __init__(
        self,
        numbers: dict[str, np.ndarray],
        spread: dict[str, np.ndarray],
        friction: float,
        shear: float,
        bodies: dict[str, Any],
        parts: np.ndarray,
        loading: np.ndarray,
    ) -> None:
        self.spread, self.friction, self.shear, self.bodies = spread, friction, shear, bodies
        self.parts, self.loading = parts, loading
        unit = numbers["k_t_x"] / (friction * numbers["pressure"])
        fits = [elements.fit_iwan(parts, row * one) for row, one in zip(loading, unit)]
        self.numbers = {**numbers, **dict(zip(FITTED, np.transpose(fits)))}
        self._compare(unit)
        self.__dict__.update(self.numbers)

    def _compare(self, unit):
        """Adds the computed loop to the errors of energy: dissimilar bodies do not follow Masing's rule."""
        of = self.numbers
        found = elements.iwan(of["iwan_chi"], of["iwan_beta"], of["loop_amplitude"] * unit)[1] * of["k_t_x"] / unit**2
        energy = np.where(of["loop_energy"] > 0, of["loop_energy"], found)
        of["iwan_error"] = np.maximum(of["iwan_error"], np.abs(found / energy - 1))

    def __repr__(self):
        p = self.numbers["pressure"]
        return f"Interface({len(p)} pressures from {p[0]:.4g} to {p[-1]:.4g} Pa: {', '.join(self.numbers)})"

    def table(self) -> list[Column]:
        """The columns, with a row for each pressure; NAME_spread are standard deviations of windows.

        The last columns are the coefficient of friction and the shear of the loop over friction times pressure.

        Returns
        -------
        list of tables.Column
        """
        found = columns_of(COLUMNS, self.numbers)
        for name, values in self.spread.items():
            unit, text = COLUMNS[name]
            found.append(Column(f"{name}_spread", unit, f"standard deviation: {text}", values))
        for name, text in (("friction", "coefficient of friction"), ("shear", "shear of the loop over its limit")):
            found.append(Column(name, "1", text, np.full_like(self.numbers["pressure"], getattr(self, name))))
        return found

    def elements(self, area: float = 1.0) -> list[dict[str, Any]]:
        """Elements for programs of harmonic balance, one for each pressure; see elements.of_codes().

        Parameters
        ----------
        area : float
            Area of an element, m2.

        Returns
        -------
        list of dict
            Of each pressure: the pressure (Pa), the elements by program and class, and the Iwan element's errors. The
            tangential stiffness is that along x, as the loop's.
        """
        rows = zip(*(self.numbers[name] for name in ("pressure", "k_n", "k_t_x", *FITTED)))
        return [
            {
                "pressure": float(p),
                **elements.of_codes(float(p), float(k_n), float(k_t), self.friction, float(chi), float(beta), area),
                "iwan_error": float(error),
                "iwan_shear_error": float(shear_error),
            }
            for p, k_n, k_t, chi, beta, error, shear_error in rows
        ]

    def to_json(self, path: Union[str, os.PathLike], area: float = 1.0) -> None:
        """Writes elements() as JSON, in SI units, and what they are of; NaN as null.

        Parameters
        ----------
        path : str or path
            Name of the file, which is replaced.
        area : float
            Area of an element, m2.

        Raises
        ------
        OSError
            If the file cannot be written.
        """
        about = {"units": "SI: N, m, Pa, N/m; displacements of body 2 against body 1", "area": area}
        about.update(friction=self.friction, shear=self.shear, bodies=self.bodies)
        text = json.dumps({**about, "elements": self.elements(area)}, indent=1, default=str).replace("NaN", "null")
        with open(path, "w", encoding="utf-8") as file:
            file.write(text + "\n")

    def to_abaqus(self, path: Union[str, os.PathLike], name: str = "INTERFACE") -> None:
        """Writes the interaction for a deck of Abaqus in N, mm: pressure over overclosure, friction.

        The allowable elastic slip of the penalty method is friction times pressure over the tangential stiffness. The
        deck has one for all pressures, the median, and in a comment the range.

        Parameters
        ----------
        path : str or path
            Name of the file, which is replaced.
        name : str
            Name of the interaction in the deck.

        Raises
        ------
        OSError
            If the file cannot be written.
        """
        slips = self.friction * self.numbers["pressure"] * 2 / (self.numbers["k_t_x"] + self.numbers["k_t_y"])
        slip = np.median(slips)
        lines = [
            "** contact stiffness of a rough interface; pressure in MPa, overclosure from the first touch in mm,",
            "** linear between the rows",
            f"** elastic slip in mm: median of {min(slips) * 1e3:.4g} to {max(slips) * 1e3:.4g} at these pressures, so "
            "that the",
            f"** tangential stiffness is {min(slips) / slip:.3g} to {max(slips) / slip:.3g} times the computed one",
            f"*SURFACE INTERACTION, NAME={name}",
            "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=TABULAR",
            "0., 0.",
            *(f"{p / 1e6:.6g}, {d * 1e3:.6g}" for p, d in zip(self.numbers["pressure"], self.numbers["closure"])),
            f"*FRICTION, ELASTIC SLIP={slip * 1e3:.4g}",
            f"{self.friction:.6g}",
        ]
        with open(path, "w", encoding="utf-8") as file:
            file.write("\n".join(lines) + "\n")

    def lines(self) -> list[str]:
        """The table that petsam-joint prints: in MPa, N/mm3, %, mJ/m2, with the windows' deviations in %.

        Returns
        -------
        list of str
            A line of heads, and one for each pressure.
        """
        with np.errstate(invalid="ignore"):  # no energy, if nothing slips
            part = {name: 100 * spread / self.numbers[name] for name, spread in self.spread.items()}
        none = np.full_like(self.numbers["pressure"], np.nan)
        k_t = (self.numbers["k_t_x"] + self.numbers["k_t_y"]) / 2
        lines = [
            "   p/MPa  k_n/(N/mm3)  +- %  k_t/(N/mm3)  k_t/k_n  area/%  loop/(mJ/m2)  +- %  Iwan: chi  beta  error/%"
        ]
        for k, pressure in enumerate(self.numbers["pressure"]):
            deviations = [f"{part.get(name, none)[k]:5.0f}".replace("nan", "  -") for name in ("k_n", "loop_energy")]
            k_n, energy, *iwan = (self.numbers[name][k] for name in ("k_n", "loop_energy", *FITTED[:3]))
            fit = f"{iwan[0]:10.2f} {iwan[1]:5.2f} {100 * iwan[2]:8.0f}" if iwan[0] == iwan[0] else NO_FIT
            lines.append(
                f"{pressure / 1e6:8.4g} {k_n / 1e9:12.4g} {deviations[0]} {k_t[k] / 1e9:12.4g} {k_t[k] / k_n:8.4f} "
                f"{100 * self.numbers['area'][k]:7.2f} {1e3 * energy:13.3g} {deviations[1]} {fit}"
            )
        return lines


@contextlib.contextmanager
def _gathered():
    """Gives one warning for all those of the steps within; what it yields is called with the place of the next ones."""
    places = [(0, "the start")]
    with warnings.catch_warnings(record=True) as found:
        warnings.simplefilter("always", AdviceWarning)
        yield lambda place: places.append((len(found), place))
    said = []
    for k, one in enumerate(found):
        if issubclass(one.category, AdviceWarning):
            place = [place for before, place in places if before <= k][-1]
            said.append(f"{place}: {str(one.message).partition(': use ')[0]}")
        else:
            warnings.warn_explicit(one.message, one.category, one.filename, one.lineno)
    if said:
        text = f"{len(said)} solutions have a warning, the first at {said[0]}; finer points of the surface resolve more"
        warnings.warn(text, AdviceWarning, stacklevel=4)


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


def of_interface(
    separation: ArrayLike, spacing: ArrayLike, pressures: ArrayLike, *, friction: float, shear: float = 0.5,
    steps: int = 8, **bodies: Any,
) -> Interface:  # fmt: skip
    """The Interface of a separation that repeats itself. Warnings of its solutions are gathered in one.

    Parameters
    ----------
    separation : array_like
        Separation, (ny, nx), m, larger where the surfaces are farther apart.
    spacing : float or pair of floats
        Distance of its points along x and y, m, or one for both.
    pressures : array_like
        Nominal pressures, (pressures,), Pa, rising.
    friction : float
        Coefficient of friction.
    shear : float
        Amplitude of the mean shear of the loop over friction times pressure, above 0 and below 1.
    steps : int
        Load steps of a quarter of the loop.
    **bodies
        Options of the two bodies, body1_young (Pa), body1_poisson, body2_young, ..., and of the solution.

    Returns
    -------
    Interface

    Raises
    ------
    Error
        For wrong values, and for a pressure that closes the interface.
    ContactError
        Where petsam finds no solution.
    """
    with _gathered() as begins:
        return _of_interface(separation, spacing, pressures, _Loop(friction, shear, steps), bodies, begins)


def _of_interface(separation, spacing, pressures, loop, bodies, begins):
    """begins is called with each pressure, in words, before its steps."""
    friction, shear, steps = loop
    separation = array("separation", separation)
    pressures = np.atleast_1d(array("pressures", pressures))
    if separation.ndim != 2 or not np.isfinite(separation).all():
        raise Unusable("separation: expected a field (ny, nx) of finite numbers: fill missing points, .fill() of a map")
    if pressures.ndim != 1 or not pressures.size or not (np.diff(pressures, prepend=0.0) > 0).all():
        raise Unusable("pressures: expected positive pressures that rise")
    steps = integer("steps", steps)
    what = "a coefficient > 0, without which nothing resists a shear"
    friction = real("friction", friction, what, lambda one: 0.0 < one < np.inf)
    what = "a part of friction times pressure, above 0 and below 1"
    shear = real("shear", shear, what, lambda part: 0.0 < part < 1.0)
    step = positive("spacing", spacing, "lengths above 0")
    if step.size > 2:
        raise Unusable(f"spacing {spacing!r}: expected the distance of points along x and y, or one for both")
    step = np.broadcast_to(step, 2)
    need_fitting(separation, step, pressures, friction, bodies)
    n = separation.shape[::-1]
    size = tuple(float(n[k] * step[k]) for k in range(2))
    parts = shear * np.arange(1, steps + 1) / steps
    if shear < LARGEST:
        parts = np.append(parts, np.linspace(shear, LARGEST, steps + 1)[1:])
    rows, loading = [], []
    with Contact(
        elasticity="periodic", gap_type="flat", grid_n=n, grid_size=size, friction=friction, **bodies
    ) as contact:
        contact.gap = separation - separation.min()
        for pressure in pressures:
            begins(f"{pressure:.6g} Pa")
            row, first = _at(contact, float(pressure), size[0] * size[1], friction, parts, steps)
            rows.append(row)
            loading.append(first)
    numbers = dict(zip(COMPUTED, np.transpose(rows)))
    return Interface(numbers, {}, friction, shear, bodies, parts, np.array(loading))


def _at(contact, pressure, area, friction, parts, steps):
    """The computed numbers of COLUMNS at a pressure, to which the contact is loaded, and the first loading."""
    contact.try_step(time=pressure, load_n=pressure * area)
    if contact.number("contact_cells") == contact.n[0] * contact.n[1]:
        raise Unusable(
            f"pressures: {pressure:.6g} Pa: all of the surface touches, and its stiffness is infinite: give less, or "
            "check the units of heights and moduli"
        )
    k, pressed = contact.stiffness(reversal=True) / area, contact.number("disp_x")  # N alone moves dissimilar bodies
    closure, fraction = contact.number("disp_z"), contact.number("contact_fraction")
    contact.commit()
    with contact.copy() as trial:
        _, start = _shear(trial, pressure * area, friction * parts[:steps])
        with trial.copy() as further:
            _, rest = _shear(further, pressure * area, friction * parts[steps:])
        energy, swing = _loop(trial, pressure * area, friction * float(parts[steps - 1]), steps)
    secant = friction * parts[steps - 1] * pressure / swing
    row = pressure, closure, k[0, 0], pressure / closure, k[1, 1], k[2, 2], fraction, swing, energy / area, secant
    return row, np.array(start + rest) - pressed


def _shear(contact, normal, parts):
    """Pushes by these parts of the normal load in turn; returns the dissipated energy (J) and the displacements (m)."""
    energy, places = 0.0, []
    for part in parts:
        contact.try_step(time=0.0, load_n=normal, load_tx=normal * float(part))
        energy += contact.number("dissipated_energy")
        places.append(contact.number("disp_x"))
        contact.commit()
    return energy, places


def _loop(contact, normal, part, steps):
    """Dissipated energy (J) and amplitude of the displacement (m) of the second of two cycles of the load along x.

    The contact has been pushed to the first end of the loop.
    """
    ends, energies = [], []
    for k in range(HALVES):
        end = part if k % 2 else -part
        energy, places = _shear(contact, normal, np.linspace(-end, end, 2 * steps + 1)[1:])
        energies.append(energy)
        ends.append(places[-1])
    return sum(energies[-2:]), abs(ends[-1] - ends[-2]) / 2


def of_windows(
    separation: ArrayLike, spacing: ArrayLike, pressures: ArrayLike, *, friction: float, shear: float = 0.5,
    steps: int = 8, report: Optional[Callable[[int, int], object]] = None, **bodies: Any,
) -> Interface:  # fmt: skip
    """The Interface of a measured separation: means and standard deviations of five windows of it, half as wide.

    Four windows have the corners, one the middle. Each is mirrored, so that it repeats itself.

    Parameters
    ----------
    separation : array_like
        Separation, (ny, nx), m, of 4 x 4 points or more.
    spacing, pressures, friction, shear, steps
        As of of_interface().
    report : callable, optional
        Called with the number of the windows that are done, and of all.
    **bodies
        Options of the bodies and of the solution, as of of_interface().

    Returns
    -------
    Interface
        The means; `spread` has the standard deviations.

    Raises
    ------
    Error
        For wrong values, and for a pressure that closes the interface.
    ContactError
        Where petsam finds no solution.
    """
    separation = array("separation", separation)
    if separation.ndim != 2 or min(separation.shape) < 4:
        raise Unusable("separation: expected a field of 4 x 4 points or more")
    ny, nx = (size // 2 for size in separation.shape)
    y, x = separation.shape[0] - ny, separation.shape[1] - nx
    places = [(0, 0), (0, x), (y, 0), (y, x), (y // 2, x // 2)]
    found = []
    with _gathered() as begins:
        for k, (j, i) in enumerate(places, 1):
            window = mirrored(separation[j : j + ny, i : i + nx])
            place = lambda pressure, k=k: begins(f"{pressure} in window {k} with its mirror images")  # noqa: E731
            found.append(_of_interface(window, spacing, pressures, _Loop(friction, shear, steps), bodies, place))
            if report:
                report(len(found), len(places))
    numbers = {name: np.mean([one.numbers[name] for one in found], axis=0) for name in COMPUTED}
    spread = {name: np.std([one.numbers[name] for one in found], axis=0, ddof=1) for name in COMPUTED[1:]}
    # shears over their own stiffness: a mean of the displacements would be that of compliances, and seem to slip
    loading = np.mean([one.loading * one.numbers["k_t_x"][:, None] for one in found], axis=0)
    loading /= numbers["k_t_x"][:, None]
    return Interface(numbers, spread, friction, shear, bodies, found[0].parts, loading)


def interface(  # noqa: PLR0913  (as the options of petsam-joint stiffness)
    surface: Any, pressures: ArrayLike, *, friction: float, spacing: Optional[ArrayLike] = None,
    periodic: bool = False, shear: float = 0.5, steps: Optional[int] = None,
    report: Optional[Callable[[int, int], object]] = None, **bodies: Any,
) -> Interface:  # fmt: skip
    """The Interface of a surface: a scan in a file, a map of petsam.surface, or an array.

    Parameters
    ----------
    surface : path, petsam.surface.Map, or array_like
        Heights or a separation in a file of petsam-surface or in a map; an array (ny, nx) is the separation, m.
    pressures : array_like
        Nominal pressures, (pressures,), Pa, rising.
    friction : float
        Coefficient of friction.
    spacing : float or pair of floats, optional
        Distance of the points of an array along x and y, m; files and maps have their own.
    periodic : bool
        Whether the surface repeats itself; else five windows of it give means and standard deviations.
    shear : float
        Shear of the loop over friction times pressure, above 0 and below 1.
    steps : int, optional
        Load steps of a quarter of the loop (8).
    report : callable, optional
        Called with the number of the windows that are done, and of all.
    **bodies
        Options of the bodies, body1_young (Pa, or "210GPa"), body1_poisson, body2_young, ..., and of the solution.

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
    if isinstance(surface, (str, os.PathLike)):
        surface, own, doubts = read_separation(os.fspath(surface))
        for text in doubts:
            warnings.warn(text, AdviceWarning, stacklevel=2)
    elif hasattr(surface, "quantity"):
        own = tuple(side / n for side, n in zip(surface.size, surface.n))
        surface = surface.values if surface.quantity == "separation" else -surface.values
    else:
        own = spacing
        if spacing is None:
            raise Unusable("spacing: give the distance of the points of an array, m")
    if spacing is not None and own is not spacing:
        raise Unusable("spacing: the surface has its own: leave it out")
    moduli = {f"body{k}_young" for k in (1, 2)}
    for name, value in bodies.items():
        if name in moduli and isinstance(value, str):
            bodies[name] = words.number(value, "Young's modulus, such as 210GPa", "Pa", lambda young: young > 0.0)
    given = dict(friction=friction, shear=shear, **({} if steps is None else {"steps": steps}), **bodies)
    if periodic:
        return of_interface(surface, own, pressures, **given)
    return of_windows(surface, own, pressures, report=report, **given)

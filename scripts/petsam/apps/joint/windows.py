"""Numbers of one window of a rough interface: by the formula of Ciavarella and Jaeger, by computed loops, or without
friction.

The formula: where bodies are elastically similar, the coefficient of friction is one and the pressure P stays, the
shear under a growing T is mu times the difference of two pressures, that under P and that under P - T/mu
(M. Ciavarella, J. Mech. Phys. Solids 46 (1998) 2349; J. Jaeger, Arch. Appl. Mech. 68 (1998) 247). The displacement:

    delta_t(T) = mu int (k_n/k_t) d(delta_n), from P - T/mu to P,

with the stiffnesses k_n and k_t while all contacts stick and the approach delta_n. Where their ratio is constant, this
is mu (k_n/k_t) [delta_n(P) - delta_n(P - T/mu)]; in a window with few spots it varies by some per cent, and neglecting
that doubles the error. The loop follows by Masing's rule, W = 8 int_0^d T d(delta) - 4 T d.
"""

import contextlib
import time
import warnings
from collections.abc import Callable
from typing import Any, NamedTuple, Optional

import numpy as np

from ...closed.materials import Bodies
from ...contact.errors import AdviceWarning
from ...contact.inprocess import Contact
from ...core.errors import Unusable
from . import elements
from .arguments import need_timeless
from .conductance import Conductors

HALVES = 4  # half cycles of a loop; the last two count
LARGEST = 0.95  # shear over its limit at the end of the first loading to which elements are fitted
FINE, COARSE = 4, 2  # loads of the normal curve per octave: where loops need them, and below
EVERY = 4  # of them, for the ratio of the stiffnesses
FURTHER = 1e-3  # relative rise of the pressure by which the stiffness of further loading is a difference
NOISE = 1e-6  # slip over displacement that is rounding
CURVE = 128  # parts of the first loading over which the loop's energy is integrated
CHECKED = 3  # pressures at most at which the formula is compared with computed loops
ELASTIC = {f"body{k}_{name}" for k in "12" for name in ("young", "poisson")}
SOLVERS = {"normal_rtol", "tangential_rtol"}

NORMAL = ("pressure", "closure", "separation", "k_n", "k_n_secant", "area")
LOADING = "k_n_loading"
SHEARED = ("k_t_x", "k_t_y", "loop_amplitude", "loop_energy", "loop_stiffness")


class Loop(NamedTuple):
    """A loop of the shear: coefficient of friction, amplitude over friction times pressure, steps of a quarter."""

    friction: float
    shear: float
    steps: int

    def parts(self):
        """Shears of the first loading over friction times pressure, rising to LARGEST or to the amplitude."""
        parts = self.shear * np.arange(1, self.steps + 1) / self.steps
        if self.shear < LARGEST:
            parts = np.append(parts, np.linspace(self.shear, LARGEST, self.steps + 1)[1:])
        return parts


class Window(NamedTuple):
    """A separation that repeats itself, the distances of its points, the pressures, the loop, and options.

    Without a loop there is no friction. The name is for warnings; of the first window the time is told. With conductors
    the conductance is found, too.
    """

    separation: np.ndarray
    step: np.ndarray
    pressures: tuple
    loop: Optional[Loop]
    bodies: dict
    name: str = ""
    first: bool = False
    conductors: Optional[Conductors] = None

    @property
    def area(self) -> float:
        """Nominal area, m2."""
        return float(np.prod(self._size()))

    @property
    def sheared(self) -> Loop:
        """The loop of a window that has one."""
        if self.loop is None:
            raise Unusable("friction: a loop needs one")
        return self.loop

    def _size(self):
        return tuple(float(n * step) for n, step in zip(self.separation.shape[::-1], self.step))

    def contact(self):
        """The contact of the window, which has never been loaded."""
        contact = Contact(
            elasticity="periodic", gap_type="flat", grid_n=self.separation.shape[::-1], grid_size=self._size(),
            friction=self.loop.friction if self.loop else 0.0, **self.bodies,
        )  # fmt: skip
        need_timeless(contact)
        contact.gap = self.separation - self.separation.min()
        return contact


class Found(NamedTuple):
    """Numbers of a window, {name: (pressures,)}, displacements of the first loading (m), and warnings with places."""

    numbers: dict
    loading: np.ndarray
    warnings: list


def need_computing(bodies: dict[str, Any]) -> str:
    """Returns why the loops must be computed with these options of the bodies and of the solution, in words; empty
    where the formula holds."""
    given = {name for name, value in bodies.items() if value is not None}
    if "pressure_limit" in given:
        return "with a hardness the curve of loading is not that of unloading"
    others = sorted(given - ELASTIC - SOLVERS)
    if others:
        return f"the formula is for elastic half-spaces without the option {others[0]}"
    if given & ELASTIC != ELASTIC:
        return "the formula needs both bodies' moduli"
    two = Bodies.of(bodies)
    ratios = [(1.0 - 2.0 * nu) / g for nu, g in zip((two.poisson1, two.poisson2), two.shear_moduli)]
    if abs(ratios[0] - ratios[1]) > 1e-9 * max(ratios):
        return "the bodies are elastically dissimilar, so that pressure and shear are coupled"
    return ""


def checked(count: int) -> list[int]:
    """Places of the pressures, of so many, at which the formula is compared with computed loops."""
    return sorted({0, count // 2, count - 1})[:CHECKED]


def spread_over(values: np.ndarray, places: list[int], count: int) -> np.ndarray:
    """Errors at all of so many pressures, from those at the checked places: between two the larger one."""
    at = np.asarray(places)
    found = np.empty(count)
    for k in range(count):
        low, high = values[at <= k][-1], values[at >= k][0]
        found[k] = max(low, high)
    return found


# ---------------------------------------------------------------- ways


def normal_curve(window: Window, told: Callable[[float, float], object]) -> Found:
    """The normal numbers alone, without friction; told is called with the times (s) of the first solutions."""
    with _noted() as (found, begins), window.contact() as contact:
        rows = [_pressed(contact, window, p, told, begins)[0] for p in _telling(window)]
    return Found(_named(rows), np.empty((len(rows), 0)), found)


def by_formula(window: Window, told: Callable[[float, float], object]) -> Found:
    """All numbers by the formula: no step has a shear."""
    from scipy.interpolate import CubicSpline, PchipInterpolator

    loop, parts = window.sheared, window.sheared.parts()
    rows, approach, ratio = [], {}, {}
    with _noted() as (found, begins), window.contact() as contact:
        for pressure in _telling(window):
            row, k_t = _pressed(contact, window, pressure, told, begins)
            rows.append({**row, "k_t_x": k_t[0], "k_t_y": k_t[1]})
            approach[pressure[0]], ratio[pressure[0]] = row["closure"], row["k_n"] / k_t[0]
        with _quiet():
            for m, load in enumerate(reversed(loads(window.pressures, loop.shear, parts[-1]))):
                approach[load] = contact.try_step(time=0.0, load_n=load * window.area).disp_z
                if m % EVERY == EVERY - 1:
                    k = contact.stiffness(reversal=True)
                    ratio[load] = k[0, 0] / k[1, 1]
                contact.commit()
        lowest = min(approach)
        if lowest not in ratio:
            with _quiet():
                k = contact.stiffness(reversal=True)
            ratio[lowest] = k[0, 0] / k[1, 1]
    curve, factor = (
        kind(*np.transpose(sorted(values.items())))
        for kind, values in ((CubicSpline, approach), (PchipInterpolator, ratio))
    )
    loading = [_sheared(row, curve, factor, loop, parts) for row in rows]
    return Found(_named(rows), np.array(loading), found)


def by_loops(window: Window, told: Callable[[float, float], object]) -> Found:
    """All numbers, by load steps of the shear: a first loading, and a loop."""
    rows, loading = [], []
    with _noted() as (found, begins), window.contact() as contact:
        for pressure in _telling(window):
            row, k_t = _pressed(contact, window, pressure, told, begins)
            pushed, first = _cycled(contact, pressure[0], window)
            rows.append({**row, "k_t_x": k_t[0], "k_t_y": k_t[1], **pushed})
            loading.append(first)
    return Found(_named(rows), np.array(loading), found)


def check(window: Window, _: Callable[[float, float], object]) -> Found:
    """The loop alone, computed at the first pressure: one cycle, as that of similar bodies is closed."""
    pressure, loop = window.pressures[0], window.sheared
    with _noted() as (found, begins), window.contact() as contact:
        begins(f"{pressure:.6g} Pa{window.name}")
        normal = pressure * window.area
        contact.try_step(time=0.0, load_n=normal)
        contact.commit()
        _push(contact, normal, loop.friction * loop.parts()[: loop.steps])
        numbers = _loop(contact, normal, window, halves=2)
    return Found({name: np.array([value]) for name, value in numbers.items()}, np.empty((1, 0)), found)


def loads(pressures: tuple, shear: float, largest: float) -> list[float]:
    """Returns pressures of the normal curve beside the given ones, which rise, so that none is far from the next.
    `shear` and `largest`: parts by which loops, and the first loading for elements, go below a pressure."""
    fixed = sorted({pressures[0] * (1.0 - largest), pressures[0] * (1.0 - shear), *pressures})
    found = set(fixed)
    for low, high in zip(fixed, fixed[1:]):
        rate = FINE if low >= pressures[0] * (1.0 - shear) else COARSE
        count = max(1, int(np.ceil(np.log2(high / low) * rate - 1e-9)))
        found |= {float(p) for p in np.geomspace(low, high, count + 1)[1:-1]}
    return sorted(found - set(pressures))


# ---------------------------------------------------------------- parts of them


def _telling(window):
    """The pressures, each with whether the times of its solutions are told."""
    return [(pressure, window.first and not k) for k, pressure in enumerate(window.pressures)]


def _named(rows):
    return {name: np.array([row[name] for row in rows]) for name in rows[0]}


@contextlib.contextmanager
def _noted():
    """Collects warnings as (place, text, kind); gives their list and a function that names the place of the next."""
    found, places = [], [(0, "the start")]
    with warnings.catch_warnings(record=True) as raw:
        warnings.simplefilter("always", AdviceWarning)
        yield found, lambda place: places.append((len(raw), place))
    for k, one in enumerate(raw):
        place = [place for before, place in places if before <= k][-1]
        found.append((place, str(one.message), one.category))


@contextlib.contextmanager
def _quiet():
    """Without the advice on solutions that are not in the table."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AdviceWarning)
        yield


def _pressed(contact, window, pressure, told, begins):
    """Loads the contact and commits: the normal numbers, and k_t along x and y."""
    pressure, tell = pressure
    begins(f"{pressure:.6g} Pa{window.name}")
    start = time.perf_counter()
    step = contact.try_step(time=pressure, load_n=pressure * window.area)
    solved = time.perf_counter()
    if step.contact_cells == contact.n[0] * contact.n[1]:
        raise Unusable(
            f"pressures: {pressure:.6g} Pa: all of the surface touches, and its stiffness is infinite: give less, or "
            "check the units of heights and moduli"
        )
    k = contact.stiffness(reversal=True) / window.area
    separation = float(np.mean(contact.field("gap")))
    contact.commit()
    numbers = pressure, step.disp_z, separation, k[0, 0], pressure / step.disp_z, step.contact_fraction
    row = dict(zip(NORMAL, map(float, numbers)))
    if window.conductors:
        row.update(window.conductors.measure(contact))
    if tell:
        told(solved - start, time.perf_counter() - solved)
    if window.bodies.get("pressure_limit") is not None:
        with _quiet():
            further = contact.try_step(time=pressure, load_n=pressure * (1.0 + FURTHER) * window.area).disp_z
        contact.reject()
        row[LOADING] = pressure * FURTHER / (further - step.disp_z)
    return row, (float(k[1, 1]), float(k[2, 2]))


def _sheared(row, curve, factor, loop, parts):
    """Adds the loop to a row, by the formula; returns the displacements of the first loading, m."""
    pressure, limit = row["pressure"], loop.friction * row["pressure"]
    unit = limit / row["k_t_x"]  # displacement at the limit, if all contacts stuck

    def first_loading(largest):
        """Shears over their limit up to this one, and displacements beyond those of sticking contacts over unit."""
        x = np.linspace(0.0, largest, CURVE + 1)
        less = pressure * (1.0 - x)
        pushed = -np.diff(curve(less)) * factor((less[1:] + less[:-1]) / 2.0)
        pushed = loop.friction / unit * np.append(0.0, np.cumsum(pushed))
        return x, np.maximum.accumulate(np.where(pushed - x > NOISE * pushed, pushed - x, 0.0))

    x, slip = first_loading(loop.shear)
    swing = float(loop.shear + slip[-1]) * unit
    row["loop_amplitude"] = swing
    row["loop_energy"] = float(elements.masing(x, slip)[-1]) * limit * unit
    row["loop_stiffness"] = limit * loop.shear / swing
    return (parts + np.interp(parts, *first_loading(parts[-1]))) * unit


def _cycled(contact, pressure, window):
    """The numbers of a computed loop at the committed pressure, and the displacements of the first loading, m."""
    friction, _, steps = window.sheared
    parts, normal = friction * window.sheared.parts(), pressure * window.area
    with contact.copy() as trial:
        pressed = trial.number("disp_x")  # N alone moves dissimilar bodies
        _, start = _push(trial, normal, parts[:steps])
        with trial.copy() as further:
            _, rest = _push(further, normal, parts[steps:])
        found = _loop(trial, normal, window)
    return found, np.array(start + rest) - pressed


def _push(contact, normal, parts):
    """Pushes by these parts of the normal load in turn; returns the dissipated energy (J) and the displacements (m)."""
    energy, places = 0.0, []
    for part in parts:
        contact.try_step(time=0.0, load_n=normal, load_tx=normal * float(part))
        energy += contact.number("dissipated_energy")
        places.append(contact.number("disp_x"))
        contact.commit()
    return energy, places


def _loop(contact, normal, window, halves=HALVES):
    """Numbers of the last cycle of the load along x, of a contact that has been pushed to the first end of the loop."""
    loop, ends, energies = window.sheared, [], []
    part, steps = loop.friction * loop.shear, loop.steps
    for k in range(halves):
        end = part if k % 2 else -part
        energy, places = _push(contact, normal, np.linspace(-end, end, 2 * steps + 1)[1:])
        energies.append(energy)
        ends.append(places[-1])
    swing, area = abs(ends[-1] - ends[-2]) / 2, window.area
    return dict(
        loop_amplitude=swing, loop_energy=sum(energies[-2:]) / area, loop_stiffness=part * normal / area / swing
    )

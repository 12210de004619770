"""How the numbers of an interface are found: keywords of its functions, windows among processes, errors."""

from __future__ import annotations

import dataclasses
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Optional

import numpy as np

from ...core import processes
from ...core.environment import cores as all_cores
from ...core.errors import Unusable
from . import windows
from .arguments import integer, real
from .windows import Loop

Estimate = Callable[[float], object]
Report = Callable[[int, int], object]
STEPS = 8  # of a quarter of a loop
SMALL = 100_000  # points of all windows below which starting processes takes longer than the solution
# for the estimate of time: later solutions over the first one, a step of the shear over a solution without one
LATER, PUSHED = 1.2, 1.5
ERRORS = {  # of the formula: the column of properties.COLUMNS, and its text
    "loop_energy": "relative error of loop_energy by the formula",
    "loop_stiffness": "relative error of loop_stiffness by the formula",
}


@dataclass(frozen=True)
class Ways:
    """The choice of the numbers of an interface, and of the way to compute them.

    Parameters
    ----------
    friction : float, optional
        Coefficient of friction; not with normal_only.
    shear : float
        Amplitude of the mean shear of the loop over friction times pressure, above 0 and below 1.
    steps : int, optional
        Load steps of a quarter of a computed loop (8).
    full : bool
        Compute all loops; False: by a formula, which one window checks at up to three pressures. It holds for
        elastically similar half-spaces; for other bodies, and with other options, all loops are computed.
    normal_only : bool
        Normal numbers alone, without friction: pressure, closure, separation, k_n, k_n_secant, area.
    cores : int or None
        Processes among which the windows are divided; None: as many as cores are available. The numbers do not depend
        on it.
    estimate : callable, optional
        Called once, after the first pressure of the first window, with an estimate of the time that is left, s.
    """

    friction: Optional[float] = None
    shear: float = 0.5
    steps: Optional[int] = None
    full: bool = False
    normal_only: bool = False
    cores: Optional[int] = 1
    estimate: Optional[Estimate] = None

    def checked(self) -> Ways:
        """The same with numbers as such; Error for values that are wrong or do not go together."""
        cores = None if self.cores is None else integer("cores", self.cores)
        if self.normal_only:
            for name, given in (("friction", self.friction is not None), ("full", self.full)):
                if given:
                    raise Unusable(f"{name}: is for loops, which normal_only leaves out: give one of both")
            return dataclasses.replace(self, cores=cores)
        if self.friction is None:
            raise Unusable("friction: give a coefficient, or normal_only")
        steps = STEPS if self.steps is None else integer("steps", self.steps)
        what = "a coefficient > 0, without which nothing resists a shear"
        friction = real("friction", self.friction, what, lambda one: 0.0 < one < np.inf)
        what = "a part of friction times pressure, above 0 and below 1"
        shear = real("shear", self.shear, what, lambda part: 0.0 < part < 1.0)
        return dataclasses.replace(self, friction=friction, shear=shear, steps=steps, cores=cores)

    def loop(self) -> Optional[Loop]:
        """The loop of checked ways; None without friction."""
        if self.friction is None or self.steps is None:
            return None
        return Loop(self.friction, self.shear, self.steps)

    def reason(self, bodies: dict[str, Any]) -> str:
        """Why all loops of these bodies are computed, in words; empty where none is, or by the formula."""
        if self.normal_only:
            return ""
        return windows.need_computing(bodies) or ("as requested" if self.full else "")


def errors(first, checks, way, reason, pressures):
    """Relative errors of the formula at all pressures, and how the loops were found, in words."""
    if way.normal_only:
        return {}, ""
    if reason:
        return {}, f"all loops are computed: {reason}"
    places, found = windows.checked(len(pressures)), {}
    for name in ERRORS:
        ours = first.numbers[name][places]
        right = np.array([one.numbers[name][0] for one in checks])
        with np.errstate(divide="ignore", invalid="ignore"):
            error = np.where(ours == right, 0.0, np.abs(ours / right - 1.0))
        found[name] = windows.spread_over(np.where(right > 0.0, error, 0.0), places, len(pressures))
    where = ", ".join(f"{pressures[k] / 1e6:.4g}" for k in places)
    return found, f"loops by a formula; largest difference from those computed in one window at {where} MPa"


def computed(parts, way, reason, report=None):
    """Outcome of the windows, and after them of the loops that check the formula."""
    one = windows.normal_curve if way.normal_only else windows.by_loops if reason else windows.by_formula
    jobs = [(one, part) for part in parts]
    if one is windows.by_formula:
        # the check of the largest pressure takes longest and begins first, but for the window that tells the time
        places = windows.checked(len(parts[0].pressures))
        checks = [
            (windows.check, parts[0]._replace(pressures=parts[0].pressures[k : k + 1], first=False)) for k in places
        ]
        order = [0, *range(len(parts) + len(places) - 1, len(parts) - 1, -1), *range(1, len(parts))]
    else:
        checks, order = [], list(range(len(parts)))
    jobs += checks
    cores = all_cores() if way.cores is None else way.cores
    if way.cores is None and sum(part.separation.size for part in parts) < SMALL:
        cores = 1
    start, ended = time.monotonic(), []

    def told(solved, stiff):
        if way.estimate:
            total = _units(parts, reason, checks, solved, stiff) / min(cores, len(jobs))
            way.estimate(max(total - (time.monotonic() - start), 0.0))

    def done(k):
        if order[k] < len(parts):
            ended.append(k)
            if report:
                report(len(ended), len(parts))

    found = processes.run([jobs[k] for k in order], cores, told, done)
    return [found[order.index(k)] for k in range(len(jobs))]


def _units(parts, reason, checks, solved, stiff):
    """Estimate of the time of all windows in one process, s, from the times of a solution and of its stiffness."""
    loop, pressures = parts[0].loop, parts[0].pressures
    one = len(pressures) * (LATER * solved + stiff)
    if reason:
        one += len(pressures) * (2 * windows.HALVES + 2) * loop.steps * PUSHED * LATER * solved
    elif loop:
        one += len(windows.loads(pressures, loop.shear, loop.parts()[-1])) * (LATER * solved + stiff / windows.EVERY)
    check = (len(checks) * 5 * loop.steps * PUSHED * LATER * solved) if checks else 0.0
    return len(parts) * one + check

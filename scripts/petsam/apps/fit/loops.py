"""The fit of measured loops: friction and the rig's compliance, their ranges, and whether the loops hold them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Union

import numpy as np

from ...core.errors import Error, Unusable, short, there_are
from . import least
from .loop import Fit, Loop
from .problem import SHARED, Problem
from .push import Push

# of the friction, from which it begins again where the best loops just slide, or just do not
NEARBY = (0.94, 1.06, 1.15)
LOSS = (0.0, 0.005)  # of a rig, if nothing is stated, and its standard deviation: clamped joints, load cells, lags
LOADS = 0.5  # deviation of a factor of the scale at each of several loads, over that of the scale; bends: BENDS times
SHAPE = 0.05  # standard deviation of the scale, if nothing is stated: 15 % of a ball's radius, or 8 % of its load
LARGE = 3.0  # root mean square of the residuals, in units of the noise, beyond which the model does not hold
DOUBTFUL = 0.03  # relative deviation of the friction above which its range is that of its profile
VAGUE = 0.1  # and above which it is called not identifiable where no profile is made
UNBOUNDED = 5.0  # friction beyond this multiple of the best one is not excluded by the loops: no upper bound
WEAK = 0.5  # width of the range, relative to the friction, from which on it is weakly known


def _neighbours(problem, residuals):
    """Correlation of neighbouring residuals within the loops."""
    return least.neighbours(np.split(residuals, np.cumsum([len(loop.force) for loop in problem.loops]))[:-1])


def _profile(problem, best, variance):
    """The range of the friction, 95 %: where the sum of squares, all else free, grows by 4 times the variance; and how
    far the other shared parameters are within it from the best ones."""
    limit = best.deviance + 4.0 * variance
    friction = best.x[0]
    free = [name for name in problem.free if name != "friction"]

    def cost(value, start):
        one = Problem(problem.loops, problem.pushes, free, {**problem.fixed, "friction": value})
        one.spread = problem.spread
        found = one.solve([start, one.start(min(0.999, problem.least() / value))])
        return found.deviance, found.x

    ends, others = [], [best.x[1:]]
    for factor in (0.8, 1.25):
        inside, start, value = friction, best.x[1:], friction
        while True:
            value = value * factor
            if not friction / (4 * UNBOUNDED) < value < UNBOUNDED * friction * 1.01:
                ends.append(0.0 if factor < 1.0 else np.inf)
                break
            now, start = cost(value, start)
            if now > limit:
                for _ in range(12):  # halves the interval between a friction within the range and one outside of it
                    middle = np.sqrt(inside * value)
                    now, start = cost(middle, start)
                    inside, value = (inside, middle) if now > limit else (middle, value)
                ends.append(float(np.sqrt(inside * value)))
                others.append(start)
                break
            inside = value
            others.append(start)
    far = np.max(np.abs(np.array(others) - best.x[1:]), axis=0)
    return tuple(ends), dict(zip(free, far[: len(free)]))


def _solved(problem):
    """The best parameters, the mean square of the loops' residuals over that of the noise, and the variance of one."""
    count = sum(len(loop.force) for loop in problem.loops)
    best = problem.solve()
    if problem.free[:1] == ["friction"] and problem.turning(best.x):  # each side of the kink has a least of its own
        nearby = [np.concatenate([[factor * best.x[0]], best.x[1:]]) for factor in NEARBY]
        best = min(best, problem.solve(nearby), key=lambda one: one.deviance)
    if count < 3 * len(best.x):
        raise Error(f"{count} points: a fit of {len(best.x)} parameters needs {3 * len(best.x)}")
    for again in (bool(problem.known), False):
        expected = problem.expected(best.x)
        square = float(np.sum(best.fun[:count] ** 2)) / (count - len(best.x)) / expected
        variance = max(square, 0.25 if expected > 0.99 else 1.0)  # without noise the errors are those of the model
        if again and abs(np.sqrt(variance) - 1.0) > 0.1:  # what is known beforehand does not grow with the residuals
            problem.spread = float(np.sqrt(variance))
            best = problem.solve([best.x])
    return best, square, variance


def need_parameters(free: Sequence[str], fixed: Mapping[str, Any]) -> None:
    """Raises Unusable for names that are no parameters of a loop, and for values that are no numbers."""
    if isinstance(free, str):
        raise Unusable(f"free {short(repr(free))}: expected a list of names: give [{short(repr(free))}]")
    known = (*SHARED, "loads")
    for name in (*free, *fixed):
        if name not in known:
            raise Unusable(f"{short(str(name))}: is no parameter of a loop{there_are(name, known)}")
    for name, value in fixed.items():
        numbers = value if isinstance(value, tuple) else (value,)
        if not all(one is None or isinstance(one, (int, float, np.number)) for one in numbers) or len(numbers) > 2:
            raise Unusable(f"{name} {short(repr(value))}: expected a number, or (number, standard deviation)")


def fit(
    loops: Sequence[Loop],
    push: Union[Push, Sequence[Push]],
    free: Sequence[str] = (),
    profile: bool = True,
    **fixed: Any,
) -> Fit:
    """Fits friction and the rig's compliance to one or several closed loops.

    Parameters
    ----------
    loops : sequence of Loop
        With common friction and rig.
    push : Push or sequence of Push
        That of each loop, or of all.
    free : sequence of str
        Parameters that are found besides friction and compliance: "lean", "loss", "scale", "bend".
    profile : bool
        False: no range by the profile, which takes most of the time; a friction with a deviation above VAGUE is then
        called not identifiable.
    **fixed
        What is given: compliance (m/N), lean (N/m), loss, scale, bend; a value, or (value, standard deviation) of one
        that is found within what is known of it. loads: standard deviation of a factor of the scale that each of
        several normal loads has for itself; BENDS times of what is added to the bend.

    Returns
    -------
    Fit

    Raises
    ------
    Error
        If the loops have fewer points than the fit needs.
    """
    need_parameters(free, fixed)
    pushes = [push] * len(loops) if isinstance(push, Push) else list(push)
    names = [name for name in SHARED if name in ("friction", "compliance", *free) and name not in fixed]
    names += [name for name, value in fixed.items() if isinstance(value, tuple)]
    problem = Problem(list(loops), pushes, names, fixed)
    best, square, variance = _solved(problem)
    jacobian = best.jac / np.sqrt(variance)
    deviation, correlation = least.bands(jacobian)
    of, sd = problem.shared(best.x), dict(zip(problem.free, deviation))
    neighbours = _neighbours(problem, best.fun)
    friction, friction_sd = of["friction"], float(sd["friction"])
    ends, state, at_least = (friction - 2 * friction_sd, friction + 2 * friction_sd), "known", np.nan
    if least.correlated(neighbours, np.sqrt(square)) or square > LARGE**2:
        state = "rejected"
    elif not friction_sd <= (DOUBTFUL if profile else VAGUE) * friction or profile and problem.turning(best.x):
        ends, far = _profile(problem, best, variance) if profile else ((problem.least(), np.inf), {})
        rest = least.bands(jacobian[:, 1:]).sd
        sd |= {name: max(sd[name], np.hypot(own, 0.5 * far[name])) for name, own in zip(far, rest)}
        if np.isinf(ends[1]):
            state, at_least = "not identifiable", max(ends[0], problem.least() * 0.999)
        else:
            state = "weak" if ends[1] - ends[0] > WEAK * friction else "known"
            friction_sd = max(friction_sd, *(0.5 * abs(end - friction) for end in ends))
    at_ends = problem.ends(best.x)
    if state == "not identifiable":  # a friction without an upper bound may be at the largest
        at_ends = tuple(name for name in at_ends if name != "friction")
    if at_ends:
        state, at_least = "rejected", np.nan
    verdict = dict(friction_sd=friction_sd, ends=at_ends, friction_at_least=at_least, friction_range=ends, state=state)
    beside = {name: float(correlation[0, k]) for k, name in enumerate(problem.free) if k}
    return _result(problem, best.x, sd, dict(verdict, neighbours=neighbours, correlation=beside))


def _result(problem, values, sd, verdict):
    of, state = problem.shared(values), verdict["state"]
    friction, held = of["friction"], state in ("known", "weak")
    amplitudes, gross, curves, squares = [], [], [], 0.0
    for k, loop in enumerate(problem.loops):
        sheared, stroke = problem.amplitude(values, k)
        amplitudes.append(sheared)
        gross.append(stroke > 1.0)
        force, _ = problem.curve(values, k)
        squares += float(np.sum((loop.force - force) ** 2))
        curves.append(_curve(problem, values, k))
    largest = int(np.argmax(amplitudes))
    noise = tuple(float(np.median(one)) for one in zip(*problem.noise))
    verdict["friction_sd"] = verdict["friction_sd"] if held else np.nan
    return Fit(
        friction=friction if held else np.nan,
        **verdict,
        compliance=of["compliance"] if state != "rejected" else np.nan,
        compliance_sd=float(sd.get("compliance", 0.0)) if state != "rejected" else np.nan,
        sliding=amplitudes[largest],
        gross=bool(gross[largest]),
        misfit=float(np.sqrt(squares / sum(len(loop.force) for loop in problem.loops))),
        noise=noise,
        more={name: (of[name], float(sd[name])) for name in problem.free if name not in ("friction", "compliance")},
        loops=tuple(problem.loops),
        curves=tuple(curves),
    )


def _curve(problem, values, k, points=200):
    """Displacement and force of the closed loop of the fit, for pictures."""
    _, top, bottom = values[len(problem.free) + 3 * k :][:3]
    way = np.linspace(0.0, np.pi, points)
    d = 0.5 * (top + bottom) + 0.5 * (top - bottom) * np.cos(np.concatenate([way, way + np.pi]))
    rising = np.repeat([False, True], points)
    return d, problem.curve(values, k, d, rising)[0]


def jacobian_of(loops: Sequence[Loop], push: Push, free: Sequence[str], values: dict, noise: Sequence) -> np.ndarray:
    """Derivatives of the residuals of loops without noise, in units of the noise (displacement and force of each loop,
    m and N), (points of all loops, parameters), at given values: by friction, compliance and the free parameters, and
    by force, largest and smallest displacement of each loop. All but the friction are scaled."""
    problem = Problem(list(loops), [push] * len(loops), ("friction", "compliance", *free), {})
    problem.noise = list(noise)
    own = [value for loop in loops for value in (0.0, loop.displacement.max(), loop.displacement.min())]
    at = np.array([*(values[name] for name in problem.free), *own])
    scales = problem.scales()
    scales[0] = 1.0
    weights, columns = problem.weights(at), []
    for k, scale in enumerate(scales):
        step = np.zeros_like(at)
        step[k] = 1e-4 * (scale if k else values["friction"])
        change = problem.residuals(at + step, weights) - problem.residuals(at - step, weights)
        columns.append(change / (2.0 * step[k] / scale))
    return np.array(columns).T

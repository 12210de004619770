"""The model of a measured loop, and its fit: friction and the rig's compliance.

Displacement D of the drive or of a sensor, force Q, constant normal load N. Contact and rig are in series, the rig
of compliance c: D = mu f(Q/mu) + c Q, with f the displacement of one push at a coefficient of friction of 1 (push.py);
beyond D_g = mu f(N) + c mu N it slides at mu N. With this backbone Q = F(D) a closed loop follows by Masing's rule:

    falling  Q = Q0 + Qa - 2 F((Dmax - D)/2)    rising  Q = Q0 - Qa + 2 F((D - Dmin)/2)    Qa = F((Dmax - Dmin)/2)

also in gross slip. A guide beside the contact adds k_p (D - Dmid), the lean; a loss of the rig a thin ellipse of force,
a part of Qa high, negative of a force that lags behind the displacement. Dmax and Dmin are found, not read off, since
the largest of noisy points is too large. Residuals are those of Q at the measured D, weighted by the noise of Q and,
times the slope, of D. What is known of a parameter beforehand, a value p0 and its standard deviation s, is one more
residual, (p - p0)/s: least squares then find the most likely parameters given both (Bayes, normal errors), and the
covariance is that of both, v (J'J + v I/s^2)^-1 with v the variance of the loops' residuals.

Jaeger, J., Z. angew. Math. Mech. 75 (1995) 1; Masing, G., Proc. 2nd Int. Congr. Appl. Mech. (1926) 332.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Optional

import numpy as np

from ...core.errors import Error, Unusable, short, there_are
from . import least
from .backbone import Backbone, derivatives, force_of, plain_force
from .push import Push

# parameters that all loops of a fit have in common
SHARED = ("friction", "compliance", "lean", "loss", "scale", "bend")
OWN = ("offset", "top", "bottom")  # those of each: force, largest and smallest displacement
STARTS = (0.999, 0.7, 0.3)  # parts of sliding from which the fit begins: from one it may end where all sticks or slides
# of the friction, from which it begins again where the best loops just slide, or just do not
NEARBY = (0.94, 1.06, 1.15)
PASSES = 3  # of a fit, each with the weights of the one before
LOSING = 0.2  # the most loss that is looked for: more would be a loop of its own
LEAST, MOST = 1e-4, 30.0  # coefficients of friction
LOWEST = {"friction": LEAST, "compliance": 0.0, "loss": -LOSING, "scale": 0.05, "bend": -0.9}
HIGHEST = {"friction": MOST, "loss": LOSING}
END = 1e-3  # distance from such an end, over the scale, within which a parameter is at it
TRIALS = 30  # steps of a pass at most: the next pass goes on, and a start that leads nowhere costs little
FLOOR = 2e-4  # least noise, relative to the range: that of a record of 12 bits
LOSS = (0.0, 0.005)  # of a rig, if nothing is stated, and its standard deviation: clamped joints, load cells, lags
BENDS = 2.0  # deviation of the bend over that of the scale, if nothing is stated
LOADS = 0.5  # deviation of a factor of the scale at each of several loads, over that of the scale; bends: BENDS times
SHAPE = 0.05  # standard deviation of the scale, if nothing is stated: 15 % of a ball's radius, or 8 % of its load
CORRELATED = 0.3  # correlation of neighbouring residuals above which the model does not hold
MISFIT = 1.2  # and root mean square of the residuals, in units of the noise, below which it does not matter
LARGE = 3.0  # root mean square of the residuals, in units of the noise, beyond which the model does not hold
DOUBTFUL = 0.03  # relative deviation of the friction above which its range is that of its profile
TURNING = (0.9, 1.05)  # and so where loops just slide or just do not: shear over mu N, stroke over that of sliding
VAGUE = 0.1  # and above which it is called not identifiable where no profile is made
UNBOUNDED = 5.0  # friction beyond this multiple of the best one is not excluded by the loops: no upper bound
DEAF = 0.3  # of what is known beforehand: the least deviation in which it is measured how far loops pull it
WEAK = 0.5  # width of the range, relative to the friction, from which on it is weakly known


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


class _Problem:
    """The least squares of several loops: parameters, scales and residuals."""

    def __init__(self, loops, pushes, free, fixed):
        self.loops, self.pushes = loops, pushes
        self.free = [name for name in SHARED if name in free]
        self.fixed = dict(friction=np.nan, compliance=0.0, lean=0.0, loss=0.0, scale=1.0, bend=0.0) | dict(fixed)
        self.known = {name: self.fixed[name] for name in self.free if isinstance(self.fixed[name], tuple)}
        self.loads = sorted({push.normal for push in pushes})
        if self.fixed.get("loads") and len(self.loads) > 1:  # the shape's errors are not the same at each load
            for name, part in (("scale", 1.0), ("bend", BENDS)):
                self.known |= {f"{name}{j}": (0.0, part * self.fixed["loads"]) for j in range(len(self.loads))}
            self.free += [name for name in self.known if name not in self.free]
        self.spread = 1.0  # of the residuals, in units of the noise, in which what is known beforehand is weighed
        self.noise = [loop.noise() for loop in loops]
        self.amplitudes = [(0.5 * np.ptp(one.displacement), 0.5 * np.ptp(one.force)) for one in loops]

    def amplitude(self, values, k):
        """Shear amplitude over mu N and stroke over that of sliding, of loop k."""
        _, top, bottom = values[len(self.free) + 3 * k :][:3]
        backbone, half = self._backbone(values, k), 0.5 * (top - bottom)
        return float(backbone(half) / backbone.force[-1]), float(half / backbone.displacement[-1])

    def turning(self, values):
        """True if the loops nearest to sliding are about at its beginning, where friction bends all else."""
        sheared, stroke = map(max, zip(*(self.amplitude(values, k) for k in range(len(self.loops)))))
        return sheared > TURNING[0] and stroke < TURNING[1]

    def scales(self):
        """The scales of the parameters' changes."""
        d, q = map(max, zip(*self.amplitudes))
        shared = dict(friction=0.1, compliance=0.1 * d / q, lean=0.1 * q / d, loss=0.01, scale=0.1, bend=0.1)
        own = [value for d, q in self.amplitudes for value in (0.05 * q, 0.05 * d, 0.05 * d)]
        return np.array([*(shared.get(name, 0.05) for name in self.free), *own])

    def bounds(self):
        count = 3 * len(self.loops)
        return (
            np.array([*(LOWEST.get(name, -np.inf) for name in self.free), *[-np.inf] * count]),
            np.array([*(HIGHEST.get(name, np.inf) for name in self.free), *[np.inf] * count]),
        )

    def ends(self, values):
        """Names of the parameters at an end of their range; of a compliance of 0 the stiffness has a lower bound."""
        low, high = self.bounds()
        near = np.minimum(values - low, high - values) < END * self.scales()
        return tuple(name for name, at in zip(self.free, near) if at and name != "compliance")

    def start(self, sliding):
        """Parameters from which a fit begins: this part of sliding in the loop that is nearest to it."""
        most = max(q / push.normal for (_, q), push in zip(self.amplitudes, self.pushes))
        friction = float(np.clip(most / sliding, 2 * LEAST, 0.5 * MOST))
        friction = self.fixed["friction"] if "friction" not in self.free else friction
        loop, push, (d, q) = max(
            zip(self.loops, self.pushes, self.amplitudes), key=lambda one: one[2][1] / one[1].normal
        )
        own = friction * np.interp(min(q / friction, push.normal), push.force, push.displacement)
        steep = self._steep(loop) - push.displacement[1] / push.force[1]
        compliance = max(steep if sliding > 0.99 else (d - own) / q, 1e-3 * d / q)
        values = dict(friction=friction, compliance=compliance, lean=0.0, loss=0.0, scale=1.0, bend=0.0)
        values |= {name: value for name, (value, _) in self.known.items()}
        found = [values[name] for name in self.free]
        for one in self.loops:
            found += [
                0.5 * (one.force.max() + one.force.min()), one.displacement.max(), one.displacement.min(),
            ]  # fmt: skip
        return np.array(found)

    def least(self):
        """The least friction that bears the loops' force."""
        return max(q / push.normal for (_, q), push in zip(self.amplitudes, self.pushes))

    @staticmethod
    def _steep(loop):
        """Compliance of the steep part after a reversal, m/N: from a quarter of the change of the force."""
        top, bottom = loop.force.max(), loop.force.min()
        falling = ~loop.rising & (loop.force > top - 0.35 * (top - bottom)) & (loop.force < top - 0.05 * (top - bottom))
        if falling.sum() < 3:
            return 0.5 * np.ptp(loop.displacement) / np.ptp(loop.force)
        return float(np.polyfit(loop.force[falling], loop.displacement[falling], 1)[0])

    def shared(self, values):
        """{name: value} of the shared parameters."""
        return {**self.fixed, **dict(zip(self.free, values))}

    def curve(self, values, k, displacement=None, rising=None):
        """Force and slope of loop k."""
        d = self.loops[k].displacement if displacement is None else displacement
        up = self.loops[k].rising if rising is None else rising
        return force_of(self._backbone(values, k), d, up, *self._beside(values, k))

    def _backbone(self, values, k):
        of, load = self.shared(values), self.loads.index(self.pushes[k].normal)
        scale, bend = of["scale"] * (1.0 + of.get(f"scale{load}", 0.0)), of["bend"] + of.get(f"bend{load}", 0.0)
        return Backbone(self.pushes[k], of["friction"], of["compliance"], scale, bend)

    def _beside(self, values, k):
        """Parameters of loop k beside its backbone: its own, lean, loss."""
        of = self.shared(values)
        return values[len(self.free) + 3 * k :][:3], of["lean"], of["loss"]

    def weights(self, values):
        """One over the noise of each point's force, with that of its displacement. They stay as they are while a fit
        runs: else it would gain by steeper slopes."""
        slopes = [self.curve(values, k)[1] for k in range(len(self.loops))]
        return [1.0 / np.sqrt(sd_q**2 + (slope * sd_d) ** 2) for slope, (sd_d, sd_q) in zip(slopes, self.noise)]

    def expected(self, values):
        """Mean square of the residuals that noise leaves, in units of the weights: 1, or less where the displacement is
        smooth."""
        total, count = 0.0, 0
        for k, (loop, (sd_d, sd_q)) in enumerate(zip(self.loops, self.noise)):
            slope = self.curve(values, k)[1]
            left = loop.given[2] if loop.given else sd_d
            total += float(np.sum((sd_q**2 + (slope * left) ** 2) / (sd_q**2 + (slope * sd_d) ** 2)))
            count += len(slope)
        return total / count

    def residuals(self, values, weights):
        """Residuals of all loops in units of the noise, and behind them those of what is known beforehand."""
        parts, of = [], self.shared(values)
        for k, (loop, weight) in enumerate(zip(self.loops, weights)):
            force = plain_force(self._backbone(values, k), loop.displacement, loop.rising, *self._beside(values, k))
            parts.append(weight * (loop.force - force))
        known = [self.spread * (of[name] - value) / deviation for name, (value, deviation) in self.known.items()]
        return np.concatenate([*parts, known])

    def deviance(self, residuals, weights):
        """Sum of squares that is comparable between fits whose weights differ.

        Steep slopes have small weights, since the noise of the displacement counts for the bands. Where the values of
        the displacement are smooth the residuals have none of it, and the plain sum favours loops that do not slide,
        right or wrong: the least it can be in the mean, with noise of the force alone, is the sum of y = sd_q^2 w^2 of
        the weights w. That is subtracted, as far as the displacement is smooth. Of noisy displacements the plain sum is
        taken: the likelihood, sum - log(y), held the friction just below sliding less often.
        """
        less = 0.0
        for loop, weight, (sd_d, sd_q) in zip(self.loops, weights, self.noise):
            smooth = 1.0 - (loop.given[2] / sd_d) ** 2 if loop.given else 0.0
            less += smooth * float(np.sum((sd_q * weight) ** 2))
        return float(np.sum(residuals**2)) - self.spread**2 * less

    def jacobian(self, values, weights):
        """Derivatives of the residuals by the parameters."""
        shared, ends = len(self.free), np.cumsum([0, *(len(loop.force) for loop in self.loops)])
        found = np.zeros((ends[-1] + len(self.known), len(values)))
        for k, (loop, weight) in enumerate(zip(self.loops, weights)):
            rows = slice(ends[k], ends[k + 1])
            backbone, beside = self._backbone(values, k), self._beside(values, k)
            by, own = derivatives(backbone, loop.displacement, loop.rising, *beside)
            by = self._by_loads(values, k, by)
            for column, name in enumerate(self.free):
                found[rows, column] = -weight * by.get(name, 0.0)
            found[rows, shared + 3 * k : shared + 3 * k + 3] = -weight[:, None] * own
        for row, (name, (_, deviation)) in enumerate(self.known.items(), ends[-1]):
            found[row, self.free.index(name)] = self.spread / deviation
        return found

    def _by_loads(self, values, k, by):
        """Derivatives of loop k, {name: (n,)}, with those by the factors of its load."""
        of, load = self.shared(values), self.loads.index(self.pushes[k].normal)
        own = of.get(f"scale{load}", 0.0)
        more = {f"scale{load}": of["scale"] * by["scale"], f"bend{load}": by["bend"]}
        return {**by, "scale": (1.0 + own) * by["scale"], **more}

    def solve(self, starts=None):
        """The best parameters, their residuals' sum of squares, deviance, and the Jacobian there."""
        scales = self.scales()
        low, high = (bound / scales for bound in self.bounds())
        best = None

        def scaled(values, weights):
            return self.residuals(scales * values, weights)

        def slopes(values, weights):
            return self.jacobian(scales * values, weights) * scales

        for start in starts if starts is not None else [self.start(part) for part in STARTS]:
            for _ in range(PASSES):
                first = np.clip(start / scales, low + 1e-9, high)
                weights = self.weights(scales * first)
                given = dict(bounds=(low, high), args=(weights,))
                found = least.fit(scaled, [first], slopes, max_nfev=TRIALS, **given)
                start = scales * found.x
            found.deviance = self.deviance(found.fun, weights)
            if best is None or found.deviance < best.deviance:
                best = found
        best.x, best.jac = scales * best.x, best.jac / scales
        return best


def _neighbours(problem, residuals):
    """Correlation of neighbouring residuals within the loops."""
    sizes = np.cumsum([len(loop.force) for loop in problem.loops])
    parts = [part - part.mean() for part in np.split(residuals, sizes)[:-1]]
    return float(sum(np.sum(p[1:] * p[:-1]) for p in parts) / max(sum(np.sum(p * p) for p in parts), 1e-300))


def _profile(problem, best, variance):
    """The range of the friction, 95 %: where the sum of squares, all else free, grows by 4 times the variance; and how
    far the other shared parameters are within it from the best ones."""
    limit = best.deviance + 4.0 * variance
    friction = best.x[0]
    free = [name for name in problem.free if name != "friction"]

    def cost(value, start):
        one = _Problem(problem.loops, problem.pushes, free, {**problem.fixed, "friction": value})
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
    loops: Sequence[Loop], push: Sequence[Push], free: Sequence[str] = (), profile: bool = True, **fixed: Any
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
    problem = _Problem(list(loops), pushes, names, fixed)
    best, square, variance = _solved(problem)
    jacobian = best.jac / np.sqrt(variance)
    deviation, correlation = least.bands(jacobian)
    of, sd = problem.shared(best.x), dict(zip(problem.free, deviation))
    neighbours = _neighbours(problem, best.fun)
    friction, friction_sd = of["friction"], float(sd["friction"])
    ends, state, at_least = (friction - 2 * friction_sd, friction + 2 * friction_sd), "known", np.nan
    if neighbours > CORRELATED and square > MISFIT**2 or square > LARGE**2:
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
    problem = _Problem(list(loops), [push] * len(loops), ("friction", "compliance", *free), {})
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

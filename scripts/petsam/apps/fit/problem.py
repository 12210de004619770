"""The model of a measured loop, and the least squares of several: parameters, scales and residuals.

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

import numpy as np

from . import least
from .backbone import Backbone, derivatives, force_of, plain_force

# parameters that all loops of a fit have in common
SHARED = ("friction", "compliance", "lean", "loss", "scale", "bend")
OWN = ("offset", "top", "bottom")  # those of each: force, largest and smallest displacement
STARTS = (0.999, 0.7, 0.3)  # parts of sliding from which the fit begins: from one it may end where all sticks or slides
PASSES = 3  # of a fit, each with the weights of the one before
LOSING = 0.2  # the most loss that is looked for: more would be a loop of its own
LEAST, MOST = 1e-4, 30.0  # coefficients of friction
LOWEST = {"friction": LEAST, "compliance": 0.0, "loss": -LOSING, "scale": 0.05, "bend": -0.9}
HIGHEST = {"friction": MOST, "loss": LOSING}
END = 1e-3  # distance from such an end, over the scale, within which a parameter is at it
TRIALS = 30  # steps of a pass at most: the next pass goes on, and a start that leads nowhere costs little
BENDS = 2.0  # deviation of the bend over that of the scale, if nothing is stated
TURNING = (0.9, 1.05)  # where loops just slide, or just do not: shear over mu N, stroke over that of sliding


class Problem:
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

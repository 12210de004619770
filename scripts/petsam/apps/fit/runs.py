"""Parameters of a contact from measured numbers of its history, by full runs.

For what one push and Masing's rule (problem.py) do not hold: dissimilar bodies at their own friction, both tangential
directions out of phase, wear within the loop, a normal load that varies, unknown radii, moduli or profiles. Residuals
are those of the numbers over their standard deviations, and of what is known of a parameter beforehand over its own;
least squares then find the most likely parameters (normal errors), and the covariance is (J'J)^-1 with the Jacobian J
of the residuals there, by Gauss and Newton.

A Jacobian by differences takes a run for each parameter; by passes back (gradient.py) one for each number, of a third
to all of a run. A loop has more numbers than a contact has unknown parameters: differences are then the cheaper way.
Passes are where there are as many parameters as numbers, or more, such as the heights of a profile that are known to
some um beforehand.
"""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from numbers import Real
from typing import Any, Optional

import numpy as np
from numpy.typing import ArrayLike

from ...contact import gradient
from ...core.brief import brief
from ...core.errors import Error, Unusable, counted, there_are
from . import least
from .loops import LARGE, VAGUE
from .problem import TRIALS

TOLERANCES = {"normal_rtol": 1e-8, "tangential_rtol": 1e-6}  # of petsam, if the options have none
NEAR, FAR = 1e-4, 1e-2  # least and largest step of a difference, relative; between them the root of the tolerance
ALIGNED = 0.95  # correlation with a parameter that is not identifiable by which another is not, either
JOINED = 5.0  # steps of a difference: parts of a direction's effect that differences do not tell from none
POSITIVE = ("friction", "body1_young", "body2_young", "wear_", "gap_radius", "rig_compliance")
LEAST = 1e-3  # of such a parameter, relative to its start; friction beyond the load's just fails
POISSON = 0.499  # the largest Poisson's ratio that is tried
RIG, OFFSET = "rig_compliance", "_offset"
PULLED = {"disp_x": "load_tx", "disp_y": "load_ty"}  # displacements to which the rig adds, and the load that does
BOUND = 1e-3  # distance from a bound, over the scale or the range, within which a value is at it
SETTLED = 1e-4  # relative change of the sum of squares at which a fit ends: a small part of a deviation
CLOSE = 1e-6  # and that of the parameters


@brief
@dataclass(frozen=True)
class ContactFit:
    """Parameters of a contact as found from measured numbers.

    Attributes
    ----------
    values, sd : dict
        {name: value and its standard deviation}; infinite where the numbers do not hold it at all.
    correlation : ndarray
        Of the errors, (parameters, parameters), in the order of values; NaN of a parameter that is not held.
    identifiable : dict
        {name: bool}, False where the deviation is above a tenth of the value and above half of what was known
        beforehand, where the value is at one of its bounds, where the error goes with that of such a parameter (a
        correlation above 0.95), and of all where the model does not hold or the fit has not converged.
    state : str
        "known"; "rejected": the residuals are larger than three times the noise; "not converged".
    chi2 : float
        Sum of the squared residuals over their deviations, with what was known beforehand.
    freedom : int
        Numbers, and parameters known beforehand, less parameters.
    numbers : dict
        {name: ndarray or float} of the best fit, at the places that were measured, else NaN.
    way : str
        Of the Jacobian, "differences" or "passes back".
    runs, passes : int
        Runs of the contact, and passes back.
    ends : tuple of str
        Parameters whose best value is at one of its bounds: beyond it may be a better one.
    """

    values: dict
    sd: dict
    correlation: np.ndarray
    identifiable: dict
    state: str
    chi2: float
    freedom: int
    numbers: dict = field(repr=False)
    way: str
    runs: int
    passes: int
    ends: tuple = ()

    @property
    def misfit(self) -> float:
        """Root mean square of the residuals over their deviations; NaN without a degree of freedom."""
        return float(np.sqrt(self.chi2 / self.freedom)) if self.freedom > 0 else np.nan

    def nearest(self, name: str) -> tuple[str, float]:
        """The parameter whose error goes most with that of another one.

        Parameters
        ----------
        name : str

        Returns
        -------
        tuple
            Its name and the correlation; "" and 0 of a single parameter, or where no correlation is known.
        """
        names = list(self.values)
        row = np.nan_to_num(self.correlation[names.index(name)])
        row[names.index(name)] = 0.0
        other = int(np.argmax(np.abs(row)))
        return (names[other], float(row[other])) if row[other] else ("", 0.0)

    def __str__(self):
        lines = [f"chi2 {self.chi2:.4g}, {self.freedom} degrees of freedom; {counted(self.runs, 'run')}"]
        lines[0] += f", {self.passes} passes back" if self.passes else ""
        if self.state == "rejected":
            lines.append(f"misfit {self.misfit:.3g} times the noise: the model does not hold")
        if self.state == "not converged":
            lines.append(f"not converged in {TRIALS} trials: start nearer, or give what is known")
        for name, value in self.values.items():
            if self.identifiable[name]:
                lines.append(f"{name} {value:.5g} +- {self.sd[name]:.2g}")
            elif self.state == "known" and name in self.ends:
                lines.append(f"{name}: no number: ends at its bound, {value:.5g}: give wider bounds, or what is known")
            elif self.state == "known":
                other, part = self.nearest(name)
                beside = f", correlation {part:.3f} with {other}" if other else ""
                lines.append(f"{name}: not identifiable ({value:.3g} +- {self.sd[name]:.2g}{beside})")
        return "\n".join(lines)


class _Measured:
    """The numbers that were measured: where, what, and how well."""

    def __init__(self, measured, options, history):
        per_row, self.places, self.values, self.deviations, self.wanted = int(options.get("steps", 1)), [], [], [], []
        self.shapes = {}
        for name, (values, deviation) in measured.items():
            if name not in gradient.NUMBERS:
                raise Unusable(f"measured {name}: it is none of a run{there_are(name, list(gradient.NUMBERS))}")
            if isinstance(history, Mapping) and name in history:
                raise Unusable(f"measured {name}: the history prescribes it")
            values = np.asarray(values, dtype=float)
            single = name in ("energy", "wear_volume")
            rows = np.size(next(iter(history.values()))) if isinstance(history, Mapping) else values.size
            if values.shape != (() if single else (rows,)):
                raise Unusable(f"measured {name} has the shape {values.shape}: give {'one' if single else rows}")
            deviations = np.broadcast_to(np.asarray(deviation, dtype=float), values.shape)
            self.shapes[name] = values.shape
            for row in np.flatnonzero(np.isfinite(values)):
                step = (int(row) + 1) * per_row - 1
                self.wanted.append((name, None if single else slice(step, step + 1)))
                self.places.append((name, int(row)))
                self.values.append(values.flat[row])
                self.deviations.append(deviations.flat[row])
        self.values, self.deviations = np.array(self.values), np.array(self.deviations)
        if not self.values.size or not np.all(self.deviations > 0.0):
            raise Unusable("measured: give values, and for each a standard deviation above 0")

    def named(self, values):
        """Numbers by name, as they were measured."""
        found = {name: np.full(shape, np.nan) for name, shape in self.shapes.items()}
        for (name, row), value in zip(self.places, values):
            found[name].flat[row] = value
        return {name: one if one.ndim else float(one) for name, one in found.items()}


class _Problem:
    """Residuals and their Jacobian by parameters in units of their scales."""

    def __init__(self, options, history, measured, parameters, known, gap):
        self.history, self.known = history, known
        self.measured = _Measured(measured, options, history)
        self.names = list(parameters)
        starts = {name: one if np.isscalar(one) else one[1] for name, one in parameters.items()}
        shapes = {name: name if np.isscalar(one) else one[0] for name, one in parameters.items()}
        for name in known:
            if name not in starts:
                raise Unusable(f"known {name}: it is no parameter{there_are(name, self.names)}")
        if not self.names:
            raise Unusable("there are no parameters: give those to be found, with the values that they start from")
        for name, start in starts.items():
            if not isinstance(start, Real) or (start < 0.0 and name.startswith(POSITIVE)):
                raise Unusable(f"parameter {name} starts from {start!r}: give a number that it may have")
        self.start = np.array([float(starts[name]) for name in self.names])
        self.scales = np.array([max(abs(starts[name]), known.get(name, (0.0, 0.0))[1]) for name in self.names])
        if not np.all(self.scales > 0.0):
            name = self.names[int(np.argmin(self.scales))]
            raise Unusable(
                f'parameter {name} starts from 0: give known={{"{name}": (value, deviation)}}, or another start'
            )
        self.beside = [name for name in self.names if name == RIG or name.endswith(OFFSET)]
        for name in self.beside:
            self._check(name)
        self.within = [k for k, name in enumerate(self.names) if name not in self.beside]
        inside = [shapes[self.names[k]] for k in self.within]
        self.numbers = gradient.numbers(
            {"errors": "none", **options}, history, self.measured.wanted, inside, gap=gap,
            scales=self.scales[self.within],
        )  # fmt: skip
        few = len(self.measured.values) <= len(inside)
        self.slopes, self.runs, self.passes, self.last = self.numbers.derivative if few else None, 0, 0, None
        rtol = max(float(self.numbers.options.get(name, usual)) for name, usual in TOLERANCES.items())
        self.step, self.ways = float(np.clip(np.sqrt(rtol), NEAR, FAR)), np.eye(len(inside))

    def _check(self, name):
        """Rejects a compliance or an offset of nothing."""
        if name == RIG:
            given = self.history if isinstance(self.history, Mapping) else {}
            if not any(way in self.measured.shapes and load in given for way, load in PULLED.items()):
                raise Unusable(f"{RIG}: it needs a measured disp_x or disp_y, and its load in the history")
        elif name[: -len(OFFSET)] not in self.measured.shapes:
            raise Unusable(f"{name}: {name[: -len(OFFSET)]} is not measured")

    def _outside(self, x):
        """The contribution of rig and offsets to the numbers, and its derivatives by the parameters."""
        values, slopes = np.zeros(len(self.measured.values)), np.zeros((len(self.measured.values), len(x)))
        of = dict(zip(self.names, x * self.scales))
        for k, (name, row) in enumerate(self.measured.places):
            load = PULLED.get(name)
            if RIG in of and isinstance(self.history, Mapping) and load in self.history:
                force, factor = self.history[load][row], of.get(load, 1.0)
                values[k] += of[RIG] * factor * force
                slopes[k, self.names.index(RIG)] = factor * force
                if load in of:
                    slopes[k, self.names.index(load)] = of[RIG] * force
            if name + OFFSET in of:
                values[k] += of[name + OFFSET]
                slopes[k, self.names.index(name + OFFSET)] = 1.0
        return values, slopes * self.scales

    def _run(self, inside):
        """Numbers of a run, and with passes back their derivatives; the last ones are kept."""
        if self.last is None or not np.array_equal(self.last[0], inside):
            self.runs += 1
            if self.slopes:
                self.last = (inside.copy(), *self.slopes(inside))
                self.passes += len(self.measured.values)
            else:
                self.last = (inside.copy(), self.numbers(inside), None)
        return self.last[1:]

    def begin(self, x):
        """The first run, whose error is the caller's; without passes back where its steps have none."""
        try:
            self.model(x)
        except _contact_error():
            if not self.slopes:
                raise
            self.slopes, self.passes = None, 0
            self.model(x)

    def model(self, x):
        """The measured numbers as these parameters have them."""
        return self._run(x[self.within])[0] + self._outside(x)[0]

    def residuals(self, x):
        """The residuals of the numbers, then of the parameters known beforehand; NaN where the contact has no
        solution."""
        try:
            off = (self.model(x) - self.measured.values) / self.measured.deviations
        except _contact_error():
            return np.full(len(self.measured.values) + len(self.known), np.nan)
        of = dict(zip(self.names, x * self.scales))
        return np.append(off, [(of[name] - value) / deviation for name, (value, deviation) in self.known.items()])

    def jacobian(self, x):
        """Derivatives of the residuals."""
        inside, found = x[self.within], self._outside(x)[1]
        numbers, slopes = self._run(inside)
        found[:, self.within] += self._differences(inside, numbers) if slopes is None else slopes
        prior = [self.scales * (np.array(self.names) == name) / sd for name, (_, sd) in self.known.items()]
        return np.vstack([found / self.measured.deviations[:, None], np.reshape(prior, (-1, len(x)))])

    def _differences(self, inside, numbers):
        """By a step in each direction, in which a parameter changes by its relative step at most; backwards where the
        contact has no solution. Directions are the singular ones of the Jacobian before, of columns of length 1: two
        parameters that have nearly one effect differ by a small part of it, to which the error of a difference is
        relative then."""
        floor = [0.0 if self.names[k].startswith(POSITIVE) else 1.0 for k in self.within]
        sizes, columns = np.maximum(np.abs(inside), floor), []
        for way in self.ways.T:
            step = self.step / np.max(np.abs(way) / sizes)
            try:
                self.runs += 1
                change = self.numbers(inside + step * way) - numbers
            except _contact_error():
                self.runs += 1
                change = numbers - self.numbers(inside - step * way)
            columns.append(change / step)
        found = np.linalg.solve(self.ways.T, np.reshape(columns, (len(inside), len(numbers)))).T
        scaled, lengths = least.unit(found / self.measured.deviations[:, None])
        self.ways = np.linalg.svd(scaled)[2].T / lengths[:, None]
        return found

    def bounds(self, given):
        """The bounds of the parameters over their scales."""
        low, high = np.full(len(self.names), -np.inf), np.full(len(self.names), np.inf)
        for k, (name, start) in enumerate(zip(self.names, self.start)):
            if name.startswith(POSITIVE):
                low[k] = LEAST * start / self.scales[k] if start > 0.0 else 0.0
            if name.endswith("_poisson"):
                low[k], high[k] = 0.0, POISSON / self.scales[k]
            if name in given:
                low[k], high[k] = np.array(given[name]) / self.scales[k]
        return low, high


def _contact_error():
    from ...contact.errors import ContactError

    return ContactError


def fit_contact(
    options: Mapping[str, Any],
    history: Any,
    measured: Mapping[str, tuple[ArrayLike, ArrayLike]],
    parameters: Mapping[str, Any],
    known: Optional[Mapping[str, tuple[float, float]]] = None,
    *,
    gap: Optional[ArrayLike] = None,
    bounds: Optional[Mapping[str, Sequence[float]]] = None,
) -> ContactFit:
    """Finds parameters of a contact from measured numbers of its history, by least squares of full runs.

    Slower than analyse() of cycles, which is for the loops of a rig in one direction, and has no run in its fit; this
    one is for dissimilar bodies, loads out of phase, wear in the loop, unknown shapes and moduli. A fit of three
    parameters takes 25 to 45 runs.

    Parameters
    ----------
    options : mapping
        The keywords of Contact; errors="none" unless they have others.
    history : path or mapping
        As Contact.run() takes it: the loads or displacements that were prescribed.
    measured : mapping
        {name: (values, standard deviation)}: of loads that follow from displacements, or displacements that follow
        from loads, one value per row of the history, NaN where there is none; of the energy and of the wear_volume of
        both bodies after the last row one. Deviations are of one value or of each.
    parameters : mapping
        {name: start}, in which the name is an option of Contact that is a number (friction, body1_young, gap_radius1,
        wear_coefficient2), a column of the history, on which the value is a factor, rig_compliance (m/N), whose product
        with the load is added to a measured disp_x or disp_y, or disp_x_offset, added to all values of disp_x. Or
        {name: (shape, start)} of a part of the gap, with shape as gradient.function() takes it, and the gap_type flat.
    known : mapping, optional
        {name: (value, standard deviation)} of what is known of a parameter beforehand: one more residual each.
    gap : array_like, optional
        A part of the gap that stays, (ny, nx), m.
    bounds : mapping, optional
        {name: (least, largest)}; without them moduli, radii, friction, wear and the rig's compliance are positive.

    Returns
    -------
    ContactFit

    Raises
    ------
    Error
        If a parameter or a measured number is none.
    ContactError
        If the contact has no solution at the start, as in gross slip under loads; trial steps that have none are
        shortened.

    Notes
    -----
    The Jacobian is that of differences, one run for each parameter, with steps of the root of the larger relative
    tolerance of the run, 1e-3 by default, along the singular directions of the Jacobian before. Where there are at most
    as many numbers as parameters it is that of passes back, one for each number, if all parameters have a derivative
    and the steps have one, too: where the contact of dissimilar bodies grows, with slip_direction="end" only.

    Load steps are part of the model: of a loop with both directions out of phase in 12 steps the friction was 0.4 %
    off, with slip_direction="end" 8 %; with twice as many steps 0.8 and 4 %. Fit again with more `steps`.

    Where the residuals are larger than the deviations (a misfit above 1.2), standard deviations grow by the misfit.
    """
    problem = _Problem(options, history, measured, parameters, dict(known or {}), gap)
    for name in bounds or {}:
        if name not in problem.names:
            raise Unusable(f"bounds of {name}: it is no parameter{there_are(name, problem.names)}")
    if len(problem.measured.values) + len(problem.known) < len(problem.names):
        have = counted(len(problem.measured.values) + len(problem.known), "number")
        raise Error(f"{have} for {len(problem.names)} parameters: measure more, or give what is known of them")
    low, high = problem.bounds(bounds or {})
    start = np.clip(problem.start / problem.scales, low, high)
    problem.begin(start)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # the first run has told
        best = least.fit(
            problem.residuals, [start], problem.jacobian, (low, high), x_scale="jac", ftol=SETTLED, xtol=CLOSE,
            gtol=0.0, max_nfev=TRIALS,
        )  # fmt: skip
        numbers = problem.model(best.x)
    ends = [name for name, at in zip(problem.names, _at_bounds(best.x, low, high)) if at]
    return _result(problem, best, numbers, tuple(ends), best.status == 0)


def _at_bounds(values, low, high):
    """True where values, over their scales, are at a bound."""
    near = BOUND * np.minimum(1.0, high - low)
    return (values - low < near) | (high - values < near)


def _result(problem, best, numbers, ends=(), unsettled=False):
    """The fit with its bands; the parameters at their bounds; whether the trials have not sufficed."""
    count, names = len(numbers), problem.names
    chi2, freedom = float(2.0 * best.cost), len(best.fun) - len(names)
    misfit = np.sqrt(chi2 / freedom) if freedom > 0 else 0.0
    jacobian = best.jac.copy()
    if misfit > least.MISFIT:  # what is known beforehand does not get worse by that
        jacobian[:count] /= misfit
    sd, correlation = least.bands(jacobian, JOINED * problem.step)
    values, sd = best.x * problem.scales, sd * problem.scales
    state = "rejected" if misfit > LARGE else "not converged" if unsettled else "known"
    limits = [
        max(VAGUE * abs(value), 0.5 * problem.known.get(name, (0.0, 0.0))[1]) for name, value in zip(names, values)
    ]
    vague = (sd > limits) | (state != "known") | np.isin(names, ends)
    vague |= np.any(vague & (np.abs(correlation) > ALIGNED), axis=1)
    held = {name: not one for name, one in zip(names, vague)}
    return ContactFit(
        dict(zip(names, map(float, values))), dict(zip(names, map(float, sd))), correlation, held, state, chi2,
        freedom, problem.measured.named(numbers), "passes back" if problem.slopes else "differences", problem.runs,
        problem.passes, tuple(ends),
    )  # fmt: skip

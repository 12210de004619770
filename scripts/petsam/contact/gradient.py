"""Derivatives of a number of a load history by all of its parameters, in one pass back over its steps.

    contact = petsam.Contact(...)
    contact.record_gradient()
    contact.run({"time": [0, 1, 2], "load_n": [100, 100, 100], "load_tx": [0, 20, -20]})
    found = contact.gradient("energy")
    found.value, found["gap"], found["friction"], found["load_tx"]

The pass back is the library's (src/post/gradient). For optimisers, function() makes runs and passes back of parameters:

    energy = petsam.gradient.function(options, history, "energy", ["friction", "load_tx"])
    scipy.optimize.minimize(energy, [0.3, 1.0], jac=True)

numbers() is the same without derivatives; positions() and mean() make functions of it that scatter less about those of
fine grids.
"""

from collections.abc import Iterable, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any, Callable, Optional

import numpy as np
from numpy.typing import ArrayLike

from ..core.errors import Unusable, counted, there_are
from ..results.gradients import MODULI
from .derivatives import BULK, LOADS, USUAL, WAYS, WEAR, OneSidedWarning  # noqa: F401  (USUAL: for users)
from .inprocess import Contact

NUMBERS = ("energy", "wear_volume", *LOADS, *WAYS)  # that numbers() takes from a run that is not recorded
OPTIONS = ("friction", *MODULI, *(f"{name}{body}" for name in WEAR for body in (1, 2)))  # that function() may change
SETTLES = 1e-8  # tolerance of the shear by which the direction of slip at mid step is found completely
RTOL = 1e-6  # relative residual of the systems of a pass back
GOLDEN = (5**0.5 - 1) / 2
IMAGINARY = 1e-30  # part of a value by which a shape's derivative is found, without any error of differences


@dataclass(frozen=True)
class _Evaluation:
    """A function of parameters, the shape of the numbers that it returns, the options of its contacts, and a function
    that returns the numbers with their derivatives: None where a parameter has none."""

    of: Callable[[ArrayLike], Any]
    shape: tuple[int, ...] = ()
    options: Mapping[str, Any] = field(default_factory=dict)
    derivative: Optional[Callable[[ArrayLike], tuple[Any, np.ndarray]]] = None

    def __call__(self, x: ArrayLike) -> Any:
        return self.of(x)


def function(
    options: Mapping[str, Any],
    history: Any,
    objective: Any,
    parameters: Sequence[Any],
    *,
    gap: Optional[ArrayLike] = None,
    scales: ArrayLike = 1.0,
    rtol: float = RTOL,
) -> Callable[[ArrayLike], tuple[Any, np.ndarray]]:
    """A function of parameters that returns a number and its derivatives: one run, and one pass back, for each call.

    Parameters
    ----------
    options : mapping
        The keywords of Contact; tangential_rtol is 1e-8 unless they have another: from there on the direction of slip
        at mid step is found completely, whether steps are recorded or not.
    history : path or mapping
        As Contact.run() takes it.
    objective : str, tuple or list
        A number as Contact.gradient() takes it, (number, slice of steps), or a list of them.
    parameters : sequence
        For each value of x a name: friction, a modulus, wear_coefficient1, ..., or a column of the history, on which x
        is a factor. Or a part of the gap: an array (ny, nx), times x; a function shape(x, y, value) of the cells'
        centres; or a pair of this function and that of its derivative by the value. A function alone is
        differentiated by a complex value: it must be analytic, without abs().
    gap : array_like, optional
        A part of the gap that stays, (ny, nx), m.
    scales : array_like
        The values of the parameters are x times these. Optimisers need an x whose values are alike in size.
    rtol : float
        Relative residual of the systems that are solved.

    Returns
    -------
    callable
        x -> (number, derivatives (parameters,)), as scipy.optimize.minimize(..., jac=True) takes it; of a list
        x -> (numbers (objectives,), derivatives (objectives, parameters)), with a pass back for each number. Its
        attribute shape is () or (objectives,).

    Raises
    ------
    Error
        If there is no derivative by a parameter, or parts of the gap meet others of the options; by the call, if x or
        a part has another shape than it should, or a function is real for a complex value.
    ContactError
        By the call, if a step has no solution, as in gross slip, or the number has no derivative.
    """
    model = _Model(options, history, objective, parameters, gap, scales)
    for name in model.underived:
        raise Unusable(f"parameter {name}: there is no derivative by it{there_are(name, [*OPTIONS, *model.columns])}")
    return model.derivative(rtol)


def numbers(
    options: Mapping[str, Any],
    history: Any,
    objective: Any,
    parameters: Sequence[Any],
    *,
    gap: Optional[ArrayLike] = None,
    scales: ArrayLike = 1.0,
) -> Callable[[ArrayLike], Any]:
    """A function of parameters that returns the numbers of function() without derivatives: one run for each call.

    Parameters
    ----------
    options : mapping
        As function() takes them.
    history, gap, scales
        As function() takes them.
    objective : str, tuple or list
        As function() takes it: energy, wear_volume, a load or a displacement.
    parameters : sequence
        As function() takes them, and any other option of Contact that is a number. A function of a shape may be real.

    Returns
    -------
    callable
        x -> number; of a list x -> numbers (objectives,). Its attributes are shape, () or (objectives,); options, those
        of its contacts; and derivative, function() of the same, or None if there is no derivative by a parameter.

    Raises
    ------
    Error
        If a run alone has no such number, or parts of the gap meet others of the options; by the call, if x or a part
        has another shape than it should.
    ContactError
        By the call, if a step has no solution, or an option is rejected.
    """
    model = _Model(options, history, objective, parameters, gap, scales)
    for name, _ in model.wanted:
        if name not in NUMBERS:
            raise Unusable(f"number {name}: it is none of a run alone{there_are(name, list(NUMBERS))}")

    def evaluate(x: ArrayLike) -> Any:
        with model.solved(x, record=False) as (_, steps, _):
            values = np.array([_number(steps, name, part) for name, part in model.wanted])
        return values if model.several else float(values[0])

    return _Evaluation(evaluate, model.shape, model.options, None if model.underived else model.derivative())


class _Model:
    """The runs of function() and numbers(): what is wanted of them, and a contact with its steps for each x."""

    def __init__(self, options, history, objective, parameters, gap, scales):
        self.options, self.history = {"tangential_rtol": SETTLES, **options}, history
        self.parameters, self.gap, self.scales = parameters, gap, scales
        self.several = isinstance(objective, list)
        self.wanted = [
            (one, None) if isinstance(one, str) else one for one in (objective if self.several else [objective])
        ]
        if not _fits(scales, len(parameters)):
            raise Unusable(f"scales = {scales!r}: give a number, or {counted(len(parameters), 'number')}")
        named = isinstance(history, Mapping)
        self.columns = [name for name in history if name in (*LOADS, *WAYS, *BULK)] if named else []
        self.names = [one for one in parameters if isinstance(one, str)]
        if not len(parameters) or not self.wanted:
            raise Unusable("there are no parameters, or no numbers: give some of both")
        self.underived = [name for name in self.names if name not in (*OPTIONS, *self.columns)]
        for name in self.names:
            if self.names.count(name) > 1:
                raise Unusable(f"parameter {name} is listed twice")
        self.shape = (len(self.wanted),) if self.several else ()
        self.shaped = gap is not None or len(self.names) < len(parameters)
        for name, value in {**options, **dict.fromkeys(self.names, "a parameter")}.items():
            if self.shaped and name.startswith("gap_") and (name, value) != ("gap_type", "flat"):
                raise Unusable(f"{name} = {value}: parts of the gap replace it: use gap_type = flat alone")

    @contextmanager
    def solved(self, x, record):
        """The contact of x, its steps, and for each parameter its part of the gap with the derivative, or None."""
        if np.shape(x) != (len(self.parameters),):
            raise Unusable(f"x has the shape {np.shape(x)}: give {counted(len(self.parameters), 'value')}")
        pairs = list(zip(self.parameters, np.asarray(x, dtype=float) * self.scales))
        given = {one: value for one, value in pairs if isinstance(one, str)}
        changed = {one: value for one, value in given.items() if one not in self.columns}
        with _made({**self.options, **changed}) as contact:
            parts = [None if isinstance(one, str) else _part(contact, one, value, record) for one, value in pairs]
            if self.shaped:
                stays = 0.0 if self.gap is None else np.asarray(self.gap)
                contact.gap = stays + sum(part[0] for part in parts if part)
            if record:
                contact.record_gradient()
            factors = {one: given.get(one, 1.0) for one in self.columns}
            scaled = self.history
            if self.columns:
                scaled = {one: np.asarray(values) * factors.get(one, 1.0) for one, values in self.history.items()}
            yield contact, contact.run(scaled), parts

    def derivative(self, rtol: float = RTOL) -> Callable[[ArrayLike], tuple[Any, np.ndarray]]:
        """The function of x that returns what is wanted with its derivatives."""
        of = [*(["gap"] if self.shaped else []), *dict.fromkeys(_derivative(name) for name in self.names)]

        def evaluate(x: ArrayLike) -> tuple[Any, np.ndarray]:
            with self.solved(x, record=True) as (contact, _, parts):
                found = [contact.gradient(name, of, steps, rtol) for name, steps in self.wanted]
            by = [
                [
                    np.sum(each.gap * part[1]) if part else _by_name(each, one, self.history)
                    for one, part in zip(self.parameters, parts)
                ]
                for each in found
            ]
            values, slopes = np.array([each.value for each in found]), np.reshape(by, (len(found), -1)) * self.scales
            return (values, slopes) if self.several else (float(values[0]), slopes[0])

        return _Evaluation(evaluate, self.shape, self.options)


def _fits(scales, count):
    """True if these are numbers, one or as many as parameters."""
    try:
        return np.asarray(scales, dtype=float).shape in ((), (count,))
    except (TypeError, ValueError):
        return False


def _number(steps, name, part):
    """A number of steps as Contact.gradient() has it."""
    if name == "energy":
        return sum(step.dissipated_energy for step in (steps if part is None else steps[part]))
    chosen = steps[-1:] if part is None else steps[part]
    if name == "wear_volume":
        return sum(chosen[-1].numbers.get(f"wear_volume{body}", 0.0) for body in (1, 2))
    return sum(getattr(step, name) for step in chosen)


def positions(options: Mapping[str, Any], count: int) -> list[dict[str, Any]]:
    """Options of a contact with its grid in several positions within a cell, for mean().

    Parameters
    ----------
    options : mapping
        The keywords of Contact.
    count : int
        Number of positions, the given one among them: points of a lattice that covers a cell evenly.

    Returns
    -------
    list of dict

    Raises
    ------
    Error
        If the count is no number from 1 on, or as of Contact().
    """
    if not isinstance(count, int) or count < 1:
        raise Unusable(f"count = {count!r}: give a number of positions of the grid, 1 or more")
    with _made(options) as contact:
        cells = [(np.mean(at), size / n) for at, size, n in zip((contact.x, contact.y), contact.size, contact.n)]
    places = [(k / count, GOLDEN * k % 1.0) for k in range(1, count)]
    moved = [[float(middle + part * cell) for (middle, cell), part in zip(cells, place)] for place in places]
    return [dict(options), *({**options, "grid_center": center} for center in moved)]


def mean(functions: Iterable[Callable[[ArrayLike], Any]]) -> Callable[[ArrayLike], Any]:
    """The mean of functions that function() or numbers() returns, as of positions() of a grid.

    Where a cell changes its set the derivative jumps, so that the one of a grid scatters about that of fine grids. The
    mean over 8 positions scatters by a fifth of that.

    Parameters
    ----------
    functions : iterable of callable
        Of the same parameters, which should not be arrays of cells: these would move with the grid.

    Returns
    -------
    callable
        x -> what one of them returns.

    Raises
    ------
    Error
        If there are none; by the call, if they return several shapes.
    """
    every = list(functions)
    if not every:
        raise Unusable("there are no functions: give some, of positions() of a grid")

    def evaluate(x: ArrayLike) -> Any:
        found = [one(x) for one in every]
        shapes = {tuple(map(np.shape, one)) if isinstance(one, tuple) else np.shape(one) for one in found}
        if len(shapes) > 1:
            raise Unusable("the functions return numbers of several shapes: give those of the same numbers")
        return (
            tuple(sum(parts) / len(every) for parts in zip(*found))
            if isinstance(found[0], tuple)
            else sum(found) / len(every)
        )

    return _Evaluation(evaluate, getattr(every[0], "shape", ()))


def whole(contact: Contact) -> Contact:
    """The contact, if this process has all of its rows; Error if other ranks have rows of it."""
    if contact.rows != contact.n[1]:
        raise Unusable(f"{contact.rows} of {contact.n[1]} rows are on this rank: use a contact without comm")
    return contact


def _made(options):
    return whole(Contact(**options))


def _part(contact, shape, value, differentiate):
    """A part of the gap, and its derivative by the value, which is None if it is not wanted."""
    x, y = np.meshgrid(contact.x, contact.y)
    if isinstance(shape, tuple):
        return tuple(_cells(contact, one(x, y, value)) for one in shape)
    if not callable(shape):
        unit = _cells(contact, shape)
        return value * unit, unit
    if not differentiate:
        return _cells(contact, shape(x, y, value)), None
    step = IMAGINARY * (abs(value) or 1.0)
    found = _cells(contact, shape(x, y, complex(value, step)))
    if not np.iscomplexobj(found):
        raise Unusable("a part of the gap is real for a complex value: give a pair, it and its derivative")
    return found.real, found.imag / step


def _cells(contact, values):
    values, cells = np.asarray(values), (contact.rows, contact.n[0])
    if values.shape != cells:
        raise Unusable(f"a part of the gap has the shape {values.shape}: the grid has {cells}: use these")
    return values


def _derivative(name):
    """The name of the derivative by a parameter: those by the coefficients of wear are of both bodies together."""
    return name[:-1] if name[:-1] in WEAR else name


def _by_name(found, name, history):
    """The derivative by a number among the options, or by a factor on a column of the history."""
    if name == "friction":
        scales = history.get("friction_scale", 1.0) if isinstance(history, Mapping) else 1.0
        return np.ravel(scales)[-1] * found.friction.sum()
    if name in OPTIONS:
        return found[_derivative(name)]
    slopes, column = found[name], np.append(0.0, history[name])  # steps divide the change from row to row, from 0 on
    return slopes @ np.interp(np.linspace(0, len(column) - 1, len(slopes) + 1)[1:], range(len(column)), column)


__all__ = ["OneSidedWarning", "function", "mean", "numbers", "positions"]


def __dir__():
    return __all__

"""Pictures of a study: any number of its table over another, of studies.Study."""

import numpy as np

from ..core import words
from ..core.errors import Error, Unusable, counted, short
from . import symbols
from .style import BARS, MARKED, colors, logarithmic, need_few, plt
from .units import label, largest, number, plain, scale

MARKS = ("o", "s", "^", "D", "v", "x", "+")
MOST = 9  # panels of a picture, unless columns are named
CURVES = 40  # in a panel
SAME = 1e-9  # relative difference below which values do not vary
AGAIN = 1e-6  # relative difference below which a result is the input of the same name
NOISE = 1e-9  # relative to the largest number with the same dimension; smaller numbers are rounding; rad is separate
DIMENSION = {"J": "N m"}
ENERGIES = {"dissipated_energy_sum": "dissipated energy, sum", "dissipated_energy": "dissipated energy, last step"}


def numbers(study, name, option):
    """Values of a column of numbers, and their unit."""
    values, unit = study.column(name, option)
    if values.dtype.kind not in "biuf":
        raise Error(f"{study.path}: {option} {short(name)}: holds texts, no numbers")
    return values.astype(float), study.unit_of_input(name) if name in study.inputs else unit


def need_case(study, name, option, chosen):
    """Raises Unusable if a column has a number in none of the chosen cases."""
    if not np.isfinite(numbers(study, name, option)[0][chosen]).any():
        raise Unusable(f"{study.path}: {option} {short(name)}: no chosen case has a number; use another column")


def titled(name):
    """Returns the name of a column on an axis: its symbol, if it has one."""
    bare = name.removesuffix("_end")
    return ENERGIES.get(bare) or symbols.scalar(bare if bare in symbols.SYMBOLS else name)


def _varies(values):
    """Returns true if a column has different values: texts, or numbers that differ by more than rounding."""
    if values.dtype.kind not in "biuf":
        return len(set(values)) > 1
    known = values[np.isfinite(values)].astype(float)
    return known.size > 1 and float(np.ptp(known)) > SAME * float(np.max(np.abs(known)))


def _distinct(values):
    return len(set(values.tolist()))


def swept(study):
    """Names of the inputs that vary, the one with the most values first."""
    names = [name for name, values in study.inputs.items() if _varies(values)]
    return sorted(names, key=lambda name: -_distinct(study.inputs[name]))


def abscissa(study):
    """The input of numbers that has the most values."""
    names = [name for name in swept(study) if study.inputs[name].dtype.kind in "biuf"]
    if not names:
        raise Error(f"{study.path}: no input of numbers varies; --against names what is drawn over")
    return names[0]


def _results(study, other):
    """Returns the default results of a picture: physical quantities that vary by more than rounding."""
    sizes = {"rad": 1.0}
    for name, unit in study.units.items():
        unit = DIMENSION.get(unit, unit)
        sizes[unit] = max(sizes.get(unit, 0.0), largest([study.results[name].astype(float)]))
    names = []
    for name, unit in study.units.items():
        if name.endswith("_error") and name.removesuffix("_error") in study.results:
            continue  # the bars of that column
        values = study.results[name].astype(float)
        column = name + "_end" if name in study.inputs else name
        if column == other or unit in ("1", "s") or not _varies(values) or _is_input(study, name, values):
            continue
        if np.nanmax(values) - np.nanmin(values) > NOISE * sizes[DIMENSION.get(unit, unit)]:
            names.append(column)
    names = _once(study, names)
    if not names:
        raise Error(f"{study.path}: no result varies; --scalar names what is drawn: {', '.join(study.names)}")
    return names[:MOST]


def _is_input(study, name, values):
    """Returns true if a result repeats the input of its name."""
    given = study.inputs.get(name)
    if given is None or given.dtype.kind not in "biuf":
        return False
    known = np.isfinite(values)
    return bool(np.allclose(values[known], given.astype(float)[known], rtol=AGAIN, atol=0.0))


def _once(study, names):
    """Returns the names without duplicates: for a single step the sum is that of the step."""
    kept = []
    for name in sorted(names, key=lambda name: not name.endswith("_sum")):  # the sum means more than the last step
        values, unit = study.column(name)
        others = (study.column(other) for other in kept)
        if not any(
            unit == one and np.allclose(values, some, rtol=SAME, atol=0.0, equal_nan=True) for some, one in others
        ):
            kept.append(name)
    return [name for name in names if name in kept]


def matching(study, where=()):
    """Returns a mask of the cases that have the given values (name, text) in their columns."""
    chosen = np.full(study.codes.shape, True)
    for name, text in where:
        values, _ = study.column(name, "--where")
        if values.dtype.kind in "biuf":
            try:
                wanted = words.number(text, "a number", numbers(study, name, "--where")[1] or "1")
            except words.WordError as error:
                raise Error(f"{study.path}: --where {short(name)}={error}") from None
            match = np.isclose(values.astype(float), wanted, rtol=1e-9, atol=0.0)
        else:
            match = values == text
        if not match.any():
            known = sorted(set(values.tolist()))[:8]
            there = ", ".join(f"{value:g}" if values.dtype.kind in "biuf" else value for value in known)
            raise Error(f"{study.path}: --where {short(name)}={short(text)}: no case has it; there are {there}")
        chosen = chosen & match
    return chosen


def rows(study, where=()):
    """Returns a mask of the drawn cases: those that finished, with the given values (name, text) in their columns."""
    chosen = matching(study, where) & (study.codes == 0)
    if not chosen.any():
        raise Error(f"{study.path}: none of the chosen cases has finished")
    return chosen


def _text(study, name, value):
    if not isinstance(value, float):
        return f"{titled(name)} = {plain(value)}"
    factor, unit = scale(study.unit_of_input(name), abs(value))
    return f"{titled(name)} = {number(factor * value, 6)} {unit}".rstrip()


def _split(columns, chosen):
    """Rows of the chosen cases by their values in the columns."""
    found = {}
    for k in np.flatnonzero(chosen):
        found.setdefault(tuple(column[k].item() for column in columns), []).append(int(k))
    return found


def _ambiguous(curves, x, column):
    """Returns true if in some curve a column differs between cases with the same x."""
    for rows_of_curve in curves.values():
        values = {}
        for k in rows_of_curve:
            values.setdefault(x[k].item(), set()).add(column[k].item())
        if any(len(some) > 1 for some in values.values()):
            return True
    return False


def _repeats(curves, x, column):
    """Returns true if in some curve a column has several values, and one of them at several x."""
    for rows_of_curve in curves.values():
        values = {(x[k].item(), column[k].item()) for k in rows_of_curve}
        if 1 < len({value for _, value in values}) < len(values):
            return True
    return False


def groups(study, other, by, chosen):
    """Names of the parameters that tell curves apart, `by` first, and of every curve their values and its rows.

    Besides `by` these are inputs in which cases with the same x differ, and then inputs with one value at several x;
    an input that is different at every x of a curve follows from x, and tells none apart.
    """
    x = study.column(other)[0]
    names = [by] if by is not None else []
    columns = [study.column(by, "--by")[0]] if names else []
    for differ in _ambiguous, _repeats:
        for name in reversed(swept(study)):  # those with few values first
            if name not in (other, *names) and differ(_split(columns, chosen), x, study.inputs[name]):
                names.append(name)
                columns.append(study.inputs[name])
    found = _split(columns, chosen)
    curves = [(key, np.array(found[key])) for key in sorted(found)]
    if len(curves) > CURVES:
        raise Error(f"{study.path}: {len(curves)} curves, by {', '.join(names)}; --where chooses cases")
    return names, curves


def _styles(curves):
    """Colour by the first parameter, mark by the others; without these, or where they are the same, mark as colour."""
    first = list(dict.fromkeys(key[:1] for key, _ in curves))
    others = list(dict.fromkeys(key[1:] for key, _ in curves))
    tints = colors(len(first))
    for key, _ in curves:
        mark = others.index(key[1:]) if len(others) > 1 else first.index(key[:1])
        yield tints[first.index(key[:1])], MARKS[mark % len(MARKS)]


def _curves(studies, other, by, where):
    """(study, label, colour, mark, rows) of every curve."""
    found = []
    for study in studies:
        names, curves = groups(study, other, by, rows(study, where))
        who = [plain(study.label)] if len(studies) > 1 else []
        for (key, cases), (color, mark) in zip(curves, _styles(curves)):
            text = ", ".join([*who, *(_text(study, name, value) for name, value in zip(names, key))])
            found.append([study, text, color, mark, cases])
    if len(studies) > 1:  # colours tell the curves of several studies apart
        for curve, color in zip(found, colors(len(found))):
            curve[2] = color
    return found


def _draw(panel, curves, name, other, across, logs):
    """One column over the other of all curves."""
    data = [(study.column(other)[0][cases].astype(float), numbers(study, name, "--scalar")[0][cases])
            for study, _, _, _, cases in curves]  # fmt: skip
    factor, unit = scale(numbers(curves[0][0], name, "--scalar")[1], *(y for _, y in data), powers=True)
    for (study, text, color, mark, cases), (x, y) in zip(curves, data):
        order = np.argsort(x, kind="stable")
        error = f"{name.removesuffix('_end')}_error"
        if error in study.results and name not in study.inputs:
            bars = factor * np.nan_to_num(study.results[error][cases].astype(float))
            panel.errorbar(across * x, factor * y, bars, ecolor=color, **BARS)
        many = {"marker": "", "linewidth": 0.8} if x.size > MARKED else {"marker": mark, "linewidth": 1.0}
        look = {"markersize": 4.5, "markerfacecolor": "white", "color": color, "label": text, **many}
        panel.plot(across * x[order], factor * y[order], **look)
    panel.set(ylabel=label(titled(name), unit))
    logarithmic(panel, logs)


def study(studies, names=None, other=None, by=None, where=(), logs=()):
    """Columns of studies over another one: a panel each, a curve for every value of the other inputs that vary.

    Without names the results that vary; without other the input with the most values; by names the parameter that the
    colours stand for. Cases that have not finished are left out, and the picture says how many.
    """
    other = other or abscissa(studies[0])
    for one in studies:
        numbers(one, other, "--against")
    names = names or _results(studies[0], other)
    need_few(len(names), "columns")
    curves = _curves(studies, other, by, where)
    for one in studies:
        for name in names:
            need_case(one, name, "--scalar", rows(one, where))
        need_case(one, other, "--against", rows(one, where))
    across, unit = _abscissa(curves, other)
    columns = min(3, len(names))
    height = -(-len(names) // columns)
    size = (4.4 * columns, 3.0 * height + 0.4) if len(names) > 1 else (6.8, 4.6)
    figure, axes = plt.subplots(height, columns, figsize=size, squeeze=False, constrained_layout=True)
    for panel, name in zip(axes.flat, names):
        _draw(panel, curves, name, other, across, logs)
        panel.set_xlabel(label(titled(other), unit))
    for panel in axes.flat[len(names) :]:
        panel.set_axis_off()
    handles, texts = axes.flat[0].get_legend_handles_labels()
    if any(texts):
        outside = {"loc": "outside right upper"} if len(curves) > 4 else {}
        (figure if outside else axes.flat[0]).legend(handles, texts, **outside)
    left = sum(int(np.sum(one.codes != 0)) for one in studies)
    if left:
        figure.suptitle("omitted: " + counted(left, "unfinished case"), fontsize=9, color="0.35")
    return figure


def _abscissa(curves, other):
    """Factor and unit of what is drawn over."""
    _, unit = numbers(curves[0][0], other, "--against")
    return scale(unit, *(numbers(study, other, "--against")[0][cases] for study, _, _, _, cases in curves), powers=True)

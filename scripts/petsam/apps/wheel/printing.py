"""Lines that petsam-wheel prints: equilibria, patches, failures and doubts."""

import argparse
import re
import warnings

import numpy as np

from ...core.errors import counted
from . import derailing
from .inputs import vehicle_of
from .options import warn

SMOOTHED = 0.03  # change of the largest pressure by half the smoothing without a remark
ROLL = 1e-3  # rad by which the roll of a table may differ without a remark
SHOWN = 12  # positions whose patches are printed, and failures


def print_all(options, found, table):
    """The equilibria and patches of few positions; of all, failures and warnings."""
    columns = {column.name: column.values for column in table}
    _head(found)
    solved = {number: k for k, number in reversed([*enumerate(columns["position"])]) if columns["ws_y"][k] is not None}
    for number, k in [*sorted(solved.items())][:SHOWN]:
        row = {name: values[k] for name, values in columns.items()}
        left = max(abs(row[name]) for name in ("force_error", "moment_error"))
        print(f"position {number}: y {1e3 * row['ws_y']:.4f} mm, {_told(row, 'z', 'ws_z', '.4f', 'mm', 1e3)}, "
              f"{_told(row, 'roll', 'ws_roll', '.5f', 'mrad', 1e3)}, "
              f"{_told(row, 'lateral force', 'ws_lateral', '.5g', 'N')}, "
              f"{_told(row, 'rolling radius difference', 'radius_difference', '.4f', 'mm', 1e3)}, "
              f"residual {left:.1g}")  # fmt: skip
        for row in [j for j, one in enumerate(columns["position"]) if one == number]:
            _print_patch({name: values[row] for name, values in columns.items()})
    if len(solved) > SHOWN:
        print(f"{counted(len(solved), 'position')} solved of {len(found.states)}; the first {SHOWN} are shown")
    for number, failure in found.failures[:SHOWN]:
        line = found.states[number - 1].line
        warn(f"position {number}{f' (line {line})' if line else ''}: {failure}")
    if len(found.failures) > SHOWN:
        warn(f"{len(found.failures)} positions have no equilibrium in all; the column note names each")
    _warn_of_notes(found.found)
    _compare_roll(options, found)
    if options.smooth:
        _doubt_smoothing(options, found)


def _warn_of_notes(found):
    """Prints the warnings of positions; of several that differ by numbers only the first, and how many there are."""
    alike = {}
    for number, one in enumerate(found, 1):
        for note in one.notes:
            alike.setdefault(re.sub(r"\d[\d.]*(e[-+]?\d+)?", "0", note), []).append((number, note))
    for (number, note), *others in alike.values():
        more = f"; {counted(len(others), 'other position')} with such a warning: see the column note" if others else ""
        warn(f"position {number}: {note}{more}")


def _print_patch(row):
    numbers = (
        ("y", "y", "9.3f", "mm", 1e3), ("angle", "angle", "8.4f", "", 1.0), ("creepages", "creep_x", ".3e", "", 1.0),
        ("", "creep_s", ".3e", "", 1.0), ("", "creep_spin", ".3e", "/m", 1.0), ("N", "n", ".5g", "N", 1.0),
        ("Fx", "fx", ".4g", "N", 1.0), ("Fs", "fs", ".4g", "N", 1.0), ("p_max", "p_max", ".4g", "MPa", 1e-6),
        ("T-gamma", "t_gamma", ".4g", "N", 1.0),
    )  # fmt: skip
    print(f"  {row['side']:5} {', '.join(_told(row, *one) for one in numbers)}{_climbing(row)}")


def _told(row, text, name, form, unit, scale=1.0):
    """A number of a row with its error, if that is known: N 43946 N +- 12."""
    value, error = scale * row[name], scale * row.get(f"{name}_error", np.nan)
    more = f" +- {error:.2g}" if np.isfinite(error) else ""
    if more and error > 0 and form[-1] == "g":  # both end at the second digit of the error
        decimals = max(1 - int(np.floor(np.log10(error))), 0)
        form, more = f".{decimals}f", f" +- {error:.{decimals}f}"
    number = f"{value:{form}}" if float(f"{value:{form}}") else f"{0.0:{form}}"  # not -0
    return f"{text} {number} {unit}".strip().replace(" /m", "/m") + more


def _head(found):
    """Prints what the numbers behind +- are, and why positions have none."""
    solved = [(number, one) for number, one in enumerate(found.found, 1) if one.value]
    if any(not one.unknown for _, one in solved):
        print("+-: estimated error by the cells, from a solution on cells twice as wide")
    for text in dict.fromkeys(one.unknown for _, one in solved if one.unknown):
        numbers = [number for number, one in solved if one.unknown == text]
        which = "" if len(numbers) == len(solved) else f"position {', '.join(map(str, numbers[:SHOWN]))}: "
        more = f" ({len(numbers)} such positions)" if which and len(numbers) > SHOWN else ""
        print(f"{which}{text}{more}")


def _climbing(row):
    """The state of a wheel that may climb or is derailed, for its line."""
    if row["state"] == derailing.STATES[0]:
        return ""
    here = derailing.nadal(abs(row["angle"]), row["friction"])
    return (
        f"; {row['state'].upper()}: Y/Q {row['y_over_q']:.3f}, Nadal's limit {row['nadal']:.3f} at the flange's "
        f"steepest place, {here:.3f} at this angle"
    )


def _highest(found):
    """The largest maximum pressure of all positions, Pa, and the position; 0 and None without one."""
    rows = {column.name: column.values for column in found.table()}
    solved = [(p, number) for p, number in zip(rows["p_max"], rows["position"]) if p is not None and np.isfinite(p)]
    return max(solved, default=(0.0, None))


def _doubt_smoothing(options, found):
    """Warns where the largest pressure is another one with half the smoothing: it takes the profiles' own curvatures
    away, or leaves some of their noise."""
    from .. import wheel as profiles

    highest, number = _highest(found)
    if number is None:
        return
    half = argparse.Namespace(**{**vars(options), "smooth": 0.5 * options.smooth})
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        other, _ = _highest(profiles.solve_all(vehicle_of(half), [found.states[number - 1]], 1))
    if other and abs(other / highest - 1.0) > SMOOTHED:
        warn(
            f"--smooth {1e3 * options.smooth:g}mm: position {number}: p_max is {highest / 1e6:.4g} MPa, and "
            f"{other / 1e6:.4g} MPa with half of it: smoothing flattens curves of the profiles, too, and noise that is "
            "left raises pressures: their error is of the order of this difference; measure with less noise"
        )


def _compare_roll(options, found):
    """Warns where the roll of a table is another one than that of the equilibrium."""
    rolls = found.of("ws_roll")
    apart = [(abs(roll - state.roll), state) for roll, state in zip(rolls, found.states) if state.roll is not None]
    apart = [one for one in apart if np.isfinite(one[0])]
    if apart and max(one[0] for one in apart) > ROLL:
        most, state = max(apart, key=lambda one: one[0])
        warn(
            f"{options.table}: line {state.line}: roll differs by {most:.3g} rad from that of the equilibrium: check "
            "its unit and sign (positive: right wheel down), profiles, --cant and --gauge"
        )

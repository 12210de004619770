"""The verdict of a report: the check of all steps, the required accuracy, and warnings beside them."""

import math
import re

import numpy as np

from ..core.errors import counted
from . import page, sheets

STATES = {
    10: "did not converge",
    11: "has no equilibrium (gross slip under force control, or moments that no pressure balances)",
    12: "has contact at the edge of the grid",
}
# errors of the check, their options and usual tolerances
CHECK = {
    "normal_residual": ("-normal_rtol", 1e-8, "gap where there is pressure, penetration and tension elsewhere"),
    "tangential_residual": ("-tangential_rtol", 1e-6, "stick, slip and its direction"),
    "equilibrium_residual": ("", 1e-10, "loads and integrals of the tractions"),
}
OVER = "above: accepted as rounding"
SLACK = 1.05  # the check allows so much of a tolerance
LARGE = 0.05  # errors of numbers from which they are warned of
USUAL = 0.01  # accuracy of -grid auto
FAILED, DOUBTFUL, FINE = "failed", "warning", "fine"  # classes of the verdict's element


def exit_code(results):
    """The exit code that the states of the steps stand for; None while a run writes, or after it was killed."""
    if not results.parameters.get("closed", 1):
        return None
    states = [int(state) for state in results.history["status"] if state]
    return states[-1] if states else 0


def _states(results):
    """How many steps have each state that is not 0."""
    states, counts = np.unique(results.history["status"].astype(int), return_counts=True)
    return [(int(state), int(count)) for state, count in zip(states, counts) if state]


def _options(results):
    return {name.lower(): value for name, value in sheets.given(results)}


def residuals(results):
    """Returns name, largest value of all solved steps, tolerance and quantity for each error of the check."""
    options, found = _options(results), []
    for name, (option, usual, what) in CHECK.items():
        if name not in results.history:
            continue
        values = results.series(name)
        values = values[np.isfinite(values)]
        try:
            tolerance = float(options.get(option, usual))
        except ValueError:
            tolerance = usual
        if values.size:
            found.append((name, float(np.max(values)), tolerance, what))
    return found


# ---------------------------------------------------------------- accuracy


def asked(results):
    """The error that -accuracy allows, and the numbers that it concerns, none for all; None where it is not given."""
    options = _options(results)
    text = options.get("-accuracy", "").replace(" ", "")
    if not text:
        return (USUAL, []) if options.get("-grid") == "auto" else None
    part = 0.01 if text.endswith("%") else 1.0
    try:
        allowed = part * float(text.rstrip("%"))
    except ValueError:
        return None
    return allowed, [name for name in options.get("-accuracy_of", "").replace(",", " ").split() if name]


def _too_large(results):
    """The numbers whose error is unknown or above the required accuracy, above LARGE without one, and this limit. The
    worst is the first."""
    allowed, names = asked(results) or (LARGE, [])
    some = [(name, one) for name, one in results.errors.items() if not names or name in names]
    some = [(name, one) for name, one in some if not one.error <= allowed]
    return sorted(some, key=lambda pair: -pair[1].error if sheets.is_known(pair[1].error) else -math.inf), allowed


def _error(name, one):
    """An error in words."""
    if not sheets.is_known(one.error):
        return f"the error of {name} is unknown"
    return f"{name} has an error of {sheets.percent(one.error)} by the {one.cause}"


def _doubt(results):
    """Returns why the numbers are not as accurate as required, or as usual; empty if they are."""
    large, allowed = _too_large(results)
    wanted = f"the required {100.0 * allowed:.3g} %"
    if not asked(results):
        return f"Not accurate: {_error(*large[0])}" if large else ""
    if large:
        beside = f", above {wanted}" if sheets.is_known(large[0][1].error) else f"; {100.0 * allowed:.3g} % is required"
        return f"Accuracy not reached: {_error(*large[0])}{beside}"
    return "" if results.errors else f"Accuracy unknown: the file has no errors to compare with {wanted}"


def _reached(results):
    """A sentence about errors that are small enough, or that are not known."""
    known = {name: one for name, one in results.errors.items() if math.isfinite(one.error)}
    if not known:
        return "The errors of the numbers by the cells are unknown."
    names = [name for name in (asked(results) or (0.0, []))[1] if name in known] or known
    name = max(names, key=lambda name: known[name].error)
    wanted = f"The accuracy of {100.0 * asked(results)[0]:.3g} % is reached: the" if asked(results) else "The"
    return f"{wanted} maximum error is {sheets.percent(known[name].error)}, of {name}."


# ---------------------------------------------------------------- verdict


def verdict(results):
    """Returns the class, the headline and another sentence of the verdict: on the check and on the accuracy."""
    code, bad = exit_code(results), [count for _, count in _states(results)]
    count, number = results.history["status"].size, len(warnings(results))
    ended = f"Exit code {code}." if code is not None else "No exit code: the run has not ended, or was killed."
    agreed = f"{f'all {count} steps' if count > 1 else 'the step'} converged, and the check agrees. {ended}"
    if bad:
        return FAILED, f"Failed: {sum(bad)} of {counted(count, 'step')} marked. {ended}", ""
    if doubt := _doubt(results):
        return DOUBTFUL, f"{doubt}.", agreed[0].upper() + agreed[1:]
    if number:
        return DOUBTFUL, f"Passed with {counted(number, 'warning')}: {agreed}", _reached(results)
    return FINE, f"Passed: {agreed}", _reached(results)


def warnings(results):
    """Returns the warnings of the file for its reader, a line each."""
    found = [f"{counted(count, 'step')} {STATES.get(state, 'has a state that is unknown')} (exit code {state})"
             for state, count in _states(results)]  # fmt: skip
    if not results.parameters.get("closed", 1):
        found.append("the file is not closed: a run writes to it, or was killed")
    large = _too_large(results)[0]
    told = [] if _states(results) else large[:1]  # in the headline
    large = large[len(told) :]
    small = [(name, one) for name, one in large if one.error <= LARGE]
    if small:
        found.append(f"above it, too: {', '.join(f'{name} {sheets.percent(one.error)}' for name, one in small)}")
    own = " ".join(one for one in results.warnings if one.startswith("error by the "))  # by the run: they name theirs
    known = [*(name for name, _ in (*told, *small)), *re.findall(r"\w+", own)]
    found += [_error(name, one) for name, one in results.errors.items() if name not in known and not one.error <= LARGE]
    return found + results.warnings


def check(results):
    """The section of the check: verdict and warnings, and residuals."""
    kind, headline, more = verdict(results)
    rows = []
    for name, value, tolerance, what in residuals(results):
        state = "below" if value <= SLACK * tolerance else "above: not converged" if kind == FAILED else OVER
        rows.append((name, (value, "1"), (tolerance, "1"), state, what))
    found = warnings(results)
    lines = [page.element("ul", *(page.element("li", one) for one in found))] if found else []
    told = page.element("p", page.element("strong", headline)), *([page.element("p", more)] if more else []), *lines
    box = page.element("div", *told, class_=f"verdict {kind}")
    table = page.table(
        "Largest relative errors of all steps, recomputed from tractions and rigid-body displacements alone",
        ("error", "largest", "tolerance", "state", "of"), rows, (4,)
    )  # fmt: skip
    note = "The messages about steps that have failed are on the run's stderr alone."
    return page.section("Check", box, table, *([page.element("p", note)] if kind == FAILED else []))

"""The tables of a report: inputs, numbers of the last step with their errors, history, cases of a study."""

import math
import shlex

import numpy as np

from ..core.declared import OPTIONS
from ..core.errors import counted
from . import noise, page

ROWS = 20  # of a history or of a study
MOST = 14  # columns of a study
PORTRAIT = 6  # columns of a history beside step and time from which paper is turned
ABOUT = (
    "CLASS", "Conventions", "NAME", "closed", "fixed_parameters", "options", "part_identity", "petsam_version",
    "source", "title", "traction_error",
)  # attributes that are no inputs  # fmt: skip
WORK = ("_iterations", "_applies", "_preconditions", "_residual")  # ends of the names of numbers about the solution
BY_STEP = {"dissipated_energy": "energy_error"}  # numbers and columns with their errors by the length of the load step
CLOSED = "_closed"  # end of the name of a number in closed form, which stands below that number
PLACE = ("_x", "_y", "_z")  # ends of the names of the places of a stress
SAME = 1e-6  # relative difference of a number and the one that its error is of
UNKNOWN = 0.995  # error of a number from which on it is printed as unknown, as by the program
COLUMNS = (
    "load_n", "load_tx", "load_ty", "load_mx", "load_my", "load_mz", "disp_z", "disp_x", "disp_y", "creep_x", "creep_y",
    "contact_area", "stick_area", "pressure_max", "shear_max", "slip_max", "dissipated_energy", "wear_volume1",
    "wear_volume2",
)  # of the history  # fmt: skip
ALWAYS = ("contact_area", "pressure_max")


def given(results):
    """The options of the run's command line and files, (name, value) each; none where the file does not say."""
    text = str(results.parameters.get("options", ""))
    try:
        words = shlex.split(text)
    except ValueError:  # quotes that do not close
        words = text.split()
    found = []
    for word in words:
        if word.startswith("-") and not word[1:2].isdigit() and word[1:2] != ".":
            found.append((word, []))
        elif found:
            found[-1][1].append(word)
    return [(name, " ".join(values)) for name, values in found]


def _value(value):
    if isinstance(value, bytes):
        value = value.decode("utf-8", "replace")
    if np.ndim(value):
        return ", ".join(f"{one:g}" if np.issubdtype(type(one), np.number) else str(one) for one in np.ravel(value))
    return f"{value:.10g}" if np.issubdtype(type(value), np.number) else str(value)


def as_input(name, value, options):
    """The row of an input: its name, its value with the unit, and how it was given."""
    unit = OPTIONS.get(name, "")
    number = np.ndim(value) == 0 and np.issubdtype(type(value), np.number) and math.isfinite(value)
    infinite = isinstance(value, float) and math.isinf(value)
    if number:
        shown = page.quantity(float(value), unit, 10)
    else:
        shown = page.text(_value(value) + (f" {unit}" if unit and not infinite else ""))
    return name, shown, options.get("-" + name, "")


def _command(program, options):
    """A command as it is typed, with an option in a line."""
    words = [program, *(" ".join(part).strip() for part in options)]
    return page.element("pre", page.element("code", page.Html(" \\\n  ".join(page.text(word) for word in words))))


def inputs(results):
    """The command and all parameters with their units."""
    options = given(results)
    parts = [_command(results.program, options)] if options else []
    named, known = dict(options), [name for name in results.parameters if name not in ABOUT]
    rows = [as_input(name, results.parameters[name], named) for name in known]
    rows += [(name[1:], value, value) for name, value in options if name[1:] not in known]
    what = f"All {counted(len(rows), 'parameter')}, in SI units with prefixes"
    table = page.table(what, ("option", "value", "given as"), rows, (1, 2))
    return page.section("Inputs", *parts, table, class_="page")


def of_inputs(inputs):
    """The section of inputs {name: value} of what an application has found, in a list; empty without any."""
    if not inputs:
        return []
    rows = [as_input(name, value, {}) for name, value in inputs.items()]
    caption = f"{counted(len(rows), 'input')}, in SI units with prefixes unless given with a unit"
    table = page.table(caption, ("name", "value"), [row[:2] for row in rows], (1,))
    return [page.section("Inputs", table, class_="page")]


def shared(study):
    """The section of the options that all cases of a study have."""
    rows = given(study)
    if not rows:
        return ""
    varied = ", ".join(study.inputs)
    said = f"{counted(len(rows), 'option')} of all cases" + (f"; besides, each has its own {varied}" if varied else "")
    table = page.table(said, ("option", "given as"), [(name[1:], value) for name, value in rows], (1,))
    return page.section("Inputs", _command("petsam", rows), table, class_="page")


# ---------------------------------------------------------------- numbers


def is_known(error):
    """True if an error relative to a number is one that the program prints."""
    return error < UNKNOWN  # not NaN either


def percent(error):
    """A relative error as a text."""
    return "unknown" if not math.isfinite(error) else f"{100.0 * error:.2g} %"


def relative(value, unit, error, cause=""):
    """An error relative to a number: in percent, in its unit, and what it comes from."""
    if not is_known(error):
        return page.Html("&plusmn; unknown")
    size = page.quantity(abs(value) * error, unit, 2, abs(value))
    return page.Html(f"&plusmn; {percent(error)} (&plusmn; {size}){page.text(cause and f', by the {cause}')}")


def absolute(size, unit, value, cause=""):
    """An error with the prefix of its number, and what it comes from; nothing where it is 0 or unknown."""
    if not size > 0.0:
        return ""
    return page.Html(f"&plusmn; {page.quantity(size, unit, 2, abs(value))}{page.text(cause and f', by the {cause}')}")


def estimate(one):
    """The error of a number of /errors."""
    return relative(one.value, one.unit, one.error, one.cause)


def _is_same(value, other):
    return math.isclose(value, other, rel_tol=SAME, abs_tol=0.0)


def _error(results, name, row, of):
    """The error of a number of the history: as /errors has it, of others as a column of the history has it; of stresses
    that of the tractions."""
    value, unit = float(results.history[name][row]), results.units[name]
    if of and _is_same(of.value, value):
        return estimate(of)
    if results.program != "petsam":
        error = float(results.parameters.get("traction_error", math.nan))
        return relative(value, unit, error, "tractions") if unit == "Pa" and error > 0.0 else ""
    sizes = [
        (float(results.history[column][row]), cause)
        for column, cause in ((f"{name}_error", ""), (BY_STEP.get(name), "load step"))
        if column in results.history
    ]
    return next(filter(None, (absolute(size, unit, value, cause) for size, cause in sizes)), "")


def _beside(results, name, ends):
    """True if a column belongs to another one, whose name lacks one of these ends."""
    return any(name.endswith(end) and name.removesuffix(end) in results.history for end in ends)


def _meaning(results, name, row):
    """Returns the meaning of a number; for the maximum of a stress also its place."""
    text = results.meaning(name)
    places = [name + end for end in PLACE if name + end in results.history] if results.program != "petsam" else []
    if not places:
        return text
    values = [float(results.history[one][row]) for one in places]
    size = page.largest(values)
    where = ", ".join(page.quantity(value, results.units[one], beside=size) for one, value in zip(places, values))
    axes = ", ".join(one[-1] for one in places)
    return page.Html(f"{page.text(text)}{' ' if text else ''}at {axes} = {where}")


def _is_shown(results, name, value, known):
    """True if a number adds something to the check, the errors of others and rounding."""
    if name in ("status", "time") or name.endswith(WORK) or not math.isfinite(value):
        return False
    if name in BY_STEP.values() or _beside(results, name, ("_error",)):
        return False
    if results.program != "petsam" and _beside(results, name, PLACE):
        return False
    return abs(value) >= noise.NOISE * known.get(results.units[name], 0.0)


def numbers(results, row):
    """The numbers of a row of the history, those with errors first, and the heads of their columns."""
    errors = dict(getattr(results, "errors", {}))
    known = noise.scales([results]) if results.program == "petsam" else {}
    rows = []
    for name, values in results.history.items():
        value = float(values[row])
        if _is_shown(results, name, value, known):
            error = _error(results, name, row, errors.get(name))
            rows.append((name, (value, results.units[name]), error, _meaning(results, name, row)))
    rows += [
        (f"{name}, sum", (one.value, one.unit), estimate(one), "over the steps of the run")
        for name, one in errors.items()
        if not (name in results.history and _is_same(one.value, float(results.history[name][row])))
    ]
    if any(row[2] for row in rows):
        wrong = {name for name, _, error, _ in rows if error}
        rows.sort(key=lambda row: row[0].removesuffix(CLOSED) not in wrong)
        return rows, ("number", "value", "error", "meaning")
    return [(name, value, meaning) for name, value, _, meaning in rows], ("number", "value", "meaning")


def of_last(results, row):
    """The section of the numbers of the last step that has a solution."""
    rows, heads = numbers(results, row)
    number = row + 1 + getattr(results, "before", 0)
    step = int(results.history["step"][row]) if "step" in results.history else number
    left = "; numbers that are zero to rounding are left out" if results.program == "petsam" else ""
    what = f"Load step {step}, t = {results.history['time'][row]:.6g} s{left}"
    lacks = results.program == "petsam" and not results.errors
    note = "The file has no errors of its numbers by the cells: run petsam with -errors companion." if lacks else ""
    return page.section(
        "Numbers of the last step",
        page.table(what, heads, rows, (len(heads) - 1,)),
        *([page.element("p", note)] if note else []),
    )


# ---------------------------------------------------------------- tables


def some(count):
    """Indices of the rows that are shown, the first and the last among them."""
    return np.unique(np.linspace(0, count - 1, min(count, ROWS)).round().astype(int)).tolist()


def rest(count, noun):
    """How many rows a table has, and how many of them are shown."""
    return f"{counted(count, noun)}" if count <= ROWS else f"{ROWS} of {counted(count, noun)}, chosen evenly"


def history(results, columns=COLUMNS):
    """The section of the history: at most ROWS load steps, and the columns that vary."""
    count = results.history["time"].size
    if results.program == "petsam":
        known = noise.scales([results])
        names = [name for name in columns if name in results.history]
        names = [name for name in names if name in ALWAYS or noise.varies([results], name, known)]
        first = [int(results.before) + 1 + row for row in range(count)]
    else:
        names = [name for name in results.history if name not in ("step", "time")][:12]
        first = results.steps
    rows = [
        (str(first[row]), (float(results.history["time"][row]), "s"))
        + tuple((float(results.history[name][row]), results.units[name]) for name in names)
        for row in some(count)
    ]
    left = "; numbers that do not vary are left out" if results.program == "petsam" else ""
    caption = f"{rest(count, 'load step')}{left}"
    shape = "page many" if len(names) > PORTRAIT else "page"  # of paper
    return page.section("History", page.table(caption, ("step", "time", *names), rows), class_=shape)


def life(results):
    """The section of the computed cycles of a life."""
    count = min(values.size for values in results.wear.values())
    names = [name for name in results.wear if name not in ("cycle", "computed")]
    rows = [
        (f"{results.wear['cycle'][row]:.10g}",)
        + tuple((float(results.wear[name][row]), results.wear_units[name]) for name in names)
        for row in some(count)
    ]
    return page.section("Life", page.table(rest(count, "computed cycle"), ("cycles before", *names), rows))


def beside(value, unit, size, largest):
    """A number with its error, both with the prefix of the column's largest number."""
    shown = [page.quantity(value, unit, 6, largest), " \N{PLUS-MINUS SIGN} ", page.quantity(size, unit, 2, largest)]
    return page.Html("".join(page.text(one) for one in shown))


def _case(study, name, case):
    """A cell of a study: a text, or a number with its error."""
    values, unit = study.column(name)
    if values.dtype.kind not in "biuf":
        return str(values[case])
    unit = study.unit_of_input(name) if name in study.inputs else unit
    value, own = float(values[case]), name.removesuffix("_end")
    error = next((one for one in (f"{own}_error", BY_STEP.get(own)) if one in study.results), None)
    if name in study.inputs or error is None:
        return value, unit
    return beside(value, unit, float(study.results[error][case]), page.largest(values))


def _columns(study):
    """The columns of a study that are shown: inputs that vary, results that do, and then others, at most MOST."""
    errors = [*(f"{name}_error" for name in study.results), *BY_STEP.values()]
    names = [name for name in study.names if name not in errors]
    varying = [name for name in names if len(set(study.column(name)[0][study.codes == 0].tolist())) > 1]
    inputs = [name for name in names if name in study.inputs]
    first = [*inputs, *(name for name in varying if not name.endswith(WORK))]
    first.sort(key=lambda name: (name not in inputs, name not in varying))
    return list(dict.fromkeys([*first, *names]))[:MOST], len(names)


def cases(study):
    """The section of the cases of a study."""
    names, there = _columns(study)
    rows = [
        (study.cases[case], str(study.codes[case]), *(_case(study, name, case) for name in names))
        for case in some(study.cases.size)
    ]
    failed = int(np.sum(study.codes != 0))
    words = f"{counted(study.cases.size, 'case')}, {failed} of them failed or not run."
    kind = "verdict warning" if failed else "verdict fine"
    verdict = page.element("p", words if failed else "All cases finished.", class_=kind)
    left = f"; {len(names)} of {there} columns" if len(names) < there else ""
    caption = rest(study.cases.size, "case") + left
    return page.section("Cases", verdict, page.table(caption, ("case", "exit code", *names), rows))

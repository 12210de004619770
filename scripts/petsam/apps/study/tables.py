"""The results table of a study: one row per case, with inputs and the scalars of its last load step, as CSV and HDF5.

CSV: case, exit_code (empty: not run), seconds [s], ranks, the inputs as they were given, and with heads `name [unit]`
steps, the names of petsam's /history (those of the last step, with NaN for what is unknown if it has no solution;
`dissipated_energy_sum` of all steps that have one; with -errors companion NAME_error, in the unit of NAME); message,
the reason of a failure, or of a finished case `warning: ` and its first warning. A scalar that has an input's name gets
`_end` added. Of histories with cycles (petsam.cycles) there are also `cycles`, their number, `energy_ratio_cycle_last`,
`sliding_ratio_cycle_last` and `loss_factor_cycle_last` (petsam.sliding), of bodies that relax
`viscous_energy_cycle_last`, `dissipated_energy_cycle_last`, and `dissipated_energy_cycle_change`, by which the last
cycle differs from the one before, relative to it; and `dissipated_energy_cycle_K` of the chosen cycles K. `regime` is 0
where all steps stick, 1 of partial slip, 2 of gross slip (also where a step was rejected for it), 3 where some cycles
are of gross slip and others are not. Where petsam-stress runs too, `mises_max` and so on are the largest of its
/history, and `swt_max` and so on those of its fatigue parameters. Columns of the table's `results` follow.

HDF5: the same in /case, /exit_code (-1: not run), /seconds, /ranks, /message, and in the groups /inputs and /results,
NaN where there is no value; the attribute `options` holds those of all cases, and /cases/NAME links to the case's own
results file.
"""

import math
import os
import re
from typing import NamedTuple, Optional

import h5py
import numpy as np

from ...core.errors import Error
from ...core.hdf5 import DAMAGED, replacing
from ...core.tables import Column, csv_text
from ...results import cycles, sliding
from ...results.file import Results
from ...results.stresses import Stresses
from .expressions import Expander
from .runs import LATER, RESULTS, STRESSES, record, write_atomically

ENERGY = "dissipated_energy"
GROSS = re.compile(r"(step \d+: )?gross slip: ")  # what petsam says of a load that cannot be balanced


class Figures(NamedTuple):
    """How cycles are found (turns, period: of cycles.find) and which energies are wanted besides the last one's."""

    turns: Optional[str] = None
    period: Optional[tuple] = None
    numbers: tuple = ()


LAST = Figures()


def of_cycles(results, figures):
    """Name: (value, unit) from the cycles of a file, empty where it has none; NaN for missing cycles."""
    whole = []
    if results.has_life:
        energies, count = results.wear[ENERGY], results.wear["cycle"][-1].item()
        by_number = dict(zip(results.wear["cycle"].tolist(), energies.tolist()))
    elif results.solved.size:
        whole = cycles.find(results, figures.turns, figures.period)
        energies = whole.energies
        count, by_number = energies.size, dict(enumerate(energies.tolist(), 1))
        by_number.update({number - energies.size - 1: value for number, value in list(by_number.items())})
    else:
        return {}
    if not energies.size and not (figures.turns or figures.period or figures.numbers):
        return {}
    unit = (results.wear_units if results.has_life else results.units)[ENERGY]
    last, before = [*[float("nan")] * 2, *energies.tolist()][:-3:-1]
    found = {"cycles": (count, "1"), ENERGY + "_cycle_last": (last, unit)}
    found[ENERGY + "_cycle_change"] = (last / before - 1.0 if before else float("nan"), "1")
    found.update(_ratios(results, whole))
    for number in figures.numbers:
        found[f"{ENERGY}_cycle_{number}"] = (by_number.get(number, float("nan")), unit)
    return found


def _ratios(results, whole):
    """Energy ratio, sliding ratio and loss factor of the last of some cycles, and the energy by bodies that relax."""
    if not len(whole) or whole.pair is None:
        return {}
    last = sliding.numbers(results, whole.numbered(-1), whole.pair)
    names = "energy_ratio", "sliding_ratio", "loss_factor"
    found = {f"{name}_cycle_last": (getattr(last, name), "1") for name in names}
    if "viscous_energy" in results.history:
        found["viscous_energy_cycle_last"] = (last.viscous, results.units["viscous_energy"])
    return found


def _regime(results, figures):
    """Code of the regime: of all cycles, or without any of all steps."""
    whole = [] if results.has_life else cycles.find(results, figures.turns, figures.period)
    parts = [cycle.rows for cycle in whole] or [slice(None)]
    return sliding.REGIMES.index(sliding.regime(results, *parts))


def scalars(path, figures=LAST):
    """Name: (value, unit) of a results file's last load step, empty where there is none that can be read; and what is
    wrong with the cycles asked for."""
    try:
        with Results(path) as results:
            found = {"steps": (results.history["time"].size, "1")}
            for name, values in results.history.items():
                if values.ndim == 1:
                    found[name] = (values[-1].item(), results.units[name])
            if results.is_steady:
                return found, None
            # without any solution the energy is unknown, not zero
            total = float(np.sum(results.series(ENERGY))) if results.solved.size else np.nan
            found[ENERGY + "_sum"] = (total, results.units[ENERGY])
            if ENERGY in results.errors:
                row = results.errors[ENERGY]
                found[ENERGY + "_sum_error"] = (row.error * abs(row.value), results.units[ENERGY])
            try:
                if results.solved.size and "stick_area" in results.history:
                    found["regime"] = (_regime(results, figures), "1")
                return {**found, **of_cycles(results, figures)}, None
            except Error as error:
                return found, str(error)
    except (Error, *DAMAGED):
        return {}, None


def _stresses(path):
    """Name: (value, unit) of the maxima in a file of petsam-stress; empty where there is none that can be read."""
    try:
        with Stresses(path) as file:
            names = [name for name in file.history if name.endswith("_max")]
            found = {name: (float(np.max(file.history[name])), file.units[name]) for name in names}
            for name in file.fatigue:
                values = file.field(name)
                if np.isfinite(values).any():
                    found[name + "_max"] = (float(np.nanmax(values)), file.unit(name))
            return found
    except (Error, *DAMAGED):
        return {}


def _of_case(folder, figures, with_stress):
    """scalars() of a case's folder, with the maxima of its stresses."""
    values, complaint = scalars(os.path.join(folder, RESULTS), figures)
    return {**values, **(_stresses(os.path.join(folder, STRESSES)) if values and with_stress else {})}, complaint


def _expressed(case, values):
    """Name: (value, unit) of the table's expressions, NaN without a value; and the first thing wrong, or None."""
    known = {name + "_end" if name in case.values else name: repr(value) for name, (value, _) in values.items()}
    known.update({name: text for name, text in case.values.items() if text is not None})
    known.update({name: f"{{{expression}}}" for name, expression in case.results.items()})
    expander, found, complaint = Expander(known), {}, None
    for name in case.results:
        try:
            found[name] = (float(expander.text(name)), case.units.get(name, "1"))
        except ValueError as error:
            expander.open.clear()
            found[name] = (math.nan, case.units.get(name, "1"))
            complaint = complaint or f"case {case.name}: results: {name}: {error}"
    return found, complaint


def rows(directory, cases, figures=LAST):
    """For every case: the case, its record, its scalars (only where its record is of the same inputs); and the first
    thing that is wrong with the cycles asked for, or None."""
    records = [(case, record(directory, case)) for case in cases]
    ended = [case for case, known in records if known.get("exit_code") is not None]
    # a run that was killed may have left a damaged file
    paths = [os.path.join(directory, case.name) for case in ended]
    with_stress = any(case.stress for case in cases)
    values = [_of_case(path, figures, with_stress) for path in paths]
    known_values = {case.name: one for case, (one, _) in zip(ended, values)}
    for case, known in records:
        if case.name in known_values and GROSS.match(known.get("message") or ""):
            known_values[case.name]["regime"] = (sliding.REGIMES.index("gross slip"), "1")
    complaint = next((text for _, text in values if text), None)
    wrong = []
    for case, _ in records:
        if case.results and known_values.get(case.name):
            more, text = _expressed(case, known_values[case.name])
            known_values[case.name].update(more)
            wrong.append(text)
    complaint = complaint or (wrong[0] if wrong and all(wrong) else None)
    return [(case, known, known_values.get(case.name, {})) for case, known in records], complaint


def _names(found):
    """Names of inputs and of scalars, in order of appearance, and the scalars' units."""
    inputs = list(dict.fromkeys(name for case, _, _ in found for name in case.inputs))
    units = {name: unit for _, _, values in found for name, (_, unit) in values.items()}
    return inputs, units


def _columns(found):
    """The tables.Column of the cases; those of inputs are texts, as the study's table has them."""
    inputs, units = _names(found)
    column = [
        Column("case", "", "name", [case.name for case, _, _ in found]),
        Column("exit_code", "", "exit code of petsam", [known.get("exit_code") for _, known, _ in found]),
        Column("seconds", "s", "wall time", [known.get("seconds") for _, known, _ in found]),
        Column("ranks", "", "MPI ranks", [case.ranks for case, _, _ in found]),
    ]
    column += [Column(name, "", "input", [case.inputs.get(name) for case, _, _ in found]) for name in inputs]
    for name, unit in units.items():
        values = [values[name][0] if name in values else None for _, _, values in found]
        column.append(Column(name + "_end" if name in inputs else name, unit, "result", values))
    return [*column, Column("message", "", "petsam's words", [known.get("message") for _, known, _ in found])]


def write_csv(path, found):
    """The table as CSV."""
    write_atomically(path, csv_text(_columns(found)))


def _numbers(texts):
    """Texts as numbers where all are, else as they are."""
    try:
        return np.array([float(text) if text is not None else np.nan for text in texts])
    except ValueError:
        return None


def _encodable(text):
    """The text as HDF5 takes it: names of files need not be UTF-8."""
    return text.encode(errors="backslashreplace").decode()


def _write(group, name, values, unit=None):
    numbers = values if isinstance(values, np.ndarray) else _numbers(values)
    if numbers is None:
        group.create_dataset(name, data=[_encodable(value or "") for value in values], dtype=h5py.string_dtype())
    else:
        group.create_dataset(name, data=numbers)
    if unit:
        group[name].attrs["units"] = unit


def write_hdf5(path, found, study):
    """The table as HDF5."""
    inputs, units = _names(found)
    shared = set.intersection(*[set(case.options.items()) for case, _, _ in found])
    with replacing(path) as file:
        words = ("-" + name + (" " + value if value else "") for name, value in sorted(shared, key=str))
        file.attrs["study"], file.attrs["options"] = _encodable(study), _encodable(" ".join(words))
        for name, values in (
            ("case", [case.name for case, _, _ in found]),
            ("message", [known.get("message", "") for _, known, _ in found]),
        ):
            file.create_dataset(name, data=values, dtype=h5py.string_dtype())
        codes = [known.get("exit_code") for _, known, _ in found]
        _write(file, "exit_code", np.array([-1 if code is None else code for code in codes], dtype=int))
        _write(file, "ranks", np.array([case.ranks for case, _, _ in found]))
        _write(file, "seconds", np.array([known.get("seconds", np.nan) for _, known, _ in found]), "s")
        for name in inputs:
            _write(file.require_group("inputs"), name, [case.inputs.get(name) for case, _, _ in found],
                   found[0][0].units.get(name))  # fmt: skip
        for name, unit in units.items():
            values = np.array([values[name][0] if name in values else np.nan for _, _, values in found])
            _write(file.require_group("results"), name, values, unit)
        links = file.create_group("cases")
        for case, _, values in found:
            if values:
                _link_parts(links, os.path.dirname(path), case.name)


def _link_parts(links, directory, case):
    """Links to the results of a case: under its name the first part, then CASE.part2, ... of a run that went on."""
    number, file = 1, RESULTS
    while number == 1 or os.path.exists(os.path.join(directory, case, file)):
        links[case if number == 1 else f"{case}.part{number}"] = h5py.ExternalLink(os.path.join(case, file), "/")
        number += 1
        file = LATER.format(number)


def write(directory, cases, study, figures=LAST):
    """Both tables; their names, and the error in the chosen cycles, or None."""
    found, complaint = rows(directory, cases, figures)
    names = [os.path.join(directory, "results" + ending) for ending in (".csv", ".h5")]
    write_csv(names[0], found)
    write_hdf5(names[1], found, study)
    return names, complaint

"""The results table of a study: a row a case, with inputs and the scalars of its last load step, as CSV and HDF5.

CSV: case, exit_code (empty: not run), seconds, ranks, the inputs, `steps`, the names of petsam's /history (those of the
last step, with NaN for what is unknown if it has no solution; `dissipated_energy_sum` of all steps that have one),
message. A scalar that has an input's name gets `_end` added.

HDF5: the same in /case, /exit_code (-1: not run), /seconds, /ranks, /message, and in the groups /inputs and /results,
NaN where there is no value; the attribute `options` holds those of all cases, and /cases/NAME links to the case's own
results file.
"""

import csv
import io
import os

import h5py
import numpy as np

from .. import isolation
from ..errors import Error
from ..files import need_replaceable
from ..results import DAMAGED, Results
from .runs import RESULTS, record, write_atomically


def scalars(path):
    """Name: (value, unit) of a results file's last load step, empty where there is none that can be read."""
    try:
        with Results(path) as results:
            found = {"steps": (results.history["time"].size, "1")}
            for name, values in results.history.items():
                if values.ndim == 1:
                    found[name] = (values[-1].item(), results.units[name])
            energy = "dissipated_energy"
            # without any solution the energy is unknown, not zero
            total = float(np.sum(results.series(energy))) if results.solved.size else np.nan
            found[energy + "_sum"] = (total, results.units[energy])
            return found
    except (Error, *DAMAGED):
        return {}


def rows(directory, cases):
    """For every case: the case, its record, its scalars (only where its record is of the same inputs)."""
    records = [(case, record(directory, case)) for case in cases]
    ended = [case for case, known in records if known.get("exit_code") is not None]
    # a run that was killed may have left a damaged file
    values = list(isolation.each(scalars, [os.path.join(directory, case.name, RESULTS) for case in ended]))
    known_values = {case.name: {} if isinstance(one, Error) else one for case, one in zip(ended, values)}
    return [(case, known, known_values.get(case.name, {})) for case, known in records]


def _names(found):
    """Names of inputs and of scalars, in order of appearance, and the scalars' units."""
    inputs = list(dict.fromkeys(name for case, _, _ in found for name in case.inputs))
    units = {name: unit for _, _, values in found for name, (_, unit) in values.items()}
    return inputs, units


def write_csv(path, found):
    """The table as text."""
    inputs, units = _names(found)
    text = io.StringIO()
    table = csv.writer(text, lineterminator="\n")
    table.writerow(
        [
            "case",
            "exit_code",
            "seconds",
            "ranks",
            *inputs,
            *[name + "_end" if name in inputs else name for name in units],
            "message",
        ]
    )
    for case, known, values in found:
        code = known.get("exit_code")
        table.writerow(
            [
                case.name,
                "" if code is None else code,
                known.get("seconds", ""),
                case.ranks,
                *[case.inputs.get(name, "") for name in inputs],
                *[repr(values[name][0]) if name in values else "" for name in units],
                known.get("message", ""),
            ]
        )
    write_atomically(path, text.getvalue())


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
    need_replaceable(path + ".tmp")
    with h5py.File(path + ".tmp", "w") as file:
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
            _write(file.require_group("inputs"), name, [case.inputs.get(name) for case, _, _ in found])
        for name, unit in units.items():
            values = np.array([values[name][0] if name in values else np.nan for _, _, values in found])
            _write(file.require_group("results"), name, values, unit)
        links = file.create_group("cases")
        for case, _, values in found:
            if values:
                links[case.name] = h5py.ExternalLink(os.path.join(case.name, RESULTS), "/")
    os.replace(path + ".tmp", path)


def write(directory, cases, study):
    """Both tables; their names."""
    found = rows(directory, cases)
    names = [os.path.join(directory, "results" + ending) for ending in (".csv", ".h5")]
    write_csv(names[0], found)
    write_hdf5(names[1], found, study)
    return names

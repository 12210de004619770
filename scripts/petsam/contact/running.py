"""Runs of the program petsam from Python, without a shell: petsam.run()."""

import multiprocessing.util
import os
import shutil
import signal
import subprocess
import tempfile
import warnings
from collections.abc import Callable, Mapping
from typing import Any, Optional

import numpy as np

from ..core import arrays, environment
from ..core import options as command_line
from ..core.errors import EDGE, UNBALANCED, UNSETTLED, Error, short
from ..core.hdf5 import replacing
from ..results.file import Results
from .errors import AdviceWarning, error_of

_SOLVED = (0, UNSETTLED, UNBALANCED, EDGE)  # exit codes of runs that have written results


def run(
    options: Optional[Mapping] = None, /, *, history: Any = None, ranks: int = 1,
    report: Optional[Callable[[str], object]] = None, **more: Any,
) -> Results:  # fmt: skip
    """Runs petsam with these options, and returns its Results: petsam.run(grid_n=64, load_n=100, ...).

    Parameters
    ----------
    options : mapping, optional
        Names and values of options of the program without the dash, as a mapping, as keywords, or as both: a number,
        a text, True or False, a path, or a sequence of numbers or texts; None leaves the option out. Two may be
        arrays of the cells, (ny, nx) or in plane strain (nx,), whose rows are y, the first the smallest: `gap`, the
        separation of the undeformed bodies, m, over a surface of `grid_size`, and `friction`; `grid_n` is theirs
        unless it is given.
    history : mapping, DataFrame, structured array or path, optional
        Loads and conditions over time: each column has the value of each row, and `time` is 1, 2, ... unless it is
        given, as a column or as the index of a DataFrame.
    ranks : int
        Number of MPI ranks; more than 1 are started by the launcher in $MPIRUN, or mpirun.
    report : callable, optional
        Called with each line that the program prints, for example print; None: it prints nothing.
    **more
        Options as keywords.

    Returns
    -------
    Results

    Raises
    ------
    ContactError
        With the program's code and message: NotConverged or NoEquilibrium if a step has no solution, EdgeContact if
        the contact reaches the edge of the grid, unless `allow_edge_contact` is given; its attribute `results` then
        has the steps so far, and is None for other errors.
    Error
        If an argument cannot be given to the program, or there is no program.

    Notes
    -----
    The results are written to the file that the option `output` names. Without it they are in a temporary file, which
    exists as long as the Results do. Files that options name are relative to the working directory.

    The program's warnings are issued as AdviceWarning.
    """
    given = {**(options or {}), **more}
    command_line.one_case([*given, "output", "history", "quiet"])
    folder, process = tempfile.mkdtemp(prefix="petsam-"), os.getpid()
    try:
        if history is not None and given.get("history") is not None:
            raise Error("history: given both as an argument and as an option: give one of them")
        history = given.pop("history", None) if history is None else history
        if isinstance(history, np.ndarray) and history.dtype.names:
            history = {name: history[name] for name in history.dtype.names}
        if isinstance(history, Mapping) or hasattr(history, "columns"):
            history = _write_history(os.path.join(folder, "history.csv"), history)
        given.update(_fields(folder, given))
        if given.get("output") is None:
            given["output"] = os.path.join(folder, "results.h5")
        output = given["output"]
        if not isinstance(output, (str, os.PathLike)):
            raise Error(f"output: expected the path of a file, not {short(repr(output))}")
        given["quiet"] = report is None
        given["history"] = history
        code, complaint = _execute(_command(ranks) + command_line.words(given), report)
        for name in ("history.csv", "gap.h5", "friction.h5"):
            complaint = [line.replace(os.path.join(folder, name), name.partition(".")[0]) for line in complaint]
        results = Results(output) if code in _SOLVED and os.path.exists(output) else None
    except BaseException:
        _remove(folder, process)
        raise
    if results is None:
        _remove(folder, process)
    else:
        results.temporary = os.path.dirname(results.path) == folder
        # also at the end of a worker of multiprocessing, which calls no other finalizers
        multiprocessing.util.Finalize(results, _remove, (folder, process), exitpriority=0)
    _finish(code, complaint, results)
    if results is None:
        raise Error(f"petsam has written no results to {short(output)}")
    return results


def _fields(folder, given):
    """Options for a gap and a friction that are arrays, which are written to files in the folder."""
    options = {}
    for name in ("gap", "friction"):
        values = given.get(name)
        if values is None or isinstance(values, str) or np.ndim(values) == 0:
            continue
        file = f"{name}_file"
        if given.get(file) is not None:
            raise Error(f"{name}: an array and {file} are both given: remove one of them")
        try:
            values = arrays.real(values)
        except (TypeError, ValueError):
            values = np.zeros(0)
        values = values[np.newaxis] if values.ndim == 1 and values.size else values
        if values.ndim != 2 or not np.all(np.isfinite(values)):
            raise Error(f"{name}: expected finite numbers, an array of shape (ny, nx)")
        path, dataset = os.path.join(folder, f"{name}.h5"), "separation" if name == "gap" else name
        with replacing(path) as out:
            out[dataset] = values
            if name == "gap":
                out[dataset].attrs.update(units="m", quantity="separation")
        options.update({name: None, file: path, f"{name}_dataset": dataset})
        if given.get("grid_n") is None:
            options["grid_n"] = values.shape[1] if values.shape[0] in (1, values.shape[1]) else values.shape[::-1]
    return options


def _remove(folder, process):
    """Removes a temporary folder, which a copy of the process that has made it does not own."""
    if os.getpid() == process:
        shutil.rmtree(folder, ignore_errors=True)


def _command(ranks):
    if isinstance(ranks, bool) or not isinstance(ranks, (int, np.integer)) or ranks < 1:
        raise Error(f"ranks {short(repr(ranks))}: expected an integer >= 1")
    words = environment.command()(ranks) if ranks > 1 else [environment.petsam()]
    cores = environment.cores()
    if ranks > cores and environment.is_local(words):
        text = f"ranks={ranks}: this process may use {cores} cores; more ranks take turns, and are slower: use fewer"
        warnings.warn(text, AdviceWarning, stacklevel=3)
    return words


def _write_history(path, table):
    """Writes the columns of a table as a file of loads; returns its path."""
    columns = {str(name): _column(str(name), table[name]) for name in table}
    command_line.one_case(columns, "history: ")
    index = getattr(table, "index", None)
    if getattr(index, "name", None) == "time":
        columns.setdefault("time", _column("time", index))
    count = max((len(values) for values in columns.values()), default=0)
    if not count:
        raise Error("history: expected at least one column and one row")
    columns = {"time": columns.pop("time", np.arange(1.0, count + 1)), **columns}
    for name, values in columns.items():
        if len(values) != count:
            raise Error(f"history: {short(name)} has {values.size} values, and other columns {count}")
        if "," in name or "\n" in name:
            raise Error(f"history: {short(repr(name))} is no name of a column")
    with open(path, "w", encoding="utf-8") as file:
        file.write(",".join(columns) + "\n")
        file.writelines(",".join(repr(float(value)) for value in row) + "\n" for row in zip(*columns.values()))
    return path


def _column(name, values):
    """The values of a column of loads."""
    try:
        values = np.atleast_1d(arrays.real(values))
    except (TypeError, ValueError):
        values = np.full(1, np.nan)
    if values.ndim != 1 or not np.all(np.isfinite(values)):
        raise Error(f"history: {short(name)}: expected finite numbers, one for each row")
    return values


def _execute(words, report):
    """Runs a command; returns its exit code, and the lines that it has written about errors."""
    with tempfile.TemporaryFile() as complaint:
        process = environment.start(
            words, stdout=subprocess.PIPE, stderr=complaint, text=True, errors="replace",
            follows=True,
        )  # fmt: skip
        try:
            for line in process.stdout:
                if report:
                    report(line.rstrip("\n"))
            process.wait()
        finally:  # also after an interruption, or an error of report()
            if process.poll() is None:
                process.terminate()
                try:
                    process.wait()
                finally:  # interrupted once more
                    process.kill()
            process.stdout.close()
        complaint.seek(0)
        return process.returncode, complaint.read().decode(errors="replace").splitlines()


def _said(complaint):
    """Returns the program's warnings, and its message."""
    mark, kind = "petsam: ", "warning: "
    lines = [line[len(mark) :] for line in complaint if line.startswith(mark)]
    found = [line[len(kind) :] for line in lines if line.startswith(kind)]
    return found, "; ".join(line for line in lines if not line.startswith((kind, "see petsam -help")))


def _finish(code, complaint, results):
    """Issues the warnings of a run and raises its error, which a warning that is an error does not hide."""
    advice, message = _said(complaint)
    if code == EDGE and results is not None:
        message += f"; the run ended with step {results.before + results.time.size}"
    try:
        for line in advice:
            warnings.warn(line, AdviceWarning, stacklevel=3)
    except Warning as warning:
        if code:
            raise _error(code, message or _end(code, complaint), results) from warning
        raise
    if code:
        raise _error(code, message or _end(code, complaint), results)


def _error(code, message, results):
    error = error_of(code, message)
    error.results = results
    return error


def _end(code, complaint):
    """Describes the end of a run that says nothing itself."""
    said = [line for line in complaint if any(map(str.isalnum, line))]
    how = f"signal {-code} ({signal.strsignal(-code)})" if code < 0 else f"code {code}"
    return f"petsam ended with {how}" + "".join(f": {line}" for line in said[-1:])

"""A study as a whole: Jobs has its table, folder and how cases are run; run() is all of it in one call."""

from __future__ import annotations

import os
import signal
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Optional, Union

import numpy as np
import yaml

from ...core import environment
from ...core import options as command_line
from ...core.errors import Error
from ...results.studies import Study as Results
from . import tables
from .cases import Case, common_options, read
from .reading import TableError
from .runs import STOPPED, Study, check_folders, record


@dataclass(frozen=True)
class Jobs:
    """The cases of a table and how they are run.

    Attributes
    ----------
    table : str
        Path of the table, CSV or YAML.
    directory : str
        Folder of the cases and of the tables of their results.
    words : tuple of str
        petsam's options for all cases, as words of a command line.
    ranks : int
        MPI ranks of cases without a value in the table.
    cores : int, optional
        Cores to use; None: all available to this process.
    launcher : str, optional
        Words of the MPI launcher; None: $MPIRUN, mpirun.
    checkpoint : int, optional
        Steps between checkpoints, from which a case that was stopped resumes; None: none.
    skip_failed : bool
        Whether failed cases are not run again.
    figures : study.Figures
        Cycles whose energies are columns of the tables.
    """

    table: str
    directory: str
    words: tuple = ()
    ranks: int = 1
    cores: Optional[int] = None
    launcher: Optional[str] = None
    checkpoint: Optional[int] = None
    skip_failed: bool = False
    figures: tables.Figures = tables.LAST

    def cases(self) -> list[Case]:
        """All cases of the table.

        Returns
        -------
        list of study.Case

        Raises
        ------
        TableError
            If the table cannot be understood.
        """
        return read(self.table, common_options(self.words), self.ranks)

    def prepare(self, cases: Sequence[Case]) -> None:
        """Makes the study's folder.

        Parameters
        ----------
        cases : list of study.Case
            Its cases.

        Raises
        ------
        Error
            If the results would replace another file, or `directory` is no folder.
        """
        if os.path.lexists(self.directory) and not os.path.isdir(self.directory):
            raise Error(f"{self.directory}: is not a folder; choose another by --directory")
        os.makedirs(self.directory, exist_ok=True)
        check_folders(self.directory, cases, self.table)

    def due(self, cases: Sequence[Case]) -> list[Case]:
        """The cases that have to be run.

        Parameters
        ----------
        cases : list of study.Case
            Some cases of the study.

        Returns
        -------
        list of study.Case
            Those of them that have not finished, in order; without those that failed, if skip_failed is true.
        """
        codes = [record(self.directory, case).get("exit_code") for case in cases]
        kept = lambda code: code == 0 or self.skip_failed and code not in (None, STOPPED)  # noqa: E731
        return [case for case, code in zip(cases, codes) if not kept(code)]

    def most(self, waiting: Sequence[Case], alone: bool = False) -> int:
        """The number of cores to use.

        Parameters
        ----------
        waiting : list of study.Case
            Cases that have to be run.
        alone : bool
            Whether a case that needs more cores is run alone.

        Returns
        -------
        int

        Raises
        ------
        TableError
            If a case needs more cores, unless it is run alone.
        """
        cores = self.cores or environment.cores()
        for case in waiting:
            if case.ranks > cores and not alone:
                raise TableError(
                    f"case {case.name}: {case.ranks} ranks do not fit into {cores} cores; use fewer ranks or larger "
                    "--cores"
                )
        return max([cores, *[case.ranks for case in waiting]]) if alone else cores

    def command(self) -> Callable[[int], list[str]]:
        """The words that start petsam.

        Returns
        -------
        callable
            Returns, as command(ranks), the words for this number of MPI ranks.

        Raises
        ------
        Missing
            If there is no launcher or program.
        """
        return environment.command(self.launcher)

    def write(self, cases: Sequence[Case]) -> tuple[list[str], Optional[str]]:
        """Writes the tables of the results.

        Parameters
        ----------
        cases : list of study.Case
            The cases, a row each.

        Returns
        -------
        tuple
            Paths of the tables, CSV and HDF5, and the error in the chosen cycles, or None.

        Raises
        ------
        Error
            If a table cannot be written.
        """
        return tables.write(self.directory, cases, os.path.basename(self.table), self.figures)


def check_files(cases):
    """Error where a file that every case reads does not exist, so that every case would fail."""
    for name, path in cases[0].paths().items():
        if not os.path.exists(path) and all(case.paths().get(name) == path for case in cases):
            raise Error(f"-{name} {path}: no such file, and every case reads it")


def _written(table, folder):
    """The path of a YAML table in the folder, of {option: value, or a list of values}."""
    os.makedirs(folder, exist_ok=True)
    path = os.path.join(folder, "study.yaml")
    options = {}
    for name, values in table.items():
        several = values.tolist() if isinstance(values, np.ndarray) else values
        swept = isinstance(several, list)
        words = [command_line.words({str(name): one})[1] for one in (several if swept else [several])]
        options[str(name)] = words if swept else words[0]
    with open(path, "w", encoding="utf-8") as file:
        yaml.safe_dump({"options": options}, file, sort_keys=False)
    return path


def run(
    table: Union[str, os.PathLike, Mapping[str, Any]],
    directory: Union[str, os.PathLike, None] = None,
    options: Optional[dict[str, Any]] = None,
    *,
    cores: Optional[int] = None,
    report: Optional[Callable[[Case, Optional[int]], object]] = None,
    **how: Any,
) -> Results:
    """Runs all cases of a table side by side, as petsam-study does, and returns their results.

    Cases that have finished with the same inputs in this folder are not run again.

    Parameters
    ----------
    table : path or mapping
        The cases, .csv or .yaml; or {option: value}, in which each list has several values: all combinations are run.
    directory : path, optional
        Folder of the cases and of results.csv, results.h5; by default the table's name, here, or `study`.
    options : dict, optional
        petsam's options for all cases, {name without dash: value}; none that is a column or a list of the table.
    cores : int, optional
        Cores to use; by default all available to this process.
    report : callable, optional
        Called with the petsam.study.Case and its exit code (None: another study runs it) as cases end.
    **how
        Other fields of petsam.study.Jobs: ranks, checkpoint, skip_failed, launcher, and figures, a
        petsam.study.Figures(turns, period, numbers) of the cycles whose energies are columns.

    Returns
    -------
    Study
        Of results.h5: `codes` has the exit codes, 0 where a case has finished; to_xarray() and to_dataframe().

    Raises
    ------
    Error
        For a table that cannot be understood, files that cannot be read or written, and cycles that do not exist.
    KeyboardInterrupt
        At Ctrl-C, after the cases have been ended in order; the same call resumes.

    Examples
    --------
    >>> import petsam
    >>> ball = dict(gap_type="sphere", gap_radius1=5e-3, gap_radius2="inf", body1_young=210e9, body1_poisson=0.3)
    >>> ball.update(body2_young=210e9, body2_poisson=0.3, grid_n=16, grid_size=3e-4, friction=0.3, load_n=10.0)
    >>> found = petsam.study.run({"load_tx": [1.0, 2.0]}, options=ball)
    >>> found.codes.tolist()
    [0, 0]
    """
    if isinstance(table, Mapping):
        folder = os.path.abspath(directory or "study")
        path = _written(table, folder)
    else:
        path = os.fspath(table)
        folder = os.path.abspath(directory or os.path.splitext(os.path.basename(path))[0])
    jobs = Jobs(path, folder, tuple(command_line.words(options or {})), cores=cores, **how)
    cases = jobs.cases()
    check_files(cases)
    jobs.prepare(cases)
    waiting, ended = jobs.due(cases), 0
    if waiting:
        study = Study(folder, jobs.command(), jobs.most(waiting), report or _ignore, _ignore, jobs.checkpoint)
        ended = study.run(waiting)
    names, complaint = jobs.write(cases)
    if ended == signal.SIGINT:
        raise KeyboardInterrupt
    if ended or complaint:
        raise Error(complaint or f"{folder}: ended by signal {ended}; the same call resumes")
    return Results(names[-1])


def _ignore(*_):
    """Does nothing with a report."""

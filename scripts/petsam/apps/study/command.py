"""Run petsam for every case of a table, and put the results into one.

    petsam-study cases.csv -- -options_file sphere.opts -grid_n 256
    petsam-study study.yaml --cores 16 --ranks 4
    petsam-study study.yaml --slurm --sbatch "--time=2:00:00 --partition=short"

The table is CSV (one column per option, one row per case; commas or semicolons) or YAML (all combinations of lists).
Sections of a YAML table:
  options     options of petsam: a value or a list of values
  parameters  names of your own for {expressions}, likewise
  files       NAME: text of a file that each case gets in its folder, with {expressions}; an option refers to NAME
  ranks       MPI ranks of a case
  stress      options of petsam-stress, which runs after each case; its maxima are columns, such as swt_max
  results     NAME: expression of results, inputs and one another, a column of the table, such as
              life: life_swt(swt_max, 115e9, 2.03e9, -0.104, 0.841, -0.69)

  options: {history: cycle.csv, load_n: 1000, friction: [0.1, 0.5]}
  files:
    cycle.csv: |
      time, load_tx
      1,    {0.8 * friction * load_n}

Options after `--` hold for all cases, and replace single values of a YAML table's `options`; columns, lists and
parameters of their names are rejected. The first warning of each case is in the column `message`. Cases run side by
side as long as their ranks fit into the cores, each in DIRECTORY/NAME. Cases that have finished with the same inputs
are not run again, so the same command resumes after an interruption (Ctrl-C, or the end of a job). The results of all
cases are written to DIRECTORY/results.csv and results.h5. A study has at most 100000 cases. petsam-plot draws
results.h5. For histories with cycles the table lists the energies of some: --turns, --period, --cycle.
"""

import os
import sys

from ...core import words
from ...core.errors import Error, counted
from ...core.line import Parser, word, wrote
from . import slurm, tables
from .jobs import Jobs, check_files
from .progress import Progress, standing, summary, warn
from .reading import TableError
from .runs import Study

MOST = 1 << 30  # maximum of numbers on the command line


POSITIVE = word(words.integer, f"an integer from 1 to {MOST}", least=1, most=MOST)


def _cycle_options(parser):
    of_cycles = parser.add_argument_group("energies of cycles in the table")
    parser.add_cycles(
        of_cycles, "divide cycles at the reversals of this scalar (a displacement)",
        "instead: duration of a cycle, and its start: 20ms,1s",
    )  # fmt: skip
    form = "integers separated by commas: from 1, or from -1 backwards"
    once = word(
        words.integers, form, lambda value: 0 < abs(value) <= MOST, to=lambda found: tuple(dict.fromkeys(found))
    )
    of_cycles.add_argument(
        "--cycle", type=once, metavar="K,...", default=(), help="cycles in addition to the last; -2 is the second last"
    )


def arguments():
    """Read the command line: the options, and the words after --."""
    given = sys.argv[1:]
    at = given.index("--") if "--" in given else len(given)
    parser = Parser(
        prog="petsam-study",
        texts=["--sbatch"],
        description=__doc__,
        usage="%(prog)s TABLE [option ...] [-- petsam's options for all cases]",
    )
    parser.add_argument("table", metavar="TABLE", help="cases: .csv, or .yaml")
    parser.add_argument("-d", "--directory", help="folder of the cases and the tables (the table's name, here)")
    parser.add_argument("--cores", type=POSITIVE, help="cores to use (all available to this process)")
    parser.add_argument("--ranks", type=POSITIVE, default=1, help="MPI ranks of cases without a value in the table (1)")
    parser.add_argument(
        "--launcher", metavar="WORDS", help="MPI launcher, to which -n RANKS is added ($MPIRUN, mpirun)"
    )
    parser.add_argument(
        "--checkpoint",
        type=POSITIVE,
        metavar="M",
        help="write a checkpoint every M steps; a stopped case resumes from it",
    )
    parser.add_argument("--skip-failed", action="store_true", help="do not rerun failed cases")
    parser.add_argument("--quiet", action="store_true", help="print failures only")
    what = parser.add_mutually_exclusive_group()
    what.add_argument("--list", action="store_true", help="print the cases and their status only")
    what.add_argument("--case", type=POSITIVE, metavar="K", help="run only the K-th case of --list, without tables")
    what.add_argument("--collect", action="store_true", help="write the tables only")
    what.add_argument(
        "--slurm", action="store_true", help="submit a job array of the cases, and a job that writes the tables"
    )
    parser.add_argument("--sbatch", metavar="WORDS", default="", help="options of sbatch for --slurm")
    _cycle_options(parser)
    options = parser.parse_args(given[:at])
    if options.sbatch and not options.slurm:
        parser.error("--sbatch requires --slurm")
    options.words = given[at + 1 :]
    options.directory = os.path.abspath(options.directory or os.path.splitext(os.path.basename(options.table))[0])
    return options


def run(options, jobs, cases, waiting):
    """Runs the waiting cases; returns the number of the signal that ended the study, or 0."""
    command, cores = jobs.command(), jobs.most(waiting, alone=options.case is not None)
    before = len(cases) - len(waiting)
    if not options.quiet and options.case is None:
        skipped = f" ({before} others skipped)" if before else ""
        print(f"{counted(len(waiting), 'case')}{skipped}, {counted(cores, 'core')}, {jobs.directory}", flush=True)
    progress = Progress(len(waiting), options.quiet)
    study = Study(jobs.directory, command, cores, progress.report, progress.tick, jobs.checkpoint)
    ended = study.run(waiting)
    progress.close()
    return ended


def write(options, jobs, cases):
    """Writes the tables; raises Error if the requested cycles do not exist."""
    names, complaint = jobs.write(cases)
    if not options.quiet:
        wrote(*names)
    if complaint:
        raise Error(complaint)


def chosen(options, cases):
    """All cases, or the one of --case."""
    if options.case is None:
        return cases
    if options.case > len(cases):
        raise TableError(f"--case {options.case}: use 1 to {len(cases)}")
    return cases[options.case - 1 : options.case]


def warn_of_gaps(options, cases):
    """Warnings of columns with empty cells, which leave the option out: petsam takes its default, of friction 0."""
    for name in dict.fromkeys(name for case in cases for name in case.inputs):
        without = [case.name for case in cases if name not in case.inputs]
        if without:
            print(
                f"petsam-study: warning: {options.table}: {name} is empty in {len(without)} of {len(cases)} cases, the "
                f"first {without[0]}: they run without -{name}",
                file=sys.stderr,
            )


def carry_out(options):
    """Carries out the options; returns the exit code."""
    jobs = Jobs(
        options.table, options.directory, tuple(options.words), options.ranks, options.cores, options.launcher,
        options.checkpoint, options.skip_failed, tables.Figures(options.turns, options.period, options.cycle),
    )  # fmt: skip
    cases = jobs.cases()
    if not options.quiet and options.case is None:
        warn_of_gaps(options, cases)
    if options.list:
        for case in cases:
            print(f"{case.number:5d}  {standing(jobs.directory, case):11s}  {case.name}")
        return 0
    if not options.collect:
        check_files(cases)
    jobs.prepare(cases)
    waiting = [] if options.collect else jobs.due(chosen(options, cases))
    if options.slurm:
        return slurm.submit(jobs, cases, waiting, options.sbatch)
    ended = run(options, jobs, cases, waiting) if waiting else 0
    if options.case is None:
        write(options, jobs, cases)
    code = summary(jobs.directory, chosen(options, cases))
    if not options.quiet:
        warn(jobs.directory, chosen(options, cases))
    if ended:
        print("petsam-study: interrupted; run the same command again to resume", file=sys.stderr)
    return 128 + ended if ended else code


def main():
    """Exit code: 0 all cases finished, 1 some failed or have not run, 75 some stopped early, 2 usage, 3 a file,
    128 + the signal that ended the study."""
    return carry_out(arguments())

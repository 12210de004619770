"""Run petsam for every case of a table, and put the results into one.

    petsam-study cases.csv -- -options_file sphere.opts -grid_n 256
    petsam-study study.yaml --cores 16 --ranks 4
    petsam-study study.yaml --slurm --sbatch "--time=2:00:00 --partition=short"

The table is CSV (a column an option, a row a case) or YAML (all combinations of lists of values); options after `--`
hold for all cases. Cases run side by side as long as their ranks fit into the cores, each in DIRECTORY/NAME. Cases that
have finished with the same inputs are not run again, so the same command goes on after an interruption (Ctrl-C, or the
end of a job). Results of all go to DIRECTORY/results.csv and results.h5. A study has at most 100000 cases.
petsam-plot draws results.h5. Of histories with cycles the table has the energies of some: --turns, --period, --cycle.
"""

import argparse
import os
import sys

from .. import cycles, environment
from ..errors import USAGE, Error, Parser, fail, guarded, joined, short
from ..files import same
from . import slurm, tables
from .cases import TableError, common_options, read
from .progress import Progress, standing, summary
from .runs import STOPPED, Study, check_folders, record

MOST = 1 << 30  # of numbers on the command line


def positive(text):
    """A number from 1, for argparse."""
    try:
        value = int(text)
    except ValueError:
        value = 0
    if not 1 <= value <= MOST:
        raise argparse.ArgumentTypeError(f"{short(text)}: expected a whole number from 1 to {MOST}")
    return value


def period(text):
    """Reader of T or T,START for argparse."""
    try:
        return cycles.read_period(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{short(text)}: expected a positive time, or T,START, in s") from None


def numbers(text):
    """Reader of cycles' numbers for argparse."""
    try:
        values = tuple(dict.fromkeys(int(word) for word in text.split(",")))
    except ValueError:
        values = (0,)
    if 0 in values or max(map(abs, values)) > MOST:
        raise argparse.ArgumentTypeError(f"{short(text)}: expected whole numbers from 1, or from -1, and commas")
    return values


def _cycle_options(parser):
    of_cycles = parser.add_argument_group("energies of cycles in the table")
    how = of_cycles.add_mutually_exclusive_group()
    how.add_argument("--turns", metavar="NAME", help="cycles by turning points of this scalar (a displacement)")
    how.add_argument("--period", type=period, metavar="T[,START]", help="cycles by time, s, instead")
    of_cycles.add_argument(
        "--cycle",
        type=numbers,
        metavar="K,...",
        default=(),
        help="further cycles than the last; -2 is the one before it",
    )


def arguments():
    """Read the command line: the options, and the words after --."""
    words = sys.argv[1:]
    at = words.index("--") if "--" in words else len(words)
    parser = Parser(
        prog="petsam-study",
        description=__doc__,
        usage="%(prog)s TABLE [option ...] [-- petsam's options for all cases]",
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("table", metavar="TABLE", help="cases: .csv, or .yaml")
    parser.add_argument("-d", "--directory", help="folder of the cases and the tables (the table's name, here)")
    parser.add_argument("--cores", type=positive, help="cores to use (all that this process may)")
    parser.add_argument("--ranks", type=positive, default=1, help="MPI ranks of cases whose table says nothing (1)")
    parser.add_argument(
        "--launcher", metavar="WORDS", help="MPI launcher, to which -n RANKS is added ($MPIRUN, mpirun)"
    )
    parser.add_argument(
        "--checkpoint",
        type=positive,
        metavar="M",
        help="write a checkpoint every M steps; a case that was stopped goes on from it",
    )
    parser.add_argument("--skip-failed", action="store_true", help="do not run again what has failed before")
    parser.add_argument("--quiet", action="store_true", help="print failures only")
    what = parser.add_mutually_exclusive_group()
    what.add_argument("--list", action="store_true", help="print the cases and how they stand, run nothing")
    what.add_argument("--case", type=positive, metavar="K", help="run the K-th case of --list only, write no tables")
    what.add_argument("--collect", action="store_true", help="write the tables, run nothing")
    what.add_argument("--slurm", action="store_true", help="submit a job array of the cases, and a job that collects")
    parser.add_argument("--sbatch", metavar="WORDS", default="", help="options of sbatch for --slurm")
    _cycle_options(parser)
    options = parser.parse_args(joined(words[:at]))
    if options.sbatch and not options.slurm:
        parser.error("--sbatch: is for --slurm")
    options.words = words[at + 1 :]
    options.directory = os.path.abspath(options.directory or os.path.splitext(os.path.basename(options.table))[0])
    return options


def available_cores():
    """Cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def due(options, cases):
    """Cases that are to be run, in order."""
    wanted = cases if options.case is None else cases[options.case - 1 : options.case]
    if not wanted:
        raise TableError(f"--case {options.case}: there are {len(cases)} cases")
    waiting = []
    for case in wanted:
        code = record(options.directory, case).get("exit_code")
        if code != 0 and not (options.skip_failed and code not in (None, STOPPED)):
            waiting.append(case)
    return waiting


def run(options, cases, waiting):
    """Run what waits; the number of the signal that ended it, or 0."""
    cores = options.cores or available_cores()
    words = environment.launcher(options.launcher)
    program = environment.petsam()
    for case in waiting:
        if case.ranks > cores and options.case is None:
            raise TableError(f"case {case.name}: {case.ranks} ranks do not fit into {cores} cores; see --cores")
    cores = max([cores, *[case.ranks for case in waiting]]) if options.case else cores
    before = len(cases) - len(waiting)
    if not options.quiet and options.case is None:
        print(
            "{} cases{}, {} cores, {}".format(
                len(waiting), f" ({before} more need not run)" if before else "", cores, options.directory
            ),
            flush=True,
        )
    progress = Progress(len(waiting), options.quiet)
    study = Study(
        options.directory,
        lambda ranks: [*words, "-n", str(ranks), program],
        cores,
        progress.report,
        progress.tick,
        options.checkpoint,
    )
    ended = study.run(waiting)
    progress.close()
    return ended


def prepare(options, cases):
    """Make the study's folder; Error where what is to be written there would replace something else."""
    if os.path.lexists(options.directory) and not os.path.isdir(options.directory):
        raise Error(f"{options.directory}: is not a folder; --directory names another")
    os.makedirs(options.directory, exist_ok=True)
    for name in ("results.csv", "results.h5"):
        path = os.path.join(options.directory, name)
        if same(path, options.table) or same(path + ".tmp", options.table):
            raise Error(f"{options.table}: would be replaced by the results; --directory names another folder")
    check_folders(options.directory, cases)


def write(options, cases):
    """Write the tables; Error where the cycles asked for are not there."""
    figures = tables.Figures(options.turns, options.period, options.cycle)
    names, complaint = tables.write(options.directory, cases, os.path.basename(options.table), figures)
    for name in names if not options.quiet else ():
        print("wrote " + name)
    if complaint:
        raise Error(complaint)


def carry_out(options):
    """Do what the options ask for; the exit code."""
    cases = read(options.table, common_options(options.words), options.ranks)
    if options.list:
        for case in cases:
            print(f"{case.number:5d}  {standing(options.directory, case):11s}  {case.name}")
        return 0
    prepare(options, cases)
    waiting = [] if options.collect else due(options, cases)
    if options.slurm:
        return slurm.submit(options, cases, waiting)
    ended = run(options, cases, waiting) if waiting else 0
    if options.case is not None:
        cases = cases[options.case - 1 : options.case]
    else:
        write(options, cases)
    code = summary(options.directory, cases)
    if ended:
        print("petsam-study: interrupted; the same command goes on from here", file=sys.stderr)
    return 128 + ended if ended else code


def _main():
    try:
        return carry_out(arguments())
    except (TableError, slurm.SubmitError) as error:
        return fail("petsam-study", error, USAGE)
    except Error as error:
        return fail("petsam-study", error)


def main():
    """Exit code: 0 all cases finished, 1 some failed or have not run, 75 some stopped early, 2 usage, 3 a file,
    128 + the signal that ended the study."""
    return guarded("petsam-study", _main)

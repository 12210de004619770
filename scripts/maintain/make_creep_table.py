#!/usr/bin/env python3
"""Makes the table of creep forces, or checks one on random cases.

    build/venv/bin/python scripts/maintain/make_creep_table.py make [-o build/creep-forces.bin] [--cells 96] [--jobs 2]
    build/venv/bin/python scripts/maintain/make_creep_table.py check TABLE [--cases 1000] [--cells 128]

An interrupted table is completed by the same command. The checks print median, 90 % and worst of the maximum error of
Fx/(mu N), Fy/(mu N), Mz/(mu N c), and end with code 1 if they are above --limits.
"""

import argparse
import os
import sys
import time

import creeptable
import numpy as np

from petsam.apps.wheel.creep import CreepTable
from petsam.core.errors import Error
from petsam.core.line import fail


def parser():
    """The command line."""
    made = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = made.add_subparsers(dest="command", required=True)
    make = commands.add_parser("make", help="make a table")
    make.add_argument("-o", "--output", default="build/creep-forces.bin", help="file of the table")
    make.add_argument("--nodes", type=int, nargs=4, default=creeptable.Plan.nodes, help="along a/b, v, turn, rise")
    make.add_argument("--range", type=float, nargs=2, default=(0.05, 20.0), help="first and last a/b")
    make.add_argument("--own-cases", type=int, default=creeptable.CASES, help="cases of the table's own error")
    check = commands.add_parser("check", help="check a table on random cases")
    check.add_argument("table", help="file of the table")
    check.add_argument("--cases", type=int, default=1000, help="random cases")
    check.add_argument("--seed", type=int, default=1, help="of the random numbers")
    check.add_argument("--limits", type=float, nargs=3, help="of median, 90 %% and worst")
    for one in (make, check):
        cells = creeptable.Plan.cells if one is make else 128
        one.add_argument("--cells", type=int, default=cells, help="cells of a grid along each axis")
        one.add_argument("--poisson", type=float, default=0.28 if one is make else None, help="Poisson's ratio")
        one.add_argument("--jobs", type=int, default=os.cpu_count() or 1, help="processes")
    return made


def make_table(args):
    """Makes a table and writes it."""
    plan = creeptable.Plan(tuple(args.nodes), tuple(args.range), args.cells, args.poisson)
    start = time.monotonic()
    table = creeptable.make(plan, args.output + ".parts", args.jobs, checked=(args.own_cases, 2 * args.cells))
    table.write(args.output)
    median, most, worst, count = table.error
    print(f"{args.output}: {os.path.getsize(args.output) / 1000:.0f} kB in {time.monotonic() - start:.0f} s")
    print(f"own error, {count:.0f} cases: median {median:.4f}, 90 % {most:.4f}, worst {worst:.4f}")
    return 0


def check_table(args):
    """Prints the errors of a table."""
    table = CreepTable.open(args.table)
    errors = creeptable.check(table, args.cases, args.cells, args.seed, args.poisson, args.jobs)
    found = creeptable.statistics(errors.max(axis=1))
    print("median {:.4f}, 90 % {:.4f}, worst {:.4f} of mu N".format(*found))
    for name, column in zip(("Fx", "Fy", "Mz"), errors.T):
        print("{}: median {:.4f}, 90 % {:.4f}, worst {:.4f}".format(name, *creeptable.statistics(column)))
    return int(args.limits is not None and bool(np.any(np.array(found) > args.limits)))


def main():
    args = parser().parse_args()
    try:
        return make_table(args) if args.command == "make" else check_table(args)
    except (Error, OSError) as error:
        return fail(os.path.basename(sys.argv[0]), error, 1)


if __name__ == "__main__":
    sys.exit(main())

#!/bin/sh
# A fretting pad: stick and slip, the loop of a cycle, fatigue under the pad, and the scar after 100,000 cycles.
#
#   examples/pad/run.sh
#
# Works from any directory. Environment:
#   PETSAM   the program              (build/bin/petsam of the repository)
#   NP       MPI ranks                (2)
#   GRID_N   cells in each direction  (160)
#   OUT      results and figures, relative to the repository's root  (build/pad)
#   PYTHON   a Python with scripts/requirements.txt  (build/venv/bin/python of the repository)
#   MPIRUN   the MPI launcher         (mpirun)
set -eu

here=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd)
example=pad
default_n=160
# shellcheck source=examples/common.sh
. "$here/../common.sh"

solve_quietly cycle -options_file "$here/pad.opts" -grid_n "$grid_n" -history "$here/cycle.csv" -steps 20
stress cycle fatigue -steps 81:120 -section y=0 -depths 0:3e-4:41 -quantities mises -fatigue swt
solve_quietly scar -options_file "$here/pad.opts" -grid_n "$grid_n" -history "$here/wear.csv" -steps 5 \
    -wear_coefficient1 1e-14 -wear_coefficient2 1e-14 -wear_cycles 1e5 -wear_output 0,1e5
compare

#!/bin/sh
# A mass on a spring, held by a rounded punch: response curves by harmonic balance with the contact in process, the wear
# of a million cycles at a peak, and response curves of the worn joint.
#
#   examples/vibrating-joint/run.sh
#
# Works from any directory. Environment:
#   PETSAM     the program              (build/bin/petsam of the repository)
#   NP         processes, and MPI ranks (2)
#   GRID_N     cells in each direction  (64)
#   OUT        results and figures, relative to the repository's root  (build/vibrating-joint)
#   PYTHON     a Python with scripts/requirements.txt  (build/venv/bin/python of the repository)
#   MPIRUN     the MPI launcher         (mpirun)
set -eu

here=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd)
example=vibrating-joint
default_n=64
# shellcheck source=examples/common.sh
. "$here/../common.sh"

export OMP_NUM_THREADS=1
"$python" "$here/vibrate.py" fresh "$out" "$grid_n" "$ranks"
solve_quietly life -options_file "$here/punch.opts" -grid_n "$grid_n" -history "$out/life.csv" \
    -wear_cycles 1000000 -wear_output 0,100000,1000000
# the scar on cells a third as wide, for the picture
solve_quietly scar -options_file "$here/punch.opts" -grid_n $((3 * grid_n)) -history "$out/life.csv" \
    -wear_cycles 1000000 -wear_output 0,100000,1000000
"$python" "$here/vibrate.py" worn "$out" "$grid_n" "$ranks"
compare

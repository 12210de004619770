#!/bin/sh
# Wear a sphere that slides to and fro under constant load, and compare volume, contact and pressure with what is known.
#
#   examples/wear-gross-slip/run.sh
#
# Works from any directory. Environment:
#   PETSAM     the program              (build/bin/petsam of the repository)
#   NP         MPI ranks                (2)
#   GRID_N     cells in each direction  (128)
#   WEAR_RTOL  error of a jump          (1e-2)
#   OUT        results and figures, relative to the repository's root  (build/wear-gross-slip)
#   PYTHON     a Python with scripts/requirements.txt  (build/venv/bin/python of the repository)
#   MPIRUN     the MPI launcher         (mpirun)
set -eu

here=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd)
example=wear-gross-slip
default_n=128
# shellcheck source=examples/common.sh
. "$here/../common.sh"

# 4 k E* u n/a0 is 1e-4 n with this amplitude; all slides in every step, so the turning points and zero are enough
wave disp_x 2.0619652471058e-5 4 4 >"$out/slide.csv"
solve_quietly slide -options_file "$here/sphere.opts" -grid_n "$grid_n" -history "$out/slide.csv" -output_every 4 \
    -wear_rtol "${WEAR_RTOL:-1e-2}" -wear_cycles 300000 -wear_output 0,1e3,1e4,1e5
compare

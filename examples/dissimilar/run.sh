#!/bin/sh
# Press an elastic sphere on a rigid flat with friction, in steps, and compare stick radius and pressure with Spence.
#
#   examples/dissimilar/run.sh
#
# Works from any directory. Environment:
#   PETSAM   the program              (build/bin/petsam of the repository)
#   NP       MPI ranks                (2)
#   GRID_N   cells in each direction  (192)
#   OUT      results and figures, relative to the repository's root  (build/dissimilar)
#   PYTHON   a Python with scripts/requirements.txt  (build/venv/bin/python of the repository)
#   MPIRUN   the MPI launcher         (mpirun)
set -eu

here=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd)
example=dissimilar
default_n=192
# shellcheck source=examples/common.sh
. "$here/../common.sh"

# solve CASE OPTION...: dissimilar.opts with further options, results to CASE.h5
solve() {
    name=$1
    shift
    solve_quietly "$name" -options_file "$here/dissimilar.opts" -grid_n "$grid_n" "$@"
}

# Poisson's ratio 0, 0.2, 0.3 is beta = 0.5, 0.375, 0.286. figures.py expects these names.
for friction in 0.2 0.2986 0.4 0.5 0.65 1; do
    solve "nu0_mu$friction" -friction "$friction"
done
for friction in 0.15 0.2 0.3 0.4; do
    solve "nu0.2_mu$friction" -body1_poisson 0.2 -friction "$friction"
done
for friction in 0.1 0.15 0.2 0.3; do
    solve "nu0.3_mu$friction" -body1_poisson 0.3 -friction "$friction"
done
# Without the coupling: Hertz's pressure, no shear
solve uncoupled -coupling none
# The number of load steps
for steps in 1 2 5 10 20 40; do
    solve "steps$steps" -steps "$steps" -output_every 1000
done
compare

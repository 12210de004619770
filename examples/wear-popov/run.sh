#!/bin/sh
# Wear a sphere under prescribed approach and amplitude until nothing wears any more, and compare its life with numbers
# of a one-dimensional model and its last shape with Popov's.
#
#   examples/wear-popov/run.sh
#
# Works from any directory. Environment:
#   PETSAM     the program              (build/bin/petsam of the repository)
#   NP         MPI ranks                (2)
#   GRID_N     cells in each direction  (128)
#   WEAR_RTOL  error of a jump          (1e-2)
#   OUT        results and figures, relative to the repository's root  (build/wear-popov)
#   PYTHON     a Python with scripts/requirements.txt  (build/venv/bin/python of the repository)
#   MPIRUN     the MPI launcher         (mpirun)
set -eu

here=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd)
example=wear-popov
default_n=128
# shellcheck source=examples/common.sh
. "$here/../common.sh"
rtol=${WEAR_RTOL:-1e-2}

a0=8.660254037844386e-4
u0=5.625e-7 # stick radius a0/2

# cycles TAU: the number of cycles after which 4 k E* u0 n/a0 is TAU
cycles() {
    LC_ALL=C awk "BEGIN { printf \"%.0f\", $1 * $a0 / (4 * 1e-14 * 105e9 * $u0) }"
}

saved=
for tau in 0.1 1 3 5 10; do
    saved=$saved${saved:+,}$(cycles "$tau")
done
# fields of the last step of a cycle, where disp_x is zero again
wave disp_x "$u0" 16 4 >"$out/life.csv"
solve_quietly life -options_file "$here/sphere.opts" -grid_n "$grid_n" -history "$out/life.csv" -wear_rtol "$rtol" \
    -output_every 16 -wear_cycles "$(cycles 20)" -wear_output "$saved"
compare

#!/bin/sh
# Plane strain: a cylinder with bulk tension, a rounded pad with fatigue over its edge, its wear over a million cycles,
# and the middle of a long contact in three dimensions beside its plane problem.
#
#   examples/plane/run.sh
#
# Works from any directory. Environment:
#   PETSAM   the program              (build/bin/petsam of the repository)
#   GRID_N   cells                    (1024)
#   OUT      results and figure, relative to the repository's root  (build/plane)
#   PYTHON   a Python with scripts/requirements.txt  (build/venv/bin/python of the repository)
#   MPIRUN   the MPI launcher         (mpirun)
set -eu

here=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd)
example=plane
default_n=1024
NP=1 # one row of cells lies on one rank
# shellcheck source=examples/common.sh
. "$here/../common.sh"

solve_quietly tension -options_file "$here/cylinder.opts" -grid_n "$grid_n" -history "$here/tension.csv" -steps 20
solve_quietly cycle -options_file "$here/pad.opts" -grid_n "$grid_n" -history "$here/cycle.csv" -steps 20
stress cycle fatigue -steps 41:80 -depths 0:2e-4:41 -quantities none -fatigue swt
solve_quietly life -options_file "$here/pad.opts" -grid_n "$grid_n" -history "$here/wear.csv" -steps 10 \
    -wear_coefficient1 1e-14 -wear_coefficient2 1e-14 -wear_cycles 1e6 -wear_output 0,1e4,1e5,1e6

# the long punch of examples/long-punch, 10 times as long as wide, and the plane problem of its middle section
long="$here/../long-punch"
"$python" "$long/gap.py" "$out/gap.h5" --n "$grid_n" "$((grid_n / 4))" --size 3.2e-3 23e-3 --flat 1e-3 10e-3 \
    --edge-radius 20e-3
solve_quietly long -options_file "$long/upright.opts" -gap_file "$out/gap.h5" -grid_n "$grid_n,$((grid_n / 4))"
loads=$("$python" "$here/figures.py" "$out" --loads)
# shellcheck disable=SC2086 # two options
solve_quietly middle -elasticity plane -body1_young 210e9 -body1_poisson 0.3 -body2_young 210e9 -body2_poisson 0.3 \
    -friction 0.1 -gap_type punch -gap_flat_radius 1e-3 -gap_edge_radius 20e-3 -grid_n "$grid_n" -grid_size 3.2e-3 $loads

printf '\n'
compare

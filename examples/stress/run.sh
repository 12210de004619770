#!/bin/sh
# Stresses under a sphere, in partial slip and sliding, against closed solutions; then a fretting cycle and its fatigue.
#
#   examples/stress/run.sh
#
# Works from any directory. Environment:
#   PETSAM   the program; petsam-stress lies beside it  (build/bin/petsam of the repository)
#   NP       MPI ranks                (2)
#   GRID_N   cells in each direction, an odd number  (513)
#   OUT      results and figures, relative to the repository's root  (build/stress)
#   PYTHON   a Python with scripts/requirements.txt  (build/venv/bin/python of the repository)
#   MPIRUN   the MPI launcher         (mpirun)
set -eu

here=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd)
example=stress
default_n=513
# shellcheck source=examples/common.sh
. "$here/../common.sh"

# solve CASE OPTION...
solve() {
    name=$1
    shift
    solve_quietly "$name" -options_file "$here/sphere.opts" -grid_n "$grid_n" "$@"
}

a=0.8662391e-3
section="-section y=0 -depths 0:$(evaluate "1.6 * $a"):65" # below: words

solve normal
# shellcheck disable=SC2086
stress normal normal_section $section
stress normal normal_axis -section y=0 -depths "$(evaluate "0.05 * $a"):$(evaluate "2 * $a"):40" -quantities stress
for mu in 0.1 0.5; do
    solve "partial_$mu" -friction "$mu" -load_tx "$(evaluate "0.784 * $mu * 1000")"
    solve "sliding_$mu" -friction "$mu" -disp_x 1e-2
    for state in partial sliding; do
        # shellcheck disable=SC2086
        stress "${state}_$mu" "${state}_${mu}_section" $section
        stress "${state}_$mu" "${state}_${mu}_surface" -depths 0 -quantities stress
    done
done

# The cycle is steps 21 to 40: from one turning point to the other and back.
solve cycle -history "$here/cycle.csv" -steps 10
fatigue="-steps 21:40 -fatigue swt,ruiz -quantities mises"
# shellcheck disable=SC2086
stress cycle cycle_surface -depths 0 $fatigue
# shellcheck disable=SC2086
stress cycle cycle_section -section y=0 -depths "0:$(evaluate "0.3 * $a"):33" $fatigue
compare

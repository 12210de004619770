#!/bin/sh
# Bodies that yield below their surface: the dent of a ball, and fretting above yield, beside the same contact of
# elastic bodies.
#
#   examples/plastic/run.sh
#
# Works from any directory. Environment:
#   PETSAM   the program              (build/bin/petsam of the repository)
#   NP       MPI ranks                (2)
#   GRID_N   cells in each direction  (40)
#   OUT      results and figure, relative to the repository's root  (build/plastic)
#   PYTHON   a Python with scripts/requirements.txt  (build/venv/bin/python of the repository)
#   MPIRUN   the MPI launcher         (mpirun)
set -eu

here=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd)
example=plastic
default_n=40
# shellcheck source=examples/common.sh
. "$here/../common.sh"

# pressed to 100 N and let go
LC_ALL=C awk 'BEGIN { print "time,load_n"
    for (k = 1; k <= 10; k++) print k "," (k <= 5 ? 20 * k : 200.2 - 20.02 * k) }' >"$out/press.csv"
# pressed to 100 N, then T_x between 24 and -24 N, 0.6 of what friction bears, eight half cycles
LC_ALL=C awk 'BEGIN { print "time,load_n,load_tx"; print "0,100,0"
    for (k = 1; k <= 32; k++) { m = k % 8; print k ",100," 24 * (m <= 2 ? m / 2 : m <= 6 ? 2 - m / 2 : m / 2 - 4) } }' >"$out/fret.csv"

run() { # run CASE OPTION...: the case, and that of elastic bodies
    history=$1
    shift
    solve_quietly "$history" -options_file "$here/ball.opts" -grid_n "$grid_n" -history "$out/$history.csv" "$@" \
        -output_fields usual,plastic
    solve_quietly "$history-elastic" -options_file "$here/ball.opts" -grid_n "$grid_n" -history "$out/$history.csv" "$@" \
        -body2_yield inf
}
run press
run fret -friction 0.4

printf '\n'
compare

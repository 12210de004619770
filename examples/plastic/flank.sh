#!/bin/sh
# The flank of a dovetail above yield: lives by elastic bodies, with plastic strain, and with a peened surface.
#
#   examples/plastic/flank.sh
#
# Works from any directory. Environment: as of run.sh, whose OUT is build/flank here and GRID_N 320.
set -eu

here=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd)
example=flank
default_n=320
# shellcheck source=examples/common.sh
. "$here/../common.sh"
ranks=1 # a row of cells is solved by one rank

# start and stop: N, T_x and the bulk stress grow with the speed's square, seven times to the full load and back to a tenth
LC_ALL=C awk 'BEGIN { print "time,load_n,load_tx,bulk2_stress_xx"
    for (k = 0; k <= 13; k++) { s = k % 2 ? 1 : k ? 0.1 : 0.05; print k "," 9e5 * s "," 2.88e5 * s "," 3e8 * s } }' >"$out/start.csv"

run() { # run CASE OPTION...: a case, and SWT over its last cycle
    name=$1
    shift
    solve_quietly "$name" -options_file "$here/flank.opts" -grid_n "$grid_n" -history "$out/start.csv" -steps 8 "$@" \
        -output_fields usual,plastic
    stress "$name" "$name-swt" -depths 0:0.3mm:31 -steps 97:112 -fatigue swt
}
steel="-body2_yield 600MPa -body2_backstress 60e9,800,4e9,100"
solve_quietly elastic -options_file "$here/flank.opts" -grid_n "$grid_n" -history "$out/start.csv" -steps 8
stress elastic elastic-swt -depths 0:0.3mm:31 -steps 97:112 -fatigue swt
# shellcheck disable=SC2086 # the words of the options
run yields $steel
# shellcheck disable=SC2086
run peened $steel -body2_initial_stress "$here/peen.csv"

printf '\n'
"$python" "$here/flank.py" "$out"

#!/bin/sh
# Wear a sphere under prescribed approach and amplitude until nothing wears any more, and compare its life with numbers
# of a one-dimensional model and its last shape with Popov's. With the argument "jumps" instead: how many cycles are
# computed with implicit and with explicit jumps, and what both end with (ten minutes).
#
#   examples/wear-popov/run.sh [jumps]
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
what=${1:-life}
default_n=128
# shellcheck source=examples/common.sh
. "$here/../common.sh"
rtol=${WEAR_RTOL:-1e-2}

a0=8.660254037844386e-4

# cycles TAU E_STAR AMPLITUDE: the number of cycles after which 4 k E* u0 n/a0 is TAU
cycles() {
    LC_ALL=C awk "BEGIN { printf \"%.0f\", $1 * $a0 / (4 * 1e-14 * $2 * $3) }"
}

# solve CASE AMPLITUDE STEPS OPTION...: fields of the last step of a cycle, where disp_x is zero again
solve() {
    name=$1
    wave disp_x "$2" "$3" 4 >"$out/$name.csv"
    steps=$3
    shift 3
    solve_quietly "$name" -options_file "$here/sphere.opts" -grid_n "$grid_n" -history "$out/$name.csv" \
        -wear_rtol "$rtol" -output_every "$steps" "$@"
}

case $what in
    life)
        u0=5.625e-7 # stick radius a0/2
        saved=
        for tau in 0.1 1 3 5 10; do
            saved=$saved${saved:+,}$(cycles "$tau" 105e9 "$u0")
        done
        solve life "$u0" 16 -wear_cycles "$(cycles 20 105e9 "$u0")" -wear_output "$saved"
        compare
        ;;
    jumps)
        u0=6.830357142857143e-7 # nu = 0.3: G*/E* = 14/17, so this is the same stick radius
        e_star=115.38461538461539e9
        for type in implicit explicit; do
            solve "jumps_$type" "$u0" 40 -body1_poisson 0.3 -body2_poisson 0.3 -wear_type "$type" \
                -wear_cycles "$(cycles 10 "$e_star" "$u0")"
        done
        "$python" "$here/jumps.py" "$out"
        ;;
    *) fail "no such argument: $what" ;;
esac

#!/bin/sh
# Press and shear long punches of several lengths, upright and inclined, and compare their middle section with the
# plane theory.
#
#   examples/long-punch/run.sh
#
# Works from any directory. Environment:
#   PETSAM   the program              (build/bin/petsam of the repository)
#   NP       MPI ranks                (2)
#   GRID_N   cells across the punch (x); along it (y) a quarter of that  (1024)
#   OUT      separations, results and figure, relative to the repository's root  (build/long-punch)
#   PYTHON   a Python with scripts/requirements.txt  (build/venv/bin/python of the repository)
#   MPIRUN   the MPI launcher         (mpirun)
set -eu

here=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd)
example=long-punch
default_n=1024
# shellcheck source=examples/common.sh
. "$here/../common.sh"

# Length over width of the base, L/c: figures.py expects these.
ratios="2.5 5 10 20 40"
# nu = 0 and E/(1 - nu^2) of the steel: same E*
young_nu0=230.76923076923077e9

# solve NAME RATIO COLUMNS [--sharp] -- OPTION...: upright and inclined, results to upright_NAME.h5, inclined_NAME.h5
solve() {
    shape=$1
    ratio=$2
    columns=$3
    ends=
    [ "$4" = -- ] || { ends=$4; shift; }
    shift 4
    rows=$((grid_n / 4))
    length=$(evaluate "2e-3 * ($ratio + 1.5)")
    load=$(evaluate "1800 * $ratio")
    "$python" "$here/gap.py" "$out/gap_$shape.h5" --n "$columns" "$rows" --size 3.2e-3 "$length" \
        --flat 1e-3 "$(evaluate "1e-3 * $ratio")" --edge-radius 20e-3 ${ends:+"$ends"}
    for study in upright inclined; do
        moment=0
        [ "$study" = upright ] || moment=$(evaluate "0.3e-3 * $load")
        solve_quietly "${study}_$shape" -options_file "$here/$study.opts" -gap_file "$out/gap_$shape.h5" \
            -grid_n "$columns,$rows" -grid_size "3.2e-3,$length" \
            -load_n "$load" -load_tx "$(evaluate "0.06 * $load")" -load_my "$moment" "$@"
    done
}

[ "$grid_n" -ge 256 ] || fail "GRID_N must be at least 256: on coarser grids the long contact reaches the edge"
for ratio in $ratios; do
    solve "fine_r$ratio" "$ratio" "$grid_n" --
    solve "coarse_r$ratio" "$ratio" "$((grid_n / 4))" --
done
# What must not matter in the middle: the shape of the ends, and Poisson's ratio
solve sharp_r10 10 "$grid_n" --sharp --
solve nu0_r10 10 "$grid_n" -- -body1_young "$young_nu0" -body2_young "$young_nu0" -body1_poisson 0 -body2_poisson 0

printf '\n'
compare

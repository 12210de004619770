#!/bin/sh
# Run the sphere example (normal load, tangential force, torque) and compare it with the closed solutions.
#
#   examples/sphere/run.sh
#
# Works from any directory. Environment:
#   PETSAM   the program              (build/bin/petsam of the repository)
#   NP       MPI ranks                (2)
#   GRID_N   cells in each direction  (512)
#   LEVELS   T_x/(mu N) and M_z/M_lim, as in "0.30 0.90"  (0.10 to 0.95; with nu = 0: 0.30 0.60 0.90)
#   OUT      results and figures, relative to the repository's root  (build/sphere)
#   PYTHON   a Python with scripts/requirements.txt  (build/venv/bin/python of the repository)
#   MPIRUN   the MPI launcher         (mpirun)
set -eu

here=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd)
example=sphere
default_n=512
# shellcheck source=examples/common.sh
. "$here/../common.sh"

# Limits and levels of Table 1: mu N in N, 3 pi/16 mu N a in N m.
force_limit=100
torque_limit=51.0257e-3
levels=${LEVELS:-0.10 0.30 0.50 0.70 0.90 0.95}
levels_exact=${LEVELS:-0.30 0.60 0.90}
# nu = 0 and E/(1 - nu^2) of Table 1's steel: same E*, so the same p0 and a.
young_exact=230.76923076923077e9

# solve STUDY CASE OPTION...: run STUDY.opts with further options, results to CASE.h5
solve() {
    study=$1
    name=$2
    shift 2
    printf '%s\n' "== $name"
    status=0
    launch -options_file "$here/$study.opts" -grid_n "$grid_n" -output "$out/$name.h5" "$@" || status=$?
    [ "$status" -eq 0 ] || fail "case $name failed with exit code $status"
}

# figures.py draws all levels in the folder
rm -f "$out"/cattaneo_nu*_t*.h5 "$out"/torsion_m*.h5
solve hertz hertz
for level in $levels; do
    solve cattaneo "cattaneo_nu0.3_t$level" -load_tx "$(evaluate "$level * $force_limit")"
done
for level in $levels_exact; do
    solve cattaneo "cattaneo_nu0_t$level" -load_tx "$(evaluate "$level * $force_limit")" \
        -body1_young "$young_exact" -body2_young "$young_exact" -body1_poisson 0 -body2_poisson 0
done
for level in $levels; do
    solve torsion "torsion_m$level" -load_mz "$(evaluate "$level * $torque_limit")"
done
compare

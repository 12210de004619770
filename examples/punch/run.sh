#!/bin/sh
# Run the punch example (normal load, tilting moment, tangential force, torque), compare it with the exact solution
# under normal load and with Jaeger's principle, and show the limits of Table 3.
#
#   examples/punch/run.sh
#
# Works from any directory. Environment:
#   PETSAM   the program              (build/bin/petsam of the repository)
#   NP       MPI ranks                (2)
#   GRID_N   cells in each direction of 1.5 c on each side of the centre  (512)
#   OUT      results and figures, relative to the repository's root  (build/punch)
#   PYTHON   a Python with scripts/requirements.txt  (build/venv/bin/python of the repository)
#   MPIRUN   the MPI launcher         (mpirun)
set -eu

here=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd)
example=punch
default_n=512
# shellcheck source=examples/common.sh
. "$here/../common.sh"

# Levels in N m, mu N, mu N, N m: figures.py expects these. mu N in N.
moments="0 5e3 1e4 1.5e4 2e4 2.5e4 3e4"
ratios="0.10 0.30 0.50 0.70 0.90 0.95"
ratios_exact="0.30 0.60 0.90"
ratios_stress="0.30 0.70 0.95"
torques="300 600 900 1200 1500 1700"
force_limit=1e5
# nu = 0 and E/(1 - nu^2) of the steel: same E*, so the same pressure.
young_exact=230.76923076923077e9

# run EXPECTED STUDY NAME OPTION...: run STUDY.opts with further options, results to NAME.h5; EXPECTED is the exit code
run() {
    expected=$1
    study=$2
    name=$3
    shift 3
    printf '%s\n' "== $name"
    status=0
    launch -options_file "$here/$study.opts" -output "$out/$name.h5" "$@" || status=$?
    [ "$status" -eq "$expected" ] || fail "case $name ended with exit code $status, not $expected"
}

# solve STUDY NAME OPTION...: on the grid of 1.5 c on each side
solve() {
    study=$1
    name=$2
    shift 2
    run 0 "$study" "$name" -grid_n "$grid_n" "$@"
}

# refuse EXPECTED NAME OPTION...: a load that petsam must not accept silently, on the grid of 1.5 c on each side.
# mpirun's own lines about the exit code are left out.
refuse() {
    expected=$1
    name=$2
    shift 2
    (run "$expected" punch "$name" -grid_n "$grid_n" "$@") >"$out/$name.log" 2>&1 || {
        cat "$out/$name.log" >&2
        exit 1
    }
    printf '%s\n' "== $name: exit code $expected, as it should be"
    grep -o 'petsam: .*' "$out/$name.log" # mpirun may put it behind a line of the printout
}

solve punch normal

# The grid of tilt.opts is longer in x by a quarter, with the same cells.
columns=$(evaluate "int(1.25 * $grid_n + 0.5)")
for moment in $moments; do
    run 0 tilt "tilt_my$moment" -grid_n "$columns,$grid_n" -load_my "$moment"
done

for ratio in $ratios; do
    solve tangential "tangential_nu0.3_t$ratio" -load_tx "$(evaluate "$ratio * $force_limit")"
done
for ratio in $ratios_exact; do
    name=tangential_nu0_t$ratio
    solve tangential "$name" -load_tx "$(evaluate "$ratio * $force_limit")" \
        -body1_young "$young_exact" -body2_young "$young_exact" -body1_poisson 0 -body2_poisson 0
    # Jaeger: the same tilt under the load N - T_x/mu.
    tilt=$("$python" -c 'import sys, petsam; print(float(petsam.open(sys.argv[1]).history["rot_y"][-1]))' \
        "$out/$name.h5")
    solve punch "less_t$ratio" -load_n "$(evaluate "1e6 * (1 - $ratio)")" -rot_y "$tilt" \
        -body1_young "$young_exact" -body2_young "$young_exact" -body1_poisson 0 -body2_poisson 0
done

# What the body feels under these loads, on y = 0 down to 1.2 c.
for ratio in $ratios_stress; do
    stress "tangential_nu0.3_t$ratio" "stress_t$ratio" -section y=0 -depths 0:0.024:65
done

for torque in $torques; do
    solve torsion "torsion_mz$torque" -load_mz "$torque"
done
# Gross slip by prescribed rotation: the torque that results is the limit.
solve punch torsion_gross -rot_z 1e-2

printf '\n%s\n' "Table 3's loads that the grid of 1.5 c on each side, or the punch, does not carry:"
refuse 12 refused_my1.9e4 -load_my 1.9e4
refuse 11 refused_my3e4 -load_my 3e4
refuse 11 refused_mz2e3 -load_mz 2e3
printf '%s\n' "So M_y was solved on $columns x $grid_n cells, x from -0.03 to 0.045 m, and M_z ends at its limit."

printf '\n'
compare

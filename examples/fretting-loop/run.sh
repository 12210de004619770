#!/bin/sh
# Run the fretting loops (partial slip by force, gross slip by displacement) and compare them with Mindlin-Deresiewicz.
#
#   examples/fretting-loop/run.sh
#
# Works from any directory. Environment:
#   PETSAM   the program              (build/bin/petsam of the repository)
#   NP       MPI ranks                (2)
#   GRID_N   cells in each direction  (256)
#   OUT      histories, results and figures, relative to the repository's root  (build/fretting-loop)
#   PYTHON   a Python with scripts/requirements.txt  (build/venv/bin/python of the repository)
#   MPIRUN   the MPI launcher         (mpirun)
set -eu

here=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd)
example=fretting-loop
default_n=256
# shellcheck source=examples/common.sh
. "$here/../common.sh"

# Amplitudes: 0.8 mu N in N, and twice the displacement of incipient sliding 3 mu N (2 - nu)/(8 G a) in m.
force=80
displacement_nu0=1.5007406e-6
displacement_nu03=1.8223278e-6
steel="-body1_young 210e9 -body1_poisson 0.3 -body2_young 210e9 -body2_poisson 0.3"

# solve CASE COLUMN AMPLITUDE STEPS QUARTERS OPTION...: one loop, results to CASE.h5
solve() {
    name=$1
    wave "$2" "$3" "$4" "$5" >"$out/$name.csv"
    shift 5
    solve_quietly "$name" -options_file "$here/sphere.opts" -grid_n "$grid_n" -history "$out/$name.csv" "$@"
}

# Two cycles at 80 steps each; fields at their quarters.
solve partial_nu0 load_tx "$force" 80 8 -output_every 20
# shellcheck disable=SC2086  # the material is four options and their values
solve partial_nu0.3 load_tx "$force" 80 8 -output_every 20 $steel
solve gross_nu0 disp_x "$displacement_nu0" 80 8 -output_every 20
# shellcheck disable=SC2086
solve gross_nu0.3 disp_x "$displacement_nu03" 80 8 -output_every 20 $steel
# The number of steps a cycle: to the first peak, and one cycle from there. The first with all fields.
solve steps20 load_tx "$force" 20 5 -output_every 1
solve steps40 load_tx "$force" 40 5 -output_every 1000
solve steps80 load_tx "$force" 80 5 -output_every 1000
solve steps160 load_tx "$force" 160 5 -output_every 1000
compare

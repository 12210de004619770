#!/bin/sh
# The public benchmark of fretting wear: a cylinder that slides cyclically on a flat, 18,000 cycles, beside Abaqus and the
# measurement; a block on a ring, over 3600 m; and the running-in of two rough surfaces.
#
#   examples/mccoll/run.sh
#
# Works from any directory. Environment:
#   PETSAM     the program              (build/bin/petsam of the repository)
#   NP         MPI ranks                (1)
#   GRID_N     cells across the cylinder's grid of 0.64 mm  (320)
#   WEAR_RTOL  error of a jump where surfaces slide  (0.1, petsam's default there)
#   OUT        results and figures, relative to the repository's root  (build/mccoll)
#   PYTHON     a Python with scripts/requirements.txt  (build/venv/bin/python of the repository)
#   MPIRUN     the MPI launcher         (mpirun)
set -eu

here=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd)
example=mccoll
default_n=320
NP=${NP:-1}
# shellcheck source=examples/common.sh
. "$here/../common.sh"

# 16 steps a cycle, from a turn on. figures.py expects these cycles.
wave disp_x 25e-6 16 5 | sed '3,6d' >"$out/stroke.csv"
cylinder() { # cylinder CASE OPTION...
    case=$1
    shift
    solve_quietly "$case" -options_file "$here/cylinder.opts" -grid_n "$grid_n,1" -history "$out/stroke.csv" \
        -wear_cycles 18000 -wear_output 1000,10000 -output_every 16 "$@" 2>"$out/$case.warnings"
}
cylinder moved -slide -wear_rtol "${WEAR_RTOL:-0.1}"
cylinder fixed -wear_rtol 1e-2

# A cycle of the block is 4 mm of sliding: 800, 1600 and 3600 m.
wave disp_x 1e-3 4 4 >"$out/turn.csv"
solve_quietly ring -options_file "$here/ring.opts" -history "$out/turn.csv" -wear_rtol 1e-2 -wear_cycles 900000 \
    -wear_output 200000,400000 2>"$out/ring.warnings"

# Both bodies are rough: waves of 16 to 64 um, each 0.1 um. The steps of a stroke are shorter than half a wave.
"$python" - "$out" <<'EOF'
import sys
import h5py
import numpy as np
random = np.random.default_rng(7)
for body in "12":
    x = (np.arange(320) - 159.5) * 2e-6
    waves = [random.normal() * np.cos(2 * np.pi * x / length + random.uniform(0, 2 * np.pi)) for length in 1e-6 * np.arange(16, 65, 4)]
    height = np.sum(waves, axis=0)
    with h5py.File(f"{sys.argv[1]}/rough{body}.h5", "w") as file:
        file["height"] = (1e-7 * (height - height.mean()) / height.std())[None, :]
        file["height"].attrs["units"] = "m"
EOF
solve_quietly rough -options_file "$here/cylinder.opts" -history "$out/stroke.csv" -slide \
    -gap_rough_file "$out/rough1.h5" -body2_surface_file "$out/rough2.h5" -wear_coefficient1 1e-14 -wear_coefficient2 2e-14 \
    -wear_cycles 1000 -wear_output 0,10,100 -output_every 16 2>"$out/rough.warnings"
compare

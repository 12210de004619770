#!/bin/sh
# Wear the rounded punch by a tangential force that goes to and fro for a million cycles, and follow its stick zone,
# pressure, von Mises stress and a fatigue parameter.
#
#   examples/wear-punch/run.sh
#
# Works from any directory. Environment:
#   PETSAM     the program              (build/bin/petsam of the repository)
#   NP         MPI ranks                (2)
#   GRID_N     cells in each direction  (128)
#   WEAR_RTOL  error of a jump          (1e-2)
#   OUT        results and figures, relative to the repository's root  (build/wear-punch)
#   PYTHON     a Python with scripts/requirements.txt  (build/venv/bin/python of the repository)
#   MPIRUN     the MPI launcher         (mpirun)
set -eu

here=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd)
example=wear-punch
default_n=128
# shellcheck source=examples/common.sh
. "$here/../common.sh"

# 0.6 mu N, 16 steps a cycle; figures.py expects these cycles
saved="0 30000 100000 200000 300000 450000 600000 800000 1000000"
wave load_tx 3e5 16 4 >"$out/life.csv"
solve_quietly life -options_file "$here/punch.opts" -grid_n "$grid_n" -history "$out/life.csv" \
    -wear_rtol "${WEAR_RTOL:-1e-2}" -wear_cycles 1000000 -wear_output "$(printf '%s' "$saved" | tr ' ' ',')"

# What body 2 feels over each saved cycle, on y = 0, from 0.05 c to 0.5 c. Its steps are those with its number.
for cycle in $saved; do
    steps=$("$python" - "$out/life.h5" "$cycle" <<'EOF'
import sys
import petsam
steps = [k + 1 for k, cycle in enumerate(petsam.open(sys.argv[1]).history["cycle"]) if cycle == float(sys.argv[2])]
print(f"{steps[0]}:{steps[-1]}")
EOF
    )
    stress life "stress_$cycle" -steps "$steps" -section y=0 -depths 0.001:0.01:10 -quantities mises -fatigue swt
done
compare

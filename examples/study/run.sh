#!/bin/sh
# Run the study of stick radius and dissipated energy, and draw its figure.
#
#   examples/study/run.sh
#
# Works from any directory; once interrupted, it goes on where it was. Environment:
#   PETSAM   the program              (build/bin/petsam of the repository)
#   CORES    cores to use             (all)
#   NP       MPI ranks of a case      (1)
#   GRID_N   cells in each direction  (256)
#   OUT      cases and tables, relative to the repository's root  (build/study)
#   PYTHON   a Python with scripts/requirements.txt  (build/venv/bin/python of the repository)
#   MPIRUN   the MPI launcher         (mpirun)
set -eu

here=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd)
example=study
default_n=256
NP=${NP:-1}
# shellcheck source=examples/common.sh
. "$here/../common.sh"

status=0
PETSAM=$petsam PYTHON=$python "$root/scripts/petsam-study" "$here/study.yaml" --directory "$out" --ranks "$ranks" \
    ${CORES:+--cores "$CORES"} -- -grid_n "$grid_n" || status=$?
[ "$status" -eq 0 ] || fail "petsam-study ended with exit code $status"
"$python" "$here/figures.py" "$out"

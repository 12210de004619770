#!/bin/sh
# Measure what the reconstruction of edges gains, against closed solutions: on a sphere, an
# ellipsoid turned on the grid and a rounded punch, which it draws; then on spheres that slip to and fro, and that slide.
#
#   examples/edges/run.sh [CELLS...]     cells in each direction (32 64 128 256; to and fro 64 128 256)
#
# Works from any directory. Environment:
#   PETSAM   the program              (build/bin/petsam of the repository)
#   OUT      results and figure, relative to the repository's root  (build/edges)
#   PYTHON   a Python with scripts/requirements.txt  (build/venv/bin/python of the repository)
#   MPIRUN   the MPI launcher, not used here         (mpirun)
set -eu

here=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd)
example=edges
default_n=128
# shellcheck source=examples/common.sh
. "$here/../common.sh"

"$python" "$here/edges.py" "$petsam" "$out" "$@"
"$python" "$here/slip.py" "$petsam" "$out" "$@"
"$python" "$here/tension.py" "$petsam" "$out" "$@"

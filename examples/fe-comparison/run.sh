#!/bin/sh
# Solve the sphere in CalculiX and in petsam under equal forces, and compare pressure, shear and cost.
#
#   examples/fe-comparison/run.sh [OPTION...]
#
# Works from any directory; options go to compare.py, which lists them. Environment:
#   CCX      CalculiX, Debian package calculix-ccx  (ccx)
#   PETSAM   the program              (build/bin/petsam of the repository)
#   OUT      results and figures, relative to the repository's root  (build/fe-comparison)
#   PYTHON   a Python with scripts/requirements.txt  (build/venv/bin/python of the repository)
set -eu

here=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd)
example=fe-comparison
default_n=512
# shellcheck source=examples/common.sh
. "$here/../common.sh"

ccx=${CCX:-ccx}
command -v "$ccx" >/dev/null || fail "no CalculiX $ccx: install the Debian package calculix-ccx, or set CCX"

"$python" "$here/compare.py" "$out" --petsam "$petsam" --ccx "$ccx" "$@"
compare

#!/bin/sh
# Press a rigid sphere on a block near its edge, and on a clamped beam whose end is then pulled: bodies from finite
# elements, in petsam and, with FULL=1, in full contact in CalculiX.
#
#   examples/body/run.sh
#
# Works from any directory. Environment:
#   PETSAM   the program              (build/bin/petsam of the repository)
#   CCX      CalculiX, Debian package calculix-ccx  (ccx)
#   FULL     1: full contact, too, half an hour  (0)
#   NP       MPI ranks                (2)
#   OUT      results and figures, relative to the repository's root  (build/body)
#   PYTHON   a Python with scripts/requirements.txt  (build/venv/bin/python of the repository)
#   MPIRUN   the MPI launcher         (mpirun)
set -eu

here=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd)
example=body
default_n=96
# shellcheck source=examples/common.sh
. "$here/../common.sh"

ccx=${CCX:-ccx}
command -v "$ccx" >/dev/null || fail "no CalculiX $ccx: install the Debian package calculix-ccx, or set CCX"
PYTHON=$python
export PYTHON

# meshes, and coarser ones
for body in block beam; do
    "$python" "$here/mesh.py" "$body" "$out/$body.inp"
    "$python" "$here/mesh.py" "$body" "$out/${body}_coarse.inp" --coarse
done

# compliance BODY NAME DEGREE OPTION...: NAME.h5 from the deck BODY.inp
compliance() {
    deck=$1
    file=$2
    shift 2
    printf '%s\n' "== compliance $file"
    "$root/scripts/petsam-compliance" --mesh "$out/$deck.inp" --units mm --contact TOP -o "$out/$file.h5" --no-stress \
        --degree "$@" >"$out/$file.log" 2>&1 || fail "compliance $file failed, see $out/$file.log"
}
for degree in 1 2 4 6; do
    compliance block "block_c$degree" "$degree" --fixed BOTTOM --patch 2.2mm
    compliance beam "beam_c$degree" "$degree" --fixed LEFT --fixed RIGHT --patch 3mm --case pull=1
done
compliance block_coarse block_ccoarse 6 --fixed BOTTOM --patch 2.2mm
compliance beam_coarse beam_ccoarse 6 --fixed LEFT --fixed RIGHT --patch 3mm --case pull=1

solve_quietly block_none -options_file "$here/block.opts"
for which in 1 2 4 6 coarse; do
    solve_quietly "block_$which" -options_file "$here/block.opts" -body2_compliance "$out/block_c$which.h5"
    solve_quietly "beam_$which" -options_file "$here/beam.opts" -body2_compliance "$out/beam_c$which.h5" \
        -history "$here/pull.csv"
done

# full contact: a reference, whose mesh is refined at the contact and at the supports; and how stiff its meshes are
if [ "${FULL:-0}" = 1 ]; then
    for mesh in 0.2,0.5,0.5 0.2,0.5,0.05 0.1,0.5,0.5 0.1,0.4,0.04; do
        rest=${mesh#*,}
        "$python" "$here/full.py" beam "$out/beam_full_$mesh" --size "${mesh%%,*}" --far "${rest%,*}" --last "${mesh##*,}"
    done
    for size in 0.2 0.1; do
        "$python" "$here/full.py" block "$out/block_full_$size,0.5" --size "$size"
    done
    "$python" "$here/linear.py"
fi
compare

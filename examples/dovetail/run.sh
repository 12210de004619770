#!/bin/sh
# The flank of a dovetail: two finite bodies in contact under cycles of pull, in petsam and, with FULL=1, in full contact
# in CalculiX; the loop, wear over 100,000 cycles, and fatigue of the blade.
#
#   examples/dovetail/run.sh
#
# Works from any directory. Environment:
#   PETSAM   the program              (build/bin/petsam of the repository)
#   CCX      CalculiX, Debian package calculix-ccx  (ccx)
#   FULL     1: full contact, too, and that of the sections, three quarters of an hour  (0)
#   NP       MPI ranks                (2)
#   OUT      results and figures, relative to the repository's root  (build/dovetail)
#   PYTHON   a Python with scripts/requirements.txt  (build/venv/bin/python of the repository)
#   MPIRUN   the MPI launcher         (mpirun)
set -eu

here=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd)
example=dovetail
default_n=64
# shellcheck source=examples/common.sh
. "$here/../common.sh"

ccx=${CCX:-ccx}
command -v "$ccx" >/dev/null || fail "no CalculiX $ccx: install the Debian package calculix-ccx, or set CCX"
PYTHON=$python
export PYTHON

# compliance BODY NAME OPTION...: NAME.h5 from the deck NAME.inp
compliance() {
    body=$1
    name=$2
    shift 2
    printf '%s\n' "== compliance $name"
    case $body in
        blade) set -- --fixed GRIP --symmetry SYMMETRY --frame=5,0,0:-1,0,1:-1,0,-1 "$@" ;;
        disc) set -- --fixed HELD --frame=5,0,0:-1,0,1:1,0,1 "$@" ;;
    esac
    "$root/scripts/petsam-compliance" --mesh "$out/$name.inp" --units mm --contact FLANK --patch 1.6mm,2.8mm \
        -o "$out/$name.h5" "$@" >"$out/$name.log" 2>&1 || fail "compliance $name failed, see $out/$name.log"
}
for body in blade disc; do
    "$python" "$here/mesh.py" "$body" "$out/$body.inp"
    "$python" "$here/mesh.py" "$body" "$out/${body}_coarse.inp" --coarse
    compliance "$body" "$body"
    compliance "$body" "${body}_coarse" --no-stress
done

# flank NAME SUFFIX OPTION...: petsam with the compliances of that suffix
flank() {
    name=$1
    suffix=$2
    shift 2
    solve_quietly "$name" -options_file "${opts:-$here/dovetail.opts}" -body1_compliance "$out/blade$suffix.h5" \
        -body2_compliance "$out/disc$suffix.h5" "$@"
}
flank cycles "" -history "$here/cycles.csv"
flank coarse _coarse -history "$here/cycles.csv"
flank worn "" -history "$here/wear.csv" -wear_coefficient1 2e-14 -wear_coefficient2 2e-14 -wear_cycles 1e5 \
    -wear_output 0,1e5
stress cycles fatigue -body 1 -steps 13:20 -section y=0 -depths 0:4e-4:41 -quantities mises -fatigue swt

if [ "${FULL:-0}" = 1 ]; then
    for size in 0.2 0.17; do
        "$python" "$here/full.py" "$out/full_$size" --size "$size"
        # the crown's radii have no effect beside a file of the gap, and petsam rejects them
        grep -v '^-gap_' "$here/dovetail.opts" >"$out/facets.opts"
        opts=$out/facets.opts flank "facets_$size" "" -history "$here/cycles.csv" -gap_type file \
            -gap_file "$out/full_${size}_gap.h5"
    done
    for body in blade disc; do
        "$python" "$here/linear.py" "$body" "$out/$body.h5" "$out/${body}_coarse.h5"
    done
    "$python" "$here/section.py" "$out/section"
fi
compare

# What the examples' run.sh share; sourced, with `example` (the folder's name) and `default_n` (cells) set.
# Sets here, root, petsam, python, mpirun, ranks, grid_n, out and oversubscribe from the environment that each run.sh
# describes, checks the programs, lets Python find the package petsam, and makes the output folder.
# shellcheck shell=sh disable=SC2034,SC2154 # set for, and by, the script that sources this

root=$(CDPATH='' cd -- "$here/../.." && pwd)
if [ -f "$root/Makefile" ]; then # the sources; else they are installed, as share/petsam
    petsam=${PETSAM:-$root/build/bin/petsam}
    python=${PYTHON:-$root/build/venv/bin/python}
    base=$root
    out=${OUT:-build/$example}
else
    petsam=${PETSAM:-$root/../../bin/petsam}
    python=${PYTHON:-python3}
    base=$(pwd)
    out=${OUT:-$example}
fi
mpirun=${MPIRUN:-mpirun}
ranks=${NP:-2}
grid_n=${GRID_N:-$default_n}
case $out in
    /*) ;;
    *) out=$base/$out ;;
esac

fail() {
    printf '%s example: %s\n' "$example" "$*" >&2
    exit 1
}

command -v "$petsam" >/dev/null || fail "no program $petsam: run make, or set PETSAM"
command -v "$python" >/dev/null || \
    fail "no Python $python: make an environment with scripts/requirements.txt, or set PYTHON"
command -v "$mpirun" >/dev/null || fail "no MPI launcher $mpirun: set MPIRUN"

# Open MPI refuses more ranks than cores, and the superuser, unless told otherwise.
oversubscribe=
case $("$mpirun" --version 2>/dev/null) in
    *"Open MPI"* | *OpenRTE*) oversubscribe=--oversubscribe ;;
esac
if [ "$(id -u)" -eq 0 ]; then
    export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
fi

PYTHONPATH=$root/scripts${PYTHONPATH:+:$PYTHONPATH}
export PYTHONPATH
mkdir -p "$out"

# launch OPTION...: petsam on the ranks asked for
launch() {
    "$mpirun" ${oversubscribe:+"$oversubscribe"} -n "$ranks" "$petsam" "$@" </dev/null
}

# solve_quietly CASE OPTION...: results to CASE.h5; what the run prints goes to CASE.log, its last line is shown
solve_quietly() {
    name=$1
    shift
    printf '%s\n' "== $name"
    status=0
    launch -output "$out/$name.h5" "$@" >"$out/$name.log" || status=$?
    [ "$status" -eq 0 ] || fail "case $name failed with exit code $status, see $out/$name.log"
    tail -n 1 "$out/$name.log"
}

# stress CASE NAME OPTION...: petsam-stress of CASE.h5 to NAME.h5; the program lies beside petsam
stress() {
    stress_case=$1
    stress_name=$2
    shift 2
    "$mpirun" ${oversubscribe:+"$oversubscribe"} -n "$ranks" "$petsam-stress" -quiet \
        -input "$out/$stress_case.h5" -output "$out/$stress_name.h5" "$@" </dev/null || \
        fail "stresses $stress_name failed"
}

# wave COLUMN AMPLITUDE STEPS QUARTERS: a triangular wave from 0 that rises first, STEPS a cycle, time in cycles
wave() {
    LC_ALL=C awk -v column="$1" -v amplitude="$2" -v n="$3" -v quarters="$4" 'BEGIN {
        print "# triangular wave, " n " steps a cycle"
        print "time," column
        for (k = 0; 4 * k <= n * quarters; k++) {
            m = 4 * (k % n)  # of 4 n a cycle
            value = m <= n ? m / n : m <= 3 * n ? 2 - m / n : m / n - 4
            printf "%.10g,%.12g\n", k / n, amplitude * value
        }
    }'
}

evaluate() { # evaluate EXPRESSION: its value
    LC_ALL=C awk "BEGIN { printf \"%.10g\\n\", $1 }"
}

# compare [OPTION...]: tables and pictures by the example's figures.py, numbers to errors.json
compare() {
    "$python" "$here/figures.py" "$out" --json "$out/errors.json" "$@"
}

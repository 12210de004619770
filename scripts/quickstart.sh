#!/bin/sh
# From a fresh clone to the figures of the sphere example: installs what is missing, builds petsam, runs the example.
# Prints the time of each part, the tables of errors and the names of the pictures; all else goes to build/quickstart.log.
set -eu
cd "$(dirname "$0")/.."
log=build/quickstart.log
mkdir -p build
: >"$log"

# part NAME COMMAND...: runs a command into the log; prints the name and the seconds
part() {
  name=$1
  shift
  printf '%-12s ' "$name"
  began=$(date +%s)
  if ! "$@" >>"$log" 2>&1 </dev/null; then
    printf 'failed; the end of %s:\n' "$log"
    tail -n 15 "$log"
    exit 1
  fi
  printf '%4d s\n' $(($(date +%s) - began))
}

echo "petsam: packages, build and a first example; what they print is in $log"
part packages scripts/install-dependencies.sh
part program make -j"$(nproc)"
part Python make venv
part spheres examples/sphere/run.sh
sed -n '/^cells: /,/^Torque/{/^Torque/!p;}' "$log"
echo "pictures: $(ls build/sphere/*.png | tr '\n' ' ')"
echo "next: the first run in README.md"

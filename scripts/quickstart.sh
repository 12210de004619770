#!/bin/sh
# From a fresh clone to the figures of the sphere example: installs what is missing, builds petsam beside the Python
# environment, runs the example at one load level. Prints the time of each part and, while it runs, the last line that it
# wrote; then the tables of errors and the names of the pictures. All output goes to build/quickstart/PART.log.
set -eu
cd "$(dirname "$0")/.."
logs=build/quickstart
mkdir -p "$logs"
rm -f "$logs"/*
# the interrupt key does not reach what runs in the background
trap 'trap "" TERM; kill 0; exit 130' INT

# begin PART COMMAND...: runs a command in the background, into its log; its exit status and seconds go to PART.status
begin() {
  part=$1
  shift
  began=$(date +%s)
  {
    status=0
    "$@" >"$logs/$part.log" 2>&1 </dev/null || status=$?
    echo "$status $(($(date +%s) - began))" >"$logs/$part.new"
    mv "$logs/$part.new" "$logs/$part.status"
  } &
}

# finish PART...: waits for parts that were begun; one line for each, and every five seconds what they are doing
finish() {
  waited=0
  while [ $# -gt 0 ]; do
    running=
    for part in "$@"; do
      [ -e "$logs/$part.status" ] || {
        running="$running $part"
        continue
      }
      read -r status seconds <"$logs/$part.status"
      if [ "$status" != 0 ]; then
        printf '%-12s failed; the end of %s:\n' "$part" "$logs/$part.log"
        tail -n 15 "$logs/$part.log"
        wait
        exit 1
      fi
      printf '%-12s %4d s\n' "$part" "$seconds"
    done
    # shellcheck disable=SC2086 # a list of parts
    set -- $running
    [ $# -gt 0 ] || break
    sleep 0.2
    waited=$((waited + 1))
    if [ $((waited % 25)) = 0 ]; then
      for part in "$@"; do
        printf '  %-10s ... %s\n' "$part" "$(tail -n 1 "$logs/$part.log" | cut -c 1-100)"
      done
    fi
  done
}

echo "petsam: packages, build and a first example; what they print is in $logs"
begin packages scripts/install-dependencies.sh
finish packages
begin program make -j"$(nproc)"
begin Python make venv
finish program Python
begin spheres env LEVELS=0.60 examples/sphere/run.sh
finish spheres
sed -n '/^cells: /,/^Torque/{/^Torque/!p;}' "$logs/spheres.log"
echo "pictures: $(ls build/sphere/*.png | tr '\n' ' ')"
echo "next: the first run in README.md"

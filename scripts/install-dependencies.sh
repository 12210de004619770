#!/bin/sh
# Installs what petsam needs on Debian 12 and distributions based on it: compiler, MPI, PETSc, FFTW, HDF5, CMocka, and
# Python for the scripts; packages named as arguments, too. Asks no questions; uses sudo unless run by root.
set -eu

packages="gcc gfortran make pkg-config libopenmpi-dev openmpi-bin petsc-dev libfftw3-dev libfftw3-mpi-dev \
libhdf5-openmpi-dev libcmocka-dev calculix-ccx python3 python3-venv $*"

if ! command -v apt-get >/dev/null; then
  echo "install-dependencies.sh: apt-get not found; install the equivalents of these packages:" >&2
  echo "  $packages" >&2
  exit 1
fi

missing=
for package in $packages; do
  status=$(dpkg-query -W -f '${Status}' "$package" 2>/dev/null || true)
  [ "$status" = "install ok installed" ] || missing="$missing $package"
done
[ -n "$missing" ] || exit 0

as_root=
[ "$(id -u)" = 0 ] || as_root=sudo
echo "install-dependencies.sh: installing$missing"
$as_root apt-get update -q
# shellcheck disable=SC2086 # a list of words
DEBIAN_FRONTEND=noninteractive $as_root apt-get install -q -y --no-install-recommends $missing

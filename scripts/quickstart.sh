#!/bin/sh
# From a fresh clone to the figures of the sphere example: installs what is missing, builds petsam, runs the example.
set -eu
cd "$(dirname "$0")/.."
scripts/install-dependencies.sh
make -j"$(nproc)"
make venv
examples/sphere/run.sh

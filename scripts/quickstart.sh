#!/bin/sh
# From a fresh clone to the sphere study's figures: installs what is missing, builds, runs the study on two ranks.
set -eu
cd "$(dirname "$0")/.."
scripts/install-dependencies.sh
make -j"$(nproc)"
make venv
examples/sphere/run.sh

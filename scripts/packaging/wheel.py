"""Makes a wheel of the Python package that carries the programs and the library: make wheel.

    python3 scripts/packaging/wheel.py --build build/wheel/petsam --libraries build/wheel/libraries

PETSc, FFTW, HDF5 and BLAS, with which petsam was built, go from the second folder (wheel-libraries.sh) into lib/petsam
of the environment where the wheel is installed; MPI comes from PyPI's package mpich, which the wheel requires. Programs
and libraries find each other by their places in the environment. The library is lib/libpetsam.so.MAJOR.MINOR. Without
--libraries the wheel carries and requires no libraries, and runs where it was made.
"""

import argparse
import os
import re
import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PROGRAMS = ("petsam", "petsam-stress")
MPI = "libmpi.so.12"  # of MPICH and those compatible with it
C_LIBRARY = (2, 28)  # the oldest one, for which wheel-libraries.sh builds and PyPI's mpich is made
# on every system: the C library, zlib and the compiler's own
OF_THE_SYSTEM = re.compile(r"(lib(c|m|rt|dl|pthread|z|gcc_s)|ld-linux-[\w-]+)\.so\.\d+")
# files in the folder licenses of the libraries that are carried, by the beginnings of their names
LICENSES = {
    "libpetsc": "petsc",
    "libfftw3": "fftw3",
    "libhdf5": "hdf5",
    "libblas": "lapack",
    "liblapack": "lapack",
    "libgfortran": "gcc",
    "libquadmath": "gcc",
}


def output(*words):
    return subprocess.run(words, check=True, stdout=subprocess.PIPE, text=True).stdout


def needed(*files):
    """Names of the libraries that the files are linked with directly, without those of the system, MPI and petsam."""
    names = {name for file in files for name in re.findall(r"NEEDED +(\S+)", output("objdump", "-p", file))}
    return {name for name in names if not OF_THE_SYSTEM.fullmatch(name) and name != MPI and "petsam" not in name}


def license_of(library):
    """The name of the library's licence in the folder licenses, or None."""
    return next((text for start, text in LICENSES.items() if library.startswith(start)), None)


def carried(files):
    """{name: path} of the libraries that the files need, and those need, as the loader finds them now."""
    found = {}
    for file in files:
        found.update(re.findall(r"(\S+) => (/\S+)", output("ldd", file)))
    names, left = {}, needed(*files)
    while left:
        name = left.pop()
        if name not in found:
            raise SystemExit(f"wheel.py: error: {name} not found")
        if not license_of(name):
            raise SystemExit(f"wheel.py: error: {name}: a library of unknown license; add it to LICENSES")
        names[name] = found[name]
        left |= needed(found[name]) - set(names)
    return names


def ready(library):
    """True if the library seeks others beside itself already: another run of strip or patchelf would break it."""
    return re.search(r"R(UN)?PATH +\$ORIGIN$", output("objdump", "-p", library), re.M)


def copy(source, path):
    """A file's copy, with its folder."""
    path.parent.mkdir(parents=True, exist_ok=True)
    shutil.copy(source, path)


def stage(build, libraries, tree):
    """The package's sources in `tree`, and in `tree`/data the files for the environment beside it.

    Returns the programs and libraries among them.
    """
    shutil.rmtree(tree, ignore_errors=True)
    shutil.copytree(ROOT / "scripts", tree, ignore=shutil.ignore_patterns(
        "__pycache__", "*.egg-info", "build", "maintain", "packaging"))  # fmt: skip
    data, library = tree / "data", build / "lib" / "libpetsam.so"
    places = {data / "lib" / os.readlink(library): library}
    places[data / "lib/petsam/petsam-examine"] = build / "lib/petsam/petsam-examine"
    places.update({data / "bin" / name: build / "bin" / name for name in PROGRAMS})
    if libraries:
        others = carried(places.values())
        places.update({data / "lib/petsam" / name: path for name, path in others.items()})
        mpich = output(libraries / "bin/mpichversion", "--version").split()[2]
        with open(tree / "requirements.txt", "a", encoding="utf-8") as lines:
            lines.write(f"mpich>={mpich}\n")
        shutil.copytree(libraries / "licenses", data / "share/petsam/licenses")
        listed = "".join(f"{name}: {license_of(name)}\n" for name in sorted(others))
        (data / "share/petsam/licenses/libraries.txt").write_text(listed, encoding="utf-8")
        print("carried: " + ", ".join(sorted(others)))
    for path, source in places.items():
        copy(source, path)
        path.chmod(0o755)
        if not ready(path):
            subprocess.run(["strip", "--strip-unneeded", path], check=True)
            if libraries:
                up = "$ORIGIN/" + os.path.relpath(data / "lib", path.parent)
                subprocess.run([libraries / "bin/patchelf", "--set-rpath", f"{up}/petsam:{up}", path], check=True)
    scripts = [path.name for path in (ROOT / "scripts").glob("petsam-*") if path.is_file()]
    manual = [f"man/man1/{name}.1" for name in (*PROGRAMS, *scripts)]
    for page in (*manual, *(f"bash-completion/completions/{name}" for name in PROGRAMS)):
        copy(build / "share" / page, data / "share" / page)
    for name in ("LICENSE", "CITATION.cff"):
        copy(ROOT / name, data / "share/petsam" / name)
    return list(places)


def c_library(file):
    """The version (major, minor) of the GNU C library that the file needs, by the symbols that it takes from it."""
    versions = re.findall(r"GLIBC_(\d+)\.(\d+)", output("objdump", "-T", file))
    return max(((int(major), int(minor)) for major, minor in versions), default=(0, 0))


def platform(files):
    """The wheel's tag: with all that it needs inside (`files`), any system with C_LIBRARY or a newer one."""
    machine = re.sub(r"[-.]", "_", sysconfig.get_platform())
    if not files or not machine.startswith("linux_"):
        return machine
    oldest = "{}.{}".format(*C_LIBRARY)
    for file in files:
        if c_library(file) > C_LIBRARY:
            needs = "{}.{}".format(*c_library(file))
            raise SystemExit(
                f"wheel.py: error: {file} needs glibc {needs}, expected {oldest} at most: "
                "compile it with zig-cc of wheel-libraries.sh"
            )
    return f"manylinux_{oldest.replace('.', '_')}_{machine[6:]}"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--build", type=Path, default=ROOT / "build", help="where petsam was built, and its pages")
    parser.add_argument("--libraries", type=Path, help="the folder of wheel-libraries.sh")
    parser.add_argument("--out", type=Path, default=ROOT / "build/wheel")
    options = parser.parse_args()
    out, tree = options.out.resolve(), options.out.resolve() / "tree"
    files = stage(options.build.resolve(), options.libraries and options.libraries.resolve(), tree)
    tag = platform(options.libraries and files)
    for old in out.glob("petsam-*.whl"):
        old.unlink()
    subprocess.run(
        [sys.executable, "-m", "pip", "wheel", "-q", "--disable-pip-version-check", "--no-deps", "-w", out, tree],
        env=dict(os.environ, PETSAM_WHEEL=tag),
        check=True,
    )
    (wheel,) = out.glob("petsam-*.whl")
    print(f"wrote {wheel} ({wheel.stat().st_size / 1e6:.1f} MB)")


if __name__ == "__main__":
    main()

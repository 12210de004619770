"""Makes a wheel of the Python package that carries the programs and the library: make wheel.

    python3 scripts/packaging/wheel.py --build build

In the environment where it is installed, bin/petsam checks that the libraries are there with which petsam was built
(PETSc, MPI, FFTW, HDF5: those of the distribution, as the launcher must be of the same MPI) and starts libexec/petsam;
otherwise it prints in one line what to install. The library is lib/libpetsam.so.MAJOR.MINOR.
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
OF_THE_SYSTEM = re.compile(r"lib(c|m|rt|dl|pthread)\.so\.\d+")
STARTER = """#!/bin/sh
# Starts petsam's {name} if the libraries with which it was built are installed.
program=$(dirname "$(readlink -f "$0")")/../libexec/{name}
missing=$(LD_TRACE_LOADED_OBJECTS=1 "$program" | awk '/ => not found/ && !seen[$1]++ {{printf " %s", $1}}')
if [ -n "$missing" ]; then
  echo "{name}: error: shared libraries not found:$missing; {remedy}" >&2
  exit 127
fi
exec "$program" "$@"
"""


def output(*words):
    """What a command prints, or nothing where it fails or is not there."""
    try:
        return subprocess.run(words, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True).stdout
    except OSError:
        return ""


def needed(*files):
    """Paths of the libraries that the files are linked with directly, without the C library's and petsam's own."""
    names = {name for file in files for name in re.findall(r"NEEDED +(\S+)", output("objdump", "-p", file))}
    found = dict(re.findall(r"(\S+) => (/\S+)", output("ldd", files[0])))
    return {
        name: found.get(name) for name in sorted(names) if not OF_THE_SYSTEM.fullmatch(name) and "petsam" not in name
    }


def remedy(libraries):
    """The end of the message about missing libraries: Debian's packages, or names of the libraries."""
    packages = set()
    for path in filter(None, libraries.values()):
        owner = next(filter(None, (output("dpkg-query", "-S", p) for p in (path, os.path.realpath(path)))), "")
        packages.add(owner.split(":")[0])
    if "" in packages or not packages:
        return f"install {', '.join(libraries)}, all built with the same MPI, or build petsam from its source"
    if "libopenmpi3" in packages:
        packages.add("openmpi-bin")  # mpirun
    system = re.search(r'^PRETTY_NAME="(.*)"$', Path("/etc/os-release").read_text(), re.M)
    where = re.sub(r" \(.*\)", "", system.group(1)) if system else "Debian"
    return f"on {where} run: apt-get install {' '.join(sorted(packages))}; elsewhere build petsam from its source"


def write(path, text, mode=0o644):
    """A file with its folder."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")
    path.chmod(mode)


def copy(source, path):
    """The same of a file's copy."""
    path.parent.mkdir(parents=True, exist_ok=True)
    shutil.copy(source, path)


def stage(build, tree):
    """The package's sources in `tree`, and in `tree`/data the files for the environment beside it."""
    shutil.rmtree(tree, ignore_errors=True)
    shutil.copytree(ROOT / "scripts", tree, ignore=shutil.ignore_patterns(
        "__pycache__", "*.egg-info", "build", "maintain", "packaging"))  # fmt: skip
    data, library = tree / "data", build / "lib" / "libpetsam.so"
    words = remedy(needed(build / "bin" / "petsam", library))
    soname = os.readlink(library)
    copy(library, data / "lib" / soname)
    write(data / "lib" / (soname + ".needs"), words + "\n")
    for name in PROGRAMS:
        copy(build / "bin" / name, data / "libexec" / name)
        write(data / "bin" / name, STARTER.format(name=name, remedy=words), 0o755)
        for page in (f"man/man1/{name}.1", f"bash-completion/completions/{name}"):
            copy(build / "share" / page, data / "share" / page)
    for binary in (data / "lib" / soname, *(data / "libexec").iterdir()):
        subprocess.run(["strip", binary], check=True)
    shutil.copytree(ROOT / "scripts/slurm", data / "share/petsam/scripts/slurm")
    for name in ("LICENSE", "CITATION.cff"):
        copy(ROOT / name, data / "share/petsam" / name)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--build", type=Path, default=ROOT / "build")
    build = parser.parse_args().build.resolve()
    tree, wheels = build / "wheel" / "tree", build / "wheel"
    stage(build, tree)
    for old in wheels.glob("petsam-*.whl"):
        old.unlink()
    platform = re.sub(r"[-.]", "_", sysconfig.get_platform())
    subprocess.run(
        [sys.executable, "-m", "pip", "wheel", "-q", "--disable-pip-version-check", "--no-deps", "-w", wheels, tree],
        env=dict(os.environ, PETSAM_WHEEL=platform),
        check=True,
    )
    (wheel,) = wheels.glob("petsam-*.whl")
    print(f"wrote {wheel} ({wheel.stat().st_size / 1e6:.1f} MB)")


if __name__ == "__main__":
    main()

"""`make wheel`: in an environment of its own, without the sources, it solves the README's first contact."""

import importlib.util
import os
import re
import shutil
import subprocess
import sys
import sysconfig
import zipfile

import numpy as np
import pytest

from conftest import PROGRAM, environment
from support import ROOT, Results

FIRST = re.search(r"^build/bin/petsam (.*?[^\\])$", (ROOT / "README.md").read_text(), re.M | re.S)
STEEL = "body1='steel', body2='steel'"


_spec = importlib.util.spec_from_file_location("make_wheel", ROOT / "scripts/packaging/wheel.py")
maker = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(maker)


def shell(command, cwd, check=0, **variables):
    """Output of a line of a shell that knows nothing of the sources."""
    hidden = ("PYTHON", "PYTHONPATH", "PETSAM", "PETSAM_LIBRARY", "PETSAM_BUILD", "VIRTUAL_ENV")
    env = {**{key: value for key, value in environment().items() if key not in hidden}, **variables}
    done = subprocess.run(command, shell=True, cwd=cwd, env=env, capture_output=True, text=True, timeout=300)
    assert done.returncode == check, (command, done.stdout, done.stderr)
    return done.stdout + done.stderr


@pytest.fixture(scope="module")
def wheel(tmp_path_factory):
    """Made of what is being tested, without the libraries, which are those of this system."""
    script = ROOT / "scripts/packaging/wheel.py"
    build = PROGRAM.parents[1]
    subprocess.run(["make", f"B={build}", "pages"], cwd=ROOT, check=True, capture_output=True, timeout=300)
    words = [sys.executable, script, "--build", build, "--out", tmp_path_factory.mktemp("wheel")]
    done = subprocess.run(words, capture_output=True, text=True, timeout=600)
    if "No matching distribution found for setuptools" in done.stderr:
        pytest.skip("no setuptools to make a wheel with")
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout.split()[1]


def test_the_wheel_has_the_package_the_programs_and_the_license(wheel):
    with zipfile.ZipFile(wheel) as archive:
        names = {name.split(".data/", 1)[-1] for name in archive.namelist()}
        (metadata,) = (name for name in archive.namelist() if name.endswith("METADATA"))
        required = re.findall(r"^Requires-Dist: ([\w-]+)[>=\d.]+$", archive.read(metadata).decode(), re.M)
    assert {"petsam/__init__.py", "data/bin/petsam", "data/bin/petsam-stress", "data/share/petsam/LICENSE"} <= names
    assert sorted(required) == sorted(re.findall(r"^[\w-]+", (ROOT / "scripts/requirements.txt").read_text(), re.M))
    assert not any("maintain/" in name or "packaging/" in name for name in names)


def install(wheel, folder):
    """A new environment with the wheel; numpy and the others are those of this Python."""
    subprocess.run([sys.executable, "-m", "venv", "--without-pip", folder], check=True, timeout=300)
    pip = [sys.executable, "-m", "pip", "--python", folder / "bin/python", "install", "-q", "--no-deps", wheel]
    subprocess.run(pip, check=True, timeout=300)
    (site,) = folder.glob("lib/python*/site-packages")
    (site / "others.pth").write_text(sysconfig.get_path("purelib") + "\n")
    return folder


@pytest.fixture
def fresh(wheel, tmp_path):
    return install(wheel, tmp_path / "fresh")


def first_contact(fresh, tmp_path, launcher):
    """Solves the README's contact on two ranks and in process; returns {name: path} of the libraries of the latter."""
    path = f"{fresh}/bin:{os.environ['PATH']}"
    command = f"{launcher} -n 2 petsam " + FIRST.group(1)
    (tmp_path / "build/run").mkdir(parents=True)
    n, width = re.search(r" chose -grid_n (\d+) -grid_size (\S+)\n", shell(command, tmp_path, PATH=path)).groups()
    result = Results(next(tmp_path.glob("build/run/*.h5")))
    assert np.isclose(result["load_n"], 1000, rtol=1e-12) and result.pressure.shape == (int(n), int(n))
    # the same contact in process, by the library of the wheel
    code = (
        f"import petsam; print(petsam.__file__); c = petsam.Contact(grid_n={n}, grid_size={width}, {STEEL}, "
        "friction=0.1, gap_type='sphere', gap_radius1=0.2, gap_radius2=0.2); "
        "print(c.try_step(load_n=1000, load_tx=60).pressure_max);"
        "print(*{line.split()[-1] for line in open('/proc/self/maps') if '.so' in line})"
    )
    package, pressure, libraries = shell(f'"{fresh}/bin/python" -c "{code}"', tmp_path).splitlines()
    mapped = {name.rsplit("/", 1)[-1]: name for name in libraries.split()}
    (library,) = (name for name in mapped if name.startswith("libpetsam"))
    assert package.startswith(str(fresh)) and mapped[library] == str(next(fresh.glob("lib/libpetsam.so.*.?")))
    assert np.isclose(float(pressure), result["pressure_max"], rtol=1e-12)
    for tool in ("petsam-plot --maps -o maps.png build/run/*.h5", "petsam-surface --help", "petsam-stress --version"):
        shell(tool, tmp_path, PATH=path)
    assert (tmp_path / "maps.png").exists()
    return mapped


def test_an_environment_with_the_wheel_alone_solves_the_first_contact_of_the_README(fresh, tmp_path):
    first_contact(fresh, tmp_path, "mpirun --oversubscribe")


def test_a_study_finds_program_and_job_script_of_the_wheel(fresh, tmp_path):
    (tmp_path / "one.csv").write_text("load_n\n1\n")
    fake = tmp_path / "bin" / "sbatch"
    fake.parent.mkdir()
    fake.write_text(f'#!/bin/sh\necho "$@" >>{tmp_path}/sbatch.txt\necho 1\n')
    fake.chmod(0o755)
    path = f"{fresh}/bin:{fake.parent}:{os.environ['PATH']}"
    shell("petsam-study one.csv --slurm", tmp_path, PATH=path)
    first, last = (tmp_path / "sbatch.txt").read_text().splitlines()
    assert f"{fresh}/share/petsam/scripts/slurm/array.sbatch" in first and f"{fresh}/bin/petsam-study" in last
    assert "exit 2: " in shell("petsam-study one.csv", tmp_path, check=1, PATH=path)  # petsam lacks the other options


def test_a_library_whose_license_is_not_listed_is_not_carried(monkeypatch):
    """Everything that the programs need is the system's, MPI's, or carried with its license."""
    assert "libhdf5" in " ".join(maker.needed(PROGRAM)) and maker.MPI not in maker.needed(PROGRAM)
    monkeypatch.setattr(maker, "LICENSES", {})
    with pytest.raises(SystemExit, match="unknown license"):
        maker.carried([PROGRAM])


def test_the_carrying_wheel_is_refused_where_a_file_needs_a_newer_C_library(monkeypatch):
    machine = sysconfig.get_platform().replace("-", "_")
    assert maker.platform(None) == machine
    table = {"old": "(GLIBC_2.2.5) pow\n(GLIBC_2.28) a", "new": "(GLIBC_2.9) a\n(GLIBC_2.34) b\n(GFORTRAN_8) c", "": ""}
    monkeypatch.setattr(maker, "output", lambda *words: table[words[-1]])
    assert [maker.c_library(file) for file in table] == [(2, 28), (2, 34), (0, 0)]
    assert maker.platform(["old", ""]) == machine.replace("linux", "manylinux_2_28")
    with pytest.raises(SystemExit, match="new needs glibc 2.34, expected 2.28"):
        maker.platform(["old", "new"])


def test_the_libraries_are_linked_with_the_C_library_that_the_wheel_names():
    script = (ROOT / "scripts/packaging/wheel-libraries.sh").read_text()
    assert re.search(r"^glibc=(.*)$", script, re.M)[1] == "{}.{}".format(*maker.C_LIBRARY)


@pytest.fixture(scope="module")
def standing():
    """The wheel of `make wheel`."""
    wheels = list((ROOT / "build/wheel").glob("petsam-*manylinux_*.whl"))
    if not wheels:
        pytest.skip("no wheel of make wheel stands in build/wheel")
    return wheels[0]


@pytest.fixture(scope="module")
def data(standing, tmp_path_factory):
    """The folder of its files for the environment."""
    folder = tmp_path_factory.mktemp("standing")
    with zipfile.ZipFile(standing) as archive:
        archive.extractall(folder)
    return next(folder.glob("*.data/data"))


def test_a_wheel_that_stands_needs_no_newer_C_library_than_its_name_says(standing, data):
    files = [path for path in data.rglob("*") if path.is_file() and path.read_bytes()[:4] == b"\x7fELF"]
    named = re.search(r"manylinux_(\d+)_(\d+)_", standing.name)
    assert len(files) > 4 and max(map(maker.c_library, files)) <= (int(named[1]), int(named[2])) == maker.C_LIBRARY


def test_a_wheel_that_stands_has_the_license_of_each_library(data):
    licenses = data / "share/petsam/licenses"
    listed = dict(line.split(": ") for line in (licenses / "libraries.txt").read_text().splitlines())
    assert set(listed) == {path.name for path in data.glob("lib/petsam/lib*")}
    assert all((licenses / text).stat().st_size > 1000 for text in (*listed.values(), "compiler_rt"))


def test_a_wheel_that_stands_solves_the_first_contact_with_libraries_of_its_own(standing, data, tmp_path):
    """Its MPI is the one of PyPI that it was built with."""
    fresh = install(standing, tmp_path / "fresh")
    mpich = ROOT / "build/wheel/libraries"
    for name in ("bin/mpirun", "bin/hydra_pmi_proxy", f"lib/{maker.MPI}"):
        shutil.copy(mpich / name, fresh / name)
    (fresh / "lib/mpich").symlink_to(mpich / "lib/mpich")
    mapped = first_contact(fresh, tmp_path, "mpirun")
    inside = {path.name for path in data.glob("lib/petsam/lib*")} | {maker.MPI}
    assert {name: mapped[name] for name in inside} == {
        name: str(fresh / "lib" / ("" if name == maker.MPI else "petsam") / name) for name in inside
    }

"""The tests' own tools: targets for other compilers and libraries, limits of time, the slowest tests."""

import os
import re
import subprocess
import sys

import pytest

from conftest import PROGRAM, environment
from support import ROOT, finished, limit

MAKEFILE = (ROOT / "Makefile").read_text()


def test_targets_that_CI_takes_as_arguments_are_there():
    text = (ROOT / ".ci/run").read_text()
    arguments = re.findall(r"^([a-z-]+)\)$", text, re.M)
    assert arguments == ["clang", "petsc-newest"] and all(f"#   .ci/run {name} " in text for name in arguments)
    for target in re.findall(r"\b(check-[a-z]+)", text):
        assert re.search(rf"^{target}:.*## ", MAKEFILE, re.M), target


def test_CI_refuses_an_unknown_argument_and_names_those_it_knows():
    done = subprocess.run([ROOT / ".ci/run", "gcc"], capture_output=True, text=True, timeout=60)
    assert done.returncode == 2 and done.stdout == ""
    assert done.stderr == ".ci/run: unknown argument gcc; use clang, petsc-newest, or none\n"


def test_the_newest_PETSc_may_be_another_version():
    words = ["make", "-n", "NEWEST=/nothing", "/nothing/done"]
    for version, wanted in (("", "petsc\n"), ("3.24.6", "petsc==3.24.6\n")):
        commands = subprocess.run([*words, f"PETSC_VERSION={version}"], cwd=ROOT, capture_output=True, text=True).stdout
        assert f"--no-binary :all: -d /nothing {wanted}" in commands and "--with-64-bit-indices=1" in commands


@pytest.mark.parametrize("load, seconds", [(0.0, 10.0), (1.0, 10.0), (3.0, 30.0), (1000.0, 200.0)])
def test_limits_of_time_grow_with_the_load(monkeypatch, load, seconds):
    monkeypatch.setattr(os, "getloadavg", lambda: (load * os.cpu_count(), 0.0, 0.0))
    assert limit(10) == pytest.approx(seconds) and limit(None) is None
    assert environment()["MPIEXEC_TIMEOUT"] == str(int(12 * seconds))


def test_ranks_that_wait_yield_their_core_and_a_run_that_hangs_ends(launcher, tmp_path):
    env = {**environment(), "MPIEXEC_TIMEOUT": "1"}
    assert env["OMPI_MCA_mpi_yield_when_idle"] == "1" and env["OMPI_MCA_hwloc_base_binding_policy"] == "none"
    done = subprocess.run([*launcher, "-n", "2", "sleep", "600"], env=env, capture_output=True, timeout=300)
    assert done.returncode != 0


def test_the_slowest_tests_are_printed_with_their_time():
    words = [ROOT / "tests/run.py", "--build", PROGRAM.parents[1], "--units-only", "--ranks", "1,2", "test_control"]
    done = finished([sys.executable, *words], env=environment())
    *_, heading, first, second, last = done.stdout.splitlines()
    assert heading == "slowest 30 unit tests (ranks)" and re.fullmatch(r"\d+ passed, 0 failed", last)
    times = [float(re.fullmatch(r" +([\d.]+) s  test_control on [12]", line).group(1)) for line in (first, second)]
    assert times == sorted(times, reverse=True)

"""Scripts from the build tree and installed, their Python and petsam; the manual's commands."""

import os
import re
import shutil
import subprocess
import sys

import pytest

from conftest import PROGRAM, environment, make_install
from support import ROOT, ball, finished, words


def shell(command, cwd, check=0, **variables):
    """Run a line of a shell in cwd, without PYTHON and PETSAM unless given; its output."""
    env = {key: value for key, value in environment().items() if key not in ("PYTHON", "PETSAM")}
    env.update(OMPI_MCA_rmaps_base_oversubscribe="1", **{k: str(v) for k, v in variables.items()})
    done = finished(command, check, shell=True, cwd=cwd, env=env, stdin=subprocess.DEVNULL)
    return done.stdout + done.stderr


@pytest.fixture
def tree(tmp_path):
    """A repository with the built program, and an environment that writes down that it was used."""
    tree = tmp_path / "petsam"
    for name in ("scripts", "examples"):
        shutil.copytree(ROOT / name, tree / name, ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copy(ROOT / "Makefile", tree)  # by which the examples know the sources
    (tree / "build" / "bin").mkdir(parents=True)
    (tree / "build" / "run").mkdir()
    (tree / "build" / "bin" / "petsam").symlink_to(PROGRAM)
    python = tree / "build" / "venv" / "bin" / "python"
    python.parent.mkdir(parents=True)
    python.write_text(f'#!/bin/sh\necho used >>{tmp_path}/used.txt\nexec {sys.executable} "$@"\n')
    python.chmod(0o755)
    return tree


@pytest.fixture(scope="module")
def prefix(tmp_path_factory):
    """make install."""
    folder = tmp_path_factory.mktemp("stage")
    make_install("prefix=/opt/p", f"DESTDIR={folder}")
    return folder / "opt" / "p"


# ---------------------------------------------------------------- where things are found


def test_in_the_build_tree_scripts_use_its_environment_and_program(tree, tmp_path):
    (tmp_path / "one.csv").write_text("load_tx\n1\n")
    shell("petsam/scripts/petsam-study one.csv -- " + " ".join(words(ball(n=24))), tmp_path)
    shell("petsam/scripts/petsam-plot --maps -o maps.png one/case/results.h5", tmp_path)
    assert (tmp_path / "maps.png").exists() and (tmp_path / "used.txt").read_text() == "used\nused\n"


def test_installed_scripts_find_the_installed_program(prefix, tmp_path):
    assert (prefix / "bin" / "petsam-study").is_symlink() and not os.path.isabs(
        os.readlink(prefix / "bin" / "petsam-study")
    )
    (tmp_path / "one.csv").write_text("load_tx\n1\n")
    path = "{}:/usr/bin:/bin:{}".format(os.path.dirname(sys.executable), os.environ["PATH"])
    shell("{}/bin/petsam-study one.csv -- {}".format(prefix, " ".join(words(ball(n=24)))), tmp_path, PATH=path)
    shell(f"{prefix}/bin/petsam-plot --maps -o maps.pdf one/case/results.h5", tmp_path, PATH=path)
    assert (tmp_path / "maps.pdf").exists()


@pytest.mark.parametrize("script", ["scripts/petsam/apps/study/array.sbatch", "examples/study/run.sbatch"])
def test_job_scripts_are_installed(prefix, script):
    assert (prefix / "share/petsam" / script).read_bytes() == (ROOT / script).read_bytes()


def test_petsam_of_the_environment_comes_first(tree, tmp_path):
    fake = tmp_path / "other"
    fake.write_text("#!/bin/sh\necho petsam: the other one >&2\nexit 9\n")
    fake.chmod(0o755)
    (tmp_path / "one.csv").write_text("load_tx\n1\n")
    assert "exit 9: the other one" in shell("petsam/scripts/petsam-study one.csv", tmp_path, check=1, PETSAM=fake)


@pytest.mark.parametrize(
    "script",
    [
        "petsam-compliance",
        "petsam-fatigue",
        "petsam-fit",
        "petsam-joint",
        "petsam-loads",
        "petsam-plot",
        "petsam-study",
        "petsam-surface",
        "petsam-wheel",
    ],
)
def test_missing_libraries_are_named_with_the_remedy(tree, tmp_path, script):
    bare = tmp_path / "bare"
    bare.write_text(f'#!/bin/sh\nexec {sys.executable} -E -S "$@"\n')
    bare.chmod(0o755)
    said = shell(f"petsam/scripts/{script} --help", tmp_path, check=1, PYTHON=bare)
    assert len(said.splitlines()) == 1 and "h5py" in said and "make venv" in said


# ---------------------------------------------------------------- what the manual says


def blocks(file, heading):
    """Commands of the blocks in sh after a heading, continued lines joined."""
    text = (ROOT / file).read_text().split(f"\n## {heading}\n")[1].split("\n## ")[0]
    lines = "\n".join(re.findall(r"^```sh\n(.*?)\n```$", text, re.M | re.S)).replace("\\\n", " ")
    return [re.sub(r" +", " ", line.strip()) for line in lines.splitlines()]


def test_four_commands_lead_from_the_sources_to_a_plotted_loop(tree):
    commands = blocks("examples/README.md", "A fretting loop in four commands")
    assert len(commands) == 4
    assert commands[0] == "scripts/install-dependencies.sh"
    assert commands[1].startswith("make ") and {"all", "venv"} <= set(commands[1].split())
    for command in commands[2:]:
        shell(command.replace(" -grid_n 256", " -grid_n 48"), tree)
    assert (tree / "build/run/loop.png").stat().st_size > 10000


def test_run_with_a_time_limit_goes_on_from_its_checkpoint(tree):
    first, again = blocks("examples/manual/CHECKPOINTS.md", "Checkpoints")
    assert first.endswith("-max_walltime 0:01") and again.endswith("-max_walltime 10:00 -restart build/run/state.h5")
    assert again.startswith(first.replace("0:01", "10:00"))
    shell(first.replace(" -grid_n 256", " -grid_n 64").replace("0:01", "0.1"), tree, check=75)
    shell(again.replace(" -grid_n 256", " -grid_n 64"), tree)


def test_the_example_study_runs_to_its_figure(tree, tmp_path):
    """A part of its cases, on a coarse grid."""
    table = tree / "examples" / "study" / "study.yaml"
    text = table.read_text()
    cut = re.sub(r"ratio: \[.*?\]", "ratio: [0.5, 0.9]", re.sub(r"nu: \[.*?\]", "nu: [0]", text))
    assert cut != text
    table.write_text(cut)
    said = shell("examples/study/run.sh", tree, GRID_N=64, OUT=tmp_path / "out", CORES=2)
    assert "4 cases: 4 finished, 0 failed" in said and (tmp_path / "out" / "study.png").exists()
    nu, cases, radius, energy, mu = [
        line for line in said.splitlines() if "between mu" in line or line.strip().startswith("0 ")
    ][-1].split()
    # nu = 0, where the closed solution is exact: about 42 cells in the contact's radius; mu is only a factor
    assert cases == "4" and float(radius) < 0.02 and float(energy) < 0.01 and float(mu) < 1e-5

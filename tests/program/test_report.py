"""What a run says: banner, a line a load step, closing table, progress; and where it says it."""

import os
import pty
import re
import subprocess

import h5py
import numpy as np
import pytest

from conftest import PROGRAM, environment
from support import ROOT, ball, bodies, flatten, history

EXAMPLE = str(ROOT / "examples" / "sphere" / "cattaneo.opts")
STEPS = dict(ball(48), load_tx=20.0, steps=4)
HEADING = [
    "step",
    "time/s",
    "N/N",
    "Tx/N",
    "contact/m2",
    "stick/m2",
    "p max/Pa",
    "q max/Pa",
    "slip/m",
    "it n",
    "it t",
    "residual",
    "s",
    "left",
]


def table(text):
    """Heading and lines of the steps."""
    lines = text.splitlines()
    first = next(k for k, line in enumerate(lines) if line.split()[:2] == ["step", "time/s"])
    return lines[first], [line for line in lines[first + 1 :] if re.match(r" *\d+ ", line)]


def banner(text, name):
    return re.search(rf"^  {name} +(.+)$", text, re.M).group(1)


def seconds(text, name):
    return float(re.search(rf"^ +{name} +(\d+\.\d+) s", text, re.M).group(1))


# ---- banner


@pytest.mark.parametrize("ranks", [1, 3])
def test_banner_tells_version_libraries_ranks_and_grid(petsam, ranks):
    text = petsam(STEPS, ranks=ranks).stdout
    version, petsc = petsam("--version").stdout.splitlines()[:2]
    assert text.startswith(version + ":")
    libraries = banner(text, "libraries")
    assert re.search(r"PETSc " + re.search(r"\d+\.\d+\.\d+", petsc).group() + ",", libraries)
    assert re.search(r"FFTW \d+\.\d+[\d.]*, HDF5 \d+\.\d+\.\d+, \S+", libraries)
    assert banner(text, "ranks").startswith(f"{ranks} on 1 node")
    assert banner(text, "grid").startswith("48 x 48 cells of ")
    assert banner(text, "steps").startswith("4,")


@pytest.mark.parametrize("ranks", [1, 2])
def test_memory_estimate_is_what_the_run_uses(petsam, ranks):
    """A rough figure for the choice of a machine: the program alone differs by tens of MB between systems."""
    text = petsam(ball(512), dict(load_tx=20.0), ranks=ranks).stdout
    told = float(re.search(r"about (\S+) MB per rank", banner(text, "memory")).group(1))
    used = float(re.search(r"memory (\S+) MB of the largest rank", text).group(1))
    assert 0.7 * used <= told <= 1.6 * used


# ---- steps


def test_each_step_is_a_line_of_fixed_columns(petsam, tmp_path):
    heading, lines = table(petsam(STEPS, dict(output="out.h5")).stdout)
    assert heading.split() == " ".join(HEADING).split()
    assert len({len(line) for line in [heading, *lines]}) == 1
    names = (
        "time",
        "load_n",
        "load_tx",
        "contact_area",
        "stick_area",
        "pressure_max",
        "shear_max",
        "slip_max",
        "normal_iterations",
        "tangential_iterations",
    )
    with h5py.File(tmp_path / "out.h5") as f:
        for k, line in enumerate(lines):
            values = line.split()
            assert int(values[0]) == k + 1
            for name, shown in zip(names, values[1:]):
                assert float(shown) == pytest.approx(f["history"][name][k], rel=6e-3, abs=1e-300), name
            worst = max(f["history"][f"{problem}_residual"][k] for problem in ("normal", "tangential"))
            assert float(values[-3]) == pytest.approx(worst, rel=0.06)
    assert len(lines) == 4


def test_all_loads_fit_into_a_line_of_120_columns(petsam):
    """Columns that are less wanted make way; loads that are 0 in all steps have no column."""
    loads = dict(load_tx=20.0, load_ty=-3.0, load_mx=0.01, rot_y=1e-7, load_mz=1e-3)
    heading, lines = table(petsam(dict(ball(48), steps=3), loads).stdout)
    assert max(len(line) for line in [heading, *lines]) <= 120
    assert heading.split()[:8] == ["step", "time/s", "N/N", "Tx/N", "Ty/N", "Mx/Nm", "My/Nm", "Mz/Nm"]
    assert [float(value) for value in lines[-1].split()[3:6]] == [20, -3, 0.01]


def test_numbers_of_many_cycles_stay_apart(petsam, tmp_path):
    (tmp_path / "c.csv").write_text("time,load_tx\n1,10\n2,-10\n3,10\n")
    case = dict(ball(32), friction=0.1, history="c.csv", wear_energy2=1e-14, wear_cycles=10**9, output="c.h5")
    lines = petsam(dict(case, load_tx=None)).stdout.splitlines()
    first = next(k for k, line in enumerate(lines) if line.split()[:2] == ["cycles", "jump"])
    rows = [line.split() for line in lines[first + 1 : lines.index("", first)]]
    with h5py.File(tmp_path / "c.h5") as f:
        cycle, jump = f["wear/cycle"][:], f["wear/jump"][:]
    assert max(jump) > 1e6 and {len(row) for row in rows} == {13}
    assert [float(row[0]) for row in rows] == pytest.approx(cycle, rel=1e-3)
    assert [float(row[1]) for row in rows] == pytest.approx(jump, rel=0.05)


def test_rounding_is_printed_as_zero(petsam):
    """Loads and displacements that vanish by symmetry; small ones that are given are printed as they are."""
    text = petsam(ball(48), dict(load_tx=20.0, load_my=1e-17)).stdout
    for name in ("load_mx", "load_ty", "load_mz"):
        assert re.search(rf"{name} +0 ", text), text
    for name in ("rot_x", "rot_z", "disp_y"):
        assert re.search(rf"{name} +0 ", text), text
    assert float(re.search(r"load_my +(\S+) ", text).group(1)) != 0
    assert float(re.search(r"disp_x +(\S+) ", text).group(1)) > 0
    text = petsam("-options_file", EXAMPLE, "-load_tx", "90").stdout  # solvers' tolerances leave rot_z of -9e-14
    for name in ("rot_x", "rot_y", "rot_z", "disp_y", "load_mz"):
        assert re.search(rf"{name} +0 ", text), text
    assert float(re.search(r"disp_x +(\S+) ", petsam(ball(48), dict(load_tx=1e-9)).stdout).group(1)) > 0


def test_time_left_is_what_the_other_steps_take(petsam):
    _, lines = table(petsam(dict(STEPS, grid_n=300, steps=6)).stdout)
    taken = [float(line.split()[-2]) for line in lines]
    left = [sum(int(part) * unit for part, unit in zip(line.split()[-1].split(":"), (3600, 60, 1))) for line in lines]
    assert left[-1] == 0
    for k in range(6):  # of the mean so far times the steps to come, rounded to seconds
        recent = taken[max(0, k - 4) : k + 1]
        assert left[k] == pytest.approx(np.mean(recent) * (5 - k), abs=0.51 + 0.005 * 5)


def test_failed_step_is_a_line_too(petsam):
    done = petsam(STEPS, dict(load_tx=100.0), check=11)
    assert len(table(done.stdout)[1]) == 1 and done.complaint[0].startswith("petsam: step 1: gross slip")


def test_steps_are_told_when_they_are_done(tmp_path):
    """Into a pipe as well, which C's streams would fill before they say anything."""
    run = subprocess.Popen(
        [str(PROGRAM), *flatten([STEPS, dict(steps=100000)])],
        stdout=subprocess.PIPE,
        text=True,
        env=environment(),
        cwd=tmp_path,
        stdin=subprocess.DEVNULL,
    )
    try:
        assert any(re.match(r" *3 ", line) for line in run.stdout)
        assert run.poll() is None
    finally:
        run.kill()
        run.communicate()


# ---- the end


def test_parts_of_the_time_make_up_the_whole(petsam):
    text = petsam(dict(STEPS, grid_n=200), dict(output="out.h5"), "-profile").stdout
    lines = re.search(r"^( +set-up .*?)^ +total ", text, re.M | re.S).group(1).splitlines()
    parts = {line[:30].strip(): seconds(text, line[:30].strip()) for line in lines}
    total = seconds(text, "total")
    assert {"set-up", "normal problem", "tangential problem", "edges", "check", "results", "other"} <= parts.keys()
    assert sum(parts.values()) == pytest.approx(total, abs=0.005 * (len(parts) + 1)) and total > 0
    assert parts["normal problem"] > 0 and parts["tangential problem"] > 0
    for name in ("influence coefficients", "operator applications", "preconditioner", "Fourier transforms"):
        assert 0 < seconds(text, name) <= total


def test_worst_residuals_are_those_of_the_history(petsam, tmp_path):
    """Also where they are those of a part of a divided step."""
    text = petsam(STEPS, dict(output="out.h5")).stdout
    with h5py.File(tmp_path / "out.h5") as f:
        for kind in ("normal", "tangential", "equilibrium"):
            value, step = re.search(rf"worst .*\b{kind} (\S+) \(step (\d+)\)", text).groups()
            column = f["history"][f"{kind}_residual"][:]
            assert float(value) == pytest.approx(column.max(), rel=6e-3)
            assert int(step) == column.argmax() + 1


LIFE = dict(wear_coefficient1=1e-13, wear_cycles=10.0)
YIELDS = dict(body2_yield=4e8, yield_layers=8)


@pytest.mark.parametrize("more", [LIFE, YIELDS, dict(LIFE, **YIELDS)], ids=["life", "yields", "life that yields"])
def test_parts_make_up_the_whole_time(petsam, tmp_path, more):
    """Nothing is counted twice: the kernels of plastic strain are made before the first step of a life."""
    rows = [(0.0, 100.0, 0.0), (1.0, 100.0, 20.0), (2.0, 100.0, -20.0), (3.0, 100.0, 0.0)]
    loads = history(tmp_path / "rows.csv", "time,load_n,load_tx", *rows)
    case = dict(
        bodies(), gap_type="sphere", gap_radius1=0.02, gap_radius2="inf", grid_size=9e-4, grid_n=12, friction=0.5
    )
    text = petsam(case, loads, more, dict(output="out.h5"), "-profile").stdout
    table = text.split("time by part")[1].split("within these")[0]
    share = {name.strip(): float(part) for name, part in re.findall(r"^    (\S.*?) +[\d.]+ s +([\d.]+) %", table, re.M)}
    assert share.pop("total") == 100 and len(share) > 7
    assert sum(share.values()) == pytest.approx(100, abs=1)


@pytest.mark.parametrize("every, fields", [(1, 4), (3, 2)])
def test_files_written_are_named(petsam, tmp_path, every, fields):
    text = petsam(STEPS, dict(output="out.h5", output_every=every)).stdout
    steps, saved, size = re.search(r"written +out\.h5: (\d+) steps, fields of (\d+), (\S+ [kM])B", text).groups()
    size = float(size[:-2]) * {"k": 1e3, "M": 1e6}[size[-1]]
    assert (int(steps), int(saved)) == (4, fields)
    assert size == pytest.approx((tmp_path / "out.h5").stat().st_size, rel=6e-3)


def test_nested_log_of_petsc_stays_as_it_is(petsam, tmp_path):
    """Its events are others than those of the closing table, which is left out."""
    text = petsam(STEPS, "-profile", "-log_view", ":log.xml:ascii_xml").stdout
    assert "SamNormalSolve" in (tmp_path / "log.xml").read_text()
    assert "time by part" not in text and "worst" in text


# ---- quiet, stderr


def test_quiet_says_nothing_and_computes_the_same(petsam, tmp_path):
    done = petsam(STEPS, "-quiet", "-output", "a.h5")
    assert done.stdout == "" and done.stderr == ""
    petsam(STEPS, "-output", "b.h5")
    with h5py.File(tmp_path / "a.h5") as a, h5py.File(tmp_path / "b.h5") as b:
        assert np.array_equal(a["shear_x"], b["shear_x"])


@pytest.mark.parametrize("ranks", [1, 3])
def test_quiet_leaves_warnings_and_errors(petsam, ranks):
    small = ball(40, half_width=0.9)
    done = petsam(small, "-quiet", "-output", "a.h5", "-allow_edge_contact", ranks=ranks)
    assert done.stdout == "" and len(done.complaint) == 1 and "warning" in done.complaint[0]
    done = petsam(small, "-quiet", "-output", "b.h5", ranks=ranks, check=12)
    assert len(done.complaint) == 1 and "edge" in done.complaint[0]


# ---- progress

# two seconds: a fine grid without coarser ones
LONG = dict(ball(1000), normal_levels=1, tangential_levels=1, load_tx=20.0)


def on_terminal(words, folder):
    """What a terminal gets of a command."""
    pid, terminal = pty.fork()
    if pid == 0:
        os.chdir(folder)
        os.execvpe(words[0], words, environment())
    text = b""
    while True:
        try:
            part = os.read(terminal, 65536)
        except OSError:  # the other end is closed
            break
        if not part:
            break
        text += part
    assert os.waitpid(pid, 0)[1] == 0
    return text.decode()


def progress(text):
    return re.findall(r"step 1 of 1, \d:\d\d:\d\d: (?:normal|tangential) problem, iteration \d+, residual \S+", text)


@pytest.mark.parametrize("ranks", [1, 2])
def test_long_step_shows_its_progress_on_a_terminal(launcher, tmp_path, ranks):
    words = (launcher + ["-n", str(ranks)] if ranks > 1 else []) + [str(PROGRAM), *flatten([LONG])]
    text = on_terminal(words, tmp_path)
    assert progress(text)
    assert re.search(r"\r +\r +step +time/s", text), "the line is not taken away"


def test_short_step_shows_no_progress(tmp_path):
    assert "\r" not in on_terminal([str(PROGRAM), *flatten([ball(40)])], tmp_path).replace("\r\n", "")


def test_progress_may_be_declined(tmp_path):
    assert not progress(on_terminal([str(PROGRAM), *flatten([LONG, "-progress", "never"])], tmp_path))


@pytest.mark.parametrize("ranks", [1, 2])
def test_no_progress_gets_into_a_file(launcher, tmp_path, ranks):
    """Not even where the launcher, itself on a terminal, gives its processes one and writes to a file."""
    words = (launcher + ["-n", str(ranks)] if ranks > 1 else []) + [str(PROGRAM), *flatten([LONG])]
    on_terminal(["sh", "-c", " ".join(words) + " > log.txt"], tmp_path)
    text = (tmp_path / "log.txt").read_text()
    assert len(table(text)[1]) == 1 and "\r" not in text


def test_progress_may_be_asked_for(petsam):
    assert progress(petsam(LONG, "-progress", "always").stdout)


# ---- help and version


def test_help_is_grouped(petsam):
    text = petsam("-help").stdout
    groups = re.findall(r"^([A-Z]\w+(?: \w+)*)$", text, re.M)
    first = [
        "Accuracy",
        "Plugins",
        "Grid",
        "Bodies",
        "Elasticity",
        "Friction",
        "Frictional heat",
        "Surfaces that slide past each other",
        "Wear",
    ]
    assert groups[: len(first) + 1] == [*first, "Plastic deformation"]
    assert len(set(groups)) == len(groups)
    assert max(map(len, text.splitlines())) <= 120


def test_help_shows_a_command_that_works(petsam):
    text = petsam("-help").stdout
    command = re.search(r"^  petsam (-grid_n.*?[^\\])$", text, re.M | re.S).group(1)
    petsam(*command.replace("\\\n", " ").split())


@pytest.mark.parametrize("word", ["--version", "-version"])
def test_version_is_told_by_either_word(petsam, word):
    assert petsam(word).stdout.startswith("petsam ")


def test_help_into_a_pipe_that_closes_is_no_crash(tmp_path):
    run = subprocess.Popen(
        [str(PROGRAM), "-help"],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env=environment(),
        cwd=tmp_path,
    )
    run.stdout.close()
    assert "PETSC ERROR" not in run.stderr.read()
    run.wait()


def test_edges_that_are_not_found_are_told(petsam):
    case = dict(ball(64), load_tx=25.0, steps=4)
    assert "  edges " not in petsam(dict(case, steps=1), "-profile").stdout.split("worst")[1]
    unlike = dict(case, body2_poisson=0.1)
    told = petsam(unlike).stdout
    share, step, areas = re.search(
        r"^  edges +(?:not reconstructed|reconstructed on (\d+) % of their length) in step (\d) \(the worst\)(.*)",
        told,
        re.M,
    ).groups()
    assert (
        int(share or 0) < 50 and 1 <= int(step) <= 4 and areas.startswith("; elsewhere areas" if share else ": areas")
    )
    assert " areas are counted in whole cells, minus 0.09 of a cell per side" in areas
    assert "  edges " not in petsam(unlike, dict(edges="none")).stdout.split("worst")[1]

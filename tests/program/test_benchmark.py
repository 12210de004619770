"""The benchmark (tests/bench): it runs, its accuracy tells solutions apart, and its scaling model holds together."""

import csv
import json
import os
import subprocess
import sys
import time
from pathlib import Path

import pytest

import support

sys.path.insert(0, str(support.ROOT / "tests" / "bench"))
import benchmark  # noqa: E402
import paired  # noqa: E402
import peer  # noqa: E402
import problem  # noqa: E402
import scaling  # noqa: E402

pytestmark = pytest.mark.slow
CASES = ("hertz", "rough_8", "periodic_8", "slip_tx", "slip_tx_mz", "cycle_16")
N, SECONDS = 2048, (0.06, 0.033, 0.057)  # a convolution's on one rank, and on two by shared memory and by messages


BUILD = Path(os.environ.get("PETSAM_BUILD", support.ROOT / "build")).resolve()
# as it is here, without what MPI adds in a process that a test before has started it in, by which launchers fail
ENVIRONMENT = dict(os.environ)
TINY = ("--quick", "--peers", "none", "--cells", "32", "--repeats", "1")


def command(*words, build=BUILD):
    return [sys.executable, str(support.ROOT / "tests/bench/benchmark.py"), "--build", str(build), *map(str, words)]


def run(*words, build=BUILD):
    return subprocess.run(command(*words, build=build), capture_output=True, text=True, timeout=300, env=ENVIRONMENT)


def rows(out):
    path = out / "results.json"
    return json.loads(path.read_text())["runs"] if path.exists() else []


@pytest.fixture(scope="module")
def report(tmp_path_factory):
    """The folder of a run with petsam and FFTW alone, on a tiny grid."""
    out = tmp_path_factory.mktemp("benchmark")
    done = run(*TINY, "--out", out)
    assert done.returncode == 0, done.stdout + done.stderr
    return out


def test_every_case_is_solved_on_one_and_two_ranks(report):
    assert {(r["case"], r["cores"]) for r in rows(report)} == {(case, n) for case in CASES for n in (1, 2)}
    assert all(r["accuracy"] == "exact" for r in rows(report))


def test_memory_is_a_process_s(report):
    assert all(
        10 < r["memory"] / r["cores"] < 1000 for r in rows(report)
    )  # MB: PETSc alone takes 30, a grid of 32 next to nothing


def test_report_has_all_rows_and_figures(report):
    with open(report / "results.csv", newline="") as file:
        assert len(list(csv.DictReader(file))) == 2 * len(CASES)
    text = (report / "report.md").read_text()
    assert all(
        f"![{name}]({name}.png)" in text and (report / f"{name}.png").exists()
        for name in ("seconds", "memory", "scaling")
    )
    assert "| 32² | 2 |" in text  # FFTW's padded pair beside petsam's convolution


def test_parts_of_a_solve_make_up_the_whole(report):
    lines = (report / "report.md").read_text().split("| preconditioner | rest |")[1].splitlines()[2:]
    solves = [[cell.strip() for cell in line.split("|")[1:-1]] for line in lines if line.startswith("|")]
    solves = solves[: 2 * (len(CASES) - 1)]  # all but the cycle
    assert {(row[0], row[2]) for row in solves} >= {("Hertz", "1"), ("Hertz", "2")}
    for row in solves:
        total, *parts = map(float, row[3:])
        assert total > 0 and min(parts) >= 0 and sum(parts) == pytest.approx(total, abs=0.3)


@pytest.fixture
def killed(tmp_path):
    """The folder of a run that was killed after its first rows."""
    words = (*TINY, "--cases", "hertz,slip_tx", "--out", tmp_path)
    with subprocess.Popen(command(*words), stdout=subprocess.DEVNULL, env=ENVIRONMENT) as started:
        end = time.monotonic() + support.limit(120)
        while not rows(tmp_path) and started.poll() is None and time.monotonic() < end:
            time.sleep(0.02)
        started.kill()
    return words, tmp_path


def test_killed_run_goes_on_where_it_was(killed):
    words, out = killed
    before = rows(out)
    done = run(*words)
    assert done.returncode == 0, done.stdout + done.stderr
    assert 0 < len(before) < 4 and len(rows(out)) == 4
    assert rows(out)[: len(before)] == before  # the times, too
    assert f"resumed after {len(before)} rows" in (out / "report.md").read_text()


def test_killed_run_does_not_go_on_with_other_options(killed):
    words, out = killed
    before = rows(out)
    done = run(*words, "--repeats", "2")
    assert done.returncode == 1 and "repeats is 2, was 1" in done.stderr and "--anew" in done.stderr
    assert rows(out) == before


def test_killed_run_starts_over_when_told(killed):
    words, out = killed
    done = run(*words, "--repeats", "2", "--anew")
    assert done.returncode == 0, done.stdout + done.stderr
    assert [len(r["runs"]) for r in rows(out)] == [2] * 4


def test_failing_case_is_named_and_loses_no_other(tmp_path):
    """A petsam that fails with M_z alone; mended, the same command measures only that."""
    build = tmp_path / "build"
    (build / "bin").mkdir(parents=True)
    for name in ("bench", "venv"):
        (build / name).symlink_to(BUILD / name)
    program = build / "bin" / "petsam"
    program.write_text(
        f'#!/bin/sh\ncase "$*" in *load_mz*) [ -e {tmp_path}/mended ] || exit 3;; esac\nexec {BUILD}/bin/petsam "$@"\n'
    )
    program.chmod(0o755)
    words = (*TINY, "--cases", "slip_tx_mz,hertz", "--out", tmp_path / "out")
    done = run(*words, build=build)
    assert done.returncode == 1 and "slip_tx_mz 32^2 petsam on 2: petsam: exit code 3" in done.stderr
    timed = [r for r in rows(tmp_path / "out") if "seconds" in r]
    assert [(r["case"], r["cores"]) for r in timed] == [("hertz", 1), ("hertz", 2)]
    assert "exit code 3" in (tmp_path / "out" / "report.md").read_text()
    (tmp_path / "mended").touch()
    done = run(*words, build=build)
    assert done.returncode == 0, done.stdout + done.stderr
    assert rows(tmp_path / "out")[:2] == timed and all("seconds" in r for r in rows(tmp_path / "out"))


def rolling(out, *words, build=BUILD):
    script = support.ROOT / "tests/bench/rolling.py"
    words = [sys.executable, script, "--build", build, "--out", out, "--cells", "64,96,128", "--repeats", "1", *words]
    return subprocess.run(words, capture_output=True, text=True, timeout=300, env=ENVIRONMENT)


def test_rolling_stands_beside_contact(tmp_path):
    done = rolling(tmp_path)
    assert done.returncode == 0, done.stdout + done.stderr
    with open(tmp_path / "rolling.csv", newline="") as file:
        of64, of96, of128 = csv.DictReader(file)
    assert float(of64["T_x"]) == pytest.approx(float(of64["CONTACT T_x"]), abs=6e-5) and not of96["CONTACT T_x"]
    assert 0 < float(of64["seconds"]) < 10 and 5 < float(of64["applications"]) <= 30 and float(of64["memory"]) > 10
    assert float(of128["extrapolated"]) == pytest.approx(0.4997, abs=5e-4)  # the limit of fine grids
    (line,) = (line for line in done.stdout.splitlines() if line.startswith("| 64 |"))
    assert line.endswith("| 0.5054 |")


def test_loads_other_than_contact_s_fail(tmp_path):
    """A petsam whose creepage is larger by a percent."""
    build = tmp_path / "build"
    (build / "bin").mkdir(parents=True)
    program = build / "bin" / "petsam"
    program.write_text(f'#!/bin/sh\nexec {BUILD}/bin/petsam $(echo "$@" | sed "s/-creep_x [^ ]*/-creep_x 8.87e-4/")\n')
    program.chmod(0o755)
    done = rolling(tmp_path, build=build)
    assert done.returncode == 1 and "T_x differs from CONTACT's on [64, 128] cells" in done.stderr


@pytest.mark.parametrize("n, first, last", [(6, 0, 5), (9, 1, 7), (20, 5, 14)])
def test_interval_of_a_median_is_that_of_order_statistics(n, first, last):
    """It holds the median of the values with 95 %: by the binomial distribution, tabulated."""
    assert paired.interval(list(range(n - 1, -1, -1))) == (first, last)


def test_aspher_is_measured_on_the_periodic_plane():
    assert peer.cannot("aspher", "periodic") is None and peer.settings("aspher", "periodic") == ["aspher periodic"]
    assert "aspher periodic" not in peer.settings("aspher", "rough")


@pytest.mark.skipif(not (BUILD / "peers/bin/python").exists(), reason="no other programs: make peers")
def test_pair_is_measured_by_turns(tmp_path):
    script = support.ROOT / "tests/bench/paired.py"
    words = [sys.executable, script, "--build", BUILD, "--out", tmp_path, "--cells", "64"]
    done = support.finished(list(map(str, words)), env=ENVIRONMENT)
    (found,) = json.loads((tmp_path / "paired.json").read_text())["results"]
    assert len(found["runs"]) == 6 and max(found["errors"].values()) <= benchmark.EXACT
    assert "| 64² | ratio, with its interval |" in done.stdout


def test_unknown_case_is_refused():
    done = run("--cases", "hertzz")
    assert done.returncode == 2 and "no case hertzz" in done.stderr


def test_runs_end_at_the_limit():
    ran = benchmark.Ran(["sleep", "60"], 0.2)
    assert ran.code is None and ran.seconds < 30


@pytest.mark.parametrize("case", ["hertz", "rough_8"])
def test_loose_solutions_are_not_exact(petsam, tmp_path, case):
    problem.make(case, 32, tmp_path)
    options = json.loads((tmp_path / "problem.json").read_text())["options"]
    petsam(*options, "-normal_rtol", "1e-4", "-normal_levels", "1", "-output", "loose.h5")
    numbers = problem.check(tmp_path, Path(tmp_path / "loose.h5"))
    # petsam stops where both are below its tolerance, here with the approach that its own fit gives
    assert benchmark.EXACT < max(numbers["complementarity"], numbers["penetration"]) < 2e-4


def test_rough_plane_is_the_same_on_every_grid():
    """A grid of three times as many cells has a centre in every centre of the coarse one."""
    coarse, fine = problem.rough_plane(132, 1e-3), problem.rough_plane(396, 1e-3)
    assert abs(fine[1::3, 1::3] - coarse).max() <= 1e-12 * abs(coarse).max()  # rounding of the transforms


def convolution():
    return scaling.fit(N, *SECONDS, 20e9, scaling.Assumptions())


def test_model_meets_what_was_measured():
    model = convolution()
    assert model.seconds(N, 1) == pytest.approx(SECONDS[0], rel=1e-12)
    assert model.seconds(N, 2) == pytest.approx(SECONDS[1], rel=1e-12)


def test_model_is_never_better_than_perfect_scaling():
    model = convolution()
    solve = scaling.measured_solve(N, 2.0, 14, 10, model)
    assert solve.seconds(model, N, 1) == pytest.approx(2.0, rel=1e-12)
    for n in (N, 8 * N):
        one = solve.seconds(model, n, 1)
        assert all(p * solve.seconds(model, n, p) > one for p in (2, 16, 64, 128, 1024, 4096))


def test_the_bench_beside_contact_says_what_it_needs(tmp_path):
    script = str(support.ROOT / "tests/bench/contact.py")
    done = subprocess.run([sys.executable, script, "--contact", str(tmp_path)], capture_output=True, text=True)
    assert done.returncode == 1 and not done.stdout
    assert done.stderr.startswith("contact.py: no CONTACT: give --contact folder")

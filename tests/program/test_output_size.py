"""How large results are and how long they take: single precision, the forecast, steps that wait to be written."""

import re
import signal
import time

import h5py
import numpy as np
import pytest

import conftest
import petsam as library
from kinds.kills import differences, write_history
from support import FIELDS, SPHERE
from test_checkpoint import small_disk as small_disk  # a fixture

CASE = dict(SPHERE, load_n=None, grid_n=(40, 33), history="history.csv", output="out.h5")
STEPS = 24


@pytest.fixture
def folder(tmp_path):
    write_history(tmp_path, STEPS)
    return tmp_path


# ---- single precision


@pytest.mark.parametrize("ranks", [1, 3])
@pytest.mark.parametrize("more", [{}, dict(output_compress=4, output_chunk=9)], ids=["plain", "compressed"])
def test_fields_are_the_nearest_singles(folder, petsam, ranks, more):
    petsam(CASE, more, dict(output="double.h5"), ranks=ranks)
    petsam(CASE, more, dict(output_single=True), ranks=ranks)
    with h5py.File(folder / "out.h5") as one, h5py.File(folder / "double.h5") as two:
        for name in FIELDS:
            expected = two[name][:]
            assert one[name].dtype == (np.int8 if name == "state" else np.float32)
            assert np.array_equal(one[name][:], expected if name == "state" else expected.astype(np.float32)), name
        for name in ("x", "y", "time", "contact_edge"):
            assert one[name].dtype == np.float64 and np.array_equal(one[name][:], two[name][:], equal_nan=True)
        for name in one["history"]:
            assert np.array_equal(one["history"][name][:], two["history"][name][:], equal_nan=True)
    if not more:
        assert (folder / "out.h5").stat().st_size < 0.7 * (folder / "double.h5").stat().st_size


@pytest.mark.parametrize("ranks", [2, 3])
def test_many_chunks_are_written_by_several_ranks(folder, petsam, ranks):
    """HDF5's metadata of these steps are more than it keeps by itself until the file is flushed."""
    write_history(folder, 8)
    case = dict(CASE, grid_n=96, output_chunk=8, output_fields="all")
    petsam(case, dict(output="one.h5"))
    petsam(case, ranks=ranks)
    assert not differences(folder / "one.h5", folder / "out.h5")


def test_readers_cope_with_singles(folder, petsam):
    """Sums over a field are of doubles; the stresses are those of doubles to single precision."""
    case = dict(CASE, grid_n=32, output_every=8)
    petsam(case, dict(output="double.h5"))
    petsam(case, dict(output_single=True))
    for name in ("out", "double"):
        words = dict(input=f"{name}.h5", output=f"{name}.stress.h5", depths="0,1e-4", quantities="stress,mises")
        conftest.execute([], folder, [words], 1, 0, program=conftest.PROGRAM.with_name("petsam-stress"))
    with library.open(folder / "out.h5") as one, library.open(folder / "double.h5") as two:
        assert one.field("pressure").dtype == np.float64
        assert np.allclose(one.field("pressure"), two.field("pressure"), rtol=1e-7, atol=0)
        assert one.contact_window(-1) == two.contact_window(-1)
    with h5py.File(folder / "out.stress.h5") as one, h5py.File(folder / "double.stress.h5") as two:
        for name in ("stress_zz", "mises"):
            assert np.allclose(one[name], two[name], rtol=0, atol=3e-7 * np.max(np.abs(two[name])))


def test_picture_of_singles(folder, petsam, draw):
    petsam(CASE, dict(output_single=True, output_every=12))
    assert draw("out.h5") == (0, [])
    pictures = list(folder.glob("*.png"))
    assert pictures and all(picture.stat().st_size > 10000 for picture in pictures)


# ---- the forecast


def forecast(text):
    """The size that the banner tells, bytes, and the word before it."""
    word, number, unit = re.search(r"^  file size +(\D+) (\S+) (\S)B, \S+ \SB free there$", text, re.M).groups()
    return word, float(number) * 1e3 ** (1 + "kMGT".index(unit))


@pytest.mark.parametrize(
    "options",
    [
        dict(output_fields=None),
        dict(output_fields="pressure", output_every=5),
        dict(output_fields="none"),
        dict(output_fields=None, output_single=True, grid_n=150),
        dict(output_fields="pressure,contact_edge", output_chunk=16, stiffness=True),
    ],
    ids=str,
)
def test_forecast_is_the_size(folder, petsam, options):
    case = {**CASE, **options}
    word, size = forecast(petsam(case).stdout)
    assert word == "about" and size == pytest.approx((folder / "out.h5").stat().st_size, rel=0.12)


def test_forecast_of_compressed_results_is_an_upper_one(folder, petsam):
    word, size = forecast(petsam(CASE, dict(output_compress=9)).stdout)
    assert word == "at most" and size > (folder / "out.h5").stat().st_size


def test_forecast_after_a_restart_is_of_the_part(folder, petsam):
    petsam(CASE, dict(checkpoint="state.h5", checkpoint_every=7))
    _, size = forecast(petsam(CASE, dict(restart="state.h5.1")).stdout)
    assert size == pytest.approx((folder / "out.part2.h5").stat().st_size, rel=0.12)


def test_results_larger_than_the_disk_are_a_warning_at_the_start(small_disk, petsam):
    done = petsam(dict(CASE, output="out.h5"), dict(grid_n=32), check=None)
    assert not [line for line in done.complaint if "warning" in line]
    done = petsam(dict(CASE, output="away/out.h5"), dict(grid_n=256), check=None)
    warning = [line for line in done.complaint if "warning" in line]
    assert len(warning) == 1 and "-output away/out.h5: needs about" in warning[0]
    assert all(option in warning[0] for option in ("-output_every", "-output_fields", "-output_single"))


# ---- steps that wait to be written


def whole_steps(path):
    """Steps that all columns have; all of them must be numbers that the history asks for."""
    with h5py.File(path) as f:
        columns = {name: data[:] for name, data in f["history"].items()}
        steps = min(len(column) for column in columns.values())
        assert np.array_equal(columns["time"][:steps], np.arange(steps) + 1.0)
        assert np.all(np.isfinite(columns["contact_area"][:steps]))
        assert len(f["pressure"]) >= steps // 1000
        return steps


@pytest.mark.parametrize("wait", [0, 0.5], ids=["at once", "half a second"])
def test_steps_wait_as_long_as_they_may(tmp_path, wait):
    """A run that is killed loses no more."""
    write_history(tmp_path, 3000)
    run = conftest.start([], tmp_path, [CASE, dict(output_every=1000, output_flush=wait, output_fields="pressure")])
    told = []  # when each step was told
    for line in run.stdout:
        if re.match(r" *\d+ +\S+ +\d", line):
            told.append(time.monotonic())
        if len(told) == 400:
            break
    run.send_signal(signal.SIGKILL)
    killed = time.monotonic()
    told += [killed for line in run.communicate()[0].splitlines() if re.match(r" *\d+ +\S+ +\d", line)]
    steps = whole_steps(tmp_path / "out.h5")
    must = len(told) if wait == 0 else sum(when < killed - wait - 0.5 for when in told)
    assert steps >= must and steps >= len(told) - 256
    assert wait == 0 or steps % 256 == 0 or killed - told[0] > wait


def test_steps_wait_for_no_checkpoint(tmp_path, petsam):
    """What is before a checkpoint must be in the results, from which the next run goes on."""
    write_history(tmp_path, 40)
    case = dict(CASE, output_every=1000, output_flush=1000, output_fields="pressure")
    run = conftest.start([], tmp_path, [case, dict(checkpoint="state.h5", checkpoint_every=7, progress="never")])
    for line in run.stdout:
        if re.match(r" *15 +\S", line):
            break
    run.send_signal(signal.SIGKILL)
    run.communicate()
    with h5py.File(tmp_path / "state.h5") as f:
        done = int(f.attrs["progress"][0])
    assert done >= 14 and whole_steps(tmp_path / "out.h5") >= done
    petsam(case, dict(restart="state.h5"))
    petsam(case, dict(output="whole.h5"))
    assert not differences(tmp_path / "out.h5", tmp_path / "whole.h5")


@pytest.mark.parametrize("every", [70, 1], ids=["few fields", "all fields"])
@pytest.mark.parametrize("ranks", [1, 2])
def test_waiting_changes_no_value(tmp_path, petsam, ranks, every):
    write_history(tmp_path, 300 if every > 1 else 40)
    case = dict(
        CASE,
        grid_n=16,
        output_every=every,
        stiffness=True,
        output_fields="all",
        output_single="true" if every == 1 else "false",
    )
    petsam(case, dict(output_flush=0, output="at_once.h5"))
    petsam(case, dict(output_flush=1000), ranks=ranks)
    assert not differences(tmp_path / "out.h5", tmp_path / "at_once.h5")


def test_steps_with_fields_are_written_together(tmp_path, petsam):
    """Steps of a row of cells, which take less time than to write them; none is told before it is in the file."""
    rows = "".join(f"{k + 1},1e5,{8e3 * np.sin(k / 20):.9g}\n" for k in range(250))
    (tmp_path / "history.csv").write_text("time,load_n,load_tx\n" + rows)
    case = dict(CASE, elasticity="plane", gap_type="ellipsoid", gap_radius1=None, gap_radius2=None, gap_radius_x=0.1)
    case.update(gap_radius_y="inf", grid_n=64, grid_size=5e-3)
    run = conftest.start([], tmp_path, [case])
    steps = []
    for line in run.stdout:
        if found := re.match(r" *(\d+) +\S+ +\S+ +\S+ ", line):
            steps.append(int(found[1]))
        if len(steps) == 80:
            break
    run.send_signal(signal.SIGSTOP)
    told = len(steps)
    with h5py.File(tmp_path / "out.h5", locking=False) as f:
        written = min(len(f[name]) for name in ("time", "pressure", "shear_x", "history/load_tx"))
        assert written >= told and np.array_equal(f["time"][:told], np.arange(told) + 1.0)
    run.send_signal(signal.SIGCONT)
    run.communicate()
    assert run.returncode == 0
    petsam(case, dict(output="at_once.h5", output_flush=0))
    assert not differences(tmp_path / "out.h5", tmp_path / "at_once.h5")


def test_steps_before_a_failure_are_written(tmp_path, petsam):
    (tmp_path / "history.csv").write_text("time,load_n,load_tx\n1,1000,0\n2,1000,10\n3,1000,200\n")
    petsam(CASE, dict(output_every=1000, output_flush=1000), check=11)
    with h5py.File(tmp_path / "out.h5") as f:
        assert f["history/status"][:].tolist() == [0, 0, 11] and f["time"][:].tolist() == [2]


# ---- a run that only checks


@pytest.mark.parametrize("ranks", [1, 2])
def test_dry_run_forecasts_and_writes_nothing(folder, petsam, ranks):
    before = sorted(folder.iterdir())
    done = petsam(CASE, dict(dry_run=True, checkpoint="state.h5"), ranks=ranks)
    assert sorted(folder.iterdir()) == before
    told = re.search(r"file size +about ([\d.]+) (\w+), .* free there", done.stdout)
    assert "roughly" in done.stdout and "nothing is solved" in done.stdout and "memory" in done.stdout
    petsam(CASE)
    unit = dict(kB=1e3, MB=1e6)[told[2]]
    assert float(told[1]) * unit == pytest.approx((folder / "out.h5").stat().st_size, rel=0.1)


ROW = re.compile(r"^ +(\d+) +(\d+) +([\d.e+-]+) +(\d+) % +([\d.]+) (\wB)$", re.M)


def test_dry_run_predicts_times_and_memory_on_other_ranks(folder, petsam):
    """The memory is that which a run on so many ranks estimates; one rank sends nothing."""

    def memory(ranks):
        return re.search(r"memory +about (.*) per rank", petsam(CASE, dict(dry_run=True), ranks=ranks).stdout)[1]

    done = petsam(CASE, dict(dry_run=True, fft_exchange="transpose"))
    rows = ROW.findall(done.stdout)
    seconds, sent = ([float(row[k]) for row in rows] for k in (2, 3))
    assert [int(row[0]) for row in rows] == [2**k for k in range(11)]
    assert sent[0] == 0 and sent[-1] > 90 and seconds[-1] > seconds[0]
    assert [f"{row[4]} {row[5]}" for row in rows[:2]] == [memory(1), memory(2)]
    told = float(re.search("roughly ([^ ]*) s", done.stdout)[1])
    assert seconds[0] == pytest.approx(told)
    assert "model" not in petsam(CASE).stdout


def test_dry_run_reads_all_that_a_run_reads(folder, petsam):
    petsam(CASE, dict(checkpoint="state.h5", checkpoint_every=7))
    on = dict(CASE, restart="state.h5", output="on.h5", dry_run=True)
    write_history(folder, STEPS + 4)
    assert "after step 21" in petsam(on).stdout
    assert "friction" in petsam(on, dict(friction=0.123), check=2).stderr
    assert "cannot be written: " in petsam(CASE, dict(output="no/out.h5", dry_run=True), check=3).stderr
    (folder / "file").touch()
    assert "its folder is a file" in petsam(CASE, dict(output="file/out.h5", dry_run=True), check=3).stderr
    assert "-frob" in petsam(CASE, dict(frob=1, dry_run=True), check=2).stderr
    assert not (folder / "on.h5").exists()


# ---- fields at the rows of a history


def test_fields_at_the_rows_of_a_history(folder, petsam):
    """Ends of rows have their times, whatever the number of steps to them."""
    (folder / "rows.csv").write_text("time,load_n\n0,5\n1,20\n3,10\n7,30\n")
    case = dict(CASE, history="rows.csv", steps=3, output_at="history")
    for every, times in ((1, [0, 1, 3, 7]), (2, [1, 7]), (3, [3, 7])):
        petsam(case, dict(output_every=every))
        with h5py.File(folder / "out.h5") as f:
            assert f["time"][:].tolist() == times and f["history/time"].size == 12

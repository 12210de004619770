"""A full disk, a lost folder, a run that is killed: the file stays readable up to its last complete step."""

import contextlib
import os
import re
import resource
import shutil
import signal
import subprocess
import time

import h5py
import numpy as np
import pytest

import conftest
from kinds import kills
from petsam.results import Results
from support import FIELDS, SPHERE, flatten

# a load that goes on changing, so that every step has its own fields
TX = [float(5 * np.sin(k / 5)) for k in range(3000)]
CASE = dict(SPHERE, history="history.csv", output="out/out.h5")


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "history.csv").write_text("time, load_tx\n" + "".join(f"{k + 1}, {tx!r}\n" for k, tx in enumerate(TX)))
    (tmp_path / "out").mkdir()
    return tmp_path


def assert_intact(path, least):
    """All steps up to the last complete one hold what was computed; there are at least so many."""
    with h5py.File(path) as f:
        steps = min(len(data) for data in f["history"].values())
        saved = min(f[name].shape[0] for name in (*FIELDS, "time"))
        assert steps >= least and saved >= least, (steps, saved, least)
        area = np.diff(f["x"])[0] * np.diff(f["y"])[0]
        assert np.array_equal(f["time"][:least], np.arange(least) + 1.0)
        assert f["pressure"][:least].sum(axis=(1, 2)) * area == pytest.approx(SPHERE["load_n"], rel=1e-9)
        assert f["shear_x"][:least].sum(axis=(1, 2)) * area == pytest.approx(TX[:least], rel=1e-9, abs=1e-9)
        assert f["history/load_tx"][:least] == pytest.approx(TX[:least], rel=1e-9, abs=1e-9)
        for name in FIELDS:
            assert np.all(np.isfinite(f[name][:least])), name
    return steps


def start(launcher, folder, ranks, *options, **how):
    return conftest.start(launcher, folder, [CASE, *options], ranks, **how)


def told(text):
    return len(re.findall(r"^ *\d+ +\S+ +1000 ", text, re.M))


def ended(run):
    """Exit code, what was told since, and the program's complaints."""
    out, err = run.communicate(timeout=60)
    return run.returncode, told(out), [line for line in err.splitlines() if line.startswith("petsam: ")]


# ---- no room


@pytest.mark.parametrize("ranks", [1, 2])
@pytest.mark.parametrize("options", [{}, dict(output_compress=4)], ids=["plain", "compressed"])
def test_file_that_may_not_grow_ends_the_run(launcher, folder, ranks, options):
    """The limit of a file's size stands for a quota."""
    limit = 12 << 20
    run = start(
        launcher, folder, ranks, options, preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))
    )
    code, steps, complaint = ended(run)
    assert code == 3 and len(complaint) == 1 and "out/out.h5" in complaint[0]
    assert steps >= 10
    assert assert_intact(folder / "out" / "out.h5", steps) == steps


def test_file_that_may_not_even_begin_ends_the_run(launcher, folder):
    """HDF5 does not survive this: it must be found before."""
    limit = 13 << 10
    run = start(launcher, folder, 1, {}, preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit)))
    code, steps, complaint = ended(run)
    assert code == 3 and steps == 0 and len(complaint) == 1 and "File too large" in complaint[0]


@pytest.fixture
def small_disk(folder):
    """out/ on a disk of 16 MB."""
    with conftest.small_disk_on(folder / "out", "16m"):
        yield folder


@pytest.mark.parametrize("ranks", [1, 2])
@pytest.mark.parametrize("n, least", [(None, 10), (160, 3)], ids=["small", "large"])
def test_full_disk_ends_the_run(launcher, small_disk, ranks, n, least):
    """Also where the fields of one step take more than is reserved for HDF5's metadata."""
    options = dict(grid_n=n) if n else {}
    code, steps, (warning, *complaint) = ended(start(launcher, small_disk, ranks, options))
    assert "warning: -output out/out.h5: needs about" in warning
    assert code == 3 and len(complaint) == 1 and "out/out.h5" in complaint[0] and "No space left" in complaint[0]
    assert steps >= least
    assert_intact(small_disk / "out" / "out.h5", steps)


# ---- no folder


@pytest.mark.parametrize("ranks", [1, 2])
@pytest.mark.parametrize("lose", [lambda out: out.rename(out.parent / "away"), shutil.rmtree], ids=["moved", "removed"])
def test_lost_folder_ends_the_run(launcher, folder, ranks, lose):
    run = start(launcher, folder, ranks)
    conftest.wait_for(run, 4)
    lose(folder / "out")
    code, steps, complaint = ended(run)
    assert code == 3 and len(complaint) == 1 and "out/out.h5" in complaint[0]
    if (folder / "away").exists():
        assert_intact(folder / "away" / "out.h5", 4 + steps)


# ---- changed by others


@pytest.mark.parametrize("ranks", [1, 2])
@pytest.mark.parametrize(
    "change, says",
    [
        (lambda path: path.write_bytes(b""), "changed its size"),
        (lambda path: os.truncate(path, path.stat().st_size - 1), "changed its size"),
        (lambda path: shutil.copy(path, path.with_name("new")) and path.with_name("new").rename(path), "replaced it"),
        (lambda path: path.unlink(), "No such file"),
    ],
    ids=["emptied", "cut", "replaced", "removed"],
)
def test_change_from_outside_ends_the_run(launcher, folder, ranks, change, says):
    run = start(launcher, folder, ranks)
    conftest.wait_for(run, 4)
    # again, as a byte that is cut while a step is written may be one of that step, which is then written
    for _ in range(20):
        if run.poll() is None:
            with contextlib.suppress(FileNotFoundError):
                change(folder / "out" / "out.h5")
            time.sleep(0.05)
    code, _, complaint = ended(run)
    assert code == 3 and len(complaint) == 1 and "out/out.h5" in complaint[0] and says in complaint[0]


@pytest.mark.parametrize("ranks", [1, 2])
@pytest.mark.parametrize("name", ["state.h5", "state.h5.1", "state.h5.tmp"])
def test_file_put_in_the_place_of_a_checkpoint_is_kept(launcher, folder, ranks, name):
    """As is the file that a link there points to."""
    out = folder / "out"
    (folder / "mine").write_text("the only copy")
    run = start(launcher, folder, ranks, dict(checkpoint="out/state.h5"))
    conftest.wait_for(run, 4)
    if name.endswith(".tmp"):
        (out / "new").symlink_to(folder / "mine")
    else:
        shutil.copy(folder / "mine", out / "new")
    (out / "new").rename(out / name)
    for process in conftest.processes(run, ranks):
        os.kill(process, signal.SIGUSR2)  # write a checkpoint
    code, _, complaint = ended(run)
    assert code == 3 and len(complaint) == 1 and "out/state.h5" in complaint[0]
    assert (out / name).read_text() == (folder / "mine").read_text() == "the only copy"


@pytest.mark.parametrize("ranks", [1, 2])
def test_second_run_is_kept_from_the_files(launcher, folder, ranks):
    """From results and checkpoints, also one that would go on from there; not after the first has been killed."""
    mine = dict(checkpoint="out/state.h5", checkpoint_every=1)
    first = start(launcher, folder, 1, mine)
    conftest.wait_for(first, 4)
    running = conftest.processes(first, 1)
    for process in running:
        os.kill(process, signal.SIGSTOP)  # it goes on replacing its own, also while one is copied
    shutil.copy(folder / "out" / "state.h5", folder / "out" / "kept.h5")
    for process in running:
        os.kill(process, signal.SIGCONT)
    for other in (
        dict(grid_n=12),
        dict(output="out/other.h5", **mine),
        dict(output=None, **mine),
        dict(restart="out/kept.h5"),
    ):
        code, steps, complaint = ended(start(launcher, folder, ranks, other))
        assert code == 3 and steps == 0
        assert len(complaint) == 1 and "another run is writing it" in complaint[0], complaint
    conftest.wait_for(first, 8)
    first.kill()
    assert_intact(folder / "out" / "out.h5", 8)
    assert not [path.name for path in (folder / "out").iterdir() if path.name.endswith(".lock")]
    third = start(launcher, folder, ranks, dict(mine, overwrite=True))
    conftest.wait_for(third, 2)
    conftest.kill_all(third, ranks)
    third.communicate(timeout=60)


# ---- killed


@pytest.mark.parametrize("ranks", [1, 2])
@pytest.mark.parametrize("step", [1, 5, pytest.param(20, marks=pytest.mark.slow)])
def test_killed_run_leaves_what_it_has_told(launcher, folder, ranks, step):
    """At once after a step is told: its results are in the file, not on their way."""
    run = start(launcher, folder, ranks)
    conftest.wait_for(run, step)
    conftest.kill_all(run, ranks)
    _, more, _ = ended(run)
    assert_intact(folder / "out" / "out.h5", step + more)


def test_file_can_be_read_at_any_time(launcher, folder):
    """By another program, while the run goes on: a copy made between two steps that are told holds the first."""
    run = start(launcher, folder, 1)
    conftest.wait_for(run, 3)
    os.kill(run.pid, signal.SIGSTOP)
    try:
        shutil.copy(folder / "out" / "out.h5", folder / "copy.h5")
    finally:
        os.kill(run.pid, signal.SIGCONT)
        run.kill()
        run.communicate()
    assert_intact(folder / "copy.h5", 3)


# ---- killed at every write of a step


@pytest.fixture(scope="module")
def deadly(tmp_path_factory):
    """A library that kills the program before a change of its files that is counted."""
    return kills.make_deadly(tmp_path_factory.mktemp("deadly")) or pytest.skip("no C compiler")


def die(deadly, folder, options=None, **variables):
    """Steps told before the end, and how the run ended. Each run begins alike: changes of files are counted."""
    for old in (folder / "out").iterdir():
        old.unlink()
    command = [str(conftest.PROGRAM), *flatten([CASE, dict(grid_n=24), options or {}])]
    run = subprocess.run(
        command,
        cwd=folder,
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=60,
        env={**conftest.environment(), "LD_PRELOAD": str(deadly), **variables},
    )
    return told(run.stdout), run.returncode


@pytest.mark.parametrize("rows, saved, room", [(2, 1, 64), (70, 1, 70), (70, 40, 64), (40, 1, 80), (1500, 1, 1024)])
def test_indices_have_room_for_all_steps(folder, petsam, rows, saved, room):
    """HDF5 need not divide them: one of several ranks that ends while they are divided would harm the steps before."""
    kills.write_history(folder, rows)
    chunk = dict(output_chunk="8,12") if room == 80 else {}
    petsam(dict(CASE, load_n=None, grid_n=12, output_every=saved, errors="none", output_flush=1), chunk)
    head = (folder / "out" / "out.h5").read_bytes()[:26]  # the superblock, of version 0 or 1
    assert 2 * (int.from_bytes(head[24:], "little") if head[8] else 32) == room
    with h5py.File(folder / "out" / "out.h5") as f:
        assert len(f["pressure"]) == (rows if saved == 1 else 2)


@pytest.mark.slow
def test_no_write_of_a_step_harms_the_steps_before(deadly, folder):
    """Of the step that would divide HDF5's usual indices, which have room for 64 chunks, and of a common one.

    HDF5 writes some hundred pieces a step; a run that is killed before any of them leaves the steps that were told.
    """
    (folder / "history.csv").write_text("\n".join((folder / "history.csv").read_text().splitlines()[:69]) + "\n")
    each = dict(output_flush=0)  # steps of a millisecond would be written together
    die(deadly, folder, each, DIE_LOG="log")
    # the superblock is the last that HDF5 writes of a step
    ends = [k for k, line in enumerate((folder / "log").read_text().split(), 1) if line == "0"][-68:]
    for step, stride in ((66, 4), (31, 9)):
        for n in range(ends[step - 2] + 1, ends[step - 1] + 3, stride):
            steps, code = die(deadly, folder, each, DIE_AT=str(n))
            assert code == -signal.SIGKILL and steps >= step - 2
            with h5py.File(folder / "out" / "out.h5") as f:  # all that is there can be read
                for name in (*FIELDS, "time", *(f"history/{column}" for column in f["history"])):
                    assert len(f[name][:]) >= steps, (n, name)
            assert_intact(folder / "out" / "out.h5", steps)


def test_no_write_of_the_first_step_by_one_of_two_ranks_harms_the_file(deadly, launcher, folder):
    """Each rank writes a part of HDF5's metadata; without that of one rank the file has no step, and can be read."""
    log = folder / "log"
    variables = dict(LD_PRELOAD=str(deadly), DIE_RANK="1")
    (folder / "history.csv").write_text("time, load_tx\n1, 10\n")
    once = [CASE, dict(grid_n=24, errors="none")]
    conftest.start(launcher, folder, once, 2, extra={**variables, "DIE_LOG": str(log)}).communicate()
    writes, tried = len(log.read_text().split()), 0
    for n in range(writes // 2, writes - 8, max(1, writes // 20)):
        (folder / "out" / "out.h5").unlink(missing_ok=True)
        conftest.start(launcher, folder, once, 2, extra={**variables, "DIE_AT": str(n)}).communicate()
        if (folder / "out" / "out.h5").exists():
            tried += 1
            with h5py.File(folder / "out" / "out.h5") as f:  # all that is there can be read
                assert all(len(f[name][:]) <= 1 for name in (*FIELDS, "time")), n
                assert all(len(column[:]) <= 1 for column in f["history"].values()), n
    assert tried > 3


def test_no_write_of_many_steps_harms_the_steps_before(deadly, folder):
    """Steps that take a millisecond are written together; only those in the file have been told."""
    (folder / "history.csv").write_text("\n".join((folder / "history.csv").read_text().splitlines()[:300]) + "\n")
    options, most = dict(grid_n=10), 0
    die(deadly, folder, options, DIE_LOG="log")
    writes = len((folder / "log").read_text().split())
    for n in range(writes // 4, writes, max(1, writes // 20)):
        steps, code = die(deadly, folder, options, DIE_AT=str(n))
        if code == 0 or not steps:
            continue
        most = max(most, steps)
        assert_intact(folder / "out" / "out.h5", steps)
    assert most >= 2


@pytest.mark.parametrize("more", [dict(output_fields="none"), dict(output_every=1000), dict(output_every=5)],
                         ids=["none", "later", "some"])  # fmt: skip
@pytest.mark.parametrize("flush", [0, 0.01])
def test_no_write_of_a_step_without_fields_harms_the_steps_before(deadly, folder, more, flush):
    """Its space is reserved and, where its numbers fit into the chunks that are there, cut off again; steps that wait
    are not told."""
    (folder / "history.csv").write_text("\n".join((folder / "history.csv").read_text().splitlines()[:13]) + "\n")
    options = dict(more, output_flush=flush)
    die(deadly, folder, options, DIE_LOG="log")
    writes = len((folder / "log").read_text().split())
    tried = 0
    for n in range(writes // 3, writes, max(1, writes // 60)):  # where steps are slow, few follow a step that was told
        steps, code = die(deadly, folder, options, DIE_AT=str(n))
        if code == 0 or not steps:
            continue
        tried += 1
        with h5py.File(folder / "out" / "out.h5") as f:
            assert f["history/time"][:steps].tolist() == [k + 1.0 for k in range(steps)]
            assert all(len(column[:]) >= steps for column in f["history"].values())
    assert tried > 10


@pytest.mark.parametrize(
    "more",
    [dict(errors="companion"), pytest.param(dict(errors="none", gradient="energy,swt@50um"), marks=pytest.mark.slow)],
)
def test_no_write_of_the_tables_at_the_end_harms_the_steps(deadly, folder, more):
    """Their names are in the file before its first step, as HDF5 changes an index of names in place, piece by piece."""
    (folder / "history.csv").write_text("\n".join((folder / "history.csv").read_text().splitlines()[:13]) + "\n")
    options = dict(more, grid_n=10, output_flush=0)  # with a warning of so few cells
    die(deadly, folder, options, DIE_LOG="log")
    lines = (folder / "log").read_text().split()
    ends = [k for k, line in enumerate(lines, 1) if line == "0"]  # the superblock is the last of each flush
    with h5py.File(folder / "out" / "out.h5") as f:
        assert len(f["errors/name"]) and len(f["warnings"]) if "errors" in f else len(f["gradient"]) == 2
        named = sorted(f)
    for n in range(ends[-4] + 1, len(lines) + 1, 3):  # after the last step: two tables, and the mark of the end
        _, code = die(deadly, folder, options, DIE_AT=str(n))
        assert code == -signal.SIGKILL
        with h5py.File(folder / "out" / "out.h5") as f:
            assert sorted(f) == named, n
            assert all(len(f[name][:]) >= 12 for name in (*FIELDS, "time")), n
            assert all(len(column[:]) >= 12 for column in f["history"].values()), n
        with Results(folder / "out" / "out.h5") as results:
            assert len(results.steps) >= 12 and set(results.gradients) <= {"energy", "swt@50um"}, n

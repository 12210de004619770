"""Checkpoints: what goes on from one is what would have come without it; a wrong or damaged one is refused."""

import contextlib
import os
import re
import shutil
import signal
import time
from pathlib import Path

import h5py
import numpy as np
import pytest

import conftest
import petsam as library
from kinds.kills import CASE, YIELDING, AtWrites, complete_steps, differences, torture, write_history
from support import Results, assert_same, ball, few

STEPS = 24
KEPT = dict(checkpoint="state.h5", checkpoint_every=7)
ON = dict(restart="state.h5")


@pytest.fixture
def folder(tmp_path):
    write_history(tmp_path, STEPS)
    return tmp_path


@pytest.fixture(scope="session")
def solved(launcher, tmp_path_factory):
    """The folder of a run with checkpoints after steps 14 and 21."""
    folder = tmp_path_factory.mktemp("stopped")
    write_history(folder, STEPS)
    conftest.execute(launcher, folder, [CASE, KEPT], 1, 0)
    return folder


@pytest.fixture
def stopped(solved, tmp_path):
    """Another folder with the files of such a run."""
    return shutil.copytree(solved, tmp_path, dirs_exist_ok=True)


def progress(path):
    """Load steps before a checkpoint."""
    with h5py.File(path, "r") as f:
        return int(f.attrs["progress"][0])


def steps(path):
    """Load steps of a run."""
    with library.open(path) as run:
        return run.before + run.history["time"].size


def is_closed(path):
    with h5py.File(path, "r") as f:
        return bool(f.attrs["closed"])


# ---------------------------------------------------------------- going on

# materials for which p and q act on one another; N that stays, so that its solution is used again; a contact that moves
# over the grid and takes the tangential solver's window with it
DISSIMILAR = dict(CASE, grid_size=6e-3, body2_young=9e9, body2_poisson=0.4, friction=0.3)
CONSTANT = dict(CASE, load_n=1000.0), "time, load_tx", lambda k: (60 * np.sin(k / 5),)
HELD = dict(CASE, friction=0, load_n=1000.0), "time, disp_x", lambda k: (1e-8 * k,)
ROLLING = (
    dict(CASE, grid_n=64, grid_size=4e-3, load_n=300.0),
    "time, load_my, load_tx",
    lambda k: (0.05 * np.sin(k / 4), 10 * np.cos(k / 5)),
)
# a cycle whose steps start from those of the cycle before, which are kept with their pressures
CYCLE = (
    dict(CASE, load_mx=1e-3),
    "time, load_n, load_tx, load_ty",
    lambda k: (1000 + 200 * np.sin(k * np.pi / 3), 60 * np.cos(k * np.pi / 3), 30 * np.sin(k * np.pi / 3)),
)


def write(folder, header, values):
    (folder / "history.csv").write_text(
        header + "\n" + "".join(f"{k + 1}, {', '.join(repr(float(v)) for v in values(k))}\n" for k in range(STEPS))
    )


@pytest.mark.parametrize(
    "case, ranks",
    [((CASE,), 1), ((DISSIMILAR,), 2), (CONSTANT, 1), (ROLLING, 3), (HELD, 1), (CYCLE, 1)],
    ids=["similar", "dissimilar", "constant", "rolling", "held", "cycle"],
)
def test_run_goes_on_as_if_it_had_not_been_stopped(folder, petsam, case, ranks):
    """To the last bit, which asks for all of the state: what is lost of it shows at the solvers' tolerance."""
    if len(case) > 1:
        write(folder, *case[1:])
    petsam(case[0], KEPT, ranks=ranks)
    shutil.copy(folder / "out.h5", folder / "whole.h5")
    for checkpoint, solved in (("state.h5.1", 14), ("state.h5", 21)):
        assert progress(folder / checkpoint) == solved
        petsam(case[0], dict(restart=checkpoint), ranks=ranks)
        assert not differences(folder / "out.h5", folder / "whole.h5")


@few("before, after", [(3, 1), (1, 2), (2, 3), (1, 5)], 2)
def test_run_goes_on_with_other_ranks(folder, petsam, before, after):
    """To the last bit, since what the solvers sum does not depend on which rank has which rows."""
    petsam(CASE, KEPT, ranks=before)
    whole = Results(shutil.copy(folder / "out.h5", folder / "whole.h5"))
    petsam(CASE, dict(restart="state.h5.1"), ranks=after)
    assert steps(folder / "out.h5") == STEPS
    assert_same(Results(folder / "out.h5"), whole, 0)


def test_kept_steps_of_a_cycle_are_read_on_other_ranks(folder, petsam):
    """In batches, each rank its rows; with less memory they are left out, with another number of steps solved anew."""
    write(folder, *CYCLE[1:])
    petsam(CYCLE[0], KEPT, dict(cycle_memory=5e7), ranks=3)
    whole = Results(shutil.copy(folder / "out.h5", folder / "whole.h5"))
    with h5py.File(folder / "state.h5.1") as f:
        steps, rows = f["kept_ranges"].shape[:2]
        cells = np.diff(f["kept_ranges"]).sum()
        assert rows == f["pressure"].shape[1] and 6 <= steps <= 13  # two cycles; the first step has none before it
        assert f["kept_changes"].size == 6 * cells  # as the loads turn
        assert 0 < f["kept_pressures"].size <= cells
    for memory in (5e7, 0):
        petsam(CYCLE[0], dict(restart="state.h5.1", cycle_memory=memory), ranks=2)
        # without kept steps the direction of slip is known less accurately, which is much in steps as long as these
        assert_same(Results(folder / "out.h5"), whole, 0 if memory else 0.05)
        with library.open(folder / "out.h5") as run:
            assert (run.history["normal_applies"][14:17] == 0).all() == (memory > 0)


def test_longer_history_goes_on(folder, petsam):
    petsam(CASE, dict(output="whole.h5"))
    rows = (folder / "history.csv").read_text()
    (folder / "history.csv").write_text("\n".join(rows.splitlines()[:11]) + "\n")
    petsam(CASE, KEPT, dict(checkpoint_every=10))
    (folder / "history.csv").write_text(rows)
    petsam(CASE, ON)
    assert not differences(folder / "out.h5", folder / "whole.h5")


def test_run_that_was_at_its_end_stays_as_it_is(folder, petsam):
    petsam(CASE, KEPT, dict(checkpoint_every=STEPS))
    shutil.copy(folder / "out.h5", folder / "whole.h5")
    petsam(CASE, ON)
    assert not differences(folder / "out.h5", folder / "whole.h5")


def test_run_goes_on_without_results(stopped, petsam):
    done = petsam(CASE, dict(output=None), ON)
    assert re.search(r"restart +after step 21, from state.h5", done.stdout) and re.search(
        r"^ *22 +22 ", done.stdout, re.M
    )


def test_run_that_ended_at_the_edge_goes_on_if_that_is_allowed(folder, petsam):
    """From the checkpoint before that step, which is solved once more."""
    (folder / "history.csv").write_text("time, load_n\n1, 1000\n2, 1e4\n3, 900\n")
    case = dict(CASE, grid_size=3e-3)
    petsam(case, KEPT, dict(checkpoint_every=1), check=12)
    assert steps(folder / "out.h5") == 2
    done = petsam(case, ON, "-allow_edge_contact")
    assert len(done.complaint) == 1 and "warning: step 2" in done.complaint[0]
    with library.open(folder / "out.h5") as run:
        assert run.history["status"].tolist() == [0, 0, 0]


# ---------------------------------------------------------------- the results


@pytest.mark.parametrize("ranks", [1, 2])
@pytest.mark.parametrize("every", [1, 5])
def test_steps_after_the_checkpoint_are_solved_once_more(folder, petsam, ranks, every):
    """The file held all steps: those after the checkpoint must not be there twice, nor those before it be lost."""
    case = dict(CASE, output_every=every)
    petsam(case, KEPT, ranks=ranks)
    before = (folder / "out.h5").read_bytes()
    shutil.copy(folder / "out.h5", folder / "whole.h5")
    petsam(case, dict(restart="state.h5.1"), ranks=ranks)
    assert not differences(folder / "out.h5", folder / "whole.h5")
    assert (folder / "out.h5").read_bytes() == before and not list(folder.glob("*.tmp"))


def test_parts_follow_one_another_and_those_of_an_older_checkpoint_go(folder, petsam):
    """Each restart begins the next part; one from an earlier checkpoint replaces the parts that followed it."""
    petsam(CASE, KEPT)
    shutil.copy(folder / "out.h5", folder / "whole.h5")
    shutil.copy(folder / "state.h5.1", folder / "early.h5")
    names = ["out.part2.h5", "out.part3.h5"]
    petsam(CASE, dict(restart="early.h5", checkpoint="next.h5", checkpoint_every=3))
    done = petsam(CASE, dict(restart="next.h5.1"))
    assert sorted(path.name for path in folder.glob("out.part*")) == names and "results in out.part3.h5" in done.stdout
    with library.open(folder / "out.h5") as run:
        assert [len(part.steps) for part in run._sources[1:]] == [10, 3] and run._complete == STEPS
    assert not differences(folder / "out.h5", folder / "whole.h5")
    done = petsam(CASE, dict(restart="early.h5"))
    assert "results in out.part2.h5, replacing those there" in done.stdout
    with library.open(folder / "out.h5") as run:  # out.part3.h5 follows a file that is no more
        assert len(run._sources) == 2
    assert not differences(folder / "out.h5", folder / "whole.h5")


def test_new_run_has_nothing_of_the_parts_of_an_old_one(stopped, petsam):
    petsam(CASE, ON)
    petsam(CASE, dict(steps=2))
    with library.open(stopped / "out.h5") as run:
        assert len(run._sources) == 1 and run._complete > STEPS


def test_part_that_does_not_fit_is_named(stopped, petsam):
    """One that begins after steps that are lost, one that is damaged, a text."""
    petsam(CASE, ON)
    part = stopped / "out.part2.h5"
    with h5py.File(part, "a") as f:
        f.attrs["branch_step"] = 25.0
    words = dict(input="out.h5", output="stress.h5", depths="0", steps="all")
    for _ in range(2):
        with pytest.raises(library.Error, match=r"out\.part2\.h5"):
            library.open(stopped / "out.h5").close()
        program = conftest.PROGRAM.with_name("petsam-stress")
        done = conftest.execute(conftest.launcher_words(), stopped, [words], 1, 3, program=program)
        assert "-input out.part2.h5" in done.stderr
        part.write_text("no")


@pytest.mark.parametrize(
    "spoil, code, word",
    [
        (lambda f: f.unlink(), 3, "No such file"),
        (lambda f: f.write_text("no"), 3, "petsam has not written"),
        (lambda f: shutil.copy(f.with_name("other.h5"), f), 2, "belongs to other results"),
    ],
    ids=["missing", "text", "other"],
)
def test_results_of_another_run_are_left_alone(stopped, petsam, spoil, code, word):
    petsam(CASE, dict(output="other.h5"))
    results = stopped / "out.h5"
    spoil(results)
    before = results.read_bytes() if results.exists() else None
    done = petsam(CASE, ON, check=code)
    assert len(done.complaint) <= 2 and "-output out.h5" in done.complaint[0] and word in done.complaint[0]
    assert (results.read_bytes() if results.exists() else None) == before


# ---------------------------------------------------------------- when


def test_without_every_nothing_is_written(folder, petsam):
    petsam(CASE, dict(checkpoint="state.h5"))
    assert not list(folder.glob("state.h5*"))


def test_last_two_are_kept(stopped):
    assert sorted(path.name for path in stopped.glob("state.h5*")) == ["state.h5", "state.h5.1"]
    assert progress(stopped / "state.h5") == 21 and progress(stopped / "state.h5.1") == 14


def send(run, ranks, number, rank=-1):
    """A signal to one rank alone."""
    os.kill(conftest.processes(run, ranks)[rank], number)


@pytest.mark.parametrize("ranks", [1, 2, 3])
def test_USR2_writes_a_checkpoint_and_the_run_goes_on(launcher, folder, petsam, ranks):
    run = conftest.start(launcher, folder, [CASE, dict(checkpoint="state.h5", output="whole.h5")], ranks)
    conftest.wait_for(run, 2)
    send(run, ranks, signal.SIGUSR2)
    out, err = run.communicate(timeout=60)
    assert run.returncode == 0 and steps(folder / "whole.h5") == STEPS, err
    last = progress(folder / "state.h5")
    assert 2 <= last < STEPS and f"checkpoint after step {last}" in out
    assert not (folder / "state.h5.1").exists()
    shutil.copy(folder / "whole.h5", folder / "out.h5")
    petsam(CASE, ON, ranks=ranks)
    assert not differences(folder / "out.h5", folder / "whole.h5")


def stop_by_signal(launcher, folder, ranks):
    run = conftest.start(launcher, folder, [CASE, dict(checkpoint="state.h5")], ranks)
    conftest.wait_for(run, 2)
    if ranks == 2:
        run.send_signal(signal.SIGUSR1)  # to the launcher, which passes it on
    else:
        send(run, ranks, signal.SIGUSR1)
    _, err = run.communicate(timeout=60)
    assert run.returncode == 75, err
    return err


@pytest.mark.parametrize("ranks", [1, 2, 3])
def test_USR1_writes_a_checkpoint_and_stops(launcher, folder, petsam, ranks):
    err = stop_by_signal(launcher, folder, ranks)
    last = progress(folder / "state.h5")
    assert 2 <= last < STEPS and steps(folder / "out.h5") == last and is_closed(folder / "out.h5")
    assert f"stopped after step {last} of {STEPS}" in err and "-restart state.h5" in err
    petsam(CASE, ON, ranks=ranks)
    petsam(CASE, dict(output="whole.h5"), ranks=ranks)
    assert not differences(folder / "out.h5", folder / "whole.h5")


@pytest.mark.parametrize("ranks", [1, 2])
def test_TERM_stops_like_USR1(launcher, folder, petsam, ranks):
    """On any rank. Sent to mpirun, it ends that as well."""
    run = conftest.start(launcher, folder, [CASE, dict(checkpoint="state.h5")], ranks)
    conftest.wait_for(run, 2)
    send(run, ranks, signal.SIGTERM)
    _, err = run.communicate(timeout=60)
    last = progress(folder / "state.h5")
    assert run.returncode == 75 and f"stopped after step {last} of {STEPS}" in err, err
    petsam(CASE, ON, ranks=ranks)
    assert steps(folder / "out.h5") == STEPS


def wait_for_handlers(run, ranks):
    """Waits until all ranks catch the signals; returns the libraries that the last one has loaded."""
    wanted = sum(1 << (number - 1) for number in (signal.SIGUSR1, signal.SIGUSR2, signal.SIGTERM))
    end = time.time() + 20
    while time.time() < end and run.poll() is None:
        with contextlib.suppress(FileNotFoundError):
            own = [Path(f"/proc/{one}") for one in conftest.processes(run, ranks)]
            names = [(one / "comm").read_text().strip() for one in own]
            masks = [int(re.search(r"SigCgt:\s*(\w+)", (one / "status").read_text())[1], 16) for one in own]
            if names == ["petsam"] * ranks and all(mask & wanted == wanted for mask in masks):
                return (own[-1] / "maps").read_text()
    raise AssertionError("no handlers")


@pytest.mark.parametrize("number, code", [("USR1", 75), ("TERM", 75), ("USR2", 0)])
@few("ranks, delay", [(1, 0), (1, 0.05), (1, 0.1), (1, 0.15), (2, 0.1), (2, 0)])
def test_a_signal_before_the_options_are_read_counts(launcher, folder, ranks, delay, number, code):
    write_history(folder, 200)
    run = conftest.start(launcher, folder, [CASE, dict(checkpoint="state.h5")], ranks)
    wait_for_handlers(run, ranks)
    time.sleep(delay)
    send(run, ranks, getattr(signal, "SIG" + number))
    _, err = run.communicate(timeout=60)
    assert run.returncode == code and (folder / "state.h5").exists(), err


def test_signals_are_caught_before_mpi_starts(launcher, folder):
    """What a run has loaded when it catches them; of several runs, as this process may look late."""
    for _ in range(20):
        run = conftest.start(launcher, folder, [CASE], 1)
        libraries = wait_for_handlers(run, 1)
        run.communicate(timeout=60)
        if "/mca_" not in libraries:  # parts of MPI
            return
    raise AssertionError("MPI has started each time")


@pytest.mark.parametrize("delay", [0, 0.01, 0.05])
def test_TERM_before_the_options_are_read_ends_a_run_without_checkpoints(launcher, folder, delay):
    write_history(folder, 1000)
    run = conftest.start(launcher, folder, [CASE], 1)
    wait_for_handlers(run, 1)
    time.sleep(delay)
    send(run, 1, signal.SIGTERM)
    run.communicate(timeout=60)
    assert run.returncode == -signal.SIGTERM


def test_TERM_ends_a_run_without_checkpoints(launcher, folder):
    run = conftest.start(launcher, folder, [CASE], 1)
    conftest.wait_for(run, 2)
    send(run, 1, signal.SIGTERM)
    run.communicate(timeout=60)
    assert run.returncode == -signal.SIGTERM


def test_forgotten_restart_does_not_replace_the_checkpoint(stopped, petsam):
    """By the command of the stopped run; neither its checkpoint nor its results change."""
    before = [(stopped / name).read_bytes() for name in ("state.h5", "out.h5")]
    done = petsam(CASE, dict(checkpoint="state.h5"), check=2)
    assert "-checkpoint state.h5" in done.complaint[0] and "-restart state.h5" in done.complaint[0]
    assert "-overwrite" in done.complaint[0]
    assert before == [(stopped / name).read_bytes() for name in ("state.h5", "out.h5")]
    petsam(CASE, dict(checkpoint="state.h5", checkpoint_every=20, overwrite=True))
    assert progress(stopped / "state.h5") == STEPS // 20 * 20


def test_signal_without_a_checkpoint_is_a_warning(launcher, folder):
    run = conftest.start(launcher, folder, [CASE], 1)
    conftest.wait_for(run, 2)
    send(run, 1, signal.SIGUSR1)
    _, err = run.communicate(timeout=60)
    assert run.returncode == 0 and "warning" in err and "-checkpoint" in err and steps(folder / "out.h5") == STEPS


@pytest.mark.parametrize("limit, seconds, ranks", [("0.6", 0.6, 1), ("0:01", 1, 2), ("0:0:1", 1, 1)])
def test_run_stops_before_its_time_is_up(folder, petsam, limit, seconds, ranks):
    """Many steps in few seconds, over as many runs as it takes; each ends by itself and gets on."""
    write_history(folder, 20000)
    case = [dict(CASE, grid_n=96, output_every=20000), dict(checkpoint="state.h5", max_walltime=limit)]
    done = petsam(*case, ranks=ranks, check=75)
    assert float(re.search(r"used +([0-9.]+) s", done.stdout).group(1)) < seconds + 1  # the launcher's time is on top
    first = progress(folder / "state.h5")
    assert first >= 1 and "before -max_walltime" in done.stderr and steps(folder / "out.h5") == first
    petsam(*case, ON, ranks=ranks, check=75)
    assert progress(folder / "state.h5") > first and progress(folder / "state.h5.1") == first
    assert steps(folder / "out.h5") == progress(folder / "state.h5")


def test_step_longer_than_the_limit_still_gets_on(folder, petsam):
    """A run solves at least one step, so that it does not go round in circles."""
    petsam(CASE, dict(checkpoint="state.h5", max_walltime=1e-3), check=75)
    petsam(CASE, dict(checkpoint="state.h5", max_walltime=1e-3), ON, check=75)
    assert progress(folder / "state.h5") == 2


def test_last_step_is_the_end_not_a_stop(folder, petsam):
    (folder / "history.csv").write_text("time, load_n\n1, 1000\n")
    petsam(CASE, dict(checkpoint="state.h5", max_walltime=1e-3))


def test_results_may_not_replace_the_checkpoint(stopped, petsam):
    assert "-restart" in petsam(CASE, ON, dict(output="state.h5"), check=2).complaint[0]
    assert progress(stopped / "state.h5") == 21


@pytest.mark.parametrize("ranks", [1, 2])
def test_lost_folder_ends_the_run(launcher, folder, ranks):
    write_history(folder, 2000)
    (folder / "away").mkdir()
    run = conftest.start(launcher, folder, [CASE, dict(checkpoint="away/state.h5", checkpoint_every=1)], ranks)
    conftest.wait_for(run, 5)
    (folder / "away").rename(folder / "gone")
    _, err = run.communicate(timeout=60)
    assert run.returncode == 3 and "-checkpoint away/state.h5" in err
    assert complete_steps(folder / "out.h5") >= 5


@pytest.fixture
def small_disk(folder):
    """away/ on a disk that holds one checkpoint of 128 x 128 cells and not two."""
    (folder / "away").mkdir()
    with conftest.small_disk_on(folder / "away", "3m"):
        yield folder


@pytest.mark.parametrize("ranks", [1, 2])
def test_full_disk_ends_the_run_and_leaves_the_checkpoint_before(small_disk, petsam, ranks):
    case = dict(CASE, grid_n=128, cycle_memory=0)
    done = petsam(case, dict(checkpoint="away/state.h5", checkpoint_every=2), ranks=ranks, check=3)
    assert (
        len(done.complaint) == 1
        and "-checkpoint away/state.h5" in done.complaint[0]
        and "No space left" in done.complaint[0]
    )
    assert [path.name for path in (small_disk / "away").iterdir()] == ["state.h5"]
    assert complete_steps(small_disk / "out.h5") == 4
    petsam(case, dict(restart="away/state.h5"), ranks=ranks)
    assert complete_steps(small_disk / "out.h5") == STEPS


# ---------------------------------------------------------------- another run's

OTHERS = dict(
    friction=0.2,
    grid_n=33,
    grid_size=2.7e-3,
    grid_center=1e-5,
    body1_young=200e9,
    body2_poisson=0.29,
    gap_radius1=0.21,
    coupling="none",
    steps=2,
)


@pytest.mark.parametrize("name", OTHERS)
def test_checkpoint_of_other_physics_is_refused_by_name(stopped, petsam, name):
    before = (stopped / "out.h5").read_bytes()
    done = petsam(CASE, ON, {name: OTHERS[name]}, check=2)
    assert "-restart state.h5" in done.complaint[0] and f"-{name} is" in done.complaint[0]
    assert (stopped / "out.h5").read_bytes() == before


def test_checkpoint_of_another_gap_is_refused_by_name(stopped, petsam):
    case = dict(CASE, gap_type="ellipsoid", gap_radius1=None, gap_radius2=None, gap_radius_x=0.1, gap_radius_y=0.1)
    assert "-gap_type is sphere there, not ellipsoid" in petsam(case, ON, check=2).complaint[0]


def test_gap_file_that_has_changed_is_refused(folder, petsam):
    rough = 1e-9 * np.random.default_rng(1).standard_normal((32, 32))
    with h5py.File(folder / "rough.h5", "w") as f:
        f["height"] = rough
    case = dict(CASE, gap_rough_file="rough.h5")
    petsam(case, KEPT)
    petsam(case, ON, ranks=2)
    with h5py.File(folder / "rough.h5", "a") as f:
        f["height"][3, 4] += 1e-12
    assert "-gap_rough_file is" in petsam(case, ON, check=2).complaint[0]
    assert "-gap_rough_file is" in petsam(CASE, ON, check=2).complaint[0]


@pytest.mark.parametrize(
    "change, word",
    [
        (lambda rows: re.sub(r"^5, \S+,", "5, 1000,", rows, flags=re.M), "-load_n"),
        (lambda rows: re.sub(r"^(5, \S+), .*", r"\1, 1", rows, flags=re.M), "-load_tx"),
        (lambda rows: rows.replace("load_tx", "disp_x"), "-disp_x"),
        (lambda rows: re.sub(r"^5,", "5.5,", rows, flags=re.M), "times"),
        (lambda rows: "\n".join(rows.splitlines()[:11]) + "\n", "-history"),
    ],
    ids=["load_n", "load_tx", "control", "times", "short"],
)
def test_checkpoint_of_another_history_is_refused_by_name(stopped, petsam, change, word):
    history = stopped / "history.csv"
    history.write_text(change(history.read_text()))
    done = petsam(CASE, ON, check=2)
    assert "-restart state.h5" in done.complaint[0] and word in done.complaint[0]


def mixed(x):
    """The finalizer of MurmurHash3."""
    x = (x ^ x >> 33) * 0xFF51AFD7ED558CCD % 2**64
    x = (x ^ x >> 33) * 0xC4CEB9FE1A85EC53 % 2**64
    return x ^ x >> 33


def sealed(path, version=8):
    """The seal that a file should have, as the manual describes it: hashed by blocks, whose hashes are added."""
    data, block, total = path.read_bytes(), 1 << 20, 0
    for place, first in enumerate(range(512, len(data), block)):
        part = data[first : first + block]
        value = mixed(place + 1)
        for k in range(0, len(part), 8):
            value = mixed((value + int.from_bytes(part[k : k + 8], "little")) % 2**64)
        total += mixed((value + len(part)) % 2**64)
    text = f"petsam checkpoint {version}\nbytes {len(data)}\nchecksum {total % 2**64:016x}\n"
    return text.encode().ljust(512, b"\0")


def test_seal_is_a_checksum_over_the_whole_file(stopped):
    for name in ("state.h5", "state.h5.1"):
        path = stopped / name
        assert path.read_bytes()[:512] == sealed(path)


def test_checkpoint_of_another_version_is_refused(stopped, petsam):
    path = stopped / "state.h5"
    with h5py.File(path, "a") as f:
        f.attrs["petsam_version"] = "0.0.9"
    path.write_bytes(sealed(path) + path.read_bytes()[512:])
    done = petsam(CASE, ON, check=2)
    assert "petsam" in done.complaint[0] and "written by petsam 0.0.9" in done.complaint[0]
    path.write_bytes(sealed(path, 9) + path.read_bytes()[512:])
    done = petsam(CASE, ON, check=3)
    assert "written by another version of petsam" in done.complaint[0] and "state.h5.1" in done.complaint[0]


# ---------------------------------------------------------------- damage


def flip(path, where):
    data = bytearray(path.read_bytes())
    data[where] ^= 4
    path.write_bytes(data)


@pytest.mark.parametrize("ranks", [1, 2])
@pytest.mark.parametrize(
    "damage",
    [
        lambda f: f.unlink(),
        lambda f: f.write_text("no"),
        lambda f: os.truncate(f, f.stat().st_size // 2),
        lambda f: os.truncate(f, 0),
        lambda f: flip(f, f.stat().st_size // 2),
        lambda f: shutil.copy(f.with_name("out.h5"), f),
    ],
    ids=["missing", "text", "half", "empty", "one bit", "results"],
)
def test_damaged_checkpoint_is_an_error_that_names_the_one_before(stopped, petsam, damage, ranks):
    damage(stopped / "state.h5")
    done = petsam(CASE, ON, ranks=ranks, check=3)
    assert (
        len(done.complaint) == 1
        and "-restart state.h5:" in done.complaint[0]
        and "-restart state.h5.1" in done.complaint[0]
    )
    shutil.copy(stopped / "state.h5.1", stopped / "state.h5.0")
    flip(stopped / "state.h5.1", (stopped / "state.h5.1").stat().st_size // 2)
    assert "state.h5.1" not in petsam(CASE, ON, ranks=ranks, check=3).complaint[0]
    petsam(CASE, dict(restart="state.h5.0"), ranks=ranks)


def test_no_damaged_bit_is_taken_for_good(stopped, petsam):
    """Anywhere in the file: the run is refused, or goes on as if nothing had been, where the bit means nothing."""
    whole = (stopped / "state.h5").read_bytes()
    shutil.copy(stopped / "out.h5", stopped / "whole.h5")
    refused = 0
    for where in [*range(8, 4096, 262), *np.random.default_rng(2).integers(0, len(whole), 20)]:
        (stopped / "state.h5").write_bytes(whole)
        flip(stopped / "state.h5", where)
        done = petsam(CASE, ON, check=None)
        assert done.code in (0, 2, 3), (where, done)
        refused += done.code != 0
        if done.code == 0:
            assert not differences(stopped / "out.h5", stopped / "whole.h5"), where
    assert refused >= 20


# ---------------------------------------------------------------- killed


@pytest.mark.parametrize(
    "ranks, kills", [(1, 3), *(pytest.param(*more, marks=pytest.mark.slow) for more in ((1, 12), (2, 4)))]
)
def test_run_that_is_killed_again_and_again_gets_to_the_same_end(launcher, folder, ranks, kills):
    """More of them: tests/program/random_problems.py kills --kills 50"""
    assert torture(launcher, folder, kills, ranks, seed=ranks) >= 1


@pytest.mark.slow
def test_run_one_of_whose_ranks_is_killed_at_a_write_gets_to_the_same_end(launcher, folder):
    """More of them: tests/program/random_problems.py kills --writes --ranks 2 --kills 50"""
    assert torture(launcher, folder, 12, ranks=2, seed=2, killer=AtWrites) >= 1


@pytest.mark.parametrize("kind", YIELDING)
def test_yielding_run_that_is_killed_gets_to_the_same_end(launcher, folder, kind):
    """Histories and wear cycles, in plane strain too: all columns and fields to the last bit."""
    assert torture(launcher, folder, 3, 1, seed=1, kind=kind) >= 1


# ---------------------------------------------------------------- no equilibrium

BALL = dict(ball(32), output="out.h5")
SLIDES = "time, load_tx\n1, 10\n2, 20\n3, 30\n4, 25\n5, 90\n"  # the limit is 48.6 N


@pytest.mark.parametrize("ranks", [1, 2, 3])
@pytest.mark.parametrize("case", [BALL, dict(BALL, body2_young=9e9, grid_size=2.4e-3)], ids=["similar", "dissimilar"])
def test_fields_of_the_last_solution_are_in_the_file(folder, petsam, case, ranks):
    """When the run ends for want of equilibrium, at a step after fields that were not due."""
    (folder / "history.csv").write_text(SLIDES)
    case = dict(case, history="history.csv")
    petsam(case, dict(output="all.h5"), ranks=ranks, check=11)
    petsam(case, dict(output_every=3), ranks=ranks, check=11)
    with h5py.File(folder / "out.h5", "r") as f:
        assert list(f["time"]) == [3, 4] and list(f["history/time"]) == [1, 2, 3, 4, 5]
    some, every = Results(folder / "out.h5"), Results(folder / "all.h5")
    assert every.saved == 4
    # displacements are computed anew from the same tractions
    assert_same(some, every, 1e-14)
    for name in ("pressure", "shear_x", "shear_y", "slip_x", "slip_y"):
        assert np.array_equal(getattr(some, name), getattr(every, name)), name


def test_fields_of_the_last_solution_are_written_once(folder, petsam):
    """Also when the step that has none is the first after a restart, once or twice."""
    (folder / "history.csv").write_text(SLIDES)
    case = dict(BALL, history="history.csv", output_every=3)
    petsam(case, dict(checkpoint="state.h5", checkpoint_every=4), check=11)
    whole = Results(shutil.copy(folder / "out.h5", folder / "whole.h5"))
    for _ in range(2):
        petsam(case, ON, check=11)
        with library.open(folder / "out.h5") as run:
            assert run.times.tolist() == [3, 4] and run.history["time"].tolist() == [1, 2, 3, 4, 5]
        assert_same(Results(folder / "out.h5"), whole, 1e-14)


def test_first_step_without_equilibrium_has_no_fields(folder, petsam):
    petsam(BALL, dict(load_tx=90.0), check=11)
    with h5py.File(folder / "out.h5", "r") as f:
        assert len(f["time"]) == 0 and list(f["history/status"]) == [11]

"""petsam.run(): the program from Python, without a shell."""

import concurrent.futures
import errno
import gc
import os
import pickle
import re
import signal
import subprocess
import sys
import time
import warnings

import h5py
import numpy as np
import pytest

import petsam as package
from conftest import PROGRAM, environment
from petsam.apps.compliance import stiffness
from petsam.contact import running
from support import ROOT, ball, slide_limit

CASE = ball(n=32)
LIMIT = slide_limit(CASE)[0]


pytestmark = pytest.mark.filterwarnings("ignore::petsam.contact.AdviceWarning")


@pytest.fixture(autouse=True)
def program(monkeypatch, tmp_path):
    """The program that is tested, and a working directory of its own."""
    monkeypatch.setenv("PETSAM", str(PROGRAM))
    monkeypatch.chdir(tmp_path)


@pytest.mark.parametrize("ranks", [1, 2])
def test_results_are_those_of_the_program(solve, tmp_path, ranks):
    loads = [0.2 * LIMIT, 0.5 * LIMIT, -0.1 * LIMIT]
    (tmp_path / "h.csv").write_text("time,load_tx\n" + "".join(f"{k},{load!r}\n" for k, load in enumerate(loads, 1)))
    with h5py.File(solve(CASE, dict(history=tmp_path / "h.csv")).path) as f:
        expected, stick = f["pressure"][:], f["history/stick_area"][:]
    lines = []
    found = package.run(CASE, history=dict(load_tx=loads), ranks=ranks, report=lines.append)
    assert np.array_equal(found["pressure"], expected) and np.array_equal(found["stick_area"], stick)
    assert list(found.time) == [1, 2, 3] and any("results in" in line for line in lines)


def test_results_can_be_copied_to_another_process(tmp_path):
    found = package.run(CASE, load_tx=0.3 * LIMIT, steps=4, output="kept.h5")
    for one in (found, found.between(2, 3)):
        copy = pickle.loads(pickle.dumps(one))
        assert np.array_equal(copy.series("load_tx"), one.series("load_tx")) and copy.label == one.label
        assert np.array_equal(copy.field("pressure"), one.field("pressure"))
    found = package.run(CASE, load_tx=0.3 * LIMIT)
    with pytest.raises(package.Error, match="is a temporary file.*give petsam.run"):
        pickle.dumps(found)


@pytest.mark.parametrize("n", [(32, 32), (24, 40), (64, 1)])
def test_gap_and_friction_may_be_arrays(solve, n):
    nx, ny = n
    flat = dict(CASE, gap_type=None, gap_radius1=None, gap_radius2=None, grid_n=None, friction=None, load_n=2.0)
    if ny == 1:
        flat["elasticity"] = "plane"
    width = 4e-3 if ny == 1 else CASE["grid_size"]
    size = (width, width * ny / nx)
    x = (np.arange(nx) + 0.5 - nx / 2) * size[0] / nx
    y = np.zeros(1) if ny == 1 else (np.arange(ny) + 0.5 - ny / 2) * size[1] / ny
    gap = (x**2 + 2.0 * y[:, None] ** 2) / 0.2
    friction = 0.3 + 0.1 * np.sign(x) * np.ones((ny, 1))
    given = dict(gap=gap[0], friction=friction[0]) if ny == 1 else dict(gap=gap, friction=friction)
    rows = np.zeros(3, dtype=[("load_tx", float), ("load_ty", float)])
    rows["load_tx"] = [0.0, 0.1, 0.2]
    found = package.run({**flat, "grid_size": width if ny == 1 else size, "steps": 1}, history=rows, **given)
    assert np.allclose(found["load_tx"], rows["load_tx"], rtol=1e-12, atol=0.0)
    assert (found.x.size, found.y.size) == n and found["contact_area"][-1] > 0.0
    with package.Contact(
        **{
            **{k: v for k, v in flat.items() if v is not None and not k.startswith("load")},
            "grid_n": nx if ny == 1 else n,
            "grid_size": width if ny == 1 else size,
            "friction": 0.1,
            "gap_type": "flat",
        }
    ) as contact:
        contact.gap, contact.friction = gap, friction
        for load in rows["load_tx"]:
            contact.try_step(load_n=2.0, load_tx=load)
            contact.commit()
        assert np.allclose(contact["pressure"], found["pressure"][-1], rtol=1e-6, atol=1e-6 * found["pressure"].max())
        assert np.allclose(contact["shear_x"], found["shear_x"][-1], rtol=1e-5, atol=1e-5 * found["pressure"].max())


@pytest.mark.parametrize(
    "given, says",
    [
        (dict(gap=np.zeros((2, 2, 2))), "gap: expected finite numbers, an array of shape"),
        (dict(gap=[["a"]]), "gap: expected finite numbers"),
        (dict(friction=np.full((4, 4), np.nan)), "friction: expected finite numbers"),
        (dict(gap=np.ones((4, 4)) * 1j), "gap: expected finite numbers"),
        (dict(gap=np.ma.masked_array(np.ones((4, 4)), np.eye(4))), "gap: expected finite numbers"),
        (dict(history=dict(load_tx=np.array([0.0, 1j]))), "history: load_tx: expected finite numbers"),
        (dict(history=dict(load_tx=np.ma.masked_array([0.0, 1.0], [0, 1]))), "history: load_tx: expected finite"),
        (dict(gap=np.zeros((8, 8)), gap_file="x.h5"), "gap: an array and gap_file are both given"),
        (dict(gap=np.zeros((8, 9))), "-gap_file gap: separation has shape (8, 9), expected (ny, nx) = (32, 32)"),
    ],
)
def test_arrays_that_do_not_fit_are_told(given, says):
    case = {name: value for name, value in CASE.items() if not name.startswith("gap")}
    with pytest.raises(package.Error, match=re.escape(says)):
        package.run({**case, **given})


def test_a_temporary_file_lives_as_long_as_its_results(tmp_path, capfd):
    found = package.run(CASE, load_tx=0.3 * LIMIT, steps=2, stiffness=True, output_fields=["pressure", "slip_x"])
    path = found.path
    assert found.matrices["stiffness"].shape == (2, 6, 6) and found["slip_x"].shape == (2, 32, 32)
    assert h5py.is_hdf5(path) and not list(tmp_path.iterdir())
    copy = os.fork()
    if not copy:
        del found
        gc.collect()
        os._exit(0)
    os.waitpid(copy, 0)
    assert h5py.is_hdf5(path)  # it is not the copy's
    del found
    gc.collect()
    assert not os.path.exists(os.path.dirname(path)) and capfd.readouterr().out == ""
    kept = package.run(CASE, output="kept.h5", load_tx=None)
    del kept
    gc.collect()
    assert h5py.is_hdf5(tmp_path / "kept.h5")


def path_of_a_run(case):
    return package.run(case).path


def test_worker_leaves_no_temporary_files():
    with concurrent.futures.ProcessPoolExecutor(1) as pool:
        path = pool.submit(path_of_a_run, CASE).result()
    assert not os.path.exists(os.path.dirname(path))


def test_table_of_loads_has_its_own_times_or_is_refused():
    found = package.run(CASE, load_n=None, history=dict(load_tx=np.array([1.0, 2.0]), time=(0.5, 2), load_n=[180, 170]))
    assert list(found.time) == [0.5, 2] and found["load_n"] == pytest.approx([180, 170])
    for history, says in (
        (dict(load_tx=[1, 2], load_n=[1, 2, 3]), "load_tx has 2 values, and other columns 3"),
        (dict(), "at least one column"),
        (dict(load_tx=["a", "b"]), "load_tx: expected finite numbers"),
        (dict(load_tx=[1, None]), "load_tx: expected finite numbers"),
        (dict(load_tx=[[1], [2, 3]]), "load_tx: expected finite numbers"),
        ({"load_tx,load_n": [1]}, "no name of a column"),
    ):
        with pytest.raises(package.Error, match=says):
            package.run(CASE, history=history)


def test_index_of_a_table_is_its_time():
    """As to_dataframe() gives it."""
    pandas = pytest.importorskip("pandas")
    table = pandas.DataFrame(dict(load_tx=[1.0, 2.0]), index=pandas.Index([0.5, 2], name="time"))
    found = package.run(dict(CASE, history=table))
    assert list(found.time) == [0.5, 2]
    again = package.run(CASE, history=found.to_dataframe()[["load_tx"]])
    assert list(again.time) == [0.5, 2]


def test_options_may_be_scalars_of_numpy_and_none(tmp_path):
    found = package.run(CASE, load_n=np.array(150.0), grid_n=np.int64(16), output=None)
    assert found["load_n"] == pytest.approx([150]) and not list(tmp_path.iterdir())
    assert found.matrices == {} and "stiffness" not in found
    with pytest.raises(package.Error, match="3 is no name of a number or field"):
        _ = found[3]


def test_an_error_names_no_file_that_the_user_has_not_written():
    with pytest.raises(package.ContactError, match="^-load_n: history has the column load_n") as found:
        package.run(CASE, load_n=1.0, history=dict(load_n=[1.0, 2.0]))
    assert "/" not in str(found.value)


def test_errors_have_the_code_and_the_message_of_the_program():
    with pytest.raises(package.ContactError, match="-grid_m 3: unknown option: is -grid_n meant") as error:
        package.run(CASE, grid_m=3)
    assert error.value.code == 2 and error.value.results is None
    with pytest.raises(package.NoEquilibrium, match="step 2: gross slip") as error:
        package.run(CASE, history=dict(load_tx=[0.5 * LIMIT, 2 * LIMIT]))
    assert error.value.code == 11 and error.value.results["stick_area"][0] > 0
    sent = pickle.loads(pickle.dumps(error.value))  # as from a pool of processes; the results are an open file
    assert type(sent) is package.NoEquilibrium and str(sent) == str(error.value) and sent.results is None


@pytest.mark.parametrize("start", [
    lambda: package.run(CASE, history="no where.csv"), lambda: package.run(CASE, restart="no where.h5"),
    lambda: package.Contact(**shape(), gap_type="file", gap_file="no where.h5"),
    lambda: package.Contact(**shape(), gap_type="flat").load("no where.h5"),
    lambda: package.Contact(**shape(), gap_type="flat").run("no where.csv"),
    lambda: package.open("no where.h5"), lambda: package.open("no where.h5", "label"),
])  # fmt: skip
def test_a_missing_file_is_an_error_of_petsam_and_of_python(start):
    with pytest.raises(FileNotFoundError, match="no where") as caught:
        start()
    error = caught.value
    assert isinstance(error, package.MissingFile) and isinstance(error, package.Missing)
    assert error.errno == errno.ENOENT and error.filename.startswith("no where.") and os.sep not in error.filename
    sent = pickle.loads(pickle.dumps(error))
    assert type(sent) is type(error) and str(sent) == str(error) and sent.filename == error.filename


def shape():
    """The case without the shape of its bodies and its loads."""
    return {name: value for name, value in CASE.items() if not name.startswith(("gap_", "load_"))}


def test_a_missing_option_file_is_an_error_with_a_code():
    with pytest.raises(package.ContactError, match="-friction_file none.h5: cannot be read") as caught:
        package.run(CASE, friction=None, friction_file="none.h5")
    assert isinstance(caught.value, FileNotFoundError) and caught.value.code == 3


def test_what_is_no_option_is_refused_before_the_run(tmp_path):
    for options, says in (
        ({"-grid_n": 3}, "no name of an option"),
        ({"grid_n": object()}, "neither a number nor a text"),
        ({"grid_size": np.ones((2, 2))}, "not an array of 2 dimensions"),
        ({"grid_size": [[1, 2], [3]]}, "not an array of 2 dimensions"),
        ({"output": ["out.h5"]}, "output: expected the path of a file"),
        ({"output": False}, "output: expected the path of a file"),
    ):
        with pytest.raises(package.Error, match=says):
            package.run({**CASE, **options})
    with pytest.raises(package.Error, match="ranks 0: expected an integer"):
        package.run(CASE, ranks=0)
    with pytest.raises(package.Error, match="give one of them"):
        package.run(dict(CASE, history="h.csv"), history=dict(load_tx=[1]))
    assert not list(tmp_path.iterdir())


def test_warnings_are_warnings():
    with pytest.warns(package.AdviceWarning, match="slip zone"):
        package.run(CASE, load_tx=0.02 * LIMIT)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        package.run(CASE)
        with pytest.raises(package.AdviceWarning):
            package.run(CASE, load_tx=0.02 * LIMIT)


def test_a_contact_at_the_edge_ends_the_run_with_an_error():
    """Unless it is allowed; the steps so far are its results."""
    small = dict(CASE, grid_size=0.4 * CASE["grid_size"])
    rows = dict(load_tx=[0, 0.1 * LIMIT])
    with pytest.raises(package.EdgeContact, match="reached the edge .* the run ended with step 1") as caught:
        package.run(small, history=rows)
    assert caught.value.code == 12 and caught.value.results["contact_cells"][-1] > 0
    assert package.run(small, history=rows, allow_edge_contact=True).time.size == 2
    contact = package.Contact(**{k: v for k, v in small.items() if not k.startswith("load")})
    with pytest.raises(package.EdgeContact, match="reached the edge") as caught:
        contact.run(dict(time=[0, 1], load_n=[CASE["load_n"]] * 2, load_tx=rows["load_tx"]))
    assert len(caught.value.steps) == 1 and caught.value.step.contact_cells > 0


def test_a_warning_that_is_an_error_does_not_hide_that_of_the_run(tmp_path):
    (tmp_path / "some.opts").write_text("-load_tx 1\n")  # which the history overrides, with a warning
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with pytest.raises(package.NoEquilibrium) as caught:
            package.run(CASE, options_file="some.opts", history=dict(load_tx=[0.02 * LIMIT, 2 * LIMIT]))
    assert isinstance(caught.value.__cause__, package.AdviceWarning) and caught.value.results["load_n"].size == 2


def test_temporary_files_go_with_the_last_reference():
    """Without a collection of garbage: neither results nor errors refer to themselves."""
    gc.collect()
    gc.disable()
    try:
        found = package.run(CASE, load_tx=0.3 * LIMIT, steps=2)
        folder, part = os.path.dirname(found.path), found.between(2, 2)
        del found
        assert os.path.exists(folder) and part["pressure"].shape == (2, 32, 32)
        del part
        assert not os.path.exists(folder)
        try:
            package.run(CASE, load_tx=2 * LIMIT)
        except package.NoEquilibrium as error:
            folder = os.path.dirname(error.results.path)
            assert os.path.exists(folder)
        assert not os.path.exists(folder)
    finally:
        gc.enable()


def test_an_error_of_tell_ends_the_run(tmp_path):
    def report(line):
        raise RuntimeError(line)

    with pytest.raises(RuntimeError, match="petsam 1"):
        package.run(CASE, steps=100, report=report)
    assert not list(tmp_path.iterdir())


def test_a_program_that_gives_nothing_is_an_error(monkeypatch, tmp_path):
    for script, says in (
        ("exit 0", "petsam has written no results to"),
        ("kill -9 $$", r"petsam ended with signal 9 \(Killed\)"),
        ("echo why >&2; echo ---- >&2; exit 7", "petsam ended with code 7: why"),
    ):
        program = tmp_path / "petsam"
        program.write_text("#!/bin/sh\n" + script)
        program.chmod(0o755)
        monkeypatch.setenv("PETSAM", str(program))
        with pytest.raises(package.Error, match=says):
            package.run(CASE)


@pytest.mark.parametrize("ranks", [1, 2])
@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGKILL])
def test_a_signal_that_ends_python_ends_the_run(tmp_path, ranks, number):
    """A program that never ends stands for petsam; it notes its process."""
    program = tmp_path / "petsam"
    program.write_text(f"#!/bin/sh\necho $$ >> {tmp_path}/started\necho running\nexec sleep 600")
    program.chmod(0o755)
    lines = f"import petsam; petsam.run(grid_n=8, ranks={ranks}, report=lambda line: print(line, flush=True))"
    given = dict(environment(), PETSAM=str(program), PYTHONPATH=str(ROOT / "scripts"))
    with subprocess.Popen([sys.executable, "-c", lines], stdout=subprocess.PIPE, env=given) as python:
        for _ in range(ranks):
            assert python.stdout.readline() == b"running\n"
        python.send_signal(number)
        python.wait(10)
    runs = [int(line) for line in (tmp_path / "started").read_text().split()]
    end = time.monotonic() + 10
    try:
        while any(map(alive, runs)) and time.monotonic() < end:
            time.sleep(0.05)
        assert not any(map(alive, runs))
    finally:
        for run in filter(alive, runs):
            os.kill(run, signal.SIGKILL)


def test_a_signal_that_ends_python_ends_calculix(tmp_path):
    """A program that never ends stands for CalculiX; it notes its process, and its threads."""
    program, started = tmp_path / "ccx", tmp_path / "started"
    program.write_text(
        f"#!/bin/sh\necho $$ $OMP_NUM_THREADS $CCX_NPROC_STIFFNESS > {started}.part\nmv {started}.part {started}\n"
        "exec sleep 600"
    )
    program.chmod(0o755)
    lines = f"from petsam.apps.compliance import stiffness; stiffness.run([], {str(tmp_path)!r}, 'a', {str(program)!r})"
    given = dict(environment(), PYTHONPATH=str(ROOT / "scripts"), OMP_NUM_THREADS="7")
    end = time.monotonic() + 20
    with subprocess.Popen([sys.executable, "-c", lines], env=given) as python:
        while not started.exists() and time.monotonic() < end:
            time.sleep(0.02)
        python.kill()
    run, *threads = map(int, started.read_text().split())
    try:
        while alive(run) and time.monotonic() < end:
            time.sleep(0.02)
        assert not alive(run) and threads == [1, 1]
    finally:
        if alive(run):
            os.kill(run, signal.SIGKILL)


def test_a_solver_that_cannot_be_started_is_named(tmp_path):
    (tmp_path / "ccx").write_bytes(b"\x7fELF no program")
    (tmp_path / "ccx").chmod(0o755)
    with pytest.raises(package.Error, match="ccx cannot be started: "):
        stiffness.run([], tmp_path, "a", str(tmp_path / "ccx"))


def alive(process):
    """Whether a process runs; one that has ended may wait for its parent."""
    try:
        with open(f"/proc/{process}/stat", encoding="ascii") as file:
            return file.read().rpartition(")")[2].split()[0] not in "ZX"
    except OSError:
        return False


def test_more_ranks_than_cores_are_warned_of(monkeypatch):
    monkeypatch.setattr(package.core.environment, "cores", lambda: 2)
    monkeypatch.setattr(package.core.environment, "NODES", ())
    for launcher, warned in (("mpirun", True), ("mpiexec", True), ("mpirun --host a,b", False), ("srun", False)):
        monkeypatch.setattr(package.core.environment, "launcher", launcher.split)
        with warnings.catch_warnings(record=True) as found:
            warnings.simplefilter("always")
            assert running._command(3)[:-3] == launcher.split() and running._command(2)
        said = ["ranks=3: this process may use 2 cores; more ranks take turns, and are slower: use fewer"] * warned
        assert [str(one.message) for one in found if one.category is package.AdviceWarning] == said

"""Fixtures that run the built program: build/bin/petsam, or that of the directory in PETSAM_BUILD."""

import contextlib
import functools
import os
import re
import signal
import subprocess
import sys
import zlib
from pathlib import Path

import pytest

import support

TIMEOUT = 120  # seconds for one run on an idle machine
PROGRAM = Path(os.environ.get("PETSAM_BUILD", support.ROOT / "build")).resolve() / "bin" / "petsam"


SLOWEST, FILES = 30, 10  # tests, and files of them, whose CPU times are printed
SLOW = Path(__file__).with_name("slow.txt")  # test functions that `make test` leaves out
MOST = 0.6  # CPU seconds of others


def pytest_configure(config):
    config.addinivalue_line("markers", "slow: run by `make check-slow`, not by `make test`")
    worker = os.environ.get("PYTEST_XDIST_WORKER")
    if worker and hasattr(os, "sched_setaffinity"):
        # a core of its own, also for the ranks of its runs: there each yields to the others, and none waits by spinning
        cores = sorted(os.sched_getaffinity(0))
        os.sched_setaffinity(0, {cores[int(worker[2:]) % len(cores)]})


def pytest_collection_modifyitems(items):
    """Marks the slow tests: the listed ones, and of a test on several numbers of ranks all but one number, chosen by a
    checksum of its name."""
    alike, listed = {}, set(SLOW.read_text().splitlines())
    for item in items:
        if name_of(item.nodeid) in listed:
            item.add_marker("slow")
        places = dict(getattr(item, "callspec", None) and item.callspec.indices or {})
        if places.pop("ranks", None) is not None:
            alike.setdefault((item.nodeid.partition("[")[0], *sorted(places.items())), []).append(item)
    for name, tests in alike.items():
        chosen = zlib.crc32(repr(name).encode()) % len(tests)
        for test in tests[:chosen] + tests[chosen + 1 :]:
            test.add_marker("slow")


def name_of(nodeid):
    """The file and function of a test."""
    return nodeid.partition("[")[0].rpartition("/")[2]


def cpu():
    """CPU seconds of this process and of all that it has started and awaited."""
    return sum(os.times()[:4])


spent = [cpu()]


@pytest.hookimpl(hookwrapper=True)
def pytest_runtest_makereport(item, call):
    """CPU seconds of each phase of a test, which do not depend on what else the machine does."""
    report = (yield).get_result()
    report.cpu, spent[0] = cpu() - spent[0], cpu()


def write_slow(seconds):
    """Lists the functions of which a test took longer than MOST; those that did not run keep their place."""
    most = {}
    for nodeid, value in seconds.items():
        most[name_of(nodeid)] = max(value, most.get(name_of(nodeid), 0.0))
    head, *before = SLOW.read_text().splitlines()
    kept = {name for name in before if name not in most} | {name for name in most if most[name] > MOST}
    SLOW.write_text("\n".join([head, *sorted(kept)]) + "\n")


def pytest_terminal_summary(terminalreporter):
    seconds = {}
    for report in (r for reports in terminalreporter.stats.values() for r in reports if hasattr(r, "cpu")):
        seconds[report.nodeid] = seconds.get(report.nodeid, 0.0) + report.cpu
    terminalreporter.section(f"slowest {SLOWEST} tests and {FILES} files of {sum(seconds.values()):.0f} CPU seconds")
    if os.environ.get("PETSAM_MEASURE"):
        write_slow(seconds)
    files = {}
    for name, spent_there in seconds.items():
        file = name.partition("::")[0]
        files[file] = files.get(file, 0.0) + spent_there
    for group, most in ((seconds, SLOWEST), (files, FILES)):
        for name in sorted(group, key=group.get, reverse=True)[:most]:
            terminalreporter.line(f"{group[name]:8.1f} s  {name}")


class Popen(subprocess.Popen):
    """The time limits of all tests are those of an idle machine; on a loaded one they are longer."""

    def communicate(self, input=None, timeout=None):
        return super().communicate(input, support.limit(timeout))

    def wait(self, timeout=None):
        return super().wait(support.limit(timeout))


subprocess.Popen = Popen


def approx(expected, rel=None, abs=None, nan_ok=False, compare=pytest.approx):
    """pytest's own adds an absolute tolerance of 1e-12, within which all slips and energies in SI units are alike."""
    if abs is None:
        rel, abs = 1e-6 if rel is None else rel, 0.0
    return compare(expected, rel=rel, abs=abs, nan_ok=nan_ok)


pytest.approx = approx


def environment():
    """Open MPI refuses to run as root, as a container does, unless told twice; PETSC_OPTIONS would add options.

    Ranks that wait yield their core: several tests share the cores. mpirun would bind two ranks to a core each, where a
    rank that yields to a busy process gets no time. A run that hangs ends after MPIEXEC_TIMEOUT.
    """
    env = {name: value for name, value in os.environ.items() if name != "PETSC_OPTIONS"}
    env.update(OMPI_MCA_mpi_yield_when_idle="1", OMPI_MCA_hwloc_base_binding_policy="none")
    env.update(OMP_NUM_THREADS="1", MPIEXEC_TIMEOUT=str(int(support.limit(TIMEOUT))))
    if os.geteuid() == 0:
        env.update(OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
    return env


@functools.cache
def launcher_words():
    """The launcher's words but the number of ranks."""
    words = os.environ.get("MPIRUN", "mpirun").split()
    version = subprocess.run(
        words + ["--version"], capture_output=True, text=True, env=environment(), timeout=60
    ).stdout
    return words + (["--oversubscribe"] if "Open MPI" in version else [])


@pytest.fixture(scope="session")
def launcher():
    return launcher_words()


def make_install(*words):
    """make install of what is being tested, with these variables."""
    support.finished(["make", f"B={PROGRAM.parents[1]}", "install", *words], cwd=support.ROOT, timeout=600)


def processes(run, ranks):
    """Process numbers of the ranks of a run that was started by the launcher, or alone."""
    if ranks == 1:
        return [run.pid]
    return [int(word) for word in Path(f"/proc/{run.pid}/task/{run.pid}/children").read_text().split()]


def kill_all(run, ranks):
    """All ranks at once, by the signal that nothing can catch."""
    try:
        ranks = processes(run, ranks)
    except FileNotFoundError:  # the launcher has ended
        ranks = []
    for process in ranks or [run.pid]:
        with contextlib.suppress(ProcessLookupError):
            os.kill(process, signal.SIGKILL)


def execute(launcher, directory, options, ranks, check, extra=None, program=None):
    """One run; with more than one rank by the launcher."""
    command = (
        (launcher + ["-n", str(ranks)] if ranks > 1 else []) + [str(program or PROGRAM)] + support.flatten(options)
    )
    done = subprocess.run(
        command,
        capture_output=True,
        text=True,
        errors="replace",
        cwd=directory,
        timeout=TIMEOUT + 30,
        env={**environment(), **(extra or {})},
        stdin=subprocess.DEVNULL,
    )
    assert check is None or done.returncode == check, (
        f"exit code {done.returncode}, expected {check}: {' '.join(command)}\n"
        f"{done.stdout[-3000:]}\n{done.stderr[-3000:]}"
    )
    return support.Run(done.returncode, done.stdout, done.stderr)


def start(launcher, directory, options, ranks=1, extra=None, **how):
    """Begins a run whose output can be read while it goes on; `extra`: variables of its environment."""
    return subprocess.Popen(
        (launcher + ["-n", str(ranks)] if ranks > 1 else []) + [str(PROGRAM), *support.flatten(options)],
        cwd=directory,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env={**environment(), **(extra or {})},
        **how,
    )


def wait_for(run, step):
    """Until a run that was started has told that step."""
    for line in run.stdout:
        if re.match(rf" *{step} +\S", line):
            return
    pytest.fail(f"the run ended before step {step}: {run.stderr.read()}")


@contextlib.contextmanager
def small_disk_on(folder, size):
    """The folder lies on a disk of that size."""
    mount = ["mount", "-t", "tmpfs", "-o", f"size={size}", "tmpfs", str(folder)]
    if subprocess.run(mount, capture_output=True).returncode:
        pytest.skip("no right to mount a small disk")
    yield
    subprocess.run(["umount", "-l", str(folder)], check=True)


@pytest.fixture(scope="session")
def prefix(tmp_path_factory):
    """What make install has installed; to read only."""
    folder = tmp_path_factory.mktemp("prefix")
    make_install(f"prefix={folder}")
    return folder


@pytest.fixture
def petsam(launcher, tmp_path):
    """petsam(*options, ranks=1, check=0): runs in tmp_path; options are words and dicts; check=None takes any code."""

    def run(*options, ranks=1, check=0, environment=None):
        return execute(launcher, tmp_path, options, ranks, check, environment)

    return run


@pytest.fixture
def stress(launcher, tmp_path):
    """stress(*options, ranks=1, check=0): a run of petsam-stress in tmp_path."""
    program = PROGRAM.with_name("petsam-stress")

    return lambda *options, ranks=1, check=0: execute(launcher, tmp_path, options, ranks, check, program=program)


@pytest.fixture(scope="session")
def solve(launcher, tmp_path_factory):
    """solve(*options, ranks=1, check=0): the results of such a run, solved once a session."""
    known = {}

    def run(*options, ranks=1, check=0):
        key = (*support.flatten(options), ranks, check)
        if key not in known:
            directory = tmp_path_factory.mktemp("run")
            done = execute(launcher, directory, [*options, "-output", "results.h5"], ranks, check)
            known[key] = support.Results(directory / "results.h5", done)
        return known[key]

    return run


@pytest.fixture
def sphere():
    """Table 1 at 64 x 64 cells; a copy to change."""
    return dict(support.SPHERE)


@pytest.fixture
def call(tmp_path, monkeypatch, capfd):
    """call(name, *words, main=None): exit code and messages of a command of Python, or of another main(), run here in
    tmp_path: many quickly."""
    from petsam.apps.launch import code_of

    monkeypatch.chdir(tmp_path)

    def run(name, *words, main=None):
        monkeypatch.setattr(sys, "argv", [name, *map(str, words)])
        try:
            code = main() if main else code_of(name)
        except SystemExit as end:  # of argparse
            code = end.code
        return code, capfd.readouterr().err.splitlines()

    return run


@pytest.fixture
def draw(call):
    """draw(*words): exit code and messages of petsam-plot."""
    return lambda *words: call("petsam-plot", *words)


@pytest.fixture
def results(path):
    """The results of the run whose file the fixture `path` of a module gives."""
    import petsam

    with petsam.open(path) as results:
        yield results


@pytest.fixture
def closing():
    """Figures are closed after each test: matplotlib keeps them."""
    from petsam.plot.style import plt

    yield
    plt.close("all")


@pytest.fixture
def joint_command(tmp_path, monkeypatch, capsys):
    """joint_command(action, *words, check=0): what petsam-joint prints; its complaint where it fails."""
    from petsam.apps.launch import code_of

    monkeypatch.chdir(tmp_path)

    def run(action, *words, check=0):
        monkeypatch.setattr(sys, "argv", ["petsam-joint", action, *map(str, words)])
        try:
            code = code_of("petsam-joint")
        except SystemExit as error:
            code = error.code
        out, err = capsys.readouterr()
        assert code == check, (code, err)
        return err if check else out

    return run

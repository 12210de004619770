"""Finds Python's libraries and petsam for the commands, in the build tree as well as installed.

It uses the standard library only, as it is imported before it is known that the libraries exist.
"""

import contextlib
import ctypes
import importlib
import importlib.util
import os
import re
import shlex
import shutil
import signal
import subprocess
import sys
import threading
from pathlib import Path

from .errors import Error, Missing, short

SCRIPTS = Path(__file__).resolve().parents[2]
TREE = SCRIPTS.parent  # the repository, prefix/share/petsam, or prefix/lib/pythonX.Y of an installed wheel
PREFIX = TREE.parents[1]
ENTERED = "PETSAM_ENTERED"
PR_SET_PDEATHSIG = 1  # of Linux's prctl
VERSION, SECONDS = 4096, 60.0  # characters of what a launcher says about itself, and how long it may take


# ---------------------------------------------------------------- Python


def _interpreter():
    """Returns the Python to use: $PYTHON, that of `make venv`, or this one."""
    if os.environ.get("PYTHON"):
        found = shutil.which(os.environ["PYTHON"])
        if not found:
            sys.exit(
                "{}: error: no Python {}, which PYTHON names".format(
                    os.path.basename(sys.argv[0]), os.environ["PYTHON"]
                )
            )
        return found
    for venv in (TREE / "build" / "venv", TREE / "venv"):
        if os.access(venv / "bin" / "python", os.X_OK):
            return str(venv / "bin" / "python")
    return None


def enter(*libraries):
    """Continues in the Python of _interpreter(); ends with a message if a library is missing there."""
    python = _interpreter()
    # execv keeps the process: its number shows that this one has already been replaced
    if python and os.environ.get(ENTERED) != str(os.getpid()):
        os.environ[ENTERED] = str(os.getpid())
        if sys.stdout:
            sys.stdout.flush()
        try:
            os.execv(python, [python, *sys.argv])
        except OSError as error:
            sys.exit(
                f"{os.path.basename(sys.argv[0])}: error: {python} cannot be executed: {error.strerror}; see PYTHON"
            )
    lacking = [name for name in libraries if importlib.util.find_spec(name) is None]
    if lacking:
        sys.exit(
            "{}: error: {} has no {}: run `make venv`, or set PYTHON to one with {}".format(
                os.path.basename(sys.argv[0]), sys.executable, ", ".join(lacking), SCRIPTS / "requirements.txt"
            )
        )


# ---------------------------------------------------------------- petsam


def petsam():
    """Returns the path of the program: $PETSAM, build/bin, prefix/bin, or PATH."""
    if os.environ.get("PETSAM"):
        found = shutil.which(os.environ["PETSAM"])
        if not found:
            raise Missing("no program {}, which PETSAM names".format(os.environ["PETSAM"]))
        return os.path.abspath(found)
    for folder in (TREE / "build" / "bin", PREFIX / "bin"):
        if os.access(folder / "petsam", os.X_OK):
            return str(folder / "petsam")
    found = shutil.which("petsam")
    if not found:
        raise Missing("no program petsam in build/bin or on PATH: run make, or set PETSAM")
    return found


def script(name):
    """Returns the path of a script beside this package, or where pip puts it."""
    folders = (SCRIPTS, PREFIX / "bin")
    found = next((folder / name for folder in folders if (folder / name).exists()), None)
    if not found:
        raise Missing(f"{name} not found in {', '.join(map(str, folders))}; install petsam again")
    return found


def split(text, what):
    """Splits a text into words like a shell; `what` names the text in messages."""
    try:
        return shlex.split(text)
    except ValueError as error:
        raise Error(f"{what}: {text}: {str(error).lower()}") from error


def launcher(words=None):
    """The MPI launcher's words, to which `-n RANKS PROGRAM` is added: words, $MPIRUN, mpirun beside the installed
    petsam (of a wheel's MPI), or mpirun on the PATH."""
    beside = PREFIX / "bin" / "mpirun"
    own = shlex.quote(str(beside)) if os.access(beside, os.X_OK) and os.access(PREFIX / "bin/petsam", os.X_OK) else None
    text = words or os.environ.get("MPIRUN") or own or "mpirun"
    command = split(text, "the MPI launcher")
    if not command or not shutil.which(command[0]):
        raise Missing(f"no MPI launcher {command[0] if command else repr(text)}: set MPIRUN")
    if os.sep in command[0]:
        command[0] = os.path.abspath(command[0])  # it is called from the cases' folders
    version = _version(command)
    if "Open MPI" in version or "OpenRTE" in version:
        # otherwise concurrent runs would all be bound to the first cores
        command += ["--bind-to", "none", "--oversubscribe"]
    return command


def _version(command):
    """Returns the beginning of a launcher's description of itself; stops one that prints too much or takes too long."""
    try:
        process = subprocess.Popen(
            command + ["--version"],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            start_new_session=True,
        )
    except OSError as error:
        raise Missing(f"the MPI launcher {command[0]} cannot be executed: {error.strerror}") from error

    def stop():
        with contextlib.suppress(ProcessLookupError, PermissionError):
            os.killpg(process.pid, signal.SIGKILL)

    timer = threading.Timer(SECONDS, stop)
    timer.start()
    try:
        with process.stdout:
            return process.stdout.read(VERSION).decode(errors="replace")
    finally:
        timer.cancel()
        stop()
        process.wait()


def command(words=None):
    """Returns a function of a number of ranks: the words that start petsam by the launcher of these words."""
    launched, program = launcher(words), petsam()
    return lambda ranks: [*launched, "-n", str(ranks), program]


def cores():
    """Number of cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


ELSEWHERE = re.compile(r"--?(host|machine|node|f$)")  # options of an mpirun that name machines
NODES = "SLURM_JOB_NUM_NODES", "PBS_NODEFILE", "LSB_HOSTS", "PE_HOSTFILE"  # of a job that may have several machines


def is_local(words):
    """True if a launcher's words start all ranks on this machine."""
    mpirun = bool(words) and os.path.basename(words[0]).startswith("mpi")
    alone = all(os.environ.get(name, "1") == "1" for name in NODES)
    return mpirun and alone and not any(ELSEWHERE.match(word) for word in words[1:])


def start(words, follows=False, variables=None, **how):
    """Starts a program of a run, with nothing to read; Error if it cannot be started. `follows`: it ends with this
    process, whatever ends that; `variables`: of its environment; `how`: as subprocess.Popen takes it."""
    if follows:
        how["preexec_fn"] = _following()
    try:
        return subprocess.Popen(words, stdin=subprocess.DEVNULL, env={**_variables(), **(variables or {})}, **how)
    except (OSError, ValueError) as error:  # no program for this system, or too many words
        raise Error(f"{short(words[0])} cannot be started: {getattr(error, 'strerror', None) or error}") from error


def _variables():
    """The variables of a run: one thread a rank, and Open MPI's consent to the superuser, whom a container has."""
    variables = dict(os.environ)
    variables.setdefault("OMP_NUM_THREADS", "1")
    if os.geteuid() == 0:
        variables.update(OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
    return variables


def end_with_parent(number):
    """Asks the system for a signal to this process when the thread that has made it ends, whatever ends that."""
    with contextlib.suppress(OSError, AttributeError):  # not available on systems other than Linux
        ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, number)


def _following():
    """Returns a function for a child process to call before its program begins: a signal that ends this process then
    ends the program."""
    parent = os.getpid()

    def begin():
        end_with_parent(signal.SIGTERM)
        if os.getppid() != parent:  # it has ended already
            os._exit(128 + signal.SIGTERM)

    return begin

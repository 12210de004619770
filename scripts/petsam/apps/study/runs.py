"""Running of a study's cases: each in its own folder, side by side within a number of cores, again where it ended.

A case's folder holds petsam.log (all that the run printed), results.h5, the files of the table, and record.json: the
identity of its inputs, its exit code (none until it has ended), seconds and message. A case is finished when its record
has this identity and exit code 0. A lock, which the run inherits, keeps two studies from running one case at once.
"""

import contextlib
import errno
import fcntl
import json
import math
import os
import re
import signal
import subprocess
import threading
import time

from ...core import environment
from ...core.errors import Error, short
from ...core.files import need_regular, need_replaceable

LOG, RESULTS, RECORD, CHECKPOINT = "petsam.log", "results.h5", "record.json", "checkpoint.h5"
LATER = "results.part{}.h5"  # of a run that went on, from 2 on
STRESSES = "stress.h5"  # of petsam-stress, if the table requests it
STOPPED = 75  # petsam's exit code when it has written a checkpoint and is to be run again
MEANINGS = {
    2: "bad usage",
    3: "file error",
    10: "not converged",
    11: "no equilibrium",
    12: "contact at the grid's edge",
    STOPPED: "stopped early, to be run again",
}
PATIENCE = 10.0  # seconds for runs to end when requested
GRACE = 90.0  # seconds that they get to write a checkpoint and stop, unless a variable gives the time that is left
RESERVE = 30.0  # seconds before the end of a Slurm job in which it is queued again
WORDS = 1000  # maximum characters of a run's own words on its end
OWN = re.compile("^petsam(-stress)?: ")  # beginning of the programs' messages
WARNING = "warning: "  # beginning of those of a run that goes on
PAUSE = 0.05  # seconds between looks at the runs


class Busy(Exception):
    """Another study runs this case."""


# ---------------------------------------------------------------- records


def write_atomically(path, text):
    """The file contains either its old text or all of the new one."""
    beside = path + ".tmp"
    need_replaceable(beside)
    with open(beside, "w", encoding="utf-8", errors="backslashreplace") as file:  # names of files need not be text
        file.write(text)
        file.flush()
        os.fsync(file.fileno())
    os.replace(beside, path)


def record(directory, case):
    """Returns the case's record if its inputs are these, else an empty one."""
    path = os.path.join(directory, case.name, RECORD)
    try:
        need_regular(path)
        with open(path, encoding="utf-8") as file:
            known = json.load(file)
    except (OSError, ValueError, RecursionError, Error):
        return {}
    return known if _is_record(known) and known["identity"] == case.identity() else {}


def _is_record(known):
    """Returns true if it may be a record written here."""
    if not isinstance(known, dict) or not {"identity", "exit_code", "seconds", "message"} <= set(known):
        return False
    code, seconds = known["exit_code"], known["seconds"]
    return (
        (code is None or type(code) is int and abs(code) < 1 << 31)
        and type(seconds) in (int, float)
        and abs(seconds) < math.inf
        and isinstance(known["message"], str)
        and "\0" not in known["message"]
    )


def finished(directory, case):
    """Returns true if the case need not run again."""
    return record(directory, case).get("exit_code") == 0


def _message(log, code):
    """Returns the run's own words on its end: petsam's first message, or its first warning, else the last line."""
    try:
        with open(log, encoding="utf-8", errors="replace") as file:
            lines = [line.strip() for line in file if line.strip()]
    except OSError:
        lines = []
    said = [OWN.sub("", line) for line in lines if OWN.match(line)]
    own = [line for line in said if not line.startswith(WARNING)]
    if own:
        return short(own[0], WORDS)
    if code < 0 or code > 128:
        number = -code if code < 0 else code - 128
        return f"ended by signal {number}"
    last = lines[-1:] if code else said
    return short(last[0], WORDS) if last else ""


def _seconds(name):
    """A variable's number of seconds, or None where it is not set."""
    text = os.environ.get(name)
    if not text:
        return None
    try:
        seconds = float(text)
    except ValueError:
        seconds = math.nan
    if not 0.0 <= seconds < math.inf:
        raise Error(f"the variable {name} is {short(text)}; expected a number of seconds")
    return seconds


def grace():
    """Seconds from now that runs get to write a checkpoint and stop: $GRACE, the job's time left, or GRACE."""
    seconds, end = _seconds("GRACE"), _seconds("SLURM_JOB_END_TIME")
    if seconds is not None:
        return seconds
    return GRACE if end is None else max(1.0, end - time.time() - RESERVE)


def check_folders(directory, cases, table):
    """Raises Error, before any case runs, if a result or a case would replace another file, or the study's table."""
    for name in ("results.csv", "results.h5"):
        for path in (os.path.join(directory, name), os.path.join(directory, name + ".tmp")):
            said = f"{table}: would be replaced by the results; choose another folder by --directory"
            need_replaceable(path, [table], Error(said))
    for case in cases:
        folder = os.path.join(directory, case.name)
        if os.path.lexists(folder) and not os.path.isdir(folder):
            raise Error(f"{folder}: is not a folder, but has the name of a case; rename or remove it")


# ---------------------------------------------------------------- one case


class Run:
    """A case that is running."""

    def __init__(self, case, directory, command, checkpoint_every=None):
        """Make the folder ready and start `command -n RANKS petsam ...` in it."""
        self.case, self.folder = case, os.path.join(directory, case.name)
        os.makedirs(self.folder, exist_ok=True)
        self.lock = self._lock()
        goes_on = self._goes_on(directory, checkpoint_every)
        for name, text in case.files.items():
            write_atomically(os.path.join(self.folder, name), text)
        self.start, self.told, self.patience = time.monotonic(), None, 0.0
        self.before = record(directory, case).get("seconds", 0.0) if goes_on else 0.0
        self._note(None, "")
        program = command(case.ranks)
        self.stress = []
        if case.stress:
            beside = os.path.join(os.path.dirname(program[-1]), "petsam-stress")
            self.stress = [*program[:-1], beside, "-input", RESULTS, "-output", STRESSES, *case.words(case.stress)]
        words = [*program, *case.words(), "-output", RESULTS, *self._checkpointing(checkpoint_every, goes_on)]
        log = os.path.join(self.folder, LOG)
        need_replaceable(log)
        with open(log, "a" if goes_on else "w", encoding="utf-8") as file:
            self.process = self._popen(words, file)

    def _popen(self, words, log):
        try:
            # its own session: the terminal's Ctrl-C reaches the study alone, which then ends the runs in order
            return environment.start(
                words, cwd=self.folder, stdout=log, stderr=subprocess.STDOUT, start_new_session=True,
                pass_fds=(self.lock,),
            )  # fmt: skip
        except Error as error:
            raise Error(f"case {self.case.name}: {error}") from error

    def _lock(self):
        lock = os.open(os.path.join(self.folder, "lock"), os.O_RDWR | os.O_CREAT, 0o666)
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError as error:
            # a file system without locks must not prevent a run
            if error.errno in (errno.EWOULDBLOCK, errno.EACCES):
                os.close(lock)
                raise Busy() from error
        return lock

    def _goes_on(self, directory, checkpoint_every):
        """True if an earlier run of these inputs left a checkpoint; the remains of others are removed."""
        if checkpoint_every and record(directory, self.case) and os.path.exists(os.path.join(self.folder, CHECKPOINT)):
            return True
        for name in os.listdir(self.folder):
            begins = (os.path.splitext(CHECKPOINT)[0], LATER.partition("{")[0])
            if name in (RESULTS, RECORD, LOG, STRESSES) or name.startswith(begins):
                os.remove(os.path.join(self.folder, name))
        return False

    @staticmethod
    def _checkpointing(every, goes_on):
        words = ["-checkpoint", CHECKPOINT, "-checkpoint_every", str(every)] if every else []
        return words + (["-restart", CHECKPOINT] if goes_on else [])

    def _note(self, code, message):
        seconds = self.before + time.monotonic() - self.start
        write_atomically(
            os.path.join(self.folder, RECORD),
            json.dumps(
                {
                    "identity": self.case.identity(),
                    "inputs": self.case.inputs,
                    "ranks": self.case.ranks,
                    "exit_code": code,
                    "seconds": round(seconds, 3),
                    "message": message,
                },
                indent=2,
            )
            + "\n",
        )

    def ended(self):
        """Returns the exit code, which is also recorded, once the run has ended by itself; else None."""
        code = self.process.poll()
        if self.told and code is None and time.monotonic() > self.told + self.patience:
            self.signal(signal.SIGTERM)
        if code == 0 and self.stress and not self.told:
            with open(os.path.join(self.folder, LOG), "a", encoding="utf-8") as file:
                self.process = self._popen(self.stress, file)
            self.stress, code = [], None
        if code is not None:
            code = STOPPED if code == 0 and self.stress else code
            if self.told and code not in (0, *MEANINGS) and os.path.exists(os.path.join(self.folder, CHECKPOINT)):
                code = STOPPED  # it was in a long step, and has an earlier checkpoint
            message = _message(os.path.join(self.folder, LOG), code)
            self._note(code, message)
            os.close(self.lock)
        return code

    def tell(self):
        """Ask for a checkpoint and an early end, within the seconds of grace()."""
        self.told, self.patience = time.monotonic(), grace()
        self.signal(signal.SIGUSR1)

    def signal(self, number):
        """Send a signal to the launcher, which passes it on."""
        with contextlib.suppress(ProcessLookupError):
            self.process.send_signal(number)

    def kill(self):
        """End the launcher and all that it has started, unless it has ended."""
        if self.process.poll() is None:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(self.process.pid, signal.SIGKILL)
            self.process.wait()


# ---------------------------------------------------------------- all cases


class Study:
    """Runs cases side by side within cores; report(case, exit code or None when busy) is called as they end."""

    def __init__(self, directory, command, cores, report, tick, checkpoint_every=None):
        """tick(number of running cases, number of waiting cases) is called now and then."""
        self.directory, self.command, self.cores = directory, command, cores
        self.report, self.tick, self.checkpoint_every = report, tick, checkpoint_every
        self.running, self.interrupted, self.stop = [], 0, False
        grace()  # refuses variables that are no numbers

    def _catch(self, number, _frame):
        if number == signal.SIGUSR1:  # Slurm's notice of the end: the runs write their checkpoints and stop
            self.stop = True
            for run in self.running if self.checkpoint_every else ():
                run.tell()
        else:
            self.interrupted, self.stop = self.interrupted or number, True

    def run(self, cases):
        """Run all; the number of the signal that ended it early, or 0."""
        # signals that the caller ignores (nohup) stay ignored
        caught = [
            number
            for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGUSR1)
            if signal.getsignal(number) != signal.SIG_IGN and threading.current_thread() is threading.main_thread()
        ]
        before = {number: signal.signal(number, self._catch) for number in caught}
        try:
            self._loop(list(cases))
        finally:
            self._end()
            for number, handler in before.items():
                signal.signal(number, handler)
        return self.interrupted

    def _loop(self, waiting):
        while (self.running or (waiting and not self.stop)) and not self.interrupted:
            self._look()
            while waiting and not self.stop:
                free = self.cores - sum(run.case.ranks for run in self.running)
                case = next((case for case in waiting if case.ranks <= free), None)
                if case is None:
                    break
                waiting.remove(case)
                self._start(case)
            self.tick(len(self.running), len(waiting))
            time.sleep(PAUSE)

    def _start(self, case):
        try:
            self.running.append(Run(case, self.directory, self.command, self.checkpoint_every))
        except Busy:
            self.report(case, None)

    def _look(self):
        for run in list(self.running):
            code = run.ended()
            if code is not None:
                self.running.remove(run)
                self.report(run.case, code)

    def _end(self):
        """Ends the remaining runs; their records show that they have not ended by themselves."""
        for run in self.running:
            run.signal(signal.SIGTERM)
        until = time.monotonic() + PATIENCE
        for run in self.running:
            with contextlib.suppress(subprocess.TimeoutExpired):
                run.process.wait(max(0.0, until - time.monotonic()))
            run.kill()
            os.close(run.lock)
        self.running = []

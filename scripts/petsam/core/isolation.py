"""Work in a child process: HDF5 follows the addresses in a file, and on a damaged one it may crash or never end."""

import contextlib
import math
import mmap
import os
import pickle
import resource
import signal
import stat
import sys
import warnings

from .environment import end_with_parent
from .errors import Error

SECONDS = 20  # of CPU time for one reading
EXAMINING = 5  # of CPU time for the names and attributes of a file, before this process opens it
MEMORY = 4 << 30  # bytes that one reading may need; it reads by blocks
NAME = 4096  # maximum bytes of a file's name that are noted
# signals that end a child that reads a damaged file
DAMAGE = {
    getattr(signal, name)
    for name in ("SIGSEGV", "SIGBUS", "SIGABRT", "SIGFPE", "SIGILL", "SIGTRAP", "SIGXCPU", "SIGSYS")
}

_examined = {}  # path: the state of the file that has been examined last, and the Ended that is raised for it, or None
_note = None  # in a child: memory shared with the parent, with the name of the file that is being read


class Ended(Error):
    """A child has ended before its work: number is the signal, if any; path the file it was reading, if any."""

    def __init__(self, number, path):
        super().__init__(
            f"{path}: is damaged"
            if path and number in DAMAGE
            else f"{path or 'the work'}: ended by signal {number}"
            if number
            else "the work ended early"
        )
        self.number, self.path = number, path


def _addresses():
    """Returns the bytes of address space in use; infinite if the system does not report them."""
    try:
        with open("/proc/self/statm", encoding="ascii") as file:
            return int(file.read().split()[0]) * mmap.PAGESIZE
    except (OSError, ValueError):
        return math.inf


@contextlib.contextmanager
def _limits(**wanted):
    """Lowers soft limits of the system during the block; lower existing limits stay."""
    before = {name: resource.getrlimit(getattr(resource, name)) for name in wanted}
    for name, value in wanted.items():
        if math.isfinite(value):
            holding = [one for one in before[name] if one != resource.RLIM_INFINITY]
            resource.setrlimit(getattr(resource, name), (min([value, *holding]), before[name][1]))
    try:
        yield
    finally:
        for name, pair in before.items():
            resource.setrlimit(getattr(resource, name), pair)


@contextlib.contextmanager
def _silence():
    """Suppresses the messages of a library that aborts, which would mean nothing to a user."""
    sys.stderr.flush()
    before, nowhere = os.dup(2), os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 2)
    os.close(nowhere)
    try:
        yield
    finally:
        os.dup2(before, 2)
        os.close(before)


def _walk(path):
    """Reads all names and attributes of a file without keeping them; unreadable ones are reported later."""
    import h5py

    def visit(_, item):
        for name in item.attrs:
            with contextlib.suppress(Exception):
                _ = item.attrs[name]

    with reading(path, min(SECONDS, EXAMINING)), contextlib.suppress(Exception), h5py.File(path, "r") as file:
        visit("/", file)
        file.visititems(visit)


def _examine(path):
    """Raises Ended if a child process cannot read the names and attributes of an existing file."""
    try:
        status = os.stat(path)
    except (OSError, ValueError):
        return
    if not stat.S_ISREG(status.st_mode):
        return
    name, now = os.fsencode(path), (status.st_dev, status.st_ino, status.st_size, status.st_mtime_ns)
    if _examined.get(name, (None,))[0] != now:
        import h5py  # noqa: F401  in the parent, so that no child loads it again

        (answer,) = each(_walk, [path])
        _examined[name] = now, answer if isinstance(answer, Ended) and answer.number in DAMAGE else None
    if _examined[name][1]:
        raise Ended(_examined[name][1].number, str(path))


@contextlib.contextmanager
def reading(path, seconds=None):
    """Context in which HDF5 reads a file. In a child, time and memory are limited, and the parent gets the name of the
    file.

    In other processes a child first examines the file, once for each state of it.
    """
    if _note is None:
        _examine(path)
        yield
        return
    name = os.fsencode(path)[:NAME]
    _note[: len(name) + 1] = name + b"\0"
    used = resource.getrusage(resource.RUSAGE_SELF)
    seconds = math.ceil(used.ru_utime + used.ru_stime) + (seconds or SECONDS)
    try:
        with _silence(), _limits(RLIMIT_CPU=seconds, RLIMIT_AS=_addresses() + MEMORY):
            yield
    finally:
        _note[:1] = b"\0"


def _work(function, items, pipe):
    """Runs in the child: writes the results of the items, one after another, to the pipe."""
    resource.setrlimit(resource.RLIMIT_CORE, (0, resource.getrlimit(resource.RLIMIT_CORE)[1]))
    end_with_parent(signal.SIGKILL)
    for number in DAMAGE:
        signal.signal(number, signal.SIG_DFL)
    with os.fdopen(pipe, "wb") as out:
        for item in items:
            try:
                answer = pickle.dumps((True, function(item)))
            except Exception as error:
                answer = pickle.dumps((False, f"{type(error).__name__}: {error}"))
            out.write(answer)
            out.flush()
    for stream in (sys.stdout, sys.stderr):
        if stream:
            stream.flush()


def _start(function, items, note):
    """A child that works on the items: its process number, and the stream of its answers."""
    global _note
    source, sink = os.pipe()
    for stream in (sys.stdout, sys.stderr):
        if stream:
            stream.flush()  # otherwise the child would print it again
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # the threads of numerical libraries are idle here
        child = os.fork()
    if child:
        os.close(sink)
        return child, os.fdopen(source, "rb")
    code = 1
    try:
        os.close(source)
        _note = note
        _work(function, items, sink)
        code = 0
    except KeyboardInterrupt:
        code = 130
    finally:
        os._exit(code)  # the cleanup of the parent is not executed here


def each(function, items):
    """Returns function(item) of all items, in order, from a child process; Ended replaces a result if the child ended.

    The child has a copy of the present memory; its changes there are lost.
    """
    items, note = list(items), mmap.mmap(-1, NAME + 1)
    done = 0
    while done < len(items):
        note[:1] = b"\0"
        child, answers = _start(function, items[done:], note)
        wanted = True
        try:
            while done < len(items):
                try:
                    fine, value = pickle.load(answers)
                except (EOFError, pickle.UnpicklingError):
                    break
                if not fine:
                    raise RuntimeError(value)
                done += 1
                yield value
            wanted = False
        finally:
            answers.close()
            if wanted:
                with contextlib.suppress(ProcessLookupError):
                    os.kill(child, signal.SIGTERM)
            status = os.waitpid(child, 0)[1]
        if done < len(items):
            number = os.WTERMSIG(status) if os.WIFSIGNALED(status) else 0
            yield Ended(number, os.fsdecode(note[:].split(b"\0")[0]))
            done += 1

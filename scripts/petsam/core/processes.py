"""Jobs side by side, each in a process of its own with one thread: run(). Their results do not depend on how many."""

import concurrent.futures
import contextlib
import multiprocessing
import os
import queue
import sys
from collections.abc import Callable, Sequence
from typing import Any, Optional

TICK = 0.2  # s between two looks at what the jobs tell

_words: Any = None  # of a process of run(): what it tells goes here


def _begin(words):
    global _words
    os.environ["OMP_NUM_THREADS"] = "1"  # before the library is loaded
    _words = words


def _work(job):
    function, *given = job
    return function(*given, lambda *told: _words.put(told))


def run(
    jobs: Sequence[tuple], cores: int, told: Callable[..., object], done: Optional[Callable[[int], object]] = None
) -> list:
    """Returns the results of jobs in their order, computed in `cores` processes; 1: in this one. A job is a function of
    a module and its arguments, to which a function is added: `told` is called with all that it is called with, and
    `done` with the number of each job that has ended, from 0 on. If a job fails its exception is raised, and the others
    are given up."""
    done = done or (lambda k: None)
    if cores == 1 or len(jobs) == 1:
        found = []
        for k, (function, *given) in enumerate(jobs):
            found.append(function(*given, told))
            done(k)
        return found
    context = multiprocessing.get_context("spawn")  # MPI does not bear a fork
    words = context.Queue()
    pool = concurrent.futures.ProcessPoolExecutor(min(cores, len(jobs)), context, _begin, (words,))
    with pool:
        with _without_main():
            futures = [pool.submit(_work, job) for job in jobs]
        try:
            _follow(futures, words, told, done)
            return [future.result() for future in futures]
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            raise


@contextlib.contextmanager
def _without_main():
    """New processes do not run the main script again, which may have no guard against that."""
    main = sys.modules["__main__"]
    kept = {name: getattr(main, name) for name in ("__file__", "__spec__") if hasattr(main, name)}
    try:
        for name in kept:
            setattr(main, name, None)
        yield
    finally:
        for name, value in kept.items():
            setattr(main, name, value)


def _follow(futures, words, told, done):
    """Returns when all jobs have ended, or one has failed."""
    places, left = {future: k for k, future in enumerate(futures)}, set(futures)
    while left:
        ended, left = concurrent.futures.wait(left, TICK, concurrent.futures.FIRST_COMPLETED)
        try:
            while True:
                told(*words.get_nowait())
        except queue.Empty:
            pass
        for future in sorted(ended, key=places.get):
            future.result()
            done(places[future])

"""Printed lines of petsam-study: one per case, a summary, the failures."""

import os
import sys
import time

from ...core import progress
from ...core.errors import counted
from .runs import LOG, MEANINGS, STOPPED, WARNING, record


def standing(directory, case):
    """The status of a case in a word."""
    code = record(directory, case).get("exit_code", "")
    if code == 0:
        return "finished"
    return "not run" if code == "" else "interrupted" if code is None else f"exit {code}"


class Progress(progress.Progress):
    """A line for each case that ends, and on a terminal a line of progress."""

    def __init__(self, total, quiet):
        super().__init__("case")
        self.total, self.quiet = total, quiet
        self.done = self.failed = 0
        self.live, self.shown = sys.stdout.isatty() and not quiet, 0.0

    def _left(self):
        return self.left(self.done, self.total) if self.done else "?"

    def report(self, case, code):
        """A case has ended, or (None) is being run by another study."""
        self.done += 1
        self.failed += code not in (0, None)
        if self.quiet and code in (0, None):
            return
        end = "is being run by another study" if code is None else f"exit {code}"
        meaning = MEANINGS.get(code)
        print(
            "{}[{}/{}] {}  {}{}  ({} left)".format(
                "\r\033[K" if self.live else "",
                self.done,
                self.total,
                case.name,
                end,
                f" ({meaning})" if meaning else "",
                self._left(),
            ),
            flush=True,
        )

    def tick(self, running, waiting):
        """Refresh the terminal's last line."""
        if self.live and time.monotonic() - self.shown > 0.5:
            self.shown = time.monotonic()
            print(
                f"\r\033[K{running} running, {waiting} waiting, {self.done - self.failed} done, {self.failed} failed, "
                f"{self.since()} since the start, {self._left()} left",
                end="",
                flush=True,
            )

    def close(self):
        """Leave the terminal's last line empty."""
        if self.live:
            print("\r\033[K", end="", flush=True)


def warn(directory, cases):
    """Print how many finished cases have warnings, and the first one."""
    messages = [(case.name, record(directory, case).get("message", "")) for case in cases]
    warned = [(name, text[len(WARNING) :]) for name, text in messages if text.startswith(WARNING)]
    if warned:
        name, text = warned[0]
        print(
            f"petsam-study: warning: {len(warned)} of {counted(len(cases), 'case')} finished with warnings, the first "
            f"{name}: {text}; see all in {LOG} of each case, in {directory}",
            file=sys.stderr,
        )


def summary(directory, cases):
    """Print the status of all cases, failures with exit codes and messages; the study's exit code."""
    records = [(case, record(directory, case)) for case in cases]
    failed = [(case, known) for case, known in records if known.get("exit_code") not in (0, None, STOPPED)]
    stopped = sum(known.get("exit_code") == STOPPED for _, known in records)
    done = sum(known.get("exit_code") == 0 for _, known in records)
    print(
        "{}: {} finished, {} failed{}{}".format(
            counted(len(cases), "case"),
            done,
            len(failed),
            f", {stopped} stopped early" if stopped else "",
            f", {len(cases) - done - len(failed) - stopped} not run"
            if done + len(failed) + stopped < len(cases)
            else "",
        )
    )
    for case, known in failed:
        print(
            "  {}  exit {}: {}\n    see {}".format(
                case.name, known["exit_code"], known.get("message", ""), os.path.join(directory, case.name, LOG)
            )
        )
    if stopped:
        return STOPPED
    return 1 if failed or done < len(cases) else 0

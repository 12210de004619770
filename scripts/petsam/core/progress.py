"""How far a work is: Progress, whose lines all commands print, and clock(), a time as they write it."""

import sys
import time
from collections.abc import Callable
from typing import Optional

Say = Callable[[str], object]


def to_stderr(text: str) -> None:
    """Prints a line on stderr at once."""
    print(text, file=sys.stderr, flush=True)


def clock(seconds: float) -> str:
    """Returns a time in s as h:mm:ss, or m:ss."""
    minutes, rest = divmod(int(round(seconds)), 60)
    return f"{minutes}:{rest:02d}" if minutes < 60 else "{}:{:02d}:{:02d}".format(*divmod(minutes, 60), rest)


class Progress:
    """A line for each unit of a work that ends, with an estimate of the time left: "window 2 of 5, about 1:33 left".
    `what` is the noun of a unit, "window"; `say` is called with each line, at most once in `every` seconds, and not
    before these have passed; by default it prints the line on stderr at once, with None nothing."""

    def __init__(self, what: str, say: Optional[Say] = to_stderr, every: float = 0.0) -> None:
        self.form, self.say, self.every = what + " {} of {}", say, every
        self.start = self.last = time.monotonic()

    def begin(self, text: str, form: str = "") -> None:
        """Begins a part of the work, which the text names, with an estimate of its own. `form`: line of its units, with
        {} for the number that are done and {} for that of all."""
        self.form, self.start = form or self.form, time.monotonic()
        self._tell(text)

    def since(self) -> str:
        """Returns the time since the begin, as clock() writes it."""
        return clock(time.monotonic() - self.start)

    def left(self, done: int, total: int) -> str:
        """Returns the time that the other units take if they take as long as those that are done, at least one."""
        return clock((time.monotonic() - self.start) / done * (total - done))

    def estimate(self, seconds: float) -> None:
        """Prints the time left, s, which is known before the first unit has ended."""
        self._tell(f"about {clock(seconds)} left")

    def __call__(self, done: int, total: int, name: str = "") -> None:
        """Prints that a unit, which may have a name, has ended: the number of units done, and of all."""
        text = self.form.format(done, total) + (f": {name}" if name else "")
        self._tell(text + (f", about {self.left(done, total)} left" if done < total else ""))

    def _tell(self, text):
        now = time.monotonic()
        if self.say and now - self.last >= self.every:
            self.last = now
            self.say(text)

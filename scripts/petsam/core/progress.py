"""How far a work is: Progress, whose lines all commands print, and clock(), a time as they write it."""

import sys
import time
from collections.abc import Callable

Say = Callable[[str], object]


def clock(seconds: float) -> str:
    """A time as h:mm:ss, or m:ss.

    Parameters
    ----------
    seconds : float
        The time, s.

    Returns
    -------
    str
    """
    minutes, rest = divmod(int(round(seconds)), 60)
    return f"{minutes}:{rest:02d}" if minutes < 60 else "{}:{:02d}:{:02d}".format(*divmod(minutes, 60), rest)


def to_stderr(text: str) -> None:
    """Prints a line on stderr at once.

    Parameters
    ----------
    text : str
        The line.
    """
    print(text, file=sys.stderr, flush=True)


def quiet(_: str) -> None:
    """Prints nothing: in notebooks, and in functions that no command has called.

    Parameters
    ----------
    _ : str
        A line.
    """


class Progress:
    """A line for each unit of a work that ends, with an estimate of the time left: "window 2 of 5, about 1:33 left".

    Parameters
    ----------
    what : str
        Noun of a unit: "window".
    say : callable
        Called with each line.
    every : float
        Least time between two lines, and before the first one, s.
    """

    def __init__(self, what: str, say: Say = to_stderr, every: float = 0.0) -> None:
        self.form, self.say, self.every = what + " {} of {}", say, every
        self.start = self.last = time.monotonic()

    def begin(self, text: str, form: str = "") -> None:
        """A part of the work begins, with units and an estimate of its own.

        Parameters
        ----------
        text : str
            What the part is.
        form : str
            Line of its units, with {} for how many are done, and for all.
        """
        self.form, self.start = form or self.form, time.monotonic()
        self._tell(text)

    def left(self, done: int, total: int) -> float:
        """Time that the other units take, if they take as long as those that are done.

        Parameters
        ----------
        done, total : int
            Units that are done, at least one, and all.

        Returns
        -------
        float
            Time, s.
        """
        return (time.monotonic() - self.start) / done * (total - done)

    def estimate(self, seconds: float) -> None:
        """The time left is known before the first unit has ended.

        Parameters
        ----------
        seconds : float
            Time, s.
        """
        self._tell(f"about {clock(seconds)} left")

    def __call__(self, done: int, total: int, name: str = "") -> None:
        """A unit has ended.

        Parameters
        ----------
        done, total : int
            Units that are done, and all.
        name : str
            Name of the one that has ended.
        """
        text = self.form.format(done, total) + (f": {name}" if name else "")
        self._tell(text + (f", about {clock(self.left(done, total))} left" if done < total else ""))

    def _tell(self, text):
        now = time.monotonic()
        if now - self.last >= self.every:
            self.last = now
            self.say(text)

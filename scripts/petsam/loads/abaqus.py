"""Field output reports of Abaqus: CNORMF and CSHEARF at nodes, one table per part instance and frame.

Contact forces of a node are CNORMF + CSHEARF, on the body that has the node. The step times of several steps are added.
"""

import re

import numpy as np

from ..compliance.assembly import LABELS
from ..compliance.cards import folded
from ..core.errors import Error, short, there_are
from ..core.files import lines_of, text_of
from . import gathering
from .texts import KNOWN, MOVED, NORMAL, SHEAR, X

FRAME = re.compile(r"\s*Frame:\s*(.*)")
STEP = re.compile(r"\s*Step:\s*(.*?)\s*")
TIME = re.compile(r"Step Time\s*=\s*(\S+)")
PART = re.compile(r"\s*Field Output reported at nodes for (?:part|region):\s*(.*?)\s*")
RULE = re.compile(r"-{5,}")
END = re.compile(r"\s*(Minimum|Maximum|Total|\*{5,})")


def is_report(text):
    """True if a text is a field output report."""
    return "Field Output Report" in text or bool(re.search(r"CNORMF\.?\s*CNORMF1.*\n(.*\n){0,3}-{5,}", text))


class _Report:
    def __init__(self, path, lines, deck):
        self.path, self.lines, self.deck = path, lines, deck
        self.instances = [folded(name) for name in deck.instances] if deck else []
        self.columns, self.first = None, 0  # of the table that is read; number of the instance's first label
        self.step, self.base, self.time, self.last = None, 0.0, None, 0.0
        self.found, self.sets = [], {}
        self.part = ""
        for k, line in enumerate(lines):
            self._follow(k, line)

    def _follow(self, k, line):
        step, frame, part = STEP.fullmatch(line), FRAME.fullmatch(line), PART.fullmatch(line)
        if step:
            if self.step not in (None, step[1]):
                self.base = self.last
            self.step = step[1]
        elif frame:
            self._set_time(k, frame[1])
        elif part:
            self.part, self.columns = folded(part[1]), None
            self.first = self._first(k)
        elif RULE.fullmatch(line.strip()):
            self.columns = self._columns(k) or self.columns
        elif END.match(line):
            self.columns = None
        elif self.columns and line.strip():
            self._take(k, line.split())

    def _set_time(self, k, text):
        time = TIME.search(text)
        try:
            self.time = self.base + float(time[1])
        except (TypeError, ValueError):
            raise Error(f"{self.path}: line {k + 1}: the frame has no Step Time: report frames of a step") from None
        self.last = max(self.last, self.time)

    def _first(self, k):
        """The number before the first label of the part instance in the flat deck."""
        if not self.instances:
            return 0
        if self.part not in self.instances:
            meant = there_are(self.part, self.instances)
            raise Error(f"{self.path}: line {k + 1}: no instance {short(self.part)} in the deck{meant}")
        return LABELS * self.instances.index(self.part)

    def _columns(self, k):
        """{name: place in a line} by the head above a line of dashes; None of another line."""
        head = k - 1
        while head > 0 and self.lines[head - 1].strip():
            head -= 1
        words = self.lines[head].split()
        if not words or words[0].lower() != "node":
            return None
        names = [KNOWN.get(word.lower()) for word in words[1:]]
        found = {name: place for place, name in enumerate(names, 1) if name}
        twice = next((name for name in found if names.count(name) > 1), None)
        if twice:
            raise Error(f"{self.path}: line {head + 1}: has {twice} twice: report one frame per table")
        found["count"] = len(words)
        return found

    def _take(self, k, words):
        if len(words) != self.columns["count"]:
            raise Error(f"{self.path}: line {k + 1}: has {len(words)} words, the table's head {self.columns['count']}")
        if self.time is None:
            raise Error(f"{self.path}: line {k + 1}: no line `Frame: ... Step Time = ...` above: report the whole head")
        try:
            label = self.first + int(words[0])
            values = {name: float(words[place]) for name, place in self.columns.items() if name != "count"}
        except ValueError:
            raise Error(f"{self.path}: line {k + 1}: has a word that is no number: the file is damaged") from None
        if not all(np.isfinite(value) for value in values.values()):
            raise Error(f"{self.path}: line {k + 1}: has a number that is not finite: leave the node out")
        if all(name in values for name in NORMAL) or all(name in values for name in SHEAR):
            self.found.append((k + 1, label, self.time, values))
            self.sets.setdefault(self.part, set()).add(label)


def read(path, given):
    """The Forces of a report."""
    deck = gathering.of_deck(given, path) if given.deck else None
    report = _Report(path, lines_of(text_of(path)), deck)
    if not report.found:
        raise Error(f"{path}: has no CNORMF1 to 3 with Node Label: report the field outputs CNORMF and CSHEARF")
    length, force = given.size("length", path), given.size("force", path)
    rows, every = gathering.Rows(path, sets={name: some for name, some in report.sets.items() if name}), report.found
    rows.lines, rows.labels, rows.times = ([one[k] for one in every] for k in range(3))
    values = {name: np.array([one[3].get(name, 0.0) for one in every]) for name in (*NORMAL, *SHEAR)}
    normal, shear = (np.stack([values[name] for name in names], axis=1) for names in (NORMAL, SHEAR))
    rows.force, rows.more["normal"] = normal + shear, normal
    for name, names in (("displacement", MOVED), ("x", X)):
        if all(one in found[3] for found in every for one in names):
            rows.more[name] = np.array([[found[3][one] for one in names] for found in every])
    for name in ("cpress", "cshear1", "cshear2"):
        if all(name in found[3] for found in every):
            rows.more[name] = np.array([found[3][name] for found in every])
    x = None if "x" in rows.more else gathering.of_deck(given, path).nodes
    result = rows.forces(given, x, length, force)
    gathering.add_sets(result, deck)
    return result

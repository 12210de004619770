"""Field output reports of Abaqus: CNORMF and CSHEARF at nodes, as tables in text or as comma-separated values.

Contact forces of a node are CNORMF + CSHEARF, on the body that has the node. The step times of several steps are added.
Tables in text are those of a part instance or set at one frame, of all fields or of one each. Where the width of a page
is limited, further heads follow the first one, and the lines of a node follow each other. Fields without a value at a
node are NoValue.
"""

import re
from collections import Counter

import numpy as np

from ...core.decks import folded
from ...core.errors import Error, counted, short, there_are
from ...core.files import text_of
from ...core.texttable import Form
from . import gathering
from .texts import KNOWN, MOVED, NORMAL, SHEAR, STRESSES, X

FRAME = re.compile(r"\s*Frame:\s*(.*)")
STEP = re.compile(r"\s*Step:\s*(.*?)\s*")
TIME = re.compile(r"Step Time\s*=\s*(\S+)")
PART = re.compile(r"\s*Field Output reported at nodes for (?:part|region):\s*(.*?)\s*")
RULE = re.compile(r"\s*-{5,}\s*")
END = re.compile(r"\s*(Minimum|Maximum|Total|\*{5,}|Source\s+\d|Field Output |ODB:|Loc\s+\d)")
HEAD = 3  # lines of a head, at most
OF_PAIR = re.compile(r"\b(CNORMF|CSHEARF|CPRESS|CSHEAR[12])\s+([^\s/]+/[^\s.,]+)(?:[.-](\w+))?", re.I)
PRINTED = re.compile(r"THE FOLLOWING TABLE IS PRINTED|^1? *Abaqus .*\bDATE\b", re.M | re.I)
PLACES = {
    "node label": "label",
    "step": "step",
    "frame": "frame",
    "instance name": "part",
    "part instance name": "part",
}
REPORT = "report the field outputs CNORMF and CSHEARF at the position Unique Nodal"


def is_report(text):
    """True if a text is a field output report."""
    return "Field Output Report" in text or bool(re.search(r"CNORMF\.?\s*CNORMF1.*\n(.*\n){0,3}-{5,}", text))


def is_values(text):
    """True if a text is a field output report in comma-separated values."""
    head, _, rest = text.lstrip().partition("\n")
    words = {PLACES.get(word.lower()) for word in Form().words(head)}
    return {"label", "frame"} <= words and "Step Time" in rest.partition("\n")[0]


def is_printed(text):
    """True if a text is a data file (.dat)."""
    return bool(PRINTED.search(text))


def refuse_printed(path):
    """Raises Error about a data file."""
    raise Error(f"{path}: is a data file (.dat) of Abaqus, which has no contact forces of nodes: {REPORT}, of the .odb")


class _States:
    """Values of nodes over time, and sets of nodes."""

    def __init__(self, path, deck):
        self.path = path
        self.deck, self.instances = deck, [folded(name) for name in deck.instances] if deck else []
        self.bases, self.last = {}, 0.0  # total time at which each step begins; the latest one
        self.step, self.time, self.skips = "", None, False
        # {(label, time): (line, {name: value})}, {part or region: labels}, pairs, and steps whose first frame, the last
        # state of the step before, is left out
        self.found, self.sets, self.pairs, self.repeated = {}, {}, {}, set()

    def begin(self, step):
        """A step begins, or is continued: fields may be reported one after the other."""
        self.step = step
        self.bases.setdefault(step, self.last)

    def at(self, line, text):
        """A frame begins."""
        time = TIME.search(text)
        try:
            own = float(time[1])
        except (TypeError, ValueError):
            raise Error(f"{self.path}: line {line}: the frame has no Step Time: report frames of a step") from None
        base = self.bases.setdefault(self.step, self.last)
        self.time, self.skips = base + own, own == 0.0 < base
        self.last = max(self.last, self.time)
        if self.skips:
            self.repeated.add(self.step)

    def first(self, line, part):
        """The number before the first label of a part instance in the flat deck; `part` may name a set of it."""
        if not self.instances:
            return 0
        whole = part if part in self.instances else part.rpartition(".")[0]
        if whole not in self.instances:
            meant = there_are(part, self.instances)
            raise Error(f"{self.path}: line {line}: no instance {short(part)} in the deck{meant}")
        return self.deck.before(self.instances.index(whole))

    def without_pairs(self, line, head):
        """A head without the names of surfaces, which have to be those of one pair in all of the file."""
        for field, pair, _ in OF_PAIR.findall(head):
            other = self.pairs.setdefault(field.upper(), pair)
            if other != pair:
                raise Error(
                    f"{self.path}: line {line}: {field} of the surfaces {short(pair)}, above of {short(other)}: report "
                    "one pair of surfaces per file"
                )
        return OF_PAIR.sub(lambda one: one[3] or one[1], head)

    def columns(self, line, words):
        """Names of columns, None of those that are not used."""
        names = [KNOWN.get(word.lower()) for word in words]
        twice = next((name for name, count in Counter(filter(None, names)).items() if count > 1), None)
        if twice:
            raise Error(f"{self.path}: line {line}: has {twice} twice: report one frame per table")
        return names

    def take(self, line, part, label, words):
        """Takes the fields of a node: {name: word}."""
        if self.skips:
            return
        try:
            own = int(label)
            values = {name: float(word) for name, word in words.items() if word.lower() != "novalue"}
        except ValueError:
            raise Error(f"{self.path}: line {line}: has a word that is no number: the file is damaged") from None
        if not all(np.isfinite(value) for value in values.values()):
            raise Error(f"{self.path}: line {line}: has a number that is not finite: leave the node out")
        if not any(name in values for name in (*NORMAL, *SHEAR, *STRESSES)):
            return
        first, known = self.found.setdefault((self.first(line, part) + own, self.time), (line, {}))
        for name, value in values.items():
            if known.setdefault(name, value) != value:
                raise Error(
                    f"{self.path}: line {line}: node {own} has {name} {value:g} at time {self.time:g}, and "
                    f"{known[name]:g} by line {first}: report each frame once; of several parts give --deck"
                )
        self.sets.setdefault(part, set()).add(self.first(line, part) + own)


class _Report:
    """The tables of a report in text, read into states."""

    def __init__(self, states, lines):
        self.path, self.states, self.lines = states.path, states, lines
        self.part, self.columns = "", None  # of the table that is read; names of all of its columns
        self.counts, self.row, self.body = [], [], 0  # words of each line of a node; those read; first line below heads
        for k, line in enumerate(lines):
            if k >= self.body:
                self._follow(k, line)
        self._end(len(lines))

    def _follow(self, k, line):
        step, frame, part = STEP.fullmatch(line), FRAME.fullmatch(line), PART.fullmatch(line)
        if step:
            self.states.begin(step[1])
        elif frame:
            self.states.at(k + 1, frame[1])
        elif part:
            self._end(k)
            self.part = folded(part[1])
            self.states.first(k + 1, self.part)
        elif RULE.fullmatch(line):
            self._begin(k)
        elif END.match(line):
            self._end(k)
        elif self.columns and line.strip():
            self._take(k, line.replace("No Value", "NoValue").split())

    def _begin(self, rule):
        """Begins a table below the head above a line of dashes, if it is one of nodes."""
        head = rule - 1
        while head > 0 and self.lines[head - 1].strip():
            head -= 1
        words = self.states.without_pairs(head + 1, self.lines[head]).split()
        if not words or words[0].lower() != "node":
            return
        self.counts, line = [len(words)], head + 1
        while (rest := self._further(rule)) is not None:
            more = self.states.without_pairs(rule + 2, self.lines[rule + 1]).split()
            words, self.counts, rule = words + more, [*self.counts, len(more)], rest
        self.columns, self.row, self.body = self.states.columns(line, words), [], rule + 1

    def _further(self, rule):
        """The line of dashes below a further head; None if a node or nothing follows."""
        below = self.lines[rule + 1 : rule + 1 + HEAD + 1]
        if not below or not below[0].strip() or below[0].split()[0].isdigit():
            return None
        return next((rule + 1 + k for k, line in enumerate(below) if RULE.fullmatch(line)), None)

    def _end(self, k):
        """Ends a table."""
        if self.columns and self.row:
            raise Error(f"{self.path}: line {k}: node {short(self.row[0])} lacks words of its row: the file is damaged")
        self.columns = None

    def _take(self, k, words):
        done = [sum(self.counts[:n]) for n in range(len(self.counts))].index(len(self.row))
        if len(words) != self.counts[done]:
            heads = self.counts[done]
            raise Error(f"{self.path}: line {k + 1}: has {len(words)} words, the table's head {heads}")
        self.row += words
        if len(self.row) < len(self.columns):
            return
        row, self.row = self.row, []
        if self.states.time is None:
            raise Error(f"{self.path}: line {k + 1}: no line `Frame: ... Step Time = ...` above: report the whole head")
        self.states.take(k + 1, self.part, row[0], {name: word for name, word in zip(self.columns, row) if name})


def _read_values(states, lines):
    """Reads comma-separated values into states; each field, or each frame, may have its own head."""
    places, names, count = {}, [], 0
    for k, line in enumerate(lines, 1):
        words = Form().words(line)
        if not any(words):
            continue
        if any(PLACES.get(word.lower()) == "label" for word in words):
            words, count = Form().words(states.without_pairs(k, line)), len(words)
            places = {PLACES.get(word.lower()): place for place, word in enumerate(words)}
            names = states.columns(k, ["" if word.lower() in PLACES else word for word in words])
            continue
        if len(words) != count:
            raise Error(f"{states.path}: line {k}: has {len(words)} words, the head above {count}")
        states.begin(words[places["step"]] if "step" in places else "")
        states.at(k, words[places["frame"]])
        part = folded(words[places["part"]]) if "part" in places else ""
        states.take(k, part, words[places["label"]], {name: word for name, word in zip(names, words) if name})


def read(path, given):
    """The Forces of a report."""
    text = text_of(path)
    deck = gathering.of_deck(given, path) if given.deck else None
    states = _States(path, deck)
    if is_values(text):
        _read_values(states, text.split("\n"))
    else:
        _Report(states, text.split("\n"))
    return _forces(states, given, deck)


def _forces(states, given, deck):
    """The Forces of states."""
    path, every = states.path, [values for _, values in states.found.values()]
    _need_components(path, every)
    length, force = given.size("length", path), given.size("force", path)
    rows = gathering.Rows(path, sets={name: some for name, some in states.sets.items() if name})
    rows.lines = [line for line, _ in states.found.values()]
    rows.labels, rows.times = ([key[k] for key in states.found] for k in range(2))
    normal, shear = (np.array([[one.get(name, 0.0) for name in names] for one in every]) for names in (NORMAL, SHEAR))
    rows.force, rows.more["normal"] = normal + shear, normal
    for name, names in (("displacement", MOVED), ("x", X)):
        if all(one in values for values in every for one in names):
            rows.more[name] = np.array([[values[one] for one in names] for values in every])
    for name in STRESSES:
        if all(name in values for values in every):
            rows.more[name] = np.array([values[name] for values in every])
    x = None if "x" in rows.more else gathering.of_deck(given, path).nodes
    result = rows.forces(given, x, length, force)
    gathering.add_sets(result, deck)
    result.notes += _notes(states, every)
    return result


def _need_components(path, every):
    """Raises Error unless nodes have forces, with all components."""
    names = {name for values in every for name in values}
    if not names & set(NORMAL):
        raise Error(f"{path}: has no CNORMF1 to 3 with Node Label: {REPORT}")
    for some in (NORMAL, SHEAR):
        lacking = [name.upper() for name in some if name not in names]
        if 0 < len(lacking) < len(some):
            raise Error(f"{path}: has no {', '.join(lacking)}: report all three components")


def _notes(states, every):
    """Notes on frames that are left out, and on a friction that is not in the file."""
    notes = []
    if states.repeated:
        notes.append(
            f"the first frame of {counted(len(states.repeated), 'step')}, at step time 0, is the last one of the step "
            "before: left out"
        )
    if not any(name in values for values in every for name in SHEAR):
        notes.append("no CSHEARF in the file: the forces are without friction; report CSHEARF, too")
    return notes

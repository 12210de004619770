"""Forces of CalculiX: of nodes in .dat (*NODE PRINT, RF) and .frd (*NODE FILE, RF), of contact pairs in .dat (*CONTACT
PRINT, CF).

RF is the force of supports: nodes that have contact alone have none, as their contact elements count as elements. The
force of a contact pair, on its slave surface, is in .dat, with its moment; it counts as one node at the centre of
gravity of the contact area, with a couple.
"""

import re

import numpy as np

from ...core.errors import Error, short
from ...core.files import text_of
from . import gathering

PRINTED = re.compile(r"\s*(forces|displacements) \((?:fx,fy,fz|vx,vy,vz)\) for set (\S+) and time\s+(\S+)\s*")
PAIR = re.compile(r"\s*statistics for slave set (\S+), master set (\S+) and time\s+(\S+)\s*")
COUNTS = (6, 6, 3, 3)  # numbers below each title of a pair: force and moment, centre and normal, moment, area and force
WIDTH = 12  # columns of a number in .frd


def is_dat(text):
    """True if a text is a .dat with forces."""
    return bool(re.search(r"^\s*(forces \(fx,fy,fz\) for set|statistics for slave set) ", text, re.M))


def is_frd(text):
    """True if a text is a .frd."""
    return text.startswith("    1C")


def _number(path, line, word, kind=float):
    try:
        value = kind(word.replace("D", "E") if kind is float else word)
    except ValueError:
        value = np.nan
    if not np.isfinite(value):
        raise Error(f"{path}: line {line}: {short(word.strip()) or 'an empty word'} is no number: the file is damaged")
    return value


class _Dat:
    """The tables of a .dat: {(label, time): (line, vector)} of forces and displacements, and lines of contact pairs."""

    def __init__(self, path, lines):
        self.path, self.tables, self.sets, self.pairs = path, {"forces": {}, "displacements": {}}, {}, []
        block = None
        for number, line in enumerate(lines, 1):
            title, pair = PRINTED.fullmatch(line), PAIR.fullmatch(line)
            if title:
                block = (title[1], title[2], _number(path, number, title[3]))
            elif pair:
                self.pairs.append((number, pair[1], _number(path, number, pair[3]), []))
                block = "pair"
            elif line.strip() and block == "pair":
                if not re.search(r"[a-df-z]", line, re.I):
                    self.pairs[-1][3].append([_number(path, number, word) for word in line.split()])
            elif line.strip() and block:
                block = self._take(number, line.split(), *block)

    def _take(self, number, words, kind, name, time):
        """A line of a table; None where another table begins."""
        if re.match(r"[A-Za-z]", words[0]):
            return None
        if len(words) != 4:
            raise Error(f"{self.path}: line {number}: expected a node and three numbers: the file is damaged")
        label = _number(self.path, number, words[0], int)
        vector = [_number(self.path, number, word) for word in words[1:]]
        earlier = self.tables[kind].setdefault((label, time), (number, vector))
        if earlier[1] != vector:
            raise Error(
                f"{self.path}: line {number}: node {label} has other {kind} at time {time:g} in line {earlier[0]}: "
                "the file is of two analyses"
            )
        if kind == "forces":
            self.sets.setdefault(name, set()).add(label)
        return kind, name, time

    def of_nodes(self):
        """The Rows of the nodes."""
        found = self.tables["forces"]
        rows = gathering.Rows(self.path, sets=self.sets)
        rows.labels, rows.times = ([key[k] for key in found] for k in (0, 1))
        rows.lines, rows.force = ([value[k] for value in found.values()] for k in (0, 1))
        moved = self.tables["displacements"]
        if moved and all(key in moved for key in found):
            rows.more["displacement"] = [moved[key][1] for key in found]
        return rows

    def of_pairs(self):
        """The Rows of the contact pairs, one node each, and the places of these."""
        names = list(dict.fromkeys(name for _, name, _, _ in self.pairs))
        rows, x = gathering.Rows(self.path, sets={name: {k} for k, name in enumerate(names, 1)}), {}
        rows.more = {"normal": [], "couple": []}
        for line, name, time, numbers in self.pairs:
            if tuple(map(len, numbers[:4])) != COUNTS:
                raise Error(f"{self.path}: line {line}: its contact pair lacks numbers: the file is damaged")
            total, centre, _, last = (np.array(one) for one in numbers[:4])
            label = names.index(name) + 1
            at = x.setdefault(label, centre[:3])
            rows.labels.append(label)
            rows.times.append(time)
            rows.lines.append(line)
            rows.force.append(total[:3])
            rows.more["normal"].append(last[1] * centre[3:])
            rows.more["couple"].append(total[3:] - np.cross(at, total[:3]))
        return rows, x


def read_dat(path, given):
    """The Forces of a .dat."""
    dat = _Dat(path, text_of(path).split("\n"))
    length, force = given.size("length", path), given.size("force", path)
    if dat.pairs:
        rows, x = dat.of_pairs()
        found = rows.forces(given, x, length, force)
        also = ", those of nodes (RF) are left out" if dat.tables["forces"] else ""
        found.notes.append(f"forces are those of contact pairs on the slave surface{also}: --on names its body")
        return found
    deck = gathering.of_deck(given, path)
    found = dat.of_nodes().forces(given, deck.nodes, length, force)
    gathering.add_sets(found, deck)
    return found


class _Frd:
    """Coordinates {label: x}, and {(label, time): (line, vector)} of forces and displacements."""

    def __init__(self, path, lines):
        self.path, self.nodes, self.tables = path, {}, {"FORC": {}, "DISP": {}}
        self.table, self.time, self.width = None, None, 10
        for number, line in enumerate(lines, 1):
            self._follow(number, line)

    def _follow(self, number, line):
        key = line[:5].strip()
        if key in ("2C", "100C") or line.startswith("  100C") or line.startswith("    2C"):
            form = line[73:75].strip()
            if form not in ("0", "1"):
                raise Error(f"{self.path}: line {number}: is binary: write *NODE FILE, not *NODE OUTPUT")
            self.width = 5 if form == "0" else 10
            of_mesh = line.startswith("    2C")
            self.time = None if of_mesh else _number(self.path, number, line[12:24])
            self.table = self.nodes if of_mesh else None
        elif line.startswith(" -4"):
            self.table = self.tables.get(line[5:13].strip())
        elif line.startswith(" -3"):
            self.table = None
        elif line.startswith(" -1") and self.table is not None:
            label = _number(self.path, number, line[3 : 3 + self.width], int)
            first = 3 + self.width
            vector = [_number(self.path, number, line[first + WIDTH * k :][:WIDTH]) for k in range(3)]
            if self.table is self.nodes:
                self.nodes[label] = vector
            elif (label, self.time) in self.table:
                raise Error(
                    f"{self.path}: line {number}: node {label} has two vectors at time {self.time:g}, the first one "
                    f"in line {self.table[label, self.time][0]}: the file is of two analyses"
                )
            else:
                self.table[label, self.time] = (number, vector)


def read_frd(path, given):
    """The Forces of a .frd, whose mesh has the coordinates."""
    frd = _Frd(path, text_of(path).split("\n"))
    found = frd.tables["FORC"]
    if not found:
        raise Error(f"{path}: has no forces: write them by *NODE FILE with RF")
    length, force = given.size("length", path), given.size("force", path)
    rows = gathering.Rows(path)
    rows.labels, rows.times = ([key[k] for key in found] for k in (0, 1))
    rows.lines, rows.force = ([value[k] for value in found.values()] for k in (0, 1))
    moved = frd.tables["DISP"]
    if moved and all(key in moved for key in found):
        rows.more["displacement"] = [moved[key][1] for key in found]
    result = rows.forces(given, frd.nodes, length, force)
    gathering.add_sets(result, gathering.of_deck(given, path) if given.deck else None)
    return result

"""Random decks of one body: in many forms that mean the same, with cards that change it, and damaged.

Kinds: `sound`, the body in another form (encoding, parts and instances, units, includes, continued lines, generated
sets, cards without effect): the compliance must be the same; `changed`, a card, a parameter or a line that changes the
body or makes no sense: rejected with file, line and cure, or of no effect; `damaged`, bytes or lines that are lost,
repeated or spoiled: rejected with the file, or computed. An exception that is no petsam.Error, a run of 60 s or of more
than 4 GB, and another compliance without a word are faults.
"""

import collections
import os
import random
import re
import resource
import signal
import tempfile
from pathlib import Path

import numpy as np

import conftest  # noqa: F401
import petsam
from kinds import Outcome
from petsam.apps.compliance import command, keywords, mesh, model, stiffness

SECONDS, MEMORY = 60, 4 << 30
OPTIONS = dict(trials=200)
SAME = 1e-5  # relative difference of compliances that are the same; CalculiX writes fewer digits
PLACE = re.compile(r"[^\s:]+\.(inp|txt):\d+: ")
FILE = re.compile(r"[^\s:]+\.(inp|txt)(:\d+)?: ")
NAMES = ("LOW", "Unten", "B\u00f6den", "fu\u00df", "\u0434\u043d\u043e", "Set 1", "a-b_c")
GRID = np.linspace(-2.0, 2.0, 5)


def body(kind, length, stress):
    """A block in units of (length, stress) per m and Pa."""
    found = mesh.grid_mesh([GRID * 0.01, GRID * 0.01, (GRID + 2.0) * 0.01], kind, 7e10 * stress)
    found.nodes = found.nodes * length
    bottom = np.flatnonzero(found.nodes[:, 2] > 0.0399 * length)
    return found, bottom


def pieces(kind, length, stress, low, chance):
    """Lines of the mesh with its sets, and those of its material."""
    found, bottom = body(kind, length, stress)
    text = stiffness.model_lines(found)
    cut = next(k for k, line in enumerate(text) if line.startswith("*MATERIAL"))
    section = next(k for k, line in enumerate(text) if line.startswith("*SOLID"))
    lines = [*text[:cut], *text[section:], f"*NSET, NSET={low}", *_set(bottom + 1, chance)]
    top = [number for number, _ in found.surfaces["TOP"]]
    lines += ["*ELSET, ELSET=UPPER", *stiffness.numbers(top)]
    lines += ["*SURFACE, NAME=TOP, TYPE=ELEMENT", f"UPPER, S{found.surfaces['TOP'][0][1] + 1}"]
    return lines, text[cut:section]


def _set(numbers, chance):
    """Data lines of a set, in one of two orders."""
    numbers = list(numbers)
    if chance.random() < 0.5:
        chance.shuffle(numbers)
    return stiffness.numbers(numbers, chance.choice((1, 5, 8, 16)))


class Deck:
    """A random deck of the body, in one of its forms: lines, options and files beside it."""

    def __init__(self, chance, folder):
        self.chance, self.folder = chance, Path(folder)
        self.units = chance.choice(("m", "mm"))
        self.kind = chance.choice(("C3D8", "C3D20", "C3D20R"))
        length, stress = (1.0, 1.0) if self.units == "m" else (1e3, 1e-6)
        self.low = chance.choice(NAMES)
        self.frame = "0,0,0:1,0,0"
        self.fixed = [self.low]
        self.encoding = chance.choice(("utf-8", "utf-8-sig", "utf-16", "latin-1", "cp1252"))
        mesh_lines, material = pieces(
            self.kind, length, stress, f'"{self.low}"' if " " in self.low else self.low, chance
        )
        self.lines = ["*Heading", "a body", *mesh_lines, *material]
        if chance.random() < 0.5:
            self._instances(mesh_lines, material, length)
        self._without_effect()
        self.words = ["--units", self.units, "--patch", "20mm", "--degree", "2", "--no-stress", "--no-picture"]
        self.words += ["--stiffness", "calculix"] if chance.random() < 0.1 else []

    def _instances(self, mesh_lines, material, length):
        """The same as one or two instances, moved and turned about z."""
        chance = self.chance
        move, angle = np.array([chance.uniform(-1, 1) * length for _ in range(3)]), chance.choice((0.0, 30.0, 90.0))
        c, s = float(np.cos(np.radians(angle))), float(np.sin(np.radians(angle)))
        axis = ", ".join(f"{x!r}" for x in (*move.tolist(), *(move + [0, 0, 1]).tolist(), angle))
        instances = ["*Instance, name=One, part=Body", ", ".join(map(repr, move.tolist()))]
        instances += ([axis] if angle else []) + ["*End Instance"]
        self.frame = f"{float(move[0])!r},{float(move[1])!r},{float(move[2])!r}:{c!r},{s!r},0"
        self.fixed, prefix = [self.low], ""
        if chance.random() < 0.5:
            instances += [
                "*Instance, name=Two, part=Body",
                ", ".join(map(repr, (move + [5 * length, 0, 0]).tolist())),
                "*End Instance",
            ]
            prefix, self.fixed = "One.", [f"One.{self.low}", f"Two.{self.low}"]
        self.top = prefix + "TOP"
        self.lines = ["*Heading", "*Part, name=Body", *mesh_lines, "*End Part", "*Assembly, name=Assembly", *instances]
        self.lines += ["*End Assembly", *material]

    def _without_effect(self):
        """Adds cards without effect, comments, a step, empty lines; another case of keywords; continued keywords."""
        chance = self.chance
        for _ in range(chance.randrange(6)):
            name = chance.choice(sorted(keywords.IGNORED))
            self.lines += [f"*{name}", "1., 2.", "** a comment", ""]
        if chance.random() < 0.5:
            self.lines += ["*STEP, NLGEOM=NO", "*STATIC", "1., 1.", "*OUTPUT, FIELD, VARIABLE=PRESELECT", "*END STEP"]
        if chance.random() < 0.3:
            self.lines = [line.replace(", ", ",\n", 1) if line.startswith("*E") else line for line in self.lines]
        if chance.random() < 0.3:
            self.lines = [line.lower() if line.startswith("*") and line.isascii() else line for line in self.lines]

    def place(self, starts):
        """Index of a random line that begins so."""
        return self.chance.choice([k for k, line in enumerate(self.lines) if line.upper().startswith(starts)])

    def write(self):
        """Writes the file, perhaps as two; returns its words."""
        end = self.chance.choice(("\n", "\r\n"))
        lines = self.lines
        if len(lines) > 2 and self.chance.random() < 0.3:
            cut = self.chance.randrange(2, len(lines))
            self._text("rest.txt", end.join(lines[cut:]) + end)
            lines = [*lines[:cut], "*INCLUDE, INPUT=rest.txt"] if not lines[cut - 1].endswith(",") else lines
        self._text("a.inp", end.join(lines) + end)
        return self.all_words()

    def all_words(self):
        """The command line."""
        words = ["--mesh", str(self.folder / "a.inp"), "--contact", getattr(self, "top", "TOP"), *self.words]
        return [*words, "--frame", self.frame, *(word for name in self.fixed for word in ("--fixed", name))]

    def _text(self, name, text):
        try:
            data = text.encode(self.encoding)
        except UnicodeEncodeError:
            data = text.encode("utf-8")
        (self.folder / name).write_bytes(data)


# ---------------------------------------------------------------- kinds


def sound(deck):
    """Leaves the deck."""
    return "sound"


def _card(deck):
    name = deck.chance.choice(sorted(keywords.CURES))
    deck.lines.insert(deck.place("*MATERIAL"), f"*{name}, NAME=A\n1, 2, 3.")
    return f"*{name}"


def _misspelt(deck):
    at = deck.place(tuple(f"*{name}" for name in ("NODE", "ELEMENT", "NSET", "ELSET", "SURFACE", "MATERIAL", "SOLID")))
    word = deck.lines[at].partition(",")[0]
    k = deck.chance.randrange(2, len(word))
    changed = word[:k] + deck.chance.choice((word[k] + "Q", "", "Z")) + word[k + 1 :]
    deck.lines[at] = deck.lines[at].replace(word, changed, 1)
    return changed


def _parameter(deck):
    at = deck.place(("*NODE,", "*ELEMENT", "*NSET", "*ELSET", "*SURFACE,", "*ELASTIC", "*SOLID"))
    word = deck.chance.choice(
        (
            "INPUT=x",
            "LIBRARY=y",
            "SYSTEM=C",
            "OFFSET=3",
            "ORIENTATION=O",
            "MODULI=LONG TERM",
            "COMPOSITE",
            "CROP",
            "ELSE=Q",
        )
    )
    deck.lines[at] = deck.lines[at].rstrip(",\n") + f", {word}" if "\n" not in deck.lines[at] else deck.lines[at]
    return word


def _twice(deck):
    first, last = deck.place(("*NODE, NSET", "*NODE,NSET")), deck.place("*SOLID")
    how = deck.chance.choice(("mesh", "elements", "shifted"))
    chosen = deck.lines[first:last]
    if how != "mesh":
        chosen = chosen[next(k for k, line in enumerate(chosen) if line.upper().startswith("*EL")) :]
    if how == "shifted":
        text = "\n".join(chosen)
        head = re.match(r"(\*(?:[^\n]*,\n)?[^\n]*\n)", text)[0]
        rows = [line for line in "\n".join(chosen)[len(head) :].split("\n")]
        joined = " ".join(row if row.endswith(",") else row + ";" for row in rows).split(";")
        chosen = [head.rstrip("\n"), *(f"9{row.strip()}" for row in joined if row.strip())]
        chosen = [re.sub(r"((?:[^,]*,){8}) ", r"\1\n", line) if "\n" not in line else line for line in chosen]
    deck.lines[last:last] = chosen
    return f"{how} twice"


def _inside_out(deck):
    at = deck.place(("*ELEMENT, TYPE", "*ELEMENT,\nTYPE")) + 1
    while deck.lines[at].startswith("*") or "=" in deck.lines[at].split("\n")[-1]:
        at += 1
    words = [word.strip() for word in deck.lines[at].split(",")]
    words[1:5] = words[4:0:-1]
    deck.lines[at] = ", ".join(words)
    return "inside out"


def _units(deck):
    deck.words[1] = "m" if deck.units == "mm" else "mm"
    deck.words[3] = {"m": "20", "mm": "2e-5"}[deck.words[1]]
    return "units"


def _bomb(deck):
    low = '"' + deck.low + '"'
    (deck.folder / "self.inp").write_text("*INCLUDE, INPUT=self.inp\n")
    deck.lines.insert(
        deck.place("*MATERIAL"),
        deck.chance.choice(
            (
                "*NSET, NSET=X, GENERATE\n1, 100000000000, 0",
                "*INCLUDE, INPUT=/dev/zero",
                f"*INCLUDE, INPUT={deck.folder}/fifo",
                "*INCLUDE, INPUT=self.inp",
                f"*NSET, NSET=Y\n{low}x, {low}",
            )
        ),
    )
    return "bomb"


def changed(deck):
    """Changes the body."""
    return deck.chance.choice((_card, _card, _misspelt, _parameter, _twice, _inside_out, _units, _bomb))(deck)


def damaged(deck):
    """Spoils lines."""
    chance, lines = deck.chance, deck.lines
    for _ in range(chance.choice((1, 1, 2, 4))):
        k, how = chance.randrange(len(lines)), chance.randrange(6)
        if how == 0:
            del lines[k]
        elif how == 1:
            lines.insert(k, lines[chance.randrange(len(lines))])
        elif how == 2:
            at = chance.randrange(len(lines[k]) + 1)
            odd = chance.choice(
                ("1e400", "nan", ",", ",,", "*", "=", "\t", "\0", "\u6f22", "9" * 30, "-", "1_0", "\u0663")
            )
            lines[k] = lines[k][:at] + odd + lines[k][at + 1 :]
        elif how == 3:
            del lines[k + 1 :]
        elif how == 4:
            other = chance.randrange(len(lines))
            lines[k], lines[other] = lines[other], lines[k]
        else:
            lines[k] = lines[k][: chance.randrange(len(lines[k]) + 1)]
        if not lines:
            lines.append("")
    return "damaged"


KINDS = (sound, changed, damaged)


# ---------------------------------------------------------------- running


class TooLong(Exception):
    """A run of more than SECONDS."""


def _late(*_):
    raise TooLong(f"more than {SECONDS} s")


def computed(words):
    """(compliance, warnings), or (None, message) of what is rejected."""
    signal.signal(signal.SIGALRM, _late)
    signal.alarm(SECONDS)
    try:
        options = command.arguments(words)
        found = model.computed(options.mesh, options.settings).bodies[0]
        return found.compliance, [text for text in found.remarks if text.startswith("warning")]
    except (petsam.Error, OSError) as error:
        return None, str(error)
    finally:
        signal.alarm(0)


def reference(kind, found={}):  # noqa: B006
    """The compliance of the body with elements of a kind."""
    if kind not in found:
        with tempfile.TemporaryDirectory() as folder:
            lines, material = pieces(kind, 1.0, 1.0, "LOW", random.Random(1))
            Path(folder, "r.inp").write_text("\n".join([*lines, *material]) + "\n")
            words = ["--mesh", f"{folder}/r.inp", "--contact", "TOP", "--fixed", "LOW", "--frame", "0,0,0:1,0,0"]
            words += ["--patch", "20mm", "--degree", "2", "--no-stress", "--no-picture"]
            found[kind] = computed(words)[0]
            assert found[kind] is not None, computed(words)[1]
    return found[kind]


def judged(kind, compliance, said, exact):
    """Outcome of a deck, and whether it is a fault."""
    if compliance is None:
        if kind is sound:
            return "sound, rejected", True
        place = PLACE if kind is changed else FILE
        at = said.rpartition(": ")[2]
        lone = not place.search(said) and kind is changed and "Young's modulus" not in said
        return ("rejected without a place", True) if lone or not at else ("rejected", False)
    same = np.linalg.norm(compliance - exact) <= SAME * np.linalg.norm(exact)
    if same:
        return "the same compliance", False
    if said:
        return "warned", False
    return ("another compliance", kind is not damaged)


def trial(seed, folder, given=None):
    """What became of a deck: rejected, computed to the same compliance, or another one."""
    chance = random.Random(seed)
    kind = KINDS[seed % len(KINDS)]
    os.mkfifo(folder / "fifo")
    deck = Deck(chance, folder)
    what = kind(deck)
    words = deck.write()
    try:
        exact = reference(deck.kind)
        compliance, said = computed(words)
        outcome, fault = judged(kind, compliance, said, exact)
    except Exception as error:  # what no user may see
        outcome, fault, said = "exception", True, f"{type(error).__name__}: {error}"
    text = f"{kind.__name__}, {what}, {deck.encoding}, {deck.kind}: {outcome}: {said}".replace(str(folder), "")
    return Outcome(text, fault, dict(kind_of_deck=kind.__name__, outcome=outcome))


def begin():
    """Limits the memory."""
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))


def summary(found):
    counts = collections.Counter((one["kind_of_deck"], one["outcome"]) for one in found.values())
    return [f"{count:5d} {kind}: {outcome}" for (kind, outcome), count in sorted(counts.items())]

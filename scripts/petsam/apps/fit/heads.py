"""Heads of a laboratory's table: what each column is, its unit, and which are meant by displacement and force.

Where several columns have a unit that fits, their words decide: those of a normal load or of a depth are never
taken, those of a tangential one are preferred.
"""

import re
from typing import NamedTuple, Optional

from ...core import units
from ...core.errors import Error, short, there_are

QUANTITIES = {"displacement": "m", "force": "N", "time": "s", "energy": "J"}
EXAMPLES = {"m": "Displacement (um)", "N": "Force (N)"}
PER_LENGTH = re.compile(r".*N/(mm|m|cm|um)")
# what a column may be called: whole words, and those of three letters or more also within one
WORDS = {
    "m": (
        "displacement", "stroke", "position", "slip", "disp", "travel", "weg", "verschiebung", "auslenkung", "hub",
        "schlupf", "x", "d", "s", "u", "dx", "ux",
    ),
    "N": (
        "friction", "tangential", "force", "shear", "load", "kraft", "last", "reib", "q", "f", "t", "ft", "fx", "fr",
        "fq", "fn", "fz",
    ),
    "s": ("time", "zeit", "t"),
    "J": ("energy", "energie", "work", "arbeit", "e", "w"),
}  # fmt: skip
ALONG = ("friction", "tangential", "shear", "lateral", "reib", "quer", "schub", "tang", "q", "ft", "fx", "fr", "fq")
ACROSS = (
    "normal", "vertical", "vertikal", "depth", "tiefe", "wear", "verschlei\u00df", "verschleiss", "penetration",
    "clamp", "anpress", "preload", "vorlast", "fn", "fz", "z", "dz", "uz",
)  # fmt: skip


class Column(NamedTuple):
    """A column: its name, the unit of SI of its quantity ("" of none, None of an unknown unit), the size of its unit,
    its place, the unit as it is written, the whole head, and whether that is of name and unit as one: d_um."""

    name: str
    si: Optional[str]
    size: float
    place: int
    unit: Optional[str]
    cell: str
    joined: bool = False

    def fits(self, si):
        """True if it is of this quantity; of name and unit as one, if the name is, too: not cycle_N."""
        return self.si == si and (not self.joined or _means(self.name, si))

    def unclear(self, si):
        """True if it may be of this quantity by its name, but states no such unit."""
        return not self.fits(si) and (self.si in ("", None) or self.joined) and _means(self.name, si)

    def index(self):
        """True if the apparent unit may be an index of a symbol: F_N."""
        return self.joined and len(self.name) == 1


def _words(name):
    """The words of a name in small letters; F_N is fn, too."""
    words = re.findall(r"[^\W\d_]+", re.sub(r"(?<=[a-z])(?=[A-Z])", " ", name).lower())
    return {*words, *(a + b for a, b in zip(words, words[1:]) if len(a) == len(b) == 1), "".join(words)}


def _has(name, known):
    """True if a name has one of these words, long ones also within another."""
    words = _words(name)
    return any(one in words or len(one) > 2 and any(one in word for word in words) for one in known)


def _means(name, si):
    return _has(name, WORDS[si])


def _across(name):
    """True if a column is of the normal direction by its name."""
    return _has(name, ACROSS) and not _has(name, ALONG)


def _quantity(head):
    """Quantity of a head, and the size of its unit; "" of none, None of one that no column here is of."""
    si, size = head.measure
    if si == "N/m" or PER_LENGTH.fullmatch(head.unit or ""):
        return "N/m", 1.0
    return (si, size) if si in ("", *QUANTITIES.values()) else (None, 1.0)


def columns(path, heads):
    """The columns of the Heads of a table."""
    found = []
    for k, one in enumerate(heads):
        name, unit, cell, joined = one
        si, size = _quantity(one)
        if si == "N/m":
            raise Error(f"{path}: column {short(name)}: is a force per length, {unit}: multiply by the length")
        found.append(Column(name or cell or unit or "", si, size, k, unit, cell, joined))
    return found


def choose(path, what, found):
    """The column of a displacement or a force by its unit and its words."""
    si = QUANTITIES[what]
    fitting = [one for one in found if one.fits(si)]
    unclear = [one for one in found if one.unclear(si)]
    if unclear and all(one.index() for one in fitting):
        raise Error(
            f"{path}: column {short(unclear[0].cell)}: has no unit of {what} in the head, such as {EXAMPLES[si]}; "
            f"units are {units.names(si)}"
        )
    along = [one for one in fitting if not _across(one.name)]
    if not fitting:
        raise Error(
            f"{path}: no column of a {what}: name it with its unit, such as {what} [{'um' if si == 'm' else 'N'}]"
        )
    if not along:
        raise Error(
            f"{path}: column {short(fitting[0].name)}: is of the normal direction by its name, and no other has a unit "
            f"of {what}: give --{what} NAME, if it is the tangential one"
        )
    for known in ([one for one in along if _has(one.name, ALONG)], [one for one in along if _means(one.name, si)]):
        if len(known) == 1:
            return known[0]
    if len(along) > 1:
        names = ", ".join(short(one.name) for one in along)
        raise Error(f"{path}: columns {names} may be the {what}: choose one by --{what} NAME")
    return along[0]


def given(path, what, name, found):
    """The column of this name, with or without its unit."""
    si = QUANTITIES[what]
    chosen = [one for one in found if name.lower() in (one.cell.lower(), one.name.lower())]
    if not chosen:
        raise Error(f"{path}: --{what} {short(name)}: no such column{there_are(name, [one.name for one in found])}")
    if len(chosen) > 1:
        cells = ", ".join(short(one.cell) for one in chosen)
        raise Error(f"{path}: --{what} {short(name)}: may be {cells}: give the whole head, with its unit")
    if chosen[0].si != si:
        raise Error(f"{path}: column {short(chosen[0].name)}: has no unit of {what}; units are {units.names(si)}")
    return chosen[0]

"""Statements in the header of a text file about its map: unit of the heights, size, order of the rows.

A header is what stands before the numbers: comments, lines of text, lines that --skip-rows leaves out. It is read by
its words, as programs of instruments write them: "# Width: 80 um", "x-length = 80 um", "Value units: m", "[um]".
"""

import re
from typing import NamedTuple, Optional

from ...core.errors import Error, short
from ...core.texttable import Form
from ...core.units import NUMBER
from ...core.units import size as metres

X = {"x", "width", "breite", "largeur", "anchura", "ancho", "larghezza", "largura", "breedte", "bredd", "dx", "lx"}
Y = {"y", "height", "h\u00f6he", "hauteur", "altura", "alto", "altezza", "hoogte", "h\u00f6jd", "dy", "ly"}
WIDTHS, HEIGHTS = X - {"x", "dx", "lx"}, Y - {"y", "dy", "ly"}
PIXEL = {"pixel", "pixelsize", "step", "spacing", "scale", "dx", "dy", "cellsize", "increment", "resolution", "pitch"}
SIZE = {"size", "length", "range", "extent", "field", "scan", "lx", "ly"} | WIDTHS | HEIGHTS
FACTOR = {"scale", "factor", "bit2nm", "multiplier"}
UNIT = re.compile(
    r"unit|einheit|unidad|eenheid|enhet|jednot|\u0435\u0434\u0438\u043d\u0438\u0446|\u5358\u4f4d|\u5355\u4f4d"
)
OF_UNIT = re.compile(r"[\[(<]\s*([^\W\d]+)\s*[\])>]")  # x [um], z (nm)
PAIR = re.compile(rf"^({NUMBER})\s*([^\W\d]*?)\s*(?:[x\u00d7,*;/]|by|\s)\s*({NUMBER})\s*([^\W\d]*)$")
SINGLE = re.compile(rf"^({NUMBER})\s*[\[(]?([^\W\d]*)[\])]?$")
LENGTH = re.compile(rf"(?<![\w.]){NUMBER}\s*([^\W\d]+)")
QUANTITY = re.compile(rf"({NUMBER.replace(chr(92) + '.', '[.,]')})\s+([^\W\d]+)")  # 80 um, 80,5 um
AT_END = re.compile(r"[\[(<{/_,\s]\s*([^\W\d_]+)\s*[\])>}]?\s*$")  # x [um], x (um), x / um, x_um
ORDER = re.compile(r"\b(?:first (?:row|line)|origin)\b.*?\b(top|upper|bottom|lower)\b", re.IGNORECASE)


class Header(NamedTuple):
    """Statements of a header, lengths in m; None where it makes none."""

    unit: Optional[float] = None  # of the heights
    size: tuple = (None, None)  # along x, y
    pixel: tuple = (None, None)
    top: Optional[bool] = None  # whether the first row has the largest y
    mentioned: tuple = ()  # units of lengths in brackets, of whatever quantity
    unread: tuple = ()  # numbers and texts of lines about lengths that no rule understands
    lines: dict = {}  # of unit, x and y: the number of the line
    lateral: Optional[float] = None  # m of the unit of lengths along x and y without one


def _words(key):
    """The words of a key in small letters; x, y, z before a known word are words of their own: Xscale."""
    found = []
    for word in re.findall(r"[^\W\d_]+\d?(?:nm)?", key.lower()):
        if word[0] in "xyz" and word[1:] in PIXEL | SIZE | FACTOR | {"unit", "units"}:
            found.append(word[0])
            word = word[1:]
        found.append(word)
    return found


def _split(line):
    """Key and value of a line, "" and the line without a key."""
    line = line.strip().lstrip("#%;/*! \t").strip('" \t,;')
    found = re.match(r"([^\d:=\uff1a]*?[^\d:=\uff1a\s,;])\s*[:=\uff1a,;\t]+\s*(.+)$", line)
    found = found or re.match(rf"([^\W\d](?:[^\d:=,;]|\d(?!\s))*?)\s+({NUMBER}\s*[^\d]*)$", line)
    return (found[1], found[2].strip('" \t,;')) if found else ("", line)


def _unit_of(path, number, line, text):
    """Metres of a unit of the heights; Error where it is none of a length."""
    found = metres(text)
    if found is None:
        raise Error(
            f"{path}: line {number}: {short(line.strip())}: its values are in {short(text)}, not in a length: export "
            "the heights, or write their unit as m, mm, um or nm"
        )
    return found


class _Reader:
    def __init__(self, path, lateral=None):
        self.path, self.lateral = path, lateral
        self.unit = self.top = None
        self.numbers = {}  # (kind, axis): number, its unit, line
        self.mentioned, self.unread, self.keys, self.lines = [], [], set(), {}

    def read(self, number, line):
        """One line of the header."""
        key, value = _split(line)
        words = _words(key or line)
        order = ORDER.search(line)
        if order:
            self.top = order[1].lower() in ("top", "upper")
            return
        self.keys |= {words[0]} if len(words) == 1 else set()
        brackets = [one for one in OF_UNIT.findall(line) if metres(one)]
        self.mentioned += brackets
        if any(UNIT.search(word) or word.startswith("unit\u00e9") for word in words) and not re.match(NUMBER, value):
            self._read_unit(number, line, words, value.strip("[]()<>"))
        elif "z" in words and FACTOR & set(words) and re.match(NUMBER, value):
            self._refuse_factor(number, line, value)
        elif not self._read_numbers(number, line, words, value) and self._is_of_length(words, line):
            self.unread.append((number, line.strip()))

    def _read_unit(self, number, line, words, value):
        if {"x", "y", "xy", "lateral"} & set(words):
            self.lateral = metres(value)
            self.unread += [] if self.lateral else [(number, line.strip())]
            return
        unit = _unit_of(self.path, number, line, value)
        if self.unit not in (None, unit):
            raise Error(f"{self.path}: line {number}: {short(line.strip())}: an earlier line gives another unit")
        self.unit, self.lines["unit"] = unit, number

    def _refuse_factor(self, number, line, value):
        found = SINGLE.match(value)
        if not found or float(found[1]) != 1.0:
            raise Error(
                f"{self.path}: line {number}: {short(line.strip())}: is a factor of the heights, which is not applied: "
                "multiply them by it, and remove the line"
            )

    def _read_numbers(self, number, line, words, value):
        """Reads the size or the width of a pixel, along one axis or both; False if the line has none."""
        kind = "pixel" if PIXEL & set(words) else "size" if SIZE & set(words) else None
        axes = [d for d, names in enumerate((X, Y)) if names & set(words)]
        if not kind or {"z", "n", "points", "pixels", "number", "date"} & set(words):
            return False
        pair, single = PAIR.match(value), SINGLE.match(value)
        if pair and not axes:
            found = [(float(pair[1]), pair[2] or pair[4]), (float(pair[3]), pair[4])]
        elif single:
            found = [(float(single[1]), single[2])] * 2
        else:
            return False
        for d in axes if len(axes) == 1 else (0, 1):
            if found[d][1] and not metres(found[d][1]):
                return False
            self.numbers[kind, d] = (*found[d], number, line.strip())
        return True

    @staticmethod
    def _is_of_length(words, line):
        about = (PIXEL | SIZE) & set(words) and re.search(NUMBER, line)
        return bool(about or any(metres(one) for one in LENGTH.findall(line)))

    def result(self):
        """The Header."""
        found = {"size": [None, None], "pixel": [None, None]}
        for (kind, d), (value, unit, number, line) in self.numbers.items():
            scale = metres(unit) if unit else self.lateral or None
            if scale is None or not value > 0.0:
                self.unread += [(number, line)] if (number, line) not in self.unread else []
            else:
                found[kind][d] = value * scale
                self.lines.setdefault("xy"[d], number)
        # programs that write Width and Height so export images, whose first row is on top
        image = bool(self.keys & WIDTHS and self.keys & HEIGHTS)
        top = True if self.top is None and image else self.top
        sides = (tuple(found[kind]) for kind in ("size", "pixel"))
        mentioned, unread = tuple(dict.fromkeys(self.mentioned)), tuple(self.unread)
        return Header(self.unit, *sides, top, mentioned, unread, self.lines, self.lateral)


def stated(path, lines, lateral=None):
    """The Header of lines, each a number and a text; lateral: unit (m) of lengths along x and y that have none."""
    reader = _Reader(path, lateral)
    for number, line in lines:
        reader.read(number, line)
    return reader.result()


def of_gwyddion(path, lines):
    """The Header of Gwyddion's text, whose lines have words of any language; None of another text.

    After at most one line, the channel's, there are width, height and unit of the values, each with its name.
    """
    for k in (0, 1):
        three = lines[k : k + 3]
        if len(three) < 3 or not all(line.lstrip().startswith("#") for _, line in three):
            return None
        pairs = [re.split(r"\s*[:\uff1a]\s*", line.lstrip("# \t").strip(), maxsplit=1) for _, line in three]
        found = [QUANTITY.fullmatch(pair[1]) if len(pair) == 2 else None for pair in pairs]
        sizes = [metres(one[2]) if one else None for one in found[:2]]
        keys = {word for pair in pairs[:2] for word in _words(pair[0])}
        if all(sizes) and len(pairs[2]) == 2 and not found[2] and not keys & (PIXEL | {"x", "y", "z"}):
            unit = _unit_of(path, three[2][0], three[2][1], pairs[2][1])
            size = tuple(float(one[1].replace(",", ".")) * scale for one, scale in zip(found, sizes))
            rest = stated(path, [line for line in lines if line not in three])
            at = {name: number for name, (number, _) in zip(("x", "y", "unit"), three)}
            return rest._replace(unit=unit, size=size, top=True, lines=at)
    return None


def of_columns(path, lines, count):
    """The Header that the heads of so many columns give, x (and y) and the heights: `x [um],y [um],z [nm]`."""
    heights = 1 if count == 2 else 2  # the column of the heights, from 0
    for number, line in reversed(lines):
        words = Form().words(line.strip().lstrip("".join(Form.comments)).strip())
        found = OF_UNIT.findall(line)
        if len(words) == count or len(words) > count and len(found) <= heights:  # else blanks are within the heads
            found = [AT_END.search(" " + word) for word in words[:count]]
            found = [one[1] if one else None for one in found]
        if len(found) <= heights or not any(text and metres(text) for text in found):
            continue
        lateral = {metres(text) for text in found[:heights] if text and metres(text)}
        if len(lateral) > 1:
            raise Error(f"{path}: line {number}: its columns x and y have different units: bring them to one")
        text = found[heights]
        bracket = text and (metres(text) or re.search(r"[\[(<{]\s*" + re.escape(text), line))
        unit = _unit_of(path, number, line, text) if bracket else None
        return Header(unit, lateral=lateral.pop() if lateral else None, lines={"unit": number} if unit else {})
    return Header()


def size_of(path, header, n):
    """Size along x, y of n points there; None for an axis without one; Error where size and pixel do not agree."""
    sizes = []
    for d in (0, 1):
        ways = [header.size[d], header.pixel[d] and header.pixel[d] * n[d]]
        ways = [way for way in ways if way]
        if len(ways) == 2 and abs(ways[0] - ways[1]) > 1.5 / n[d] * ways[0]:
            raise Error(f"{path}: its header's size and pixel along {'xy'[d]} do not fit its {n[d]} points: correct it")
        sizes.append(ways[0] if ways else None)
    return tuple(sizes)

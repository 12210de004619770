"""Texts: one line per y, one number per x, and what headers of instruments and programs state of them."""

import re

import numpy as np

from ....core import units
from ....core.errors import Error, counted, short
from .. import headers
from ..basics import SAME
from .stated import Reader, Stated

SPIP = re.compile(r"file format\s*=\s*ascii", re.IGNORECASE)
NANOMETRE = 1e-9  # unit of lengths in SPIP's header


def unread(header):
    """Warnings of the lines of a header that no rule understands."""
    return tuple(
        f"line {number}: {short(line)}: is not understood: make sure that it agrees with the options"
        for number, line in header.unread
    )


def need_mentioned(path, header, unit):
    """Error where the units in a header's brackets do not contain that of the option."""
    if header.unit is None and header.mentioned and unit:
        if not any(np.isclose(units.size(name), unit, rtol=SAME, atol=0.0) for name in header.mentioned):
            raise Error(
                f"{path}: its header has {', '.join(header.mentioned)}, which contradicts --units: give the file's unit"
            )


def left_out(text):
    """Remarks about lines of a header, and about empty last columns but for that of a separator at the end of lines."""
    count, empty = text.table[1], text.empty_columns
    lines = (f"{counted(count, 'header line')} left out",) if count else ()
    return (*lines, f"{empty} empty last columns left out") if empty > 1 else lines


class Table(Reader):
    """Lines of numbers under a header that may state unit, size, pixel and the first row in any of its usual forms."""

    family = "table"
    states = ("unit", "size", "first row", "missing points")

    def recognizes(self, source):
        """Any text of a usual name."""
        return source.is_list

    def header(self, source):
        """The Header of the text."""
        return source.header()

    def read(self, source):
        """The lines as rows of a map."""
        path = source.path
        values, _, first = source.text.table
        header = self.header(source)
        need_mentioned(path, header, source.how.units)
        x, y = headers.size_of(path, header, values.shape[::-1])
        size = (x, y) if x and y else None
        doubts, empty = unread(header), source.text.empty_line()
        if empty:
            doubts += (f"line {empty} is empty: if it ends a map, leave out what follows it, or give each map a file",)
        return Stated(
            values, header.unit, size, top=header.top, remarks=left_out(source.text), doubts=doubts, sides=(x, y),
            lines={**header.lines, "values": first}, layout="text",
        )  # fmt: skip


class Gwyddion(Table):
    """Gwyddion's text: "# Width: 80 um", "# Height: 60 um", "# Value units: m" in any language, first row on top."""

    def recognizes(self, source):
        """By the three lines, whatever their words are."""
        return source.is_text and headers.of_gwyddion(source.path, source.text.header) is not None

    def header(self, source):
        """The three lines, and others as of any table."""
        return headers.of_gwyddion(source.path, source.text.header)


class Spip(Table):
    """SPIP's and other microscopes' "# File Format = ASCII": lengths without a unit are in nm."""

    def recognizes(self, source):
        """By its first line."""
        return source.is_text and any(SPIP.search(line) for _, line in source.text.header[:3])

    def header(self, source):
        """As of any table, in nm."""
        return source.header(NANOMETRE)

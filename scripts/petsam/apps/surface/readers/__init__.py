"""Readers of maps, one class a format: what it is recognized by, what it states, and the cure of what it rejects.

A new format is a class of stated.py's Reader in a module here, and a line in READERS. The first reader that recognizes
a file reads it; the last one takes all others.
"""

from .arrays import Npy
from .grids import Esri, Surfer
from .hdf import Hdf5
from .instruments import Instrument
from .points import Points, Profile, as_map
from .texts import Gwyddion, Spip, Table

READERS = (Npy(), Hdf5(), Esri(), Surfer(), Gwyddion(), Spip(), Points(), Profile(), Table(), Instrument())
FORMATS = tuple(dict.fromkeys(reader.family for reader in READERS))


def reader_of(source, family=None):
    """The reader of a file: the first of a family of formats, or of all, that recognizes it."""
    readers = [reader for reader in READERS if family in (None, reader.family)]
    return next((reader for reader in readers[:-1] if reader.recognizes(source)), readers[-1])


def stated_of(source, family=None):
    """The statements of a file about its map, and the family of its format; Error where the file contains none."""
    reader = reader_of(source, family)
    return as_map(source.path, reader.read(source)), reader.family

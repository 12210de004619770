"""Joints: what a structural analysis needs of a contact, and the structure itself.

interface   contact stiffness, damping and real contact area of a rough interface per area (interfaces.py)
conductance of heat or current, beside that stiffness (conductance.py); its cards: decks.py
structure   patches of contact in a linear structure (structure.py); pair: of a file of petsam-compliance (pair.py)
backbone    frequency and damping of a mode over its amplitude (backbone.py)
band        the same over the histories of assembly, and their scatter (band.py)
wear        what wear does to them over the cycles of a vibration (wear.py)
balance     its resonance, and the response to a harmonic force, by harmonic balance (balance.py)
saved       tables of all these from CSV (saved.py)
damper      under the platforms of turbine blades, pressed by its centrifugal force (damper.py)
adapters    contacts in other programs of harmonic balance: tmdsimpy, pyHarm (adapters/)
"""

from . import adapters
from .backbone import Backbone, backbone, shake
from .balance import Response, forced
from .band import Band, band
from .conductance import Conductors
from .damper import Damper, damper
from .interfaces import Interface, interface, mirrored, of_interface, of_windows
from .pair import Pair
from .saved import Saved, read
from .structure import NoSolution, Patch, Structure
from .sweep import BackboneWarning
from .wear import Wear, wear

__all__ = [
    "Backbone", "BackboneWarning", "Band", "Conductors", "Damper", "Interface", "NoSolution", "Pair", "Patch",
    "Response", "Saved", "Structure", "Wear", "adapters", "backbone", "band", "damper", "forced", "interface",
    "mirrored", "of_interface", "of_windows", "read", "shake", "wear",
]  # fmt: skip

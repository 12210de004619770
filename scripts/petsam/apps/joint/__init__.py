"""Joints: stiffness and damping of interfaces, and of vibrating structures with contacts.

interface   contact stiffness, damping and real contact area of a rough interface per area (interfaces.py, by ways.py);
            its columns, elements and cards (properties.py)
conductance of heat or current, beside that stiffness (conductance.py); its cards: decks.py
structure   patches of contact (patch.py) in a linear structure (assembly.py), and their steps (structure.py)
pair        such a structure of a file of petsam-compliance (pair.py)
backbone    frequency and damping of a mode over its amplitude (backbone.py)
band        the same over the histories of assembly, and their scatter (band.py)
wear        what wear does to them over the cycles of a vibration (wear.py)
element     a contact as a force element of a time integration or of a static solver (element.py)
balance     its resonance, and the response to a harmonic force, by harmonic balance (balance.py)
saved       tables of all these from CSV (saved.py)
"""

from ...core.part import Part

PART = Part(
    __name__,
    names={
        "properties": ("Interface",),
        "interfaces": ("interface", "mirrored", "of_interface", "of_windows"),
        "conductance": ("Conductors",),
        "failures": ("NoSolution",),
        "patch": ("Patch",),
        "structure": ("Structure",),
        "pair": ("Pair",),
        "element": ("Element",),
        "backbones": ("Backbone", "backbone", "shake"),
        "sweep": ("BackboneWarning",),
        "bands": ("Band", "band"),
        "wearing": ("Wear", "wear"),
        "balance": ("Response", "forced"),
        "saved": ("Saved", "read"),
    },
    see=("petsam-surface", "petsam"),
    pictures={
        "pictures": ("backbone", "band", "conductance", "interface", "joint_wear", "response", "saved", "slip_zones")
    },
    top=("Element",),
    report="report",
    tables={"read": ("pressure", "alpha", "assembly", "frequency", "cycles")},
)
__all__, __getattr__, __dir__ = PART.face()

"""Joints: what a structural analysis needs of a contact.

interface   contact stiffness, damping and real contact area of a rough interface per area (interface.py)
"""

from .interface import Interface, mirrored, of_interface, of_windows

__all__ = ["Interface", "mirrored", "of_interface", "of_windows"]

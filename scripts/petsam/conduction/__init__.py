"""Thermal and electrical conductance of contacts: constriction into the spots, films, gas or oil in the gap.

spots  the flux through given cells of contact: half-spaces, or one period of them
shape  of(): the conductance of a contact in process, or of a step of results
"""

from .shape import Conductance, of
from .spots import conduct

__all__ = ["Conductance", "conduct", "of"]

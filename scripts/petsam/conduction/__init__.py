"""Thermal and electrical conductance of contacts: constriction into the spots, layers, films, gas or oil in the gap.

layers  a conducting body with layers: the potential of a wave of the flux, and images below a half-space's surface
spots   the flux through given cells of contact: half-spaces, or one period of them
shape   of(): the conductance of a contact in process, or of a step of results
"""

from .layers import Body
from .shape import Conductance, of
from .spots import conduct

__all__ = ["Body", "Conductance", "conduct", "of"]

"""Thermal and electrical conductance of contacts: constriction into the spots, layers, films, gas or oil in the gap.

layers  a conducting body with layers: the potential of a wave of the flux, and images below a half-space's surface
spots   the flux through given cells of contact: half-spaces, or one period of them
shape   of(): the conductance of a contact in process, or of a step of results
"""

from ...core.part import Part

PART = Part(
    __name__, names={"layers": ("Body",), "shape": ("Conductance", "need_conducting", "of"), "spots": ("conduct",)}
)
__all__, __getattr__, __dir__ = PART.face()

"""Settling of a load history: the dissipated energy of each cycle over that of the last one."""

from ...core.part import Part

PART = Part(
    __name__,
    names={"settling": ("Settling", "settling")},
    pictures={"pictures": ("settled",)},
    tables={"Settling": ("settling_cycle",)},
)
__all__, __getattr__, __dir__ = PART.face()

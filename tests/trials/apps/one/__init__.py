"""Settling of a load history: the dissipated energy of each cycle over that of the last one."""

from ...core.part import Part

PART = Part(
    __name__,
    "settling of a load history",
    names={"settling": ("Settling", "read", "settling")},
    command="petsam-one",
    libraries=("numpy", "h5py", "matplotlib"),
    see=("petsam", "petsam-plot"),
    pictures={"pictures": ("settled",)},
    tables=("settling_cycle",),
)
__all__, __getattr__, __dir__ = PART.face()

"""Temperatures by frictional heat that changes in a cycle: fretting at a frequency.

kernels    the temperature of a half-space by a periodic flux, as a convolution in space and time
partition  the heat of a contact divided between two bodies over a whole cycle: temperatures, their means and flashes
friction   the frictional work of a cycle of results, cell by cell
"""

from ...core.part import Part

PART = Part(__name__, names={"friction": ("Work", "work"), "partition": ("Body", "Temperatures", "divided")})
__all__, __getattr__, __dir__ = PART.face()

"""The picture of a settling."""

from ...plot.style import plt
from .settling import Settling


def settled(found: Settling) -> plt.Figure:
    """Energies over the cycles."""
    figure, panel = plt.subplots()
    panel.plot(found.settling_cycle, found.ratio, "o")
    return figure

"""The picture of a settling."""

from matplotlib.figure import Figure

from ...plot.style import plt
from .settling import Settling


def settled(found: Settling) -> Figure:
    """Energies over the cycles.

    Parameters
    ----------
    found : Settling
        Of petsam.one.settling().

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, panel = plt.subplots()
    panel.plot(found.cycle, found.ratio, "o")
    return figure

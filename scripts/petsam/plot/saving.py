"""Pictures as files: the one place where all commands write them.

matplotlib is loaded when a picture is written, not before: a command reads its options without it.
"""

from ..core.errors import Error
from ..core.files import need_replaceable
from ..core.line import DPI

PIXELS = 300e6  # of a PNG at most: matplotlib holds them all


def write(figure, path, dpi=DPI):
    """Writes a figure in the format that the ending of its name gives, and closes it. Raises Error if the name is not
    that of a file, or if a PNG would have more than PIXELS."""
    from .style import STYLE, plt

    need_replaceable(path)
    width, height = (dpi * inches for inches in figure.get_size_inches())
    if path.lower().endswith(".png") and width * height > PIXELS:
        raise Error(f"{path}: {width:.0f} x {height:.0f} pixels are too many; see --dpi")
    with plt.rc_context(STYLE):  # of the ticks that are made now
        figure.savefig(path, dpi=dpi)
    plt.close(figure)

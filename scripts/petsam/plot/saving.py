"""Pictures as files: the one place where all commands write them, with the option of their resolution.

matplotlib is loaded when a picture is written, not before: a command reads its options without it.
"""

import argparse

from ..core.errors import Error, short
from ..core.files import need_replaceable

DPI = 150  # pixels per inch of a PNG: for the screen
RANGE = (10, 1200)
PIXELS = 300e6  # of a PNG at most: matplotlib holds them all


def resolution(text):
    """Reader of the pixels per inch for argparse."""
    try:
        value = int(text)
    except ValueError:
        value = 0
    if not RANGE[0] <= value <= RANGE[1]:
        raise argparse.ArgumentTypeError("{}: expected a whole number from {} to {}".format(short(text), *RANGE))
    return value


def add_resolution(group):
    """Adds --dpi to a group of options."""
    text = "pixels per inch of a PNG, {} to {} ({}); journals ask for 300".format(*RANGE, DPI)
    group.add_argument("--dpi", type=resolution, default=DPI, metavar="N", help=text)


def add_choice(group):
    """Adds --no-picture, and --dpi, which has no meaning beside it."""
    one = group.add_mutually_exclusive_group()
    one.add_argument("--no-picture", action="store_true", help="draw none")
    add_resolution(one)


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

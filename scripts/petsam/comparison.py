"""What the figure scripts of the examples share: style, tables, files, and the program around them."""
import argparse
import json
import os
import sys

import matplotlib
import numpy as np

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (the backend is chosen first)

STYLE = {
    "font.size": 10, "axes.grid": True, "grid.color": "0.92", "axes.axisbelow": True,
    "axes.spines.top": False, "axes.spines.right": False, "axes.titlesize": 11,
    "legend.frameon": False, "legend.fontsize": 8.5, "legend.title_fontsize": 9,
    "savefig.dpi": 150, "mathtext.fontset": "dejavusans",
}


class InputError(Exception):
    """A result that is missing, cannot be read, or lacks what the comparison needs."""


def relative_l2(numerical, exact):
    """sqrt(sum (numerical - exact)^2 / sum exact^2) over all cells."""
    return float(np.sqrt(np.sum((numerical - exact)**2) / np.sum(exact**2)))


def print_table(title, columns, rows):
    """Print rows (dicts) under a title; columns maps a heading to (key, format)."""
    print("\n" + title)
    print("  " + "".join("{:>14s}".format(heading) for heading in columns))
    for row in rows:
        print("  " + "".join("{:>14s}".format(form.format(row[key])) for key, form in columns.values()))


def save(figure, directory, name):
    """Write one PNG and close the figure."""
    path = os.path.join(directory, name)
    figure.savefig(path)
    plt.close(figure)
    print("wrote " + path)


def finish_numbers(options, numbers):
    """Write the numbers where --json asks for them; return the figures' directory, which then exists."""
    if options.json:
        with open(options.json, "w", encoding="utf-8") as file:
            json.dump(numbers, file, indent=2)
            file.write("\n")
    directory = options.figures or options.directory
    os.makedirs(directory, exist_ok=True)
    print()
    return directory


def main(run, description, example, arguments=None):
    """Parse the command line and call run(options).

    Exit code: 0, or 1 with a message when a file is missing, unreadable or cannot be written.
    """
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("directory", help="the HDF5 files of examples/{}/run.sh".format(example))
    parser.add_argument("--figures", metavar="DIR", help="write the PNG files here (default: the same directory)")
    parser.add_argument("--json", metavar="FILE", help="write the numbers to FILE too")
    try:
        run(parser.parse_args(arguments))
    except (InputError, OSError) as error:
        print("{}: error: {}".format(os.path.basename(sys.argv[0]), error), file=sys.stderr)
        return 1
    return 0

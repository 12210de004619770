"""Common parts of the examples' comparisons with other solutions: command line, tables, numbers as JSON, error norms.

A comparison is a class with

    __init__(directory)  reads the results that the example's run.sh writes to a directory
    numbers              all numbers of the tables, as JSON takes them
    tables()             yields the printed texts, and the tables as (title, columns, rows)
    draw(directory)      writes the pictures
"""

import argparse
import json
import os
import sys

import numpy as np

from petsam.core.errors import Error, Missing
from petsam.core.line import fail


def relative_l2(numerical, exact):
    """sqrt(sum (numerical - exact)^2 / sum exact^2) over all cells."""
    return float(np.sqrt(np.sum((numerical - exact) ** 2) / np.sum(exact**2)))


def nodal_l2(grid, name, nodes, spacing, reference, weight):
    """relative_l2() of a field in MPa against values of finite elements at nodes: (x, y) in mm, weight their areas.

    The force of a node is the mean with its shape function, so petsam's values are averaged with it: a hat of the
    spacing of the nodes in x and y. The problem is symmetric about y = 0.
    """
    from scipy.interpolate import RegularGridInterpolator

    values = RegularGridInterpolator((grid.y * 1e3, grid.x * 1e3), grid[name] / 1e6, bounds_error=False, fill_value=0.0)
    hat = [(at / 5.0, (1.0 - abs(at / 5.0)) / 5.0) for at in range(-4, 5)]
    mean, (x, y) = 0.0, nodes
    for dx, a in hat:
        for dy, b in hat:
            points = np.stack([np.abs(y + dy * spacing[1]), x + dx * spacing[0]], axis=1)
            mean = mean + a * b * values(points)
    return float(np.sqrt(np.sum(weight * (mean - reference) ** 2) / np.sum(weight * reference**2)))


def print_table(title, columns, rows):
    """Prints rows (dicts) under a title; columns: "heading = key:format; ...", with formats of format()."""
    columns = [column.split(" = ") for column in columns.split("; ")]
    widths = [max(14, len(heading) + 2) for heading, _ in columns]
    print("\n" + title)
    print("  " + "".join(f"{heading:>{width}s}" for (heading, _), width in zip(columns, widths)))
    for row in rows:
        cells = [format(row[key], form) for key, _, form in (place.partition(":") for _, place in columns)]
        print("  " + "".join(f"{cell:>{width}s}" for cell, width in zip(cells, widths)))


def _run(kind, options):
    """Reads the results, prints the tables, and writes the numbers and the pictures."""
    from petsam.plot.style import STYLE, plt

    comparison = kind(options.directory)
    for part in comparison.tables():
        print(part) if isinstance(part, str) else print_table(*part)
    if options.json:
        with open(options.json, "w", encoding="utf-8") as file:
            json.dump(comparison.numbers, file, indent=2)
            file.write("\n")
    directory = options.figures or options.directory
    os.makedirs(directory, exist_ok=True)
    print()
    with plt.rc_context(STYLE):
        comparison.draw(directory)


def main(kind, description, example, arguments=None):
    """The program of an example's comparison.

    Exit code: 0, or 1 with a message when a file is missing, unreadable or cannot be written.
    """
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("directory", help=f"the HDF5 files of examples/{example}/run.sh")
    parser.add_argument("--figures", metavar="DIR", help="write the PNG files here (default: the same directory)")
    parser.add_argument("--json", metavar="FILE", help="write the numbers to FILE too")
    try:
        _run(kind, parser.parse_args(arguments))
    except Missing as error:
        return fail(os.path.basename(sys.argv[0]), f"{error}; run examples/{example}/run.sh first", 1)
    except (Error, OSError) as error:
        return fail(os.path.basename(sys.argv[0]), error, 1)
    return 0

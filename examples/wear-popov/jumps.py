"""Print what implicit and explicit jumps of the Popov example cost, and how far they end from each other.

Reads jumps_implicit.h5 and jumps_explicit.h5, which `examples/wear-popov/run.sh jumps` writes to a directory. Exit code
1 when explicit jumps do not need more cycles, or when the depths differ by more than 0.05 in relative L2. The largest
difference is shown but not held: at the stick radius it depends on a cell's slipping or not.
"""

import argparse
import os
import sys

import numpy as np

import petsam
from petsam.comparison import print_table, relative_l2
from petsam.errors import fail

ALLOWED = 0.05  # relative L2: five times the tolerance of a jump, as their errors add up


def numbers(results, name):
    """How a life ended."""
    end = {key: float(results.file["wear"][key][-1]) for key in ("cycle", "computed", "volume1", "depth_max1")}
    return {"jumps": name, **end, "load_n": float(results.history["load_n"][-1])}


def compare(directory):
    """Print both lives; whether they are as they should be."""
    lives = {name: petsam.open(os.path.join(directory, f"jumps_{name}.h5")) for name in ("implicit", "explicit")}
    rows = [numbers(results, name) for name, results in lives.items()]
    columns = "jumps = jumps; cycles = cycle:.0f; computed = computed:.0f; volume, m3 = volume1:.4e"
    columns += "; depth, m = depth_max1:.4e; N, N = load_n:.2f"
    print_table("tau = 10, nu = 0.3, 40 steps per cycle", columns, rows)
    depths = [results.field("wear_depth1") for results in lives.values()]
    difference = relative_l2(*depths)
    largest = float(np.max(np.abs(depths[0] - depths[1])) / np.max(depths[1]))
    ok = difference < ALLOWED and rows[0]["computed"] < rows[1]["computed"]
    said = f"depths differ by {difference:.1e} (relative L2; {ALLOWED:g} is allowed), in a cell by {largest:.1e}"
    print(f"\ncheck: {said}; implicit is cheaper: {'passed' if ok else 'FAILED'}")
    return ok


def main():
    """The program."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("directory", help="the HDF5 files of `examples/wear-popov/run.sh jumps`")
    try:
        return 0 if compare(parser.parse_args().directory) else 1
    except petsam.Error as error:
        return fail(os.path.basename(sys.argv[0]), error, 1)


if __name__ == "__main__":
    sys.exit(main())

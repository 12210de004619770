#!/usr/bin/env python3
"""Write the separation of a long punch for petsam's -gap_type file.

The base is flat over |x| <= c, |y| <= L; beyond it, with d the distance from that rectangle, h = d^2/(2 R). So the
section at y = 0 is the plane punch, and the ends are rounded as the sides are. With --sharp the punch is cut off at
|y| = L instead. The cells are those of -grid_n NX,NY -grid_size WX,WY with the centre at 0.
"""

import argparse

import h5py
import numpy as np

FAR = 1.0  # m: beyond the reach of any contact


def main():
    """Write /height (ny, nx), m, with the geometry as attributes."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file")
    parser.add_argument("--n", nargs=2, type=int, required=True, metavar=("NX", "NY"), help="cells")
    parser.add_argument("--size", nargs=2, type=float, required=True, metavar=("WX", "WY"), help="full width, m")
    parser.add_argument("--flat", nargs=2, type=float, required=True, metavar=("C", "L"), help="half width, length, m")
    parser.add_argument("--edge-radius", type=float, required=True, metavar="R", help="m")
    parser.add_argument("--sharp", action="store_true", help="ends cut off, not rounded")
    options = parser.parse_args()

    x, y = (((np.arange(n) + 0.5) / n - 0.5) * size for n, size in zip(options.n, options.size))
    beyond_x, beyond_y = (np.clip(np.abs(z) - flat, 0.0, None) for z, flat in zip((x, y), options.flat))
    end = np.where(beyond_y > 0.0, FAR, 0.0) if options.sharp else beyond_y**2 / (2.0 * options.edge_radius)
    with h5py.File(options.file, "w") as file:
        height = file.create_dataset("height", data=end[:, None] + beyond_x**2 / (2.0 * options.edge_radius))
        height.attrs.update(
            {
                "units": "m",
                "flat_half_width": options.flat[0],
                "flat_half_length": options.flat[1],
                "edge_radius": options.edge_radius,
                "sharp_ends": options.sharp,
            }
        )


if __name__ == "__main__":
    main()

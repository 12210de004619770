"""Spikes of an instrument: a few points far from all their neighbours.

A height is compared with the median of its 5 x 5 neighbours. It is a spike where this difference is FAR times the
larger of two robust deviations: of the differences around it, and of all of the map. Both are medians, so that spikes
do not hide one another. Larger groups of such points are steps, pits or scratches of the surface, and stay.
"""

import numpy as np

WINDOW = 5  # cells along x and y
FAR = 10.0  # standard deviations of Gaussian differences: by chance one of 1e23
GAUSS = 1.4826  # standard deviation over the median of absolute deviations of Gaussian numbers
LARGEST = 6  # points of a spike, which may touch at corners
ROUNDING = 1e-12  # of peak to valley, that a plane's differences are of


def found(values):
    """Returns True for each of the values (ny, nx) that is a spike; missing ones (NaN) are none."""
    from scipy.ndimage import label, median_filter

    holes = np.isnan(values)
    if np.all(holes) or max(values.shape) < WINDOW:
        return np.zeros(values.shape, dtype=bool)
    whole = np.where(holes, np.nanmedian(values), values)
    window = tuple(WINDOW if n >= WINDOW else 1 for n in values.shape)
    border = [(n // 2, n // 2) for n in window]
    inner = tuple(slice(n // 2, n // 2 + m) for n, m in zip(window, values.shape))
    # a tilt goes on beyond the border, where it would else be far from its neighbours
    beyond = np.pad(whole, border, mode="reflect", reflect_type="odd")
    apart = np.abs(whole - median_filter(beyond, size=window)[inner])
    around = median_filter(apart, size=window, mode="nearest")
    least = max(float(np.median(apart[~holes])), ROUNDING * float(np.ptp(whole)))
    far = ~holes & (apart > FAR * GAUSS * np.maximum(around, least))
    groups, count = label(far, structure=np.ones((3, 3)))
    sizes = np.bincount(groups.ravel(), minlength=count + 1)
    return far & (sizes[groups] <= LARGEST)

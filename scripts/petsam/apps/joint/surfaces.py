"""Surfaces of petsam-joint stiffness, read as petsam-surface and petsam read them, and what they can bear."""

import numpy as np

from ...closed.materials import Bodies
from ...core.errors import Error, Missing, Unusable
from ..surface import read_hdf5

AREA = 0.01  # cells of expected contact below which a pressure is no pressure of the surface
FRICTIONS = (1e-4, 5.0)  # range of coefficients of friction


def read_separation(path):
    """Separation (m) of a file of petsam-surface, the distance of its points along x and y, and texts of doubts.

    Units, quantity and axes are those that the file states. Without units lengths are in m, as petsam takes them.
    """
    try:
        stated = read_hdf5(path, bare=True)
    except Missing:
        raise
    except Error as error:
        reason = str(error).removeprefix(f"{path}: ")
        raise Error(f"{path}: no surface of petsam-surface, which makes one of a scan: {reason}") from error
    values = stated.values.astype(float) * (stated.unit or 1.0)
    count = values.size - np.isfinite(values).sum()
    for wrong, text in (
        (count, f"has no number at {count} of {values.size} points; see petsam-surface --fill"),
        (min(values.shape) < 4, f"has {values.shape[0]} x {values.shape[1]} points, fewer than 4 x 4"),
        (stated.size is None, "has neither axes x and y beside it nor an attribute size"),
    ):
        if wrong:
            raise Error(f"{path}: no surface of petsam-surface: /{stated.name} {text}")
    doubts = []
    if stated.quantity is None and stated.name != "separation":
        doubts.append(
            f"{path}: /{stated.name} has no attribute quantity: taken for heights, peaks positive, but petsam takes it "
            "for a separation: write height1, height2 or separation"
        )
    heights = (stated.quantity or stated.name) != "separation"
    values = values[::-1] if stated.top else values
    spacing = tuple(side / n for side, n in zip(stated.size, values.shape[::-1]))
    return (-values if heights else values), spacing, doubts


def modulus(bodies):
    """E* of the options of two bodies, Pa; 0 where they do not have all, or are rigid both."""
    constants = [bodies.get(f"body{k}_{name}") for k in "12" for name in ("young", "poisson")]
    if None in constants:
        return 0.0
    return Bodies(*constants).e_star if any(map(np.isfinite, constants[::2])) else 0.0


def need_fitting(separation, step, pressures, friction, bodies):
    """Error where pressures do not fit the bodies and the slope of the surface, or friction is none: wrong units."""
    if friction is not None and not FRICTIONS[0] <= friction <= FRICTIONS[1]:
        low, high = FRICTIONS
        raise Unusable(
            f"friction {friction:g}: use a coefficient from {low:g} to {high:g}, such as 0.4: not in per cent"
        )
    star = modulus(bodies)
    slopes = [np.diff(separation, axis=1 - d) / step[d] for d in (0, 1)]
    slope = np.sqrt(sum(np.mean(one**2) for one in slopes))
    if not star or not slope > 0.0:
        return
    if pressures[-1] > star:
        raise Unusable(
            f"pressures: {pressures[-1]:.6g} Pa: all of the surface touches, as it is above E* = {star:.4g} Pa: check "
            "the units of both"
        )
    # real contact area of random roughness under small pressures: 2 p / (E* slope) of the nominal one
    least = 0.5 * star * slope * AREA / separation.size
    if pressures[0] < least:
        raise Unusable(
            f"pressures: {pressures[0]:.6g} Pa is {pressures[0] / (star * slope):.2g} of E* times the rms slope, "
            f"{slope:.3g}: less than {AREA:g} of a point of the surface would touch: check the units (20MPa), or give "
            f"more than {least:.2g} Pa"
        )

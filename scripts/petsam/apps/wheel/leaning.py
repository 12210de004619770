"""How far the head of a rail leans, and the warning of one that is turned, mirrored or canted twice."""

import warnings

import numpy as np

from .profile import ProfileWarning

OUTWARD, INWARD = 0.02, 0.1  # rad by which a rail's head may lean away from the middle, and towards it
TWICE = 0.6  # of the cant: a head that leans by so much without it was drawn or measured in its place
HALF = 5e-3  # m: of the chord by which the slope of a head is found, which noise does not change
TURNS = 3  # of the head to its own axes
SHALLOW = 3e-3  # m below the top: both sides of a head are seen down to there where its lean is judged


def _lean(section, depth):
    """Inclination of a rail's head away from the middle, rad: its slope in the middle of its width at a depth below the
    top, or where the shorter side ends, in the head's own axes; None where a side is not seen."""
    lean = 0.0
    for _ in range(TURNS):
        c, s = np.cos(lean), np.sin(lean)
        y, z = c * section.y + s * section.z, c * section.z - s * section.y
        k = int(np.argmin(z))
        down = min(depth, *(float(np.max(part - z[k])) for part in (z[: k + 1], z[k:])))
        if down < SHALLOW:
            return None
        deep = z - z[k] >= down
        middle = 0.5 * (y[int(np.flatnonzero(deep[: k + 1])[-1])] + y[k + int(np.flatnonzero(deep[k:])[0])])
        near = abs(y - middle) < 2.0 * HALF
        lean += float(np.arctan2(np.diff(np.interp(middle + np.array([-HALF, HALF]), y[near], z[near]))[0], 2.0 * HALF))
    return lean


def doubt_lean(profile, section, cant, depth):
    """Warns of a rail whose head leans away from the middle, far towards it, or by its cant without it."""
    lean = _lean(section, depth)
    if lean is None or cant < 0.0:  # a negative cant has its own warning
        return
    own = lean + cant
    if own > OUTWARD:
        text = f"away from the middle by {_ratio(own)}: is it mirrored? {profile.taken.other_y(profile.kind)}"
    elif cant > 0.0 and -own > max(TWICE * cant, OUTWARD):
        text = (
            f"towards the middle by {_ratio(own)} in its points, and by {_ratio(lean)} with the cant: is it canted "
            "twice? Measured in its place, it is read without cant="
        )
    elif lean < -INWARD:
        text = (
            f"towards the middle by {_ratio(lean)}, more than 1:10: check whether it is turned, and take it "
            "without cant= if it was measured in its place"
        )
    else:
        return
    warnings.warn(f"{profile.name}: the rail's head leans {text}", ProfileWarning, stacklevel=4)


def _ratio(angle):
    return f"1:{abs(1.0 / np.tan(angle)):.2g}"

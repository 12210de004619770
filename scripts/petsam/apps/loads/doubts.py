"""Remarks about a history: rows without contact, nodes that pull, moments beyond the patch, nodes off the plane, forces
that cancel, patches that move or turn."""

import numpy as np

from ...core.errors import counted
from ...core.units import shown

PULL = 1e-6  # of the largest force of a node: smaller pulls are rounding
CANCEL = 0.05  # resultant over the sum of the nodes' forces, below which two bodies' nodes may be in the patch
OFF = 0.01  # of the patch's larger extent: nodes off the plane, and motion
TURN = 2e-3  # rad


def pulling(normal):
    """Mask (n, m) of the nodes whose normal forces (n, m) pull."""
    return normal < -PULL * np.max(np.abs(normal))


def _rows(found, mask):
    """The first row of a mask with its time, and how many more there are."""
    first, more = int(np.argmax(mask)), int(np.count_nonzero(mask)) - 1
    others = f" and in {counted(more, 'more row')}" if more else ""
    return first, f"in row {first + 1} (time {found.times[first]:g} s){others}"


def of(found, force, x):
    """The remarks about a History; force (n, m, 3), x (m, 3) or (n, m, 3): of its nodes in the frame."""
    return [
        text
        for text in (
            _open(found), _pull(found), _cancelled(force), _beyond(found), _off_plane(found), _motion(found, x),
        )
        if text
    ]  # fmt: skip


def _open(found):
    n = found.loads[:, 0]
    pulls = n < -PULL * np.max(n)
    if np.any(pulls):
        first, where = _rows(found, pulls)
        return (
            f"the normal force turns to pull {where}, N = {n[first]:.4g} N: remove the rows, or give petsam the "
            "surfaces' -adhesion_work"
        )
    return None


def _pull(found):
    mask = pulling(found.normal)
    some = np.any(mask, axis=1)
    if not np.any(some):
        return None
    _, where = _rows(found, some)
    pull = -np.sum(np.where(mask, found.normal, 0.0), axis=1)
    most = int(np.argmax(pull))
    return (
        f"nodes pull {where}: up to {counted(int(mask.sum(axis=1).max()), 'node')}, {pull[most]:.3g} N in row "
        f"{most + 1}: a tie, an edge outside of the contact, or nodes of the other body"
    )


def _cancelled(force):
    total, parts = np.linalg.norm(force.sum(axis=1), axis=1), np.linalg.norm(force, axis=2).sum(axis=1)
    row = int(np.argmax(parts))
    if total[row] >= CANCEL * parts[row]:
        return None
    return (
        f"the resultant in row {row + 1} is {total[row] / parts[row]:.1e} of the sum of the nodes' forces: the patch "
        "may have nodes of both bodies: name a set of one body"
    )


def _beyond(found):
    low, high = found.extent
    if found.x.shape[0] < 3 or not np.max(high - low) > 0.0:
        return None  # a contact pair, whose extent is not known
    slack = 1e-6 * np.max(high - low)
    center = found.center
    with np.errstate(invalid="ignore"):
        out = np.any((center < low - slack) | (center > high + slack), axis=1)
    if not np.any(out):
        return None
    first, where = _rows(found, out)
    at = ", ".join(f"{name} = {shown(value)}" for name, value in zip("xy", center[first]))
    return (
        f"the resultant leaves the patch {where}, at {at}: no pressure has such moments: move the "
        "origin, or name another set"
    )


def _off_plane(found):
    size, off = np.max(np.ptp(found.extent, axis=0)), float(np.max(np.abs(found.x[:, 2])))
    if off <= OFF * size or not off > 0.0 or found.x.shape[0] < 3:
        return None
    return (
        f"nodes are up to {shown(off)} off the plane of the frame: their tangential forces add to M_x and M_y: move "
        "the origin onto the surface, or use a smaller patch of a curved one"
    )


def _motion(found, x):
    """The largest rigid motion of the nodes since the first row."""
    if x.ndim == 2:
        return None
    size = np.max(np.ptp(x[0], axis=0))
    shift = x.mean(axis=1) - x[0].mean(axis=0)
    way = np.linalg.norm(shift, axis=1)
    angle = np.array([_angle(x[0], one) for one in x])
    moves, turns = bool(np.max(way) > OFF * size), bool(np.max(angle) > TURN)
    if not (moves or turns):
        return None
    row = int(np.argmax(way if moves else angle))
    along = ", ".join(f"{shown(value)} in {name}" for name, value in zip("xyz", shift[row]))
    texts = [f"moves by {along}"] * moves + [f"turns by {np.degrees(np.max(angle)):.3g} degrees"] * turns
    return (
        f"the patch {' and '.join(texts)} until row {row + 1}, and the frame does not: the moments have the forces "
        "times this way: give a frame per part of the history"
    )


def _angle(before, after):
    """Angle (rad) of the rotation that fits two places (m, 3) of the nodes best; 0 of nodes on a line or a point."""
    a, b = before - before.mean(axis=0), after - after.mean(axis=0)
    u, values, v = np.linalg.svd(a.T @ b)
    if not values[1] > 1e-9 * max(values[0], 1e-300):
        return 0.0
    flip = np.diag([1.0, 1.0, np.sign(np.linalg.det(u @ v)) or 1.0])
    turn = u @ flip @ v
    return float(np.arctan2(0.5 * np.linalg.norm([turn[1, 2] - turn[2, 1], turn[2, 0] - turn[0, 2],
                                                  turn[0, 1] - turn[1, 0]]), 0.5 * (np.trace(turn) - 1.0)))  # fmt: skip

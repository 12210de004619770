"""Edges of contact and of stick as lines through the points that a file has of them, between the centres of cells.

The points of an edge have no order. Neighbours are found by the shortest distances: pairs are joined in this order,
each point to two others at most, and a line is closed only once it has LOOP points. Points that are further apart than
REACH cells are not joined: the edge between them is not reconstructed.
"""

import numpy as np
from matplotlib.patheffects import withStroke
from scipy.spatial import cKDTree

REACH = 2.3  # cells
LOOP = 6
LOOK = {"color": "white", "linewidth": 0.9}
CASING = {"linewidth": 2.1, "foreground": "black"}  # seen on dark and light colours
DASHED = (0, (4.0, 2.0))
DASHES = {"contact_edge": "-", "stick_edge": DASHED}


def _joined(points, reach):
    """The neighbours of each point, two at most."""
    pairs = cKDTree(points).query_pairs(reach, output_type="ndarray")
    apart = np.linalg.norm(points[pairs[:, 0]] - points[pairs[:, 1]], axis=1)
    near, group = [[] for _ in points], {k: [k] for k in range(len(points))}
    for first, second in pairs[np.argsort(apart, kind="stable")]:
        if len(near[first]) == 2 or len(near[second]) == 2:
            continue
        ours, other = group[first], group[second]
        if ours is other and len(ours) < LOOP:
            continue
        near[first].append(second)
        near[second].append(first)
        if ours is not other:
            few, many = sorted((ours, other), key=len)
            many += few
            group.update(dict.fromkeys(few, many))
    return near


def lines(points, cell):
    """The lines through points (count, 2) of an edge, each (count, 2), for cells of this width; a closed one ends where
    it begins. Points without a neighbour are left out."""
    if len(points) < 2:
        return []
    near, found, left = _joined(points, REACH * cell), [], set(range(len(points)))
    ends = [k for k in sorted(left) if len(near[k]) == 1]
    for start in [*ends, *sorted(left)]:
        if start not in left or not near[start]:
            continue
        line, here = [start], start
        left.remove(start)
        while following := [k for k in near[here] if k in left]:
            here = following[0]
            left.remove(here)
            line.append(here)
        closed = len(line) > 2 and start in near[here] and len(near[start]) == 2
        found.append(points[[*line, start] if closed else line])
    return found


def draw(panel, name, lines, length):
    """The lines of an edge over a map; the stick-slip boundary is dashed."""
    for line in lines:
        panel.plot(*(length * line.T), linestyle=DASHES[name], path_effects=[withStroke(**CASING)], gid=name, **LOOK)

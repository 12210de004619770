"""Missing points of a map."""

from dataclasses import replace

import numpy as np

from ...core.errors import Error


def place(one, row, column):
    """Where a cell was in the file, and where it is."""
    x, y = (one.axis(d)[k] for d, k in enumerate((column, row)))
    rows, columns = one.places
    return f"row {rows[row]}, column {columns[column]}, counted from 0 (x = {x:.4g} m, y = {y:.4g} m)"


def missing(one):
    """Returns True for each missing point."""
    return np.isnan(one.values)


def _nearest(values, holes):
    from scipy.ndimage import distance_transform_edt

    indices = distance_transform_edt(holes, return_distances=False, return_indices=True)
    return values[tuple(indices)]


def _smooth(values, holes):
    """Each missing value is the mean of its four neighbours (Laplace): never above or below the hole's rim."""
    from scipy.sparse import csc_matrix
    from scipy.sparse.linalg import spsolve

    rows, columns = np.nonzero(holes)
    number = np.full(values.shape, -1)
    number[rows, columns] = np.arange(rows.size)
    diagonal, right = np.zeros(rows.size), np.zeros(rows.size)
    entries = [[], []]
    base = np.mean(values[~holes])  # small numbers are rounded less
    for dy, dx in ((0, 1), (0, -1), (1, 0), (-1, 0)):
        r, c = rows + dy, columns + dx
        inside = np.flatnonzero((r >= 0) & (r < values.shape[0]) & (c >= 0) & (c < values.shape[1]))
        r, c = r[inside], c[inside]
        diagonal[inside] += 1.0
        known = ~holes[r, c]
        right[inside[known]] += values[r[known], c[known]] - base
        entries[0].append(inside[~known])
        entries[1].append(number[r[~known], c[~known]])
    i, j = (np.concatenate(part) for part in entries)
    data = np.concatenate([-np.ones(i.size), diagonal])
    whole = np.arange(rows.size)
    matrix = csc_matrix((data, (np.concatenate([i, whole]), np.concatenate([j, whole]))))
    filled = values.copy()
    filled[rows, columns] = base + np.atleast_1d(spsolve(matrix, right))
    return filled


def filled(one, how):
    """The map without missing points ("smooth", "nearest"), and their number; Error with the first for None."""
    holes = missing(one)
    count = int(np.count_nonzero(holes))
    if not count:
        return one, 0
    if count == holes.size:
        raise Error(f"{one.name}: all points are missing")
    if how is None:
        where = place(one, *np.argwhere(holes)[0])
        noun = "point is" if count == 1 else "points are"
        raise Error(
            f"{one.name}: {count} {noun} missing, of {holes.size}, the first at {where}: "
            "--fill smooth or --fill nearest replaces them, --window cuts them off"
        )
    values = (_smooth if how == "smooth" else _nearest)(one.values, holes)
    return replace(one, values=values), count

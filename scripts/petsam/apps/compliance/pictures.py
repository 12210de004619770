"""A picture of a compliance: the patch on the mesh, deflections, the spectrum, convergence by degree."""

import numpy as np
from matplotlib.figure import Figure

from ...plot.style import bar, colors, drawn, field, note, plt
from ...plot.units import label, scale
from .basis import LinePatch, written
from .result import Compliance

CELLS = 80  # of the patch in a map
COLUMNS = 3
SIDE = 3.6  # inches of a panel


def _outline(body):
    """Edges (n, 2, 2) of the contact surface's faces, x and y; of a section its elements' sides, x and z."""
    part = body.mesh.parts[0]
    edges = []
    if isinstance(body.patch, LinePatch):
        return np.concatenate([part.mesh.nodes[group.nodes[:, :2]][..., [0, 2]] for group in part.mesh.all_faces()])
    for group in part.contact:
        count = part.mesh.blocks[group.block].shape.face_corners(group.local)
        corners = part.mesh.nodes[group.nodes[:, :count], :2]
        edges.append(np.stack([corners, np.roll(corners, -1, axis=1)], axis=2).reshape(-1, 2, 2))
    return np.concatenate(edges)


def _mesh(axes, bodies, unit):
    from matplotlib.collections import LineCollection

    if bodies[0].mesh is not None:
        axes.add_collection(LineCollection(_outline(bodies[0]) * unit[0], colors="0.6", linewidths=0.5))
    line = isinstance(bodies[0].patch, LinePatch)
    for body in bodies:
        (x, y), (a, b) = body.patch.center, (body.patch.half[0], 0.0 if line else body.patch.half[1])
        corners = np.array([(x - a, y - b), (x + a, y - b), (x + a, y + b), (x - a, y + b), (x - a, y - b)]) * unit[0]
        axes.plot(*corners.T, color=colors()[1], linewidth=1.6)
    axes.autoscale()
    axes.grid(False)
    title = "patch on the mesh" if len(bodies) == 1 else "patches on the mesh"
    axes.set(title=title, xlabel=label("x", unit[1]), ylabel=label("z" if line else "y", unit[1]))
    axes.set_aspect("equal", adjustable="datalim")
    if line:
        axes.invert_yaxis()


def _points(patch):
    x, y = (c + h * (2.0 * (np.arange(CELLS) + 0.5) / CELLS - 1.0) for c, h in zip(patch.center, patch.half))
    return [v.ravel() for v in np.meshgrid(x, y)]


def _map(axes, body, coefficients, title, unit, field_unit="m"):
    """u_z, or the largest component, of a displacement on the patch."""
    patch = body.patch
    if isinstance(patch, LinePatch):
        _line(axes, body, coefficients, title, unit, field_unit)
        return
    values = (patch.values(*_points(patch)) @ coefficients).T.reshape(3, CELLS, CELLS)
    largest = int(np.argmax(np.max(np.abs(values), axis=(1, 2))))
    size = scale("m", values) if field_unit == "m" else (1.0, field_unit)
    (x, y), (a, b) = patch.center, patch.half
    edges = [v * unit[0] for v in (x - a, x + a, y - b, y + b)]
    shown = values[largest] * size[0]
    image = field(axes, shown, edges, shown.min(), shown.max())
    axes.set(title=title, xlabel=label("x", unit[1]), ylabel=label("y", unit[1]))
    bar(axes, image, label(f"u_{'xyz'[largest]}", size[1]))


def _line(axes, body, coefficients, title, unit, field_unit):
    """u_x and u_z of a displacement on the patch of a section."""
    x = body.patch.center[0] + body.patch.half[0] * np.linspace(-1.0, 1.0, CELLS)
    values = body.patch.values(x, np.zeros(CELLS)) @ coefficients
    size = scale("m", values) if field_unit == "m" else (1.0, field_unit)
    for axis, name in ((0, "u_x"), (2, "u_z")):
        axes.plot(x * unit[0], values[:, axis] * size[0], color=colors()[axis], label=name)
    axes.legend()
    axes.set(title=title, xlabel=label("x", unit[1]), ylabel=label("u", size[1]))


def _unit_load(body, direction):
    """Coefficients (m, 3) of the correction by 1 N, uniform on the patch."""
    m = body.patch.count
    load = np.zeros((m, 3))
    load[0, direction] = 0.5 / np.sqrt(body.patch.half[0] * body.patch.half[1])
    return (0.5 * (body.compliance + body.compliance.T) @ load.ravel()).reshape(m, 3)


def _spectrum(axes, body, title):
    values = np.sort(np.abs(body.eigenvalues))[::-1]
    axes.semilogy(1 + np.arange(len(values)), np.maximum(values, 1e-300), ".", color=colors()[0])
    axes.set_ylim(max(values[0] * 1e-12, values[-1] * 0.5, 1e-300), 2.0 * values[0])
    axes.set(title=title, xlabel="number", ylabel="magnitude")


def _convergence(axes, body, title):
    changes = np.maximum(body.changes, 1e-16)
    axes.semilogy(np.arange(len(changes)), changes, "o-", color=colors()[2], markersize=4)
    axes.set(title=title, xlabel="degree", ylabel=f"difference from degree {written(body.patch.degree)}")


def _panels(body, unit, name=""):
    """The panels that are drawn of a patch; of one of several, without load cases."""
    of = f"{name}, " if name else ""
    panels = [
        lambda axes: _map(axes, body, _unit_load(body, 2), f"{of}correction under N = 1 N", unit),
        lambda axes: _map(axes, body, _unit_load(body, 0), f"{of}correction under T_x = 1 N", unit),
        lambda axes: _spectrum(axes, body, f"{of}eigenvalues relative to the half-space"),
    ]
    if len(body.changes) > 1:
        panels.append(lambda axes: _convergence(axes, body, f"{of}correction under a Hertzian pressure"))
    for case, one in {} if name else body.cases.items():
        panels.append(lambda axes, c=one, n=case: _map(axes, body, c.coefficients, f"load case {n}", unit, c.unit))
    return panels


@drawn(Compliance)
def compliance(found: Compliance) -> Figure:
    """The patches of a body, or of a pair: on the mesh, deflections, the spectrum, convergence by degree.

    Parameters
    ----------
    found : compliance.Compliance
        The compliance, of petsam.compliance.of_deck() or of_mesh().

    Returns
    -------
    matplotlib.figure.Figure
    """
    bodies = found.bodies
    body = bodies[0]
    unit = scale("m", float(body.patch.wide))
    panels = [lambda axes: _mesh(axes, bodies, unit)]
    for k, one in enumerate(bodies, 1):
        panels += _panels(one, unit, f"patch {k}" if len(bodies) > 1 else "")
    rows = -(-len(panels) // COLUMNS)
    figure, grid = plt.subplots(
        rows, COLUMNS, figsize=(COLUMNS * (SIDE + 1.0), rows * SIDE), squeeze=False, layout="constrained"
    )
    for axes, panel in zip(grid.ravel(), panels):
        panel(axes)
    for axes in grid.ravel()[len(panels) :]:
        axes.set_axis_off()
    note(figure, f"method {body.method}, degree {written(body.patch.degree)}: body minus half-space", 10)
    return figure

"""Before a test: how well which strokes would give the friction, from the Jacobian of the model.

Nothing is measured yet: a friction, a rig, a noise and a number of points are assumed.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Optional

import numpy as np

from ...core.brief import brief
from ...core.errors import Error
from ...core.tables import Column, Tabled
from .backbone import Backbone, force_of
from .loop import Loop
from .loops import jacobian_of
from .push import Push

PARTS = (0.2, 0.3, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95)  # shear amplitudes over mu N of loops that stick in part
BEYOND = (1.2, 1.5, 2.0, 3.0)  # strokes over that at which sliding begins
UNKNOWN = ((), ("loss",), ("lean",), ("scale",))  # what is found besides friction and rig
NOISE = 0.005  # of amplitude, of displacement and force


@brief
@dataclass(frozen=True)
class Plan(Tabled):
    """Relative standard deviations of the friction by loop.

    Attributes
    ----------
    loops : list of str
        What is measured: "0.6" of sliding, or "1.5 D_g".
    stroke : ndarray
        Displacement amplitudes, m, the largest of each row.
    force : ndarray
        Shear amplitudes, N, the largest of each row.
    deviation : ndarray
        (rows, len(UNKNOWN)), 1: with friction and rig unknown, and with the loss, the lean, or the contact's compliance
        unknown, too.
    friction, wanted : float
        The assumed friction, and the deviation that is wanted.
    """

    loops: Sequence[str]
    stroke: np.ndarray
    force: np.ndarray
    deviation: np.ndarray
    friction: float
    wanted: float

    def table(self) -> list:
        """The columns: loops, amplitudes, and a deviation for each set of unknowns.

        Returns
        -------
        list of Column
        """
        names = ["friction_sd", *(f"friction_sd_{one[0]}" for one in UNKNOWN[1:])]
        texts = ["friction and rig unknown", *(f"{one[0]} unknown, too" for one in UNKNOWN[1:])]
        return [
            Column("loops", "", "shear amplitude over mu N, or stroke over that of sliding", list(self.loops)),
            Column("displacement", "m", "largest amplitude", self.stroke.tolist()),
            Column("force", "N", "maximum shear amplitude", self.force.tolist()),
            *(
                Column(name, "1", f"deviation of the friction relative to it, {text}", self.deviation[:, k].tolist())
                for k, (name, text) in enumerate(zip(names, texts))
            ),
        ]

    def advice(self) -> str:
        """The smallest loops that are good enough also if the rig loses energy.

        Returns
        -------
        str
            One sentence.
        """
        good = [k for k in range(len(self.loops)) if self.deviation[k, :2].max() <= self.wanted]
        if not good:
            wanted = f"{100 * self.wanted:g} %"
            return f"none of these loops gives the friction to {wanted}: less noise or a stiffer rig is needed"
        first = min(good, key=lambda k: self.stroke[k])
        return (
            f"the friction to {100 * self.wanted:g} % takes {self.loops[first]}: an amplitude of "
            f"{self.stroke[first]:.4g} m and {self.force[first]:.4g} N, or more; the loss of the rig may be unknown"
        )


def plan(
    push: Push,
    friction: float,
    rig: float,
    noise: Optional[tuple[float, float]] = None,
    points: int = 200,
    cycles: int = 10,
    wanted: float = 0.02,
) -> Plan:
    """Deviations of the friction for loops in partial and gross slip, and for several of them.

    Parameters
    ----------
    push : Push
    friction : float
        Assumed.
    rig : float
        Stiffness of the rig, N/m.
    noise : tuple of float, optional
        Of displacement and force, m and N; None: NOISE of the amplitudes.
    points, cycles : int
        Points of a loop, and number of loops of each kind.
    wanted : float
        Deviation relative to the friction.

    Returns
    -------
    Plan

    Raises
    ------
    Error
        If a number is not above 0.
    """
    if not (friction > 0.0 and rig > 0.0 and points >= 20 and cycles >= 1):
        raise Error("plan: expected friction, rig, cycles above 0, and 20 points or more")
    backbone = Backbone(push, friction, 1.0 / rig)
    slides = float(backbone.displacement[-1])
    kinds = {f"{part:g} of sliding": float(np.interp(part * backbone.force[-1], backbone.force, backbone.displacement))
             for part in PARTS}  # fmt: skip
    kinds.update({f"{ratio:g} times the sliding stroke": ratio * slides for ratio in BEYOND})
    sets: list[tuple[str, ...]] = [(name,) for name in kinds]
    sets += [
        ("0.3 of sliding", "0.6 of sliding", "0.9 of sliding"), ("0.6 of sliding", "1.5 times the sliding stroke")
    ]  # fmt: skip
    rows, strokes, forces = [], [], []
    for names in sets:
        loops = [_made(backbone, push, kinds[name], points) for name in names]
        sizes = [noise or (NOISE * kinds[name], NOISE * float(backbone(kinds[name]))) for name in names]
        values = dict(friction=friction, compliance=1.0 / rig, lean=0.0, loss=0.0, scale=1.0, bend=0.0)
        rows.append([_deviation(loops, push, free, values, sizes, cycles) / friction for free in UNKNOWN])
        strokes.append(max(kinds[name] for name in names))
        forces.append(float(backbone(strokes[-1])))
    measured = [" and ".join(names) for names in sets]
    return Plan(measured, np.array(strokes), np.array(forces), np.array(rows), friction, wanted)


def _made(backbone, push, half, points):
    """A loop without noise."""
    phase = 2.0 * np.pi * (np.arange(points) + 0.5) / points
    d, rising = -half * np.cos(phase), phase < np.pi
    return Loop(d, force_of(backbone, d, rising, (0.0, half, -half))[0], rising, push.normal)


def _deviation(loops, push, free, values, noise, cycles):
    """Standard deviation of the friction."""
    jacobian = jacobian_of(loops, push, free, values, noise)
    lengths = np.linalg.norm(jacobian, axis=0)
    _, r = np.linalg.qr(jacobian / lengths)
    return float(np.linalg.norm(np.linalg.inv(r)[0]) / lengths[0] / np.sqrt(cycles))

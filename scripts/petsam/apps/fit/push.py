"""One push of a contact: the displacement over a growing tangential force at a coefficient of friction of 1.

It serves all coefficients of friction (Jaeger's scaling): with mu the displacement at Q is mu f(Q/mu). For similar
bodies this is exact, for others within 0.06 % of the friction (their first cycles differ, later ones do not).
"""

import os
import shlex
import warnings
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Optional, Union

import numpy as np

from ...closed.materials import Bodies
from ...closed.sphere import Spheres
from ...core import materials, words
from ...core.brief import brief
from ...core.errors import Error, Unusable, library, short
from ...core.files import text_of

STEPS = 48  # load steps of petsam's push
FINE = 600  # points of the table, dense at the end, where the curve is flat
BALL = {
    "gap_type", "gap_radius1", "gap_radius2", "body1_young", "body1_poisson", "body2_young", "body2_poisson", "body1",
    "body2", "grid_n", "grid_size", "grid_center", "elasticity", "friction", "load_n", "output", "output_fields",
    "steps", "accuracy", "accuracy_of", "grid",
}  # fmt: skip
LOADS = ("load_", "disp_", "rot_", "creep_", "history", "steps", "friction", "wear_", "output", "checkpoint", "restart")


@brief
@dataclass(frozen=True)
class Push:
    """The table of a push.

    Parameters
    ----------
    normal : float
        Normal load, N.
    force, displacement : ndarray
        (n,), N and m, from 0 to the normal load, at a coefficient of friction of 1.
    text : str
        Where it comes from.
    datum : str
        What the displacement is relative to, where that is a choice: the rig's stiffness includes it. Else empty.
    """

    normal: float
    force: np.ndarray
    displacement: np.ndarray
    text: str = ""
    datum: str = ""

    @property
    def stiffness(self) -> float:
        """Stiffness of the contact without slip, N/m."""
        return float(self.force[1] / self.displacement[1])


def _dense(count):
    """Parts of sliding from 0 to 1, dense at both ends."""
    s = np.linspace(0.0, 1.0, count)
    return 1.0 - (1.0 - s) ** 2


def ball(normal: float, radius: float, bodies: Mapping) -> Push:
    """The push of a ball in closed form (Cattaneo and Mindlin).

    Parameters
    ----------
    normal, radius : float
        Normal load (N) and relative radius (m).
    bodies : mapping
        body1_young, body1_poisson, body2_young, body2_poisson (Pa, 1).

    Returns
    -------
    Push
    """
    return _of_spheres(Spheres(Bodies.of(bodies), radius, 1.0, normal))


def _of_spheres(spheres):
    """The push of spheres at a friction of 1."""
    force = spheres.load_n * _dense(FINE)
    return Push(spheres.load_n, force, spheres.first_loading(force), "ball in closed form (Cattaneo and Mindlin)")


def options_of(path: Union[str, os.PathLike]) -> dict[str, str]:
    """{name: value} of an options file of petsam; "" of an option without a value."""
    found = {}
    for number, line in enumerate(text_of(path).splitlines(), 1):
        try:
            parts = shlex.split(line, comments=True)
        except ValueError as error:
            raise Error(f"{path}, line {number}: {error}") from error
        for k, part in enumerate(parts):
            if part.startswith("-") and not part[1:2].isdigit() and not part[1:2] == ".":
                after = parts[k + 1] if k + 1 < len(parts) else "-"
                found[part[1:]] = "" if after.startswith("-") and not after[1:2].isdigit() else after
    if not found:
        raise Error(f"{path}: has no option of petsam, as -gap_type sphere")
    return found


def of_shape(path: Union[str, os.PathLike], normal: float, width: Optional[float] = None) -> Push:
    """The push of the contact that an options file describes: of a ball on half-spaces in closed form, else by petsam.

    Parameters
    ----------
    path : path
        Options of petsam: bodies, gap and grid. Loads, friction and wear in it are not used.
    normal : float
        Normal load, N.
    width : float, optional
        Length of a contact in plane strain, m.

    Returns
    -------
    Push

    Raises
    ------
    Error
        If the file is none, or petsam cannot solve the push.
    """
    options = options_of(path)
    plane = options.get("elasticity", "").startswith("plane")
    if plane and not width:
        raise Unusable(
            f"{path}: is in plane strain, whose loads are per metre: give the length of the contact, --width"
        )
    if width and not plane:
        raise Unusable(f"--width: {path} is not in plane strain")
    if (
        options.get("gap_type") == "sphere"
        and set(options) <= BALL
        and options.get("elasticity", "") in ("", "halfspace")
    ):
        return _ball_of(path, options, normal)
    return _computed(path, options, normal / (width or 1.0), width)


def _ball_of(path, options, normal):
    """The push of a ball of these options."""
    options = materials.resolved(options)
    try:
        units = dict(young="Pa", poisson="1")
        bodies = {
            f"body{b}_{name}": words.number(
                str(options[f"body{b}_{name}"]), "a number", unit, lambda value: value == value
            )
            for b in (1, 2)
            for name, unit in units.items()
        }
        for name in ("gap_radius1", "gap_radius2"):
            bodies[name] = words.number(options[name], "a radius", "m", lambda value: value == value)
    except (KeyError, words.WordError) as error:
        raise Error(f"{path}: -{error.args[0]} of a sphere is missing or no number") from error
    return _of_spheres(Spheres.of({**bodies, "friction": 1.0}, normal))


def _computed(path, options, normal, width):
    """A push by petsam: STEPS load steps at a friction of 1."""
    from ...contact.running import run

    if "accuracy" in options or "grid" in options:
        raise Unusable(
            f"{path}: -accuracy: the push goes on to gross slip, where no grid resolves stick: give -grid_n and "
            "-grid_size, as a run of the loop has chosen them by it"
        )

    kept = {name: value or True for name, value in options.items() if not name.startswith(LOADS)}
    part = _dense(STEPS + 1)[:-1]
    history = dict(time=np.arange(STEPS) + 1.0, load_n=np.full(STEPS, normal), load_tx=normal * part)
    if "rot_y" in options:
        history["rot_y"] = np.zeros(STEPS)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # small slip zones of small forces matter little
        results = run(kept, friction=1.0, history=history, output_fields="none")
    with results:
        force = results.series("load_tx") * (width or 1.0)
        displacement = results.series("disp_x")
    displacement = displacement - displacement[0]
    force, displacement = np.append(force, normal * (width or 1.0)), np.append(displacement, np.nan)
    # the last step would slide; of a ball the displacement is linear in (1 - part)^(2/3)
    left = (1.0 - force / force[-1]) ** (2.0 / 3.0)
    displacement[-1] = np.polyval(np.polyfit(left[-8:-1], displacement[-8:-1], 1), 0.0)
    s = np.sqrt(1.0 - force / force[-1])
    curve = library("scipy.interpolate").PchipInterpolator(1.0 - s, displacement)
    datum = f"the displacement of plane strain about its datum, of {short(path)}" if width else ""
    return Push(
        float(force[-1]),
        force[-1] * _dense(FINE),
        curve(np.linspace(0.0, 1.0, FINE)),
        f"{STEPS} steps of petsam of {path}",
        datum,
    )

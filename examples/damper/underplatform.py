"""A damper under the platforms of turbine blades, which its centrifugal force presses into their roof: damper().

A cylinder of mass m lies between two platforms, inclined by alpha_1 and alpha_2 to the circumference, at a distance r
from the axis of rotation. x is along the circumference, z outwards. Without friction F = m r Omega^2 is in equilibrium
with the normal loads

    N_1 = F sin(alpha_2)/sin(alpha_1 + alpha_2)      N_2 = F sin(alpha_1)/sin(alpha_1 + alpha_2)

both F/(2 cos(alpha)) where the platforms are alike. Both contacts are Hertz's: ellipses of a damper that is crowned
along its length, lines of one that is not.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Optional, Union

import numpy as np
from numpy.typing import ArrayLike

import petsam
from petsam import Contact, joint
from petsam.apps.joint.arguments import array, moduli, real
from petsam.closed import effective_modulus
from petsam.closed.ellipse import Ellipse, hertz_ellipse
from petsam.core import units, words

FASTEST = 700.0  # m/s, that no turning rim of metal bears
ROOM = 1.5  # half width of a contact's grid over its half axis
SIDES = (-1.0, 1.0)  # of the platforms along x
NAMES = ("left", "right")
RIM = "rad/s"

Value = Union[float, str]  # a number in the unit of SI, or a text with its unit


@dataclass(frozen=True)
class Damper:
    """A damper between two platforms, left and right; damper() makes it of numbers and texts.

    Attributes
    ----------
    mass, radius : float
        Mass, kg, and radius of the section, m.
    angles : ndarray
        Angles of the two platforms to the circumference, (2,), rad.
    speed, orbit : float
        Angular velocity of the rotor, rad/s, and the damper's distance from its axis, m.
    friction : float
        Coefficient of friction.
    crown : float
        Radius along the damper's length, m; inf: the contacts are lines.
    length : float or None
        Length of contacts that are lines, m.
    bodies : dict
        Options of the contacts: moduli of the damper, body 1, and the platforms, body 2, and others.
    """

    mass: float
    radius: float
    angles: np.ndarray
    speed: float
    orbit: float
    friction: float
    crown: float
    length: Optional[float]
    bodies: dict

    @property
    def force(self) -> float:
        """The centrifugal force m r Omega^2, N."""
        return self.mass * self.orbit * self.speed**2

    @property
    def loads(self) -> np.ndarray:
        """Normal loads of the contacts without shear, left and right, (2,), N."""
        return self._resolved(0.0)

    @property
    def sliding(self) -> np.ndarray:
        """Normal loads where both contacts slide, N: first while the damper moves outwards, then inwards, (2, 2).

        NaN where platforms of unlike angles leave no such equilibrium.
        """
        return np.array([self._resolved(self.friction), self._resolved(-self.friction)])

    @property
    def hertz(self) -> list[Ellipse]:
        """Hertz's contact of each platform: half axes across and along the damper (m), pressure (Pa), approach (m).

        Of a line half_y is half its length, and the approach NaN, as it depends on the bodies' depth.
        """
        e_star = effective_modulus(*(self.bodies[f"body{k}_{name}"] for k in "12" for name in ("young", "poisson")))
        if self.length is None:
            return [hertz_ellipse(float(load), self.radius, self.crown, e_star) for load in self.loads]
        found = []
        for load in self.loads / self.length:
            half = float(np.sqrt(4.0 * load * self.radius / (np.pi * e_star)))
            found.append(Ellipse(half, 0.5 * self.length, float(2.0 * load / (np.pi * half)), np.nan))
        return found

    @property
    def scale(self) -> float:
        """Factor on sensors of structure(), by which modal forces are divided: the root of the length of lines, else 1.

        All numbers of a line are those of a metre: loads in N/m, energies in J/m, mass in kg/m.
        """
        return 1.0 if self.length is None else float(np.sqrt(self.length))

    @property
    def axes(self) -> np.ndarray:
        """Normal of each platform, from the damper, and tangent, (2, 2, 2), as rows (x, z) in each."""
        sine, cosine = np.sin(self.angles), np.cos(self.angles)
        return np.array([[[side * s, c], [c, -side * s]] for side, s, c in zip(SIDES, sine, cosine)])

    @property
    def motions(self) -> np.ndarray:
        """Displacements (n, t) of the damper against each platform, left and right, (4, 3), by its x, z (m) and its
        rotation about y (rad)."""
        found = np.zeros((4, 3))
        found[:, :2] = self.axes.reshape(4, 2)
        found[1::2, 2] = self.radius
        return found

    def contact(self, side: int, grid_n: Any = 48, grid_size: Any = None) -> Contact:
        """The contact of the damper, body 1, with a platform, body 2, that has never been loaded.

        Parameters
        ----------
        side : int
            0 left, 1 right.
        grid_n : int or pair of ints
            Cells across and along the damper.
        grid_size : float or pair of floats, optional
            Its sides, m; None: 1.5 times those of Hertz's contact.

        Returns
        -------
        Contact

        Raises
        ------
        ContactError
            For options that petsam does not take.
        """
        shape, found = dict(gap_type="ellipsoid", gap_radius_x=self.radius, gap_radius_y=self.crown), self.hertz[side]
        if self.length is not None:
            shape.update(elasticity="plane", plane_datum=self.radius)
        if grid_size is None:
            halves = [found.half_x, found.half_y] if self.length is None else [found.half_x]
            grid_size = [2.0 * ROOM * half for half in halves]
        return Contact(**{**shape, "friction": self.friction, "grid_n": grid_n, "grid_size": grid_size, **self.bodies})

    def structure(
        self, platforms: ArrayLike, omega: ArrayLike, grid_n: Any = 48, grid_size: Any = None, damping: float = 0.0,
        coupling: Optional[ArrayLike] = None,
    ) -> joint.Structure:  # fmt: skip
        """The blades and the damper, pressed against their platforms, for backbone() and the other functions.

        The shear of the preload is zero, as if vibrations had settled the damper. The blades are at rest where the
        damper has pushed them: a modal force of their own holds them there. Motion along the damper is held.

        Parameters
        ----------
        platforms : array of shape (4, modes)
            Displacements of the platforms at their contacts by each mode of the blades, of unit modal mass: x and z of
            the left one, x and z of the right one.
        omega : array of shape (modes,)
            Angular frequencies of the modes, rad/s.
        grid_n, grid_size
            As of contact(), of both.
        damping : float
            Damping of the blades' material as a part of critical.
        coupling : array of shape (4, 4), optional
            Compliance, m/N, of modes that are left out, between n and t of the left and of the right platform.

        Returns
        -------
        Structure
            Its modes are those of the blades, and the damper's x, z and rotation about y.

        Raises
        ------
        Error
            For arrays of other shapes, and where there is no equilibrium.
        ContactError
            For options that petsam does not take.
        """
        omega, blades = array("omega", omega), array("platforms", platforms)
        if blades.shape != (4, omega.size):
            raise petsam.Error(f"platforms: has the shape {blades.shape}: expected (4, {omega.size}), as omega")
        shapes = -self.scale * np.concatenate([axes @ two for axes, two in zip(self.axes, np.split(blades, 2))])
        rigid = self.scale * self.motions / np.sqrt(self.mass * np.array([1.0, 1.0, 0.5 * self.radius**2]))
        joined = shapes @ (shapes.T / omega[:, None] ** 2)
        if coupling is not None:
            joined = joined + self.scale**2 * array("coupling", coupling)
        found = joint.Structure(self._pressed(grid_n, grid_size), omega, shapes, joined, rigid, damping)
        found.z, found.loads = (np.concatenate(parts) for parts in zip(*(patch.state() for patch in found.patches)))
        found.a = np.linalg.lstsq(rigid, found.z, rcond=None)[0]
        found.step(-np.concatenate([shapes.T, rigid.T]) @ found.loads)
        return found

    def _pressed(self, grid_n, grid_size):
        """The patches of both contacts under their loads without shear, at one place of the damper."""
        held = dict(disp_y=0.0, rot_y=0.0, **(dict(rot_x=0.0, rot_z=0.0) if self.length is None else {}))
        contacts = [self.contact(side, grid_n, grid_size) for side in range(2)]
        loads = [float(load) for load in self.loads / self.scale**2]
        approaches = [one.try_step(load_n=load).disp_z for one, load in zip(contacts, loads)]
        place = np.linalg.solve(self.axes[:, 0], approaches)  # x and z of the damper
        patches = []
        for name, one, load, (_, along) in zip(NAMES, contacts, loads, self.axes):
            one.commit()
            one.try_step(load_n=load, disp_x=float(along @ place), friction_scale=0.0, **held)
            one.commit()
            patches.append(joint.Patch(one, ["disp_z", "disp_x"], held, ["disp_z"], name))
        return patches

    def _resolved(self, friction):
        """Normal loads that bear the force together with friction against a damper that moves outwards, N."""
        pushes = self.axes[:, 0] - friction * np.array(SIDES)[:, None] * self.axes[:, 1]
        wanted = np.array([0.0, self.force])
        found = np.linalg.lstsq(pushes.T, wanted, rcond=None)[0]
        off = np.abs(pushes.T @ found - wanted).max()
        return found if np.all(found >= 0.0) and off <= 1e-9 * self.force else np.full(2, np.nan)


def damper(  # noqa: PLR0913  (as the numbers of a damper)
    mass: Value, radius: Value, angle: Union[Value, Sequence[Value]], speed: Value, orbit: Value, friction: float,
    *, crown: Value = np.inf, length: Optional[Value] = None, **bodies: Any,
) -> Damper:  # fmt: skip
    """The Damper of turbine blades: numbers in SI units, or texts with their unit, mass="10g", speed="3000rpm".

    Parameters
    ----------
    mass : float or str
        Mass of the damper, kg.
    radius : float or str
        Radius of its section, a circle, m.
    angle : float, str or pair of them
        Angle of the platforms to the circumference, above 0 and below a right angle, rad or "35deg"; or that of the
        left and that of the right one.
    speed : float or str
        Angular velocity of the rotor, rad/s or "3000rpm".
    orbit : float or str
        Distance of the damper from the axis of rotation, m.
    friction : float
        Coefficient of friction, with which the damper does not lock between the platforms.
    crown : float or str
        Radius of the damper along its length, m; inf: it has none, and the contacts are lines.
    length : float or str, optional
        Length of contacts that are lines, m.
    **bodies
        Options of the contacts: those of the damper, body1="steel" (petsam.materials), or body1_young (Pa, or
        "210GPa") and body1_poisson, those of the platforms, body2, and others of petsam.

    Returns
    -------
    Damper
        loads, hertz, sliding; .structure(platforms, omega) is that of joint.backbone() and the others.

    Raises
    ------
    Error
        For wrong values, and a damper that locks.
    """
    given = dict(
        mass=_value("mass", mass, "kg"),
        radius=_value("radius", radius, "m"),
        angles=_angles(angle),
        speed=_value("speed", speed, RIM),
        orbit=_value("orbit", orbit, "m"),
        friction=real("friction", friction, "a coefficient from 0 on", lambda one: 0.0 <= one < np.inf),
        crown=_value("crown", crown, "m", np.inf),
        length=None if length is None else _value("length", length, "m"),
    )
    if np.isinf(given["crown"]) == (length is None):
        raise petsam.Error("crown, length: give one of both: the crown of an ellipse, or the length of a line")
    _need_bearable(given)
    bodies = moduli(bodies)
    for name in (f"body{k}_{one}" for k in "12" for one in ("young", "poisson")):
        if bodies.get(name) is None:
            raise petsam.Error(f"{name}: give the bodies' materials, as body1='steel', or their moduli")
    return Damper(**given, bodies=bodies)


def _value(name, value, unit, most=None):
    """A number above 0, or a text with its unit; infinite ones only up to `most`."""
    good = (lambda one: 0.0 < one <= most) if most else (lambda one: 0.0 < one < np.inf)
    form = f"a number above 0, in {unit}, or a text with its unit, of {units.names(unit)}"
    if not isinstance(value, str):
        return real(name, value, form, good)
    try:
        return words.number(value, form, unit, good)
    except words.WordError as error:
        raise petsam.Error(f"{name}: {error}") from None


def _angles(angle):
    """Two angles, rad, of one or two of them."""
    given = [angle] if isinstance(angle, str) or np.ndim(angle) == 0 else list(angle)
    if len(given) not in (1, 2):
        raise petsam.Error(
            f"angle: has {len(given)} values: expected one, or that of the left and of the right platform"
        )
    found = np.array([_value("angle", one, "rad") for one in given])
    if not np.all(found < 0.5 * np.pi):
        raise petsam.Error(f"angle: {found.max():g} rad is no angle below a right one: give rad, or a text as '35deg'")
    return np.broadcast_to(found, 2)


def _need_bearable(given):
    """Error for a speed that no rotor bears, and for a damper that locks."""
    rim = given["speed"] * given["orbit"]
    if not rim <= FASTEST:
        speed = given["speed"]
        raise petsam.Error(
            f"speed: {speed:g} rad/s move the damper at {rim:.3g} m/s: expected at most {FASTEST:g} m/s: "
            f"give rad/s ({speed:g} rpm are {speed * np.pi / 30.0:.4g} rad/s), or a text as '{speed:g}rpm'"
        )
    if np.arctan(given["friction"]) + given["angles"].mean() >= 0.5 * np.pi:
        told = " and ".join(f"{one:g}" for one in dict.fromkeys(np.degrees(given["angles"]).tolist()))
        raise petsam.Error(f"friction {given['friction']:g}: the damper locks between platforms at {told} degrees")

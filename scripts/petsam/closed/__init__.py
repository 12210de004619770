"""Closed-form solutions for elastic half-spaces in contact, with which results are compared.

Conventions
-----------
SI units. A contact of two half-spaces, loaded through body 1; r is the distance from the contact's centre.
Displacements, rotations and slips are relative (body 1 against body 2), so both bodies' compliances add: the functions
take sums such as ``1/G1 + 1/G2``. Shear q is positive in the direction of the positive load, slip is
``s = u_t - rigid`` and therefore opposite to the shear: under a positive T_x, q_x >= 0 and s_x <= 0; under a positive
M_z, q_theta >= 0. All functions accept numpy arrays wherever the argument is a coordinate.

materials  elastic constants
sphere     Hertz; Cattaneo and Mindlin; Lubkin (functions: normal, cattaneo, lubkin)
stress     stresses under a spherical contact: Hertz; sliding: Hamilton
loop       tangential loops of a sphere and their energy: Mindlin and Deresiewicz
spence     elastic sphere on a dissimilar flat with friction: Spence
ellipse    Hertz's elliptic contact, forward and inverse
punch      flat circular punch with a rounded edge under normal load
adhesion   ball that adheres to a flat: Maugis; Johnson, Kendall and Roberts; Derjaguin, Muller and Toporov
plane      infinitely long punch with rounded edges, upright or inclined, in partial slip

tests/program/test_closed.py compares every formula with a numerical quadrature.

Functions of materials, sphere and stress have their names here; the others are imported when they are first used.
"""

import importlib

from .cattaneo import cattaneo_displacement, cattaneo_shear, cattaneo_slip, cattaneo_stick_radius
from .lubkin import lubkin_shear, lubkin_stick_radius, lubkin_torque_ratio, lubkin_twist, torsion_limit

# fmt: off
from .materials import Bodies, dundurs_beta, effective_modulus, effective_radius, shear_modulus, tangential_compliance
from .normal import Hertz, hertz, hertz_pressure
from .sphere import Spheres
from .stress import HERTZ_MISES, HERTZ_MISES_DEPTH, hertz_axis, hertz_surface, sliding_surface

# fmt: on

_PARTS = ("adhesion", "ellipse", "loop", "plane", "punch", "spence")


def __getattr__(name):
    if name not in _PARTS:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return importlib.import_module("." + name, __name__)


def __dir__():
    return sorted({*globals(), *_PARTS})

"""Settings of the compliance of a mesh, and the checks that they make sense together.

Messages have the names of petsam-compliance's options: --fixed of `supports`, --bolt of `bolts`, --case of `cases`,
--center of `centers`.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, fields, replace
from typing import NamedTuple

import numpy as np

from ...core.errors import Unusable, short, there_are
from . import basis, several
from .units import UNITS

HIGHEST = 10  # highest degree that petsam reads
HIGHEST_EACH, MOST_FUNCTIONS = 24, 325  # the same of degrees in x and y, and the number of their products
NAME = re.compile(r"[A-Za-z0-9_]{1,20}")
MOST_CASES, MOST_OF_PAIR = 8, 40
LONGEST = 20  # letters of the name of a load case
RESERVED = ("closing", "closing_by")  # names beside those of bolts in the file
METHODS = ("auto", "image", "cutoff")


class Bolt(NamedTuple):
    """A bolt: its name, the surfaces of its washers on body 1 and on body 2, its diameter (m), and its modulus, Pa
    (that of the washers)."""

    name: str
    surfaces: tuple
    diameter: float
    young: float | None = None


@dataclass(frozen=True)
class Settings:
    """The task of a computation. Sets and surfaces are names of the mesh, or boxes (place()).

    Attributes
    ----------
    contact : str
        Surface on which the patches lie.
    patch : tuple
        Full widths in x and y, m.
    centers : tuple
        Centre (x, y) of each patch in the frame, m.
    supports : tuple
        Node sets that are held in x, y, z.
    symmetry : tuple
        Node sets in planes of symmetry.
    free : bool
        Whether nothing holds the bodies of a pair.
    units : str
        Those of the mesh: "m" (m, N, Pa) or "mm" (mm, N, MPa).
    frame : tuple
        Origin, x and z (or the first ones of them) of the contact, in the mesh's coordinates and units.
    pair : str or None
        Surface of body 1 that faces the contact.
    bolts : tuple of Bolt
        Bolts of a pair.
    modes : int
        Number of modes without contact.
    sensors : tuple
        (name, node or set of one node) of each sensor.
    cases : tuple
        (name, step of the deck) of each load case.
    degree : int or tuple
        Of the polynomials: their sum in x and y, or the largest in x and in y.
    method : str
        "auto", "image" or "cutoff".
    stiffness : str or None
        "own", "calculix" or None (own, for elements that petsam assembles).
    keep_elements : bool
        Whether linear elements stay linear, instead of becoming quadratic ones.
    depth : float or None
        Depth of the stress points, m; None: twice the smaller half width.
    stress : bool
        Whether there are any stress points.
    coarse : path or meshio.Mesh, optional
        A coarser mesh, which tells how much it changes the compliance.
    materials : tuple or None
        (young, poisson, density) of a mesh that has none (foreign.py).
    ccx : str
        The program CalculiX.
    """

    contact: str
    patch: tuple
    centers: tuple = ((0.0, 0.0),)
    supports: tuple = ()
    symmetry: tuple = ()
    free: bool = False
    units: str = "m"
    frame: tuple = ((0.0, 0.0, 0.0),)
    pair: str | None = None
    bolts: tuple = ()
    modes: int = 0
    sensors: tuple = ()
    cases: tuple = ()
    degree: int | tuple = 6
    method: str = "auto"
    stiffness: str | None = None
    keep_elements: bool = False
    depth: float | None = None
    stress: bool = True
    coarse: object = None
    materials: tuple | None = None
    ccx: str = "ccx"


def place(where):
    """The name of a set or surface: a text as it is, or a box of the points (x, y, z) of two corners in the mesh's
    coordinates and units, such as ((0, 0, 4), (4, 4, 4)); None leaves a coordinate free."""
    if where is None or isinstance(where, str):
        return where
    low, high = (np.array([free if x is None else x for x in point], dtype=float)
                 for point, free in zip(where, (-math.inf, math.inf)))  # fmt: skip
    return ":".join(",".join(repr(float(x)) for x in point) for point in (low, high))


def _places(names):
    """The names of one or several sets."""
    if names is None:
        return ()
    single = isinstance(names, str) or len(names) == 2 and all(np.ndim(one) == 1 for one in names)
    return tuple(place(one) for one in ([names] if single else names))


def _pairs(given):
    """Pairs of {name: value}, or of such pairs."""
    found = tuple(given.items()) if hasattr(given, "items") else tuple(tuple(one) for one in given)
    if not all(len(one) == 2 for one in found):
        raise Unusable(f"{short(repr(given))}: expected {{name: value}}")
    return found


def _bolts(given):
    """Bolts of {name: (surface 1, surface 2, diameter[, modulus])}, or of Bolts."""
    if not hasattr(given, "items"):
        return tuple(given)
    return tuple(
        Bolt(name, (place(first), place(second)), *more) for name, (first, second, *more) in given.items()
    )  # fmt: skip


def need_names(given):
    """Raises Unusable unless each name is that of a field of Settings."""
    known = [one.name for one in fields(Settings)]
    for name in given:
        if name not in known:
            raise Unusable(f"{short(name)}: no such argument{there_are(name, known)}")


def _widths(patch):
    """Full widths in x and y of two numbers, or of one of a square."""
    try:
        return tuple(np.broadcast_to(np.asarray(patch, dtype=float), 2).tolist())
    except (TypeError, ValueError):
        raise Unusable(f"patch {short(repr(patch))}: expected its full widths in m, two numbers or one") from None


def settings(contact, patch, supports=(), **more):
    """The checked Settings by what a notebook gives: a number as the patch of a square, one name for several, mappings
    of bolts, cases and sensors, boxes as places."""
    forms = {"symmetry": _places, "pair": place, "bolts": _bolts, "cases": _pairs, "sensors": _pairs}
    more = {name: forms.get(name, lambda value: value)(value) for name, value in more.items()}
    need_names(more)
    contact = None if contact is None else place(contact)
    found = Settings(contact, _widths(patch), supports=_places(supports), **more)
    frame = (found.frame,) if np.ndim(found.frame) == 1 and np.isscalar(found.frame[0]) else tuple(found.frame)
    sensors = tuple((name, str(node)) for name, node in found.sensors)
    found = replace(found, frame=frame, sensors=sensors, centers=tuple(map(tuple, found.centers)))
    need_sense(found)
    return found


def need_degree(degree):
    """Raises Unusable unless petsam reads polynomials of the degree."""
    most = HIGHEST if np.ndim(degree) == 0 else HIGHEST_EACH
    each = np.atleast_1d(degree)
    numbers = np.issubdtype(each.dtype, np.number)
    if len(each) > 2 or not numbers or not all(value == int(value) and 0 <= value <= most for value in each):
        raise Unusable(
            f"{short(str(degree))}: expected an integer from 0 to {HIGHEST}, or two from 0 to {HIGHEST_EACH} for x and "
            "y: 12,6"
        )
    count = len(basis.powers(degree))
    if count > MOST_FUNCTIONS:
        raise Unusable(
            f"{basis.written(degree)} gives {count} polynomials, limit {MOST_FUNCTIONS}: lower the degree in one "
            "direction"
        )


def need_sense(given):
    """Raises Unusable unless the Settings make sense together."""
    if given.contact is None:
        raise Unusable("--mesh needs --contact: the surface on which the patch lies, its name or a box")
    if not all(0.0 < width < math.inf for width in given.patch):
        raise Unusable(f"--patch {given.patch[0]:g},{given.patch[1]:g}: expected lengths above 0")
    if given.units not in UNITS:
        raise Unusable(f"--units {short(str(given.units))}: use {', '.join(UNITS)}")
    if given.method not in METHODS:
        raise Unusable(f"--method {short(given.method)}: use {', '.join(METHODS)}")
    need_degree(given.degree)
    _check_held(given)
    _check_pair(given)
    _check_names(given)


def _check_held(given):
    """Checks --fixed, and what belongs to --free."""
    if given.free and given.supports:
        raise Unusable("--free holds nothing: remove it, or --fixed")
    if given.free and not given.pair:
        raise Unusable(
            "--free is for a pair: a body alone moves away under the loads of its contact: hold it by --fixed, or give "
            "the surface of body 1 by --pair"
        )
    if not given.free and not given.supports:
        other = ", or --free for a pair that nothing holds" if given.pair else ""
        raise Unusable(f"--mesh needs --fixed{other}")


def _check_pair(given):
    """Checks --pair and what belongs to it, or to one body alone."""
    if not given.pair:
        for name, value in (("bolt", given.bolts), ("modes", given.modes), ("sensor", given.sensors)):
            if value:
                raise Unusable(f"--{name} is for a pair: give the surface of body 1 by --pair, or remove it")
    elif given.method == "cutoff":
        raise Unusable("--method cutoff is not for a pair, which has the method image only: remove it")
    elif given.depth and len(given.centers) > 1:
        raise Unusable("--depth: the file of several patches has no stresses: remove it, or give one patch")
    elif given.symmetry:
        raise Unusable("--symmetry: a pair is given as a whole: remove it, or give one body alone, without --pair")


def need_bolt(name, text=None):
    """Raises Unusable unless the file can have a bolt of this name."""
    if not NAME.fullmatch(name) or name in RESERVED:
        raise Unusable(
            f"{short(text or name)}: expected NAME=SURFACE1,SURFACE2:DIAMETER[:YOUNG], as in B1=HEAD,NUT:8mm"
        )
    if len("bolt_" + name) > LONGEST:
        raise Unusable(f"{short(name)}: use a name of at most {LONGEST - len('bolt_')} letters")


def _check_names(given):
    """Checks the names and the numbers of load cases, patches, bolts and sensors."""
    for bolt in given.bolts:
        need_bolt(bolt.name)
    if len(given.centers) > 1 and not given.pair:
        raise Unusable("--center: several patches are for a pair: give the surface of body 1 by --pair, or one centre")
    if len(given.centers) > 1 and any(re.fullmatch(several.NAME + r"[0-9]+", name) for name, _ in given.cases):
        raise Unusable(f"--case: {several.NAME} with a number is a name of the file's own: give another one")
    if given.sensors and not given.modes:
        raise Unusable("--sensor needs --modes: give their number, or remove it")
    if len({name for name, _ in given.sensors}) < len(given.sensors):
        raise Unusable("--sensor: give each name once")
    names = [name for name, _ in given.cases] + [f"bolt_{one.name}" for one in given.bolts]
    names += [f"mode{k}" for k in range(1, 1 + given.modes)]
    most = MOST_OF_PAIR if given.pair else MOST_CASES
    if len(set(names)) < len(names) or len(names) > most:
        bolts = ", with those of --bolt and --modes" if given.pair else ""
        raise Unusable(f"--case: give each name once, at most {most} of them{bolts}")

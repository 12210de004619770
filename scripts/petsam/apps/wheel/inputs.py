"""Inputs of petsam-wheel: profiles in their places, and positions."""

import contextlib

from ...core.errors import Error, Missing, Unusable, short
from .options import BUILT, JUMPS, KINDS, has_own, optioned, unlike, warn


@contextlib.contextmanager
def _named(option):
    """Errors of what an option names have the option before them; those of a file that cannot be read, too."""
    try:
        yield
    except Missing as error:
        raise Missing(f"{option}: {error}") from error
    except OSError as error:
        raise Error(f"{option}: {error.filename or 'file'}: {error.strerror or error}") from error
    except Error as error:
        text = f"{option}: {optioned(error)}"
        raise type(error)(text) if type(error) in (Error, Unusable) else error from error


def _read(options, kind, side):
    """A profile of the left (0) or right (1) side by its name or from its file."""
    from .. import wheel as profiles

    name = getattr(options, kind)[side]
    if name.lower() in BUILT:
        found = getattr(profiles, name.lower())()
        if found.kind != kind:
            raise Unusable(f"--{kind} {name}: is the profile of a {found.kind}: give --{found.kind} {name}")
        if options.mirror in (kind, "both"):
            raise Unusable(f"--mirror {options.mirror}: {name} has y to the field side: remove it")
    else:
        mirror = options.mirror in (kind, "both")
        unit, z = (given and given[KINDS.index(kind)] for given in (options.unit, options.z))
        with _named(f"--{kind}"):
            found = profiles.read(name, kind, None if has_own(name, "unit") else unit, z, mirror)
    if not options.smooth:
        return found
    with _named(f"--smooth {options.smooth:g}"):
        return found.smoothed(options.smooth)


def vehicle_of(options):
    """Rails and wheels."""
    from .. import wheel as profiles

    sides = [(_read(options, "rail", k), _read(options, "wheel", k), options.radius[k])
             for k in ((1, 0) if unlike(options) else (1,))]  # fmt: skip
    if options.curve is not None and not abs(options.curve) >= 10.0:
        raise Unusable(f"--curve {options.curve:g}: expected the radius in m, at least 10, positive to the right")
    curvature = 0.0 if options.curve is None else 1.0 / options.curve
    placed = [
        (
            profiles.Track(rail, options.gauge, options.gauge_height, options.cant, curvature, options.gauge_position),
            profiles.Wheelset(wheel, radius, options.flange_back, options.flange_position),
        )
        for rail, wheel, radius in sides
    ]
    given = {name: getattr(options, f"{name}_material") for name in ("rail", "wheel")}
    bodies = {name: profiles.Material(*numbers) for name, numbers in given.items() if numbers}
    settings = profiles.Settings(cell=options.cell, **bodies)
    left = placed[1] if len(placed) > 1 else None
    return profiles.Vehicle(*placed[0], options.friction, settings, left, options.rolling)


def states_of(options):
    """The positions."""
    from .. import wheel as profiles

    if options.table is not None:
        with _named("--table"):
            states, ignored = profiles.read_positions(options.table, options.load, options.speed)
        if ignored:
            warn(f"{options.table}: columns that are not used: {', '.join(map(short, ignored))}")
        return states
    load = profiles.Load(options.load, options.offset or 0.0, options.lateral, options.height or 0.0)
    places = [0.0] if options.y is None else options.y
    return [
        profiles.State(profiles.Position(y=float(y), yaw=options.yaw or 0.0, speed=options.speed), load) for y in places
    ]


def need_ready(options, vehicle, states):
    """Raises Unusable for wheels beside their rails, and wear that cannot be followed, before anything is solved."""
    from . import Position, wearing

    with vehicle.axle() as axle:
        try:
            axle.rigid(Position())
        except Error as error:
            raise Unusable(str(error).partition(": ")[2]) from error
    if options.wear is None:
        return
    law = wearing.Law(options.law or "energy", options.wear)
    with _named(f"--table {options.table}") if options.table else contextlib.nullcontext():
        wearing.shares(states)
    if options.distance is not None:
        wearing.need_shallow(vehicle, states, options.distance, law, options.jumps or JUMPS)

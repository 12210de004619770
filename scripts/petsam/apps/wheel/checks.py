"""Checks of the profiles and lengths from which rails, rollers and wheels are made."""

from ...core.errors import Error, Unusable
from .profile import Profile

GAUGES = (0.05, 4.0)  # m


def need(value, what, low, high, cure):
    """Raises Unusable unless a number lies within a range."""
    if not low <= value <= high:
        raise Unusable(f"{what} {value:g}: {cure}")


def need_kind(profile, kind, name):
    if not isinstance(profile, Profile):
        raise TypeError(f"{name}: expected a Profile, and not {type(profile).__name__}")
    if profile.kind != kind:
        raise Error(f"{profile.name}: is the profile of a {profile.kind}: {name} takes that of a {kind}")

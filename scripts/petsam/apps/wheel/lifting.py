"""Errors of a wheelset without an equilibrium: wheels that lift, climb or tip over, and forces that jump."""

from __future__ import annotations

import math

import numpy as np

from ...core.errors import Error
from .places import place
from .positions import SIDES

ALMOST = 0.05  # of the load or its moment: what is left where an iteration may still end
FACE = 0.5  # slope of a flange from which the equilibrium is tried by Newton's steps, too
WIDEST = 0.03  # m: end of the search for a lateral force
LIFTED = 0.1  # of the load: a wheel with less lifts


def no_equilibrium(axle, position, load, state, cases):
    """The error of an iteration without an end."""
    right, left = (float(found.force[2]) for found in state.found)
    where = f"y {position.y:g} m, load {load.vertical:g} N: no equilibrium: the rails carry {right:.4g} N (right) and "
    tips = _tips(axle, load, state)
    if tips:
        return Error(f"{where}{left:.4g} N (left) at last: {tips}")
    rest = max(abs(state.values))
    if rest <= ALMOST:
        return Error(f"{where}{left:.4g} N (left), and {rest:.2g} of the load or its moment is left: {_jump(cases)}")
    return Error(
        f"{where}{left:.4g} N (left) at last: a wheel lifts or climbs: check offset, lateral, height and y, and the "
        "flange"
    )


def wedged(axle, position, load, cases):
    """The error where forces are sought in overlaps that no elastic wheel has."""
    overlaps = [position.z - case.search.touch for case in cases]
    k = int(np.argmax(overlaps))
    slope = float(axle.pairs[k].rail.section.slope(np.array(place(cases[k]))))
    return Error(
        f"y {position.y:g} m, load {load.vertical:g} N: no equilibrium up to an overlap of {overlaps[k]:.3g} m of the "
        f"{SIDES[k]} wheel, which touches at an angle of {abs(math.atan(slope)):.3g} rad: a flange climbs, or lies "
        "against its rail along its face: take another y"
    )


def _jump(cases):
    """Why the forces of wheels that do not lift jump."""
    if any(case.at_end for case in cases):
        return (
            "a contact is cut by the end of a visible profile, where the forces jump from cell to cell: give more of "
            "the profile"
        )
    return (
        "no wheel lifts, but a contact moves between two regions of its profiles, where the forces change much with "
        "the height: take y a little beside it"
    )


def _tips(axle, load, state):
    """Why the wheelset tips over where a flange carries most of the load; empty where it does not tip.

    On a face of the inclination d a wheel that carries the whole load needs a lateral force of load tan d; below the
    line in which it is applied this turns the wheelset about x by more than the load on one wheel can hold.
    """
    loads = [float(found.force[2]) for found in state.found]
    heavy = int(np.argmax(loads))
    if not loads[1 - heavy] < LIFTED * load.vertical or not state.found[heavy].patches:
        return ""
    angle = max(abs(patch.angle) for patch in state.found[heavy].patches)
    arm = axle.wheel.radius - load.height
    lever = state.half + (load.offset if heavy else -load.offset)
    if load.right is not None or math.tan(angle) < FACE or not 0.0 < lever < arm * math.tan(angle):
        return ""
    return (
        f"the {SIDES[heavy]} flange touches at an angle of {angle:.3g} rad, where the lateral force that holds the "
        f"wheelset, {arm:.3g} m above the rails, tips it, and the {SIDES[1 - heavy]} wheel lifts: above "
        f"about {math.atan(lever / arm):.3g} rad there is no equilibrium: give height, where it acts, or another y"
    )


def derails(load, solved):
    reached = max((abs(one.lateral) for one in solved.values()), default=0.0)
    return Error(
        f"lateral {load.lateral:g} N: no lateral displacement up to {WIDEST:g} m gives it (up to {reached:.4g} N were "
        "found): the wheelset climbs: reduce it, or raise the axle load"
    )

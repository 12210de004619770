"""Interactions of an interface in decks of Abaqus and CalculiX, in N, mm, s, K, V, A: abaqus(), calculix()."""

from typing import Any

import numpy as np

from .conductance import rows

TEMPERATURE = 293.0  # K, of the rows for CalculiX: one temperature holds for all
ANALOGY = (
    "** CalculiX has no electrical contact: for a thermal step as that of a current, with conductivities in S/mm,",
    "** potentials in V as temperatures, and currents in A as heat",
)


def _friction(found):
    """Elastic slips of the penalty method at all pressures, mm."""
    of = found.numbers
    return 1e3 * found.friction * of["pressure"] * 2 / (of["k_t_x"] + of["k_t_y"])


def _left_out(found):
    """Comments of the conductance: what it is of, and what it does not contain."""
    kind, unit, less = "thermal", "mW/(mm2 K)", "radiation and heat of friction"
    if found.conductors.electrical:
        kind, unit, less = "electrical", "S/mm2", "heat of the current"
    layers = []
    if any(found.conductors.layers):
        layers = [
            "** layers change the constriction; their resistance to a uniform flux beyond the body's is left out:",
            "** thickness (1/lam of the layer - 1/lam of the body)",
        ]
    return [
        f"** {kind} conductance in {unit} over the pressure in MPa, computed from the scanned surface by petsam:",
        f"** {found.conductors.words()}",
        "** constriction of the interface alone: the bodies' own resistance is that of their elements;",
        *layers,
        f"** without {less}; conductivities do not change with temperature",
        "** at pressure 0 the gap alone, as at the lowest computed pressure; at a tenth of that pressure the contact's",
        "** part is extrapolated in proportion to the power 0.95",
    ]


def _conductances(found):
    """(MPa, mW/(mm2 K) or S/mm2) of the rows."""
    factor = 1e-6 if found.conductors.electrical else 1e-3
    return [(p / 1e6, factor * h) for p, h in rows(found.numbers)]


def abaqus(found: Any, name: str) -> list[str]:
    """Returns the lines of an Interface for Abaqus, under a name: pressure over overclosure, friction, and the
    conductance, if computed."""
    comments = [
        "** contact stiffness of a rough interface; pressure in MPa, overclosure from the first touch in mm,",
        "** linear between the rows",
    ]
    friction = []
    if found.friction is not None:
        slips = _friction(found)
        slip = np.median(slips)
        comments += [
            f"** elastic slip in mm: median of {min(slips):.4g} to {max(slips):.4g} at these pressures, so that the",
            f"** tangential stiffness is {min(slips) / slip:.3g} to {max(slips) / slip:.3g} times the computed one",
        ]
        friction = [f"*FRICTION, ELASTIC SLIP={slip:.4g}", f"{found.friction:.6g}"]
    lines = [
        *comments,
        f"*SURFACE INTERACTION, NAME={name}",
        "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=TABULAR",
        "0., 0.",
        *(f"{p / 1e6:.6g}, {d * 1e3:.6g}" for p, d in zip(found.numbers["pressure"], found.numbers["closure"])),
        *friction,
    ]
    if found.conductors is None:
        return lines
    card = "*GAP ELECTRICAL CONDUCTANCE" if found.conductors.electrical else "*GAP CONDUCTANCE"
    return [*lines, *_left_out(found), f"{card}, PRESSURE", *(f"{h:.6g}, {p:.6g}" for p, h in _conductances(found))]


def calculix(found: Any, name: str) -> list[str]:
    """Returns the lines of an Interface with a conductance for CalculiX, under a name: a linear overclosure, friction,
    and the conductance. CalculiX has no electrical contact: a current is written as heat, whose equations are the
    same."""
    of = found.numbers
    slope = 1e-9 * float(np.median(of["k_n_secant"]))
    lines = [
        "** interaction of a rough interface, for *CONTACT PAIR, TYPE=SURFACE TO SURFACE;",
        "** linear overclosure, the median of pressure over closure, as CalculiX 2.20 finds the conductance's pressure",
        "** by a linear one alone, neither by a table nor of pairs NODE TO SURFACE",
        *_left_out(found),
        *(ANALOGY if found.conductors.electrical else ()),
        f"*SURFACE INTERACTION, NAME={name}",
        "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR",
        f"{slope:.6g}",
    ]
    if found.friction is not None:
        k_t = 1e-9 * float(np.median(of["k_t_x"] + of["k_t_y"])) / 2
        lines += ["*FRICTION", f"{found.friction:.6g}, {k_t:.6g}"]
    given = (f"{h:.6g}, {p:.6g}, {TEMPERATURE:g}" for p, h in _conductances(found))
    return [*lines, "*GAP CONDUCTANCE", *given]

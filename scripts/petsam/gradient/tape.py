"""A history whose steps are recorded, from which gradients go back."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike

from ..contact import Contact, ContactError
from ..core import materials
from ..core.errors import Error
from .halfspace import Influence

COMPONENTS = ("n", "mx", "my", "tx", "ty", "mz")  # normal ones first
LOADS = tuple("load_" + name for name in COMPONENTS)
WAYS = ("disp_z", "rot_x", "rot_y", "disp_x", "disp_y", "rot_z")  # conjugate to them
STILL = 1e-5  # of the displacement of a cell by the largest bound: shorter slip in a step is the solver's error
LEAST_RTOL = 1e-5  # tolerance of the tangential problem from which on sets of cells are not those of the solution
WEAR = ("wear_coefficient1", "wear_coefficient2", "wear_energy1", "wear_energy2")
BULK = tuple(f"bulk{body}_stress_{name}" for body in (1, 2) for name in ("xx", "yy", "xy"))
ABSENT = {"halfspace": (), "plane": (1, 5), "periodic": (1, 2, 5)}  # components that such bodies do not have
REFUSED = {
    "pressure_limit": "hardness", "body1_yield": "yielding", "body2_yield": "yielding", "rolling": "rolling",
    "friction_law": "friction that changes", "heat": "heat", "slide": "surfaces that slide", "film_shear": "a film",
    "body1_compliance": "finite bodies", "body2_compliance": "finite bodies",
    "body1_layer_young": "layers", "body2_layer_young": "layers", "body1_layer_file": "layers",
    "body2_layer_file": "layers", "body1_layers": "layers", "body2_layers": "layers", "step_rtol": "divided steps",
}  # fmt: skip


@dataclass
class Record:
    """A solved step on the tape's window: (ny, nx), vectors (2, ny, nx).

    Attributes
    ----------
    pressure, shear, slip : ndarray
        Pa; Pa; m, the sum of all steps.
    state : ndarray
        0 open, 1 stick, 2 slip.
    loads : ndarray of bool
        Components that are given by loads, (6,), in the order of LOADS.
    bulk : ndarray
        Bulk stresses, Pa, in the order of BULK.
    """

    pressure: np.ndarray
    shear: np.ndarray
    slip: np.ndarray
    state: np.ndarray
    loads: np.ndarray
    bulk: np.ndarray = field(default_factory=lambda: np.zeros(6))


@dataclass
class Tape:
    """The steps of a history, for gradients: see record().

    Attributes
    ----------
    influence : Influence
        Products on the window of all cells that are in contact in some step.
    window : tuple of slice
        Rows and columns of the window.
    shape : tuple of int
        (ny, nx) of the grid.
    motions : ndarray
        Unit motions of the six components in cells of the window: (3, ny, nx) of the normal ones, then (3, 2, ny, nx).
    friction : ndarray
        Coefficient of friction, (ny, nx).
    bodies : ndarray
        E1 (Pa), nu1, E2, nu2.
    records : list of Record
    energies : ndarray
        Dissipated energy of each step, as the contact has it, J.
    ways : ndarray
        Displacements of the six components in each step, (steps, 6), m and rad.
    wear : ndarray
        Coefficients of wear of both bodies together, by pressure and by energy, 1/Pa.
    kind : str
        "halfspace", "plane" or "periodic".
    """

    influence: Influence
    window: tuple
    shape: tuple
    motions: tuple
    friction: np.ndarray
    bodies: np.ndarray
    records: list = field(default_factory=list)
    energies: np.ndarray = field(default_factory=lambda: np.zeros(0))
    ways: np.ndarray = field(default_factory=lambda: np.zeros((0, 6)))
    wear: np.ndarray = field(default_factory=lambda: np.zeros(2))
    kind: str = "halfspace"

    @property
    def area(self) -> float:
        """Area of a cell, m2."""
        return self.influence.cell[0] * self.influence.cell[1]

    def whole(self, values: np.ndarray) -> np.ndarray:
        """A field of the window on the whole grid.

        Parameters
        ----------
        values : ndarray
            Of the window's cells.

        Returns
        -------
        ndarray
            (ny, nx) of the grid, 0 outside of the window.
        """
        found = np.zeros(self.shape)
        found[self.window] = values
        return found


def _refuse(options):
    for name, what in REFUSED.items():
        value = options.get(name)
        if value not in (None, "none", False, 0, ""):
            raise Error(f"gradient: {name}: the derivative of {what} is not computed: omit it")
    kind = _kind(options)
    if kind not in ABSENT:
        raise Error(f"gradient: elasticity {kind}: expected {', '.join(ABSENT)}")
    if str(options.get("slip_direction", "mid")) != "end":
        raise Error("gradient: slip is taken opposite to the shear at the end of a step: give slip_direction='end'")
    if str(options.get("coupling", "full")) != "full":
        raise Error(f"gradient: coupling {options['coupling']}: expected full coupling of pressure and shear")
    rtol = float(options.get("tangential_rtol", 1e-6))
    if rtol > LEAST_RTOL:
        raise Error(
            f"gradient: tangential_rtol {rtol:g}: cells that stick are not certain: expected at most {LEAST_RTOL:g}"
        )


def _kind(options):
    """The kind of bodies."""
    return str(options.get("elasticity", "halfspace"))


def _has_steps(contact):
    try:
        contact.field("pressure")
    except ContactError:
        return False
    return True


def _bodies(options):
    found = []
    for body in (1, 2):
        named = options.get(f"body{body}")
        pair = materials.elastic(str(named)) if named is not None else (None, None)
        for name, default in zip(("young", "poisson"), pair):
            value = options.get(f"body{body}_{name}", default)
            if value is None:
                raise Error(f"gradient: body{body}_{name} is not among the options of the contact")
            found.append(float(value))
    if not np.all(np.isfinite(found)):
        raise Error("gradient: a rigid body has no derivative by its modulus: give it a large finite one")
    return np.array(found)


def record(contact: Contact, history: Mapping[str, ArrayLike]) -> Tape:
    """Solves a history from the contact's state, which must be the initial one, and records its steps.

    Parameters
    ----------
    contact : Contact
        A contact of half-spaces, in plane strain or of periodic bodies, without a committed step, with
        slip_direction="end"; it may wear in its steps. For derivatives of many digits with tight tolerances,
        normal_rtol=1e-12, tangential_rtol=1e-12: the default ones leave about 1e-5.
    history : mapping
        {column: values}: time, loads, displacements and bulk stresses, each (rows,); other columns are refused.

    Returns
    -------
    Tape

    Raises
    ------
    Error
        If the contact has a law whose derivative is not computed, steps before, or several ranks; if a column is none
        of a load or displacement.
    NoEquilibrium, NotConverged
        If a step has no solution.
    """
    options = contact.options
    _refuse(options)
    if contact.rows != contact.n[1]:
        raise Error("gradient: the contact has several ranks: expected one")
    if _has_steps(contact):
        raise Error("gradient: the contact has steps already: give a new one, or call its reset()")
    unknown = sorted(set(history) - {"time", *LOADS, *WAYS, *BULK})
    if unknown:
        raise Error(f"gradient: column {unknown[0]}: expected loads and displacements, {', '.join(LOADS + WAYS)}, or "
                    f"bulk stresses, {BULK[0]} and so on")  # fmt: skip
    kind = _kind(options)
    loads = np.array([way not in history and i not in ABSENT[kind] for i, way in enumerate(WAYS)])
    found, energies, ways = [], [], []

    def keep(one, step):
        fields = {name: one.field(name) for name in ("pressure", "shear_x", "shear_y", "slip_x", "slip_y", "state")}
        found.append(fields)
        energies.append(one.number("dissipated_energy"))
        ways.append([getattr(step, name) for name in WAYS])

    contact.run(history, keep)
    touched = np.any([one["pressure"] > 0 for one in found], axis=0)
    if not touched.any():
        raise Error("gradient: there is no contact in the history")
    touched |= kind == "periodic"  # the window is the period
    rows, columns = (np.flatnonzero(touched.any(axis=axis)) for axis in (1, 0))
    window = slice(rows[0], rows[-1] + 1), slice(columns[0], columns[-1] + 1)
    x, y = np.meshgrid(contact.x[window[1]], contact.y[window[0]])
    one, none = np.ones_like(x), np.zeros_like(x)
    motions = np.stack([one, -y, x]), np.stack([np.stack([one, none]), np.stack([none, one]), np.stack([-y, x])])
    bodies = _bodies(options)
    cell = tuple(size / n for size, n in zip(contact.size, contact.n))
    friction = np.broadcast_to(contact._given.get("friction", float(options.get("friction", 0.0))), touched.shape)
    influence = Influence(x.shape, cell, bodies, kind, float(options.get("plane_datum", contact.size[0])))
    tape = Tape(influence, window, touched.shape, motions, friction[window], bodies, kind=kind)
    tape.wear = np.add(
        *(np.array([float(options.get(name, 0.0)) for name in pair]) for pair in (WEAR[::2], WEAR[1::2]))
    )
    bulk = [np.broadcast_to(history.get(name, float(options.get(name, 0.0))), len(found)) for name in BULK]
    for fields, stresses in zip(found, np.transpose(bulk)):
        of = {name: values[window].astype(float) for name, values in fields.items()}
        tape.records.append(Record(
            of["pressure"], np.stack([of["shear_x"], of["shear_y"]]), np.stack([of["slip_x"], of["slip_y"]]),
            of["state"], loads, stresses,
        ))  # fmt: skip
    tape.energies, tape.ways = np.array(energies), np.array(ways)
    return tape

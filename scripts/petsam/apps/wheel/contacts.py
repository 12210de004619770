"""Contacts in process for patches, kept by the numbers of their cells, and one solution on a patch."""

import warnings
from collections import OrderedDict
from dataclasses import dataclass
from typing import Union

import numpy as np

from ...contact.errors import AdviceWarning, EdgeContactWarning
from ...contact.inprocess import Contact
from ...core import materials
from ...core.brief import brief
from ...core.errors import Error, Unusable

MULTIPLE = 4  # numbers of cells are multiples of it, so that few grids occur
MOST = 1024  # cells along x or s
KEPT = 64  # contacts
WIDEST = 5e-3  # m: of a cell
SPARE = 8  # cells by which a grid that is there may be wider than a new one
COARSER = 3  # cells of a draft
DRAFTED = dict(tangential_rtol=1e-5, normal_rtol=1e-7, edges="none")  # of a draft


@dataclass(frozen=True)
class Material:
    """An isotropic elastic body.

    Parameters
    ----------
    young : float
        Young's modulus, Pa.
    poisson : float
        Poisson's ratio.

    Raises
    ------
    Error
        If they are not those of an elastic body.
    """

    young: float = materials.TABLE["steel"].young
    poisson: float = materials.TABLE["steel"].poisson

    def __post_init__(self) -> None:
        if not (1e5 < self.young < np.inf and 0.0 <= self.poisson < 0.5):
            raise Unusable(
                f"Material {self.young:g}, {self.poisson:g}: expected Young's modulus (Pa) and Poisson's ratio"
            )

    @property
    def compliance(self) -> float:
        """(1 - nu^2)/E, 1/Pa."""
        return (1.0 - self.poisson**2) / self.young


@dataclass(frozen=True)
class Settings:
    """Materials, cells and limits of the solution.

    Parameters
    ----------
    rail, wheel : Material
        Of the bodies; steel by default.
    cell : float
        Width of a cell along x and s, m.
    separation : float
        Distance of two regions of overlap up to which they share a grid, m.
    combination : float
        Below `separation`, m: regions up to 2 separation - combination apart are turned towards each other.
    rtol : float
        Relative error of the vertical force.

    Raises
    ------
    Error
        If a number is out of range.
    """

    rail: Material = Material()
    wheel: Material = Material()
    cell: float = 2e-4
    separation: float = 8e-3
    combination: float = 4e-3
    rtol: float = 1e-5

    def __post_init__(self) -> None:
        if not 1e-6 <= self.cell <= WIDEST:
            raise Unusable(f"cell {self.cell:g}: expected the width of a cell in m, such as 2e-4")
        if not 0.0 <= self.combination < self.separation < 0.2:
            raise Unusable(
                f"combination {self.combination:g}, separation {self.separation:g}: expected two lengths in m, the "
                "first one below the second"
            )
        if not 1e-10 <= self.rtol <= 0.1:
            raise Unusable(f"rtol {self.rtol:g}: expected a relative error from 1e-10 to 0.1")

    @property
    def modulus(self) -> float:
        """E* of both bodies, Pa."""
        return 1.0 / (self.rail.compliance + self.wheel.compliance)


class Contacts:
    """Contacts of two bodies, one for each number of cells, of the materials and cells in the settings. With
    `extrapolate` loads are extrapolated to fine grids, too; never those of drafts."""

    def __init__(self, settings: Settings, extrapolate: bool = True) -> None:
        self.settings, self.extrapolate = settings, extrapolate
        self._kept: OrderedDict[tuple, Contact] = OrderedDict()

    def cell(self, draft: bool) -> float:
        """Width of a cell, or of a draft's cell, m."""
        return self.settings.cell * (COARSER if draft else 1)

    def of(self, widths: np.ndarray, draft: bool = False) -> Contact:
        """The contact whose grid covers a box of these widths along x and s (2,), m: the last one that is little wider,
        or a new one. The grid is centred at 0 and wider than the box by a cell at least; a draft's cells are coarser,
        and it is solved less accurately. Raises Error if the grid would be too large."""
        cell = self.cell(draft)
        nx, ns = (int(np.ceil((width / cell + 1.0) / MULTIPLE)) * MULTIPLE for width in widths)
        n = nx, ns
        if max(n) > MOST:
            x, s = widths
            raise Error(f"cell {cell:g}: the overlap of {x:g} x {s:g} m needs {n[0]} x {n[1]} cells: give wider ones")
        key = self._fitting(n, draft) or (n, draft)
        if key not in self._kept:
            if len(self._kept) >= KEPT:
                self._kept.popitem(last=False)[1].close()
            self._kept[key] = self._made(n, draft)
        self._kept.move_to_end(key)
        return self._kept[key]

    def _fitting(self, n, draft):
        """The key of the last contact that is as wide or little wider; None: there is none."""
        for key in reversed(self._kept):
            (nx, ns), is_draft = key
            if is_draft == draft and 0 <= nx - n[0] <= SPARE and 0 <= ns - n[1] <= SPARE:
                return key
        return None

    def _made(self, n, draft):
        """A new contact of so many cells."""
        rail, wheel = self.settings.rail, self.settings.wheel
        return Contact(
            grid_n=n, grid_size=tuple(k * self.cell(draft) for k in n), gap_type="flat", rolling="steady", friction=1.0,
            body1_young=rail.young, body1_poisson=rail.poisson, body2_young=wheel.young, body2_poisson=wheel.poisson,
            extrapolate=self.extrapolate and not draft, **(DRAFTED if draft else {}),
        )  # fmt: skip

    def close(self) -> None:
        """Frees all contacts."""
        while self._kept:
            self._kept.popitem()[1].close()


@brief
@dataclass(frozen=True, eq=False)
class Solution:
    """A solution on a patch: normal force n (N); T_x and T_s on the wheel's half-space, (2,), N, and the moment M_z
    about the patch's origin, N m, both of the other sign on the rail; further numbers of the step; texts of
    warnings."""

    n: float
    shear: np.ndarray
    moment: float
    numbers: dict[str, float]
    advice: list[str]


def solved(
    contact: Contact,
    gap: np.ndarray,
    approach: float,
    creeps: tuple[float, float, float],
    friction: float,
    middle: Union[np.ndarray, tuple[float, float]],
) -> Solution:
    """Solves steady rolling under an approach (m) and creepages along x and s and spin (1/m) at the patch's origin, and
    keeps the solution as the next one's start. The contact's grid is centred at 0; `gap` is the separation of the
    undeformed bodies, 0 where it is least, (ns, nx), m; `middle` is the grid's centre in the patch, (2,), m."""
    x, s, spin = creeps
    given = dict(disp_z=approach, rot_x=0.0, rot_y=0.0, friction_scale=friction)
    moved = dict(creep_x=x - spin * middle[1], creep_y=s + spin * middle[0], creep_spin=spin)
    contact.gap = gap
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        step = contact.try_step(**given, **moved)
        contact.commit()
    advice = [str(one.message) for one in caught if issubclass(one.category, (AdviceWarning, EdgeContactWarning))]
    tx, ts = step.load_tx, step.load_ty
    return Solution(
        step.load_n, np.array([tx, ts]), step.load_mz + middle[0] * ts - middle[1] * tx, dict(step.numbers), advice
    )

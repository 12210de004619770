"""The conductance of a contact in process: constriction, layers, films and gas in one problem."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any, Optional, Union

import numpy as np
from numpy.typing import ArrayLike

from ...core.brief import brief
from ...core.errors import Error
from .layers import Body
from .spots import conduct

PERIODIC = ("periodic", "plane_periodic")


@brief
@dataclass(frozen=True)
class Conductance:
    """The conductance of a contact, of a pair of half-spaces or of one period.

    Attributes
    ----------
    total : float
        Flux for a difference of potentials of 1, W/K, or S (A/V).
    per_area : float
        The same over the area of the grid, W/(m2 K), or S/m2: of one period the conductance of the interface.
    contact : float
        The part of `per_area` that passes through the contact; the rest passes through the gas.
    flux : ndarray
        Flux density for a difference of 1, (ny, nx), W/(m2 K), or S/m2.
    """

    total: float
    per_area: float
    contact: float
    flux: np.ndarray

    @property
    def resistance(self) -> float:
        """Difference of potentials for a flux of 1, K/W, or Ohm."""
        return 1 / self.total

    @property
    def gap(self) -> float:
        """The part of `per_area` that passes through the gas, W/(m2 K), or S/m2."""
        return self.per_area - self.contact


Conductivity = Union[float, str]  # a number, or the name of a material
Layers = Sequence[tuple[float, Conductivity]]


def of(  # noqa: PLR0913  (each body has a conductivity and layers)
    contact: Any,
    lam1: Conductivity,
    lam2: Conductivity,
    film: Union[float, ArrayLike, None] = None,
    gas: Optional[tuple[float, float]] = None,
    rtol: float = 1e-8,
    layers1: Optional[Layers] = None,
    layers2: Optional[Layers] = None,
) -> Conductance:
    """The thermal, or electrical, conductance of the committed step of a contact.

    Parameters
    ----------
    contact : petsam.Contact
        The contact, with a step. Of bodies of type periodic it is one period of an interface; else the spreading of the
        flux into both half-spaces is included, which a finite element model around it must not have again.
    lam1, lam2 : float or str
        Conductivities of both bodies, W/(m K), or S/m; or materials' names (petsam.materials), as in the layers.
    film : float or array_like, optional
        Resistance of a film on the cells in contact, K m2/W, or Ohm m2; (ny, nx) where it varies.
    gas : pair of floats, optional
        Conductivity of what fills the gap (W/(m K)), and the length of the temperature jump (m): of air 0.026, 0.37e-6.
    rtol : float
        Relative residual at which the solution is accepted; the error of the conductance goes with its square.
    layers1, layers2 : sequence of (thickness, conductivity), optional
        Layers on each body from the surface inwards, m and W/(m K), or S/m; () says that there is none that matters.

    Returns
    -------
    Conductance

    Raises
    ------
    Error
        If there is no contact, a number is not positive, a body has elastic layers whose conductivity is not given, or
        the bodies are of finite elements, or in plane strain, where a contact has no conductance of its own.

    Notes
    -----
    Conducting layers are independent of elastic ones. Of a period the resistance of a layer to a uniform flux is left
    out, as that of the bodies: thickness (1/conductivity - 1/lam) more than the body alone.

    Films lie on the area of contact, of which counted cells are too many: their resistance is raised by the counted
    over the reconstructed area (`contact_area`).
    """
    if not hasattr(contact, "number"):
        raise Error(f"conduction: {contact!r}: expected a contact with a step, or results")
    bodies = Body(lam1, layers1 or ()).checked(), Body(lam2, layers2 or ()).checked()
    periodic = _is_periodic(contact, layers1, layers2)
    pressure = contact["pressure"]
    touches = pressure > 0
    cell = tuple(size / n for size, n in zip(contact.size, contact.n))
    resistance = np.zeros(pressure.shape)
    if film is not None:
        counted = touches.sum() * cell[0] * cell[1]
        area = contact.number("contact_area")
        resistance = np.asarray(film, dtype=float) * np.where(
            touches, max(1.0, counted / area) if area > 0 else 1.0, 0.0
        )
    conducts = touches
    if gas is not None:
        lam, jump = gas
        if not (lam > 0 and jump >= 0):
            raise Error(f"conduction: gas {lam:g}, {jump:g}: expected a conductivity > 0 and a length >= 0")
        resistance = np.where(touches, resistance, (np.maximum(contact["gap"], 0.0) + jump) / lam)
        conducts = np.ones_like(touches)
    flux = conduct(conducts, cell, bodies, resistance, periodic, rtol)
    area = contact.size[0] * contact.size[1]
    total = float(flux.sum()) * cell[0] * cell[1]
    return Conductance(total, total / area, float(flux[touches].sum()) * cell[0] * cell[1] / area, flux)


def _is_periodic(contact, layers1, layers2):
    """Returns True for periodic bodies; Error where no conductance is known."""
    options = contact.options
    kind = str(options.get("elasticity", "halfspace"))
    if kind.startswith("plane"):
        raise Error(
            "conduction: in plane strain a contact's conductance has no limit far away: use a section of one period"
        )
    need_conducting(options, layers1, layers2)
    return kind in PERIODIC


def need_conducting(options: Iterable[str], layers1: Optional[Layers] = None, layers2: Optional[Layers] = None) -> None:
    """Raises Error where options make finite bodies, or elastic layers of which it is not known how they conduct.

    Parameters
    ----------
    options : iterable of str
        Names of the options.
    layers1, layers2 : sequence of (thickness, conductivity), optional
        Conducting layers of each body; None: not given.
    """
    for name in options:
        if "_compliance" in name:
            raise Error(f"conduction: {name}: the flux through finite bodies is not computed: omit it")
        for body, layers in (("1", layers1), ("2", layers2)):
            if f"body{body}_layer" in name and layers is None:
                raise Error(
                    f"conduction: {name}: give also how the layers conduct: layers{body}=[(thickness, conductivity), "
                    "...] from the surface inwards"
                )

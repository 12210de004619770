"""Single cases of the table of creep forces: steady rolling on Hertz's ellipse, in process, in numbers without units.

Creepages are xi' = G c^2 xi/(mu N), eta' likewise, phi' = G c^3 phi/(mu N), with c^2 = a b; forces are Fx/(mu N),
Fy/(mu N) and Mz/(mu N c). A positive creepage gives a positive force.

Reference: J. J. Kalker, Three-Dimensional Elastic Bodies in Rolling Contact (1990).
"""

import warnings

import numpy as np

from petsam.closed.ellipse import hertz_radii
from petsam.contact.errors import AdviceWarning
from petsam.contact.inprocess import Contact

SHEAR, PEAK, LENGTH = 82e9, 800e6, 1e-3  # Pa: G, maximum pressure; m: c
FRICTION = 0.3
ADHESION, SMALL = 1e4, 1e-6  # friction and creepage without slip
MARGIN = 1.1  # width of the grid relative to that of the contact
POINTS = 400  # of the quadrature of full sliding, along each axis


class Rolling:
    """Steady rolling on an ellipse.

    Parameters
    ----------
    ratio : float
        a/b, where a is the half axis along the rolling direction.
    poisson : float
        Poisson's ratio of both bodies.
    cells : int
        Cells of the grid along each axis.
    """

    def __init__(self, ratio: float, poisson: float, cells: int) -> None:
        a, b = LENGTH * np.sqrt(ratio), LENGTH / np.sqrt(ratio)
        young = 2.0 * SHEAR * (1.0 + poisson)
        self.load = 2.0 / 3.0 * np.pi * PEAK * a * b
        radii = hertz_radii(a, b, self.load, SHEAR / (1.0 - poisson))
        self.contact = Contact(
            grid_n=cells, grid_size=(2.0 * MARGIN * a, 2.0 * MARGIN * b), gap_type="ellipsoid", gap_radius_x=radii[0],
            gap_radius_y=radii[1], rolling="steady", friction=1.0, body1_young=young, body2_young=young,
            body1_poisson=poisson, body2_poisson=poisson,
        )  # fmt: skip

    def forces(self, creepages: np.ndarray, friction: float = FRICTION) -> np.ndarray:
        """The forces of one case, extrapolated to fine grids; the next case starts from its solution.

        Parameters
        ----------
        creepages : ndarray
            xi', eta', phi', (3,).
        friction : float
            Coefficient of friction; the result depends on it only by rounding.

        Returns
        -------
        ndarray
            Fx/(mu N), Fy/(mu N), Mz/(mu N c), (3,).
        """
        traction = friction * self.load
        unit = traction / (SHEAR * LENGTH**2)
        xi, eta, phi = (unit * one for one in creepages)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", AdviceWarning)
            step = self.contact.try_step(
                load_n=self.load, friction_scale=friction, creep_x=xi, creep_y=eta, creep_spin=phi / LENGTH,
                load_mx=0.0, load_my=0.0,
            )  # fmt: skip
            self.contact.commit()
        loads = np.array([step.numbers[f"load_{name}_extrapolated"] for name in ("tx", "ty", "mz")])
        return loads / traction / np.array([1.0, 1.0, LENGTH])

    def coefficients(self) -> np.ndarray:
        """Kalker's coefficients: the forces without slip.

        Returns
        -------
        ndarray
            C11, C22, C23, C33, (4,).
        """
        x, y, spin = (self.forces(SMALL * one, ADHESION) / SMALL for one in np.eye(3))
        return np.array([x[0], y[1], 0.5 * (spin[1] - y[2]), spin[2]])

    def close(self) -> None:
        """Frees the contact."""
        self.contact.close()


def linear(coefficients: np.ndarray, creepages: np.ndarray) -> np.ndarray:
    """The forces of the linear theory, without slip.

    Parameters
    ----------
    coefficients : ndarray
        C11, C22, C23, C33, (4,).
    creepages : ndarray
        xi', eta', phi', (..., 3).

    Returns
    -------
    ndarray
        Of the form of creepages.
    """
    c11, c22, c23, c33 = coefficients
    return creepages @ np.array([[c11, 0.0, 0.0], [0.0, c22, -c23], [0.0, c23, c33]])


def sliding(ratio: float, creepages: np.ndarray) -> np.ndarray:
    """The forces of full sliding: mu p along the rigid slip, without elastic displacements.

    Parameters
    ----------
    ratio : float
        a/b.
    creepages : ndarray
        xi', eta', phi', of which only the directions count, (3,).

    Returns
    -------
    ndarray
        (3,).
    """
    ring = np.sqrt((np.arange(POINTS) + 0.5) / POINTS)  # rings of one area
    angle = 2.0 * np.pi * (np.arange(POINTS) + 0.5) / POINTS
    x = np.sqrt(ratio) * np.outer(ring, np.cos(angle))
    y = np.outer(ring, np.sin(angle)) / np.sqrt(ratio)
    pressure = np.sqrt(1.0 - ring**2)[:, None] * np.ones(POINTS)
    slip = np.array([creepages[0] - creepages[2] * y, creepages[1] + creepages[2] * x])
    size = np.hypot(*slip)
    qx, qy = pressure / pressure.sum() * slip / np.where(size > 0.0, size, 1.0)
    return np.array([qx.sum(), qy.sum(), (x * qy - y * qx).sum()])

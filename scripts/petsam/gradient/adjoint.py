"""The adjoint of a step of the contact whose sets of cells are frozen.

With gamma, tau and beta the cotangents of the gap, of the slip and of the bound of the shear, V what later steps leave
for the slip, c_p, c_q and c_d the derivatives of the objective by pressure, shear and rigid-body displacements,
e = q/|q|, n_e its normal and L = |ds|/b,

    tau = V - lambda,   r = c_q + C tau + X gamma - t nu_t dA,
    stick    r = 0,
    slip     n_e.r = L n_e.lambda,   lambda along n_e,   beta = e.r,
    contact  c_p + S gamma + X' tau + mu beta - n nu_n dA = 0,
    loads    n.gamma = c_d,   t.tau = c_d   of each component that is given by a load.

The unknowns are (-gamma, lambda, nu). The system is the transpose of the step's linear response. It is solved by
generalised conjugate residuals whose directions have no part in the rows of the loads; residuals are taken off the
columns of nu, so that nu follows at the end.
"""

from dataclasses import dataclass

import numpy as np

from ..core.errors import Error
from .tape import STILL, Record, Tape

MOST = 400  # operator applications of a step


@dataclass
class Sets:
    """The frozen cells of a step: masks (ny, nx), and of cells that slip e and n_e (2, ny, nx), ds and its length.

    Attributes
    ----------
    contact, slip : ndarray of bool
    along, across : ndarray
        e, and its normal; 0 where nothing slips.
    ds : ndarray
        Slip of the step, m; 0 where nothing slips.
    length : ndarray
        Its length, m.
    stiff : ndarray
        L = |ds|/b, m/Pa.
    """

    contact: np.ndarray
    slip: np.ndarray
    along: np.ndarray
    across: np.ndarray
    ds: np.ndarray
    length: np.ndarray
    stiff: np.ndarray


def sets_of(tape: Tape, k: int) -> Sets:
    """The frozen cells of step k."""
    now = tape.records[k]
    ds = now.slip - (tape.records[k - 1].slip if k else 0.0)
    bound, length = tape.friction * now.pressure, np.hypot(*ds)
    contact = now.pressure > 0
    slip = contact & (now.state == 2) & (length > STILL * tape.influence.own[1] * bound.max()) & (bound > 0)
    size = np.where(slip, np.hypot(*now.shear), 1.0)
    along = np.where(slip, now.shear / size, 0.0)
    across = np.stack([-along[1], along[0]])
    stiff = np.divide(length, bound, out=np.zeros_like(length), where=slip)
    return Sets(contact, slip, along, across, np.where(slip, ds, 0.0), np.where(slip, length, 0.0), stiff)


def borders(tape: Tape, k: int, sets: Sets, eps: float) -> int:
    """Cells of step k that are about to change their set: the gradient is one-sided there."""
    now = tape.records[k]
    bound = tape.friction * now.pressure
    weak = sets.contact & (now.pressure < eps * now.pressure.max())
    near = sets.contact & ~sets.slip & (bound > 0) & (np.hypot(*now.shear) > (1 - eps) * bound)
    still = sets.slip & (sets.length < 10 * STILL * tape.influence.own[1] * bound.max())
    return int((weak | near | still).sum())


class System:
    """The adjoint of a step.

    Parameters
    ----------
    tape : Tape
    step : Record
    sets : Sets
    rtol : float
        Residual relative to the right-hand side at which it is solved.
    """

    def __init__(self, tape: Tape, step: Record, sets: Sets, rtol: float) -> None:
        self.tape, self.step, self.sets, self.rtol = tape, step, sets, rtol
        self.slides = np.where(sets.slip, tape.friction, 0.0)
        rubs = np.any(tape.friction[sets.contact] > 0)
        self.given = [i for i in np.flatnonzero(step.loads) if i < 3 or rubs]  # without friction there is no shear
        self.columns = [self.rows_of(*self.motion(i)) for i in self.given]
        self.rows = [self._row(i) for i in self.given]
        own = tape.influence.own[1]
        self._weight = own / (own + sets.stiff)

    # fields of unknowns are (3, ny, nx): of the pressure, then of the shear

    def _project(self, shear):
        """Q: all of the shear where a cell sticks, its part across e where it slips, 0 without friction."""
        sets = self.sets
        across = np.sum(sets.across * shear, axis=0) * sets.across
        free = sets.contact & (self.tape.friction > 0)
        return np.where(sets.slip, across, np.where(free, shear, 0.0))

    def rows_of(self, u_z: np.ndarray, u_t: np.ndarray) -> np.ndarray:
        """What the rows of pressure and shear take of displacements, (3, ny, nx)."""
        pressed = np.where(self.sets.contact, u_z + self.slides * np.sum(self.sets.along * u_t, axis=0), 0.0)
        return np.concatenate([pressed[None], self._project(u_t)])

    def motion(self, i: int) -> tuple[np.ndarray, np.ndarray]:
        """The unit motion of component i: u_z and u_t, m."""
        u_z, u_t = np.zeros(self.slides.shape), np.zeros((2, *self.slides.shape))
        if i < 3:
            u_z = self.tape.motions[0][i]
        else:
            u_t = self.tape.motions[1][i - 3]
        return u_z, u_t

    def _row(self, i):
        u_z, u_t = self.motion(i)
        return np.concatenate([np.where(self.sets.contact, u_z, 0.0)[None], self._project(u_t)])

    def product(self, x: np.ndarray) -> np.ndarray:
        """The system's matrix times unknowns."""
        found = self.rows_of(*self.tape.influence(x[0], x[1:]))
        found[1:] += self.sets.stiff * x[1:]
        return found

    def precondition(self, r: np.ndarray) -> np.ndarray:
        """An approximate inverse: that of S, and that of C between weights of cells that slip."""
        own, h = self.tape.influence.own[1], self._weight
        pressed = np.where(self.sets.contact, self.tape.influence.inverse_normal(r[0]), 0.0)
        shear = self._project(r[1:])
        spread = self.tape.influence.inverse_tangential(np.sqrt(h) * shear)
        return np.concatenate([pressed[None], self._project(np.sqrt(h) * spread + 0.5 * (1 - h) * h * shear / own)])

    def solve(self, right: np.ndarray, loads: np.ndarray) -> tuple[np.ndarray, np.ndarray, float]:
        """The unknowns, nu of the loads, and the relative residual.

        Parameters
        ----------
        right : ndarray
            Right-hand side of the cells, (3, ny, nx).
        loads : ndarray
            What the rows of the loads are, in their order.

        Returns
        -------
        tuple

        Raises
        ------
        Error
            If there is no convergence.
        """
        enough = self.rtol * np.linalg.norm(right)
        columns = np.array([one.ravel() for one in self.columns]).reshape(len(self.columns), right.size)
        basis = np.linalg.qr(columns.T)[0] if len(columns) else np.zeros((right.size, 0))
        x, clear = self._start(right.shape, loads)
        residual = right.ravel() - self.product(x).ravel()
        rest = residual - basis @ (basis.T @ residual)
        directions: list[tuple[np.ndarray, np.ndarray]] = []
        enough = max(enough, self.rtol * np.linalg.norm(rest)) if enough == 0 else enough
        while np.linalg.norm(rest) > enough:
            if len(directions) == MOST:
                raise Error(f"gradient: no convergence of a step's adjoint within {MOST} operator applications")
            z = clear(self.precondition(rest.reshape(right.shape)))
            whole = self.product(z).ravel()
            image, z = whole - basis @ (basis.T @ whole), z.ravel()
            for direction, its_image, its_whole in directions:
                part = its_image @ image
                image = image - part * its_image
                z = z - part * direction
                whole = whole - part * its_whole
            size = np.linalg.norm(image)
            if not size > 0:
                raise Error(
                    "gradient: a step's adjoint has no solution: does the contact slide as a whole under loads?"
                )
            directions.append((z / size, image / size, whole / size))
            step = directions[-1][1] @ rest
            x = x + step * directions[-1][0].reshape(right.shape)
            rest = rest - step * directions[-1][1]
            residual = residual - step * directions[-1][2]
        multipliers = np.linalg.lstsq(columns.T, residual, rcond=None)[0] if len(columns) else np.zeros(0)
        return x, multipliers, float(np.linalg.norm(rest) / max(np.linalg.norm(right), 1e-300))

    def _start(self, shape, loads):
        """The start, which meets the loads, and the function that takes their part off a direction."""
        if not self.rows:
            return np.zeros(shape), lambda z: z
        inverse = np.array([self.precondition(one) for one in self.columns])
        rows = np.array(self.rows)
        matrix = np.tensordot(rows, inverse, axes=([1, 2, 3], [1, 2, 3]))
        if np.linalg.cond(matrix) > 1e12:
            raise Error("gradient: loads are given that the contact cannot change: it slides as a whole")

        def clear(z):
            return z - np.tensordot(np.linalg.solve(matrix, np.tensordot(rows, z, axes=3)), inverse, axes=1)

        return np.tensordot(np.linalg.solve(matrix, loads), inverse, axes=1), clear

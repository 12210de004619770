"""Makes the table of creep forces, and checks it on new cases: make(), check().

Axes of the table: log(a/b), and the scaled creepages (X, Y, Z) in spherical coordinates,

    X = C11 xi'/3, Y = C22 eta'/3, Z = hypot(C23/1.5, sqrt(b/a) C11/3) phi',
    v = R/(1 + R) with R = |(X, Y, Z)|, alpha = atan2(Y, X), beta = atan2(Z, hypot(X, Y)),

with xi' = G c^2 xi/(mu N), phi' = G c^3 phi/(mu N), c^2 = a b, and Kalker's coefficients C11, C22, C23. The table has
Fx/(mu N), Fy/(mu N), Mz/(mu N c), over v: at v = 0 linear theory, at v = 1 full sliding. Its nodes are equally spaced
in log(a/b) and in

    level = 3/4 v + 1/4 (arctan(10 v - 4) + arctan(4))/(arctan(6) + arctan(4)),
    turn = (alpha + atan2(Y (kx/ky)^(sin(beta)^2), X))/2, rise = (beta + atan2(Z, hypot(X/sqrt(kx), Y/sqrt(ky))))/2,

with kx = 1/hypot(1, 0.7 a/b), ky = a/b/hypot(1.37, 0.7 a/b): nearly X/Z and Y/Z where the pole of the rigid slip is at
the edge of the contact, on the axis b or a. The forces of slender ellipses change on both scales, that of the creepages
and that of the edge, and turn and rise resolve both; level is finer where the contact begins to slide fully.

The cases of a table are run in jobs, each with its own file, so that an interrupted table is completed by a second run.
"""

import concurrent.futures
import hashlib
import multiprocessing
import os
from dataclasses import dataclass
from typing import Optional

import numpy as np
from creepcases import Rolling, linear, sliding
from creepfile import VERSION, Contents, rounded, solved

from petsam.apps.wheel.creep import CreepTable
from petsam.core.errors import Error
from petsam.core.progress import Progress, Say, to_stderr

LEAST = 4  # nodes along an axis
BEND, WIDTH, SHARE = 0.4, 0.1, 0.25  # of the levels: v where they are finest, how far, how much
SPAN = float(np.arctan((1.0 - BEND) / WIDTH) + np.arctan(BEND / WIDTH))
CASES = 60  # of the table's own error
FINE = 128  # least cells for Kalker's coefficients
SEED = 11
ROUNDS = 500  # of the search for the angles of nodes, at most


@dataclass(frozen=True)
class Plan:
    """Nodes and cells of a table.

    Parameters
    ----------
    nodes : tuple of int
        Along log(a/b), v, turn and rise; that along turn is odd.
    range : tuple of float
        First and last a/b.
    cells : int
        Cells of the grid along each axis.
    poisson : float
        Poisson's ratio.

    Raises
    ------
    Error
        If a number is out of range.
    """

    nodes: tuple[int, int, int, int] = (11, 14, 13, 15)
    range: tuple[float, float] = (0.05, 20.0)
    cells: int = 96
    poisson: float = 0.28

    def __post_init__(self) -> None:
        if len(self.nodes) != 4 or min(self.nodes) < LEAST or self.nodes[2] % 2 == 0:
            raise Error(f"--nodes {self.nodes}: expected four numbers of {LEAST} or more, the third one odd")
        if not 1e-3 <= self.range[0] < self.range[1] <= 1e3:
            raise Error(f"--range {self.range}: expected the first and the last a/b, from 1e-3 to 1e3")
        if not (8 <= self.cells <= 2048 and 0.01 <= self.poisson <= 0.49):
            raise Error(f"--cells {self.cells}, --poisson {self.poisson}: expected 8 to 2048 cells and 0.01 to 0.49")

    @property
    def ratios(self) -> np.ndarray:
        """a/b of the nodes."""
        return np.geomspace(*self.range, self.nodes[0])

    @property
    def levels(self) -> np.ndarray:
        """v of the nodes."""
        wanted = np.linspace(0.0, 1.0, self.nodes[1])
        found = _risen(level, wanted, 0.0, 1.0)
        found[[0, -1]] = 0.0, 1.0
        return found

    def directions(self, i: int) -> tuple[np.ndarray, np.ndarray]:
        """alpha and beta of the nodes.

        Parameters
        ----------
        i : int
            Node of a/b.

        Returns
        -------
        tuple of ndarray
            (nodes of turn, rise).
        """
        turns, rises = np.linspace(-0.5, 0.5, self.nodes[2]) * np.pi, np.linspace(0.0, 0.5, self.nodes[3]) * np.pi
        alpha, beta = np.meshgrid(turns, rises, indexing="ij")
        ratio, mid, end = self.ratios[i], slice(1, -1), 0.5 * np.pi
        for _ in range(ROUNDS):
            old = alpha.copy(), beta.copy()
            inner = beta[mid, mid]
            alpha[mid, mid] = _risen(lambda a, b=inner: _angle(ratio, a, b, 0), turns[mid, None], -end, end)
            inner = alpha[:, mid]
            beta[:, mid] = _risen(lambda b, a=inner: _angle(ratio, a, b, 1), rises[mid], 0.0, end)
            if max(np.abs(alpha - old[0]).max(), np.abs(beta - old[1]).max()) < 1e-13:
                break
        return alpha, beta

    @property
    def key(self) -> str:
        """Text that differs for tables of other cases."""
        return hashlib.sha256(f"{VERSION} {self}".encode()).hexdigest()[:12]


def edge(ratio: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """X/Z and Y/Z, nearly, where the pole of the rigid slip is at the edge of the contact.

    Parameters
    ----------
    ratio : ndarray
        a/b, (m,).

    Returns
    -------
    tuple of ndarray
        kx, on the axis b, and ky, on the axis a, (m,).
    """
    return 1.0 / np.hypot(1.0, 0.7 * ratio), ratio / np.hypot(1.37, 0.7 * ratio)


def angles(ratio: np.ndarray, vector: np.ndarray) -> np.ndarray:
    """The angles in which nodes of the table are equally spaced.

    Parameters
    ----------
    ratio : ndarray
        a/b, (m,).
    vector : ndarray
        X and Z of 0 or more, and Y, (m, 3); X and Y are not both 0.

    Returns
    -------
    ndarray
        turn, from -pi/2 to pi/2, and rise, from 0 to pi/2, (m, 2).
    """
    x, y, z = vector.T
    kx, ky = edge(ratio)
    m = (kx / ky) ** (z * z / (x * x + y * y + z * z))
    turn = np.arctan2(y, x) + np.arctan2(m * y, x)
    rise = np.arctan2(z, np.hypot(x, y)) + np.arctan2(z, np.hypot(x / np.sqrt(kx), y / np.sqrt(ky)))
    return 0.5 * np.stack([turn, rise], -1)


def level(v: np.ndarray) -> np.ndarray:
    """The level of v, from 0 to 1, in which nodes are equally spaced.

    Parameters
    ----------
    v : ndarray
        R/(1 + R).

    Returns
    -------
    ndarray
    """
    return (1.0 - SHARE) * v + SHARE / SPAN * (np.arctan((v - BEND) / WIDTH) + np.arctan(BEND / WIDTH))


def _risen(function, wanted, low, high):
    """Arguments at which a growing function has values, by bisection."""
    shape = np.shape(function(wanted))
    low, high = np.full(shape, low), np.full(shape, high)
    for _ in range(54):
        middle = 0.5 * (low + high)
        less = function(middle) < wanted
        low, high = np.where(less, middle, low), np.where(less, high, middle)
    return 0.5 * (low + high)


def _angle(ratio, alpha, beta, which):
    """turn (0) or rise (1) of directions."""
    alpha, beta = np.broadcast_arrays(alpha, beta)
    vectors = np.stack([np.cos(beta) * np.cos(alpha), np.cos(beta) * np.sin(alpha), np.sin(beta)], -1).reshape(-1, 3)
    return angles(np.full(len(vectors), ratio), vectors)[:, which].reshape(alpha.shape)


def direction(alpha: float, beta: float) -> np.ndarray:
    """The unit vector of a direction of creepages.

    Parameters
    ----------
    alpha, beta : float
        Angles, rad.

    Returns
    -------
    ndarray
        X, Y, Z over R, (3,).
    """
    return np.array([np.cos(beta) * np.cos(alpha), np.cos(beta) * np.sin(alpha), np.sin(beta)])


def factors(coefficients: np.ndarray, ratio: float) -> np.ndarray:
    """X/xi', Y/eta', Z/phi'.

    Parameters
    ----------
    coefficients : ndarray
        C11, C22, C23 and others, (3 or more,).
    ratio : float
        a/b.

    Returns
    -------
    ndarray
        (3,).
    """
    c11, c22, c23 = coefficients[:3]
    return np.array([c11 / 3.0, c22 / 3.0, np.hypot(c23 / 1.5, c11 / 3.0 / np.sqrt(ratio))])


def coefficients_job(plan: Plan, i: int) -> np.ndarray:
    """Kalker's coefficients at a node of a/b.

    Parameters
    ----------
    plan : Plan
        The table.
    i : int
        Node of a/b.

    Returns
    -------
    ndarray
        C11, C22, C23, C33 at Poisson's ratios 0, that of the table, and 0.5, (3, 4).
    """
    found = []
    for poisson in (0.0, plan.poisson, 0.5):
        rolling = Rolling(float(plan.ratios[i]), poisson, max(plan.cells, FINE))
        found.append(rolling.coefficients())
        rolling.close()
    return np.array(found)


def forces_job(plan: Plan, i: int, m: int, coefficients: np.ndarray) -> np.ndarray:
    """The forces at the nodes of a/b and rise.

    Parameters
    ----------
    plan : Plan
        The table.
    i, m : int
        Nodes of a/b and rise.
    coefficients : ndarray
        C11, C22, C23, C33, (4,).

    Returns
    -------
    ndarray
        Forces over v, (nodes of v, turn, 3).
    """
    ratio, (alphas, betas) = float(plan.ratios[i]), plan.directions(i)
    count = len(alphas)
    found = np.empty((plan.nodes[1], count, 3))
    rolling = Rolling(ratio, plan.poisson, plan.cells)
    pole = m == plan.nodes[3] - 1
    first = count // 2 if m == 0 or pole else 0
    for k in range(first, first + 1 if pole else count):
        towards = direction(float(alphas[k, m]), float(betas[k, m])) / factors(coefficients, ratio)
        found[:, k] = _along(plan, rolling, towards, coefficients, ratio)
    rolling.close()
    if pole:  # spin alone
        found[:] = found[:, first : first + 1]
        found[..., 0] = 0.0
    elif m == 0:  # no spin: symmetric in Y
        found[:, :first] = found[:, : count - 1 - first : -1] * np.array([1.0, -1.0, -1.0])
        found[:, first, 1:] = 0.0
    found[:, [0, -1], 0] = 0.0  # no X
    return found


def _along(plan, rolling, towards, coefficients, ratio):
    """Forces over v in one direction, (nodes of v, 3)."""
    inner = [rolling.forces(v / (1.0 - v) * towards) / v for v in plan.levels[1:-1]]
    return np.array([linear(coefficients, towards), *inner, sliding(ratio, towards)])


def make(
    plan: Plan, folder: str, jobs: int = 1, say: Optional[Say] = to_stderr, checked: Optional[tuple[int, int]] = None
) -> Contents:
    """A table, from the cases that a folder already has, and those that remain.

    Parameters
    ----------
    plan : Plan
        Nodes and cells.
    folder : str
        Its jobs' files; it may be removed afterwards.
    jobs : int
        Processes.
    say : callable
        Called with lines of progress.
    checked : tuple of int, optional
        Number of cases and cells of the table's own error: CASES, and twice the table's cells.

    Returns
    -------
    Contents
        Of its file.
    """
    count, fine = checked or (CASES, 2 * plan.cells)
    n = plan.nodes
    folder = os.path.join(folder, plan.key)
    os.makedirs(folder, exist_ok=True)
    coefficients = np.array(_run(
        [(f"C{i}", coefficients_job, plan, i) for i in range(n[0])], folder, jobs, Progress("coefficients", say)
    ))  # fmt: skip
    work = [(f"F{i}-{m}", forces_job, plan, i, m, coefficients[i, 1]) for i in range(n[0]) for m in range(n[3])]
    found = np.array(_run(work, folder, jobs, Progress("row", say))).reshape(n[0], n[3], n[1], n[2], 3)
    nodes = np.moveaxis(found, 1, 3)
    own = [(f"E{k}-{fine}", own_error_job, plan, k, fine, coefficients[:, 1]) for k in range(count)]
    errors = np.array(_run(own, folder, jobs, Progress("finer case", say))).ravel()
    stored = (*statistics(errors), float(count)) if count else (0.0, 0.0, 0.0, 0.0)
    scales, slopes = solved(np.log(coefficients[..., :3])), linear_slopes(plan, coefficients[:, 1])
    nodes -= _ahead(plan, slopes)
    return Contents(plan.range, plan.poisson, scales, solved(slopes), *rounded(nodes), plan.cells, stored)


def linear_slopes(plan: Plan, coefficients: np.ndarray) -> np.ndarray:
    """The forces of the linear theory by X, Y, Z.

    Parameters
    ----------
    plan : Plan
        The table.
    coefficients : ndarray
        At all nodes of a/b, (n, 4).

    Returns
    -------
    ndarray
        (n, 3, 3).
    """
    units = (np.diag(1.0 / factors(one, ratio)) for one, ratio in zip(coefficients, plan.ratios))
    return np.array([linear(one, unit).T for one, unit in zip(coefficients, units)])


def _ahead(plan, slopes):
    """Linear theory times (1 - v)^2 at the nodes, (nodes of a/b, v, turn, rise, 3)."""
    towards = np.array([np.moveaxis(direction(*plan.directions(i)), 0, -1) for i in range(plan.nodes[0])])
    return np.einsum("v,nij,nkmj->nvkmi", (1.0 - plan.levels) ** 2, slopes, towards)


def statistics(errors: np.ndarray) -> tuple[float, float, float]:
    """Median, 90 % and maximum.

    Parameters
    ----------
    errors : ndarray
        Errors, (n,).

    Returns
    -------
    tuple of float
    """
    return float(np.median(errors)), float(np.quantile(errors, 0.9)), float(np.max(errors))


def own_error_job(plan: Plan, k: int, fine: int, coefficients: np.ndarray) -> np.ndarray:
    """The difference that finer cells make at a random node.

    Parameters
    ----------
    plan : Plan
        The table.
    k : int
        Number of the case.
    fine : int
        Cells.
    coefficients : ndarray
        At all nodes of a/b, (n, 4).

    Returns
    -------
    ndarray
        Maximum over the three forces, ().
    """
    random = np.random.default_rng([SEED, k])
    i, j = random.integers(plan.nodes[0]), random.integers(1, plan.nodes[1] - 1)
    at = random.integers(plan.nodes[2]), random.integers(plan.nodes[3])
    alpha, beta = (float(one[at]) for one in plan.directions(int(i)))
    v = plan.levels[j]
    creepages = v / (1.0 - v) * direction(alpha, beta) / factors(coefficients[i], plan.ratios[i])
    found = [_single(plan.ratios[i], plan.poisson, cells, creepages) for cells in (plan.cells, fine)]
    return np.abs(found[1] - found[0]).max()


def _single(ratio, poisson, cells, creepages):
    """The forces of one case."""
    rolling = Rolling(ratio, poisson, cells)
    try:
        return rolling.forces(creepages)
    finally:
        rolling.close()


def check(
    table: CreepTable, count: int, cells: int, seed: int = 1, poisson: Optional[float] = None, jobs: int = 1,
    say: Optional[Say] = to_stderr,
) -> np.ndarray:  # fmt: skip
    """Errors of a table on random cases: a/b from 0.1 to 10 within its range, v to 0.95, all directions.

    Parameters
    ----------
    table : CreepTable
        The table.
    count : int
        Cases.
    cells : int
        Cells of their grids along each axis.
    seed : int
        Of the random numbers.
    poisson : float, optional
        Poisson's ratio; that of the table.
    jobs : int
        Processes.
    say : callable
        Called with lines of progress.

    Returns
    -------
    ndarray
        Errors of Fx and Fy over mu N, and of Mz over mu N c, (count, 3).
    """
    poisson = table.poisson if poisson is None else poisson
    random = np.random.default_rng(seed)
    low, high = np.log(np.clip([0.1, 10.0], *table.range))
    ratios = np.exp(random.uniform(low, high, count))
    towards = random.standard_normal((count, 3))
    levels = random.uniform(0.0, 0.95, count)
    vectors = towards / np.linalg.norm(towards, axis=1)[:, None] * (levels / (1.0 - levels))[:, None]
    found, _ = table.scaled(ratios, vectors)
    creepages = vectors / table.factors(ratios, np.full(count, poisson))
    work = [("", _single, ratios[k], poisson, cells, creepages[k]) for k in range(count)]
    wanted = _run(work, "", jobs, Progress("case", say, 10.0))
    return np.abs(found - np.array(wanted))


# ---- jobs


def _job(folder, name, function, *given):
    """The result of a job, kept in a file if there is a folder."""
    path = os.path.join(folder, name + ".npy")
    if folder and os.path.exists(path):
        return np.load(path)
    found = function(*given)
    if folder:
        np.save(path + ".part.npy", found)
        os.replace(path + ".part.npy", path)
    return found


def _run(work, folder, jobs, progress):
    """Results of jobs in their order."""
    found = [None] * len(work)
    for done, (k, result) in enumerate(_results(work, folder, jobs), 1):
        found[k] = result
        progress(done, len(work))
    return found


def _results(work, folder, jobs):
    """Numbers and results of jobs as they end."""
    if jobs == 1:
        yield from ((k, _job(folder, *one)) for k, one in enumerate(work))
        return
    context = multiprocessing.get_context("spawn")  # MPI does not bear a fork
    with concurrent.futures.ProcessPoolExecutor(min(jobs, max(len(work), 1)), context) as pool:
        futures = {pool.submit(_job, folder, *one): k for k, one in enumerate(work)}
        try:
            for future in concurrent.futures.as_completed(futures):
                yield futures[future], future.result()
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            raise

"""A mass on a spring, held by a rounded punch with friction, and its steady vibration.

The mass (m, moment of inertia J) is a rigid body whose centre lies at the height h above the contact. It moves by d_x
and rocks by r_y, both at the contact; N is constant, and a spring with a little damping holds it:

    M q'' + C q' + K q + f(q, history) = (1, h) F cos(w t),   q = (d_x, r_y),   f = (T_x, M_y) of the contact.

Harmonic balance with alternating frequency and time (Cameron and Griffin 1989, J. Appl. Mech. 56, 149): q is a sum of
odd harmonics; the contact gives f at `samples` times of a cycle, and its harmonics balance the others.
"""

import numpy as np

import petsam

PUNCH = dict(
    body1_young=210e9,
    body1_poisson=0.3,
    body2_young=210e9,
    body2_poisson=0.3,
    friction=0.5,
    gap_type="punch",
    gap_flat_radius=0.02,
    gap_edge_radius=0.2,
    grid_size=0.06,
)
NORMAL = 1e6  # N
LIMIT = 0.5 * NORMAL  # of T_x, N
Z, X, RY = 0, 1, 4  # components of the contact: N and d_z, T_x and d_x, M_y and r_y

MASS, HEIGHT = 40.0, 0.05  # kg, m
INERTIA = 0.2  # kg m2, about the centre: a block of steel
SPRING, ROTATION = 2e8, 5e7  # N/m and N m/rad: the spring, at the centre
DAMPING = 0.002  # of the spring: part of the critical damping of the stuck joint
HARMONICS = (1, 3)
SAMPLES = 32
ITERATIONS = 20
LITTLE = 0.7  # of the residual: a step that leaves more has brought little


class Joint:
    """The contact, which gives its forces over a cycle of motion; counts its steps and stiffnesses."""

    def __init__(self, cells, worn=0.0):
        """worn: the depth that has been removed of both bodies, (cells, cells), m."""
        self.contact = petsam.Contact(grid_n=cells, **PUNCH)
        beyond = np.maximum(np.hypot(self.contact.x, self.contact.y[:, None]) - PUNCH["gap_flat_radius"], 0.0)
        self.contact.gap = beyond**2 / (2.0 * PUNCH["gap_edge_radius"]) + worn
        self.trials = self.stiffnesses = 0

    def _try(self, motion):
        self.trials += 1
        return self.contact.try_step(load_n=NORMAL, disp_x=motion[0], disp_y=0.0, rot_x=0.0, rot_y=motion[1], rot_z=0.0)

    def rest(self):
        """Bodies apart and together again: without any shear that is left from before."""
        self.contact.try_step(disp_z=-1e-6, disp_x=0.0, disp_y=0.0, rot_x=0.0, rot_y=0.0, rot_z=0.0)
        self.contact.commit()
        self._try((0.0, 0.0))
        self.contact.commit()

    def run_in(self, motion):
        """A first cycle, with half of the steps, after which the contact repeats itself."""
        self.rest()
        for one in [*motion[:-1:2], motion[-1]]:
            self._try(one)
            self.contact.commit()

    def forces(self, motion, tangent=True):
        """(T_x, M_y) over a cycle of motion (samples, 2) that repeats, and the derivative (samples, 2, samples, 2)."""
        count = len(motion)
        self.run_in(motion)
        loads, stiffness = np.empty((count, 2)), np.empty((count, 2, 2))
        for k, one in enumerate(motion):
            step = self._try(one)
            loads[k] = step.load_tx, step.load_my
            if tangent:
                stiffness[k] = self._tangent()
            self.contact.commit()
        return loads, derivative(motion, stiffness) if tangent else None

    def slip(self, motion):
        """How far each cell slips to and fro along x in a cycle, m, and the dissipated energy of the cycle, J."""
        self.run_in(motion)
        slips, energy = [], 0.0
        for one in motion:
            self._try(one)
            slips.append(np.where(self.contact["pressure"] > 0.0, self.contact["slip_x"], np.nan))
            energy += self.contact.number("dissipated_energy")
            self.contact.commit()
        return np.max(slips, axis=0) - np.min(slips, axis=0), energy

    def _tangent(self):
        """d(T_x, M_y)/d(d_x, r_y) at constant N: d_z follows."""
        self.stiffnesses += 1
        k = self.contact.stiffness()
        follow = k[Z, [X, RY]] / k[Z, Z]
        return k[np.ix_([X, RY], [X, RY])] - np.outer(k[[X, RY], Z], follow)


def derivative(motion, stiffness):
    """Of the forces at all instants with respect to the motion at all instants.

    After a turn of d_x the force follows from where it turned, f - f_turn = g(q - q_turn): its derivative is the
    stiffness of the instant, on the motion since the turn, and that of the force at the turn. There f is that of a loop
    about zero, a function of q_turn alone, whose derivative is the stiffness at the turn. Right for two turns a cycle
    and loops about zero at constant N, which odd harmonics lead to.
    """
    count = len(motion)
    rate = np.diff(motion[:, 0], append=motion[:1, 0])  # to the next instant
    turns = [k for k in range(count) if rate[k] * rate[k - 1] <= 0.0]
    d = np.zeros((count, 2, count, 2))
    if not turns:
        turns = [0]
    for turn in turns:
        d[turn, :, turn, :] = stiffness[turn]
    for turn, end in zip(turns, [*turns[1:], turns[0] + count]):
        for k in range(turn + 1, end if end % count in turns else end + 1):
            i = k % count
            d[i] = d[turn]
            d[i, :, i, :] += stiffness[i]
            d[i, :, turn, :] -= stiffness[i]
    return d


# ---------------------------------------------------------------- harmonic balance


def basis():
    """Instants of the harmonics' cosines and sines, (samples, 2 harmonics), and the way back."""
    t = 2.0 * np.pi * np.arange(SAMPLES) / SAMPLES
    waves = np.column_stack([wave(h * t) for h in HARMONICS for wave in (np.cos, np.sin)])
    return waves, 2.0 / SAMPLES * waves.T


WAVES, ANALYSIS = basis()
COUNT = 2 * len(HARMONICS)  # coefficients of a coordinate

M = np.array([[MASS, MASS * HEIGHT], [MASS * HEIGHT, INERTIA + MASS * HEIGHT**2]])
K = SPRING * np.array([[1.0, HEIGHT], [HEIGHT, HEIGHT**2]]) + np.diag([0.0, ROTATION])
DRIVE = np.array([1.0, HEIGHT])


def linear(omega, damping):
    """The matrix of the linear part on the coefficients, ordered (harmonic, cosine or sine, coordinate)."""
    c = damping * np.outer(DRIVE, DRIVE)
    z = np.zeros((COUNT, 2, COUNT, 2))
    for n, h in enumerate(HARMONICS):
        w, a, b = h * omega, 2 * n, 2 * n + 1
        z[a, :, a, :] = z[b, :, b, :] = K - w**2 * M
        z[a, :, b, :] = w * c
        z[b, :, a, :] = -w * c
    return z.reshape(2 * COUNT, 2 * COUNT)


def stuck(joint):
    """The stiffness of the stuck joint (2, 2), its lowest resonance (rad/s), and the damping coefficient (N s/m)."""
    joint.rest()
    joint._try((1e-12, 0.0))
    k = joint._tangent()
    omega = np.sqrt(np.min(np.linalg.eigvals(np.linalg.solve(M, K + k)).real))
    return k, omega, 2.0 * DAMPING * MASS * omega


class Balance:
    """The residual of harmonic balance at a frequency and an amplitude of the drive, and its derivative."""

    def __init__(self, joint, damping):
        self.joint, self.damping = joint, damping

    def residual(self, x, omega, force, tangent=True):
        motion = WAVES @ x.reshape(COUNT, 2)
        loads, d = self.joint.forces(motion, tangent)
        z = linear(omega, self.damping)
        drive = np.zeros((COUNT, 2))
        drive[0] = force * DRIVE
        r = z @ x + (ANALYSIS @ loads - drive).ravel()
        if not tangent:
            return r, None
        d = np.einsum("ai,ipjq,jb->apbq", ANALYSIS, d, WAVES)
        return r, z + d.reshape(2 * COUNT, 2 * COUNT)

    def differences(self, x, r, omega, force):
        """The derivative by differences: an evaluation for each unknown."""
        largest = np.abs(x.reshape(COUNT, 2)).max(axis=0)
        j = np.empty((x.size, x.size))
        for k in range(x.size):
            moved = x.copy()
            moved[k] += 1e-4 * largest[k % 2]
            j[:, k] = (self.residual(moved, omega, force, False)[0] - r) / (moved[k] - x[k])
        return j

    def solve(self, x, omega, force, rtol=1e-4, by_differences=False):
        """Newton's method from x, with shorter steps where a whole one would lead away.

        Where the motion turns between two instants, the rule of derivative() leaves open from which of them to count.
        Four steps that bring little are followed by one with a Jacobian by differences.
        """
        r, j = self.residual(x, omega, force, not by_differences)
        stalls = 0
        for _ in range(ITERATIONS):
            if size(r) <= rtol * force:
                return x
            if by_differences or stalls > 3:
                j = self.differences(x, r, omega, force)
            step = np.linalg.solve(j, r)
            for part in (1.0, 0.5, 0.25, 0.125):
                new, j = self.residual(x - part * step, omega, force, not by_differences)
                if size(new) < size(r):
                    break
            stalls = stalls + 1 if stalls < 4 and size(new) > LITTLE * size(r) else 0
            x, r = x - part * step, new
        raise RuntimeError(f"no convergence at {omega / 2.0 / np.pi:.1f} Hz, {force:g} N")


def size(r):
    """The norm of a residual, N; moments count as forces at the height of the centre."""
    return np.linalg.norm(r.reshape(COUNT, 2) / (1.0, HEIGHT))


def amplitude(x):
    """The largest |d_x + h r_y| of a cycle, m: the motion of the centre."""
    t = 2.0 * np.pi * np.arange(360) / 360
    waves = np.column_stack([wave(h * t) for h in HARMONICS for wave in (np.cos, np.sin)])
    return np.abs(waves @ x.reshape(COUNT, 2) @ DRIVE).max()


def response(joint, omegas, force, by_differences=False):
    """Coefficients (omegas, unknowns) along a response curve, from the frequency that is farthest from resonance."""
    k, _, damping = stuck(joint)
    balance = Balance(joint, damping)
    found = []
    stiff = np.einsum("ab,pq->apbq", np.eye(COUNT), k).reshape(2 * COUNT, 2 * COUNT)
    for n, omega in enumerate(omegas):
        if n == 0:  # as if it were stuck
            drive = np.zeros((COUNT, 2))
            drive[0] = force * DRIVE
            x = np.linalg.solve(linear(omega, damping) + stiff, drive.ravel())
        elif n > 1:
            x = found[-1] + (found[-1] - found[-2]) * (omega - omegas[n - 1]) / (omegas[n - 1] - omegas[n - 2])
        x = balance.solve(x, omega, force, by_differences=by_differences)
        found.append(x)
    return np.array(found)

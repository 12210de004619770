"""Two strips in plane strain that lap, joined by a bolt: their deck, and the frequency and damping of a mode by finite
elements and a dense contact of the tests' own, without polynomials.

Strips and loads are of 1 m along y; lengths in m. Body 2 lies at z >= 0 and is clamped at its far end.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.sparse.linalg import eigsh, splu

import sections
from petsam.apps.compliance import halfplane

YOUNG, POISSON, DENSITY = 210e9, 0.3, 7800.0
HEIGHT, LAP, LENGTH, WASHER = 12.7e-3, 30e-3, 150e-3, 8e-3
DIAMETER, SPACING = 8e-3, 25e-3  # of the bolts
FRICTION, TENSION = 0.3, 6e5
GAUSS = np.polynomial.legendre.leggauss(4)


@dataclass
class Lap:
    """Nodes (n, 2) and elements of both strips, masks of the nodes of body 2, and of the named sets."""

    nodes: np.ndarray
    elements: np.ndarray
    second: np.ndarray
    sets: dict

    @classmethod
    def made(cls, size=2e-3, rows=6):
        """Strips of elements as wide as `size` along the lap."""
        near = np.linspace(-LAP, LAP, 1 + round(2 * LAP / size))
        far = LAP + (LENGTH - LAP) * np.linspace(0.0, 1.0, 17)[1:] ** 1.5
        z = np.linspace(0.0, HEIGHT, rows + 1)
        two, one = sections.grid(np.append(-far[::-1], near), z), sections.grid(np.append(near, far), z - HEIGHT)
        nodes = np.concatenate([two[0], one[0]])
        second = np.arange(len(nodes)) < len(two[0])
        x, z = nodes.T
        washer = np.abs(x) < WASHER * (1 + 1e-9)
        sets = {"CLAMP": second & (x == x.min()), "TIP": ~second & (x == x.max()) & (z == -HEIGHT),
                "CONTACT2": second & (z == 0.0), "CONTACT1": ~second & (z == 0.0),
                "WASHER2": second & washer & (z == HEIGHT), "WASHER1": ~second & washer & (z == -HEIGHT)}  # fmt: skip
        return cls(nodes, np.concatenate([two[1], one[1] + len(two[0])]), second, sets)

    def write(self, path, thickness=SPACING):
        """Its deck in mm, with a bolt in each thickness (m) of the strips."""
        named = {name: self.sets[name] for name in ("CLAMP", "TIP")}
        surfaces = {name: mask for name, mask in self.sets.items() if name not in named}
        more = dict(young=1e-6 * YOUNG, poisson=POISSON, density=1e-12 * DENSITY, section=f"{1e3 * thickness}")
        sections.deck(path, 1e3 * self.nodes, self.elements, "CPE8", named, surfaces, **more)

    def sides(self, mask):
        """(ends and middle) of the sides of elements on a mask of nodes."""
        for one in self.elements:
            for k in range(4):
                side = one[[k, (k + 1) % 4, 4 + k]]
                if np.all(mask[side[:2]]):
                    yield side

    def boundary(self):
        """(ends and middle, outward normal times length) of the outer sides but those in z = 0."""
        ends = {}
        for one in self.elements:
            for k in range(4):
                side = one[[k, (k + 1) % 4, 4 + k]]
                ends.setdefault(frozenset(side[:2].tolist()), []).append((side, self.nodes[one].mean(axis=0)))
        for (side, middle), *other in ends.values():
            a, b = self.nodes[side[:2]]
            if other or a[1] == b[1] == 0.0:
                continue
            normal = np.array([b[1] - a[1], a[0] - b[0]])
            yield side, normal * np.sign(normal @ (0.5 * (a + b) - middle))


def line(at):
    """Quadratic functions of a side (q, 3): ends and middle."""
    return np.stack([0.5 * at * (at - 1.0), 0.5 * at * (at + 1.0), 1.0 - at * at], axis=-1)


class Reference:
    """The structure in modes of the tests' own, and its full compliance on n cells of |x| < half."""

    def __init__(self, lap, half, n, modes=14, clamped=True):
        self.lap, self.half, self.n = lap, half, n
        count = len(lap.nodes)
        self.matrix = sections.stiffness(lap.nodes, lap.elements, YOUNG, POISSON)
        self.tie, closing = bolt(lap)
        self.free = np.flatnonzero(~np.repeat(lap.sets["CLAMP"] & clamped, 2))
        whole = (self.matrix + self.tie).tocsr()
        self.whole, inner = whole, whole[self.free][:, self.free].tocsc()
        mass = masses(lap)[self.free][:, self.free]
        square, shapes = eigsh(inner, modes, mass, sigma=0.0 if clamped else -1e4)
        if not clamped:
            self.omega = np.sqrt(np.abs(square))
            return
        self.factor = splu(inner)
        self.omega = np.sqrt(square)
        modal = np.zeros((2 * count, modes))
        modal[self.free] = shapes
        self.sample = self._sample()
        self.modes = self.sample @ modal
        self.tip = modal.reshape(count, 2, modes)[np.flatnonzero(lap.sets["TIP"])[0], 1]
        tension = np.zeros((2 * count, 1))
        tension[self.free, 0] = self.factor.solve(closing[self.free])
        self.bolt = (self.sample @ tension)[:, 0]

    def _sample(self):
        """Means over the cells of body 2's displacement minus body 1's, (2 n, 2 nodes): x of all cells, then z."""
        edges = np.linspace(-self.half, self.half, self.n + 1)
        found = np.zeros((2 * self.n, 2 * len(self.lap.nodes)))
        for name, sign in (("CONTACT2", 1.0), ("CONTACT1", -1.0)):
            for side in self.lap.sides(self.lap.sets[name]):
                a, b = np.sort(self.lap.nodes[side[:2], 0])
                order = np.argsort(self.lap.nodes[side[:2], 0])
                for cell in np.flatnonzero((edges[1:] > a + 1e-12) & (edges[:-1] < b - 1e-12)):
                    low, high = max(a, edges[cell]), min(b, edges[cell + 1])
                    x = 0.5 * (low + high) + 0.5 * (high - low) * GAUSS[0]
                    mean = 0.5 * (high - low) * GAUSS[1] @ line((2.0 * x - a - b) / (b - a)) / np.diff(edges)[0]
                    for axis in range(2):
                        np.add.at(found[axis * self.n + cell], 2 * side[[*order, 2]] + axis, sign * mean)
        return found

    @cached_property
    def compliance(self):
        """C (2 n, 2 n), m3/N: the half-planes' cells, and what elements add, which bear the half-planes' fields taken
        back on all other sides, at the clamp and on the bolt."""
        lap, n = self.lap, self.n
        kernel = halfplane.cell_compliance(self.half, n, YOUNG, POISSON).reshape(n, 3, n, 3)[:, [0, 2]][:, :, :, [0, 2]]
        both = np.zeros((2, n, 2, n))
        for axis in range(2):  # of equal bodies the coupling of normal and tangential directions vanishes
            both[axis, :, axis] = 2.0 * kernel[:, axis, :, axis]
        force = np.zeros((len(lap.nodes), 2, 2 * n))
        for side, normal in lap.boundary():
            if np.all(lap.sets["CLAMP"][side]):
                continue
            stress = self._stress(line(GAUSS[0]) @ lap.nodes[side], lap.second[side[0]])
            traction = np.einsum("qijc,j->qic", stress, normal)
            np.add.at(force, side, -np.einsum("q,qk,qic->kic", 0.5 * GAUSS[1], line(GAUSS[0]), traction))
        given = np.zeros_like(force)
        for name in ("CLAMP", "WASHER1", "WASHER2"):
            mask = lap.sets[name]
            given[mask] = self._moved(lap.nodes[mask], name != "WASHER1")
        given = given.reshape(-1, 2 * n)
        force = force.reshape(-1, 2 * n) - self.tie @ given
        held = np.repeat(lap.sets["CLAMP"], 2)
        w = np.where(held[:, None], -given, 0.0)
        w[self.free] = self.factor.solve((force - self.whole @ w)[self.free])
        return both.reshape(2 * n, 2 * n) + self.sample @ w

    def _lines(self, points, second):
        """Differences (3, points, lines) from lines in the cells, and their part of a cell: of body 2's half-plane, of
        body 1's mirrored."""
        h = 2.0 * self.half / self.n
        at = (np.arange(self.n)[:, None] + 0.5 + 0.5 * GAUSS[0]) * h - self.half
        d = points[:, None, 0] - at.ravel()
        z = np.broadcast_to((points[:, 1] * (1.0 if second else -1.0))[:, None], d.shape)
        return np.stack([d, 0.0 * d, z]), 0.5 * h * GAUSS[1]

    def _moved(self, points, second):
        """Displacements (points, 2, 2 n) of a half-plane by unit tractions on the cells."""
        d, weights = self._lines(points, second)
        u = (
            halfplane.displacement(d, POISSON, 2.0 * self.half)[[0, 2]][:, [0, 2]]
            * (1.0 + POISSON)
            / (2.0 * np.pi * YOUNG)
        )
        return self._turned(u, weights, second, 1)

    def _stress(self, points, second):
        """Stresses (points, 2, 2, 2 n) of a half-plane by unit tractions on the cells: Flamant's radial ones."""
        d, weights = self._lines(points, second)
        x = d[[0, 2]]
        s = -2.0 / np.pi * np.einsum("ipl,jpl,kpl->ijkpl", x, x, x) / np.sum(x * x, axis=0) ** 2
        return self._turned(s, weights, second, 2)

    def _turned(self, field, weights, second, rank):
        """Sums over the lines of each cell, (points, ..., 2 n), of body 1 mirrored and by the opposite traction."""
        sign = np.array([1.0, 1.0 if second else -1.0])
        field = field.reshape(*field.shape[:-1], self.n, len(weights)) @ weights
        field = field * (sign if second else -sign)[:, None, None]  # of the traction's direction
        for k in range(rank):
            field = field * sign.reshape(-1, *[1] * (field.ndim - 1 - k))
        field = np.moveaxis(field, -2, 0)
        return field.reshape(*field.shape[:-2], -1)


def masses(lap):
    """The consistent mass (2 nodes, 2 nodes)."""
    at, weight = np.polynomial.legendre.leggauss(3)
    rows, columns, values = [], [], []
    for one in lap.elements:
        own = np.zeros((8, 8))
        for a, wa in zip(at, weight):
            for b, wb in zip(at, weight):
                n, local = sections.shapes(a, b)
                own += np.outer(n, n) * abs(np.linalg.det(lap.nodes[one].T @ local)) * wa * wb * DENSITY
        for axis in range(2):
            rows.append(np.repeat(2 * one + axis, 8))
            columns.append(np.tile(2 * one + axis, 8))
            values.append(own.ravel())
    entries = (np.concatenate(values), (np.concatenate(rows), np.concatenate(columns)))
    return sections.sparse.coo_matrix(entries, shape=(2 * len(lap.nodes),) * 2).tocsr()


def bolt(lap):
    """Stiffness (2 nodes, 2 nodes) of the bolts of 1 m, and the forces of a unit tension: beams between the mean
    displacements and the mean rotations of the washers, by Timoshenko with Cowper's factor."""
    rows = []
    for name in ("WASHER1", "WASHER2"):
        mean, turn = np.zeros((2, 2 * len(lap.nodes))), np.zeros(2 * len(lap.nodes))
        for side in lap.sides(lap.sets[name]):
            x = line(GAUSS[0]) @ lap.nodes[side][:, 0]
            weight = 0.5 * abs(np.diff(lap.nodes[side[:2], 0])[0]) * GAUSS[1]
            for axis in range(2):
                mean[axis, 2 * side + axis] += weight @ line(GAUSS[0]) / (2.0 * WASHER)
            turn[2 * side + 1] += (weight * x) @ line(GAUSS[0]) / (2.0 * WASHER**3 / 3.0)  # slope u_z,x
        rows.append([*mean, turn])
    length, area, inertia = 2.0 * HEIGHT, np.pi * DIAMETER**2 / 4.0, np.pi * DIAMETER**4 / 64.0
    shear = 0.5 * YOUNG / (1.0 + POISSON) * area * 6.0 * (1.0 + POISSON) / (7.0 + 6.0 * POISSON)
    (x1, z1, t1), (x2, z2, t2) = rows
    closing = z1 - z2  # body 1 lies at z < 0: its washer moves to body 2's
    bend, soft = YOUNG * inertia / length, 12.0 * YOUNG * inertia / (shear * length**2)
    across = x2 - x1 + 0.5 * length * (t1 + t2)  # that no rigid motion has, as u_x,z = -u_z,x then
    parts = [(YOUNG * area / length, closing), (bend, t2 - t1), (12.0 * bend / (length**2 * (1.0 + soft)), across)]
    dense = [sections.sparse.csr_matrix(row) for _, row in parts]
    matrix = sum(k / SPACING * (row.T @ row) for (k, _), row in zip(parts, dense))
    return matrix.tocsr(), closing


@dataclass
class State:
    """Tractions q, p of the cells, N/m2, and u_x of their last step, m."""

    q: np.ndarray
    p: np.ndarray
    x: np.ndarray


class Friction:
    """Contact with Coulomb friction on cells of a dense compliance, by sets of open, sticking and slipping cells."""

    def __init__(self, compliance, friction):
        self.n, self.compliance, self.friction = len(compliance) // 2, compliance, friction

    def step(self, last, given):
        """The State after a step to the displacements `given` (2 n), which are those without tractions."""
        n = self.n
        touches, sign = last.p > 0.0, np.sign(last.q) * (np.abs(last.q) >= (1.0 - 1e-9) * self.friction * last.p)
        if not np.any(touches):
            touches = given[n:] < 0.0
        for most in [200] + 400 * [1]:
            for _ in range(most):
                q, p = self._solved(touches, sign, last, given)
                u = self.compliance @ np.concatenate([q, p]) + given
                slip, gap, excess = u[:n] - last.x, u[n:], np.abs(q) - self.friction * p
                scale = 1e-9 * (np.abs(p).max() + 1.0), 1e-9 * np.abs(u).max()
                opens, closes = touches & (p < -scale[0]), ~touches & (gap < -scale[1])
                slips = touches & (sign == 0.0) & (excess > scale[0])
                sticks = touches & (sign != 0.0) & (sign * slip > scale[1])
                changes = opens | closes | slips | sticks
                if not np.any(changes):
                    return State(q, p, u[:n])
                if most == 1:  # sets that repeat: one cell at a time
                    changes &= np.arange(n) == self.chosen(changes)
                touches = (touches & ~(opens & changes)) | (closes & changes)
                sign = np.where((sticks | opens | closes) & changes, 0.0, sign)
                sign = np.where(slips & changes, np.sign(q), sign)
        raise AssertionError("the reference's sets do not settle")

    def chosen(self, changes):
        """One of the cells that change."""
        return np.random.default_rng(np.sum(changes)).choice(np.flatnonzero(changes))

    def _solved(self, touches, sign, last, given):
        """Tractions where sticking cells do not move, slipping ones bear -mu p against their slip, and all touch."""
        n, mu = self.n, self.friction
        matrix, right = np.zeros((2 * n, 2 * n)), np.zeros(2 * n)
        cells, stuck = np.arange(n), touches & (sign == 0.0) & (mu > 0.0)
        matrix[cells, cells] = 1.0
        slides = touches & ~stuck
        matrix[cells[slides], n + cells[slides]] = -mu * sign[slides]
        matrix[cells[stuck]] = self.compliance[cells[stuck]]
        right[cells[stuck]] = last.x[stuck] - given[cells[stuck]]
        matrix[n + cells[~touches], n + cells[~touches]] = 1.0
        matrix[n + cells[touches]] = self.compliance[n + cells[touches]]
        right[n + cells[touches]] = -given[n + cells[touches]]
        found = np.linalg.solve(matrix, right)
        return found[:n], found[n:]


class Quasistatic:
    """Frequency and damping of a mode of a Reference with contact, by a full compliance of its cells, or of some of
    them, whose surfaces have a gap (m)."""

    def __init__(self, reference, cells=None, gap=0.0):
        cells = np.arange(reference.n) if cells is None else cells
        n, self.area, both = len(cells), 2.0 * reference.half / reference.n, np.append(cells, cells + reference.n)
        compliance = reference.compliance[np.ix_(both, both)]
        self.given = TENSION * reference.bolt[both] + np.repeat([0.0, 1.0], n) * np.tile(gap * np.ones(n), 2)
        apart = State(np.zeros(n), np.zeros(n), np.zeros(n))
        pressed = Friction(compliance, 0.0).step(apart, self.given)
        self.preload, self.contact = pressed, Friction(compliance, FRICTION)
        touches = np.tile(pressed.p > 0.0, 2)
        phi, omega = reference.modes[both], reference.omega
        rest = compliance - phi @ (phi / omega**2).T * self.area
        held = phi[touches]
        stiff = np.diag(omega**2) + self.area * held.T @ np.linalg.solve(rest[np.ix_(touches, touches)], held)
        squares, shapes = np.linalg.eigh(0.5 * (stiff + stiff.T))
        self.omega, self.x = np.sqrt(squares[0]), shapes[:, 0]
        self.moved, self.own = phi @ (self.x / omega**2), self.x @ (self.x / omega**2)

    def point(self, alpha, steps, cycles=2):
        """Angular frequency and damping in the last of some cycles."""
        state, energy, reach = self.preload, 0.0, [0.0, 0.0]
        turns = [0.0, *[1.0, -1.0] * cycles, 1.0]
        for k, (begin, end) in enumerate(zip(turns, turns[1:])):
            if k == len(turns) - 3:
                energy = 0.0
            for part in np.linspace(begin, end, steps + 1)[1:]:
                after = self.contact.step(state, self.given + alpha * part * self.moved)
                energy -= self.area * after.q @ (after.x - state.x)
                state = after
            tractions = np.concatenate([state.q - self.preload.q, state.p - self.preload.p])
            reach = [reach[1], alpha * end * self.own + self.area * self.moved @ tractions]
        width = abs(reach[1] - reach[0])
        return np.sqrt(2.0 * alpha / width), energy / (np.pi * alpha * width)

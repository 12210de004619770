"""Plane strain, random histories: each step must fulfil the conditions of contact by dense matrices in numpy.

Lines of 16 to 300 cells: half-planes and periodic ones, rough and rounded, nu 0 to 0.5, friction 0.03 to 1,
dissimilar bodies, layers, bulk stress, antiplane loads, films, wear, hardness, tilting moments; loads and displacements
in all combinations, with reversals. The summary has the products by properties.
"""

import collections
import subprocess

import h5py
import numpy as np

import conftest
from kinds import costs
from layers import Body
from support import words

STEPS = 5
OPTIONS = dict(trials=300)
summary = costs.summary


# ---------------------------------------------------------------- mechanics


def layered(n, h, bodies, datum):
    """What layers add to u_z by p, u_x by q_x, u_y by q_y and u_x by p, by lags of up to n - 1 cells.

    The symbol less that of the half-plane at the surface is an image c(0) exp(-kZ), whose integral is known, and a
    rest of the order k. Periodic bodies have the sum over their waves instead.
    """
    lag, sums = np.arange(n) * h, np.zeros((4, n))
    point, weight = np.polynomial.legendre.leggauss(12)

    def ends(primitive):  # the mean over a cell times its width
        return (primitive(lag + h / 2) - primitive(lag - h / 2)) / np.pi

    for sign, body in zip((-1, 1), bodies):
        if not body.layers:
            continue
        g, nu = body.surface()
        flat = np.array([(1 - nu) / g, (1 - nu) / g, 1 / g, -(1 - 2 * nu) / (2 * g)])[:, None]

        def rest(k, body=body, flat=flat):
            zz, zr, rr, tt = body.symbols(k)
            return np.array([zz, rr, tt, zr]) - flat

        signs = np.array([1, 1, 1, sign])[:, None]
        if not datum:
            k = 2 * np.pi * np.arange(1, n // 2 + 1) / (n * h)
            c = rest(k) / k * np.where(2 * np.arange(1, n // 2 + 1) == n, 0.5, 1) * 2 / n
            waves = np.outer(k, lag)
            sums[:3] += (c @ np.cos(waves))[:3]
            sums[3] += sign * ((c * np.where(2 * np.arange(1, n // 2 + 1) == n, 0, 1)) @ np.sin(waves))[3]
            continue
        thin, Z = body.layers[0][2], sum(layer[2] for layer in body.layers)
        edges = [0.0, 1e-6 / Z]
        while edges[-1] < 20 / thin:
            edges.append(edges[-1] + min(0.3 * edges[-1], 4 / (n * h), 0.5 / thin))
        k = (np.array(edges[:-1])[:, None] + np.diff(edges)[:, None] * (point + 1) / 2).ravel()
        w = (np.diff(edges)[:, None] * weight / 2).ravel() / np.pi
        long = rest(np.array([1e-11 / Z]))
        c = (rest(k) - long * np.exp(-k * Z)) / k * w * 2 * np.sin(k * h / 2) / k
        waves = np.outer(k, lag)
        by_ln = ends(lambda x, Z=Z: x - x * np.log(np.hypot(x, Z) / datum) - Z * np.arctan(x / Z))
        by_atan = ends(lambda x, Z=Z: x * np.arctan(x / Z) - Z * np.log(np.hypot(x, Z)))
        sums += signs * np.concatenate([(c @ np.cos(waves))[:3], (c @ np.sin(waves))[3:]])
        sums[:3] += long[:3] * by_ln
        sums[3] += sign * long[3] * by_atan
    return sums


def matrices(n, h, bodies, datum):
    """u_z by p, u_x by q_x, u_y by q_y, u_x by p, all (n, n): of half-planes (datum, m), or periodic (None)."""
    sums, bodies = layered(n, h, bodies, datum), [body.surface() for body in bodies]
    lag = np.subtract.outer(np.arange(n), np.arange(n))
    more = sums[:, np.abs(lag)] * np.array([np.ones((n, n))] * 3 + [np.sign(lag)])
    return [a + b for a, b in zip(more, half_planes(lag, h, bodies, datum))]


def half_planes(lag, h, bodies, datum):
    n = len(lag)
    normal = sum((1 - nu) / g for g, nu in bodies)
    across = sum(1 / g for g, nu in bodies)
    (g1, nu1), (g2, nu2) = bodies
    coupled = (1 - 2 * nu1) / (2 * g1) - (1 - 2 * nu2) / (2 * g2)
    if datum:
        x = h * np.abs(lag).astype(np.longdouble)
        high, low = x + h / 2, np.abs(x - h / 2)
        F = high * np.log(high / datum) - np.sign(x - h / 2) * low * np.log(low / datum) - h
        F = np.array(F, float)
        return -normal / np.pi * F, -normal / np.pi * F, -across / np.pi * F, coupled / 2 * h * np.sign(lag)
    k = 2 * np.pi * np.fft.fftfreq(n, h)
    size = np.abs(k)
    size[0] = np.inf
    odd = np.where(2 * np.abs(np.arange(n)) == n, 0, np.sign(k))  # the wave of two cells is its own mirror image
    even = np.real(np.fft.ifft(1 / size))
    turned = np.real(np.fft.ifft(-1j * odd / size))
    return normal * even[lag % n], normal * even[lag % n], across * even[lag % n], coupled * turned[lag % n]


class Check:
    """Ratios of errors to what is allowed, the largest by name, over the steps of a file."""

    def __init__(self, problem, f):
        self.problem, self.f, self.case, self.mu = problem, f, problem.case, problem.case["friction"]
        self.h = {name: values[:] for name, values in f["history"].items()}
        self.x = f["x"][:]
        self.d = self.x[1] - self.x[0]
        datum = f.attrs.get("plane_datum", None)
        self.kernels = matrices(self.x.size, self.d, problem.bodies, datum)
        self.past = {name: np.zeros(self.x.size) for name in ("x", "y", "w1", "w2", "plastic", "p")}
        self.worst = collections.defaultdict(float)
        self.unit = np.abs(self.kernels[0]).sum(axis=1).max() * max(np.abs(f["pressure"][:]).max(), 1e-300)

    def test(self, name, value):
        self.worst[name] = max(self.worst[name], float(value) if np.isfinite(value) else np.inf)

    def step(self, k):
        """All conditions of a step; then what it leaves to the next one."""
        p, *q = (self.f[name][k, 0] for name in ("pressure", "shear_x", "shear_y"))
        now = [self.f[f"slip_{c}"][k, 0] for c in "xy"]
        self.normal(k, p, q[0])
        self.tangential(k, p, np.array(q), now)
        self.wear(k, p, now)
        self.sums(k, p, q)
        self.past.update(x=now[0], y=now[1], p=p)
        if "plastic_depth" in self.f:
            self.past["plastic"] = self.f["plastic_depth"][k, 0]

    def normal(self, k, p, qx):
        Z, _, _, C = self.kernels
        u, rigid = Z @ p - C @ qx, self.h["disp_z"][k] + self.x * self.h["rot_y"][k]
        g = self.problem.gap + self.past["w1"] + self.past["w2"] + self.past["plastic"] + u - rigid
        full = p >= self.case.get("pressure_limit", np.inf) * (1 - 1e-9)
        scale = max(np.abs(u).max(), 1e-3 * self.unit)
        self.test("tension", -p.min() / p.max() / 1e-12)
        self.test("overlap", -g[~full].min(initial=0) / scale / 1e-6)
        self.test("touch", np.abs(g[(p > 1e-7 * p.max()) & ~full]).max(initial=0) / scale / 3e-6)
        self.test("yield", g[full].max(initial=-1) / scale / 1e-6)

    def tangential(self, k, p, q, slip):
        _, X, Y, C = self.kernels
        film, stretch = self.problem.film, 0.0
        for number, body in enumerate(self.problem.bodies, 1):
            g, nu = body.base[0] / (2 * (1 + body.base[1])), body.base[1]
            s = self.h.get(f"bulk{number}_stress_xx", np.zeros(k + 1))[k]
            stretch += (-1) ** number * (1 - nu**2) * s / (2 * g * (1 + nu))
        s_x = X @ q[0] + film * q[0] + C @ p + stretch * self.x - self.h["disp_x"][k]
        s_y = Y @ q[1] + film * q[1] - self.h["disp_y"][k]
        bound = self.mu * p
        self.test("cone", (np.hypot(*q) - bound).max() / p.max() / 1e-9)
        move = np.array([s_x - self.past["x"], s_y - self.past["y"]])
        z = q - move / (0.5 * (X[0, 0] + Y[0, 0]) + film)
        length = np.maximum(np.hypot(*z), 1e-300)
        residual = q - z * np.where(length > bound, bound / length, 1)
        self.test("friction", np.linalg.norm(residual) / max(np.linalg.norm(bound), 1e-300) / 3e-5)
        self.test("slip", max(np.abs(slip[0] - s_x).max(), np.abs(slip[1] - s_y).max()) / self.unit / 1e-7)

    def wear(self, k, p, slip):
        """Not more than the larger pressure over the way, and as the work of friction."""
        way = np.hypot(slip[0] - self.past["x"], slip[1] - self.past["y"])
        most = np.maximum(p, self.past["p"]) * way * (1 + 1e-6)
        for b in (1, 2):
            if f"wear_depth{b}" in self.f:
                depth = self.f[f"wear_depth{b}"][k, 0]
                k_b, more = self.case.get(f"wear_coefficient{b}", 0), depth - self.past[f"w{b}"]
                unit, work = max(depth.max(), 1e-30), self.f["friction_energy"][k, 0]
                self.test("wear", max(-more.min(), (more - k_b * most).max()) / unit / 1e-9)
                self.test("wear work", np.abs(depth - k_b / self.mu * work).max() / unit / 1e-6)
                self.past[f"w{b}"] = depth

    def sums(self, k, p, q):
        """Loads, and what is given."""
        h, x = self.h, self.x
        found = dict(load_n=p.sum(), load_tx=q[0].sum(), load_ty=q[1].sum(), load_my=(x * p).sum())
        for name, value in found.items():
            unit = p.sum() * self.d * (np.abs(x).max() if name == "load_my" else 1)
            self.test("sums", abs(value * self.d - h[name][k]) / unit / 1e-9)
        for name, values in self.problem.rows.items():
            least = 1e-6 * (h["load_n"][k] if "load" in name else self.unit)
            self.test("given", abs(values[k] - h[name][k]) / max(np.abs(h[name]).max(), least) / 1e-7)


def faults(problem, f):
    """What is wrong with the steps of a file."""
    check = Check(problem, f)
    for k in range(len(check.h["time"])):
        check.step(k)
    return check.h, {name: value for name, value in check.worst.items() if not value <= 1}


# ---------------------------------------------------------------- problems


class Problem:
    """A random history of a line of cells; `kinds` are its properties."""

    def __init__(self, seed):
        self.random = np.random.default_rng(seed)
        self.kinds = []
        n, self.a, self.mu = int(self.log(16, 300)), self.log(1e-5, 1e-2), self.log(0.03, 1)
        self.periodic = self.is_a("periodic", 0.25)
        self.width = float(self.random.uniform(2.6, 4)) * self.a
        self.datum = None if self.random.random() < 0.5 else self.width * self.log(0.6, 1e3)
        self.make_bodies()
        self.p0 = self.modulus * self.log(1e-4, 3e-2)
        self.make_gap(n)
        self.make_case(n)
        self.make_history()

    def log(self, low, high):
        return float(np.exp(self.random.uniform(np.log(low), np.log(high))))

    def is_a(self, kind, chance):
        if self.random.random() < chance:
            self.kinds.append(kind)
        return kind in self.kinds

    def make_bodies(self):
        young, nu = self.log(2e8, 5e11), self.random.uniform(0, 0.5)
        bases = [(young, nu)] * 2
        if self.is_a("dissimilar", 0.3):
            bases[1] = (young * self.log(0.1, 10), self.random.uniform(0, 0.5))
        layers, which = [[], []], self.random.integers(1, 4)
        if self.is_a("layers", 0.3):
            self.datum = self.datum and 50 * self.datum  # displacements relative to a near one are not positive
            layers = [self.make_layers(base[0]) if which & (1 << k) else [] for k, base in enumerate(bases)]
        self.bodies = [Body(*one) for one in zip(layers, bases)]
        wave = np.array([1 / self.a])
        self.modulus = 0.5 / sum(body.symbols(wave)[0][0] for body in self.bodies)

    def make_layers(self, young):
        return [
            (young * self.log(0.03, 30), self.random.uniform(0, 0.5), self.a * self.log(0.03, 3))
            for _ in range(self.random.integers(1, 4))
        ]

    def make_gap(self, n):
        x = ((np.arange(n) + 0.5) / n - 0.5) * self.width
        self.radius = self.a * self.modulus / (2 * self.p0)
        self.gap = x**2 / (2 * self.radius)
        if self.is_a("flat", 0.25):  # with rounded edges
            self.gap = np.maximum(np.abs(x) - 0.6 * self.a, 0) ** 2 / self.radius
        if self.is_a("rough", 0.3):
            waves = np.cumsum(self.random.normal(size=n))
            self.gap += self.a**2 / self.radius * self.log(1e-3, 0.1) * (waves - waves.mean()) / waves.std()

    def make_case(self, n):
        self.case = dict(
            slip_direction="end",  # the law of a step as it is tested below
            step_divide="no",
            elasticity="plane_periodic" if self.periodic else "plane",
            plane_datum=None if self.periodic else self.datum,
            gap_type="file",
            gap_file="gap.h5",
            grid_n=n,
            grid_size=self.width,
            friction=self.mu,
            normal_rtol=1e-9,
            tangential_rtol=1e-8,
            history="h.csv",
            steps=1,
            output_fields="all",
        )
        for k, body in enumerate(self.bodies, 1):
            self.case.update({f"body{k}_young": body.base[0], f"body{k}_poisson": float(body.base[1])})
            for name, values in zip(("young", "poisson", "thickness"), zip(*body.layers)):
                self.case[f"body{k}_layer_{name}"] = [float(value) for value in values]
        self.film = 0.0
        if self.is_a("film", 0.2):
            self.film = self.width / n / self.bodies[0].surface()[0] * self.log(1e-2, 1e2)
            self.case.update(film_thickness=1e-6, film_shear=1e-6 / self.film)
        if self.is_a("hard", 0.15):
            self.case["pressure_limit"] = self.p0 * self.log(0.5, 2)
        if self.is_a("wear", 0.25):
            wear = self.log(1e-3, 0.1) / self.p0 * self.a / self.radius
            self.case[f"wear_coefficient{self.random.choice([1, 2])}"] = wear

    def make_history(self):
        """Rows of loads, of which the tangential ones change their signs."""
        random, load = self.random, np.pi * self.p0 * self.a / 2
        N = load * random.uniform(0.3, 1, STEPS)
        angle = 0 if random.random() < 0.6 else random.uniform(0, 2 * np.pi)
        T = self.mu * N * (0.7 if "dissimilar" in self.kinds else 0.95) * random.uniform(-1, 1, STEPS)
        self.rows = dict(load_n=N, load_tx=T * np.cos(angle))
        if angle:
            self.kinds.append("antiplane")
            self.rows["load_ty"] = T * np.sin(angle)
        if not self.periodic and self.is_a("moment", 0.3):
            self.rows["load_my"] = N * self.a * random.uniform(-0.15, 0.15, STEPS)
        if self.is_a("displacements", 0.25):  # of all loads but that along z
            for name, way in (("load_tx", "disp_x"), ("load_ty", "disp_y")):
                if self.rows.pop(name, None) is not None:
                    self.rows[way] = random.uniform(-1, 1, STEPS) * self.mu * load / self.modulus
        self.columns = dict(self.rows)
        if not self.periodic and self.is_a("bulk", 0.3):
            self.columns[f"bulk{random.choice([1, 2])}_stress_xx"] = self.mu * self.p0 * random.uniform(-1, 1, STEPS)

    def write(self, folder):
        with h5py.File(folder / "gap.h5", "w") as f:
            f["height"] = self.gap[None, :]
        names = ["time", *self.columns]
        rows = np.column_stack([np.arange(STEPS), *self.columns.values()])
        text = "\n".join([",".join(names), *(",".join(repr(float(v)) for v in row) for row in rows)])
        (folder / "h.csv").write_text(text + "\n")


def numbers(history):
    """Products, the most of a step."""
    return {name: float(history[f"{name}_applies"].max()) for name in ("normal", "tangential")}


def trial(seed, folder, given=None):
    """What is wrong with the steps of a problem."""
    problem = Problem(seed)
    problem.write(folder)
    command = [str(conftest.PROGRAM), *words(dict(problem.case, output="r.h5"))]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=300)
    line = " ".join(words(problem.case))
    if done.returncode in (11, 12):  # gross slip by rough surfaces, or contact up to the edge of the grid
        return costs.outcome([f"code {done.returncode}"], {}, {}, line)
    if done.returncode:
        return costs.outcome(problem.kinds, {}, {f"code {done.returncode}": done.stderr.strip()[-300:]}, line)
    with h5py.File(folder / "r.h5") as f:
        h, wrong = faults(problem, f)
    return costs.outcome(problem.kinds, numbers(h), wrong, line)

"""Steady rolling, random problems: each must be solved within 80 products and agree with formulas in numpy.

Ellipses a/b 0.1 to 10, nu 0 to 0.5, roughness, films, friction fields, dissimilar bodies; creepages and loads to 0.99
of the limit in all combinations; grids of 32 to 128 cells. The summary has the products by properties.
"""

import subprocess

import h5py
import numpy as np

import conftest
from kinds import costs
from support import words
from test_rolling import integrals

OPTIONS = dict(trials=500)
summary = costs.summary
MOST = 80  # products of each coupling iteration
SIZES = (33, 35, 36, 40, 42, 45, 48, 50, 54, 55, 60, 63, 70, 72, 77, 90, 96, 105, 120, 127)


# ---------------------------------------------------------------- mechanics


def corners(n, d, function):
    """The integral over a cell of d, at distances of up to n cells, of what has this antiderivative."""
    x, y = (d[k] * (np.arange(-n[k], n[k] + 1) - 0.5) for k in range(2))
    f = function(x[None, :], y[:, None])
    return f[1:, 1:] - f[1:, :-1] - f[:-1, 1:] + f[:-1, :-1]


def kernels(n, d, bodies):
    """xx, xy, yy of shear, and x, y of pressure: displacement u2 - u1 by the traction on body 2."""
    # over a cell: x^2/r^3, y^2/r^3 and xy/r^3 of Cerruti's solution, x/r^2 and y/r^2 of Boussinesq's
    x2 = corners(n, d, lambda x, y: y * np.arcsinh(x / np.abs(y)))
    y2 = corners(n, d, lambda x, y: x * np.arcsinh(y / np.abs(x)))
    xy = corners(n, d, lambda x, y: -np.hypot(x, y))
    px = corners(n, d, lambda x, y: y * np.log(np.hypot(x, y)) + x * np.arctan(y / x))
    py = corners(n, d, lambda x, y: x * np.log(np.hypot(x, y)) + y * np.arctan(x / y))
    whole = sum((1 - nu) / (2 * np.pi * g) for g, nu in bodies)
    part = sum(nu / (2 * np.pi * g) for g, nu in bodies)
    (g1, nu1), (g2, nu2) = bodies
    pressed = (1 - 2 * nu1) / (4 * np.pi * g1) - (1 - 2 * nu2) / (4 * np.pi * g2)
    return whole * (x2 + y2) + part * x2, part * xy, whole * (x2 + y2) + part * y2, pressed * px, pressed * py


def convolve(kernel, field):
    shape = [k + f - 1 for k, f in zip(kernel.shape, field.shape)]
    full = np.fft.irfft2(np.fft.rfft2(kernel, shape) * np.fft.rfft2(field, shape), shape)
    j, i = (k // 2 for k in kernel.shape)
    return full[j : j + field.shape[0], i : i + field.shape[1]]


def difference(field):
    """q_i - q_(i+1), zero beyond the last column."""
    return field - np.pad(field, ((0, 0), (0, 1)))[:, 1:]


def faults(case, bodies, film, mu, f):
    """What is wrong with the last step of a file."""
    h = {name: float(values[-1]) for name, values in f["history"].items()}
    p, q, v = (
        f["pressure"][-1],
        *(np.array([f[f"{name}_{c}"][-1] for c in "xy"]) for name in ("shear", "slip_velocity")),
    )
    x, y = f["x"][:], f["y"][:]
    d = x[1] - x[0], y[1] - y[0]
    xx, xy, yy, px, py = kernels((x.size, y.size), d, bodies)
    dq, dp, area = np.array([difference(c) for c in q]), difference(p), d[0] * d[1]
    u = np.array([convolve(xx, dq[0]) + convolve(xy, dq[1]), convolve(xy, dq[0]) + convolve(yy, dq[1])]) + film * dq
    by_pressure = np.array([convolve(px, dp), convolve(py, dp)])
    x, y = np.meshgrid(x, y)
    w = np.array([h["creep_x"] - h["creep_spin"] * y, h["creep_y"] + h["creep_spin"] * (x + d[0] / 6)])
    s = (u + by_pressure) / d[0] - w
    bound, c = mu * p, ((xx.max() + yy.max()) / 2 + film) / d[0]
    z = q - s / c
    size = np.hypot(*z)
    residual = q - z * np.where(size > bound, bound / np.maximum(size, 1e-300), 1)
    loads = dict(load_n=p.sum(), load_tx=q[0].sum(), load_ty=q[1].sum(), load_mz=(x * q[1] - y * q[0]).sum())
    total, arm = bound.sum() * area, np.hypot(x, y)[p > 0].max()
    power = sum(h[f"load_{a}"] * h[f"creep_{b}"] for a, b in (("tx", "x"), ("ty", "y"), ("mz", "spin")))
    scale = np.maximum(np.abs(q * w), np.abs(q * s)).sum() * area + 1e-300
    damping = (dq * u).sum() * area / (2 * d[0])
    most = np.linalg.norm(residual) / (max(np.linalg.norm(q), 1e-8 * np.linalg.norm(bound)) + 1e-300)
    reach = np.abs(s)[:, p > 0].max() + 1e-300
    tests = dict(
        residual=most / 3e-6,
        bound=(np.hypot(*q) - bound).max() / bound.max() / 1e-12,
        slip=np.abs(v - s)[:, p > 0].max() / reach / 1e-6,
        rolling_energy=abs(h["rolling_energy"] - power) / scale / 1e-9,
        power=abs((q * (s - by_pressure / d[0] + w)).sum() * area - damping) / (damping + 1e-300) / 1e-6,
        cells=abs(h["rolling_energy_cells"] + (q * s).sum() * area) / scale / 1e-6,
        damping=(0 if damping >= 0 else np.inf),
        products=h["tangential_applies"] / max(1, h.get("coupling_iterations", 1)) / MOST,
    )
    for name, load in loads.items():
        unit = h["load_n"] if name == "load_n" else total * (arm if name == "load_mz" else 1)
        tests[name] = max(abs(load * area - h[name]), abs(h[name] - case.get(name, h[name]))) / unit / 1e-9
    return h, {name: value for name, value in tests.items() if not value <= 1}


# ---------------------------------------------------------------- problems


def radii(a, b, p0, modulus):
    short, long = min(a, b), max(a, b)
    e2 = 1 - (short / long) ** 2
    if e2 < 1e-6:
        return [2 * a * modulus / (np.pi * p0)] * 2
    K, E = integrals(e2)
    across = 2 * p0 / (modulus * short * e2) * (E - (1 - e2) * K)
    along = 2 * p0 * short / (modulus * long**2 * e2) * (K - E)
    return [1 / across, 1 / along] if a < b else [1 / along, 1 / across]


def waves(random, n, d, lowest):
    """Random heights of rms 1, waves between `lowest` and a few cells."""
    k = np.hypot(np.fft.fftfreq(n[1], d[1])[:, None], np.fft.rfftfreq(n[0], d[0])[None, :])
    seen = (k > 1 / lowest) & (k < 0.3 / min(d))
    damped = seen / np.where(k > 0, k, 1) ** 1.8
    rough = np.fft.irfft2(np.fft.rfft2(random.normal(size=(n[1], n[0]))) * damped, (n[1], n[0]))
    return rough / rough.std() if rough.std() > 0 else rough


class Problem:
    """A random contact; `kinds` are its properties."""

    def __init__(self, seed):
        self.random = random = np.random.default_rng(seed)
        self.kinds = []

        def log(low, high):
            return float(np.exp(random.uniform(np.log(low), np.log(high))))

        def is_a(kind, chance):
            if random.random() < chance:
                self.kinds.append(kind)
            return kind in self.kinds

        a, g, nu, mu = log(1e-5, 1e-2), log(1e8, 2e11), random.uniform(0, 0.5), log(0.02, 1)
        b, p0 = a / log(0.1, 10), g * log(1e-4, 3e-2)
        self.n = tuple(int(k) for k in random.choice(SIZES, 2))
        self.bodies = [(g, nu)] * 2
        if is_a("dissimilar", 0.2):
            self.bodies = [(g, nu), (g * log(0.1, 10), random.uniform(0, 0.5))]
        young = [2 * g * (1 + nu) for g, nu in self.bodies]
        modulus = 1 / sum((1 - nu) / (2 * g) for g, nu in self.bodies)
        size = [float(random.uniform(2.4, 3.2)) * k for k in (a, b)]
        d = [s / k for s, k in zip(size, self.n)]
        radius = radii(a, b, p0, modulus)
        self.a, self.b, self.creep = a, b, mu * p0 / g
        self.case = dict(
            rolling="steady",
            body1_young=young[0],
            body2_young=young[1],
            body1_poisson=self.bodies[0][1],
            body2_poisson=self.bodies[1][1],
            gap_type="ellipsoid",
            gap_radius_x=float(radius[0]),
            gap_radius_y=float(radius[1]),
            load_n=2 / 3 * np.pi * p0 * a * b,
            grid_n=self.n,
            grid_size=tuple(size),
            friction=mu,
        )
        self.film = 0.0
        if is_a("film", 0.25):
            self.film = min(d) / g * log(1e-2, 1e2)
            self.case.update(film_thickness=1e-6, film_shear=1e-6 / self.film)
        self.files = {}
        if is_a("rough", 0.3):
            depth = a * a / radius[0] / 2 + b * b / radius[1] / 2
            self.files["rough"] = depth * log(1e-3, 0.3) * waves(random, self.n, d, min(a, b))
            self.case.update(gap_rough_file="rough.h5", gap_rough_dataset="/rough")
        self.mu = np.full(self.n[::-1], mu)
        if is_a("field", 0.25):
            field = 1 + log(0.02, 0.5) * waves(random, self.n, d, 2 * max(a, b))
            self.mu = mu * np.clip(field, 0.05 if random.random() < 0.8 else 0, 3)
            self.files["friction"] = self.mu
            self.case.update(friction=None, friction_file="friction.h5")

    def drive(self, p, x, y):
        """Creepages and loads, each of which may be zero; loads up to 0.99 of those under some full sliding."""
        random = self.random
        strength = 10 ** random.uniform(-1.5, 1.5 if random.random() < 0.8 else 6)
        arm = np.sqrt(self.a * self.b)
        creep = random.normal(size=3) * (random.random(3) < 0.7)
        creep = creep / max(np.linalg.norm(creep), 1e-9) * strength * self.creep / np.array([1, 1, arm])
        x, y = np.meshgrid(x, y)
        slide = random.normal(size=3) * (random.random(3) < 0.6)
        way = np.array([slide[0] - slide[2] * y / arm, slide[1] + slide[2] * x / arm])
        q = self.mu * p * way / np.maximum(np.hypot(*way), 1e-300)
        area = (x[0, 1] - x[0, 0]) * (y[1, 0] - y[0, 0])
        most = np.array([q[0].sum(), q[1].sum(), (x * q[1] - y * q[0]).sum()]) * area
        limit = 0.9 if "dissimilar" in self.kinds else 0.99  # the pressure is another one
        share = limit if random.random() < 0.3 else random.uniform(0.05, limit)
        force = random.random(3) < random.choice([0, 0.6])
        for k, (load, rate) in enumerate((("tx", "x"), ("ty", "y"), ("mz", "spin"))):
            if force[k]:
                self.case[f"load_{load}"] = float(share * most[k])
            else:
                self.case[f"creep_{rate}"] = float(creep[k])
        if np.any(force):
            self.kinds.append("loads")


def run(folder, case, name):
    line = [str(conftest.PROGRAM), *words(dict(case, output=name, overwrite=True))]
    return subprocess.run(line, cwd=folder, capture_output=True, text=True, timeout=300)


def numbers(history):
    """Products of a pass, and the area of contact over that of the ellipse."""
    passes = max(1, history.get("coupling_iterations", 1))
    return {"products": float(history["tangential_applies"] / passes), "area": float(history["share"])}


def trial(seed, folder, given=None):
    """What is wrong with the steps of a problem."""
    for _ in range(20):
        problem = Problem(seed)
        for name, field in problem.files.items():
            with h5py.File(folder / f"{name}.h5", "w") as f:
                f[name] = field
        still = dict(problem.case, rolling=None, friction=None, friction_file=None)
        done = run(folder, dict(still, film_thickness=None, film_shear=None), "still.h5")
        if done.returncode == 0:
            break
        seed += 10**6  # rough, and larger than the grid
    with h5py.File(folder / "still.h5") as f:
        p, x, y = f["pressure"][-1], f["x"][:], f["y"][:]
    problem.drive(p, x, y)
    done = run(folder, dict(problem.case, output_fields="all"), "rolled.h5")
    line = " ".join(words({k: v for k, v in problem.case.items() if v is not None}))
    if done.returncode:
        return costs.outcome(problem.kinds, {}, {f"code {done.returncode}": done.stderr.strip()[-300:]}, line)
    with h5py.File(folder / "rolled.h5") as f:
        h, wrong = faults(problem.case, problem.bodies, problem.film, problem.mu, f)
    h["share"] = (p > 0).sum() * (x[1] - x[0]) * (y[1] - y[0]) / (np.pi * problem.a * problem.b)
    return costs.outcome(problem.kinds, numbers(h), wrong, line)

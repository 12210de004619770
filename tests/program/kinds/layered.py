"""Layered bodies, random problems: each must agree with coefficients by an own solution of the layers and quadrature.

One to five layers on one or both bodies, E ratios 0.01 to 100, nu 0 to 0.5, thicknesses 0.01 to 10 contact radii, rigid
bases, friction to 1, normal loads, then tangential ones in one or two steps. Each wave's boundary conditions are one
linear system here, not a recursion; its transforms to space are sums over the wave number, not over its logarithm.
The summary has the products by properties.
"""

import collections
import subprocess

import h5py
import numpy as np
from scipy.interpolate import CubicSpline, make_interp_spline
from scipy.special import j0, j1, jv

import conftest
from kinds import costs
from kinds.rolling import convolve, corners, kernels
from layers import Body
from support import words

OPTIONS = dict(trials=300)
summary = costs.summary

# ---------------------------------------------------------------- mechanics


def transform(depth, ks, d, order, r):
    """1/2pi times the integral of d(k) J_order(kr), d given at ks, over all k; it falls like exp(-depth k)."""
    smooth = CubicSpline(np.log(ks), d)
    most, edges = 40 / depth, [0.0, float(ks[0])]
    while edges[-1] < most:  # panels on which d and the Bessel functions are polynomials of a low degree
        edges.append(edges[-1] + min(0.3 * edges[-1], 2 / r.max(), 0.5 / depth))
    x, w = np.polynomial.legendre.leggauss(8)
    half, mid = np.diff(edges) / 2, np.add(edges[1:], edges[:-1]) / 2
    k = (mid[:, None] + half[:, None] * x).ravel()
    g = (half[:, None] * w).ravel() * smooth(np.log(np.maximum(k, ks[0]))) / (2 * np.pi)
    bessel = {0: j0, 1: j1}.get(order, lambda z: jv(order, z))
    return np.array([g @ bessel(k * one) for one in r])


def coefficients(bodies, n, d):
    """Influence of a cell at lags from -n to n - 1 cells: zz, xx, xy, yy, and xz, yz of pressure; of body 2 less 1."""
    elastic = [(body, sign) for body, sign in zip(bodies, (-1, 1)) if body]
    surfaces = [body.surface() if body else (np.inf, 0.0) for body in bodies]
    xx, xy, yy, px, py = kernels(n, d, surfaces)
    zz = corners(n, d, lambda x, y: x * np.arcsinh(y / np.abs(x)) + y * np.arcsinh(x / np.abs(y)))
    zz = sum((1 - nu) / (2 * np.pi * g) for g, nu in surfaces) * zz
    layered = [(body, sign) for body, sign in elastic if body.layers]
    depth = 2 * min(body.layers[0][2] for body, _ in layered)
    total = max(sum(layer[2] for layer in body.layers) for body, _ in layered)
    diagonal = np.hypot(n[0] * d[0], n[1] * d[1]) * 1.1
    ks = np.geomspace(1e-7 / max(total, diagonal), 60 / depth, 2500)
    sums = np.zeros((4, ks.size))
    for body, sign in layered:
        g, nu = body.surface()
        flat = ((1 - nu) / g, -(1 - 2 * nu) / (2 * g), (1 - nu) / g, 1 / g)
        for m, (symbol, half_space) in enumerate(zip(body.symbols(ks), flat)):
            sums[m] += (sign if m == 1 else 1) * (symbol - half_space)
    r = np.concatenate([[0], np.geomspace(1e-3 * depth, diagonal, 260)])
    if r[1] > 0.2 * max(d):
        r = np.concatenate([[0], np.geomspace(1e-2 * min(d), diagonal, 400)])
    f = [
        transform(depth, ks, one, order, r)
        for one, order in ((sums[0], 0), ((sums[2] + sums[3]) / 2, 0), ((sums[3] - sums[2]) / 2, 2), (sums[1], 1))
    ]
    even = make_interp_spline(
        np.concatenate([-r[:0:-1], r]), np.concatenate([np.array(f[:3])[:, :0:-1], f[:3]], axis=1), k=7, axis=1
    )
    odd = make_interp_spline(np.concatenate([-r[:0:-1], r]), np.concatenate([-f[3][:0:-1], f[3]]), k=7)

    def values(x, y):
        s = np.hypot(x, y)
        z, one, two = even(s)
        third, s = odd(s), np.where(s > 0, s, 1)
        c, q = x / s, y / s
        return np.array(
            [z, one + two * (c * c - q * q), 2 * two * c * q, one - two * (c * c - q * q), third * c, third * q]
        )

    added = np.zeros((6, 2 * n[1], 2 * n[0]))
    lag = np.mgrid[-n[1] : n[1], -n[0] : n[0]].astype(float)
    x, w = np.polynomial.legendre.leggauss(7)

    def integrate(j, i, cut):
        """Integrals over the cells at these lags, each cut into cut * cut parts."""
        points = ((np.arange(cut) + 0.5)[:, None] + x / 2).ravel() / cut - 0.5
        weight = np.tile(w / 2, cut) / cut
        return sum(
            a * b * d[0] * d[1] * values((i + s) * d[0], (j + t) * d[1])
            for s, a in zip(points, weight)
            for t, b in zip(points, weight)
        )

    far = np.hypot(lag[0] * d[1], lag[1] * d[0])
    fine = int(min(40, max(1, np.ceil(1.2 * max(d) / depth))))
    for part, cut in ((far > 4.5 * max(d), 1), ((far <= 4.5 * max(d)) & (far > 0), 3 * fine), (far == 0, 3 * fine)):
        added[:, part] = integrate(lag[0][part], lag[1][part], cut)
    return [a + b for a, b in zip((zz, xx, xy, yy, px, py), added)]


def faults(bodies, mu, f):
    """What is wrong in a file, over what is allowed; its history."""
    h = {name: values[:] for name, values in f["history"].items()}
    x, y = f["x"][:], f["y"][:]
    d = x[1] - x[0], y[1] - y[0]
    c = coefficients(bodies, (x.size, y.size), d)
    xm, ym = np.meshgrid(x, y)
    area, before, tests = d[0] * d[1], np.zeros((2, y.size, x.size)), collections.defaultdict(float)

    def most(name, value, allowed):
        tests[name] = max(tests[name], float(value) / allowed)

    for step in range(f["pressure"].shape[0]):
        r = {name: float(values[step]) for name, values in h.items()}
        p, q = f["pressure"][step], np.array([f[f"shear_{a}"][step] for a in "xy"])
        uz = convolve(c[0], p) - convolve(c[4], q[0]) - convolve(c[5], q[1])
        ut = np.array([convolve(c[1], q[0]) + convolve(c[2], q[1]), convolve(c[2], q[0]) + convolve(c[3], q[1])])
        ut += np.array([convolve(c[4], p), convolve(c[5], p)])
        largest = np.abs(uz).max()
        most("displacement", np.abs(uz - f["displacement_z"][step]).max() / largest, 3e-8)
        free = f["gap"][step] - f["displacement_z"][step]  # from the gap's definition
        gap = free + uz
        most("gap", np.abs(gap[p > 0]).max() / largest, 2e-6)
        most("penetration", -gap.min() / largest, 2e-6)
        most("tension", -p.min() / p.max(), 1e-14)
        bound = mu * p
        most("bound", (np.hypot(*q) - bound).max() / p.max(), 1e-9)
        way = np.array([r["disp_x"] - ym * r["rot_z"], r["disp_y"] + xm * r["rot_z"]])
        slip = ut - way - before
        size = (c[1].max() + c[3].max()) / 2
        z = q - slip / size
        length = np.hypot(*z)
        residual = (q - z * np.where(length > bound, bound / np.maximum(length, 1e-300), 1))[:, p > 0]
        if mu > 0 and step > 0:
            most("friction", np.abs(residual).max() * size / max(np.abs(ut).max(), 1e-300), 1e-5)
        before = ut - way
        for name, field in dict(load_n=p, load_tx=q[0], load_ty=q[1]).items():
            most(name, abs(field.sum() * area - r[name]) / r["load_n"], 1e-9)
    return h, {name: value for name, value in tests.items() if not value <= 1}


# ---------------------------------------------------------------- problems


def material(name, body):
    """The options of a body; None: rigid."""
    if body is None:
        return {name + "young": np.inf}
    case = {name + "young": body.base[0] if body.base else np.inf, name + "poisson": body.base[1] if body.base else 0.3}
    for k, word in enumerate(("young", "poisson", "thickness")):
        if body.layers:
            case[name + "layer_" + word] = [layer[k] for layer in body.layers]
    return case


class Problem:
    def __init__(self, seed):
        self.random = random = np.random.default_rng(seed)
        self.kinds = []

        def log(low, high):
            return float(np.exp(random.uniform(np.log(low), np.log(high))))

        def ratio():
            return float(random.choice([0.5, 0.0, 0.3])) if random.random() < 0.3 else float(random.uniform(0, 0.5))

        young, self.a, self.mu = log(1e8, 1e11), log(1e-5, 1e-2), log(0.02, 1) if random.random() < 0.8 else 0.0

        def layers(most):
            count = int(random.integers(1, most + 1))
            return [(young * log(0.01, 100), ratio(), self.a * log(0.01, 10)) for _ in range(count)]

        base = None if random.random() < 0.12 else (young, ratio())
        second = Body(layers(5), base)
        kind = str(random.choice(["rigid", "alike", "half-space", "layered"]))
        firsts = {
            "rigid": lambda: None,
            "alike": lambda: second,
            "half-space": lambda: Body([], (young * log(0.1, 100), ratio())),
            "layered": lambda: Body(layers(3), (young * log(0.1, 10), ratio())),
        }
        self.bodies = (firsts[kind](), second)
        self.kinds += [kind, f"{len(second.layers)} layers", *([] if base else ["rigid base"])]
        self.n = tuple(int(k) for k in random.integers(33, 49, 2))
        self.case = dict(gap_type="sphere", gap_radius1=1e3 * self.a, gap_radius2=np.inf)
        for number, body in enumerate(self.bodies, 1):
            self.case.update(material(f"body{number}_", body))
        self.case["friction"] = self.mu
        # the load under which a contact of radius a is, about, by the moduli at the surface and deep inside
        self.case["load_n"] = 4 / 3 * young * self.a**3 / (1e3 * self.a) * log(0.2, 2)


def run(folder, case, name):
    line = [str(conftest.PROGRAM), *words(dict(case, output=name))]
    (folder / name).unlink(missing_ok=True)
    return subprocess.run(line, cwd=folder, capture_output=True, text=True, timeout=600)


def fit(folder, problem):
    """Chooses the grid's width so that the contact is 15 to 45 cells across; the last result of doing so."""
    width = 6 * problem.a
    for _ in range(8):
        sides = (width * float(problem.random.uniform(0.95, 1.05)), width)
        problem.case.update(grid_n=problem.n, grid_size=sides)
        done = run(folder, dict(problem.case, friction=0.0), "still.h5")
        if done.returncode:
            width *= 2
            continue
        with h5py.File(folder / "still.h5") as f:
            across = 2 * np.sqrt(float(f["history/contact_area"][-1]) / np.pi) / width
        if 0.35 < across < 0.8:
            return done
        width *= across / 0.55 if across > 0 else 0.2
    return done


def numbers(history):
    """Products, the most of a step."""
    return {name: float(history[f"{name}_applies"].max()) for name in ("normal", "tangential")}


def trial(seed, folder, given=None):
    """What is wrong with the steps of a problem."""
    problem = Problem(seed)
    done, random = fit(folder, problem), problem.random
    rows = [[problem.case["load_n"], 0, 0, 0]]
    if problem.mu > 0:
        for _ in range(int(random.integers(1, 3))):
            limit = problem.mu * problem.case["load_n"] * random.uniform(0.05, 0.9)
            angle = random.uniform(0, 2 * np.pi)
            rows.append([rows[0][0], limit * np.cos(angle), limit * np.sin(angle), 0])
    case = {key: value for key, value in problem.case.items() if key != "load_n"}
    (folder / "h.csv").write_text(
        "time,load_n,load_tx,load_ty,load_mz\n"
        + "".join(",".join(map(repr, [k, *map(float, row)])) + "\n" for k, row in enumerate(rows))
    )
    case.update(history="h.csv", output_fields="all")
    line = " ".join(words(case))
    if done.returncode == 0:
        done = run(folder, case, "slid.h5")
    if done.returncode:
        return costs.outcome(problem.kinds, {}, {f"code {done.returncode}": done.stderr.strip()[-300:]}, line)
    with h5py.File(folder / "slid.h5") as f:
        h, wrong = faults(problem.bodies, problem.mu, f)
    return costs.outcome(problem.kinds, numbers(h), wrong, line)

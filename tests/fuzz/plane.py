#!/usr/bin/env python3
"""Plane strain, random histories: each step must fulfil the conditions of contact by dense matrices in numpy.

    python3 tests/fuzz/plane.py [--build build] [--count 300] [--seed 1] [--show]

Lines of 16 to 300 cells: half-planes and periodic ones, rough and rounded, nu 0 to 0.5, friction 0.03 to 1,
dissimilar bodies, bulk stress, antiplane loads, films, wear, hardness, tilting moments; loads and displacements in all
combinations, with reversals. Prints what repeats a failure. Ends with 1 after a failure.
"""

import argparse
import collections
import subprocess
import sys
import tempfile
from pathlib import Path

import h5py
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "program"))
from support import words  # noqa: E402

STEPS = 5
ALL = ("load_n", "load_tx", "load_ty", "load_my", "disp_z", "disp_x", "disp_y", "rot_y")


# ---------------------------------------------------------------- mechanics


def matrices(n, h, bodies, datum):
    """u_z by p (and u_x by q_x), u_y by q_y, u_x by p, all (n, n): of half-planes (datum, m), or periodic (None)."""
    normal = sum((1 - nu) / g for g, nu in bodies)
    across = sum(1 / g for g, nu in bodies)
    (g1, nu1), (g2, nu2) = bodies
    coupled = (1 - 2 * nu1) / (2 * g1) - (1 - 2 * nu2) / (2 * g2)
    lag = np.subtract.outer(np.arange(n), np.arange(n))
    if datum:
        x = h * np.abs(lag).astype(np.longdouble)
        high, low = x + h / 2, np.abs(x - h / 2)
        F = high * np.log(high / datum) - np.sign(x - h / 2) * low * np.log(low / datum) - h
        F = np.array(F, float)
        return -normal / np.pi * F, -across / np.pi * F, coupled / 2 * h * np.sign(lag)
    k = 2 * np.pi * np.fft.fftfreq(n, h)
    size = np.abs(k)
    size[0] = np.inf
    odd = np.where(2 * np.abs(np.arange(n)) == n, 0, np.sign(k))  # the wave of two cells is its own mirror image
    even = np.real(np.fft.ifft(1 / size))
    turned = np.real(np.fft.ifft(-1j * odd / size))
    return normal * even[lag % n], across * even[lag % n], coupled * turned[lag % n]


def faults(problem, f):
    """What is wrong with the steps of a file: ratios to what is allowed."""
    case, mu = problem.case, problem.case["friction"]
    h = {name: values[:] for name, values in f["history"].items()}
    x = f["x"][:]
    n, d = x.size, x[1] - x[0]
    Z, Y, C = matrices(n, d, problem.bodies, None if problem.periodic else problem.datum)
    gap = problem.gap
    past = {name: np.zeros(n) for name in ("x", "y", "w1", "w2", "plastic", "p")}
    worst = collections.defaultdict(float)

    def test(name, value):
        worst[name] = max(worst[name], float(value) if np.isfinite(value) else np.inf)

    unit_u = np.abs(Z).sum(axis=1).max() * max(np.abs(f["pressure"][:]).max(), 1e-300)
    for k in range(len(h["time"])):
        p, qx, qy = (f[name][k, 0] for name in ("pressure", "shear_x", "shear_y"))
        e = [[h[f"bulk{b}_stress_xx"][k] if f"bulk{b}_stress_xx" in h else 0.0] for b in (1, 2)]
        young = [2 * g * (1 + nu) for g, nu in problem.bodies]
        stretch = sum(sign * (1 - nu**2) * s[0] / E for sign, s, E, (_, nu) in zip((-1, 1), e, young, problem.bodies))
        u_z = Z @ p - C @ qx
        s_x = Z @ qx + problem.film * qx + C @ p + stretch * x - h["disp_x"][k]
        s_y = Y @ qy + problem.film * qy - h["disp_y"][k]
        g = gap + past["w1"] + past["w2"] + past["plastic"] + u_z - h["disp_z"][k] - x * h["rot_y"][k]
        limit = case.get("pressure_limit", np.inf)
        full = p >= limit * (1 - 1e-9)
        scale = max(np.abs(u_z).max(), 1e-3 * unit_u)
        test("tension", -p.min() / p.max() / 1e-12)
        test("overlap", -g[~full].min(initial=0) / scale / 1e-6)
        test("touch", np.abs(g[(p > 1e-7 * p.max()) & ~full]).max(initial=0) / scale / 3e-6)
        test("yield", g[full].max(initial=-1) / scale / 1e-6)
        # friction
        size = np.hypot(qx, qy)
        test("cone", (size - mu * p).max() / p.max() / 1e-9)
        move = np.array([s_x - past["x"], s_y - past["y"]])
        c = 0.5 * (Z[0, 0] + Y[0, 0]) + problem.film
        z = np.array([qx, qy]) - move / c
        length = np.maximum(np.hypot(*z), 1e-300)
        residual = np.array([qx, qy]) - z * np.where(length > mu * p, mu * p / length, 1)
        test("friction", np.linalg.norm(residual) / max(np.linalg.norm(mu * p), 1e-300) / 3e-5)
        test("slip", np.abs(f["slip_x"][k, 0] - s_x).max() / max(unit_u, 1e-300) / 1e-7)
        # what wears in this step, and what has worn before
        slid = np.hypot(*(np.array([f["slip_x"][k, 0], f["slip_y"][k, 0]]) - [past["x"], past["y"]]))
        most = np.maximum(p, past["p"]) * slid * (1 + 1e-6)
        past["p"] = p
        for b in (1, 2):
            if f"wear_depth{b}" in f:
                depth = f[f"wear_depth{b}"][k, 0]
                k_b, more = case.get(f"wear_coefficient{b}", 0), depth - past[f"w{b}"]
                unit = max(depth.max(), 1e-30)
                test("wear", max(-more.min(), (more - k_b * most).max()) / unit / 1e-9)
                test("wear work", np.abs(depth - k_b / mu * f["friction_energy"][k, 0]).max() / unit / 1e-6)
                past[f"w{b}"] = depth
        if "plastic_depth" in f:
            past["plastic"] = f["plastic_depth"][k, 0]
        past["x"], past["y"] = f["slip_x"][k, 0], f["slip_y"][k, 0]
        # sums, and what is given
        sums = dict(load_n=p.sum() * d, load_tx=qx.sum() * d, load_ty=qy.sum() * d, load_my=(x * p).sum() * d)
        for name, value in sums.items():
            unit = p.sum() * d * (np.abs(x).max() if name == "load_my" else 1)
            test("sums", abs(value - h[name][k]) / unit / 1e-9)
        for name, values in problem.rows.items():
            unit = max(np.abs(h[name]).max(), 1e-6 * (h["load_n"][k] if "load" in name else unit_u), 1e-12 * unit_u)
            test("given", abs(values[k] - h[name][k]) / unit / 1e-7)
    return h, {name: value for name, value in worst.items() if not value <= 1}


# ---------------------------------------------------------------- problems


class Problem:
    """A random history of a line of cells; `kinds` are its properties."""

    def __init__(self, seed):
        self.random = random = np.random.default_rng(seed)
        self.kinds = []

        def log(low, high):
            return float(np.exp(random.uniform(np.log(low), np.log(high))))

        def is_a(kind, chance):
            if random.random() < chance:
                self.kinds.append(kind)
            return kind in self.kinds

        n, a, g, nu, mu = int(log(16, 300)), log(1e-5, 1e-2), log(1e8, 2e11), random.uniform(0, 0.5), log(0.03, 1)
        self.periodic = is_a("periodic", 0.25)
        self.bodies = [(g, nu)] * 2
        if is_a("dissimilar", 0.3):
            self.bodies = [(g, nu), (g * log(0.1, 10), random.uniform(0, 0.5))]
        young = [float(2 * g * (1 + nu)) for g, nu in self.bodies]
        modulus = 1 / sum((1 - nu) / (2 * g) for g, nu in self.bodies)
        width = float(random.uniform(2.6, 4)) * a
        self.datum = width * (1 if random.random() < 0.5 else log(0.6, 1e3))
        x = ((np.arange(n) + 0.5) / n - 0.5) * width
        p0 = modulus * log(1e-4, 3e-2)
        radius = a * modulus / (2 * p0)
        self.gap = x**2 / (2 * radius)
        if is_a("flat", 0.25):  # with rounded edges
            self.gap = np.maximum(np.abs(x) - 0.6 * a, 0) ** 2 / (2 * 0.5 * radius)
        if is_a("rough", 0.3):
            waves = np.cumsum(random.normal(size=n))
            self.gap = self.gap + a**2 / radius * log(1e-3, 0.1) * (waves - waves.mean()) / waves.std()
        load = np.pi * p0 * a / 2
        self.case = dict(
            elasticity="plane_periodic" if self.periodic else "plane",
            plane_datum=None if self.periodic else float(self.datum),
            body1_young=young[0],
            body2_young=young[1],
            body1_poisson=float(self.bodies[0][1]),
            body2_poisson=float(self.bodies[1][1]),
            gap_type="file",
            gap_file="gap.h5",
            grid_n=n,
            grid_size=width,
            friction=mu,
            normal_rtol=1e-9,
            tangential_rtol=1e-8,
            history="h.csv",
            steps=1,
            output_fields="all",
        )
        self.film = 0.0
        if is_a("film", 0.2):
            self.film = width / n / g * log(1e-2, 1e2)
            self.case.update(film_thickness=1e-6, film_shear=1e-6 / self.film)
        if is_a("hard", 0.15):
            self.case["pressure_limit"] = p0 * log(0.5, 2)
        if is_a("wear", 0.25):
            self.case[f"wear_coefficient{random.choice([1, 2])}"] = log(1e-3, 0.1) / p0 * a / radius
        # each row of loads, of which the tangential ones change their signs
        t = np.arange(STEPS)
        N = load * random.uniform(0.3, 1, STEPS)
        share = 0.7 if "dissimilar" in self.kinds else 0.95
        angle = 0 if random.random() < 0.6 else random.uniform(0, 2 * np.pi)
        T = mu * N * share * random.uniform(-1, 1, STEPS)
        self.rows = dict(load_n=N, load_tx=T * np.cos(angle))
        if angle:
            self.kinds.append("antiplane")
            self.rows["load_ty"] = T * np.sin(angle)
        if not self.periodic and is_a("moment", 0.3):
            self.rows["load_my"] = N * a * random.uniform(-0.15, 0.15, STEPS)
        self.columns = dict(self.rows)
        if not self.periodic and is_a("bulk", 0.3):
            self.columns[f"bulk{random.choice([1, 2])}_stress_xx"] = mu * p0 * random.uniform(-1, 1, STEPS)
        if is_a("displacements", 0.25):  # of all loads but that along z
            for load_of, way in (("load_tx", "disp_x"), ("load_ty", "disp_y")):
                if load_of in self.columns:
                    move = random.uniform(-1, 1, STEPS) * mu * load / modulus
                    del self.rows[load_of], self.columns[load_of]
                    self.rows[way] = self.columns[way] = move
        self.t = t

    def write(self, folder):
        with h5py.File(folder / "gap.h5", "w") as f:
            f["height"] = self.gap[None, :]
        names = ["time", *self.columns]
        rows = np.column_stack([self.t, *self.columns.values()])
        text = "\n".join([",".join(names), *(",".join(repr(float(v)) for v in row) for row in rows)])
        (folder / "h.csv").write_text(text + "\n")


def trial(program, seed):
    """Kinds, history and faults of a problem."""
    problem = Problem(seed)
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        problem.write(folder)
        command = [str(program), *words(dict(problem.case, output="r.h5"))]
        done = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=300)
        line = " ".join(words(problem.case))
        if done.returncode in (11, 12):  # gross slip by rough surfaces, or contact up to the edge of the grid
            return [f"code {done.returncode}"], None, {}, line
        if done.returncode:
            return problem.kinds, None, {f"code {done.returncode}": done.stderr.strip()[-300:]}, line
        with h5py.File(folder / "r.h5") as f:
            h, wrong = faults(problem, f)
        return problem.kinds, h, wrong, line


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", default="build", help="the build folder")
    parser.add_argument("--count", type=int, default=300, help="how many problems")
    parser.add_argument("--seed", type=int, default=1, help="of the first; the next one has the next number")
    parser.add_argument("--show", action="store_true", help="print a line for each problem")
    given = parser.parse_args()
    program = Path(given.build).resolve() / "bin" / "petsam"
    counts, failed = collections.Counter(), 0
    for seed in range(given.seed, given.seed + given.count):
        kinds, h, wrong, line = trial(program, seed)
        counts.update(kinds or ["plain"])
        if given.show and h:
            most = max(h["normal_applies"].max(), h["tangential_applies"].max())
            print(seed, ",".join(kinds), f"products {most:.0f}", flush=True)
        if wrong:
            failed += 1
            print(f"seed {seed} ({', '.join(kinds)}): {wrong}\n    {line}", flush=True)
    print(", ".join(f"{kind} {count}" for kind, count in counts.most_common()))
    print(f"{given.count} problems, {failed} failed")
    return failed > 0


if __name__ == "__main__":
    sys.exit(main())

"""-pressure_limit: p <= H, and a plastic depth where it is reached, against numpy and scipy."""

import h5py
import numpy as np
import pytest
from scipy.optimize import minimize

import support
from support import ball

H = 0.7 * support.hertz(ball()).pressure
SATURATED = 1 - 1e-9  # of H: equilibrium is restored to rounding
SOFT = ball(40, 2, pressure_limit=H, load_n=None)


def rows(path, **columns):
    """A history of one step a value."""
    count = len(next(iter(columns.values())))
    table = np.column_stack([np.arange(1.0, count + 1), *columns.values()])
    path.write_text(
        ",".join(["time", *columns]) + "\n" + "".join(",".join(map(repr, r)) + "\n" for r in table.tolist())
    )
    return dict(history=path)


def influence(nx, ny, dx, dy, young, nu):
    """f(p): the normal displacement by a pressure on two equal half-spaces, by a convolution of its own."""
    x, y = np.meshgrid(np.arange(1 - nx, nx) * dx, np.arange(1 - ny, ny) * dy)
    kernel = 2 * (1 - nu**2) / (np.pi * young) * support.kernels(x, y, dx, dy)["r"]
    shape = (3 * ny, 3 * nx)
    spectrum = np.fft.rfft2(kernel, shape)

    def apply(p):
        return np.fft.irfft2(spectrum * np.fft.rfft2(p, shape), shape)[ny - 1 : 2 * ny - 1, nx - 1 : 2 * nx - 1]

    return apply


def motion(data, k):
    """The normal rigid displacement of every cell in step k."""
    x, y = np.meshgrid(data["x"], data["y"])
    at = {name: data[f"history/{name}"][k] for name in ("disp_z", "rot_x", "rot_y")}
    return at["disp_z"] - y * at["rot_x"] + x * at["rot_y"]


def errors(data, h, limit, apply):
    """Errors of all steps: of the conditions of the problem, of the loads, and of the depth; each should be below 1."""
    x, y = np.meshgrid(data["x"], data["y"])
    area = np.diff(data["x"]).mean() * np.diff(data["y"]).mean()
    depth, worst = np.zeros_like(h), 0.0
    for k, p in enumerate(data["pressure"]):
        u = apply(p)
        gap = u + h + depth - motion(data, k)
        full, scale = p >= SATURATED * limit, np.abs(u).max() or 1.0
        wrong = np.where(p <= 0, -gap, np.where(full, gap, np.abs(gap))).max() / scale
        depth = depth + np.where(full, np.maximum(-gap, 0), 0)
        sums = np.array([p.sum(), -(y * p).sum(), (x * p).sum()]) * area
        given = [data[f"history/load_{name}"][k] for name in ("n", "mx", "my")]
        arm = np.array([1, np.abs(y).max(), np.abs(x).max()]) * max(p.sum() * area, 1e-300)
        kept = np.abs(depth - data["plastic_depth"][k]).max() / scale
        bounds = max(-p.min(), p.max() / limit - 1)
        worst = max(worst, wrong / 1.1e-8, np.max(np.abs(sums - given) / arm) / 1e-10, kept / 1e-9, bounds / 1e-14)
    return worst


# ---- one step


def test_against_a_bound_constrained_minimisation(solve):
    """At 64 x 64 cells scipy finds the pressure under the same approach and rotation, and the loads follow."""
    case = ball(64, 2, pressure_limit=H, load_my=1.5e-3)
    mine = solve(case)
    h = mine.separation() - plastic(mine)
    apply = influence(64, 64, mine.dx, mine.dy, case["body1_young"], case["body1_poisson"])
    d = mine.rigid()[2] - h
    unit = d.max() / H  # so that unknowns, gradient and curvature are of order 1

    def energy(x):
        u = apply(H * x.reshape(64, 64))
        return 0.5 * np.sum(u * H * x.reshape(64, 64) - 2 * d * H * x.reshape(64, 64)) / (H * H * unit), (
            (u - d) / (H * unit)
        ).ravel()

    found = minimize(
        energy,
        np.where(d > 0, 0.5, 0).ravel(),
        jac=True,
        method="L-BFGS-B",
        bounds=[(0, 1)] * 64**2,
        options=dict(maxiter=20000, maxfun=40000, maxcor=50, ftol=0, gtol=1e-9),
    )
    p = H * found.x.reshape(64, 64)
    assert 200 < mine["plastic_cells"] < 0.8 * mine["contact_cells"]
    support.assert_close(mine.pressure, p, 2e-6, "pressure")
    assert np.sum(p) * mine.area == pytest.approx(case["load_n"], rel=1e-6)
    assert np.sum(p * mine.xx) * mine.area == pytest.approx(case["load_my"], rel=1e-5)


def plastic(results):
    with h5py.File(results.path) as f:
        return f["plastic_depth"][-1]


def test_plastic_area_comes_back_with_the_load(solve, tmp_path_factory):
    case = dict(ball(96, load_n=None), pressure_limit=0.6 * support.hertz(ball()).pressure)
    load = ball()["load_n"]
    loads = enumerate((load, load / 9, load, 0.5 * load, load))
    table = support.history(tmp_path_factory.mktemp("history") / "h.csv", "time,load_n", *loads)
    with h5py.File(solve(dict(case, **table)).path) as f:
        area, energy = f["history/plastic_area"][:], f["history/hardness_work"][:]
    assert area[0] == area[2] == area[4] > 0 and area[1] == area[3] == 0
    assert abs(energy[1:]).max() < 1e-7 * energy[0]


def test_full_plasticity_is_load_over_hardness(solve):
    """A soft sphere: N = H A, on the circle that its undeformed surface cuts out, as Meyer's hardness has it."""
    case = ball(96, 4, pressure_limit=support.hertz(ball()).pressure / 10)
    soft = solve(case)
    area = case["load_n"] / case["pressure_limit"]
    assert soft["contact_area"] == pytest.approx(area, rel=0.02)
    assert soft["plastic_area"] == pytest.approx(area, rel=0.02)
    assert soft["plastic_area"] <= soft["contact_area"] * (1 + 1e-3)
    # the depth is what the sphere overlaps the plane by, less what the bodies give way
    at = soft.r < 0.9 * np.sqrt(area / np.pi)
    overlap = soft.rigid()[2] - soft.r**2 / 2 / case["gap_radius1"] - soft.displacement_z
    support.assert_close(plastic(soft)[at], overlap[at], 1e-9, "depth")
    assert plastic(soft)[soft.r > 1.1 * np.sqrt(area / np.pi)].max() == 0


def test_flat_punch_bears_its_area_times_the_hardness(petsam, tmp_path):
    """Up to there all of the load lies on the base; at its edge the surfaces yield from the first load on."""
    n, base = 48, np.zeros((48, 48), bool)
    base[10:38, 12:36] = True
    with h5py.File(tmp_path / "h.h5", "w") as f:
        f["height"] = np.where(base, 0, 1e-3)
    case = {**SOFT, "gap_type": "file", "gap_file": "h.h5", "grid_n": n, "gap_radius1": None, "gap_radius2": None}
    limit = H * base.sum() * (case["grid_size"] / n) ** 2
    for part in (0.4, 0.7, 0.999):
        petsam(case, dict(load_n=part * limit, output="o.h5"))
        p = support.read_run(tmp_path / "o.h5")["pressure"][0]
        assert p[~base].max() == 0 and p[base].min() > 0
        full = p[base] >= SATURATED * H
        assert 0 < full.mean() < part or full.mean() > 0.98
    assert p[base].mean() == pytest.approx(0.999 * H)


# ---- loads beyond


def test_load_beyond_the_grid_is_refused_with_the_limit(petsam, tmp_path):
    area = SOFT["grid_size"] ** 2
    run = petsam(SOFT, dict(load_n=1.001 * H * area, output="o.h5"), check=11)
    assert "load_n" in run.stderr and "pressure_limit" in run.stderr and f"limit {H * area:.8g} N" in run.stderr
    with h5py.File(tmp_path / "o.h5") as f:
        assert np.isnan(f["history/plastic_area"][-1]) and np.isnan(f["history/plastic_depth_max"][-1])
    petsam(SOFT, dict(load_n=H * area, allow_edge_contact=True, output="o.h5"))
    data = support.read_run(tmp_path / "o.h5")
    assert data["pressure"].min() >= SATURATED * H and data["gap"].min() > -1e-6 * data["history/disp_z"][0]


@pytest.mark.parametrize("name, sign", [("load_my", 1), ("load_my", -1), ("load_mx", 1), ("load_mx", -1)])
def test_moment_beyond_what_the_hardness_bears_is_refused_with_the_limit(petsam, name, sign):
    """Half the grid's load: its resultant lies at most where half of the grid at one side bears all of it."""
    width = SOFT["grid_size"]
    case = dict(SOFT, load_n=0.5 * H * width**2, allow_edge_contact=True)
    limit = case["load_n"] * width / 4
    petsam(case, {name: 0.99 * sign * limit})
    run = petsam(case, {name: 1.01 * sign * limit}, check=11)
    assert name in run.stderr and f"limits {-limit:.6g} and {limit:.6g} N m" in run.stderr


# ---- unloading and loading again


def test_unloading_is_elastic_and_loading_again_comes_back(petsam, tmp_path):
    load = ball()["load_n"] * np.array([0.6, 1, 0.4, 0.05, 0.7, 1, 1, 1.1])
    petsam(SOFT, rows(tmp_path / "h.csv", load_n=load), dict(output="o.h5"))
    data = support.read_run(tmp_path / "o.h5")
    depth, p, most = data["plastic_depth"], data["pressure"], data["plastic_depth"][1].max()
    assert depth[0].max() > 0 and most > 1.5 * depth[0].max()
    for k in (2, 3, 4):
        assert np.array_equal(depth[k], depth[1])
        assert data["history/plastic_cells"][k] == 0 and data["history/hardness_work"][k] == 0
    support.assert_close(p[5], p[1], 1e-6, "pressure when loaded again")
    assert (depth[5] - depth[1]).max() < 1e-7 * most and (depth[6] - depth[1]).max() < 1e-7 * most
    assert (depth[7] - depth[1]).max() > 0.1 * most
    assert data["history/normal_iterations"][6] == 0 and np.array_equal(depth[6], depth[5])
    # flattened, the sphere bears a small load with less pressure, and a gap is left where it has yielded
    open_again = (p[3] == 0) & (depth[1] > 0)
    assert open_again.any() and data["gap"][3][open_again].min() > 0
    assert 0 < p[3].max() < 0.8 * support.hertz(ball(load_n=load[3])).pressure
    # unloading is the elastic contact of the surfaces as they are now
    x, y = np.meshgrid(data["x"], data["y"])
    with h5py.File(tmp_path / "yielded.h5", "w") as f:
        f["height"] = (x**2 + y**2) / 2 / SOFT["gap_radius1"] + depth[1]
    elastic = dict(
        SOFT, gap_type="file", gap_file="yielded.h5", gap_radius1=None, gap_radius2=None, pressure_limit=None
    )
    petsam(elastic, dict(load_n=load[2], output="e.h5"))
    support.assert_close(p[2], support.read_run(tmp_path / "e.h5")["pressure"][0], 1e-6, "elastic")


def test_energy_of_a_loop_is_what_the_surfaces_yielded(petsam, tmp_path):
    """Work of the load on the approach over a load cycle, in small steps: plastic work, nothing else."""
    n = 40
    part = np.concatenate([np.arange(1, n + 1), np.arange(n - 1, -1, -1)]) / n
    d = 1.3 * support.hertz(ball()).approach
    petsam(SOFT, rows(tmp_path / "h.csv", disp_z=d * part - 1e-9), dict(output="o.h5"))
    data = support.read_run(tmp_path / "o.h5")
    load, disp = np.append(0, data["history/load_n"]), np.append(0, data["history/disp_z"])
    work = np.sum(0.5 * (load[1:] + load[:-1]) * np.diff(disp))
    assert load[-1] == 0
    assert work == pytest.approx(data["history/hardness_work"].sum(), rel=0.02)


# ---- random cases


def surface(random, x, y):
    """A sphere, a plane, a rough plane, a rough sphere or a punch; and the area that can bear."""
    kind = random.choice(["sphere", "flat", "rough", "rough sphere", "punch"])
    h, (ny, nx) = np.zeros_like(x), x.shape
    if "sphere" in kind:
        h += ((x - x.mean()) ** 2 + (y - y.mean()) ** 2) / 2 / random.uniform(0.05, 0.3)
    if "rough" in kind:
        k = np.hypot(np.fft.fftfreq(nx), np.fft.fftfreq(ny)[:, None])
        k[0, 0] = 1
        z = np.fft.ifft2(np.fft.fft2(random.standard_normal((ny, nx))) * k ** -random.uniform(1.3, 2)).real
        h += (z.max() - z) / z.std() * 10 ** random.uniform(-7, -6)
    if kind == "flat":
        h += random.uniform(0, 1e-7) * random.random((ny, nx))
    if kind == "punch":
        h[(x - x.mean()) ** 2 + (y - y.mean()) ** 2 >= (0.3 * min(np.ptp(x), np.ptp(y))) ** 2] = 1e-3
    return h, np.mean(h < 1e-3) * np.ptp(x) * np.ptp(y)


def controls(random, most, center, width, approach):
    """Columns of 2 to 6 steps: forces, moments, rotations and approaches, to and fro."""
    count = random.integers(2, 7)
    part = np.where(random.random(count) < 0.5, 1.0, random.random(count))
    share = random.choice([random.uniform(0.01, 0.3), random.uniform(0.3, 0.8), random.uniform(0.8, 0.99)])
    load, room = share * most * part, (1 - share) * width
    mode = random.choice(["force", "moments", "rotation", "approach"])
    if mode == "approach":
        return dict(disp_z=approach * share * part, rot_y=random.choice([0, 1e-4]) * random.uniform(-1, 1, count))
    columns = dict(load_n=load, load_my=center[0] * load)
    if mode == "rotation":
        return dict(columns, rot_x=random.uniform(-1e-4, 1e-4, count))
    tilt = 0.2 * room * random.uniform(-1, 1, (2, count)) if mode == "moments" else np.zeros((2, count))
    return dict(load_n=load, load_mx=load * (tilt[0] - center[1]), load_my=load * (tilt[1] + center[0]))


@pytest.mark.parametrize("seed", range(24))
def test_random_cases_solve_the_problem(petsam, tmp_path, seed):
    random = np.random.default_rng(seed)
    n, size = random.integers(12, 60, 2), random.uniform(1.5e-3, 3e-3, 2)
    center = random.choice([0.0, 3e-4]) * random.uniform(-1, 1, 2)
    x, y = np.meshgrid(*[c + ((np.arange(m) + 0.5) / m - 0.5) * s for c, m, s in zip(center, n, size)])
    h, area = surface(random, x, y)
    limit = 10 ** random.uniform(8, 9.3)
    approach = h.min() + 3 * limit * np.sqrt(area) / 72e9
    columns = controls(random, limit * area, center, size.min(), approach)
    with h5py.File(tmp_path / "h.h5", "w") as f:
        f["height"] = h
    case = ball(40, load_n=None, grid_n=tuple(n.tolist()), grid_size=tuple(size.tolist()), gap_file="h.h5")
    case.update(gap_type="file", gap_radius1=None, gap_radius2=None, grid_center=tuple(center.tolist()), friction=None)
    case.update(output_fields="pressure,plastic_depth", pressure_limit=limit, allow_edge_contact=True)
    petsam(case, rows(tmp_path / "h.csv", **columns), dict(output="o.h5"), ranks=1 + seed % 8 // 7)
    apply = influence(*n, *(size / n), case["body1_young"], case["body1_poisson"])
    assert errors(support.read_run(tmp_path / "o.h5"), h, limit, apply) < 1


# ---- friction, dissimilar bodies, wear, periodic bodies


def test_shear_is_bounded_by_the_hardness_times_friction(petsam, tmp_path):
    force = ball()["load_n"] * ball()["friction"]
    history = rows(tmp_path / "h.csv", load_n=[180.0] * 4, load_tx=[0, 0.9 * force, -0.9 * force, 0.5 * force])
    petsam(SOFT, history, dict(output="o.h5"))
    data = support.read_run(tmp_path / "o.h5")
    q = np.hypot(data["shear_x"], data["shear_y"])
    assert q.max() == pytest.approx(SOFT["friction"] * H, rel=1e-9)
    assert np.array_equal(data["plastic_depth"][3], data["plastic_depth"][0])
    assert data["history/normal_iterations"][1:].max() == 0  # the pressure is that of the first step


def test_dissimilar_bodies(petsam, tmp_path):
    """With full coupling: all conditions hold for the displacements that the results have."""
    load = np.array([0.7, 1, 1, 0.4, 1.0])
    history = rows(tmp_path / "h.csv", load_n=180 * load, load_tx=[0, 30, -20, 0, 25.0])
    petsam(SOFT, history, dict(body2_young=10e9, body2_poisson=0.2, output="o.h5", pressure_limit=0.5 * H))
    data, before = support.read_run(tmp_path / "o.h5"), 0
    assert data["history/coupling_iterations"].max() > 1
    for k, p in enumerate(data["pressure"]):
        full, depth = p >= SATURATED * 0.5 * H, data["plastic_depth"][k]
        scale = np.abs(data["displacement_z"][k]).max()
        assert p.min() == 0 and p.max() <= 0.5 * H * (1 + 1e-14)
        assert data["gap"][k].min() > -1.1e-8 * scale and np.abs(data["gap"][k][p > 0]).max() < 1.1e-8 * scale
        assert np.min(depth - before) >= 0 and np.max((depth - before)[~full]) == 0
        before = depth
    assert np.max(data["plastic_depth"][2] - data["plastic_depth"][1]) > 0  # the lift by the shear has changed


def test_wear_and_plastic_depth_add_up(petsam, tmp_path):
    mu, d = SOFT["friction"], 1.2 * support.hertz(ball()).approach
    history = rows(tmp_path / "h.csv", disp_z=[d] * 5, disp_x=0.6 * mu * d * np.array([0, 1, -1, 1, -1.0]))
    petsam(SOFT, history, dict(wear_coefficient1=1e-10, wear_coefficient2=2e-10, output="o.h5"))
    data = support.read_run(tmp_path / "o.h5")
    x, y = np.meshgrid(data["x"], data["y"])
    worn = np.append(np.zeros((1, 40, 40)), data["wear_depth1"] + data["wear_depth2"], axis=0)
    for k, p in enumerate(data["pressure"]):  # a step is solved with the wear before it
        h = (x**2 + y**2) / 2 / SOFT["gap_radius1"] + worn[k] + data["plastic_depth"][k]
        gap = data["displacement_z"][k] + h - motion(data, k)
        assert np.abs(gap[p > 0]).max() < 1.1e-8 * np.abs(data["displacement_z"][k]).max()
    assert worn[-1].max() > 0.01 * data["plastic_depth"][-1].max() > 0


def test_periodic_bodies(petsam, tmp_path):
    """Whatever the approach, a limited pressure holds it: in the end the mean is H."""
    n, width = 36, 1e-3
    x, y = np.meshgrid(*[2 * np.pi * (np.arange(n) + 0.5) / n] * 2)
    with h5py.File(tmp_path / "h.h5", "w") as f:
        f["height"] = 1e-6 * (1 - np.cos(x) * np.cos(y))
    case = dict(SOFT, grid_n=n, grid_size=width, elasticity="periodic", gap_type="file", gap_file="h.h5", friction=None)
    case.update(gap_radius1=None, gap_radius2=None, pressure_limit=5e7, disp_z=None)
    petsam(case, rows(tmp_path / "h.csv", disp_z=[2e-7, 9e-7, 5e-6, 4.9e-6, 5.1e-6]), dict(output="o.h5"))
    data = support.read_run(tmp_path / "o.h5")
    load = data["history/load_n"] / width**2
    assert 0 < load[0] < load[1] < load[2] and load[2] == pytest.approx(5e7)
    assert load[4] == pytest.approx(5e7, rel=1e-6) and load[3] < load[2]


# ---- stiffness


@pytest.mark.parametrize("ends", [1.001, 0.999])
def test_stiffness_is_the_derivative_of_the_next_step(petsam, tmp_path, ends):
    """Forward while the surfaces yield, reversed when they are unloaded."""
    h = support.hertz(ball())
    d, dr = 1.3 * h.approach, 1e-6
    columns = dict(disp_z=d * np.array([0.9, 0.95, 1, ends]), rot_x=[0.0] * 4, rot_y=[0.0] * 4)
    petsam(SOFT, rows(tmp_path / "h.csv", **columns), dict(stiffness=True, output="o.h5", normal_rtol=1e-10))
    with h5py.File(tmp_path / "o.h5") as f:
        load, k = f["history/load_n"][:], f["history/stiffness"][2, 0, 0]
        back, cells = f["history/stiffness_reversal"][2, 0, 0], f["history/plastic_cells"][:]
    slope = (load[3] - load[2]) / (d * (ends - 1))
    assert cells[2] > 50 and k < 0.9 * back and dr
    assert slope == pytest.approx(k if ends > 1 else back, rel=5e-3)


# ---- ranks, restarts


def test_same_bits_on_any_number_of_ranks_and_after_a_restart(petsam, tmp_path):
    load = 180 * np.array([0.6, 1, 0.5, 1, 1.2])
    shear = 180 * 0.27 * np.array([0.1, 0.3, 0.2, -0.4, 0.0])

    def history(count):
        return rows(tmp_path / "h.csv", load_n=load[:count], load_tx=shear[:count], load_my=1e-3 * load[:count] / 180)

    for ranks in (1, 3):
        petsam(SOFT, history(5), dict(output=f"o{ranks}.h5", grid_n=(41, 43)), ranks=ranks)
    one = support.read_run(tmp_path / "o1.h5")
    for count, ranks in ((2, 1), (3, 2)):
        go = dict(grid_n=(41, 43), output="r.h5", checkpoint="c.h5", checkpoint_every=1)
        petsam(SOFT, history(count), dict(go, overwrite=True), ranks=ranks)
        petsam(SOFT, history(5), dict(go, restart="c.h5"), ranks=3 - ranks)
        for name, value in support.read_run(tmp_path / "r.h5").items():
            assert np.array_equal(value, one[name], equal_nan=True), name
    for name, value in support.read_run(tmp_path / "o3.h5").items():
        assert np.array_equal(value, one[name], equal_nan=True), name
    run = petsam(SOFT, history(5), dict(go, restart="c.h5", pressure_limit=2 * H), check=2)
    assert "pressure_limit" in run.stderr


# ---- what is saved and what is refused


def test_depth_is_saved_with_a_limit_only(petsam, tmp_path):
    default = dict(SOFT, output_fields=None, load_n=100.0, output="o.h5")
    line = next(line for line in petsam(default).stdout.splitlines() if line.startswith("  plastic "))
    petsam({**default, "pressure_limit": None, "output": "e.h5"})
    petsam({**default, "pressure_limit": "inf", "output": "i.h5"})
    with h5py.File(tmp_path / "o.h5") as f, h5py.File(tmp_path / "e.h5") as e, h5py.File(tmp_path / "i.h5") as i:
        assert f["plastic_depth"].attrs["units"] in ("m", b"m") and f.attrs["pressure_limit"] == H
        assert {name for name in f["history"] if "plastic" in name or "hardness" in name} == {
            "plastic_cells",
            "plastic_area",
            "plastic_depth_max",
            "hardness_work",
        }
        assert f["history/plastic_depth_max"][0] == f["plastic_depth"][0].max()
        assert f"depth up to {f['history/plastic_depth_max'][0]:.6g} m" in line
        for plain in (e, i):
            assert "plastic_depth" not in plain and not [name for name in plain["history"] if "plastic" in name]

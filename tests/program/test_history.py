"""Load histories through the whole program: files, steps, and mechanics that depend on the path."""

import re

import h5py
import numpy as np
import pytest

from support import FIELDS, LOADS, RIGID, SPHERE, assert_close, ball, displacement, flatten, hertz, slide_limit, words

FRICTION = 0.27
MU_N = FRICTION * 180.0


# ---------------------------------------------------------------- helpers


def csv(path, columns, rows):
    """A history: rows of numbers without their time, which counts from 1."""
    lines = ["time," + ",".join(columns)] + [
        ",".join(repr(float(v)) for v in (k + 1, *np.atleast_1d(row))) for k, row in enumerate(rows)
    ]
    path.write_text("\n".join(lines) + "\n")
    return path


class Path:
    """All steps of a results file: fields as (steps, ny, nx), scalars by item as (steps,)."""

    def __init__(self, path):
        with h5py.File(path, "r") as f:
            self.x, self.y, self.time = f["x"][:], f["y"][:], f["time"][:]
            self.history = {name: data[:] for name, data in f["history"].items()}
            for name in (*FIELDS, "slip_aside_x", "slip_aside_y"):
                setattr(self, name, f[name][:])
        self.xx, self.yy = np.meshgrid(self.x, self.y)
        self.area = np.diff(self.x).mean() * np.diff(self.y).mean()

    def __getitem__(self, name):
        return self.history[name]

    def rigid(self):
        """Tangential rigid displacement (x, y) of every cell, of every step."""
        dx, dy, rz = (self[name][:, None, None] for name in ("disp_x", "disp_y", "rot_z"))
        return dx - self.yy * rz, dy + self.xx * rz


@pytest.fixture(scope="session")
def drive(launcher, tmp_path_factory):
    """drive(case, columns, rows, ranks=1, check=0): all steps of that history, solved once a session."""
    from conftest import execute

    known = {}

    def run(case, columns=None, rows=None, ranks=1, check=0):
        rows = None if rows is None else np.asarray(rows, dtype=float)
        key = (*flatten([case]), columns, None if rows is None else rows.tobytes(), ranks, check)
        if key not in known:
            directory = tmp_path_factory.mktemp("history")
            options = [case, "-output", "results.h5"]
            if columns:
                options += ["-history", csv(directory / "history.csv", columns, rows).name]
            done = execute(launcher, directory, options, ranks, check)
            known[key] = Path(directory / "results.h5")
            known[key].run = done
        return known[key]

    return run


def roughness(path, n, height, waves=6, seed=5):
    """A sum of cosines of random phases and that height (m), the same function of place on every grid."""
    rng = np.random.default_rng(seed)
    x = (np.arange(n) + 0.5) / n * 2 * np.pi
    z = np.zeros((n, n))
    for kx in range(0, waves + 1):
        for ky in range(-waves, waves + 1):
            phase, size = rng.uniform(0, 2 * np.pi), rng.normal()
            if 4 <= kx * kx + ky * ky <= waves * waves:
                z += size / (kx * kx + ky * ky) ** 0.9 * np.cos(kx * x[None, :] + ky * x[:, None] + phase)
    with h5py.File(path, "w") as f:
        f["height"] = height * z
    return path


@pytest.fixture(scope="session")
def rough(tmp_path_factory):
    """rough(n, **more): a rough aluminium ball, about half of Hertz's contact area touching."""
    directory = tmp_path_factory.mktemp("rough")

    def case(n, **more):
        path = directory / f"rough{n}.h5"
        base = ball(n)
        if not path.exists():
            roughness(path, n, 6e-7)
        return dict(base, gap_rough_file=path, **more)

    return case


def pushed(loads, n=180.0):
    """Rows (N, T): first N alone, then these T."""
    return [(n, 0.0)] + [(n, t) for t in loads]


def cycle(top, steps):
    """0 to top, then to -top, and back to top, in that many steps a stroke."""
    return np.concatenate(
        [
            top * np.arange(1, steps + 1) / steps,
            np.linspace(top, -top, steps + 1)[1:],
            np.linspace(-top, top, steps + 1)[1:],
        ]
    )


def mindlin(case):
    """Displacement of all sliding, for nu = 0 (m): d = this (1 - (1 - T/mu N)^(2/3))."""
    h = hertz(case)
    return case["friction"] * h.approach  # mu a^2/R, the compliances along x and z being equal


def six(rows, n=180.0, radius=None):
    """Out-of-phase loads of all components (N, Mx, My, Tx, Ty, Mz), each of another frequency, well below sliding."""
    radius = radius or hertz(ball()).radius
    t = np.arange(1, rows + 1) / rows
    w = 2 * np.pi * t
    start = np.minimum(1, 8 * t)
    load_n = n * (1 - 0.35 * np.sin(2 * w) ** 2) * start
    return np.column_stack(
        [
            load_n,
            0.12 * load_n * radius * np.sin(3 * w),
            0.10 * load_n * radius * np.cos(2 * w + 0.4),
            0.35 * FRICTION * load_n * np.sin(4 * w),
            0.30 * FRICTION * load_n * np.cos(3 * w + 1.0),
            0.12 * FRICTION * load_n * radius * np.sin(5 * w + 0.7),
        ]
    )


# ---------------------------------------------------------------- malformed files


@pytest.mark.parametrize("how", ["command line", "capitals", "options file", "environment"])
def test_history_file_is_never_written_to(petsam, tmp_path, how):
    """PETSc's own -history would append a log to it."""
    path = csv(tmp_path / "loads.csv", ("load_tx",), [20.0, 40.0])
    before, line, environment = (path.read_bytes(), path.stat().st_mtime_ns), words(dict(SPHERE, grid_n=16)), None
    if how == "environment":
        environment = dict(PETSC_OPTIONS="-history loads.csv")
    elif how == "options file":
        (tmp_path / "study.opts").write_text("-history loads.csv\n")
        line += ["-options_file", "study.opts"]
    else:
        line += ["-History" if how == "capitals" else "-history", "loads.csv"]
    petsam(*line, "-output", "out.h5", environment=environment)
    assert (path.read_bytes(), path.stat().st_mtime_ns) == before
    with h5py.File(tmp_path / "out.h5") as f:
        assert f["history/load_tx"][:] == pytest.approx([20.0, 40.0], rel=1e-9)


def test_history_may_lie_where_nobody_may_write(petsam, tmp_path):
    path = csv(tmp_path / "loads.csv", ("load_tx",), [20.0])
    path.chmod(0o444)
    petsam(dict(SPHERE, grid_n=16), "-history", path)


# ---------------------------------------------------------------- steps and their results


def test_rows_are_steps_in_the_results(drive):
    s = drive(ball(32), ("load_tx", "load_ty"), [(5, 0), (10, -3), (0, 0)])
    assert s["time"].tolist() == s.time.tolist() == [1, 2, 3]
    assert len(s.pressure) == 3 and s["status"].tolist() == [0, 0, 0]
    assert s["load_tx"] == pytest.approx([5, 10, 0], abs=1e-9 * 10)
    assert s["load_ty"] == pytest.approx([0, -3, 0], abs=1e-9 * 10)


def test_steps_are_interpolated_in_the_history(drive):
    rows = [(90, 1e-7), (180, 5e-7), (120, -1e-7)]
    s = drive(dict(ball(32), load_n=None, steps=4), ("load_n", "disp_x"), rows)
    knots = np.vstack([[0, 0, 0], np.column_stack([[1, 2, 3], rows])])
    t = np.arange(1, 13) / 4
    assert s["time"] == pytest.approx(t, rel=1e-14)
    assert s.time == pytest.approx(t, rel=1e-14)
    assert all(len(values) == 12 for values in s.history.values()) and len(s.pressure) == 12
    assert s["disp_x"] == pytest.approx(np.interp(t, knots[:, 0], knots[:, 2]), rel=1e-13)  # as given
    assert s["load_n"] == pytest.approx(np.interp(t, knots[:, 0], knots[:, 1]), rel=1e-9)  # equilibrium of the solution


@pytest.mark.parametrize(
    "every, saved", [(1, range(1, 11)), (3, [3, 6, 9, 10]), (5, [5, 10]), (10, [10]), (99, [10])], ids=str
)
def test_output_every_saves_fields_of_those_steps_and_the_last(drive, every, saved):
    case, columns, rows = ball(32), ("load_tx",), 40 * np.sin(np.arange(10))
    every_step, s = drive(case, columns, rows), drive(dict(case, output_every=every), columns, rows)
    assert s.time.tolist() == list(saved)
    assert s["time"].tolist() == list(range(1, 11))
    for name in FIELDS:
        assert np.array_equal(getattr(s, name), getattr(every_step, name)[np.array(saved) - 1]), name
    assert s["load_tx"].tolist() == every_step["load_tx"].tolist()


def test_one_step_is_the_single_load(drive):
    case = ball(48, load_tx=30.0, load_mz=1e-3)
    one, single = drive(dict(case, steps=1)), drive(case)
    for name in FIELDS:
        assert np.array_equal(getattr(one, name), getattr(single, name)), name


def test_history_of_one_row_is_the_single_load(drive):
    row, single = drive(ball(48), ("load_tx", "load_mz"), [(30.0, 1e-3)]), drive(ball(48, load_tx=30.0, load_mz=1e-3))
    for name in FIELDS:
        assert np.array_equal(getattr(row, name), getattr(single, name)), name


def test_same_row_again_changes_nothing(drive):
    s = drive(ball(64), ("load_tx", "load_ty", "load_mz", "load_my"), [(30.0, -8.0, 1e-3, 0.01)] * 2)
    assert s["normal_applies"][1] == s["normal_iterations"][1] == 0
    assert np.array_equal(s.pressure[0], s.pressure[1])
    # 1e-5: ten times the tangential tolerance
    for names in (("shear_x", "shear_y"), ("slip_x", "slip_y")):
        scale = max(np.max(np.abs(getattr(s, name)[0])) for name in names)
        for name in names:
            assert_close(getattr(s, name)[1], getattr(s, name)[0], 1e-5, name, scale)
    for name in LOADS[3:] + RIGID[3:]:
        assert s[name][1] == pytest.approx(s[name][0], rel=1e-5), name
    assert abs(s["dissipated_energy"][1]) <= 1e-5 * s["dissipated_energy"][0]


def test_normal_problem_is_not_solved_again_while_its_loads_stay(drive):
    s = drive(dict(ball(48), load_n=None), ("load_n", "load_tx"), pushed([10, 20, 15]))
    assert s["normal_applies"][0] > 0 and s["normal_applies"][1:].tolist() == [0, 0, 0]


def test_summary_has_a_line_a_step(drive):
    s = drive(ball(32), ("load_tx", "load_ty"), [(5, 0), (10, -3), (0, 0)])
    numbers = [line.split()[0] for line in s.run.stdout.splitlines() if line.split() and line.split()[0].isdigit()]
    assert numbers == ["1", "2", "3"]


def test_edge_contact_in_one_step_is_the_exit_code_and_ends_the_run(drive):
    case = dict(ball(40, half_width=1.1), load_n=None)
    s = drive(case, ("load_n",), [60.0, 400.0, 60.0], check=12)
    assert s["status"].tolist() == [0, 12]
    assert len(s.run.complaint) == 1 and "step 2" in s.run.complaint[0]
    s = drive(dict(case, allow_edge_contact=True), ("load_n",), [60.0, 400.0, 400.0, 60.0])
    assert s["status"].tolist() == [0, 0, 0, 0]
    assert len(s.run.complaint) == 1 and "step 2" in s.run.complaint[0]


# ---------------------------------------------------------------- paths with known answers, nu = 0


def smooth(n=64, **more):
    return dict(ball(n, poisson=0.0), load_n=None, **more)


@pytest.mark.parametrize("n, steps", [(64, 1), (64, 4), (128, 1)])
def test_shear_on_a_rough_gap_is_mu_times_the_difference_of_two_pressures(drive, rough, n, steps):
    """Ciavarella and Jaeger: q = mu (p(N) - p(N - T/mu)), at nu = 0 exact for the discrete problem too, untilted."""
    case = rough(n, body1_poisson=0.0, body2_poisson=0.0, rot_x=0.0, rot_y=0.0, rot_z=0.0, load_n=None)
    for t in (0.3, 0.8):
        s = drive(dict(case, steps=steps), ("load_n", "load_tx"), pushed([t * MU_N]))
        p, rest = s.pressure[-1], drive(dict(case, load_n=180.0 * (1 - t))).pressure[-1]
        assert 0.15 < np.mean(p > 0) < 0.45 and np.sum(rest > 0) < 0.95 * np.sum(p > 0)
        # 1e-5: ten times the tangential tolerance
        assert_close(s.shear_x[-1], FRICTION * (p - rest), 1e-5, "q_x", FRICTION * p.max())
        assert_close(s.shear_y[-1], 0, 1e-5, "q_y", FRICTION * p.max())


def test_shear_of_a_rough_gap_on_a_coarse_grid_comes_near_that_on_a_fine_one(drive, rough):
    """Against the pressures of the finest grid the error is that of the discretisation, and falls."""

    def shear(n):
        case = rough(n, body1_poisson=0.0, body2_poisson=0.0, rot_x=0.0, rot_y=0.0, rot_z=0.0, load_n=None)
        return drive(dict(case, steps=1), ("load_n", "load_tx"), pushed([0.6 * MU_N])).shear_x[-1]

    fine = rough(256, body1_poisson=0.0, body2_poisson=0.0, rot_x=0.0, rot_y=0.0)
    exact = FRICTION * (drive(fine).pressure[-1] - drive(dict(fine, load_n=180.0 * 0.4)).pressure[-1])
    errors = []
    for n in (32, 64, 128):
        k = 256 // n
        mean = exact.reshape(n, k, n, k).mean((1, 3))
        errors.append(np.linalg.norm(shear(n) - mean) / np.linalg.norm(mean))
    assert errors[1] < 0.7 * errors[0] and errors[2] < 0.7 * errors[1], errors  # order 1: the edge lies between cells
    assert errors[2] < 0.03, errors


TOP, STROKE = 0.8, 40


def loop(drive, n=96):
    return drive(smooth(n), ("load_n", "load_tx"), pushed(cycle(TOP * MU_N, STROKE)))


def test_unloading_follows_masing(drive):
    """Twice the curve of first loading, of Mindlin and Deresiewicz, turned round."""
    s = loop(drive)
    back = slice(STROKE, 2 * STROKE + 1)
    d, t = s["disp_x"][back], s["load_tx"][back] / MU_N
    first = mindlin(ball(poisson=0.0)) * (1 - (1 - TOP) ** (2 / 3))
    expected = first - 2 * mindlin(ball(poisson=0.0)) * (1 - (1 - (TOP - t) / 2) ** (2 / 3))
    assert_close(d, expected, 1e-2)


def test_unloading_follows_masing_on_the_grid_too(drive):
    """The discrete problem of nu = 0 obeys the rule itself: every second step back is one of first loading."""
    s = loop(drive)
    d = np.concatenate([[0], s["disp_x"][1:]])
    rise, fall = d[: STROKE + 1], d[STROKE : 2 * STROKE + 1]
    assert_close(fall[0] - fall, 2 * rise, 2e-5)  # tolerance of either solution, ten times


def test_reloading_closes_the_loop(drive):
    s = loop(drive)
    for name in ("shear_x", "slip_x"):
        field = getattr(s, name)
        assert_close(field[-1], field[STROKE], 1e-4, name)  # 1e-6 a step, 80 steps


def test_dissipation_of_a_cycle_is_that_of_mindlin_and_deresiewicz(drive):
    """Johnson eq. 7.59: 24/5 mu N d0 (1 - (1-t)^(5/3) - 5t/6 (1 + (1-t)^(2/3)))."""
    closed = (
        24
        / 5
        * MU_N
        * mindlin(ball(poisson=0.0))
        * (1 - (1 - TOP) ** (5 / 3) - 5 * TOP / 6 * (1 + (1 - TOP) ** (2 / 3)))
    )
    assert loop(drive)["dissipated_energy"][STROKE + 1 :].sum() == pytest.approx(closed, rel=2e-2)


def test_dissipation_of_a_stroke_does_not_depend_on_its_steps(drive):
    """Where slip only spreads, q is mu p at the end of the step as during it, so one step knows all."""
    one = drive(smooth(96), ("load_n", "load_tx"), pushed(cycle(TOP * MU_N, 1)))
    many = loop(drive)["dissipated_energy"][1:].reshape(3, STROKE).sum(1)
    # 3e-3: a cell that changes from stick to slip within a step does so at its end
    assert one["dissipated_energy"][1:] == pytest.approx(many, rel=3e-3)


def test_dissipation_of_a_cycle_is_the_area_of_its_loop(drive):
    """Work of T over d_x by the trapezoidal rule; T_k (d_k - d_(k-1)) alone would be behind by the order of a step."""
    s = loop(drive)
    t, d = s["load_tx"][STROKE:], s["disp_x"][STROKE:]
    work = np.sum((t[1:] + t[:-1]) / 2 * np.diff(d))
    assert s["dissipated_energy"][STROKE + 1 :].sum() == pytest.approx(work, rel=1e-3)


def test_work_of_the_end_loads_is_dissipated_or_stored(drive, rough):
    """sum T_k (d_k - d_(k-1)) = sum D_k + sum q_k (u_k - u_(k-1)) dA for any path of tangential loads, nu = 0.34.

    The pressure stays: where it changes, the work of friction is that of the mean bound of a step. So does the
    direction of slip, which at mid step makes it that of the mean shear.
    """
    rows = six(12)
    rows[:, :3] = rows[0, :3]
    rows = np.vstack([rows, rows[:1]])  # closed
    s = drive(rough(64, load_n=None, slip_direction="end"), LOADS, rows)
    work = sum(s[load][1:] * np.diff(s[rigid]) for load, rigid in zip(LOADS[3:], RIGID[3:]))
    stored = (
        sum(
            np.sum(getattr(s, "shear_" + a)[1:] * np.diff(getattr(s, "displacement_" + a), axis=0), (1, 2))
            for a in "xy"
        )
        * s.area
    )
    # work and stored energy nearly cancel; 1e-6 of their size is rounding, not the solvers'
    assert_close(work - stored, s["dissipated_energy"][1:], 1e-6, scale=np.abs(work).max())
    assert (work - stored).sum() == pytest.approx(s["dissipated_energy"][1:].sum(), rel=1e-3)


# ---------------------------------------------------------------- all components


def long_path(drive, rough, ranks=1):
    return drive(rough(64, load_n=None, step_divide="no"), LOADS, six(60), ranks=ranks)


@pytest.mark.parametrize("ranks", [1, 3])
def test_every_step_of_a_long_path_passes_the_check(drive, rough, ranks):
    s = long_path(drive, rough, ranks)
    assert len(s["status"]) == 60 and not s["status"].any()
    assert s["normal_residual"].max() <= 1e-6 and s["tangential_residual"].max() <= 1e-5
    assert (s["stick_area"] > 0).all() and (s["stick_area"] < s["contact_area"]).any()


def test_every_step_of_a_long_path_carries_its_loads(drive, rough):
    s, rows = long_path(drive, rough), six(60)
    radius = hertz(ball()).radius
    for k, name in enumerate(LOADS):
        assert_close(s[name], rows[:, k], 1e-9, name, 180.0 * (radius if name[5] == "m" else 1))


def test_fields_of_a_long_path_do_not_depend_on_the_ranks(drive, rough):
    one, three = long_path(drive, rough), long_path(drive, rough, 3)
    for names in (
        ("pressure",),
        ("shear_x", "shear_y"),
        ("slip_x", "slip_y"),
        ("gap", "displacement_z"),
        ("displacement_x", "displacement_y"),
    ):
        scale = max(np.max(np.abs(getattr(one, name))) for name in names)
        for name in names:
            # tolerances 1e-8 and 1e-6 a step; the slip of 60 steps adds up
            assert_close(
                getattr(three, name),
                getattr(one, name),
                1e-6 if name in ("pressure", "gap", "displacement_z") else 1e-4,
                name,
                scale,
            )


def test_dissipation_of_a_step_is_never_negative(drive, rough):
    for s in (long_path(drive, rough), loop(drive), drive(rough(64, load_n=None, step_divide="no"), LOADS, six(12))):
        assert (
            s["dissipated_energy"].min() >= -1e-5 * s["dissipated_energy"].max()
        )  # ten times the tangential tolerance


def test_driven_by_its_displacements_the_path_gives_back_its_loads(drive, rough):
    rows = six(12)
    case = rough(
        64, load_n=None, slip_direction="end", step_divide="no"
    )  # at mid step a guess of it depends on what is prescribed
    forced = drive(case, LOADS, rows)
    driven = drive(case, RIGID, np.column_stack([forced[name] for name in RIGID]))
    radius = hertz(ball()).radius
    for k, name in enumerate(LOADS):
        scale = (180.0 if name in LOADS[:3] else MU_N) * (radius if name[5] == "m" else 1)
        assert_close(driven[name], rows[:, k], 1e-5, name, scale)


def test_mixed_control_gives_back_the_path(drive, rough):
    """Some components by their displacements, the others by their loads."""
    rows = six(12)
    case = rough(64, load_n=None, slip_direction="end", step_divide="no")
    forced = drive(case, LOADS, rows)
    columns = ("load_n", "rot_x", "load_my", "disp_x", "load_ty", "rot_z")
    driven = drive(case, columns, np.column_stack([forced[name] for name in columns]))
    for names, scale in (
        (("shear_x", "shear_y"), FRICTION * forced.pressure.max()),
        (("pressure",), forced.pressure.max()),
    ):
        for name in names:
            assert_close(
                getattr(driven, name), getattr(forced, name), 1e-4, name, scale
            )  # 1e-6 a step, times the condition


# ---------------------------------------------------------------- stick and slip, recomputed


def assert_coulomb(s, case, exact=1e-12):
    """Stick, slip, and the slip reference of every cell, open ones included, from fields alone."""
    friction = case["friction"]
    rx, ry = s.rigid()
    sx, sy = s.displacement_x - rx, s.displacement_y - ry
    size = max(np.abs(s.displacement_x).max(), np.abs(s.displacement_y).max())
    assert_close(s.slip_x, sx, exact, "slip_x", size + np.abs(rx).max())
    assert_close(s.slip_y, sy, exact, "slip_y", size + np.abs(ry).max())
    dx, dy = (np.diff(v, axis=0, prepend=0 * v[:1]) for v in (sx, sy))
    dx, dy = dx - s.slip_aside_x, dy - s.slip_aside_y
    p, qx, qy = s.pressure, s.shear_x, s.shear_y
    q = np.hypot(qx, qy)
    assert np.all(q <= friction * p * (1 + 1e-12)) and np.all(p >= 0)
    stick, slip = s.state == 1, s.state == 2
    assert np.array_equal(s.state > 0, p > 0)
    assert np.array_equal(slip, (p > 0) & (q >= (1 - 1e-5) * friction * p))
    ds = np.hypot(dx, dy)
    assert ds[stick].max(initial=0) <= 1e-6 * size, ds[stick].max() / size
    # along q: only against it
    along = (dx * qx + dy * qy)[slip] / q[slip]
    assert along.max(initial=0) <= 1e-6 * size, along.max() / size
    # across it nothing, by power: 1e-6 of q in the 2-norm may all be in one of some 1000 cells, whose q is 0.1 of the
    # largest
    across, power = np.where(slip, np.abs(dx * qy - dy * qx), 0).max((1, 2)), np.where(slip, q * ds, 0).max((1, 2))
    assert np.all(across <= 1e-4 * power), (across / power).max()


def test_points_stick_where_they_were_or_slip_against_the_shear(drive, rough):
    case = rough(64, load_n=None, step_divide="no")
    s = long_path(drive, rough)
    assert_coulomb(s, case)
    came = (s.state[1:] > 0) & (s.state[:-1] == 0)
    stuck = (s.state[1:] == 1) & (s.state[:-1] == 0)
    assert came.sum() > 100 and stuck.sum() > 20  # cells that come into contact, some of which stick at once


def test_slip_is_that_of_the_tractions(drive, rough):
    """The displacements on which the slip rests, by direct summation in some cells."""
    case = rough(64)
    s = long_path(drive, rough)

    class Step:
        x, y, xx, yy = s.x, s.y, s.xx, s.yy
        dx, dy = np.diff(s.x).mean(), np.diff(s.y).mean()

    for k in (5, 29, 59):
        Step.pressure, Step.shear_x, Step.shear_y = s.pressure[k], s.shear_x[k], s.shear_y[k]
        for i, j in ((31, 31), (20, 40), (3, 60)):
            ux, uy, uz = displacement(Step, case, i, j)
            assert ux == pytest.approx(s.displacement_x[k, j, i], rel=1e-9)
            assert uy == pytest.approx(s.displacement_y[k, j, i], rel=1e-9)
            assert uz == pytest.approx(s.displacement_z[k, j, i], rel=1e-9)


def test_growing_contact_keeps_the_slip_with_which_its_points_came(drive):
    """Under constant T_x and growing N the new ring comes into contact with slip, and carries no shear there."""
    case = dict(ball(72), load_n=None)
    s = drive(case, ("load_n", "load_tx"), [(60, 0), (60, 10), (120, 10), (180, 10)])
    assert_coulomb(s, case)
    ring = (s.state[1] == 0) & (s.state[3] == 1)
    assert ring.sum() > 100
    assert np.abs(s.slip_x[3][ring]).min() > 1e-3 * abs(s["disp_x"][1])  # a step from no slip at all would have none


# ---------------------------------------------------------------- sliding

SLIDES = [
    0.0,
    2e-7,
    4e-6,
    8e-6,
    7.9e-6,
    0.0,
    -2e-6,
]  # stick, partial slip, sliding twice, back to stick, sliding back twice


def test_sliding_under_displacement_control_is_a_solution(drive):
    s = drive(ball(64), ("disp_x",), SLIDES)
    assert not s["status"].any()
    for k in (2, 3, 5, 6):
        assert s["stick_area"][k] == 0
        assert_close(np.hypot(s.shear_x[k], s.shear_y[k]), FRICTION * s.pressure[k], 1e-12)  # on the cone to rounding
    assert s["load_tx"][[2, 3, 5, 6]] == pytest.approx(
        MU_N * np.array([1, 1, -1, -1]), rel=1e-3
    )  # nearly parallel to x
    assert_coulomb(s, ball(64))


def test_sliding_goes_back_to_stick_on_reversal(drive):
    s = drive(ball(64), ("disp_x",), SLIDES)
    assert s["stick_area"][4] > 0.5 * s["contact_area"][4]
    assert 0 < s["load_tx"][4] < MU_N


def test_dissipation_of_sliding_is_mu_n_times_the_way(drive):
    s = drive(dict(ball(64), load_ty=0.0, rot_z=0.0), ("disp_x",), [4e-6, 1e-5])
    assert s["dissipated_energy"][1] == pytest.approx(MU_N * 6e-6, rel=1e-4)  # q is as before, but for its direction


@pytest.mark.parametrize("ranks", [1, 3])
def test_gross_slip_in_a_later_step_ends_the_run_and_keeps_the_earlier_ones(drive, ranks):
    s = drive(ball(48), ("load_tx",), [20.0, 40.0, 60.0, 10.0], ranks=ranks, check=11)
    assert s["status"].tolist() == [0, 0, 11]
    assert (
        len(s.run.complaint) == 1
        and "step 3" in s.run.complaint[0]
        and "load_tx" in s.run.complaint[0]
        and "limit" in s.run.complaint[0]
    )
    assert s.time.tolist() == [1, 2]
    loads = s.shear_x.sum((1, 2)) * s.area
    assert loads == pytest.approx([20.0, 40.0], rel=1e-9)


def test_gross_slip_by_unloading_names_the_limit_of_that_step(drive):
    s = drive(dict(ball(48), load_n=None), ("load_n", "load_tx"), [(180, 0), (180, 30), (150, 30), (100, 30)], check=11)
    assert s["status"].tolist() == [0, 0, 0, 11]
    assert float(s.run.complaint[0].split("(limit ")[1].split(")")[0]) == pytest.approx(27.0, rel=1e-6)


def test_step_without_convergence_ends_the_run_and_is_marked(drive):
    # the first step converges at once: no tangential load, nothing to iterate
    s = drive(ball(48, tangential_max_it=1), ("load_tx",), [0.0, 30.0, 40.0], check=10)
    assert s["status"].tolist() == [0, 10]
    assert s.time.tolist() == [1, 2]
    assert len(s.run.complaint) == 1 and "step 2" in s.run.complaint[0] and "tangential" in s.run.complaint[0]


# ---------------------------------------------------------------- loss of contact


@pytest.mark.parametrize(
    "column, values", [("load_n", [180.0, 0.0, 180.0]), ("disp_z", [3e-6, -1e-6, 3e-6])], ids=["load_n", "disp_z"]
)
def test_contact_is_lost_and_found(drive, column, values):
    case = dict(ball(48), load_n=None)
    rows = (column, "load_tx"), np.column_stack([values, [10.0, 0.0, 10.0]])
    assert not drive(case, *rows)["status"].any()  # steps that are divided do not slide on the way either
    s = drive(dict(case, step_divide="no"), *rows)
    assert not s["status"].any()
    assert s["contact_area"][1] == s["load_n"][1] == s["load_tx"][1] == s["dissipated_energy"][1] == 0
    assert s.pressure[1].max() == 0 and np.all(s.state[1] == 0) and s.gap[1].min() >= 0
    assert np.hypot(s.shear_x[1], s.shear_y[1]).max() == 0
    assert np.isfinite(s["disp_x"]).all() and np.isfinite(s.slip_x).all()
    assert_close(s.pressure[2], s.pressure[0], 1e-6)  # no memory in the normal problem; 1e-8 on u
    assert s["load_tx"][2] == pytest.approx(10.0, rel=1e-9)


def test_no_normal_force_between_rough_bodies_is_no_contact(drive, rough):
    """Heights below zero: the bodies are as far apart as it takes."""
    s = drive(rough(48, load_n=None), ("load_n",), [0.0, 180.0, 0.0])
    assert not s["status"].any()
    assert s["contact_area"][[0, 2]].tolist() == [0, 0] and s["contact_area"][1] > 0
    assert s.gap[[0, 2]].min() >= -1e-15 * s.gap.max()  # rounding


def test_no_normal_force_on_a_tilted_body_is_no_contact(drive):
    s = drive(dict(ball(48), load_n=None, rot_x=5e-3, rot_y=-3e-3), ("load_n",), [1.0, 0.0])
    assert not s["status"].any()
    assert s["contact_area"][1] == 0 and s.gap[1].min() >= -1e-15 * s.gap.max()


@pytest.mark.parametrize("n", [48, 49])
def test_contact_grows_from_a_few_cells(drive, n):
    """However small the first force: -steps may make it so."""
    loads = [1e-9, 1e-6, 1e-3, 1.0, 180.0]
    s = drive(dict(ball(n), load_n=None), ("load_n",), loads)
    assert not s["status"].any()
    assert s["load_n"] == pytest.approx(loads, rel=1e-9)


@pytest.mark.parametrize("n", [48, 49])
def test_contact_shrinks_to_a_few_cells(drive, n):
    """However small the force: unloading in geometric steps, and none at the end."""
    loads = [180.0, 1e-1, 1e-3, 1e-5, 1e-7, 1e-9, 0.0]
    s = drive(dict(ball(n), load_n=None), ("load_n",), loads)
    assert not s["status"].any()
    assert s["load_n"] == pytest.approx(loads, rel=1e-9)
    assert np.all(np.diff(s["contact_area"]) <= 0) and s["contact_area"][5] > 0


def test_bodies_moved_while_apart_meet_without_shear(drive):
    s = drive(
        dict(ball(48), load_n=None),
        ("disp_z", "disp_x", "disp_y", "rot_z"),
        [(3e-6, 1e-7, 0, 0), (-1e-6, 5e-7, -2e-7, 1e-3), (3e-6, 5e-7, -2e-7, 1e-3), (3e-6, 6e-7, -2e-7, 1e-3)],
    )
    assert not s["status"].any()
    assert s["load_tx"][0] > 1 and s["load_tx"][1] == 0
    assert np.hypot(s.shear_x[2], s.shear_y[2]).max() <= 1e-6 * FRICTION * s.pressure[2].max()
    # then the way from there counts
    assert s["load_tx"][3] == pytest.approx(s["load_tx"][0], rel=1e-5)
    assert_coulomb(s, ball(48))


def test_contact_found_again_without_tangential_load_has_no_shear(drive):
    s = drive(dict(ball(48), load_n=None), ("load_n", "load_tx"), [(180, 10), (0, 0), (180, 0), (180, 10)])
    assert not s["status"].any()
    assert np.hypot(s.shear_x[2], s.shear_y[2]).max() <= 1e-6 * FRICTION * s.pressure[2].max()
    assert s["disp_x"][3] - s["disp_x"][2] == pytest.approx(
        drive(dict(ball(48), load_n=None), ("load_n", "load_tx"), [(180, 0), (180, 10)])["disp_x"][1], rel=1e-5
    )


def test_sliding_ahead_of_a_contact_that_grows_from_nothing(drive):
    """One motion along x while the bodies come together: contact begins in a step that slides at once."""
    s = drive(dict(ball(48), load_n=None), ("disp_z", "disp_x"), [(-1e-6, 0), (1e-6, 5e-6), (2e-6, 1e-5)])
    assert not s["status"].any() and s["stick_area"].tolist() == [0, 0, 0]
    assert s["load_tx"][1:] == pytest.approx(FRICTION * s["load_n"][1:], rel=1e-3)


def test_unloading_to_nothing_and_sliding_is_no_equilibrium(drive):
    s = drive(dict(ball(48), load_n=None), ("load_n", "load_tx"), [(180, 10), (0, 10)], check=11)
    assert s["status"].tolist() == [0, 11] and "load_tx" in s.run.complaint[0]


def test_contact_that_tips_over_is_told_at_its_step(drive):
    s = drive(ball(48), ("load_my",), [0.01, 1.0, 0.0], check=11)
    assert s["status"].tolist() == [0, 11]
    assert "step 2" in s.run.complaint[0] and "load_my" in s.run.complaint[0]


# ---------------------------------------------------------------- what must not matter


def test_warm_start_does_not_change_the_path(drive):
    t = np.concatenate([np.linspace(5, 40, 8), np.linspace(35, -40, 16)])
    case = dict(ball(64), load_n=None)
    warm, cold = (
        drive(dict(case, warm_start=w), ("load_n", "load_tx", "load_mz"), np.column_stack([0 * t + 180, t, t * 1e-5]))
        for w in (1, 0)
    )
    for name in ("shear_x", "shear_y"):
        assert_close(
            getattr(warm, name), getattr(cold, name), 1e-2, name, FRICTION * warm.pressure.max()
        )  # the direction of slip in a step is left as predicted where it is nearly right (step/solve.c)


def test_turned_path_is_the_turned_solution(drive):
    """Along y instead of x, from the start to the end."""
    t = cycle(0.7 * MU_N, 3)
    case = dict(ball(60), load_n=None)
    x, y = (drive(case, ("load_n", name), pushed(t)) for name in ("load_tx", "load_ty"))
    scale = FRICTION * x.pressure.max()
    assert_close(y.shear_y, x.shear_x.transpose(0, 2, 1), 2e-5, "q", scale)  # ten times the tolerance of either
    assert_close(y["disp_y"], x["disp_x"], 2e-5)
    assert y["dissipated_energy"] == pytest.approx(
        x["dissipated_energy"], rel=1e-4, abs=1e-5 * x["dissipated_energy"].max()
    )


def test_limit_of_sliding_is_approached_in_steps(drive):
    """As near to gross slip as 0.999, there and back."""
    s = drive(dict(ball(64), load_n=None), ("load_n", "load_tx"), pushed(cycle(0.999 * slide_limit(ball(64))[0], 4)))
    assert not s["status"].any() and (s["stick_area"][1:] > 0).all()


@pytest.mark.parametrize("ranks", [1, 2])
def test_without_contact_there_is_no_approach(petsam, tmp_path, ranks):
    """It is NaN in the results and the table; the steps after it, also from a checkpoint, have the same bits."""
    case = dict(SPHERE, load_n=None, checkpoint="c.h5", checkpoint_every=1)
    (tmp_path / "h.csv").write_text("time,load_n,load_tx\n1,1000,20\n2,0,0\n3,500,10\n")
    (tmp_path / "part.csv").write_text("time,load_n,load_tx\n1,1000,20\n2,0,0\n")
    petsam(case, dict(history="h.csv", output="r.h5"), ranks=ranks)
    said = petsam(case, dict(history="part.csv", output="p.h5"), "-overwrite", ranks=ranks)
    petsam(case, dict(history="h.csv", output="n.h5", restart="c.h5"), ranks=ranks)
    assert said.code == 0
    with h5py.File(tmp_path / "r.h5") as whole, h5py.File(tmp_path / "n.h5") as rest:
        approach = whole["history/disp_z"][:]
        assert np.isnan(approach[1]) and approach[0] > approach[2] > 0 and whole["history/load_n"][1] == 0
        assert not np.isnan(whole["history/disp_x"]).any()
        assert rest["history/disp_z"][-1] == approach[2] and (rest["pressure"][-1] == whole["pressure"][-1]).all()
    alone = petsam(dict(SPHERE, load_n=0)).stdout
    assert re.search(r"load_n +0 N +disp_z +nan m", alone)

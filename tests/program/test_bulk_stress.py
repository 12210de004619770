"""Bulk stress in the bodies: the stretch of their surfaces, its options and columns."""

import h5py
import numpy as np
import pytest

from support import SPHERE, assert_same, ball, bodies, doubts, history, read_run, slide_limit

BALL = ball(48, load_tx=10.0)


@pytest.mark.parametrize("body", [1, 2])
def test_stick_zone_of_a_long_contact_moves_as_nowell_and_hills_found(solve, body):
    """Plane strain: e/a = sigma/(4 mu p0), towards +x under tension of body 2 and a positive shear on it."""
    a, long, mu = 2e-4, 3.6e-3, 0.5
    case = dict(
        SPHERE, friction=mu, gap_type="ellipsoid", gap_radius_x=0.0105, gap_radius_y=0.9,
        gap_radius1=None, gap_radius2=None, load_n=1500.0, load_tx=0.5 * mu * 1500.0,
        grid_n=(200, 40), grid_size=(2.6 * a, 2.6 * long),
    )  # fmt: skip
    plain = solve(case)
    middle, h = 20, plain.x[1] - plain.x[0]
    half = np.count_nonzero(plain.pressure[middle]) * h / 2
    p0 = plain.pressure[middle].max()
    for part in (0.4, -0.7):
        sigma = part * mu * p0 * (1 if body == 2 else -1)
        bulk = {f"bulk{body}_stress_xx": sigma, f"bulk{body}_stress_yy": 0.3 * sigma}
        stick = np.flatnonzero(solve(dict(case, **bulk)).state[middle] == 1)
        center = (plain.x[stick[0]] + plain.x[stick[-1]]) / 2
        assert center / half == pytest.approx(part / 4, abs=0.75 * h / half)


def test_equal_stretches_of_both_bodies_do_nothing(solve):
    plain = solve(BALL)
    both = solve(dict(BALL, bulk1_stress_xx=3e7, bulk2_stress_xx=3e7, bulk1_stress_xy=-1e7, bulk2_stress_xy=-1e7))
    assert_same(both, plain, 0)
    other = solve(dict(BALL, bulk2_stress_xx=3e7))
    assert abs(other.shear_x - plain.shear_x).max() > 1e-2 * abs(plain.shear_x).max()


def test_history_and_attributes_tell_the_bulk_stress(petsam, tmp_path):
    steps = history(tmp_path / "h.csv", "time,load_tx,bulk2_stress_xx", (1, 10, 2e7), (2, 5, -1e7))
    petsam(dict(BALL, load_tx=None, bulk1_stress_yy=4e6), steps, dict(steps=2, output="with.h5"))
    with h5py.File(tmp_path / "with.h5") as f:
        assert f["history/bulk2_stress_xx"][:].tolist() == [1e7, 2e7, 5e6, -1e7]
        assert f["history/bulk1_stress_yy"][:].tolist() == [2e6, 4e6, 4e6, 4e6]
        assert not f["history/bulk1_stress_xy"][:].any() and f["history/bulk2_stress_xx"].attrs["units"] == "Pa"
        assert f.attrs["bulk2_stress_xx"] == -1e7 and f.attrs["bulk1_stress_yy"] == 4e6
    petsam(BALL, dict(output="without.h5"))
    with h5py.File(tmp_path / "without.h5") as f:
        assert "bulk2_stress_xx" not in f["history"] and "bulk2_stress_xx" not in f.attrs


def test_restart_goes_on_with_the_same_bulk_stress_only(petsam, tmp_path):
    def steps(second, *more):
        return history(tmp_path / "h.csv", "time,bulk2_stress_xx", (1, 2e7), (2, second), *more)

    def shear(name):
        run = read_run(tmp_path / name)
        return run["shear_x"][-1], run["history/bulk2_stress_xx"].tolist()

    case, restart = ball(32, load_tx=8.0), dict(restart="c.h5", output="on.h5")
    petsam(case, steps(1e7), dict(checkpoint="c.h5", checkpoint_every=1, output="on.h5"))
    assert "bulk2_stress_xx" in petsam(case, steps(1.1e7, (3, 0.0)), restart, check=2).complaint[0]
    petsam(case, steps(1e7, (3, 0.0)), restart)
    petsam(case, steps(1e7, (3, 0.0)), dict(output="whole.h5"))
    assert np.array_equal(shear("on.h5")[0], shear("whole.h5")[0])
    assert shear("on.h5")[1] == shear("whole.h5")[1] == [2e7, 1e7, 0]


def test_friction_limit_does_not_depend_on_the_bulk_stress(petsam):
    """What the grid carries when all slides is mu N, whatever the stretch."""
    limit = slide_limit(BALL)[0]
    petsam(dict(BALL, load_tx=0.999 * limit, bulk2_stress_xx=3e7))
    done = petsam(dict(BALL, load_tx=1.001 * limit, bulk2_stress_xx=3e7), check=11)
    assert "gross slip: load_tx" in done.complaint[0]


def stretched(folder, kind, phase):
    """Two cycles of N, which varies by 70 %, and bulk stress, five rows each; `phase` 0: in proportion."""
    load, stress = (400.0, 150e6) if kind == "sphere" else (1e5, 100e6)
    turns = [2 * np.pi * k / 5 for k in range(11)]
    rows = [
        (float(k), load * (1 + 0.7 * float(np.sin(t))), stress * float(np.sin(t + phase))) for k, t in enumerate(turns)
    ]
    grid = dict(grid_n=40, grid_size=1.5e-3) if kind == "sphere" else dict(grid_n=120, grid_size=1.6e-3)
    case = dict(grid, gap_type="sphere", gap_radius1=0.05, gap_radius2=float("inf"), friction=0.5, output_every=1000)
    case |= {f"body{b}_{name}": value for b in (1, 2) for name, value in (("young", 200e9), ("poisson", 0.3))}
    if kind == "plane":
        case["elasticity"] = "plane"
    return case | history(folder / f"{kind}{phase}.csv", "time,load_n,bulk2_stress_xx", *rows)


def of_a_cycle(run, steps, *names):
    with h5py.File(run.path) as f:
        return [f[f"history/{name}"][-5 * steps :].sum() for name in names]


@pytest.mark.parametrize("kind", ["sphere", "plane"])
def test_slip_by_the_stretch_begins_with_contact(solve, tmp_path, kind):
    """Held from the beginning of the step, cells that touch late in it would make 9 % too much of the energy."""
    case = stretched(tmp_path, kind, 2.5)
    few, many = (solve(case, dict(steps=steps)) for steps in (4, 32))
    energy, estimate = of_a_cycle(few, 4, "dissipated_energy", "energy_error")
    exact = of_a_cycle(many, 32, "dissipated_energy")[0]
    error = abs(energy - exact)
    assert error < 0.03 * exact and error / 3 < estimate < 4 * error


def test_contact_that_is_stretched_in_proportion_to_the_load_sticks(solve, tmp_path):
    """In plane strain the drift is exact; the shear of cells that are released goes back in the order of long steps."""
    case = stretched(tmp_path, "plane", 0.0)
    energy, told = of_a_cycle(solve(case), 1, "dissipated_energy", "energy_error")
    apart = of_a_cycle(solve(stretched(tmp_path, "plane", 0.7)), 1, "dissipated_energy")[0]
    assert energy < 0.01 * apart and energy < 3 * told
    assert of_a_cycle(solve(case, dict(steps=4)), 4, "dissipated_energy")[0] < 1e-6 * apart


def test_slip_by_bulk_stress_alone_within_a_cell_is_warned_of(petsam, tmp_path):
    """No tangential load does work; the shear of the stretched surface still slips at the edge, on finer cells."""
    pad = dict(
        bodies(210e9, 0.3), elasticity="plane", gap_type="pad", gap_half_flat_x=4.84e-3, gap_edge_radius_x=0.136,
        friction=1.0, grid_n=120, grid_size=0.0189, steps=4,
    )  # fmt: skip
    rows = [(0, 7.26e5, 0), (1, 5.56e5, -3.94e6), (2, 6.07e5, 5.3e6), (3, 4.53e5, -1.23e6)]
    done = petsam(pad, history(tmp_path / "h.csv", "time,load_n,bulk1_stress_xx", *rows))
    assert doubts(done)[1]["dissipated_energy"] == 1
    rows = [(0, 7.26e5, 0), (1, 7.26e5, 0)]
    done = petsam(pad, history(tmp_path / "h.csv", "time,load_n,bulk1_stress_xx", *rows))
    assert "dissipated_energy" not in doubts(done)[1]

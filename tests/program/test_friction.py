"""Friction that varies over the surface, and over the steps."""

import h5py
import numpy as np
import pytest

from kinds.kills import differences
from support import FIELDS, assert_close, assert_same, ball, history, kernels, read_run

BALL = ball(60, poisson=0.3)
LIMIT = BALL["friction"] * BALL["load_n"]


def with_field(case, path, values, dataset="friction"):
    """The case with a field of coefficients, which is written to path, instead of the number."""
    with h5py.File(path, "w") as f:
        f[dataset] = values
    return dict(case, friction=None, friction_file=path)


def elastic(results, options):
    """u_x, u_y of all cells by a convolution of our own, for equal bodies; and a cell's influence on itself."""
    n, shear = results.pressure.shape, options["body1_young"] / (2 * (1 + options["body1_poisson"]))
    lag = [(np.arange(2 * size) + size) % (2 * size) - size for size in n]
    with np.errstate(divide="ignore", invalid="ignore"):
        k = kernels(*np.meshgrid(lag[1] * results.dx, lag[0] * results.dy), results.dx, results.dy)
    nu, c = options["body1_poisson"], 2 / (2 * np.pi * shear)

    def product(kernel, q):
        return np.fft.irfft2(np.fft.rfft2(kernel) * np.fft.rfft2(q, s=kernel.shape), s=kernel.shape)[: n[0], : n[1]]

    xx, yy, xy = (1 - nu) * k["r"] + nu * k["xx"], (1 - nu) * k["r"] + nu * k["yy"], nu * k["xy"]
    ux = c * (product(xx, results.shear_x) + product(xy, results.shear_y))
    uy = c * (product(xy, results.shear_x) + product(yy, results.shear_y))
    return ux, uy, c * max(xx[0, 0], yy[0, 0])


def residual(results, options, bound):
    """|q - D(q - s/c)|/|q| of a first step, D the projection on the discs of radius `bound`."""
    ux, uy, self_influence = elastic(results, options)
    rx, ry, _ = results.rigid()
    yx, yy = results.shear_x - (ux - rx) / self_influence, results.shear_y - (uy - ry) / self_influence
    with np.errstate(invalid="ignore", divide="ignore"):
        scale = np.minimum(1, np.where(np.hypot(yx, yy) > 0, bound / np.hypot(yx, yy), 1))
    error = np.hypot(results.shear_x - scale * yx, results.shear_y - scale * yy)
    return np.linalg.norm(error) / np.linalg.norm(results.shear)


def test_constant_field_is_the_number_to_the_last_bit(solve, tmp_path):
    case = dict(BALL, load_tx=0.7 * LIMIT, load_mz=1e-3)
    number = solve(case)
    constant = with_field(case, tmp_path / "mu.h5", np.full((60, 60), BALL["friction"]))
    for ranks in 1, 3:
        assert_same(solve(constant, ranks=ranks), number, 0)


def stripes(results):
    """0.05 and 0.5 in stripes of five cells."""
    return np.where((np.arange(results.pressure.shape[1]) // 5) % 2, 0.5, 0.05) * np.ones(results.pressure.shape)


@pytest.mark.parametrize("ranks", [1, 2])
def test_stripes_satisfy_an_independent_check(solve, tmp_path, ranks):
    case = dict(BALL, load_tx=0.6 * LIMIT, load_ty=10.0)
    mu = stripes(solve(BALL))
    r = solve(with_field(case, tmp_path / "mu.h5", mu), ranks=ranks)
    bound = mu * r.pressure
    assert np.max(r.shear - bound) <= 1e-14 * bound.max()
    assert residual(r, BALL, bound) <= 1.1e-6
    assert_close([r.loads()[name] for name in ("load_tx", "load_ty")], [0.6 * LIMIT, 10.0], 1e-10)
    slips, sticks = r.state == 2, r.state == 1
    assert slips[mu == 0.05].any() and sticks[mu == 0.5].any()
    assert np.array_equal(slips, (r.pressure > 0) & (r.shear >= (1 - 1e-5) * bound))


def test_independent_check_sees_another_friction(solve, tmp_path):
    """The check above is worth something: it refuses the solution for other stripes."""
    mu = stripes(solve(BALL))
    r = solve(with_field(dict(BALL, load_tx=0.6 * LIMIT), tmp_path / "mu.h5", mu))
    assert residual(r, BALL, 1.01 * mu * r.pressure) > 1e-4


def test_limit_of_gross_slip_is_that_of_the_field(petsam, tmp_path):
    mu = np.full((60, 60), 0.1)
    mu[:, 30:] = 0.3  # by symmetry 0.2 of the load
    done = petsam(with_field(BALL, tmp_path / "mu.h5", mu), dict(load_tx=1.1 * 0.2 * BALL["load_n"]), check=11)
    limit = float(done.complaint[0].split("limit ")[1].split(")")[0])
    assert limit == pytest.approx(0.2 * BALL["load_n"], rel=1e-9)


def test_scale_of_the_friction_is_a_factor(solve, tmp_path):
    steps = history(tmp_path / "h.csv", "time,load_tx,friction_scale", (1, 20.0, 0.8))
    one, other = solve(BALL, steps), solve(dict(BALL, friction=0.8 * BALL["friction"], load_tx=20.0))
    assert_same(one, other, 1e-12)
    assert one["friction_scale"] == 0.8 and "friction_scale" not in other.history


def test_cells_slip_where_friction_falls_below_their_shear(solve, tmp_path):
    """Constant loads; the coefficient falls step by step until all but a core slips."""
    rows = [(1, 25.0, 1.0), (2, 25.0, 0.8), (3, 25.0, 0.6)]
    stick = []
    for count in 1, 2, 3:
        r = solve(BALL, history(tmp_path / f"h{count}.csv", "time,load_tx,friction_scale", *rows[:count]))
        stick.append(r["stick_area"])
        bound = rows[count - 1][2] * BALL["friction"] * r.pressure
        assert np.max(r.shear - bound) <= 1e-14 * bound.max()
        assert np.array_equal(r.state == 2, (r.pressure > 0) & (r.shear >= (1 - 1e-5) * bound))
    assert stick[0] > 1.1 * stick[1] > 1.1 * 1.1 * stick[2] > 0
    # Jaeger: at constant load a path of falling friction ends where its last value alone would
    alone = solve(dict(BALL, friction=0.6 * BALL["friction"], load_tx=25.0))
    assert r["stick_area"] == pytest.approx(alone["stick_area"], rel=0.02)


def test_increments_divide_the_change_of_the_scale(petsam, tmp_path):
    petsam(
        BALL,
        history(tmp_path / "h.csv", "time,load_tx,friction_scale", (1, 5.0, 1.0), (2, 5.0, 0.5)),
        dict(steps=2, output=tmp_path / "r.h5"),
    )
    with h5py.File(tmp_path / "r.h5") as f:
        assert list(f["history/friction_scale"]) == [1.0, 1.0, 0.75, 0.5]
        assert f["history/friction_scale"].attrs["units"] == "1"


WRONG_FIELDS = {"negative": (-0.1, "is less than 0"), "not a number": (np.nan, "is not a finite number")}


@pytest.mark.parametrize("kind", WRONG_FIELDS)
@pytest.mark.parametrize("ranks", [1, 2])
def test_wrong_coefficient_is_named_by_its_cell(petsam, tmp_path, kind, ranks):
    value, words = WRONG_FIELDS[kind]
    mu = np.full((60, 60), 0.1)
    mu[41, 7] = value
    done = petsam(with_field(BALL, tmp_path / "mu.h5", mu), ranks=ranks, check=3)
    assert "-friction_file" in done.complaint[0] and "/friction[41, 7] " + words in done.complaint[0]


def test_field_of_another_shape_or_name_is_refused(petsam, tmp_path):
    wrong = with_field(BALL, tmp_path / "a.h5", np.ones((60, 59)))
    assert "(60, 59), expected (ny, nx) = (60, 60)" in petsam(wrong, check=3).complaint[0]
    named = with_field(BALL, tmp_path / "b.h5", np.full((60, 60), 0.1), "mu")
    assert "-friction_dataset" in petsam(named, check=3).complaint[0]
    petsam(named, dict(friction_dataset="/mu"))


def test_number_and_field_together_are_refused(petsam, tmp_path):
    both = dict(with_field(BALL, tmp_path / "mu.h5", np.ones((60, 60))), friction=0.3)
    complaint = petsam(both, check=2).complaint[0]
    assert "-friction " in complaint and "-friction_file" in complaint
    assert "-friction_dataset" in petsam(BALL, dict(friction_dataset="/mu"), check=2).complaint[0]


def test_checkpoint_of_another_field_is_refused(petsam, tmp_path):
    steps = history(tmp_path / "h.csv", "time,load_tx", (1, 5.0), (2, 6.0))
    run = dict(BALL, checkpoint=tmp_path / "c.h5", checkpoint_every=1, **steps)
    petsam(with_field(run, tmp_path / "mu.h5", np.full((60, 60), 0.1)))
    other = with_field(run, tmp_path / "other.h5", np.full((60, 60), 0.2))
    assert "friction_file" in petsam(other, dict(restart=tmp_path / "c.h5"), check=2).complaint[0]
    assert "friction" in petsam(run, dict(restart=tmp_path / "c.h5"), check=2).complaint[0]


def test_all_fields_are_the_same_on_any_number_of_ranks(solve, tmp_path):
    steps = history(tmp_path / "h.csv", "time,load_tx,load_n,friction_scale", (1, 20, 180, 1.0), (2, -15, 150, 0.7))
    mu = 0.2 + 0.1 * np.random.default_rng(1).random((60, 60))
    case = with_field(dict(BALL, load_n=None, **steps), tmp_path / "mu.h5", mu)
    one = solve(case)
    for ranks in 2, 3:
        assert_same(solve(case, ranks=ranks), one, 0, FIELDS)


@pytest.mark.parametrize("option", ["output", "checkpoint"])
def test_results_do_not_replace_the_field(petsam, tmp_path, option):
    path = tmp_path / "mu.h5"
    case = with_field(BALL, path, np.full((60, 60), 0.1))
    before = path.read_bytes()
    done = petsam(case, {option: path}, check=2)
    assert f"-{option} {path}: would overwrite the file of -friction_file" in done.complaint[0]
    assert path.read_bytes() == before


@pytest.mark.parametrize("ranks", [1, 2])
def test_scale_that_begins_after_a_restart_is_in_the_results(petsam, solve, tmp_path, ranks):
    """The results of before the restart did not have the column: they get it, with 1 for their steps."""
    rows = [(k, 5.0 * k, 1.0) for k in (1, 2, 3)]
    run = dict(BALL, checkpoint=tmp_path / "c.h5", checkpoint_every=1, output=tmp_path / "r.h5")
    petsam(run, history(tmp_path / "plain.csv", "time,load_tx", *[row[:2] for row in rows]), ranks=ranks)
    scaled = history(tmp_path / "scaled.csv", "time,load_tx,friction_scale", *rows, (4, 16.0, 0.75))
    petsam(run, scaled, dict(restart=tmp_path / "c.h5"), ranks=ranks)
    once = solve(BALL, scaled)
    assert list(read_run(tmp_path / "r.h5")["history/friction_scale"]) == [1.0, 1.0, 1.0, 0.75]
    assert not differences(tmp_path / "r.h5", once.path)

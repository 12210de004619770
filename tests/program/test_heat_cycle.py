"""Temperatures by the frictional heat of a cycle: kernels beside quadrature, discs beside closed-form solutions, a
cycle of results beside the steady temperatures of the program."""

import numpy as np
import pytest

import petsam
from petsam import heat
from petsam.apps.heat import friction, kernels

PERIOD = 4.0
FRETTING = dict(
    body1="steel", body2="Ti-6Al-4V", gap_type="sphere", gap_radius1=20e-3, gap_radius2="inf", grid_n=(40, 36),
    grid_size=(0.7e-3, 0.63e-3), friction=0.6, errors="none", output="cycle.h5",
)  # fmt: skip
HISTORY = {"time": [0, 1, 3, 5, 7], "load_n": [100, 110, 90, 110, 90], "load_tx": [0, 45, -45, 45, -45]}


@pytest.fixture(autouse=True)
def here(tmp_path, monkeypatch):
    """Tests run in their folder."""
    monkeypatch.chdir(tmp_path)


def grid(n, width):
    """Coordinates of the cells' centres, and the sides of a cell."""
    x = (np.arange(n) - (n - 1) / 2) * width / n
    return *np.meshgrid(x, x), (width / n, width / n)


def part_in_disc(x, y, cell):
    """Part of each cell's area within the radius 1."""
    s = (np.arange(24) + 0.5) / 24 - 0.5
    return np.mean([[np.hypot(x + u * cell[0], y + v * cell[1]) < 1 for u in s] for v in s], axis=(0, 1))


@pytest.mark.parametrize("kappa", [1 + 1j, 0.05 + 0.05j, 6 + 6j])
@pytest.mark.parametrize(
    "lag", [(0, 0), (1, 0), (0, -0.6), (2, 0.6), (-3.9, 1.8), (4, 0), (0, -2.4), (9, 3), (12, 0), (13, 7.2)]
)
def test_a_cell_beside_quadrature(kappa, lag):
    """The integral over a cell of 1 x 0.6, halved until its parts are short beside their distance from the point."""
    points, weights = np.polynomial.legendre.leggauss(24)

    def integral(x, y, a, b, depth):
        if depth and np.hypot(max(abs(x) - a, 0), max(abs(y) - b, 0)) < 2 * max(a, b):
            return sum(
                integral(x + u * a / 2, y + v * b / 2, a / 2, b / 2, depth - 1) for u in (-1, 1) for v in (-1, 1)
            )
        r = np.hypot.outer(x + a * points, y + b * points)
        return a * b * np.einsum("i,j,ij", weights, weights, np.exp(-kappa * r) / r)

    expected = integral(*lag, 0.5, 0.3, 26 if lag == (0, 0) else 6) / (2 * np.pi)
    assert abs(kernels.harmonic(*lag, (1, 0.6), kappa) - expected) < 2e-8 * abs(expected) + 1e-12 / abs(kappa)


def test_a_cell_by_its_own_flux():
    """Published to 14 digits in the derivation of the method."""
    own = kernels.harmonic(0.0, 0.0, (1, 0.6), 1 + 1j)
    assert own == pytest.approx(0.33370593047153 - 0.069265435995336j, rel=1e-13)


@pytest.mark.parametrize("rate", [0.1, 10.0])
def test_disc_of_harmonic_flux(rate):
    """The temperature at the centre is (1 - exp(-kappa))/kappa."""
    x, y, cell = grid(65, 2.2)
    count, kappa = 16, np.sqrt(1j * rate)
    phase = 2 * np.pi * np.arange(count) / count
    conductor = kernels.Conductor((count, 65, 65), cell, 2 * np.pi / rate, 1.0, 1.0)
    centre = conductor(np.cos(phase)[:, None, None] * part_in_disc(x, y, cell))[:, 32, 32]
    expected = (1 - np.exp(-kappa)) / kappa
    assert np.mean(centre * np.exp(-1j * phase)) * 2 == pytest.approx(expected, rel=1e-3)


def test_disc_of_rectified_flux():
    """abs(sin): mean, maximum and minimum at the centre of a disc; means over intervals keep the mean."""
    found = []
    for count in (32, 64):
        x, y, cell = grid(65, 2.3)
        ends = np.abs(np.arange(count + 1) / count)
        work = np.where(ends <= 0.5, 1 - np.cos(2 * np.pi * ends), 3 + np.cos(2 * np.pi * ends)) / (4 * np.pi)
        flux = np.diff(work * 2)[:, None, None] * count / 1.0 * part_in_disc(x, y, cell)
        conductor = kernels.Conductor(flux.shape, cell, 0.5, 1.0, 1.0)
        found.append(conductor(flux)[:, 32, 32])
    for centre in found:
        assert np.mean(centre) == pytest.approx(0.6366197724, rel=3e-4)
    assert np.max(found[1]) == pytest.approx(0.7164950899, rel=1e-3)
    assert np.min(found[1]) == pytest.approx(0.539406134, rel=1e-3)


@pytest.mark.parametrize(
    "n, share, most, mean", [(33, 0.091006, 0.537181, 0.336577), (65, 0.091019, 0.537154, 0.336795)]
)
def test_partition_in_a_contact_that_moves(n, share, most, mean):
    """Heat of a fixed centre in a contact that moves by 0.15: numbers of the derivation."""
    x, y, cell = grid(n, 2.3)
    times = (np.arange(16) + 0.5) / 16
    touches = np.array([np.hypot(x - 0.15 * np.sin(2 * np.pi * t), y) < 1 for t in times])
    lens = np.sqrt(np.maximum(1 - x**2 - y**2, 0))
    flux = np.abs(np.cos(2 * np.pi * times))[:, None, None] * lens * touches
    bodies = heat.Body(1.0, 1.0), heat.Body(0.1, 0.5)
    found = heat.divided(flux, touches, cell, 1.0, bodies)
    assert found.share_2 == pytest.approx(share, abs=1e-6)
    assert found.maximum == pytest.approx(most, abs=1e-6)
    assert found.surface[0][touches].mean() == pytest.approx(mean, abs=2e-4)
    assert np.abs(found.surface[0] - found.surface[1])[touches].max() < 1e-7
    film = heat.divided(flux, touches, cell, 1.0, bodies, resistance=0.3)
    assert np.abs(film.surface[0] - film.surface[1] - 0.3 * film.heat_2)[touches].max() < 1e-7
    table = {column.name: np.array(column.values) for column in found.table()}
    assert table["temperature_max"].max() == found.maximum
    assert table["heat_power"].mean() == pytest.approx(found.power, rel=1e-12)


def test_share_of_a_contact_that_stays():
    """In the mean over a cycle the share is that of the conductivities; equal bodies take halves without a solve."""
    x, y, cell = grid(21, 2.4)
    touches = np.repeat((np.hypot(x, 1.3 * y) < 1)[None], 9, axis=0)
    rng = np.random.default_rng(5)
    flux = rng.random((9, 21, 21)) * touches
    found = heat.divided(flux, touches, cell, 0.7, (heat.Body(1.0, 3.0, 20.0), heat.Body(0.25, 0.1, 20.0)))
    assert found.share_2 == pytest.approx(0.2, rel=1e-7)
    equal = heat.divided(flux, touches, cell, 0.7, (heat.Body(1.0, 3.0), heat.Body(1.0, 3.0)))
    np.testing.assert_array_equal(equal.heat_2, 0.5 * flux)
    warmer = heat.divided(flux * 0, touches, cell, 0.7, (heat.Body(1.0, 3.0, 20.0), heat.Body(0.25, 0.1, 50.0)))
    assert warmer.surface[0][touches] == pytest.approx(20 + 30 * 0.2, abs=1e-5)


def test_cycle_of_results():
    """Work of a fretting cycle; slow cycles have the steady temperatures of each step, which the program computes."""
    options = {name: value for name, value in FRETTING.items() if name != "output"}
    slow = 1e9
    bodies = "steel", "Ti-6Al-4V"
    with petsam.run(**options, history={**HISTORY, "time": [slow * t for t in HISTORY["time"]]}, steps=8,
                    heat="steady") as results:  # fmt: skip
        work = heat.work(results)
        cycle = petsam.cycles.find(results, period=(PERIOD * slow, slow)).numbered(1)
        rows = range(cycle.first + 1, cycle.last + 1)
        np.testing.assert_array_equal(heat.work(results, cycle).work, work.work)
        steady = [results.field("temperature_1", k) for k in rows]
        shares = results.series("heat_share_2")[rows.start : rows.stop]
        window = np.ix_(np.isin(results.y, work.y), np.isin(results.x, work.x))
        assert work.energy == pytest.approx(petsam.cycles.find(results).energies[-1], rel=1e-12)
    found = work.temperatures(bodies)
    scale, most = np.max(found.surface[0]), found.heat_2.sum(axis=(1, 2)).max()
    for k in range(16):
        assert np.abs(found.surface[0][k] - steady[k][window]).max() < 4e-3 * scale  # work by cells
        assert found.heat_2[k].sum() == pytest.approx(shares[k] * found.heat[k].sum(), abs=1e-4 * most)
    fast = work.temperatures(bodies, 50.0)
    assert fast.mean_maximum == pytest.approx(found.mean_maximum * 50 * PERIOD * slow, rel=1e-3)
    assert fast.flash_maximum < found.flash_maximum * 50 * PERIOD * slow
    assert fast.power == pytest.approx(50 * work.energy, rel=1e-12)


def test_steps_of_unequal_lengths():
    """Equal intervals keep the work, and the temperatures are those of equal steps within what intervals leave."""
    rows = {"time": [0, 1, 1.5, 3, 4.5, 5, 7], "load_tx": [0, 45, 22.5, -45, 22.5, 45, -45]}
    with petsam.run(**FRETTING, history={**rows, "load_n": [100] * 7}, steps=8) as results:
        own, more = heat.work(results), heat.work(results, intervals=48)
    assert own.work.shape[0] == 32
    assert own.energy == pytest.approx(more.energy, rel=1e-12)
    bodies = heat.Body(53.3, 3.45e6), heat.Body(6.7, 2.4e6)
    one, other = own.temperatures(bodies, 10.0), more.temperatures(bodies, 10.0)
    assert one.mean_maximum == pytest.approx(other.mean_maximum, rel=1e-6)
    assert one.maximum == pytest.approx(other.maximum, rel=0.03)


def test_refusals():
    """Each message names the number or the file, and what to do."""
    flux = np.ones((4, 3, 3))
    good = heat.Body(1.0, 1.0), heat.Body(2.0, 1.0)
    for change, words in (
        (dict(period=0.0), "period 0 s"), (dict(resistance=-1.0), "resistance -1"),
        (dict(touches=np.zeros((4, 3, 3))), "no contact"), (dict(touches=flux[:3]), "expected \\(intervals, ny, nx\\)"),
        (dict(heat=flux[:3], touches=flux[:3]), "at least 4"), (dict(touches=np.tril(flux)), "0 outside of contact"),
        (dict(heat=flux[:, :1], touches=flux[:, :1]), "plane strain"),
    ):  # fmt: skip
        with pytest.raises(petsam.Error, match=words):
            heat.divided(**{**dict(heat=flux, touches=flux, cell=(1, 1), period=1.0, bodies=good), **change})
    for constants, words in (((0.0, 1.0), "conductivity 0"), ((1.0, np.nan), "capacity nan"), ((1, 1, np.inf), "inf")):
        with pytest.raises(petsam.Error, match=words):
            heat.Body(*constants)
    with pytest.raises(petsam.Error, match="no material"):
        heat.Body.named("unobtainium")


def test_refused_results():
    """Cycles without all fields, without slip, of few steps, and of bodies whose heat is not known."""
    for options, words in (
        (dict(output_every=4), "fields of step .* are not saved"),
        (dict(body2="steel", history={"load_n": [50, 100, 50, 100]}), "nothing slips"),
        (dict(steps=1), "has 2 steps"), (dict(elasticity="plane", gap_radius1=None, gap_radius2=None,
         gap_type="ellipsoid", gap_radius_x=0.02, gap_radius_y="inf", grid_n=64, grid_size=1e-3), "plane strain"),
        (dict(body2_layer_thickness=1e-4, body2_layer_young=1e11, body2_layer_poisson=0.3), "body2_layer"),
    ):  # fmt: skip
        every = {**FRETTING, "history": HISTORY, "steps": 4, **options}
        with petsam.run(**{k: v for k, v in every.items() if v is not None}) as results:
            with pytest.raises(petsam.Error, match=words):
                heat.work(results)
    shares = friction._shares(np.array([0.0, 1.0, 4.0]), 2)
    np.testing.assert_allclose(shares, [[1, 1 / 3], [0, 2 / 3]], atol=1e-12)
    with pytest.raises(petsam.Error, match="do not rise"):
        friction._shares(np.array([0.0, 1.0, 1.0]), 2)

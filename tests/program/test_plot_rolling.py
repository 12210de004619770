"""petsam-plot of steady rolling: creep curves; stick and slip zones with arrows of slip velocity, power density."""

import shutil

import h5py
import numpy as np
import pytest
from matplotlib.quiver import Quiver

import petsam
from petsam.plot import fields, series, wear
from support import ROOT, ball, finished, history

CASE = dict(ball(32), rolling="steady")


@pytest.fixture(scope="module")
def rolled(solve, tmp_path_factory):
    """rolled(columns, *rows): the results of such creepages and loads."""
    folder = tmp_path_factory.mktemp("history")

    def run(columns, *rows):
        table = folder / f"{columns.replace(',', '_')}.csv"
        return solve(CASE, history(table, f"time,{columns}", *[(k, *row) for k, row in enumerate(rows)])).path

    return run


def curve(rolled):
    """Under longitudinal creepage; the lateral one and the spin are found, and are zero to rounding."""
    return rolled("creep_x", (2e-4,), (4e-4,), (8e-4,), (2e-3,))


def labels(figure):
    return [axes.get_ylabel().split(",")[0] for axes in figure.axes if axes.lines]


def below(figure):
    return {axes.get_xlabel() for axes in figure.axes if axes.get_xlabel()}


def test_the_history_is_a_creep_curve(rolled):
    with petsam.open(curve(rolled)) as results:
        figure = series.history([results])
        assert labels(figure) == ["$T_x$", "stick area"]
        assert below(figure) == {r"creepage $\xi$, 10⁻³"}
        x, y = figure.axes[0].lines[0].get_data()
        assert np.allclose(x, 1e3 * results.history["creep_x"]) and np.allclose(y, results.history["load_tx"])
        over_time = series.history([results], ["load_tx"], "time").axes[0]
        assert np.array_equal(over_time.lines[0].get_xdata(), [0, 1, 2, 3])


def test_the_curve_is_over_what_varies_most(rolled):
    """Spin times the size of the contact counts beside creepages; what else varies is a curve of its own."""
    rows = (1e-4, 0.0, 0.1), (1.1e-4, 0.0, 1.0), (1e-4, 0.0, 3.0)
    with petsam.open(rolled("creep_x,creep_y,creep_spin", *rows)) as results:
        figure = series.history([results])
        assert below(figure) == {r"spin $\varphi$, 1/m"}
        assert labels(figure) == ["$T_x$", "$T_y$", "$M_z$", r"creepage $\xi$", "stick area"]


def test_spin_counts_with_the_size_of_the_contact(rolled):
    with petsam.open(rolled("creep_x,creep_spin,load_ty", (1e-4, 0.1, 0.0), (1e-3, 0.2, 0.0))) as results:
        assert below(series.history([results])) == {r"creepage $\xi$, 10⁻³"}


def test_a_curve_of_loads_is_over_the_creepage_that_they_need(rolled):
    with petsam.open(rolled("load_ty,creep_spin", (2.0, 0.0), (6.0, 0.0), (10.0, 0.0))) as results:
        figure = series.history([results])
        assert below(figure) == {r"creepage $\eta$, 10⁻⁶"} and "$T_y$" in labels(figure)


def test_arrows_of_slip_velocity_on_the_cells_that_slip(rolled):
    with petsam.open(curve(rolled)) as results:
        figure = fields.maps([(results, results.of_step(3))], whole=True)
        titles = [axes.get_title() for axes in figure.axes if axes.images]
        assert titles == ["pressure $p$", "shear $|q|$", r"power density over $V$, $-q \cdot s$", "state"]
        panel = next(axes for axes in figure.axes if axes.get_title() == "state")
        (arrows,) = (one for one in panel.collections if isinstance(one, Quiver))
        x, y = (1e-6 * np.asarray(values) for values in (arrows.X, arrows.Y))
        i, j = (np.argmin(np.abs(axis[:, None] - at), axis=0) for axis, at in ((results.x, x), (results.y, y)))
        state, vx, vy = (results.field(name, 2) for name in ("state", "slip_velocity_x", "slip_velocity_y"))
        assert 10 < i.size < 18 * 18 and np.allclose(results.x[i], x) and np.allclose(results.y[j], y)
        assert np.all(state[j, i] == 2) and np.array_equal(arrows.U, vx[j, i]) and np.array_equal(arrows.V, vy[j, i])
        assert np.mean(arrows.U) < 0  # against the shear of a positive creepage


def test_the_last_step_needs_no_name(rolled):
    with petsam.open(curve(rolled)) as results:
        first, last = (
            fields.maps([(results, index)]).axes[0].get_title(loc="left") for index in (0, results.of_last())
        )
    assert first == "step 1, t = 0 s" and last == ""


def test_the_scar_of_a_band_has_no_place_along_it_and_its_maps_name_the_passages(solve):
    band = petsam.open(solve(CASE, dict(creep_x=1e-3, wear_coefficient1=1e-14, wear_cycles=1000, wear_output=0)).path)
    figure = wear.scar([(band, index) for index in wear.scar_steps(band)])
    assert [axes.get_title() for axes in figure.axes] == ["body 1"]
    assert "after 1000 cycles" in fields.maps([(band, band.of_last())]).axes[0].get_title(loc="left")


@pytest.mark.parametrize("spin", [0.0, 5.0])
def test_power_density_is_a_field_by_name(rolled, spin):
    with petsam.open(rolled("creep_x,creep_spin", (2e-4, spin), (2e-3, spin))) as results:
        power = results.quantity("power_density")
        assert results.about("power_density")[0] == "Pa"
        cell = (results.x[1] - results.x[0]) * (results.y[1] - results.y[0])
        assert np.sum(power) * cell == pytest.approx(results.history["rolling_energy"][-1])
        figure = fields.maps([(results, results.of_last())], names=["power_density"])
        assert len(figure.axes) == 1 and figure.axes[0].images[0].norm.vmin == 0.0  # also with spin: see colours.LEAST


@pytest.mark.parametrize("window", [{}, dict(rows=slice(4, 20), columns=slice(5, 29), stride=3), dict(stride=5)])
def test_power_density_is_computed_where_it_is_not_saved(rolled, tmp_path, window):
    path = rolled("creep_x,creep_y,creep_spin", (2e-4, 0.0, 0.0), (4e-4, 2e-4, 1.0))
    copy = shutil.copy(path, tmp_path / "copy.h5")
    with h5py.File(copy, "a") as file:
        del file["power_density"]
    with petsam.open(path) as whole, petsam.open(copy) as results:
        saved, found = (of.quantity("power_density", **window) for of in (whole, results))
        assert saved.shape == found.shape and np.abs(found - saved).max() <= 1e-12 * np.abs(saved).max()
        assert saved.max() > 0 and results.about("power_density")[0] == "Pa"


def test_what_the_power_needs_is_named(rolled, tmp_path):
    copy = shutil.copy(curve(rolled), tmp_path / "copy.h5")
    with h5py.File(copy, "a") as file:
        del file["power_density"], file["slip_velocity_x"]
    with petsam.open(copy) as results, pytest.raises(petsam.Error, match="power_density, or shear_x,shear_y,slip_vel"):
        results.need_quantity("power_density")


def test_all_pictures_of_a_file(rolled, tmp_path):
    done = finished([ROOT / "scripts/petsam-plot", curve(rolled)], cwd=tmp_path)
    assert [line.rpartition("_")[2] for line in done.stdout.split()[1::2]] == [
        "maps.png",
        "profiles.png",
        "history.png",
    ]

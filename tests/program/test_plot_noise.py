"""What pictures leave out by themselves: what does not vary, and rounding noise; and how many points are drawn."""

import h5py
import numpy as np
import pytest

import petsam
from petsam import cycles
from petsam.plot import crossings, fields, loops, noise, series, style
from support import ball, history, slide_limit

pytestmark = pytest.mark.usefixtures("closing")

CASE = ball(n=24)
AMPLITUDE = float(0.7 * slide_limit(CASE)[0])


@pytest.fixture(scope="module")
def strokes(solve, tmp_path_factory):
    """Three cycles at constant normal load."""
    turns = [0.0, *[AMPLITUDE, -AMPLITUDE] * 3, AMPLITUDE]
    table = history(tmp_path_factory.mktemp("history") / "h.csv", "time,load_tx", *enumerate(turns))
    return solve(CASE, dict(table, steps=3)).path


@pytest.fixture(scope="module", params=[0.0, 0.3])
def normal(solve, request):
    """Normal load alone, without friction and with it."""
    return solve(dict(CASE, friction=request.param), dict(steps=4)).path


@pytest.fixture(scope="module")
def periodic(solve, tmp_path_factory):
    """A rough periodic surface, whose moments say nothing."""
    folder = tmp_path_factory.mktemp("periodic")
    chance = np.random.default_rng(1)
    with h5py.File(folder / "rough.h5", "w") as file:
        x = np.linspace(0, 2 * np.pi, 24, endpoint=False)
        waves = [np.cos(k * x[None, :] + chance.normal()) * np.cos(k * x[:, None] + 1.0) for k in (1, 2)]
        file["height"] = 3e-7 * np.sum(waves, axis=0)
        file["height"].attrs["quantity"] = "height2"
    case = dict(CASE, elasticity="periodic", gap_type="flat", gap_rough_file=folder / "rough.h5", grid_size=1e-3)
    case.update(gap_radius1=None, gap_radius2=None, load_n=20.0, load_tx=2.0, friction=0.3)
    return solve(case, dict(steps=4)).path


def panels(*paths):
    """What the panels of a history show by themselves."""
    figure = series.history([petsam.open(path) for path in paths])
    return [axes.get_ylabel().split(",")[0] for axes in figure.axes if axes.lines]


# ---------------------------------------------------------------- histories


def test_a_history_shows_what_varies_alone(strokes):
    # the normal load is constant after the steps of the preload
    assert set(panels(strokes)) >= {"$T_x$", "$d_x$", "stick area", "dissipated energy"}
    part = petsam.open(strokes).between(4, None)
    shown = [axes.get_ylabel().split(",")[0] for axes in series.history([part]).axes if axes.lines]
    assert shown == ["$T_x$", "$d_x$", "stick area", "dissipated energy"]


def test_a_history_of_normal_load_shows_no_friction(normal):
    assert panels(normal) == ["$N$", "$d_z$", "contact area"]


def test_moments_of_a_periodic_surface_are_left_out(periodic):
    with petsam.open(periodic) as results:
        assert np.ptp(results.history["load_mx"]) > 1e-3 * results.history["load_n"].max() * 1e-3 * 1e-3
        assert "$T_x$" in panels(periodic) and not {"$M_x$", "$M_y$", "$M_z$"} & set(panels(periodic))
        assert len(series.history([results], ["load_mx"]).axes[0].lines) == 1


@pytest.mark.parametrize("name, symbol, powers", [
    ("rot_y", "$r_y$", (0, 1, -1)), ("disp_y", "$d_y$", (0, 1, 0)), ("load_ty", "$T_y$", (1, 0, 0)),
    ("load_my", "$M_y$", (1, 0, 1)), ("load_mz", "$M_z$", (1, 0, 1)),
])  # fmt: skip
def test_the_scale_of_noise_is_that_of_its_kind(strokes, name, symbol, powers):
    """powers are those of the largest load, the largest displacement and the size of the contact."""
    for factor, shown in ((0.1, False), (10.0, True)):
        with petsam.open(strokes) as results:
            rows = results.solved
            force, way = results.history["load_n"][rows].max(), results.history["disp_z"][rows].max()
            size = np.sqrt(results.history["contact_area"][rows].max())
            scale = np.prod(np.array([force, way, size]) ** powers)
            results.history[name][:] = 0.0
            results.history[name][-1] = factor * noise.NOISE * scale
            labels = [axes.get_ylabel().split(",")[0] for axes in series.history([results]).axes if axes.lines]
            assert (symbol in labels) == shown


def test_what_is_asked_for_by_name_is_drawn(normal):
    names = ["load_tx", "rot_x", "tangential_iterations", "dissipated_energy"]
    figure = series.history([petsam.open(normal)], names)
    assert sum(bool(axes.lines) for axes in figure.axes) == len(names)


# ---------------------------------------------------------------- normal load alone


def test_normal_load_alone_has_no_shear_slip_or_loop(draw, normal, strokes, tmp_path):
    assert draw(normal) == (0, [])
    names = {file.name for file in tmp_path.iterdir()}
    assert names == {f"results_{kind}.png" for kind in ("maps", "profiles", "history")}
    with petsam.open(normal) as one, petsam.open(strokes, "strokes") as other:
        assert [axes.get_title() for axes in fields.maps([(one, one.of_last())]).axes] == ["pressure $p$", "state"]
        figure = crossings.profiles([(one, one.of_last())])
        assert [axes.get_title(loc="left") for axes in figure.axes[::2]] == ["pressure $p$"]
        # beside a file with shear, or by name, they are drawn
        assert len(fields.maps([(one, one.of_last()), (other, other.of_last())]).axes) == 8
        assert [axes.get_title() for axes in fields.maps([(one, 0)], names=["shear"]).axes] == ["shear $|q|$"]
    assert draw(normal, "--loop") == (0, []) and (tmp_path / "results_loop.png").exists()


def test_noise_of_shear_and_slip_is_measured_by_pressure_and_displacement(strokes, monkeypatch):
    with petsam.open(strokes) as results:
        way = max(np.abs(results.history[name]).max() for name in ("disp_z", "disp_x", "disp_y"))
        for top, nothing in ((0.5, True), (2.0, False)):
            tops = {"pressure": 1e9, "shear": top * noise.NOISE * 1e9, "slip": top * noise.NOISE * way}
            assert [noise.is_nothing(name, tops, [results]) for name in ("shear", "slip")] == [nothing] * 2
        assert not noise.is_nothing("pressure", {"pressure": 0.0}, [results])
        assert not noise.is_nothing("shear", {"shear": 0.0}, [results])  # without a pressure there is no scale


# ---------------------------------------------------------------- energies of cycles


def test_cycles_are_whole_numbers_and_the_legend_hides_no_curve(strokes):
    with petsam.open(strokes) as results:
        figure = loops.energy([cycles.find(results)])
    figure.canvas.draw()
    (axes,) = figure.axes
    low, high = axes.get_xlim()
    ticks = [tick for tick in axes.get_xticks() if low <= tick <= high]
    assert ticks == [1.0, 2.0, 3.0]
    (legend,) = figure.legends
    assert not legend.get_window_extent().overlaps(axes.get_window_extent())
    assert axes.get_ylim()[1] > axes.lines[0].get_ydata().max() * 1.02


# ---------------------------------------------------------------- many points


def test_long_histories_over_what_goes_to_and_fro_are_points(strokes):
    chance = np.random.default_rng(1)
    many, time = chance.normal(size=1000), np.linspace(0.0, 1.0, 1000)
    for x, line in (
        (many, False), (many[:50], True), (np.sort(many), True), (-np.sort(many), True),
        (np.sin(2 * np.pi * 8 * time), True), (np.sin(2 * np.pi * 100 * time), False), (np.zeros(1000), True),
    ):  # fmt: skip
        assert (style.scattered(x).get("linestyle") != "none") == line
    with petsam.open(strokes) as results:
        results.history.update({name: np.zeros(1000) for name in results.history})
        results.__dict__.pop("solved", None)
        results.history.update(load_n=many, contact_area=many**2, time=time)
        over_load = series.history([results], ["contact_area"], "load_n").axes[0].lines[0]
        over_time = series.history([results], ["contact_area"]).axes[0].lines[0]
    assert over_load.get_linestyle() == "None" and over_load.get_marker() == "."
    assert over_time.get_linestyle() == "-" and len(over_load.get_xdata()) == 1000

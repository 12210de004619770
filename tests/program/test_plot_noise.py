"""What pictures leave out by themselves: what does not vary, and rounding noise; and how many points are drawn."""

import h5py
import numpy as np
import pytest

import petsam
from petsam import cycles
from petsam.plot import loops, maps, noise, profiles, series, style
from support import ball, slide_limit

pytestmark = pytest.mark.usefixtures("closing")

CASE = ball(n=24)
AMPLITUDE = float(0.7 * slide_limit(CASE)[0])


@pytest.fixture(scope="module")
def strokes(solve, tmp_path_factory):
    """Three cycles at constant normal load."""
    table = tmp_path_factory.mktemp("history") / "h.csv"
    turns = [0.0, *[AMPLITUDE, -AMPLITUDE] * 3, AMPLITUDE]
    table.write_text("time,load_tx\n" + "".join(f"{k},{load!r}\n" for k, load in enumerate(turns)))
    return solve(CASE, dict(history=table, steps=3)).path


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

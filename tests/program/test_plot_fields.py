"""petsam-plot's maps and profiles of chosen fields: colours, limits, layout; scalars over one another; many points."""

import h5py
import numpy as np
import pytest
from matplotlib.colors import LogNorm, Normalize, SymLogNorm

import petsam
from petsam.plot import colours, crossings, fields, outlines, series, style
from petsam.plot.style import plt
from support import ball, slide_limit

pytestmark = pytest.mark.usefixtures("closing")

CASE = ball(n=32)
AMPLITUDE = 0.7 * slide_limit(CASE)[0]
# steel on steel, a narrow ellipse: 10 mm x 1 mm
LONG = dict(CASE, body1_young=210e9, body2_young=210e9, body1_poisson=0.3, body2_poisson=0.3, friction=0.3)
LONG.update(gap_type="ellipsoid", gap_radius_x=4.0, gap_radius_y=0.1, gap_radius1=None, gap_radius2=None)
LONG.update(grid_n=(320, 32), grid_size=(20e-3, 1.6e-3), load_n=2000.0)


@pytest.fixture(scope="module")
def path(solve, tmp_path_factory):
    """To the amplitude and back, both tangential loads."""
    table = tmp_path_factory.mktemp("history") / "h.csv"
    amplitude = float(AMPLITUDE)
    table.write_text(f"time,load_tx,load_ty\n0,0,0\n1,{amplitude!r},{0.5 * amplitude!r}\n2,{-amplitude!r},0\n")
    return solve(CASE, dict(history=table, steps=3)).path


@pytest.fixture(scope="module")
def edges(solve):
    """A narrow contact on a long grid, with its edge."""
    more = dict(load_tx=300.0, load_ty=100.0, output_fields="all,contact_edge")
    return solve(dict(LONG, **more)).path


def image(figure, panel=0):
    """The picture of a map, and its colour bar's axes."""
    drawn = figure.axes[panel].images[0]
    return drawn, drawn.colorbar.ax


# ---------------------------------------------------------------- fields by name


def test_fields_and_vectors_of_a_file_are_known_by_what_it_holds(results, path):
    with h5py.File(path, "r") as file:
        shape = (results.times.size, results.y.size, results.x.size)
        named = [name for name in file if getattr(file[name], "shape", None) == shape]
        expected = np.hypot(file["displacement_x"][-1], file["displacement_y"][-1])
    assert sorted(results.fields) == sorted(named) and "state" in named
    assert {"shear", "slip", "displacement"} <= set(results.vectors)
    assert np.array_equal(results.quantity("displacement"), expected)
    assert results.about("displacement") == ("m", "relative elastic displacement along x")
    assert results.flags("state") == {0: "open", 1: "stick", 2: "slip"} and results.flags("gap") == {}


def test_a_new_field_needs_no_change_here(path, tmp_path):
    other = tmp_path / "other.h5"
    other.write_bytes(path.read_bytes())
    with h5py.File(other, "r+") as file:
        file["heat"] = 3.0e3 * file["pressure"][:] / file["pressure"][:].max()
        file["heat"].attrs.update(units="J/m2", long_name="heat of friction")
        file["history/wear_rate"] = np.arange(file["history/time"].size) * 1e-7
        file["history/wear_rate"].attrs["units"] = "m"
    with petsam.open(other) as results:
        figure = fields.maps([(results, results.of_last())], names=["heat"])
        drawn, bar = image(figure)
        assert bar.get_ylabel() == "kJ/m²" and figure.axes[0].get_title() == "heat of friction"
        assert drawn.get_array().max() == pytest.approx(3.0, rel=1e-12)
        axes = series.history([results], ["wear_rate"]).axes[0]
        assert axes.get_ylabel().startswith("wear rate, ")


def test_one_field_alone_with_its_sign_is_symmetric_about_zero(results, path):
    with h5py.File(path, "r") as file:
        shear = 1e-6 * file["shear_x"][-1]
    figure = fields.maps([(results, results.of_last())], whole=True, names=["shear_x"])
    drawn, bar = image(figure)
    assert len(figure.axes) == 1 and bar.get_ylabel() == "$q_x$, MPa"
    assert np.allclose(drawn.get_array(), shear) and drawn.get_cmap().name == colours.SIGNED
    low, high = drawn.get_clim()
    assert low == -high and high == pytest.approx(np.abs(shear).max(), rel=1e-12)


@pytest.mark.parametrize(
    "name, values, signed",
    [
        ("shear_x", [0.0, 1.0], True),
        ("gap", [-1e-12, 1.0], False),
        ("any", [-0.1, 1.0], True),
        ("pressure", [0.0, 1.0], False),
        ("any", [], False),
    ],
)
def test_a_sign_is_in_the_name_or_in_the_values(name, values, signed):
    assert colours.is_signed(name, np.array(values)) == signed
    assert (colours.choose(name, [np.array(values)], "m").color_map == colours.SIGNED) == signed


def test_slip_is_not_drawn_where_there_is_no_contact(results):
    is_open = results.field("state") == 0
    for name in ("slip_x", "slip"):
        drawn = image(fields.maps([(results, results.of_last())], whole=True, names=[name]))[0]
        assert np.array_equal(np.ma.getmaskarray(np.ma.masked_invalid(drawn.get_array())), is_open)


# ---------------------------------------------------------------- colours


def test_limits_are_those_given_in_SI_units(results):
    choice = colours.Choice((1e6, 2e6))
    drawn, bar = image(fields.maps([(results, results.of_step(6))], names=["shear_x"], choice=choice))
    assert np.allclose(drawn.get_clim(), (1.0, 2.0)) and bar.get_ylabel() == "$q_x$, MPa"
    assert drawn.colorbar.extend == "both"
    choice = colours.Choice((0.0, 1e12))
    assert image(fields.maps([(results, 0)], names=["pressure"], choice=choice))[0].colorbar.extend == "neither"


def test_a_few_peaks_do_not_darken_the_map_and_the_label_says_so():
    chance = np.random.default_rng(1)
    cells = np.concatenate([np.zeros(1000), chance.uniform(1e6, 2e6, 9850), np.full(150, 5e7)])
    found = colours.choose("pressure", [cells], "Pa")
    assert found.norm.vmax == pytest.approx(1e-6 * np.percentile(cells[1000:], 98.0), rel=1e-12)
    assert found.text("$p$") == "$p$, MPa" and found.extend == "max"
    assert found.remark == "colours hold 98 % of non-zero cells; maximum 50 MPa"
    share = np.mean(found.factor * cells[1000:] <= found.norm.vmax)
    assert 0.979 < share < 0.981
    signed = colours.choose("shear_x", [-cells], "Pa")
    assert signed.norm.vmin == -signed.norm.vmax and signed.extend == "min"
    assert signed.remark == found.remark


@pytest.mark.parametrize("count, share", [(0, 100.0), (5, 99.8), (90, 99.0), (150, 98.0), (400, 95.0), (600, 100.0)])
def test_the_percentile_leaves_out_as_little_as_it_takes(count, share):
    cells = np.ones(10000)
    cells[:count] = 10.0
    assert colours.top(cells) == ((1.0 if share < 100 else cells.max()), share)


def test_a_smooth_field_is_drawn_to_its_largest_value(results):
    for name in ("pressure", "shear", "slip"):
        drawn, bar = image(fields.maps([(results, results.of_last())], names=[name]))
        assert drawn.get_clim()[1] == pytest.approx(np.nanmax(drawn.get_array())) and bar.get_ylabel()
        assert "%" not in drawn.axes.get_xlabel()


def test_the_percentile_is_that_which_is_given(results):
    choice = colours.Choice(percentile=50.0)
    drawn, bar = image(fields.maps([(results, 0)], whole=True, names=["pressure"], choice=choice))
    inside = np.asarray(drawn.get_array())
    assert drawn.get_clim()[1] == pytest.approx(np.median(inside[inside > 0]), rel=1e-12)
    lines = drawn.axes.get_xlabel().split("\n")
    assert lines[0].startswith("$x$, ") and bar.get_ylabel().startswith("$p$, ")
    unit = bar.get_ylabel().split(", ")[1]
    assert " ".join(lines[1:]) == f"colours hold 50 % of non-zero cells; maximum {inside.max():.3g} {unit}"


def test_logarithmic_colours_span_some_decades_or_the_limits():
    values = np.array([0.0, 1e-3, 1.0, 500.0])
    found = colours.choose("pressure", [values], "Pa", colours.Choice(log=True))
    assert isinstance(found.norm, LogNorm) and np.allclose((found.norm.vmin, found.norm.vmax), (0.05, 500.0))
    found = colours.choose("pressure", [values], "Pa", colours.Choice((0.1, 100.0), True))
    assert np.allclose((found.norm.vmin, found.norm.vmax), (0.1, 100.0))
    found = colours.choose("shear_x", [-values], "Pa", colours.Choice(log=True))
    assert isinstance(found.norm, SymLogNorm) and np.isclose(found.norm.linthresh, 0.05)
    assert found.norm.vmin == -found.norm.vmax == pytest.approx(-500.0)
    with pytest.raises(petsam.Error, match="--log colors: no value is positive"):
        colours.choose("pressure", [np.zeros(3)], "Pa", colours.Choice(log=True))
    with pytest.raises(petsam.Error, match="expected a positive lower limit"):
        colours.choose("pressure", [values], "Pa", colours.Choice((0.0, 1.0), True))


@pytest.mark.parametrize(
    "norm, count, expected",
    [
        (LogNorm(0.01, 100.0), 9, [0.01, 0.1, 1, 10, 100]),
        (LogNorm(0.01, 100.0), 3, [0.01, 1, 100]),
        (LogNorm(0.2, 0.9), 4, [0.2, 0.5]),
        (SymLogNorm(0.1, vmin=-10.0, vmax=10.0, base=10), 7, [-10, -1, -0.1, 0, 0.1, 1, 10]),
        (SymLogNorm(0.1, vmin=-10.0, vmax=10.0, base=10), 3, [-10, 0, 10]),
    ],
)
def test_numbers_on_a_logarithmic_bar_do_not_collide(norm, count, expected):
    assert np.allclose(colours.log_ticks(norm, count), expected)


# ---------------------------------------------------------------- layout


def boxes(figure):
    """Places, in pixels, of the maps and of their colour bars."""
    figure.canvas.draw()
    renderer = figure.canvas.get_renderer()
    panels = [axes for axes in figure.axes if axes.images]
    bars = [axes.images[0].colorbar.ax for axes in panels]
    return [[one.get_window_extent(renderer) for one in group] for group in (panels, bars)]


@pytest.mark.parametrize("kind", ["square", "wide", "tall"])
def test_colour_bars_are_as_tall_as_their_maps_and_nothing_overlaps(path, edges, tmp_path, kind):
    file = path if kind == "square" else edges
    if kind == "tall":
        file = tmp_path / "tall.h5"
        file.write_bytes(edges.read_bytes())
        turn(file)
    with petsam.open(file) as results:
        figure = fields.maps([(results, results.of_last())], whole=True)
        panels, bars = boxes(figure)
        assert len(panels) == 4
        for panel, bar in zip(panels, bars):
            assert bar.y0 == pytest.approx(panel.y0, abs=1.0) and bar.y1 == pytest.approx(panel.y1, abs=1.0)
            assert 4 < bar.x0 - panel.x1 < 30 and bar.width < 30
        figure.axes[0].set_title("", loc="left")  # the snapshot's name has a line of its own, over all maps
        extents = [axes.get_tightbbox(figure.canvas.get_renderer()) for axes in figure.axes]
        for k, one in enumerate(extents):
            assert one.x0 > -1 and one.x1 < figure.bbox.width + 1
            assert all(not overlap(one, other) for other in extents[k + 1 :])
        if kind == "wide":
            assert all(panel.width > 6 * panel.height and panel.width > 0.7 * figure.bbox.width for panel in panels)
        if kind == "tall":
            assert all(panel.height > 6 * panel.width for panel in panels)
        for axes in figure.axes:
            for labels in (axes.get_xticklabels(), axes.get_yticklabels()):
                places = [text.get_window_extent() for text in labels if text.get_text() and text.get_visible()]
                inside = [place for place in places if place.width]
                assert all(not overlap(a, b) for a, b in zip(inside, inside[1:]))


def overlap(one, other):
    """Whether two boxes share more than a pixel."""
    width = min(one.x1, other.x1) - max(one.x0, other.x0)
    height = min(one.y1, other.y1) - max(one.y0, other.y0)
    return width > 1.0 and height > 1.0


def turn(path):
    """Exchange x and y of a file's fields."""
    with h5py.File(path, "r+") as file:
        shape = (file["time"].size, file["y"].size, file["x"].size)
        axes = {name: (file[name][:], dict(units="m")) for name in "xy"}
        fields = {name: (file[name][:], file[name].attrs["units"]) for name in file if shape == shape_of(file[name])}
        flags = {name: file["state"].attrs[name] for name in ("flag_values", "flag_meanings")}
        for name in [*axes, *fields, "contact_edge"]:
            del file[name]
        file["x"], file["y"] = axes["y"][0], axes["x"][0]
        for name, (values, units) in fields.items():
            file[name] = np.swapaxes(values, 1, 2)
            file[name].attrs["units"] = units
        file["state"].attrs.update(flags)


def shape_of(data):
    return getattr(data, "shape", None)


@pytest.mark.parametrize(
    "width, height, stretch", [(30.0, 1.0, 2.5), (1.0, 30.0, 0.4), (5.0, 1.0, 1.0), (1.0, 1.0, 1.0)]
)
def test_what_is_very_long_is_stretched_and_says_so(width, height, stretch):
    layout = fields.Layout([{"extent": [0.0, width, 0.0, height]}], 4)
    assert layout.stretch == pytest.approx(stretch) and layout.stacked == (width > 2 * height)
    assert layout.width / layout.height == pytest.approx(width / height / stretch)
    said = {2.5: " ($y$ is stretched 2.5 times)", 0.4: " ($x$ is stretched 2.5 times)"}.get(stretch, "")
    assert layout.remark == said


def test_edges_are_lines_through_the_points_of_the_file(edges):
    with petsam.open(edges) as results:
        points = results.edge("contact_edge")
        assert len(points) > 20
        for axes in fields.maps([(results, results.of_last())]).axes[:2]:
            drawn = [line for line in axes.lines if line.get_gid() == "contact_edge"]
            assert drawn and all(line.get_marker() == "None" and line.get_linestyle() == "-" for line in drawn)
            x, y = np.concatenate([line.get_xydata() for line in drawn]).T
            assert {*np.round(x, 6)} <= {*np.round(1e3 * points[:, 0], 6)} and np.ptp(y) > 0.0


def test_points_of_edges_are_joined_in_their_order():
    turn = np.linspace(0.0, 2.0 * np.pi, 60, endpoint=False)
    ring = np.stack([np.cos(turn), np.sin(turn)], axis=1)
    cell = 2.0 * np.pi / 60
    mixed = ring[np.random.default_rng(1).permutation(60)]
    [line] = outlines.lines(mixed, cell)
    assert len(line) == 61 and np.array_equal(line[0], line[-1])  # closed
    assert np.linalg.norm(np.diff(line, axis=0), axis=1).max() < 1.01 * cell
    open_ring = mixed[np.abs(mixed[:, 1]) < 0.8]  # two arcs
    parts = outlines.lines(open_ring, cell)
    assert sum(map(len, parts)) == len(open_ring) and [len(part) for part in parts] == [len(open_ring) // 2] * 2
    assert all(np.ptp(part[:, 0]) < 0.5 for part in parts)
    assert outlines.lines(ring[:1], cell) == outlines.lines(ring[:0], cell) == []


def test_the_open_surface_has_one_colour_in_all_maps(path):
    with petsam.open(path) as results:
        figure = fields.maps([(results, results.of_last())])
        corners = [panel.images[0].make_image(None, unsampled=True)[0][0, 0] for panel in figure.axes if panel.images]
        state = results.field("state", results.of_last())
        pressure = figure.axes[0].images[0].get_array()
    assert len(corners) == 4 and len({tuple(one) for one in corners}) == 1
    assert pressure.mask.any() and pressure.count() == np.count_nonzero(state)


# ---------------------------------------------------------------- profiles, scalars


def test_profiles_of_chosen_fields(results, path):
    figure = crossings.profiles([(results, results.of_last())], whole=True, names=["gap", "shear_y"], logs=["y"])
    assert [axes.get_title(loc="left") for axes in figure.axes[::2]] == ["gap $g$", "shear $q_y$"]
    row = int(np.argmin(np.abs(results.y)))
    values = figure.axes[0].lines[0].get_ydata()
    with h5py.File(path, "r") as file:
        expected = file["gap"][-1, row]
    assert np.allclose(values / values.max(), expected / expected.max()) and figure.axes[0].get_yscale() == "log"
    figure = crossings.profiles([(results, 0)], names=["pressure"], limits=(0.0, 5e9))
    assert figure.axes[0].get_ylim() == (0.0, 5.0) and figure.axes[0].get_ylabel() == "$p$, GPa"


def test_any_scalar_is_drawn_over_any_other_of_several_files(results, edges):
    with petsam.open(edges, "other") as other:
        axes = series.history([results, other], ["contact_area"], "load_tx").axes[0]
        first, second = axes.lines
        assert np.allclose(first.get_xdata(), results.history["load_tx"]) and axes.get_xlabel() == "$T_x$, N"
        assert np.allclose(first.get_ydata(), 1e6 * results.history["contact_area"])
        assert axes.get_ylabel() == "contact area, mm²"
        assert np.allclose(second.get_ydata(), 1e6 * other.history["contact_area"])
        assert [text.get_text() for text in axes.get_legend().get_texts()] == ["results", "other"]
    assert series.history([results], ["contact_area"], "load_tx").axes[0].get_legend() is None


def test_the_status_is_over_what_has_a_solution(results):
    results.history["status"][-1] = 11
    axes = series.history([results], ["status"], "load_tx").axes[0]
    assert np.allclose(axes.lines[0].get_xdata(), results.history["load_tx"][:-1])
    assert len(series.history([results], ["status"]).axes[0].lines[0].get_xdata()) == results.history["time"].size


def test_many_points_have_no_marks_and_keep_their_extremes():
    assert style.curve(style.MARKED)["marker"] == "." and style.curve(style.MARKED + 1)["marker"] == ""
    assert style.curve(10000)["linewidth"] < style.curve(100)["linewidth"]
    x, y = np.arange(1e5), np.random.default_rng(2).normal(size=100000)
    y[5], y[77777] = 50.0, -60.0
    a, b = style.outlined(x, y)
    assert a.size < 5 * style.BINS and (a[0], a[-1]) == (x[0], x[-1]) and np.all(np.diff(a) > 0)
    assert b.max() == 50.0 and b.min() == -60.0 and np.array_equal(b, y[a.astype(int)])
    assert style.outlined(x[::-1], y)[0].size == x.size  # a loop stays as it is


def test_an_entry_of_the_stiffness_is_a_scalar(solve, draw):
    path = solve(
        dict(CASE, stiffness=True, load_tx=float(AMPLITUDE), load_ty=0.2 * float(AMPLITUDE)), dict(steps=4)
    ).path
    with petsam.open(path) as results:
        axes = series.history([results], ["stiffness.load_ty.disp_x"], "load_tx").axes[0]
        x, y = axes.lines[0].get_data()
        unit = axes.get_ylabel().split()[-1]
    with h5py.File(path, "r") as file:
        expected = file["history/stiffness"][:, 2, 1]
        assert np.allclose(x, file["history/load_tx"])
    assert np.allclose(y * {"N/m": 1.0, "kN/m": 1e3, "MN/m": 1e6}[unit], expected) and np.ptp(expected) > 0
    for name, says in (("stiffness", "is a matrix"), ("stiffness.load_q.disp_x", "stiffness.LOAD.DISPLACEMENT")):
        code, (error,) = draw(path, "--scalar", name)
        assert code == 3 and f"--scalar {name}: " in error and says in error


def test_numbers_of_a_logarithmic_axis_stand_in_a_row():
    with style.plt.rc_context(style.STYLE):
        figure, axes = style.plt.subplots()
        style.logarithmic(axes, "xy")
        axes.set(xlim=(5.0, 60.0), ylim=(5.0, 60.0))
        figure.canvas.draw()
        for axis, upper in ((axes.xaxis, lambda box: box.y1), (axes.yaxis, lambda box: box.x1)):
            labels = [*axis.get_majorticklabels(), *axis.get_minorticklabels()]
            at = [upper(label.get_window_extent()) for label in labels if label.get_text()]
            assert len(at) > 3 and max(at) - min(at) < 0.6  # pixels; antialiasing
        style.plt.close(figure)


def test_numbers_of_a_logarithmic_axis_are_plain():
    figure, axes = plt.subplots()
    axes.plot([30.0, 60.0], [1e-7, 1e7])
    style.logarithmic(axes, ["x", "y"])
    figure.canvas.draw()
    across = [text.get_text() for text in axes.get_xticklabels(minor=True)]
    assert "30" in across and "60" in across and (axes.get_xscale(), axes.get_yscale()) == ("log", "log")
    assert any("10^{6}" in text.get_text() or "10^{7}" in text.get_text() for text in axes.get_yticklabels())


@pytest.mark.parametrize(
    "low, high", [(1e-4, 9e-4), (2e-4, 3e-3), (0.3, 40.0), (1e-6, 1e3), (110.0, 140.0), (1.0, 5.0)]
)
def test_numbers_of_a_logarithmic_axis_do_not_collide(low, high):
    figure, panels = plt.subplots(1, 3, figsize=(13.2, 3.4), constrained_layout=True)
    for axes in panels:
        axes.plot([low, high], [low, high])
        style.logarithmic(axes, ["x", "y"])
    figure.canvas.draw()
    for axis in (panels[1].xaxis, panels[1].yaxis):
        shown = [text for which in (True, False) for text in axis.get_ticklabels(minor=which)]
        inside = [text for text in shown if text.get_text() and text.get_visible()]
        first, last = axis.get_view_interval()
        boxes = [
            text.get_window_extent()
            for text in inside
            if first <= text.get_position()[0 if axis is panels[1].xaxis else 1] <= last
        ]
        assert len(boxes) >= 2
        assert not any(a.overlaps(b) for k, a in enumerate(boxes) for b in boxes[:k])


def test_six_maps_are_drawn_in_two_rows():
    layout = fields.Layout([{"extent": [0.0, 1.0, 0.0, 1.0]}] * 2, 6)
    assert (layout.rows, layout.columns) == (4, 3)
    assert [layout.place(1, k, 6) for k in (0, 2, 3, 5)] == [(2, 0), (2, 2), (3, 0), (3, 2)]
    assert [k for k in range(6) if layout.is_left(k)] == [0, 3]
    assert (fields.Layout([{"extent": [0.0, 1.0, 0.0, 1.0]}], 4).rows, layout.width) == (1, layout.height)


# ---------------------------------------------------------------- the program


@pytest.mark.parametrize(
    "words, name, begin",
    [
        (("--field", "shear_x", "--limits", "-1e7,1e7"), "a.svg", b"<?xml"),
        (("--field", "pressure,slip_y", "--log", "colors"), "a.png", b"\x89PNG"),
        (("--field", "pressure", "--percentile", "99"), "a.pdf", b"%PDF"),
        (("--profiles", "--field", "gap", "--log", "y"), "a.svg", b"<?xml"),
        (("--scalar", "contact_area,stick_area", "--against", "load_tx"), "a.svg", b"<?xml"),
        (("--against", "disp_x", "--log", "x,y"), "a.png", b"\x89PNG"),
    ],
)
def test_one_picture_as_asked_for(draw, path, tmp_path, words, name, begin):
    assert draw(path, *words, "-o", name) == (0, [])
    assert (tmp_path / name).read_bytes().startswith(begin)
    assert [file.name for file in tmp_path.iterdir()] == [name]


def test_maps_of_a_file_without_some_fields_show_the_others(draw, solve, tmp_path):
    some = solve(dict(CASE, output_fields="pressure,gap", load_tx=float(AMPLITUDE))).path
    assert draw(some, "--maps", "--profiles") == (0, [])
    with petsam.open(some) as results:
        figure = fields.maps([(results, 0)])
        assert [axes.get_title() for axes in figure.axes] == ["pressure $p$"]
        rows, columns = results.contact_window(0, margin=0.0)
        inside = np.zeros_like(results.field("pressure"))
        inside[rows, columns] = 1
        assert np.all(inside[results.field("pressure") > 0]) and inside.sum() < 0.7 * inside.size
    bare = tmp_path / "bare.h5"
    bare.write_bytes(some.read_bytes())
    with h5py.File(bare, "r+") as file:
        del file["pressure"], file["gap"]
    code, (error,) = draw(bare, "--maps")
    assert code == 3 and "has no pressure (petsam -output_fields); it has no field at all" in error


def test_norms_are_linear_unless_asked_for(results):
    drawn, _ = image(fields.maps([(results, 0)], names=["pressure"]))
    assert type(drawn.norm) is Normalize

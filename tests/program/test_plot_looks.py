"""Parts of axes, widths, numbers as CSV, several files of fatigue, labels of logarithmic axes."""

import csv

import h5py
import numpy as np
import pytest

import conftest
import petsam
from petsam.core.tables import Column
from petsam.plot import bodies, looks
from petsam.plot.style import STYLE, logarithmic, plt
from petsam.plot.units import bracketed, scale, size_of
from support import ball, few, slide_limit

pytestmark = pytest.mark.usefixtures("closing")
STRESS = conftest.PROGRAM.with_name("petsam-stress")


@pytest.fixture(scope="module")
def folder(launcher, tmp_path_factory):
    """A cycle c.h5, and fatigue of bodies 1 and 2 on a section: one.h5, two.h5."""
    folder = tmp_path_factory.mktemp("looks")
    case = ball(n=32)
    t = float(0.8 * slide_limit(case)[0])
    (folder / "h.csv").write_text(f"time,load_tx,bulk2_stress_xx\n0,0,0\n1,{t},1e7\n2,{-t},-1e7\n3,{t},1e7\n")
    conftest.execute(launcher, folder, [case, dict(history="h.csv", steps=3, output="c.h5")], 1, 0)
    common = dict(input="c.h5", steps="4:9", fatigue="swt,findley", fatigue_findley_k=0.3, quiet=True)
    for name, body in (("one", 1), ("two", 2)):
        run = dict(common, output=f"{name}.h5", body=body, section="y=0", depths="0:3e-4:5")
        conftest.execute(launcher, folder, [run], 1, 0, program=STRESS)
    return folder


@pytest.fixture
def plot(draw, folder, monkeypatch):
    """plot(*words): petsam-plot in the folder; code and messages."""
    monkeypatch.chdir(folder)
    return draw


def table(path):
    with open(path, encoding="utf-8") as file:
        return list(csv.DictReader(file))


def size_in(label):
    """Size of the unit of a label in a table."""
    return size_of(", " + Column.headed(label, "", None).unit)


@pytest.mark.parametrize(
    "text, table",
    [
        ("depth $z$, µm", "depth $z$ [µm]"), ("energy, last step, nJ", "energy, last step [nJ]"), ("t, s", "t [s]"),
        ("$\\Delta K$, MPa m$^{1/2}$", "$\\Delta K$ [MPa m$^{1/2}$]"), ("energy, last step", "energy, last step"),
        ("life, million cycles", "life [million cycles]"), ("creepage, 10⁻³", "creepage [10⁻³]"),
    ],
)  # fmt: skip
def test_a_label_in_a_table_has_its_unit_in_brackets(text, table):
    assert bracketed(text) == table


@pytest.mark.parametrize(
    "text, size",
    [
        ("$x$, µm  at $y$ = 27 µm", 1e-6), ("depth $z$, mm", 1e-3), ("$T_x$, N", 1.0), ("$r$, m", 1.0),
        ("s, MPa", 1e6), ("area, mm²", 1e-6), ("volume, µm³", 1e-18), ("way", 1.0), ("load, kN", 1e3),
        ("R, kJ/m²", 1e3), ("t, s", 1.0),
    ],
)  # fmt: skip
def test_the_unit_of_a_label_has_a_size(text, size):
    assert size_of(text) == pytest.approx(size)


def test_a_loop_is_written_as_it_is_drawn(plot, folder):
    assert plot("--loop", "--cycle", "1", "--csv", "loop.csv", "-o", "loop.png", "c.h5") == (0, [])
    rows = table(folder / "loop.csv")
    with petsam.open(folder / "c.h5") as results:
        cycle = petsam.cycles.find(results).numbered(1)
        force, way = (results.series(name)[cycle.rows] for name in ("load_tx", "disp_x"))
    x, y = (np.array([float(row[name]) for row in rows]) for name in "xy")
    assert x * size_in(rows[0]["x_label"]) == pytest.approx(way) and y == pytest.approx(force)
    assert rows[0]["y_label"].endswith(" [N]") and rows[0]["curve"].startswith("1: ")


def test_maps_and_sections_are_written_with_their_values(plot, folder):
    assert plot("--field", "pressure", "--whole-grid", "--csv", "map.csv", "-o", "map.png", "c.h5") == (0, [])
    rows = [row for row in table(folder / "map.csv") if row["value"]]  # without the points of the edge
    with petsam.open(folder / "c.h5") as results:
        pressure, x, y = results.field("pressure"), results.x, results.y
    assert len(rows) == pressure.size
    values = np.array([[float(row[name]) for name in ("x", "y", "value")] for row in rows])
    assert values[:, 2] == pytest.approx(1e-6 * pressure.ravel(), rel=1e-12)
    length = size_in(rows[0]["x_label"])
    assert length * values[:, 0] == pytest.approx(np.tile(x, y.size)) and length * values[-1, 1] == pytest.approx(y[-1])
    assert plot("--fatigue", "--csv", "f.csv", "-o", "f.png", "one.h5", "two.h5") == (0, [])
    rows = [float(row["value"]) for row in table(folder / "f.csv") if row["value"] and "two: Smith" in row["panel"]]
    with petsam.open(folder / "two.h5") as file:
        swt = file.field("swt")[:, 0]
    assert len(rows) == swt.size and max(rows) == pytest.approx(max(rows) / swt.max() * swt.max())
    assert np.array(rows) / max(rows) == pytest.approx(swt.ravel() / swt.max())


def test_all_pictures_go_into_one_table(plot, folder):
    assert plot("--loop", "--history", "--csv", "all.csv", "c.h5") == (0, [])
    assert len({row["y_label"] for row in table(folder / "all.csv")}) > 2
    assert "would replace the results; --csv gives another name" in plot("--csv", "c.h5", "--loop", "c.h5")[1][0]


def test_fatigue_of_two_files_has_one_scale_per_parameter(folder):
    files = [petsam.open(folder / f"{name}.h5") for name in ("one", "two")]
    figure = bodies.fatigue(files)
    panels = [panel for panel in figure.axes if panel.has_data()]
    assert [panel.get_title().split(": ")[0] for panel in panels] == ["one", "one", "two", "two"]
    limits = [panel.collections[0].get_clim() for panel in panels]
    assert limits[0] == limits[2] and limits[1] == limits[3] and limits[0] != limits[1]
    with h5py.File(folder / "none.h5", "w") as none, h5py.File(folder / "one.h5") as one:
        for name in one:
            one.copy(name, none)
        none.attrs.update(one.attrs)
        del none["findley"], none["swt"]
    with pytest.raises(petsam.Error, match=r"none.h5: has no fatigue parameter \(petsam-stress -fatigue\)"):
        bodies.fatigue([files[0], petsam.open(folder / "none.h5")])


def test_limits_are_in_si_units_and_depth_still_points_down(folder):
    figure = bodies.sections([(petsam.open(folder / "two.h5"), 0)])
    looks.adapt(figure, (-2e-4, 1e-4), (0.0, 1e-4))
    first, second = (panel for panel in figure.axes if panel.has_data())
    assert first.get_xlim() == pytest.approx((-200.0, 100.0)) and first.get_ylim() == pytest.approx((100.0, 0.0))
    assert second.get_ylim() == pytest.approx((100.0, 0.0))  # which has no label of its own


def test_words_of_a_picture_have_their_units(plot, folder):
    for name, limits, part, at, width in (
        ("a", "0,5e7", "-1e-4,1e-4", "1e-5,0", "90"), ("b", "0,50MPa", "-0.1mm,100um", "10um,0", "9cm"),
    ):  # fmt: skip
        words = ("--profiles", "--field", "pressure", "--limits", limits, "--xlim", part, "--at", at, "--width", width)
        assert plot(*words, "-o", name + ".png", "c.h5") == (0, [])
    assert (folder / "a.png").read_bytes() == (folder / "b.png").read_bytes()
    code, err = plot("--profiles", "--xlim", "0,5MPa", "-o", "a.png", "c.h5")
    assert code == 3 and "--xlim, of $x$" in err[0] and "expected a unit of these: m, cm, mm" in err[0]
    code, err = plot("--loop", "--ylim", "0,1mm", "-o", "a.png", "c.h5")
    assert code == 3 and "expected a unit of these: N, kN" in err[0]


def test_a_picture_has_the_given_width(plot, folder):
    assert plot("--field", "pressure,shear", "--width", "90", "--dpi", "254", "-o", "w.png", "c.h5") == (0, [])
    picture = plt.imread(folder / "w.png")
    assert picture.shape[1] == pytest.approx(900, abs=1)
    code, err = plot("--width", "9", "c.h5")
    assert code == 2 and "expected millimetres from 30 to 2000" in err[0]
    assert plot("--xlim", "2,1", "c.h5")[0] == 2


def test_a_picture_for_print_has_more_pixels_of_the_same_size(plot, folder):
    shapes = []
    for dpi in ("100", "300"):
        assert plot("--field", "pressure,shear", "--dpi", dpi, "-o", "print.png", "c.h5") == (0, [])
        shapes.append(plt.imread(folder / "print.png").shape)
    assert shapes[1][:2] == pytest.approx([3 * side for side in shapes[0][:2]], abs=3)
    for dpi in ("9", "1201", "300.5", "high"):
        code, err = plot("--dpi", dpi, "c.h5")
        assert code == 2 and f"--dpi: {dpi}: expected a whole number from 10 to 1200" in err[0]


def test_a_small_number_without_a_unit_is_one_times_a_power_of_ten():
    assert scale("1", 2e-3, powers=True) == (pytest.approx(1e3), "10⁻³") and scale("1", 2e-3) == (1.0, "")
    assert scale("1", 0.5, powers=True) == (1.0, "")
    assert scale("m", 2e-3, powers=True) == (pytest.approx(1e3), "mm")
    assert scale("1", 3e-12, powers=True) == (pytest.approx(1e12), "10⁻¹²")
    assert size_of("creepage $\\xi$, 10⁻³") == pytest.approx(1e-3)


def test_limits_without_data_are_rejected(plot, folder):
    code, err = plot("--field", "pressure", "--xlim", "1,2", "-o", "beyond.png", "c.h5")
    assert code == 3 and "--xlim 1,2: nothing is drawn there: the data reach from -" in err[0]
    assert not (folder / "beyond.png").exists()
    assert plot("--field", "pressure", "--xlim=-1e-5,2", "-o", "w.png", "c.h5")[0] == 0


@few("decades", [0.1, 0.3, 0.6, 1.0, 1.7, 2.5, 4.0, 7.0])
@pytest.mark.parametrize("inches", [2.0, 4.0, 9.0])
@pytest.mark.parametrize("first", [3e-8, 1.0, 2e6])
def test_labels_of_logarithmic_axes_do_not_collide(decades, inches, first):
    with plt.rc_context(STYLE):
        figure, axes = plt.subplots(figsize=(inches, 3.0), layout="constrained")
        x = np.geomspace(first, first * 10.0**decades, 9)
        axes.plot(x, x)
        logarithmic(axes, "xy")
        figure.draw_without_rendering()
        for axis in (axes.xaxis, axes.yaxis):
            low, high = axis.get_view_interval()
            ticks = [*axis.get_major_ticks(), *axis.get_minor_ticks()]
            ticks = [tick for tick in ticks if tick.label1.get_text() and low <= tick.get_loc() <= high]
            boxes = [tick.label1.get_window_extent() for tick in ticks]
            assert boxes and all(not a.overlaps(b) for k, a in enumerate(boxes) for b in boxes[:k])


def test_pictures_refuse_what_they_do_not_draw(folder):
    file = petsam.open(folder / "c.h5")
    for name in (
        "maps",
        "interface",
        "conductance",
        "backbone",
        "band",
        "response",
        "joint_wear",
        "compliance",
        "lives",
        "surface",
    ):
        with pytest.raises(petsam.Error, match=f"{name}: .*expected .*, not a file's name: open it first"):
            getattr(petsam.plot, name)(str(folder / "c.h5"))
        with pytest.raises(petsam.Error, match=f"{name}: expected .*, not int"):
            getattr(petsam.plot, name)(5)
    with pytest.raises(petsam.Error, match="interface: expected Interface, not Results"):
        petsam.plot.interface(file)
    with pytest.raises(petsam.Error, match="maps: expected results of petsam.open"):
        petsam.plot.maps()
    with pytest.raises(petsam.Error, match="--load tz: there are"):
        petsam.plot.loop(file, load="tz")
    with pytest.raises(petsam.Error, match="--percentile 200"):
        petsam.plot.maps(file, percentile=200)

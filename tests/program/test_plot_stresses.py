"""petsam-plot of petsam-stress's files: pictures from true results, what they show, and refusals."""

import sys

import h5py
import numpy as np
import pytest

import conftest
import petsam
from petsam.plot import bodies
from petsam.plot.style import plt
from petsam.plot.units import number
from support import ROOT, ball, finished, slide_limit

PROGRAM = ROOT / "scripts" / "petsam-plot"
STRESS = conftest.PROGRAM.with_name("petsam-stress")


@pytest.fixture(scope="module")
def folder(launcher, tmp_path_factory):
    """A folder with strokes of a ball, their stresses on a section (section.h5) and on planes (maps.h5)."""
    folder = tmp_path_factory.mktemp("stresses")
    case = ball(n=40)
    t = float(0.8 * slide_limit(case)[0])
    (folder / "h.csv").write_text(f"time,load_tx\n1,{t}\n2,{-t}\n3,{t}\n")
    conftest.execute(launcher, folder, [case, dict(history="h.csv", steps=2, output="c.h5")], 1, 0)
    common = dict(input="c.h5", steps="3:6", fatigue="swt,ruiz", quiet=True)
    for options in (
        dict(output="section.h5", section="y=0", depths="0:4e-4:9"),
        dict(output="column.h5", section="x=1e-4", depths="0:4e-4:9"),
        dict(output="maps.h5", depths="0,1e-4"),
    ):
        conftest.execute(launcher, folder, [dict(common, **options)], 1, 0, program=STRESS)
    return folder


@pytest.fixture
def plot(folder):
    def run(*words, check=0):
        return finished([sys.executable, str(PROGRAM), *map(str, words)], check=check, cwd=folder)

    return run


@pytest.mark.parametrize(
    "name, kinds",
    [
        ("section", ("sections", "profiles", "fatigue")),
        ("column", ("sections", "profiles", "fatigue")),
        ("maps", ("maps", "profiles", "fatigue")),
    ],
)
def test_all_that_a_file_is_good_for_is_drawn(plot, folder, name, kinds):
    done = plot(f"{name}.h5")
    assert done.stdout.split() == [word for kind in kinds for word in ("wrote", f"{name}_{kind}.png")]
    assert all((folder / f"{name}_{kind}.png").stat().st_size > 5000 for kind in kinds)


def test_steps_and_components_are_chosen(plot, folder):
    plot("--sections", "--component", "xz", "--step", "3,-1", "-o", "two.pdf", "section.h5")
    assert (folder / "two.pdf").read_bytes().startswith(b"%PDF")
    plot("--profiles", "--time", "2", "-o", "at.png", "section.h5", "maps.h5")


def test_planes_are_chosen_and_principal_stresses_drawn(plot, launcher, folder):
    run = dict(input="c.h5", output="many.h5", depths="0:3e-4:9", quantities="principal,shear_max", quiet=True)
    conftest.execute(launcher, folder, [run], 1, 0, program=STRESS)
    file = petsam.open(folder / "many.h5")
    assert len(bodies.maps([(file, 0)], "principal_1").axes) == bodies.PLANES
    assert len(bodies.maps([(file, 0)], "shear_max", [1e-4, 2e-4]).axes) == 2
    assert "has no stress_xx" in plot("--maps", "many.h5", check=3).stderr
    plot("--sections", "--component", "shear_max", "many.h5")


def test_limits_are_those_of_the_component_and_nothing_is_cut_off(folder):
    file = petsam.open(folder / "maps.h5")
    figure = bodies.maps([(file, 0)], "xz", None, (-2e6, 3e6))
    first, second = (axes.images[0] for axes in figure.axes[:2])
    assert np.allclose(second.get_clim(), (-2.0, 3.0)) and second.colorbar.ax.get_ylabel().endswith(", MPa")
    with h5py.File(folder / "maps.h5") as f:
        assert first.get_clim() == pytest.approx((0.0, 1e-6 * f["mises"][0].max()), rel=1e-6)
    figure.canvas.draw()
    for axes in figure.axes:
        box, bar = axes.get_tightbbox(), axes.images[0].colorbar.ax.get_window_extent()
        assert box.x0 >= 0 and box.x1 <= figure.bbox.width and box.y0 >= 0 and box.y1 <= figure.bbox.height
        assert bar.y0 == pytest.approx(axes.get_window_extent().y0, abs=1.0)
        assert bar.y1 == pytest.approx(axes.get_window_extent().y1, abs=1.0)
    image = bodies.sections([(petsam.open(folder / "section.h5"), 0)], "xz", limits=(-2e6, 2e6)).axes[-1]
    assert image.collections[0].get_clim() == pytest.approx((-2.0, 2.0))


def test_profile_is_the_stress_on_the_surface(folder):
    file = petsam.open(folder / "maps.h5")
    figure = bodies.profiles([(file, 1)], "yy", (0.0, 1e-4))
    x, y = figure.axes[0].lines[0].get_data()
    with h5py.File(folder / "maps.h5") as f:
        row = int(np.argmin(abs(f["y"][:] - 1e-4)))
        expected = f["stress_yy"][1, 0, row]
        assert np.allclose(y / np.abs(y).max(), expected / np.abs(expected).max(), rtol=1e-12)
        assert np.allclose(x / x.max(), f["x"][:] / f["x"][:].max())
    assert "MPa" in figure.axes[0].get_ylabel() and abs(y).max() == pytest.approx(abs(expected).max() / 1e6)


@pytest.mark.parametrize("name", ["section", "column", "maps"])
def test_fatigue_names_the_largest_value_and_its_place(folder, name):
    file = petsam.open(folder / f"{name}.h5")
    figure = bodies.fatigue([file])
    title = figure.axes[0].get_title().replace("\N{MINUS SIGN}", "-")
    with h5py.File(folder / f"{name}.h5") as f:
        swt = f["swt"][:1] if name == "maps" else f["swt"][:]
        z, y, x = np.unravel_index(np.argmax(swt), swt.shape)
        along = f["y"][y] if name == "column" else f["x"][x]
    assert f"{swt.max() / 1e3:.4g} kPa" in title and f"= {1e6 * along:.4g} µm" in title
    assert "Ruiz" in figure.axes[1].get_title()


def test_numbers_of_contours_lie_neither_on_one_another_nor_on_the_mark(folder):
    file = petsam.open(folder / "section.h5")
    found = 0
    for figure in (bodies.fatigue([file]), bodies.sections([(file, 1), (file, 2)], "zz")):
        figure.canvas.draw()
        for axes in figure.axes:
            room = axes.get_window_extent()
            boxes = [text.get_window_extent() for text in axes.texts if text.get_gid() == bodies.LABEL]
            found += len(boxes)
            marks = [line.get_window_extent() for line in axes.lines if line.get_gid() == bodies.MARK]
            for k, box in enumerate(boxes):
                assert room.x0 - 1 <= box.x0 and box.x1 <= room.x1 + 1 and box.y1 <= room.y1 + 1
                assert not any(box.overlaps(other) for other in [*boxes[k + 1 :], *marks])
    assert found > 5


def test_numbers_on_one_another_are_taken_away():
    figure, axes = bodies.plt.subplots()
    axes.set(xlim=(0, 1), ylim=(0, 1))
    bodies.cross(axes, 0.2, 0.2, bodies.MARK)
    for x, y, text in (
        (0.5, 0.5, "kept"),
        (0.505, 0.505, "on it"),
        (0.2, 0.2, "marked"),
        (0.999, 0.8, "out"),
        (0.8, 0.8, "far"),
    ):
        axes.text(x, y, text, gid=bodies.LABEL)
    axes.text(0.5, 0.5, "no label")
    bodies.untangle(figure)
    assert [text.get_text() for text in axes.texts] == ["kept", "far", "no label"]


def test_the_mark_of_a_curve_does_not_hide_it_and_titles_have_units(folder):
    axes = bodies.fatigue([petsam.open(folder / "section.h5")]).axes[1]  # Ruiz is on the surface only
    curve, mark = axes.lines
    assert mark.get_marker() == "o" and mark.get_markerfacecolor() == "none"
    assert mark.get_xydata()[0] == pytest.approx(curve.get_xydata()[np.argmax(curve.get_ydata())])
    maps = petsam.open(folder / "maps.h5")
    for axes in bodies.maps([(maps, 0)], "zz").axes:
        assert axes.get_title().splitlines()[0].endswith(" MPa")


def test_the_last_step_needs_no_name_and_others_have_theirs(folder):
    file, other = (petsam.open(folder / f"{name}.h5") for name in ("section", "column"))
    last = file.of_last()

    def said(*steps):
        return [axes.get_title() for axes in bodies.sections(list(steps)).axes if axes.get_title()]

    assert not any("step" in title or "t =" in title for title in said((file, last)))
    assert all(title.endswith("step 3, t = 1.5 s") for title in said((file, 0)))
    assert all("step" in title for title in said((file, 0), (file, last)))
    assert ["section, step" in title for title in said((file, last), (other, last))] == [True] * 2 + [False] * 2
    named = petsam.open(folder / "section.h5", "mine")
    assert all("mine, step 6" in title for title in said((named, last)))


def test_numbers_in_texts_have_the_minus_sign_of_the_axes(folder):
    assert number(-0.00123) == "\u22120.00123" and number(-1e-7, 3) == "\u22121e\u221207" and number(20.0) == "20"
    title = bodies.sections([(petsam.open(folder / "section.h5"), 0)], "xx").axes[1].get_title()
    assert "minimum \u2212" in title and "minimum -" not in title


def test_a_layer_that_few_contours_cross_has_its_own():
    figure, axes = plt.subplots()
    along, z = np.linspace(0.0, 1.0, 5), np.append(np.linspace(0.0, 1.0, 9), np.linspace(1.0, 2.0, 9))
    stress = np.outer(np.where(np.arange(18) < 9, 1.0, 0.1), np.linspace(-700.0, 700.0, 5))
    bodies._contours(axes, along, z, stress, -700.0, 700.0, "viridis")
    upper, lower = ({float(text.get_text().replace("\u2212", "-")) for text in part} for part in halves(axes))
    assert {-400.0, 0.0, 400.0} <= upper and len(lower) >= 2 and max(map(abs, lower)) <= 70.0
    plt.close(figure)


def halves(axes):
    """Numbers on the contours above and below the depth of 1."""
    return ([one for one in axes.texts if (one.get_position()[1] > 1.0) == below] for below in (False, True))


def test_open_knows_the_file_by_its_content(folder):
    assert isinstance(petsam.open(folder / "c.h5"), petsam.Results)
    file = petsam.open(folder / "section.h5")
    assert isinstance(file, petsam.Stresses) and file.along == "x" and file.fatigue == ["swt", "ruiz_1", "ruiz_2"]
    assert file.field("mises").shape == (9, 1, 40) and file.field("swt").shape == (9, 1, 40)
    assert file.field("mises", 0, slice(2, 4)).shape == (2, 1, 40) and file.unit("swt") == "Pa"
    assert file.history["mises_max"].size == 4 and file.parameters["body"] == 2
    with pytest.raises(petsam.Error, match="index 500: 4 steps are saved, indices 0 to 3"):
        file.field("mises", 500)
    with pytest.raises(petsam.Error, match="has no stress_xv: is stress_.. meant. It has "):
        file.field("stress_xv")
    with pytest.raises(petsam.Error, match="has no crossland"):
        file.field("crossland")
    with pytest.raises(petsam.Error, match="holds no results"):
        petsam.Snapshot(file)


def test_stresses_are_had_by_name(folder):
    """As those of a run: of all steps at once, with depth, y and x."""
    found = petsam.open(folder / "maps.h5")
    stress = found["stress_xx"]
    assert stress.shape == found.shape and np.array_equal(stress[-1], found.field("stress_xx"))
    assert np.array_equal(found["step"], found.steps)
    with pytest.raises(petsam.Error, match="has no stress_xz_: is stress_xz meant"):
        found["stress_xz_"]
    with pytest.raises(petsam.Error, match="1 is no name"):
        found[1]


@pytest.mark.parametrize(
    "words, says",
    [
        (("--loop", "section.h5"), "--loop"),
        (("--sections", "c.h5"), "--sections"),
        (("section.h5", "c.h5"), "do not go into one picture"),
        (("--maps", "section.h5"), "holds a section"),
        (("--step", "2", "section.h5"), "has the steps 3, 4, 5, 6"),
        (("--time", "9", "section.h5"), "from 1.5 to 3"),
        (("--fatigue", "section.h5", "maps.h5"), "sections and maps do not go into one picture"),
    ],
)
def test_pictures_that_cannot_be_are_refused(plot, words, says):
    done = plot(*words, check=3)
    assert says in done.stderr and len(done.stderr.splitlines()) == 1


def test_damaged_file_is_named(plot, folder):
    data = bytearray((folder / "section.h5").read_bytes())
    (folder / "short.h5").write_bytes(data[: len(data) // 3])
    assert "short.h5" in plot("short.h5", check=3).stderr

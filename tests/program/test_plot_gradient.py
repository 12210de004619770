"""petsam-plot --gradient: where a micrometre counts, maps of cells and curves of plane problems."""

import shutil

import h5py
import numpy as np
import pytest

import petsam as library  # beside the fixture petsam, which runs the program
from petsam.plot import gradients
from support import ball, history
from test_plane import CYLINDER

pytestmark = pytest.mark.usefixtures("closing")

WANTED = dict(slip_direction="end", errors="none", steps=2)


@pytest.fixture(scope="module")
def path(solve, tmp_path_factory):
    """A sphere with a tangential load and back."""
    rows = history(tmp_path_factory.mktemp("history") / "h.csv", "time,load_tx", (0, 0.0), (1, 30.0), (2, -30.0))
    return solve(dict(ball(n=32, half_width=2.5), gradient="energy,disp_x"), WANTED, rows).path


@pytest.fixture(scope="module")
def plane(solve):
    """A cylinder with a tangential load in plane strain."""
    return solve(dict(CYLINDER, grid_n=60, load_tx=2e4, gradient="energy"), WANTED).path


def test_a_file_with_gradients_has_their_picture(draw, path, tmp_path):
    assert draw(path) == (0, [])
    assert {file.name for file in tmp_path.glob("*.png")} == {
        f"results_{kind}.png" for kind in ("gradient", "history", "loop", "maps", "profiles")
    }
    assert draw("--report", "page.html", path) == (0, [])
    assert "Where a micrometre counts" in (tmp_path / "page.html").read_text()


def test_maps_are_changes_by_a_patch_in_colours_about_zero(results):
    figure = gradients.gradient([results], whole=True)
    panels = [panel for panel in figure.axes if panel.images]
    assert len(panels) == 4 and results.history["contact_area"].max() > 1e-6  # of which 1 % is a patch
    cell = (results.x[1] - results.x[0]) * (results.y[1] - results.y[0])
    found = results.gradients["energy"]
    assert found.unit == "J" and results.gradients["disp_x"].unit == "m"
    for panel, values, change in zip(panels[2:], (found.gap, found.friction), (1e-6, 0.01)):
        drawn = panel.images[0]
        assert np.asarray(drawn.get_array()) == pytest.approx(
            values * change * 1e-8 / cell / found.value * 100, rel=1e-9
        )
        assert drawn.norm.vmin == -drawn.norm.vmax and drawn.get_cmap().name == "RdBu_r"
        assert "100 µm x 100 µm" in panel.get_title("left") and panel.get_title("left").startswith("energy: ")
        assert {line.get_gid() for line in panel.lines} == {"contact_edge", "stick_edge"}
    part = next(panel.images[0] for panel in gradients.gradient([results]).axes if panel.images)
    assert 0 < part.get_array().size < 0.8 * found.gap.size


def test_a_number_that_is_zero_changes_by_its_own_unit(path, tmp_path):
    with h5py.File(shutil.copy(path, tmp_path / "zero.h5"), "r+") as file:
        file["gradient/disp_x"].attrs["value"] = 0.0
    with library.open(tmp_path / "zero.h5") as results:
        images = [image for panel in gradients.gradient([results]).axes for image in panel.images]
    assert [image.colorbar.ax.get_ylabel()[-1] for image in images] == ["m", "m", "%", "%"]


def test_plane_problems_have_curves(draw, plane, path, tmp_path):
    assert draw(plane, "--gradient", "--csv", "numbers.csv") == (0, [])
    with library.open(plane) as results:
        figure = gradients.gradient([results])
        found = results.gradients["energy"]
        step = results.x[1] - results.x[0]
    for panel, values, change in zip(figure.axes, (found.gap, found.friction), (1e-6, 0.01)):
        line = panel.lines[-1].get_ydata()
        assert np.abs(line).max() == pytest.approx(np.abs(values).max() * change * 1e-6 / step / found.value * 100)
        assert "a strip of 1 µm" in panel.get_title("left") and len(panel.lines) == 6
    assert found.unit == "J/m" and len(figure.axes) == 2
    code, (error,) = draw("--gradient", path, plane)
    assert code == 3 and "plane problems do not go into a picture of others" in error


def test_a_file_without_gradients_is_named(draw, solve):
    code, (error,) = draw("--gradient", solve(ball(n=24), dict(load_tx=20.0)).path)
    assert code == 3 and "has no gradient by gap and friction: use petsam -gradient NAME" in error


def test_a_file_of_a_run_that_was_killed_before_its_gradients_is_named(draw, path, tmp_path):
    shutil.copy(path, tmp_path / "killed.h5")
    with h5py.File(tmp_path / "killed.h5", "r+") as file:
        file.attrs["closed"] = 0
        for name in list(file["gradient"]):
            del file["gradient"][name]
    code, (error,) = draw("--gradient", tmp_path / "killed.h5")
    assert code == 3 and "a run writes to it, or was killed, and derivatives come at its end" in error
    with library.open(tmp_path / "killed.h5") as results:
        assert results.gradients == {} and len(results.history["time"])


def test_a_derivative_that_is_0_everywhere_has_the_middle_colour(solve):
    """That of the norm of the pressure by friction, of similar bodies."""
    results = solve(dict(ball(n=24, half_width=2.5), load_tx=30.0, gradient="pressure_norm"), WANTED)
    figure = gradients.gradient([library.open(results.path)])
    image = [image for panel in figure.axes for image in panel.images][1]
    assert not np.any(image.get_array()) and image.norm.vmin == -image.norm.vmax

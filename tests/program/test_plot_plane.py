"""petsam-plot of plane problems: lines over x, without an empty dimension."""

import pytest

from support import history
from test_plane import CYLINDER, N


@pytest.fixture(scope="module")
def file(launcher, tmp_path_factory):
    import conftest

    folder = tmp_path_factory.mktemp("plane")
    rows = history(folder / "h.csv", "time,load_n,load_tx", (0.0, N, 0.0), (1.0, N, 2e4), (3.0, N, -2e4), (4.0, N, 0.0))
    case = dict(CYLINDER, load_n=None, grid_n=60, wear_coefficient2=1e-13, wear_cycles=100, steps=4, output="life.h5")
    conftest.execute(launcher, folder, [case, rows], 1, 0)
    return folder / "life.h5"


def test_kinds_are_those_of_lines(draw, file, tmp_path):
    assert draw(file) == (0, [])
    assert {path.name for path in tmp_path.glob("*.png")} == {
        f"life_{kind}.png" for kind in ("profiles", "scar", "life", "fretting-log")
    }


def test_profiles_and_scars_have_one_column(file):
    import petsam
    from petsam.plot import crossings, wear

    one = petsam.open(str(file))
    for figure in (crossings.profiles([(one, -1)]), wear.scar([(one, -1)])):
        places = {round(panel.get_position().x0, 2) for panel in figure.axes if panel.lines}
        assert len(places) == 1
        assert all("y" not in panel.get_xlabel() for panel in figure.axes)


def test_maps_are_refused_and_a_field_is_a_profile(draw, file, tmp_path):
    code, (error,) = draw("--maps", file)
    assert code == 3 and "--maps: is a plane problem, one row of cells: use --profiles" in error
    assert draw("--field", "shear_x", "-o", "q.png", file) == (0, []) and (tmp_path / "q.png").exists()

"""Depths in half widths of the contact: -depths 0.5a."""

import h5py
import numpy as np
import pytest

from support import SPHERE, hertz
from test_plane import CYLINDER, A
from test_shapes import INF, STEEL, elliptic_hertz, relative


def depths(path):
    with h5py.File(path) as f:
        return f["z"][:]


def test_of_a_sphere_they_are_in_hertzs_radius(petsam, stress, tmp_path):
    """In the step with the largest contact, printed; the maximum von Mises stress lies 0.48 a deep."""
    (tmp_path / "h.csv").write_text("time,load_n\n1,500\n2,1000\n3,100\n")
    petsam(dict(SPHERE, load_n=None, history="h.csv", output="r.h5"))
    case = dict(input="r.h5", depths="0:1.2a:61", section="y=0", steps="all")
    done = stress(dict(case, output="s.h5"))
    a = hertz(SPHERE).radius
    z = depths(tmp_path / "s.h5")
    assert z == pytest.approx(np.linspace(0, 1.2 * a, 61), rel=2e-3)
    assert "half width (smaller half axis) of the contact of step 2" in done.stdout
    with h5py.File(tmp_path / "s.h5") as f:
        assert f["history/mises_max_z"][1] == pytest.approx(0.48 * a, abs=0.02 * a)
    stress(dict(case, output="ranks.h5"), ranks=3)
    assert (depths(tmp_path / "ranks.h5") == z).all()
    stress(dict(case, output="m.h5", depths="0,0.1a,1e-4,1a", steps="last", section=None))
    last = depths(tmp_path / "m.h5")
    assert last[[0, 2]].tolist() == [0, 1e-4] and last[3] == pytest.approx(a * 0.1 ** (1 / 3), rel=5e-3)


@pytest.mark.parametrize("angle", [0, 30, 90])
def test_of_an_ellipse_they_are_in_its_smaller_half_axis(petsam, stress, tmp_path, angle):
    radii = (0.1, 0.4, INF, INF)
    least, most, _ = relative(*radii, 0)
    a, b, *_ = elliptic_hertz(300.0, least, most)
    turned = dict(gap_radius2_x=0.1, gap_radius2_y=0.4, gap_angle=angle)
    petsam(dict(STEEL, gap_type="curved", **turned, load_n=300.0, grid_n=90, grid_size=2.4 * a, output="r.h5"))
    stress(dict(input="r.h5", output="s.h5", depths="0,1a"))
    assert depths(tmp_path / "s.h5")[1] == pytest.approx(b, rel=0.01)


def test_in_plane_strain_they_are_in_half_the_length(petsam, stress, tmp_path):
    petsam(dict(CYLINDER, output="r.h5"))
    assert "-depths" in stress(dict(input="r.h5", output="s.h5", depths="0,0.5a-"), check=2).stderr
    stress(dict(input="r.h5", output="s.h5", depths="0.5a,1a"))
    assert depths(tmp_path / "s.h5") == pytest.approx([0.5 * A, A], rel=1e-3)


def test_mistakes_in_depths_are_explained(petsam, stress, tmp_path):
    petsam(dict(SPHERE, load_n=None, disp_z=-1e-6, load_tx=None, output="apart.h5"))
    petsam(dict(SPHERE, output="r.h5"))
    for options, says in (
        (
            dict(input="apart.h5", depths="0,1a"),
            ["-depths", "no chosen step of -input apart.h5", "give depths in m, or other"],
        ),
        (dict(input="r.h5", depths="0,1a,1e-6"), ["-depths 0,1a,1e-6", "1e-06 follows", "increase"]),
        (dict(input="r.h5", depths="0,0.5b"), ["-depths 0,0.5b", "or as 0.5a in half widths"]),
        (dict(input="r.h5", depths="0,a"), ["-depths 0,a", "or as 0.5a in half widths"]),
    ):
        line = stress(options, dict(output="s.h5"), check=2).stderr.splitlines()[0]
        assert all(text in line for text in says), line
    assert not (tmp_path / "s.h5").exists()


@pytest.mark.parametrize("depths", ["nan", "inf", "0,nan", "nana", "1e400a", "nan:1e-4:3", "0:infa:3"])
def test_a_depth_that_is_no_finite_number_is_told_as_it_is_written(petsam, stress, depths):
    """Also of results without contact, of which no half width is known."""
    petsam(dict(SPHERE, load_n=0, output="r.h5"))
    done = stress(dict(input="r.h5", output="s.h5", depths=depths), check=2)
    assert f"-depths {depths}: expected depths" in done.stderr

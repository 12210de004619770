"""The finite element comparison: a coarse mesh in CalculiX, petsam and the closed solutions at equal force."""

import os
import shutil
import sys
from argparse import Namespace

import numpy as np
import pytest

import support
from conftest import PROGRAM

sys.path.insert(0, str(support.ROOT / "examples" / "fe-comparison"))
import compare  # noqa: E402
import figures  # noqa: E402

CCX = os.environ.get("CCX", "ccx")
needs_calculix = pytest.mark.skipif(not shutil.which(CCX), reason=f"no CalculiX {CCX}: Debian package calculix-ccx")


def options(directory):
    """Of compare.py, for its functions."""
    return Namespace(directory=str(directory), ccx=CCX, petsam=str(PROGRAM), keep=False)


@pytest.fixture(scope="module")
def normal(tmp_path_factory):
    """Table 1's sphere on 8 elements along the cube's edge, and petsam at the force that came out."""
    directory = tmp_path_factory.mktemp("fe")
    surface = compare.solve_mesh(options(directory), "mesh", 8)
    compare.solve_petsam(options(directory), "petsam", 96, surface)
    mesh = figures.Mesh(str(directory), "mesh")
    return mesh, figures.Grid(str(directory), "petsam", mesh)


@needs_calculix
def test_calculix_petsam_and_hertz_agree_on_the_peak_pressure(normal):
    mesh, grid = normal
    peaks = np.array([mesh.pressure.max(), grid["pressure"].max(), mesh["hertz_peak"]])
    assert np.ptp(peaks) <= 0.03 * mesh["hertz_peak"]


@needs_calculix
def test_calculix_petsam_and_hertz_agree_on_the_contact_radius_within_an_element(normal):
    mesh, grid = normal
    radii = np.array([mesh["contact_radius"], np.sqrt(grid["contact_area"] / np.pi), mesh["hertz_radius"]])
    assert np.ptp(radii) <= mesh["element_size"]


@needs_calculix
def test_pressure_of_calculix_is_hertz_over_the_whole_contact(normal):
    # measured 1.4e-2 with elements of 0.16 a; the extrapolated CPRESS is off by 0.14
    assert normal[0].l2("pressure", "hertz_pressure") <= 0.03


@needs_calculix
def test_forces_from_the_stresses_carry_the_load(normal):
    mesh = normal[0]
    # seven digits are printed
    assert mesh["parts"] * np.sum(mesh.area * mesh.pressure) == pytest.approx(mesh["load_n"], rel=1e-5)


@pytest.fixture(scope="module")
def sheared(tmp_path_factory):
    """Both spheres with friction on a coarse mesh, pushed along x by what takes about 0.6 mu N."""
    directory = tmp_path_factory.mktemp("fe")
    compare.solve_mesh(options(directory), "tangential", 4, tangential=4.165e-4)
    return figures.Mesh(str(directory), "tangential")


@needs_calculix
def test_shear_of_calculix_is_cattaneos_at_equal_force(sheared):
    # measured 0.067 with elements of 0.31 a, most of it at the edges of contact and stick
    assert 0.5 < sheared["load_tx"] / (sheared["friction"] * sheared["load_n"]) < 0.7
    assert sheared.l2("shear_x", "cattaneo") <= 0.12


@needs_calculix
def test_shear_of_calculix_obeys_coulomb(sheared):
    # the surface is inclined by a/R at most, and nodal forces are in the directions of the axes
    assert np.all(sheared.shear_x <= sheared["friction"] * (sheared.pressure + 5e-3 * sheared["hertz_peak"]))


def test_a_missing_calculix_is_one_line_with_its_package(tmp_path):
    done = support.finished(
        [str(support.ROOT / "examples" / "fe-comparison" / "run.sh")],
        check=1,
        env=dict(os.environ, CCX="no-such-ccx", PETSAM=str(PROGRAM), PYTHON=sys.executable, OUT=str(tmp_path)),
    )
    assert done.stderr.count("\n") == 1 and "no-such-ccx" in done.stderr and "calculix-ccx" in done.stderr

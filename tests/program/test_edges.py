"""Edges of contact and stick: areas, points and values at the centres, which fields are saved, and the correction."""

import re

import h5py
import numpy as np
import pytest

import petsam as package
from support import SPHERE, closed, elliptic_hertz, hertz, slide_limit

USUAL = {"pressure", "shear_x", "shear_y", "slip_x", "slip_y", "state"}
SCALES = {"x", "y", "time", "point", "coordinate"}
OTHERS = SCALES | {"warnings"}  # datasets beside the fields
NAMES = "pressure,pressure_center,shear_center_x,contact_edge,stick_edge"
SLIP = dict(SPHERE, body1_poisson=0.0, body2_poisson=0.0, grid_n=90, output_fields=NAMES)


def cattaneo(share, **more):
    """A partial-slip case with closed solution, T_x = share mu N, and the stick radius in contact radii."""
    case = dict(SLIP, **more)
    case["load_tx"] = share * slide_limit(case)[0]
    return case, (1 - share) ** (1 / 3)


# ---------------------------------------------------------------- fields


def fields(path):
    with h5py.File(path, "r") as file:
        return {name for name in file if isinstance(file[name], h5py.Dataset)} - OTHERS


def test_usual_fields_are_saved_unless_others_are_asked_for(petsam, tmp_path):
    case = dict(SPHERE, grid_n=24, output_fields=None, output="out.h5")
    petsam(case)
    assert fields(tmp_path / "out.h5") == USUAL
    petsam(dict(case, output_fields="gap,state,shear_center_y"))
    assert fields(tmp_path / "out.h5") == {"gap", "state", "shear_center_y"}
    petsam(dict(case, output_fields="none"))
    assert fields(tmp_path / "out.h5") == set()
    petsam(dict(case, output_fields="all"))
    assert fields(tmp_path / "out.h5") > USUAL | {"displacement_z", "pressure_center", "stick_edge"}
    with h5py.File(tmp_path / "out.h5", "r") as file:
        assert all("units" in file[name].attrs for name in fields(tmp_path / "out.h5"))


def test_unknown_field_is_refused_with_the_names_there_are(petsam, tmp_path):
    said = petsam(dict(SPHERE, output="out.h5", output_fields="pressure,sheer_x"), check=2).stderr
    assert "-output_fields" in said and "sheer_x" in said and "shear_center_y" in said
    assert not (tmp_path / "out.h5").exists()
    for names in ("none,pressure", "all,none"):
        assert "none" in petsam(dict(SPHERE, output_fields=names), check=2).stderr
    assert "wear_depth2" in petsam(dict(SPHERE, output_fields="pressure,wear_depth2"), check=2).stderr
    petsam(dict(SPHERE, grid_n=24, output="out.h5", output_fields="pressure, gap"))
    assert fields(tmp_path / "out.h5") == {"pressure", "gap"}


def test_file_without_fields_is_drawn_as_far_as_it_goes(petsam, draw, tmp_path):
    (tmp_path / "h.csv").write_text("time, load_tx\n1, 50\n2, -50\n3, 20\n")
    case = dict(SPHERE, grid_n=24, history="h.csv", output="out.h5", output_fields="contact_edge")
    petsam(case)
    assert draw("out.h5") == (0, [])
    assert {path.name for path in tmp_path.glob("*.png")} == {"out_loop.png", "out_history.png"}
    code, said = draw("--maps", "out.h5")
    assert code != 0 and "-output_fields" in said[0]


# ---------------------------------------------------------------- edges


@pytest.mark.parametrize("ranks", [1, 2, 3])
def test_points_lie_on_the_circles(solve, ranks):
    case, c = cattaneo(0.6)
    r = solve(case, ranks=ranks)
    a = hertz(case).radius
    with package.open(r.path) as results:
        for name, radius in (("contact_edge", a), ("stick_edge", c * a)):
            points = results.edge(name)
            assert points.shape[0] > 60
            assert np.abs(np.hypot(*points.T) / radius - 1).max() < 3e-3
        alone = package.open(solve(case).path)
        assert np.array_equal(results.file["stick_edge"][:], alone.file["stick_edge"][:], equal_nan=True)
        alone.close()


def test_every_step_has_its_own_points(petsam, tmp_path):
    (tmp_path / "h.csv").write_text("time, load_n\n1, 1000\n2, 300\n3, 700\n")
    case = dict(SPHERE, load_n=None, history="h.csv", output="out.h5", output_fields="contact_edge")
    petsam(case)
    with package.open(tmp_path / "out.h5") as results:
        for step, area in enumerate(results.history["contact_area"]):
            radii, radius = np.hypot(*results.edge("contact_edge", step).T), np.sqrt(area / np.pi)
            assert np.allclose(radii, radius, rtol=3e-3)
            assert radii.size > 6 * radius / (case["grid_size"] / case["grid_n"])  # all round


def test_areas_and_peak_are_cattaneos(solve):
    case, c = cattaneo(0.6)
    r, h = solve(case), hertz(case)
    assert r["contact_area"] == pytest.approx(np.pi * h.radius**2, rel=3e-4)
    assert r["stick_area"] == pytest.approx(np.pi * (c * h.radius) ** 2, rel=1e-3)
    assert r["shear_max"] == pytest.approx(case["friction"] * h.pressure * np.sqrt(1 - c**2), rel=6e-4)
    assert r["edge_accepted"] == 1


def test_values_at_the_centres_are_nearer_to_the_exact_ones_than_the_means(solve):
    case, c = cattaneo(0.6)
    r, h = solve(case), hertz(case)
    with h5py.File(r.path, "r") as file:
        radius = np.hypot(file["x"][:][None, :], file["y"][:][:, None])
        p = closed.hertz_pressure(radius, h.radius, h.pressure)
        q = case["friction"] * (p - closed.hertz_pressure(radius, c * h.radius, c * h.pressure))
        error = {
            name: np.linalg.norm(file[name][-1] - exact) / np.linalg.norm(exact)
            for name, exact in (("pressure", p), ("pressure_center", p), ("shear_center_x", q))
        }
    assert error["pressure_center"] < error["pressure"] / 5
    assert error["shear_center_x"] < 2e-3


def test_counted_areas_are_whole_cells(solve):
    case, _ = cattaneo(0.6, edges="none")
    r = solve(case)
    cell = (case["grid_size"] / case["grid_n"]) ** 2
    for name in ("contact", "stick"):
        assert r[f"{name}_area"] == pytest.approx(r[f"{name}_cells"] * cell, rel=1e-12, abs=0)


def test_shear_of_pressing_alone_is_none(solve):
    r = solve(dict(SPHERE, grid_n=48))
    assert r["shear_max"] <= 1e-9 * hertz(SPHERE).pressure


def test_width_of_the_slip_zone_is_its_area_over_the_edge(solve):
    """Of two concentric circles, below the width of a cell too."""
    for share in (0.5, 0.05):
        case, c = cattaneo(share)
        r = solve(case)
        assert r["slip_width"] == pytest.approx(hertz(case).radius * (1 - c**2) / 2, rel=0.02)


@pytest.mark.parametrize("ranks", [1, 2, 3])
def test_half_widths_are_hertz_and_cattaneos(solve, ranks):
    """On cells that do not divide, of a sphere and of an ellipse; by whole cells without edges."""
    case, c = cattaneo(0.6, grid_n=(47, 53))
    r, a = solve(case, ranks=ranks), hertz(case).radius
    sides = dict(x=case["grid_size"] / 47, y=case["grid_size"] / 53)
    counted = solve(dict(case, edges="none"))
    for axis, cell in sides.items():
        assert abs(r[f"contact_half_{axis}"] - a) < cell / 70
        assert abs(r[f"stick_half_{axis}"] - c * a) < cell / 40
        for name in ("contact", "stick"):
            halves = 2 * counted[f"{name}_half_{axis}"] / cell
            assert halves == pytest.approx(round(halves), abs=1e-9)
    names = [f"{name}_half_{axis}" for name in ("contact", "stick") for axis in "xy"]
    assert [r[name] for name in names] == [solve(case)[name] for name in names]
    oval = dict(case, gap_type="ellipsoid", gap_radius1=None, gap_radius2=None, gap_radius_x=0.1, gap_radius_y=0.05)
    e_star = closed.effective_modulus(*[case[f"body{body}_{name}"] for body in "12" for name in ("young", "poisson")])
    exact = elliptic_hertz(case["load_n"], 0.1, 0.05, e_star)[:2]
    found = solve(oval, ranks=ranks)
    for axis, half in zip("xy", exact):
        assert abs(found[f"contact_half_{axis}"] - half) < sides[axis] / 50
        assert abs(found[f"stick_half_{axis}"] - c * half) < sides[axis] / 25


def test_half_widths_are_printed(petsam, tmp_path):
    """Of a single step, and after the table of several ones those of the last; along x only in plane strain."""
    one = r"half width  contact (\S+) m along x, (\S+) m along y; stick (\S+) m along x, (\S+) m along y"
    case, c = cattaneo(0.6, grid_n=45)
    a = hertz(case).radius
    halves = [float(text) for text in re.search(one + "\n", petsam(case).stdout).groups()]
    assert halves == pytest.approx([a, a, c * a, c * a], rel=3e-3)
    (tmp_path / "h.csv").write_text("time, load_n\n1, 300\n2, 1000\n")
    said = petsam(dict(case, load_n=None, load_tx=None, history="h.csv")).stdout
    last = [float(text) for text in re.search(one + r" \(last step\)\n", said).groups()]
    assert last[:2] == pytest.approx([a, a], rel=3e-3) and said.count("half width") == 1
    plane = dict(case, elasticity="plane", load_n=3e5, load_tx=1e4, output="out.h5")
    assert re.search(r"half width  contact (\S+) m; stick (\S+) m\n", petsam(plane).stdout)
    with package.open(tmp_path / "out.h5") as results:
        assert results.history["contact_half_x"][-1] > 0 and np.isnan(results.history["contact_half_y"][-1])


@pytest.mark.filterwarnings("ignore")
def test_no_more_sticks_than_touches():
    """Both areas are reconstructed, each with its own error, where nearly all of a growing contact sticks."""
    rows = dict(
        time=np.arange(5.0),
        load_n=np.array([500.0, 500, 250, 100, 400]),
        disp_x=1e-6 * np.array([0, 1.5, 1.5, -1, 0.5]),
    )
    case = dict(body1_young=115e9, body1_poisson=0.32, body2_young=115e9, body2_poisson=0.32, friction=0.5)
    case.update(gap_type="ellipsoid", gap_radius_x=0.05, gap_radius_y=0.2, grid_n=(20, 40), grid_size=(1.5e-3, 3.3e-3))
    run = package.run(**case, history=rows, steps=40, errors="none", output_fields="none")
    assert np.all(run["stick_area"] <= run["contact_area"])
    assert np.any((run["stick_area"] == run["contact_area"]) & (run["stick_cells"] < run["contact_cells"]))

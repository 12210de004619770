"""Periodic bodies: -elasticity periodic against closed solutions and against Tamaas, stick and slip, ranks."""

import math
import sys

import h5py
import numpy as np
import pytest

from support import ROOT, assert_close, assert_same, history

sys.path.insert(0, str(ROOT / "tests" / "bench"))
import problem  # noqa: E402

WIDTH, HEIGHT = 1e-3, 1e-6
BODIES = dict(body1_young=210e9, body1_poisson=0.3, body2_young=210e9, body2_poisson=0.3)


def write_gap(path, heights):
    with h5py.File(path, "w") as f:
        f["height"] = heights
    return dict(gap_type="file", gap_file=path)


def centres(n):
    return (np.arange(n) + 0.5) / n * WIDTH


@pytest.fixture
def wave(tmp_path):
    """One wave along x of amplitude HEIGHT on a grid of one wavelength, and the mean pressure that closes its gap."""

    def case(n, ny):
        heights = np.tile(HEIGHT * (1 - np.cos(2 * np.pi * (centres(n) / WIDTH - 0.5))), (ny, 1))
        full = np.pi * problem.modulus(BODIES) * HEIGHT / WIDTH
        return dict(
            BODIES,
            elasticity="periodic",
            grid_n=(n, ny),
            grid_size=(WIDTH, WIDTH / 4),
            **write_gap(tmp_path / f"wave{n}.h5", heights),
        ), full

    return case


def test_wave_in_full_contact(wave, solve):
    case, full = wave(45, 10)
    r = solve(case, dict(load_n=1.5 * full * WIDTH**2 / 4))
    exact = 1.5 * full + full * np.cos(2 * np.pi * r.xx / WIDTH)
    assert_close(r.pressure, exact, 1e-7)
    assert_close(r["disp_z"], HEIGHT, 1e-9)  # from the mean surface
    assert r["contact_area"] == pytest.approx(WIDTH**2 / 4)


def test_wave_in_partial_contact_is_westergaard_s(wave, solve):
    case, full = wave(1024, 4)
    sine = np.sin(0.3 * np.pi)  # of half the contact's angle
    r = solve(case, dict(load_n=full * sine**2 * WIDTH**2 / 4))
    s = np.sin(np.pi * r.xx / WIDTH)
    exact = 2 * full * np.cos(np.pi * r.xx / WIDTH) * np.sqrt(np.maximum(sine**2 - s**2, 0))
    inner = np.abs(r.xx) < 0.15 * WIDTH
    assert_close(r.pressure[inner], exact[inner], 1e-5)
    assert_close(r["disp_z"], HEIGHT * sine**2 * (1 - np.log(sine**2)), 1e-5)


def test_rough_plane_against_tamaas(petsam, tmp_path):
    tamaas = pytest.importorskip("tamaas")
    n = 128
    problem.make("periodic_8", n, tmp_path)
    numbers, gap = problem.json.loads((tmp_path / "problem.json").read_text()), np.load(tmp_path / "gap.npy")
    petsam(*numbers["options"], "-output", "results.h5")
    with h5py.File(tmp_path / "results.h5") as f:
        pressure = f["pressure"][-1]
    tamaas.set_log_level(tamaas.LogLevel.error)
    model = tamaas.Model(tamaas.model_type.basic_2d, [numbers["width"]] * 2, [n, n])
    model.E, model.nu = numbers["e_star"], 0.0
    solver = tamaas.PolonskyKeerRey(
        model, -gap, 1e-11, tamaas.PolonskyKeerRey.pressure, tamaas.PolonskyKeerRey.pressure
    )
    solver.max_iter = 20000
    assert solver.solve(numbers["load_n"] / numbers["width"] ** 2) <= 1e-11
    assert 0.06 < np.mean(pressure > 0) < 0.1
    assert_close(pressure, model.traction.reshape(n, n), 1e-6)


@pytest.fixture
def hills(tmp_path):
    """Dissimilar bodies with hills in a period, in partial contact."""
    n = 48
    x, y = np.meshgrid(centres(n), centres(n))
    heights = HEIGHT * (2 - np.cos(2 * np.pi * x / WIDTH + 0.3) - 0.8 * np.cos(4 * np.pi * y / WIDTH - 0.2))
    return dict(
        BODIES,
        body2_young=3e9,
        body2_poisson=0.2,
        friction=0.3,
        elasticity="periodic",
        grid_n=n,
        grid_size=WIDTH,
        load_n=10.0,
        **write_gap(tmp_path / "hills.h5", heights),
    )


def test_partial_slip_with_coupling_passes_the_check(hills, solve):
    r = solve(hills, dict(load_tx=1.5))
    loads = r.loads()
    assert loads["load_n"] == pytest.approx(10) and loads["load_tx"] == pytest.approx(1.5)
    assert 0.1 < r["stick_area"] / r["contact_area"] < 0.9
    shear, bound = r.shear, 0.3 * r.pressure
    assert np.all(shear <= bound * (1 + 1e-9))
    stuck = (bound > 0) & (shear < (1 - 1e-4) * bound)
    assert np.max(np.hypot(r.slip_x, r.slip_y)[stuck]) < 1e-5 * abs(r["disp_x"])


def test_shifted_hills_have_shifted_tractions(hills, solve, tmp_path):
    with h5py.File(hills["gap_file"]) as f:
        moved = write_gap(tmp_path / "moved.h5", np.roll(f["height"][:], (11, -20), (0, 1)))
    one, two = solve(hills, dict(load_tx=1.5)), solve(dict(hills, **moved), dict(load_tx=1.5))
    for name in ("pressure", "shear_x", "shear_y"):
        assert_close(
            np.roll(getattr(one, name), (11, -20), (0, 1)), getattr(two, name), 1e-4, name, np.max(one.pressure)
        )
    for name in ("contact_area", "stick_area"):  # edges go on over the border of the period
        assert one[name] == pytest.approx(two[name], rel=1e-5)


@pytest.mark.parametrize("by", [(0, 13), (0, 15), (13, 0)])
def test_maxima_between_cells_are_found_across_the_border(solve, tmp_path, by):
    """The largest slip is at the edge of contact: with cells alone beside the border it was 9 % off."""
    n = 48
    x, y = np.meshgrid(centres(n) - WIDTH / 2, centres(n) - WIDTH / 2)
    ball = (x**2 + y**2) / 0.04
    case = dict(BODIES, friction=0.3, elasticity="periodic", grid_n=n, grid_size=WIDTH, load_n=60.0, load_tx=6.0)
    one, two = (solve(case, write_gap(tmp_path / f"{name}.h5", heights)) for name, heights in
                (("middle", ball), ("moved", np.roll(ball, by, (0, 1)))))  # fmt: skip
    for name in ("slip_max", "shear_max"):
        assert one[name] == pytest.approx(two[name], rel=1e-6), name


def test_spots_far_apart_are_copies_of_one(solve, tmp_path):
    """Three hills in a row beside one: loops pass over the cells between spots, of which one in a row has none."""
    n = 48
    x, y = np.meshgrid(centres(n), centres(n))
    hill = 5 * HEIGHT * (2 - np.cos(2 * np.pi * (x / WIDTH - 0.5)) - np.cos(2 * np.pi * (y / WIDTH - 0.5)))
    found = []
    for copies in (1, 3):
        rows = [(k, copies * 100 * (1 + 0.3 * math.sin(2 * k)), copies * 15 * math.sin(0.9 * k)) for k in range(9)]
        case = dict(BODIES, friction=0.3, elasticity="periodic", grid_n=(copies * n, n),
                    **history(tmp_path / f"{copies}.csv", "time,load_n,load_tx", *rows))  # fmt: skip
        gap = write_gap(tmp_path / f"{copies}.h5", np.tile(hill, (1, copies)))
        found.append(solve(case, dict(gap, grid_size=(copies * WIDTH, WIDTH), errors="none")))
    one, three = found
    touches = one.pressure.max(axis=0) > 0
    assert np.ptp(np.flatnonzero(touches)) < n - 17  # so spots are apart by more than what loops pass over
    for name in ("pressure", "shear_x", "shear_y", "slip_x"):
        most = np.max(one.pressure) if name != "slip_x" else np.max(np.abs(one.slip_x))
        assert_close(getattr(three, name), np.tile(getattr(one, name), (1, 3)), 1e-5, name, most)
    assert three["dissipated_energy"] == pytest.approx(3 * one["dissipated_energy"], rel=1e-5)


def test_ranks_do_not_matter(hills, solve):
    case = dict(hills, load_tx=1.5, output_fields="all")
    assert_same(solve(case, ranks=3), solve(case), 0)

"""The peak of the pressure: whether the cells resolve it, and the grid that is advised where they do not."""

import re

import h5py
import numpy as np
import pytest

from petsam.closed.punch import Punch, punch_pressure, punch_radius
from support import doubts

E_STAR = 110e9
BODIES = dict(body1_young=2 * E_STAR, body1_poisson=0.0, body2_young=2 * E_STAR, body2_poisson=0.0)
LIMIT = 0.05  # change of the peak that is to be warned of
SAID = re.compile(
    r"pressure_max (is about \d+ % (higher|lower) on cells half as wide|grows without limit on finer cells)"
)


def peak(done):
    """Pressure (Pa), whether the peak is said not to be resolved, and the cells of the advised grid."""
    line, told = doubts(done)
    advised = re.search(r"-grid_n (\d+)(?=$|, unless)", line)
    pressure = float(re.search(r"pressure (\S+) Pa", done.stdout).group(1))
    return pressure, "pressure_max" in told and bool(SAID.search(line)), int(advised[1]) if advised else 0


def centres(n):
    """x and y of the cells of a square of width 1."""
    return np.meshgrid(*2 * [(np.arange(n) + 0.5) / n - 0.5])


def surface(tmp_path, n, height):
    """Writes heights (m) at the centres of n * n cells; returns the file's name."""
    with h5py.File(tmp_path / f"{n}.h5", "w") as f:
        f["height"] = height(*centres(n))
    return f"{n}.h5"


@pytest.mark.parametrize(
    "flat, edge, load, size", [(1.5e-3, 0.3e-3, 300.0, 4e-3), (1e-3, 1e-3, 1000.0, 3e-3), (0.5e-3, 5e-3, 100.0, 2e-3)]
)
def test_peak_of_a_rounded_punch_is_right_or_warned_of(petsam, flat, edge, load, size):
    punch = Punch(flat, edge, E_STAR)
    radius = punch_radius(punch, load)
    true = punch_pressure(np.linspace(0.9 * flat, radius, 20001)[:-1], punch, radius).max()
    case = dict(BODIES, gap_type="punch", gap_flat_radius=flat, gap_edge_radius=edge, load_n=load, grid_size=size)
    advised = set()
    for n in (48, 64, 96, 128, 192):
        pressure, warned, better = peak(petsam(case, dict(grid_n=n)))
        assert warned or abs(pressure / true - 1) < LIMIT, n
        advised |= {better} if warned else set()
    assert all(n > 0 for n in advised)
    for n in advised:
        if n <= 512:
            assert abs(peak(petsam(case, dict(grid_n=n)))[0] / true - 1) < LIMIT, n


def test_peak_of_a_rounded_pad_is_right_or_warned_of(petsam, tmp_path):
    """Heights from a file hide where the edge begins: the advised grid may need another one, until none is advised."""

    def pressed(n):
        file = surface(tmp_path, n, lambda x, y: 4e-3 * sum(np.maximum(abs(t) - 0.25, 0) ** 2 for t in (x, y)))
        return peak(petsam(BODIES, dict(gap_type="file", gap_file=file, grid_n=n, grid_size=4e-3, load_n=1200.0)))

    found = {n: pressed(n) for n in (48, 64, 96, 128, 192, 256, 384)}
    true, warned, _ = found[384]
    assert not warned
    for n, (pressure, warned, better) in found.items():
        assert better > n if warned else abs(pressure / true - 1) < LIMIT, n


@pytest.mark.parametrize("edge", [2e-3, 2e-2, 2e-1])
@pytest.mark.parametrize("bodies", ["plane", "plane_periodic"])
def test_peak_of_a_pad_in_plane_strain_is_right_or_warned_of(petsam, edge, bodies):
    case = dict(BODIES, elasticity=bodies, gap_type="pad", gap_half_flat_x=1e-3, gap_edge_radius_x=edge, load_n=5e4)
    found = {n: peak(petsam(case, dict(grid_n=n, grid_size=3.2e-3))) for n in (48, 64, 100, 128, 192, 256, 2048)}
    true, warned, _ = found[2048]
    assert not warned
    for n, (pressure, warned, better) in found.items():
        assert better > n if warned else abs(pressure / true - 1) < LIMIT, n
    assert edge > 2e-3 or all(found[n][1] for n in (48, 64, 100))
    assert edge < 2e-1 or not any(warned for _, warned, _ in found.values())


# heights relative to the width of the grid; the load (N); periodic bodies
GAPS = {
    "sphere": (lambda x, y: 0.01 * (x**2 + y**2), 10.0, False),
    "small sphere": (lambda x, y: 0.1 * (x**2 + y**2), 2.0, False),
    "cone": (lambda x, y: 0.01 * np.hypot(x + 0.004, y + 0.003), 60.0, False),
    "ridges of 12 cells": (lambda x, y: 1e-3 * np.cos(8 * np.pi * x + 1), 300.0, True),
    "bumps of 24 cells": (lambda x, y: 1e-3 * (np.cos(4 * np.pi * x) + np.cos(4 * np.pi * y)), 500.0, True),
    "bumps of 4 cells": (lambda x, y: 1e-3 * (np.cos(24 * np.pi * x + 1) + np.cos(24 * np.pi * y + 2)), 50.0, True),
    "waves on a sphere": (lambda x, y: 0.01 * (x**2 + y**2) + 1e-4 * np.cos(20 * np.pi * x + 1), 10.0, False),
    "faint waves on a sphere": (lambda x, y: 0.01 * (x**2 + y**2) + 1e-6 * np.cos(20 * np.pi * x + 1), 100.0, False),
}


@pytest.mark.parametrize("name", GAPS)
def test_warning_is_given_where_finer_cells_change_the_peak(petsam, tmp_path, name):
    height, load, periodic = GAPS[name]
    case = dict(
        BODIES, gap_type="file", grid_size=2e-3, load_n=load, elasticity="periodic" if periodic else "halfspace"
    )
    found = [
        peak(petsam(case, dict(grid_n=n, gap_file=surface(tmp_path, n, lambda x, y: 2e-3 * height(x, y)))))
        for n in (48, 96)
    ]
    change = found[1][0] / found[0][0] - 1
    assert found[0][1] == (abs(change) > LIMIT)


def test_sharp_edge_is_resolved_by_no_grid(petsam):
    """The same words on any number of ranks; a hardness bounds the pressure, so that there is nothing to say."""
    case = dict(BODIES, gap_type="punch", gap_flat_radius=5e-4, gap_edge_radius=1e-6, load_n=1.0)
    case = dict(case, grid_n=49, grid_size=2e-3)
    done = [petsam(case, ranks=ranks).complaint for ranks in (1, 2, 3)]
    assert len(done[0]) == 1 and done[1] == done[0] == done[2]
    assert done[0][0].endswith("pressure_max grows without limit on finer cells, as at a sharp edge)")
    assert not petsam(case, dict(pressure_limit=1.5e6)).complaint


@pytest.mark.parametrize("bodies", ["plane", "plane_periodic"])
@pytest.mark.parametrize("n", [96, 768])
def test_narrow_spots_in_plane_strain_are_few_cells(petsam, tmp_path, bodies, n):
    """Cylinders side by side; the finer grid has them right."""
    with h5py.File(tmp_path / "waves.h5", "w") as f:
        x = (np.arange(n) + 0.5) / n - 0.5
        f["height"] = 2e-7 * (1 - np.cos(6 * np.pi * x[None, :])) + (1e-6 * x[None, :] ** 2 if bodies == "plane" else 0)
    case = dict(BODIES, elasticity=bodies, gap_type="file", gap_file="waves.h5", load_n=2e4)
    done = petsam(case, dict(grid_n=n, grid_size=1e-3))
    line = doubts(done)[0]
    assert ("in 3 spots, the narrow ones" in line and "cells across" in line) == (n == 96)


STEP = re.compile(r"step of (\S+) m between neighbouring cells in contact, at x = (\S+) m, y = (\S+) m")


@pytest.mark.parametrize("n", [96, 128])
def test_step_of_a_measured_surface_in_contact_is_warned_of_with_its_place(petsam, tmp_path, n):
    """A wall of 100 um, beside which nothing else is said of the pressure, and which a limit of the pressure mends."""

    def wall(x, y):
        return 2e-4 * (x**2 + y**2) + 1e-4 * (x > 0.1)

    case = dict(BODIES, gap_type="file", gap_file=surface(tmp_path, n, wall), grid_n=n, grid_size=4e-3, load_n=3000.0)
    said = [line for line in petsam(case).complaint if "warning" in line]
    found = STEP.search(said[0])
    assert len(said) == 1 and "give the hardness, -pressure_limit, unless it is an outlier" in said[0]
    assert float(found[1]) == pytest.approx(1e-4, rel=0.05)
    assert float(found[2]) == pytest.approx(0.4e-3, abs=4e-3 / n) and abs(float(found[3])) < 1.2e-3
    assert not any(STEP.search(line) for line in petsam(case, dict(pressure_limit=2e9)).complaint)


def test_step_outside_of_contact_and_roughness_are_no_step(petsam, tmp_path):
    def far(x, y):
        return 2e-4 * (x**2 + y**2) + 1e-4 * (x > 0.4)

    def rough(x, y):
        return 2e-4 * (x**2 + y**2) + 2e-6 * np.random.default_rng(3).standard_normal(x.shape)

    for height in (far, rough):
        case = dict(BODIES, gap_type="file", gap_file=surface(tmp_path, 64, height), grid_n=64, grid_size=4e-3)
        assert not any(STEP.search(line) for line in petsam(case, dict(load_n=300.0)).complaint)


@pytest.mark.parametrize("n", [255, 256, 512])
@pytest.mark.parametrize("apex", [0.0, 0.25])
def test_peak_of_a_wedge_from_a_file_has_no_limit(petsam, tmp_path, n, apex):
    """With its tip between two cells, at a centre, or elsewhere; each third of the cells adds as much pressure."""
    peaks, told = [], []
    for k in (n, 3 * n):
        x = ((np.arange(k) + 0.5) / k - 0.5) * 4e-3 - apex * 4e-3 / n
        with h5py.File(tmp_path / "wedge.h5", "w") as f:
            f["height"] = 0.01 * abs(x)[None]
        case = dict(BODIES, elasticity="plane", gap_type="file", gap_file="wedge.h5", grid_size=4e-3, load_n=1.1e6)
        done = petsam(case)
        peaks.append(peak(done)[0])
        told += [doubts(done)[1].get("pressure_max")] if k == n else []
    change = (peaks[1] / peaks[0] - 1) * np.log(2) / np.log(3)
    assert told[0] == pytest.approx(change, rel=0.7)


def test_warnings_of_heights_hide_none_of_the_contact(petsam, tmp_path):
    """Slopes, few cells across the spots, and the pressure: all are told."""
    rough = surface(tmp_path, 64, lambda x, y: 2e-6 * np.random.default_rng(3).standard_normal(x.shape))
    case = dict(BODIES, elasticity="periodic", gap_type="file", gap_file=rough, grid_n=64, grid_size=2e-4, load_n=60.0)
    said = "\n".join(petsam(case).complaint)
    for words in (
        "rms slope of the heights",
        "check the unit of the dataset",
        "the contact is in",
        "of E*, linear elasticity holds",
    ):
        assert words in said, words


def test_large_contact_hides_no_pressure(petsam):
    case = dict(BODIES, gap_type="sphere", gap_radius1=1e-3, gap_radius2="inf", grid_n=48, grid_size=3e-3, load_n=2e4)
    said = "\n".join(petsam(case).complaint)
    assert "too large for half-space theory" in said and "of E*, linear elasticity holds" in said

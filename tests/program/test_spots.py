"""Numbers of rough contact: spots, contact fraction and mean gap, on any number of ranks."""

import re

import h5py
import numpy as np
import pytest

from support import SPHERE, flatten

N = (37, 29)
SPOTS = dict(contact_spots=True, output="out.h5")


def spots(contact, periodic):
    """Zones of cells that are connected by their sides, counted by flooding one after another."""
    left = {(int(j), int(i)) for j, i in np.argwhere(contact)}
    count = 0
    while left:
        count += 1
        flood = [left.pop()]
        while flood:
            j, i = flood.pop()
            for cell in ((j + 1, i), (j - 1, i), (j, i + 1), (j, i - 1)):
                if periodic:
                    cell = cell[0] % contact.shape[0], cell[1] % contact.shape[1]
                if cell in left:
                    left.remove(cell)
                    flood.append(cell)
    return count


@pytest.fixture
def case(tmp_path):
    """Rough from cell to cell, so that spots are many, of any shape, and some touch by corners only."""
    with h5py.File(tmp_path / "rough.h5", "w") as f:
        f["height"] = 2e-7 * np.random.default_rng(7).standard_normal(N[::-1])
    return dict(
        SPHERE, friction=0, gap_rough_file="rough.h5", grid_n=N, grid_size=(2.6e-3, 2.1e-3), allow_edge_contact=True
    )


def read(path):
    with h5py.File(path) as f:
        return {**{name: f[name][-1] for name in ("pressure", "gap")}, **{n: d[-1] for n, d in f["history"].items()}}


@pytest.mark.parametrize(
    "elasticity, load, several",
    [("halfspace", 20.0, 7), ("halfspace", 3000.0, 3), ("periodic", 300.0, 3), ("periodic", 3000.0, 2)],
)
def test_numbers_are_those_of_the_fields(petsam, tmp_path, case, elasticity, load, several):
    found = []
    for ranks in (1, several):
        petsam(case, SPOTS, dict(elasticity=elasticity, load_n=load), ranks=ranks)
        found.append(read(tmp_path / "out.h5"))
    one, other = found
    contact = one["pressure"] > 0
    assert one["contact_spots"] == spots(contact, elasticity == "periodic") > 2
    assert one["contact_cells"] == contact.sum()
    assert one["contact_fraction"] == pytest.approx(one["contact_area"] / (2.6e-3 * 2.1e-3), rel=1e-12)
    assert one["gap_mean"] == pytest.approx(one["gap"].mean(), rel=1e-12)
    assert all(other[name] == one[name] for name in ("contact_spots", "contact_fraction", "gap_mean"))


def test_mean_gap_has_the_plastic_depth(petsam, tmp_path, case):
    fields = dict(pressure_limit=5e8, output_fields="gap,plastic_depth", load_n=300.0)
    for ranks in (1, 3):
        petsam(case, SPOTS, fields, ranks=ranks)
        with h5py.File(tmp_path / "out.h5") as f:
            gap, depth = f["gap"][-1], f["plastic_depth"][-1]
            mean = f["history/gap_mean"][-1]
        assert depth.mean() > 1e-3 * gap.mean()
        assert mean == pytest.approx(gap.mean(), rel=1e-12)


def test_corners_do_not_connect_and_sides_do(petsam, tmp_path):
    """A checkerboard's peaks, then a comb's: as many spots as cells in contact; one."""
    n = 8
    j, i = np.indices((n, n))
    board, comb = (i + j) % 2, ((i % 2 == 0) | (j == 3)) & True
    for name, high, expected in (("board", board, n * n / 2), ("comb", comb, 1)):
        with h5py.File(tmp_path / "gap.h5", "w") as f:
            f["height"] = np.where(high, 0.0, 1.0)
        words = dict(SPHERE, gap_type="file", gap_file="gap.h5", gap_radius1=None, gap_radius2=None, grid_n=n)
        petsam(words, SPOTS, dict(output=f"{name}.h5", friction=0, elasticity="periodic", load_n=1.0), ranks=2)
        assert read(tmp_path / f"{name}.h5")["contact_spots"] == expected


def test_numbers_are_on_request_and_printed(petsam, tmp_path, case):
    done = petsam(case, dict(output="plain.h5"))
    assert "  spots " not in done.stdout and "contact_spots" not in read(tmp_path / "plain.h5")
    done = petsam(case, SPOTS)
    values = read(tmp_path / "out.h5")
    found = re.search(r"^  spots +(\d+), contact on (\S+) % of the grid, mean gap (\S+) m$", done.stdout, re.M)
    assert int(found[1]) == values["contact_spots"]
    assert float(found[2]) == pytest.approx(100 * values["contact_fraction"], rel=1e-3)
    assert float(found[3]) == pytest.approx(values["gap_mean"], rel=1e-5)


def test_step_without_equilibrium_has_none(petsam, tmp_path):
    (tmp_path / "history.csv").write_text("time,load_n,load_tx\n1,1000,0\n2,1000,200\n")
    case = flatten([{**SPHERE, "load_n": None, "history": "history.csv", "grid_n": 32}, SPOTS])
    petsam(*case, check=11)
    values = read(tmp_path / "out.h5")
    for name in ("contact_spots", "contact_fraction", "gap_mean", "slip_max", "pressure_max", "shear_max"):
        assert np.isnan(values[name]), name

"""petsam-stress: stresses from a results file, as maps and sections, on any number of ranks, and its refusals."""

import re

import h5py
import numpy as np
import pytest

import conftest
from support import SPHERE, ball, hertz, slide_limit

QUANTITIES = "stress,mises,principal,shear_max,strain"
PROGRAM = conftest.PROGRAM.with_name("petsam-stress")
COMPONENTS = ("xx", "yy", "zz", "xy", "xz", "yz")


@pytest.fixture(scope="module")
def contact(launcher, tmp_path_factory):
    """The folder of a run: a sphere that is pushed to and fro, the fields of every second of six steps."""
    folder = tmp_path_factory.mktemp("contact")
    tx = 0.6 * slide_limit(SPHERE)[0]
    rows = "\n".join(f"{k + 1},{f * tx}" for k, f in enumerate((0.5, 1, 0.5, -1, -0.5, 1)))
    (folder / "h.csv").write_text("time,load_tx\n" + rows + "\n")
    case = dict(SPHERE, grid_n=(65, 64), history="h.csv", output="c.h5", output_every=2)
    conftest.execute(launcher, folder, [case], 1, 0)
    return folder


@pytest.fixture
def stress(launcher, contact):
    """stress(options, ranks=1, check=0): what a run of petsam-stress in the contact's folder prints to stderr."""

    def run(options, ranks=1, check=0):
        return conftest.execute(launcher, contact, [options], ranks, check, program=PROGRAM).stderr

    return run


def read(path):
    with h5py.File(path) as f:
        names = [*f, *("history/" + k for k in f["history"])]
        return {name: f[name][()] for name in names if isinstance(f[name], h5py.Dataset)}


def test_surface_has_the_tractions(stress, contact):
    stress(dict(input="c.h5", output="s.h5", depths=0.0, steps="all"))
    s, c = read(contact / "s.h5"), read(contact / "c.h5")
    assert s["time"].tolist() == [2, 4, 6] and s["stress_zz"].shape == (3, 1, 64, 65)
    assert np.array_equal(s["stress_zz"][:, 0], -c["pressure"])
    assert np.array_equal(s["stress_xz"][:, 0], -c["shear_x"]) and np.array_equal(s["stress_yz"][:, 0], -c["shear_y"])


def test_axis_is_that_of_hertz(stress, contact):
    h = hertz(SPHERE)
    depths = [0.2 * h.radius, 0.5 * h.radius, h.radius]
    stress(dict(input="c.h5", output="a.h5", depths=",".join(repr(float(z)) for z in depths), section="y=0", body=1))
    s = read(contact / "a.h5")
    for k, z in enumerate(np.array(depths) / h.radius):
        zz = np.interp(0.0, s["x"], s["stress_zz"][0, k, 0]) / h.pressure
        assert zz == pytest.approx(-1 / (1 + z * z), abs=5e-3)  # the row nearest to y = 0 is half a cell beside it


@pytest.mark.parametrize("ranks", [2, 3])
def test_results_do_not_depend_on_the_ranks(stress, contact, ranks):
    for section in (None, "y=0", "x=1e-4"):
        for n in (1, ranks):
            stress(dict(input="c.h5", output=f"n{n}.h5", depths="0:5e-4:5", steps="all", section=section,
                        quantities=QUANTITIES), ranks=n)  # fmt: skip
        one, many = read(contact / "n1.h5"), read(contact / f"n{ranks}.h5")
        assert set(one) == set(many) and all(np.array_equal(one[k], many[k]) for k in one)


@pytest.mark.parametrize("body", [1, 2])
def test_largest_tension_of_sliding_is_found_at_the_edge(launcher, tmp_path, body):
    """(1 - 2 nu)/3 + mu pi (4 + nu)/8 of p0 at the trailing edge, and the bulk stress; the map is 10 % off."""
    bulk, mu, nu, h = 5e7, 0.3, 0.3, hertz(SPHERE)
    case = dict(SPHERE, grid_n=80, grid_size=3 * h.radius, friction=mu, load_tx=None, disp_x=1e-3, output="c.h5")
    case.update(bulk1_stress_xx=bulk, bulk2_stress_xx=bulk)
    conftest.execute(launcher, tmp_path, [case], 1, 0)
    found = []
    for ranks in (1, 3):
        options = dict(input="c.h5", output="s.h5", depths=0.0, body=body)
        done = conftest.execute(launcher, tmp_path, [options], ranks, 0, program=PROGRAM)
        found.append(read(tmp_path / "s.h5"))
    exact = ((1 - 2 * nu) / 3 + mu * np.pi * (4 + nu) / 8) * h.pressure + bulk
    s = found[0]
    assert s["history/edge_stress_xx_max"][0] == pytest.approx(exact, rel=5e-3)
    assert s["history/edge_principal_1_max"][0] == pytest.approx(exact, rel=5e-3)
    assert s["history/edge_stress_xx_max_x"][0] == pytest.approx((1 if body == 1 else -1) * h.radius, rel=2e-3)
    assert s["stress_xx"].max() < 0.95 * exact
    for name in ("stress xx", "principal stress"):
        printed = re.search(rf"{name} at the contact edge (\S+) Pa .*in step 1$", done.stdout, re.M)
        assert float(printed[1]) == pytest.approx(exact, rel=5e-3)
    for name in ("edge_stress_xx_max", "edge_stress_xx_max_x", "edge_stress_xx_max_y", "edge_principal_1_max"):
        assert np.array_equal(found[0]["history/" + name], found[1]["history/" + name])


def test_steps_that_petsam_has_not_solved_are_told(launcher, tmp_path):
    case = dict(SPHERE, grid_n=32, load_tx=None, output="c.h5")
    case.update(grid_size=1e-3)  # smaller than the contact
    conftest.execute(launcher, tmp_path, [case], 1, 12)
    told = conftest.execute(launcher, tmp_path, [dict(input="c.h5", output="s.h5", depths=1e-4)], 1, 0, program=PROGRAM)
    assert "has not solved 1 of 1 steps: step 1 has the status 12" in told.stderr


def test_edge_that_is_not_resolved_has_no_stress(launcher, tmp_path):
    case = dict(SPHERE, grid_n=36, grid_size=4.2e-3, load_tx=None, disp_x=1e-4, output="c.h5")  # slides
    case.update(grid_center=(0.3 * 4.2e-3 / 36, 0.0))
    conftest.execute(launcher, tmp_path, [case], 1, 0)
    with h5py.File(tmp_path / "c.h5") as file:
        assert 0 < file["history/edge_accepted"][-1] < 0.9
    words = dict(input="c.h5", output="s.h5", depths=0.0)
    told = conftest.execute(launcher, tmp_path, [words], 1, 0, program=PROGRAM).stderr
    assert "the contact edge is not found in 1 of 1 steps" in told
    assert np.isnan(read(tmp_path / "s.h5")["history/edge_stress_xx_max"][0])


def test_sections_are_rows_and_columns_of_the_maps(stress, contact):
    common = dict(input="c.h5", depths="0,3e-5,4e-4", steps="2:6:4", quantities=QUANTITIES)
    stress(dict(common, output="map.h5"))
    maps = read(contact / "map.h5")
    for section, axis, at in (("y=1e-4", 2, "y"), ("x=-2e-4", 3, "x")):
        stress(dict(common, output="line.h5", section=section))
        line = read(contact / "line.h5")
        k = int(np.argmin(abs(maps[at] - line[at][0])))
        for name in maps:
            if maps[name].ndim == 4:
                part = np.take(maps[name], [k], axis=axis)
                assert np.allclose(line[name], part, rtol=0, atol=1e-12 * abs(maps[name]).max()), name


def test_quantities_belong_to_the_stresses(stress, contact):
    stress(dict(input="c.h5", output="q.h5", depths="0,1e-4", quantities=QUANTITIES))
    s = read(contact / "q.h5")
    xx, yy, zz, xy, xz, yz = (s["stress_" + c] for c in COMPONENTS)
    tensor = np.moveaxis(np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]), (0, 1), (-2, -1))
    principal = np.linalg.eigvalsh(tensor)
    scale = abs(principal).max()
    for k in range(3):
        assert np.allclose(s[f"principal_{k + 1}"], principal[..., 2 - k], rtol=0, atol=1e-12 * scale)
    assert np.allclose(s["shear_max"], 0.5 * (principal[..., 2] - principal[..., 0]), rtol=0, atol=1e-12 * scale)
    young, nu = SPHERE["body2_young"], SPHERE["body2_poisson"]
    assert np.allclose(s["strain_xx"], (xx - nu * (yy + zz)) / young, rtol=0, atol=1e-12 * scale / young)
    assert np.allclose(s["strain_xz"], (1 + nu) / young * xz, rtol=0, atol=1e-12 * scale / young)
    for name in ("mises", "principal_1"):
        place = np.unravel_index(np.argmax(s[name][0]), s[name][0].shape)
        assert s[f"history/{name}_max"][0] == s[name][0].max()
        assert [s[f"history/{name}_max_{c}"][0] for c in "zyx"] == [s[c][k] for c, k in zip("zyx", place)]


def test_xarray_opens_it_as_a_volume(stress, contact):
    xarray = pytest.importorskip("xarray")
    pytest.importorskip("netCDF4")
    stress(dict(input="c.h5", output="v.h5", depths="0,1e-4"))
    with xarray.open_dataset(contact / "v.h5", engine="netcdf4") as data:
        assert data["mises"].dims == ("time", "z", "y", "x") and data["stress_xx"].attrs["units"] == "Pa"
        assert float(data["mises"].isel(time=0).sel(z=1e-4).max()) > 0


def test_safety_of_a_layer_is_its_strength_over_the_principal_stress(launcher, tmp_path):
    """Of the largest one; printed with the number of the file, for each layer its own."""
    case = dict(
        ball(n=32), body2_layer_young="400e9,100e9", body2_layer_poisson=0.25, body2_layer_thickness="2e-5,4e-5"
    )
    conftest.execute(launcher, tmp_path, [case, dict(output="c.h5")], 1, 0)
    options = dict(input="c.h5", output="s.h5", section="y=0", depths="0:1e-4:21")
    text = conftest.execute(launcher, tmp_path, [options, dict(layer_strength="2e9,1e8")], 2, 0, program=PROGRAM).stdout
    with h5py.File(tmp_path / "s.h5") as f:
        largest = [f[f"history/layer{k}_principal_1_max"][-1] for k in (1, 2)]
        assert f.attrs["layer_strength"].tolist() == [2e9, 1e8]
    found = [float(word) for word in re.findall(r"layer \d: principal stress .* safety (\S+)", text)]
    expected = [strength / stress for strength, stress in zip((2e9, 1e8), largest) if stress > 0]
    assert found == pytest.approx(expected, rel=6e-3)
    done = conftest.execute(launcher, tmp_path, [options, dict(layer_strength="2e9,1e8,1e8")], 1, 2, program=PROGRAM)
    assert "-layer_strength: 3 numbers for 2 layers" in done.stderr


def test_one_strength_is_that_of_all_layers(launcher, tmp_path):
    case = dict(
        ball(n=24), body2_layer_young="400e9,300e9", body2_layer_poisson=0.25, body2_layer_thickness="1e-5,2e-5"
    )
    conftest.execute(launcher, tmp_path, [case, dict(output="c.h5")], 1, 0)
    options = dict(input="c.h5", section="y=0", depths="0:1e-4:21")
    words = {"one.h5": "5e8", "two.h5": "5e8,5e8"}
    texts = [
        conftest.execute(
            launcher, tmp_path, [options, dict(output=name, layer_strength=given)], 1, 0, program=PROGRAM
        ).stdout
        for name, given in words.items()
    ]
    one, two = (re.findall(r"safety \S+|no tension", text) for text in texts)
    assert one == two and len(one) == 2

"""Thermal expansion: the contact that its own heat changes, the displacements, and the stresses below the surface."""

import h5py
import numpy as np
import pytest

import petsam as package
from support import history

# in units E* = R = 1: beta = (1 + nu) alpha mu V/conductivity, N = 4/3; half width and maximum pressure
OWN_HEAT = [(0.5, 0.960094, 0.7036897), (1, 0.920051, 0.7808265), (3, 0.762351, 1.221313)]
SLIDING = dict(
    body1_young=1.82e9, body1_poisson=0.3, body2_young=1.82e9, body2_poisson=0.3, friction=0.1, gap_type="sphere",
    gap_radius1=1, gap_radius2="inf", grid_size=2.6, heat="steady", body1_conductivity=1, body2_conductivity=1e-9,
    body1_heat_capacity=1, body2_heat_capacity=1, load_n=4e9 / 3, disp_x=1e3,
)  # fmt: skip


@pytest.mark.parametrize("beta, half, most", OWN_HEAT)
def test_a_sphere_under_its_own_heat(tmp_path, beta, half, most):
    """Body 1 stands and takes all heat, on which 1 km of slip in 1 s leaves no doubt."""
    expansion = beta / (1.3 * 0.1 * 1e3 * 1e9)
    results = package.run(**SLIDING, grid_n=97, body1_expansion=expansion, output=tmp_path / "own.h5")
    assert results["pressure_max"][-1] == pytest.approx(1e9 * most, rel=1.2e-3 if beta < 2 else 2e-3)
    assert results["contact_area"][-1] == pytest.approx(np.pi * half**2, rel=6e-3)
    assert 3 < results["thermal_passes"][-1] < 9
    rise, pressure = -results["thermal_displacement_z"][-1], results["pressure"][-1]
    assert results["thermal_displacement_max"][-1] == rise.max() and np.argmax(rise) == np.argmax(pressure)


def test_both_bodies_share_the_expansion(tmp_path):
    """Equal bodies: half of the heat each, twice the surfaces; their displacements along the surface are the same."""
    expansion = 1 / (1.3 * 0.1 * 1e3 * 1e9)
    case = dict(SLIDING, body2_conductivity=1, grid_n=49)
    both = package.run(**case, body1_expansion=expansion, body2_expansion=expansion, output=tmp_path / "both.h5")
    one = package.run(**case, body1_expansion=2 * expansion, output=tmp_path / "one.h5", output_fields="all")
    assert both["pressure_max"][-1] == pytest.approx(one["pressure_max"][-1], rel=1e-4)
    along = one["thermal_displacement_x"][-1]
    assert (along[:, 25:] < 0).all() and (along[:, :24] > 0).all()  # body 1 spreads, and body 2 does not
    with h5py.File(tmp_path / "one.h5") as file:
        assert file.attrs["body1_expansion"] == 2 * expansion


def test_a_step_that_begins_to_slide_has_another_pressure(tmp_path):
    """The load stays, and the heat changes the gap of similar bodies."""
    case = {name: value for name, value in SLIDING.items() if name not in ("load_n", "disp_x")}
    history = {"time": [1, 2], "load_n": [4e9 / 3] * 2, "disp_x": [0, 1e3]}
    results = package.run(**case, grid_n=33, body1_expansion=1e-8, history=history, output=tmp_path / "two.h5")
    still, slides = results["pressure_max"]
    assert slides > 1.1 * still and results["thermal_passes"][0] == 0


def test_no_expansion_is_none(tmp_path):
    cold = package.run(**SLIDING, grid_n=21, output=tmp_path / "cold.h5")
    none = package.run(**SLIDING, grid_n=21, body1_expansion=0, output=tmp_path / "none.h5")
    np.testing.assert_array_equal(cold["pressure"], none["pressure"])
    assert "thermal_displacement_max" not in none


@pytest.fixture
def fretting(tmp_path):
    """A loop of unlike bodies, one of which moves, with friction that follows the temperature."""
    case = dict(
        body1="steel", body2="Ti-6Al-4V", gap_type="sphere", gap_radius1=0.02, gap_radius2="inf", friction=0.5,
        grid_n=(21, 18), grid_size=6e-4, heat="steady", friction_temperature=(0, 1e2, -0.1), steps=2,
        body1_expansion=1.2e-3, body2_expansion=9e-4, body2_speed=0.4,
    )  # fmt: skip
    rows = [(1e-4, 50, 15), (2e-4, 50, -15), (3e-4, 50, 15)]
    return {**case, **history(tmp_path / "loop.csv", "time,load_n,load_tx", *rows)}


def test_ranks_and_restarts_have_the_same_bits(petsam, fretting, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    fields = "-output_fields", "usual,thermal_displacement_x"
    fretting["grid_n"] = (13, 11)
    for ranks in (1, 3):
        petsam(fretting, "-output", f"{ranks}.h5", *fields, ranks=ranks)
    petsam(fretting, "-checkpoint", "state.h5", "-checkpoint_every", "3", "-output", "other.h5", *fields)
    petsam(fretting, "-restart", "state.h5.1", "-output", "rest.h5", *fields)
    with h5py.File("1.h5") as one:
        assert (one["history/thermal_passes"][1:] > 2).all()
        cold = one["history/pressure_max"][0]
        assert abs(one["history/pressure_max"][-1] / cold - 1) > 1e-6  # so that heat has changed the contact
        for name in ("pressure", "shear_x", "thermal_displacement_z", "thermal_displacement_x"):
            whole = one[name][:]
            for other, count in (("3.h5", 6), ("rest.h5", 3)):
                with h5py.File(other) as file:
                    np.testing.assert_array_equal(whole[-count:], file[name][:])


def test_rejected_steps_leave_no_displacement(fretting):
    case = {name: value for name, value in fretting.items() if name not in ("history", "steps")}
    contact, other, time = package.Contact(**case), package.Contact(**case), 0.0
    for load in (15, -10):
        time += 1e-4
        contact.try_step(time, load_n=50, load_tx=0.9 * load)
        contact.reject()
        for one in (contact, other):
            one.try_step(time, load_n=50, load_tx=load)
            one.commit()
    np.testing.assert_array_equal(contact["thermal_displacement_z"], other["thermal_displacement_z"])


def test_cells_at_the_edge_are_held(tmp_path):
    """A pin on a moving disc: heat crosses at the edge, where cells come and leave from pass to pass."""
    history = {"time": [1e-4, 2e-4], "load_n": [200, 200], "disp_x": [-1e-4, -2e-4]}
    results = package.run(
        body1="steel", body2="steel", gap_type="sphere", gap_radius1=0.2, gap_radius2="inf", friction=0.3, grid_n=32,
        grid_size=2.4e-3, heat="steady", errors="none", body1_expansion=12e-6, body2_expansion=12e-6, body2_speed=1,
        history=history, output=tmp_path / "pin.h5",
    )  # fmt: skip
    assert (results["thermal_passes"] < 35).all() and (results["thermal_error"] < 0.01).all()
    assert results["pressure_max"][-1] == pytest.approx(350e6, rel=0.01)


def test_no_contact_has_no_displacement(fretting, tmp_path):
    """Bodies that part take no heat: the displacement of the step before is gone, and is not in the next contact."""
    rows = [(1e-4, 50, 15), (2e-4, 0, 0), (3e-4, 50, 15)]
    case = {**fretting, **history(tmp_path / "parts.csv", "time,load_n,load_tx", *rows), "steps": 1}
    results = package.run(**case, output=tmp_path / "parts.h5")
    found = results["thermal_displacement_z"]
    assert results["thermal_displacement_max"][0] > 1e-9
    assert (found[1] == 0).all() and results["thermal_displacement_max"][1] == 0
    np.testing.assert_allclose(found[2], found[0], atol=1e-5 * abs(found[0]).max())


COOLING = dict(
    SLIDING, body2_conductivity=1, grid_n=48, body1_bulk_temperature=100, heat_resistance=1e-4, body1_expansion=1e-4,
    disp_x=0, errors="none",
)  # fmt: skip


def test_a_body_that_cools_moves_away(petsam, tmp_path):
    """Body 1 loses its heat to body 2, so that its surface sinks where it touches: the number is that displacement."""
    done = petsam(COOLING, "-tangential_rtol", 1e-9, "-output", tmp_path / "cool.h5")
    assert "m away from each other" in done.stdout
    results = package.open(tmp_path / "cool.h5")
    sinks = results["thermal_displacement_z"][-1]
    assert results["pressure"][-1].flat[np.argmax(sinks)] > 0.99 * results["pressure_max"][-1]
    assert results["thermal_displacement_max"][-1] == -sinks.max() < 0


def test_a_slip_of_the_displacement_alone_is_as_accurate_as_its_tolerance(tmp_path):
    """No load but the thermal displacement moves the surfaces: passes end at an error that the step states."""
    rough = package.run(**COOLING, output=tmp_path / "rough.h5")
    tight = package.run(**COOLING, tangential_rtol=1e-9, output=tmp_path / "tight.h5")
    assert rough["thermal_error"][-1] < 2e-3 and tight["thermal_error"][-1] < 1e-5
    assert rough["pressure_max"][-1] == pytest.approx(tight["pressure_max"][-1], rel=1e-3)


# ---- stresses ----


@pytest.fixture(scope="module")
def heated(tmp_path_factory):
    """A contact whose bodies stand, in a file, and the same file without its expansion."""
    folder = tmp_path_factory.mktemp("heated")
    case = dict(
        body1="steel", body2="aluminium", gap_type="sphere", gap_radius1=0.02, gap_radius2="inf", friction=0.5,
        grid_n=(30, 27), grid_size=1e-3, heat="steady", load_n=50, disp_x=1e-3, body1_expansion=12e-6,
        body2_expansion=23e-6, body1_bulk_temperature=20,
    )  # fmt: skip
    package.run(**case, output=folder / "hot.h5")
    (folder / "cold.h5").write_bytes((folder / "hot.h5").read_bytes())
    with h5py.File(folder / "cold.h5", "r+") as file:
        file.attrs["body1_expansion"] = file.attrs["body2_expansion"] = 0.0
    return folder


@pytest.mark.parametrize("body, young, expansion", [(1, 210e9, 12e-6), (2, 70e9, 23e-6)])
def test_thermal_stress_is_that_of_the_temperature(stress, heated, tmp_path, body, young, expansion):
    """Of a body that stands: no stress on planes parallel to the surface, and the sum of the others -E alpha T."""
    found = {}
    for name in ("hot", "cold"):
        out = tmp_path / f"{name}.h5"
        stress("-input", heated / f"{name}.h5", "-body", body, "-depths", "0,5e-5,2e-4", "-quantities",
                      "stress,temperature", "-output", out)  # fmt: skip
        with h5py.File(out) as file:
            found[name] = {key: file[key][0] for key in file if key.startswith(("stress", "temperature"))}
    change = {key: found["hot"][key] - found["cold"][key] for key in found["hot"]}
    bulk = 20 if body == 1 else 0
    scale = young * expansion * abs(found["hot"]["temperature"] - bulk).max()
    assert abs(change["stress_xx"]).max() > 0.3 * scale
    np.testing.assert_allclose(
        change["stress_xx"] + change["stress_yy"],
        -young * expansion * (found["hot"]["temperature"] - bulk),
        atol=1e-9 * scale,
    )
    for other in ("stress_zz", "stress_xz", "stress_yz"):
        assert abs(change[other]).max() <= 1e-9 * scale


def test_sections_are_those_of_maps(stress, heated, tmp_path):
    for name, more in (("map", ()), ("row", ("-section", "y=0")), ("column", ("-section", "x=0"))):
        stress("-input", heated / "hot.h5", "-body", 2, "-depths", "0,1e-4", *more, "-output",
                      tmp_path / f"{name}.h5", ranks=2 if more else 1)  # fmt: skip
    with h5py.File(tmp_path / "map.h5") as whole, h5py.File(tmp_path / "row.h5") as row:
        with h5py.File(tmp_path / "column.h5") as column:
            for name in ("stress_xx", "stress_xy"):
                scale = abs(whole[name][:]).max()
                line = np.argmin(abs(whole["y"][:] - row["y"][0]))
                np.testing.assert_allclose(row[name][0, :, 0], whole[name][0, :, line], atol=1e-9 * scale)
                line = np.argmin(abs(whole["x"][:] - column["x"][0]))
                np.testing.assert_allclose(column[name][0, :, :, 0], whole[name][0, :, :, line], atol=1e-9 * scale)


# ---- what is refused ----


@pytest.mark.parametrize(
    "change, words",
    [
        (dict(body1_expansion=0.02), "steel has 12e-6"),
        (dict(body2_expansion=1e-5, body2_young="inf"), "is rigid and does not expand"),
        (dict(body1_expansion=1e-5, load_n=None, disp_z=1e-3), "give load_n"),
        (dict(body1_expansion=1e-5, body1_yield=1e7), "-body1_expansion: not supported with -body1_yield"),
        (dict(body1_expansion=1e-5, pressure_limit=1e9), "-body1_expansion: not supported with -pressure_limit"),
        (dict(body1_expansion=1e-5, heat=None), "heat steady"),
        (
            dict(body1_expansion=1e-5, elasticity="plane", gap_type="cylinder", body1_speed=1, body2_speed=1),
            "has no datum",
        ),
    ],
)
def test_expansion_is_refused(petsam, change, words):
    case = {**SLIDING, "grid_n": 16, **change}
    assert words in petsam(case, check=2).stderr


def test_stresses_without_their_heat_are_refused(stress, heated, tmp_path):
    (tmp_path / "less.h5").write_bytes((heated / "hot.h5").read_bytes())
    with h5py.File(tmp_path / "less.h5", "r+") as file:
        del file["heat_2"]
    done = stress("-input", tmp_path / "less.h5", "-body", 2, "-output", tmp_path / "s.h5", check=2)
    assert "its thermal stress would be missing" in done.stderr


@pytest.mark.parametrize("section", [None, "y=0"])
def test_stresses_in_process_are_those_of_the_file(petsam, stress, fretting, tmp_path, section):
    """Two steps in process have the thermal stress and the temperature that petsam-stress finds in their results."""
    case = {name: value for name, value in fretting.items() if name not in ("history", "steps")}
    rows = [(1e-4, 50, 15), (2e-4, 50, -15)]
    ask = ("-section", section) if section else ()
    petsam(
        {**case, **history(tmp_path / "two.csv", "time,load_n,load_tx", *rows), "steps": 1}, "-output",
        tmp_path / "two.h5", "-output_fields", "usual",
    )  # fmt: skip
    stress("-input", tmp_path / "two.h5", "-body", 1, "-depths", "0,3e-5", "-quantities", "stress,temperature", *ask,
           "-output", tmp_path / "s.h5")  # fmt: skip
    contact = package.Contact(**case)
    for row in rows:
        contact.try_step(row[0], load_n=row[1], load_tx=row[2])
        contact.commit()
    found = contact.stress(
        body=1, depths=[0, 3e-5], quantities=["stress", "temperature"], **({"section": section} if section else {})
    )
    with h5py.File(tmp_path / "s.h5") as file:
        for name in ("stress_xx", "stress_xy", "stress_zz", "temperature"):
            last = file[name][-1]
            np.testing.assert_array_equal(found[name][-1], last)
        assert np.abs(file["temperature"][:]).max() > 0.1


def test_stresses_of_slow_bodies_are_refused(stress, tmp_path):
    case = dict(SLIDING, body2_conductivity=1, grid_n=16, body1_speed=1e-3, body1_expansion=1e-12, load_n=1e6)
    package.run(**case, output=tmp_path / "slow.h5")
    done = stress("-input", tmp_path / "slow.h5", "-body", 1, "-output", tmp_path / "s.h5", check=2)
    assert "its heat reaches beyond the grid" in done.stderr


def test_no_convergence_is_reported(petsam, fretting):
    """So large an expansion that the slip of a step makes more displacement than the slip itself."""
    done = petsam({**fretting, "body1_expansion": 9e-3, "body2_expansion": 6e-3, "step_divide": "no"}, check=10)
    assert "step 4: the thermal displacement did not converge with the pressure in 80 passes" in done.stderr

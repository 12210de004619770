"""Temperatures below the surface by petsam-stress: beside sums over cells and the age of the heat."""

import h5py
import numpy as np
import pytest
from scipy.special import erf

import petsam as package
from support import few

PAIR = dict(
    body1="steel", body2="Ti-6Al-4V", gap_type="sphere", gap_radius1=20e-3, gap_radius2="inf", grid_n=(17, 14),
    grid_size=(0.6e-3, 0.52e-3), load_n=60, friction=0.4, history="once.csv", heat="steady",
    body2_bulk_temperature=20.0, output="hot.h5",
)  # fmt: skip
DEPTHS = np.array([0, 2e-5, 1e-4, 6e-4])


@pytest.fixture(autouse=True)
def once(tmp_path, monkeypatch):
    """One step of half a second."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "once.csv").write_text("time,disp_x\n0.5,-1e-5\n")


def below(body, results, place):
    """The temperature at a place (m) by the flux on each cell, integrated over the width s of its Gaussian."""
    conductivity, capacity, speed, bulk = (
        float(results.parameters.get(f"body{body}_{name}", 0.0))
        for name in ("conductivity", "heat_capacity", "speed", "bulk_temperature")
    )
    drift = -speed * capacity / conductivity / 2  # P, towards -x
    flux = results.field(f"heat_{body}")
    a, b = (abs(axis[1] - axis[0]) / 2 for axis in (results.x, results.y))
    logs, weights = np.polynomial.legendre.leggauss(600)
    ends = np.log(2e-6), np.log(3e3)
    s = np.exp(ends[0] + (ends[1] - ends[0]) * (logs + 1) / 2)
    weights = weights * s * (ends[1] - ends[0]) / 2
    found = 0.0
    for j, i in zip(*np.nonzero(flux)):
        x, y = place[0] - results.x[i] + drift * s**2 / 2, place[1] - results.y[j]
        along = (erf((x + a) / s) - erf((x - a) / s)) / 2
        across = (erf((y + b) / s) - erf((y - b) / s)) / 2
        found += flux[j, i] * np.sum(weights * along * across * np.exp(-((place[2] / s) ** 2)))
    return bulk + found / (conductivity * np.sqrt(np.pi))


@few("body, speeds", [(1, (0, 0)), (2, (-0.4, 0)), (1, (-0.4, 0)), (2, (0, 0)), (1, (0, 0.7)), (2, (0, 0.7))])
def test_below_the_surface(petsam, stress, tmp_path, body, speeds):
    petsam(dict(PAIR, body1_speed=speeds[0], body2_speed=speeds[1]))
    words = dict(input="hot.h5", body=body, quantities="temperature,mises", depths=",".join(map(str, DEPTHS)))
    stress(dict(words, output="map.h5"))
    stress(dict(words, output="ranks.h5"), ranks=3)
    stress(dict(words, output="line.h5", section="y=4e-5"), ranks=2)
    stress(dict(words, output="across.h5", section="x=-1e-4"), ranks=3)
    with package.open(tmp_path / "hot.h5") as results, h5py.File(tmp_path / "map.h5") as f:
        found = f["temperature"][0]
        assert f["temperature"].attrs["units"] in ("K", b"K")
        np.testing.assert_allclose(found[0], results.field(f"temperature_{body}"), rtol=1e-9, atol=1e-9)
        hot = found[0].max()
        for k, j, i in ((1, 7, 9), (2, 8, 6), (2, 3, 12), (3, 7, 2)):
            expected = below(body, results, (results.x[i], results.y[j], DEPTHS[k]))
            assert found[k, j, i] == pytest.approx(expected, abs=2e-4 * hot)
        row, column = (int(np.argmin(np.abs(axis - at))) for axis, at in ((results.y, 4e-5), (results.x, -1e-4)))
    for name, plane in (
        ("ranks", found),
        ("line", found[:, row : row + 1]),
        ("across", found[:, :, column][..., None]),
    ):
        with h5py.File(tmp_path / f"{name}.h5") as f:
            np.testing.assert_array_equal(f["temperature"][0], plane)


def test_steps_and_rolling(petsam, stress, tmp_path):
    """Each step has its own temperatures; in steady rolling both bodies move at the rolling speed."""
    (tmp_path / "h.csv").write_text("time,disp_x\n1,0\n2,1e-5\n3,3e-5\n")
    petsam({**PAIR, "history": "h.csv"})
    stress(dict(input="hot.h5", output="t.h5", body=1, quantities="temperature", steps="all", section="y=0"))
    with package.open(tmp_path / "hot.h5") as results, h5py.File(tmp_path / "t.h5") as f:
        row = int(np.argmin(np.abs(results.y)))
        for k in range(3):
            np.testing.assert_allclose(f["temperature"][k, 0, 0], results.field("temperature_1", k)[row], rtol=1e-9)
    rolls = {**PAIR, "history": None, "rolling": "steady", "rolling_speed": 3, "creep_x": 0.01}
    petsam(rolls)
    stress(dict(input="hot.h5", output="t.h5", body=2, quantities="temperature", section="y=0"))
    with package.open(tmp_path / "hot.h5") as results, h5py.File(tmp_path / "t.h5") as f:
        np.testing.assert_allclose(f["temperature"][0, 0, 0], results.field("temperature_2")[row], rtol=1e-9)


def test_refusals(petsam, stress, tmp_path):
    """Results and steps without heat, or without its fields, are refused with the cure; steps that have it have it."""
    petsam({k: v for k, v in PAIR.items() if k not in ("heat", "body2_bulk_temperature")})
    words = dict(input="hot.h5", output="t.h5", quantities="temperature")
    assert "run petsam with -heat steady" in stress(words, check=2).stderr
    petsam(dict(PAIR, output_fields="pressure,shear_x,shear_y"))
    assert "heat_1 and heat_2" in stress(words, check=2).stderr
    assert not (tmp_path / "t.h5").exists()
    options = {name: value for name, value in PAIR.items() if name not in ("output", "load_n", "history")}
    with package.Contact(**options) as contact:
        contact.try_step(load_n=100, disp_x=1e-5, time=1.0)
        contact.commit()
        found = contact.stress(quantities="temperature", depths="0")["temperature"]
        np.testing.assert_allclose(found[0, 0], contact["temperature_2"], rtol=1e-12)
    with package.Contact(
        **{name: value for name, value in options.items() if name not in ("heat", "body2_bulk_temperature")}
    ) as cold:
        cold.try_step(load_n=100, disp_x=1e-5, time=1.0)
        with pytest.raises(package.Error, match="has no frictional heat"):
            cold.stress(quantities="temperature", depths="0")

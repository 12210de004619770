"""petsam-stress in plane strain: McEwen's stresses, the edges, partial slip, antiplane shear, bulk stress, fatigue."""

import h5py
import numpy as np
import pytest

import conftest
from layers import Body
from support import history
from test_embed import run_python
from test_plane import CYLINDER, MU, NU, P0, A, N

PROGRAM = conftest.PROGRAM.with_name("petsam-stress")
COMPONENTS = ("xx", "yy", "zz", "xy", "xz", "yz")
CASE = dict(CYLINDER, load_n=None, grid_n=512, grid_size=7.3e-4, output="c.h5")


@pytest.fixture
def stress(launcher, petsam, tmp_path):
    """stress(loads, options): stresses over p0 of a history of loads (rows), by component, and the file."""

    def run(names, rows, ranks=1, case=CASE, **options):
        petsam(case, history(tmp_path / "h.csv", "time," + names, *rows), dict(overwrite=True, steps=1))
        (tmp_path / "s.h5").unlink(missing_ok=True)
        conftest.execute(
            launcher, tmp_path, [dict(dict(input="c.h5", output="s.h5"), **options)], ranks, 0, program=PROGRAM
        )
        with h5py.File(tmp_path / "s.h5") as f:
            fields = {name: f[name][()] for name in f if isinstance(f[name], h5py.Dataset)}
            return fields, {k: v[()] for k, v in f["history"].items()}

    return run


SLIDE = "load_n,disp_x", [(0.0, N, 0.0), (1.0, N, 1e-5)]


def mcewen(x, z):
    """xx, zz, xz over p0 by the pressure, and by q = p; x and z over a. Johnson, eqs 4.49, 8.17."""
    b = 1 - x**2 + z**2
    m = np.sqrt(0.5 * (np.sqrt(b * b + 4 * x * x * z * z) + b))
    n = np.sign(x) * np.sqrt(np.maximum(0.5 * (np.sqrt(b * b + 4 * x * x * z * z) - b), 0))
    s = m * m + n * n
    xx, zz = -(m * (1 + (z * z + n * n) / s) - 2 * z), -m * (1 - (z * z + n * n) / s)
    xz = -n * (m * m - z * z) / s
    return (xx, zz, xz), (n * (2 - (z * z - m * m) / s) - 2 * x, xz, xx)


@pytest.mark.parametrize("body", [1, 2])
def test_hertz_sliding_is_mcewen_s(stress, body):
    s, largest = stress(*SLIDE, depths="0:4.8e-4:41", body=body, quantities="stress,shear_max")
    x, z = np.meshgrid(s["x"] / A, s["z"] / A)
    by_p, by_q = mcewen(x, z)
    inside = (z > 0.02) | (np.abs(x) < 0.95)
    mu = MU if body == 2 else -MU
    for k, name in enumerate(("xx", "zz", "xz")):
        here = s[f"stress_{name}"][0, :, 0] / P0 - by_p[k] - mu * by_q[k]
        assert np.abs(here[inside]).max() < 3e-4, name
    both = s["stress_xx"] + s["stress_zz"]
    assert np.abs(s["stress_yy"] - NU * both).max() < 1e-12 * P0
    assert not s["stress_xy"].any() and not s["stress_yz"].any()
    # tension 2 mu p0 behind: with an infinite slope on both sides, but found by the edge
    assert largest["edge_stress_xx_max"][0] == pytest.approx(2 * MU * P0, rel=1e-3)
    assert largest["edge_stress_xx_max_x"][0] == pytest.approx(-A if body == 2 else A, rel=2e-3)


def test_largest_shear_of_hertz(stress):
    s, _ = stress("load_n", [(0.0, N), (1.0, N)], depths="1.8e-4:2e-4:21", quantities="shear_max")
    middle = s["shear_max"][0, :, 0].max(axis=1)
    k = middle.argmax()
    assert middle[k] == pytest.approx(0.300 * P0, abs=5e-4 * P0) and s["z"][k] == pytest.approx(0.786 * A, rel=4e-3)


def test_partial_slip_on_the_surface(stress):
    """s_xx = -p less 2/pi times the principal value of q/(x - t): Cattaneo's q is two ellipses."""
    T = 3e4
    s, _ = stress("load_n,load_tx", [(0.0, N, 0.0), (1.0, N, T)], depths=0.0)
    x, c = s["x"], A * np.sqrt(1 - T / (MU * N))

    def ellipse(t):  # the integral of sqrt(1 - t^2)/(x - t), over pi
        return t - np.where(np.abs(t) > 1, np.sign(t) * np.sqrt(np.maximum(t * t - 1, 0)), 0)

    p = np.sqrt(np.maximum(1 - (x / A) ** 2, 0))
    exact = -p - 2 * MU * (ellipse(x / A) - c / A * ellipse(x / c))
    away = np.minimum(np.abs(np.abs(x) - A), np.abs(np.abs(x) - c)) > 0.02 * A
    assert np.abs(s["stress_xx"][0, 0, 0] / P0 - exact)[away].max() < 2e-3


def test_antiplane_shear(stress, tmp_path):
    s, _ = stress("load_n,load_ty", [(0.0, N, 0.0), (1.0, N, 3e4)], depths="0,1e-5,1e-4", case=dict(CASE, grid_n=256))
    with h5py.File(tmp_path / "c.h5") as f:
        q, x = f["shear_y"][-1, 0], f["x"][:]
    h, t = x[1] - x[0], (np.arange(40) + 0.5) / 40 - 0.5
    at = (x[:, None] + h * t[None, :]).ravel()
    load = np.repeat(q, 40) * h / 40
    for k, z in ((1, 1e-5), (2, 1e-4)):
        away = (x[:, None] - at[None, :]) / np.pi
        square = (x[:, None] - at[None, :]) ** 2 + z * z
        assert np.abs(s["stress_yz"][0, k, 0] + (z / np.pi / square) @ load).max() < 1e-6 * P0
        assert np.abs(s["stress_xy"][0, k, 0] + (away / square) @ load).max() < 1e-6 * P0
    assert np.array_equal(s["stress_yz"][0, 0, 0], -q)


def test_bulk_stress_sections_ranks_and_fatigue(stress, launcher, tmp_path):
    bulk = "load_n,load_tx,bulk2_stress_xx"
    rows = [(0.0, N, 0.0, 0.0), (1.0, N, 2e4, 8e7), (2.0, N, -2e4, -8e7), (3.0, N, 2e4, 8e7)]
    options = dict(
        depths="0,1e-5,2e-4,2e-3",
        steps="2:4",
        fatigue="swt,fatemi_socie,crossland",
        fatigue_fatemi_socie_k=0.5,
        fatigue_yield=5e8,
        fatigue_crossland_alpha=0.3,
    )
    s, _ = stress(bulk, rows, **options)
    assert s["stress_xx"][0, -1, 0, 0] == pytest.approx(8e7, rel=0.05)
    assert np.abs(s["stress_yy"] - NU * (s["stress_xx"] + s["stress_zz"])).max() < 1e-9 * P0
    # SWT is largest on the surface at a trailing edge
    place = np.unravel_index(np.nanargmax(s["swt"]), s["swt"].shape)
    assert place[0] == 0 and abs(abs(s["x"][place[-1]]) / A - 1) < 0.05
    for more in (dict(section="y=0"), dict(section="y=0", ranks=3), dict(ranks=2)):
        t, _ = stress(bulk, rows, **dict(options, **more))
        for name in s:
            if "ranks" in more and "section" not in more:
                assert np.array_equal(s[name], t[name], equal_nan=True), name
            else:
                scale = max(np.abs(np.nan_to_num(s[name])).max(), P0 if name.startswith("stress") else 0)
                assert np.abs(np.nan_to_num(s[name]) - np.nan_to_num(t[name])).max() <= 1e-7 * scale or "normal" in name
    run = conftest.execute(
        launcher, tmp_path, [dict(input="c.h5", output="x.h5", section="x=0")], 1, 2, program=PROGRAM
    )
    assert "-section x=0: a plane problem has no section along y: give y=0, or omit it" in run.stderr


def test_embedded_stresses_are_the_same_bits(stress, tmp_path):
    s, _ = stress("load_n,load_tx", [(0.0, N, 0.0), (1.0, N, 2e4)], depths="0,1e-4", quantities="stress")
    options = {k: v for k, v in CASE.items() if v is not None and k not in ("output", "output_fields")}
    run_python(
        f"""
import petsam, numpy as np
from math import inf
with petsam.Contact(**{options!r}) as c:
    for tx in (0.0, 2e4):
        c.try_step(load_n={N}, load_tx=tx)
        c.commit()
    np.savez("here.npz", **c.stress(depths=[0.0, 1e-4], quantities=["stress"]))
""",
        tmp_path,
    )
    here = np.load(tmp_path / "here.npz")
    for name in COMPONENTS:
        assert np.array_equal(here[f"stress_{name}"], s[f"stress_{name}"]), name


LAYERS = [(8e11, 0.2, 2e-5), (5e10, 0.4, 6e-5)]


@pytest.mark.parametrize("base", [(2e11, 0.3), None])
def test_stresses_through_layers(stress, tmp_path, base):
    """Against integrals over the waves, of layers solved by one linear system each, with the tractions in the file."""
    case = dict(
        CASE,
        body1_young=float("inf"),
        body2_young=base[0] if base else float("inf"),
        body2_poisson=base[1] if base else 0.3,
        body2_layer_young="8e11,5e10",
        body2_layer_poisson="0.2,0.4",
        body2_layer_thickness="2e-5,6e-5",
        grid_n=201,
    )
    depths = [1.5e-5, 3e-5, 7.9e-5] + ([8.1e-5, 3e-4] if base else [])
    columns = "load_n,load_tx,load_ty"
    s, _ = stress(columns, [(0.0, 3e4, 0.0, 0.0), (1.0, 3e4, 6e3, 4e3)], depths=",".join(map(str, depths)), case=case)
    body = Body(LAYERS, base)
    with h5py.File(tmp_path / "c.h5") as f:
        x, p, qx, qy = f["x"][:], *(f[name][-1, 0] for name in ("pressure", "shear_x", "shear_y"))
    h = x[1] - x[0]
    for n, z in enumerate(depths):
        # panels of eight points, shorter for long waves, as far as exp(-kz) reaches
        edges = np.concatenate([[0.0], np.geomspace(1.0, 2e3, 30), np.arange(4e3, 30 / z, 3e3)])
        point, weight = np.polynomial.legendre.leggauss(8)
        k = (edges[:-1, None] + np.diff(edges)[:, None] * (point + 1) / 2).ravel()
        w = (np.diff(edges)[:, None] * weight / 2).ravel() / np.pi * 2 * np.sin(k * h / 2) / k
        waves = np.exp(1j * np.outer(x, k))
        P, Qx, Qy = (w * (np.conj(waves).T @ q) for q in (p, qx, qy))
        plane, across = body.stresses(z, k)
        exact = dict(
            xx=(waves @ (P * plane[0, 1])).real - (waves @ (Qx * plane[0, 0])).imag,
            zz=(waves @ (P * plane[1, 1])).real - (waves @ (Qx * plane[1, 0])).imag,
            xz=(waves @ (P * plane[2, 1])).imag + (waves @ (Qx * plane[2, 0])).real,
            yz=(waves @ (Qy * across[0])).real,
            xy=(waves @ (Qy * across[1])).imag,
        )
        nu = [*LAYERS, base][0 if z < 2e-5 else 1 if z < 8e-5 else 2][1]
        exact["yy"] = nu * (exact["xx"] + exact["zz"])
        for name in COMPONENTS:
            error = s[f"stress_{name}"][0, n, 0] - exact[name]
            assert np.abs(error).max() < 1e-9 * p.max(), (name, z)

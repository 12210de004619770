"""Plane strain: closed forms with the order of their errors, per metre of length; what else a line of cells must do."""

import re

import h5py
import numpy as np
import pytest

from petsam.closed import plane as closed_plane
from petsam.closed.punch import Punch
from support import assert_same, history
from test_embed import run_python

YOUNG, NU, MU, R, N = 200e9, 0.3, 0.5, 0.05, 1e5
E_STAR = YOUNG / 2 / (1 - NU**2)
A = 2.406915e-4  # half width, m
P0 = 264.49616e6
WIDTH = 6.3e-4
CYLINDER = dict(
    elasticity="plane",
    body1_young=YOUNG,
    body2_young=YOUNG,
    body1_poisson=NU,
    body2_poisson=NU,
    gap_type="ellipsoid",
    gap_radius_x=R,
    gap_radius_y=float("inf"),
    friction=MU,
    load_n=N,
    grid_n=256,
    grid_size=WIDTH,
    output_fields="all",
)


def root(x, a):
    """The mean over cells about x of sqrt(1 - x^2/a^2)."""
    h = (x[1] - x[0]) / 2

    def primitive(x):
        s = np.clip(x / a, -1, 1)
        return a / 2 * (s * np.sqrt(1 - s * s) + np.arcsin(s))

    return (primitive(x + h) - primitive(x - h)) / (2 * h)


def cattaneo(x, c, at=0.0):
    """q over mu p0 under T, the stick zone of half width c about `at`."""
    return root(x, A) - c / A * root(x - at, c)


def rms(values):
    return np.sqrt(np.mean(values**2))


def test_reference_numbers(solve):
    assert 4 * N * R / (np.pi * E_STAR) == pytest.approx(A**2, rel=1e-6)
    r = solve(CYLINDER, dict(grid_n=1000, load_tx=2.5e4))
    c = A * np.sqrt(1 - 2.5e4 / (MU * N))
    assert r["contact_area"] == pytest.approx(2 * A, rel=1e-4)
    assert r["stick_area"] == pytest.approx(2 * c, rel=3e-4)
    assert r["pressure_max"] == pytest.approx(P0, rel=1e-5)
    assert r["shear_max"] == pytest.approx(MU * P0 * np.sqrt(1 - c**2 / A**2), rel=3e-4)
    # -(2/(pi E*)) int p ln(|x|/D), D the width of the grid
    far = 2 * N / (np.pi * E_STAR)
    assert r["disp_z"] == pytest.approx(far * (np.log(2 * WIDTH / A) + 0.5), rel=1e-5)
    # the shear displaces its own stick zone uniformly: mu times that of the pressure, less that of the reduced one
    assert r["disp_x"] == pytest.approx(
        MU * far * (np.log(2 * WIDTH / A) + 0.5) - MU * far * (c / A) ** 2 * (np.log(2 * WIDTH / c) + 0.5), rel=1e-4
    )
    assert r["load_n"] == pytest.approx(N, rel=1e-12)


def test_errors_fall_with_the_cells_those_of_widths_with_their_square(solve):
    cells, c, errors = (60, 120, 240, 480), A * np.sqrt(0.5), []
    for n in cells:
        here = []  # by where the edges lie in their cells
        for part in range(5):
            size = WIDTH * (1 + 0.3 * part / n)
            r = solve(CYLINDER, dict(grid_n=n, grid_size=size, load_tx=2.5e4, normal_rtol=1e-9, tangential_rtol=1e-9))
            assert r["edge_accepted"] == 1
            pressure, shear = r.pressure[0] / P0 - root(r.x, A), r.shear_x[0] / (MU * P0) - cattaneo(r.x, c)
            here.append((rms(pressure), rms(shear), r["contact_area"] / (2 * A) - 1, r["stick_area"] / (2 * c) - 1))
        errors.append(np.sqrt(np.mean(np.square(here), 0)))
    errors = np.array(errors)
    order = -np.polyfit(np.log(cells), np.log(errors), 1)[0]
    assert (errors[-1] < (1e-3, 1e-3, 2e-4 * WIDTH / 480 / A, 3e-4 * WIDTH / 480 / A)).all()
    assert (order > (0.7, 0.7, 1.6, 1.5)).all()


def test_reversed_load_is_a_superposition(petsam, tmp_path):
    rows = history(
        tmp_path / "h.csv", "time,load_n,load_tx", (0.0, N, 0.0), (1.0, N, 4e4), (2.0, N, -1e4), (3.0, N, -4e4)
    )
    r = petsam(dict(CYLINDER, load_n=None), rows, dict(steps=4, grid_n=500, output=tmp_path / "r.h5"))
    with h5py.File(tmp_path / "r.h5") as f:
        x, q, T = f["x"][:], f["shear_x"][:, 0], f["history/load_tx"][:]
        stick = f["history/stick_area"][:]
    for k in range(5, len(T)):
        if T[k] > T[k - 1]:
            continue
        reversed_part = A * np.sqrt(1 - (4e4 - T[k]) / (2 * MU * N))
        exact = cattaneo(x, A * np.sqrt(1 - 4e4 / (MU * N))) - 2 * cattaneo(x, reversed_part)
        assert rms(q[k] / (MU * P0) - exact) < 2e-3
        assert stick[k] == pytest.approx(2 * reversed_part, rel=3e-3)
    assert r.code == 0


def test_bulk_stress_shifts_the_stick_zone(petsam, tmp_path):
    """Nowell and Hills: by a s/(4 mu p0), its width as without."""
    s, T = 60e6, 1.5e4
    rows = history(tmp_path / "h.csv", "time,load_n,load_tx,bulk2_stress_xx", (0.0, N, 0.0, 0.0), (1.0, N, T, s))
    petsam(dict(CYLINDER, load_n=None), rows, dict(steps=1, grid_n=500, output=tmp_path / "r.h5"))
    c, e = A * np.sqrt(1 - T / (MU * N)), A * s / (4 * MU * P0)
    with h5py.File(tmp_path / "r.h5") as f:
        x, q = f["x"][:], f["shear_x"][-1, 0]
        assert f["history/stick_area"][-1] == pytest.approx(2 * c, rel=2e-3)
        assert f["history/bulk2_stress_yy"][-1] == pytest.approx(NU * s)
    difference = [rms(q / (MU * P0) - cattaneo(x, c, at)) for at in (e, -e)]
    assert min(difference) < 1e-3 and max(difference) > 0.05


@pytest.mark.parametrize("moment", [0.0, 30.0])
def test_rounded_punch_in_partial_slip(solve, moment):
    punch = Punch(1e-3, 20e-3, E_STAR)
    load, shear = 6e5, 0.6 * MU * 6e5
    r = solve(
        dict(CYLINDER, gap_type="punch", gap_radius_x=None, gap_radius_y=None),
        dict(gap_flat_radius=1e-3, gap_edge_radius=20e-3, load_n=load, load_my=moment, load_tx=shear),
        dict(grid_n=1000, grid_size=3.2e-3, normal_rtol=1e-11),
    )
    contact = closed_plane.contact_under_moment(punch, load, moment)
    stick = closed_plane.stick_zone(punch, contact, shear, MU)
    p = closed_plane.plane_pressure(r.x, punch, contact)
    q = closed_plane.plane_shear(r.x, punch, contact, stick, MU)
    assert rms(r.pressure[0] - p) < 4e-3 * rms(p) and rms(r.shear_x[0] - q) < 8e-3 * rms(q)
    assert r["contact_area"] == pytest.approx(2 * contact.half_width, rel=5e-4)
    assert r["stick_area"] == pytest.approx(2 * stick.half_width, rel=1e-3)
    assert r["rot_y"] == pytest.approx(closed_plane.plane_tilt(punch, contact), rel=2e-4, abs=1e-12)


def test_westergaard(solve, tmp_path):
    height, width, n = 1e-6, 1e-3, 1000
    x = ((np.arange(n) + 0.5) / n - 0.5) * width
    with h5py.File(tmp_path / "wave.h5", "w") as f:
        f["height"] = height * (1 - np.cos(2 * np.pi * x / width))[None, :]
    full, sine = np.pi * E_STAR * height / width, np.sin(0.3 * np.pi)
    r = solve(
        dict(CYLINDER, elasticity="plane_periodic", gap_type="file", gap_radius_x=None, gap_radius_y=None),
        dict(gap_file=tmp_path / "wave.h5", grid_n=n, grid_size=width, load_n=full * sine**2 * width),
    )
    s = np.sin(np.pi * x / width)
    exact = 2 * full * np.cos(np.pi * x / width) * np.sqrt(np.maximum(sine**2 - s**2, 0))
    assert rms(r.pressure[0] - exact) < 3e-3 * full
    assert r["contact_area"] == pytest.approx(0.6 * width, rel=1e-3)


def test_antiplane_load_shears_as_one_along_x(solve):
    """Without nu in it: by 1/(1 - nu) more displacement, the same shear."""
    along, across = (solve(CYLINDER, {"load_tx": 0.0, "load_ty": 0.0, name: 3e4}) for name in ("load_tx", "load_ty"))
    assert np.abs(along.shear_x - across.shear_y).max() < 1e-5 * MU * P0
    assert across["disp_y"] == pytest.approx(along["disp_x"] / (1 - NU), rel=1e-6)
    assert across["stick_area"] == pytest.approx(2 * A * np.sqrt(1 - 3e4 / (MU * N)), rel=1e-3)
    # both share the disc
    both = solve(CYLINDER, dict(load_tx=2e4, load_ty=2e4))
    assert (np.hypot(both.shear_x, both.shear_y) <= MU * both.pressure * (1 + 1e-9)).all()


def test_rolling_is_carter_s(solve):
    mu, T = 0.3, 2e4
    r = solve(CYLINDER, dict(friction=mu, load_tx=T, rolling="steady", grid_n=1000))
    exact = mu * A / R * (1 - np.sqrt(1 - T / (mu * N)))
    assert r["creep_x"] == pytest.approx(exact, rel=2e-3)
    assert np.isnan(r["creep_x_extrapolated"]) and "fine grid" not in r.run.stdout  # its error has no order
    assert r["stick_area"] == pytest.approx(2 * A * np.sqrt(1 - T / (mu * N)), rel=5e-3)


def test_moment_per_metre_has_units(solve):
    """N m per metre is N."""
    exact = solve(CYLINDER, dict(load_my=2.0))
    for text in "2Nm/m", "2N", "2e-3kN":
        assert solve(CYLINDER, dict(load_my=text))["rot_y"] == exact["rot_y"]


def test_datum_moves_displacements_only(solve):
    near, far = (solve(CYLINDER, dict(load_tx=2e4, plane_datum=d)) for d in (WIDTH, 1000 * WIDTH))
    assert_close = np.abs(near.pressure - far.pressure).max() < 1e-5 * P0
    assert assert_close and np.abs(near.shear_x - far.shear_x).max() < 1e-5 * P0
    by = 2 / (np.pi * E_STAR) * np.log(1000)
    assert far["disp_z"] - near["disp_z"] == pytest.approx(N * by, rel=1e-6)
    assert far["disp_x"] - near["disp_x"] == pytest.approx(2e4 * by, rel=1e-4)
    assert near.attributes["plane_datum"] == WIDTH and far.attributes["plane_datum"] == 1000 * WIDTH


@pytest.mark.parametrize("given, load", [("disp_z", "load_n"), ("disp_x", "load_tx"), ("disp_y", "load_ty")])
def test_displacement_without_a_datum_is_told(petsam, given, load):
    """Its load follows from the size of the grid; not so if the datum is given, or in periodic bodies."""

    def told(**more):
        case = dict(CYLINDER, friction=0.5, grid_n=64, **{given: 2e-7}, **more)
        if given == "disp_z":
            case["load_n"] = None
        return [line for line in petsam(case).complaint if f"{load} depends on it: give {load}, or" in line]

    assert len(told()) == 1 and f"warning: {given} is prescribed in plane strain" in told()[0]
    assert not told(plane_datum=0.1) and not told(elasticity="plane_periodic")
    base = dict(body1_young="inf", body2_young="inf", body2_layer_young=2e11, body2_layer_poisson=0.3)
    assert not told(**base, body2_layer_thickness=WIDTH)


def test_datum_of_stiff_layers_is_farther(solve, petsam):
    """Relative to a near point, loads would pull them: by default the datum is where problems have solutions."""
    layers = dict(body2_layer_young=5e12, body2_layer_poisson=0.3, body2_layer_thickness=WIDTH / 2)
    case = dict(dict(CYLINDER, **layers), grid_n=64, load_n=2e4, tangential_rtol=1e-8)
    r = solve(case, dict(disp_x=4e-8))
    datum = r.attributes["plane_datum"]
    assert datum > 2 * WIDTH and 0 < r["load_tx"] < 0.9e4 and r["disp_z"] > 0
    far = solve(case, dict(plane_datum=10 * datum, load_tx=float(r["load_tx"])))
    by = 2 / (np.pi * E_STAR) * np.log(10)
    assert far["disp_z"] - r["disp_z"] == pytest.approx(2e4 * by, rel=1e-5)
    assert far["disp_x"] - 4e-8 == pytest.approx(r["load_tx"] * by, rel=1e-4)
    complaint = petsam(case, dict(plane_datum=WIDTH), check=2).stderr
    assert f"-plane_datum {WIDTH:.6g}: give at least {datum / 2:.6g} m, nearer than which" in complaint


def test_given_displacements_give_the_loads(solve):
    r = solve(CYLINDER, dict(load_tx=2e4, load_my=1.0))
    given = {name: None for name in ("load_n", "load_tx", "load_my")}
    s = solve(dict(CYLINDER, **given), {name: float(r[name]) for name in ("disp_z", "disp_x", "rot_y")})
    for name, scale in (("load_n", N), ("load_tx", N), ("load_my", 1.0)):
        assert s[name] == pytest.approx(r[name], abs=1e-5 * scale)


@pytest.mark.parametrize("type", ["plane", "plane_periodic"])
def test_any_number_of_ranks_gives_the_same_bits(solve, type):
    case = dict(CYLINDER, elasticity=type, body2_young=70e9, body2_poisson=0.2, grid_n=150, load_tx=2e4, load_ty=1e4)
    case.update(grid_size=1.3e-3)
    runs = [solve(case, ranks=ranks) for ranks in (1, 3)] + [solve(case, dict(fft_exchange="transpose"), ranks=2)]
    for other in runs[1:]:
        assert_same(runs[0], other, 0)


def test_units_are_per_metre(petsam, tmp_path):
    run = petsam(CYLINDER, dict(stiffness=True, output=tmp_path / "r.h5"), ranks=2)
    assert "per metre of length; one rank works, the others wait" in run.stdout
    assert "N/(N/m)" in run.stdout and "J/m" in run.stdout and "load_mx" not in run.stdout
    with h5py.File(tmp_path / "r.h5") as f:
        units = {name: data.attrs["units"] for name, data in f["history"].items()}
        assert f["pressure"].shape[1:] == (1, 256)
        assert np.isnan(f["history/stiffness"][-1][3]).all()
    assert units["load_n"] == "N/m" and units["load_my"] == "N m/m" and units["contact_area"] == "m2/m"
    assert units["dissipated_energy"] == "J/m" and units["stiffness"].startswith("N/m2,") and units["disp_z"] == "m"


@pytest.mark.parametrize(
    "options, says",
    [
        (dict(load_tx=1e6), "load_tx = 1000000 N/m (limit "),
        (dict(load_my=1e6), "load_my = 1e+06 N m/m under load_n = "),
        (dict(load_my=1e6, load_n=0), "load_my = 1e+06 N m/m needs a normal force"),
        (dict(pressure_limit=1e6, friction=0), "N/m exceeds the load that the whole grid carries"),
    ],
)
def test_messages_about_loads_are_per_metre(petsam, options, says):
    assert says in petsam({**CYLINDER, **options}, check=11).complaint[0]


# ---------------------------------------------------------------- what else a contact does

LAYER = dict(body2_layer_young=400e9, body2_layer_poisson=0.2, body2_layer_thickness=4e-5)


@pytest.mark.parametrize(
    "options",
    [
        dict(body2_young=70e9, body2_poisson=0.2),
        dict(LAYER, body1_young=70e9),
        dict(pressure_limit=2e8),
        dict(wear_coefficient1=1e-12, wear_coefficient2=3e-12),
        dict(wear_energy2=1e-12, friction_law="slip_path", friction_path_final=0.6, friction_path_length=1e-7),
        dict(film_thickness=1e-7, film_shear=1e8, slip_direction="mid"),
    ],
)
def test_one_row_is_a_periodic_contact_without_y(petsam, tmp_path, options):
    """Through a history, whatever is switched on: fields as those of four equal rows, loads by their width."""
    height = 2.5e-4
    case = dict(
        CYLINDER, gap_type="file", gap_radius_x=None, gap_radius_y=None, load_n=None, grid_size=None, grid_n=None
    )
    case.update(
        output="r.h5", steps=2, step_divide="no", overwrite=True, normal_rtol=1e-10, tangential_rtol=1e-10, **options
    )
    x = ((np.arange(60) + 0.5) / 60 - 0.5) * 1.2e-3
    with h5py.File(tmp_path / "row.h5", "w") as f:
        f["height"] = (x**2 / (2 * R))[None, :]
    with h5py.File(tmp_path / "rows.h5", "w") as f:
        f["height"] = np.tile(x**2 / (2 * R), (4, 1))
    both = []
    for type, n, width, name in (("plane_periodic", 1, 1.0, "row"), ("periodic", 4, height, "rows")):
        loads = [
            (t, N * width, T * width, Ty * width) for t, T, Ty in ((0.0, 0.0, 0.0), (1.0, 3e4, 1e4), (2.0, -2e4, 0.0))
        ]
        rows = history(tmp_path / "h.csv", "time,load_n,load_tx,load_ty", *loads)
        size = 1.2e-3 if n == 1 else (1.2e-3, height)
        petsam(case, rows, dict(elasticity=type, grid_n=(60, n), grid_size=size, gap_file=tmp_path / f"{name}.h5"))
        with h5py.File(tmp_path / "r.h5") as f:
            fields = {k: f[k][:] for k in f if getattr(f[k], "shape", ())[-1:] == (60,) and k not in ("x", "state")}
            numbers = {
                k: v[:] / (width if v.attrs["units"].split("/")[0] in ("N", "N m", "J", "m2", "m3") else 1.0)
                for k, v in f["history"].items()
            }
        both.append((fields, numbers))
    (plane, numbers), (rows, others) = both
    for name in (one for one in plane if "center" not in one):
        scale = np.abs(rows[name]).max()
        # what is taken aside is the gap before the step, whose differences are more exact than it is
        assert np.abs(plane[name] - rows[name]).max() <= (1e-5 if "aside" in name else 1e-6) * scale, name
    # the place of an edge that is parallel to y is known on one row only, elsewhere that of edges in all directions
    assert np.abs(numbers["contact_area"] - others["contact_area"]).max() < 2 * 0.05 * 2e-5
    for name in ("load_tx", "disp_z", "disp_x", "dissipated_energy", "wear_volume2"):
        if name in numbers:
            scale = np.abs(others[name]).max()
            assert np.abs(numbers[name] - others[name]).max() <= 1e-5 * scale, name


def test_a_life_and_an_embedded_contact(petsam, tmp_path):
    """A life by jumps, also in process, and the same bits there."""
    case = dict(CYLINDER, load_n=None, grid_n=100, wear_coefficient2=1e-13, wear_rtol=1e-2, output_fields=None)
    rows = history(
        tmp_path / "h.csv", "time,load_n,load_tx", (0.0, N, 0.0), (1.0, N, 2e4), (3.0, N, -2e4), (4.0, N, 0.0)
    )
    petsam(case, rows, dict(steps=5, wear_cycles=1000, output=tmp_path / "r.h5"))
    with h5py.File(tmp_path / "r.h5") as f:
        depth, volume = f["wear_depth2"][-1], f["history/wear_volume2"][-1]
        assert f["history/wear_volume2"].attrs["units"] == "m3/m"
        assert f["wear/cycle"][-1] == 1000
        assert volume == pytest.approx(depth.sum() * WIDTH / 100, rel=1e-12)
    options = {k: v for k, v in case.items() if v is not None and not k.startswith("load") and k != "wear_rtol"}
    text = run_python(
        f"""
import petsam
from math import inf
with petsam.Contact(**{options!r}) as c:
    step = c.try_step(load_n={N}, load_tx=2e4)
    c.commit()
    print(c["pressure"].shape, step.load_tx)
    try:
        c.try_step(load_n={N}, load_mz=1.0)
    except petsam.Error as error:
        print(error)
""",
        tmp_path,
    )
    assert text.startswith("(1, 100) 20000") and "bodies of type plane have no such moment" in text


def test_life_in_the_middle_of_a_long_contact(petsam, tmp_path):
    """A rounded pad ten times as long as wide wears in its middle as the plane one under the load of its middle."""
    n, size, flat, radius = (96, 24), (3.2e-3, 23e-3), (1e-3, 10e-3), 20e-3
    x, y = (w * ((np.arange(k) + 0.5) / k - 0.5) for k, w in zip(n, size))
    square = [np.maximum(np.abs(v) - c, 0) ** 2 / (2 * radius) for v, c in zip((x, y), flat)]
    with h5py.File(tmp_path / "gap.h5", "w") as f:
        f["height"] = square[1][:, None] + square[0]
    case = dict(CYLINDER, gap_type="file", gap_file="gap.h5", load_n=None, friction=0.1, overwrite=True, output="r.h5")
    case.update(gap_radius_x=None, gap_radius_y=None, steps=3, wear_coefficient1=1e-14, wear_coefficient2=1e-14)
    case.update(wear_cycles=1e5, wear_rtol=1e-2, elasticity="halfspace", grid_n=n, grid_size=size)

    def life(load, shear, **changes):
        rows = [(0.0, load, 0.0), (1.0, load, shear), (3.0, load, -shear), (4.0, load, 0.0)]
        petsam(dict(case, **changes), history(tmp_path / "h.csv", "time,load_n,load_tx", *rows))
        with h5py.File(tmp_path / "r.h5") as f:
            middle = f["pressure"].shape[1] // 2
            return {name: f[name][:, middle] for name in ("pressure", "shear_x", "wear_depth2")}

    solid = life(18000.0, 1080.0)
    load, shear = (solid[name][:6].sum(axis=1) * (x[1] - x[0]) for name in ("pressure", "shear_x"))
    with h5py.File(tmp_path / "gap.h5", "w") as f:
        f["height"] = square[0][None, :]
    plane = life(float(load[2]), float(np.abs(shear).max()), elasticity="plane", grid_n=n[0], grid_size=size[0])
    for name, most in (("wear_depth2", 1e-2), ("pressure", 3e-3)):
        a, b = solid[name][-1], plane[name][-1]
        assert b.max() > 0 and np.linalg.norm(a - b) < most * np.linalg.norm(b), name


def test_wear_ends_with_contact_of_what_stuck_from_the_first(petsam, tmp_path):
    """Under given displacements: a cylinder cut off at the first stick zone, |x| < c, bears the rest (closed form)."""

    def approach(a):
        return a * a / (2 * R) * (np.log(2 * WIDTH / a) + 0.5)

    c = 0.6 * A
    d, u = approach(A), MU * (approach(A) - approach(c))
    rows = [(t, float(d), float(s)) for t, s in ((0.0, 0.0), (1.0, u), (3.0, -u), (4.0, 0.0))]
    case = dict(CYLINDER, load_n=None, grid_n=300, steps=8, wear_coefficient2=1e-13, wear_cycles=1e6, wear_rtol=1e-2)
    petsam(case, history(tmp_path / "h.csv", "time,disp_z,disp_x", *rows), dict(output="r.h5"))
    load = (d - c * c / (4 * R)) * np.pi * E_STAR / 2 / np.log(2 * WIDTH / c)
    with h5py.File(tmp_path / "r.h5") as f:
        x, p = f["x"][:], f["pressure"][-1, 0]
        assert f["history/load_n"][-1] == pytest.approx(load, rel=2e-3)
        assert f["history/contact_area"][-1] == pytest.approx(2 * c, abs=2 * WIDTH / 300)
        assert f["wear/dissipated_energy"][-1] < 1e-5 * f["wear/dissipated_energy"][0]
    s = np.where(np.abs(x) < 0.9 * c, x, 0)
    exact = (load / np.pi + E_STAR / (4 * R) * (c * c - 2 * s * s)) / np.sqrt(c * c - s * s)
    assert np.abs(p / exact - 1)[np.abs(x) < 0.9 * c].max() < 5e-3


def test_energies_of_the_closing_lines_are_per_metre(petsam, tmp_path):
    (tmp_path / "push.csv").write_text(f"time,load_tx\n1,0\n2,{0.5 * MU * N}\n")
    said = petsam(CYLINDER, dict(history="push.csv", steps=4)).stdout
    assert re.search(r"^  energy +\S+ J/m dissipated", said, re.M) and " J " not in said


SHORTER = {"N m/m": "N", "m2/m": "m", "m3/m": "m2"}  # units as headings have them
STEPS = dict(N="load_n", Tx="load_tx", My="load_my", contact="contact_area", stick="stick_area")
CYCLES = {"vol.1": "volume1", "vol.2": "volume2", "depth1": "depth_max1", "en": "dissipated_energy"}


@pytest.mark.parametrize(
    "change, group, columns",
    [
        (dict(), "history", STEPS),
        (dict(wear_coefficient1=1e-14, wear_cycles=3), "wear", dict(CYCLES, width="contact_area")),
        (
            dict(wear_coefficient1=1e-14, wear_cycles=3, rolling="steady", allow_edge_contact=True),
            "wear",
            dict(CYCLES, width="contact_area"),
        ),
    ],
    ids=["steps", "cycles", "cycles of rolling"],
)
def test_headings_have_the_units_of_the_results(petsam, tmp_path, change, group, columns):
    """Of each printed column the unit is that of its dataset, per metre as well."""
    case = dict(CYLINDER, grid_n=64, load_n=None, output=tmp_path / "r.h5", output_fields="pressure", **change)
    rows = history(
        tmp_path / "h.csv", "time,load_n,load_tx,load_my", (1, N, 1e4, 0.1), (2, N, -1e4, 0.1), (3, N, 1e4, 0.1)
    )
    lines = petsam(case, rows).stdout.splitlines()
    heading = next(line for line in lines if re.match(" *(step +time|cycles )", line))
    printed = {label: unit.strip("()") for label, unit in re.findall(r"(\S+?)/(\(\S+\)|\S+)", heading)}
    with h5py.File(tmp_path / "r.h5") as f:
        for label, name in columns.items():
            unit = f[group][name].attrs["units"]
            assert printed[label] == SHORTER.get(unit, unit), (label, heading)


def test_contact_that_grows_by_many_cells_in_a_step(petsam, tmp_path):
    """A pad on 17,280 cells: from the extrapolated pressure its edges would move by a cell in an iteration."""
    case = dict(
        elasticity="plane", gap_type="pad", gap_half_flat_x=2.4416e-3, gap_edge_radius_x=0.251, friction=0,
        body1_young=70e9, body1_poisson=0, body2_young=70e9, body2_poisson=0, grid_n=17280, grid_size=7.7e-3,
        steps=4, errors="none",
    )  # fmt: skip
    out = tmp_path / "own.h5"
    petsam(case, history(tmp_path / "loads.csv", "time,load_n", (1, 141e3)), "-output", out)
    petsam(case, "-load_n", 0.75 * 141e3, "-steps", "1", "-output", tmp_path / "alone.h5")
    with h5py.File(out) as file, h5py.File(tmp_path / "alone.h5") as alone:
        area = alone["history/contact_area"][0]
        assert file["history/contact_area"][2] == pytest.approx(area, rel=1e-4)
        assert file["history/pressure_max"][2] == pytest.approx(alone["history/pressure_max"][0], rel=1e-5)

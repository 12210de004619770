"""Rolling in steps of time: columns roll and roll_y, creepages given or found."""

import re

import h5py
import numpy as np
import pytest

from support import ball, history

N, MU, SHARE, CELL = 0.4705, 0.4013, 0.657, 0.25
# CONTACT's example from Cattaneo's shift to Carter's steady state; its numbers are those that it prints
CASE_C = dict(
    grid_n=(34, 33),
    grid_size=(34 * CELL, 33 * CELL),
    grid_center=(0.125, 0.0),
    body1_young=2.56,
    body2_young=2.56,
    body1_poisson=0.28,
    body2_poisson=0.28,
    gap_type="sphere",
    gap_radius1=1 / (2 * 0.002963),
    gap_radius2=float("inf"),
    friction=MU,
    load_n=N,
    output_fields="all",
)
TX = SHARE * MU * N


def numbers(path):
    with h5py.File(path, "r") as f:
        return {name: data[:] for name, data in f["history"].items()}


@pytest.fixture
def roll(petsam, tmp_path):
    """Runs rows of a history: the numbers of its steps."""

    def run(case, header, *rows, name="rolled", **words):
        loads = history(tmp_path / f"{name}.csv", header, *[map(float, row) for row in rows])
        petsam(case, loads, dict(output=f"{name}.h5"), **words)
        return numbers(tmp_path / f"{name}.h5")

    return run


def cattaneo(steps, length=CELL):
    return [(0, TX, 0.0), *[(k + 1, TX, length) for k in range(steps)]]


def test_from_cattaneo_to_carter(roll):
    h = roll(CASE_C, "time,load_tx,roll", *cattaneo(56))
    assert h["disp_x"][0] == pytest.approx(0.01774, abs=5.1e-6)
    assert h["stick_cells"][0] == 305
    assert np.isnan(h["creep_x"][0])
    expected = {1: 1.824e-3, 2: 1.882e-3, 6: 2.221e-3, 14: 3.403e-3, 15: 3.402e-3, 21: 3.088e-3, 56: 3.101e-3}
    for k, creep in expected.items():
        assert h["creep_x"][k] == pytest.approx(creep, abs=5.1e-7), k
        assert h["disp_x"][k] - h["disp_x"][k - 1] == pytest.approx(h["creep_x"][k] * CELL, rel=1e-12)
    assert h["stick_cells"][-1] == 346
    assert np.all(h["tangential_applies"] <= 18)


@pytest.mark.parametrize("cells, steps", [(41, 1), (82, 4)])
def test_a_long_step_from_no_tractions_is_cattaneos_shift(roll, cells, steps):
    """CONTACT's test bank, case 17: the creepage that ends under the force; 0.0450 by its rule for cells that enter."""
    case = dict(CASE_C, grid_n=cells, grid_size=8.2, grid_center=(0.0, 0.0), load_n=None)
    shift = 3 * MU * N * (2 - 0.28) / (8 * 3.49991) * (1 - (1 - SHARE) ** (2 / 3))  # over Hertz's radius, G = 1
    rows = [(k + 1, N, shift / 0.4, 0.4 / steps) for k in range(steps)]
    done = roll(case, "time,load_n,creep_x,roll", (0, N, 0.0, 0.0), *rows)
    assert done["load_tx"][-1] == pytest.approx(TX, rel=1e-3)


def test_given_creepages_give_back_the_loads(roll):
    found = roll(CASE_C, "time,load_tx,roll", *cattaneo(8))
    rows = [(k, *(found[f"creep_{n}"][k] for n in ("x", "y", "spin")), CELL) for k in range(1, 9)]
    # the first row has the shift as creepage over a rolled distance, from nothing
    first = [(0, found["disp_x"][0] / CELL, found["disp_y"][0] / CELL, found["rot_z"][0] / CELL, CELL)]
    given = roll(CASE_C, "time,creep_x,creep_y,creep_spin,roll", *first, *rows, name="given")
    assert np.allclose(given["load_tx"], TX, rtol=1e-5)
    assert np.allclose(given["disp_x"], found["disp_x"], rtol=1e-9)


@pytest.mark.parametrize("turn", [0, 1, 2])
def test_direction_of_rolling_turns_the_solution_and_keeps_the_sign_of_creepage(roll, turn):
    """Towards +x, -x, and -x with a rolled distance of rounding along y: loads are the same, shear is mirrored."""
    side = 2 * CELL
    case = dict(CASE_C, grid_n=20, grid_size=20 * side, grid_center=0)
    length, beside = [(side, 0), (-side, 0), (-side, 1e-12 * side)][turn]
    forth = roll(case, "time,creep_x,creep_y,roll", *[(k, 1e-3, 5e-4, side) for k in range(6)])
    turned = roll(
        case, "time,creep_x,creep_y,roll,roll_y", *[(k, 1e-3, 5e-4, length, beside) for k in range(6)], name="turned"
    )
    assert forth["load_tx"][-1] > 0.1 * MU * N
    for load in ("load_tx", "load_ty", "creep_x"):
        assert np.allclose(turned[load], forth[load], rtol=1e-6)


def test_rows_are_divided(roll):
    one = roll(CASE_C, "time,load_tx,roll", *cattaneo(12))
    rows = [(0, 0.0, 0.0), (1, TX, 0.0), (2, TX, 12 * CELL)]
    divided = roll(dict(CASE_C, steps=12), "time,load_tx,roll", *rows, name="divided")
    assert np.all(divided["roll"][-12:] == CELL)
    assert np.allclose(divided["creep_x"][-1], one["creep_x"][-1], rtol=1e-4)


@pytest.mark.parametrize(("length", "tolerance"), [(0.5 * CELL, 8e-3), (1.4 * CELL, 1.2e-2), (2 * CELL, 2.6e-2)])
def test_steps_of_other_lengths(roll, length, tolerance):
    """The error of a step is of first order in its length; what parts of a cell add is less."""
    whole = roll(CASE_C, "time,load_tx,roll", *cattaneo(40))
    other = roll(CASE_C, "time,load_tx,roll", *cattaneo(round(40 * CELL / length), length), name="other")
    assert other["creep_x"][-1] == pytest.approx(whole["creep_x"][-1], rel=tolerance)


def test_rigid_rolling_turns_the_reference(roll):
    """Without friction nothing resists: a step without creepage slips nowhere, and displacements are about the grid."""
    case = dict(ball(32), friction=1e-9, sum_slip_path=True)
    d = case["grid_size"] / 32
    rows = [
        (0, 0.0, 0.0, 0.0, 0.0, 0.0),
        (1, 1e-3, 2e-3, 3.0, 2 * d, d),
        (2, 0.0, 0.0, 0.0, 3 * d, 0.0),
        (3, 0.0, 0.0, 0.0, 0.0, -2 * d),
        (4, 0.0, 0.0, 0.0, -3 * d, 2 * d),
    ]
    h = roll(case, "time,creep_x,creep_y,creep_spin,roll,roll_y", *rows)
    path = np.hypot(2 * d, d)
    assert h["rot_z"][1:] == pytest.approx(3.0 * path, rel=1e-12)
    turn = 3.0 * path * d
    assert h["disp_x"][1:] - h["disp_x"][1] == pytest.approx(turn * np.array([0, 0, 2, 0]), abs=1e-12 * turn)
    assert h["disp_y"][1:] - h["disp_y"][1] == pytest.approx(turn * np.array([0, 3, 3, 0]), abs=1e-12 * turn)
    assert np.all(h["dissipated_energy"][2:] <= 1e-6 * h["dissipated_energy"][1])


def test_along_y_is_as_along_x(roll):
    case = dict(ball(40), load_n=180.0)
    d = case["grid_size"] / 40
    rows = [(0, 20.0, 5.0, 0.0, 0.0), *[(k, 20.0, 5.0, 1.3 * d, 0.5 * d) for k in range(1, 6)]]
    x = roll(case, "time,load_tx,load_ty,roll,roll_y", *rows)
    y = roll(case, "time,load_ty,load_tx,roll_y,roll", *rows, name="y")
    for a, b in (("creep_x", "creep_y"), ("creep_y", "creep_x")):
        assert np.allclose(x[a][1:], y[b][1:], rtol=1e-4)
    assert np.allclose(
        x["creep_spin"][1:], -y["creep_spin"][1:], rtol=1e-3, atol=1e-3 * np.abs(x["creep_spin"][1:]).max()
    )


WEARS = dict(sum_slip_path=True, sum_friction_energy=True, wear_coefficient1=1e-12, pressure_limit=2.2e8)


@pytest.mark.parametrize("ranks", [2, 3])
def test_bits_do_not_depend_on_ranks(petsam, roll, tmp_path, ranks):
    case = dict(ball(33), **WEARS)
    d = case["grid_size"] / 33
    rows = [(0, 20.0, 0.0, 0.0), (1, 20.0, d, -2 * d), (2, 22.0, 0.3 * d, 0.8 * d), (3, 20.0, -d, 0.0)]
    for n in (1, ranks):
        roll(case, "time,load_tx,roll,roll_y", *rows, name=f"on{n}", ranks=n)
    with h5py.File(tmp_path / "on1.h5") as one, h5py.File(tmp_path / f"on{ranks}.h5") as many:
        for name in ("shear_x", "slip_x", "slip_path", "friction_energy", "wear_depth1", "plastic_depth"):
            assert np.array_equal(one[name][:], many[name][:]), name


def test_what_the_material_has_suffered_moves_with_it(roll, tmp_path):
    case = dict(ball(40), **WEARS)
    d = case["grid_size"] / 40
    del case["load_n"]
    # lifted after the second row: what was there moves and nothing is added
    rows = [(0, 180.0, 30.0, 0.0, 0.0), (1, 0.0, 0.0, 0.0, 0.0), (2, 0.0, 0.0, 3 * d, -2 * d)]
    roll(case, "time,load_n,load_tx,roll,roll_y", *rows)
    with h5py.File(tmp_path / "rolled.h5") as f:
        for name in ("wear_depth1", "plastic_depth", "friction_energy"):
            before, after = f[name][1], f[name][2]
            assert before.max() > 0, name
            assert np.array_equal(after[2:, :-3], before[:-2, 3:]), name
            assert np.all(after[:2] == 0) and np.all(after[:, -3:] == 0), name


def test_restart_amid_rolling(petsam, roll, tmp_path):
    case = dict(ball(33), **WEARS)
    d = case["grid_size"] / 33
    rows = [(0, 20.0, 0.0), *[(k, 20.0, 0.7 * d) for k in range(1, 6)]]
    roll(case, "time,load_tx,roll", *rows, name="whole")
    loads = dict(history=tmp_path / "whole.csv")
    petsam(case, loads, dict(checkpoint="state.h5", checkpoint_every=2, output="half.h5"))
    petsam(
        case, loads, dict(restart="state.h5.1" if (tmp_path / "state.h5.1").exists() else "state.h5", output="rest.h5")
    )
    with h5py.File(tmp_path / "whole.h5") as whole, h5py.File(tmp_path / "rest.h5") as rest:
        for name in ("shear_x", "slip_x", "slip_path", "wear_depth1", "plastic_depth"):
            assert np.array_equal(whole[name][-1], rest[name][-1]), name


def test_contact_where_material_enters_is_told(roll):
    case = ball(32, half_width=1.1)  # three columns outside of the contact
    d = case["grid_size"] / 32
    h = roll(case, "time,load_tx,roll", (0, 10.0, 0.0), (1, 10.0, d), (2, 10.0, 4 * d), check=12)
    assert list(h["status"]) == [0, 0, 12]


@pytest.mark.parametrize("way, other", [("roll", "x"), ("roll_y", "y")])
@pytest.mark.parametrize("cells", [8, -17.5, 32])
def test_what_a_step_can_roll_is_told(petsam, tmp_path, way, other, cells):
    """By as much as the message says, the next step rolls."""
    case, header = ball(32), f"time,load_t{other},{way}"
    d = case["grid_size"] / 32

    def run(roll, **words):
        return petsam(case, history(tmp_path / "h.csv", header, (0, 10.0, 0.0), (1, 10.0, float(roll))), **words).stderr

    said = run(cells * d, check=12)
    assert "material from outside of the grid" in said and "use more steps" in said and "-grid_size" not in said
    most = float(re.search(rf"{way} = \S+ at most (\S+) m in a step", said)[1])
    run(np.copysign(most, cells))
    assert f"{way} = 1e+300: expected at most the width of the grid" in run(1e300, check=2)


def test_gross_slip_of_a_rolling_step_names_creepages(petsam, tmp_path):
    case = ball(32)
    rows = history(tmp_path / "h.csv", "time,load_tx,roll", (0, 10.0, 0.0), (1, 500.0, 5e-5))
    assert "for gross slip give creep_x" in petsam(case, rows, check=11).stderr


def test_a_train_on_one_period_rolls_as_one_contact(solve, tmp_path):
    """Cylinders with a creepage, until the tractions are steady: one on half-planes, and a train of them."""
    cell, alone = 2e-3 / 64, dict(body1_young=210e9, body1_poisson=0.3, body2_young=210e9, body2_poisson=0.3)
    rows = [(float(k), cell if k else 0.0, 2e-3 if k else 0.0) for k in range(51)]
    alone.update(gap_type="sphere", gap_radius1=0.02, gap_radius2="inf", friction=0.3, load_n=3e5)
    alone.update(history(tmp_path / "train.csv", "time,roll,creep_x", *rows))
    one = solve(dict(alone, elasticity="plane", grid_n=64, grid_size=2e-3))
    train = solve(dict(alone, elasticity="plane_periodic", grid_n=256, grid_size=8e-3))
    assert train["load_tx"] == pytest.approx(one["load_tx"], rel=0.01)
    assert 0.6 * 0.3 * 3e5 < one["load_tx"] < 0.9 * 0.3 * 3e5

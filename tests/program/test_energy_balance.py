"""The energy that friction dissipates is also the work of the loads less what the shear stores: where N falls, the
length of the steps makes errors that the slip of cells in contact does not show."""

import numpy as np
import pytest

import petsam as package
from support import bodies, read_run

CASE = dict(bodies(), friction=0.3, gap_type="sphere", gap_radius1=0.2, gap_radius2=0.2, grid_n=32, grid_size=2.6e-3,
            errors="none", output_fields="none")  # fmt: skip
LIFT = dict(load_n=(1000, 1000, 0, 1000), disp_x=(0, 5e-7, 5e-7, 1.5e-6))
BACK = dict(load_n=(1000, 1000, 0, 1000), disp_x=(0, 5e-7, 0, 0))
RELOAD = dict(load_n=(1000, 1000, 100, 1000, 100, 1000), disp_x=(0, 3e-7, 3e-7, -3e-7, -3e-7, 3e-7))


def run(rows, steps, **more):
    history = dict(time=np.arange(len(rows["load_n"]), dtype=float), **{name: np.array(v) for name, v in rows.items()})
    return package.run(**{**CASE, **more}, history=history, steps=steps)


@pytest.fixture(scope="module")
def energies():
    """Of many steps, with an error of second order: (4 E(2 n) - E(n))/3 of the sums over cells."""
    found = {}
    for name, rows in (("lift", LIFT), ("back", BACK), ("reload", RELOAD)):
        sums = [run(rows, steps, step_divide=False)["dissipated_energy"].sum() for steps in (64, 128)]
        found[name] = (4 * sums[1] - sums[0]) / 3 if name == "reload" else 2 * sums[1] - sums[0]
    return found


@pytest.mark.parametrize("divide", [False, True])
@pytest.mark.parametrize("name, rows, steps, most", [
    ("lift", LIFT, 1, 0.19), ("lift", LIFT, 2, 0.05), ("lift", LIFT, 8, 0.04), ("back", BACK, 4, 0.08),
    ("reload", RELOAD, 1, 0.14), ("reload", RELOAD, 2, 0.06), ("reload", RELOAD, 8, 0.02),
])  # fmt: skip
def test_energy_where_n_falls_is_that_of_many_steps(energies, name, rows, steps, most, divide):
    """The sum over cells that stay in contact lacks 83 % of that of the lift."""
    run_ = run(rows, steps, step_divide=divide)
    energy, error = run_["dissipated_energy"].sum(), run_["energy_error"].sum()
    assert energy == pytest.approx(energies[name], rel=most)
    assert 0.5 * abs(energy - energies[name]) < error < (0.3 if divide else 0.7) * energy


def test_an_imbalance_of_some_percent_divides_a_step(energies):
    assert run(RELOAD, 4)["dissipated_energy"].sum() == pytest.approx(energies["reload"], rel=0.02)


def test_a_lift_off_loses_all_that_the_shear_has_stored():
    """The held displacement does no work any more, so that all work so far is dissipated."""
    run_ = run(dict(load_n=(1000, 1000, 0), disp_x=(0, 5e-7, 5e-7)), 1, step_divide=False, sum_friction_energy=True,
               output_fields="friction_energy")  # fmt: skip
    many = run(dict(load_n=(1000, 1000), disp_x=(0, 5e-7)), 64)
    force, way = np.r_[0, many["load_tx"][64:]], np.r_[0, many["disp_x"][64:]]
    work = np.sum((force[1:] + force[:-1]) / 2 * np.diff(way))
    assert run_["dissipated_energy"].sum() == pytest.approx(work, rel=0.02)
    area = (CASE["grid_size"] / CASE["grid_n"]) ** 2
    assert run_.field("friction_energy").sum() * area == pytest.approx(run_["dissipated_energy"].sum(), rel=1e-9)


def test_loads_that_go_to_zero_together_need_parts():
    """What goes back with N seems to lose nothing in one step: that is an error, by which the step is divided."""
    exact = run(BACK, 128)["dissipated_energy"].sum()
    one, parts = run(BACK, 1, step_divide=False), run(BACK, 1)
    assert one["dissipated_energy"].sum() < 0.3 * exact < one["energy_error"].sum()
    assert parts["dissipated_energy"].sum() == pytest.approx(exact, rel=0.06)


@pytest.mark.parametrize("unlike", [{}, dict(body2_young=70e9), dict(bulk2_stress_xx=1e6)])
@pytest.mark.parametrize("rows, steps", [
    (dict(load_n=(1000, 0), disp_x=(0, 1e-6)), 1), (dict(load_n=(1000, 1000, 0), disp_x=(0, 5e-7, -5e-7)), 2),
])  # fmt: skip
def test_contact_that_is_lost_from_no_shear_is_divided(rows, steps, unlike):
    """All that is dissipated is stored and lost within the step, of bodies without a balance, too."""
    one, parts, many = (
        run(rows, count, **unlike, step_divide=divide) for count, divide in ((steps, False), (steps, True), (64, False))
    )
    exact = many["dissipated_energy"].sum()
    missing = exact - one["dissipated_energy"].sum()
    assert 0.4 * exact < missing < 2 * one["energy_error"].sum()
    assert parts["dissipated_energy"].sum() == pytest.approx(exact, rel=0.07)


def test_a_release_by_loads_that_vanish_with_n_is_unknown():
    """Displacements are not given where loads are, and no contact determines them."""
    run_ = run(dict(load_n=(1000, 1000, 0), load_tx=(0, 150, 0)), 1, step_divide=False)
    assert run_["dissipated_energy"][-1] == 0


def test_divided_steps_are_told_and_the_same_after_a_restart(petsam, tmp_path):
    history = (
        ",".join(["time", *LIFT]) + "\n" + "\n".join(f"{k},{n},{d}" for k, (n, d) in enumerate(zip(*LIFT.values())))
    )
    (tmp_path / "h.csv").write_text(history + "\n")
    case = dict(CASE, history="h.csv", output_fields="usual")
    whole = petsam(case, dict(output="whole.h5"))
    assert "1 of 4 solved in parts" in whole.stdout and "-step_divide no" in whole.stdout
    assert "solved in parts" not in petsam(case, dict(output="one.h5", step_divide="no")).stdout
    (tmp_path / "first.csv").write_text("\n".join(history.split("\n")[:3]) + "\n")
    petsam(case, dict(history="first.csv", output="out.h5", checkpoint="c.h5", checkpoint_every=1))
    petsam(case, dict(output="out.h5", restart="c.h5"), ranks=2)
    one, two = read_run(tmp_path / "whole.h5"), read_run(tmp_path / "out.h5")
    names = ("pressure", "shear_x", "history/load_tx", "history/dissipated_energy")
    assert all(np.array_equal(one[name], two[name], equal_nan=True) for name in names)


def test_lost_energy_is_an_error_of_the_run():
    """Companion runs lack it as well."""
    with pytest.warns(package.AdviceWarning, match="error by the steps: dissipated_energy") as said:
        run(BACK, 2, errors="companion", step_divide=False)
    assert any("neither stored nor dissipated" in str(one.message) for one in said)


@pytest.mark.parametrize("disp_x, steps", [((0, 9e-7, -6e-7), 2), ((0, 1e-5, -1e-5, 1e-5), 1)])
def test_a_balance_that_is_less_certain_than_the_slip_says_nothing(disp_x, steps):
    """Where N stays, the sum over cells is far more accurate than the work of loads that change in proportion: that is
    zero where all slides back a long way in one step."""
    run_ = run(dict(load_n=(1000,) * len(disp_x), disp_x=disp_x), steps, step_divide=False)
    assert run_["energy_error"].sum() < 0.04 * run_["dissipated_energy"].sum()


def test_steps_are_divided_until_nothing_is_lost(energies):
    lift = dict(load_n=LIFT["load_n"][:3], disp_x=LIFT["disp_x"][:3])
    lost = run(lift, 256)["dissipated_energy"].sum()
    divided = run(lift, 1, step_rtol=1e-2)
    assert divided["dissipated_energy"].sum() == pytest.approx(lost, rel=1e-2)


@pytest.mark.parametrize("returns", [False, True])
def test_a_uniform_strain_does_work_that_is_not_counted(returns):
    """Bulk stress moves the surfaces as well, so that the work of the loads says nothing, nor where it ends."""
    rows = dict(load_n=(1000, 800, 1000, 600, 1000), disp_x=(0, 4e-7, -3e-7, 2e-7, -4e-7))
    if returns:
        rows = dict(load_n=(1000, 1000, 1000, 1000), bulk2_stress_xx=(0, 5e7, 0, 0))
    run_ = run(rows, 1 if returns else 32, **({} if returns else dict(bulk2_stress_xx=1e7)))
    assert run_["energy_error"][-2:].sum() < 5e-3 * run_["dissipated_energy"].sum()


def test_energy_is_told_where_the_displacement_changes_as_n_falls():
    """The work is uncertain then, and as large a part of what it lacks counts as the bounds of the shear have lost."""
    rows = dict(load_n=(1000, 1000, 100), disp_x=(0, 3e-7, 5e-7))
    few, many = run(rows, 2, step_divide=False), run(rows, 64)
    wrong = abs(many["dissipated_energy"].sum() / few["dissipated_energy"].sum() - 1)
    assert 0.1 < wrong < 0.2
    assert 0.6 * wrong < few["energy_error"].sum() / few["dissipated_energy"].sum() < 1.5 * wrong


LOCK = dict(load_n=(111, 1141, 260), disp_x=(0, 4.9e-7, -1.6e-7))


@pytest.mark.parametrize("unlike, wrong", [({}, 0.09), (dict(body2_young=70e9), 0.06)])
def test_shear_that_is_locked_in_while_n_grows_is_right_in_parts(unlike, wrong):
    """Nothing slips in that row: its energy shows no error, but the next rows dissipate what it has locked in."""
    one, parts, many = (
        run(LOCK, count, friction=0.16, **unlike, step_divide=divide)
        for count, divide in ((1, False), (1, True), (64, False))
    )
    force = {run_: run_["load_tx"][np.argmin(np.abs(run_["time"] - 1))] for run_ in (one, parts, many)}
    assert abs(force[one] / force[many] - 1) > wrong
    assert force[parts] == pytest.approx(force[many], rel=0.02)
    exact = many["dissipated_energy"].sum()
    assert 0.3 * abs(one["dissipated_energy"].sum() - exact) < one["energy_error"].sum()
    assert abs(parts["dissipated_energy"].sum() - exact) < min(0.15 * exact, 1.2 * parts["energy_error"].sum())


@pytest.mark.parametrize("rows", [
    "time,load_n,disp_x\n0,1000,0\n1,1040,2e-8\n2,1080,4e-8\n",
    "time,load_n,load_tx\n0,500,100\n1,1000,290\n2,2000,590\n",
])  # fmt: skip
@pytest.mark.parametrize("shape", ["sphere", "punch"])
def test_shear_that_is_locked_in_nearly_exactly_is_not_divided(petsam, tmp_path, rows, shape):
    """All sticks, so that any difference would be large beside the energy; a contact may grow with N, or not."""
    (tmp_path / "h.csv").write_text(rows)
    case = dict(CASE, friction=0.5, history="h.csv")
    if shape == "punch":
        case = {name: value for name, value in case.items() if "gap_" not in name}
        case |= dict(gap_type="punch", gap_flat_radius=8e-4, gap_edge_radius=0.02)
    assert "solved in parts" not in petsam(case).stdout


LOADED = "time,load_n,load_tx\n0,500,100\n1,1000,290\n2,1800,590\n"


def test_steps_of_layers_that_load_with_their_shear_are_not_divided(petsam, tmp_path):
    """The work of loads that are given is not what tells if the shear is locked in rightly."""
    layer = {f"body2_layer_{name}": value for name, value in (("young", 210e9), ("poisson", 0.2), ("thickness", 1e-3))}
    (tmp_path / "h.csv").write_text(LOADED)
    assert (
        "solved in parts"
        not in petsam(dict(CASE, friction=0.5, body2_poisson=0.2, body1_poisson=0.2, history="h.csv"), layer).stdout
    )


def test_steps_of_dissimilar_bodies_are_divided_where_n_grows(petsam, tmp_path):
    """The pressure moves their surfaces in the step."""
    (tmp_path / "h.csv").write_text(LOADED)
    assert "solved in parts" in petsam(dict(CASE, friction=0.5, body2_young=100e9, history="h.csv")).stdout


def test_work_of_cells_that_enter_may_be_none_at_all():
    """Where they do most of it, more steps find less and less: 6 % was printed for a tenth of the energy and more."""
    rows = dict(load_n=(1000, 1202, 1572, 2073, 2278, 2586), disp_x=(0, 4.8e-8, -1.2e-7, 1.4e-7, -9e-8, 6.5e-8))
    few, many = run(rows, 1, friction=0.05, step_divide=False), run(rows, 64, friction=0.05)
    wrong = abs(few["dissipated_energy"].sum() - many["dissipated_energy"].sum())
    assert 0.1 * many["dissipated_energy"].sum() < wrong < 1.3 * few["energy_error"].sum()


@pytest.mark.parametrize("normal, most", [(500, 0.06), (800, 0.01), (1400, 0.02)])
def test_energy_of_a_contact_that_slides_back_as_a_whole(normal, most):
    """In one step in which N changes: cells turn early, the earlier the more alike they slide."""
    rows = dict(load_n=(1000, 1000, normal), disp_x=(0, 1e-5, 0))
    one, many = (run(rows, steps, step_divide=False, grid_size=3e-3)["dissipated_energy"] for steps in (1, 64))
    assert one[2:].sum() == pytest.approx(many[128:].sum(), rel=most)

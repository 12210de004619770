"""Branches of a history: a restart with a new name of the results begins a file of its own, with another gap too."""

import re
import shutil

import h5py
import numpy as np
import pytest

import petsam as library
from conftest import PROGRAM, execute
from kinds.kills import CASE, differences, write_history

STEPS, AT = 24, 14
KEPT = dict(checkpoint="state.h5", checkpoint_every=7)
FROM = dict(restart="state.h5.1", output="branch.h5")  # the checkpoint after step 14


@pytest.fixture
def stopped(tmp_path, petsam):
    write_history(tmp_path, STEPS)
    petsam(CASE, KEPT)
    return tmp_path


def read(path):
    """All values, those of /history under their names there."""
    with h5py.File(path) as f:
        found = {name: data[:] for name, data in f.items() if isinstance(data, h5py.Dataset)}
        return {**found, **{f"history/{name}": data[:] for name, data in f["history"].items()}}, dict(f.attrs)


def assert_rest(branch, whole, first):
    """A file holds what another one does from a step on, to the last bit."""
    one, two = read(branch)[0], read(whole)[0]
    assert one.keys() == two.keys()
    for name, values in one.items():
        rest = two[name] if name in ("x", "y", "coordinate", "point") else two[name][first:]
        if name in ("contact_edge", "stick_edge"):  # as wide as their longest edge
            rest = rest[:, : values.shape[1]]
        if name != "point":
            assert np.array_equal(values, rest, equal_nan=values.dtype.kind == "f"), name


@pytest.mark.parametrize("ranks", [1, 2, 3])
def test_branch_holds_the_rest_of_the_history(stopped, petsam, ranks):
    before = (stopped / "out.h5").read_bytes()
    done = petsam(CASE, FROM, ranks=ranks)
    assert_rest(stopped / "branch.h5", stopped / "out.h5", AT)
    assert (stopped / "out.h5").read_bytes() == before
    assert re.search(r"^  branch +the results begin after step 14, of out\.h5$", done.stdout, re.M)
    attributes = read(stopped / "branch.h5")[1]
    assert attributes["branch_step"] == AT and attributes["branch_results"] == "out.h5"
    assert attributes["branch_checkpoint"] == "state.h5.1" and attributes["branch_gap"] == "as before"


def test_branch_may_go_another_way(stopped, petsam):
    """The rows up to the checkpoint are those of the first run, what follows is not."""
    rows = (stopped / "history.csv").read_text().splitlines()
    (stopped / "other.csv").write_text("\n".join(rows[: AT + 1] + ["15, 900, 0", "16, 800, 10"]) + "\n")
    petsam(CASE, FROM, dict(history="other.csv"))
    with h5py.File(stopped / "branch.h5") as f:
        assert f["history/time"][:].tolist() == f["time"][:].tolist() == [15, 16]
        assert f["history/load_n"][:] == pytest.approx([900, 800], rel=1e-9)


@pytest.mark.parametrize("ranks", [1, 2])
def test_branch_that_was_stopped_goes_on(stopped, petsam, ranks):
    """In a part beside it."""
    petsam(CASE, FROM, dict(checkpoint="branch.state", checkpoint_every=4), ranks=ranks)
    shutil.copy(stopped / "branch.h5", stopped / "before.h5")
    petsam(CASE, dict(restart="branch.state.1", output="branch.h5"), ranks=ranks)
    assert (stopped / "branch.part2.h5").exists()
    assert not differences(stopped / "branch.h5", stopped / "before.h5")
    petsam(CASE, dict(restart="branch.state.1", output="twig.h5"))
    assert read(stopped / "twig.h5")[1]["branch_results"] == "branch.h5"
    assert_rest(stopped / "twig.h5", stopped / "out.h5", 20)


def test_branch_that_is_there_is_not_begun_again(stopped, petsam):
    """It may be longer than what would replace it."""
    petsam(CASE, FROM)
    before = (stopped / "branch.h5").read_bytes()
    done = petsam(CASE, FROM, check=2)
    assert "-output branch.h5" in done.complaint[0] and "belongs to other results" in done.complaint[0]
    assert (stopped / "branch.h5").read_bytes() == before


def test_results_that_are_missing_are_no_branch(stopped, petsam):
    """Under the name that they had, they have been lost or left behind."""
    (stopped / "out.h5").unlink()
    assert "No such file" in petsam(CASE, dict(restart="state.h5"), check=3).complaint[0]
    assert not (stopped / "out.h5").exists()


def test_branch_of_a_run_without_results(stopped, petsam):
    petsam({**CASE, **KEPT, "output": None, "checkpoint": "bare.h5"})
    done = petsam(CASE, dict(restart="bare.h5.1", output="branch.h5"))
    assert "the results begin after step 14\n" in done.stdout
    assert read(stopped / "branch.h5")[1]["branch_results"] == "none"
    assert_rest(stopped / "branch.h5", stopped / "out.h5", AT)


def test_steps_of_a_branch_have_the_numbers_of_the_run(stopped, petsam):
    petsam(CASE, FROM)
    with library.open(stopped / "branch.h5") as branch, library.open(stopped / "out.h5") as whole:
        assert branch.steps == list(range(AT + 1, STEPS + 1)) and branch.before == AT
        one, two = (results.field("shear_x", results.of_step(20)) for results in (branch, whole))
        assert np.array_equal(one, two) and branch.of_step(-1) == STEPS - AT - 1
        assert branch.title(0).startswith("branch, step 15,")
        with pytest.raises(library.Error, match="the file has the steps 15 to 24"):
            branch.of_step(3)
    words = dict(input="branch.h5", output="stress.h5", body=2, depths="0", steps="20")
    for code, more in ((0, {}), (2, dict(steps="3"))):
        execute([], stopped, [words, more], 1, code, program=PROGRAM.with_name("petsam-stress"))
    with h5py.File(stopped / "stress.h5") as f, h5py.File(stopped / "out.h5") as g:
        assert f["history/step"][:].tolist() == [20]
        assert np.allclose(-f["stress_zz"][0, 0], g["pressure"][19], rtol=0, atol=1e-9 * g["pressure"][19].max())


# ---- another gap


@pytest.mark.parametrize("ranks", [1, 2])
def test_another_gap_keeps_the_slip(stopped, petsam, ranks):
    """The next step is solved on the new gap, from the slip of the checkpoint: its work says so."""
    done = petsam(CASE, FROM, dict(restart_gap=True, gap_radius1=0.25), ranks=ranks)
    assert "the results begin after step 14, of out.h5, with another gap and the accumulated slip" in done.stdout
    values, attributes = read(stopped / "branch.h5")
    before = read(stopped / "out.h5")[0]
    assert attributes["gap_radius1"] == 0.25 and attributes["branch_gap"] == "of this run"
    # Hertz's largest pressure by the new radius
    ratio = values["history/pressure_max"][0] / before["history/pressure_max"][AT]
    radius = [1 / (1 / r + 1 / 0.2) for r in (0.2, 0.25)]
    assert ratio == pytest.approx((radius[0] / radius[1]) ** (2 / 3), rel=0.01)
    # -sum q . ds, with the bound of slipping cells by the mean of before and after
    shear, slip, bound, old = (
        [np.array((values[f"{name}_x"][0], values[f"{name}_y"][0])) for name in ("shear", "slip")]
        + [CASE["friction"] * values["pressure"][0]]
        + [np.array((before["slip_x"][AT - 1], before["slip_y"][AT - 1]))]
    )
    ratio = np.ones_like(bound)
    slips = (values["state"][0] == 2) & (bound > 0)
    ratio[slips] = 0.5 * (CASE["friction"] * before["pressure"][AT - 1][slips] + bound[slips]) / bound[slips]
    area = np.diff(values["x"])[0] * np.diff(values["y"])[0]
    work = -np.sum((shear * (slip - old)).sum(axis=0) * ratio * (values["pressure"][0] > 0)) * area
    assert values["history/dissipated_energy"][0] == pytest.approx(work, rel=1e-5, abs=0)


def test_another_gap_is_by_choice_and_in_another_file(stopped, petsam):
    other = dict(gap_radius1=0.25)
    assert "-gap_radius1 is 0.2 there, not 0.25" in petsam(CASE, FROM, other, check=2).complaint[0]
    before = (stopped / "out.h5").read_bytes()
    done = petsam(CASE, dict(restart="state.h5"), other, dict(restart_gap=True), check=2)
    assert "-output out.h5" in done.complaint[0] and "-restart_gap" in done.complaint[0]
    assert (stopped / "out.h5").read_bytes() == before
    assert "-restart_gap" in petsam(CASE, dict(restart_gap=True), check=2).complaint[0]
    done = petsam(CASE, FROM, dict(restart_gap=True, friction=0.2), check=2)
    assert "-friction is 0.1 there, not 0.2" in done.complaint[0]


def test_branch_with_another_gap_goes_on(stopped, petsam):
    """Its own checkpoints know the new gap."""
    other = dict(gap_radius1=0.25)
    petsam(CASE, FROM, other, dict(restart_gap=True, checkpoint="branch.state", checkpoint_every=4))
    shutil.copy(stopped / "branch.h5", stopped / "before.h5")
    petsam(CASE, other, dict(restart="branch.state.1", output="branch.h5"))
    assert not differences(stopped / "branch.h5", stopped / "before.h5")

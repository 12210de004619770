"""A restart under another name of its results; several ways from one state, on another gap too, in Python."""

import re

import h5py
import numpy as np
import pytest

import petsam as library
from conftest import PROGRAM, execute
from kinds.kills import CASE, write_history
from support import ROOT

STEPS, AT = 24, 14
KEPT = dict(checkpoint="state.h5", checkpoint_every=7)
FROM = dict(restart="state.h5.1", output="rest.h5")  # the checkpoint after step 14


@pytest.fixture
def stopped(tmp_path, petsam):
    write_history(tmp_path, STEPS)
    petsam(CASE, KEPT)
    return tmp_path


def read(path):
    """All values, those of /history under their names there."""
    with h5py.File(path) as f:
        found = {name: data[:] for name, data in f.items() if isinstance(data, h5py.Dataset)}
        return {**found, **{f"history/{name}": data[:] for name, data in f["history"].items()}}


def assert_rest(rest, whole, first):
    """A file holds what another one does from a step on, to the last bit."""
    one, two = read(rest), read(whole)
    assert one.keys() == two.keys()
    for name, values in one.items():
        same = two[name] if name in ("x", "y", "coordinate", "point") else two[name][first:]
        if name in ("contact_edge", "stick_edge"):  # as wide as their longest edge
            same = same[:, : values.shape[1]]
        if name != "point":
            assert np.array_equal(values, same, equal_nan=values.dtype.kind == "f"), name


@pytest.mark.parametrize("ranks", [1, 3])
def test_another_name_holds_the_rest_of_the_history(stopped, petsam, ranks):
    before = (stopped / "out.h5").read_bytes()
    petsam(CASE, FROM, ranks=ranks)
    assert_rest(stopped / "rest.h5", stopped / "out.h5", AT)
    assert (stopped / "out.h5").read_bytes() == before
    # once it is there it may be longer than what would replace it
    begun = (stopped / "rest.h5").read_bytes()
    done = petsam(CASE, FROM, check=2)
    assert "-output rest.h5" in done.complaint[0] and "belongs to other results" in done.complaint[0]
    assert (stopped / "rest.h5").read_bytes() == begun


def test_results_that_are_missing_are_not_begun_anew(stopped, petsam):
    """Under the name that they had, they have been lost or left behind."""
    (stopped / "out.h5").unlink()
    assert "No such file" in petsam(CASE, dict(restart="state.h5"), check=3).complaint[0]
    assert not (stopped / "out.h5").exists()


def test_results_begin_at_the_restart_of_a_run_without_them(stopped, petsam):
    petsam({**CASE, **KEPT, "output": None, "checkpoint": "bare.h5"})
    petsam(CASE, dict(restart="bare.h5.1", output="rest.h5"))
    assert_rest(stopped / "rest.h5", stopped / "out.h5", AT)


def test_steps_have_the_numbers_of_the_run(stopped, petsam):
    petsam(CASE, FROM)
    with library.open(stopped / "rest.h5") as rest, library.open(stopped / "out.h5") as whole:
        assert rest.steps == list(range(AT + 1, STEPS + 1)) and rest.before == AT
        one, two = (results.field("shear_x", results.of_step(20)) for results in (rest, whole))
        assert np.array_equal(one, two) and rest.of_step(-1) == STEPS - AT - 1
        assert rest.title(0).startswith("rest, step 15,")
        with pytest.raises(library.Error, match="the file has the steps 15 to 24"):
            rest.of_step(3)
    words = dict(input="rest.h5", output="stress.h5", body=2, depths="0", steps="20")
    for code, more in ((0, {}), (2, dict(steps="3"))):
        execute([], stopped, [words, more], 1, code, program=PROGRAM.with_name("petsam-stress"))
    with h5py.File(stopped / "stress.h5") as f, h5py.File(stopped / "out.h5") as g:
        assert f["history/step"][:].tolist() == [20]
        assert np.allclose(-f["stress_zz"][0, 0], g["pressure"][19], rtol=0, atol=1e-9 * g["pressure"][19].max())


def test_another_gap_is_refused(stopped, petsam):
    assert "-gap_radius1 is 0.2 there, not 0.25" in petsam(CASE, FROM, dict(gap_radius1=0.25), check=2).complaint[0]
    assert "-restart_gap: unknown option" in petsam(CASE, FROM, dict(restart_gap=True), check=2).complaint[0]


# ---------------------------------------------------------------- in Python

MANUAL = (ROOT / "examples/manual/CHECKPOINTS.md").read_text()
SNIPPET = re.search(r"### Several ways from one state\n.*?```python\n(.*?)```", MANUAL, re.S).group(1)


def test_the_example_of_the_manual_keeps_the_slip_on_another_gap(tmp_path, monkeypatch):
    """Hertz's pressure is that of the new radius; cells that stick have the slip of the saved state."""
    ways, said = [], []

    class Contact(library.Contact):
        def try_step(self, **given):
            step = super().try_step(**given)
            ways.append((self["slip_x"].copy(), self["state"] == 1, self.number("pressure_max")))
            return step

    (tmp_path / "build/run").mkdir(parents=True)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(library, "Contact", Contact)
    exec(SNIPPET, {"print": lambda *words: said.append(words)})
    (saved, _, first), *others = ways
    assert [radius for radius, *_ in said] == [0.1, 0.12] and len(others) == 2
    for (radius, _, work), (slip, sticks, peak) in zip(said, others):
        assert peak / first == pytest.approx((0.1 / radius) ** (2 / 3), rel=0.01) and work > 0
        assert np.abs(saved[sticks]).max() > 0.1 * np.abs(saved).max()
        assert np.abs(slip - saved)[sticks].max() < 1e-6 * np.abs(saved).max()

"""Stresses and fatigue parameters in process: the bits of petsam-stress on the same steps."""

import h5py
import numpy as np
import pytest

import conftest
from test_embed import CASE, run_python

BULK = dict(CASE, bulk2_stress_xx=4e7, friction=0.3)
PROGRAM = conftest.PROGRAM.with_name("petsam-stress")
# the load to one side, and a cycle; of N too
STEPS = [(900.0 + 20 * (k % 3), tx) for k, tx in enumerate([60, 100, 100, 20, -60, -100, -20, 60, 100])]
CYCLE = "3:9"
CONSTANTS = dict(
    fatigue_crossland_alpha=0.2,
    fatigue_dang_van_alpha=0.3,
    fatigue_findley_k=0.3,
    fatigue_fatemi_socie_k=1.0,
    fatigue_yield=4e8,
)
PARAMETERS = "crossland,dang_van,findley,swt,fatemi_socie,ruiz"
ALL = "stress,mises,principal,shear_max,strain"
WHERE = [
    dict(depths=(0.0, 1e-4)),
    dict(depths="0:2e-4:4", section="y=0"),
    dict(depths=(0.0, 3e-5), section="x=1e-4", body=1),
]
CONTACT = f"""
import petsam, numpy as np
contact = petsam.Contact(**{BULK!r})
for k, (n, tx) in enumerate({STEPS!r}, 1):
    if k == 3:
        contact.record()
    contact.try_step(time=k, load_n=n, load_tx=tx)
"""


@pytest.fixture(scope="module")
def contact(tmp_path_factory, launcher):
    """A folder with the program's results of the steps."""
    folder = tmp_path_factory.mktemp("inprocess")
    rows = ["time,load_n,load_tx", *(f"{k},{n!r},{tx!r}" for k, (n, tx) in enumerate(STEPS, 1))]
    (folder / "h.csv").write_text("\n".join(rows))
    conftest.execute(launcher, folder, [dict(BULK, history="h.csv", output="c.h5", output_fields="all")], 1, 0)
    return folder


def compare(launcher, folder, npz, ranks=1, **options):
    """The arrays of a file of numpy are the datasets of petsam-stress, to the last bit."""
    conftest.execute(launcher, folder, [dict(options, input="c.h5", output="s.h5")], ranks, 0, program=PROGRAM)
    found = np.load(folder / npz)
    with h5py.File(folder / "s.h5") as f:
        expected = {name: data[()] for name, data in f.items() if isinstance(data, h5py.Dataset)}
    assert set(found) == set(expected)
    for name, values in expected.items():
        assert found[name].shape == values.shape and found[name].tobytes() == values.tobytes(), name


@pytest.mark.parametrize("where", WHERE)
def test_stress_of_a_step_has_the_bits_of_the_program(launcher, contact, where):
    """Of a tried step, and of the committed one when it is rejected."""
    run_python(
        CONTACT
        + f"""
    if k == 5:
        np.savez("tried.npz", **contact.stress(quantities={ALL.split(",")!r}, **{where!r}))
    contact.commit()
contact.try_step(load_n=500)
contact.reject()
np.savez("committed.npz", **contact.stress(**{where!r}))
""",
        contact,
    )
    compare(launcher, contact, "tried.npz", steps=5, quantities=ALL, **where)
    compare(launcher, contact, "committed.npz", steps="last", ranks=2, **where)


@pytest.mark.parametrize("where", WHERE)
def test_fatigue_of_recorded_steps_has_the_bits_of_the_program(launcher, contact, where):
    run_python(
        CONTACT
        + f"""    contact.commit()
np.savez("f.npz", **contact.fatigue({PARAMETERS!r}, quantities="mises", **{where!r}, **{CONSTANTS!r}))
""",
        contact,
    )
    compare(launcher, contact, "f.npz", steps=CYCLE, fatigue=PARAMETERS, quantities="mises", **where, **CONSTANTS)


def test_mistakes_are_named_and_the_contact_lives(tmp_path):
    run_python(
        f"""
import petsam, numpy as np
contact = petsam.Contact(**{CASE!r})
def told(words, function, *names, **given):
    try:
        function(*names, **given)
    except petsam.ContactError as error:
        assert words in str(error), str(error)
    else:
        raise SystemExit(words)
told("no step has been solved", contact.stress)
contact.record()
contact.try_step(load_n=100)
contact.commit()
told("-depths", contact.stress, depths=-1)
told("millionth of a cell", contact.stress, depths=1e-15)
told("outside of the grid", contact.stress, section="y=1")
told("-body 3", contact.stress, body=3)
told("-quantities temperature", contact.stress, quantities="temperature")
told("needs the steps of a cycle", contact.fatigue, "swt")
contact.try_step(load_n=90)
contact.commit()
told("-fatigue_findley_k is missing", contact.fatigue, "findley")
told("-friction", contact.fatigue, "swt", friction=0.1)
told("0 must be one of", contact.fatigue, "ruiz", depths=1e-4)
found = contact.stress(quantities=())
assert set(found) == {{"time", "z", "y", "x"}} and np.allclose(found["x"], contact.x)
rigid = petsam.Contact(**dict({CASE!r}, body2_young="inf"))
rigid.try_step(load_n=100)
told("it is rigid", rigid.stress)
assert rigid.stress(body=1)["mises"].max() > 0
periodic = petsam.Contact(elasticity="periodic", **{CASE!r})
periodic.try_step(load_n=100)
told("stresses are not available for bodies of type periodic", periodic.stress)
""",
        tmp_path,
    )


def test_cycle_that_is_not_closed_is_warned_of(tmp_path):
    text = run_python(
        f"""
import petsam, warnings
contact = petsam.Contact(**dict({CASE!r}, body2_young=210e9, body2_poisson=0.3))  # N alone brings no shear
def cycle(*loads):
    for load in loads:
        contact.try_step(load_n=load)
        contact.commit()
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        contact.fatigue("crossland", fatigue_crossland_alpha=0.2, section="y=0")
    print([(one.category.__name__, str(one.message)[:18], "of the last recorded" in str(one.message)) for one in said])
contact.record()
cycle(100, 200, 100)  # before it there was nothing
contact.record()
cycle(200, 100)
cycle(200, 150)
""",
        tmp_path,
    )
    assert text.splitlines() == ["[]", "[]", "[('CycleWarning', 'not a closed cycle', True)]"]


def test_history_and_life_are_recorded(launcher, tmp_path):
    """Of a history all steps, of a life those of the last computed cycle."""
    side = [0.0, 60.0, 0.0, -60.0, 0.0]
    table = dict(time=[1.0, 2.0, 3.0, 4.0, 5.0], load_n=[900.0] * 5, load_tx=side)
    rows = ["time,load_n,load_tx", *(",".join(map(repr, row)) for row in zip(*table.values()))]
    (tmp_path / "h.csv").write_text("\n".join(rows))
    case = dict(CASE, friction=0.3, steps=2, wear_coefficient2=1e-15)
    run_python(
        f"""
import petsam, numpy as np
for kind in ("run", "live"):
    with petsam.Contact(**{case!r}) as contact:
        contact.record()
        getattr(contact, kind)(*([1e4] if kind == "live" else []), {table!r})
        np.savez(kind + ".npz", **contact.fatigue("swt,ruiz", section="y=0", quantities="stress"))
""",
        tmp_path,
    )
    options = dict(fatigue="swt,ruiz", section="y=0", quantities="stress")
    for kind, more in ("run", {}), ("live", dict(wear_cycles=1e4, wear_output=(0, 1e4))):
        program = dict(case, history="h.csv", output="c.h5", output_fields="all", **more)
        conftest.execute(launcher, tmp_path, [program], 1, 0)
        with h5py.File(tmp_path / "c.h5") as f:
            last = len(f["history/time"])
        steps = len(np.load(tmp_path / f"{kind}.npz")["time"])
        assert steps == (10 if kind == "run" else 8)
        compare(launcher, tmp_path, f"{kind}.npz", steps=f"{last - steps + 1}:{last}", **options)


YIELDING = dict(
    CASE, body2_young=210e9, body2_poisson=0.3, grid_n=(16, 15), friction=0.3, body1_yield=2e8, body2_yield=1.5e8,
    body2_hardening="linear:1e9", yield_depth=6e-4, yield_layers=4,
)  # fmt: skip


def test_stresses_of_bodies_that_yield_are_those_of_their_layers_too(launcher, tmp_path):
    """The bits are those of the program: a step in both bodies, and a recorded cycle in which strain still grows."""
    steps = [(900.0, 0.0), (900.0, 150.0), (2500.0, -150.0), (900.0, 100.0)]
    rows = ["time,load_n,load_tx", *(f"{k},{n!r},{tx!r}" for k, (n, tx) in enumerate(steps, 1))]
    (tmp_path / "h.csv").write_text("\n".join(rows))
    case = dict(YIELDING, history="h.csv", output="c.h5", output_fields="all,plastic", allow_edge_contact=True)
    conftest.execute(launcher, tmp_path, [dict(case, step_divide="false")], 1, 0)
    more = dict(fatigue_crossland_alpha=0.2, depths=(0.0, 5e-5))
    fatigue = dict(more, fatigue="swt,crossland")
    run_python(
        f"""
import petsam, numpy as np
contact = petsam.Contact(**{dict(YIELDING, allow_edge_contact=True)!r})
contact.record()
for k, (n, tx) in enumerate({steps!r}, 1):
    contact.try_step(time=k, load_n=n, load_tx=tx)
    contact.commit()
np.savez("cycle.npz", **contact.fatigue("swt,crossland", **{more!r}))
for body in 1, 2:
    np.savez(f"{{body}}.npz", **contact.stress(depths=(0.0, 1e-4), section="y=0", body=body))
""",
        tmp_path,
    )
    with h5py.File(tmp_path / "c.h5") as f:
        assert (np.diff(f["history/plastic_max"][1:]) > 0).any() and f["history/yielding_cells"][2] > 5
    compare(launcher, tmp_path, "cycle.npz", steps="1:4", quantities="none", **fatigue)
    for body in 1, 2:
        compare(launcher, tmp_path, f"{body}.npz", depths=(0.0, 1e-4), section="y=0", body=body, steps=4)

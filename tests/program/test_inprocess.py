"""Histories and lives in process: the bits of the program; copies; what is refused."""

import h5py
import numpy as np
import pytest

import compliances
import petsam as package
from petsam.contact import histories
from support import ROOT
from test_embed import CASE as EMBEDDED
from test_embed import run_python

CASE = dict(EMBEDDED, friction=0.4)
COLUMNS = "time,load_n,disp_x,load_ty"
ROWS = [(1, 500.0, 0.0, 0.0), (2, 800.0, 3e-7, 20.0), (3, 700.0, -2e-7, -30.0), (4.5, 900.0, 1e-7, 0.0)]
CYCLE = [(k, 1000.0, 4e-7 * x) for k, x in enumerate((0, 0.5, 1, 0.5, 0, -0.5, -1, -0.5, 0))]
HISTORY = f"dict(zip({COLUMNS.split(',')!r}, np.transpose({ROWS!r})))"
BEGIN = (
    f"import numpy as np, petsam\ncase = {CASE!r}\nhistory = {HISTORY}\n"
    + '''
def alike(a, b):
    """The same numbers, also those that a step does not have."""
    return a.keys() == b.keys() and all(np.array_equal(a[name], b[name], equal_nan=True) for name in a)
'''
)


def write(path, columns, rows):
    path.write_text("\n".join([columns, *(",".join(map(repr, row)) for row in rows)]))


def test_a_row_of_a_history_that_lost_a_field_is_named(tmp_path):
    (tmp_path / "h.csv").write_text("# pull\ntime,load_n,load_tx\n1,100,0\n2,100\n")
    with pytest.raises(ValueError, match="h.csv, line 4: has 2 fields, the head has 3"):
        histories.table(tmp_path / "h.csv")


def test_history_has_the_bits_of_the_program(petsam, tmp_path):
    """Given as arrays and as the program's own file, which may have comments and other separators. Its columns, too."""
    write(tmp_path / "h.csv", COLUMNS, ROWS)
    (tmp_path / "h.txt").write_text("# a history\n" + (tmp_path / "h.csv").read_text().replace(",", " ; "))
    petsam(dict(CASE, history="h.csv", steps=3, output="h.h5", output_fields="all"))
    run_python(
        BEGIN
        + """
found = {}
for name, given in ("a", history), ("f", "h.txt"):
    with petsam.Contact(steps=3, output=f"{name}.h5", **case) as contact:
        steps = contact.run(given)
        assert not hasattr(steps[-1], "friction_scale")
        for number in "time", "load_tx", "disp_z", "dissipated_energy", "contact_area", "normal_iterations":
            found[f"{name}/{number}"] = [getattr(step, number) for step in steps]
        for field in "pressure", "shear_x", "slip_y", "gap":
            found[f"{name}/{field}"] = contact.field(field)
    with petsam.Contact(**case) as contact:
        assert contact.run(dict(history, friction_scale=[1, 1, 0.9, 0.9]))[-1].friction_scale == 0.9
np.savez("found.npz", **found)
""",
        tmp_path,
    )
    found = np.load(tmp_path / "found.npz")
    with h5py.File(tmp_path / "h.h5") as f, h5py.File(tmp_path / "a.h5") as own:
        assert len(f["history/time"]) == 12 and set(f["history"]) == set(own["history"])
        for key in found:
            name = key.split("/")[1]
            expected = f["history"][name][:] if name in f["history"] else f[name][-1]
            assert found[key].astype(float).tobytes() == np.asarray(expected, dtype=float).tobytes(), key


def test_life_has_the_bits_of_the_program(petsam, tmp_path):
    """Its log, its fields, and the file that it writes itself; and a second life goes on from the worn surfaces."""
    write(tmp_path / "c.csv", "time,load_n,disp_x", CYCLE)
    wear = dict(CASE, wear_coefficient1=1e-12, wear_rtol=0.03)
    petsam(dict(wear, history="c.csv", wear_cycles=1e4, output="c.h5"))
    run_python(
        f"""
import numpy as np, petsam
cycle = dict(zip(("time", "load_n", "disp_x"), np.transpose({CYCLE!r})))
with petsam.Contact(output="own.h5", **{wear!r}) as contact:
    log = contact.live(1e4, cycle)
    found = {{name: [one.numbers[name] for one in log] for name in log[0].numbers}}
    depth = contact.field("wear_depth1")
    again = contact.live(1e3, cycle)
    assert again[0].cycle == 0 and again[0].depth_max1 == log[-1].depth_max1 < again[-1].depth_max1
np.savez("found.npz", depth=depth, **found)
""",
        tmp_path,
    )
    found = np.load(tmp_path / "found.npz")
    with h5py.File(tmp_path / "c.h5") as f, h5py.File(tmp_path / "own.h5") as own:
        assert f["wear/cycle"][-1] == 1e4 and len(f["wear/cycle"]) > 3
        for name in found.files:
            expected = f["wear_depth1"][-1] if name == "depth" else f["wear"][name][:]
            assert found[name].astype(float).tobytes() == np.asarray(expected, dtype=float).tobytes(), name
        assert own["wear/cycle"][-1] == 1e3  # the file of the last life


def test_history_goes_on_from_the_committed_state(tmp_path):
    """In one call or in two, with increments between them, the steps are the same."""
    out = run_python(
        BEGIN
        + """
with petsam.Contact(steps=4, **case) as one, petsam.Contact(steps=4, **case) as two:
    a = one.run(history)
    b = two.run({name: values[:2] for name, values in history.items()})
    assert len(b) == 8
    b += two.run({name: values[2:] for name, values in history.items()})
    print([s.time for s in a] == [s.time for s in b], all(np.array_equal(s.load, t.load) for s, t in zip(a, b)),
          all(np.array_equal(s.rigid, t.rigid) for s, t in zip(a, b)), len(a))
""",
        tmp_path,
    )
    assert out.split() == ["True", "True", "True", "16"]


def test_copy_and_reset(tmp_path):
    """A copy goes on as its original would, to the last bit, and leaves it alone; after reset() all begins anew."""
    run_python(
        BEGIN
        + """
with petsam.Contact(**case) as contact:
    contact.friction = np.linspace(0.3, 0.4, 45)
    first = contact.run(history)
    with contact.copy() as other:
        a = other.try_step(time=9, load_n=600, load_tx=50)
        other.commit()
        shear = other["shear_x"]
    b = contact.try_step(time=9, load_n=600, load_tx=50)
    assert np.array_equal(a.rigid, b.rigid) and alike(a.numbers, b.numbers)
    assert np.array_equal(contact["shear_x"], shear)
    contact.reset()
    again = contact.run(history)
    assert all(alike(a.numbers, b.numbers) for a, b in zip(again, first)) and len(again) == len(first)
""",
        tmp_path,
    )


def test_function_is_called_after_each_step_and_may_stop(tmp_path):
    run_python(
        BEGIN
        + """
with petsam.Contact(**case) as contact:
    seen = []
    def each(contact, step):
        seen.append((step.time, contact["pressure"].max() == step.pressure_max))
        return len(seen) == 3
    assert len(contact.run(history, each)) == 3
    assert seen == [(1, True), (2, True), (3, True)]
    step = contact.try_step(time=4.5, load_n=900, disp_x=1e-7)  # the third one is committed
    def fail(contact, step):
        raise KeyError("mine")
    try:
        contact.run(history, fail)
    except KeyError as error:
        assert error.args == ("mine",)
    else:
        raise SystemExit("no exception")
""",
        tmp_path,
    )


def test_mistakes_are_told_and_leave_a_contact_that_goes_on(tmp_path):
    run_python(
        BEGIN
        + """
def refused(says, call, kind=petsam.ContactError):
    try:
        call()
    except kind as error:
        assert says in str(error), str(error)
        return error
    raise SystemExit(f"not refused: {says}")

with petsam.Contact(wear_coefficient1=1e-14, **case) as contact:
    refused("is load_n meant?", lambda: contact.run(dict(history, lod_n=history["load_n"])))
    refused("expected more than 2", lambda: contact.run(dict(history, time=[1, 2, 2, 3])))
    refused("load_n or disp_z", lambda: contact.run(dict(time=[1.0], disp_x=[0.0])))
    refused("not a finite number", lambda: contact.run(dict(history, load_n=[1, 2, 3, np.nan])))
    refused("not a closed cycle", lambda: contact.live(10, history))
    refused("number > 0", lambda: contact.live(0, history))
    refused("expected an integer", lambda: contact.live(1.5, history))
    slides = dict(time=[1, 2, 3], load_n=[500] * 3, load_tx=[0, 100, 1e4])
    error = refused("gross slip", lambda: contact.run(slides), petsam.NoEquilibrium)
    assert len(error.steps) == 2 and error.step.time == 3 and abs(error.steps[1].load_tx - 100) < 1e-6
    for name in ("", "load_tx,load_ty", "load_tx ", "load_tx;", "a\\nb"):  # each name has its value
        error = refused("is no name", lambda: contact.try_step(load_n=1000, **{name: 1}), petsam.PrescribedError)
        assert error.step is None and not error.steps
        refused("is no name", lambda: contact.try_step(roll=1e-6, load_n=1000, **{name: 1}), petsam.PrescribedError)
        refused("is no name", lambda: contact.run({"time": [1.0], "load_n": [1e3], name: [1.0]}))
        refused("is no name", lambda: contact.live(10, {"time": [1.0], "load_n": [1e3], name: [1.0]}))
    twice = {"time": [1.0], "load_n": [1e3], "Load_N": [1e3]}  # petsam takes both for one name
    refused("_n and Load_N are one name", lambda: contact.try_step(load_n=1, Load_N=2), petsam.PrescribedError)
    refused("_n and Load_N are one name", lambda: contact.run(twice))
    assert contact.try_step(time=4, load_n=500, load_tx=120).status == 0
twice = {"load_n": [1.0], "Load_N": [2.0]}
refused("_n and Grid_N are one name", lambda: petsam.Contact(**case, Grid_N=8), petsam.Error)
refused("_n and Grid_N are one name", lambda: petsam.run(case, Grid_N=8), petsam.Error)
refused("history: load_n and Load_N", lambda: petsam.run(case, history=twice), petsam.Error)
with petsam.Contact(**case) as contact:
    refused("no wear", lambda: contact.live(10, dict(time=[0, 1, 2], load_n=[1, 1, 1], disp_x=[0, 1e-8, 0])))
refused("-wear_cycles: ", lambda: petsam.Contact(wear_cycles=10, wear_coefficient1=1e-14, **case))
""",
        tmp_path,
    )


def test_a_condensed_stiffness_is_that_of_a_displacement_while_the_other_loads_stay(tmp_path):
    """Dissimilar bodies that touch beside the origin, where all six components go together: 36 % below the diagonal."""
    run_python(
        """
import numpy as np, petsam
case = dict(body1_young=210e9, body1_poisson=.3, body2_young=70e9, body2_poisson=.2, friction=.5,
            gap_type="flat", grid_n=32, grid_size=2e-3, slip_direction="end")
with petsam.Contact(**case) as contact:
    x, y = np.meshgrid(contact.x, contact.y)
    contact["gap"] = ((x - 2e-4) ** 2 + (y - 4e-4) ** 2) / 0.2
    step = contact.try_step(load_n=100, rot_x=0, rot_y=0, load_tx=10)
    held = dict(load_n=100, load_mx=step.load_mx, load_my=step.load_my)
    for load in (10.0, 10.1, 10.2):
        contact.commit()
        step = contact.try_step(load_tx=load, **held)
    full, one, two = (contact.stiffness(condense=name) for name in (None, "disp_x", ["rot_z", "disp_x"]))
    contact.reject()
    other = contact.try_step(disp_x=step.disp_x + 1e-10, **held)
    assert abs(one / ((other.load_tx - step.load_tx) / 1e-10) - 1) < 1e-3 and one < 0.8 * full[1, 1]
    assert np.allclose(two, np.linalg.inv(np.linalg.inv(full)[np.ix_([5, 1], [5, 1])]), rtol=1e-9)
    assert isinstance(two, petsam.contact.Stiffness) and list(two.loads) == ["load_mz", "load_tx"]
    head, *rows = repr(full).splitlines()
    names = [name.split(" / ")[0] for name in (one.strip() for one in head.split("  ")) if name]
    assert names == ["disp_z", "disp_x", "disp_y", "rot_x", "rot_y", "rot_z"] and "disp_x / m " in head
    assert [row.split()[0] for row in rows] == ["N", "Tx", "Ty", "Mx", "My", "Mz"] and rows[3].startswith("Mx / (N m) ")
    assert float(rows[1].split()[4]) == float(f"{full[1, 1]:.5g}") and isinstance(full, np.ndarray)
    units = {"load_n": "N", "load_mx": "N m"}, {"disp_z": "m", "rot_x": "rad"}
    small = petsam.contact.Stiffness([[1e8, 1e-9], [2e-3, 1e2]], *units)
    assert [line.split()[-2:] for line in repr(small).splitlines()[1:]] == [["1e+08", "0"], ["0.002", "100"]]
    assert "load_tx=10.2, load_ty=0, " in repr(step) and step.load_ty != 0
    plain = np.linalg.inv(full), full[:, ::-1], 2 * full, full.T, full @ np.ones(6), full.sum(axis=0)
    assert all(type(one) is np.ndarray for one in plain) and np.allclose(full @ np.linalg.solve(full, np.ones(6)), 1)
    import pickle

    assert repr(pickle.loads(pickle.dumps(full))) == repr(full)
    assert "disp" not in repr(full.copy()) and np.ndim(full.sum()) == 0 and type(full.max()) is np.float64
    try:
        contact.stiffness(condense="disp_q")
    except petsam.ContactError as error:
        assert "condense disp_q: is no displacement: is disp_" in str(error)
    else:
        raise SystemExit("not refused")
del case["friction"]
with petsam.Contact(**dict(case, gap_type="sphere", gap_radius1=0.1, gap_radius2=0.1)) as contact:
    contact.try_step(load_n=100)
    assert abs(contact.stiffness(condense="disp_z") / contact.stiffness()[0, 0] - 1) < 1e-9
""",
        tmp_path,
    )


def test_files_of_other_contacts_are_refused_and_leave_the_contact_alone(petsam, tmp_path):
    """Files of programs' runs. The sum of another contact is left out, and is not accumulated either."""
    petsam(dict(CASE, load_n=500.0), dict(checkpoint="run.h5", checkpoint_every=1))
    run_python(
        BEGIN
        + """
def refused(says, file):
    try:
        one.load(file)
    except petsam.ContactError as error:
        assert says in str(error), str(error)
    else:
        raise SystemExit("not refused")

with petsam.Contact(sum_slip_path=True, **case) as sums, petsam.Contact(**case) as one:
    for contact, file in (sums, "sum.h5"), (one, "one.h5"):
        contact.run(history)
        contact.save(file)
    one.load("sum.h5")  # without its sum
    refused("program", "run.h5")
    one.load("one.h5")
    assert np.array_equal(one.copy()["pressure"], one["pressure"])
    sums.load("sum.h5")
""",
        tmp_path,
    )
    done = petsam(dict(CASE, load_n=500.0), dict(restart="one.h5"), check=2)
    assert "a contact in process has saved it" in done.complaint[0]


def test_restart_is_of_the_first_run_only(tmp_path):
    """One that is refused leaves a contact without steps; later runs go on from the committed state."""
    run_python(
        BEGIN
        + """
more = dict(time=[10, 11], load_n=[600, 600], disp_x=[1e-7, 0])
with petsam.Contact(checkpoint="c.h5", checkpoint_every=1, **case) as contact:
    contact.run(history, lambda _, step: step.time == 2)
with petsam.Contact(restart="c.h5", **case) as contact, petsam.Contact(**case) as whole:
    try:
        contact.run(dict(history, load_n=[1, 2, 3, 4]))
    except petsam.ContactError as error:
        assert "does not fit: -load_n" in str(error), str(error)
    else:
        raise SystemExit("not refused")
    try:
        contact.save("none.h5")
    except petsam.ContactError as error:
        assert "no step has been committed" in str(error), str(error)
    else:
        raise SystemExit("not refused")
    for steps, program in (2, history), (2, more):
        a, b = contact.run(program), whole.run(program)
        assert len(a) == steps and all(alike(s.numbers, t.numbers) for s, t in zip(a, b[-steps:]))
""",
        tmp_path,
    )


ROLLS = [(0, 0.0, 0.0, 60.0), (1, 5e-5, 0.0, 60.0), (2, 7e-5, -2e-5, 90.0)]


def test_steps_that_roll_have_the_bits_of_the_program(petsam, tmp_path):
    """Tried, rejected and tried again; a creepage that was found, given. The next history does not roll on."""
    case = dict(CASE, load_n=800.0)
    write(tmp_path / "h.csv", "time,roll,roll_y,load_tx", ROLLS)
    petsam(dict(case, history="h.csv", output="h.h5", output_fields="all"))
    run_python(
        BEGIN
        + f"""
found = []
with petsam.Contact(**case) as contact:
    for time, x, y, load_tx in {ROLLS!r}:
        given = dict(time=time, load_n=800, load_tx=load_tx)
        if time:
            contact.try_step(roll=3e-5, roll_y=1e-4, load_n=900, creep_x=1e-3)
            contact.reject()
        found.append(contact.try_step(roll=x, roll_y=y, **given) if time else contact.try_step(**given))
        last = found[-1]
        creeps = {{name: last.numbers.get(name) for name in ("creep_x", "creep_y", "creep_spin")}}
        if time:
            same = contact.try_step(roll=x, roll_y=y, time=time, load_n=800, **creeps)
            assert np.allclose(same.load, last.load, rtol=1e-4, atol=0.01), (same, last)
            contact.try_step(roll=x, roll_y=y, **given)
        contact.commit()
    shear = contact["shear_x"]
    assert contact.run(dict(time=[3], load_n=[800], load_tx=[95]))[0].roll == 0
numbers = {{name: [step.numbers.get(name, np.nan) for step in found] for name in found[-1].numbers}}
np.savez("found.npz", field=shear, **numbers)
""",
        tmp_path,
    )
    found = np.load(tmp_path / "found.npz")
    with h5py.File(tmp_path / "h.h5") as f:
        assert np.array_equal(found["field"], f["shear_x"][-1])
        assert set(f["history"]) - {"time", "status"} <= set(found.files)
        for name in set(found.files) & {"creep_x", "creep_spin", "disp_x", "roll_y", "slip_max"}:
            assert found[name][1:].tobytes() == f["history"][name][1:].tobytes(), name


STRETCHED = {"body2_case_pull": [1.0, 0.5, 0.7], "body2_case_turn": [0.0, 0.2, 0.2]}


@pytest.mark.parametrize(
    ("options", "columns"),
    [
        ({}, {"bulk2_stress_xx": [0.0, 4e7, 1e7], "friction_scale": [1.0, 0.7, 1.2], "disp_x": [0.0, 3e-7, 1e-7]}),
        ({"bulk2_stress_yy": 2e7}, {"bulk2_stress_xx": [0.0, 4e7, 1e7], "load_tx": [0.0, 40.0, 10.0]}),
        ({}, {"roll": [0.0, 1e-4, 5e-5], "roll_y": [0.0, 0.0, -2e-5], "friction_scale": [1.0, 1.0, 0.8]}),
        ({"body2_compliance": "cases.h5"}, STRETCHED),
    ],
)
def test_step_takes_the_conditions_of_a_history_with_its_bits(options, columns, tmp_path):
    """Conditions that are named hold for that step; others have the values of the contact's options."""
    flat = np.zeros((3, 3))
    flat[1] = 1e-5, 2e-5, 0.0
    cases = dict(pull=flat, turn=flat[:, ::-1])
    compliances.write(tmp_path / "cases.h5", np.zeros((3, 3, 3, 3)), half=2e-3, young=70e9, poisson=0.2, cases=cases)
    case = dict(CASE, **options)
    run_python(
        f"""
import numpy as np, petsam
columns = dict(load_n=[800.0, 900.0, 700.0], **{columns!r})
with petsam.Contact(**{case!r}) as one, petsam.Contact(**{case!r}) as two:
    assert set(columns) <= set(one.prescribable) and one.prescribable["load_n"] == "N"
    steps = one.run(dict(time=[1, 2, 3], **columns))
    for k, step in enumerate(steps):
        given = {{name: value[k] for name, value in columns.items()}}
        two.try_step(load_n=850, **{{name: 1.1 * value for name, value in given.items() if name != "load_n"}})
        two.reject()
        found = two.try_step(time=k + 1, **given)
        two.commit()
    assert found.numbers.keys() == step.numbers.keys(), (set(found.numbers) ^ set(step.numbers))
    assert {{n: v for n, v in found.numbers.items() if v != step.numbers[n] and v == v}} == {{}}
    for name in "pressure", "shear_x", "slip_y":
        assert np.array_equal(one[name], two[name]), name
    usual = two.try_step(load_n=700)
    for name in set(columns) - {{"load_n", "load_tx", "disp_x"}}:
        assert usual.numbers[name] == (name == "friction_scale"), name
    assert usual.numbers.get("bulk2_stress_yy", 0) == {options.get("bulk2_stress_yy", 0)!r}
    try:
        two.try_step(load_n=700, bulk2_stres_xx=1.0)
    except petsam.ContactError as error:
        assert error.code == 2 and "bulk2_stres_xx is not" in str(error) and "bulk2_stress_xx meant?" in str(error)
    else:
        raise SystemExit("not refused")
""",
        tmp_path,
    )


def test_steady_rolling_in_process(petsam, tmp_path):
    """Each try is a steady state, with the bits of the program; creepages have their own names."""
    case = dict(CASE, body2_young=210e9, body2_poisson=0.3, rolling="steady")
    write(tmp_path / "h.csv", "time,load_n,creep_x,load_ty", [(1, 800.0, 4e-4, 9.0), (2, 800.0, 5e-4, 9.0)])
    petsam(dict(case, history="h.csv", output="h.h5"))
    run_python(
        f"""
import numpy as np, petsam
with petsam.Contact(**{case!r}) as contact:
    for creep in 4e-4, 5e-4:
        contact.try_step(load_n=900, creep_x=1e-2, creep_spin=3)
        contact.reject()
        step = contact.try_step(load_n=800, creep_x=creep, load_ty=9)
        contact.commit()
    assert step.rigid[1] == step.creep_x == 5e-4 and not hasattr(step, "disp_x") and "creep_y=" in repr(step)
    velocity = contact["slip_velocity_x"]
    again = contact.run(dict(time=[3], load_n=[800], creep_x=[5e-4], load_ty=[9]))[0]
    assert again.tangential_iterations == 0 and again.load_tx == step.load_tx and again.rigid[2] == again.creep_y
    for says, wrong in ("no meaning with -rolling steady", dict(roll=1e-5)), ("load_n or disp_z is", dict(roll=0)):
        try:
            contact.try_step(**wrong, **(dict(load_n=800) if wrong["roll"] else dict()))
        except (petsam.ContactError, TypeError) as error:
            assert says in str(error), error
        else:
            raise SystemExit("not refused")
    np.savez("found.npz", velocity=velocity, **step.numbers)
""",
        tmp_path,
    )
    found = np.load(tmp_path / "found.npz")
    with h5py.File(tmp_path / "h.h5") as f:
        assert np.array_equal(found["velocity"], f["slip_velocity_x"][-1])
        for name in "load_tx", "creep_y", "load_tx_extrapolated", "rolling_energy", "stick_area":
            assert found[name] == f["history"][name][-1], name


def test_examples_run(tmp_path):
    for name, says in ("history", "81 steps"), ("life", "  100000 cycles"), ("fatigue", "(33, 1, 96)"):
        assert says in run_python((ROOT / f"examples/embed/python/{name}.py").read_text(), tmp_path)


def test_steps_that_slide_have_the_bits_of_the_program(petsam, tmp_path):
    """Also where each was tried and rejected before, by another displacement; both bodies wear, and roll."""
    case = dict(CASE, slide=True, wear_coefficient1=1e-14, wear_coefficient2=2e-14)
    rows = [(1, 500.0, 0.0, 0.0), (2, 800.0, 3e-5, 0.0), (3, 700.0, -2e-5, 1.7e-5), (4, 900.0, 1e-5, -2e-5)]
    columns = "time,load_n,disp_x,roll"
    write(tmp_path / "h.csv", columns, rows)
    petsam(dict(case, history="h.csv", steps=1, output="h.h5", output_fields="all"))
    run_python(
        f"""
import numpy as np, petsam
found = {{}}
with petsam.Contact(**{case!r}) as contact:
    for time, n, x, roll in {rows!r}:
        for way in 1.3 * x + 1e-5, x:
            contact.reject()
            step = contact.try_step(time=time, load_n=n, disp_x=way, roll=roll)
        contact.commit()
    for number in "load_tx", "slide_x", "rolled_x", "wear_volume2":
        found["history/" + number] = getattr(step, number)
    for field in "pressure", "shear_x", "wear_depth1", "wear_depth2", "gap":
        found[field] = contact.field(field)
np.savez("found.npz", **found)
""",
        tmp_path,
    )
    found = np.load(tmp_path / "found.npz")
    with h5py.File(tmp_path / "h.h5") as f:
        assert f["history/slide_x"][-1] != 0 and f["history/wear_volume2"][-1] > 0
        for key in found:
            assert np.array_equal(found[key], f[key][-1]), key


def test_advice_on_a_step_reaches_a_contact_in_process(petsam, tmp_path):
    """A slip zone narrow beside the cells: the lines of the program, once for each kind and contact."""
    case = dict(EMBEDDED, grid_n=96, grid_size=2.6e-3, friction=0.1, body2_young=210e9, body2_poisson=0.3)
    write(tmp_path / "h.csv", "time,load_n,load_tx", [(1, 1000.0, 0.0), (2, 1000.0, 5.0)])
    lines = [line.split("warning: ")[1] for line in petsam(dict(case, history="h.csv")).stderr.splitlines()]
    assert len(lines) >= 1 and all("slip zone" in line and "-grid_n" in line for line in lines)
    run_python(
        f"""
import petsam, warnings
case = {case!r}
def said(contact, call):
    with warnings.catch_warnings(record=True) as lines:
        warnings.simplefilter("always")
        call(contact)
    assert all(issubclass(line.category, petsam.AdviceWarning) for line in lines)
    return [str(line.message) for line in lines]
def shear(contact):
    contact.try_step(time=1, load_n=1000)
    contact.commit()
    contact.try_step(time=2, load_n=1000, load_tx=5)
with petsam.Contact(**case) as contact:
    assert said(contact, shear) == {lines!r}
    assert said(contact, lambda contact: contact.try_step(load_n=1000, load_tx=5.5)) == []
    assert said(contact, lambda contact: (contact.reset(), shear(contact))) == []
    with contact.copy() as other:
        assert said(other, shear) == {lines!r}
with petsam.Contact(**case) as contact:
    assert said(contact, lambda contact: contact.run("h.csv")) == {lines!r}
    assert said(contact, lambda contact: (contact.reset(), contact.run("h.csv"))) == []
with petsam.Contact(**dict(case, grid_n=32)) as contact:
    coarse = said(contact, lambda contact: contact.try_step(load_n=10))
    assert any("cells across" in line for line in coarse), coarse
with petsam.Contact(**case) as contact:
    assert said(contact, lambda contact: contact.try_step(load_n=1000, load_tx=80)) == []
""",
        tmp_path,
    )


def test_a_message_is_one_line(petsam, tmp_path):
    """With a control character in a value."""
    run_python(
        BEGIN
        + r"""
import pytest
with pytest.raises(petsam.Error) as caught:
    petsam.Contact(**{**case, "gap_type": "sph\nere"})
assert "-gap_type sph\\nere: expected curved" in str(caught.value), str(caught.value)
""",
        tmp_path,
    )


def test_a_contact_replaces_no_file_that_it_reads(petsam, tmp_path):
    """Neither by a viewer of PETSc, nor by another file of its own."""
    (tmp_path / "i.csv").write_text("depth,stress_xx,stress_yy\n0,-1e8,-1e8\n1e-3,0,0\n")
    before = (tmp_path / "i.csv").read_bytes()
    run_python(
        BEGIN
        + """
import pytest
for options, words in (
    (dict(body2_initial_stress="i.csv", normal_view=":i.csv"), "would overwrite the file of -body2_initial_stress"),
    (dict(output="q.h5", checkpoint="q.h5", checkpoint_every=1), "is also the file of -output"),
):
    with pytest.raises(petsam.Error, match=words):
        petsam.Contact(**{**case, **options})
""",
        tmp_path,
    )
    assert (tmp_path / "i.csv").read_bytes() == before and not (tmp_path / "q.h5").exists()


def test_a_contact_says_what_it_is(tmp_path):
    text = run_python(
        f"""
import petsam
contact = petsam.Contact(**{CASE!r})
print(contact)
contact.try_step(time=2.5, load_n=900.0)
print(contact)
contact.close()
print(contact)
""",
        tmp_path,
    )
    new, tried, closed = text.splitlines()
    assert new.startswith("Contact(45 x 40 cells of 6.667e-05 m x 7e-05 m; no step")
    assert "Step(time=2.5, status=0, load_n=900, " in tried and closed.endswith("; closed)")


def test_results_of_a_run_that_goes_on_have_its_steps_so_far(tmp_path):
    """Though older results of the same file, and the user's own h5py, are alive in the process. Results that were
    opened first find their fields when the index of the chunks has grown beyond the end that the file had then."""
    run_python(
        BEGIN
        + """
import h5py
held, own, count = [], [], 0
def look(contact, step):
    global count
    count += 1
    if count % 40 != 3:
        return
    results = petsam.open("h.h5")
    held.append(results)
    own.append(h5py.File("h.h5", "r"))
    assert count - 1 <= len(results.steps) <= count, (count, results)
    assert all(old.field("pressure").max() == old.history["pressure_max"][-1] for old in held[1:])
with petsam.Contact(**dict(case, grid_n=16), steps=30, output="h.h5", output_flush=0) as contact:
    steps = contact.run(history, each=look)
assert len(held) == 3 and len(steps) == 120
assert len(held[0].steps) < 4 and held[0]["pressure"].shape[0] == len(held[0].steps)
assert len(petsam.open("h.h5").steps) == len(steps)
""",
        tmp_path,
    )


def test_threads_share_a_contact(tmp_path):
    """The numbers of a step are its own, though steps, reversals and warnings of other threads come between."""
    run_python(
        BEGIN
        + """
import threading, warnings
warnings.simplefilter("ignore")
wrong = []
def work(contact, shear):
    try:
        for load in np.linspace(500.0, 900.0, 25):
            step = contact.try_step(load_n=load, load_tx=shear)
            if abs(step.load_n - load) > 1e-3 * load or abs(step.load_tx - shear) > 1e-3 * load:
                wrong.append(str(step))
            contact.stiffness(reversal=True), contact.number("contact_area"), contact.reject(), repr(contact)
            if shear == 10.0:
                contact.run(dict(time=[1.0], load_n=[load]))
    except Exception as error:
        wrong.append(repr(error))
with petsam.Contact(**dict(case, grid_n=16)) as contact:
    contact.try_step(load_n=500.0)
    contact.commit()
    threads = [threading.Thread(target=work, args=(contact, shear)) for shear in (0.0, 10.0, 20.0, 30.0)]
    [thread.start() for thread in threads], [thread.join() for thread in threads]
    assert not wrong, wrong[:3]
""",
        tmp_path,
    )


@pytest.mark.parametrize(
    "inside, ask, answer",
    [
        ("_step", "contact.try_step(load_n=500.0)", "found.contact_area"),
        ("_message", 'contact.stress(depths=1e-4, quantities="mises")', 'found["mises"].max()'),
    ],
    ids=["step", "stress"],
)
def test_a_second_thread_waits_for_the_answers_of_the_first(tmp_path, inside, ask, answer):
    """It comes while the first one is between the call and its answers, and can only wait or disturb it."""
    run_python(
        BEGIN
        + f"""
import threading, warnings
from petsam.contact import shared as module  # before the modules that take its lock
warnings.simplefilter("ignore")
class Told:  # the lock, which tells that a thread has to wait for it
    def __init__(self, lock):
        self.lock = lock
    def __enter__(self):
        if not self.lock.acquire(blocking=False):
            waits.set()
            told.set()
            self.lock.acquire()
    def __exit__(self, *_):
        self.lock.release()
told, waits = threading.Event(), threading.Event()
module.lock = Told(module.lock)
def disturb():
    contact.try_step(load_n=900.0)
    contact.stress(depths=1e-4, quantities="mises")
    told.set()
def halfway(*words):
    del contact.{inside}
    second.start()
    assert told.wait(100)
    return contact.{inside}(*words)
with petsam.Contact(**dict(case, grid_n=16)) as contact:
    contact.try_step(load_n=500.0)
    found = {ask}
    expected = {answer}
    second = threading.Thread(target=disturb)
    contact.{inside} = halfway
    found = {ask}
    second.join()
    assert {answer} == expected and waits.is_set(), ({answer}, expected)
""",
        tmp_path,
    )


def test_a_step_has_the_numbers_that_its_conditions_add():
    """Their names come between those that a contact had before its first step."""
    with package.Contact(**{**EMBEDDED, "friction": 0.4}) as contact:
        before = contact.try_step(load_n=1000)
        contact.commit()
        after = contact.try_step(load_n=1000, bulk2_stress_xx=5e7)
        assert not hasattr(before, "bulk2_stress_xx") and after.bulk2_stress_xx == 5e7
        assert set(before.numbers) < set(after.numbers)

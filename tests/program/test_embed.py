"""Contacts in programs in C, Fortran and Python, built against the installed files: the bits of the program petsam."""

import shutil
import struct
import subprocess
import sys

import h5py
import numpy as np
import pytest

from conftest import PROGRAM, environment
from support import ROOT, bodies, finished, words

HERE = ROOT / "tests" / "program"
CASE = dict(
    grid_n=(45, 40),
    grid_size=(3e-3, 2.8e-3),
    **bodies(210e9, 0.3, 70e9, 0.2),
    friction=0.15,
    gap_type="sphere",
    gap_radius1=0.1,
    gap_radius2="inf",
)
STEPS = [
    dict(load_n=900.0 + 30 * k, disp_x=1e-7 * (1.3 * k if k <= 3 else 1.3 * (6 - k) - 1.9), load_ty=5.0, load_my=0.01)
    for k in range(1, 6)
]
LOADS = ("load_n", "load_tx", "load_ty", "load_mx", "load_my", "load_mz")
RIGIDS = ("disp_z", "disp_x", "disp_y", "rot_x", "rot_y", "rot_z")


@pytest.fixture(scope="module")
def expected(tmp_path_factory, launcher):
    """What the program petsam finds for the same steps: rows of loads, displacements; stiffness; stored energy."""
    folder = tmp_path_factory.mktemp("program")
    rows = ["time," + ",".join(STEPS[0])]
    rows += [",".join(map(repr, (float(k), *step.values()))) for k, step in enumerate(STEPS, 1)]
    (folder / "history.csv").write_text("\n".join(rows))
    command = [str(PROGRAM), *words(CASE), "-history", "history.csv", "-stiffness", "-output", "out.h5"]
    finished(command, cwd=folder, env=environment())
    with h5py.File(folder / "out.h5") as file:
        found = {name: data[:] for name, data in file["history"].items()}
        return dict(found, shear_x=file["shear_x"][:])


def bits(results, names):
    return np.column_stack([results[name] for name in names])


def compile_it(prefix, folder, compiler, *sources):
    out = folder / "embedded"
    command = [compiler, "-Wall", "-Wextra", "-Werror", *map(str, sources), "-o", str(out), f"-I{prefix}/include"]
    command += [f"-L{prefix}/lib", "-lpetsam", f"-Wl,-rpath,{prefix}/lib", "-lm"]
    subprocess.run(command, cwd=folder, check=True, timeout=120)
    return out


def launch(launcher, ranks, *command):
    words = [*launcher, "-n", str(ranks), *map(str, command)] if ranks else [*map(str, command)]
    return finished(words, env=environment()).stdout


# ---------------------------------------------------------------- C and Fortran


@pytest.mark.parametrize("ranks", [0, 1, 2, 3])
def test_c_program_has_the_bits_of_petsam(prefix, tmp_path, launcher, expected, ranks):
    """0: without MPI of its own, and without a launcher."""
    program = compile_it(prefix, tmp_path, "mpicc", HERE / "embedded.c")
    text = launch(launcher, ranks, program, " ".join(words(CASE)), *(["world"] if ranks else []))
    found = np.array([[float.fromhex(word) for word in line.split()] for line in text.splitlines()])
    assert found.shape == (5, 49)
    assert np.array_equal(found[:, 0:12:2], bits(expected, LOADS))
    assert np.array_equal(found[:, 1:12:2], bits(expected, RIGIDS))
    assert np.array_equal(found[:, 12:48].reshape(5, 6, 6), expected["stiffness"])
    assert np.array_equal(found[:, 48], expected["stored_energy"])


@pytest.mark.parametrize("ranks", [1, 2])
def test_fortran_program_has_the_bits_of_petsam(prefix, tmp_path, launcher, expected, ranks):
    module = prefix / "share/petsam/examples/embed/fortran/petsam.f90"
    program = compile_it(prefix, tmp_path, "mpif90", module, HERE / "embedded.f90")
    *lines, message = launch(launcher, ranks, program, " ".join(words(CASE))).splitlines()
    found = np.array([[struct.unpack(">d", bytes.fromhex(word))[0] for word in line.split()] for line in lines])
    assert np.array_equal(found, np.hstack([bits(expected, LOADS), bits(expected, RIGIDS)]))
    assert "gross slip" in message


def test_examples_run(prefix, tmp_path, launcher):
    examples = prefix / "share/petsam/examples/embed"
    text = launch(launcher, 0, compile_it(prefix, tmp_path, "gcc", examples / "c/contact.c"))
    assert [line.split()[1] for line in text.splitlines()] == ["20.00", "40.00", "60.00", "0.00", "-60.00"]
    fortran = examples / "fortran"
    text = launch(launcher, 2, compile_it(prefix, tmp_path, "mpif90", fortran / "petsam.f90", fortran / "contact.f90"))
    stiffness = [float(line.split()[-2]) for line in text.splitlines()]
    assert len(stiffness) == 5 and stiffness[0] > stiffness[1] > stiffness[2] > 1.2e8


ENDED = """
#include <mpi.h>
#include <petsam/embed.h>
int main(int argc, char **argv)
{
  const double load = 1000;
  petsam_contact *c;

  MPI_Init(&argc, &argv);
  if (petsam_create(-1, argv[1], &c) || petsam_try(c, 0, "load_n", &load, 0, 0)) return 9;
  MPI_Finalize();
  if (petsam_try(c, 0, "load_n", &load, 0, 0) != 2) return 8;
  petsam_destroy(&c);
  return c ? 7 : 0;
}
"""


def test_host_may_end_mpi_before_the_contact(prefix, tmp_path, launcher):
    (tmp_path / "ended.c").write_text(ENDED)
    launch(launcher, 0, compile_it(prefix, tmp_path, "mpicc", tmp_path / "ended.c"), " ".join(words(CASE)))


# ---------------------------------------------------------------- Python


def test_surface_from_a_file_is_enough_for_a_contact(tmp_path):
    """The file tells the grid, in process as in the program."""
    run_python(
        f"""
import h5py, petsam, numpy as np
x, y = (np.arange(45) - 22) * 6e-5, (np.arange(40) - 19.5) * 7e-5
with h5py.File("surface.h5", "w") as file:
    file["height"] = -(x[None, :] ** 2 + y[:, None] ** 2) / 0.2
    file["height"].attrs.update(quantity="height1", size=(2.7e-3, 2.8e-3))
case = {{name: value for name, value in {CASE!r}.items() if name[:4] not in ("gap_", "grid")}}
with petsam.Contact(gap_file="surface.h5", **case) as contact:
    step = contact.try_step(load_n=500)
    same = petsam.Contact(gap_type="file", gap_file="surface.h5", grid_n=(45, 40), grid_size=(2.7e-3, 2.8e-3), **case)
    assert step.disp_z == same.try_step(load_n=500).disp_z > 0 and contact["pressure"].shape == (40, 45)
""",
        tmp_path,
    )


def run_python(text, folder, check=0, **variables):
    """Run a program in Python, in a process of its own, which has the package and the library of the build."""
    env = dict(
        environment(), PYTHONPATH=str(ROOT / "scripts"), PETSAM_LIBRARY=str(PROGRAM.parents[1] / "lib/libpetsam.so")
    )
    env.update(variables)
    (folder / "program.py").write_text(text)
    return finished([sys.executable, "program.py"], check=check, cwd=folder, env=env).stdout


def test_python_has_the_bits_of_petsam(tmp_path, expected):
    run_python(
        f"""
import h5py, petsam, numpy as np
case, steps = {CASE!r}, {STEPS!r}
tables = {{name: [] for name in ("load", "rigid", "stiffness", "reversal", "shear_x", "dissipated_energy")}}
numbers = []
with petsam.Contact(**case) as contact, petsam.Contact(**case) as other:
    for k, step in enumerate(steps, 1):
        one = contact.try_step(time=k, **step)
        other.try_step(load_n=100)
        tables["load"].append(one.load)
        tables["rigid"].append(one.rigid)
        tables["stiffness"].append(contact.stiffness())
        tables["reversal"].append(contact.stiffness(reversal=True))
        tables["shear_x"].append(contact["shear_x"])
        tables["dissipated_energy"].append(one.dissipated_energy)
        numbers.append(one.numbers)
        assert one.stored_energy == contact.number("stored_energy") > 0
        contact.commit()
        assert np.array_equal(contact.stiffness(reversal=True), tables["reversal"][-1])
        assert one.load_n == one.load[0] and one.rot_z == one.rigid[5] and contact.number("time") == k
    assert contact.x.size == 45 and contact.y.size == contact.rows == 40 and contact.first_row == 0
    area = contact.size[0] / contact.n[0] * contact.size[1] / contact.n[1]
    assert abs(contact["pressure"].sum() * area - one.load_n) < 1e-9 * one.load_n
np.savez("tables.npz", **tables)
np.savez("numbers.npz", **{{name: [one[name] for one in numbers] for name in numbers[0]}})
""",
        tmp_path,
    )
    found = np.load(tmp_path / "tables.npz")
    assert np.array_equal(found["load"], bits(expected, LOADS)) and np.array_equal(
        found["rigid"], bits(expected, RIGIDS)
    )
    assert np.array_equal(found["stiffness"], expected["stiffness"])
    assert np.array_equal(found["reversal"], expected["stiffness_reversal"])
    assert np.array_equal(found["shear_x"], expected["shear_x"])
    assert np.array_equal(found["dissipated_energy"], expected["dissipated_energy"])
    numbers = np.load(tmp_path / "numbers.npz")  # a step has all that a row of /history has
    own = {"time", "status", "stiffness", "stiffness_reversal", "shear_x"}
    assert set(expected) - own <= set(numbers) and "wear_volume1" not in numbers
    for name in set(expected) - own:
        assert np.array_equal(numbers[name], expected[name], equal_nan=True), name


def test_mistakes_in_python_are_exceptions_and_the_process_lives(tmp_path):
    text = run_python(
        f"""
import os, petsam, warnings, numpy as np
case = {CASE!r}
def told(kind, function, *words, **given):
    try:
        function(*words, **given)
    except kind as error:
        print(type(error).__name__, error)
    else:
        raise SystemExit("no exception")
told(petsam.ContactError, petsam.Contact, **dict(case, friction=-1))
told(petsam.ContactError, petsam.Contact, **dict(case, frction=1))
told(petsam.ContactError, petsam.Contact, **dict(case, gap_type="file", gap_file="no where.h5"))
contact = petsam.Contact(**case)
told(petsam.ContactError, contact.commit)
told(petsam.ContactError, contact.field, "pressure")
told(TypeError, contact.try_step, load_m=1)
told(TypeError, contact.try_step, load_n=1, disp_z=1)
told(TypeError, contact.try_step, load_tx=1)
told(TypeError, contact.try_step, load_n="abc")
told(petsam.NoEquilibrium, contact.try_step, load_n=1000, load_tx=500)
told(ValueError, contact.set_field, "gap", np.zeros((3, 4)))
told(petsam.ContactError, contact.set_field, "gap", np.full((40, 45), np.nan))
told(petsam.ContactError, contact.load, "nowhere.h5")
contact.try_step(load_n=100)
told(petsam.ContactError, contact.field, "presure")
told(petsam.ContactError, contact.number, "area")
told(petsam.ContactError, contact.number, "qqq")
told(petsam.ContactError, contact.field, "contact_edge")
told(TypeError, contact.number, 3)
told(ValueError, contact.number, "contact_area\\0x")
told(ValueError, contact.field, "pressure\\0")
told(petsam.ContactError, contact.fatigue, None)
for kind, function, words in (
    ("time", contact.try_step, ("x",)),
    ("cycles", contact.live, ("x", dict(time=[1]))),
    ("history", contact.run, (3,)),
    ("each", contact.run, (dict(time=[1], load_n=[1]), 3)),
    ("out", contact.field, ("pressure", 3)),
    ("gap", contact.set_field, ("gap", 1j)),
    ("expected a text", contact.set_field, (5, 0.0)),
    ("comm", lambda: petsam.Contact(comm=3, **case), ()),
    ("friction", lambda: petsam.Contact(**dict(case, friction=1j)), ()),
):
    try:
        function(*words, **(dict(load_n=1) if kind == "time" else dict()))
    except TypeError as error:
        assert kind in str(error), (kind, error)
    else:
        raise SystemExit(kind)
told(TypeError, petsam.open, 3)
for name in contact._names("field"):
    contact.field(name)
with warnings.catch_warnings(record=True) as caught:
    warnings.simplefilter("always")
    assert contact.try_step(load_n=1e5).status == 12 and "edge" in str(caught[0].message)
    assert "it needs -grid_size 0.0" in str(caught[0].message) and len(caught) == 1
contact.friction, contact.gap = 0.2, 0.0
assert contact.try_step(load_n=1, disp_x=0).status == 12
contact.close()
told(petsam.ContactError, contact.commit)
assert not any("OMPI_MCA_btl" in line for line in open("/proc/self/environ").read().split("\\0"))
print("alive")
""",
        tmp_path,
    )
    lines = text.splitlines()
    for word, line in zip(
        ["-friction -1", "-frction 1: unknown", "no where.h5", "no tried step", "no step has been solved", "load_m"],
        lines,
    ):
        assert word in line
    assert lines[-1] == "alive" and "gross slip" in text
    assert "TypeError try_step: load_n: must be real number, not str" in text
    assert "presure: there is no field of this name: is pressure meant? There are pressure, shear_x, " in text
    assert "area: there is no number of this name: is contact_area or stick_area meant? There are time, " in text
    assert "petsam_fatigue: no step has been recorded" in text
    assert "qqq: there is no number of this name; there are time, " in text


def test_too_much_wear_is_warned_of_by_the_commit(tmp_path):
    text = run_python(
        f"""
import petsam, warnings
for rate in (1e-13, 1e-6):
    contact = petsam.Contact(**dict({CASE!r}, wear_coefficient1=rate))
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        contact.try_step(load_n=1000, load_tx=100)
        before = len(said)
        contact.commit()
    worn = [one for one in said if one.category is not petsam.AdviceWarning]  # the few cells are told of, too
    told = ("wear is" in str(one.message) for one in worn)
    print(before - len(said) + len(worn), [one.category.__name__ for one in worn], *told)
""",
        tmp_path,
    )
    assert text.splitlines() == ["0 []", "0 ['WearWarning'] True"]


def test_state_is_saved_and_loaded(tmp_path):
    run_python(
        f"""
import petsam, numpy as np
case = dict({CASE!r}, wear_energy1=1e-13)
one, other = petsam.Contact(**case), petsam.Contact(**case)
for k in range(3):
    one.try_step(load_n=1000, load_tx=40.0 * k)
    one.commit()
one.save("state.h5")
other.load("state.h5")
assert one.number("wear_volume1") == other.number("wear_volume1") > 0
a, b = one.try_step(load_n=1000, disp_x=0), other.try_step(load_n=1000, disp_x=0)
assert np.array_equal(a.load, b.load) and np.array_equal(one["wear_depth1"], other["wear_depth1"])
""",
        tmp_path,
    )


def test_many_trials_neither_leak_nor_slow_down(tmp_path):
    """The second half of many trials takes no more memory."""
    text = run_python(
        f"""
import petsam, resource
contact = petsam.Contact(**dict({CASE!r}, body2_young=210e9, body2_poisson=0.3, grid_n=24))
size = lambda: int(open("/proc/self/statm").read().split()[1])
contact.try_step(load_n=1000)
contact.commit()
for k in range(1200):
    contact.try_step(load_n=1000, disp_x=1e-7 * (k % 5))
    if k % 4 == 0:
        contact.stiffness()
    contact.reject()
    if k == 400:
        before = size()
print(size() / before)
""",
        tmp_path,
    )
    assert float(text) < 1.01


def test_package_is_installed_by_pip(tmp_path):
    """The package and its commands, from a copy, since setuptools leaves files beside its sources."""
    scripts, target = tmp_path / "scripts", tmp_path / "site"
    shutil.copytree(ROOT / "scripts", scripts, ignore=shutil.ignore_patterns("__pycache__"))
    pip = [sys.executable, "-m", "pip", "install", "-q", "--no-deps", "--disable-pip-version-check"]
    subprocess.run([*pip, "--target", target, scripts], check=True, timeout=300)
    text = run_python(
        "import petsam; c = petsam.Contact(grid_n=8, grid_size=1, body1_young=1e9, body1_poisson=0, body2_young=1e9,"
        " body2_poisson=0, gap_type='flat', allow_edge_contact=True); print(petsam.__file__, c.n)",
        tmp_path,
        PYTHONPATH=str(target),
    )
    assert str(target) in text and "(8, 8)" in text
    assert (target / "bin" / "petsam-plot").exists()


def test_errors_and_steps_pass_between_processes(tmp_path):
    run_python(
        f"""
import concurrent.futures, copy, multiprocessing, pickle, petsam
case = {CASE!r}
def work(load):
    with petsam.Contact(**case) as contact:
        return contact.try_step(load_n=1000, load_tx=load)
if __name__ == "__main__":
    with concurrent.futures.ProcessPoolExecutor(1, mp_context=multiprocessing.get_context("spawn")) as pool:
        assert pool.submit(work, 10).result().load_tx > 9.99
        try:
            pool.submit(work, 1000).result()
        except petsam.NoEquilibrium as error:
            assert "gross slip" in str(error) and error.code == 11 and error.step.load_tx == 1000
            assert error.step.dissipated_energy != error.step.dissipated_energy  # NaN
    with petsam.Contact(**case) as contact:
        for copied in copy.copy, copy.deepcopy, pickle.dumps:
            try:
                copied(contact)
            except TypeError:
                pass
            else:
                raise SystemExit("copied")
""",
        tmp_path,
    )


def test_threads_take_turns(tmp_path):
    """Threads of Python with a contact each, all of which may be the first one."""
    run_python(
        f"""
import petsam, threading, numpy as np
case, found = {CASE!r}, {{}}
def work(name):
    with petsam.Contact(**case) as contact:
        for k in range(1, 6):
            found[name] = contact.try_step(load_n=1000, load_tx=20.0 * k).rigid
            contact.commit()
threads = [threading.Thread(target=work, args=(name,)) for name in "abcd"]
[one.start() for one in threads]
[one.join() for one in threads]
assert all(np.array_equal(found["a"], found[name]) for name in "bcd")
""",
        tmp_path,
    )

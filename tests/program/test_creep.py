"""The table of creep forces: its header in C, C++ and Fortran, its module in Python, how it is made, against Kalker's
coefficients, full sliding in closed form, and petsam's own solutions."""

import pickle
import shutil
import subprocess
import sys

import numpy as np
import pytest

import petsam
from petsam.apps.wheel import creep
from support import ROOT

sys.path.insert(0, str(ROOT / "scripts" / "maintain"))
import creepcases  # noqa: E402
import creepfile  # noqa: E402
import creeptable  # noqa: E402

HERE = ROOT / "tests" / "program"
PLAN = creeptable.Plan((5, 7, 7, 5), (0.25, 4.0), 32, 0.25)
# J. J. Kalker, Three-Dimensional Elastic Bodies in Rolling Contact (1990), table E3, a/b = 1: nu = 0, 0.25, 0.5
KALKER = {0.0: (3.40, 3.40, 1.33, 1.21), 0.25: (4.12, 3.67, 1.47, 1.19), 0.5: (5.20, 3.98, 1.63, 1.16)}
G, LOAD, MU = 82e9, 1e5, 0.3  # Pa, N
ROUND = 5e-4  # half width of the rounded corner where |F| is cut to mu N
WARNINGS = ("-Wall", "-Wextra", "-pedantic", "-Wshadow", "-Wconversion", "-Werror", "-O2")


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("creep")


@pytest.fixture(scope="module")
def contents(folder):
    return creeptable.make(PLAN, str(folder / "parts"), say=None, checked=(3, 64))


@pytest.fixture(scope="module")
def file(folder, contents):
    contents.write(folder / "table")
    return folder / "table"


@pytest.fixture(scope="module")
def table(file):
    return petsam.wheel.CreepTable.open(file)


@pytest.fixture(scope="module")
def program(folder):
    return compiled(folder, "cc", "-std=c99")


def compiled(folder, compiler, *options):
    out = folder / f"program_{compiler}"
    source = HERE / "creep_forces.c"
    command = [compiler, *options, *WARNINGS, f"-I{ROOT / 'include'}", str(source), "-o", str(out), "-lm"]
    subprocess.run(command, check=True, timeout=120)
    return out


def contacts(count, seed=3):
    """Random contacts: shear, poisson, load, friction, a, b, xi, eta, phi, (count, 9)."""
    random = np.random.default_rng(seed)
    c, ratio = random.uniform(2e-3, 8e-3, count), np.exp(random.uniform(*np.log(PLAN.range), count))
    unit = MU * LOAD / (G * c**2)
    size = unit * np.exp(random.uniform(-4, 4, count))
    xi, eta, phi = size * random.standard_normal((3, count))
    same = np.ones(count)
    return np.column_stack(
        [
            G * same,
            random.uniform(0.0, 0.5, count),
            LOAD * same,
            MU * same,
            c * ratio**0.5,
            c / ratio**0.5,
            xi,
            eta,
            phi / c,
        ]
    )


def by_python(table, given, derivative=True):
    shear, poisson, load, mu, a, b, xi, eta, phi = given.T
    return table.forces(load, (a, b), (xi, eta, phi), mu, (shear, poisson), derivative=derivative)


def by_c(program, file, given):
    done = subprocess.run([program, file], input=given.tobytes(), capture_output=True, check=True, timeout=60)
    found = np.frombuffer(done.stdout).reshape(-1, 16)
    return found[:, 0], found[:, 1:4], found[:, 4:].reshape(-1, 3, 4)


def case(**changed):
    """One contact of a/b = 1, as by_python() takes it."""
    given = dict(shear=G, poisson=0.25, load=LOAD, mu=MU, a=4e-3, b=4e-3, xi=0.0, eta=0.0, phi=0.0) | changed
    return np.array([[*given.values()]])


def special():
    """Contacts at and beside the places where the axes of the table end."""
    unit = MU * LOAD / (G * 16e-6)
    tiny = (0.0, 1e-12, -1e-12, 1e-5, 1.0)
    rows = [case(xi=x * unit, eta=y * unit, phi=z * unit / 4e-3) for x in tiny for y in tiny for z in tiny]
    return np.vstack([*rows, case(xi=1e6), case(phi=-1e9), case(a=1e-3, xi=unit), case(a=16e-3, b=4e-3, eta=unit)])


# ---- C, C++, Fortran, Python


def test_c_equals_python(table, file, program):
    given = np.vstack([contacts(400), special()])
    status, force, derivative = by_c(program, file, given)
    expected = by_python(table, given)
    assert not status.any() and np.isfinite(derivative).all()
    # c, which moments and spin contain, is 8e-3 m at most
    assert np.abs(force - expected.force).max() < 1e-12 * MU * LOAD
    size = np.abs(expected.derivative).max(axis=0, keepdims=True)
    assert (np.abs(derivative - expected.derivative) / size).max() < 1e-12


def test_cpp_equals_c(folder, file, program):
    if not shutil.which("c++"):
        pytest.skip("no c++")
    given, cpp = contacts(200), compiled(folder, "c++", "-x", "c++")
    for one, other in zip(by_c(cpp, file, given), by_c(program, file, given)):
        np.testing.assert_allclose(one, other, rtol=1e-13, atol=0)


def test_fortran_equals_python(folder, file, table):
    if not shutil.which("gfortran"):
        pytest.skip("no gfortran")
    examples = ROOT / "examples" / "creep"
    include = f"-I{ROOT / 'include'}"
    subprocess.run(["cc", "-std=c99", include, "-c", examples / "external.c"], cwd=folder, check=True, timeout=60)
    sources = [examples / "petsam_creep.f90", HERE / "creep_forces.f90"]
    command = ["gfortran", "-Wall", "-Werror", *sources, "external.o", "-o", "fortran", "-lm"]
    subprocess.run(command, cwd=folder, check=True, timeout=60)
    done = subprocess.run([folder / "fortran", file], capture_output=True, text=True, check=True, timeout=60)
    status, *numbers = done.stdout.split()
    given = (1e-3, -2e-3, 0.3)
    found = table.forces(1e5, (5e-3, 4e-3), given, 0.3, (82e9, 0.28), derivative=True)
    expected = [*found.force, *found.derivative.ravel(), creep.slip(5e-3, 4e-3, *given)]
    assert status == "0" and np.allclose(np.array(numbers, float), expected, rtol=1e-11, atol=0)


def test_arguments(file, program, table):
    nan = float("nan")
    bad = [
        case(xi=nan),
        case(a=0.0),
        case(b=-1.0),
        case(poisson=0.6),
        case(mu=-0.1),
        case(shear=0.0),
        case(load=nan),
        case(a=1e308, xi=1e308),
    ]
    status, force, derivative = by_c(program, file, np.vstack(bad))
    assert (status == 2).all() and not force.any() and not derivative.any()
    for one in bad:
        with pytest.raises(petsam.Error, match="creep forces: "):
            by_python(table, one)
    nothing = np.vstack([case(load=0.0, xi=1e-3), case(load=-5.0, xi=1e-3), case(mu=0.0, xi=1e-3)])
    assert not any(one.any() for one in by_c(program, file, nothing)) and not by_python(table, nothing).force.any()
    wide = np.vstack([case(a=16e-3, b=1e-3, xi=1e-3), case(a=8e-3, b=2e-3, xi=1e-3)])
    status, force, _ = by_c(program, file, wide)
    assert list(status) == [1, 0] and force[0] == pytest.approx(force[1], rel=1e-12)


def test_arrays_have_one_shape(table):
    found = table.forces(np.full((3, 2), LOAD), (4e-3, np.array([4e-3, 6e-3])), (1e-3, 0.0, 0.0), MU, derivative=True)
    assert found.force.shape == (3, 2, 3) and found.derivative.shape == (3, 2, 3, 4)
    single = table.forces(LOAD, (4e-3, 6e-3), (1e-3, 0.0, 0.0), MU)
    assert single.derivative is None and np.allclose(found.force[2, 1], single.force, rtol=1e-14)
    none = table.forces(LOAD, (4e-3, 6e-3), (np.zeros((0, 2)), 0.0, 0.0), lambda speed: MU + speed, derivative=True)
    assert none.force.shape == (0, 2, 3) and none.derivative.shape == (0, 2, 3, 4)


# ---- symmetries and limits


def test_mirrored_creepages(table):
    given = contacts(500)
    force = by_python(table, given, False).force
    for turned, signs in (((-1, 1, 1), (-1, 1, 1)), ((1, -1, -1), (1, -1, -1)), ((-1, -1, -1), (-1, -1, -1))):
        other = given.copy()
        other[:, 6:] *= turned
        assert (by_python(table, other, False).force == signs * force).all()


@pytest.mark.parametrize("poisson", KALKER)
def test_small_creepages_are_kalkers_linear_theory(table, poisson):
    c11, c22, c23, c33 = KALKER[poisson]
    area, c = 16e-6, 4e-3
    slopes = by_python(table, case(poisson=poisson)).derivative[0, :, :3] / (G * area)
    assert slopes[0, 0] == pytest.approx(c11, rel=0.015) and slopes[1, 1] == pytest.approx(c22, rel=0.015)
    if poisson == PLAN.poisson:  # by spin only that of the table
        assert slopes[1, 2] / c == pytest.approx(c23, rel=0.015) and slopes[2, 1] / c == pytest.approx(-c23, rel=0.015)
        assert slopes[2, 2] / c**2 == pytest.approx(c33, rel=0.015)
    assert np.abs(slopes[[0, 0, 1, 2], [1, 2, 0, 0]]).max() < 1e-12
    small = 1e-4 * MU * LOAD / (G * area)
    force = by_python(table, case(poisson=poisson, xi=small)).force[0]
    assert force[0] == pytest.approx(c11 * G * area * small, rel=0.015)


def test_small_creepages_have_the_slopes_of_none(table):
    random = np.random.default_rng(6)
    vectors, ratios = random.standard_normal((100, 3)), np.exp(random.uniform(*np.log(PLAN.range), 100))
    small, none = (table.scaled(ratios, size * vectors)[1] for size in (1e-6, 0.0))
    assert np.abs(small - none).max() < 2e-4 and np.abs(none[:, [0, 0, 1, 2], [1, 2, 0, 0]]).max() < 1e-12


def test_full_sliding(table):
    force = by_python(table, case(xi=3.0, eta=-4.0)).force[0] / (MU * LOAD)
    assert force[:2] == pytest.approx([0.6, -0.8], abs=2e-3) and np.hypot(*force[:2]) <= 1.0
    assert abs(by_python(table, case(xi=3e4, eta=-4e4)).force[0, 2]) < 1e-8 * MU * LOAD
    spin = by_python(table, case(phi=1e6)).force[0] / (MU * LOAD)
    # integral of mu p r over a circle, p of Hertz: 3 pi/16 mu N a
    assert spin[:2] == pytest.approx([0.0, 0.0], abs=1e-4) and spin[2] == pytest.approx(3 * np.pi / 16 * 4e-3, rel=1e-4)


def test_force_never_exceeds_friction(table):
    force = by_python(table, contacts(5000), False).force
    assert np.hypot(force[:, 0], force[:, 1]).max() <= MU * LOAD * (1.0 + 1e-14)


def test_nodes_are_petsams_solutions(table, contents):
    i, j, k, m = 2, 4, 5, 1
    v, (alphas, betas) = PLAN.levels[j], PLAN.directions(i)
    vector = creeptable.direction(alphas[k, m], betas[k, m]) * v / (1 - v)
    ratio = PLAN.ratios[i]
    rolling = creepcases.Rolling(ratio, PLAN.poisson, PLAN.cells)
    expected = rolling.forces(vector / table.factors(np.array([ratio]), np.array([PLAN.poisson]))[0])
    rolling.close()
    # the file's forces are whole numbers of steps, so off by half a step at most
    error = np.abs(table.scaled(np.array([ratio]), vector[None])[0][0] - expected)
    assert (error < 1e-9 + 0.5 * v * contents.steps[i, j]).all() and contents.steps.max() < 2e-4


def test_random_cases_are_petsams_solutions(table):
    errors = creeptable.check(table, 60, PLAN.cells, seed=5, say=None).max(axis=1)
    assert np.median(errors) < 0.006 and errors.max() < 0.07


def test_half_a_step_is_the_greatest_error_of_rounding():
    nodes = np.random.default_rng(2).standard_normal((4, 5, 5, 5, 3)) * 10.0 ** np.arange(-3, 2)[:, None, None, None]
    nodes[1, 2] = 0.0
    whole, steps = creepfile.rounded(nodes)
    error = np.abs(whole * steps.astype(float)[:, :, None, None] - nodes)
    assert (error <= (0.5 + 1e-9) * steps[:, :, None, None]).all() and not whole[1, 2].any()
    most = np.abs(whole.astype(int)).max(axis=(2, 3))
    assert (
        whole.dtype == np.int16
        and ((most >= creepfile.STEPS - 2) | (steps == 0.0)).all()
        and most.max() <= creepfile.STEPS
    )


# ---- axes


def test_nodes_are_equally_spaced_in_turn_and_rise():
    plan = creeptable.Plan((5, 8, 9, 8), (0.05, 20.0))
    for i, ratio in enumerate(plan.ratios):
        alphas, betas = plan.directions(i)
        turns, rises = np.linspace(-np.pi / 2, np.pi / 2, 9), np.linspace(0, np.pi / 2, 8)
        for k, m in np.ndindex(9, 7):
            vector = creeptable.direction(alphas[k, m], betas[k, m])
            found = creeptable.angles(np.array([ratio]), vector[None])[0]
            assert found == pytest.approx([turns[k], rises[m]], abs=1e-12)
    assert creeptable.level(plan.levels) == pytest.approx(np.linspace(0, 1, 8), abs=1e-12)


def test_edge_is_where_the_pole_is(table):
    """The pole of the slip (xi - phi y, eta + phi x) is at x = -eta/phi, y = xi/phi: at -a or b at the edge."""
    ratios = PLAN.ratios
    x, y, z = table.factors(ratios, np.full(len(ratios), PLAN.poisson)).T
    kx, ky = creeptable.edge(ratios)
    assert kx == pytest.approx(x / z / np.sqrt(ratios), rel=0.15) and ky == pytest.approx(
        y / z * np.sqrt(ratios), rel=0.15
    )


# ---- derivatives


def differences(table, given, step):
    columns = []
    for j in (6, 7, 8, 2):
        width = np.zeros_like(given)
        width[:, j] = step * np.abs(given[:, [j]]).max(axis=1)
        up, down = (by_python(table, given + s * width, False).force for s in (1, -1))
        columns.append((up - down) / (2 * width[:, [j]]))
    return np.stack(columns, -1)


def test_derivatives_are_those_of_the_forces(table):
    given = contacts(2000)
    exact = by_python(table, given).derivative
    errors = np.abs(differences(table, given, 1e-5) - exact)
    # forces change by this where a creepage, or the load, changes by itself
    sizes = np.abs(given[:, None, [6, 7, 8, 2]]) / (MU * LOAD * np.array([1, 1, 4e-3])[None, :, None])
    assert np.quantile(errors * sizes, 0.99) < 1e-7 and (errors * sizes).max() < 2e-5


@pytest.mark.parametrize(
    "place",
    ("node of v", "node of turn", "node of rise", "no X", "no Z", "rounded corner begins", "rounded corner ends"),
)
def test_derivative_is_continuous(table, place):
    """Values on both sides of a place differ by what the distance explains: ten times less at a tenth of it."""
    v, alpha, beta = 0.47, 0.3, 0.6
    ratio, (alphas, betas) = PLAN.ratios[[3]], PLAN.directions(3)

    def slopes(x):
        at = dict(v=v, alpha=alpha, beta=beta)
        at |= {"node of v": dict(v=PLAN.levels[3] + x), "node of turn": dict(alpha=alphas[4, 2] + x, beta=betas[4, 2]),
               "node of rise": dict(alpha=alphas[4, 2], beta=betas[4, 2] + x), "no Z": dict(beta=x),
               "no X": dict(alpha=np.pi / 2 + x)}.get(place, {})  # fmt: skip
        if "corner" in place:
            at = dict(v=corner(table, ratio, 1.0 if "ends" in place else 1.0 - ROUND) + x, alpha=0.3, beta=0.05)
        vector = at["v"] / (1 - at["v"]) * creeptable.direction(at["alpha"], at["beta"])
        return table.scaled(ratio, vector[None])[1][0]

    near, far = (np.abs(slopes(x) - slopes(-x)).max() for x in (1e-7, 1e-6))
    assert near < 1e-9 or near < 0.2 * far


def corner(table, ratio, level):
    """v at which |F| in a direction reaches a level of mu N."""
    low, high = 0.3, 0.9
    for _ in range(60):
        v = 0.5 * (low + high)
        force = table.scaled(ratio, v / (1 - v) * creeptable.direction(0.3, 0.05)[None])[0][0]
        low, high = (v, high) if np.hypot(*force[:2]) < level - ROUND / 4 else (low, v)
    return low


def test_forces_are_continuous_around_spin_alone(table):
    found = [
        table.scaled(np.array([1.0]), np.array([[x, y, 2.0]]))[0][0]
        for x, y in ((0, 0), (1e-6, 0), (0, 1e-6), (-1e-6, 0), (0, -1e-6), (1.999e-3, 0), (2.001e-3, 0))
    ]
    assert np.abs(np.array(found[1:5]) - found[0]).max() < 3e-6 and np.abs(found[6] - found[5]).max() < 5e-6


# ---- falling friction


def test_falling_friction(table):
    law = petsam.wheel.FallingFriction(0.33, 0.14, 1.25)
    assert law(np.array([0.0, 1.25, 1e6])) == pytest.approx([0.33, 0.235, 0.14])
    sliding = dict(load=LOAD, half_axes=(4e-3, 4e-3), creepages=(0.2, 0.0, 0.0), friction=law)
    slow, fast = (table.forces(**sliding, speed=v).force[0] / LOAD for v in (0.0, 6.25))
    assert slow == pytest.approx(0.33, rel=2e-3) and fast == pytest.approx(0.235, rel=2e-3)
    with pytest.raises(petsam.Error, match="expected two coefficients of friction"):
        petsam.wheel.FallingFriction(0.1, 0.2, 1.0)


def test_slip_is_the_root_of_the_mean_square():
    a, b, xi, eta, phi = 5e-3, 3e-3, 1e-3, -2e-3, 0.4
    r, t = np.meshgrid((np.arange(400) + 0.5) / 400, 2 * np.pi * np.arange(64) / 64)
    weight = r * np.sqrt(1 - r**2)
    square = (xi - phi * b * r * np.sin(t)) ** 2 + (eta + phi * a * r * np.cos(t)) ** 2
    assert creep.slip(a, b, xi, eta, phi) == pytest.approx(np.sqrt(np.sum(weight * square) / weight.sum()), rel=1e-4)


# ---- files


def test_a_file_is_read_and_copied(table):
    assert table.cells == PLAN.cells and table.poisson == PLAN.poisson and table.range == pytest.approx(PLAN.range)
    median, most, worst, count = table.error
    assert 0.0 < median <= most <= worst < 0.02 and count == 3.0
    copied = pickle.loads(pickle.dumps(table))
    assert (by_python(copied, contacts(20)).force == by_python(table, contacts(20)).force).all()


def changed(data, at, value):
    return data[:at] + value + data[at + len(value) :]


@pytest.mark.parametrize(
    "spoil, words",
    (
        (lambda data: b"no table", "no table of creep forces"),
        (lambda data: b"", "no table of creep forces"),
        (lambda data: data[:20], "cut off"),
        (lambda data: data[:-4], "cut off"),
        (lambda data: data + b"more", "cut off"),
        (lambda data: changed(data, 8, b"\x09"), "version"),
        (lambda data: changed(data, 12, b"\x01\x02\x03\x04"), "version"),
        (lambda data: changed(data, 16, b"\xff\xff\xff\xff" * 4), "cut off"),
        (lambda data: changed(data, 16, b"\0\0\0\0"), "cut off"),
        (lambda data: changed(data, len(data) // 2, bytes([data[len(data) // 2] ^ 1])), "checksum"),
        (lambda data: changed(data, 50, bytes([data[50] ^ 8])), "checksum"),
    ),
)
def test_damaged_files_are_rejected(tmp_path, file, program, spoil, words):
    bad = tmp_path / "bad"
    bad.write_bytes(spoil(file.read_bytes()))
    done = subprocess.run([program, bad], capture_output=True, text=True, timeout=60)
    assert done.returncode == 1 and words in done.stderr and str(bad) in done.stderr and "make" in done.stderr
    for path in (bad, shutil.copy(bad, tmp_path / ("long " * 40))):
        with pytest.raises(petsam.Error, match=f"^{path}: (?!.*long).*{words}"):
            petsam.wheel.CreepTable.open(path)


def test_missing_file(tmp_path, program):
    done = subprocess.run([program, tmp_path / "none"], capture_output=True, text=True, timeout=60)
    assert done.returncode == 1 and "none: cannot be read" in done.stderr
    with pytest.raises(FileNotFoundError):
        petsam.wheel.CreepTable.open(tmp_path / "none")


def test_an_interrupted_table_is_completed(folder, tmp_path, file):
    parts = tmp_path / "parts"
    shutil.copytree(folder / "parts", parts)
    kept = next((parts / PLAN.key).glob("F2-1.npy"))
    kept.unlink()
    others = {path: path.stat().st_mtime_ns for path in (parts / PLAN.key).iterdir()}
    again = creeptable.make(PLAN, str(parts), jobs=2, say=None, checked=(3, 64))
    again.write(tmp_path / "table")
    assert kept.exists() and all(path.stat().st_mtime_ns == time for path, time in others.items())
    assert (tmp_path / "table").read_bytes() == file.read_bytes()


@pytest.mark.parametrize(
    "plan, words",
    (
        (dict(nodes=(5, 5, 6, 5)), "--nodes"),
        (dict(nodes=(3, 5, 5, 5)), "--nodes"),
        (dict(range=(2.0, 1.0)), "--range"),
        (dict(cells=2), "--cells"),
        (dict(poisson=0.5), "--poisson"),
    ),
)
def test_wrong_plans_are_rejected(plan, words):
    with pytest.raises(petsam.Error, match=words):
        creeptable.Plan(**plan)

"""Random histories of bodies that yield, each step checked from its results alone.

Cylinders and balls on grids that are periodic or not, contacts of one cell on; one or both bodies yield, with all kinds
of hardening; loads, friction, bulk stress, wear and initial stress in steps long and short. The stress by all there is
comes from petsam-stress, that of periodic rows by waves of their tractions, and the rest from numpy: no step may have
stress beyond yield, strain that grows below it, aside from the stress, or with a change of volume, tension, more shear
than friction bears, or forces that are not the loads. Exit code 10 because no stress bears the shear (its message says
so) is no fault. Of worn bodies, whose strain comes up, the changes of a step are not checked.
"""

import h5py
import numpy as np

import conftest
import support
from kinds import Outcome, codes_of, contacts, users

PARTS = ("xx", "yy", "zz", "xy", "xz", "yz")
TWICE = np.array([1, 1, 1, 2, 2, 2])
GROWN = 1e-6  # plastic strain of a step, relative to the yield strain, from which on it counts
BEYOND = 3e-5  # stress beyond yield, relative to it
ASIDE = 1e-3  # root of what the cosine of the angle between strain and stress lacks from 1
VOLUME = 1e-8  # change of it, relative to the plastic strain
FORCES = 1e-6  # relative to the normal load
OPTIONS = dict(trials=200)


def random_problem(rng, folder):
    """Options, and the options of each yielding body by its number."""
    elasticity = rng.choice(["plane_periodic", "plane", "halfspace"])
    plane = elasticity != "halfspace"
    case = contacts.bodies(rng, alike=rng.random() < 0.6)
    half, normal, peak = contacts.hertz(rng, case, plane, -2.6, -1.9)
    across = 10 ** rng.uniform(0, 1.7 if plane else 1.0)
    cells = int(rng.integers(48, 161)) if plane else int(rng.integers(14, 25))
    side = 2 * half / min(across, 0.6 * cells)
    case.update(grid_n=cells if plane else (cells, cells + int(rng.integers(0, 3))), elasticity=elasticity)
    size = side * np.array([case["grid_n"]]).ravel()
    case.update(grid_size=tuple(map(float, size)) if not plane else float(size[0]))
    limit = peak / rng.uniform(1.4, 4 if plane else 6)
    yields = {}
    for body in (2,) if rng.random() < 0.6 else (1, 2):
        options = contacts.hardening(rng, case[f"body{body}_young"], limit)
        yields[body] = {
            "yield": limit * rng.uniform(1, 1.5),
            **{k.removeprefix("body2_"): v for k, v in options.items()},
        }
        case.update({f"body{body}_{name}": value for name, value in yields[body].items()})
    case.update(friction=float(rng.choice([0.0, rng.uniform(0.05, 0.6)])), steps=int(rng.choice([1, 2, 5])))
    if case["friction"] and rng.random() < 0.25:
        approach = half**2 / (2 * case.get("gap_radius_x", case.get("gap_radius1")))
        case.update(wear_coefficient2=float(10 ** rng.uniform(-3, -1) * approach / peak / (0.01 * half)))
    if rng.random() < 0.2:
        profile = [(0, -0.5, -0.4), (half, 0.1, 0.1), (2 * half, 0, 0)]
        text = "".join(f"{depth:.9g},{xx * limit:.9g},{yy * limit:.9g}\n" for depth, xx, yy in profile)
        (folder / "initial.csv").write_text("depth,stress_xx,stress_yy\n" + text)
        case.update(body2_initial_stress="initial.csv")
    case.update(written(folder, random_loads(rng, case, normal, limit)))
    return case, yields


def random_loads(rng, case, normal, limit):
    """Columns of a history."""
    count, friction, plane = int(rng.integers(2, 6)), case["friction"], case["elasticity"] != "halfspace"
    n = normal * np.append(rng.uniform(0.3, 1, count - 1), 1.0)
    t = 0.9 * friction * n * rng.uniform(-1, 1, count)
    columns = dict(time=np.arange(1.0, count + 1), load_n=n)
    if friction:
        turn = rng.uniform(0, 2 * np.pi) if not plane else 0.0
        columns["load_tx"] = t * np.cos(turn)
        if not plane:
            columns["load_ty"] = t * np.sin(turn)
    if rng.random() < 0.4 and case["elasticity"] != "plane_periodic":  # which bears none
        columns["bulk2_stress_xx"] = 0.4 * limit * rng.uniform(-1, 1, count)
    return columns


def written(folder, columns):
    rows = [tuple(map(float, row)) for row in zip(*columns.values())]
    return support.history(folder / "loads.csv", ",".join(columns), *rows)


def limit_of(material, strain):
    """The yield stress after an accumulated plastic strain."""
    kind, numbers = material.get("hardening", "linear:0").split(":")
    constants = [float(number) for number in numbers.split(",")]
    if kind == "voce":
        return material["yield"] + constants[0] * (1 - np.exp(-constants[1] * strain))
    if kind == "swift":
        return material["yield"] * (1 + strain / constants[0]) ** constants[1]
    return material["yield"] + constants[0] * strain


def norm(tensor):
    return np.sqrt(np.tensordot(TWICE, tensor**2, 1))


def deviator(tensor):
    out = tensor.copy()
    out[:3] -= tensor[:3].mean(axis=0)
    return out


def stress_of(folder, body, depths):
    """Stress by all there is, (6, steps, layers, y, x), in layers of these depths; z points into body 2."""
    words = dict(input="out.h5", output=f"s{body}.h5", body=body, depths=",".join(map(repr, depths.tolist())))
    program = conftest.PROGRAM.with_name("petsam-stress")
    done = conftest.execute([], folder, [dict(words, steps="all", quantities="stress")], 1, None, program=program)
    if done.code:
        raise ValueError(f"petsam-stress: {done.stderr[-300:]}")
    with h5py.File(folder / f"s{body}.h5") as f:
        return turned(np.array([f[f"stress_{part}"][()] for part in PARTS]), body)


def turned(stress, body):
    """The stress in axes whose z points into body 2, of one in those whose z points into the body."""
    signs = np.array([1, 1, 1, 1, -1, -1]) if body == 1 else np.ones(6)
    return stress * signs.reshape(-1, *[1] * (stress.ndim - 1))


def stress_of_waves(folder, case, body, depths):
    """The same of a periodic row, whose half-plane bears a wave of p and q as in any textbook, by means over layers."""
    with h5py.File(folder / "out.h5") as f:
        places = layers_of(f, body)[1]
        p, q = (traction_of(f, name)[:, 0] for name in ("pressure", "shear_x"))
        residual = np.array([field_of(f, f"plastic/residual_stress_{part}", places) for part in PARTS])
        bulk = f["history/bulk2_stress_xx"][()] if body == 2 and "bulk2_stress_xx" in f["history"] else np.zeros(len(p))
    poisson, count = case[f"body{body}_poisson"], p.shape[1]
    k = 2 * np.pi * np.fft.rfftfreq(count, case["grid_size"] / count)
    p, q = np.fft.rfft(p), np.fft.rfft(q) * (1 if body == 2 else -1)
    ends, found = edges_of(depths), []
    for above, below in zip(ends, ends[1:]):
        mean = np.zeros((3, *p.shape), dtype=complex)
        for x, weight in zip(*np.polynomial.legendre.leggauss(6)):
            kz = k * (0.5 * (above + below) + 0.5 * x * (below - above))
            part = 0.5 * weight * np.exp(-kz)
            mean[0] += part * (-(1 - kz) * p + 1j * (2 - kz) * q)
            mean[1] += part * (-(1 + kz) * p + 1j * kz * q)
            mean[2] += part * (1j * kz * p - (1 - kz) * q)
        mean[0, :, 0] = poisson / (1 - poisson) * mean[1, :, 0]
        found.append(np.fft.irfft(mean, count))
    xx, zz, xz = np.moveaxis(np.array(found), 0, 2)
    xx = xx + bulk[:, None, None]
    zero = 0 * xx
    whole = turned(np.array([xx, poisson * (xx + zz), zz, zero, xz, zero]), body)
    return whole[:, :, :, None] + residual


def layers_of(file, body):
    """Depths of the middles of a body's layers, rising, and the places of these layers in a dataset."""
    z = file["plastic/z"][()] * (1 if body == 2 else -1)
    places = np.flatnonzero(z > 0)
    places = places[np.argsort(z[places])]
    return z[places], places


def edges_of(depths):
    """Tops and bottoms of layers with these middles."""
    edges = [0.0]
    for depth in depths:
        edges.append(2 * depth - edges[-1])
    return edges


def traction_of(file, name):
    """A traction (steps, y, x); zeros where the run has no friction."""
    return file[name][()] if name in file else np.zeros(file["pressure"].shape)


def field_of(file, name, places):
    """A field in layers, in the order of the places."""
    return file[name][()][:, places]


def faults_of_body(folder, case, body, material):
    """What is wrong in the layers of a body, {name: size}, each size relative to what is allowed."""
    with h5py.File(folder / "out.h5") as f:
        depths, places = layers_of(f, body)
        e = np.array([field_of(f, f"plastic/plastic_strain_{part}", places) for part in PARTS])
        total = field_of(f, "plastic/plastic_strain", places)
    periodic = case["elasticity"] == "plane_periodic"
    stress = stress_of_waves(folder, case, body, depths) if periodic else stress_of(folder, body, depths)
    stress, scale = deviator(stress.reshape(e.shape)), material["yield"] / case[f"body{body}_young"]
    change, before = np.diff(e, axis=1, prepend=0), np.concatenate([np.zeros_like(total[:1]), total[:-1]])
    grown = total - before
    back = np.zeros_like(e)
    for k in range(e.shape[1]):
        last = back[:, k - 1] if k else 0
        back[:, k] = sum_of_backstresses(material, last, change[:, k], grown[k])
    rest = stress - back
    mises = np.sqrt(1.5) * norm(rest)
    limit = limit_of(material, total)
    grows = grown > GROWN * scale
    out = dict(
        beyond=np.max(mises / limit - 1) / BEYOND,
        volume=np.max(np.abs(e[:3].sum(axis=0))) / (VOLUME * max(total.max(), 1e-300)),
    )
    worn = any("wear" in name for name in case)  # material has come up, so that changes are not those of the law
    if worn and "backstress" in material:
        del out["beyond"]
    if np.any(grows) and not worn:
        out["below"] = np.max(1 - (mises / limit)[grows]) / BEYOND
        cosine = np.tensordot(TWICE, change * rest, 1)[grows] / (norm(change) * norm(rest))[grows]
        weight = np.minimum(1, grown[grows] / (1e-3 * scale))  # a small change has its own error
        out["aside"] = np.max(np.sqrt(np.maximum(0, 1 - cosine)) * weight) / ASIDE
        size = np.sqrt(2 / 3) * norm(change)[grows]
        out["size"] = np.max(np.abs(size / grown[grows] - 1) * weight) / ASIDE
    return out


def sum_of_backstresses(material, last, change, grown):
    """Backward Euler of one term of Armstrong and Frederick."""
    if "backstress" not in material:
        return np.zeros_like(change)
    modulus, rate = map(float, material["backstress"].split(","))
    return (last + 2 / 3 * modulus * change) / (1 + rate * grown)


def faults_of_contact(folder, friction, area):
    """What is wrong on the surface."""
    with h5py.File(folder / "out.h5") as f:
        p, x, y = (traction_of(f, name) for name in ("pressure", "shear_x", "shear_y"))
        table = {name: f[f"history/{name}"][()] for name in ("load_n", "load_tx", "load_ty", "yield_error")}
    out = dict(
        tension=np.max(-p) / (1e-12 * p.max()), friction=np.max(np.hypot(x, y) - friction * p) / (1e-9 * p.max())
    )
    for name, field in (("load_n", p), ("load_tx", x), ("load_ty", y)):
        out[name] = np.max(np.abs(field.sum(axis=(1, 2)) * area - table[name])) / (FORCES * np.max(table["load_n"]))
    out["yield_error"] = np.max(table["yield_error"]) / 1e-5
    return out


def solve(case, folder):
    return users.run(conftest.PROGRAM, dict(case, output_fields="usual,plastic", output_every=1), folder, 200)


def trial(seed, folder, given):
    """What is worst of all that is checked, each relative to what is allowed."""
    case, yields = random_problem(np.random.default_rng(seed), folder)
    code, _, line = solve(case, folder)
    text = f"{case['elasticity']}, {case['grid_n']} cells, bodies {', '.join(map(str, yields))}: "
    if code != 0:
        fault = "yield/sqrt(3)" not in line
        return Outcome(f"{text}exit code {code}: {line}\n    {' '.join(support.words(case))}", fault, dict(code=code))
    size = np.array([case["grid_size"]]).ravel() / np.array([case["grid_n"]]).ravel()
    found = faults_of_contact(folder, case["friction"], np.prod(size))
    for body, material in yields.items():
        more = faults_of_body(folder, case, body, material)
        found.update({f"{key}{body}": value for key, value in more.items()})
    with h5py.File(folder / "out.h5") as f:
        text += f"{f['history/plastic_max'][-1]:.2g}, "
        contact = f["history/contact_cells"][()]
    text += f"{contact.min()} to {contact.max()} cells: "
    worst = sorted(found.items(), key=lambda item: -item[1])[:4]
    text += ", ".join(f"{key} {value:.2g}" for key, value in worst)
    return Outcome(text, bool(worst[0][1] > 1), dict(code=code, found=found))


def summary(found):
    return [codes_of(found)]

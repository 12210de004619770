"""Random lives of joints that wear, each with a check that shares nothing with petsam but the results file.

Similar and dissimilar bodies, smooth and rough gaps, every kind of control, moments, both laws. Of the last step, by
direct summation: the gap of the worn bodies is nowhere negative and closed under pressure, the shear lies in its cone,
cells that stick do not slip and the others slip against the shear, loads are balanced. Of the life: what was removed is
what friction did, V = k E/mu summed over the cycles. What does not hold is a fault.
"""

import h5py
import numpy as np

import conftest
from kinds import Outcome, codes_of
from support import closed, hertz, kernels

N = 24
OPTIONS = dict(trials=50, ranks=1)


def random_case(rng, folder):
    """Options of a joint, and its history, written to the folder."""
    dissimilar = rng.random() < 0.5
    case = dict(
        body1_young=210e9,
        body1_poisson=0.3 if rng.random() < 0.5 else 0.0,
        body2_young=70e9 if dissimilar else 210e9,
        friction=round(rng.uniform(0.1, 0.6), 3),
        gap_type="sphere",
        gap_radius1=0.1,
        gap_radius2=float("inf"),
        load_n=100.0,
        grid_n=N,
        slip_direction="end",  # the rule that the direction is checked by
        step_divide="no",
    )
    case["body2_poisson"] = 0.25 if dissimilar else case["body1_poisson"]
    contact = hertz(case)
    case["grid_size"] = 2 * contact.radius * rng.uniform(1.4, 1.8)
    approach = contact.radius**2 / 0.1
    steps = int(rng.integers(8, 17))
    t = np.arange(steps + 1) / steps
    columns = dict(time=t)
    del case["load_n"]
    limit = case["friction"] * 100.0
    if rng.random() < 0.6:
        columns["load_n"] = 100 * (1 + rng.choice([0, 0.2]) * np.sin(2 * np.pi * t + 1))
        if rng.random() < 0.4:
            columns["load_my"] = 100 * contact.radius * rng.uniform(0.02, 0.15) * np.sin(2 * np.pi * t)
    else:
        columns["disp_z"] = approach + 0 * t
    for axis, phase in (("x", 0), ("y", rng.choice([0, np.pi / 2]))):
        part = rng.uniform(0, 0.5)
        if rng.random() < 0.5:
            columns[f"load_t{axis}"] = 0.6 * limit * part * (np.sin(2 * np.pi * t + phase) - np.sin(phase))
        else:
            amplitude = 2 * case["friction"] * approach * part
            columns[f"disp_{axis}"] = amplitude * (np.sin(2 * np.pi * t + phase) - np.sin(phase))
    for column in columns.values():
        if column is not t:
            column[-1] = column[0]
    rows = zip(*(column.tolist() for column in columns.values()))
    text = ",".join(columns) + "\n" + "".join(",".join(map(repr, row)) + "\n" for row in rows)
    (folder / "cycle.csv").write_text(text)
    if rng.random() < 0.5:
        x = np.arange(N) / N
        waves = sum(
            rng.normal() * np.sin(2 * np.pi * (a * x[:, None] + b * x) + rng.uniform(0, 7)) / (1 + a * a + b * b)
            for a in range(4)
            for b in range(4)
        )
        with h5py.File(folder / "rough.h5", "w") as file:
            file["height"] = 0.05 * approach * waves
        case["gap_rough_file"] = "rough.h5"
    law = rng.choice(["coefficient", "energy"])
    rate = 1e-14 if law == "coefficient" else 1e-14 / case["friction"]
    for body, share in zip((1, 2), (part := rng.choice([0, 0.3, 1]), 1 - part)):
        case[f"wear_{law}{body}"] = float(rate * share)
    # so many cycles that about a part of the approach is removed
    case["wear_cycles"] = float(
        np.floor(rng.uniform(0.05, 0.8) * approach / (1e-14 * contact.pressure * 0.2 * approach))
    )
    return dict(case, wear_rtol=3e-3, history="cycle.csv", output="life.h5", output_every=1)


def displacements(case, f, size):
    """Relative elastic displacements (x, y, z) of all cells, by direct summation (see support.displacement)."""
    x, y = f["x"][:], f["y"][:]
    h = size / N
    dx = (x[:, None] - x)[None, :, None, :] + np.zeros((N, 1, N, 1))
    dy = (y[:, None] - y)[:, None, :, None] + np.zeros((1, N, 1, N))
    k = {name: value.reshape(N * N, N * N) for name, value in kernels(dx, dy, h, h).items()}
    p, qx, qy = (f[name][-1].ravel() for name in ("pressure", "shear_x", "shear_y"))
    total = np.zeros((3, N * N))
    for body, sign in ((1, -1), (2, 1)):
        young, nu = case[f"body{body}_young"], case[f"body{body}_poisson"]
        g = closed.shear_modulus(young, nu)
        c, d = 1 / (2 * np.pi * g), sign * (1 - 2 * nu) / (4 * np.pi * g)
        total += (
            c * (((1 - nu) * k["r"] + nu * k["xx"]) @ qx + nu * k["xy"] @ qy) - d * k["x"] @ p,
            c * (((1 - nu) * k["r"] + nu * k["yy"]) @ qy + nu * k["xy"] @ qx) - d * k["y"] @ p,
            c * (1 - nu) * k["r"] @ p + d * (k["x"] @ qx + k["y"] @ qy),
        )
    return total.reshape(3, N, N)


def errors_of(case, folder):
    """The relative errors of a life, by name."""
    with h5py.File(folder / "life.h5") as f:
        p, qx, qy = (f[name][-1] for name in ("pressure", "shear_x", "shear_y"))
        history = {name: column[-1] for name, column in f["history"].items()}
        u = displacements(case, f, case["grid_size"])
        x, y = np.meshgrid(f["x"][:], f["y"][:])
        h = (x**2 + y**2) / 0.2 + f["wear_depth1"][-1] + f["wear_depth2"][-1]
        if "gap_rough_file" in case:
            with h5py.File(folder / "rough.h5") as rough:
                h = h + rough["height"][:]
        gap = u[2] + h - (history["disp_z"] - y * history["rot_x"] + x * history["rot_y"])
        # the slip of the last step: that at its end by direct summation, that before from the file
        slip = [
            u[0] - (history["disp_x"] - y * history["rot_z"]) - f["slip_x"][-2],
            u[1] - (history["disp_y"] + x * history["rot_z"]) - f["slip_y"][-2],
        ]
        life = {name: column[:] for name, column in f["wear"].items()}
        parts = dict(load_n=p, load_tx=qx, load_ty=qy, load_my=x * p, load_mx=-y * p, load_mz=x * qy - y * qx)
        loads = {name: np.sum(part) * (case["grid_size"] / N) ** 2 for name, part in parts.items()}
    length, q, bound = np.hypot(*slip), np.hypot(qx, qy), case["friction"] * p
    scale, slips = np.abs(u[:2]).max(), (p > 0) & (q >= (1 - 1e-5) * case["friction"] * p)
    rate = sum(case.get(f"wear_coefficient{b}", 0) / case["friction"] + case.get(f"wear_energy{b}", 0) for b in (1, 2))
    energy, cycles = rate * life["dissipated_energy"], life["cycle"]
    worn = np.sum(np.diff(cycles) * (energy[1:] + energy[:-1]) / 2)
    force = abs(history["load_n"])
    arm = {name: case["grid_size"] / 2 if name in ("load_mx", "load_my", "load_mz") else 1 for name in loads}
    return dict(
        contact=max(np.abs(gap[p > 0]).max(), -min(gap.min(), 0)) / np.abs(u[2]).max(),
        pressure=-min(p.min(), 0) / p.max(),
        cone=(q - bound).max() / bound.max(),
        stick=length[(p > 0) & ~slips].max(initial=0) / scale,
        direction=(length * q + slip[0] * qx + slip[1] * qy)[slips].max(initial=0) / (scale * bound.max()),
        balance=max(abs(loads[name] - history[name]) / (force * arm[name]) for name in loads),
        wear=abs(worn - life["volume1"][-1] - life["volume2"][-1]) / worn if worn > 0 else 0,
    )  # fmt: skip


LIMITS = dict(contact=1e-6, pressure=0, cone=1e-9, stick=1e-4, direction=1e-5, balance=1e-6, wear=0.02)


def trial(seed, folder, given):
    """The exit code, and the errors of a life that is solved."""
    case = random_case(np.random.default_rng(seed), folder)
    done = conftest.execute(conftest.launcher_words(), folder, [case], given.ranks, None)
    errors = errors_of(case, folder) if done.code == 0 else {}
    bad = [f"{key} {error:.1e}" for key, error in errors.items() if not error <= LIMITS[key]]
    if done.code not in (0, 11, 12):
        bad = [f"exit code {done.code}: {done.stderr.strip()}"]
    return Outcome(f"{', '.join(bad) or 'right'}; {case}", bool(bad), dict(code=done.code, errors=errors))


def summary(found):
    worst = {key: max([0.0, *(one["errors"].get(key, 0.0) for one in found.values())]) for key in LIMITS}
    return ["worst: " + ", ".join(f"{key} {value:.1e}" for key, value in worst.items()), codes_of(found)]

"""Random loads that repeat, on pairs of capabilities: with kept steps of the cycle before and without them the same.

A cycle of random rows, three times, with a larger normal load between two of them; -cycle_memory 0 keeps no steps.
Compares exit codes, the numbers of all steps and the last fields; what differs is a fault. A pair that petsam refuses
is drawn again.
"""

import collections

import numpy as np

import compliances
import conftest
from kinds import Outcome, codes_of
from support import history, read_run

STEEL = dict(body1_young=210e9, body1_poisson=0.3, body2_young=210e9, body2_poisson=0.3)
BALL = dict(STEEL, gap_type="sphere", gap_radius1=0.2, gap_radius2=0.2, grid_n=40, grid_size=3e-3, friction=0.3)
LINE = dict(STEEL, elasticity="plane", plane_datum=0.05, gap_type="ellipsoid", gap_radius_x=0.1, gap_radius_y="inf")
LINE.update(grid_n=96, grid_size=2.4e-3, friction=0.3)
MEAN = {"load_n": 900.0}
PRESSURE = 6e8  # of the ball under 1.2 times that, about
# Relative differences, of columns and of the 2-norms of fields. Shears differ near edges by more than their tolerance;
# that across the load, of cross contraction, also by the direction of slip, which is found to second order in a step.
COLUMNS = dict(default=1e-4, dissipated_energy=2e-3, friction_work=2e-3)
FIELDS = dict(pressure=1e-5, shear_x=2e-3, shear_y=1e-2, plastic_depth=1e-5, wear_depth1=1e-4, wear_depth2=1e-4)
NAMES = ("load_n", "load_tx", "disp_z", "disp_x", "contact_area", "pressure_max", "dissipated_energy", "wear_volume1",
         "wear_volume2", "plastic_depth_max", "plastic_area", "hardness_work", "plastic_max")  # fmt: skip
OPTIONS = dict(trials=30)


def hardness(rng, case, columns, folder):
    case["pressure_limit"] = float(rng.uniform(0.6, 1.05) * PRESSURE)


def wear(rng, case, columns, folder):
    for body in (1, 2):
        case[f"wear_coefficient{body}"] = float(rng.choice([1e-13, 1e-12]))


def bulk(rng, case, columns, folder):
    columns["bulk2_stress_xx"] = (0.0, 5e7)


def slip_path(rng, case, columns, folder):
    case.update(friction_law="slip_path", friction_path_final=0.5, friction_path_length=1e-6)


def pressure_law(rng, case, columns, folder):
    case.update(friction_law="pressure", friction_pressure_exponent=-0.2, friction_pressure_reference=3e8)


def film(rng, case, columns, folder):
    case.update(film_thickness=1e-6, film_shear=float(rng.choice([1e9, 1e10])))


def strain(rng, case, columns, folder):
    case.update(body2_yield=2.5e8, body2_hardening="linear:2GPa", yield_depth=8e-4, yield_layers=4)


def slide(rng, case, columns, folder):
    case.update(slide=True)
    columns["disp_x"] = columns.pop("load_tx", None) and (-1e-4, 1e-4)


def roll(rng, case, columns, folder):
    columns["roll"] = (0.0, 1.5e-4)


def layers(rng, case, columns, folder):
    case.update(body2_layer_young=4e11, body2_layer_poisson=0.25, body2_layer_thickness=1e-4)


def plane(rng, case, columns, folder):
    case.update({**{name: None for name in BALL}, **LINE, **{k: v for k, v in case.items() if k not in BALL}})
    columns["load_n"] = 2.2e5


def periodic(rng, case, columns, folder):
    case["elasticity"] = "plane_periodic" if case.get("elasticity") == "plane" else "periodic"
    case["plane_datum"] = None


def compliance(rng, case, columns, folder):
    layer = compliances.layer(1, 2)
    case["body2_compliance"] = compliances.write(folder / "b.h5", 0.2 * layer, half=3e-3, young=210e9)


def dissimilar(rng, case, columns, folder):
    case["body1_young"] = 70e9


CAPABILITIES = [plane, periodic, hardness, wear, bulk, slip_path, pressure_law, film, strain, slide, roll, layers,
                compliance, dissimilar]  # fmt: skip
FREQUENT = {hardness: 4, strain: 8}  # how much more often than others: their surfaces change without a given motion
DRAWS = 20  # of a pair, until one is not refused


def random_pair(rng):
    """The places of two capabilities in their list, in its order."""
    weights = np.array([FREQUENT.get(capability, 1) for capability in CAPABILITIES])
    return sorted(rng.choice(len(CAPABILITIES), 2, replace=False, p=weights / weights.sum()))


def random_case(seed, folder):
    """Names of a pair of capabilities, and options: a cycle three times, with another row in the second one."""
    rng = np.random.default_rng(seed)
    pair = random_pair(rng)
    case, columns = dict(BALL), {"load_n": MEAN["load_n"], "load_tx": (-1.0, 1.0)}
    for k in pair:
        CAPABILITIES[k](rng, case, columns, folder)
    normal, rows = columns.pop("load_n"), int(rng.integers(3, 7))
    columns = {name: span for name, span in columns.items() if span}
    swing = rng.choice([0.0, 0.6]) * rng.uniform(0.5, 1, rows)
    loads = normal * (1 - swing)
    cycle = [loads]
    for name, (low, high) in columns.items():
        part = rng.uniform(low, high, rows)
        cycle.append(0.2 * loads.min() * part if name == "load_tx" else part)
    table = np.tile(np.array(cycle).T, (3, 1))
    extra = table[rows - 1].copy()
    extra[0] = 1.15 * normal
    table = np.insert(table, rows + rows // 2, extra, axis=0)
    steps = [(float(k + 1), *map(float, row)) for k, row in enumerate(table)]
    case.update(history(folder / "h.csv", ",".join(["time", "load_n", *columns]), *steps))
    return [CAPABILITIES[k].__name__ for k in pair], case


def differences(one, two):
    """What is more different than it may be, by name."""
    wrong = {}
    for name in NAMES:
        a, b = (r.get(f"history/{name}") for r in (one, two))
        if a is None or not np.isfinite(b).any():
            continue
        if len(a) != len(b):
            return {"steps": abs(len(a) - len(b))}
        scale = np.nanmax(np.abs(b))
        error = np.nanmax(np.abs(a - b)) / scale if scale > 0 else 0.0
        if error > COLUMNS.get(name, COLUMNS["default"]):
            wrong[name] = error
    for name, most in FIELDS.items():
        if name not in two:
            continue
        a, b, scale = one[name][-1], two[name][-1], np.linalg.norm(two[name][-1])
        if name.startswith("shear"):
            scale = max(scale, 0.1 * np.linalg.norm(two["pressure"][-1]))
        if scale > 0 and np.linalg.norm(a - b) > most * scale:
            wrong[name] = np.linalg.norm(a - b) / scale
    return wrong


def compare(case, folder, launcher=()):
    """The exit codes with and without kept steps, and what is wrong; the second code is None where the first is 2."""
    codes, runs, told = [], [], []
    for name, more in (("kept", {}), ("none", dict(cycle_memory=0))):
        options = [case, more, dict(output=f"{name}.h5", output_every=1000)]
        done = conftest.execute(list(launcher), folder, options, 1, None)
        codes.append(done.code)
        told.append(done.stderr.strip()[-300:])
        if done.code == 2:
            break
        if done.code in (0, 10, 11, 12):
            runs.append(read_run(folder / f"{name}.h5"))
    if codes == [2]:
        return [2, None], ""
    if codes[0] != codes[1]:
        return codes, f"exit codes {codes}: {told[0]} / {told[1]}"
    if codes[0] not in (0, 10, 11, 12):
        return codes, told[0]
    return codes, ", ".join(f"{name} {error:.1e}" for name, error in differences(*runs).items())


def first_pair(seed, folder, launcher=()):
    """Of the first pair of a seed that is not refused: names, exit codes, what is wrong; and the pairs refused."""
    refused = []
    for draw in range(DRAWS):
        place = folder / str(draw)
        place.mkdir()
        pair, case = random_case([seed, draw], place)
        codes, wrong = compare(case, place, launcher)
        if codes[0] != 2:
            return pair, codes, wrong, refused
        refused.append(tuple(pair))
    return pair, codes, f"{DRAWS} pairs refused", refused


def trial(seed, folder, given):
    """What differs of the first pair that is not refused."""
    pair, codes, wrong, refused = first_pair(seed, folder)
    numbers = dict(pair=pair, code=codes[0], refused=len(refused))
    return Outcome(f"{', '.join(pair)}: exit code {codes[0]} {wrong}", bool(wrong), numbers)


def summary(found):
    drawn = collections.Counter(name for one in found.values() for name in one["pair"])
    return [
        f"{codes_of(found)}, {sum(one['refused'] for one in found.values())} refused",
        ", ".join(f"{name} {count}" for name, count in sorted(drawn.items())),
    ]

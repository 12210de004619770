"""Random contacts as users give them: bodies, gaps and loads of the kinds usual, yield, slide and zone."""

from pathlib import Path
from typing import NamedTuple

import numpy as np

from kinds import pads
from support import closed

YIELD_FINER = 2  # in three dimensions, where layers and cells take their time
SLIDE_FINER = 2  # the same


class Problem(NamedTuple):
    """Options but for the grid and the steps, the history, and roughness as a function of x, y."""

    name: str
    case: dict
    header: str
    rows: list
    cells: tuple
    steps: int
    heights: object = None
    most: int = 4  # times that a grid is finer


# ---------------------------------------------------------------- bodies and loads


def bodies(rng, alike):
    """Options of two bodies."""
    steel = (210e9, 0.3)
    one, other = steel, steel
    if not alike:
        one = rng.choice([70e9, 115e9, 320e9, 600e9]), rng.choice([0.2, 0.34])
    elif rng.random() < 0.3:
        one = other = rng.choice([3e9, 70e9]), rng.choice([0.34, 0.0])
    return dict(
        body1_young=float(one[0]),
        body1_poisson=float(one[1]),
        body2_young=float(other[0]),
        body2_poisson=float(other[1]),
    )


def modulus_of(case):
    names = ("body1_young", "body1_poisson", "body2_young", "body2_poisson")
    return closed.effective_modulus(*(case[name] for name in names))


def hertz(rng, case, plane, low=-3.2, high=-2.0):
    """Adds a ball or cylinder of a radius; half width, load and peak pressure of a contact at random."""
    radius, modulus = 10 ** rng.uniform(-3, -1), modulus_of(case)
    peak = modulus * 10 ** rng.uniform(low, high)
    half = radius * peak / modulus * (2 if plane else np.pi / 2)
    if plane:
        case.update(gap_type="ellipsoid", gap_radius_x=radius, gap_radius_y=float("inf"))
    else:
        case.update(gap_type="sphere", gap_radius1=radius, gap_radius2=float("inf"))
    return half, (np.pi / 2 * half if plane else 2 / 3 * np.pi * half**2) * peak, peak


def ways(rng, normal, friction, axes, moment=0.0, tension=0.0):
    """Header and rows of N, T_x and more: loading, reversals, small ones, walks, with constant and with varying N."""
    shape = rng.choice(["grows", "together", "cycle", "returns", "small", "walk"])
    last = 1 - 2 * 10 ** rng.uniform(-2, 0)
    x = dict(grows=[0, 1], together=[1], cycle=[0, 1, -1, 1], returns=[0, 1, 0], small=[0, 1, last])
    x = x.get(shape, [0, *rng.uniform(-1, 1, 3)])
    n = np.array([1, *rng.uniform(0.6, 1, 3)] if shape == "walk" else [1.0] * 4)[: len(x)]
    part = rng.uniform(0.1, 0.95) * friction
    turn = rng.choice([0, 0, rng.uniform(0.2, 1.5)]) if axes == 2 else 0
    y = np.roll(x, 1) * (np.arange(len(x)) > 0) if turn and rng.random() < 0.5 else np.array(x, float)
    columns = dict(time=np.arange(len(x)) * 1.0, load_n=normal * n, load_tx=part * normal * n * x * np.cos(turn))
    if turn:
        columns["load_ty"] = part * normal * n * y * np.sin(turn)
    if moment:
        columns["load_my"] = moment * n
    if tension:
        columns["bulk2_stress_xx"] = tension * np.array(x, float)
    if shape == "together":
        columns["time"] = columns["time"] + 1
    return ",".join(columns), [tuple(map(float, row)) for row in zip(*columns.values())]


def waves(rng, size, shortest, height):
    """A function of x, y: a roughness of this rms height whose waves are as long or longer; with the grid as period."""
    most = max(1, int(size / shortest))
    count = rng.integers(4, 12)
    k, phase = rng.integers(-most, most + 1, (count, 2)), rng.uniform(0, 2 * np.pi, count)
    weight = rng.normal(size=count) / (1 + np.hypot(*k.T))
    weight *= height / np.sqrt(0.5 * np.sum(weight**2))

    def heights(x, y):
        return sum(w * np.sin(2 * np.pi * (a * x + b * y) / size + p) for w, (a, b), p in zip(weight, k, phase))

    return heights


# ---------------------------------------------------------------- kinds


def usual(rng, seed, folder):
    name = rng.choice(
        ["sphere", "ellipsoid", "pad", "cylinder", "rough", "layered", "dissimilar", "rolling", "moments"]
    )
    if name == "pad":
        case = pads.random_case(seed, folder)
        rows = [tuple(map(float, row)) for row in np.loadtxt(case["history"], delimiter=",", skiprows=1, ndmin=2)]
        header = Path(case["history"]).read_text().split("\n")[0]
        cells, steps = case.pop("grid_n"), case.pop("steps")
        return Problem(name, case, header, rows, (cells,), steps)
    plane = name == "cylinder" or (name in ("rough", "layered", "dissimilar") and rng.random() < 0.5)
    case = bodies(rng, alike=name != "dissimilar")
    half, normal, peak = hertz(rng, case, plane)
    friction = rng.uniform(0.1, 0.9)
    room = rng.uniform(1.15, 1.6) * (1.2 if name in ("rough", "layered", "dissimilar", "moments") else 1)
    size = 2 * half * room
    cells = int(rng.integers(100, 201)) if plane else int(rng.integers(26, 41))
    case.update(friction=friction, grid_size=size, elasticity="plane" if plane else "halfspace")
    tension = friction * peak * 10 ** rng.uniform(-1.5, 0) if rng.random() < 0.2 and name != "rolling" else 0
    moment = normal * half * rng.uniform(0.03, 0.15) if name == "moments" else 0
    header, rows = ways(rng, normal, friction, 1 if plane else 2, moment, tension)
    heights = None
    if name == "ellipsoid":
        case.update(
            gap_type="ellipsoid",
            gap_radius_x=case["gap_radius1"] * rng.uniform(0.4, 1),
            gap_radius_y=case["gap_radius1"],
        )
        for key in ("gap_radius1", "gap_radius2"):
            del case[key]
    elif name == "rough":
        heights = waves(
            rng,
            size,
            size * rng.uniform(8, 20) / cells,
            half**2 / 2 / (case.get("gap_radius_x") or case["gap_radius1"]) * rng.uniform(0.01, 0.2),
        )
    elif name == "layered":
        thick = half * 10 ** rng.uniform(-0.7, 0.5)
        case.update(
            body2_layer_young=210e9 * 10 ** rng.uniform(-0.5, 0.5),
            body2_layer_poisson=0.25,
            body2_layer_thickness=thick,
        )
    elif name == "rolling":
        creep = friction * peak / modulus_of(case) * rng.uniform(0.2, 2, 2)
        case.update(rolling="steady", creep_x=float(creep[0]))
        if rng.random() < 0.5:
            case.update(creep_y=float(creep[1]))
        else:
            case.update(creep_spin=float(creep[1] / half))
        header, rows = "time,load_n", [(1.0, normal)]
    steps = 1 if name == "rolling" else int(rng.choice([1, 2, 4, 8]))
    return Problem(name, case, header, rows, (cells,) if plane else (cells, cells), steps, heights)


def hardening(rng, young, limit):
    """Options of a material."""
    kind = rng.choice(["perfect", "linear", "voce", "swift", "backstress"])
    return dict(
        perfect={},
        linear=dict(body2_hardening=f"linear:{young * rng.uniform(0.005, 0.1)}"),
        voce=dict(body2_hardening=f"voce:{limit * rng.uniform(0.1, 1)},{rng.uniform(10, 300)}"),
        swift=dict(body2_hardening=f"swift:{limit / young},{rng.uniform(0.05, 0.3)}"),
        backstress=dict(body2_backstress=f"{young * rng.uniform(0.02, 0.2)},{rng.uniform(20, 400)}"),
    )[kind]


def yields(rng, seed, folder):
    """A cylinder, mostly, or a ball on a body that yields, often coated; pressed, unloaded, loaded again, fretted."""
    plane = rng.random() < 0.8
    case = bodies(rng, alike=rng.random() < 0.6)
    if rng.random() < 0.15:
        case.update(body1_young="inf", body1_poisson=0.3)
    elastic = dict(case, body1_young=float(case["body1_young"]))
    half, normal, peak = hertz(rng, elastic, plane, -2.6, -1.9)
    case.update({key: value for key, value in elastic.items() if key.startswith("gap")})
    limit = peak / rng.uniform(1.5, 4 if plane else 5)
    case.update(body2_yield=limit, **hardening(rng, case["body2_young"], limit))
    if case["body1_young"] == case["body2_young"] and rng.random() < 0.3:
        case.update(body1_yield=limit * rng.uniform(1, 1.5))
    friction = rng.choice([0.0, rng.uniform(0.05, 0.7)]) if plane or rng.random() < 0.5 else 0.0
    shape = rng.choice(["load", "unload", "reload"]) if not friction else rng.choice(["load", "push", "fret", "both"])
    n = dict(load=[1], unload=[1, 0.1], reload=[1, 0.1, 1.1], push=[1, 1], fret=[1, 1, 1, 1], both=[1, 1, 0.2])[shape]
    t = dict(push=[0, 1], fret=[0, 1, -1, 1], both=[0, 1, 0]).get(shape, [0] * len(n))
    part = rng.uniform(0.2, 0.9) * friction
    rows = [(k + 1.0, float(normal * a), float(part * normal * a * b)) for k, (a, b) in enumerate(zip(n, t))]
    if not any(t):
        rows = [row[:2] for row in rows]
    room = rng.uniform(1.3, 1.7) if not plane else rng.uniform(5, 7)
    cells = int(rng.integers(160, 241)) if plane else int(rng.integers(24, 33))
    case.update(
        friction=float(friction), grid_size=2 * half * room, elasticity="plane_periodic" if plane else "halfspace"
    )
    header = "time,load_n,load_tx" if any(t) else "time,load_n"
    steps = int(rng.choice([1, 2, 4] if plane else [1, 2]))
    if not plane and rng.random() < 0.5:  # coated
        young = float(case["body2_young"] * 10 ** rng.uniform(-0.5, 0.5))
        case.update(
            body2_layer_young=young, body2_layer_poisson=0.25, body2_layer_thickness=half * rng.uniform(0.02, 0.3)
        )
    return Problem(
        f"{'cylinder' if plane else 'ball'} {shape}", case, header, rows, (cells,) if plane else (cells, cells), steps,
        most=4 if plane else YIELD_FINER,
    )  # fmt: skip


def slides(rng, seed, folder):
    """A cylinder, a pad, mostly, or a ball to and fro on a flat; one or both wear, by either law."""
    plane = rng.random() < 0.9
    case = bodies(rng, alike=rng.random() < 0.7)
    half, normal, peak = hertz(rng, case, plane, -3.2, -2.3)
    friction = rng.uniform(0.1, 0.9)
    stroke = half * 10 ** rng.uniform(-1, 0.7 if plane else 0.2)
    path = 4 * stroke
    # so much wear that the scar of body 2 is some approaches deep
    approach = half**2 / (case.get("gap_radius_x") or case["gap_radius1"]) / 2
    share = rng.choice([0, 0.3, 0.5, 1])
    rate = 10 ** rng.uniform(-15, -13)
    worn = rng.uniform(0.05, 3) * approach * (half + stroke) * (1 if plane else 2 * half)
    cycles = max(3, float(np.floor(worn / (rate * normal * path))))
    law, scale = ("coefficient", 1) if rng.random() < 0.6 else ("energy", 1 / friction)
    for body, part in ((1, 1 - share), (2, share)):
        if part > 0:
            case[f"wear_{law}{body}"] = float(rate * scale * part)
    wide = half * (1 + 1.2 * np.sqrt(worn / (approach * half * (1 if plane else 2 * half)))) ** 0.5
    size = 2 * (rng.uniform(1.3, 1.7) * wide + stroke)
    if plane:
        case.update(elasticity="plane", rot_y=0.0)
        cells = (int(rng.integers(100, 201)),)
        case.update(grid_size=size)
    else:
        case.update(disp_y=0.0, rot_x=0.0, rot_y=0.0, rot_z=0.0)
        side = 2 * rng.uniform(1.3, 1.7) * wide
        cells = (48, max(24, 2 * int(24 * side / size)))
        case.update(grid_size=(size, size * cells[1] / cells[0]))
    case.update(friction=friction, load_n=float(normal), slide=True, wear_cycles=cycles)
    places = (1, -1, 1) if rng.random() < 0.7 else (0, 1, -1, 0)
    rows = [(float(k), float(place * stroke)) for k, place in enumerate(places)]
    per = 2 * stroke / half
    steps = int(np.clip(np.ceil(per * rng.choice([1.5, 2.5, 5])), 2, 24))
    return Problem(
        "cylinder" if plane else "ball", case, "time,disp_x", rows, cells, steps, most=4 if plane else SLIDE_FINER
    )


def zones(rng, seed, folder):
    """A cylinder, a pad or a ball in partial slip under constant N; one or both bodies wear, by either law."""
    plane = rng.random() < 0.85
    case = bodies(rng, alike=rng.random() < 0.7)
    half, normal, peak = hertz(rng, case, plane, -3.2, -2.0)
    friction = rng.uniform(0.1, 0.9)
    radius = case.get("gap_radius_x") or case["gap_radius1"]
    room = rng.uniform(1.25, 1.7)
    if plane and rng.random() < 0.25:  # a pad as long as the cylinder's contact, under the same load
        case.update(gap_type="pad", gap_half_flat_x=half * rng.uniform(0.3, 0.9), gap_edge_radius_x=radius)
        for key in ("gap_radius_x", "gap_radius_y"):
            del case[key]
        room *= 1.2
    part = rng.uniform(0.15, 0.9)
    # so much wear that a cell at the edge would lose some hundredths of the approach, or several
    approach, share = half**2 / radius / 2, rng.choice([0, 0.3, 0.5, 1])
    slip = friction * approach * (1 - np.sqrt(1 - part))
    rate = 10 ** rng.uniform(-15, -12.5)
    cycles = max(3, float(np.floor(10 ** rng.uniform(-1.5, 1) * approach / (rate * 0.5 * peak * 4 * slip))))
    law, scale = ("coefficient", 1) if rng.random() < 0.6 else ("energy", 1 / friction)
    for body, of in ((1, 1 - share), (2, share)):
        if of > 0:
            case[f"wear_{law}{body}"] = float(rate * scale * of)
    cells = int(80 * 4 ** rng.uniform(0, 1)) if plane else int(rng.integers(28, 41))
    case.update(friction=friction, grid_size=2 * half * room, elasticity="plane" if plane else "halfspace")
    case.update(wear_cycles=cycles)
    t = friction * part * normal
    rows = [(float(k), float(normal), float(t * x)) for k, x in enumerate((0, 1, -1, 0))]
    steps = int(rng.choice([4, 8, 16]))
    name = f"{case['gap_type'] if plane else 'ball'} life"
    return Problem(name, case, "time,load_n,load_tx", rows, (cells,) if plane else (cells, cells), steps,
                   most=4 if plane else SLIDE_FINER)  # fmt: skip


KINDS = {"usual": usual, "yield": yields, "slide": slides, "zone": zones}


def random_problem(kind, seed, folder):
    return KINDS[kind](np.random.default_rng((sorted(KINDS).index(kind), seed)), seed, folder)

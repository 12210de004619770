"""What the whole-program tests share: options from dicts, results from HDF5, and mechanics written anew in numpy."""

import csv
import os
import re
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

import h5py
import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts"))
import petsam  # noqa: E402
from petsam import closed  # noqa: E402
from petsam.core import tables  # noqa: E402

LOADS = ("load_n", "load_mx", "load_my", "load_tx", "load_ty", "load_mz")
RIGID = ("disp_z", "rot_x", "rot_y", "disp_x", "disp_y", "rot_z")
FIELDS = (
    "pressure",
    "shear_x",
    "shear_y",
    "slip_x",
    "slip_y",
    "gap",
    "displacement_x",
    "displacement_y",
    "displacement_z",
    "state",
)


def limit(seconds):
    """A time limit for this machine as loaded now, from that of an idle one; None stays None."""
    return seconds and seconds * min(max(1.0, os.getloadavg()[0] / (os.cpu_count() or 1)), 20.0)


def finished(command, check=0, timeout=300, **how):
    """A command that has ended with this exit code; what it has printed is text."""
    done = subprocess.run(command, capture_output=True, text=True, timeout=timeout, **how)
    assert done.returncode == check, (command, done.stdout[-3000:], done.stderr[-3000:])
    return done


# ---------------------------------------------------------------- rows that are alike


def spread(length, count=3):
    """Places of `count` of so many rows: the first, the last, and some between."""
    return {round(k * (length - 1) / (count - 1)) for k in range(count)}


def few(names, rows, count=3):
    """Parametrizes a test by rows that exercise the same lines: `make test` runs `count` of them, the rest are slow."""
    rows = [row if "," in names else (row,) for row in rows]
    kept = spread(len(rows), count)
    marked = [pytest.param(*row, marks=() if k in kept else pytest.mark.slow) for k, row in enumerate(rows)]
    return pytest.mark.parametrize(names, marked)


# ---------------------------------------------------------------- options


def words(options):
    """Command-line words of a dict: None leaves out, True is a bare option, a tuple is joined by commas."""

    def text(value):
        return (
            value if isinstance(value, str) else repr(float(value)) if isinstance(value, np.floating) else repr(value)
        )

    line = []
    for name, value in options.items():
        if value is None:
            continue
        line.append("-" + name)
        if value is not True:
            line.append(
                ",".join(map(text, value))
                if isinstance(value, (tuple, list))
                else str(value)
                if isinstance(value, Path)
                else text(value)
            )
    return line


def flatten(options):
    """Words of strings and dicts in any order; an option of a dict gives way to the same one of a later item."""
    line, later = [], set()
    for item in reversed(options):
        if isinstance(item, dict):
            line = words({name: value for name, value in item.items() if name not in later}) + line
            later |= {name for name, value in item.items() if value is not None}
        else:
            line = [str(item), *line]
            later.add(str(item)[1:])
    return line


# ---------------------------------------------------------------- cases


def bodies(young=210e9, poisson=0.3, young2=None, poisson2=None):
    """Options of two bodies, of steel unless told; the second is as the first unless it is given."""
    young2, poisson2 = young if young2 is None else young2, poisson if poisson2 is None else poisson2
    return dict(body1_young=young, body1_poisson=poisson, body2_young=young2, body2_poisson=poisson2)


# Table 1 of the source paper: two steel spheres, at a small number of cells; half width 1.5 a.
SPHERE = dict(
    **bodies(),
    friction=0.1,
    gap_type="sphere",
    gap_radius1=0.2,
    gap_radius2=0.2,
    load_n=1000.0,
    grid_n=64,
    grid_size=2.5987173e-3,
    output_fields="all",
)

# A steel punch with a rounded edge; half width 1.75 times its flat radius.
PUNCH = dict(
    **bodies(),
    friction=0.3,
    gap_type="punch",
    gap_flat_radius=2e-3,
    gap_edge_radius=0.05,
    load_n=4000.0,
    grid_size=7e-3,
    output_fields="all",
)


def hertz(options):
    """Hertz's contact of the sphere on which options are."""
    radius = closed.effective_radius(options["gap_radius1"], options["gap_radius2"])
    e_star = closed.effective_modulus(
        *[options[name] for name in ("body1_young", "body1_poisson", "body2_young", "body2_poisson")]
    )
    return closed.hertz(options["load_n"], radius, e_star)


def history(path, header, *rows):
    """Writes a history of loads; returns the options that take it."""
    path.write_text(header + "\n" + "\n".join(",".join(map(repr, row)) for row in rows) + "\n")
    return dict(history=path)


def ball(n=64, half_width=1.5, young=72e9, poisson=0.34, **more):
    """An aluminium ball on an aluminium flat, on a grid of that half width in contact radii."""
    case = dict(
        **bodies(young, poisson),
        friction=0.27,
        gap_type="sphere",
        gap_radius1=0.06,
        gap_radius2=float("inf"),
        load_n=180.0,
        grid_n=n,
        output_fields="all",
    )
    case["grid_size"] = 2 * half_width * hertz(case).radius
    return dict(case, **more)


def slide_limit(case):
    """Greatest T_x (N) and M_z (N m), each alone, of a sphere."""
    force = case["friction"] * case["load_n"]
    return force, closed.torsion_limit(case["load_n"], case["friction"], hertz(case).radius)


def sliding_pair(case, arm):
    """T_x, M_z of all of Hertz's contact sliding about a centre at y = arm contact radii."""
    h = hertz(case)
    t = (np.arange(2000) + 0.5) / 2000 * 2 - 1
    x, y = np.meshgrid(t, t)
    p = closed.hertz_pressure(np.hypot(x, y), 1.0, 1.0)
    p *= case["friction"] * case["load_n"] / p.sum()
    vx, vy = arm - y, x
    speed = np.hypot(vx, vy)
    return np.sum(p * vx / speed), np.sum(p * (x * vy - y * vx) / speed) * h.radius


def elliptic_hertz(load_n, radius_x, radius_y, e_star):
    """Half axes in x and y (m), greatest pressure (Pa), approach (m), radius_x > radius_y; Johnson eqs 4.25, 4.26."""
    from scipy.optimize import brentq
    from scipy.special import ellipe, ellipk

    def curvatures(ratio):  # (A, B) without the common factor, for b/a = ratio
        m = 1 - ratio**2
        return ellipk(m) - ellipe(m), ellipe(m) / ratio**2 - ellipk(m)

    def mismatch(ratio):
        a, b = curvatures(ratio)
        return b / a - radius_x / radius_y

    ratio = brentq(mismatch, 1e-3, 1 - 1e-9, xtol=1e-15)
    m = 1 - ratio**2
    # A = 1/2Rx = p0/E* b/(m a^2) (K - E), p0 = 3N/(2 pi a b)
    a = np.cbrt(3 * load_n / (2 * np.pi * e_star) * curvatures(ratio)[0] / m * 2 * radius_x)
    b = ratio * a
    p0 = 3 * load_n / (2 * np.pi * a * b)
    return a, b, p0, p0 / e_star * b * ellipk(m)


# ---------------------------------------------------------------- results


class Run(NamedTuple):
    code: int
    stdout: str
    stderr: str

    @property
    def complaint(self):
        """The program's own lines on stderr, without the launcher's."""
        return [line for line in self.stderr.splitlines() if line.startswith("petsam: ")]


def numbers_of(line):
    """{number: relative error} of what follows "error by the CAUSE: " in a warning; 1: unknown."""
    found = re.findall(r"(\w+) (unknown|[-+\d.e]+)", re.split(r" \(|: ", line)[0])
    return {name: 1 if error == "unknown" else float(error) / 100 for name, error in found}


def doubts(done, cause="cells"):
    """The line that tells of errors by a cause, empty without one, and these by the names of numbers; 1: unknown."""
    lines = [line for line in done.complaint if f"error by the {cause}: " in line]
    assert len(lines) < 2, lines
    line = lines[0].split(f"error by the {cause}: ")[1] if lines else ""
    return line, numbers_of(line)


def read_run(path):
    """All values of a run, in all its parts, by name: x, y, time, fields (steps, ny, nx), history/..., wear/...."""
    with petsam.open(path) as run:
        steps = range(len(run.steps))
        values = {"x": run.x, "y": run.y, "time": run.times, "step": np.array(run.steps)}
        values.update({name: np.array([run.field(name, k) for k in steps]) for name in run.fields})
        values.update({f"{name}/{k}": run.edge(name, k) for name in run.edges for k in steps})
        values.update({f"history/{name}": column for name, column in {**run.history, **run.matrices}.items()})
        return {**values, **{f"wear/{name}": column for name, column in run.wear.items()}}


class Results:
    """The last step of a run's results: fields as attributes (ny, nx), scalars of /history as items."""

    def __init__(self, path, run=None):
        self.path, self.run = Path(path), run
        with petsam.open(path) as run:
            self.x, self.y = run.x, run.y
            self.history = {name: data[-1] for name, data in {**run.history, **run.matrices}.items()}
            self.attributes = dict(run.parameters)
            self.saved = len(run.steps)
        self.dx = np.diff(self.x).mean()
        self.dy = np.diff(self.y).mean() if self.y.size > 1 else 1.0  # a plane problem: per metre
        self.xx, self.yy = np.meshgrid(self.x, self.y)
        self.r = np.hypot(self.xx, self.yy)

    def __getitem__(self, name):
        return self.history[name]

    def __getattr__(self, name):
        if name not in FIELDS + (
            "slip_velocity_x",
            "slip_velocity_y",
            "friction_coefficient",
            "power_density",
            "wear_passage",
            "wear_depth1",
            "wear_depth2",
        ):
            raise AttributeError(name)
        with petsam.open(self.path) as run:
            value = run.field(name)
        setattr(self, name, value)
        return value

    @property
    def area(self):
        return self.dx * self.dy

    @property
    def shear(self):
        return np.hypot(self.shear_x, self.shear_y)

    def loads(self):
        """The six loads by summation over the fields."""
        p, qx, qy, x, y = self.pressure, self.shear_x, self.shear_y, self.xx, self.yy
        return dict(
            load_n=np.sum(p) * self.area,
            load_mx=-np.sum(y * p) * self.area,
            load_my=np.sum(x * p) * self.area,
            load_tx=np.sum(qx) * self.area,
            load_ty=np.sum(qy) * self.area,
            load_mz=np.sum(x * qy - y * qx) * self.area,
        )

    def rigid(self):
        """Rigid displacement of every cell: x, y, z."""
        return (
            self["disp_x"] - self.yy * self["rot_z"],
            self["disp_y"] + self.xx * self["rot_z"],
            self["disp_z"] - self.yy * self["rot_x"] + self.xx * self["rot_y"],
        )

    def separation(self):
        """The undeformed bodies', from the gap's definition."""
        return self.gap - self.displacement_z + self.rigid()[2]


def l2(value, reference):
    """Relative error in the 2-norm."""
    return np.linalg.norm(value - reference) / np.linalg.norm(reference)


def assert_close(value, reference, tolerance, name="", scale=None):
    """Largest difference over the reference's largest magnitude (or scale)."""
    scale = np.max(np.abs(reference)) if scale is None else scale
    error = np.max(np.abs(np.asarray(value) - reference))
    assert error <= tolerance * scale, f"{name}: error {error / scale if scale else error:.3e}, allowed {tolerance:g}"


def assert_same(one, two, tolerance, fields=FIELDS[:-1]):
    """Fields of two results agree, each to a tolerance of its kind's largest value; gap and slip are displacements."""
    kinds = [
        ("pressure",),
        ("shear_x", "shear_y"),
        ("gap", "displacement_z"),
        ("slip_x", "slip_y", "displacement_x", "displacement_y"),
    ]
    for name in fields:
        kind = next((k for k in kinds if name in k), (name,))
        scale = max(np.max(np.abs(getattr(two, k))) for k in kind)
        assert_close(getattr(one, name), getattr(two, name), tolerance, name, scale)


# ---------------------------------------------------------------- influence coefficients, not the program's


def corners(function, x, y, dx, dy):
    """Integral over a rectangle about (x, y) from the mixed antiderivative at its corners."""
    return (
        function(x + dx / 2, y + dy / 2)
        - function(x - dx / 2, y + dy / 2)
        - function(x + dx / 2, y - dy / 2)
        + function(x - dx / 2, y - dy / 2)
    )


def kernels(x, y, dx, dy):
    """Integrals of 1/r, x^2/r^3, y^2/r^3, xy/r^3, x/r^2, y/r^2 over the cell about the origin, seen from (x, y).

    Love's logarithms (Phil. Trans. A 228 (1929) 377): the source point moves, so odd kernels keep their sign.
    """

    def r(u, v):
        return np.hypot(u, v)

    def along(u, v):  # v ln(u + r)
        return v * np.log(u + r(u, v))

    def odd(u, v):
        return 0.5 * v * np.log(u * u + v * v) + u * np.arctan(v / u)

    return dict(
        r=corners(lambda u, v: along(u, v) + along(v, u), x, y, dx, dy),
        xx=corners(along, x, y, dx, dy),
        yy=corners(lambda u, v: along(v, u), x, y, dx, dy),
        xy=corners(lambda u, v: -r(u, v), x, y, dx, dy),
        x=corners(odd, x, y, dx, dy),
        y=corners(lambda u, v: odd(v, u), x, y, dx, dy),
    )


def displacement(results, options, i, j):
    """Relative elastic displacement (x, y, z) of cell (i, j) by direct summation; Johnson eqs 3.17 to 3.75.

    Tractions are those on body 2, on body 1 they are opposite: u_t is body 2's less body 1's, u_z the sum of both
    inwards. Pressure draws each body's surface towards itself, so the coupling takes body 2 as printed by Johnson, and
    body 1 reversed.
    """
    k = kernels(results.x[i] - results.xx, results.y[j] - results.yy, results.dx, results.dy)
    p, qx, qy = results.pressure, results.shear_x, results.shear_y
    total = np.zeros(3)
    for body, sign in ((1, -1), (2, 1)):
        young, nu = options[f"body{body}_young"], options.get(f"body{body}_poisson") or 0.0
        g = closed.shear_modulus(young, nu)
        c, d = 1 / (2 * np.pi * g), sign * (1 - 2 * nu) / (4 * np.pi * g)
        ux = c * np.sum(((1 - nu) * k["r"] + nu * k["xx"]) * qx + nu * k["xy"] * qy) - d * np.sum(k["x"] * p)
        uy = c * np.sum(((1 - nu) * k["r"] + nu * k["yy"]) * qy + nu * k["xy"] * qx) - d * np.sum(k["y"] * p)
        uz = c * (1 - nu) * np.sum(k["r"] * p) + d * np.sum(k["x"] * qx + k["y"] * qy)
        total += (ux, uy, uz)
    return total


def anchors(text):
    """The anchors of a file's headings, as GitHub makes them."""
    text = re.sub(r"^```.*?^```$", "", text, flags=re.M | re.S)
    headings = [heading.strip().lower() for heading in re.findall(r"^#+ (.*)$", text, re.M)]
    return {re.sub(r"[^\w -]", "", heading).replace(" ", "-") for heading in headings}


def dead_links(file):
    """Relative links to files or headings that are not there."""
    text = file.read_text()
    dead = []
    for link in re.findall(r"\]\(([^)]+)\)", text):
        if re.match(r"https?:", link):
            continue
        path, _, anchor = link.partition("#")
        target = (file.parent / path).resolve() if path else file
        if not target.exists() or (anchor and anchor not in anchors(target.read_text())):
            dead.append(link)
    return dead


def waves(folder, n, wave, e_star, heights):
    """Two plane periodic bodies with waves of these heights that slide, and the wave; each has half the compliance."""
    cosine = np.cos(2 * np.pi * (np.arange(n) + 0.5) / n)
    for body, height in zip((1, 2), heights):
        with h5py.File(folder / f"{body}.h5", "w") as f:
            f.create_dataset("height", data=height * cosine[None, :])
    bodies = dict(body1_young=2 * e_star, body1_poisson=0.0, body2_young=2 * e_star, body2_poisson=0.0)
    grid = dict(elasticity="plane_periodic", grid_n=n, grid_size=wave, gap_type="flat", slide=True)
    return dict(bodies, **grid, gap_rough_file=folder / "1.h5", body2_surface_file=folder / "2.h5"), cosine


def table_of(path):
    """The rows of a CSV of petsam, {name: text} each, by the names of the heads without their units."""
    with open(path, encoding="utf-8", newline="") as file:
        rows = csv.DictReader(file)
        rows.fieldnames = [tables.Column.headed(head, "", None).name for head in rows.fieldnames]
        return list(rows)

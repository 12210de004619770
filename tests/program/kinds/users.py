"""Random problems as users give them: numbers that are wrong without a word, and warnings of right ones.

Kinds: `yield`, bodies that yield below their surface; `slide`, worn surfaces that slide past each other; `zone`, lives
in partial slip, whose scars end at a stick zone; `usual`, spheres, ellipsoids, pads, cylinders, rough, layered,
dissimilar and rolling bodies, bulk stress and moments. Each is solved on its grid and by its steps, and on finer grids
by finer steps; a single step in which contact is made goes on the path that it has by definition, N first. Wrong: a
printed number, of the last step or of all steps, differs by more than 5 %; silent: and no warning names it; right: all
are within 2 %. For each silent problem the worst number is found again on finer cells alone, and by finer steps alone.

The runs have -errors companion. Untold: a number is wrong, and its error is less than half of the true one; alarmed:
a right problem with a warning. The summary says for how many numbers the error covers the true one, for how many within
a factor of 2, and the median of their ratio where the true one is above 0.5 %.
"""

import re
import subprocess
from pathlib import Path

import h5py
import numpy as np

import conftest
from kinds import Outcome
from kinds.contacts import random_problem
from kinds.pads import RIGHT, WRONG, compare
from support import history, numbers_of, words

OPTIONS = dict(trials=100, finer=4, timeout=100.0)
FINE_LAYERS = 64
SLACK = 1e-6  # of the normal work: energies below it are none
YIELDED = 1e-5  # plastic strain, about a hundredth of the elastic one at yield, and dent over approach: none below
RESIDUAL = 0.2  # of all plastic work: 5 % of it is the stated accuracy of residual_energy, 1 % of that work
NORMAL = ("time", "load_n", "load_mx", "load_my", "disp_z")
LAST = (
    "contact_area",
    "stick_area",
    "pressure_max",
    "shear_max",
    "slip_max",
    "disp_z",
    "plastic_max",
    "residual_energy",
)
STEADY = ("slip_velocity_max", "rolling_energy", "load_tx", "load_ty", "creep_x", "creep_y", "creep_spin")
SUMS = ("dissipated_energy", "plastic_work")
LIFE = ("volume1", "volume2", "depth_max1", "depth_max2", "pressure_max", "contact_area", "dissipated_energy")
# numbers that other warnings than those of errors concern; the rest concern all
NAMED = (
    ("has a tip", ("pressure_max", "shear_max")),
    ("wears in stripes", ("depth_max1", "depth_max2", "pressure_max", "shear_max", "contact_area")),
)
ERRORS = r"error by the (?:cells|steps|layers): "
UNKNOWN = r"errors by the (?:cells|steps) are "
LEAST = 5e-3  # smallest true error whose estimate is measured
MODEL = "half-space theory|linear elasticity|strains are taken as small|periodic images|less than 0.001 of it"


# ---------------------------------------------------------------- runs


def path_of(problem, steps):
    """The rows; for more steps than the one in which contact is made those of its path: N first, then the rest."""
    first, *others = problem.rows
    columns = problem.header.split(",")
    normal = [v if name in NORMAL else 0.0 for name, v in zip(columns, first)]
    if problem.steps > 1 or steps == 1 or normal == list(first) or "load_n" not in columns:
        return problem.rows
    normal[0] -= 0.5
    return [tuple(normal), first, *others]


def options_of(kind, problem, folder, cells, steps):
    """Options with so many times finer cells and steps; writes the files that they name."""
    n = [count * cells for count in problem.cells]
    case = dict(problem.case, grid_n=tuple(n), output_every=1, steps=problem.steps * steps)
    case.pop("history", None)
    if len(n) == 1:
        case["grid_n"] = n[0]
    case.update(history(Path(folder) / "loads.csv", problem.header, *path_of(problem, steps)))
    if problem.heights:
        size = problem.case["grid_size"]
        x = [(np.arange(count) + 0.5) * size / count for count in (n if len(n) == 2 else [n[0], 1])]
        with h5py.File(Path(folder) / "rough.h5", "w") as file:
            file["height"] = problem.heights(*np.meshgrid(x[0], x[1] if len(n) == 2 else [0.0]))
        case["gap_rough_file"] = "rough.h5"
    if kind == "yield":
        case.update(yield_layers=FINE_LAYERS if cells > 1 and len(n) == 1 else None, output_every=10000)
    elif kind in ("slide", "zone"):
        case.update(output_every=10000)
    return case


def run(program, case, folder, timeout):
    """Exit code, warnings, last line of stderr, relative error printed beside an energy that is too small for the table
    or NaN; code None after so many seconds."""
    try:
        done = subprocess.run(
            [str(program), *words(dict(case, output="out.h5"))], cwd=folder, capture_output=True, text=True,
            timeout=timeout, env=conftest.environment(), stdin=subprocess.DEVNULL,
        )  # fmt: skip
    except subprocess.TimeoutExpired:
        return None, [], f"more than {timeout:g} s", np.nan
    lines = done.stderr.splitlines()
    found = [line.partition("warning: ")[2] for line in lines if "warning: " in line]
    printed = re.search(r"dissipated, error by the length of the load steps (?:about|below) (\S+) %", done.stdout)
    warnings = [line for line in found if not re.search(MODEL, line)]
    return done.returncode, warnings, (lines or [""])[-1], float(printed[1]) / 100 if printed else np.nan


def estimates(path):
    """Of the results of a run with -errors companion: {name: relative error}, and {name: values in its companions};
    unknown ones are NaN."""
    with h5py.File(path) as file:
        table = file["errors"]
        names = [name.decode().replace("residual_z_max", "residual_z") for name in table["name"]]
        runs = np.stack([table[name][:] for name in ("value", "half", "quarter", "other")], axis=1)
        return dict(zip(names, table["error"][:].tolist())), dict(zip(names, runs.tolist()))


def read(path):
    """Printed numbers of a run, and the least values that count, by name."""
    with h5py.File(path) as file:
        table = {name: column[:] for name, column in file["history"].items()}
        numbers = {name: table[name][-1] for name in (*LAST, *STEADY) if name in table}
        numbers.update({name: np.nansum(table[name]) for name in SUMS if name in table})
        if "residual_z" in file:
            numbers["residual_z"] = file["residual_z"][-1].max()
        if "wear" in file:
            numbers.update({name: file[f"wear/{name}"][-1] for name in LIFE if name in file["wear"]})
            for name in ("slip_max", "disp_z"):
                numbers.pop(name, None)
    work = np.nanmax(np.abs(table["load_n"] * table["disp_z"]))
    least = dict.fromkeys(("dissipated_energy", "plastic_work", "residual_energy"), SLACK * work)
    least["residual_energy"] += RESIDUAL * numbers.get("plastic_work", 0)
    least.update(stick_area=1e-3 * numbers["contact_area"], shear_max=1e-4 * numbers["pressure_max"])
    least.update(slip_max=1e-5 * np.nanmax(np.abs(table["disp_z"])), plastic_max=YIELDED)
    least["residual_z"] = YIELDED * np.nanmax(np.abs(table["disp_z"]))
    least.update(
        load_tx=1e-3 * table["load_n"][-1],
        load_ty=1e-3 * table["load_n"][-1],
        creep_x=1e-7,
        creep_y=1e-7,
        creep_spin=1e-2,
    )
    return {name: float(value) for name, value in numbers.items() if np.isfinite(value)}, least


def errors_of(found, true, least):
    return {name: compare({name: found[name]}, {name: true[name]}, least)[0] for name in true if name in found}


def named(warnings):
    """Numbers that the warnings name; None: all."""
    numbers = set()
    for line in warnings:
        names = [names for pattern, names in NAMED if re.search(pattern, line)]
        if re.search(ERRORS, line):
            if re.search(r" and \d+ more", line):
                return None
            numbers.update(
                name.replace("residual_z_max", "residual_z") for name in numbers_of(re.sub(ERRORS, "", line))
            )
        elif not names:
            return None
        else:
            numbers.update(*names)
    return numbers


class Trial:
    """A problem with its errors, warnings and, if it is silently wrong, what finer cells and finer steps change."""

    def __init__(self, kind, seed, folder, finer, timeout):
        self.kind, self.folder, self.timeout = kind, folder, timeout
        self.errors, self.warnings, self.failure, self.cause, self.estimates = {}, [], "", {}, {}
        self.runs = {}
        self.problem = random_problem(kind, seed, folder)
        self.finer = min(finer, self.problem.most)
        self.solve(finer)

    def numbers(self, cells, steps, **more):
        case = dict(options_of(self.kind, self.problem, self.folder, cells, steps), **more)
        code, warnings, line, self.printed = run(conftest.PROGRAM, case, self.folder, self.timeout)
        self.case = case
        if code:
            self.failure = f"exit code {code}, {cells} x finer: {line}"
        elif code is None:
            self.failure = f"{line}, {cells} x finer"
        return (None, warnings) if self.failure else (read(self.folder / "out.h5"), warnings)

    def solve(self, finer):
        found, self.warnings = self.numbers(1, 1, errors="companion")
        self.line = " ".join(words(self.case)) if self.failure else ""
        if self.failure:
            return
        self.estimates, self.runs = estimates(self.folder / "out.h5")
        self.estimates.setdefault("dissipated_energy", self.printed)
        steps = dict(zone=2).get(self.kind, self.finer if self.kind == "yield" else finer)
        steps = 1 if self.problem.name == "rolling" else steps
        fine = dict(slide=dict(wear_rtol=0.02), zone=dict(wear_rtol=5e-3)).get(self.kind, {})
        true, _ = self.numbers(self.finer, steps, **fine)
        if self.failure:
            return
        self.errors, self.true, self.found = errors_of(found[0], true[0], true[1]), true[0], found[0]
        if self.silent:
            worst = max(self.silent, key=self.silent.get)
            for part, (cells, many, words_) in dict(
                cells=(self.finer, 1, {}), steps=(1, steps, {}), jumps=(1, 1, fine)
            ).items():
                if part == "steps" and steps == 1 or part == "jumps" and not fine:
                    continue
                other, _ = self.numbers(cells, many, **words_)
                self.failure = ""
                if other and worst in other[0]:
                    self.cause[part] = errors_of(found[0], other[0], true[1])[worst]

    @property
    def wrong(self):
        return {name: error for name, error in self.errors.items() if error > WRONG}

    @property
    def untold(self):
        """Wrong numbers whose error is less than half of the true one, or unknown; 100 % tells of any error."""
        return {name: e for name, e in self.wrong.items() if not self.estimates.get(name, 0.0) >= 0.5 * min(e, 1.0)}

    @property
    def alarmed(self):
        """Warnings of a problem whose numbers are right."""
        return self.warnings if self.errors and max(self.errors.values()) < RIGHT else []

    @property
    def silent(self):
        numbers = named(line for line in self.warnings if not re.search(UNKNOWN, line))
        if numbers is not None and "dissipated_energy" not in self.runs and self.printed > WRONG:
            numbers.add("dissipated_energy")
        return {} if numbers is None else {name: error for name, error in self.wrong.items() if name not in numbers}

    def tell(self):
        p = self.problem
        head = f"{p.name}, {'x'.join(map(str, p.cells))} cells, {p.steps} steps: "
        if self.failure:
            return head + self.failure + (f"\n    {self.line}" if self.line else "")
        texts = sorted(self.errors.items(), key=lambda item: -item[1])[:4]
        text = head + ", ".join(f"{name} {100 * error:.2g} %" for name, error in texts)
        if self.silent:
            text += f" SILENT: {', '.join(self.silent)}; by " + ", ".join(
                f"{part} {100 * error:.2g} %" for part, error in self.cause.items()
            )
        parts = [
            f"{name} {100 * self.errors[name]:.2g} % (told {100 * self.estimates.get(name, np.nan):.2g} %)"
            for name in self.untold
        ]
        text += f" UNTOLD: {', '.join(parts)}" if parts else ""
        text += " ALARMED" if self.alarmed else ""
        return "\n    ".join([text, *self.warnings])


def trial(seed, folder, given):
    """The errors of the printed numbers, and what is told of them."""
    found = Trial(given.kind, seed, folder, given.finer, given.timeout)
    names = ("errors", "warnings", "failure", "cause", "wrong", "silent", "estimates", "runs", "untold", "alarmed")
    numbers = dict(name=found.problem.name, **{name: getattr(found, name) for name in names})
    telling = any((found.silent, found.failure, found.untold, found.alarmed))
    return Outcome(found.tell(), None, numbers, telling)


def summary(found):
    solved = {seed: one for seed, one in found.items() if one["errors"]}
    silent = [seed for seed, one in solved.items() if one["silent"]]
    warned = [seed for seed, one in solved.items() if one["wrong"] and not one["silent"]]
    return [
        f"{len(solved)} of {len(found)} solved: {len(silent)} wrong without a warning {silent}, "
        f"{len(warned)} wrong with one",
        *summary_of_errors(solved),
    ]


def summary_of_errors(solved):
    """Two lines: what the errors of -errors companion tell."""
    pairs = [
        (true, one["estimates"].get(name, np.nan)) for one in solved.values() for name, true in one["errors"].items()
    ]
    pairs = np.array([pair for pair in pairs if pair[0] > LEAST]).reshape(-1, 2)
    ratio = pairs[:, 1] / pairs[:, 0]
    known = ratio[np.isfinite(ratio)]
    numbers = sum(len(one["errors"]) for one in solved.values())
    wrong = sum(len(one["wrong"]) for one in solved.values())
    untold = {seed: list(one["untold"]) for seed, one in solved.items() if one["untold"]}
    alarmed = [seed for seed, one in solved.items() if one["alarmed"]]
    silent = {seed for seed, one in solved.items() if set(one["untold"]) & set(one["silent"])}
    right = sum(max(one["errors"].values()) < RIGHT for one in solved.values())
    share = [100 * np.mean(known >= least) if known.size else np.nan for least in (1.0, 0.5)]
    return [
        f"errors: {numbers} numbers, {wrong} wrong, {sum(map(len, untold.values()))} of these untold {untold}, "
        f"{len(silent)} also without a warning {sorted(silent)}; "
        f"{len(alarmed)} of {right} right problems alarmed {alarmed}",
        f"errors: of {len(ratio)} numbers with errors above 0.5 % {len(ratio) - len(known)} unknown, {share[0]:.0f} % "
        f"covered, {share[1]:.0f} % within a factor of 2, median {np.median(known) if known.size else np.nan:.2g}",
    ]

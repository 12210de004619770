#!/usr/bin/env python3
"""Kills runs with checkpoints at random moments, by the signal that nothing can catch, and goes on from what is left.

After every kill there is a checkpoint that can be read, if one was told of, and the results hold the steps that were
told, with the values of a run without kills. What the last run ends with is what a run without kills ends with, to the
last bit. Ends with 0 when all of that holds. Kinds: friction, and histories and wear cycles of bodies that yield.

    python3 tests/program/kill_at_random.py [--build build] [--kills 50] [--ranks 1] [--seed 1] [--kind friction]
"""

import argparse
import math
import random
import re
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

import capabilities
import conftest
import petsam
from support import SPHERE, read_run

STEPS = 40
CASE = dict(SPHERE, load_n=None, grid_n=32, history="history.csv", output="out.h5")
KEPT = dict(checkpoint="state.h5", checkpoint_every=1)
# {kind: (plane strain, capability, options)}, beside "friction"; the bodies yield from the first step or cycle on
YIELDING = {
    "yield": (False, "yield", dict(steps=10)),
    "plane yield": (True, "yield", dict(steps=10, body2_yield=1e8)),
    "both yield": (False, "both yield", dict(steps=6)),
    "backstress": (True, "backstress", dict(steps=10, body2_yield=1e8)),
    "rolling yield": (False, "roll and yield", dict(steps=6)),
    "life": (False, "cycles of wear and yield", dict(wear_cycles=60)),
    "plane life": (True, "cycles of wear and yield", dict(wear_cycles=100, body2_yield=1e8)),
}
KINDS = ["friction", *YIELDING]


def write_history(folder, steps=STEPS):
    """Normal and tangential force change along a curve, so that every step has its own fields."""
    rows = [f"{k + 1}, {1000 + 20 * math.sin(k / 7)!r}, {60 * math.sin(k / 5)!r}" for k in range(steps)]
    (folder / "history.csv").write_text("time, load_n, load_tx\n" + "\n".join(rows) + "\n")


def write_case(kind, folder):
    """Options of a kind of run, with its history in the folder."""
    if kind == "friction":
        write_history(folder)
        return CASE
    plane, name, more = YIELDING[kind]
    options, columns = capabilities.cases(plane)[name]
    return {**capabilities.write(plane, {**options, **more}, columns, folder), "output": "out.h5"}


def complete_steps(path):
    """Steps that are in all datasets of all parts, all of them readable; each as it must be."""
    with petsam.open(path) as run:
        steps = min(len(run.steps), run._complete)
        area = (run.x[1] - run.x[0]) * (run.y[1] - run.y[0])
        assert np.array_equal(run.times[:steps], np.arange(steps) + 1.0)
        assert np.array_equal(run.history["time"][:steps], np.arange(steps) + 1.0)
        for k in range(steps):
            assert all(np.all(np.isfinite(run.field(name, k))) for name in run.fields)
            assert np.isclose(run.field("pressure", k).sum() * area, run.history["load_n"][k], rtol=1e-9)
        return steps


def differences(one, two):
    """Names of what is not the same to the last bit in two runs."""
    a, b = read_run(one), read_run(two)
    same = {name for name in a if name in b and np.array_equal(a[name], b[name], equal_nan=True)}
    return sorted({*a, *b} - same)


def complete_as_whole(folder):
    """Steps or computed cycles that are complete in a run that was killed, each as in the run without kills."""
    with petsam.open(folder / "out.h5") as run:
        steps = min(len(run.steps), run._complete)
    killed, whole = read_run(folder / "out.h5"), read_run(folder / "whole.h5")
    for name in set(killed) & set(whole) - {"x", "y"}:
        count = min(steps, len(killed[name]))
        assert "/" in name or count == steps, name
        wrong = [k for k in range(count) if not np.array_equal(killed[name][k], whole[name][k], equal_nan=True)]
        assert not wrong, (name, wrong, count, killed[name][wrong[0]], whole[name][wrong[0]])
    return steps


COMPLETE = {"friction": lambda folder: complete_steps(folder / "out.h5")}


def assert_told(told, steps, folder):
    """The step or the cycle of a run's last line, if there is one, is in its file."""
    with petsam.open(folder / "out.h5") as run:
        assert not told or (int(told[-1]) in run.wear["cycle"] if run.wear else steps >= int(told[-1])), (steps, told)


def torture(launcher, folder, kills, ranks, seed, kind="friction"):
    """So many kills over as many runs as it takes; returns how many went on from a checkpoint.

    Where none did, as each kill was earlier than the first checkpoint, up to ten times as many kills.
    """
    chance, restarts, more = random.Random(seed), 0, 9 * kills
    case = write_case(kind, folder)
    complete = COMPLETE.get(kind, complete_as_whole)
    begin = time.monotonic()
    run = conftest.start(
        launcher, folder, [case, dict(output="whole.h5"), KEPT, dict(checkpoint="whole.state.h5")], ranks
    )
    out, err = run.communicate()
    assert run.returncode == 0, (run.returncode, out, err)
    length = time.monotonic() - begin
    while True:
        told_before = complete(folder) if (folder / "state.h5").exists() else 0
        goes_on = (folder / "state.h5").exists()
        restarts += goes_on
        if kills <= 0 and restarts == 0 and more > 0:
            kills, more = 1, more - 1
        run = conftest.start(launcher, folder, [case, KEPT, dict(restart="state.h5") if goes_on else {}], ranks)
        try:
            out, err = run.communicate(timeout=chance.uniform(0, length) if kills > 0 else None)
        except subprocess.TimeoutExpired:
            conftest.kill_all(run, ranks)
            out, err = run.communicate()
        told = re.findall(r"^ *(\d+) +\S+ +\d+", out, re.M)
        if run.returncode == 0:
            wrong = differences(folder / "out.h5", folder / "whole.h5")
            assert not wrong, wrong
            if kills <= 0:
                return restarts
            print("a run got to its end; the next begins anew")
            for name in [*folder.glob("state.h5*"), *folder.glob("out*.h5")]:
                name.unlink()
            continue
        assert not re.search("petsam: (?!warning: )", err), err
        kills -= 1
        if told or told_before:
            steps = complete(folder)
            assert_told(told, steps, folder)
            assert told or goes_on
            kept = "yes" if (folder / "state.h5").exists() else "no"
            print(f"killed after {told[-1] if told else 'no step'}, {steps} complete, checkpoint {kept}")
        else:
            print("killed before its first step")
        assert not goes_on or (folder / "state.h5").exists()


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--build", default="build")
    parser.add_argument("--kills", type=int, default=50)
    parser.add_argument("--ranks", type=int, default=1)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--kind", choices=KINDS, default="friction")
    args = parser.parse_args()
    conftest.PROGRAM = Path(args.build).resolve() / "bin" / "petsam"
    with tempfile.TemporaryDirectory(prefix="petsam") as folder:
        words = conftest.launcher_words()
        restarts = torture(words, Path(folder), args.kills, args.ranks, args.seed, args.kind)
    print(f"{args.kills} kills, {restarts} runs went on from a checkpoint: fields and scalars as without them")


if __name__ == "__main__":
    sys.exit(main())

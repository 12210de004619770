"""Kills runs with checkpoints at random moments, by the signal that nothing can catch, and goes on from what is left.

After every kill there is a checkpoint that can be read, if one was told of, and the results hold the steps that were
told, with the values of a run without kills. What the last run ends with is what a run without kills ends with, to the
last bit. Cases: friction, and histories and wear cycles of bodies that yield. A trial is a campaign of --kills.

With --writes one rank ends before one of its changes of files, or in the middle of one, instead of all at a moment.
"""

import math
import random
import re
import shutil
import subprocess
import time
from pathlib import Path

import numpy as np

import capabilities
import conftest
import petsam
from kinds import Outcome
from support import SPHERE, read_run

STEPS = 40
CASE = dict(SPHERE, load_n=None, grid_n=32, history="history.csv", output="out.h5")
KEPT = dict(checkpoint="state.h5", checkpoint_every=1)
# {case: (plane strain, capability, options)}, beside "friction"; the bodies yield from the first step or cycle on
YIELDING = {
    "yield": (False, "yield", dict(steps=10)),
    "plane yield": (True, "yield", dict(steps=10, body2_yield=1e8)),
    "both yield": (False, "both yield", dict(steps=6)),
    "backstress": (True, "backstress", dict(steps=10, body2_yield=1e8)),
    "rolling yield": (False, "roll and yield", dict(steps=6)),
    "life": (False, "cycles of wear and yield", dict(wear_cycles=60)),
    "plane life": (True, "cycles of wear and yield", dict(wear_cycles=100, body2_yield=1e8)),
}
OPTIONS = dict(trials=1, kills=50, ranks=1, writes=False, case=("friction", *YIELDING))


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


def make_deadly(folder):
    """Builds the library that kills a program at a change of its files; None without a compiler."""
    compiler, library = shutil.which("cc") or shutil.which("gcc"), folder / "die_at_write.so"
    if not compiler:
        return None
    source = Path(__file__).parents[1] / "die_at_write.c"
    subprocess.run([compiler, "-shared", "-fPIC", "-O1", "-o", str(library), str(source), "-ldl"], check=True)
    return library


class AtMoments:
    """All ranks of a run are killed at a moment within the time that a whole run takes."""

    logged = {}

    def __init__(self, folder, ranks, chance):
        self.ranks, self.chance, self.begin = ranks, chance, time.monotonic()

    def learn(self):
        """After a whole run, which began when this object was made."""
        self.length = time.monotonic() - self.begin

    def choose(self):
        """Variables of the environment of a run that is to be killed."""
        self.what = "at a moment"
        return {}

    def end(self, run):
        """The output of a run, which was killed unless it had ended before."""
        try:
            return run.communicate(timeout=self.chance.uniform(0, self.length))
        except subprocess.TimeoutExpired:
            conftest.kill_all(run, self.ranks)
            return run.communicate()


class AtWrites:
    """One rank is killed before or within a change of its files; early and late ones are equally frequent."""

    def __init__(self, folder, ranks, chance):
        self.library, self.log, self.ranks, self.chance = make_deadly(folder), folder / "log", ranks, chance
        self.logged = dict(LD_PRELOAD=str(self.library), DIE_LOG=str(self.log), DIE_RANK="0")

    def learn(self):
        self.most = len(self.log.read_text().split())

    def choose(self):
        at = round(
            math.exp(self.chance.uniform(0, math.log(self.most)))
            if self.chance.random() < 0.5
            else self.chance.uniform(1, self.most)
        )
        rank, half = self.chance.randrange(self.ranks), self.chance.randrange(2)
        self.what = f"rank {rank} {'in' if half else 'before'} change {at}"
        return dict(LD_PRELOAD=str(self.library), DIE_AT=str(at), DIE_RANK=str(rank), DIE_HALF=str(half))

    def end(self, run):
        return run.communicate()


def torture(launcher, folder, kills, ranks, seed, kind="friction", tell=print, killer=AtMoments):
    """So many kills over as many runs as it takes; returns how many went on from a checkpoint.

    Where none did, as each kill was earlier than the first checkpoint, up to ten times as many kills.
    """
    chance, restarts, more = random.Random(seed), 0, 9 * kills
    case = write_case(kind, folder)
    complete = COMPLETE.get(kind, complete_as_whole)
    how = killer(folder, ranks, chance)
    whole = [case, dict(output="whole.h5"), KEPT, dict(checkpoint="whole.state.h5")]
    run = conftest.start(launcher, folder, whole, ranks, extra=how.logged)
    out, err = run.communicate()
    assert run.returncode == 0, (run.returncode, out, err)
    how.learn()
    while True:
        told_before = complete(folder) if (folder / "state.h5").exists() else 0
        goes_on = (folder / "state.h5").exists()
        restarts += goes_on
        if kills <= 0 and restarts == 0 and more > 0:
            kills, more = 1, more - 1
        extra = how.choose() if kills > 0 else {}
        run = conftest.start(launcher, folder, [case, KEPT, dict(restart="state.h5") if goes_on else {}], ranks, extra)
        out, err = how.end(run) if kills > 0 else run.communicate()
        told = re.findall(r"^ *(\d+) +\S+ +\d+", out, re.M)
        if run.returncode == 0:
            wrong = differences(folder / "out.h5", folder / "whole.h5")
            assert not wrong, (how.what, wrong)
            if kills <= 0:
                return restarts
            tell("a run got to its end; the next begins anew")
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
            tell(f"killed {how.what} after {told[-1] if told else 'no step'}, {steps} complete, checkpoint {kept}")
        else:
            tell(f"killed {how.what} before its first step")
        assert not goes_on or (folder / "state.h5").exists()


def trial(seed, folder, given):
    """A campaign of kills."""
    tell = print if given.show else lambda _: None
    killer = AtWrites if given.writes else AtMoments
    restarts = torture(conftest.launcher_words(), folder, given.kills, given.ranks, seed, given.case, tell, killer)
    text = f"{given.case}: {given.kills} kills, {restarts} runs went on from a checkpoint"
    return Outcome(text, False, dict(restarts=restarts))


def summary(found):
    restarts = sum(one["restarts"] for one in found.values())
    return [f"{restarts} runs went on from a checkpoint: fields and scalars as without kills"]

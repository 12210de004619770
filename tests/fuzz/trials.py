"""Trials of the program with spoiled input, and with faults while it runs. Each raises Failure for a broken promise.

What is promised: a run ends, with an exit code of the contract. After exit code 2 or 3 there are one to three lines
that begin with `petsam: `, and no file has changed. What exit code 0 leaves can be read, and balances the load. A
damaged checkpoint is never used. A run that is killed goes on to the same results, to the last bit. Nothing prints a
trace.
"""

import contextlib
import math
import os
import re
import shlex
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import h5py
import mutations
import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts"))
import petsam  # noqa: E402

LIMIT = 60  # seconds for a run; those under sanitizers get more
CODES = {0, 2, 3, 10, 11, 12, 75}
MEMORY = 55  # PETSc's code for a lack of memory: an absurd size may be allowed by the system and not be there
TRACES = (
    "PETSC ERROR",
    "HDF5-DIAG",
    "Segmentation",
    "ERROR: AddressSanitizer",
    "runtime error:",
    "Traceback",
    "Caught signal",
    "stack smashing",
    "malloc():",
    "free():",
)
SPHERE = (
    "-body1_young 210e9 -body1_poisson 0.3 -body2_young 70e9 -body2_poisson 0.3 -friction 0.3 -gap_type sphere "
    "-gap_radius1 0.2 -gap_radius2 0.2 -load_n 1000 -load_tx 60 -grid_n 24 -grid_size 3.2e-3"
)
BODIES = ("", "-body2_relax_moduli 0.4,0.2 -body2_relax_times 0.5,5", "-adhesion_work 10 -adhesion_stress 3e7")
FATIGUE = "-fatigue swt,ruiz,crossland -fatigue_crossland_alpha 0.3"
KILLED = "-history history.csv -output out.h5 -checkpoint state.h5 -checkpoint_every 1"


class Failure(Exception):
    pass


def demand(truth, *words):
    if not truth:
        raise Failure(" ".join(map(str, words)))


class Trials:
    """Runs one program in one folder."""

    def __init__(self, program, folder, launcher, patience):
        self.program, self.folder, self.launcher, self.patience = program, Path(folder), launcher, patience
        self.environment = dict(os.environ, OMP_NUM_THREADS="1", HOME=str(self.folder))
        self.environment.update(OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
        self.environment.setdefault("ASAN_OPTIONS", "detect_leaks=0:allocator_may_return_null=1")
        self.environment.setdefault("UBSAN_OPTIONS", "halt_on_error=1")
        self.command = None

    # ---- running

    def clear(self):
        for path in self.folder.iterdir():
            shutil.rmtree(path) if path.is_dir() and not path.is_symlink() else path.unlink()

    def start(self, words, ranks, file_limit=None, program=None):
        """`file_limit`: largest size of a file, KiB; `program`: another one of the same folder."""
        binary = self.program.with_name(program) if program else self.program
        limited = [] if file_limit is None else ["bash", "-c", f'ulimit -f {file_limit}; exec "$@"', "bash"]
        launched = [*self.launcher, "-n", str(ranks)] if ranks > 1 else []
        command = [*launched, *limited, str(binary), *words]
        self.command = shlex.join(command)
        return subprocess.Popen(
            command,
            cwd=self.folder,
            env=self.environment,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            errors="replace",
            start_new_session=True,
        )

    def end(self, run):
        try:
            out, err = run.communicate(timeout=self.patience)
        except subprocess.TimeoutExpired:
            os.killpg(run.pid, signal.SIGKILL)
            run.communicate()
            raise Failure(f"still running after {self.patience} s") from None
        demand(not any(word in err or word in out for word in TRACES), "a trace:", err[-1500:])
        return run.returncode, out, err

    def run(self, words, ranks, file_limit=None, program=None):
        return self.end(self.start(words, ranks, file_limit, program))

    def contents(self):
        return {path.name: path.read_bytes() for path in self.folder.iterdir() if path.is_file()}

    def untraced(self, words):
        """Contents without the traces, which PETSc opens for each rank before any program can reject the option."""
        words = [str(word) for word in words]
        traces = [f"{name}." for option, name in zip(words, words[1:]) if option == "-log_trace"]
        return {name: content for name, content in self.contents().items() if not name.startswith(tuple(traces))}

    # ---- promises

    def judge(self, words, ranks, forbidden=(), results="out.h5", file_limit=None):
        """Runs, and compares with what is promised of every run. Returns the exit code."""
        before = self.contents()
        code, out, err = self.run(words, ranks, file_limit)
        demand(code in CODES or code == MEMORY, "exit code", code, err[-1500:])
        demand(code not in forbidden, "exit code", code, "must not be", err[-500:])
        lines = [line for line in err.splitlines() if line.startswith("petsam: ")]
        if code in (2, 3):
            demand(1 <= len(lines) <= 3, "complaints:", err[-1500:])
            demand(ranks > 1 or len(lines) == len(err.splitlines()), "more than complaints:", err[-1500:])
        if code == 2:
            after = self.untraced(words)
            demand(after == before, "files have changed:", set(after.items()) ^ set(before.items()))
        if code in (0, 75) and (self.folder / results).exists():
            self.check_results(results, code == 0)
        return code

    def check_results(self, name, whole, told=None):
        """All steps, or those that were told, can be read, are finite, and balance the load."""
        with h5py.File(self.folder / name) as f:
            saved, load = f["pressure"].shape[0], f["history/load_n"][:]
            demand(told is None or saved >= told, "steps were told:", told, "saved:", saved)
            saved = saved if told is None else told
            demand(saved >= 1 or not whole, "no step saved")
            area = abs(np.prod([(f[c][-1] - f[c][0]) / (len(f[c]) - 1) for c in "xy"]))
            steps = [int(np.flatnonzero(f["history/time"][:] == t)[0]) for t in f["time"][:saved]]
            for k, step in enumerate(steps):
                p = f["pressure"][k]
                pulls = f["history/tension_max"][step] if "history/tension_max" in f else 0
                demand(np.all(np.isfinite(p)) and p.min() >= -pulls, "pressure of step", step)
                demand(abs(p.sum() * area - load[step]) <= 1e-8 * np.abs(p).sum() * area, "load of step", step)

    def judge_stress(self, words, ranks, file_limit=None, finite=True):
        """The same for a run of petsam-stress, after which there is a whole file of stresses, or nothing new."""
        before = self.contents()
        code, out, err = self.run(words, ranks, file_limit, "petsam-stress")
        demand(code in (0, 2, 3, MEMORY), "exit code", code, err[-1500:])
        lines = [line for line in err.splitlines() if line.startswith("petsam-stress: ")]
        demand(code not in (2, 3) or 1 <= len(lines) <= 3, "complaints:", err[-1500:])
        after = self.untraced(words)
        demand(code == 0 or after == before, "files have changed:", set(after) ^ set(before))
        if code == 0 and (self.folder / "stress.h5").exists():
            with h5py.File(self.folder / "stress.h5") as f:
                for name in f:
                    nan = name.startswith("ruiz") or "_normal_" in name  # where there is none
                    if finite and isinstance(f[name], h5py.Dataset) and not nan:
                        demand(np.isfinite(f[name][:]).all(), name, "is not finite")
        return code

    def make_results(self):
        rows = [f"{k + 1}, {60 * math.sin(k)!r}, {1e6 * k!r}" for k in range(5)]
        (self.folder / "history.csv").write_text("time, load_tx, bulk2_stress_xx\n" + "\n".join(rows) + "\n")
        words = SPHERE.replace("-load_tx 60", "-history history.csv").split()
        code, _, err = self.run([*words, "-output", "out.h5", "-output_every", "2"], 1)
        demand(code == 0, "exit code", code, err)

    # ---- trials: each is given chance and ranks

    def trial_stress_options(self, chance, ranks):
        self.make_results()
        section = chance.choice(("", "-section y=0", "-section x=2e-4"))
        words = f"-depths {chance.choice(('0', '0,1e-4', '0:3e-4:4'))} -steps {chance.choice(('all', 'last', '2:4:2'))}"
        more = chance.choice(("", FATIGUE, "-quantities stress,mises,principal,shear_max,strain"))
        words = f"-input out.h5 -output stress.h5 {words} {section} {more}".split()
        return self.judge_stress(mutations.spoil_words(chance, words), ranks)

    def trial_stress_input(self, chance, ranks):
        self.make_results()
        path = self.folder / "out.h5"
        path.write_bytes(mutations.spoil_bytes(chance, path.read_bytes()))
        section = chance.choice(([], ["-section", "y=0"]))
        words = f"-input out.h5 -output stress.h5 -depths 0,1e-4 -steps all {FATIGUE}".split()
        return self.judge_stress([*words, *section], ranks, finite=False)  # tractions may have been changed

    def trial_stress_full(self, chance, ranks):
        self.make_results()
        words = f"-input out.h5 -output stress.h5 -depths 0:3e-4:8 -steps all {FATIGUE}".split()
        return self.judge_stress(words, ranks, file_limit=chance.randint(0, 4000))

    def trial_options(self, chance, ranks):
        words = mutations.spoil_words(chance, [*SPHERE.split(), *chance.choice(BODIES).split(), "-output", "out.h5"])
        if chance.random() < 0.3:
            lines = " ".join(words).replace(" -", "\n-")
            (self.folder / "study.opts").write_text(lines, errors="replace")
            words = ["-options_file", "study.opts"]
        return self.judge(words, ranks)

    def trial_history(self, chance, ranks):
        rows = ["time, load_n, load_tx", "1, 100, 5", "2, 200.5, 10", "3,150,-20", "4, 300, 30"]
        (self.folder / "history.csv").write_text(mutations.spoil_table(chance, "\n".join(rows) + "\n"))
        words = SPHERE.replace("-load_n 1000 -load_tx 60", "-history history.csv").split()
        return self.judge([*words, *chance.choice(BODIES).split(), "-output", "out.h5"], ranks)

    def trial_gap(self, chance, ranks):
        path = self.folder / "gap.h5"
        x = (np.arange(24) - 11.5) * 3.2e-3 / 24
        with h5py.File(path, "w", libver=chance.choice(("earliest", "latest"))) as f:
            how = chance.choice(({}, dict(chunks=(7, 24)), dict(chunks=(12, 12), compression="gzip", fletcher32=True)))
            f.create_dataset("height", data=np.add.outer(x**2, x**2) / 0.2, **how)
            f["height"].attrs.update(units="m", quantity="separation", size=[3.2e-3, 3.2e-3])
            if chance.random() < 0.5:  # x and y say the size instead
                del f["height"].attrs["size"]
            for name in "xy":
                f[name] = x
                f[name].attrs["units"] = "m"
        path.write_bytes(mutations.spoil_bytes(chance, path.read_bytes()))
        words = SPHERE.replace("sphere -gap_radius1 0.2 -gap_radius2 0.2", "file -gap_file gap.h5").split()
        return self.judge([*words, "-output", "out.h5"], ranks)

    def write_program(self, steps, bodies=""):
        rows = [f"{k + 1}, {900 + 20 * math.sin(k)!r}, {60 * math.sin(k / 2)!r}" for k in range(steps)]
        (self.folder / "history.csv").write_text("time, load_n, load_tx\n" + "\n".join(rows) + "\n")
        return f"{SPHERE.replace('-load_n 1000 -load_tx 60', KILLED)} {bodies}".split()

    def stop(self, bodies, steps=6):
        """A run that was stopped half way, with its checkpoint and results."""
        words = self.write_program(steps // 2, bodies)
        code, _, err = self.run(words, 1)
        demand(code == 0, "exit code", code, err)
        return self.write_program(steps, bodies)

    def trial_checkpoint(self, chance, ranks):
        words = self.stop(chance.choice(BODIES))
        path = self.folder / "state.h5"
        whole = path.read_bytes()
        path.write_bytes(mutations.spoil_bytes(chance, whole))
        if path.read_bytes() == whole:
            return None
        return self.judge([*words, "-restart", "state.h5"], ranks, forbidden=CODES - {3})

    def trial_results(self, chance, ranks):
        words = self.stop(chance.choice(BODIES))
        path = self.folder / "out.h5"
        path.write_bytes(mutations.spoil_bytes(chance, path.read_bytes()))
        return self.judge([*words, "-restart", "state.h5"], ranks, results="none")

    def trial_kill(self, chance, ranks):
        """Kills all ranks at a random moment, again and again, until the run gets to its end."""
        words = self.write_program(12, chance.choice(BODIES))
        others = {"out.h5": "whole.h5", "state.h5": "whole.state"}
        code, _, err = self.run([others.get(word, word) for word in words], ranks)
        demand(code == 0, "exit code", code, err)
        for _ in range(6):
            again = ["-restart", "state.h5"] if (self.folder / "state.h5").exists() else []
            run = self.start([*words, *again], ranks)
            time.sleep(chance.uniform(0, 0.6 if ranks == 1 else 1.2))
            for process in self.processes(run, ranks):
                with contextlib.suppress(ProcessLookupError):  # the launcher ends others as soon as one has died
                    os.kill(process, signal.SIGKILL)
            try:
                run.communicate(timeout=self.patience)
            except subprocess.TimeoutExpired:
                os.killpg(run.pid, signal.SIGKILL)  # a launcher whose processes die while they start may wait for ever
                run.communicate()
        again = ["-restart", "state.h5"] if (self.folder / "state.h5").exists() else []
        code, _, err = self.run([*words, *again], ranks)
        demand(code == 0, "exit code", code, err)
        with petsam.open(self.folder / "out.h5") as a, petsam.open(self.folder / "whole.h5") as b:
            demand(a.steps == b.steps, "steps:", a.steps, b.steps)
            for name in ("pressure", "shear_x", "slip_x", "state"):
                same = all(np.array_equal(a.field(name, k), b.field(name, k)) for k in range(len(b.steps)))
                demand(same, name, "differs from that of the run without kills")
            name = "dissipated_energy"
            demand(np.array_equal(a.history[name], b.history[name]), name, "differs from that of the run without kills")
        left = [path.name for path in self.folder.iterdir() if path.name.endswith((".lock", ".data.0", ".metadata.0"))]
        demand(not left, "left over:", left)
        return 0

    def processes(self, run, ranks):
        if ranks == 1:
            return [run.pid] if run.poll() is None else []
        try:
            words = Path(f"/proc/{run.pid}/task/{run.pid}/children").read_text().split()
        except FileNotFoundError:
            return []
        return [int(word) for word in words if self.is_ours(word)]

    def is_ours(self, process):
        try:
            return Path(f"/proc/{process}/cmdline").read_bytes().startswith(str(self.program).encode())
        except FileNotFoundError:
            return False

    def trial_full(self, chance, ranks):
        """A limit on the size of files stands for a full disk. What was told is in the file."""
        words = self.write_program(12)
        code = self.judge(words, ranks, results="none", file_limit=chance.randint(0, 3000))
        if (self.folder / "out.h5").exists() and (self.folder / "out.h5").stat().st_size:
            self.check_results("out.h5", False)
        return code

    def trial_signal(self, chance, ranks):
        """USR1 and TERM stop with a checkpoint, USR2 writes one; others end the run at once, in the middle of a step's
        results too. Nothing that was told is lost."""
        words = self.write_program(200)
        words[words.index("-checkpoint_every") + 1] = "1000"
        number = chance.choice((signal.SIGUSR1, signal.SIGUSR2, signal.SIGHUP, signal.SIGQUIT, signal.SIGTERM))
        run = self.start(words, ranks)
        for line in run.stdout:
            if line.strip().startswith("1 "):
                break
        time.sleep(chance.uniform(0, 0.3))
        for process in self.processes(run, ranks)[: chance.randint(1, ranks)]:
            with contextlib.suppress(ProcessLookupError):
                os.kill(process, number)
        code, out, err = self.end(run)
        if number in (signal.SIGUSR1, signal.SIGTERM):
            demand(code in (0, 75), "exit code", code, err[-500:])
        elif number == signal.SIGUSR2:
            demand(code == 0 and (self.folder / "state.h5").exists(), "exit code", code, err[-500:])
        told = 1 + len(re.findall(r"^ *\d+ +\S+ +\d+", out, re.M))
        self.check_results("out.h5", False, None if code in (0, 75) else told)
        return code

    def trial_names(self, chance, ranks):
        """Names of files at random: what is not petsam's stays as it is."""
        names = ["a.h5", "a.h5.1", "a.h5.tmp", "b.txt", "loads.csv", "study.opts", "./a.h5", "link.h5", "no/a"]
        (self.folder / "b.txt").write_text("the only copy of a long text")
        (self.folder / "loads.csv").write_text("time, load_n\n1, 100\n2, 200\n")
        (self.folder / "study.opts").write_text("-load_tx 1\n")
        (self.folder / "link.h5").symlink_to(chance.choice(("b.txt", "a.h5", "loads.csv")))
        with h5py.File(self.folder / "a.h5", "w") as f:
            f["height"] = np.zeros((24, 24))
        kept = self.contents()
        words = SPHERE.replace("-load_n 1000 -load_tx 60", "-history loads.csv").split()
        words += ["-options_file", "study.opts", "-gap_rough_file", "a.h5", "-checkpoint_every", "1"]
        for option in chance.sample(("-output", "-checkpoint", "-normal_view", "-log_view"), 2):
            name = chance.choice(names)
            words += [option, f":{name}" if option.endswith("view") else name]
        if "-checkpoint" not in words:
            words += ["-checkpoint", "c.h5"]
        code = self.judge(words, ranks, results="none")
        # a log of PETSc goes where the user says, if that is no file of the run
        logs = {(self.folder / word[1:]).resolve() for word in words if word.startswith(":")}
        for name, data in kept.items():
            path = self.folder / name
            demand(path.resolve() in logs or path.read_bytes() == data, name, "has changed")
        return code


KINDS = sorted(name[6:] for name in vars(Trials) if name.startswith("trial_"))

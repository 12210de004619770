#!/usr/bin/env python3
"""petsam, FFTW, the memory's bandwidth and other contact programs on the same problems in one run.

    python3 tests/bench/benchmark.py [--quick] [--cases hertz,slip_tx] [--cells 512,1024] [--peers none]
                                     [--out build/bench/report] [--anew]

Writes results.json and results.csv, report.md and its figures (report.py) to --out. A run that breaks off or in which
something fails leaves its rows there; the same command measures what is missing. Times are medians of repeated runs,
from building the operators to the solution, without the start of MPI or Python; memory is the process's peak resident
set as the kernel tells it (wait4), for several ranks the largest rank's times their number. Every solution is checked
by the same measure (problem.py). This program stays small, because a child's peak never falls below its parent's size.
"""

import argparse
import hashlib
import json
import os
import platform
import re
import shutil
import signal
import statistics
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
BENCH = ROOT / "tests" / "bench"
sys.path[:0] = [str(BENCH), str(ROOT / "tests")]
import peer  # noqa: E402
from run import environment, mpirun  # noqa: E402

# case: (kind, cells of a whole run, cells of a quick one); a cycle's number is its steps
CASES = {
    "hertz": ("normal", (512, 1024, 2048), (128, 256)),
    "rough_1": ("rough", (512, 1024, 2048), ()),
    "rough_8": ("rough", (512, 1024, 2048), (128,)),
    "rough_40": ("rough", (512, 1024, 2048), ()),
    "periodic_8": ("periodic", (1024, 2048), (128,)),
    "slip_tx": ("tangential", (512, 1024, 2048), (128,)),
    "slip_tx_mz": ("torque", (512, 1024, 2048), (128,)),
    "cycle_80": ("cycle", (512,), ()),
    "cycle_16": ("cycle", (), (128,)),
}
CONVOLUTIONS = (512, 1024, 2048, 4096)
EXACT, APPROXIMATE = 1e-7, 1e-5  # limits of the classes of accuracy: error of a normal solution
# and of a peer's shear against petsam's certified one; increments slip on another path
SHEAR_EXACT, SHEAR_APPROXIMATE = 1e-5, 1e-2
PATIENCE = 900.0  # seconds for anything but a peer
ENOUGH = 30.0  # seconds of repeats after which one median is good enough
START = time.monotonic()
# what measures and is measured: rows belong together when none of it has changed
MEASURING = [BENCH / name for name in ("benchmark.py", "problem.py", "peer.py")]
PARTS = ("influence coefficients", "operator applications", "preconditioner")  # of petsam's time, none within another
MEASURED = ("bin/petsam", "bench/bandwidth", "bench/convolution")


class Failure(Exception):
    """What failed, and how, in a line."""


class Ran:
    """How a command ended: code (None: killed at the limit), output, seconds, CPU seconds, peak memory (MB)."""

    def __init__(self, command, limit, env=None):
        with tempfile.TemporaryFile() as out:
            start = time.perf_counter()
            child = subprocess.Popen(
                [str(w) for w in command],
                stdout=out,
                stderr=subprocess.STDOUT,
                stdin=subprocess.DEVNULL,
                env=env or environment(),
                start_new_session=True,
            )
            late = []

            def kill():
                late.append(True)
                os.killpg(child.pid, signal.SIGKILL)

            timer = threading.Timer(limit, kill)
            timer.start()
            try:
                _, status, usage = os.wait4(child.pid, 0)
            except BaseException:  # its own session does not see an interrupt
                kill()
                raise
            finally:
                timer.cancel()
            self.seconds = time.perf_counter() - start
            child.returncode = os.waitstatus_to_exitcode(status)
            out.seek(0)
            self.text = out.read().decode(errors="replace")
        self.code = None if late else child.returncode
        self.memory, self.cpu = usage.ru_maxrss * 1024e-6, usage.ru_utime + usage.ru_stime

    def must(self, what):
        if self.code is None:
            raise Failure(f"{what}: no end in time")
        if self.code:
            print(self.text[-2000:])
            said = [line.strip() for line in self.text.splitlines() if re.search(r"\w", line)] or ["no message"]
            raise Failure(f"{what}: exit code {self.code}: {said[-1][:200]}")
        return self.text


def launch(ranks, limit):
    """The launcher's words; none for one rank."""
    return mpirun(ranks, limit) if ranks > 1 else []


def say(text):
    elapsed = round(time.monotonic() - START)
    print(f"{elapsed // 60:3d}:{elapsed % 60:02d}  {text}", flush=True)


class Bench:
    def __init__(self, args):
        self.args = args
        self.build = Path(args.build).resolve()
        self.out = Path(args.out).resolve()
        self.out.mkdir(parents=True, exist_ok=True)
        self.python = self.build / "venv" / "bin" / "python"
        self.peer_python = self.build / "peers" / "bin" / "python"
        self.cores = max(args.ranks)
        self.there = {name: self.version(name) for name in args.peers}
        self.failures = []
        self.results = self.earlier_run() or dict(
            setup=self.setup(),
            machine=self.machine(),
            command=" ".join(["python3", "tests/bench/benchmark.py", *sys.argv[1:]]),
            bandwidth={},
            convolution=[],
            limit=args.limit,
            repeats=args.repeats,
            exact=EXACT,
            approximate=APPROXIMATE,
            runs=[],
            shear_exact=SHEAR_EXACT,
            shear_approximate=SHEAR_APPROXIMATE,
            settings=peer.describe(),
            resumed=[],
        )
        self.rows = self.results["runs"]

    # ---------------------------------------------------------------- the run and its rows

    def setup(self):
        """All that rows in one report have in common."""
        digest = {
            str(path.relative_to(path.parents[1])): hashlib.sha256(path.read_bytes()).hexdigest()[:12]
            for path in MEASURING + [self.build / name for name in MEASURED]
        }
        args = {name: getattr(self.args, name) for name in ("quick", "cases", "cells", "ranks", "repeats", "limit")}
        machine = {name: value for name, value in self.machine().items() if name not in ("load", "date")}
        petsam = Ran([self.build / "bin" / "petsam", "-version"], PATIENCE).must("petsam -version")
        return dict(machine, **args, peers=self.there, petsam=petsam.strip(), **digest)

    def earlier_run(self):
        """The results of an unfinished run, without what failed in it; None without one."""
        path = self.out / "results.json"
        if self.args.anew or not path.exists():
            return None
        results = json.loads(path.read_text())
        if results.get("finished", True):
            return None
        now = self.setup()
        differs = [f"{k} is {now.get(k)}, was {v}" for k, v in results["setup"].items() if now.get(k) != v]
        if differs:
            sys.exit(
                f"benchmark.py: {path} has an unfinished run that this one cannot go on with: {'; '.join(differs)}. "
                "--anew measures everything again"
            )
        results["runs"] = [row for row in results["runs"] if not row["failed"]]
        results["resumed"].append(
            dict(date=time.strftime("%Y-%m-%d %H:%M"), load=os.getloadavg()[0], rows=len(results["runs"]))
        )
        say(f"goes on with the run in {self.out}, {len(results['runs'])} rows (--anew measures them again)")
        return results

    def save(self, finished=False):
        """Whole at any time, so that a run killed here leaves what it had."""
        path = self.out / "results.json"
        path.with_suffix(".part").write_text(json.dumps(dict(self.results, finished=finished), indent=1) + "\n")
        path.with_suffix(".part").replace(path)

    def add(self, case, cells, program, cores, note="", failed=False, **numbers):
        row = dict(case=case, cells=cells, program=program, cores=cores, note=note, failed=failed, **numbers)
        self.rows.append(row)
        self.rows.sort(
            key=lambda r: (list(CASES).index(r["case"]), r["cells"])
        )  # those of an earlier run may be of larger grids
        self.save()
        text = f"{row['seconds']:.2f} s, {row['memory']:.0f} MB, error {row['error']:.1e}" if "error" in row else note
        say(f"{case} {cells}^2 {program} on {cores}: {'FAILED: ' if failed else ''}{text}")

    def find(self, case, cells, program, cores=None):
        """The row of a program, of petsam on that many ranks; None when it is not measured."""
        return next(
            (
                r
                for r in self.rows
                if (r["case"], r["cells"], r["program"]) == (case, cells, program) and cores in (None, r["cores"])
            ),
            None,
        )

    # ---------------------------------------------------------------- the machine

    @staticmethod
    def machine():
        text = Path("/proc/cpuinfo").read_text() if Path("/proc/cpuinfo").exists() else ""
        model = re.search(r"model name\s*: (.*)", text)
        return dict(
            processor=model[1] if model else platform.machine(),
            cores=os.cpu_count(),
            system=platform.platform(),
            load=os.getloadavg()[0],
            date=time.strftime("%Y-%m-%d"),
        )

    def bandwidth(self, ranks):
        """GB/s."""
        if str(ranks) not in self.results["bandwidth"]:
            text = Ran(launch(ranks, PATIENCE) + [self.build / "bench" / "bandwidth"], PATIENCE).must(
                f"bandwidth on {ranks} ranks"
            )
            self.results["bandwidth"][str(ranks)] = float(re.search(r"([\d.]+) GB/s", text)[1])
            self.save()
            say(f"bandwidth on {ranks} ranks: {self.results['bandwidth'][str(ranks)]:.1f} GB/s")

    def convolution(self, ranks, cells):
        """Seconds of FFTW's padded pair, of petsam's convolution, and of it by messages: a row a number of ranks."""
        rows = self.results["convolution"]
        if any((r["ranks"], r["cells"]) == (ranks, cells) for r in rows):
            return
        command = launch(ranks, PATIENCE) + [self.build / "bench" / "convolution", "-sizes", cells]
        what = f"convolution of {cells}^2 on {ranks} ranks"
        words, other = [
            Ran(command + ["-fft_exchange", e], PATIENCE).must(what).splitlines()[1].split()
            for e in ("auto", "transpose")
        ]
        rows.append(
            dict(ranks=ranks, cells=cells, padded=float(words[1]), petsam=float(words[2]), messages=float(other[2]))
        )
        self.save()
        say("{}: padded {padded:.4f} s, petsam {petsam:.4f} s, by messages {messages:.4f} s".format(what, **rows[-1]))

    # ---------------------------------------------------------------- problems

    def problem(self, *words):
        return Ran([self.python, BENCH / "problem.py", *words], PATIENCE).must(
            "problem.py " + " ".join(map(str, words))
        )

    def check(self, folder, solution):
        numbers = json.loads(self.problem("check", folder, solution))
        numbers["error"] = max(numbers["complementarity"], numbers["penetration"], numbers["load"])
        shear = numbers.get("shear_difference", 0.0)
        numbers["accuracy"] = (
            "exact"
            if numbers["error"] <= EXACT and shear <= SHEAR_EXACT
            else "approximate"
            if numbers["error"] <= APPROXIMATE and shear <= SHEAR_APPROXIMATE
            else "poor"
        )
        return numbers

    def repeat(self, once):
        """Medians of enough runs, and the greatest memory; once() gives (seconds, CPU seconds, memory)."""
        runs = []
        while len(runs) < self.args.repeats and (not runs or sum(r[0] for r in runs) < ENOUGH):
            runs.append(once())
        times, cpu, memory = zip(*runs)
        return dict(seconds=statistics.median(times), cpu=statistics.median(cpu), memory=max(memory), runs=times)

    # ---------------------------------------------------------------- petsam

    def solution(self, case, cells, folder):
        """Make the problem, solve it untimed: the accuracy."""
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir()
        self.problem("make", case, cells, folder)
        options = json.loads((folder / "problem.json").read_text())["options"]
        Ran(
            [self.build / "bin" / "petsam", *options, "-output", folder / "results.h5", "-output_every", "1000000"],
            PATIENCE,
        ).must("petsam")
        return self.check(folder, folder / "results.h5")

    def petsam(self, ranks, folder):
        """Times on that many ranks, and the shares of the parts that petsam tells of its own time."""
        command = launch(ranks, PATIENCE) + [
            self.build / "bin" / "petsam",
            *json.loads((folder / "problem.json").read_text())["options"],
            "-profile",
        ]
        shares = []

        def once():
            ran = Ran(command, PATIENCE)
            text = ran.must("petsam")
            shares.append({part: float(re.search(part + r"\s+[\d.]+ s\s+([\d.]+) %", text)[1]) for part in PARTS})
            return float(re.search(r"used\s+([\d.]+) s", text)[1]), ran.cpu, ran.memory * ranks

        return dict(self.repeat(once), parts={k: statistics.median(s[k] for s in shares) / 100 for k in PARTS})

    # ---------------------------------------------------------------- peers

    def first_run(self, setting, folder):
        """A first run, and the cores of it: all or one, whichever is the faster."""
        best = None
        for n in sorted({1, self.cores}, reverse=True):
            said = self.run_peer(setting, folder, n)
            if best is None or said.get("seconds", float("inf")) < best[0].get("seconds", float("inf")):
                best = said, n
            if "seconds" not in said:  # one core does not help
                break
        return best

    def run_peer(self, setting, folder, cores):
        """One run: what it says of itself, with its memory; or a note why there is nothing."""
        env = dict(environment(), OMP_NUM_THREADS=str(cores))
        ran = Ran([self.peer_python, BENCH / "peer.py", setting, folder, folder / "peer.npy"], self.args.limit, env)
        if ran.code is None:
            return dict(note=f"not within {self.args.limit:g} s")
        said = json.loads(ran.must("peer.py").splitlines()[-1])
        if not said["converged"]:
            return dict(
                note="does not converge: {} after {:.1f} s, its residual {:.1e}".format(
                    said.get("reason", "its own test fails"), said["seconds"], said["residual"]
                )
            )
        return dict(said, cpu=ran.cpu, memory=ran.memory)

    def peer(self, setting, folder):
        """All runs of one setting: its row."""
        first, cores = self.first_run(setting, folder)
        if "seconds" not in first:
            return dict(cores=cores, note=first["note"])
        accuracy = self.check(folder, folder / "peer.npy")
        runs = [first]

        def once():
            said = runs.pop() if runs else self.run_peer(setting, folder, cores)
            return said.get("seconds", self.args.limit), said.get("cpu", 0.0), said.get("memory", 0.0)

        return dict(cores=cores, iterations=first.get("iterations"), **self.repeat(once), **accuracy)

    def version(self, name):
        """An installed peer's; None when it is not there."""
        if not self.peer_python.exists():
            return None
        ran = Ran(
            [self.peer_python, "-c", f"import {name}, importlib.metadata as m; print(m.version('{name}'))"], PATIENCE
        )
        return ran.text.split()[-1] if ran.code == 0 else None

    def hindrance(self, name, kind):
        """Why a peer has no answer at all to a kind of problem; None when it can be asked."""
        why = peer.cannot(name, kind)
        if why:
            return "cannot: " + why
        return None if self.there[name] else "not installed"

    def earlier_note(self, case, setting):
        """Why a setting gave up on a smaller grid, and larger ones need not try; None when it did not."""
        row = next(
            (r for r in self.rows if (r["case"], r["program"]) == (case, setting) and r["note"] and not r["failed"]),
            None,
        )
        return row and row["note"] + (
            "" if "converge" in row["note"] or " at " in row["note"] else f" at {row['cells']}"
        )

    # ---------------------------------------------------------------- all of it

    def cells(self, case):
        whole, quick = CASES[case][1:]
        cells = quick if self.args.quick else whole
        return [n for n in self.args.cells or cells] if cells else []

    def programs(self, kind):
        """(program, petsam's ranks or None) of every row: petsam, then a peer's settings, or its name if it cannot."""
        yield from (("petsam", n) for n in self.args.ranks)
        for name in self.args.peers:
            yield from (
                (program, None) for program in ([name] if self.hindrance(name, kind) else peer.settings(name, kind))
            )

    def measure(self, case, program, ranks, folder, accuracy):
        """A row's numbers, or its note."""
        if ranks:
            return dict(self.petsam(ranks, folder), cores=ranks, **accuracy)
        note = self.hindrance(program.split()[0], CASES[case][0]) or self.earlier_note(case, program)
        return dict(cores=self.cores, note=note) if note else self.peer(program, folder)

    def run_grid(self, case, cells):
        """The rows of one problem that are not there yet."""
        folder, accuracy, unsolved = self.out / "problem", {}, None
        missing = [words for words in self.programs(CASES[case][0]) if not self.find(case, cells, *words)]
        try:
            if missing:
                accuracy = self.solution(case, cells, folder)
        except Failure as failure:  # a peer has nothing to be compared with
            unsolved = failure
        for program, ranks in missing:
            try:
                if unsolved:
                    raise unsolved
                row = self.measure(case, program, ranks, folder, accuracy)
            except Failure as failure:
                row = dict(cores=ranks or self.cores, note=str(failure), failed=True)
            self.add(case, cells, program, **row)
        shutil.rmtree(folder, ignore_errors=True)

    def attempt(self, once, *words):
        try:
            once(*words)
        except Failure as failure:
            say(f"FAILED: {failure}")
            self.failures.append(str(failure))

    def run(self):
        """What failed, a line each."""
        sizes = self.args.cells or ((128, 256) if self.args.quick else CONVOLUTIONS)
        for n in self.args.ranks:
            self.attempt(self.bandwidth, n)
        for n in self.args.ranks:
            for cells in sizes:
                self.attempt(self.convolution, n, cells)
        for case in self.args.cases or CASES:
            for cells in self.cells(case):
                self.run_grid(case, cells)
        self.failures += ["{case} {cells}^2 {program} on {cores}: {note}".format(**r) for r in self.rows if r["failed"]]
        self.save(finished=not self.failures)
        print(Ran([self.python, BENCH / "report.py", self.out], PATIENCE).must("report.py"), end="")
        return self.failures


def numbers(text):
    return [int(n) for n in text.split(",")]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument(
        "--quick", action="store_true", help="small grids, two repeats, 5 s a run of a peer: under two minutes"
    )
    parser.add_argument("--cases", type=lambda t: t.split(","), help="of " + ", ".join(CASES))
    parser.add_argument("--cells", type=numbers, help="instead of each case's own grids, e.g. 512,1024")
    parser.add_argument(
        "--ranks", type=numbers, default=[1, 2], help="of petsam; a peer has as many cores as the largest (1,2)"
    )
    parser.add_argument(
        "--peers", type=lambda t: t.split(","), default=["tamaas", "aspher"], help="of tamaas,aspher; or none"
    )
    parser.add_argument(
        "--repeats", type=int, help=f"runs of each, fewer when they take more than {ENOUGH:g} s (5, quick 2)"
    )
    parser.add_argument("--limit", type=float, help="seconds after which a peer's run is given up (120, quick 5)")
    parser.add_argument(
        "--anew", action="store_true", help="measure everything again, where an unfinished run would be gone on with"
    )
    parser.add_argument("--build", default=str(ROOT / "build"))
    parser.add_argument("--out", default=str(ROOT / "build" / "bench" / "report"))
    args = parser.parse_args()
    args.repeats = args.repeats or (2 if args.quick else 5)
    args.limit = args.limit or (5.0 if args.quick else 120.0)
    args.peers = [] if args.peers == ["none"] else args.peers
    for name in args.peers:
        if name not in peer.PEERS:
            parser.error(f"--peers: no peer {name}; there are {', '.join(peer.PEERS)}, or none")
    for case in args.cases or []:
        if case not in CASES:
            parser.error(f"--cases: no case {case}; there are {', '.join(CASES)}")
    for name, target in (
        ("bin/petsam", "all"),
        ("bench/bandwidth", "bench-programs"),
        ("bench/convolution", "bench-programs"),
        ("venv/bin/python", "venv"),
    ):
        if not (Path(args.build) / name).exists():
            sys.exit(f"benchmark.py: no {args.build}/{name}: make {target}")
    signal.signal(signal.SIGTERM, signal.default_int_handler)  # its children end with it
    try:
        failures = Bench(args).run()
    except KeyboardInterrupt:
        sys.exit("benchmark.py: broken off; the same command goes on from here")
    except Failure as failure:
        sys.exit(f"benchmark.py: {failure}")
    if failures:
        sys.exit("benchmark.py: failed, and measured again by the same command:\n" + "\n".join(failures))


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""petsam, FFTW, the memory's bandwidth and other contact programs on the same problems in one run.

    python3 tests/bench/benchmark.py [--quick] [--cases hertz,slip_tx] [--cells 512,1024] [--peers none] [--out build/bench/report]

Writes results.json and results.csv, report.md and its figures (report.py) to --out. Times are medians of repeated runs,
from building the operators to the solution, without the start of MPI or Python; memory is the process's peak resident
set as the kernel tells it (wait4), for several ranks the largest rank's times their number. Every solution is checked
by the same measure (problem.py). This program stays small, because a child's peak never falls below its parent's size.
"""
import argparse
import json
import os
import platform
import re
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
    "slip_tx": ("tangential", (512, 1024, 2048), (128,)),
    "slip_tx_mz": ("torque", (512, 1024, 2048), (128,)),
    "cycle_80": ("cycle", (512,), ()),
    "cycle_16": ("cycle", (), (128,)),
}
CONVOLUTIONS = (512, 1024, 2048, 4096)
EXACT, APPROXIMATE = 1e-7, 1e-5  # limits of the classes of accuracy: error of a normal solution
SHEAR_EXACT, SHEAR_APPROXIMATE = 1e-5, 1e-2  # and a peer's shear against petsam's certified one; increments slip on another path
PATIENCE = 900.0  # seconds for anything but a peer
ENOUGH = 30.0  # seconds of repeats after which one median is good enough


class Ran:
    """How a command ended: code (None: killed at the limit), output, seconds, CPU seconds, peak memory (MB)."""

    def __init__(self, command, limit, env=None):
        with tempfile.TemporaryFile() as out:
            start = time.perf_counter()
            child = subprocess.Popen([str(w) for w in command], stdout=out, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL,
                                     env=env or environment(), start_new_session=True)
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
        if self.code != 0:
            sys.exit(f"benchmark.py: {what} failed with {self.code}:\n{self.text[-2000:]}")
        return self.text


def launch(ranks, limit):
    """The launcher's words; none for one rank."""
    return mpirun(ranks, limit) if ranks > 1 else []


def say(text):
    print(text, flush=True)


class Bench:
    def __init__(self, args):
        self.args = args
        self.build = Path(args.build).resolve()
        self.out = Path(args.out).resolve()
        self.out.mkdir(parents=True, exist_ok=True)
        self.python = self.build / "venv" / "bin" / "python"
        self.peer_python = self.build / "peers" / "bin" / "python"
        self.cores = max(args.ranks)
        self.rows = []

    # ---------------------------------------------------------------- the machine

    def machine(self):
        text = Path("/proc/cpuinfo").read_text() if Path("/proc/cpuinfo").exists() else ""
        model = re.search(r"model name\s*: (.*)", text)
        return dict(processor=model[1] if model else platform.machine(), cores=os.cpu_count(), system=platform.platform(),
                    load=os.getloadavg()[0], date=time.strftime("%Y-%m-%d"))

    def bandwidth(self):
        """GB/s by number of ranks."""
        program = self.build / "bench" / "bandwidth"
        found = {}
        for n in self.args.ranks:
            text = Ran(launch(n, PATIENCE) + [program], PATIENCE).must("bandwidth")
            found[n] = float(re.search(r"([\d.]+) GB/s", text)[1])
            say(f"bandwidth, {n} ranks: {found[n]:.1f} GB/s")
        return found

    def convolutions(self, sizes):
        """Seconds of FFTW's padded pair and of petsam's convolution: rows {ranks, cells, padded, petsam, messages}, the last by messages."""
        program, rows = self.build / "bench" / "convolution", []
        for n in self.args.ranks:
            command = launch(n, PATIENCE) + [program, "-sizes", ",".join(map(str, sizes))]
            texts = [Ran(command + ["-fft_exchange", e], PATIENCE).must("convolution") for e in ("auto", "transpose")]
            for words, other in zip(*[[line.split() for line in text.splitlines()[1:]] for text in texts]):
                rows.append(dict(ranks=n, cells=int(words[0]), padded=float(words[1]), petsam=float(words[2]), messages=float(other[2])))
                say("convolution of {cells}^2 on {ranks} ranks: padded {padded:.4f} s, petsam {petsam:.4f} s, by messages {messages:.4f} s".format(**rows[-1]))
        return rows

    # ---------------------------------------------------------------- problems

    def problem(self, *words):
        return Ran([self.python, BENCH / "problem.py", *words], PATIENCE).must("problem.py " + " ".join(map(str, words)))

    def check(self, folder, solution):
        numbers = json.loads(self.problem("check", folder, solution))
        numbers["error"] = max(numbers["complementarity"], numbers["penetration"], numbers["load"])
        shear = numbers.get("shear_difference", 0.0)
        numbers["accuracy"] = "exact" if numbers["error"] <= EXACT and shear <= SHEAR_EXACT else \
            "approximate" if numbers["error"] <= APPROXIMATE and shear <= SHEAR_APPROXIMATE else "poor"
        return numbers

    def add(self, case, cells, program, cores, note="", **numbers):
        row = dict(case=case, cells=cells, program=program, cores=cores, note=note, **numbers)
        self.rows.append(row)
        line = f"{case} {cells}^2 {program} on {cores}: "
        say(line + (f"{row['seconds']:.2f} s, {row['memory']:.0f} MB, error {row['error']:.1e}" if "error" in row else note))

    def repeat(self, once):
        """Medians of runs until there are enough, and the greatest memory; once() gives (seconds, CPU seconds, memory)."""
        runs = []
        while len(runs) < self.args.repeats and (not runs or sum(r[0] for r in runs) < ENOUGH):
            runs.append(once())
        times, cpu, memory = zip(*runs)
        return dict(seconds=statistics.median(times), cpu=statistics.median(cpu), memory=max(memory), runs=times)

    # ---------------------------------------------------------------- petsam

    def petsam(self, case, cells, folder):
        options = json.loads((folder / "problem.json").read_text())["options"]
        program = self.build / "bin" / "petsam"
        # not timed: the solution to check
        Ran([program, *options, "-output", folder / "results.h5", "-output_every", "1000000"], PATIENCE).must(f"petsam, {case}")
        accuracy = self.check(folder, folder / "results.h5")
        for n in self.args.ranks:
            def once(ranks=n):
                ran = Ran(launch(ranks, PATIENCE) + [program, *options], PATIENCE)
                return float(re.search(r"used\s+([\d.]+) s", ran.must(f"petsam, {case}"))[1]), ran.cpu, ran.memory * ranks
            self.add(case, cells, "petsam", n, **self.repeat(once), **accuracy)

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
        if ran.code:
            return dict(note=(ran.text.strip().splitlines() or [f"exit code {ran.code}"])[-1][:200])
        said = json.loads(ran.text.splitlines()[-1])
        if not said["converged"]:
            return dict(note="does not converge: {} after {:.1f} s, its residual {:.1e}".format(
                said.get("reason", "its own test fails"), said["seconds"], said["residual"]))
        return dict(said, cpu=ran.cpu, memory=ran.memory)

    def peer(self, setting, case, cells, folder, earlier):
        """All runs of one setting; earlier are the notes of smaller grids, which larger ones need not try."""
        if earlier.get(setting):
            return self.add(case, cells, setting, self.cores, note=earlier[setting])
        first, cores = self.first_run(setting, folder)
        if "seconds" not in first:
            earlier[setting] = first["note"] + ("" if "converge" in first["note"] else f" at {cells}")
            return self.add(case, cells, setting, cores, note=first["note"])
        accuracy = self.check(folder, folder / "peer.npy")
        runs = [first]

        def once():
            said = runs.pop() if runs else self.run_peer(setting, folder, cores)
            return said.get("seconds", self.args.limit), said.get("cpu", 0.0), said.get("memory", 0.0)
        return self.add(case, cells, setting, cores, iterations=first.get("iterations"), **self.repeat(once), **accuracy)

    def hindrance(self, name, kind):
        """Why a peer has no answer at all to a kind of problem; None when it can be asked."""
        why = peer.cannot(name, kind)
        if why:
            return "cannot: " + why
        there = self.peer_python.exists() and Ran([self.peer_python, "-c", f"import {name}"], PATIENCE).code == 0
        return None if there else "not installed"

    # ---------------------------------------------------------------- all of it

    def cells(self, case):
        whole, quick = CASES[case][1:]
        cells = quick if self.args.quick else whole
        return [n for n in self.args.cells or cells] if cells else []

    def run_case(self, case):
        kind, earlier = CASES[case][0], {}
        for cells in self.cells(case):
            with tempfile.TemporaryDirectory(dir=self.out) as name:
                folder = Path(name)
                self.problem("make", case, cells, folder)
                self.petsam(case, cells, folder)
                for name in self.args.peers:
                    why = self.hindrance(name, kind)
                    if why:
                        self.add(case, cells, name, self.cores, note=why)
                        continue
                    for setting in peer.settings(name, kind):
                        self.peer(setting, case, cells, folder, earlier)

    def run(self):
        sizes = self.args.cells or ((128, 256) if self.args.quick else CONVOLUTIONS)
        results = dict(machine=self.machine(), command=" ".join(["python3", "tests/bench/benchmark.py", *sys.argv[1:]]),
                       bandwidth=self.bandwidth(), convolution=self.convolutions(sizes), limit=self.args.limit,
                       repeats=self.args.repeats, exact=EXACT, approximate=APPROXIMATE, runs=self.rows,
                       shear_exact=SHEAR_EXACT, shear_approximate=SHEAR_APPROXIMATE, settings=peer.describe())
        path = self.out / "results.json"
        for case in self.args.cases or CASES:
            self.run_case(case)
            path.write_text(json.dumps(results, indent=1) + "\n")  # a broken run leaves what it had
        print(Ran([self.python, BENCH / "report.py", self.out], PATIENCE).must("report.py"), end="")


def numbers(text):
    return [int(n) for n in text.split(",")]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="small grids, two repeats, 5 s a run of a peer: under two minutes")
    parser.add_argument("--cases", type=lambda t: t.split(","), help="of " + ", ".join(CASES))
    parser.add_argument("--cells", type=numbers, help="instead of each case's own grids, e.g. 512,1024")
    parser.add_argument("--ranks", type=numbers, default=[1, 2], help="of petsam; a peer has as many cores as the largest (1,2)")
    parser.add_argument("--peers", type=lambda t: t.split(","), default=["tamaas", "aspher"], help="of tamaas,aspher; or none")
    parser.add_argument("--repeats", type=int, help=f"runs of each, fewer when they take more than {ENOUGH:g} s (5, quick 2)")
    parser.add_argument("--limit", type=float, help="seconds after which a peer's run is given up (120, quick 5)")
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
    for name, target in (("bin/petsam", "all"), ("bench/bandwidth", "bench-programs"), ("bench/convolution", "bench-programs"), ("venv/bin/python", "venv")):
        if not (Path(args.build) / name).exists():
            sys.exit(f"benchmark.py: no {args.build}/{name}: make {target}")
    Bench(args).run()


if __name__ == "__main__":
    main()

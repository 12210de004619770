#!/usr/bin/env python3
"""The benchmark's report: results.csv, report.md and figures from results.json; and scaling on paper (scaling.py).

build/venv/bin/python tests/bench/report.py [--cores-per-node 64] [--network 25] [--latency 2] DIRECTORY
"""

import argparse
import csv
import json
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests" / "bench"), str(ROOT / "scripts")]
import scaling  # noqa: E402
from petsam.plot.style import STYLE, plt, save  # noqa: E402

TITLES = {
    "hertz": "Hertz",
    "rough_1": "rough, 1 % contact",
    "rough_8": "rough, 8 % contact",
    "rough_40": "rough, 40 % contact",
    "periodic_8": "periodic rough, 8 % contact",
    "slip_tx": "partial slip, T_x = 0.6 mu N",
    "slip_tx_mz": "partial slip, T_x and M_z, half of each limit",
    "cycle_80": "fretting cycle, 80 steps",
    "cycle_16": "fretting cycle, 16 steps",
}
COLUMNS = (
    "case",
    "cells",
    "program",
    "cores",
    "seconds",
    "cpu",
    "memory",
    "error",
    "tangential_residual",
    "accuracy",
    "hertz_l2",
    "contact",
    "iterations",
    "normal_iterations",
    "tangential_iterations",
    "total_normal_applies",
    "total_tangential_applies",
    "note",
)
STRONG, WEAK = (4096, 16384), 1024  # cells of a grid; cells of a rank's square
RANKS, SHOWN = [2**k for k in range(11)], (1, 16, 64, 256, 1024)


def table(headings, rows):
    """Markdown."""
    lines = ["| " + " | ".join(line) + " |" for line in [headings, ["---"] * len(headings), *rows]]
    return "\n".join(lines) + "\n"


def seconds(value):
    return f"{value:.3g}" if value < 100 else f"{value:.0f}"


class Report:
    def __init__(self, directory, cluster):
        self.directory, self.cluster = directory, cluster
        self.data = json.loads((directory / "results.json").read_text())
        self.rows = self.data["runs"]
        self.text = []

    def write(self, *paragraphs):
        self.text += paragraphs

    def of(self, case, cells=None, **want):
        return [
            r
            for r in self.rows
            if r["case"] == case
            and (cells is None or r["cells"] == cells)
            and all(r.get(k) == v for k, v in want.items())
        ]

    def cases(self):
        return list(dict.fromkeys(r["case"] for r in self.rows))

    def grids(self, case):
        return sorted({r["cells"] for r in self.of(case)})

    # ---------------------------------------------------------------- tables

    def head(self):
        m, d = self.data["machine"], self.data
        self.write(
            "# Benchmark\n",
            f"`{d['command']}`, {m['date']}, {m['processor']}, {m['cores']} cores, load at the start "
            f"{m['load']:.1f}. Seconds are medians of up to {d['repeats']} runs from building the operators to the "
            "solution, without the start of MPI or Python; a peer runs on one core or all, whichever is the faster. "
            "CPU seconds are the process's, its start and all ranks with it. Memory is the peak resident set (for "
            "several ranks the largest rank's times their number; a peer's holds Python). "
            "Error is the largest of complementarity sum p |g|/(N u), penetration over u and load, "
            f"by one measure for all (`tests/bench/problem.py`): exact is at most {d['exact']:g}, approximate at most "
            f"{d['approximate']:g}. With friction, a peer's shear must agree with petsam's, whose residual the "
            f"program's own check certifies, to {d['shear_exact']:g} or {d['shear_approximate']:g} (relative L2).\n",
        )
        for r in d.get("resumed", []):
            self.write(f"The run was resumed after {r['rows']} rows: {r['date']}, load {r['load']:.1f}.\n")

    def machine(self):
        self.write(
            "## Memory and transforms\n",
            table(["ranks", "triad, GB/s"], [[n, f"{b:.1f}"] for n, b in self.data["bandwidth"].items()]),
        )
        rows = [
            [
                f"{r['cells']}²",
                str(r["ranks"]),
                f"{r['padded']:.4f}",
                f"{r['petsam']:.4f}",
                f"{r['petsam'] / r['padded']:.2f}",
                self.gain(r),
                f"{r['messages']:.4f}" if r["ranks"] > 1 else "",
            ]
            for r in self.data["convolution"]
        ]
        self.write(
            "One convolution, seconds, against FFTW's padded pair (r2c, product, c2r) on as many ranks:\n",
            table(
                ["cells", "ranks", "padded FFTW", "petsam", "ratio", "times one rank", "by messages, as between nodes"],
                rows,
            ),
        )

    def gain(self, row):
        one = [r for r in self.data["convolution"] if r["cells"] == row["cells"] and r["ranks"] == 1]
        return f"{one[0]['petsam'] / row['petsam']:.2f}" if one and row["ranks"] > 1 else ""

    def best(self, case, cells, wanted):
        """The fastest row of those programs that has a time."""
        rows = [r for r in self.of(case, cells) if "seconds" in r and wanted(r)]
        return min(rows, key=lambda r: r["seconds"]) if rows else None

    def summary(self):
        """The table for tests/bench/README.md: petsam and the fastest peers, each on its better number of cores."""
        rows = []
        for case in self.cases():
            for cells in self.grids(case):
                ours = self.of(case, cells, program="petsam")
                best = self.best(case, cells, lambda r: r["program"] == "petsam")
                if not best:
                    continue
                peers = [
                    self.best(case, cells, lambda r, a=a: r["program"] != "petsam" and r["accuracy"] == a)
                    for a in ("exact", "approximate")
                ]
                rows.append(
                    [
                        TITLES[case],
                        f"{cells}²",
                        *[
                            seconds(r["seconds"]) if "seconds" in r else ""
                            for r in sorted(ours, key=lambda r: r["cores"])
                        ],
                        f"{best['total_normal_applies']} + {best['total_tangential_applies']}",
                        f"{ours[0]['memory']:.0f}" if "memory" in ours[0] else "",
                        *[self.versus(p, best) for p in peers],
                    ]
                )
        ranks = sorted({r["cores"] for r in self.rows if r["program"] == "petsam"})
        self.write(
            "## Summary\n",
            table(
                [
                    "case",
                    "cells",
                    *[f"petsam on {n}, s" for n in ranks],
                    "products",
                    "MB on one",
                    "fastest exact peer",
                    "fastest approximate peer",
                ],
                rows,
            ),
        )

    @staticmethod
    def versus(row, best):
        return (
            f"{row['program']}: {seconds(row['seconds'])} s, **{row['seconds'] / best['seconds']:.1f}** times"
            if row
            else "none"
        )

    def missing(self):
        """Which peers have no answer, and why."""
        notes = {}
        for r in self.rows:
            if "seconds" not in r:
                notes.setdefault((r["case"], r["program"], r["note"]), {})[f"{r['cells']}²"] = True
        if notes:
            self.write(
                "Without an answer:\n",
                "".join(
                    f"- {TITLES[case]}, {', '.join(cells)}: {program}: {note}\n"
                    for (case, program, note), cells in notes.items()
                ),
            )

    def cycle(self):
        """A cycle in units of one partial-slip solve of the same grid."""
        for case in (c for c in self.cases() if c.startswith("cycle_")):
            for cells in self.grids(case):
                a = self.best(case, cells, lambda r: r["program"] == "petsam" and r["cores"] == 1)
                b = self.best("slip_tx", cells, lambda r: r["program"] == "petsam" and r["cores"] == 1)
                if a and b:
                    ratio = a["seconds"] / b["seconds"]
                    self.write(f"The {TITLES[case]} at {cells}² costs {ratio:.1f} partial-slip solves on one rank.\n")

    def solves_in_convolutions(self):
        """What a solve of one step takes, in convolutions of the same grid on as many ranks."""
        rows = []
        for case in (c for c in self.cases() if not c.startswith("cycle_")):
            for r in (r for r in self.of(case) if "parts" in r):
                one = [c for c in self.data["convolution"] if (c["cells"], c["ranks"]) == (r["cells"], r["cores"])]
                if not one:
                    continue
                total, parts = r["seconds"] / one[0]["petsam"], r["parts"].values()
                shares = [*parts, 1 - sum(parts)]
                rows.append(
                    [TITLES[case], f"{r['cells']}²", str(r["cores"]), f"{total:.1f}"]
                    + [f"{total * share:.1f}" for share in shares]
                )
        if rows:
            headings = ["case", "cells", "ranks", "solve", "coefficients", "products", "preconditioner", "rest"]
            self.write(
                "A solve of one step from nothing, in double-precision convolutions of the same grid on as many ranks. "
                "Products are those of all nested grids and of the check, most of them in single precision on the "
                "contact's window; the rest is reading and writing fields in memory, planning and sums:\n",
                table(headings, rows),
            )

    def details(self):
        for case in self.cases():
            rows = []
            for r in self.of(case):
                timed = "seconds" in r
                rest = (
                    [
                        seconds(r["seconds"]),
                        self.ratio(r),
                        seconds(r["cpu"]),
                        f"{r['memory']:.0f}",
                        self.error(r),
                        r["accuracy"],
                    ]
                    if timed
                    else [""] * 5 + [r["note"]]
                )
                rows.append([f"{r['cells']}²", r["program"], str(r["cores"]), *rest])
            self.write(
                f"## {TITLES[case]}\n",
                table(["cells", "program", "cores", "s", "times petsam", "CPU s", "MB", "error", ""], rows),
            )
        self.write("Settings: " + "; ".join(f"{k}: {v}" for k, v in self.data["settings"].items()) + ".\n")

    def ratio(self, row):
        best = self.best(row["case"], row["cells"], lambda r: r["program"] == "petsam")
        return f"{row['seconds'] / best['seconds']:.2f}" if best else ""

    @staticmethod
    def error(row):
        text = f"{row['error']:.1e}"
        if row.get("tangential_residual"):
            text += f", tangential {row['tangential_residual']:.1e}"
        if "shear_difference" in row:
            text += f", shear against petsam {row['shear_difference']:.1e}"
        return text + (f", Hertz L2 {row['hertz_l2']:.2e}" if "hertz_l2" in row else "")

    def csv(self):
        with open(self.directory / "results.csv", "w", newline="", encoding="utf-8") as file:
            writer = csv.DictWriter(file, COLUMNS, extrasaction="ignore", restval="")
            writer.writeheader()
            writer.writerows(self.rows)

    # ---------------------------------------------------------------- figures

    def lines(self):
        """(program, cores) of every curve: petsam's ranks apart, a peer's cores not."""
        return list(
            dict.fromkeys(
                (r["program"], r["cores"] if r["program"] == "petsam" else None) for r in self.rows if "seconds" in r
            )
        )

    def curves(self, key, label):
        """A panel a case: seconds or memory over n, a line a program."""
        cases = self.cases()
        columns = min(3, len(cases))
        lines = -(-len(cases) // columns)
        figure, axes = plt.subplots(
            lines, columns, figsize=(4.2 * columns, 3.2 * lines + 0.8), squeeze=False, layout="constrained"
        )
        handles = {}
        for axis, case in zip(axes.flat, cases):
            for k, (program, cores) in enumerate(self.lines()):
                rows = [r for r in self.of(case, program=program) if key in r and cores in (None, r["cores"])]
                if rows:
                    name = program + (f", {cores} rank{'s' if cores > 1 else ''}" if cores else "")
                    (handles[name],) = axis.loglog(
                        [r["cells"] for r in rows],
                        [r[key] for r in rows],
                        "o-" if cores else "s--",
                        color=f"C{k}",
                        markersize=4,
                    )
            grids = self.grids(case)
            axis.set_xticks(grids, [str(n) for n in grids])
            axis.xaxis.minorticks_off()
            axis.set(title=TITLES[case], xlabel="n", ylabel=label)
        for axis in axes.flat[len(cases) :]:
            axis.set_visible(False)
        figure.legend(handles.values(), handles.keys(), loc="outside lower center", ncols=4)
        save(figure, self.directory, f"{key}.png")

    # ---------------------------------------------------------------- scaling on paper

    def model(self):
        """The convolution's model and the largest convolution it comes from; None when something is not measured."""
        bandwidth = {int(k): 1e9 * v for k, v in self.data["bandwidth"].items()}
        times = {(r["cells"], r["ranks"]): (r["petsam"], r["messages"]) for r in self.data["convolution"]}
        both = [n for n, ranks in times if ranks == 1 and (n, 2) in times]
        if not both or 1 not in bandwidth:
            return None, 0
        n = max(both)
        return scaling.fit(n, times[n, 1][0], *times[n, 2], bandwidth[1], self.cluster), n

    def timed(self, case, cells, ranks):
        """petsam's row in a list; an empty one when it has no time."""
        return [r for r in self.of(case, cells, program="petsam", cores=ranks) if "seconds" in r]

    def solves(self, convolution):
        """Case: the model of its largest solve on one rank, and its seconds on one and two ranks."""
        found = {}
        for case in ("hertz", "rough_8", "slip_tx"):
            for row in self.timed(case, max(self.grids(case), default=0), 1):
                two = self.timed(case, row["cells"], 2)
                solve = scaling.measured_solve(
                    row["cells"],
                    row["seconds"],
                    row["normal_applies"] + 2 * row["tangential_applies"],
                    row["normal_preconditions"] + 2 * row["tangential_preconditions"],
                    convolution,
                )
                found[case] = solve, row["seconds"], two[0]["seconds"] if two else None
        return found

    def scaling(self):
        convolution, n = self.model()
        solves = self.solves(convolution) if convolution else {}
        if not solves:
            return
        c, arithmetic = self.cluster, convolution.compute * n * n * scaling.log2(2 * n)
        self.write(
            "## Scaling on paper\n",
            "```\n" + scaling.__doc__.strip() + "\n```\n",
            f"Measured: convolution of {n}² on one and two ranks, b = {convolution.bandwidth / 1e9:.1f} GB/s a rank, "
            f"arithmetic {100 * arithmetic / convolution.seconds(n, 1):.0f} % of the time on one rank, "
            f"exchange between ranks of a node {convolution.node / 1e9:.1f} GB/s a rank. "
            f"Assumed: {c.cores} ranks a node, each with this bandwidth; network {c.network / 1e9:g} GB/s a node, "
            f"latency {1e6 * c.latency:g} microseconds, no contention; no setting up or writing beyond what the "
            "measured solve holds.\n",
        )
        rows = [
            [TITLES[k], f"{s.n}²", seconds(one), seconds(two) if two else "", seconds(s.seconds(convolution, s.n, 2))]
            for k, (s, one, two) in solves.items()
        ]
        self.write(
            "The model against the solve on two ranks, which it has not seen:\n",
            table(["case", "cells", "on one, s", "on two, s", "model on two, s"], rows),
        )
        self.scaling_tables(convolution, solves)

    def scaling_tables(self, convolution, solves):
        figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4.6), layout="constrained")
        strong, weak, shares = [], [], []
        for k, (case, (solve, _, _)) in enumerate(solves.items()):
            for n, style in zip(STRONG, ("o-", "s--")):
                times = [solve.seconds(convolution, n, p) for p in RANKS]
                left.loglog(RANKS, times, style, color=f"C{k}", markersize=3, label=f"{TITLES[case]}, {n}²")
                strong.append([TITLES[case], f"{n}²", *self.efficiencies(times, RANKS, RANKS)])
                parts = solve.parts(convolution, n, RANKS[-1])
                shares.append([TITLES[case], f"{n}²", *[f"{100 * part / sum(parts):.0f} %" for part in parts]])
            squares = RANKS[::2]  # whole sides
            times = [solve.seconds(convolution, WEAK * round(p**0.5), p) for p in squares]
            right.semilogx(squares, [100 * times[0] / t for t in times], "o-", color=f"C{k}", markersize=3)
            weak.append([TITLES[case], *self.efficiencies(times, squares, [1] * len(squares))])
        left.set(title="strong scaling", xlabel="ranks", ylabel="s")
        right.set(title=f"weak scaling, {WEAK}² cells a rank", xlabel="ranks", ylabel="efficiency, %", ylim=(0, 105))
        figure.legend(*left.get_legend_handles_labels(), loc="outside lower center", ncols=3)
        save(figure, self.directory, "scaling.png")
        shown = [f"{p} rank{'s' if p > 1 else ''}" for p in SHOWN]
        self.write(
            "Strong scaling, seconds (efficiency):\n",
            table(["case", "cells", *shown], strong),
            f"Weak scaling with {WEAK}² cells a rank, seconds (efficiency):\n",
            table(["case", *shown], weak),
            f"Where the time goes on {RANKS[-1]} ranks:\n",
            table(["case", "cells", "finest transforms", "coarse grids", "the rest"], shares),
            "![scaling](scaling.png)\n",
        )

    @staticmethod
    def efficiencies(times, ranks, ideal):
        return [
            f"{seconds(t)} ({100 * times[0] / t / gain:.0f} %)" for t, p, gain in zip(times, ranks, ideal) if p in SHOWN
        ]

    def run(self):
        plt.rcParams.update(STYLE)
        self.head()
        self.summary()
        self.missing()
        self.cycle()
        self.machine()
        self.solves_in_convolutions()
        self.details()
        self.curves("seconds", "s")
        self.curves("memory", "MB")
        self.write("![seconds](seconds.png)\n", "![memory](memory.png)\n")
        self.scaling()
        self.csv()
        (self.directory / "report.md").write_text("\n".join(self.text), encoding="utf-8")
        print(f"wrote {self.directory / 'report.md'}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("directory", type=Path)
    parser.add_argument("--cores-per-node", type=int, default=64)
    parser.add_argument("--network", type=float, default=25.0, help="bandwidth of a node's network, GB/s (25)")
    parser.add_argument("--latency", type=float, default=2.0, help="of a message, microseconds (2)")
    args = parser.parse_args()
    Report(args.directory, scaling.Assumptions(args.cores_per_node, 1e9 * args.network, 1e-6 * args.latency)).run()


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""The reference collection: petsam's answers, the evidence for the intervals, and the pictures.

    reference.py answers [CASE ...] [-o answers.json]   petsam's answers and CPU seconds
    reference.py intervals [CASE ...]                   computes the intervals anew into cases.json and the pages
    reference.py pictures [CASE ...]                    draws cases/CASE.png

A case is three files in cases/: CASE.md, its text; CASE.py, with the functions answers(), evidence() and draw(figure);
CASE.png. petsam runs on one rank. `make reference` runs the answers and checks them.
"""

import argparse
import importlib
import json
import os
import re
import sys
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
CASES = HERE / "cases"
JSON = HERE / "cases.json"
# in the order of the page
NAMES = (
    "hertz-sphere",
    "hertz-ellipse",
    "cattaneo-mindlin",
    "tangential-sphere",
    "lubkin",
    "spence",
    "mindlin-deresiewicz",
    "turning-force",
    "rounded-punch",
    "inclined-punch",
    "pad-bulk-stress",
    "carter",
    "rolling-spin",
    "dissimilar-unloading",
    "coated-sphere",
    "rough-periodic",
    "westergaard",
    "sliding-stress",
    "gross-slip-wear",
    "popov-wear",
    "mccoll",
    "indentation",
    "plate-on-feet",
    "lap-joint",
)

sys.path[:0] = [str(HERE), str(CASES)]
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # threads only disturb each other on small matrices


def module(name):
    """The functions of a case."""
    return importlib.import_module(name.replace("-", "_"))


def cpu():
    """CPU seconds of this process and of all that it has started and awaited."""
    return sum(os.times()[:4])


def answers(names, output):
    """Writes petsam's answers as check.py reads them."""
    import petsam

    found, seconds = {}, {}
    for name in names:
        case, start = module(name), cpu()
        given = case.answers()
        seconds[name] = round(cpu() - start, 2)
        found[name] = {q: [float(part) for part in v] if isinstance(v, tuple) else float(v) for q, v in given.items()}
        print(f"{name}: {seconds[name]:.2f} s of CPU", flush=True)
        text = json.dumps({"program": f"petsam {petsam.__version__}", "answers": found, "seconds": seconds}, indent=1)
        output.parent.mkdir(parents=True, exist_ok=True)
        output.write_text(text + "\n", encoding="utf-8")


def intervals(names, _):
    """Computes the intervals of these cases anew; those of the others stay."""
    from common import rounded

    rows = {}
    for row in json.loads(JSON.read_text(encoding="utf-8")) if JSON.exists() else []:
        rows.setdefault(row["case"], []).append(row)
    for name in names:
        start = time.time()
        found = [rounded(interval) for interval in module(name).evidence()]
        rows[name] = [{"case": name, **{k: v for k, v in f._asdict().items() if v is not None}} for f in found]
        for f in found:
            print(f"{name} {f.quantity}: {f.low:.10g} .. {f.high:.10g} {f.unit}    {f.how}", flush=True)
        print(f"{name}: {time.time() - start:.1f} s", flush=True)
        text = ",\n".join(json.dumps(row, ensure_ascii=False) for n in NAMES for row in rows.get(n, []))
        JSON.write_text(f"[\n{text}\n]\n", encoding="utf-8")
        write_page(name, rows[name])


def write_page(name, rows):
    """Puts the intervals into the second column of the page's table of quantities."""
    page = CASES / f"{name}.md"
    text = page.read_text(encoding="utf-8")
    for row in rows:
        cell = f"{row['low']:.12g} .. {row['high']:.12g} {row['unit']}".rstrip()
        line = re.compile(rf"^\| `{re.escape(row['quantity'])}` \|[^|]*\|", re.M)
        if not line.search(text):
            raise SystemExit(f"{page.name}: the table has no row for `{row['quantity']}`")
        text = line.sub(lambda _, row=row, cell=cell: f"| `{row['quantity']}` | {cell} |", text)
    page.write_text(text, encoding="utf-8")


def pictures(names, _):
    """Draws the pictures of these cases, in 64 colors, so that they are small."""
    from PIL import Image

    from petsam.plot.style import COLORS, STYLE, plt

    look = {**STYLE, "axes.grid": False, "axes.prop_cycle": plt.cycler(color=COLORS)}
    for name in names:
        picture = CASES / f"{name}.png"
        with plt.rc_context(look):
            figure = plt.figure(figsize=(6.4, 3.2), layout="constrained")
            module(name).draw(figure)
            figure.savefig(picture, dpi=120)
            plt.close(figure)
        Image.open(picture).convert("RGB").quantize(64).save(picture, optimize=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("what", choices=("answers", "intervals", "pictures"))
    parser.add_argument("case", nargs="*", help="all without one")
    parser.add_argument("-o", "--output", type=Path, default=Path("build/run/answers.json"))
    args = parser.parse_args()
    unknown = [name for name in args.case if name not in NAMES]
    if unknown:
        parser.error(f"there is no case {unknown[0]}; the cases are {', '.join(NAMES)}")
    globals()[args.what](args.case or NAMES, args.output)


if __name__ == "__main__":
    main()

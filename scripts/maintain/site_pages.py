#!/usr/bin/env python3
"""Makes the site of petsam's pages by MkDocs and its theme Material: make site.

    python3 scripts/maintain/site_pages.py --pages build/site-pages --out build/site [--url https://example.org/petsam/]

The pages stay where they are and link to each other and to files of the repository relatively. They and the files that
they name are copied to the same places beside each other, and MkDocs checks every link: a link to no page, file or
heading is an error. README.md is the index of its folder. The pages of the C library and of the Python package are no
files of the repository: functions.py makes the first from the headers, modules.py the second from the docstrings.
Notebooks are pages with what is stored in them, by notebooks.py.

The folder theme has the page for wrong addresses, the style of blocks and of names of options, and a script with
which the search finds options by their names with the dash. The page for wrong addresses appears at any address, so its
links are absolute: --url names the folder of the server if the site is not at its top. Material was chosen because its
search needs no server, it fits a phone, and it takes the pages as they are. Its fixes end in May 2027; its successor
Zensical reads its settings.
"""

import argparse
import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import functions
import modules
import yaml

import notebooks

ROOT = Path(__file__).resolve().parents[2]
MAINTAIN = Path(__file__).resolve().parent
LINK = re.compile(r"\]\(([^)#\s]+)(?:#[^)]*)?\)")
COMMAND = ("-m", "mkdocs", "build", "--strict", "-f")  # strict: a warning is an error
# factors of pages in the order of what the search finds: an option where it is explained, a word in the glossary
BOOSTS = {
    "examples/manual/OPTIONS.md": 12,
    "examples/manual/GLOSSARY.md": 12,
    "README.md": 8,
    "examples/lap/README.md": 5,
    "examples/joint/README.md": 5,
    "scripts/README.md": 3,
    "examples/study/README.md": 3,
    "examples/body/README.md": 3,
}
HIDDEN = "scripts/packaging/paper.md"  # from the search: it says briefly what all pages say
MANUAL_BOOST = 3
FENCE = re.compile(r"^```.*?^```$", re.M | re.S)
# the reference problems, in the order of their intervals
CASES = dict.fromkeys(row["case"] for row in json.loads((ROOT / "examples/reference/cases.json").read_text("utf-8")))
NOTEBOOKS = ("loop", "coating", "life", "joint", "lap", "blade-root", "measurements")
# the parts of the site and their pages in the order of work
PARTS = (
    ("petsam", ("README.md",)),
    (
        "First run",
        (
            "scripts/README.md",
            "examples/README.md",
            "examples/manual/GALLERY.md",
            "examples/manual/RESULTS.md",
            "examples/manual/ERRORS.md",
            "examples/manual/PICTURES.md",
            "examples/study/README.md",
            "examples/manual/LARGE.md",
            "examples/sphere/README.md",
            "examples/edges/README.md",
        ),
    ),
    (
        "From other programs",
        ("examples/manual/ABAQUS.md", "examples/manual/CONTACT.md", "examples/fe-comparison/README.md"),
    ),
    (
        "Loads",
        (
            "examples/manual/LOADS.md",
            "examples/manual/CHECKPOINTS.md",
            "examples/manual/HEAT.md",
            "examples/manual/MEASUREMENTS.md",
            "examples/fretting-loop/README.md",
            "examples/pad/README.md",
            "examples/dovetail/README.md",
            "examples/rolling/README.md",
            "examples/heat/README.md",
            "examples/viscous/README.md",
            "examples/gradient/README.md",
            "examples/wheel/README.md",
            "examples/creep/README.md",
        ),
    ),
    (
        "Surfaces and bodies",
        (
            "examples/manual/SURFACES.md",
            "examples/plane/README.md",
            "examples/punch/README.md",
            "examples/long-punch/README.md",
            "examples/dissimilar/README.md",
            "examples/coating/README.md",
            "examples/plastic/README.md",
            "examples/adhesion/README.md",
            "examples/body/README.md",
        ),
    ),
    (
        "Wear",
        (
            "examples/manual/WEAR.md",
            "examples/mccoll/README.md",
            "examples/wear-gross-slip/README.md",
            "examples/wear-popov/README.md",
            "examples/wear-punch/README.md",
        ),
    ),
    ("Stresses and fatigue", ("examples/manual/STRESSES.md", "examples/stress/README.md")),
    (
        "Joints",
        (
            "examples/lap/README.md",
            "examples/joint/README.md",
            "examples/damper/README.md",
            "examples/vibrating-joint/README.md",
        ),
    ),
    (
        "Reference problems",
        (
            "examples/reference/README.md",
            "examples/reference/CREEP.md",
            *(f"examples/reference/cases/{case}.md" for case in CASES),
        ),
    ),
    ("Options and words", ("examples/manual/OPTIONS.md", "examples/manual/GLOSSARY.md")),
    ("Python", ("scripts/PYTHON.md", *(f"examples/notebooks/{one}.md" for one in NOTEBOOKS))),
    ("C and other programs", ("examples/embed/README.md", "include/FUNCTIONS.md")),
    (
        "Developing",
        (
            "src/README.md",
            "tests/README.md",
            "tests/trials/README.md",
            "tests/bench/README.md",
            "scripts/packaging/README.md",
            "scripts/packaging/paper.md",
            "CHANGES.md",
        ),
    ),
)
# pages that are no files of the repository
GENERATED = {"include/FUNCTIONS.md": functions.page, "scripts/PYTHON.md": modules.page}


def notebook_of(name):
    """Returns the notebook of a page, or None."""
    path = (ROOT / name).with_suffix(".ipynb")
    return path if path.parent.name == "notebooks" else None


def text_of(name):
    if notebook_of(name):
        return notebooks.page(notebook_of(name))[0]
    return GENERATED[name]() if name in GENERATED else (ROOT / name).read_text(encoding="utf-8")


def title_of(page):
    """Returns the title or the first heading of a page."""
    return re.search(r'^(?:# |title: )"?(.*?)"?$', text_of(page), re.M).group(1)


def navigation():
    """Returns MkDocs's list of pages: a part of one page is that page."""
    listed = []
    for title, names in PARTS:
        entries = [{title_of(name): name} for name in names]
        listed.append({title: names[0]} if len(names) == 1 else {title: entries})
    return listed


def pages():
    """Returns the paths of all pages, relative to the repository."""
    return [name for _, names in PARTS for name in names]


def copies():
    """Returns the files, besides the pages, that the pages name, without folders (their links become text)."""
    files = set()
    for name in pages():
        for link in LINK.findall(FENCE.sub("", text_of(name))):
            path = (ROOT / name).parent / link
            if not re.match(r"\w+:", link) and path.is_file() and path.suffix not in (".md", ".ipynb"):
                files.add(str(path.resolve().relative_to(ROOT)))
    return files


def boosted(name, text):
    """Returns a page's text with what the search makes of it in the lines before it."""
    boost = BOOSTS.get(name, MANUAL_BOOST if name.startswith("examples/manual/") else 1)
    lines = f"---\nsearch:\n  {'exclude: true' if name == HIDDEN else f'boost: {boost}'}\n"
    return lines + (text[4:] if text.startswith("---\n") else f"---\n\n{text}")


def page(name):
    """Returns a page's text with links to folders as text, since the site shows only pages and files, and links to the
    pages of notebooks."""
    text, parent = text_of(name).replace(".ipynb)", ".md)"), (ROOT / name).parent

    def folder(match):
        return match.group(1) if (parent / match.group(2)).is_dir() else match.group(0)

    return re.sub(r"\[([^\]]*)\]\(([^)#\s]+)\)", folder, text)


def stage(target):
    """Writes all pages and files of the site to a folder."""
    shutil.rmtree(target, ignore_errors=True)
    for name in copies():
        (target / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / name, target / name)
    for name in pages():
        (target / name).parent.mkdir(parents=True, exist_ok=True)
        (target / name).write_text(boosted(name, page(name)), encoding="utf-8")
        for picture, data in notebooks.page(notebook_of(name))[1].items() if notebook_of(name) else ():
            (target / name).with_name(picture).write_bytes(data)


def version():
    numbers = re.findall(r"define SAM_VERSION_(?:MAJOR|MINOR|SUBMINOR) +(\d+)", text_of("include/petsam/base.h"))
    return ".".join(numbers)


def settings(folder, out, url):
    """Returns MkDocs's settings: those of mkdocs.yml, and the name, the address, the folders and the list of pages."""
    return {
        "INHERIT": str(MAINTAIN / "mkdocs.yml"),
        "site_name": f"petsam {version()}",  # the header and the title of every page
        "site_url": url,
        "docs_dir": str(folder),
        "site_dir": str(out),
        "theme": {"custom_dir": str(MAINTAIN / "theme")},
        "nav": navigation(),
    }


def address(text):
    """Reads the site's address for argparse; its last folder ends with a slash."""
    if text and not re.fullmatch(r"https?://[^\s/]+(/\S*)?", text):
        raise argparse.ArgumentTypeError(f"{text}: give an address such as https://example.org/petsam/")
    return text.rstrip("/") + "/" if text else ""


def main():
    reader = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    reader.add_argument("--pages", type=Path, default=ROOT / "build/site-pages", help="folder of the copies")
    reader.add_argument("--out", type=Path, default=ROOT / "build/site", help="folder of the site")
    reader.add_argument("--url", type=address, default="", help="address of the site (the top of a server)")
    options = reader.parse_args()
    folder, out = options.pages.resolve(), options.out.resolve()
    stage(folder)
    file = folder.with_suffix(".yml")
    file.write_text(yaml.safe_dump(settings(folder, out, options.url), allow_unicode=True, sort_keys=False), "utf-8")
    environment = {**os.environ, "NO_MKDOCS_2_WARNING": "1", "PYTHONPATH": str(MAINTAIN)}
    done = subprocess.run([sys.executable, *COMMAND, str(file)], check=False, env=environment)
    if done.returncode:
        sys.exit(f"site_pages.py: error: MkDocs ended with the warnings above: correct these pages ({done.returncode})")
    print(f"wrote {options.out}/index.html ({len(pages())} pages)")


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""Makes the site of petsam's pages by MkDocs and its theme Material: make site.

    python3 scripts/maintain/site_pages.py --pages build/site-pages --out build/site

The pages stay where they are and link to each other and to files of the repository relatively. They and the files that
they name are copied to the same places beside each other, and MkDocs checks every link: a link to no page, file or
heading is an error. README.md is the index of its folder. The page of the C library's functions is no file of the
repository: functions.py makes it from the headers. Material was chosen because its search needs no server, it fits a
phone, and it takes the pages as they are. Its fixes end in May 2027; its successor Zensical reads its settings.
"""

import argparse
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import functions
import yaml

ROOT = Path(__file__).resolve().parents[2]
MAINTAIN = Path(__file__).resolve().parent
LINK = re.compile(r"\]\(([^)#\s]+)(?:#[^)]*)?\)")
COMMAND = ("-m", "mkdocs", "build", "--strict", "-f")  # strict: a warning is an error
FENCE = re.compile(r"^```.*?^```$", re.M | re.S)
# the parts of the site in their order: title, first page, others
PARTS = (
    ("petsam", "README.md", ()),
    ("Manual", "examples/README.md", ("examples/manual/*.md",)),
    ("Examples", None, ("examples/*/README.md",)),
    ("Tools and Python", "scripts/README.md", ("scripts/*/*.md",)),
    ("C library", "include/FUNCTIONS.md", ()),
    ("Method and sources", "src/README.md", ()),
    ("Tests and performance", "tests/README.md", ("tests/*/README.md",)),
    ("Changes", "CHANGES.md", ()),
)
# pages that are no files of the repository
GENERATED = {"include/FUNCTIONS.md": functions.page}


def text_of(name):
    return GENERATED[name]() if name in GENERATED else (ROOT / name).read_text(encoding="utf-8")


def pages():
    """Returns the paths of all pages, relative to the repository, part by part: [(title, [page, ...])]."""
    parts = []
    for title, first, others in PARTS:
        found = [first] if first else []
        for pattern in others:
            found += sorted(str(path.relative_to(ROOT)) for path in ROOT.glob(pattern))
        parts.append((title, list(dict.fromkeys(found))))
    return parts


def title_of(page):
    """Returns the title or the first heading of a page."""
    return re.search(r'^(?:# |title: )"?(.*?)"?$', text_of(page), re.M).group(1)


def navigation(parts):
    """Returns MkDocs's list of pages: the first page of a part represents it."""
    listed = []
    for title, names in parts:
        entries = [{title_of(name): name} for name in names]
        listed.append({title: names[0]} if len(names) == 1 else {title: entries})
    return listed


def copies(parts):
    """Returns the files, besides the pages, that the pages name, without folders (their links become text)."""
    files = set()
    for _, names in parts:
        for name in names:
            for link in LINK.findall(FENCE.sub("", text_of(name))):
                path = (ROOT / name).parent / link
                if not re.match(r"\w+:", link) and path.is_file() and path.suffix != ".md":
                    files.add(str(path.resolve().relative_to(ROOT)))
    return files


def page(name):
    """Returns a page's text with links to folders as text: the site shows only pages and files."""
    text, parent = text_of(name), (ROOT / name).parent

    def folder(match):
        return match.group(1) if (parent / match.group(2)).is_dir() else match.group(0)

    return re.sub(r"\[([^\]]*)\]\(([^)#\s]+)\)", folder, text)


def stage(target):
    """Writes all pages and files of the site to a folder; returns the parts."""
    shutil.rmtree(target, ignore_errors=True)
    parts = pages()
    for name in copies(parts):
        (target / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / name, target / name)
    for name in (name for _, names in parts for name in names):
        (target / name).parent.mkdir(parents=True, exist_ok=True)
        (target / name).write_text(page(name), encoding="utf-8")
    return parts


def main():
    reader = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    reader.add_argument("--pages", type=Path, default=ROOT / "build/site-pages", help="folder of the copies")
    reader.add_argument("--out", type=Path, default=ROOT / "build/site", help="folder of the site")
    options = reader.parse_args()
    parts = stage(options.pages.resolve())
    settings = options.pages.resolve().with_suffix(".yml")
    more = {"nav": navigation(parts), "docs_dir": str(options.pages.resolve()), "site_dir": str(options.out.resolve())}
    base = (MAINTAIN / "mkdocs.yml").read_text(encoding="utf-8")
    settings.write_text(base + yaml.safe_dump(more, allow_unicode=True, sort_keys=False), encoding="utf-8")
    environment = {**os.environ, "NO_MKDOCS_2_WARNING": "1", "PYTHONPATH": str(MAINTAIN)}
    done = subprocess.run([sys.executable, *COMMAND, str(settings)], check=False, env=environment)
    if done.returncode:
        sys.exit(f"site_pages.py: error: the links above lead nowhere ({done.returncode})")
    print(f"wrote {options.out}/index.html ({sum(len(names) for _, names in parts)} pages)")


if __name__ == "__main__":
    main()

"""`make site`: which pages and files it takes; MkDocs itself, which `make site` installs, checks its links."""

import re
import sys

import pytest

from support import ROOT

sys.path.insert(0, str(ROOT / "scripts" / "maintain"))
import site_pages  # noqa: E402


@pytest.fixture(scope="module")
def staged(tmp_path_factory):
    target = tmp_path_factory.mktemp("site")
    return target, site_pages.stage(target)


def test_every_page_is_on_the_site_once(staged):
    _, parts = staged
    listed = [name for _, names in parts for name in names]
    folders = ("examples", "include", "scripts", "src", "tests")
    there = {str(path.relative_to(ROOT)) for folder in folders for path in ROOT.glob(f"{folder}/**/*.md")}
    assert sorted(listed) == sorted(there | {"README.md", "CHANGES.md", "include/FUNCTIONS.md"})


def test_page_of_functions_is_made_from_the_headers(staged):
    target, parts = staged
    assert dict(parts)["C library"] == ["include/FUNCTIONS.md"]
    assert "### SamNormalSolve\n" in (target / "include/FUNCTIONS.md").read_text()
    assert not (ROOT / "include/FUNCTIONS.md").exists()


def test_pages_and_files_lie_as_in_the_repository_so_that_their_links_hold(staged):
    target, parts = staged
    for name in (name for _, names in parts for name in names):
        text = re.sub(r"^```.*?^```$", "", (target / name).read_text(), flags=re.M | re.S)
        for link in re.findall(r"\]\(([^)#\s]+)", text):
            assert re.match(r"https?:", link) or ((target / name).parent / link).is_file(), (name, link)


def test_dead_links_end_the_build():
    settings = (ROOT / "scripts/maintain/mkdocs.yml").read_text()
    for kind in ("not_found", "anchors", "absolute_links", "unrecognized_links"):
        assert re.search(rf"^validation: .*\b{kind}: warn\b", settings, re.M)
    # --quiet would hide warnings from --strict
    assert "--strict" in site_pages.COMMAND and "--quiet" not in site_pages.COMMAND

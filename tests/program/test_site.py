"""`make site`: which pages and files it takes; MkDocs itself, which `make site` installs, checks its links."""

import argparse
import inspect
import json
import re
import shutil
import subprocess
import sys

import pytest

from support import ROOT

sys.path.insert(0, str(ROOT / "scripts" / "maintain"))
import modules  # noqa: E402
import site_pages  # noqa: E402

OPTIONS = ROOT / "scripts/maintain/theme/javascripts/options.js"
# what is typed, and what Material's search then gets
QUERIES = {
    "-wear_rtol": "wear_rtol",
    "petsam -grid_n": "petsam grid_n",
    "--fretting-log": "+fretting +log",
    "--maps --at 0,0": "maps at 0,0",
    "stick-slip wear": "stick-slip wear",
}


@pytest.fixture(scope="module")
def staged(tmp_path_factory):
    target = tmp_path_factory.mktemp("site")
    site_pages.stage(target)
    return target


def test_every_page_is_on_the_site_once():
    folders = ("examples", "include", "scripts", "src", "tests")
    there = {str(path.relative_to(ROOT)) for folder in folders for path in ROOT.glob(f"{folder}/**/*.md")}
    there |= {str(path.relative_to(ROOT).with_suffix(".md")) for path in ROOT.glob("examples/notebooks/*.ipynb")}
    assert sorted(site_pages.pages()) == sorted(there | {"README.md", "CHANGES.md", *site_pages.GENERATED})


def test_notebooks_are_pages_with_what_they_store(staged):
    text = (staged / "examples/notebooks/loop.md").read_text()
    assert "\n# A fretting loop\n" in text and "```python\nimport petsam\n" in text and "```text\npetsam 13." in text
    for name in re.findall(r"\]\((loop-[0-9]+\.png)\)", text):
        assert (staged / "examples/notebooks" / name).read_bytes().startswith(b"\x89PNG")
    assert text.count(".png)") == 2 and "(../notebooks/loop.md)" in (staged / "examples/manual/RESULTS.md").read_text()


def test_pages_are_in_the_order_of_work():
    order = (
        "examples/README.md",
        *(f"examples/manual/{name}.md" for name in ("LOADS", "SURFACES", "WEAR", "STRESSES")),
    )
    order += ("examples/joint/README.md", "examples/manual/OPTIONS.md", "scripts/PYTHON.md", "include/FUNCTIONS.md")
    places = [site_pages.pages().index(name) for name in (*order, "src/README.md")]
    assert places == sorted(places)
    listed = site_pages.navigation()
    assert listed[0] == {"petsam": "README.md"} and listed[1]["First run"][1] == {
        "Tutorial and examples": "examples/README.md"
    }


def test_pages_of_the_references_are_made_from_the_sources(staged):
    assert "### SamNormalSolve\n" in (staged / "include/FUNCTIONS.md").read_text()
    python = (staged / "scripts/PYTHON.md").read_text()
    assert "#### Contact.try_step\n" in python and "\n- `ranks` (int): Number of MPI ranks; more than 1" in python
    assert not any((ROOT / name).exists() for name in site_pages.GENERATED)


def test_reference_has_every_name_of_the_package():
    import petsam

    text = modules.page()
    names = set(petsam.__all__) - {*petsam._PARTS}
    assert len(names) > 10 and {name for name in names if f"\n### petsam.{name}\n" not in text} == set()
    assert "\n```python\nContact.commit()\n```\n" in text and "\n```python\nCycles.energies\n```\n" in text
    assert "\n### petsam.closed.sphere.hertz_pressure\n" in text and "petsam.closed.sphere._" not in text


def test_public_names_of_the_package_have_docstrings():
    assert modules.undocumented() == []


def test_public_names_of_the_package_have_hints_and_sections():
    parts = [names for _, names in modules.listed().values()]
    lacks = [lack for names in parts for name, node in names.items() for lack in modules.unhinted(name, node)]
    assert len(parts) > 10 and not lacks, "\n".join(lacks)


def test_help_shows_each_keyword_once_as_the_reference_does():
    import petsam

    pictures = modules.chosen(petsam.plot.PART, {"pictures": petsam.plot.PART.names["pictures"]})
    parts = modules.public("apps.joint.interfaces")
    joints = {name: parts[name] for name in ("interface", "of_interface", "of_windows")}
    for name, node in {**pictures, **joints}.items():
        public = getattr(petsam.plot if name in pictures else petsam.joint, name)
        text, shown = inspect.getdoc(public), list(inspect.signature(public).parameters)
        assert text == modules.ast.get_docstring(node) and shown == [arg.arg for arg in modules.parameters(node.args)]
        heads = re.findall(r"^\*{0,2}(\w[\w, ]*?)(?: : .*)?$", text.partition("Returns")[0].partition("---\n")[2], re.M)
        assert [one for head in heads for one in head.split(", ")] == shown, name
        with pytest.raises(TypeError, match="unexpected keyword argument 'look'|'ways'"):
            public("a.h5", look=3, ways=3)


def test_classes_of_values_are_explained_with_the_function_that_returns_them():
    text = modules.page()
    for name, home in (("closed.sphere.Hertz", "closed.sphere.hertz"), ("fit.Record", "fit.read")):
        explained = re.split(r"\n###+ ", text.split(f"\n### petsam.{home}\n")[1])[0]
        assert f"\n### petsam.{name}\n" not in text and f"\n**{name.rpartition('.')[2]}**\n" in explained
    assert "- `radius` (float): Contact radius" in text and "\n- `shares`: " in text  # an attribute, and a property
    assert "\n### petsam.closed.sphere.lubkin_shear\n" not in text and "\n#### Spheres.torsion_shear\n" in text


@pytest.mark.parametrize(
    "source, made",
    [
        ("class A:\n    x: int\ndef f() -> A: pass\ndef g() -> list[A]: pass", {"A": "f"}),
        ("class A:\n    x: int\nclass B:\n    def g(self) -> 'A': pass", {"A": "B.g"}),
        ("class A:\n    @property\n    def x(self) -> int: pass\ndef f() -> A: pass", {"A": "f"}),
        ("class A:\n    def table(self) -> list: pass\ndef f() -> A: pass", {"A": "f"}),
        ("class A:\n    def close(self) -> None: pass\ndef f() -> A: pass", {}),
        ("class A:\n    @property\n    def half(self) -> 'A': pass", {}),
        ("class A:\n    x: int\ndef f(a: A) -> None: pass", {}),
    ],
)
def test_a_class_of_values_is_found_by_what_returns_it(source, made):
    assert modules.returned(modules.definitions(modules.ast.parse(source))) == made


PARAMETER = "\n\n    Parameters\n    ----------\n    x : float\n        Length, m.\n    "


@pytest.mark.parametrize(
    "source, lack",
    [
        (f'def f(x) -> None:\n    """One.{PARAMETER}"""', "hint"),
        ('def f(x: float) -> None:\n    """One."""', "Parameters"),
        ('def f() -> float:\n    """One."""', "Returns"),
        (f'def f(x: float):\n    """One.{PARAMETER}"""', "returns"),
        ('class f:\n    """One."""\n\n    def __init__(self, **x) -> None:\n        pass', "x"),
        ('class f:\n    """One."""\n\n    def g(self, *, x: float) -> None:\n        """One."""', "Parameters"),
    ],
)
def test_missing_hints_and_sections_are_found(source, lack):
    found = modules.unhinted("f", modules.ast.parse(source).body[0])
    assert found and lack in found[0], found


def test_classes_on_the_page_have_the_methods_of_their_bases():
    text = modules.page()
    for name in ("Results.of_step", "Results.field", "Results.quantity", "Results.nearest", "Stresses.nearest"):
        assert f"\n#### {name}\n" in text, name
    assert "\n```python\nStresses.field(name: str, index: int=-1, " in text and "Results.between(first: " in text
    assert "petsam.plot.life(*files: Results, xlim: Span=None, ylim: Span=None, width: " in text


def test_pages_and_files_lie_as_in_the_repository_so_that_their_links_hold(staged):
    for name in site_pages.pages():
        text = re.sub(r"^```.*?^```$", "", (staged / name).read_text(), flags=re.M | re.S)
        for link in re.findall(r"\]\(([^)#\s]+)", text):
            assert re.match(r"https?:", link) or ((staged / name).parent / link).is_file(), (name, link)


def test_the_version_is_in_the_name_that_every_page_shows():
    import petsam

    assert site_pages.settings(ROOT, ROOT, "")["site_name"] == f"petsam {petsam.__version__}"


def test_options_come_first_in_the_search_and_the_paper_is_not_found(staged):
    def boost(name):
        return float(re.match(r"---\nsearch:\n  boost: (.*)\n", (staged / name).read_text())[1])

    assert boost("examples/manual/OPTIONS.md") > boost("examples/manual/WEAR.md") > boost("examples/mccoll/README.md")
    paper = (staged / "scripts/packaging/paper.md").read_text()
    assert paper.startswith("---\nsearch:\n  exclude: true\n") and paper.count("\n---\n") == 1


def test_options_are_searched_without_their_dash():
    if not shutil.which("node"):
        pytest.skip("no node")
    code = (
        "const sent = []; class Worker { postMessage(message) { sent.push(message.data); } }\n"
        f"const document = {{ querySelector() {{}} }};\n{OPTIONS.read_text()}\n"
        f"for (const data of {json.dumps(list(QUERIES))}) new Worker().postMessage({{ type: 2, data }});\n"
        'new Worker().postMessage({ type: 0, data: "-as_it_is" }); console.log(JSON.stringify(sent));'
    )
    done = subprocess.run(["node", "-e", code], capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout) == [*QUERIES.values(), "-as_it_is"]


@pytest.mark.parametrize(
    "text, read", [("", ""), ("https://a.org/p", "https://a.org/p/"), ("http://a.org/", "http://a.org/")]
)
def test_address_of_the_site_ends_with_a_slash(text, read):
    assert site_pages.address(text) == read


def test_other_addresses_are_rejected():
    with pytest.raises(argparse.ArgumentTypeError, match="petsam: give an address such as"):
        site_pages.address("petsam")


def test_dead_links_end_the_build():
    settings = (ROOT / "scripts/maintain/mkdocs.yml").read_text()
    for kind in ("not_found", "anchors", "absolute_links", "unrecognized_links"):
        assert re.search(rf"^validation: .*\b{kind}: warn\b", settings, re.M)
    # --quiet would hide warnings from --strict
    assert "--strict" in site_pages.COMMAND and "--quiet" not in site_pages.COMMAND

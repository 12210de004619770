"""The packages in scripts/packaging, without their own tools: files, requirements, commands; the version anywhere."""

import re
import subprocess
import sys
import types

import pytest
import tomllib
import yaml

import petsam
from support import ROOT

FOLDER = ROOT / "scripts/packaging"
VERSION = ".".join(
    re.findall(r"define SAM_VERSION_(?:MAJOR|MINOR|SUBMINOR) +(\d+)", (ROOT / "include/petsam/base.h").read_text())
)
MAKEFILE = (ROOT / "Makefile").read_text()
LIBRARIES = [line.lower() for line in (ROOT / "scripts/requirements.txt").read_text().split()]
# what `make install` takes beside src, include, scripts and examples
MANUAL = re.search(r"^MANUAL := (.*)", MAKEFILE, re.M).group(1).split()


def valid(script, shell="sh"):
    """Whether the shell can read it."""
    return subprocess.run([shell, "-n"], input=script, text=True).returncode == 0


@pytest.mark.parametrize(
    "file, pattern",
    [
        ("CITATION.cff", r"^version: (.*)$"),
        ("CHANGES.md", r"^## ([\d.]+)"),
        ("scripts/packaging/petsam.def", r"^ +version (.*)$"),
        ("scripts/packaging/package.py", r'version\("([\d.]+)"'),
        ("scripts/packaging/conda/meta.yaml", r"^  version: (.*)$"),
    ],
)
def test_every_file_tells_the_version_of_the_headers(file, pattern):
    assert re.search(pattern, (ROOT / file).read_text(), re.M).group(1) == VERSION


def test_the_Python_package_and_its_wheel_have_the_version_of_the_headers():
    assert petsam.__version__ == VERSION
    assert 'version = { attr = "petsam.core.version.__version__" }' in (ROOT / "scripts/pyproject.toml").read_text()


def test_the_Python_package_takes_along_the_files_beside_its_modules():
    data = tomllib.loads((ROOT / "scripts/pyproject.toml").read_text())["tool"]["setuptools"]["package-data"]
    taken = {f"{package.replace('.', '/')}/{name}" for package, names in data.items() for name in names}
    files = [path.relative_to(ROOT / "scripts") for path in (ROOT / "scripts/petsam").rglob("*") if path.is_file()]
    assert {str(path) for path in files if path.suffix not in (".py", ".pyc")} == taken


def test_CITATION_has_what_a_citation_needs_and_README_tells_of_it():
    known = yaml.safe_load((ROOT / "CITATION.cff").read_text())
    assert {"cff-version", "message", "title", "version", "license", "authors"} <= set(known)


def test_the_list_of_changes_is_short():
    lines = (ROOT / "CHANGES.md").read_text().splitlines()
    assert len(lines) <= 60 and max(map(len, lines)) <= 120


def test_every_package_is_in_the_table_with_how_far_it_was_tried():
    rows = re.findall(r"^\| `([^`]+)` \|.*\| (.+) \|$", (FOLDER / "README.md").read_text(), re.M)
    there = {
        path.name + "/" * path.is_dir() for path in FOLDER.iterdir() if path.name not in ("README.md", "__pycache__")
    }
    assert {name for name, _ in rows} == there


def test_the_script_of_the_wheels_libraries_can_be_read_by_the_shell():
    assert valid((FOLDER / "wheel-libraries.sh").read_text())


def test_the_job_of_the_wheel_tries_all_Pythons_that_the_package_takes():
    job = yaml.safe_load((FOLDER / "wheel-job.yml").read_text())
    pythons = job["jobs"]["try"]["strategy"]["matrix"]["python"]
    oldest = tomllib.loads((ROOT / "scripts/pyproject.toml").read_text())["project"]["requires-python"]
    assert oldest == f">={pythons[0]}" and pythons[-1] == "3.14" and len(pythons) == 6
    lines = [step["run"] for part in job["jobs"].values() for step in part["steps"] if "run" in step]
    assert lines and all(valid(re.sub(r"\${{.*?}}", "word", line)) for line in lines)
    assert "make wheel" in " ".join(lines).replace('-j"$(nproc)" ', "")


def test_containers_are_built_from_files_that_exist():
    text = (FOLDER / "Containerfile").read_text()
    build, run = text.replace("\\\n", "").split("\nFROM ")[1:]
    sources = {word for line in re.findall(r"^COPY (?!--)(.*)$", build, re.M) for word in line.split()[:-1]}
    assert {"Makefile", "LICENSE", "CITATION.cff", "src", "include", "scripts"} <= sources
    assert all((ROOT / source).exists() for source in sources)
    for commands in (build, run):
        assert all(valid(command) for command in re.findall(r"^RUN (.*)$", commands, re.M))


def test_conda_recipe_asks_for_what_makefile_and_scripts_need():
    text = re.sub(r"{{ *(\w+)\('c'\) *}}", r"\1_c", (FOLDER / "conda/meta.yaml").read_text())
    recipe = yaml.safe_load(text)
    names = {part: {line.split()[0] for line in lines} for part, lines in recipe["requirements"].items()}
    assert {"compiler_c", "make", "pkg-config"} <= names["build"]
    assert {"openmpi", "petsc", "fftw", "hdf5"} <= names["host"] & names["run"]
    wanted = {line.replace("matplotlib", "matplotlib-base") for line in LIBRARIES}
    assert wanted <= {line.replace(" ", "") for line in recipe["requirements"]["run"]}
    assert (FOLDER / "conda" / recipe["source"]["path"]).resolve() == ROOT
    script = (FOLDER / "conda/build.sh").read_text()
    assert valid(script, "bash")
    for name in re.findall(r"^words=\((.*)\)", script, re.M)[0].split(" "):
        if "=" in name and name[0] != "-":
            assert re.search(rf"\b{name.split('=')[0]}\b", MAKEFILE), name


def test_apptainer_definition_names_files_that_exist_and_this_version():
    text = (FOLDER / "petsam.def").read_text()
    sections = dict(re.findall(r"^%(\w+)\n((?:    .*\n|\n)*)", text, re.M))
    assert {"files", "post", "runscript", "test", "labels", "help"} <= set(sections)
    sources = [line.split()[0] for line in sections["files"].splitlines() if line.strip()]
    for source in sources:
        assert (ROOT / source).exists(), source
    # all that the build and the scripts need is taken along
    assert {"Makefile", "LICENSE", "CITATION.cff", "src", "include", "scripts", "examples"} <= set(sources)
    assert all(any(file == source or file.startswith(source + "/") for source in sources) for file in MANUAL)
    assert valid(sections["post"])


def test_spack_recipe_asks_for_what_makefile_and_scripts_need(monkeypatch):
    depends, versions = [], []

    class Any:
        def __enter__(self):
            return self

        def __exit__(self, *_):
            return False

    package = types.ModuleType("spack.package")
    package.depends_on = lambda spec, **_: depends.append(spec)
    package.version = lambda name, **_: versions.append(name)
    package.variant = package.license = lambda *_, **__: None
    package.when = lambda _: Any()
    makefile = types.ModuleType("makefile")
    makefile.MakefilePackage = object
    for name in ("spack", "spack_repo", "spack_repo.builtin", "spack_repo.builtin.build_systems"):
        monkeypatch.setitem(sys.modules, name, types.ModuleType(name))
    monkeypatch.setitem(sys.modules, "spack.package", package)
    monkeypatch.setitem(sys.modules, "spack_repo.builtin.build_systems.makefile", makefile)
    names = {}
    exec((FOLDER / "package.py").read_text(), names)  # pylint: disable=exec-used
    assert VERSION in versions
    packages = {re.match(r"[\w-]+", spec).group(0) for spec in depends}
    assert {"mpi", "petsc", "fftw", "hdf5", "pkgconfig", "cmocka", "python"} <= packages
    libraries = {re.match(r"\w+", line).group(0) for line in LIBRARIES}
    assert {name[3:] for name in packages if name.startswith("py-")} == libraries - {"pytest"}
    recipe = names["Petsam"]()
    recipe.prefix = "/opt/petsam"
    recipe.spec = {"mpi": types.SimpleNamespace(mpicc="/opt/bin/mpicc")}
    for word in recipe.build_targets + recipe.install_targets:
        name, _, value = word.partition("=")
        # variables and targets that the Makefile knows
        assert re.search(rf"^ *{name} *[:?]?=" if value else rf"^{name}:", MAKEFILE, re.M), word


def test_all_parts_of_the_package_are_installed():
    """setuptools finds them: each folder of modules is a package."""
    found = tomllib.loads((ROOT / "scripts/pyproject.toml").read_text())["tool"]["setuptools"]["packages"]["find"]
    assert found == {"include": ["petsam*"]}
    folders = {path.parent for path in (ROOT / "scripts/petsam").rglob("*.py")}
    assert len(folders) > 10 and all((folder / "__init__.py").exists() for folder in folders)

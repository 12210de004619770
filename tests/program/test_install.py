"""`make install` puts in place what a user of the program and of the library needs, and it works from there."""

import json
import os
import re
import subprocess
import sys

import pytest

from conftest import PROGRAM, environment, make_install
from support import ROOT, Results, closed, dead_links, finished

BUILD = PROGRAM.parents[1]
CONTACT = dict(radius=0.1, e_star=210e9 / (2 * (1 - 0.3**2)), load=1000.0)  # examples/embed/library/contact.c


@pytest.fixture(scope="module")
def prefix(tmp_path_factory):
    prefix = tmp_path_factory.mktemp("install") / "petsam"
    make_install(f"prefix={prefix}")
    return prefix


def files(folder):
    return {str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file()}


def test_all_that_users_need_is_installed(prefix):
    installed = files(prefix)
    assert {
        "bin/petsam",
        "lib/libpetsam.a",
        "lib/petsam/petsam-examine",
        "lib/libpetsam.so",
        "lib/pkgconfig/petsam.pc",
        "include/petsam.h",
        "share/petsam/README.md",
        "share/petsam/LICENSE",
        "share/man/man1/petsam.1",
        "share/man/man1/petsam-stress.1",
        *(f"share/man/man1/{path.name}.1" for path in (ROOT / "scripts").glob("petsam-*")),
        "share/bash-completion/completions/petsam",
        "share/bash-completion/completions/petsam-plot",
    } <= installed
    for folder, place in (("include", "include"), ("examples", "share/petsam/examples")):
        names = {name for name in files(ROOT / folder) if "__pycache__" not in name}
        wanted = {f"{place}/{name}" for name in names}
        assert wanted <= installed, wanted - installed
    assert (
        "share/petsam/scripts/petsam/results/file.py" in installed
        and "share/petsam/scripts/requirements.txt" in installed
    )


def test_links_of_the_manual_work_where_it_is_installed(prefix):
    manual = [*(prefix / "share/petsam").rglob("*.md")]
    assert len(manual) > 20 and {str(file): dead_links(file) for file in manual if dead_links(file)} == {}


def test_what_only_developers_need_is_not_installed(prefix):
    assert not [name for name in files(prefix) if "maintain/" in name or "__pycache__" in name or name.endswith(".o")]


def test_headers_for_those_who_add_types_lie_apart(prefix):
    private = [name for name in files(prefix) if name.endswith("impl.h")]
    assert "include/petsam/private/gapimpl.h" in private and "include/petsam/private/solverimpl.h" in private
    assert all(name.startswith("include/petsam/private/") for name in private)


def test_DESTDIR_is_before_the_prefix_and_not_in_the_files(tmp_path, prefix):
    make_install("prefix=/opt/petsam", f"DESTDIR={tmp_path}/stage")
    stage = tmp_path / "stage" / "opt" / "petsam"
    assert files(stage) == files(prefix)
    text = (stage / "lib/pkgconfig/petsam.pc").read_text()
    assert re.search(r"^prefix=/opt/petsam$", text, re.M) and str(tmp_path) not in text


def test_installed_program_runs(prefix, tmp_path):
    done = subprocess.run(
        [str(prefix / "bin/petsam"), "--version"], capture_output=True, text=True, cwd=tmp_path, env=environment()
    )
    assert done.returncode == 0 and done.stdout.startswith("petsam ")


# ---- the library


def pkg_config(prefix, *words):
    """With the PETSc that petsam was built with, which may not be the system's."""
    petsc = os.environ.get("PETSC_DIR")
    paths = [str(prefix / "lib/pkgconfig")] + (
        [f"{petsc}/{os.environ.get('PETSC_ARCH', '')}/lib/pkgconfig", f"{petsc}/lib/pkgconfig"] if petsc else []
    )
    env = {**os.environ, "PKG_CONFIG_PATH": ":".join(paths)}
    return finished(["pkg-config", *words, "petsam"], env=env).stdout.split()


def library_flags(prefix, kind):
    rpath = [f"-Wl,-rpath,{prefix / 'lib'}"] + (
        [
            f"-Wl,-rpath,{os.environ['PETSC_DIR']}/{os.environ.get('PETSC_ARCH', '')}/lib",
            f"-Wl,-rpath,{os.environ['PETSC_DIR']}/lib",
        ]
        if os.environ.get("PETSC_DIR")
        else []
    )
    if kind == "shared":
        return pkg_config(prefix, "--libs") + rpath
    flags = pkg_config(prefix, "--static", "--libs")
    return [str(prefix / "lib/libpetsam.a") if flag == "-lpetsam" else flag for flag in flags] + rpath


# the same in C++, with every header that is installed
CPP = """
#include <petsam.h>
#include <petsam/embed.h>
{headers}
#if !(SAM_VERSION_GE({version}) && SAM_VERSION_EQ({version}) && !SAM_VERSION_LT({version}) && SAM_VERSION_GT(0, 0, 999))
#error SAM_VERSION
#endif
#include "{source}"
"""


@pytest.mark.parametrize("kind", ["shared", "static", "C++"])
def test_program_on_the_installed_library_solves_a_contact(prefix, tmp_path, launcher, kind):
    """examples/embed/library/contact.c, with nothing of the sources in reach."""
    source = prefix / "share/petsam/examples/embed/library/contact.c"
    compiler = ["mpicc", "-std=c11"]
    if kind == "C++":
        headers = "\n".join(
            f"#include <{path.relative_to(prefix / 'include')}>" for path in prefix.rglob("include/**/*.h")
        )
        version = (prefix / "lib/libpetsam.so").resolve().name.split(".so.")[1].replace(".", ", ")
        text = CPP.format(headers=headers, version=version, source=source)
        compiler, source = ["mpicxx", "-std=c++11"], tmp_path / "contact.cpp"
        source.write_text(text)
    command = [
        *compiler,
        "-Wall",
        "-Werror",
        str(source),
        "-o",
        str(tmp_path / "contact"),
        *pkg_config(prefix, "--cflags"),
        *library_flags(prefix, "static" if kind == "static" else "shared"),
    ]
    finished(command)
    for ranks in (1, 2):
        words = (launcher + ["-n", str(ranks)] if ranks > 1 else []) + [str(tmp_path / "contact")]
        text = subprocess.run(words, capture_output=True, text=True, env=environment(), timeout=120).stdout
        status, approach, tangential = re.fullmatch(
            r"status (\d), approach (\S+) m, tangential displacement (\S+) m\n", text
        ).groups()
        hertz = closed.hertz(CONTACT["load"], CONTACT["radius"], CONTACT["e_star"])
        assert status == "0"
        # the grid's error at 256 cells; that of the tangential displacement against the program's own
        assert float(approach) == pytest.approx(hertz.approach, rel=1e-4)
        assert float(tangential) == pytest.approx(4.16312e-7, rel=1e-4)


@pytest.mark.parametrize("compiler", ["mpicc -std=c11", pytest.param("mpicxx -std=c++11", marks=pytest.mark.slow)])
def test_every_installed_header_stands_alone(prefix, tmp_path, compiler):
    """In C and in C++, without warnings: a header includes what it needs."""
    sources = []
    for k, header in enumerate(sorted((prefix / "include").rglob("*.h"))):
        sources.append(tmp_path / f"{k}.{'c' if compiler.startswith('mpicc') else 'cpp'}")
        sources[-1].write_text(f"#include <{header.relative_to(prefix / 'include')}>\n")
    assert len(sources) > 40
    command = [
        *compiler.split(),
        "-Wall",
        "-Wextra",
        "-Werror",
        "-fsyntax-only",
        *pkg_config(prefix, "--cflags"),
        *sources,
    ]
    finished(command)


def test_programs_need_the_library_by_the_version_of_its_interface(prefix):
    """libpetsam.so is for the linker; programs that were linked with another interface do not find their own."""
    name = re.search(
        r"SONAME +(\S+)",
        subprocess.run(["objdump", "-p", prefix / "lib/libpetsam.so"], capture_output=True, text=True).stdout,
    )
    version = re.search(r"^Version: (\d+)\.(\d+)", (prefix / "lib/pkgconfig/petsam.pc").read_text(), re.M)
    assert name.group(1) == "libpetsam.so.{}.{}".format(*version.groups())
    assert (prefix / "lib" / name.group(1)).resolve() == (prefix / "lib/libpetsam.so").resolve()


def test_shared_library_exports_only_what_headers_declare(prefix):
    """Under the version of the interface what public headers declare, of private ones the rest, without a promise."""
    done = subprocess.run(["nm", "-D", "--defined-only", prefix / "lib/libpetsam.so"], capture_output=True, text=True)
    names = [line.split()[-1].split("@@") for line in done.stdout.splitlines() if "@@" in line]

    def declared(pattern):
        text = "".join(path.read_text() for path in (prefix / "include").glob(pattern))
        return set(re.findall(r"\b(?:Sam|petsam_)\w+", text))

    public = {name for name, node in names if node == "PETSAM_1"}
    private = {name for name, node in names if node == "PETSAM_PRIVATE"}
    assert len(public) + len(private) == len(names) and 100 < len(public) <= 139
    assert public <= declared("petsam/*.h") and private <= declared("petsam/private/*.h")


# ---- the examples


def test_installed_example_runs_from_anywhere(prefix, tmp_path):
    """Its figures come from the installed scripts, its results go to where the user is."""
    env = {
        **environment(),
        "GRID_N": "48",
        "NP": "1",
        "LEVELS": "0.30 0.9",
        "PYTHON": sys.executable,
        "MPIRUN": os.environ.get("MPIRUN", "mpirun"),
    }
    env.pop("OUT", None)
    finished([str(prefix / "share/petsam/examples/sphere/run.sh")], cwd=tmp_path, env=env)
    assert any(path.suffix == ".png" for path in (tmp_path / "sphere").iterdir())
    assert Results(tmp_path / "sphere" / "hertz.h5").saved == 1
    drawn = json.loads((tmp_path / "sphere" / "errors.json").read_text())["torsion"]
    assert [case["torque_ratio"] for case in drawn] == pytest.approx([0.3, 0.9], rel=1e-5)


def test_what_the_manual_says_is_installed_is(prefix):
    """Folders named in the paragraph on installing."""
    text = re.search(r"`make install.*?\n\n", (ROOT / "scripts/README.md").read_text(), re.S).group()
    for place in re.findall(r"`((?:bin|lib|include|share)/[\w/.*-]*)`", text):
        assert list(prefix.glob(place.rstrip("/"))), place


def test_the_other_spelling_of_prefix_is_refused():
    run = subprocess.run(["make", "PREFIX=/opt/p", "install"], cwd=ROOT, capture_output=True, text=True, timeout=60)
    assert run.returncode and "PREFIX=/opt/p has no effect: write prefix=/opt/p" in run.stderr

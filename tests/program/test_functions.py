"""The comments of the C library's functions (scripts/maintain/functions.py) and docstrings; checks of arguments."""

import itertools
import re
import subprocess
import sys

import pytest

from conftest import PROGRAM
from support import ROOT

sys.path.insert(0, str(ROOT / "scripts" / "maintain"))
import check_words  # noqa: E402
import functions  # noqa: E402

GRID = ROOT / "include/petsam/grid.h"
SCRIPT = ROOT / "scripts/maintain/functions.py"


def check(*headers):
    return subprocess.run([sys.executable, SCRIPT, "--check", *headers], capture_output=True, text=True, timeout=60)


def test_every_function_has_a_complete_comment():
    done = check()
    assert done.returncode == 0, done.stdout


def test_every_exported_function_is_found():
    library = PROGRAM.parents[1] / "lib/libpetsam.so"
    done = subprocess.run(["nm", "-D", "--defined-only", library], capture_output=True, text=True)
    exported = {line.split()[-1].split("@@")[0] for line in done.stdout.splitlines() if " T " in line}
    private = {line.split()[-1].split("@@")[0] for line in done.stdout.splitlines() if "@@PETSAM_PRIVATE" in line}
    found = [function.name for path in functions.headers() for function in functions.read_functions(path)[0]]
    assert len(exported - private) > 100 and exported - private <= set(found)
    assert len(found) == len(set(found))


# of SamGridNorm(): its comment, the changed text, and the gap
GAPS = (
    ("/*\n  SamGridNorm - ", "/*\n  Computes: ", "has no comment above it that begins with 'SamGridNorm - '"),
    ("PETSC_EXTERN PetscErrorCode SamGridNorm", "\nPETSC_EXTERN PetscErrorCode SamGridNorm", "has no comment above it"),
    ("          type  - NORM_1 or NORM_2\n", "", "argument type is listed 0 times"),
    ("          type  - NORM_1", "          grid  - it\n          type  - NORM_1", "argument grid is listed 2 times"),
    ("          type  - NORM_1", "          kind  - NORM_1", "argument kind is listed, but does not exist"),
    ("  Collective.\n\n  In:     grid  - ", "  In:     grid  - ", "has no paragraph 'Collective' or 'Not collective'"),
    ("  Errors: PETSC_ERR_SUP for another type of norm.\n", "", "has no line 'Errors:'"),
    ("components (any unit)", "components", "argument field has no unit in parentheses"),
    ("the norm (unit of the field)", "the norm (see below)", "argument norm has no unit in parentheses"),
    ("column of cells (m).", "column of cells.", "SamGridX has in its first sentence no unit"),
)


@pytest.mark.parametrize(("old", "new", "gap"), GAPS, ids=[gap for _, _, gap in GAPS])
def test_gap_is_found_with_its_place(tmp_path, old, new, gap):
    text = GRID.read_text()
    start = text.index("/*\n  SamGridNorm - ")
    assert old in text[start:]
    header = tmp_path / "grid.h"
    header.write_text(text[:start] + text[start:].replace(old, new, 1))
    done = check(header)
    name = "SamGridX" if "SamGridX" in gap else "SamGridNorm"
    line = next(k for k, row in enumerate(header.read_text().split("\n"), 1) if re.match(rf"\w.* {name}\(", row))
    assert done.returncode == 1 and gap in done.stdout
    assert f"{header}:{line}: {name} " in done.stdout


REFERENCES = (
    ("SamGridNorm(), SamGridX()", "SamGridNorms(), SamGridX()", "refers to SamGridNorms(): expected another public"),
    ("SamGridNorm(), SamGridX()", "SamGridNorm, SamGridX()", "refers to SamGridNorm: expected another public"),
    ("SamGridNorm(), SamGridX()", "SamGridX(), SamGridX()", "refers to SamGridX(): expected another public"),
    ("SamGridNorm(), SamGridX()", "SamGridCreateVec(), SamGrid", "refers to SamGridCreateVec(): expected another"),
    ("SamGridNorm(), SamGridX()", "SamGrid, SamGridX(), SamGap, SamLaw", "refers to 5 names: expected 4 at most"),
    ("SamGapFill().\n", "SamGapFill()\n", "is no last line of the comment"),
    ("SamGapFill().\n", "SamGapFill().\n\n  More.\n", "is no last line of the comment"),
)


@pytest.mark.parametrize(("old", "new", "fault"), REFERENCES)
def test_reference_to_no_public_name_is_found(tmp_path, old, new, fault):
    """In "See also: SamGridNorm(), SamGridX(), SamGapFill()." of SamGridCreateVec()."""
    text = GRID.read_text()
    start = text.index("/*\n  SamGridCreateVec - ")
    assert old in text[start:]
    header = tmp_path / "grid.h"
    header.write_text(text[:start] + text[start:].replace(old, new, 1))
    done = check(header)
    assert done.returncode == 1 and fault in done.stdout


def test_references_are_many_and_on_the_page():
    assert len(re.findall(r"^  See also: ", HEADERS, re.M)) > 100
    assert {"SamGridNorm()", "SamContact", "SamNormalAsSolver()", "petsam_monitor"} <= functions.public_names(
        functions.headers()
    )
    assert "\nSee also: `SamGridNorm()`, `SamGridX()`, `SamGapFill()`.\n" in functions.page()


def test_function_without_arguments_says_so(tmp_path):
    header = tmp_path / "base.h"
    header.write_text((ROOT / "include/petsam/base.h").read_text().replace("  In: nothing.\n\n", ""))
    assert "SamFinalize has no paragraph 'In: nothing.'" in check(header).stdout


def test_casts_are_no_functions_to_describe():
    names = [function.name for function in functions.read_functions(ROOT / "include/petsam/normal.h")[0]]
    assert "SamNormalAsSolver" not in names and "SamNormalSolve" in names


def test_page_has_prototypes_arguments_and_paragraphs():
    page = functions.page()
    assert "## petsam/grid.h\n\nThe grid of rectangular cells" in page
    assert "PetscErrorCode SamGridNorm(SamGrid grid, Vec field, NormType type, PetscReal *norm);\n" in page
    assert "\n- In: `type`: NORM\\_1 or NORM\\_2\n- Out: `norm`: the norm (unit of the field)\n" in page
    assert "\nErrors: `PETSC_ERR_SUP` for another type of norm.\n" in page
    assert "\n    PetscErrorCode SamPluginRegister(void)\n```\n" in page
    assert "\n- Out: `load`: all six loads, given or found (N, N m)" in page
    assert 'without dash; `gap_` may be omitted: "radius1" for `-gap_radius1`\n' in page
    assert "PETSC_EXTERN" not in page and "PETSC_INTERN" not in page


# ---- checks of arguments, include/petsam/private/classes.h ----

HEADERS = "\n".join(path.read_text() for path in sorted((ROOT / "include/petsam").glob("*.h")))
CLASSES = set(re.findall(r"typedef struct _n_(\w+) +\*\1;", HEADERS))
POINTERS = set(re.findall(r"typedef const char +\*(\w+);|typedef PetscErrorCode \(\*(\w+)\)", HEADERS))
FILES = [path.read_text() for path in sorted((ROOT / "src").rglob("*.c"))]
SOURCES = "\n".join(FILES)
PUBLIC = [
    function
    for path in functions.headers()
    for function in functions.read_functions(path)[0]
    if function.type.strip() == "PetscErrorCode" and function.arguments
]


def definition(name):
    """Parameters and body of a function; those of a macro if a macro defines it."""
    found = re.search(rf"^PetscErrorCode {name}\(([^;{{}}]*?)\)\n\{{\n(.*?)^\}}", SOURCES, re.M | re.S)
    if not found:
        file = next(text for text in FILES if re.search(rf"^[A-Z]+\({name}, ", text, re.M))
        macro = re.search(rf"^([A-Z]+)\({name}, ", file, re.M)[1]
        lines = file[file.index(f"#define {macro}(") :].replace(" \\\n", "\n")
        found = re.search(r"PetscErrorCode Name\((.*?)\)\n  \{\n(.*?)^  \}", lines, re.M | re.S)
    return functions.split_arguments(found[1]), found[2]


def needed_checks(function, names):
    """The checks that the argument's types and the comment of a function ask for; `names` are those of the source."""
    texts = {name: text for _, name, text in functions.read_block(function.comment).entries}
    kinds = {kind for pair in POINTERS for kind in pair}
    checks = []
    for k, ((name, declaration), own) in enumerate(zip(function.arguments.items(), names), 1):
        kind, optional = declaration.split()[0], f"if ({own}) " if "NULL" in texts[name] else ""
        if function.name.endswith("Destroy"):
            kind = declaration.split(" *")[0]
            checks += [f"SamValidPointer({own}, 1);", f"SamValidHandle(*{own}, {kind}, 1);"]
        elif declaration == f"{kind} {name}" and kind in CLASSES | {"Vec"}:
            valid = f"SamValidVec({own}" if kind == "Vec" else f"SamValidHandle({own}, {kind}"
            checks.append(f"{optional}{valid}, {k});")
        elif not optional and (re.search(r"[*\[]", declaration) or kind in kinds):
            checks.append(f"SamValidPointer({own}, {k});")
    return checks


def missing_checks(needed, body):
    """Those of the checks that are not among the first statements."""
    statements = body.partition("PetscFunctionBegin;\n")[2].split("\n")
    first = itertools.takewhile(lambda line: re.match(r" *(?:if \(|SamValid|\})", line), statements)
    found = {line.strip() for line in first}
    return [check for check in needed if check not in found]


def test_classes_and_functions_are_found():
    assert {"SamContact", "SamGrid", "SamBody", "SamNormal"} <= CLASSES and len(PUBLIC) > 70
    ids = set(re.findall(r"(\w+)_CLASSID\b", (ROOT / "include/petsam/private/classes.h").read_text()))
    assert ids >= CLASSES


@pytest.mark.parametrize("function", PUBLIC, ids=[function.name for function in PUBLIC])
def test_function_checks_its_arguments_first(function):
    names, body = definition(function.name)
    needed = needed_checks(function, names)
    assert needed and not missing_checks(needed, body)
    for check in needed:  # one that is removed is missed
        without = re.sub(rf"^ *{re.escape(check)}\n", "", body, count=1, flags=re.M)
        assert missing_checks(needed, without) == [check]


# those with a communicator
ON_RANKS = CLASSES - {"SamBody", "SamPair", "SamConditions"} | {"Vec"}


def meeting(function):
    """The numbers of the arguments that are objects or vectors with a communicator."""
    kinds = [declaration.split() for declaration in function.arguments.values()]
    return [k for k, kind in enumerate(kinds, 1) if kind[0] in ON_RANKS and len(kind) == 2 and "*" not in kind[1]]


MEETINGS = [function for function in PUBLIC if len(meeting(function)) > 1]


@pytest.mark.parametrize("function", MEETINGS, ids=[function.name for function in MEETINGS])
def test_function_compares_the_communicators_of_its_arguments_first(function):
    first, *others = meeting(function)
    statements = definition(function.name)[1].partition("PetscFunctionBegin;\n")[2].split("\n")
    checks = "\n".join(itertools.takewhile(lambda line: re.match(r" *(?:if \(|SamValid|\})", line), statements))
    for other in others:
        assert re.search(rf"SamValid(?:SameComm|VecOn)\(.+, {first}, .+, {other}\);", checks)


def test_functions_with_two_objects_are_found():
    assert len(MEETINGS) == 14 and "SamProblemAddLaw" in [function.name for function in MEETINGS]


def test_objects_have_a_class_from_their_creation_to_their_end():
    for name in CLASSES - {"SamSolver", "SamNormal", "SamTangential"}:
        assert re.search(rf"class_id +(?:=.*)?= {name}_CLASSID;", SOURCES), name
    made = len(re.findall(r"class_id +(?:=.*)?= (?:Sam\w+_CLASSID|kind->class_id);", SOURCES))
    assert len(re.findall(r"class_id = SAM_CLASSID_NONE;", SOURCES)) == made == len(CLASSES) - 2


@pytest.mark.parametrize("begin", ["What", "Whether", "Those", "Of", "Which"])
def test_docstring_begins_with_a_plain_sentence(begin):
    names = (f"{begin} is meant.", f'"{begin}" as a word.', f"{begin}ever is meant.", f"Returns {begin}.")
    for head in ("", "class A:\n    ", "async def f():\n    ", "class A:\n    def f(self):\n        "):
        texts = [f'{head}"""{name}\n\n{begin} comes later."""\n' for name in names]
        found = [check_words.findings("scripts/petsam/core/words.py", text) for text in texts]
        assert found == [[(head.count("\n") + 1, names[0], check_words.PLAIN)], [], [], []]
    assert not check_words.findings("tests/program/test_words.py", texts[0])

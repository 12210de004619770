"""The comments of the C library's functions (scripts/maintain/functions.py): complete, and gaps in them are found."""

import subprocess
import sys

import pytest

from conftest import PROGRAM
from support import ROOT

sys.path.insert(0, str(ROOT / "scripts" / "maintain"))
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
    line = next(k for k, row in enumerate(header.read_text().split("\n"), 1) if f" {name}(" in row)
    assert done.returncode == 1 and gap in done.stdout
    assert f"{header}:{line}: {name} " in done.stdout


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

"""What holds for every capability: ranks without cells change nothing, nor does a restart between two steps."""

import sys

import h5py
import numpy as np

import capabilities
from support import ROOT, few, finished

CASES = [(plane, name) for plane in (True, False) for name in capabilities.cases(plane)]


def read(name):
    """All datasets of a results file."""
    found = {}
    with h5py.File(name) as file:
        file.visititems(lambda at, item: found.update({at: item[()]}) if isinstance(item, h5py.Dataset) else None)
    return found


def assert_same_bits(one, many):
    one, many = read(one), read(many)
    assert len(one) > 20 and set(one) == set(many)
    for name, values in one.items():
        assert np.array_equal(values, many[name], equal_nan=values.dtype.kind == "f"), name


@few("plane, name", CASES, 8)
def test_ranks_without_cells_change_nothing(petsam, tmp_path, plane, name):
    """A row of cells is on one rank; 3 rows on 4 ranks leave one without. A decision by a rank's own data hangs."""
    case = capabilities.write(plane, *capabilities.cases(plane)[name], tmp_path)
    ranks = 2 if plane else 4
    codes = {petsam(case, dict(output=f"{n}.h5"), ranks=n, check=None).code for n in (1, ranks)}
    assert codes == {0}
    assert_same_bits(tmp_path / "1.h5", tmp_path / f"{ranks}.h5")


@few("plane, name", CASES, 8)
def test_restart_changes_no_number(petsam, tmp_path, plane, name):
    """From the checkpoint before the last step, to the last bit: numbers of steps, fields, accumulated fields.

    Warnings are those of the steps since.
    """
    case = capabilities.write(plane, *capabilities.cases(plane)[name], tmp_path)
    petsam(case, dict(output="whole.h5", checkpoint="c.h5", checkpoint_every=1))
    petsam(case, dict(output="rest.h5", restart="c.h5.1"))
    whole, rest = read(tmp_path / "whole.h5"), read(tmp_path / "rest.h5")
    compared = [
        at for at in rest if rest[at].ndim and len(rest[at]) and at not in ("x", "y", "warnings") and "edge" not in at
    ]
    assert len(compared) > 20 and {at for at in whole if at.startswith("history/") and "edge" not in at} <= set(
        compared
    )
    for at in compared:
        assert np.array_equal(whole[at][-1], rest[at][-1], equal_nan=rest[at].dtype.kind == "f"), at


def test_decisions_by_a_ranks_own_data_are_found(tmp_path):
    """An array that a rank without cells does not have, a member of a structure, a return before the others."""
    script, source = ROOT / "scripts" / "maintain" / "check_ranks.py", tmp_path / "own.c"
    own = "struct S {\n  double *kept;\n};\nstatic PetscErrorCode F(struct S *s, const double e[], PetscBool all)\n{\n"
    for line, found in (
        ("  if (!s->kept) PetscCall(Reduce(s));", "kept"),
        ("  if (!e) PetscFunctionReturn(0);\n  PetscCall(Reduce(s));", "e"),
        ("  if (all && e) {\n    PetscCall(Reduce(s));\n  }", "e"),
        ("  PetscCall(Reduce(s, e ? s : NULL));", "e"),
        ("  if (all) PetscCall(Reduce(s));\n  if (e) PetscCall(PetscFree(s->kept));", None),
    ):
        source.write_text(own + line + "\n  PetscFunctionReturn(0);\n}\n")
        done = finished([sys.executable, script, source], check=1 if found else 0)
        assert (f"rank's `{found}`" if found else "") in done.stdout and bool(done.stdout) == bool(found)
    finished([sys.executable, script])

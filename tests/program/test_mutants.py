"""The lists of mutants belong to the sources as they are."""

import sys

from support import ROOT

sys.path.insert(0, str(ROOT / "tests" / "mutants"))
import check  # noqa: E402


def test_entries_fit_the_sources_and_name_tests_that_exist():
    mutants = check.all_mutants()
    assert len(mutants) > 600 and check.misfits(mutants) == []


def test_entries_that_do_not_fit_are_told():
    mutant = check.all_mutants()[0]
    assert (
        len(check.misfits([mutant._replace(old="no such line"), mutant._replace(tests=("test_none.py::test_x",))])) == 2
    )

"""Plane strain against dense matrices in numpy: problems of tests/fuzz/plane.py."""

import importlib.util

from conftest import PROGRAM
from support import ROOT, few

spec = importlib.util.spec_from_file_location("random_plane", ROOT / "tests/fuzz/plane.py")
problems = importlib.util.module_from_spec(spec)
spec.loader.exec_module(problems)


@few("seed", range(1, 31), 8)
def test_random_problem(seed):
    _, _, wrong, line = problems.trial(PROGRAM, seed)
    assert not wrong, line

"""Plane strain against dense matrices in numpy: problems of kinds/plane.py."""

from kinds import plane
from support import few


@few("seed", range(1, 31), 8)
def test_random_problem(seed, tmp_path):
    outcome = plane.trial(seed, tmp_path)
    assert not outcome.fault, outcome.text

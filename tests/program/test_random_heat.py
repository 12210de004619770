"""Frictional heat against direct summation in numpy: problems of kinds/heat.py."""

from kinds import heat
from support import few


@few("seed", range(1, 31), 6)
def test_random_problem(seed, tmp_path):
    outcome = heat.trial(seed, tmp_path)
    assert not outcome.fault, outcome.text

"""Numbers that a grid gets wrong by more than 5 % are warned of; ordinary ones are right without a word."""

import re

import pytest

PEAK = "the peak pressure is not resolved"
STEEL = dict(body1_young=210e9, body2_young=210e9, body1_poisson=0.0, body2_poisson=0.0)


def said(done, words):
    """The warnings with these words."""
    return [line for line in done.complaint if words in line]


def history(folder, head, *rows):
    """Writes a history of loads in rows one second apart; the option."""
    lines = [",".join(map(repr, (float(k + 1), *row))) for k, row in enumerate(rows)]
    (folder / "history.csv").write_text("\n".join([f"time,{head}", *lines]) + "\n")
    return dict(history="history.csv")


# ---------------------------------------------------------------- wear

POPOV = dict(STEEL, friction=0.1, gap_type="sphere", gap_radius1=0.2, gap_radius2=0.2, disp_z=7.5e-6,
             grid_size=2.25166605e-3, wear_coefficient1=1e-14)  # fmt: skip


@pytest.mark.parametrize("n", [32, 48, 64])
def test_peak_of_a_worn_contact_is_looked_at_in_the_last_cycle(petsam, tmp_path, n):
    """The edge of the stick zone, which does not wear, becomes that of a punch."""
    cycle = dict(history(tmp_path, "disp_x", (0.0,), (5.625e-7,), (-5.625e-7,), (0.0,)), steps=4, grid_n=n)
    worn = said(petsam(POPOV, cycle, dict(wear_cycles=1e6)), PEAK)
    assert len(worn) == 1 and "after 1000000 cycles: " in worn[0]
    assert int(re.search(r"-grid_n (\d+)$", worn[0])[1]) > n
    assert not said(petsam(POPOV, cycle, dict(wear_cycles=1e3)), PEAK)


def test_peak_of_a_worn_contact_is_looked_at_in_cycles_that_are_written(petsam, tmp_path):
    cycle = dict(history(tmp_path, "disp_x", (0.0,), (5.625e-7,), (-5.625e-7,), (0.0,)), steps=4, grid_n=32)
    case = dict(POPOV, **cycle, wear_cycles=3e6, wear_output="1e3,1e6")
    worn = said(petsam(case), PEAK)
    assert len(worn) == 1 and "after 1000000 cycles: " in worn[0]


def test_peak_of_a_contact_that_wears_step_by_step_is_looked_at_in_the_last_step(petsam, tmp_path):
    rows = [(7.5e-6, x) for x in (0.0, *([5.625e-7, -5.625e-7] * 4), 0.0)]
    case = dict(POPOV, **history(tmp_path, "disp_z,disp_x", *rows), disp_z=None, steps=4, grid_n=48)
    worn = said(petsam(case, dict(wear_coefficient1=2e-9)), PEAK)
    assert len(worn) == 1 and "in the last step: " in worn[0]
    assert not said(petsam(case, dict(wear_coefficient1=1e-12)), PEAK)

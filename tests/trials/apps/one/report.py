"""The page of a settling."""

from ...plot import page
from .pictures import settled
from .settling import Settling

RESULTS = (Settling,)


def title(found):
    return "Settling"


def parts(found, inputs):
    rows = list(zip(found.cycle, found.ratio))
    shown = page.figure(page.image(settled(found), "ratio over cycles"), "Settling")
    return [page.section("Numbers", page.table("cycles", ("cycle", "ratio"), rows)), page.section("Pictures", shown)]

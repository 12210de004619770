"""Options that would have no effect, and numbers of another unit, are refused or told before they cost time."""

import pytest

from support import SPHERE

YIELDS = dict(SPHERE, friction=0.0, load_n=10.0, grid_n=16, body2_yield=600e6, yield_depth=1e-3, yield_layers=4)
LAYER = dict(body1_layer_young=1e9, body1_layer_poisson=0.3, body1_layer_thickness=400)
UNIT = "of it: check the unit, Pa"


def told(petsam, case, *words, code=2):
    """The first line on stderr."""
    done = petsam(case, *words, check=code)
    assert done.complaint and "PETSC ERROR" not in done.stderr, done.stderr
    return done.complaint[0]


@pytest.mark.parametrize("value", ["none", "linear:2GPa", "linear:0", "voce:0.1GPa,10", "voce:1e8,0", "swift:1e-3,0.2"])
def test_constants_of_the_hardening_are_taken(petsam, value):
    petsam({**YIELDS, "body2_hardening": value}, "-dry_run")


def test_layer_in_another_unit_is_told_at_the_edge(petsam):
    """A grid large enough for the contact would not mend it."""
    said = told(petsam, dict(SPHERE, grid_n=32, **LAYER), code=12)
    assert "-body1_layer_thickness 400 is" in said and "check the unit, m" in said and "-grid_size" not in said


@pytest.mark.parametrize("size, crowded", [(2.6e-3, True), (8e-3, False)])
def test_periodic_images_of_a_sphere_are_told(petsam, size, crowded):
    done = petsam(dict(SPHERE, elasticity="periodic", grid_size=size, grid_n=128))
    assert ("periodic images of it interact from about 0.25 on: for a single contact use" in done.stderr) == crowded


def test_quiet_run_that_leaves_nothing_is_told(petsam):
    said = told(petsam, SPHERE, "-quiet", code=0)
    assert said.endswith("warning: -quiet is given without -output: the run leaves no result: give -output")
    for more in ["-output", "r.h5"], ["-dry_run"]:
        assert petsam(SPHERE, "-quiet", *more).stderr == ""

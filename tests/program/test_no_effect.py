"""Options that would have no effect, and numbers of another unit, are refused or told before they cost time."""

import pytest

from support import SPHERE

YIELDS = dict(SPHERE, friction=0.0, load_n=10.0, grid_n=16, body2_yield=600e6, yield_depth=1e-3, yield_layers=4)
VOCE = dict(body2_hardening="voce", body2_voce_stress=1e8, body2_voce_rate=10)
SWIFT = dict(body2_hardening="swift", body2_swift_strain=1e-3, body2_swift_exponent=0.2)
LAYER = dict(body1_layer_young=1e9, body1_layer_poisson=0.3, body1_layer_thickness=400)
UNIT = "of it: check the unit, Pa"


def told(petsam, case, *words, code=2):
    """The first line on stderr."""
    done = petsam(case, *words, check=code)
    assert done.complaint and "PETSC ERROR" not in done.stderr, done.stderr
    return done.complaint[0]


@pytest.mark.parametrize(
    "option, value, needs",
    [
        ("yield_depth", 1e-3, "-body1_yield or -body2_yield"),
        ("yield_layers", 8, "-body1_yield or -body2_yield"),
        ("yield_rtol", 1e-3, "-body1_yield or -body2_yield"),
        ("body2_hardening", "voce", "-body2_yield"),
        ("body2_hardening_modulus", 2e9, "-body2_yield"),
        ("body1_voce_stress", 1e8, "-body1_hardening voce"),
        ("body2_swift_strain", 1e-3, "-body2_hardening swift"),
        ("body2_backstress", "1e10,100", "-body2_yield"),
    ],
)
def test_constants_of_a_body_that_does_not_yield_are_refused(petsam, option, value, needs):
    assert told(petsam, dict(SPHERE, **{option: value})).endswith(f"-{option} is given without {needs}")


@pytest.mark.parametrize(
    "more, says",
    [
        (dict(body2_voce_stress=1e8), "-body2_voce_stress is given without -body2_hardening voce"),
        (dict(SWIFT, body2_voce_rate=10), "-body2_voce_rate is given without -body2_hardening voce"),
        (dict(VOCE, body2_swift_exponent=0.2), "-body2_swift_exponent is given without -body2_hardening swift"),
        (dict(body2_hardening="voce"), "-body2_voce_stress is missing: required by -body2_hardening voce"),
        (dict(VOCE, body2_voce_rate=None), "-body2_voce_rate is missing"),
        (dict(SWIFT, body2_swift_exponent=None), "-body2_swift_exponent is missing"),
        (dict(VOCE, body2_hardening_modulus=1e9), "-body2_hardening_modulus does not work with -body2_hardening voce"),
        (dict(SWIFT, body2_hardening_modulus=1e9), "does not work with -body2_hardening swift: give one of them"),
    ],
)
def test_constants_of_another_hardening_are_refused(petsam, more, says):
    assert says in told(petsam, {**YIELDS, **more})


@pytest.mark.parametrize("more", [VOCE, SWIFT, dict(body2_hardening="linear", body2_hardening_modulus=2e9)])
def test_constants_of_the_hardening_are_taken(petsam, more):
    petsam({**YIELDS, **more}, "-dry_run")


@pytest.mark.parametrize(
    "case, option",
    [
        (dict(YIELDS, body2_yield=600), "-body2_yield 600: "),
        (dict(YIELDS, body2_hardening_modulus=2), "-body2_hardening_modulus 2: "),
        (dict(YIELDS, **dict(VOCE, body2_voce_stress=200)), "-body2_voce_stress 200: "),
        (dict(YIELDS, body2_backstress="50000,100"), "-body2_backstress 50000: "),
        (dict(YIELDS, body2_backstress="1e10,100,20000,10"), "-body2_backstress 20000: "),
        (dict(YIELDS, body2_initial_stress="i.csv"), "-body2_initial_stress: the maximum stress "),
        (dict(SPHERE, film_thickness=1e-6, film_shear=1), "-film_shear 1: "),
        (dict(SPHERE, pressure_limit=2000), "-pressure_limit 2000: "),
        (dict(SPHERE, bulk2_stress_xx=300e9), "-bulk2_stress_xx, or its column in -history: 3e+11: "),
    ],
)
def test_stress_in_another_unit_is_refused(petsam, tmp_path, case, option):
    (tmp_path / "i.csv").write_text("depth,stress_xx,stress_yy\n0,-400,-400\n1e-3,0,0\n")
    said = told(petsam, case)
    assert option in said and "of Young's modulus, expected at " in said and said.endswith(UNIT)


def test_depths_in_another_unit_are_refused(petsam, tmp_path):
    (tmp_path / "i.csv").write_text("depth,stress_xx,stress_yy\n0,-4e8,-4e8\n0.3,0,0\n")
    said = told(petsam, dict(YIELDS, body2_initial_stress="i.csv"))
    assert (
        "-body2_initial_stress: the last depth, 0.3 m, is 115 times the width of the grid" in said and "unit, m" in said
    )


@pytest.mark.parametrize("stress, limit", [(50, "at least 1e-08"), (100e9, "at most 0.2")])
def test_bulk_stress_in_another_unit_is_told(petsam, stress, limit):
    said = told(petsam, dict(SPHERE, bulk2_stress_xx=stress), code=0)
    assert f"the largest bulk stress, {stress:g} Pa, is " in said and f"expected {limit} {UNIT}" in said


def test_friction_in_percent_in_a_history_is_told(petsam, tmp_path):
    (tmp_path / "h.csv").write_text("time,friction_scale\n1,1\n2,30\n")
    said = told(petsam, dict(SPHERE, friction=0.1), "-history", "h.csv", code=0)
    assert "friction_scale of 30 makes the coefficient of friction 3: give a ratio, 0.3 for 30 percent" in said


@pytest.mark.parametrize("option", ["wear_coefficient1", "wear_coefficient2", "wear_energy1", "wear_energy2"])
def test_wear_without_friction_names_its_option(petsam, option):
    said = told(petsam, dict(SPHERE, friction=0.0, **{option: 1e-13}))
    assert f"-{option} is given without -friction, on which it acts" in said


def test_error_of_a_jump_is_less_than_all(petsam, tmp_path):
    (tmp_path / "c.csv").write_text("time,disp_x\n0,1e-6\n1,-1e-6\n2,1e-6\n")
    case = dict(SPHERE, history="c.csv", wear_cycles=10, wear_coefficient1=1e-13, wear_rtol=10)
    assert "-wear_rtol 10: expected a number > 0 and < 1" in told(petsam, case)


def test_layer_in_another_unit_is_told_at_the_edge(petsam):
    """A grid large enough for the contact would not mend it."""
    said = told(petsam, dict(SPHERE, grid_n=32, **LAYER), code=12)
    assert "-body1_layer_thickness 400 is" in said and "check the unit, m" in said and "-grid_size" not in said


def test_radius_in_another_unit_is_told_at_the_edge(petsam):
    said = told(petsam, dict(SPHERE, gap_radius1=200.0, gap_radius2=200.0), code=12)
    assert "times -gap_radius1 200 (in m), and less than 0.001 of it is rare: check the unit, m" in said


@pytest.mark.parametrize("size, crowded", [(2.6e-3, True), (8e-3, False)])
def test_periodic_images_of_a_sphere_are_told(petsam, size, crowded):
    done = petsam(dict(SPHERE, elasticity="periodic", grid_size=size, grid_n=128))
    assert ("periodic images of it interact from about 0.25 on: give a larger -grid_size" in done.stderr) == crowded


def test_quiet_run_that_leaves_nothing_is_told(petsam):
    said = told(petsam, SPHERE, "-quiet", code=0)
    assert said.endswith("warning: -quiet is given without -output: the run leaves no result: give -output")
    for more in ["-output", "r.h5"], ["-dry_run"]:
        assert petsam(SPHERE, "-quiet", *more).stderr == ""


def test_option_that_is_given_twice_is_told(petsam, tmp_path):
    """With both values, of which the last one counts; the same value twice, or one of a file replaced, is fine."""
    (tmp_path / "a.opts").write_text("-steps 1\n-grid_center 0\n-steps 2\n")
    (tmp_path / "b.opts").write_text("-options_file c.opts\n-steps 2\n")
    (tmp_path / "c.opts").write_text("-steps 1\n")
    said = told(petsam, SPHERE, "-steps", "1", "-steps", "2", code=0)
    assert said.endswith("warning: -steps 2 is given after -steps 1, and replaces it: remove one of them")
    said = told(petsam, SPHERE, "-options_file", "a.opts", code=0)
    one, other = ("-options_file a.opts, line " + line for line in ("3: -steps 2", "1: -steps 1"))
    assert f"warning: {one} is given after {other}, and replaces it" in said
    for words in (
        ["-steps", "1", "-steps", "1"],
        ["-options_file", "c.opts", "-steps", "2"],
        ["-options_file", "b.opts"],
    ):
        assert petsam(SPHERE, *words).stderr == ""

"""Input that is taken: numbers in all spellings, options of files and of the environment. Other input: refusals.txt."""

import pytest

NAN, INF = float("nan"), float("inf")


@pytest.mark.parametrize("text", ["-load_ty 3", "-dll_append libm.so"])
def test_file_that_nobody_has_named_is_not_read(petsam, sphere, tmp_path, text):
    for name in (".petscrc", "petscrc"):
        (tmp_path / name).write_text(text)
    petsam(dict(sphere, grid_n=8, friction=0.0))
    petsam(dict(sphere, grid_n=8), "-skip_petscrc")


@pytest.mark.parametrize(
    "change",
    [
        dict(body2_young=INF, body2_poisson=None),
        dict(body2_young="Inf", body2_poisson="0.3"),
        dict(gap_radius2="infinity"),
        dict(grid_n="64,64"),
        dict(grid_size="2.6e-3,2.7e-3"),
        dict(load_tx="-50"),
        dict(load_my="-1e-3", rot_x="-0"),
        dict(friction="0"),
        dict(load_n="+1e3"),
        dict(allow_edge_contact="yes"),
        dict(grid_center="-1e-4,2e-4"),
        dict(body1_poisson="-0.5", body2_poisson="-.5"),
        dict(Load_tx="60"),
    ],
    ids=str,
)
def test_good_input_is_taken(petsam, sphere, change):
    petsam(dict(sphere, **change))


def test_options_file_and_environment_count_as_the_command_line(petsam, sphere, tmp_path):
    from support import Results, words

    line = words(dict(sphere, load_tx=40.0))
    (tmp_path / "study.opts").write_text(
        "# a comment\n" + "\n".join(" ".join(p) for p in zip(line[::2], line[1::2])) + "\n"
    )
    petsam("-options_file", "study.opts", "-output", "a.h5")
    petsam("-output", "b.h5", environment=dict(PETSC_OPTIONS=" ".join(line)))
    petsam(*line, "-output", "c.h5")
    a, b, c = (Results(tmp_path / f"{k}.h5") for k in "abc")
    assert (a.pressure == c.pressure).all() and (b.shear_x == c.shear_x).all()


def test_command_line_overrides_the_options_file(petsam, sphere, tmp_path):
    from support import Results, words

    line = words(sphere)
    (tmp_path / "study.opts").write_text("\n".join(" ".join(p) for p in zip(line[::2], line[1::2])) + "\n-load_tx 10\n")
    petsam("-options_file", "study.opts", "-output", "a.h5", "-load_tx", "20")
    assert Results(tmp_path / "a.h5")["load_tx"] == pytest.approx(20, rel=1e-9)

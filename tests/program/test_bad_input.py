"""Every mistake is answered by exit code 2 or 3 and a line that names it, and nothing is written over."""

import os

import h5py
import numpy as np
import pytest

from conftest import PROGRAM, execute
from support import SPHERE

NAN, INF = float("nan"), float("inf")
FILE = dict(gap_type="file", gap_radius1=None, gap_radius2=None)
FLAT = dict(gap_type="flat", gap_radius1=None, gap_radius2=None)


def case(name, change, *extra, says=None, code=2):
    """A change of SPHERE's options, further words, and what the message must name (by default the option changed)."""
    says = says or ["-" + k for k in change][:1] or [extra[0]]
    return pytest.param(change, extra, [says] if isinstance(says, str) else says, code, id=name)


def numbers(option, texts):
    return [case(f"{option} {text}", {option: text}, says=["-" + option, text]) for text in texts]


REQUIRED = (
    "grid_n",
    "grid_size",
    "body1_young",
    "body1_poisson",
    "body2_young",
    "body2_poisson",
    "gap_type",
    "gap_radius1",
    "gap_radius2",
)
CASES = [
    # options that do not exist
    case("unknown", {}, "-nonsense", "3"),
    case("unknown bare", {}, "-nonsense"),
    case("misspelled", {}, "-load_xt", "60"),
    case("misspelled solver", {}, "-normal_rtoll", "1e-6"),
    case("prefix of one", {}, "-load", "60"),
    case("option of another gap", {}, "-gap_radius_x", "0.2"),
    case("unknown with a bad value", {}, "-nonsense", "nan", "-other", "-1"),
    case("double dash", {}, "--load_tx", "60", says="--load_tx"),
    case("double dash alone", {}, "--", says="--"),
    case("double dash with equals", {}, "--load_tx=60", says="--load_tx"),
    case("positional word", {}, "study.opts", says="study.opts"),
    case("positional word after a bare option", {}, "-load_tx", "60", "70", says="70"),
    case("dash alone", {}, "-", says="-"),
    case("negative number alone", {}, "-load_tx", "1", "-5", says="-5"),
    case("empty word", {}, "", says="expected an option"),
    # missing
    *[case(f"no {name}", {name: None}) for name in REQUIRED],
    case("neither load_n nor disp_z", dict(load_n=None), says=["-load_n", "-disp_z"]),
    case("nothing at all", {name: None for name in SPHERE}, says="-grid_n"),
    *[
        case(f"no value of {name}", {name: True})
        for name in ("grid_n", "grid_size", "body1_young", "friction", "gap_type", "load_n", "gap_radius1")
    ],
    case("no value of output", {}, "-output"),
    case("no value of normal_type", {}, "-normal_type"),
    # numbers
    *numbers(
        "grid_n",
        (
            "1",
            "0",
            "-5",
            "64.5",
            "64,64,64",
            "64,",
            ",64",
            "64,1",
            "abc",
            "nan",
            "inf",
            "1e2",
            "64x",
            "2147483648",
            "99999999999999999999",
        ),
    ),
    *numbers("grid_size", ("0", "-1e-3", "nan", "inf", "abc", "1e-3,0", "1e-3,1e-3,1e-3", "1e-3,", "1e-3 m", "1e400")),
    *numbers("grid_center", ("nan", "inf", "a,b", "0,0,0")),
    *numbers("body1_young", ("0", "-1", "nan", "-inf", "abc", "210e9,1")),
    *numbers("body2_poisson", ("0.6", "-1", "-1.5", "nan", "inf", "abc", "1/3")),
    *numbers("friction", ("-0.1", "nan", "inf", "abc", "0,1")),
    *numbers("load_n", ("-1", "nan", "inf", "-inf", "abc", "1e3J")),
    *numbers("load_tx", ("nan", "inf", "abc", "1,2")),
    *numbers("load_mz", ("nan", "-inf")),
    *numbers("disp_x", ("nan", "inf", "abc")),
    *numbers("rot_y", ("nan", "inf")),
    *numbers("gap_radius1", ("0", "-0.2", "nan", "-inf", "abc")),
    case("grid too large for its index", dict(grid_n=100000), says=["-grid_n", "100000"]),
    case("grid too large for memory", dict(grid_n=40000), says=["-grid_n", "40000"]),
    case("grid too large for memory, 32-bit", dict(grid_n=30000), says=["-grid_n", "30000"]),
    case("grid too large, thin", dict(grid_n=(2, 1000000000)), says=["-grid_n"]),
    case("cells that cannot be told apart", dict(grid_center="1e10,0"), says="-grid_size"),
    # contradictions
    case("both rigid", dict(body1_young=INF, body2_young=INF), says=["-body1_young", "-body2_young"]),
    *[
        case(f"both {load} and {rigid}", {load: 1.0, rigid: 1e-6}, says=["-" + load, "-" + rigid])
        for load, rigid in zip(
            ("load_n", "load_mx", "load_my", "load_tx", "load_ty", "load_mz"),
            ("disp_z", "rot_x", "rot_y", "disp_x", "disp_y", "rot_z"),
        )
    ],
    # gap
    case("gap type unknown", dict(gap_type="cone"), says=["-gap_type", "cone"]),
    case("gap type in capitals", dict(gap_type="Sphere"), says="-gap_type"),
    case(
        "ellipsoid without a radius",
        dict(gap_type="ellipsoid", gap_radius1=None, gap_radius2=None, gap_radius_x=1.0),
        says="-gap_radius_y",
    ),
    case(
        "ellipsoid of radius 0",
        dict(gap_type="ellipsoid", gap_radius1=None, gap_radius2=None, gap_radius_x=1.0, gap_radius_y=0.0),
        says="-gap_radius_y",
    ),
    case(
        "punch without its edge",
        dict(gap_type="punch", gap_radius1=None, gap_radius2=None, gap_flat_radius=1e-3),
        says="-gap_edge_radius",
    ),
    case(
        "punch of negative base",
        dict(gap_type="punch", gap_radius1=None, gap_radius2=None, gap_flat_radius=-1e-3, gap_edge_radius=1.0),
        says="-gap_flat_radius",
    ),
    case("radius that overflows", dict(gap_radius1=1e-320), says="-gap_"),
    # files
    case("no gap file", FILE, says="-gap_file"),
    case("dataset without a file", dict(gap_dataset="/height"), says="-gap_dataset"),
    case("gap file missing", FILE, "-gap_file", "nowhere.h5", says=["-gap_file", "nowhere.h5"], code=3),
    case("gap file is a directory", FILE, "-gap_file", ".", says="-gap_file", code=3),
    case("gap file is text", FILE, "-gap_file", "text.h5", says=["-gap_file", "text.h5"], code=3),
    case("gap file is empty", FILE, "-gap_file", "empty.h5", says=["-gap_file", "empty.h5"], code=3),
    case("gap file is cut", FILE, "-gap_file", "cut.h5", says=["-gap_file", "cut.h5"], code=3),
    case(
        "gap file lacks the dataset",
        FILE,
        "-gap_file",
        "good.h5",
        "-gap_dataset",
        "/depth",
        says=["good.h5", "/depth"],
        code=3,
    ),
    case(
        "dataset is a group", FILE, "-gap_file", "good.h5", "-gap_dataset", "/group", says=["good.h5", "/group"], code=3
    ),
    case("dataset is the root", FILE, "-gap_file", "good.h5", "-gap_dataset", "/", says="good.h5", code=3),
    case(
        "gap file of wrong shape", dict(FILE, grid_n=(9, 8)), "-gap_file", "good.h5", says=["good.h5", "(8, 9)"], code=3
    ),
    case(
        "gap file transposed",
        dict(FILE, grid_n=(6, 7)),
        "-gap_file",
        "wide.h5",
        says=["wide.h5", "(6, 7)", "(7, 6)"],
        code=3,
    ),
    case(
        "gap file of one dimension",
        dict(FILE, grid_n=8),
        "-gap_file",
        "good.h5",
        "-gap_dataset",
        "line",
        says="good.h5",
        code=3,
    ),
    case(
        "gap file of three dimensions",
        dict(FILE, grid_n=8),
        "-gap_file",
        "good.h5",
        "-gap_dataset",
        "cube",
        says="good.h5",
        code=3,
    ),
    case(
        "gap file of a scalar",
        dict(FILE, grid_n=8),
        "-gap_file",
        "good.h5",
        "-gap_dataset",
        "scalar",
        says="good.h5",
        code=3,
    ),
    case(
        "gap file of words",
        dict(FILE, grid_n=8),
        "-gap_file",
        "good.h5",
        "-gap_dataset",
        "words",
        says="good.h5",
        code=3,
    ),
    case(
        "gap file with nan",
        dict(FILE, grid_n=8),
        "-gap_file",
        "good.h5",
        "-gap_dataset",
        "nan",
        says=["good.h5", "[7, 3]"],
        code=3,
    ),
    case(
        "gap file with inf", dict(FILE, grid_n=8), "-gap_file", "good.h5", "-gap_dataset", "inf", says="good.h5", code=3
    ),
    case("roughness missing", {}, "-gap_rough_file", "nowhere.h5", says=["-gap_rough_file", "nowhere.h5"], code=3),
    case(
        "roughness with nan",
        dict(FLAT, grid_n=8),
        "-gap_rough_file",
        "good.h5",
        "-gap_rough_dataset",
        "nan",
        says="-gap_rough_file",
        code=3,
    ),
    case("roughness dataset without a file", dict(gap_rough_dataset="/height"), says="-gap_rough_dataset"),
    case("output in no directory", {}, "-output", "nowhere/out.h5", says=["-output", "nowhere/out.h5"], code=3),
    case("output in a file", {}, "-output", "text.h5/out.h5", says="-output", code=3),
    case("output is a directory", {}, "-output", "folder", says=["-output", "folder"], code=3),
    case("options file of zeros", {}, "-options_file", "zeros", says=["zeros, line 1: a byte of value 0"]),
    case("number of 2000 digits", dict(load_n="1" * 2000 + "N"), says=["-load_n 1111", "1...: expected", "unit"]),
    case("keyword of 2000 letters", dict(coupling="x" * 2000), says=["-coupling xxxx", "x...: expected none or full"]),
    case("word of 2000 letters", {}, "x" * 2000, says=["xxxx: expected an option"]),
    case(
        "output is the gap",
        dict(FILE, grid_n=8),
        "-gap_file",
        "good.h5",
        "-output",
        "good.h5",
        says=["-output", "good.h5"],
    ),
    case(
        "output is the gap by another name",
        dict(FILE, grid_n=8),
        "-gap_file",
        "good.h5",
        "-output",
        "./folder/../good.h5",
        says="-output",
    ),
    case(
        "output is a link to the gap",
        dict(FILE, grid_n=8),
        "-gap_file",
        "good.h5",
        "-output",
        "link.h5",
        says="-output",
    ),
    case("output is the roughness", dict(grid_n=8), "-gap_rough_file", "good.h5", "-output", "good.h5", says="-output"),
    case("options file missing", {}, "-options_file", "nowhere.opts", says="nowhere.opts", code=3),
    case("options file is HDF5", {}, "-options_file", "good.h5", says="good.h5"),
    case("options file without dashes", {}, "-options_file", "text.h5", says="text.h5"),
    case("options file without a name", {}, "-options_file"),
    case(
        "options file with two options a line",
        {},
        "-options_file",
        "crowded.opts",
        says="crowded.opts line 2: extra token",
    ),
    case("options file is a pipe", {}, "-options_file", "pipe", says="-options_file pipe", code=3),
    case("options file names itself", {}, "-options_file", "self.opts", says=["self.opts", "in a loop"]),
    case("options file names a missing one", {}, "-options_file", "lost.opts", says="nowhere.opts", code=3),
    case("options file starts a program", {}, "-options_file", "python.opts", says=["python.opts, line 1", "-python"]),
    case(
        "options file is YAML",
        {},
        "-options_file",
        "wrong.yaml",
        says="wrong.yaml, line 1: grid_n:: expected an option",
    ),
    case("history is a pipe", {}, "-history", "pipe", says="-history pipe", code=3),
    case("gap is a pipe", dict(gap_type="file"), "-gap_file", "pipe", says="-gap_file pipe", code=3),
    case("restart from a pipe", {}, "-restart", "pipe", says="-restart pipe", code=3),
    case("output is a pipe", {}, "-output", "pipe", says="-output pipe", code=3),
    case("output is another's file", {}, "-output", "text.h5", says="-output text.h5", code=3),
    case("checkpoint is the output", {}, "-checkpoint", "results.h5", says=["-checkpoint", "-output"]),
    case(
        "checkpoint's second file is the gap",
        dict(FILE, grid_n=8),
        "-gap_file",
        "copy.h5.1",
        "-checkpoint",
        "folder/../copy.h5",
        says=["-checkpoint", "-gap_file"],
    ),
    # PETSc's own options
    *[
        case(f"{option} refused", {}, option, *value, says=option)
        for option, *value in (
            ("-python",),
            ("-dll_append", "libm.so"),
            ("-start_in_debugger",),
            ("-on_error_attach_debugger",),
            ("-stop_for_debugger",),
            ("-prefix_push", "a_"),
            ("-prefix_pop",),
            ("-fp_trap",),
            ("-FP_trap",),
            ("-citations", "good.h5"),
            ("-options_file_yaml", "wrong.yaml"),
            ("-log_view", "foo"),
            ("-normal_view", "draw"),
            ("-options_view", "ascii:a:b"),
        )
    ],
    case("viewer in no directory", {}, "-normal_view", "ascii:nowhere/a", says="-normal_view nowhere/a", code=3),
    case("log in no directory", {}, "-log_view", ":nowhere/a", says="-log_view nowhere/a", code=3),
    case("log is the output", {}, "-log_view", ":./results.h5", says=["-log_view", "-output"]),
    case("log is the checkpoint's second file", {}, "-checkpoint", "s.h5", "-log_view", ":s.h5.1", says=["-log_view"]),
    case(
        "view is the gap",
        dict(FILE, grid_n=8),
        "-gap_file",
        "good.h5",
        "-tangential_view",
        ":link.h5",
        says=["-tangential_view", "-gap_file"],
    ),
    # solvers
    case("normal type unknown", dict(normal_type="foo"), says=["-normal_type", "foo", "activeset"]),
    case("tangential type unknown", dict(tangential_type="foo"), says=["-tangential_type", "foo", "newton"]),
    *[
        item
        for solver in ("normal", "tangential")
        for item in numbers(f"{solver}_rtol", ("abc", "0", "-1", "nan", "inf"))
    ],
    *numbers("normal_max_it", ("-1", "1.5", "abc")),
    *numbers("tangential_levels", ("-1", "x")),
    case("coupling unknown", dict(coupling="half"), says=["-coupling", "half"]),
    *numbers("coupling_max_it", ("0", "-1")),
    *numbers("allow_edge_contact", ("maybe",)),
    *numbers("output_compress", ("10", "-1", "x")),
]


@pytest.fixture
def folder(tmp_path):
    """Files to stumble over, and results of an earlier run."""
    (tmp_path / "results.h5").write_bytes(b"results of an earlier run")
    (tmp_path / "text.h5").write_text("height 1 2 3\n")
    (tmp_path / "crowded.opts").write_text("-load_tx 1  # newtons\n-grid_n 64 -load_ty 2\n")
    (tmp_path / "empty.h5").write_bytes(b"")
    (tmp_path / "folder").mkdir()
    bowl = np.add.outer((np.arange(8) - 3.5) ** 2, (np.arange(8) - 3.5) ** 2) * 1e-8
    with h5py.File(tmp_path / "good.h5", "w") as f:
        f["height"] = bowl
        f["line"], f["cube"], f["scalar"], f["words"] = bowl[0], np.stack([bowl, bowl]), 1.0, [[b"a"] * 8] * 8
        f["nan"], f["inf"] = bowl, bowl
        f["nan"][7, 3] = np.nan
        f["inf"][0, 0] = -np.inf
        f.create_group("group")
    with h5py.File(tmp_path / "wide.h5", "w") as f:
        f["height"] = np.zeros((6, 7))
    (tmp_path / "cut.h5").write_bytes((tmp_path / "good.h5").read_bytes()[:600])
    (tmp_path / "link.h5").symlink_to("good.h5")
    (tmp_path / "copy.h5.1").write_bytes((tmp_path / "good.h5").read_bytes())
    (tmp_path / "self.opts").write_text("-options_file self.opts\n")
    (tmp_path / "lost.opts").write_text("-options_file nowhere.opts\n")
    (tmp_path / "python.opts").write_text("-python\n")
    (tmp_path / "wrong.yaml").write_text("grid_n: [1\n - x")
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "zeros").write_bytes(bytes(2 << 20))
    return tmp_path


def contents(folder):
    return {path.name: path.read_bytes() if path.is_file() else None for path in folder.iterdir()}


def assert_refused(petsam, folder, change, extra, says, code, ranks=1):
    before = contents(folder)
    options = {**SPHERE, "grid_n": 8, **change}
    output = [] if "-output" in extra else ["-output", "results.h5"]
    done = petsam(*output, options, *extra, ranks=ranks, check=code)
    assert contents(folder) == before, "files changed"
    assert 1 <= len(done.complaint) <= 3, done.stderr
    assert all(text in done.complaint[0] for text in says), (says, done.complaint)
    assert len(done.complaint[0]) <= 400
    assert "PETSC ERROR" not in done.stderr and "HDF5-DIAG" not in done.stderr
    if ranks == 1:
        assert done.complaint == done.stderr.splitlines(), done.stderr
    return done


@pytest.mark.parametrize("change, extra, says, code", CASES)
def test_mistake_is_named(petsam, folder, change, extra, says, code):
    assert_refused(petsam, folder, change, extra, says, code)


PARALLEL = (
    "unknown",
    "positional word",
    "load_n nan",
    "gap file missing",
    "gap file is cut",
    "gap file with nan",
    "output in no directory",
    "normal_rtol 0",
    "history is a pipe",
    "gap is a pipe",
    "restart from a pipe",
    "options file is wrong YAML",
    "-python refused",
    "viewer in no directory",
    "log in no directory",
    "log is the output",
    "grid too large for memory, 32-bit",
)


@pytest.mark.parametrize("change, extra, says, code", [item for item in CASES if item.id in PARALLEL])
def test_mistake_is_named_once_on_three_ranks(petsam, folder, change, extra, says, code):
    done = assert_refused(petsam, folder, change, extra, says, code, ranks=3)
    assert len([line for line in done.complaint if says[0] in line]) == 1


def test_mistakes_in_an_options_file_are_found(petsam, folder):
    (folder / "study.opts").write_text("-load_tx 60\n-lood_ty 3 # misspelled\n")
    assert_refused(petsam, folder, {}, ("-options_file", "study.opts"), ["-lood_ty"], 2)


@pytest.mark.parametrize(
    "text, says",
    [
        ("-lood_ty 3", "-lood_ty"),
        ("load_ty 3", "PETSC_OPTIONS: load_ty"),
        ("-python", "PETSC_OPTIONS: -python"),
        ("-load_tx 3 \n-lood_ty 3", "-lood_ty"),
        ("-load_ty 3 -options_file python.opts", "python.opts, line 1: -python"),
        ("-load_ty 3 -h", "PETSC_OPTIONS: -h: petsam does not support it here"),
    ],
)
def test_mistakes_in_the_environment_are_found(petsam, folder, text, says):
    done = petsam(dict(SPHERE, grid_n=8), environment=dict(PETSC_OPTIONS=text), check=2)
    assert says in done.complaint[0] and len(done.stderr.splitlines()) <= 2


@pytest.mark.parametrize("text, named", [("-help\n", "1: -help"), ("\nalias -ask -version\n", "2: -version")])
def test_help_in_an_options_file_is_refused_by_petsam_stress(launcher, tmp_path, text, named):
    (tmp_path / "ask.opts").write_text(text)
    done = execute(launcher, tmp_path, ["-options_file", "ask.opts"], 1, 2, program=PROGRAM.parent / "petsam-stress")
    assert f"ask.opts, line {named}: petsam does not support it here" in done.stderr and not done.stdout


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


@pytest.mark.parametrize("option", ["output", "checkpoint"])
def test_results_do_not_overwrite_the_options_file(petsam, sphere, tmp_path, option):
    path = tmp_path / "study.opts"
    path.write_text("-load_tx 10\n")
    done = petsam(sphere, "-options_file", "study.opts", {option: "./study.opts"}, check=2)
    assert f"-{option} ./study.opts: would overwrite the file of -options_file" in done.complaint[0]
    assert path.read_text() == "-load_tx 10\n"


INPUTS = dict(
    history="time,load_n\n1,500\n",
    body1_layer_file="depth,young,poisson\n0,2e11,0.3\n1e-3,2e11,0.3\n",
    body1_initial_stress="depth,stress_xx,stress_yy\n0,0,0\n1e-3,0,0\n",
)


@pytest.mark.parametrize("written", ["normal_view", "tangential_converged_reason", "log_view", "output", "checkpoint"])
@pytest.mark.parametrize("option", INPUTS)
def test_nothing_replaces_a_file_that_an_option_declares_to_be_read(petsam, sphere, tmp_path, option, written):
    path = tmp_path / "in.txt"
    path.write_text(INPUTS[option])
    case = dict(sphere, load_n=None) if option == "history" else sphere
    if option == "body1_initial_stress":
        case = dict(case, body1_yield=1e9, yield_depth=1e-3, yield_layers=4)
    name = ":in.txt" if written.endswith(("view", "reason")) else "in.txt"
    done = petsam(case, {option: path, written: name}, check=2)
    assert f"-{written} in.txt: would overwrite the file of -{option}" in done.complaint[0]
    assert path.read_text() == INPUTS[option]


def test_command_line_overrides_the_options_file(petsam, sphere, tmp_path):
    from support import Results, words

    line = words(sphere)
    (tmp_path / "study.opts").write_text("\n".join(" ".join(p) for p in zip(line[::2], line[1::2])) + "\n-load_tx 10\n")
    petsam("-options_file", "study.opts", "-output", "a.h5", "-load_tx", "20")
    assert Results(tmp_path / "a.h5")["load_tx"] == pytest.approx(20, rel=1e-9)

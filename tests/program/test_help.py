"""-help by topic: that everything is found, that what it says is true, and its form for other programs."""

import json
import re

import pytest

from conftest import PROGRAM, execute
from support import ROOT, ball, words

PROGRAMS = ("petsam", "petsam-stress")


@pytest.fixture(params=PROGRAMS)
def ask(request, launcher, tmp_path):
    """ask(*words, ranks=1, check=0): a run of either program; ask.name is which."""

    def run(*options, ranks=1, check=0):
        done = execute(launcher, tmp_path, options, ranks, check, program=PROGRAM.parent / request.param)
        assert not list(tmp_path.iterdir())  # help writes nothing
        return done

    run.name = request.param
    return run


def described(ask):
    return json.loads(ask("-help", "json").stdout)


def options_in(text):
    """Options that a text of -help lists, those of the examples left out."""
    return re.findall(r"^  (-[a-z]\w*)(?: [<[]\S*)?(?:$|  +\S| [^-\s])", text, re.M)


def test_help_tells_its_topics(ask):
    text = ask("-help").stdout
    told = re.search(r"More about one of these by -help and its name: (.*?)\.\n", text, re.S).group(1)
    assert re.split(r",\s+", told) == [topic["name"] for topic in described(ask)["topics"]]


def test_topics_are_those_of_the_manual(ask):
    text = (ROOT / "examples" / "manual" / "OPTIONS.md").read_text()
    (listed,) = re.findall(rf"^- of {ask.name}: (.*?)[;.]$", text, re.M | re.S)
    topics = [topic["name"].replace(" ", "_") for topic in described(ask)["topics"]]
    assert re.findall(r"`(\w+)`", listed) == topics


def test_topics_name_no_types_that_only_the_tests_add(ask):
    added = re.findall(r'define SAM_\w+ "(\w{5,})"', (ROOT / "tests/unit/methods/methods.h").read_text())
    assert "polonskykeer" in added
    assert not set(added) & set(re.findall(r"\w+", " ".join(topic["text"] for topic in described(ask)["topics"])))


def test_every_option_is_in_one_topic(ask):
    whole = described(ask)
    every = options_in(ask("-help").stdout)
    by_topic = [name for topic in whole["topics"] for name in options_in(ask("-help", topic["name"]).stdout)]
    assert len(every) > 10 and sorted(by_topic) == sorted(every)


def test_topics_say_something_in_lines_that_fit(ask):
    whole = described(ask)
    for topic in whole["topics"]:
        text = ask("-help", topic["name"]).stdout
        assert text.startswith(topic["text"]) and topic["text"].endswith("\n"), topic["name"]
        # petsam-stress names its fatigue parameters in one line
        assert max(map(len, text.splitlines())) <= 120 or topic["name"] in ("fatigue", "materials")  # tables
        for group in topic["groups"]:
            assert f"\n{group}\n" in text


def test_topics_name_no_option_that_there_is_not(ask):
    whole = described(ask)
    known = {option["name"] for group in whole["groups"] for option in group["options"]}
    if ask.name == "petsam-stress":
        known.add("-output_every")  # of petsam, which is said there
    for text in [whole["usage"], *(topic["text"] for topic in whole["topics"])]:
        # `-option` stands for any; a minus behind = is one of a formula
        named = set(re.findall(r"(?<!= )(?<![\w)-])-[a-z]\w+", text)) - {"-option"}
        assert named <= known, named - known


@pytest.mark.parametrize("ranks", [1, 2])
def test_unknown_topic_is_refused_with_those_there_are(ask, ranks):
    done = ask("-help", "tricks", check=2, ranks=ranks)
    (line,) = [line for line in done.stderr.splitlines() if "-help tricks" in line]  # mpirun says more
    for topic in described(ask)["topics"]:
        assert topic["name"] in line


@pytest.mark.parametrize("asked, meant", [("tangental", "tangential"), ("gird", "grid"), ("chekpoints", "checkpoints")])
def test_misspelled_topic_is_guessed(petsam, asked, meant):
    assert f"is {meant} meant?" in petsam("-help", asked, check=2).complaint[0]


@pytest.mark.parametrize(
    "asked, meant",
    [
        (["load"], "loads"),
        (["TANGENTIAL"], "tangential"),
        (["exit"], "exit codes"),
        (["exit", "codes"], "exit codes"),
        (["exit_codes"], "exit codes"),
        (["exit-codes"], "exit codes"),
        (["che"], "checkpoints"),
    ],
)
def test_topics_are_found_by_their_beginning_too(petsam, asked, meant):
    assert petsam("-help", *asked).stdout == petsam("-help", meant).stdout


def test_beginning_of_two_topics_is_refused(petsam):
    assert "-help re" in petsam("-help", "re", check=2).complaint[0]  # report, results


@pytest.mark.parametrize(
    "asked, found",
    [
        ("gap_type", ["-gap_type"]),
        ("grid_N", ["-grid_n"]),
        ("-grid_n", ["-grid_n"]),
        ("--fft", ["-fft_effort", "-fft_exchange"]),
        ("coupling", ["-coupling", "-coupling_rtol", "-coupling_max_it", "-coupling_monitor"]),
        (
            "body1",
            ["-body1", "-body1_young", "-body1_poisson", "-body1_layer_file", "-body1_layers"]
            + [f"-body1_layer_{name}" for name in ("young", "poisson", "thickness")]
            + ["-body1_initial_stress", "-body1_compliance", "-body1_relax_moduli", "-body1_relax_times"]
            + ["-body1_relax"]
            + ["-body1_conductivity", "-body1_heat_capacity"]
            + [
                "-body1_bulk_temperature",
                "-body1_expansion",
                "-body1_speed",
                "-body1_surface_file",
                "-body1_surface_dataset",
            ]
            + [f"-body1_{name}" for name in ("yield", "hardening", "backstress")],
        ),
        ("restart", ["-restart"]),
        ("fft", ["-fft_effort", "-fft_exchange"]),
    ],
)
def test_options_are_found_with_and_without_their_dash(petsam, asked, found):
    assert options_in(petsam("-help", asked).stdout) == found


def test_a_topic_may_stand_before_other_options(petsam):
    text = petsam("-grid_n", 64, "--help", "grid", "-friction", 0.3).stdout
    assert text == petsam("-help", "grid").stdout


def test_json_has_all_that_is_printed(ask):
    printed = ask("-help").stdout
    whole = described(ask)
    assert whole["program"] == ask.name and printed.startswith(whole["usage"])
    assert printed.startswith(f"{ask.name} {whole['version']}: ")
    rest = printed[printed.index("\n\n", len(whole["usage"])) :]
    text = ""
    for group in whole["groups"]:
        text += f"\n\n{group['name']}"
        for option in group["options"]:
            left = f"{option['name']} {option['argument']}".strip()
            default = f" ({option['default']})" if option["default"] else ""
            gap = "\n" + 42 * " " if len(left) >= 40 else " " * (40 - len(left))
            text += f"\n  {left}{gap}{option['text']}{default}"
    assert rest == text + "\n"


def test_json_has_the_units_of_options_and_numbers(ask):
    whole = described(ask)
    units = {option["name"]: option["unit"] for group in whole["groups"] for option in group["options"]}
    name, unit = {"petsam": ("-gap_radius1", "m"), "petsam-stress": ("-fatigue_yield", "Pa")}[ask.name]
    assert units[name] == unit and units["-version"] is None
    assert whole["units"]["m"] == {"m": 0, "mm": -3, "um": -6, "nm": -9} and whole["units"]["N m/m"]["Nm/m"] == 0


def test_json_has_the_words_of_options(ask):
    found = {option["name"]: option for group in described(ask)["groups"] for option in group["options"]}
    expected = {
        "petsam": {
            "-gap_type": "curved ellipsoid file flat pad punch roller sphere",
            "-tangential_type": "newton rolling",
            "-elasticity": "halfspace periodic plane plane_periodic",
            "-edges": "none reconstruct",
            "-grid_n": "",
        },
        "petsam-stress": {
            "-quantities": "stress mises principal shear_max strain temperature none",
            "-fatigue": "crossland dang_van findley swt fatemi_socie ruiz",
            "-body": "",
        },
    }[ask.name]
    for name, text in expected.items():
        assert found[name]["words"] == text.split(), name
    assert found["-output"]["argument"] == "<file>" and found["-quiet"]["words"] == ["true", "false"]


# ---- what the topics say


def topic(petsam, name):
    return petsam("-help", name).stdout


def test_history_of_the_topic_is_one(petsam, tmp_path):
    text = topic(petsam, "history")
    sample = re.search(r"^  # strokes.csv.*?(?=\n\n)", text, re.M | re.S).group()
    (tmp_path / "strokes.csv").write_text(re.sub(r"^  ", "", sample, flags=re.M).replace("60", "20"))
    case = ball(n=32)
    assert len(sample.splitlines()) == 6
    said = petsam(case, "-history", "strokes.csv").stdout
    assert re.findall(r"^ +\d+ +[0-3] +180 +(\S+)", said, re.M) == ["0", "20", "-20", "20"]


def test_fatigue_is_found_in_the_other_program(petsam):
    assert "petsam-stress -help fatigue" in topic(petsam, "fatigue")


def test_exit_codes_of_the_topic_are_those_of_the_manual(petsam):
    codes = re.findall(r"^  (\d+) ", topic(petsam, "exit codes"), re.M)
    table = (ROOT / "examples" / "manual" / "RESULTS.md").read_text().split("| exit code | meaning |")
    if len(table) == 2:  # the manual may have it elsewhere
        assert codes == re.findall(r"^\| (\d+) \|", table[1].split("\n\n")[0], re.M)
    assert codes == ["0", "2", "3", "10", "11", "12", "75"]


def test_gap_types_of_the_topic_are_all_there_are(petsam):
    text = topic(petsam, "gap")
    listed = re.findall(r"^  (\w+)   +\S", text.split("\nGap\n")[0], re.M)
    found = re.search(r"-gap_type <keyword> +(.*): required", text).group(1)
    assert sorted(listed) == re.split(r", | or ", found)


def test_fields_in_the_help_are_those_that_a_contact_declares(petsam):
    groups = json.loads(petsam("-help", "json").stdout)["groups"]
    (listed,) = (one["words"] for group in groups for one in group["options"] if one["name"] == "-output_fields")
    line = petsam(*words({**ball(n=16), "output": "a.h5", "output_fields": "none_such"}), check=2).complaint[0]
    declared = re.search(r"one or more of (.*), separated by commas", line).group(1).split(", ")
    assert sorted(listed) == sorted([*declared, "all", "none", "usual", "plastic"])


@pytest.mark.parametrize("option", ["output", "gap_type", "output_fields", "restart"])
def test_missing_text_is_named_by_what_it_is(petsam, option):
    case = {**ball(n=16), option: True}
    line = petsam(*words(case), check=2).complaint[0]
    expected = {"gap_type": "curved, ellipsoid, file, flat", "output_fields": "some of all,none,pressure"}
    assert f"-{option} has no value: expected {expected.get(option, 'the name of a file')}" in line

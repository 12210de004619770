"""Outputs are judged before work: a missing folder, a folder that cannot be written, an ending that is unknown."""

import os
import subprocess
import sys

import numpy as np
import pytest

from petsam.core.errors import FILE, Error
from petsam.core.files import need_folder, need_replaceable
from support import ROOT, ball

MAP = ["z.npy", "--body", "2", "--units", "um", "--size", "1mm"]
BODY = ["--mesh", "b.inp", "--units", "mm", "--contact", "T", "--fixed", "B", "--patch", "1mm"]
PAIR = ["pair.h5", "--contact", "c.opts", "--preload", "B1=1e3", "--sensor", "T:z"]
COMMANDS = {
    "petsam-surface -o": [*MAP, "-o", "{}/z.h5"], "petsam-surface --picture": [*MAP, "--picture", "{}/z.png"],
    "petsam-joint stiffness": ["z.h5", "--pressure", "10MPa", "--friction", ".3", "--body1", "steel",
                               "--body2", "steel", "-o", "{}/j"],
    "petsam-joint backbone": [*PAIR, "--amplitudes", "1um", "-o", "{}/j"],
    "petsam-joint band": [*PAIR, "--amplitudes", "1um", "-o", "{}/j"],
    "petsam-joint wear": [*PAIR, "--amplitudes", "1um", "--cycles", "1e3", "-o", "{}/j"],
    "petsam-joint response": ["pair.h5", "--contact", "c.opts", "--force", "T:z=1", "--frequencies", "100",
                              "-o", "{}/j"],
    "petsam-compliance -o": [*BODY,
                             "-o", "{}/c.h5"],
    "petsam-compliance --picture": [*BODY,
                                    "--picture", "{}/c.png"],
    "petsam-fatigue -o": ["none.h5", "-o", "{}/f.png"], "petsam-fatigue --csv": ["none.h5", "--csv", "{}/f.csv"],
    "petsam-loads -o": ["none.csv", "--frame", "auto", "-o", "{}/h.csv"],
    "petsam-loads -d": ["none.csv", "--frame", "auto", "-d", "{}"],
    "petsam-plot -o": ["none.h5", "-o", "{}/p.png"], "petsam-plot --csv": ["none.h5", "--csv", "{}/p.csv"],
    "petsam-study": ["t.csv", "--directory", "{}/s"],
}  # fmt: skip


@pytest.mark.parametrize("folder, reason", [("nofolder", "does not exist"), ("text", "is a file"), ("/proc", "")])
@pytest.mark.parametrize("name", COMMANDS)
def test_no_command_works_for_an_output_that_it_cannot_write(tmp_path, name, folder, reason):
    if name == "petsam-study" and folder == "nofolder":
        pytest.skip("a study makes its folder")
    np.save(tmp_path / "z.npy", np.random.default_rng(1).normal(size=(16, 16)))
    (tmp_path / "text").write_text("")
    (tmp_path / "t.csv").write_text("load_n\n1\n")
    command = name.split()[0]
    words = (
        [ROOT / "scripts" / command, *name.split()[1:2]] if command == "petsam-joint" else [ROOT / "scripts" / command]
    )
    done = subprocess.run(
        [sys.executable, *map(str, words), *(word.format(folder) for word in COMMANDS[name])],
        cwd=tmp_path, capture_output=True, text=True, timeout=120,
    )  # fmt: skip
    assert done.returncode in (2, 3) and len(done.stderr.splitlines()) == 1, done.stderr
    assert f"{folder}/" in done.stderr or f": {folder}" in done.stderr, done.stderr
    assert reason in done.stderr or command == "petsam-study", done.stderr
    assert sorted(os.listdir(tmp_path)) == ["t.csv", "text", "z.npy"]


def test_a_file_of_a_folder_that_lacks_or_is_none_is_refused(tmp_path):
    need_replaceable(tmp_path / "new")
    (tmp_path / "text").write_text("")
    need_replaceable(tmp_path / "text")
    assert sorted(os.listdir(tmp_path)) == ["text"]
    for path in ("nofolder/a", "text/a"):
        with pytest.raises(Error, match="cannot be written: its folder") as found:
            need_replaceable(tmp_path / path)
        assert found.value.code == FILE
    with pytest.raises(Error, match="cannot be written"):
        need_folder("/proc", "/proc/a")


@pytest.mark.parametrize("folder", ["nofolder", "text"])
def test_the_programs_judge_theirs_before_work(petsam, tmp_path, folder):
    (tmp_path / "text").write_text("")
    for option in ("-output", "-checkpoint"):
        assert f"{option} {folder}/" in petsam(ball(16), option, f"{folder}/x.h5", check=3).complaint[0]

"""petsam-loads: resultants in inclined frames, files of every format, remarks, refusals, and a run with the history."""

import os
import sys

import numpy as np
import pytest

import petsam
from petsam.apps.compliance import command as compliance_command
from petsam.apps.launch import code_of
from petsam.apps.loads import command, doubts, resultants
from petsam.apps.loads.forces import Forces
from petsam.core import frames
from petsam.core.errors import Error, Unusable
from support import ROOT

LOADS = ("load_n", "load_tx", "load_ty", "load_mx", "load_my", "load_mz")
SQRT = np.sqrt(0.5)
# two flanks and a floor of a dovetail, mm: origin, x, z into the disc (body 2)
FRAMES = {
    "LEFT": ((-5.0, 0.0, 1.0), (1.0, 0.0, 1.0), (-1.0, 0.0, 1.0)),
    "RIGHT": ((5.0, 0.0, 1.0), (-1.0, 0.0, 1.0), (1.0, 0.0, 1.0)),
    "FLOOR": ((0.0, 0.0, -2.0), (0.0, 1.0, 0.0), (0.0, 0.0, -1.0)),
}
STEEL = dict(body1_young=210e9, body1_poisson=0.3, body2_young=210e9, body2_poisson=0.3)
TIMES = np.array([0.5, 1.0, 1.5, 2.5])


def axes_of(name):
    """x, y = z x x, z of a frame, by hand."""
    _, x, z = (np.array(one) / np.linalg.norm(one) for one in FRAMES[name])
    return np.array([x, np.cross(z, x), z])


@pytest.fixture(scope="module")
def dovetail():
    """Labels {name: (m,)}, coordinates (12, 3), mm, and forces on body 2 (4, 12, 3), N, of three patches."""
    chance, labels, x, force = np.random.default_rng(7), {}, [], []
    for k, name in enumerate(FRAMES):
        axes, origin = axes_of(name), np.array(FRAMES[name][0])
        local = np.array([(-0.6, -1.0, 0.0), (0.6, -1.0, 0.0), (0.6, 1.0, 0.0), (-0.6, 1.0, 0.0)])
        x.append(origin + local @ axes)
        parts = np.concatenate([chance.normal(0, 2.0, (4, 4, 2)), chance.uniform(5.0, 20.0, (4, 4, 1))], axis=2)
        force.append(parts @ axes)
        labels[name] = np.arange(10 * k + 1, 10 * k + 5)
    return labels, np.concatenate(x), np.concatenate(force, axis=1)


def table(
    path, labels, x, force, heads="label,x [mm],y [mm],z [mm],fx [N],fy [N],fz [N],time [s]", form=repr, mark=","
):
    """A table of all nodes at all times; x (m, 3) or (n, m, 3)."""
    x = np.broadcast_to(x, force.shape)
    lines = [heads.replace(",", mark)]
    for k, time in enumerate(TIMES[: len(force)]):
        for i, label in enumerate(np.concatenate(list(labels.values()))):
            numbers = [form(float(value)) for value in (*x[k, i], *force[k, i], time)]
            lines.append(mark.join([str(label), *numbers]))
    path.write_text("\n".join(lines) + "\n")
    return path


def deck(path, labels, x):
    """The nodes as a deck that petsam-compliance would reject: it has a tie, and shells."""
    lines = ["*NODE"] + [
        f"{n}, {p[0]!r}, {p[1]!r}, {p[2]!r}" for n, p in zip(np.concatenate([*labels.values()]), x.tolist())
    ]
    for name, some in labels.items():
        lines += [f"*NSET, NSET={name}", ", ".join(map(str, some))]
    path.write_text(
        "\n".join([*lines, "*ELEMENT, TYPE=S4, ELSET=SKIN", "1, 1, 2, 3, 4", "*TIE, NAME=T", "A, B"]) + "\n"
    )
    return path


def assembly(path, labels, x):
    """The nodes of each patch as an instance NAME-1 of an assembly."""
    lines, rows = [], np.split(x, len(labels))
    for (name, some), own in zip(labels.items(), rows):
        lines += [
            f"*PART, NAME={name}",
            "*NODE",
            *(f"{n}, {p[0]!r}, {p[1]!r}, {p[2]!r}" for n, p in zip(some, own.tolist())),
        ]
        lines += ["*END PART"]
    lines += ["*ASSEMBLY, NAME=A"]
    for name in labels:
        lines += [f"*INSTANCE, NAME={name}-1, PART={name}", "*END INSTANCE"]
    path.write_text("\n".join([*lines, "*END ASSEMBLY"]) + "\n")
    return path


@pytest.fixture
def files(dovetail, tmp_path):
    """The table and the deck."""
    return table(tmp_path / "f.csv", *dovetail), deck(tmp_path / "d.inp", *dovetail[:2])


@pytest.fixture
def tool(tmp_path, monkeypatch, capfd):
    """tool(*words, check=0): stdout and stderr of petsam-loads."""

    def run(*words, check=0):
        monkeypatch.chdir(tmp_path)
        monkeypatch.setattr(sys, "argv", ["petsam-loads", *map(str, words)])
        try:
            code = code_of("petsam-loads")
        except SystemExit as end:
            code = end.code
        out, err = capfd.readouterr()
        assert code == check, out + err
        if check:
            assert len(err.splitlines()) == 1 and err.startswith("petsam-loads: error: "), err
        return out, err

    return run


def option(frame):
    return "--frame=" + ":".join(",".join(map(repr, point)) for point in frame)


def by_hand(name, x, force):
    """N, Tx, Ty, Mx, My, Mz of a patch at one time, node by node; x in mm."""
    axes, found = axes_of(name), np.zeros(6)
    for at, on in zip(x, force):
        a, b, c = axes @ (at - np.array(FRAMES[name][0])) * 1e-3
        p, q, n = axes @ on
        found += [n, p, q, -(b * n - c * q), a * n - c * p, a * q - b * p]
    return found


def of_file(path):
    return np.loadtxt(path, delimiter=",", skiprows=1, ndmin=2)


# ---------------------------------------------------------------- resultants


def test_patches_of_a_dovetail_have_the_sums_by_hand(dovetail, files, tool, tmp_path):
    """Three patches, three frames, every row; on body 1 the forces are reversed."""
    labels, x, force = dovetail
    words = [word for name in FRAMES for word in ("--patch", name, option(FRAMES[name]))]
    tool("f.csv", "--deck", "d.inp", *words, "--no-picture")
    table(tmp_path / "g.csv", labels, x, -force)
    (tmp_path / "one").mkdir()
    tool("g.csv", "--deck", "d.inp", *words, "--on", "body1", "-d", "one", "--no-picture")
    for k, name in enumerate(FRAMES):
        nodes = slice(4 * k, 4 * k + 4)
        expected = np.array([by_hand(name, x[nodes], row[nodes]) for row in force])
        with open(tmp_path / f"{name}-history.csv") as file:
            assert file.readline() == "time," + ",".join(LOADS) + "\n"
        found = of_file(tmp_path / f"{name}-history.csv")
        assert np.array_equal(found[:, 0], TIMES)
        assert np.abs(found[:, 1:4] - expected[:, :3]).max() < 1e-12 * np.abs(expected[:, :3]).max()
        assert np.abs(found[:, 4:] - expected[:, 3:]).max() < 1e-12 * np.abs(expected[:, 3:]).max()
        assert np.array_equal(found, of_file(tmp_path / "one" / f"{name}-history.csv"))


def test_signs_are_those_of_the_manual():
    """One node on body 2 at x = 2 m, y = 3 m: N = sum p, Mx = -sum y p, My = sum x p, Mz = sum x q_y - y q_x."""
    loads = resultants.summed(np.array([[2.0, 3.0, 0.0]]), np.array([[[5.0, 7.0, 11.0]]]))
    assert loads.tolist() == [[11.0, 5.0, 7.0, -33.0, 22.0, 2 * 7.0 - 3 * 5.0]]


def test_page_help_and_commands_have_one_frame():
    """z into body 2 and y = z x x: y is out of the page where x is to the right and n is up."""
    page, header = ((ROOT / name).read_text() for name in ("examples/manual/LOADS.md", "include/petsam/embed.h"))
    programs = compliance_command.__doc__, command.__doc__, (ROOT / "src/front/app/petsam.help").read_text()
    for text in (page, header, *programs):
        assert "x, y and z are right-handed, with z into body 2" in " ".join(text.split())
    assert "(out of the page)" in page and "y = z x x" in page
    axes = frames.Frame.of((0, 0, 0), (1, 0, 0), (0, 0, -1), np.array([0.0, 0.0, 1.0])).axes
    assert axes[1].tolist() == [0.0, -1.0, 0.0]  # with x to the right and n up, +y is into the page


def test_a_box_is_a_patch_and_all_nodes_are_one(files, dovetail):
    labels, x, force = dovetail
    forces = petsam.loads.read(files[0])
    box = petsam.loads.history(forces, FRAMES["RIGHT"], patch=((3, -2, 0), (7, 2, 2)))
    assert box.x.shape == (4, 3) and np.allclose(box.loads[2], by_hand("RIGHT", x[4:8], force[2, 4:8]), atol=1e-13)
    every = petsam.loads.history(forces, FRAMES["RIGHT"])
    assert every.loads[0, :3] == pytest.approx((axes_of("RIGHT") @ force[0].sum(axis=0))[[2, 0, 1]], rel=1e-12)
    assert box.name == "box" and every.name == "all"


def test_tables_of_the_result(files, tmp_path):
    pytest.importorskip("pandas")
    found = petsam.loads.history(petsam.loads.read(files[0], deck=files[1]), FRAMES["LEFT"], patch="left")
    assert found.rows[1].time == 1.0 and found.rows[1].load_tx == found.loads[1, 1]
    frame = found.to_dataframe()
    assert list(frame.columns[:7]) == ["time", *LOADS] and frame.attrs["units"]["load_my"] == "N m"
    assert np.allclose(frame["center_x"], found.loads[:, 4] / found.loads[:, 0])
    assert np.allclose(frame["center_y"], -found.loads[:, 3] / found.loads[:, 0])
    found.to_csv(tmp_path / "t.csv")
    assert (tmp_path / "t.csv").read_text().startswith("time [s],load_n [N],load_tx [N]")


def test_a_frame_of_its_own_finds_the_flank_and_may_be_given_back(files, dovetail, tool, tmp_path):
    labels, x, force = dovetail
    out, _ = tool("f.csv", "--deck", "d.inp", "--patch", "RIGHT", "--frame", "auto", "-o", "a.csv", "--no-picture")
    assert "  no error of the grid is known for these loads, which are sums of the given forces" in out
    frame = next(line.split()[1].rstrip(",") for line in out.splitlines() if line.startswith("  frame "))
    origin, along, z = (np.array(list(map(float, part.split(",")))) for part in frame.split(":"))
    axes = axes_of("RIGHT")
    assert np.allclose(z, axes[2], atol=1e-8) and np.allclose(np.abs(along), np.abs(axes[1]), atol=1e-8)
    n = force[:, 4:8] @ axes[2]
    row = np.argmax(n.sum(axis=1))
    assert np.allclose(origin, n[row] @ x[4:8] / n[row].sum(), atol=1e-7)
    tool("f.csv", "--deck", "d.inp", "--patch", "RIGHT", "--frame=" + frame, "-o", "b.csv", "--no-picture")
    first, second = of_file(tmp_path / "a.csv"), of_file(tmp_path / "b.csv")
    assert np.allclose(first, second, atol=1e-7) and abs(first[row, 4:6]).max() < 1e-10  # the centre is the origin
    without_z = petsam.loads.history(petsam.loads.read(files[0], deck=files[1]), FRAMES["RIGHT"][:2], patch="RIGHT")
    assert np.allclose(without_z.frame.axes, axes, atol=1e-12)


def test_reversals_are_counted_and_rounding_has_none():
    t = np.arange(1, 81) / 10.0
    force = np.stack([np.sin(2 * t), 1e-14 * np.cos(9 * t), 10 + 0 * t], axis=1)[:, None]
    found = petsam.loads.history(
        Forces("f", t, np.array([1]), np.zeros((1, 3)), force), ((0, 0, 0), (1, 0, 0), (0, 0, 1))
    )
    turns = {name: len(rows) for name, rows in found.turns().items()}
    assert turns == {**dict.fromkeys(LOADS, 0), "load_tx": 5}


# ---------------------------------------------------------------- a run


def test_petsam_runs_the_history(dovetail, tool, solve, tmp_path):
    """A flank's history on a flat punch: the loads of the steps that end its rows are theirs."""
    labels, x, force = dovetail
    table(tmp_path / "f.csv", labels, x, force)
    deck(tmp_path / "d.inp", labels, x)
    tool("f.csv", "--deck", "d.inp", "--patch", "RIGHT", option(FRAMES["RIGHT"]), "-o", "h.csv")
    rows = of_file(tmp_path / "h.csv")
    assert (tmp_path / "h.png").stat().st_size > 20000
    flat = dict(
        STEEL, grid_n=48, grid_size=1e-2, gap_type="punch", gap_flat_radius=3e-3, gap_edge_radius=1e-2, friction=0.9
    )
    result = solve(flat, dict(history=tmp_path / "h.csv", steps=2))
    with petsam.open(result.path) as run:
        for k, name in enumerate(LOADS):
            assert np.allclose(
                run.history[name][1::2], rows[:, k + 1], rtol=1e-6, atol=1e-6 * np.abs(rows[:, k + 1]).max()
            )
        pressure = run.field("pressure", -1)
        found = petsam.loads.history(
            petsam.loads.read(tmp_path / "f.csv", deck=tmp_path / "d.inp"), FRAMES["RIGHT"], patch="RIGHT"
        )
        assert np.sum(pressure * run.x) / np.sum(pressure) == pytest.approx(found.center[-1, 0], rel=1e-6)
        assert np.sum(pressure * run.y[:, None]) / np.sum(pressure) == pytest.approx(found.center[-1, 1], rel=1e-6)


def test_pressure_of_the_analysis_is_drawn_beside_petsams(tool, solve, tmp_path):
    """A table with CPRESS of a Hertzian contact: nodes along y = 0, whose pressure is petsam's within its cells."""
    radius, modulus, load = 0.1, 210e9 / (2 * (1 - 0.3**2)), 500.0
    a = (3 * load * radius / (4 * modulus)) ** (1 / 3)
    peak = 3 * load / (2 * np.pi * a**2)
    lines = ["label,x [mm],y [mm],z [mm],fx [N],fy [N],fz [N],cpress [GPa],cshear1,cshear2,time"]
    for time in (1, 2):
        for k, (i, j) in enumerate((i, j) for i in range(-5, 6) for j in range(-5, 6)):
            p = float(peak * np.sqrt(max(0.0, 1 - (i * i + j * j) / 25)) * 1e-9)
            lines.append(f"{k + 1},{i * a * 200!r},{j * a * 200!r},0,0,0,{load / 121!r},{p!r},3,4,{time}")
    (tmp_path / "c.csv").write_text("\n".join(lines))
    words = ("c.csv", "--frame", "0,0,0:1,0,0:0,0,1", "-o", "h.csv")
    tool(*words)
    ball = dict(
        STEEL, grid_n=64, grid_size=3 * a, gap_type="sphere", gap_radius1=radius, gap_radius2="inf", friction=0.9
    )
    path = solve(ball, dict(history=tmp_path / "h.csv")).path
    out, _ = tool(*words, "--compare", path)
    assert "wrote h-beside.png" in out and (tmp_path / "h-beside.png").stat().st_size > 15000
    found = petsam.loads.history(petsam.loads.read(tmp_path / "c.csv"), ((0, 0, 0), (1, 0, 0), (0, 0, 1)))
    line = found.line(2.0)
    assert np.allclose(line["x"], np.arange(-5, 6) / 5 * a) and np.allclose(line["shear"], 5e6)
    with petsam.open(path) as run:
        ours = np.interp(line["x"], run.x, run.field("pressure", -1)[32])
        assert np.abs(ours - line["pressure"])[1:-1].max() < 0.02 * peak
        assert len(petsam.plot.loads_beside(found, run).axes) == 2
    with pytest.raises(Error, match="no row at time 7 s"):
        found.line(7.0)
    (tmp_path / "c.csv").write_text("\n".join(line.replace("cpress", "other") for line in lines))
    assert "has no CPRESS" in tool(*words, "--compare", path, check=3)[1]


def test_the_picture_has_the_moments(dovetail, files):
    name = list(FRAMES)[0]
    found = petsam.loads.history(petsam.loads.read(files[0], deck=files[1]), FRAMES[name], patch=name)
    panels = petsam.plot.loads(found).axes
    [moments] = [panel for panel in panels if panel.get_ylabel().startswith("moment, ")]
    assert [line.get_label() for line in moments.lines] == ["$M_x$", "$M_y$", "$M_z$"]
    unit = {"mN·m": 1e3, "N·m": 1.0}[moments.get_ylabel().partition(", ")[2]]
    for line, values in zip(moments.lines, found.loads[:, 3:].T):
        assert np.allclose(line.get_ydata(), unit * values) and np.allclose(line.get_xdata(), found.times)
    assert len(panels) == 5


# ---------------------------------------------------------------- remarks


def plate(force, x=None, **more):
    """The History of 25 nodes on a square of 4 mm with these forces (n, 25, 3), N."""
    grid = np.array([(i - 2.0, j - 2.0, 0.0) for i in range(5) for j in range(5)]) * 1e-3
    force = np.broadcast_to(force, (len(force), 25, 3))
    times = np.arange(1.0, len(force) + 1)
    forces = Forces("f.csv", times, np.arange(25), grid if x is None else grid + x, force, 1e-3, **more)
    return petsam.loads.history(forces, ((0, 0, 0), (1, 0, 0), (0, 0, 1)))


def pushing(rows=3):
    return np.tile([0.1, 0.0, 1.0], (rows, 25, 1))


def test_a_history_that_is_sound_has_no_remarks():
    assert plate(pushing()).notes == []


def test_rows_and_nodes_that_pull_are_told():
    force = pushing()
    force[1, :, 2] = -0.1
    notes = plate(force).notes
    [note] = [note for note in notes if "turns to pull in row 2 (time 2 s), N = -2.5 N" in note]
    assert "remove the rows, or give petsam the surfaces' -adhesion_work" in note
    force = pushing()
    force[2, :3, 2] = -0.5
    (note,) = plate(force).notes
    assert "nodes pull in row 3 (time 3 s): up to 3 nodes, 1.5 N in row 3" in note


def test_moments_beyond_the_patch_are_told():
    force = pushing()
    force[1, :, 2] = np.repeat([-1.0, -1.0, -1.0, 1.0, 2.5], 5)
    notes = plate(force).notes
    assert any("leaves the patch in row 2 (time 2 s), at x = " in note for note in notes), notes
    found = plate(force)
    assert found.center[1, 0] > found.extent[1, 0]


def test_a_patch_that_moves_or_turns_is_told():
    way = np.zeros((3, 1, 3))
    way[2, 0] = (2e-4, 0.0, 0.0)
    (note,) = plate(pushing(), way).notes
    assert "the patch moves by 0.2 mm in x, 0 in y, 0 in z until row 3" in note.replace("200 um", "0.2 mm")
    way[2, 0, 0] = 2e-5  # 0.5 % of the patch
    assert plate(pushing(), way).notes == []
    grid = np.array([(i - 2.0, j - 2.0, 0.0) for i in range(5) for j in range(5)]) * 1e-3
    turn = np.zeros((3, 25, 3))
    turn[1] = np.stack([-grid[:, 1], grid[:, 0], grid[:, 2]], axis=1) * np.sin(0.02) - grid * (1 - np.cos(0.02))
    (note,) = plate(pushing(), turn).notes
    assert "turns by 1.15 degrees until row 2" in note
    assert doubts._angle(grid, grid + turn[1]) == pytest.approx(0.02, rel=1e-9)


def test_nodes_off_the_plane_and_forces_that_cancel_are_told():
    (note,) = plate(pushing(), np.array([0.0, 0.0, 1e-4])).notes
    assert "100 um off the plane" in note or "0.1 mm off the plane" in note
    force = pushing()
    force[:, :, 0], force[:, ::2, 2] = 0.0, -0.92
    assert any("may have nodes of both bodies" in note for note in plate(force).notes)


def test_displacements_move_the_patch(dovetail, tmp_path):
    """ux, uy, uz of a table are added to the coordinates at their time."""
    labels, x, force = dovetail
    heads = "label,x [mm],y [mm],z [mm],fx [N],fy [N],fz [N],time [s]"
    path = table(tmp_path / "f.csv", labels, x, force, heads)
    lines = path.read_text().splitlines()
    moved = [lines[0] + ",ux [mm],uy [mm],uz [mm]"] + [
        f"{line},{k // 12 * 0.1},0,0" for k, line in enumerate(lines[1:])
    ]
    path.write_text("\n".join(moved) + "\n")
    forces = petsam.loads.read(path)
    assert forces.x.shape == (4, 12, 3) and np.allclose(forces.x[3], (x + [0.3, 0, 0]) * 1e-3, atol=1e-15)
    found = petsam.loads.history(forces, FRAMES["FLOOR"], patch=((-2, -2, -3), (2, 2, -1.5)))
    assert np.allclose(found.loads[3], by_hand("FLOOR", x[8:] + [0.3, 0, 0], force[3, 8:]), atol=1e-14)
    assert any("moves by" in note for note in found.notes)
    other = table(tmp_path / "g.csv", labels, x + np.arange(4)[:, None, None] * [0.1, 0, 0], force)
    assert np.allclose(petsam.loads.read(other).x, forces.x, atol=1e-12)


# ---------------------------------------------------------------- formats


def dat(labels, force):
    """A .dat of CalculiX, as its FORTRAN writes it."""
    lines = []
    for time, rows in zip(TIMES, force):
        for k, (name, some) in enumerate(labels.items()):
            lines += ["", f" forces (fx,fy,fz) for set {name} and time  {time:13.7E}", ""]
            lines += ["{:10d} {:13.6E} {:13.6E} {:13.6E}".format(n, *f) for n, f in zip(some, rows[4 * k : 4 * k + 4])]
    return "\n".join(lines) + "\n"


def frd(labels, x, force):
    """A .frd of CalculiX."""
    every = np.concatenate(list(labels.values()))

    def rows(values):
        return [f" -1{n:10d}" + "".join(f"{value:12.5E}" for value in one) for n, one in zip(every, values)] + [" -3"]

    lines = ["    1C", f"    2C{'':18}{len(every):12d}{'':37}1", *rows(x)]
    for k, (time, one) in enumerate(zip(TIMES, force), 1):
        lines += [f"    1PSTEP{k:26d}{k:12d}{1:12d}"]
        lines += [f"  100CL{100 + k:5d}{time:12.9f}{len(every):12d}{'':21}0{k:5d}{'':11}1"]
        lines += [" -4  FORC        4    1", " -5  F1          1    2    1    0", *rows(one)]
    return "\n".join([*lines, " 9999"]) + "\n"


def report(labels, force, shear=0.25):
    """A field output report of Abaqus in two steps, CNORMF and CSHEARF the parts of each force."""
    lines = []
    for k, (time, rows) in enumerate(zip(TIMES, force)):
        step, at = (1, time) if k < 2 else (2, time - TIMES[1])
        lines += ["*" * 80, "Field Output Report, written Mon Jan  5 10:00:00 2026", "", "Source 1", "---------", ""]
        lines += [
            "   ODB: job.odb",
            f"   Step: Step-{step}",
            f"   Frame: Increment      {k + 1}: Step Time = {at:10.4f}",
            "",
        ]
        lines += ["Loc 1 : Nodal values from source 1", "", 'Output sorted by column "Node Label".', ""]
        for name, some, some_rows in zip(labels, labels.values(), np.split(rows, 3)):
            lines += [f"Field Output reported at nodes for part: {name}-1", ""]
            heads = [f"CNORMF.CNORMF{i}" for i in (1, 2, 3)] + [f"CSHEARF.CSHEARF{i}" for i in (1, 2, 3)]
            lines += ["            Node  " + "  ".join(heads), "           Label" + "          @Loc 1" * 6, "-" * 110]
            lines += [
                f"{n:16d} " + " ".join(f"{v:15.7E}" for v in (*((1 - shear) * f), *(shear * f)))
                for n, f in zip(some, some_rows)
            ]
            lines += [
                "",
                "",
                "  Minimum    " + "   1.0E+00" * 6,
                "      At Node      " + "  5" * 6,
                "",
                "  Total    1.",
                "",
            ]
    return "\n".join(lines) + "\n"


def engineering(value):
    """A number as reports have it: exponents are multiples of three."""
    power = 0 if value == 0.0 else 3 * int(np.floor(np.log10(abs(value)) / 3.0))
    mantissa = f"{value / 10.0**power:.6f}".rstrip("0")
    return mantissa if power == 0 else f"{mantissa}E{power:+03d}"


FIELDS = [
    f"{field}.{part}" for field in ("CNORMF", "CSHEARF") for part in ("Magnitude", *(f"{field}{k}" for k in "123"))
]


def fields_of(force, shear=0.25):
    """Columns FIELDS of nodes with these forces."""
    parts = [(1 - shear) * force, shear * force]
    return np.hstack([np.hstack([np.linalg.norm(part, axis=1)[:, None], part]) for part in parts])


def frames_of(force, initial=False):
    """(step, increment, step time, forces) in two steps; `initial`: the second one begins with the end of the first."""
    frames = [(1 + (k > 1), k + 1, time - (k > 1) * TIMES[1], rows) for k, (time, rows) in enumerate(zip(TIMES, force))]
    return frames[:2] + [(2, 0, 0.0, force[1])] * initial + frames[2:]


def table_of(labels, rows, heads, width=None, footer=True):
    """A table of a report in text, its lines not longer than `width` columns of numbers."""
    parts = np.split(np.arange(len(heads)), range(width, len(heads), width)) if width else [np.arange(len(heads))]
    lines = []
    for k, part in enumerate(parts):
        top, below = ("            Node", "           Label") if k == 0 else ("", "")
        lines += [top + "".join(f"  {heads[j]:>16}" for j in part), below + f"{'@Loc 1':>18}" * len(part)]
        lines += ["-" * len(lines[-1])]
    for label, row in zip(labels, rows):
        for k, part in enumerate(parts):
            words = (one if isinstance(one, str) else engineering(one) for one in (row[j] for j in part))
            lines.append((f"{label:16d}" if k == 0 else "") + "".join(f"{word:>18}" for word in words))
    if footer:
        lines += [
            "",
            "",
            "  Minimum " + f"{'0.':>18}" * len(heads),
            "",
            "         At Node" + f"{labels[0]:18d}" * len(heads),
        ]
        lines += ["  Maximum " + f"{'0.':>18}" * len(heads), "", "         At Node" + f"{labels[0]:18d}" * len(heads)]
        lines += ["", "           Total" + f"{'0.':>18}" * len(heads)]
    return [*lines, "", ""]


def frame_of(step, increment, time):
    """The lines above the tables of a frame."""
    return [
        "*" * 80, "Field Output Report, written Mon Jan  5 10:00:00 2026", "", "Source 1", "---------", "",
        "   ODB: C:/jobs/dovetail.odb", f"   Step: Step-{step}",
        f"   Frame: Increment {increment:6d}: Step Time = {time:8.4g}", "",
        "Loc 1 : Nodal values from source 1", "", 'Output sorted by column "Node Label".', "",
    ]  # fmt: skip


def reported(labels, force, heads=FIELDS, region="{}-1", separate=False, initial=False, apart=False, **more):
    """A report in text; `separate`: a table for each column, `apart`: a report for each field."""
    lines = []
    for some in (range(4), range(4, 8)) if apart else (range(8),):
        for *frame, rows in frames_of(force, initial):
            lines += frame_of(*frame)
            values = fields_of(rows)
            for k, (name, own) in enumerate(labels.items()):
                lines += [f"Field Output reported at nodes for region: {region.format(name)}"]
                lines += ["   Computation algorithm: EXTRAPOLATE_COMPUTE_AVERAGE", "   Averaged at nodes", ""]
                for part in [[j] for j in some] if separate else [list(some)]:
                    lines += table_of(own, values[4 * k : 4 * k + 4, part], [heads[j] for j in part], **more)
    return "\n".join(lines) + "\n"


def valued(labels, x, force, initial=False):
    """A report in comma-separated values, coordinates included, one head for each frame."""
    lines = []
    for step, increment, time, rows in frames_of(force, initial):
        heads = ["ODB Name", "Step", "Frame", "Part Instance Name", "Node Label", "X", "Y", "Z"]
        lines.append(", ".join([*heads, *(f"{name.replace('.', '-'):>15}" for name in FIELDS), "CSTATUS"]))
        values = fields_of(rows)
        for k, (name, own) in enumerate(labels.items()):
            for j, label in enumerate(own, 4 * k):
                frame = f"Increment {increment:6d}: Step Time = {time:8.4g}"
                words = ["C:/jobs/dovetail.odb", f"Step-{step}", frame, f"{name}-1", f"{label:10d}"]
                words += [*map(repr, x[j].tolist()), *map(engineering, values[j]), "NoValue"]
                lines.append(", ".join(words))
    return "\n".join(lines) + "\n"


PAIR = "ASSEMBLY_BLADE_FLANKS/ASSEMBLY_DISC_FLANKS"


@pytest.mark.parametrize(
    "kind", ["wide", "wrapped", "narrow", "separate", "apart", "sets", "no footers", "initial frames", "pair", "values"]
)
def test_reports_as_abaqus_lays_them_out(kind, rounded, tmp_path):
    """Invariants, limited pages, a table for each column, a report for each field, sets of an instance, columns of one
    pair of surfaces, the frame at time 0 of a later step, comma-separated values."""
    labels, x, force = rounded
    plain = petsam.loads.read(table(tmp_path / "plain.csv", *rounded))
    model = assembly if kind == "sets" else deck
    given, path = dict(length="mm", force="N", deck=model(tmp_path / "d.inp", labels, x)), tmp_path / "job.rpt"
    more = {
        "wrapped": dict(width=5), "narrow": dict(width=1), "separate": dict(separate=True), "apart": dict(apart=True),
        "sets": dict(region="{0}-1.{0}_NODES"), "no footers": dict(footer=False), "initial frames": dict(initial=True),
        "pair": dict(heads=[name.replace(".", f"   {PAIR}.") for name in FIELDS]),
    }.get(kind, {})  # fmt: skip
    path.write_text(valued(labels, x, force) if kind == "values" else reported(labels, force, **more))
    found = petsam.loads.read(path, **given)
    assert np.array_equal(found.labels % 10**6, plain.labels) and np.allclose(found.times, plain.times, rtol=1e-9)
    assert np.allclose(found.x, plain.x, rtol=1e-12, atol=1e-15)
    assert np.allclose(found.force, plain.force, rtol=4e-6, atol=1e-7)
    assert np.allclose(found.normal, 0.75 * plain.force, rtol=4e-6, atol=1e-7)
    assert any("at step time 0" in note for note in found.notes) is (kind == "initial frames")
    own = found.labels[found.nodes("RIGHT-1.RIGHT_NODES" if kind == "sets" else "RIGHT-1")]
    assert np.array_equal(own % 10**6, labels["RIGHT"])


def test_comma_separated_values_have_their_coordinates(rounded, tmp_path):
    labels, x, force = rounded
    (tmp_path / "job.csv").write_text(valued(labels, x, force, initial=True))
    found = petsam.loads.read(tmp_path / "job.csv", length="mm", force="N")
    assert np.allclose(np.sort(found.x, axis=0), np.sort(1e-3 * x, axis=0)) and len(found.times) == len(TIMES)


@pytest.mark.parametrize("word", ["NoValue", "No Value"])
def test_nodes_without_a_value_have_no_force(word, rounded, tmp_path):
    labels, x, force = rounded
    text = reported(labels, force).splitlines()
    outer = f"{99:16d}" + f"  {word:>16}" * len(FIELDS)
    lines = [one for line in text for one in ([outer, line] if line.startswith(" " * 15 + "1 ") else [line])]
    (tmp_path / "job.rpt").write_text("\n".join(lines) + "\n")
    found = petsam.loads.read(tmp_path / "job.rpt", deck(tmp_path / "d.inp", labels, x), "mm", "N")
    assert np.array_equal(found.labels, np.concatenate([*labels.values()])) and not found.notes


def test_sums_without_friction_are_told(rounded, tmp_path):
    labels, x, force = rounded
    text = "\n".join(reported(labels, force, apart=True).splitlines()[: len(reported(labels, force).splitlines())])
    (tmp_path / "job.rpt").write_text(text)
    found = petsam.loads.read(tmp_path / "job.rpt", deck(tmp_path / "d.inp", labels, x), "mm", "N")
    assert any("no CSHEARF in the file" in note for note in found.notes)
    assert np.allclose(found.force, found.normal)


@pytest.fixture(scope="module")
def rounded(dovetail):
    """The forces in five digits, which all formats keep, and coordinates of few digits."""
    labels, x, force = dovetail
    return labels, np.round(x, 4), np.vectorize(lambda v: float(f"{v:.5E}"))(force)


@pytest.mark.parametrize(
    "kind", ["semicolon", "comma in decimals", "tab", "bom", "utf-16", "shuffled", "dat", "frd", "report"]
)
def test_all_formats_give_the_same_numbers(kind, rounded, tmp_path):
    labels, x, force = rounded
    plain = petsam.loads.read(table(tmp_path / "plain.csv", *rounded))
    units, where, path = dict(length="mm", force="N"), deck(tmp_path / "d.inp", labels, x), tmp_path / "other.txt"
    given = {}
    if kind in ("semicolon", "tab", "comma in decimals"):
        mark = "\t" if kind == "tab" else ";"
        form = (lambda v: repr(v).replace(".", ",")) if kind == "comma in decimals" else repr
        heads = "Node Label,x (mm),y (mm),z (mm),Fx (kN),FY (kN),fz (kN),time"
        table(path, labels, x, force * 1e-3, heads, form, mark)
    elif kind in ("bom", "utf-16"):
        text = table(path, labels, x, force, "node,X,Y,Z,fx,fy,fz,total time").read_text()
        path.write_bytes(text.encode("utf-8-sig" if kind == "bom" else "utf-16"))
        given = units
    elif kind == "shuffled":
        head, *lines = table(path, *rounded).read_text().splitlines()
        np.random.default_rng(3).shuffle(lines)
        path.write_text("# a comment\n" + "\n".join([head, *lines]))
    else:
        path.write_text(
            dat(labels, force) if kind == "dat" else frd(labels, x, force) if kind == "frd" else report(labels, force)
        )
        given = dict(units, deck=where)
    found = petsam.loads.read(path, **given)
    assert np.array_equal(found.labels, plain.labels) and np.allclose(found.times, plain.times, rtol=1e-9)
    assert np.allclose(found.x, plain.x, rtol=1e-12, atol=1e-15)
    assert np.allclose(found.force, plain.force, rtol=2e-6, atol=1e-9)
    if kind == "report":
        assert np.allclose(found.normal, 0.75 * plain.force, rtol=2e-6, atol=1e-9)
        assert {"LEFT-1", "RIGHT-1", "FLOOR-1", "LEFT"} <= set(found.sets)
    if kind in ("dat", "frd", "report"):
        assert found.labels[found.nodes("RIGHT")].tolist() == labels["RIGHT"].tolist()


PAIRS = """
 statistics for slave set S2, master set S1 and time  {time}

   total surface force (fx,fy,fz) and moment about the origin (mx,my,mz)

   -9.522102E-01  6.873842E-16  5.172414E+01  2.586207E+01 -2.681556E+01  4.761051E-01

   center of gravity and mean normal

    5.000298E-01  5.000000E-01  9.997241E-01  0.000000E+00 -5.521737E-19 -1.000000E+00

   moment about the center of gravity(mx,my,mz)

   -1.015389E-12  2.063949E-10  7.771561E-16

   area,  normal force (+ = tension) and shear force (size)

    1.000000E+00 -5.172414E+01  9.522102E-01
"""


def test_the_force_of_a_contact_pair_of_calculix(tmp_path):
    """As CalculiX 2.20 wrote it: the slave is the upper body; its moment about the origin of the frame by hand."""
    path = tmp_path / "a.dat"
    path.write_text(PAIRS.format(time="0.5000000E+00") + PAIRS.format(time="0.1000000E+01"))
    forces = petsam.loads.read(path, length="mm", force="N")
    found = petsam.loads.history(forces, ((0.2, 0.1, 1), (1, 0, 0), (0, 0, -1)), patch="S2", on="body1")
    force, moment = np.array([-0.9522102, 0.0, 51.72414]), np.array([25.86207, -26.81556, 0.4761051]) * 1e-3
    about = -(moment - np.cross([0.2e-3, 0.1e-3, 1e-3], force))  # on body 2
    # y = z x x = -y of the model, so the frame's components are (x, -y, -z)
    expected = [51.72414, 0.9522102, 0.0, -about[0], about[1], -about[2]]
    assert found.loads[1] == pytest.approx(expected, abs=1e-9) and found.times.tolist() == [0.5, 1.0]


def test_an_element_surface_of_the_deck_is_a_set(tmp_path):
    (tmp_path / "d.inp").write_text(
        "*NODE\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n5,0,0,1\n6,1,0,1\n7,1,1,1\n8,0,1,1\n*ELEMENT,TYPE=C3D8,ELSET=E\n"
        "1,1,2,3,4,5,6,7,8\n*SURFACE,NAME=TOP\nE,S2\n*RIGID BODY, REF NODE=1, ELSET=E\n"
    )
    lines = [f"{n},{n},0,{n},1" for n in range(1, 9)]
    (tmp_path / "f.csv").write_text("\n".join(["label,fx [N],fy [N],fz [N],increment", *lines]))
    forces = petsam.loads.read(tmp_path / "f.csv", deck=tmp_path / "d.inp", length="mm")
    assert forces.labels[forces.nodes("top")].tolist() == [5, 6, 7, 8]
    found = petsam.loads.history(forces, ((0, 0, 1), (1, 0, 0), (0, 0, 1)), patch="TOP")
    assert found.loads[0, 0] == 26.0


# ---------------------------------------------------------------- refusals

GOOD = "label,x [mm],y [mm],z [mm],fx [N],fy [N],fz [N],time\n"


@pytest.mark.parametrize(
    "text, complaint",
    [
        (GOOD + "1,0,0,0,1,1,one,0\n", "line 2: one in column fz is no finite number"),
        (GOOD + "1,0,0,0,1,1,nan,0\n", "line 2: nan in column fz"),
        (GOOD + "1,0,0,0,1,1,1,0\n2,0,0,0,1,1,,0\n", "line 3: an empty word in column fz"),
        (GOOD + "1,0,0,0,1,1,1,0\n2,0,0,0,1\n", "line 3 has 5 words, line 1 has 8 heads"),
        (GOOD + "1.5,0,0,0,1,1,1,0\n", "line 2: 1.5 in column label is no label"),
        (GOOD + "1,0,0,0,1,1,1,0\n1,0,0,0,1,1,2,0\n", "line 3: node 1 has two forces at time 0"),
        (GOOD + "1,0,0,0,0,0,0,0\n", "all forces are 0"),
        (GOOD, "no lines of forces"),
        ("", "is empty"),
        (GOOD.replace("label", "name"), "line 1: has no column label"),
        (GOOD.replace("fy [N],", ""), "line 1: has no column fy"),
        (GOOD.replace("fy [N]", "fy [kN]"), "its columns of force are in several units (N, kN)"),
        (GOOD.replace("fy", "fx"), "two columns are fx"),
        (GOOD.replace("time", "when"), "has no column time or increment"),
        ("\0\0\0", "bytes of 0"),
        (GOOD.replace("time", "time [h]") + "1,0,0,0,1,1,1,0\n", "line 1: time in h: use s, ms"),
        (" forces (fx,fy,fz) for set A and time  0.5\n\n   1 1.0 2.0\n", "line 3: expected a node and three numbers"),
        (" forces (fx,fy,fz) for set A and time  0.5\n\n   1 1.0 2.0 x\n", "line 3: x is no number"),
        ("    1C\n    2C" + " " * 67 + "2\n", "line 2: is binary"),
        ("    1C\n", "has no forces"),
        ("Field Output Report\n", "has no CNORMF1 to 3"),
        (" THE FOLLOWING TABLE IS PRINTED FOR NODES BELONGING TO NODE SET TIP\n\n NODE FOOT- RF1\n", ".dat) of Abaqus"),
    ],
)  # fmt: skip
def test_bad_files_are_refused_with_their_line(text, complaint, tool, tmp_path):
    (tmp_path / "bad.csv").write_text(text)
    _, err = tool("bad.csv", "--frame", "auto", check=3)
    assert "bad.csv: " in err and complaint in err, err
    assert sorted(os.listdir(tmp_path)) == ["bad.csv"]


def test_a_damaged_report_names_its_line(rounded, tool, tmp_path):
    deck(tmp_path / "d.inp", *rounded[:2])
    text = report(rounded[0], rounded[2])
    place = next(k for k, line in enumerate(text.splitlines(), 1) if line.startswith(" " * 15 + "1 "))
    for old, new, complaint in (
        (text.splitlines()[place - 1], " 1 2.0", f"line {place}: has 2 words"),
        (
            text.splitlines()[place - 1],
            text.splitlines()[place - 1][:-4] + "x",
            f"line {place}: has a word that is no number",
        ),
        ("Step Time =     0.5000", "", "the frame has no Step Time"),
    ):
        (tmp_path / "job.rpt").write_text(text.replace(old, new, 1))
        words = ("job.rpt", "--deck", "d.inp", "--length", "mm", "--force", "N", "--frame", "auto")
        assert complaint in tool(*words, check=3)[1]


@pytest.mark.parametrize(
    "old, new, complaint",
    [
        (f"CNORMF   {PAIR}.CNORMF2", "CNORMF   A_TOP/B_TOP.CNORMF2", "report one pair of surfaces per file"),
        (f"CNORMF   {PAIR}.CNORMF2", "CNORMF.CNORMF1", "has cnormf1 twice: report one frame per table"),
        (f"CNORMF   {PAIR}.CNORMF3", "S.Mises", "has no CNORMF3: report all three components"),
        ("LEFT-1", "NOSE-1", "no instance NOSE-1 in the deck"),
    ],
)  # fmt: skip
def test_reports_that_cannot_be_summed_are_refused(old, new, complaint, rounded, tool, tmp_path):
    labels, x, force = rounded
    assembly(tmp_path / "d.inp", labels, x)
    heads = [name.replace(".", f"   {PAIR}.") for name in FIELDS]
    text = reported(labels, force, heads=heads)
    (tmp_path / "job.rpt").write_text(text.replace(old, new))
    words = ("job.rpt", "--deck", "d.inp", "--length", "mm", "--force", "N", "--frame", "auto")
    assert complaint in tool(*words, check=3)[1]


def test_a_narrow_report_that_lacks_a_line_or_repeats_a_frame_is_refused(rounded, tool, tmp_path):
    labels, x, force = rounded
    assembly(tmp_path / "d.inp", labels, x)
    lines = reported(labels, force, width=5).splitlines()
    row = next(k for k, line in enumerate(lines) if line.startswith(" " * 15 + "2 "))
    other = reported(labels, 2.0 * force, width=5)
    for text, complaint in (
        ("\n".join(lines[: row + 1] + lines[row + 2 :]), f"line {row + 2}: has 6 words, the table's head 3"),
        ("\n".join(lines[: row + 1]), f"line {row + 1}: node 2 lacks words of its row"),
        ("\n".join(lines) + other, "report each frame once"),
    ):
        (tmp_path / "job.rpt").write_text(text)
        words = ("job.rpt", "--deck", "d.inp", "--length", "mm", "--force", "N", "--frame", "auto")
        assert complaint in tool(*words, check=3)[1]


@pytest.mark.parametrize(
    "words, code, complaint",
    [
        (["f.csv"], 2, "--frame: give the frame"),
        (["f.csv", "--frame", "1,2"], 2, "--frame"),
        (["f.csv", "--frame", "0,0,0:0,0,1:0,0,1"], 3, "x and z of --frame are parallel"),
        (["f.csv", "--frame", "0,0,0:1,0,0:0,0,0"], 2, "its z is 0"),
        (["f.csv", "--frame", "0,0,0:0,1,0:0,0,1", "--patch", "FLOOR", "--deck", "d.inp"], 2, "the forces press out"),
        (["f.csv", "--frame", "auto"], 2, "not in a plane"),
        (["f.csv", "--frame", "auto", "--length", "m"], 2, "is in mm, not in m: remove --length"),
        (["u.csv", "--frame", "auto"], 2, "does not say the unit of its coordinates: give --length"),
        (["u.csv", "--frame", "auto", "--length", "mm"], 2, "does not say the unit of its forces: give --force"),
        (["u.csv", "--frame", "auto", "--length", "N", "--force", "N"], 2, "--length N: use one of m, cm, mm"),
        (["u.csv", "--frame", "auto", "--length", "mm", "--force", "kg"], 2, "--force kg: use one of N"),
        (["f.csv", "--frame", "auto", "--patch", "NOSE"], 3, "no set of nodes NOSE"),
        (["f.csv", "--frame", "auto", "--patch", "RIHGT", "--deck", "d.inp"], 3, "is RIGHT meant?"),
        (["f.csv", "--frame", "auto", "--patch", "a=9,9,9:10,10,10"], 3, "has none of the nodes"),
        (["f.csv", "--frame", "auto", "--patch", "a=1,2:3,4"], 2, "a box of two corners"),
        (["f.csv", "--frame", "auto", "--patch", "../a"], 2, "NAME=SET"),
        (["f.csv", "--frame", "auto", "--patch", "a=LEFT", "--patch", "a=RIGHT"], 2, "give each name once"),
        (["f.csv", "--frame", "auto", "--frame", "auto", "--patch", "LEFT"], 2, "--frame: 2 frames"),
        (["f.csv", "--frame", "auto", "-o", "f.csv"], 3, "f.csv: is an input file"),
        (["f.csv", "--frame", "auto", "-o", "h.txt"], 2, "ends in .csv"),
        (["f.csv", "--frame", "auto", "--patch", "LEFT", "--patch", "RIGHT", "-o", "h.csv"], 2, "file of one patch"),
        (["f.csv", "--frame", "auto", "--on", "body3"], 2, "--on"),
        (["none.csv", "--frame", "auto"], 3, "none.csv: no such file"),
        (["n.csv", "--frame", "auto", "--length", "mm"], 2, "has no coordinates of its nodes: give the "),
        (["n.csv", "--frame", "auto", "--length", "mm", "--deck", "d.inp"], 3, "line 2: node 99 has no coordinates"),
    ],
)  # fmt: skip
def test_absurd_options_are_refused(words, code, complaint, files, tool, tmp_path):
    (tmp_path / "u.csv").write_text("label,x,y,z,fx,fy,fz,time\n1,0,0,0,0,0,1,0\n")
    (tmp_path / "n.csv").write_text("label,fx [N],fy [N],fz [N],time\n99,0,0,1,0\n")
    before = {name: (tmp_path / name).read_bytes() for name in os.listdir(tmp_path)}
    assert complaint in tool(*words, check=code)[1]
    assert before == {name: (tmp_path / name).read_bytes() for name in os.listdir(tmp_path)}


def test_calls_refuse_what_the_command_does(files):
    forces = petsam.loads.read(files[0])
    for more, complaint in (
        (dict(on="2"), "--on 2"),
        (dict(frame="own"), "--frame own"),
        (dict(frame=((0, 0),)), "--frame"),
    ):
        with pytest.raises(Unusable, match=complaint):
            petsam.loads.history(forces, **more)
    with pytest.raises(Error, match="no set of nodes"):
        petsam.loads.history(forces, patch="LEFT")

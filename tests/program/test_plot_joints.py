"""Pictures of bolted joints: change of the frequency, damping, zones of stick and slip, bolts."""

import h5py
import numpy as np
import pytest
from matplotlib.colors import to_rgb

import petsam
from petsam.apps.compliance import bolts
from petsam.apps.joint.backbones import COLUMNS, Backbone
from petsam.apps.joint.bands import Band
from petsam.apps.joint.wearing import Wear
from petsam.plot.fields import STATES
from petsam.results.fields import OPEN, SLIP, STICK
from test_backbone import OPTIONS, PRELOAD, pair_file

pytestmark = pytest.mark.usefixtures("closing")

FIRST = 100.0  # Hz
CENTERS = (-30e-3, 30e-3)  # x of the patches, m
PLACES = {"L": (-30e-3, 1e-3, 8e-3), "R": (31e-3, 0.0, 6e-3), "far": (0.5, 0.0, 8e-3)}


def made(patches=1, lower=0.0, viscous=0.0, slips=True):
    """A backbone whose frequency falls by 0.01, 0.02 and 0.04 %, and `lower` more."""
    numbers = {name: np.zeros(3) for name in COLUMNS if name != "damping_error"}  # of companion runs
    numbers.update(
        amplitude=np.array([1e-5, 3e-5, 1e-4]),
        alpha=np.array([1.0, 3.0, 10.0]),
        frequency=FIRST * (1.0 - 1e-2 * (np.array([0.01, 0.02, 0.04]) + lower)),
        damping=np.array([1e-4, 2e-4, 4e-4]),
        viscous=np.full(3, viscous),
    )
    along = np.linspace(-0.02, 0.02, 21)
    inside = np.hypot(*np.meshgrid(along, along)) < 0.01
    pressure = [1e6 * (k + 1) * inside for k in range(patches)]
    states = [inside * np.where(slips and along < 0.0, SLIP, STICK) for _ in range(patches)]
    axes = [(along + CENTERS[k], along) for k in range(patches)]
    names = [f"patch{k + 1}" for k in range(patches)]
    shape, stuck = np.ones(1), np.array([FIRST])
    return Backbone(FIRST, shape, numbers, np.zeros((3, patches)), names, np.nan, stuck, "m", pressure, states, axes)


def test_the_frequency_is_drawn_as_its_change_and_the_last_numbers_stand_in_the_picture():
    left, right = petsam.plot.backbone(made()).axes
    assert left.get_ylabel() == "change of frequency, %" and left.get_xlabel() == "amplitude, µm"
    assert left.get_title() == "Frequency: 100 Hz while all that touches sticks"
    assert left.lines[-1].get_ydata() == pytest.approx([-0.01, -0.02, -0.04])
    assert [ax.texts[0].get_text() for ax in (left, right)] == ["\N{MINUS SIGN}0.04 %", "0.04 %"]
    assert right.get_title() == "Damping by friction"
    right = petsam.plot.backbone(made(viscous=1e-3)).axes[1]
    assert right.get_title() == "Damping by friction and material"
    assert right.lines[-1].get_ydata() == pytest.approx([0.11, 0.12, 0.14])


def test_a_band_and_wear_have_the_change_of_frequency():
    found = Band({"as given": made(), "without friction": made(lower=0.01)}, {"friction": (made(lower=0.002), made())})
    left, right = petsam.plot.band(found).axes
    assert left.get_title() == "Frequency: 100 Hz while all that touches sticks"
    area = left.collections[0].get_paths()[0].vertices[:, 1]
    assert (area.min(), area.max()) == pytest.approx((-0.05, -0.01))
    bar = left.containers[0].lines[2][0].get_segments()[0]
    assert bar[:, 1] == pytest.approx([-0.011, -0.009])
    markers = [one.lines[0].get_marker() for one in left.containers]
    assert len(set(markers)) == len(markers) == 2 and right.get_legend()
    numbers = {name: np.zeros(2) for name in ("energy", "volume", "damping_error")}
    numbers.update(cycles=np.array([0.0, 1e5]), frequency=np.array([50.0, 50.5]), frequency_error=np.array([0.0, 0.05]))
    left = petsam.plot.joint_wear(Wear({**numbers, "damping": np.array([1e-3, 2e-3])}, {}, [])).axes[0]
    assert left.containers[0].lines[0].get_ydata() == pytest.approx([0.0, 1.0])
    assert left.get_title() == "Frequency: 50 Hz without wear"


def test_zones_name_the_bolts_whose_axes_cross_the_patch():
    figure = petsam.plot.slip_zones(made(2), bolts=PLACES)
    panels = [panel for panel in figure.axes if panel.get_title()]
    assert [panel.get_title() for panel in panels] == [
        f"patch{k}, bolt {name}: {what}"
        for k, name in ((1, "L"), (2, "R"))
        for what in ("preload", "largest amplitude")
    ]
    for panel, name in zip(panels, "LLRR"):
        x, y, diameter = PLACES[name]
        assert [text.get_text() for text in panel.texts] == [name]
        ring = np.array(panel.lines[-1].get_data())
        assert np.ptp(ring, axis=1) == pytest.approx(1e3 * diameter, rel=5e-3)
        assert np.array([ring.min(axis=1), ring.max(axis=1)]).mean(axis=0) == pytest.approx(
            (1e3 * x, 1e3 * y), abs=0.02
        )
    assert [one.get_title() for one in petsam.plot.slip_zones(made()).axes if one.get_title()][0] == "patch1: preload"


def test_slip_is_told_from_stick_without_colour():
    """By hatches, and by lightness."""
    panel = petsam.plot.slip_zones(made()).axes[1]
    (hatched,) = [one for one in panel.collections if getattr(one, "hatches", None)]
    x, _ = np.concatenate([path.vertices for path in hatched.get_paths()]).T
    assert x.max() < 1e3 * CENTERS[0] and [bool(one.get_hatch()) for one in panel.get_legend().get_patches()] == [0, 1]
    none = petsam.plot.slip_zones(made(slips=False)).axes[1]
    assert not [one for one in none.collections if getattr(one, "hatches", None)]
    light = {k: np.dot((0.3, 0.59, 0.11), to_rgb(STATES[k][1])) for k in STATES}
    assert light[OPEN] > light[SLIP] + 0.2 > light[STICK] + 0.4


def test_pressures_of_all_patches_have_one_scale():
    meshes = [panel.collections[0] for panel in petsam.plot.slip_zones(made(2)).axes if "preload" in panel.get_title()]
    assert [one.get_clim() for one in meshes] == [(0.0, 2.0)] * 2


def test_a_pair_knows_the_places_of_its_bolts(tmp_path):
    path = pair_file(tmp_path / "pair.h5", 1.0)
    assert petsam.joint.Pair(path, PRELOAD, **OPTIONS).places == {}  # a file without them
    with h5py.File(path, "a") as file:
        file["bolts/B/place"], file["bolts/B/diameter"] = np.array([0.1, -0.2]), 0.3
    assert petsam.joint.Pair(path, PRELOAD, **OPTIONS).places == {"B": (0.1, -0.2, 0.3)}


def test_a_bolt_is_where_its_axis_crosses_the_plane_of_the_contact():
    start, along = np.array([1.0, 2.0, -1.0]), np.array([0.4, 0.0, 4.0])
    assert bolts.crossing(start, along) == pytest.approx([1.1, 2.0])
    assert bolts.crossing(start, np.array([2.0, 0.0, 0.0])) == pytest.approx([2.0, 2.0])

"""petsam-stress -fatigue_length: parameters of stresses averaged over a length, against means of stresses at depths."""

import h5py
import numpy as np
import pytest

import conftest
from support import SPHERE, hertz, slide_limit

PROGRAM = conftest.PROGRAM.with_name("petsam-stress")
COMPONENTS = ("xx", "yy", "zz", "xy", "xz", "yz")
ALPHA = 0.2
CYCLE = dict(fatigue="crossland,findley,swt", fatigue_crossland_alpha=ALPHA, fatigue_findley_k=0.3, steps="2:3")


def run_contact(launcher, folder, n):
    case = dict(SPHERE, friction=0.5, grid_n=(n, 31), history="h.csv", output=f"c{n}.h5")
    radius = hertz(case).radius
    case["grid_size"] = (2.5 * radius, 2.6 * radius)
    t = 0.7 * slide_limit(case)[0]
    (folder / "h.csv").write_text(f"time,load_tx,load_ty\n1,{t},0\n2,{-t},{t / 5}\n3,{t},0\n")
    conftest.execute(launcher, folder, [case], 1, 0)
    return radius


@pytest.fixture(scope="module")
def contact(launcher, tmp_path_factory):
    """The folder of a run, its contact radius, and a function that evaluates it: stress(name, options, ranks)."""
    folder = tmp_path_factory.mktemp("length")
    radius = run_contact(launcher, folder, 48)

    def stress(name, ranks=1, check=0, **options):
        case = dict(dict(input="c48.h5", output=f"{name}.h5"), **options)
        done = conftest.execute(launcher, folder, [case], ranks, check, program=PROGRAM)
        if check:
            return done
        with h5py.File(folder / f"{name}.h5") as f:
            return {key: f[key][()] for key in f if isinstance(f[key], h5py.Dataset)}

    return folder, radius, stress


def crossland(first, second):
    """Of two states (6, ...): the sphere about two points has half their distance as its radius."""
    half = (first - second) / 2
    mean = half[:3].mean(axis=0)
    norm = np.sqrt(((half[:3] - mean) ** 2).sum(axis=0) + 2 * (half[3:] ** 2).sum(axis=0))
    return norm / np.sqrt(2) + ALPHA * np.maximum(first[:3].mean(axis=0), second[:3].mean(axis=0))


def chord(values, half):
    """Means over lengths of 2 half cells about each cell of the last axis, of those on the grid."""
    n = values.shape[-1]
    edges = np.arange(n + 1)
    low, high = (np.clip(np.arange(n) + 0.5 + s * half, 0, n) for s in (-1, 1))
    part = np.clip(np.minimum(high[:, None], edges[1:]) - np.maximum(low[:, None], edges[:-1]), 0, None)
    return values @ part.T / (high - low)


@pytest.mark.parametrize("section", [None, "y=0", "x=2e-4"])
@pytest.mark.parametrize("average, reach", [("line", 2), ("area", 1)])
def test_means_are_those_of_many_depths(contact, section, average, reach):
    _, radius, stress = contact
    length, n = 0.15 * radius, 160
    place = {} if section is None else dict(section=section)
    got = stress("mean", fatigue_length=length, fatigue_average=average, **CYCLE, **place)
    t = (np.arange(n) + 0.5) / n
    depth = reach * length * t**2
    fine = stress("fine", depths=[float(z) for z in depth], quantities="stress", steps="2:3", **place)
    field = np.array([fine["stress_" + c] for c in COMPONENTS])  # component, step, depth, y, x
    weight = t
    if average == "area":
        half = np.sqrt(length**2 - depth**2)
        weight = t * half
        along = "y" if section and section[0] == "x" else "x"
        field = np.moveaxis(field, -2, -1) if along == "y" else field
        cell = fine[along][1] - fine[along][0]
        field = np.stack([chord(field[:, :, k], half[k] / cell) for k in range(n)], axis=2)
        field = np.moveaxis(field, -2, -1) if along == "y" else field
    mean = np.tensordot(field, weight / weight.sum(), axes=(2, 0))
    expected = crossland(mean[:, 0], mean[:, 1])
    assert got["z"].tolist() == [0] and got["crossland"].shape[-2:] == expected.shape[-2:]
    assert np.abs(got["crossland"][0] - expected).max() < 2e-4 * expected.max()


def test_a_point_is_half_a_length_deep(contact):
    _, radius, stress = contact
    got = stress("point", fatigue_length=0.2 * radius, fatigue_average="point", **CYCLE)
    depth = stress("depth", depths=0.1 * radius, quantities="none", **CYCLE)
    for name in ("crossland", "findley", "swt"):
        assert np.array_equal(got[name], depth[name])


@pytest.mark.parametrize("place", [{}, dict(section="y=0")])
def test_means_do_not_depend_on_the_ranks(contact, place):
    _, radius, stress = contact
    one, three = (stress(f"r{n}", ranks=n, fatigue_length=0.1 * radius, **CYCLE, **place) for n in (1, 3))
    for name in ("crossland", "findley", "swt"):
        assert np.array_equal(one[name], three[name])


def test_means_do_not_depend_on_the_grid(launcher, contact):
    """SWT at the edge of slip rises with the grid by a quarter of itself, its mean over a length does not."""
    folder, radius, stress = contact
    run_contact(launcher, folder, 144)
    peaks = {}
    for n in (48, 144):
        for name, options in (("mean", dict(fatigue_length=0.1 * radius)), ("point", {})):
            got = stress("grid", input=f"c{n}.h5", section="y=0", **CYCLE, **options)
            peaks[name, n] = np.nanmax(got["swt"])
    assert peaks["mean", 144] == pytest.approx(peaks["mean", 48], rel=0.02)
    assert peaks["point", 144] > 1.1 * peaks["point", 48]

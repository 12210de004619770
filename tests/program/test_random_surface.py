"""Random surfaces of petsam-surface: spectra, seeds, grids, refusals; and instruments' heights without a body."""

import sys

import h5py
import numpy as np
import pytest

from petsam.apps.launch import code_of
from petsam.apps.surface import generation, reading
from petsam.apps.surface.readers.instruments import Instrument
from petsam.apps.surface.readers.stated import Stated
from petsam.core.errors import Error
from petsam.core.roughness import self_affine
from petsam.plot.style import plt

SIZE = (1e-3, 1e-3)


def spectrum_of(values, size=SIZE):
    """q (rad/m) of all waves and C (m^4) of heights."""
    power = np.abs(np.fft.fft2(values) / values.size) ** 2 * size[0] * size[1] / (2 * np.pi) ** 2
    k = [2 * np.pi * np.fft.fftfreq(n, side / n) for n, side in zip(values.shape[::-1], size)]
    return np.hypot(k[0][None, :], k[1][:, None]).ravel(), power.ravel()


def test_a_self_affine_surface_has_its_exponent_and_its_limits():
    spectrum = self_affine(0.7, 2e-4, 1e-5)
    found = [spectrum_of(generation.heights(spectrum, (256, 256), SIZE, 1e-5, seed, 1e-6)) for seed in range(8)]
    q, power = found[0][0], np.mean([one for _, one in found], axis=0)
    inside = (q > 2 * np.pi / 2e-4 * 1.001) & (q < 2 * np.pi / 1e-5 * 0.999)
    outside = (q < 2 * np.pi / 2e-4 * 0.999) | (q > 2 * np.pi / 1e-5 * 1.001)
    slope = np.polyfit(np.log(q[inside]), np.log(power[inside]), 1)[0]
    assert slope == pytest.approx(-2 * 1.7, abs=0.05) and power[outside].max() < 1e-20 * power.max()


def test_a_table_gives_the_mean_square_height(tmp_path):
    """The integral of C = c q^-2 from q0 to q1 over all wave vectors is 2 pi c log(q1/q0)."""
    q0, q1, c = 2 * np.pi / 2.01e-4, 2 * np.pi / 1e-5, 1e-14
    (tmp_path / "psd.txt").write_text("".join(f"{q} {c / q**2}\n" for q in (q0, 2 * q0, q1)))
    spectrum, shortest = generation.tabulated(str(tmp_path / "psd.txt"))
    assert shortest == pytest.approx(1e-5)
    squares = [np.mean(generation.heights(spectrum, (256, 256), SIZE, shortest, seed) ** 2) for seed in range(20)]
    assert np.mean(squares) == pytest.approx(2 * np.pi * c * np.log(q1 / q0), rel=0.1)


def test_a_seed_is_a_surface_whatever_the_grid():
    spectrum = self_affine(0.8, 5e-4, 2e-5)
    one, same, other = (generation.heights(spectrum, (128, 128), SIZE, 2e-5, seed, 1e-6) for seed in (3, 3, 4))
    assert one.tobytes() == same.tobytes() and abs(np.corrcoef(one.ravel(), other.ravel())[0, 1]) < 0.5
    fine = generation.heights(spectrum, (384, 384), SIZE, 2e-5, 3, 1e-6)
    assert np.sqrt(np.mean(one**2)) == pytest.approx(1e-6) and abs(np.mean(one)) < 1e-15
    assert fine[::3, ::3] == pytest.approx(one, abs=1e-15)
    long = generation.heights(spectrum, (100, 200), (1e-3, 2e-3), 2.1e-5, 3, 1e-6)
    assert long.shape == (200, 100) and np.isrealobj(long)


@pytest.mark.parametrize("moments", [(0.0, 3.0), (-1.0, 4.5), (0.7, 4.5), (0.0, 2.2), (-0.5, 3.0)])
def test_heights_have_the_moments_that_are_given(moments):
    """Of the polynomial exactly, by Gauss and Hermite's rule; of surfaces in the mean over seeds; on every grid."""
    function = generation.cubic(*moments)
    nodes, weights = np.polynomial.hermite_e.hermegauss(30)
    found = [np.sum(weights * function(nodes) ** k) / np.sqrt(2 * np.pi) for k in range(5)]
    assert found == pytest.approx([1, 0, 1, *moments], abs=1e-8)
    spectrum = self_affine(0.8, 1e-4, 2e-5)
    of_seeds = []
    for seed in range(6):
        gauss = generation.heights(spectrum, (128, 128), SIZE, 2e-5, seed, 1e-6)
        values = generation.shaped(gauss, function, 1e-6)
        assert abs(values.mean()) < 1e-15 and values.std() == pytest.approx(1e-6)
        of_seeds.append([np.mean((values / 1e-6) ** k) for k in (3, 4)])
    assert np.mean(of_seeds, axis=0) == pytest.approx(moments, abs=0.25)
    fine = generation.shaped(generation.heights(spectrum, (384, 384), SIZE, 2e-5, 5, 1e-6), function, 1e-6)
    assert fine[::3, ::3] == pytest.approx(values, abs=1e-8)  # means over other points


def test_heights_have_the_distribution_of_a_table(tmp_path):
    """A tenth of the points in the lower 3 um, the others on a plateau of 1 um."""
    (tmp_path / "abbott.txt").write_text("0 0\n3e-6 0.1\n4e-6 1\n")
    function = generation.distributed(str(tmp_path / "abbott.txt"))
    gauss = generation.heights(self_affine(0.8, 1e-4, 2e-5), (256, 256), SIZE, 2e-5, 1)
    values = generation.shaped(gauss, function)
    assert np.ptp(values) == pytest.approx(4e-6, rel=0.01)
    assert np.mean(values - values.min() < 3e-6) == pytest.approx(0.1, abs=0.01)
    assert np.mean(values - values.min() < 3.5e-6) == pytest.approx(0.55, abs=0.02)
    assert generation.shaped(gauss, function, 2e-6).std() == pytest.approx(2e-6)


def test_skewness_changes_the_spectrum_little():
    spectrum = self_affine(0.8, 2e-4, 2e-5)
    gauss = generation.heights(spectrum, (256, 256), SIZE, 2e-5, 2, 1e-6)
    (q, power), (_, of) = (
        spectrum_of(one) for one in (gauss, generation.shaped(gauss, generation.cubic(-0.8, 4.0), 1e-6))
    )
    inside = (q > 2 * np.pi / 2e-4) & (q < 2 * np.pi / 2e-5)
    assert of[inside].sum() > 0.8 * of.sum()
    slopes = [np.polyfit(np.log(q[inside]), np.log(one[inside]), 1)[0] for one in (power, of)]
    assert slopes[1] == pytest.approx(slopes[0], abs=0.5)


@pytest.fixture
def surface(tmp_path, monkeypatch, capfd):
    """surface(*words): exit code, stdout and stderr of petsam-surface."""
    monkeypatch.chdir(tmp_path)

    def run(*words):
        monkeypatch.setattr(sys, "argv", ["petsam-surface", *map(str, words)])
        try:
            code = code_of("petsam-surface")
        except SystemExit as end:
            code = end.code
        return code, *capfd.readouterr()

    return run


RANDOM = ("--self-affine", "0.8", "--rms", "0.5um", "--wavelengths", "200um,40um", "--size", "1mm", "--grid-n", "64")


def test_the_picture_has_the_given_resolution(surface, tmp_path):
    widths = []
    for words in ([], ["--dpi", "300"]):
        assert surface(*RANDOM, *words, "-o", "r.h5")[0] == 0
        widths.append(plt.imread(tmp_path / "r.png").shape[1])
    assert widths[1] == pytest.approx(2 * widths[0], abs=2)
    for words, says in ((["--dpi", "5000"], "--dpi: 5000: expected"), (["--dpi", "300", "--no-picture"], "--dpi")):
        code, _, err = surface(*RANDOM, *words, "-o", "r.h5")
        assert code == 2 and says in err


def test_the_command_writes_a_surface(surface, tmp_path):
    code, out, err = surface(*RANDOM, "--seed", "7", "--no-picture", "-o", "r.h5")
    assert code == 0 and not err and "heights of body 2" in out and "seed 7" in out and "-gap_rough_file r.h5" in out
    with h5py.File(tmp_path / "r.h5") as file:
        values = file["height"][:]
    expected = generation.heights(self_affine(0.8, 2e-4, 4e-5), (64, 64), SIZE, 4e-5, 7, 5e-7)
    assert values == pytest.approx(expected, abs=1e-18)
    assert surface(*RANDOM, "--body", "1", "--no-picture", "-o", "r.h5")[1].startswith(
        "random surface: heights of body 1"
    )
    code, _, err = surface(*RANDOM, "--rms", "0.5", "--no-picture", "-o", "r.h5")
    assert code == 0 and "r.h5: peak to valley" in err and err.endswith("is more than the size 1 mm: check the unit\n")


def test_the_command_shapes_heights(surface, tmp_path):
    (tmp_path / "t.txt").write_text("0 0\n1e-6 0.5\n1.2e-6 1\n")
    code, out, _ = surface(*RANDOM, "--skewness", "-1", "--no-picture", "-o", "r.h5")
    assert code == 0 and "Sq 500 nm" in out and -1.6 < float(out.split("skewness Ssk ")[1].split(",")[0]) < -0.5
    assert surface(*RANDOM, "--kurtosis", "5", "--no-picture", "-o", "r.h5")[0] == 0
    code, out, _ = surface(*RANDOM[:2], *RANDOM[4:], "--distribution", "t.txt", "--no-picture", "-o", "r.h5")
    assert code == 0
    with h5py.File(tmp_path / "r.h5") as file:
        assert np.ptp(file["height"][:]) == pytest.approx(1.2e-6, rel=0.02)


def test_heights_of_one_instruments_file_are_body_2s(monkeypatch, tmp_path):
    (tmp_path / "scan.sur").write_text("x")
    stated = Stated(np.array([[0.0, 1e-6], [0.0, 0.0]]), 1.0, (1e-3, 1e-3))
    monkeypatch.setattr(Instrument, "read", lambda self, source: stated)
    one = reading.read(tmp_path / "scan.sur")
    assert one.quantity == "height2"
    assert any("taken for heights of body 2; --body 1 or --separation" in remark for remark in one.remarks)
    with pytest.raises(Error, match="does not say whether it holds heights"):
        reading.read(tmp_path / "scan.sur", alone=False)

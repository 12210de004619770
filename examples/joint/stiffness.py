"""Contact stiffness and damping of two rough steel surfaces under a bolt's pressure: prints a table, writes files.

python examples/joint/stiffness.py [FOLDER]        build/run
"""

import sys
import warnings
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts"))
from petsam import AdviceWarning, joint  # noqa: E402

STEEL = dict(body1_young=210e9, body1_poisson=0.3, body2_young=210e9, body2_poisson=0.3)
N, WIDTH, RMS = 192, 1e-3, 0.5e-6  # points along a side, m, m
HURST, LONGEST, SHORTEST = 0.8, 4, 16  # exponent of a self-affine surface; waves in the width


def scan(seed=1):
    """A surface as a profilometer measures it, m: here random, self-affine waves of a known rms height."""
    k = np.hypot(*np.meshgrid(*2 * [np.fft.fftfreq(N) * N]))
    size = np.where((k >= LONGEST) & (k <= SHORTEST), np.maximum(k, 1.0) ** -(1 + HURST), 0.0)
    waves = np.fft.ifft2(np.fft.fft2(np.random.default_rng(seed).normal(size=(N, N))) * size).real
    return RMS * waves / waves.std()


def main(folder):
    warnings.simplefilter("ignore", AdviceWarning)  # at low pressures spots are a few cells wide; the spread is larger
    pressures = np.geomspace(5e6, 80e6, 5)
    found = joint.of_windows(-scan(), WIDTH / N, pressures, friction=0.4, steps=4, **STEEL)
    part = {name: 100 * spread / found.numbers[name] for name, spread in found.spread.items()}
    print("   p/MPa  k_n/(N/mm3)  +- %  k_t/(N/mm3)  k_t/k_n  area/%  loop/(mJ/m2)  +- %")
    for k, pressure in enumerate(found.pressure):
        k_t = (found.k_t_x[k] + found.k_t_y[k]) / 2
        print(
            f"{pressure / 1e6:8.3g} {found.k_n[k] / 1e9:12.4g} {part['k_n'][k]:5.0f} {k_t / 1e9:12.4g} "
            f"{k_t / found.k_n[k]:8.4f} {100 * found.area[k]:7.2f} {1e3 * found.loop_energy[k]:13.3g} "
            f"{part['loop_energy'][k]:5.0f}"
        )
    folder.mkdir(parents=True, exist_ok=True)
    found.to_csv(folder / "interface.csv")
    found.to_abaqus(folder / "interface.inp")
    found.plot().savefig(folder / "interface.png", dpi=100)


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else ROOT / "build/run"))

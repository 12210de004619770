"""A rough rigid surface slides on rubber: the friction by what the rubber dissipates, at five speeds and two pressures.

build/venv/bin/python examples/viscous/rough.py
"""

import numpy as np

import petsam

# the rubber of ball.py
YOUNG, POISSON = 6e6, 0.5
PARTS, TIMES = np.array([0.5, 0.2]), np.array([0.1, 1.0])
CELLS, WIDTH = 64, 1e-3  # m, of one period


def heights():
    """A self-affine surface of Hurst exponent 0.8, waves of 1/2 to 1/16 of the period, root mean square slope 0.1."""
    number = np.fft.fftfreq(CELLS, 1 / CELLS)
    n = np.hypot(number[:, None], number[None, :])
    noise = np.random.default_rng(1).standard_normal((CELLS, CELLS))
    size = np.where((n >= 2) & (n <= 16), 1.0, 0.0) * np.maximum(n, 1) ** -1.8
    waves = np.fft.fft2(noise) * size
    steep = np.sqrt(np.sum((2 * np.pi * n / WIDTH * np.abs(waves)) ** 2)) / CELLS**2
    return np.real(np.fft.ifft2(waves)) * 0.1 / steep


def closed(surface, speed):
    """The force along x in full contact, over the area: sum of k_x |k| |h|^2 Im(E*(k_x V)/2) over the waves."""
    number = 2 * np.pi * np.fft.fftfreq(CELLS, WIDTH / CELLS)
    k_x, k = number[None, :], np.hypot(number[:, None], number[None, :])
    i_w_t = 1j * k_x[..., None] * speed * TIMES
    # of a sudden load, less what has relaxed
    modulus = YOUNG / (1 - POISSON**2) * (1 - np.sum(PARTS / (1 + i_w_t), axis=-1))
    power = np.abs(np.fft.fft2(surface) / CELLS**2) ** 2
    return np.sum(k_x * k * power * np.imag(modulus) / 2)


if __name__ == "__main__":
    surface = heights()
    print("             contact of a part       full contact")
    print("speed, m/s   area, %   friction       friction   closed")
    for speed in (1e-5, 1e-4, 1e-3, 1e-2, 1e-1):
        line = f"{speed:10.0e}"
        for pressure in (5e4, 5e6):
            run = petsam.run(
                gap=surface, elasticity="periodic", grid_n=CELLS, grid_size=WIDTH, body1_young="inf", body1_poisson=0,
                body2_young=YOUNG, body2_poisson=POISSON, body2_relax_moduli=PARTS, body2_relax_times=TIMES,
                body2_speed=-speed, load_n=pressure * WIDTH**2, errors="none",
            )  # fmt: skip
            area = run["contact_area"][-1] / WIDTH**2
            line += f"{100 * area:10.1f}" if area < 1 else ""
            line += f"{run['rolling_resistance'][-1] / run['load_n'][-1]:12.6f}   "
        print(line + f"{closed(surface, speed) / pressure:9.6f}")

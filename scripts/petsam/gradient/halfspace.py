"""Displacements of two bodies by tractions on cells, as convolutions: S, C and X of the contact's equations.

    u_z = S p + X' q,   u_t = X p + C q,
    S = A Ir,   C = A Ir + B (Ixx, Ixy; Ixy, Iyy),   X = D (Ix, Iy),

with the integrals over a cell of 1/r, x^2/r^3, x y/r^3, x/r^2 and so on. Displacements are of body 2 relative to body
1, tractions act on body 2. In plane strain the integrals are those of strips, relative to the datum; of periodic
bodies they are the symbols of waves, whose mean displaces nothing. Sources: Love 1929; Johnson 1985, Contact
Mechanics, 2.3, 3.2 and 3.6; Stanley and Kato 1997.
"""

from collections.abc import Callable

import numpy as np
import scipy.fft

CONSTANTS = ("A", "B", "D")
MODULI = ("body1_young", "body1_poisson", "body2_young", "body2_poisson")

_CORNERS: dict[str, Callable] = {
    "r": lambda x, y: x * np.arcsinh(y / np.abs(x)) + y * np.arcsinh(x / np.abs(y)),
    "xx": lambda x, y: y * np.arcsinh(x / np.abs(y)),
    "yy": lambda x, y: x * np.arcsinh(y / np.abs(x)),
    "xy": lambda x, y: -np.hypot(x, y),
    "x": lambda x, y: x * np.arctan(y / x) + 0.5 * y * np.log(x * x + y * y),
    "y": lambda x, y: y * np.arctan(x / y) + 0.5 * x * np.log(x * x + y * y),
}


def constants(bodies: np.ndarray) -> np.ndarray:
    """A, B and D (1/Pa) of bodies (E1, nu1, E2, nu2); complex numbers are passed through.

    Parameters
    ----------
    bodies : ndarray
        Young's moduli (Pa) and Poisson's ratios of bodies 1 and 2.

    Returns
    -------
    ndarray
        A, B, D.
    """
    found = np.zeros(3, dtype=np.asarray(bodies).dtype)
    for young, poisson, sign in ((bodies[0], bodies[1], 1), (bodies[2], bodies[3], -1)):
        found += np.array([
            (1 - poisson**2) / (np.pi * young), poisson * (1 + poisson) / (np.pi * young),
            sign * (1 + poisson) * (1 - 2 * poisson) / (2 * np.pi * young),
        ])  # fmt: skip
    return found


def by_moduli(bodies: np.ndarray) -> np.ndarray:
    """The derivatives of A, B, D by E1, nu1, E2, nu2, (3, 4), by complex steps.

    Parameters
    ----------
    bodies : ndarray
        E1 (Pa), nu1, E2, nu2.

    Returns
    -------
    ndarray
    """
    columns = []
    for k in range(4):
        moved = np.array(bodies, dtype=complex)
        moved[k] += 1e-30j * abs(bodies[k]) + 1e-40j
        columns.append(constants(moved).imag / moved[k].imag)
    return np.array(columns).T


class Influence:
    """Products with S, C, X and X' on a grid of (ny, nx) cells; fields are (ny, nx), shears (2, ny, nx).

    Parameters
    ----------
    shape : tuple of int
        (ny, nx).
    cell : tuple of float
        Sides of a cell along x and y, m; in plane strain the latter is 1 m.
    bodies : ndarray
        E1 (Pa), nu1, E2, nu2.
    kind : str
        "halfspace", "plane" or "periodic", whose grid is one period.
    datum : float
        Distance of the datum of plane strain, m.
    """

    def __init__(
        self,
        shape: tuple[int, int],
        cell: tuple[float, float],
        bodies: np.ndarray,
        kind: str = "halfspace",
        datum: float = 1.0,
    ) -> None:
        self.shape, self.cell, self.constants = shape, cell, constants(np.asarray(bodies, dtype=float))
        periods = [n if kind == "periodic" or n == 1 else 2 * n for n in shape]
        self.padded = tuple(n if kind == "periodic" else scipy.fft.next_fast_len(n, real=True) for n in periods)
        self._set_waves()
        self._spectra = (
            self._symbols() if kind == "periodic" else self._strips(datum) if kind == "plane" else self._cells()
        )
        of = [float(self.back(self._spectra[name])[0, 0]) for name in ("r", "xx")]
        a, b, _ = self.constants
        self.own = a * of[0], a * of[0] + b * of[1]  # of a cell on itself

    def _lags(self):
        """Distances along x and y on the padded grid, m."""
        y, x = (np.rint(np.fft.fftfreq(n) * n) * width for n, width in zip(self.padded, self.cell[::-1]))
        return np.meshgrid(x, y)

    def _cells(self):
        """The transforms of the integrals over a cell."""
        x, y = self._lags()
        a, b = 0.5 * self.cell[0], 0.5 * self.cell[1]
        spectra = {}
        for name, corner in _CORNERS.items():
            kernel = corner(x + a, y + b) - corner(x - a, y + b) - corner(x + a, y - b) + corner(x - a, y - b)
            spectra[name] = scipy.fft.rfft2(kernel)
        return spectra

    def _strips(self, datum):
        """The same of strips: integrals along y, where those of 1/r and y^2/r^3 are relative to the datum."""
        x, h = self._lags()[0], self.cell[0]
        right, left = x + 0.5 * h, x - 0.5 * h
        logarithm = right * np.log(np.abs(right) / datum) - left * np.log(np.abs(left) / datum) - h
        along, none = scipy.fft.rfft2(-2.0 * logarithm), np.zeros((self.padded[0], self.padded[1] // 2 + 1))
        turn = scipy.fft.rfft2(np.pi * (np.abs(right) - np.abs(left)))
        return {"r": along, "xx": none, "yy": along, "xy": none, "x": turn, "y": none}

    def _symbols(self):
        """The same of waves: 2 pi/k and so on; nothing of the mean, nor of phases of the shortest waves."""
        k, n_x, n_y = self._waves
        flat = np.where(self._mean, 0.0, 2 * np.pi / k)
        n_x, n_y = np.where(self._shortest[0], 0.0, n_x), np.where(self._shortest[1], 0.0, n_y)
        return {
            "r": flat, "xx": flat * self._waves[2] ** 2, "yy": flat * self._waves[1] ** 2, "xy": -flat * n_x * n_y,
            "x": -1j * flat * n_x, "y": -1j * flat * n_y,
        }  # fmt: skip

    def _set_waves(self):
        """The waves of the padded grid: k (1/m), its direction, and which are the mean and the shortest."""
        wave_y, wave_x = np.meshgrid(
            2 * np.pi * np.fft.fftfreq(self.padded[0], self.cell[1]),
            2 * np.pi * np.fft.rfftfreq(self.padded[1], self.cell[0]),
            indexing="ij",
        )  # fmt: skip
        k = np.hypot(wave_x, wave_y)
        self._mean = k == 0
        self._shortest = tuple(np.isclose(np.abs(wave), np.pi / d) for wave, d in zip((wave_x, wave_y), self.cell))
        k[0, 0] = np.pi / max(n * d for n, d in zip(self.padded, self.cell[::-1]) if n > 1)
        self._waves = k, wave_x / k, wave_y / k
        self._wave = k / (2 * np.pi), wave_x / k, wave_y / k

    def transform(self, field: np.ndarray) -> np.ndarray:
        """The transform of fields (..., ny, nx) on the padded grid."""
        return scipy.fft.rfft2(field, self.padded)

    def back(self, spectrum: np.ndarray) -> np.ndarray:
        """Fields (..., ny, nx) of a transform."""
        return scipy.fft.irfft2(spectrum, self.padded)[..., : self.shape[0], : self.shape[1]]

    def parts(self, p: np.ndarray, q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(u_z, u_t) by tractions for A = 1, B = 1 and D = 1 alone: (3, ny, nx) and (3, 2, ny, nx), m/Pa."""
        s, (fp, fx, fy) = self._spectra, self.transform(np.stack([p, q[0], q[1]]))
        none = np.zeros_like(fp)
        u_z = [s["r"] * fp, none, -(s["x"] * fx + s["y"] * fy)]
        u_x = [s["r"] * fx, s["xx"] * fx + s["xy"] * fy, s["x"] * fp]
        u_y = [s["r"] * fy, s["xy"] * fx + s["yy"] * fy, s["y"] * fp]
        return self.back(np.stack(u_z)), self.back(np.stack([np.stack(one) for one in zip(u_x, u_y)]))

    def __call__(self, p: np.ndarray, q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Displacements u_z (ny, nx) and u_t (2, ny, nx), m, by pressure and shear, Pa."""
        s, (fp, fx, fy), (a, b, d) = self._spectra, self.transform(np.stack([p, q[0], q[1]])), self.constants
        found = self.back(np.stack([
            a * s["r"] * fp - d * (s["x"] * fx + s["y"] * fy),
            a * s["r"] * fx + b * (s["xx"] * fx + s["xy"] * fy) + d * s["x"] * fp,
            a * s["r"] * fy + b * (s["xy"] * fx + s["yy"] * fy) + d * s["y"] * fp,
        ]))  # fmt: skip
        return found[0], found[1:]

    def inverse_normal(self, u: np.ndarray) -> np.ndarray:
        """The approximate inverse of S: the pressure of each wave of u_z."""
        return self.back(self.transform(u) * (self._wave[0] / self.constants[0]))

    def inverse_tangential(self, u: np.ndarray) -> np.ndarray:
        """The approximate inverse of C: the shear of each wave of u_t."""
        k, n_x, n_y = self._wave
        a, b, _ = self.constants
        fx, fy = self.transform(u)
        across = (n_x * fy - n_y * fx) * (b / (a * (a + b)))  # a wave across its direction is stiffer by B
        return self.back(np.stack([k * (fx / a + across * n_y), k * (fy / a - across * n_x)]))

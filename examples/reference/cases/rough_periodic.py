"""One period of a rough surface: twelve waves."""

import tempfile
from pathlib import Path

import h5py
import numpy as np
from common import all_covered
from scipy import fft

import petsam

LENGTH, N, YOUNG, POISSON = 1e-3, 160.0, 210e9, 0.3
# wave vector over 2 pi/LENGTH, amplitude (um), phase
WAVES = (
    (1, 1, 0.50, 0.3),
    (2, -1, 0.40, 1.9),
    (1, -3, 0.30, 4.1),
    (3, 2, 0.30, 2.6),
    (4, -3, 0.25, 5.2),
    (2, 5, 0.20, 0.9),
    (6, 1, 0.20, 3.4),
    (5, -5, 0.15, 6.0),
    (7, 3, 0.15, 1.2),
    (3, -8, 0.10, 4.7),
    (8, -4, 0.10, 2.2),
    (9, 6, 0.08, 5.5),
)
E_STAR = YOUNG / (1 - POISSON**2) / 2
G = YOUNG / (2 * (1 + POISSON))
OPTIONS = {
    "elasticity": "periodic",
    "grid_size": LENGTH,
    **{f"body{body}_young": YOUNG for body in (1, 2)},
    **{f"body{body}_poisson": POISSON for body in (1, 2)},
    "gap_type": "file",
    "friction": 0.5,
    "load_n": N,
    "stiffness": True,
}
UNITS = {
    "contact_area": "m2",
    "mean_gap": "m",
    "pressure_max": "Pa",
    "elastic_energy": "J",
    "stiffness_n": "N/m",
    "stiffness_tx": "N/m",
}


def gap(n):
    """At the centres of n x n cells, about x = y = 0: (ny, nx)."""
    x = 2 * np.pi * ((np.arange(n) + 0.5) / n - 0.5)
    return sum(1e-6 * a * np.cos(kx * x + ky * x[:, None] + phase) for kx, ky, a, phase in WAVES)


# ---------------------------------------------------------------- own solver


class Cells:
    """n x n cells of constant traction: displacements of their centres by the exact relation of each wave, summed over
    all waves, also those shorter than two cells. Displacements have the mean 0."""

    def __init__(self, n, images=4):
        self.n, self.area = n, (LENGTH / n) ** 2
        first = np.arange(n // 2 + 1.0), fft.fftfreq(n, 1 / n)[:, None]
        xx = xy = yy = 0.0
        for i in range(-images, images + 1):
            for j in range(-images, images + 1):
                kx, ky = first[0] + i * n, first[1] + j * n
                square = np.maximum(kx**2 + ky**2, 1e-30)
                cell = np.sinc(kx / n) * np.sinc(ky / n) * LENGTH / np.pi / square**1.5
                xx, xy, yy = xx + cell * kx**2, xy + cell * kx * ky, yy + cell * ky**2
        # waves along the traction are stretched by 1/E*, those across by 1/G
        self.normal = (xx + yy)[None, None] / E_STAR
        cross = xy * (1 / E_STAR - 1 / G)
        self.tangential = np.array([[xx / E_STAR + yy / G, cross], [cross, yy / E_STAR + xx / G]])

    def apply(self, symbol, tractions):
        """Displacements by one or two fields of tractions."""
        waves = fft.rfft2(tractions)
        return fft.irfft2(np.einsum("abij,bij->aij", symbol, waves), s=(self.n, self.n))

    def invert(self, symbol, mask, wanted, start):
        """Tractions on the mask that give these displacements there: preconditioned conjugate gradients."""
        diagonal = np.array([symbol[a, a] for a in range(len(symbol))])
        inverse = np.where(diagonal > 0, 1 / np.maximum(diagonal, 1e-300), 0)
        x = start * mask
        r = mask * (wanted - self.apply(symbol, x))
        limit, d, rho = 1e-16 * np.sum((mask * wanted) ** 2), 0.0, np.inf
        while np.sum(r * r) > limit:
            z = mask * fft.irfft2(inverse * fft.rfft2(r), s=(self.n, self.n))
            rho, before = np.sum(r * z), rho
            d = z + rho / before * d
            image = mask * self.apply(symbol, d)
            step = rho / np.sum(d * image)
            x, r = x + step * d, r - step * image
        return x


def by_active_sets(sizes):
    """All quantities on grids each twice as fine as the one before, whose contact is where the search begins."""
    found, contact = [], np.ones((1, sizes[0] // 2, sizes[0] // 2), bool)
    for n in sizes:
        cells, h = Cells(n), gap(n)[None]
        contact = contact.repeat(2, 1).repeat(2, 2)
        if not found:
            contact = h < np.quantile(h, 0.3)
        ones, shape = np.ones_like(h), np.zeros_like(h)
        by_approach = 0 * h
        while True:
            # pressure by an approach of 1 m, and by the gap
            by_approach = cells.invert(cells.normal, contact, ones, by_approach)
            shape = cells.invert(cells.normal, contact, -h, shape)
            approach = (N / cells.area - shape.sum()) / by_approach.sum()
            p = approach * by_approach + shape
            rest = cells.apply(cells.normal, p) + h - approach
            new = np.where(contact, p > 0, rest < 0)
            if np.array_equal(new, contact):
                break
            contact = new
        along_x = np.array([ones[0], 0 * h[0]])
        q = cells.invert(cells.tangential, contact, along_x, along_x * by_approach)
        found.append(
            {
                "contact_area": contact.sum() * cells.area,
                "mean_gap": -approach,
                "pressure_max": top(p[0]),
                "elastic_energy": np.sum(p * (approach - h)) * cells.area / 2,
                "stiffness_n": by_approach.sum() * cells.area,
                "stiffness_tx": q[0].sum() * cells.area,
            }
        )
    return found


def top(p):
    """The maximum of a parabola through the maximum and its neighbors, along both axes."""
    j, i = np.unravel_index(p.argmax(), p.shape)
    high = p[j, i]
    for before, after in ((p[j, i - 1], p[j, (i + 1) % len(p)]), (p[j - 1, i], p[(j + 1) % len(p), i])):
        high += (after - before) ** 2 / (8 * (2 * p[j, i] - before - after))
    return high


# ---------------------------------------------------------------- petsam


def solve(n=512, **more):
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "gap.h5"
        with h5py.File(path, "w") as file:
            file["height"] = gap(n)
        return petsam.run(OPTIONS, grid_n=n, gap_file=path, **more)


def by_petsam(**more):
    results = solve(**more)
    last = {name: values[-1] for name, values in results.history.items()}
    stiffness = results.matrices["stiffness_reversal"][-1]
    return {
        "contact_area": last["contact_area"],
        "mean_gap": -last["disp_z"],
        "pressure_max": last["pressure_max"],
        "elastic_energy": last["stored_energy"],
        "stiffness_n": stiffness[0, 0],
        "stiffness_tx": stiffness[1, 1],
    }


def evidence():
    own = by_active_sets((64, 128, 256, 512, 1024))
    # whole cells make the area too large by a constant part of the length of its edge
    areas = [2 * fine["contact_area"] - coarse["contact_area"] for coarse, fine in zip(own, own[1:])]
    own = [{**found, "contact_area": area} for found, area in zip(own[1:], areas)]
    other = [by_petsam(n=n) for n in (128, 256, 512, 1024)]
    return all_covered(UNITS, {"active sets, 128 to 1024 cells": own, "petsam, 128 to 1024 cells": other})


def answers():
    return by_petsam()


def draw(figure):
    figure.set_size_inches(4.0, 3.2)
    axes, results = figure.subplots(), solve(128)
    x, pressure = results.x * 1e3, results["pressure"][-1] * 1e-9
    image = axes.contourf(x, x, pressure, [1e-9, 1, 2, 3], colors=["0.8", "0.5", "0.1"], antialiased=False)
    axes.set_aspect("equal")
    axes.set_xlabel("x, mm")
    axes.set_ylabel("y, mm")
    figure.colorbar(image, label="p, GPa", format="%.0f")

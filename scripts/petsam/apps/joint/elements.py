"""Elements of harmonic balance for an interface: a four-parameter Iwan model, fitted to its first loading by a shear.

The Iwan model is that of D. J. Segalman (J. Appl. Mech. 72 (2005) 752): sliders in parallel, whose limits have the
density R phi^chi up to phi_max, and a single one there. Its stiffness kt and its limit Fs are those of the interface;
chi and beta, the weight of the last slider, are fitted to the energies of loops.
"""

import numpy as np

SMALLEST = 0.15  # shear over its limit from which loops are fitted: below it few cells slip
LIMITS = ([-0.95, 0.0], [5.0, 50.0])  # of chi and beta


def masing(shear, slip):
    """Energy of closed loops between +shear and -shear, from the slip at first loading: arrays, zero first.

    slip        displacement beyond that of sticking contacts, at each shear
    Masing's rule: the branches of a loop are the first loading, twice as large. It holds for elastically similar bodies
    under constant pressure and a shear along a line.
    """
    from scipy.interpolate import PchipInterpolator  # which takes long to import

    return 4 * shear * slip - 8 * PchipInterpolator(shear, slip).antiderivative()(shear)


def iwan(chi, beta, displacement):
    """An Iwan model's shear over Fs, and energy of a loop over Fs^2/kt, at displacements over Fs/kt."""
    scale = beta + (chi + 1) / (chi + 2)
    reach = (1 + beta) / scale  # phi_max, at which all sliders slip
    x = np.minimum(displacement / reach, 1.0)
    shear = ((1 + beta) * x - x ** (chi + 2) / (chi + 2)) / scale
    energy = 4 * reach * (chi + 1) / scale * x ** (chi + 3) / ((chi + 2) * (chi + 3))
    return shear, energy + 4 * np.maximum(displacement - reach, 0.0)


def fit_iwan(shear, displacement):
    """The Iwan model nearest to a first loading: chi, beta, and the largest relative errors of energy and shear.

    shear           shears over their limit Fs, rising, below 1
    displacement    displacements at these, over Fs/kt
    Compared are loops of these displacements, those of shears from SMALLEST on. NaN if fewer than four of them slip.
    """
    from scipy.optimize import least_squares

    shear, displacement = (np.concatenate(([0.0], values)) for values in (shear, displacement))
    energy = masing(shear, np.maximum.accumulate(np.maximum(displacement - shear, 0.0)))
    use = (shear >= SMALLEST) & (energy > 0.0)
    if use.sum() < 4:
        return (np.nan,) * 4

    def misfit(x):
        found = iwan(*x, displacement[use])
        return np.log(np.concatenate((found[1] / energy[use], found[0] / shear[use])))

    best = min(
        (least_squares(misfit, (chi, beta), bounds=LIMITS) for chi in (-0.5, 0.5) for beta in (0.1, 2.0)),
        key=lambda one: one.cost,
    )
    errors = np.abs(np.expm1(misfit(best.x))).reshape(2, -1).max(axis=1)
    return *(round(float(x), 6) for x in best.x), *map(float, errors)


def of_codes(pressure, k_n, k_t, friction, chi, beta, area):
    """Parameters of an element of this area (m2) under a pressure (Pa), by program and by class, in SI units.

    tmdsimpy    Iwan4Force(kt, Fs, chi, beta), ElasticDryFriction3D(kt, kn, mu); the linear spring of the latter has
                this pressure at a normal displacement of pressure/k_n
    pyHarm      Penalty3D(k_n, k_t, mu, N0, g): N0 is the preload
    """
    normal = pressure * area
    return {
        "tmdsimpy": {
            "Iwan4Force": {"kt": k_t * area, "Fs": friction * normal, "chi": chi, "beta": beta},
            "ElasticDryFriction3D": {"kt": k_t * area, "kn": k_n * area, "mu": friction},
        },
        "pyHarm": {"Penalty3D": {"k_n": k_n * area, "k_t": k_t * area, "mu": friction, "N0": normal, "g": 0.0}},
    }

"""Tangential loops of a sphere under constant normal load: force against displacement, and the energy of a cycle.

SI units, relative displacements, similar materials. The first loading is Cattaneo and Mindlin's. Unloading and
reloading follow Masing's rule, which Mindlin and Deresiewicz derived for this contact: the same curve, doubled in both
directions. limit = mu N (N) and gross (m), the displacement of incipient sliding, are those of sphere.Spheres.

References
----------
- R. D. Mindlin, H. Deresiewicz, Elastic spheres in contact under varying oblique forces, J. Appl. Mech. 20 (1953) 327.
- K. L. Johnson, Contact Mechanics, 1985, section 7.4.
"""

import numpy as np


def first_loading(load, limit, gross):
    """d_x, m, of the first loading to load (N); limit = mu N, gross = displacement of incipient sliding (m)."""
    return gross * (1.0 - np.cbrt(1.0 - np.asarray(load, dtype=float) / limit) ** 2)


def masing_displacement(load, turn_load, turn_displacement, limit, gross):
    """d_x, m, at load (N) after a turning point: the first loading's curve doubled, down or up."""
    swing = np.asarray(load, dtype=float) - turn_load
    return turn_displacement + 2.0 * np.sign(swing) * first_loading(0.5 * np.abs(swing), limit, gross)


def partial_loop_energy(amplitude, limit, gross):
    """Energy, J, that friction dissipates in one cycle between -amplitude and amplitude (N), amplitude <= mu N.

    Mindlin and Deresiewicz; with gross = 3 mu N (sum of (2 - nu)/G)/(16 a) it is Johnson's eq. 7.59.
    """
    t = amplitude / limit
    return 4.0 * limit * gross * (1.2 * (1.0 - np.cbrt(1.0 - t) ** 5) - t * (1.0 + np.cbrt(1.0 - t) ** 2))


def sliding_displacement_load(displacement, limit, gross):
    """T, N, of the first loading to displacement (m) >= 0; mu N beyond gross."""
    return limit * (1.0 - np.clip(1.0 - np.asarray(displacement, dtype=float) / gross, 0.0, None) ** 1.5)


def sliding_masing_load(displacement, turn_load, turn_displacement, limit, gross):
    """T, N, at displacement (m) after a turning point; the loop's branches end in sliding at mu N."""
    swing = np.asarray(displacement, dtype=float) - turn_displacement
    return turn_load + 2.0 * np.sign(swing) * sliding_displacement_load(0.5 * np.abs(swing), limit, gross)


def sliding_loop_energy(amplitude, limit, gross):
    """Energy, J, of one cycle between displacements -amplitude and amplitude (m) >= gross, from sliding to sliding."""
    return partial_loop_energy(limit, limit, gross) + 4.0 * limit * (amplitude - gross)

"""The spectrum of self-affine surfaces."""

import numpy as np


def self_affine(hurst, longest, shortest):
    """The spectrum, without its factor, as a function of q."""
    low, high = 2.0 * np.pi / longest, 2.0 * np.pi / shortest
    slack = 1.0 + 1e-9
    return lambda q: np.where((q * slack >= low) & (q <= high * slack), q ** (-2.0 * (1.0 + hurst)), 0.0)

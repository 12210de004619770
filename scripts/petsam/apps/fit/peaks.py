"""Frictions and energies of records of peaks, which have no loops."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .reading import Record


@dataclass(frozen=True)
class Peaks:
    """The numbers that peaks of cycles hold alone: least friction, the largest force over the normal load; energy over
    4 D* Q*, 1, above 0.2 gross slip, roughly, NaN without energies; and where slip is gross."""

    friction_at_least: float
    energy_ratio: np.ndarray
    gross: np.ndarray


def of_peaks(record: Record, normal: float) -> Peaks:
    """Evaluates a record of peaks under a normal load, N."""
    energy = record.energy if record.energy is not None else np.full(record.force.shape, np.nan)
    ratio = energy / (4.0 * record.displacement * record.force)
    return Peaks(float(np.nanmax(record.force) / normal), ratio, ratio > 0.2)

"""Frames: origin and axes of a contact in the coordinates of a model."""

from dataclasses import dataclass

import numpy as np

from . import words
from .errors import Error

FORM = "ORIGIN[:X[:Z]], each of them three numbers: 0,0,0:1,0,0"


@dataclass(frozen=True)
class Frame:
    """Origin (m) and x, y, z as rows, z into the body, in the model's coordinates."""

    origin: np.ndarray
    axes: np.ndarray

    @staticmethod
    def read(text):
        """Origin of a frame, and up to two directions, x and z, of a word: tuples of three numbers."""
        points = text.split(":")
        if len(points) > 3:
            raise words.WordError(text, FORM)
        return tuple(tuple(words.numbers(point, FORM, count=3)) for point in points)

    @classmethod
    def of(cls, origin, x, z, outward, normal=None):
        """The Frame through an origin with directions x and z, or None, which follow from the outward area vector;
        normal: that of a section, in which they lie."""
        total = outward / max(np.linalg.norm(outward), 1e-300)
        z = -total if z is None else np.array(z) / max(np.linalg.norm(z), 1e-300)
        if total @ z > 0.0:
            raise Error("z of --frame points out of the body: reverse it")
        if x is None and normal is not None:
            x = np.cross(normal, z)
            x = x * np.sign(x[np.argmax(np.abs(x))])
        elif x is None:
            x = (1.0, 0.0, 0.0) if abs(z[0]) < 0.9 else (0.0, 1.0, 0.0)
        x = np.array(x) - (np.array(x) @ z) * z
        if np.linalg.norm(x) < 1e-6:
            raise Error("x and z of --frame are parallel or zero: give two different directions")
        x /= np.linalg.norm(x)
        if normal is not None and max(abs(x @ normal), abs(z @ normal)) > 1e-6:
            raise Error("x and z of --frame are not in the plane of the section: give directions in it")
        return cls(np.array(origin, dtype=float), np.stack([x, np.cross(z, x), z]))

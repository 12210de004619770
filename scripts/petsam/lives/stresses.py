"""The stresses of a cycle and its fatigue parameters: of a file of petsam-stress, or of petsam.Contact.fatigue()."""

import os

import numpy as np

from ..core.errors import Error, one_line, short, there_are
from ..core.files import decoded
from ..results.stresses import FATIGUE, Stresses


def terms(angle):
    """Returns {name: factor}; the sum of factors times stresses is the stress on planes with this angle (degrees)."""
    cosine, sine = np.cos(np.deg2rad(angle)), np.sin(np.deg2rad(angle))
    found = {"stress_xx": cosine**2, "stress_yy": sine**2, "stress_xy": 2.0 * sine * cosine}
    return {name: term for name, term in found.items() if abs(term) > 1e-15}


class Cycle:
    """Stresses and parameters on the points x, y, z; constants are those of the body, young (Pa) and poisson."""

    layered = False

    def __init__(self, source, label="the contact", **constants):
        """source: a petsam.Stresses, or the arrays by name of petsam.Contact.fatigue(), then with the constants."""
        self.source, self.file = source, source if isinstance(source, Stresses) else None
        self.path, self.label, self.constants = label, os.path.splitext(os.path.basename(label))[0], constants
        self.x, self.y, self.z = (getattr(source, n) if self.file else np.asarray(source[n]) for n in "xyz")
        if self.file:
            self.path, self.label, of = source.path, source.label, source.parameters
            self.constants = self._moduli(of)
        if self.z[0] != 0.0:
            raise Error(f"{self.path}: its first depth is {self.z[0]:g} m; give petsam-stress depths from 0 on")
        self.steps = source.times.size if self.file else np.size(source["time"])

    def _moduli(self, of):
        """Young's modulus and Poisson's ratio of the body; with layers at each depth, (z, 1, 1), or {} of a profile."""
        body = f"body{of['body']:.0f}_"
        self.layered = any(body + name in of for name in ("layer_young", "layer_file"))
        if not self.layered:
            return {name: float(of[name]) for name in ("young", "poisson")}
        if body + "layer_thickness" not in of:
            return {}
        # at an interface the depth itself is above it, the next number below
        layer = np.searchsorted(np.cumsum(of[body + "layer_thickness"]), self.z)
        count, found = np.size(of[body + "layer_young"]), {}
        for name in ("young", "poisson"):
            values = np.append(np.broadcast_to(of[f"{body}layer_{name}"], count), of.get(body + name, np.nan))
            found[name] = values[layer][:, None, None]
        return found

    @property
    def averaged(self):
        """Length over which the stresses have been averaged (petsam-stress -fatigue_length), m; 0: not at all."""
        return float(self.file.parameters.get("fatigue_length", 0.0)) if self.file else 0.0

    @property
    def doubt(self):
        """Warning of petsam-stress that the steps are no closed cycle, or more than one; "" for none."""
        words = self.file.parameters.get("cycle_warning", "") if self.file else ""
        return one_line(decoded(words) if isinstance(words, bytes) else words, 480)

    def __contains__(self, name):
        return name in self.source and name not in ("x", "y", "z", "time")

    @property
    def names(self):
        """Names of the quantities and parameters."""
        names = self.file.file if self.file else self.source
        return [name for name in names if name in self and name != "history" and "_normal_" not in name]

    def _part(self, name, rows=slice(None), columns=slice(None)):
        """Values (steps, z, y, x) of a quantity, step by step; of a parameter one."""
        if name not in self:
            raise Error(f"{self.path}: has no {short(name)} (petsam-stress){there_are(name, self.names, 'it has')}")
        for step in range(1 if name in FATIGUE else self.steps):
            if self.file:
                yield self.file.field(name, step, rows=rows, columns=columns)
            else:
                values = np.asarray(self.source[name])
                yield (values if name in FATIGUE else values[step])[:, rows, columns]

    def unit(self, name):
        """Unit of a quantity or a parameter."""
        return self.file.unit(name) if self.file else {"fatemi_socie": "1", "ruiz_1": "J/m2"}.get(name, "Pa")

    def maximum(self, name):
        """The largest value over the steps, (z, y, x)."""
        top = None
        for values in self._part(name):
            top = values if top is None else np.fmax(top, values)
        return top

    def on_plane(self, angle=0.0, row=None, column=None):
        """Stress on planes normal to the surface, whose normal has this angle (degrees) to x: (z, y, x) by step."""
        of = terms(angle)
        window = () if row is None else (slice(row, row + 1), slice(column, column + 1))
        for parts in zip(*(self._part(name, *window) for name in of)):
            yield sum(term * part for term, part in zip(of.values(), parts))

    def extremes(self, angle=0.0):
        """Maximum and minimum of that stress over the steps, (z, y, x)."""
        high = low = None
        for values in self.on_plane(angle):
            high = values if high is None else np.fmax(high, values)
            low = values if low is None else np.fmin(low, values)
        return high, low

    def hot_spot(self, name):
        """Row and column of the largest value of a quantity or parameter on the surface."""
        top = self.maximum(name)[0]
        if not np.isfinite(top).any():
            raise Error(f"{self.path}: {name} has no value on the surface; name another parameter by --hot")
        row, column = np.unravel_index(np.nanargmax(top), top.shape)
        return int(row), int(column)

    def nearest(self, x, y):
        """Row and column of the point nearest to x, y (m); Error beyond the outermost cells."""
        found = []
        for letter, axis, wanted in (("y", self.y, y), ("x", self.x, x)):
            half = 0.5 * (axis[1] - axis[0]) if axis.size > 1 else np.inf
            if not axis[0] - half <= wanted <= axis[-1] + half:
                limits = f"{axis[0]:g} to {axis[-1]:g} m"
                raise Error(
                    f"{self.path}: --at: {letter} = {wanted:g} m is not on the points, {limits}; choose one there"
                )
            found.append(int(np.argmin(np.abs(axis - wanted))))
        return tuple(found)

    def line(self, name, row, column):
        """The largest value over the steps along the depth below a point."""
        window = (slice(row, row + 1), slice(column, column + 1))
        return np.fmax.reduce([part[:, 0, 0] for part in self._part(name, *window)])

    def stress_line(self, angle, row, column):
        """on_plane() below a point, (time, z)."""
        return np.array([part[:, 0, 0] for part in self.on_plane(angle, row, column)])

"""The points of a profile in its own axes: y to the field side, z down, m."""

from dataclasses import dataclass, field, replace
from typing import NamedTuple, Optional

import numpy as np

from ...core.brief import brief
from ...core.errors import Error, Unusable, counted

KINDS = ("rail", "wheel")
FEWEST = 5  # points that a smoothing spline needs
WIDTHS = (10e-3, 1.0)  # m: no profile is narrower or wider
FARTHEST = 10.0  # m: no profile is deeper, or farther from its origin
LIGHTEST = 1e-9  # weight, and of two weights their ratio
BACK = -0.8  # cosine of the angle between two chords below which points go back
ASTRAY = -0.5  # the same where a chord is as long as a hole
FOLD = 0.5e-3  # m: points that step back by no more are removed

SPARSE = (10.0, 5e-3)  # distance of two points, over the median and in m, that may be a hole
NOISY = 1e-7  # m: median distance to the profile without waves shorter than SHORT
SHORT = 4e-3  # m
ASIDE = 5e-6  # m: a point that lies so far beside the cubic through two neighbours on each side may be a false one,
CORNER = (
    20.0  # 1/m: if that is more than the widest step between them, squared, times this, as at changes of curvature,
)
MOST = 5.0, 95.0  # and than this factor times this percentile of all such distances


class ProfileWarning(UserWarning):
    """Profiles or their places can be computed, but may not be intended."""


class Taken(NamedTuple):
    """How read() took a file: the direction of z in it, and whether y was mirrored; messages name the other way."""

    z: str = "down"
    mirror: bool = False

    @property
    def other_z(self) -> str:
        """The end of a message about a profile upside down."""
        other = "up" if self.z == "down" else "down"
        return f"is its z {other}? read(..., z='{other}') turns it over"

    def other_y(self, kind: str) -> str:
        """The cure of a profile that is mirrored."""
        if self.mirror:
            return f"omit mirror=True of read() of the {kind}"
        return f"give mirror=True to read() of the {kind}, or mirror.y = 1 in the file, or take mirrored()"


@brief
@dataclass(frozen=True, eq=False)
class Profile:
    """A rail's or a wheel's profile.

    Parameters
    ----------
    y, z : ndarray
        Points in their order along the profile, (n,), m; y to the field side, z down.
    kind : str
        rail or wheel.
    weights : ndarray, optional
        Weights of the points in smoothed(), (n,); 1 by default.
    name : str
        The name in messages: of a profile that was read, its file.
    taken : Taken
        How its file was read, for messages.

    Raises
    ------
    Error
        If there are fewer than five points, a number is not finite, a weight is not positive, or the profile is so
        narrow or wide that its unit of length must be another one.
    """

    y: np.ndarray
    z: np.ndarray
    kind: str
    weights: Optional[np.ndarray] = field(default=None, repr=False)
    name: str = "profile"
    taken: Taken = field(default=Taken(), repr=False)

    def __post_init__(self) -> None:
        if self.kind not in KINDS:
            raise Error(f"{self.name}: kind {self.kind!r}: expected {' or '.join(KINDS)}")
        y, z = np.asarray(self.y, dtype=float).ravel(), np.asarray(self.z, dtype=float).ravel()
        weights = np.ones_like(y) if self.weights is None else np.asarray(self.weights, dtype=float).ravel()
        if not len(y) == len(z) == len(weights):
            raise Error(f"{self.name}: y, z and weights have {len(y)}, {len(z)} and {len(weights)} numbers")
        if not (np.isfinite(y).all() and np.isfinite(z).all() and np.isfinite(weights).all() and (weights > 0).all()):
            raise Error(f"{self.name}: expected finite numbers, and weights above 0")
        if len(weights) and not (LIGHTEST < weights.min() and weights.max() < weights.min() / LIGHTEST):
            raise Error(f"{self.name}: weights from {weights.min():g} to {weights.max():g}: give numbers near 1")
        self._need_small(y, z)
        new = np.concatenate([[True], np.hypot(np.diff(y), np.diff(z)) > 0.0]) if len(y) else np.ones(0, bool)
        if new.sum() < FEWEST:
            raise Error(f"{self.name}: {new.sum()} points: a profile has at least {FEWEST}")
        for name, values in (("y", y[new]), ("z", z[new]), ("weights", weights[new])):
            values.setflags(write=False)
            object.__setattr__(self, name, values)

    def _need_small(self, y, z):
        """Raises Error for a width or a place that no profile has in m."""
        if len(y) < FEWEST:
            return
        with np.errstate(over="ignore"):
            width, farthest = float(np.ptp(y)), float(max(np.abs(y).max(), np.abs(z).max()))
        if not WIDTHS[0] <= width <= WIDTHS[1]:
            raise Error(f"{self.name}: is {width:g} m wide: check its unit of length")
        if farthest > FARTHEST:
            raise Error(f"{self.name}: has a point {farthest:.3g} m from its origin: check its unit of length")

    def doubts(self) -> list[str]:
        """Reasons for which the points may not be the profile: holes between them, noise, and single false points.

        Returns
        -------
        list of str
            A sentence for each; empty for points that raise no doubt.
        """
        found, steps = [], np.diff(self.lengths)
        widest = int(np.argmax(steps))
        if steps[widest] > max(SPARSE[0] * np.median(steps), SPARSE[1]):
            found.append(
                f"{self.name}: no points from y {1e3 * self.y[widest]:.4g} to {1e3 * self.y[widest + 1]:.4g} mm: the "
                "profile is a smooth curve between them"
            )
        noise = float(np.median(abs(self.smoothed(SHORT).z - self.z)))
        if noise > NOISY:
            found.append(
                f"{self.name}: its heights vary by {1e6 * noise:.2g} um from point to point, which makes pressures too "
                f"high: smoothed({SHORT:g}) removes it, with 5 um of noise smoothed({2 * SHORT:g})"
            )
        aside, limit = self._aside()
        if (aside > limit).any():
            k = int(np.argmax(aside / limit)) + 2
            found.append(
                f"{self.name}: the point at y {1e3 * self.y[k]:.4g} mm, z {1e3 * self.z[k]:.4g} mm, lies "
                f"{1e6 * aside[k - 2]:.3g} um beside a smooth curve through its neighbours, which makes pressures too "
                "high: remove it, if it is a false one"
            )
        return found

    def _aside(self):
        """Distances of all points but two at each end from the cubic through two neighbours on each side, m, and limits
        above which they are doubtful."""
        s, k = self.lengths, np.arange(2, len(self.y) - 2)
        beside = k[:, None] + np.array([-2, -1, 1, 2])
        t = s[beside] - s[k, None]
        weights = np.stack(
            [np.prod([t[:, j] / (t[:, j] - t[:, m]) for j in range(4) if j != m], axis=0) for m in range(4)], axis=1
        )
        found = np.hypot(*(values[k] - np.sum(weights * values[beside], axis=1) for values in (self.y, self.z)))
        widest = np.diff(np.insert(t, 2, 0.0, axis=1), axis=1).max(axis=1)
        return found, np.maximum(CORNER * widest**2, max(ASIDE, MOST[0] * np.percentile(found, MOST[1])))

    def need_forward(self) -> None:
        """Raises Error where points go or jump back along the profile."""
        steps = np.diff(np.column_stack([self.y, self.z]), axis=0)
        length = np.hypot(*steps.T)
        steps /= length[:, None]
        turn = np.sum(steps[1:] * steps[:-1], axis=1)
        long = length > max(SPARSE[0] * np.median(length), SPARSE[1])
        back = np.flatnonzero((turn < BACK) | (turn < ASTRAY) & (long[1:] | long[:-1]))
        if len(back):
            k = back[0] + 1
            raise Error(
                f"{self.name}: point {k + 1}, y = {self.y[k]:.6g} m, z = {self.z[k]:.6g} m: the points go back there: "
                "sort them along the profile, and remove folds"
            )

    def without_folds(self) -> tuple["Profile", str]:
        """The profile without points that step back a little, as those of a probe that trembles do.

        Returns
        -------
        Profile
            Without the points that lie up to 0.5 mm behind one before them.
        str
            A sentence about them; empty where there are none.
        """
        points = np.column_stack([self.y, self.z])
        kept, farthest = [0, 1], 0.0
        for k in range(2, len(points)):
            ahead = points[kept[-1]] - points[kept[-2]]
            step = points[k] - points[kept[-1]]
            along, length = float(ahead @ step) / float(np.hypot(*ahead)), float(np.hypot(*step))
            if 0.0 < length <= FOLD and along < BACK * length:
                farthest = max(farthest, -along)
            elif length > 0.0:
                kept.append(k)
        count = len(points) - len(kept)
        if not count or not farthest:
            return self, ""
        text = (
            f"{self.name}: {counted(count, 'point')} removed that step back along the profile, by up to "
            f"{1e3 * farthest:.2g} mm (at most {1e3 * FOLD:g} mm is removed)"
        )
        return replace(self, y=self.y[kept], z=self.z[kept], weights=np.asarray(self.weights)[kept]), text

    @property
    def lengths(self) -> np.ndarray:
        """Chord length from the first point to each, (n,), m."""
        return np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(self.y), np.diff(self.z)))])

    def smoothed(self, wavelength: float) -> "Profile":
        """The profile without waves that are much shorter than a wavelength.

        Parameters
        ----------
        wavelength : float
            Waves of this length are halved, longer ones kept, m: 4 mm for a measured profile with 1 um of noise, 8 mm
            with 5 um.

        Returns
        -------
        Profile
            Its points beside the old ones, by a weighted smoothing spline over the chord length.

        Raises
        ------
        Error
            If the wavelength is not above 0, or longer than the profile.

        Notes
        -----
        y and z minimise sum w (p - f)^2 + (L/2 pi)^4 times the integral of f''^2 each, where w is the point's weight
        times half the distance of its neighbours.
        """
        from scipy.interpolate import make_smoothing_spline

        s = self.lengths
        if not 0.0 < wavelength <= s[-1]:
            raise Unusable(
                f"{self.name}: wavelength {wavelength:g}: expected a length (m) above 0 and within {s[-1]:g}"
            )
        t = s / wavelength
        steps = np.diff(t)
        weights = np.asarray(self.weights) * 0.5 * np.concatenate([[steps[0]], steps[1:] + steps[:-1], [steps[-1]]])
        penalty = 1.0 / (2.0 * np.pi) ** 4
        y, z = (make_smoothing_spline(t, values, w=weights, lam=penalty)(t) for values in (self.y, self.z))
        return replace(self, y=y, z=z)

    def turned(self, angle: float) -> "Profile":
        """The profile turned about x through its origin.

        Parameters
        ----------
        angle : float
            rad; a positive one moves the field side down.

        Returns
        -------
        Profile
        """
        c, s = np.cos(angle), np.sin(angle)
        return replace(self, y=c * self.y - s * self.z, z=s * self.y + c * self.z)

    def mirrored(self) -> "Profile":
        """The profile with y of the other sign.

        Returns
        -------
        Profile
        """
        return replace(self, y=-self.y)

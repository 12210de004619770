"""Regions of overlap of the undeformed bodies, and the frames of their patches.

A patch has its origin on the rail and the axes e_x = (1, 0, 0), e_s = (0, cos d, sin d), e_n = (0, -sin d, cos d) into
the rail. Origin and angle d are means over the region with the weight overlap^2, integrated along x as for a parabola:
overlap^2.5. The box spans the overlap; an elastic contact is about 0.7 of it in each direction.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Optional, Union

import numpy as np

from ...core.brief import brief
from .locus import Locus
from .rails import Roller, Track

STEP = 60e-6  # m: of the search for overlaps
SMALLEST = 1e-4  # of the deepest overlap: regions below it carry nothing that counts


@brief
@dataclass(frozen=True, eq=False)
class Region:
    """An interval of y in which the undeformed bodies overlap: x of the locus, y and z of points on the rail, and
    overlap, m, 0 at the ends, and inclination of the rail, rad, (n,) each, the ends included. `at_end` is true where
    the region reaches the end of a profile."""

    x: np.ndarray
    y: np.ndarray
    z: np.ndarray
    overlap: np.ndarray
    angle: np.ndarray
    at_end: bool

    @property
    def weights(self) -> np.ndarray:
        """Weights of the points in means over the region, (n,)."""
        return self.overlap**2.5

    def mean(self, values: np.ndarray) -> float:
        """Weighted mean of values (n,) at the points."""
        return float(np.average(values, weights=self.weights))

    def joined(self, other: "Region") -> "Region":
        """This region and the next one as one."""
        names = ("x", "y", "z", "overlap", "angle")
        arrays = {name: np.concatenate([getattr(self, name), getattr(other, name)]) for name in names}
        return Region(**arrays, at_end=self.at_end or other.at_end)

    def distance(self, other: "Region") -> float:
        """Distance from the end of this region to the start of the next one, m."""
        return float(np.hypot(other.y[0] - self.y[-1], other.z[0] - self.z[-1]))


@brief
@dataclass(frozen=True, eq=False)
class Place:
    """The frame of a patch and the box of its overlap: origin on the rail, (3,), m; angle d, rad; corners of the box in
    the patch's x and s, (2,), m; its weight in means over patches; `at_end`, true where the overlap reaches the end of
    a profile; and x and s of the points of its region with the overlap there along the normal, (3, n), m."""

    origin: np.ndarray
    angle: float
    low: np.ndarray
    high: np.ndarray
    weight: float
    at_end: bool
    line: Optional[np.ndarray] = None

    @property
    def axes(self) -> np.ndarray:
        """e_x, e_s, e_n as rows, (3, 3)."""
        c, s = np.cos(self.angle), np.sin(self.angle)
        return np.array([[1.0, 0.0, 0.0], [0.0, c, s], [0.0, -s, c]])


@brief
@dataclass(frozen=True, eq=False)
class Search:
    """Gap (n,), m, of the undeformed bodies along the locus, at z = 0 of the wheelset, over x of the locus and y and z
    of points on the rail above it, (n,), m, for the wheel's nominal radius, m. `cut` is true where the first or last
    point is not the end of a visible profile."""

    rail: Union[Track, Roller]
    radius: float
    x: np.ndarray
    y: np.ndarray
    z: np.ndarray
    gap: np.ndarray
    cut: tuple[bool, bool] = (False, False)

    @property
    def touch(self) -> float:
        """z of the wheelset at which the bodies touch, m."""
        k = int(np.argmin(self.gap))
        if not 0 < k < len(self.gap) - 1:
            return float(self.gap[k])
        a, b, c = self.gap[k - 1 : k + 2]
        return float(b - 0.125 * (c - a) ** 2 / (a - 2.0 * b + c)) if a - 2.0 * b + c > 0.0 else float(b)

    def regions(self, z: float) -> list[Region]:
        """The regions of overlap at a height of the wheelset, m, in growing y, without those that carry nothing that
        counts."""
        overlap = z - self.gap
        inside = np.concatenate([[False], overlap > 0.0, [False]])
        edges = np.flatnonzero(np.diff(inside.astype(int)))
        found = [self._region(overlap, first, last) for first, last in zip(edges[::2], edges[1::2])]
        return [one for one in found if one.overlap.max() > SMALLEST * overlap.max()]

    def _region(self, overlap, first, last):
        """The region of the points first to last - 1, with its ends by linear interpolation."""
        at_end = first == 0 or last == len(overlap)
        columns = np.stack([self.x, self.y, self.z, overlap])
        points = columns[:, first:last]
        if first > 0:
            points = np.column_stack([_zero(columns[:, first - 1], columns[:, first]), points])
        if last < len(overlap):
            points = np.column_stack([points, _zero(columns[:, last - 1], columns[:, last])])
        x, y, z, depth = points
        return Region(x, y, z, np.maximum(depth, 0.0), np.arctan(self.rail.section.slope(y)), bool(at_end))

    def place(self, region: Region) -> Place:
        """The frame and the box of a patch on a region."""
        x, y, angle = (region.mean(values) for values in (region.x, region.y, region.angle))
        origin = np.array([x, y, float(self.rail.surface(np.array(x), np.array(y)))])
        place = Place(origin, angle, origin[:2], origin[:2], float(region.weights.sum()), region.at_end)
        return self.boxed(place, region)

    def boxed(self, place: Place, region: Region) -> Place:
        """A patch on a region with its box along the axes of its angle."""
        curvature = 1.0 / self.radius + 1.0 / self.rail.roller_radius
        half = np.sqrt(2.0 * region.overlap / curvature)
        s = (region.y - place.origin[1]) * place.axes[1, 1] + (region.z - place.origin[2]) * place.axes[1, 2]
        low = np.array([(region.x - half).min() - place.origin[0], s.min()])
        high = np.array([(region.x + half).max() - place.origin[0], s.max()])
        line = np.stack([region.x - place.origin[0], s, region.overlap * place.axes[1, 1]])
        return replace(place, low=low, high=high, line=line)


def _zero(one, other):
    """The point between two points at which their last number is 0."""
    part = one[-1] / (one[-1] - other[-1])
    return one + part * (other - one)


def search(
    rail: Union[Track, Roller], radius: float, line: Locus, ends: Optional[tuple[float, float]] = None
) -> Optional[Search]:
    """The gap along the locus, or its part that counts, where rail and wheel are both visible; None where the wheel is
    beside the rail. The points of a part are some of those of the whole, whose `ends` (m) are given with it."""
    first, last = ends or (line.first, line.last)
    first, last = max(rail.section.first, first), min(rail.section.last, last)
    if last - first < 4.0 * STEP:
        return None
    y = np.linspace(first, last, int(np.ceil((last - first) / STEP)) + 1)
    if ends is not None:
        y = y[(y >= line.first) & (y <= line.last)]
    x, z = line.at(y)
    cut = bool(y[0] > first), bool(y[-1] < last)
    return Search(rail, radius, x, y, rail.section.height(y), rail.surface(x, y) - z, cut)


def merged(regions: Sequence[Region], separation: float) -> list[Region]:
    """Regions, in growing y, with those whose distance is up to a separation (m) as one."""
    found = list(regions[:1])
    for region in regions[1:]:
        if found[-1].distance(region) <= separation:
            found[-1] = found[-1].joined(region)
        else:
            found.append(region)
    return found


def places(search: Search, regions: Sequence[Region], separation: float, combination: float) -> list[Place]:
    """The patches of regions, in growing y: those up to `separation` (m) apart share a grid; neighbours between
    `separation` and 2 separation - combination (m, below `separation`) are turned towards their mean angle, so that
    forces do not jump where they merge."""
    regions = merged(regions, separation)
    found = [search.place(region) for region in regions]
    apart = np.array([one.distance(other) for one, other in zip(regions, regions[1:])])
    parts = np.maximum(2.0 * separation - combination - apart, 0.0) / (separation - combination)
    angles = _turned(np.array([(one.angle, one.weight) for one in found]), parts)
    turned = [replace(place, angle=angle) for place, angle in zip(found, angles)]
    return [search.boxed(place, region) for place, region in zip(turned, regions)]


def _turned(patches, parts):
    """Angles of patches, given with their weights, of which each neighbour is merged with the next one in part.

    They are means over all ways to merge some neighbours and leave others, so that angles are continuous where any two
    merge.
    """
    links, found = np.concatenate([[0.0], parts, [0.0]]), np.zeros(len(patches))
    for first in range(len(patches)):
        for end in range(first + 1, len(patches) + 1):
            share = (1.0 - links[first]) * np.prod(links[first + 1 : end]) * (1.0 - links[end])
            angles, weights = patches[first:end].T
            found[first:end] += share * np.average(angles, weights=weights)
    return found.tolist()

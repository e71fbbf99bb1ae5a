"""Colours of skin and cloth that no picture shows, from those that it shows.

Clothes and limbs go round: what is seen of a ring round the trunk or a limb tells the rest of
that ring. The colours seen of each region of the body are therefore read as a profile along it, the
trunk and legs from the crown down, the arms from the shoulder out, and cut into bands of plain
colour. That is what hidden points show, so that a hem or a belt runs on behind, and a check, a
fold or a print does not. Where hidden meets seen its light follows what is seen
(:func:`fitter.applications.surface_field.extend_light`). Regions blend where they meet.

The head is no ring: its back is hair. The scalp has one colour of its own, wherever any of it is
seen.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import cv2
import numpy as np
from jaxtyping import Float, Integer

from fitter.applications.picture_surface import Colours, SurfacePoints, smooth_step
from fitter.applications.rings import Region, RingCoordinates
from fitter.observation.pixels import display_from_linear

BIN_M = 0.006
"""Width of a ring: a hem is as sharp behind as this."""

LEAST_WEIGHT = 25.0
"""Texels believed wholly, of an atlas of 1024, from which a ring is read; one with fewer is
interpolated between those beside it."""

FORGOTTEN_M = 0.05
"""Along the surface, over which what is seen at the border loses its influence by e."""

MIDDLE = (0.35, 0.65)
"""Quantiles of a ring's brightness between which its colours are averaged: nipples, logos and
shade lie outside."""

SHADE_M = 0.1
"""Along a band of plain colour, over which its rings are averaged: light from above stays, folds
and stripes do not."""

SAME_CLOTH = 10.0
"""Difference of two bands, in CIELAB with less brightness, up to which they are one cloth or skin
in other light."""

HEM_COST = 9.0
"""Cost of one more band, in squares of CIELAB metres: a band of 3 cm stays if it differs by 25 from
what is beside it, and one of 20 cm by 10."""

BRIGHTNESS_SHARE = 0.4
"""Weight of brightness against hue and saturation when bands are told apart."""

BORDER = (0.3, 0.7)
"""Shares of a region between which its colours turn into its neighbour's, over about 1.5 cm."""

SHOULDER_M = (0.0, 0.08)
"""Along the arm, where the trunk's colours turn into its own."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ColourProfiles:
    """Colours along each region, from what is seen of it.

    Attributes
    ----------
    positions_m, colours
        (b,) centres of the rings that were read and (b, 3) their linear colours, by region.
    """

    positions_m: Mapping[Region, Float[np.ndarray, " b"]]
    colours: Mapping[Region, Float[np.ndarray, "b 3"]]

    @classmethod
    def of(
        cls,
        region: Integer[np.ndarray, " k"],
        along_m: Float[np.ndarray, " k"],
        colours: Colours,
        weights: Float[np.ndarray, " k"],
        *,
        least_weight: float,
    ) -> "ColourProfiles":
        """Read the profiles of points with these weights.

        Parameters
        ----------
        region, along_m
            Of the points, as of :meth:`RingCoordinates.of_points`.
        least_weight
            Of a ring, that it counts.
        """
        positions: dict[Region, Float[np.ndarray, " b"]] = {}
        found: dict[Region, Float[np.ndarray, "b 3"]] = {}
        for each in Region:
            own = (region == each) & (weights > 0.0)
            bins = np.floor(along_m[own] / BIN_M).astype(np.intp)
            rings, read = _rings(bins, colours[own], weights[own], least_weight)
            positions[each] = (rings + 0.5) * BIN_M
            found[each] = _plain(positions[each], read)
        return cls(positions_m=positions, colours=found)

    @property
    def empty(self) -> bool:
        """Whether no ring was read."""
        return not any(len(read) for read in self.colours.values())

    def at(self, region: Region, along_m: Float[np.ndarray, " k"]) -> Colours:
        """Colours of points of a region, unless all are empty."""
        positions, read = self.positions_m[region], self.colours[region]
        if not len(positions):
            stand_in = next(each for each in _INSTEAD[region] if len(self.colours[each]))
            return np.tile(np.median(self.colours[stand_in], axis=0), (len(along_m), 1))
        return np.stack([np.interp(along_m, positions, read[:, k]) for k in range(3)], axis=1)


_INSTEAD: Mapping[Region, tuple[Region, ...]] = {
    Region.TRUNK: (Region.ARMS, Region.HANDS, Region.FACE, Region.SCALP),
    Region.ARMS: (Region.HANDS, Region.FACE, Region.TRUNK, Region.SCALP),
    Region.HANDS: (Region.FACE, Region.ARMS, Region.TRUNK, Region.SCALP),
    Region.FACE: (Region.HANDS, Region.ARMS, Region.SCALP, Region.TRUNK),
    Region.SCALP: (Region.FACE, Region.HANDS, Region.ARMS, Region.TRUNK),
}
"""Stand-ins for a region of which nothing is seen, best first: for skin, other skin."""


def on_rings(
    rings: RingCoordinates,
    profiles: ColourProfiles,
    points: SurfacePoints,
) -> Colours:
    """Colours of points; at the shoulder the trunk's merge into the arm's."""
    colours, total = np.zeros((len(points.corners), 3)), np.zeros((len(points.corners), 1))
    for each in Region:
        own = points.near(rings.shares[each] > BORDER[0])
        of_region = points.some(own)
        share = smooth_step(of_region.of(rings.shares[each]), *BORDER)[:, None]
        found = profiles.at(each, of_region.of(rings.along_m[each]))
        if each is Region.ARMS:
            arm = smooth_step(of_region.of(rings.along_m[each]), *SHOULDER_M)[:, None]
            trunk = profiles.at(Region.TRUNK, of_region.of(rings.along_m[Region.TRUNK]))
            found = arm * found + (1.0 - arm) * trunk
        colours[own] += share * found
        total[own] += share
    return colours / total


def _rings(
    bins: Integer[np.ndarray, " k"],
    colours: Colours,
    weights: Float[np.ndarray, " k"],
    least_weight: float,
) -> tuple[Integer[np.ndarray, " b"], Float[np.ndarray, "b 3"]]:
    """Bins that have enough weight, and the colours in the middle of each one's brightness."""
    if not len(bins):
        return bins, colours
    order = np.lexsort((colours.sum(axis=1), bins))
    bins, colours, weights = bins[order], colours[order], weights[order]
    rings, starts = np.unique(bins, return_index=True)
    totals = np.add.reduceat(weights, starts)
    before = np.cumsum(totals) - totals
    counts = np.diff(np.append(starts, len(bins)))
    darker = np.cumsum(weights) - 0.5 * weights - np.repeat(before, counts)
    quantile = darker / np.repeat(totals, counts)
    # In a ring of few points none may lie in the middle: then all count.
    middle = np.where((quantile >= MIDDLE[0]) & (quantile <= MIDDLE[1]), weights, 1e-6 * weights)
    sums = np.add.reduceat(middle[:, None] * colours, starts, axis=0)
    means = sums / np.add.reduceat(middle, starts)[:, None]
    enough = totals >= least_weight
    return rings[enough], means[enough]


def _plain(
    positions_m: Float[np.ndarray, " b"], colours: Float[np.ndarray, "b 3"]
) -> Float[np.ndarray, "b 3"]:
    """A profile cut into bands of plain colour, smooth along themselves and into those like them.

    Folds, muscles, patterns and logos go, hems and broad stripes stay.
    """
    if not len(positions_m):
        return colours
    worn = cloth_colours(colours)
    band = _bands(worn)
    means = np.stack([worn[band == each].mean(axis=0) for each in np.unique(band)])
    worn = means[np.unique(band, return_inverse=True)[1]]
    apart = (positions_m[:, None] - positions_m) / SHADE_M
    unlike = np.linalg.norm(worn[:, None] - worn, axis=2) / SAME_CLOTH
    weights = np.exp(-0.5 * (apart**2 + unlike**2))
    return weights @ colours / weights.sum(axis=1, keepdims=True)


def cloth_colours(colours: Float[np.ndarray, "b 3"]) -> Float[np.ndarray, "b 3"]:
    """CIELAB with less of its brightness, in which folds and shade differ most."""
    shown = display_from_linear(np.clip(colours, 0.0, 1.0)).astype(np.float32)
    lab = cv2.cvtColor(shown[None], cv2.COLOR_RGB2LAB)[0].astype(np.float64)
    return lab * [BRIGHTNESS_SHARE, 1.0, 1.0]


def _bands(values: Float[np.ndarray, "b 3"]) -> Integer[np.ndarray, " b"]:
    """Which band of constant value each ring lies in: least squares plus :data:`HEM_COST` a cut.

    Dynamic programming over the last cut before each ring (the Potts model in one dimension).
    """
    count = len(values)
    sums = np.concatenate([np.zeros((1, 3)), np.cumsum(values, axis=0)])
    squares = np.concatenate([[0.0], np.cumsum((values**2).sum(axis=1))])
    best, cut = np.zeros(count + 1), np.zeros(count + 1, dtype=np.intp)
    for end in range(1, count + 1):
        starts = np.arange(end)
        spread = squares[end] - squares[:end]
        spread -= ((sums[end] - sums[:end]) ** 2).sum(axis=1) / (end - starts)
        costs = best[:end] + BIN_M * spread + HEM_COST
        cut[end] = np.argmin(costs)
        best[end] = costs[cut[end]]
    band = np.zeros(count, dtype=np.intp)
    end = count
    while end > 0:
        band[cut[end] : end] = cut[end]
        end = int(cut[end])
    return band

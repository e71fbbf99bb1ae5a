"""Colours of skin and cloth that no picture shows, from those that it shows.

Clothes and limbs go round: what is seen of a ring round the trunk or a limb tells the rest of
that ring. The colours seen of each region of the body are therefore read as a profile along it, the
trunk and legs from the crown down, the arms from the shoulder out. The profile is what hidden
points show, so that a hem, a belt or a stripe runs on behind. Where hidden meets seen it follows
what is seen, and forgets that over some centimetres.

The head is no ring: its back is hair. The scalp has one colour of its own, wherever any of it is
seen.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Integer

from fitter.applications.rings import Region, RingCoordinates
from fitter.applications.seen_surface import Colours, SurfacePoints, smooth_step
from fitter.body.model import BodyModel
from fitter.numerics.mesh_topology import mesh_topology
from fitter.observation.colour import display_from_linear
from fitter.optimizer.hidden_reflectance import HiddenVertices

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

SHADE_M, SHADE_LEVELS = 0.06, 0.08
"""Of the filter along a profile: over what distance, and up to which difference of displayed
colours (0 to 1), two rings count as the same cloth under different light."""

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
            found[each] = _without_shade(positions[each], read)
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
"""What stands in for a region of which nothing is seen, best first: for skin, other skin."""


def on_rings(
    rings: RingCoordinates,
    profiles: ColourProfiles,
    triangles: Integer[np.ndarray, " k"],
    points: SurfacePoints,
) -> Colours:
    """Colours of points on given triangles; at the shoulder the trunk's merge into the arm's."""
    region, along_m = rings.of_points(triangles, points)
    colours = np.empty((len(region), 3))
    for each in Region:
        own = region == each
        colours[own] = profiles.at(each, along_m[own])
    arms = region == Region.ARMS
    from_trunk = profiles.at(Region.TRUNK, points.of(rings.along_m[Region.TRUNK])[arms])
    share = smooth_step(along_m[arms], *SHOULDER_M)[:, None]
    colours[arms] = share * colours[arms] + (1.0 - share) * from_trunk
    return colours


def following(
    model: BodyModel, known: Bool[np.ndarray, " m"], differences: Float[np.ndarray, "m 3"]
) -> Float[np.ndarray, "m 3"]:
    """Carry on how far what is seen differs from the profile, over :data:`FORGOTTEN_M`.

    Parameters
    ----------
    known
        Which vertices are seen.
    differences
        Of their colours from the profile's; of the others without meaning.
    """
    edges = mesh_topology(model.triangles, vertex_count=len(model.mean_vertices)).edges
    first, second = model.mean_vertices[edges.T]
    lengths = np.maximum(np.linalg.norm(first - second, axis=1), 1e-4)
    # Three edges a vertex in all directions: Σ (v_i - v_j)² / d is Σ 1.5 d |∇v|² over vertices, so
    # that a ridge of 1.5 d / s² makes solutions decay by e over a distance s.
    count = len(known)
    sums = np.bincount(edges.ravel(), np.repeat(lengths, 2), count)
    ridge = 1.5 * sums / np.bincount(edges.ravel(), minlength=count) / FORGOTTEN_M**2
    hidden = HiddenVertices.of(known, edges, lengths, ridge=ridge)
    return np.stack([hidden.filled(differences[:, k], toward=0.0) for k in range(3)], axis=1)


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


def _without_shade(
    positions_m: Float[np.ndarray, " b"], colours: Float[np.ndarray, "b 3"]
) -> Float[np.ndarray, "b 3"]:
    """The bilateral filter along a profile: folds and muscles go, hems and stripes stay."""
    shown = display_from_linear(np.clip(colours, 0.0, 1.0))
    apart = (positions_m[:, None] - positions_m) / SHADE_M
    unlike = np.linalg.norm(shown[:, None] - shown, axis=2) / SHADE_LEVELS
    weights = np.exp(-0.5 * (apart**2 + unlike**2))
    return weights @ colours / weights.sum(axis=1, keepdims=True)

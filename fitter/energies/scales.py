"""The scale of every energy term.

The paper adds its terms with unit weights and leaves their normalisation open. Here every term is
a negative log-likelihood, scaled by the expected size of its residuals, so that unit weights are
right by construction, the shape prior is N(0, I), and the final Gauss-Newton matrix is an
information matrix. Lengths on the body are given in metres and converted to pixels at the body's
distance, so that a fit does not depend on the size of the picture.
"""

from dataclasses import dataclass, replace

from fitter.render.camera import Camera


@dataclass(frozen=True, slots=True, kw_only=True)
class EnergyScales:
    """Scales in working pixels unless said otherwise.

    Attributes
    ----------
    silhouette_sigma
        Standard deviation of the segmented boundary about the model's contour.
    silhouette_eta
        Distance at about which a boundary starts to be treated as an outlier.
    correlation_length
        Neighbouring boundary pixels are not independent: this many count as one.
    contour_sigma
        Standard deviation of the model's contour about the person's.
    line_correlation_length
        Pixels of contour whose correspondence lines count as one.
    edge_weight
        Nats for a body whose visible edges all miss every image edge.
    click_hand
        Spread of clicked points due to an unsteady hand.
    penetration_sigma_m
        Metres of overlap between body parts that cost half a nat.
    shading_weight
        Half the number of patches of the visible surface whose brightness counts as independent.
    shading_floor
        Share of the shading that stays unexplained on the true body.
    shading_eta
        Geman-McClure scale η₁, relative to the person's median intensity.
    ease_mean, ease_spread, ease_reach
        Mean and standard deviation of how far loose clothes stand off the body, and the distance
        from the mean at about which they stop saying anything about it.
    ease_common_spread
        Standard deviation of an offset of that mean that all clothes of one person share.
    ease_correlation_length
        Pixels of outline whose ease counts as one.
    pixels_per_metre
        At the body's distance.
    """

    silhouette_sigma: float
    silhouette_eta: float
    correlation_length: float
    contour_sigma: float
    line_correlation_length: float
    edge_weight: float
    click_hand: float
    penetration_sigma_m: float
    shading_weight: float
    shading_floor: float
    shading_eta: float
    ease_mean: float
    ease_spread: float
    ease_common_spread: float
    ease_reach: float
    ease_correlation_length: float
    pixels_per_metre: float


FAR_BOUNDARY_ETA_M = 0.06
"""After the clicks, limbs are off by centimetres: what is a hand's breadth away must still pull."""

NEAR_BOUNDARY_ETA_M = 0.02
"""A boundary two centimetres off a fitted body is hair, cloth, ground or a missing foot."""

# A segmented boundary is a pixel uncertain and the model's own posed error is about 5 mm.
_BOUNDARY_PIXELS = 1.0
_BOUNDARY_METRES = 0.005
# Where a boundary is wrong, because of hair, cloth, shadow or a shape that twenty axes cannot
# express, it is wrong over a hand's length or more.
_CORRELATION_METRES = 0.2
# Lines that see no boundary say so, and few see a false one: the correlated error that remains is
# that of the model's contour. Chosen together with the shading's weight, below.
_LINE_CORRELATION_METRES = 0.15
_CLICK_PIXELS = 2.5


# What Eq. 1 leaves unexplained is correlated over more than a hand's breadth, and how much that is
# differs between pictures. Chosen on the tuning halves of both makers' bodies together:
# DECISIONS.md, "Shading is believed less, and the prior is wider".
_SHADING_PATCHES, _SHADING_FLOOR = 60.0, 0.1

# Chosen on the clothed pictures of the tuning half (4), where waists, without the common offset,
# have a mean error of 5.3 cm and are 0.5 cm too small. With 3 cm of mean ease 4.8, but 2.7 too
# small; counted every 25 cm 6.6; with the half-normal of 3 cm (mean 0) 8.0, counted once per
# garment 10.7. The reach is that of jackets and coats, with which real people are 10 cm broader.
EASE_MEAN_M, _EASE_SPREAD_M, _EASE_REACH_M = 0.025, 0.02, 0.1
_EASE_CORRELATION_METRES = 0.15
# With the offset, 95 % intervals hold 87 of 92 values on 23 other pictures of that half, in random
# outfits.
_EASE_COMMON_M = 0.02


_SHARED_LINES = 1.5


def scales_of_several(scales: EnergyScales) -> EnergyScales:
    """Scales for a picture that is one of several of a person: its outline counts for more.

    Chosen on the tuning half of the suite's phone pairs and on the foreign pairs together
    (DECISIONS.md, "One search for all pictures of a person").
    """
    return replace(
        scales,
        correlation_length=scales.correlation_length / _SHARED_LINES,
        line_correlation_length=scales.line_correlation_length / _SHARED_LINES,
    )


def scales_at(camera: Camera, depth_m: float, *, boundary_eta_m: float) -> EnergyScales:
    """Scales for a body at ``depth_m`` in front of ``camera``.

    ``boundary_eta_m`` is :data:`FAR_BOUNDARY_ETA_M` while the pose is coarse and
    :data:`NEAR_BOUNDARY_ETA_M` once the body is near.
    """
    pixels_per_metre = camera.focal_length_px / depth_m
    boundary = (_BOUNDARY_PIXELS**2 + (_BOUNDARY_METRES * pixels_per_metre) ** 2) ** 0.5
    return EnergyScales(
        silhouette_sigma=boundary,
        silhouette_eta=boundary_eta_m * pixels_per_metre,
        correlation_length=_CORRELATION_METRES * pixels_per_metre,
        contour_sigma=_BOUNDARY_METRES * pixels_per_metre,
        line_correlation_length=_LINE_CORRELATION_METRES * pixels_per_metre,
        edge_weight=40.0,
        click_hand=_CLICK_PIXELS,
        penetration_sigma_m=0.01,
        shading_weight=0.5 * _SHADING_PATCHES,
        shading_floor=_SHADING_FLOOR,
        shading_eta=0.15,
        ease_mean=EASE_MEAN_M * pixels_per_metre,
        ease_spread=_EASE_SPREAD_M * pixels_per_metre,
        ease_common_spread=_EASE_COMMON_M * pixels_per_metre,
        ease_reach=_EASE_REACH_M * pixels_per_metre,
        ease_correlation_length=_EASE_CORRELATION_METRES * pixels_per_metre,
        pixels_per_metre=pixels_per_metre,
    )

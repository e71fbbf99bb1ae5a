"""Silhouette energy E_Si: pixelwise distances between the model's region and the observed one.

Every unmatched pixel costs a function of its distance d to the other region (as in [5] and [22]),
here ρ'(d) = d / (1 + d²/η²)². A sliver of width δ along the outline then costs ∫ ρ' = ρ(δ) =
½ δ² / (1 + δ²/η²) for each pixel of outline: the sum is a Geman-McClure boundary error, and contour
points with its weights are its exact linearisation. Ground, walls and hair taken for the person lie
far from the body, where they do not pull. Divided by σ² and by the length over which neighbouring
errors are correlated, it is a negative log-likelihood.

The outline of loose clothes bounds the body from outside, and a pixel costs the derivative of the
function below. Balan and Black ("The Naked Truth", ECCV 2008): what is observed of a clothed person
is the body's boundary plus the ease e ≥ 0 of the clothes. If r is how far the body's contour lies
outside the observed outline, e = -r. Three things are known where cloth is seen with probability c:

- a body outside its clothes is as unlikely as one outside a tight outline: ρ_η(r)/σ² for r > 0;
- clothes stand off the body by an ease of mean μ and deviation τ:
  ρ_κ(r + μ)/τ², flat beyond κ, where a skirt or a cape says nothing of the leg beneath;
- the ease of one garment repeats itself over a length Λ.

A pixel of outline therefore costs the expected negative log-likelihood

    E(r) = (1 - c + c [r > 0]) ρ_η(r) / (σ² L) + c ρ_κ(r + μ) / (τ² Λ),

ρ_η(x) = ½ x² / (1 + x²/η²). The bracket jumps where ρ and its slope are zero, so that E is once
continuously differentiable. Its two terms are two rows of least squares; without cloth it is the
tight outline's.

μ is that of the place: cloth lies on shoulders and hangs away from shins. As written, the ease of
each length Λ is independent of the others', but who wears a wide shirt wears it all over. Where the
contour is fitted to lines, all of it shares two offsets δ ~ N(0, τ_δ²), of what covers the upper
body and the legs, each in proportion g to the usual ease f there: g = f for what is closer than
usual, and hardly more for jackets, which differ less than in proportion. They are not parameters of
the body: the energy is that of their most probable values,

    min over δ of  Σ ρ_κ(r + μ + g · δ) c / (τ² Λ) + ½ |δ|²/τ_δ²,

so that bare skin and what is usual for people tell how wide this person's clothes are.
"""

from typing import Final

import cv2
import numpy as np
from jaxtyping import Bool, Float, Integer

from fitter.energies._picture_kernels import (
    Clothes,
    EaseCost,
    Pixels,
    RobustCost,
    bounding_box,
    clothed_mismatch,
    nearest_within,
    robust_mismatch,
)
from fitter.energies.rows import Nuisance, PositionRows, boundary_loss, boundary_weights
from fitter.energies.scales import EnergyScales
from fitter.evidence.loose_outline import FARTHEST_M
from fitter.evidence.silhouette_evidence import SilhouetteEvidence
from fitter.render.contours import ModelEdges
from fitter.render.rasterizer import Rendering

Values = Float[np.ndarray, " k"]
Fullness = Float[np.ndarray, "k 2"]
"""Usual standoff of clothes on the upper body and on the legs, as shares of the mean ease."""

_OFFSET_STEPS: Final = 10
"""Reweighted least squares in one unknown: the last step is less than a hundredth of a pixel."""


def bound_share(residuals: Values, cloth: Values) -> Values:
    """1 - c + c [r > 0]: how much of the tight outline's cost remains."""
    return np.where(residuals > 0.0, 1.0, 1.0 - cloth)


def ease_loss(residuals: Values, scales: EnergyScales) -> Values:
    """ρ_κ(r + μ) / (τ² Λ), nats per pixel of outline that shows cloth."""
    loss = boundary_loss(residuals + scales.ease_mean, scales.ease_reach)
    return loss / (scales.ease_spread**2 * scales.ease_correlation_length)


def ease_weights(residuals: Values, scales: EnergyScales) -> Values:
    """Weights w such that w (r + μ) is the derivative of :func:`ease_loss`."""
    weights = boundary_weights(residuals + scales.ease_mean, scales.ease_reach)
    return weights / (scales.ease_spread**2 * scales.ease_correlation_length)


def beyond_usual(residuals: Values, fullness: Fullness, scales: EnergyScales) -> Values:
    """Residuals as they would be if the mean ease were the same everywhere: r + μ - its scale."""
    return residuals + scales.ease_mean * (fullness.sum(axis=1) - 1.0)


_WIDER_BY: Final = 0.2
"""Power of a top's usual ease with which its common offset grows beyond it: outlines of real
jackets differ by 3.4 cm a side, while they stand 7 cm off."""


def offset_slopes(fullness: Fullness) -> Fullness:
    """Slopes g of the common offsets, of clothes whose usual standoff is f."""
    top, bottom = fullness.T
    return np.stack([np.minimum(top, top**_WIDER_BY), bottom], axis=1)


def common_offset(
    residuals: Values, fullness: Fullness, lengths: Values, scales: EnergyScales
) -> Float[np.ndarray, "2"]:
    """The most probable δ, pixels; ``lengths`` are the pixels of outline under cloth."""
    slopes = offset_slopes(fullness)
    offset = np.zeros(slopes.shape[1])
    known = np.eye(len(offset)) / scales.ease_common_spread**2
    for _ in range(_OFFSET_STEPS):
        weights = lengths * ease_weights(residuals + slopes @ offset, scales)
        weighted = slopes * weights[:, None]
        slope = weighted.T @ (residuals + scales.ease_mean)
        offset = -np.linalg.solve(weighted.T @ slopes + known, slope)
    return offset


def common_ease(
    fullness: Fullness, scales: EnergyScales, *, held_in_search: bool = False
) -> Nuisance:
    """δ as the unknowns that all rows r + μ + g · δ share."""
    return Nuisance(
        name="ease",
        slopes=offset_slopes(fullness),
        known=np.eye(fullness.shape[1]) / scales.ease_common_spread,
        held_in_search=held_in_search,
    )


# A boundary point of the image matches a contour point that faces the same way within 60 degrees.
_LEAST_NORMAL_AGREEMENT = 0.5
# Half of the rows go from the model to the image, half from the image to the model.
_SHARE = 0.5
# Cost of a pixel far from everything, in robust scales: without it a body that has left the person
# altogether would cost nothing. It is constant, so it does not pull.
_FAR_COST = 0.1
# Distance, in robust scales, beyond which d / (1 + d²/η²)² is less than that.
_FAR = 1.81
_MARGIN_PX = 2


def silhouette_energy(
    rendering: Rendering, evidence: SilhouetteEvidence, scales: EnergyScales
) -> float:
    """E_Si in nats; pixels outside the picture do not count."""
    top, bottom, left, right = _common_box(rendering, evidence)
    pixels = Pixels(
        model=rendering.face_ids[top:bottom, left:right],
        image=evidence.mask[top:bottom, left:right],
        to_image=evidence.signed_distance[top:bottom, left:right],
        confidence=evidence.confidence[top:bottom, left:right],
    )
    eta = scales.silhouette_eta
    cost = RobustCost(scale=eta, floor=_FAR_COST * eta, reach=_FAR * eta)
    nats = 1.0 / (scales.silhouette_sigma**2 * scales.correlation_length)
    if evidence.cloth is None or evidence.fullness is None:
        return nats * float(robust_mismatch(pixels, cost))
    clothes = Clothes(
        cloth=evidence.cloth[top:bottom, left:right],
        fullness=evidence.fullness[top:bottom, left:right],
    )
    ease_cost = EaseCost(
        mean=scales.ease_mean,
        reach=scales.ease_reach,
        of_skin=nats,
        of_ease=1.0 / (scales.ease_spread**2 * scales.ease_correlation_length),
    )
    return float(clothed_mismatch(pixels, clothes, cost, ease_cost))


def silhouette_rows(
    rendering: Rendering,
    edges: ModelEdges,
    evidence: SilhouetteEvidence,
    scales: EnergyScales,
) -> tuple[PositionRows, ...]:
    """Rows from the model's outline to the image, and from the image's outline to the model.

    The second kind sees what the first cannot: observed limbs far from any part of the outline.
    Under loose clothes, each kind is followed by its rows for the ease.
    """
    camera = rendering.camera
    middles = edges.endpoints.mean(axis=1)
    outer = (
        edges.visible
        & edges.is_outer_silhouette
        & (middles > 1.0).all(axis=1)
        & (middles[:, 0] < camera.width - 1)
        & (middles[:, 1] < camera.height - 1)
    )
    pairs = edges.edges[outer]
    middles = middles[outer]
    normals = edges.outward[outer]
    lengths = np.linalg.norm(edges.endpoints[outer, 1] - edges.endpoints[outer, 0], axis=1)
    points = rendering.vertices[pairs]  # (k, 2, 3)
    distances = evidence.distance_at(middles)
    forward = _rows(
        distances,
        evidence.confidence_at(middles) * lengths,
        evidence.cloth_at(middles),
        evidence.fullness_at(middles),
        scales,
        points=pairs,
        derivatives=0.5 * camera.pull_back(points, np.repeat(normals[:, None], 2, axis=1)),
    )
    if not len(middles):
        return forward
    nearest = _nearest_facing_alike(middles, normals, evidence, scales)
    matched = nearest >= 0
    nearest = nearest[matched]
    observed, facing = evidence.boundary_points[matched], evidence.boundary_normals[matched]
    residuals = np.einsum("ki,ki->k", middles[nearest] - observed, facing)
    backward = _rows(
        residuals,
        evidence.confidence_at(observed) * evidence.boundary_spacing,
        evidence.cloth_at(observed),
        evidence.fullness_at(observed),
        scales,
        points=pairs[nearest],
        derivatives=0.5 * camera.pull_back(points[nearest], np.repeat(facing[:, None], 2, axis=1)),
    )
    return (*forward, *backward)


def _rows(
    residuals: Float[np.ndarray, " k"],
    lengths: Float[np.ndarray, " k"],
    cloth: Float[np.ndarray, " k"],
    fullness: Fullness,
    scales: EnergyScales,
    *,
    points: Integer[np.ndarray, "k 2"],
    derivatives: Float[np.ndarray, "k 2 3"],
) -> tuple[PositionRows, ...]:
    """Rows of one kind, each for a length of outline in pixels, and rows for the ease of cloth."""
    nats = _SHARE / (scales.silhouette_sigma**2 * scales.correlation_length)
    bound = PositionRows(
        residuals=residuals,
        weights=nats
        * lengths
        * bound_share(residuals, cloth)
        * boundary_weights(residuals, scales.silhouette_eta),
        points=points,
        derivatives=derivatives,
    )
    if not cloth.any():
        return (bound,)
    usual = beyond_usual(residuals, fullness, scales)
    ease = PositionRows(
        residuals=usual + scales.ease_mean,
        weights=_SHARE * lengths * cloth * ease_weights(usual, scales),
        points=points,
        derivatives=derivatives,
        nuisance=common_ease(fullness, scales, held_in_search=True),
    )
    return bound, ease


def silhouette_overlap(
    rendering: Rendering, evidence: SilhouetteEvidence, scales: EnergyScales
) -> float:
    """Intersection over union of the model's region and the observed one.

    What loose clothes add to the body, as far as they may reach, counts toward neither.
    """
    model = rendering.silhouette
    union = float(np.count_nonzero(model | evidence.mask))
    if evidence.cloth is not None:
        reach = FARTHEST_M * scales.pixels_per_metre
        around = cv2.distanceTransform((~model).astype(np.uint8), cv2.DIST_L2, 3) <= reach
        union -= float(evidence.cloth[evidence.mask & ~model & around].sum())
    return float(np.count_nonzero(model & evidence.mask) / union if union else 0.0)


def _nearest_facing_alike(
    middles: np.ndarray, normals: np.ndarray, evidence: SilhouetteEvidence, scales: EnergyScales
) -> np.ndarray:
    """Index of the nearest contour point facing alike for each observed boundary point, else -1.

    Position and normal together form the key: a normal turned by 60 degrees counts like twice the
    robust scale, so the far side of a thin limb is never the nearest.
    """
    scale = 2.0 * scales.silhouette_eta
    keys = np.hstack([middles, scale * normals])
    order = np.argsort(middles[:, 0])
    nearest = nearest_within(
        keys[order],
        np.hstack([evidence.boundary_points, scale * evidence.boundary_normals]),
        1.5 * scale,
    )
    index = np.where(nearest >= 0, order[nearest], -1)
    agreement = np.einsum("ki,ki->k", normals[index], evidence.boundary_normals)
    return np.where((index >= 0) & (agreement > _LEAST_NORMAL_AGREEMENT), index, -1)


def _common_box(rendering: Rendering, evidence: SilhouetteEvidence) -> tuple[int, int, int, int]:
    """Rows and columns that hold both regions, with a margin."""
    left, right, top, bottom = bounding_box(rendering.projected)
    height, width = evidence.mask.shape
    return (
        *_span(top, bottom, evidence.occupied_rows, height),
        *_span(left, right, evidence.occupied_columns, width),
    )


def _span(
    first: float, last: float, occupied: Bool[np.ndarray, " k"], size: int
) -> tuple[int, int]:
    """Range that a body's projection and the occupied lines cover in a picture, with a margin."""
    lines = np.flatnonzero(occupied)
    if len(lines):
        first, last = min(first, float(lines[0])), max(last, float(lines[-1]) + 1.0)
    start = min(max(int(np.floor(first)) - _MARGIN_PX, 0), size - 1)
    return start, max(min(int(np.ceil(last)) + _MARGIN_PX, size), start + 1)

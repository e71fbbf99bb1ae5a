"""Silhouette energy E_Si: pixelwise distances between the model's region and the observed one.

Every unmatched pixel costs a function of its distance d to the other region (as in [5] and [22]),
here ρ'(d) = d / (1 + d²/η²)². A sliver of width δ along the outline then costs ∫ ρ' = ρ(δ) =
½ δ² / (1 + δ²/η²) for each pixel of outline: the sum is a Geman-McClure boundary error, and contour
points with its weights are its exact linearisation. Wrong ground, walls and hair lie far from the
body, and pull at nothing there. Divided by σ² and by the length over which neighbouring errors
repeat themselves it is a negative log-likelihood.
"""

import numpy as np
from jaxtyping import Bool

from fitter.energies._silhouette_kernels import (
    bounding_box,
    nearest_within,
    robust_mismatch,
)
from fitter.energies.rows import PositionRows
from fitter.energies.scales import EnergyScales
from fitter.evidence.silhouette_evidence import SilhouetteEvidence
from fitter.numerics.robust import boundary_weights
from fitter.render.contours import ModelEdges
from fitter.render.rasterizer import Rendering

# A boundary point of the image matches a contour point that faces the same way within 60 degrees.
_LEAST_NORMAL_AGREEMENT = 0.5
# Half of the rows look from the model to the image, half from the image to the model.
_SHARE = 0.5
# What a pixel far from everything costs, in robust scales: without it a body that has left the
# person altogether would cost nothing. Constant, so it pulls at nothing.
_FAR_COST = 0.1
# From where on, in robust scales, d / (1 + d²/η²)² is less than that.
_FAR = 1.81
_MARGIN_PX = 2


def silhouette_energy(
    rendering: Rendering, evidence: SilhouetteEvidence, scales: EnergyScales
) -> float:
    """E_Si in nats; pixels outside the picture count for nothing."""
    top, bottom, left, right = _common_box(rendering, evidence)
    total = robust_mismatch(
        rendering.face_ids[top:bottom, left:right],
        evidence.mask[top:bottom, left:right],
        evidence.signed_distance[top:bottom, left:right],
        evidence.confidence[top:bottom, left:right],
        scales.silhouette_eta,
        _FAR_COST * scales.silhouette_eta,
        _FAR * scales.silhouette_eta,
    )
    return float(total) / (scales.silhouette_sigma**2 * scales.correlation_length)


def silhouette_rows(
    rendering: Rendering,
    edges: ModelEdges,
    evidence: SilhouetteEvidence,
    scales: EnergyScales,
) -> tuple[PositionRows, PositionRows]:
    """Rows from the model's outline to the image, and from the image's outline to the model.

    The second kind sees what the first cannot: observed limbs that no part of the outline is near.
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
    nats = _SHARE / (scales.silhouette_sigma**2 * scales.correlation_length)

    distances = evidence.distance_at(middles)
    forward = PositionRows(
        residuals=distances,
        weights=nats
        * evidence.confidence_at(middles)
        * lengths
        * boundary_weights(distances, scales.silhouette_eta),
        points=pairs,
        derivatives=0.5 * camera.pull_back(points, np.repeat(normals[:, None], 2, axis=1)),
    )
    if not len(middles):
        return forward, forward
    nearest = _nearest_facing_alike(middles, normals, evidence, scales)
    matched = nearest >= 0
    nearest = nearest[matched]
    observed, facing = evidence.boundary_points[matched], evidence.boundary_normals[matched]
    residuals = np.einsum("ki,ki->k", middles[nearest] - observed, facing)
    backward = PositionRows(
        residuals=residuals,
        weights=nats
        * evidence.confidence_at(observed)
        * evidence.boundary_spacing
        * boundary_weights(residuals, scales.silhouette_eta),
        points=pairs[nearest],
        derivatives=0.5 * camera.pull_back(points[nearest], np.repeat(facing[:, None], 2, axis=1)),
    )
    return forward, backward


def silhouette_overlap(rendering: Rendering, evidence: SilhouetteEvidence) -> float:
    """Intersection over union of the model's region and the observed one."""
    model = rendering.silhouette
    union = np.count_nonzero(model | evidence.mask)
    return np.count_nonzero(model & evidence.mask) / union if union else 0.0


def _nearest_facing_alike(
    middles: np.ndarray, normals: np.ndarray, evidence: SilhouetteEvidence, scales: EnergyScales
) -> np.ndarray:
    """Contour index for each observed boundary point, -1 where none is near and faces alike.

    Position and normal together are the key: a normal turned by 60 degrees counts like twice the
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
    """Where a body's projection and the occupied lines lie within a picture, with a margin."""
    lines = np.flatnonzero(occupied)
    if len(lines):
        first, last = min(first, float(lines[0])), max(last, float(lines[-1]) + 1.0)
    start = min(max(int(np.floor(first)) - _MARGIN_PX, 0), size - 1)
    return start, max(min(int(np.ceil(last)) + _MARGIN_PX, size), start + 1)

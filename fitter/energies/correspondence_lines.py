"""Silhouette energy E_Si by correspondence lines: ends of the person on lines across the contour.

GrabCut has one mixture of colours per side for the whole picture, and its cut follows joints and
boards of a wall that resemble the skin. Near a body that is almost right the task is easier: on a
line across its contour the person's colours lie on one side and the background's on the other, and
both can be learnt locally from the lines around. Each line then gives a position and a variance of
the boundary; the variance is large where the two sides look alike.

The lines are those of region-based tracking (Stoiber et al., SRT3D, IJCV 2022; RAPiD, Harris and
Stennett 1990); the likelihood is that of Hanek and Beetz' contracting curve density (IJCV 2004): a
pixel on the boundary shows a mixture of both sides.

A line follows the two vertices whose midpoint lay on the contour when the line was placed. To first
order the contour moves along its normal as these do, so that the residual

    r = n · (x - c) - o

of the vertices' current midpoint x, the line's centre c, its normal n and the offset o found on it
is the contour's distance from the boundary, and its derivative is exact. Lines are placed anew as
the body moves (:mod:`fitter.optimizer.search`). Where the boundary is that of loose clothes, it
bounds the body from outside (:mod:`fitter.energies.silhouette`).
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Integer
from scipy.special import ndtr

from fitter.arrays import GreyImage, Image, Points2D
from fitter.energies import _line_kernels as kernels
from fitter.energies.rows import PositionRows, boundary_loss, boundary_weights
from fitter.energies.scales import EnergyScales
from fitter.energies.silhouette import (
    beyond_usual,
    bound_share,
    common_ease,
    common_offset,
    ease_loss,
    ease_weights,
    offset_slopes,
)
from fitter.evidence.loose_outline import LooseOutline
from fitter.observation.maps import sample
from fitter.render.contours import ModelEdges
from fitter.render.rasterizer import Rendering

WINDOW_M, LEAST_WINDOW_PX = 0.025, 4
"""Distance to either side of the body's contour within which the boundary is searched for."""

DEPTH_M, LEAST_DEPTH_PX = 0.02, 4
"""Distance from the boundary within which colours are learnt and compared: skin darkens toward its
rim, so nearer is better. On the evaluation's tuning half 3.9 % of the lines are off by more than
3 px; with 3 cm 4.8 %, with 5 cm 5.5 %."""

NEIGHBOURHOOD_M = 0.04
"""Standard deviation of the weights with which a line learns its colours from its neighbours."""

SPACING_PX, MOST_LINES = 2.0, 800
"""One line per this many pixels of contour, and at most this many lines."""

FIRST_GUARD_PX, GUARD_PX = 2.0, 1.0
"""No side is learnt from pixels nearer to the boundary than this: around the body's own contour,
and around a boundary that was found."""

BLUR_PX = 0.6
"""Standard deviation of the blur by lens, pixel and compression together."""

LEAST_DEVIATION = 0.012
"""Standard deviation of a colour: three steps of 8-bit display values, noise and compression."""

INDEPENDENCE = 0.2
"""Pixels of a line are not independent: five count as one. On the tuning half, half of the lines
are then off by less than 0.64 of their own standard deviation, where 0.67 would be right."""

PASSES = 2
"""The colours are learnt on either side of the body's contour, then of the boundary found."""

LEAST_SAMPLES = 3
"""Samples needed on either side. With fewer, the gap is too narrow or the limb too thin to tell."""


Neighbours = tuple[np.ndarray, np.ndarray, np.ndarray]
"""Return value of :func:`fitter.energies._line_kernels.neighbours`."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class CorrespondenceLines:
    """Lines across the outer contour of one body, and the boundary each has found.

    Attributes
    ----------
    points
        (k, 2) vertex ids; a line belongs to the midpoint of their projections.
    centres, normals
        (k, 2) where that was, continuous pixels, and the contour's outward unit normals.
    offsets, variances
        (k,) how far outside the centres the boundary lies, pixels, and the variance.
    confidence
        (k,) how much a line counts: what is seen may not be the body's outline.
    cloth
        (k,) probability that the boundary is that of loose clothes; 0 where clothes are tight.
    fullness
        (k, 2) how far clothes of upper body and legs usually stand off, of the mean ease.
    spacing
        Pixels of contour each line stands for.
    """

    points: Integer[np.ndarray, "k 2"]
    centres: Points2D
    normals: Points2D
    offsets: Float[np.ndarray, " k"]
    variances: Float[np.ndarray, " k"]
    confidence: Float[np.ndarray, " k"]
    cloth: Float[np.ndarray, " k"]
    fullness: Float[np.ndarray, "k 2"]
    spacing: float


def correspondence_lines(
    rendering: Rendering,
    edges: ModelEdges,
    display: Image,
    confidence: GreyImage,
    clothes: LooseOutline | None = None,
) -> CorrespondenceLines:
    """Search for the person's boundary along the contour of a body.

    Parameters
    ----------
    rendering, edges
        A body near the person: within :data:`WINDOW_M` of it.
    display
        (h, w, 3) display values in [0, 1].
    confidence
        (h, w) how much an outline counts.
    clothes
        For a person in loose clothes: the boundary is searched for around their outline, which may
        lie far outside the body's contour.
    """
    pixels_per_metre = rendering.camera.focal_length_px / float(rendering.vertices[:, 2].mean())
    window = max(round(WINDOW_M * pixels_per_metre), LEAST_WINDOW_PX)
    depth = max(round(DEPTH_M * pixels_per_metre), LEAST_DEPTH_PX)
    chosen, spacing = _spread_along(edges, _on_the_outline(edges, rendering))
    centres, normals = edges.endpoints[chosen].mean(axis=1), edges.outward[chosen]
    reach = window + depth
    region, ease = rendering.silhouette, np.zeros(len(chosen))
    if clothes is not None:
        region, ease = clothes.mask, clothes.beyond(rendering, centres, normals)
        met = np.isfinite(ease)
        chosen, ease, centres, normals = chosen[met], ease[met], centres[met], normals[met]
    outline = np.ascontiguousarray(centres + ease[:, None] * normals)
    first, last = np.empty((2, len(chosen)), dtype=np.int64)
    kernels.usable_samples(region, outline, normals, reach, first, last)
    told = (reach - first >= LEAST_SAMPLES) & (last - reach >= LEAST_SAMPLES)
    chosen, first, last, ease = chosen[told], first[told], last[told], ease[told]
    centres, outline = np.ascontiguousarray(centres[told]), np.ascontiguousarray(outline[told])
    normals = np.ascontiguousarray(normals[told])
    samples = np.zeros((len(chosen), 2 * reach + 1, 3))
    picture = np.ascontiguousarray(display, dtype=np.float32)
    kernels.sample_lines(picture, outline, normals, first, last, samples)
    offsets, variances = _boundaries(
        samples,
        (first, last),
        kernels.neighbours(outline, normals, NEIGHBOURHOOD_M * pixels_per_metre),
        window=window,
        depth=depth,
    )
    found = outline + offsets[:, None] * normals
    return CorrespondenceLines(
        points=edges.edges[chosen],
        centres=centres,
        normals=normals,
        offsets=ease + offsets,
        variances=variances,
        confidence=sample(confidence, centres)[0],
        cloth=np.zeros(len(chosen))
        if clothes is None
        else clothes.cloth_within(found, normals, pixels_per_metre),
        fullness=np.zeros((len(chosen), 2))
        if clothes is None
        else clothes.fullness_within(found, normals, pixels_per_metre),
        spacing=spacing,
    )


def _on_the_outline(edges: ModelEdges, rendering: Rendering) -> Bool[np.ndarray, " e"]:
    """Edges that border the background within the picture."""
    middles = edges.endpoints.mean(axis=1)
    size = [rendering.camera.width - 1.0, rendering.camera.height - 1.0]
    return (
        edges.visible & edges.is_outer_silhouette & ((middles > 1.0) & (middles < size)).all(axis=1)
    )


def _spread_along(
    edges: ModelEdges, usable: Bool[np.ndarray, " e"]
) -> tuple[Integer[np.ndarray, " k"], float]:
    """Edges at even steps along the contour, chosen in proportion to length; and the step."""
    ids = np.flatnonzero(usable)
    lengths = np.linalg.norm(edges.endpoints[ids, 1] - edges.endpoints[ids, 0], axis=1)
    ends = np.cumsum(lengths)
    total = float(ends[-1]) if len(ends) else 0.0
    spacing = max(SPACING_PX, total / MOST_LINES)
    picked = ids[np.unique(np.searchsorted(ends, np.arange(0.5 * spacing, total, spacing)))]
    return picked, total / max(len(picked), 1)


def _boundaries(
    samples: Float[np.ndarray, "k s 3"],
    usable: tuple[Integer[np.ndarray, " k"], Integer[np.ndarray, " k"]],
    neighbours: Neighbours,
    *,
    window: int,
    depth: int,
) -> tuple[Float[np.ndarray, " k"], Float[np.ndarray, " k"]]:
    """Mean and variance of each line's boundary.

    Where a line ends early, another limb begins or the limb is thin: the boundary is then sought
    in the near half of what is left.
    """
    first, last = usable
    reach = window + depth
    lowest = np.where(first > 0, -np.minimum(window, 0.5 * (reach - first)), -window)
    highest = np.where(last < 2 * reach, np.minimum(window, 0.5 * (last - reach)), window)
    steps = np.linspace(-kernels.BLUR, kernels.BLUR, 2 * kernels.BLUR * kernels.PLACES + 1)
    coverage = ndtr(steps / BLUR_PX)
    coverage[0], coverage[-1] = 0.0, 1.0
    inside, outside = np.empty((2, len(samples), 10))
    offsets, variances = np.zeros(len(samples)), np.empty(len(samples))
    for turn in range(PASSES):
        guard = GUARD_PX if turn else FIRST_GUARD_PX
        kernels.side_sums(samples, first, last, offsets, guard, depth, inside, outside)
        kernels.boundary_posteriors(
            samples,
            first,
            last,
            lowest,
            highest,
            _means_and_covariances(kernels.gathered(*neighbours, inside)),
            _means_and_covariances(kernels.gathered(*neighbours, outside)),
            coverage,
            INDEPENDENCE,
            offsets,
            variances,
        )
    # Candidate places are discrete: even a single one is uncertain within its step.
    return offsets, variances + 1.0 / (12.0 * kernels.PLACES**2)


def _means_and_covariances(sums: Float[np.ndarray, "k 10"]) -> Float[np.ndarray, "k 9"]:
    moments = sums[:, 1:] / np.maximum(sums[:, :1], np.finfo(np.float64).tiny)
    first, second = np.triu_indices(3)
    covariances = moments[:, 3:] - moments[:, first] * moments[:, second]
    covariances[:, first == second] += LEAST_DEVIATION**2
    return np.hstack([moments[:, :3], covariances])


def line_energy(rendering: Rendering, lines: CorrespondenceLines, scales: EnergyScales) -> float:
    """E_Si in nats: Σ ρ(r) over the lines, each weighted by its own variance."""
    residuals = _residuals(rendering, lines)
    share = bound_share(residuals, lines.cloth)
    loss = share * boundary_loss(residuals, scales.silhouette_eta)
    return float(_precisions(lines, scales) @ loss) + _ease_energy(residuals, lines, scales)


def line_rows(
    rendering: Rendering, lines: CorrespondenceLines, scales: EnergyScales
) -> tuple[PositionRows, ...]:
    """One row per line, and another for the ease where the line shows clothes."""
    residuals = _residuals(rendering, lines)
    normals = np.repeat(lines.normals[:, None], 2, axis=1)
    ends = rendering.vertices[lines.points]
    derivatives = 0.5 * rendering.camera.pull_back(ends, normals)
    weights = _precisions(lines, scales) * boundary_weights(residuals, scales.silhouette_eta)
    bound = PositionRows(
        residuals=residuals,
        weights=bound_share(residuals, lines.cloth) * weights,
        points=lines.points,
        derivatives=derivatives,
    )
    if not lines.cloth.any():
        return (bound,)
    lengths, fullness = _cloth_lengths(lines), lines.fullness
    usual = beyond_usual(residuals, fullness, scales)
    off = usual + offset_slopes(fullness) @ common_offset(usual, fullness, lengths, scales)
    ease = PositionRows(
        residuals=off + scales.ease_mean,
        weights=lengths * ease_weights(off, scales),
        points=lines.points,
        derivatives=derivatives,
        nuisance=common_ease(fullness, scales),
    )
    return bound, ease


def _ease_energy(
    residuals: Float[np.ndarray, " k"], lines: CorrespondenceLines, scales: EnergyScales
) -> float:
    if not lines.cloth.any():
        return 0.0
    lengths, fullness = _cloth_lengths(lines), lines.fullness
    usual = beyond_usual(residuals, fullness, scales)
    offset = common_offset(usual, fullness, lengths, scales)
    prior = 0.5 * float(offset @ offset) / scales.ease_common_spread**2
    return float(lengths @ ease_loss(usual + offset_slopes(fullness) @ offset, scales)) + prior


def _residuals(rendering: Rendering, lines: CorrespondenceLines) -> Float[np.ndarray, " k"]:
    moved = rendering.projected[lines.points].mean(axis=1) - lines.centres
    return np.einsum("ki,ki->k", moved, lines.normals) - lines.offsets


def _cloth_lengths(lines: CorrespondenceLines) -> Float[np.ndarray, " k"]:
    """Pixels of contour that each line takes to be under cloth."""
    return lines.confidence * lines.spacing * lines.cloth


def _precisions(lines: CorrespondenceLines, scales: EnergyScales) -> Float[np.ndarray, " k"]:
    """Weights of the lines' squared residuals: errors of neighbours on the contour correlate."""
    variances = scales.contour_sigma**2 + lines.variances
    return lines.confidence * lines.spacing / (variances * scales.line_correlation_length)

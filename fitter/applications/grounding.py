"""Feet on the ground: a moving body placed so that it neither floats, sinks nor slides.

Another skeleton's root is right only about: proportions differ, and scaling by leg length leaves
centimetres. Two rules mend it. *Height*: the lowest vertex of every frame is at y = 0, or at the
lift of the source where that has left the ground. *Place*: between two frames the root moves so
that what touches the ground of the soles stands still, as in rolling without slip; only where
nothing touches it, it moves as the source's.
"""

from dataclasses import replace

import numpy as np
from jaxtyping import Float, Integer

from fitter.applications.motion import MovingBody
from fitter.body.model import BodyModel

CONTACT_HEIGHT_M = 0.004
"""Height above the ground at which a vertex of the sole counts 1/e of one that touches it: the
flesh that a foot presses flat, which the rigid sole of the model does not have."""

SOLE_HEIGHT_M = 0.03
"""Vertices of the feet this near to the lowest at rest are the soles."""

SOURCE_WEIGHT = 0.02
"""Of the source's own motion, beside vertices of weight up to one each."""


def grounded(body: MovingBody, model: BodyModel) -> MovingBody:
    """The same bodies with their roots moved."""
    lowest = [
        (shape @ turn[1]).min() for shape, turn in zip(body.shapes, body.rotations, strict=True)
    ]
    roots = body.roots.copy()
    roots[:, 1] = body.motion.lifts_m - lowest
    soles = _soles(body, model)
    weights = _touching(soles[:, :, 1] + roots[:, None, 1])
    back = -np.diff(soles[:, :, [0, 2]], axis=0)
    steps = np.einsum("tc,tci->ti", weights, back)
    steps += SOURCE_WEIGHT * np.diff(roots[:, [0, 2]], axis=0)
    steps /= (weights.sum(axis=1) + SOURCE_WEIGHT)[:, None]
    roots[1:, [0, 2]] = roots[0, [0, 2]] + np.cumsum(steps, axis=0)
    return replace(body, roots=roots)


def sliding_m(body: MovingBody, model: BodyModel) -> float:
    """How far what touches the ground of the soles slides from frame to frame, mean, metres."""
    soles = _soles(body, model) + body.roots[:, None]
    weights = _touching(soles[:, :, 1])
    moved = np.linalg.norm(np.diff(soles[:, :, [0, 2]], axis=0), axis=2)
    return float((weights * moved).sum() / max(weights.sum(), 1e-12))


def _soles(body: MovingBody, model: BodyModel) -> Float[np.ndarray, "t c 3"]:
    """Vertices of the soles with the root at the origin, body frame's axes."""
    shapes = body.shapes[:, sole_vertices(model)].astype(np.float64)
    return np.einsum("tij,tcj->tci", body.rotations, shapes)


def sole_vertices(model: BodyModel) -> Integer[np.ndarray, " c"]:
    """The lowest vertices of both feet at rest."""
    feet = [model.part_names.index(f"{side}_foot") for side in ("left", "right")]
    vertices = np.unique(model.triangles[np.isin(model.part_of_triangle, feet)])
    heights = model.mean_vertices[vertices, 1]
    return vertices[heights < heights.min() + SOLE_HEIGHT_M]


def _touching(heights: Float[np.ndarray, "t c"]) -> Float[np.ndarray, "t1 c"]:
    """How much each vertex touches the ground from a frame to the next, in [0, 1]."""
    weights = np.exp(-np.maximum(heights, 0.0) / CONTACT_HEIGHT_M)
    return np.minimum(weights[1:], weights[:-1])

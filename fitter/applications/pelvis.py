"""Colours about the pelvis that no picture shows, from those before or behind it.

The hems of what is worn there rise from between the legs to the hips: they are no rings. What is
seen is told apart into two colours, say of cloth and skin; a hidden point has the one that is seen
straight before it, or behind it. Patterns differ left and right: they are left to rings.
"""

from functools import lru_cache

import numpy as np
from jaxtyping import Bool, Float

from fitter.applications.atlas import barycentric
from fitter.applications.hidden_colours import BORDER, SAME_CLOTH, cloth_colours
from fitter.applications.picture_look import BELIEVED, BothSides
from fitter.applications.picture_surface import (
    LEAST_SEEN,
    Beliefs,
    Colours,
    SurfacePoints,
    nearest_of_two,
    smooth_step,
)
from fitter.applications.rings import Region, RingCoordinates, landmark
from fitter.body.model import BodyModel
from fitter.render.camera import Camera
from fitter.render.rasterizer import Rendering, render

BELOW_NAVEL_M, BELOW_CROTCH_M = (0.03, 0.08), (0.1, 0.16)
"""Over which these colours begin, and end: a bare back has no navel, and cloth goes round legs."""

ALIKE_SHARE = 0.85
"""Share of what is seen on both sides whose colour is the same there, as of hems and flies."""

GUSSET_PX, RAISED_PX = (20.0, 35.0), 40.0
"""Half the width of what is worn between the legs, and where above the crotch it is seen; mm."""

_CARRIED = (0.2, 0.6)
# Beliefs from which, and with which wholly, a colour is carried through the body.
_DISTANCE_M, _METRE_PX = 100.0, 1000.0
# A view from so far away is parallel within the body's depth.
_SIDE_PX = 600


def pelvis_colours(sides: BothSides, points: SurfacePoints) -> Float[np.ndarray, "2 3"] | None:
    """The two linear colours of points that are seen; None where it is one, or a pattern's."""
    points = points.some(points.near(pelvis_weights(sides.model) > BELIEVED))
    found, seen = sides.look(points)
    other, mirrored = sides.look(points.moved(sides.model.mirror))
    both = (seen >= BELIEVED) & (mirrored >= BELIEVED)
    if np.count_nonzero(both) < LEAST_SEEN:
        return None
    found, other = found[both], other[both]
    first = nearest_of_two(cloth_colours(found)) == 0
    two = np.stack([np.median(found[own], axis=0) for own in (first, ~first) if own.any()])
    if np.linalg.norm(np.ptp(cloth_colours(two), axis=0)) < SAME_CLOTH:
        return None
    second, mirror = (_towards_second(two, each) > 0.5 for each in (found, other))
    return two if np.mean(second == mirror) >= ALIKE_SHARE else None


def through_pelvis(
    sides: BothSides, two: Float[np.ndarray, "2 3"], points: SurfacePoints, colours: Colours
) -> Colours:
    """Colours of points; about the pelvis the two, nearest to their own where neither is seen."""
    weights = pelvis_weights(sides.model)
    own = points.near(weights > 0.0)
    there, through = points.some(own), colours.copy()
    second = _towards_second(two, colours[own])
    for sign in (-1.0, 1.0):
        opposite, exists = _straight_from(sides.model, there, sign)
        found, seen, mirrored = sides.at(opposite)
        share = np.where(exists, smooth_step(seen + mirrored, *_CARRIED), 0.0)
        second += share * (_towards_second(two, found) - second)
    share = smooth_step(second, *BORDER)[:, None]
    worn = (1.0 - share) * two[0] + share * two[1]
    through[own] += there.of(weights)[:, None] * (worn - through[own])
    return through


def _towards_second(two: Float[np.ndarray, "2 3"], colours: Colours) -> Beliefs:
    """How far each colour is on the way from the first to the second, as people see it."""
    (start, end), worn = cloth_colours(two), cloth_colours(colours)
    return np.clip((worn - start) @ (end - start) / np.sum((end - start) ** 2), 0.0, 1.0)


@lru_cache(maxsize=2)
def pelvis_weights(model: BodyModel) -> Float[np.ndarray, " m"]:
    """Weights of vertices in the pelvis, from below the navel to the tops of the legs: 0 to 1."""
    height = model.mean_vertices[:, 1]
    below, above = landmark(model, "navel")[1] - height, height - landmark(model, "crotch")[1]
    inside = smooth_step(below, *BELOW_NAVEL_M) * (1.0 - smooth_step(-above, *BELOW_CROTCH_M))
    return inside * RingCoordinates.of(model).shares[Region.TRUNK]


@lru_cache(maxsize=4)
def _straight_view(model: BodyModel, sign: float) -> Rendering:
    """The mean body's pelvis from straight before it, or from behind it."""
    x, y, z = model.mean_vertices.T
    vertices = np.stack(
        [sign * x, landmark(model, "crotch")[1] - y, _DISTANCE_M - sign * z], axis=1
    )
    middle = {"centre_x": 0.5 * _SIDE_PX, "centre_y": 0.5 * _SIDE_PX}
    size = {"width": _SIDE_PX, "height": _SIDE_PX}
    camera = Camera(focal_length_px=_METRE_PX * _DISTANCE_M, **middle, **size)
    return render(vertices, model.triangles, camera)


def _straight_from(
    model: BodyModel, points: SurfacePoints, sign: float
) -> tuple[SurfacePoints, Bool[np.ndarray, " k"]]:
    """The points seen straight before others at rest, or behind them, and whether there are any."""
    rendering = _straight_view(model, sign)
    pixels = rendering.camera.project(points.of(rendering.vertices))
    aside, above = np.abs(pixels[:, 0] - 0.5 * _SIDE_PX), 0.5 * _SIDE_PX - pixels[:, 1]
    low = smooth_step(above, -GUSSET_PX[1], -GUSSET_PX[0]) - smooth_step(above, 0.0, RAISED_PX)
    pixels[:, 1] -= RAISED_PX * low * (1.0 - smooth_step(aside, *GUSSET_PX))
    columns, rows = np.clip(pixels.astype(np.intp), 0, _SIDE_PX - 1).T
    triangles = rendering.face_ids[rows, columns]
    weights = barycentric(pixels, triangles, rendering.projected[model.triangles])
    return SurfacePoints(corners=model.triangles[triangles], weights=weights), triangles >= 0

"""Looks at a body in a picture: less what cannot be right of its parts, and of both its sides.

A face is believed as a whole or not at all: half of one, mirrored, is nobody's. What one side hides
its mirror image on the other may show, in other light: where both are seen their colours differ by
a factor, by which what is mirrored beside it is changed too; over some centimetres that is
forgotten.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from fitter.applications.picture_surface import (
    DARKEST,
    Beliefs,
    Colours,
    PictureSurface,
    SurfacePoints,
)
from fitter.applications.rings import RingCoordinates
from fitter.applications.surface_field import extend_values
from fitter.body.model import BodyModel
from fitter.numerics.rotations import unit_vectors

Look = Callable[[SurfacePoints], tuple[Colours, Beliefs]]
"""Linear colours of points, and how far each is believed."""

BELIEVED = 0.5
"""From this belief on a point counts as seen."""

MOST_TURNED_DEG = 55.0
"""A face turned farther from the camera shows less than half of itself, and that in profile."""

LEAST_OF_FACE = 0.35
"""Mean belief of the half of a face that is seen better, from which the face is believed."""


def at_vertices(model: BodyModel) -> SurfacePoints:
    """The vertices as points of the surface."""
    count = len(model.mean_vertices)
    return SurfacePoints(
        corners=np.repeat(np.arange(count)[:, None], 3, axis=1),
        weights=np.tile([1.0, 0.0, 0.0], (count, 1)),
    )


def face_to_leave_out(surface: PictureSurface, model: BodyModel) -> Float[np.ndarray, " m"]:
    """Weight of each vertex in a face that is not seen as one; 0 for all where it is."""
    features, x = RingCoordinates.of(model).features, model.mean_vertices[:, 0]
    belief = surface.belief(at_vertices(model))
    halves = [np.average(belief, weights=features * own) for own in (x >= 0.0, x <= 0.0)]
    rendering = surface.rendering
    ahead, to_face = unit_vectors(
        np.stack([features @ rendering.vertex_normals, features @ rendering.vertices])
    )
    turned = np.degrees(np.arccos(np.clip(-ahead @ to_face, -1.0, 1.0)))
    if max(halves) >= LEAST_OF_FACE and turned <= MOST_TURNED_DEG:
        return np.zeros_like(features)
    return features


FORGOTTEN_M = 0.1
"""Along the surface, over which the light at a border loses its influence by e."""

MOST_RATIO, MOST_TINT = 1.5, 0.35
"""Logarithms of the most that light differs by, and that its channels differ by in that: more is
another colour, which is not carried on."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class BothSides:
    """A look at both sides of a body.

    Attributes
    ----------
    ratios
        (m, 3) logarithms of what colours of the other side are multiplied by.
    """

    look: Look
    model: BodyModel
    ratios: Float[np.ndarray, "m 3"]

    @classmethod
    def of(cls, look: Look, model: BodyModel) -> "BothSides":
        """A look, with the difference between the sides where it shows both."""
        colours, seen = look(at_vertices(model))
        both = (seen >= BELIEVED) & (seen[model.mirror] >= BELIEVED)
        ratios = extend_light(model, both, colours, colours[model.mirror])
        return cls(look=look, model=model, ratios=ratios)

    def at(self, points: SurfacePoints) -> tuple[Colours, Beliefs, Beliefs]:
        """Colours of points, how far they are seen, and how far their mirror image is instead.

        The colour is the mean of both, each by its weight; the point itself comes first.
        """
        colours, seen = self.look(points)
        other, belief = self.look(points.moved(self.model.mirror))
        other = other * np.exp(points.of(self.ratios))
        mirrored = (1.0 - seen) * belief
        total = np.maximum(seen + mirrored, 1e-12)[:, None]
        return (seen[:, None] * colours + mirrored[:, None] * other) / total, seen, mirrored


def extend_light(
    model: BodyModel, known: Bool[np.ndarray, " m"], colours: Colours, others: Colours
) -> Float[np.ndarray, "m 3"]:
    """Logarithms of what makes other colours of vertices these, as far as light does.

    Where they are known, and from there toward 0 by e over :data:`FORGOTTEN_M`.
    """
    ratios = np.log(np.maximum(colours, DARKEST) / np.maximum(others, DARKEST))
    same = (np.abs(ratios).max(axis=1) < MOST_RATIO) & (np.ptp(ratios, axis=1) < MOST_TINT)
    lit = known & same
    if not lit.any():
        return np.zeros_like(ratios)
    return extend_values(model, lit, ratios, over_m=FORGOTTEN_M)

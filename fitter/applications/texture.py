"""Texture mapping (section 6): the picture, or the albedo found in it, laid on the body.

What the picture shows is taken from it. What it hides is taken from the other side of the body
where that is seen, and else from what is seen of the same ring round the body
(:mod:`fitter.applications.hidden_colours`); a coverage picture says which is which, so that nothing
invented passes for observed.
"""

from collections.abc import Callable
from dataclasses import dataclass
from enum import IntEnum

import numpy as np
from jaxtyping import Integer, UInt8

from fitter.applications.atlas import Atlas, atlas_of, drawn_on
from fitter.applications.hidden_colours import (
    LEAST_WEIGHT,
    ColourProfiles,
    following,
    on_rings,
)
from fitter.applications.lit_surface import LitSurface
from fitter.applications.rings import Region, RingCoordinates
from fitter.applications.seen_surface import Beliefs, Colours, SeenSurface, SurfacePoints
from fitter.arrays import Image, Mask
from fitter.body.model import BodyModel
from fitter.body.scape import ScapeEvaluator
from fitter.errors import InvalidInputError
from fitter.observation.colour import display_from_linear
from fitter.observation.resampling import linear_working_picture, working_size
from fitter.person.fitted_person import FittedPerson, require_model

SIZES = (512, 1024, 2048)
"""Sides an atlas may have, texels."""

BELIEVED = 0.5
"""From this belief on a texel counts as seen."""

PICTURE_PIXELS = 2_000_000
"""Of the picture that is laid on the body: then a pixel of a standing person is a millimetre, as a
texel of the largest atlas is."""

_CHUNK = 1 << 17

Look = Callable[[SurfacePoints], tuple[Colours, Beliefs]]
"""Linear colours of points, and how far each is believed."""


class TexelOrigin(IntEnum):
    """Where a texel's colour comes from: the levels of the coverage picture."""

    CONTINUED = 0
    MIRRORED = 128
    SEEN = 255


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Texture:
    """A texture of the body model's atlas.

    Attributes
    ----------
    levels
        (n, n, 3) sRGB.
    coverage
        (n, n) :class:`TexelOrigin`; 0 also off the body.
    scale
        Linear values are colours times this: albedo may exceed 1, a picture's levels may not.
    seen_share, mirrored_share
        Of the texels on the body.
    """

    levels: UInt8[np.ndarray, "n n 3"]
    coverage: UInt8[np.ndarray, "n n"]
    scale: float
    seen_share: float
    mirrored_share: float


def linear_picture(pixels: UInt8[np.ndarray, "_ _ 3"]) -> Image:
    """An upright decoded picture in linear light, made smaller if it is larger than needed."""
    height, width = pixels.shape[:2]
    size = working_size(width=width, height=height, pixels=PICTURE_PIXELS)
    return linear_working_picture(pixels, size)


def picture_texture(
    person: FittedPerson,
    evaluator: ScapeEvaluator,
    linear_rgb: Image,
    *,
    mask: Mask | None = None,
    size: int = 1024,
) -> Texture:
    """The picture on the body, with the light it was taken in.

    Parameters
    ----------
    person
        The fitted body and its camera.
    evaluator
        Of the model it was fitted with.
    linear_rgb
        (h, w, 3) the upright picture in linear light, at any scale: :func:`linear_picture`.
    mask
        (h, w) the person in it; without one the body's own outline must do.
    size
        Side of the atlas, one of :data:`SIZES`.

    Raises
    ------
    InvalidInputError
        For another size, or a model that is not the person's.
    """
    surface = _surface(person, evaluator, linear_rgb, mask)

    def look(points: SurfacePoints) -> tuple[Colours, Beliefs]:
        return surface.colours(points), surface.belief(points)

    return _texture(look, evaluator, size)


def albedo_texture(
    person: FittedPerson,
    evaluator: ScapeEvaluator,
    linear_rgb: Image,
    *,
    mask: Mask | None = None,
    size: int = 1024,
) -> Texture:
    """The same with the light divided out by Eq. 1, so that the body can be lit anew.

    Eq. 1 adds the same ambient light b to skin and to black cloth, so that subtracting it leaves
    cloth nothing. Here it is what surroundings of b / a' light let a surface of the typical albedo
    a' reflect: a = (r - s (h . n)^alpha l) / ((l . n) l + b / a'), the same for skin. The hue is
    the picture's: the light is taken as white. Shadows, cast and attached, count as hidden, but not
    where surroundings were fitted, which take the place of b / a' and say what shines there.

    Parameters
    ----------
    person, evaluator, linear_rgb, mask, size
        As of :func:`picture_texture`.

    Raises
    ------
    InvalidInputError
        As there, and where the fit found no light.
    """
    light, reflectance = person.light, person.reflectance
    if light is None or reflectance is None:
        raise InvalidInputError(
            code="no-light",
            field="kind",
            reason="The fit found no light, so that none can be divided out of the picture.",
            remedy="Fit with cues SES, or ask for the texture with the picture's own light.",
        )
    surface = _surface(person, evaluator, linear_rgb, mask)
    lit = LitSurface.of(surface, person, light, reflectance)

    def look(points: SurfacePoints) -> tuple[Colours, Beliefs]:
        return lit.albedo(points, surface.colours(points), surface.belief(points))

    return _texture(look, evaluator, size)


def _surface(
    person: FittedPerson, evaluator: ScapeEvaluator, linear_rgb: Image, mask: Mask | None
) -> SeenSurface:
    require_model(person, evaluator.model)
    height, width = linear_rgb.shape[:2]
    camera = person.camera.scaled(width / person.camera.width, width=width, height=height)
    vertices = evaluator.vertices(person.body)
    region = RingCoordinates.of(evaluator.model).region
    return SeenSurface.of(
        vertices,
        evaluator.model.triangles,
        camera,
        linear_rgb,
        mask,
        scalp=region == Region.SCALP,
        face=region == Region.FACE,
    )


def _texture(look: Look, evaluator: ScapeEvaluator, size: int) -> Texture:
    if size not in SIZES:
        raise InvalidInputError(
            code="texture-size",
            field="size",
            reason=f"A texture of {size} texels a side is not made.",
            remedy=f"Ask for one of {', '.join(map(str, SIZES))}.",
        )
    model = evaluator.model
    atlas = atlas_of(model, size)
    points = SurfacePoints(corners=model.triangles[atlas.triangles], weights=atlas.weights)
    found, seen, mirrored = _own_or_other_side(look, model.mirror, points)
    belief = seen + mirrored
    hidden = _hidden_colours(look, model, atlas, points, found, belief)
    colours = belief[:, None] * found + (1.0 - belief[:, None]) * hidden
    scale = max(1.0, float(np.percentile(colours, 99.5)))
    origin = _origin(seen, mirrored)
    levels = np.rint(255.0 * display_from_linear(np.clip(colours / scale, 0.0, 1.0)))
    return Texture(
        levels=drawn_on(atlas.inside, levels.astype(np.uint8)),
        coverage=_picture_of(atlas, origin),
        scale=scale,
        seen_share=float(np.mean(origin == TexelOrigin.SEEN)),
        mirrored_share=float(np.mean(origin == TexelOrigin.MIRRORED)),
    )


def _own_or_other_side(
    look: Look, mirror: Integer[np.ndarray, " m"], points: SurfacePoints
) -> tuple[Colours, Beliefs, Beliefs]:
    """Colours of points, how far they are seen, and how far their mirror image is instead.

    The colour is the mean of both, each by its weight; the point itself comes first.
    """
    parts = [
        _own_or_other_side_of_few(look, mirror, points.some(slice(first, first + _CHUNK)))
        for first in range(0, len(points.corners), _CHUNK)
    ]
    colours, seen, mirrored = (np.concatenate(part) for part in zip(*parts, strict=True))
    return colours, seen, mirrored


def _own_or_other_side_of_few(
    look: Look, mirror: Integer[np.ndarray, " m"], points: SurfacePoints
) -> tuple[Colours, Beliefs, Beliefs]:
    colours, seen = look(points)
    other, belief = look(SurfacePoints(corners=mirror[points.corners], weights=points.weights))
    mirrored = (1.0 - seen) * belief
    total = np.maximum(seen + mirrored, 1e-12)[:, None]
    return (seen[:, None] * colours + mirrored[:, None] * other) / total, seen, mirrored


def _hidden_colours(
    look: Look,
    model: BodyModel,
    atlas: Atlas,
    points: SurfacePoints,
    found: Colours,
    belief: Beliefs,
) -> Colours:
    """Colours for all texels, as far as they are hidden, from what is found of the others."""
    rings = RingCoordinates.of(model)
    region, along_m = rings.of_points(atlas.triangles, points)
    profiles = ColourProfiles.of(
        region,
        along_m,
        found,
        np.where(belief >= BELIEVED, belief, 0.0),
        least_weight=LEAST_WEIGHT * (atlas.size / 1024) ** 2,
    )
    vertices, at_vertices, believed = _at_vertices(look, model)
    known = believed >= BELIEVED
    if profiles.empty or not known.any():
        raise InvalidInputError(
            code="body-not-seen",
            field="fit_id",
            reason="The picture shows nothing of the fitted body clearly enough for a texture.",
            remedy="Look at the fit's overlay; mend the clicks and fit again.",
        )
    of_vertices = on_rings(rings, profiles, _a_triangle_of_each(model), vertices)
    carried_on = following(model, known, at_vertices - of_vertices)
    of_texels = on_rings(rings, profiles, atlas.triangles, points)
    return np.maximum(of_texels + points.of(carried_on), 0.0)


def _at_vertices(look: Look, model: BodyModel) -> tuple[SurfacePoints, Colours, Beliefs]:
    """The vertices as points of the surface, their colours, and how far these are believed."""
    count = len(model.mean_vertices)
    vertices = SurfacePoints(
        corners=np.repeat(np.arange(count)[:, None], 3, axis=1),
        weights=np.tile([1.0, 0.0, 0.0], (count, 1)),
    )
    colours, seen, mirrored = _own_or_other_side(look, model.mirror, vertices)
    return vertices, colours, seen + mirrored


def _a_triangle_of_each(model: BodyModel) -> Integer[np.ndarray, " m"]:
    """One of the triangles around each vertex."""
    triangle = np.empty(len(model.mean_vertices), dtype=np.intp)
    triangle[model.triangles] = np.arange(len(model.triangles))[:, None]
    return triangle


def _origin(seen: Beliefs, mirrored: Beliefs) -> UInt8[np.ndarray, " k"]:
    origin = np.full(len(seen), TexelOrigin.CONTINUED, dtype=np.uint8)
    origin[seen + mirrored >= BELIEVED] = TexelOrigin.MIRRORED
    origin[seen >= BELIEVED] = TexelOrigin.SEEN
    return origin


def _picture_of(atlas: Atlas, values: UInt8[np.ndarray, " t"]) -> UInt8[np.ndarray, "n n"]:
    picture = np.zeros((atlas.size, atlas.size), dtype=np.uint8)
    picture[atlas.inside] = values
    return picture

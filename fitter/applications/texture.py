"""Texture mapping (section 6): the picture, or the albedo found in it, laid on the body.

What the picture shows is taken from it. What it hides is taken from the other side of the body
where that is seen, and else what is worn beside it is carried on
(:mod:`fitter.applications.hidden_colours`); a coverage picture says which is which, so that nothing
invented passes for observed.
"""

from dataclasses import dataclass
from enum import IntEnum

import numpy as np
from jaxtyping import Float, UInt8

from fitter.applications.atlas import atlas_of, drawn_on
from fitter.applications.hidden_colours import Worn
from fitter.applications.picture_look import (
    BELIEVED,
    BothSides,
    Look,
    at_vertices,
    extend_light,
    face_to_leave_out,
)
from fitter.applications.picture_surface import (
    DARKEST,
    Beliefs,
    Colours,
    PictureSurface,
    SurfacePoints,
    smooth_step,
)
from fitter.applications.rings import Region, RingCoordinates
from fitter.arrays import Image, Mask
from fitter.body.model import BodyModel
from fitter.body.scape import ScapeEvaluator
from fitter.errors import InvalidInputError
from fitter.export.gltf_mesh import LIGHTEST
from fitter.numerics.rotations import unit_vectors
from fitter.observation.pixels import (
    bytes_of_display,
    display_from_linear,
    linear_working_picture,
    luminance_of,
    working_size,
)
from fitter.parameters import Light, Reflectance
from fitter.person.fitted_person import FittedPerson, require_model
from fitter.render.reflectance import shading_terms
from fitter.render.shadow import cast_shadow

PICTURE_PIXELS = 2_000_000
"""Pixels of the picture that is laid on the body: then one of a standing person is a millimetre, as
a texel of the largest atlas is."""


class TexelOrigin(IntEnum):
    """Origins of a texel's colour: the levels of the coverage picture."""

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
        Side of the atlas, texels.

    Raises
    ------
    InvalidInputError
        For a model that is not the person's, or where the picture shows nothing of the body.
    """
    surface = _surface(person, evaluator, linear_rgb, mask)
    return _texture(surface, surface.look, evaluator, size, lightest=1.0)


def picture_colours(
    person: FittedPerson, evaluator: ScapeEvaluator, display: Image, mask: Mask
) -> Colours:
    """The same of the m vertices alone, (m, 3) linear, which takes a quarter of a texture's time.

    Of a working picture (h, w, 3) and its mask (h, w): with fewer pixels somebody who fills little
    of it loses face and sleeves.
    """
    height, width = mask.shape
    size = working_size(width=width, height=height, pixels=width * height)
    linear_rgb = linear_working_picture(bytes_of_display(display), size)
    surface, model = _surface(person, evaluator, linear_rgb, mask), evaluator.model
    colours, _, _ = _laid(surface, surface.look, model, at_vertices(model))
    return np.clip(colours, 0.0, 1.0)


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
    cloth nothing. Here it is what light of b / a' from all round lets a surface of the typical
    albedo a' reflect: a = (r - s (h . n)^alpha l) / ((l . n) l + b / a'), the same for skin. The
    hue is the picture's: the light is taken as white. Shadows, cast and attached, count as hidden.

    Parameters
    ----------
    person, evaluator, linear_rgb, mask, size
        As of :func:`picture_texture`; the fit found light.
    """
    light, reflectance = person.light, person.reflectance
    assert light is not None
    assert reflectance is not None
    surface = _surface(person, evaluator, linear_rgb, mask)
    lit = LitSurface.of(surface, person, light, reflectance)

    def look(points: SurfacePoints) -> tuple[Colours, Beliefs]:
        return lit.albedo(points, surface.colours(points), surface.belief(points))

    return _texture(surface, look, evaluator, size, lightest=LIGHTEST)


def _surface(
    person: FittedPerson, evaluator: ScapeEvaluator, linear_rgb: Image, mask: Mask | None
) -> PictureSurface:
    require_model(person, evaluator.model)
    height, width = linear_rgb.shape[:2]
    camera = person.camera.scaled(width / person.camera.width, width=width, height=height)
    vertices = evaluator.vertices(person.body)
    region = RingCoordinates.of(evaluator.model).region
    return PictureSurface.of(
        vertices,
        evaluator.model.triangles,
        camera,
        linear_rgb,
        mask,
        scalp=region == Region.SCALP,
        face=region == Region.FACE,
    )


def _texture(
    surface: PictureSurface, look: Look, evaluator: ScapeEvaluator, size: int, *, lightest: float
) -> Texture:
    model = evaluator.model
    atlas = atlas_of(model, size)
    points = SurfacePoints(corners=model.triangles[atlas.triangles], weights=atlas.weights)
    colours, seen, mirrored = _laid(surface, look, model, points)
    scale = max(1.0, float(np.percentile(colours, 99.5)) / lightest)
    origin = np.full(len(seen), TexelOrigin.CONTINUED, dtype=np.uint8)
    origin[seen + mirrored >= BELIEVED] = TexelOrigin.MIRRORED
    origin[seen >= BELIEVED] = TexelOrigin.SEEN
    coverage = np.zeros_like(atlas.inside, dtype=np.uint8)
    coverage[atlas.inside] = origin
    linear = np.clip(colours / scale, 0.0, 1.0).astype(np.float32)
    levels = np.rint(255.0 * display_from_linear(linear))
    return Texture(
        levels=drawn_on(atlas.inside, levels.astype(np.uint8)),
        coverage=coverage,
        scale=scale,
        seen_share=float(np.mean(origin == TexelOrigin.SEEN)),
        mirrored_share=float(np.mean(origin == TexelOrigin.MIRRORED)),
    )


def _laid(
    surface: PictureSurface, look: Look, model: BodyModel, points: SurfacePoints
) -> tuple[Colours, Beliefs, Beliefs]:
    """Colours of points, how far each is seen, and how far its mirror image is instead."""
    sides = BothSides.of(look, model)
    found, seen, mirrored = sides.at(points)
    no_face = face_to_leave_out(surface, model)
    seen, mirrored = (each * (1.0 - points.of(no_face)) for each in (seen, mirrored))
    belief = seen + mirrored
    colours = belief[:, None] * found
    hidden = np.flatnonzero(belief < 1.0)
    invented = _hidden_colours(sides, surface, no_face, points.some(hidden))
    colours[hidden] += (1.0 - belief[hidden, None]) * invented
    return colours, seen, mirrored


def _hidden_colours(
    sides: BothSides,
    surface: PictureSurface,
    no_face: Float[np.ndarray, " m"],
    points: SurfacePoints,
) -> Colours:
    """Colours for points, as far as they are hidden, from what is found of the vertices."""
    model = sides.model
    vertices = at_vertices(model)
    found, seen, mirrored = sides.at(vertices)
    known = (seen + mirrored) * (1.0 - no_face) >= BELIEVED
    if not known.any():
        raise InvalidInputError(
            code="body-not-seen",
            field="fit_id",
            reason="The picture shows nothing of the fitted body clearly enough for a texture.",
            remedy="Look at the fit's overlay; mend the clicks and fit again.",
        )
    # What is done to the picture's colours, as by dividing its light out.
    pictured = np.maximum(surface.colours(vertices), DARKEST)
    done = np.median(found[known] / pictured[known])
    crown = None if surface.crown is None else done * surface.crown
    worn = Worn.of(model, known, found, crown)
    light = extend_light(model, known, found, worn.at(vertices))
    return worn.at(points) * np.exp(points.of(light))


DIM, LIT = 0.1, 0.35
"""Shares of the lamp's light: below the first an albedo is noise divided by little, and the rest of
the light is only roughly known; from the second on it is believed wholly."""

_LEAST_LUMINANCE = 1e-3


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class LitSurface:
    """Eq. 1 over the surface of a person in their light."""

    surface: PictureSurface
    light: Light
    reflectance: Reflectance
    body_centre: Float[np.ndarray, "3"]
    lit: Float[np.ndarray, " m"]
    typical: float

    @classmethod
    def of(
        cls, surface: PictureSurface, person: FittedPerson, light: Light, reflectance: Reflectance
    ) -> "LitSurface":
        """Surface of a body before its picture, in the light that the fit found."""
        rendering, centre = surface.rendering, person.body.translation
        shadowed = cast_shadow(
            rendering.vertices, rendering.triangles, light=light, body_centre=centre
        )
        typical = float(np.median(reflectance.albedo[rendering.vertex_visible]))
        return cls(
            surface=surface,
            light=light,
            reflectance=reflectance,
            body_centre=centre,
            lit=1.0 - shadowed,
            typical=max(typical, _LEAST_LUMINANCE),
        )

    def albedo(
        self, points: SurfacePoints, colours: Colours, belief: Beliefs
    ) -> tuple[Colours, Beliefs]:
        """Albedo of points whose linear colours are seen, and how far it is believed."""
        rendering, lit = self.surface.rendering, points.of(self.lit)
        normals = unit_vectors(points.of(rendering.vertex_normals))
        terms = shading_terms(
            points.of(rendering.vertices),
            normals,
            light=self.light,
            body_centre=self.body_centre,
            specular_exponent=self.reflectance.specular_exponent,
        )
        luminance = np.maximum(luminance_of(colours[None])[0], _LEAST_LUMINANCE)
        highlight = points.of(self.reflectance.specularity) * terms.specular * lit
        direct = terms.diffuse * lit
        without = np.maximum(1.0 - highlight / luminance, 0.0)
        around = self.reflectance.ambient / self.typical
        share = without / np.maximum(direct + around, DIM)
        return colours * share[:, None], belief * smooth_step(direct, DIM, LIT)

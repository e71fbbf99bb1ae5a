"""Texture mapping (section 6): the picture, or the albedo found in it, laid on the body.

What the picture shows is taken from it. What it hides is taken from the other side of the body
where that is seen, and else continued from its surroundings over the mesh; a coverage picture says
which is which, so that nothing invented passes for observed.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from enum import IntEnum

import numpy as np
from jaxtyping import Bool, Float, Integer, UInt8

from fitter.applications.atlas import Atlas, atlas_of, drawn_on
from fitter.applications.seen_surface import SeenSurface, SurfacePoints, smooth_step
from fitter.arrays import Image, Mask, Vector3
from fitter.body.scape import ScapeEvaluator
from fitter.errors import InvalidInputError
from fitter.numerics.mesh_topology import mesh_topology
from fitter.numerics.vectors import unit_vectors
from fitter.observation.colour import display_from_linear, luminance_of
from fitter.observation.resampling import linear_working_picture, working_size
from fitter.optimizer.hidden_reflectance import HiddenVertices
from fitter.parameters import Light, Reflectance
from fitter.person.fitted_person import FittedPerson, require_model
from fitter.render.rasterizer import Rendering
from fitter.render.reflectance import shading_terms
from fitter.render.shadow import cast_shadow, penumbra
from fitter.render.surroundings import irradiance

SIZES = (512, 1024, 2048)
"""Sides an atlas may have, texels."""

BELIEVED = 0.5
"""From this belief on a texel counts as seen."""

DIM, LIT = 0.1, 0.35
"""Shares of the lamp's light: below the first an albedo is noise divided by little, and the rest of
the light is only roughly known; from the second on it is believed wholly."""

PICTURE_PIXELS = 2_000_000
"""Of the picture that is laid on the body: then a pixel of a standing person is a millimetre, as a
texel of the largest atlas is."""

_LEAST_LUMINANCE = 1e-3
_CHUNK = 1 << 17

Colours = Float[np.ndarray, "k 3"]
Beliefs = Float[np.ndarray, " k"]
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
    lit = _LitSurface.of(surface, person, light, reflectance)

    def look(points: SurfacePoints) -> tuple[Colours, Beliefs]:
        return lit.albedo(points, surface.colours(points), surface.belief(points))

    return _texture(look, evaluator, size)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _LitSurface:
    """Eq. 1 over the surface of a person in their light."""

    surface: SeenSurface
    light: Light
    reflectance: Reflectance
    body_centre: Float[np.ndarray, "3"]
    lit: Float[np.ndarray, " m"]
    sharp: Float[np.ndarray, " m"]
    typical: float

    @classmethod
    def of(
        cls,
        surface: SeenSurface,
        person: FittedPerson,
        light: Light,
        reflectance: Reflectance,
    ) -> "_LitSurface":
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
            sharp=1.0 - _penumbra(rendering, shadowed, light, centre),
            typical=max(typical, _LEAST_LUMINANCE),
        )

    def albedo(
        self, points: SurfacePoints, colours: Colours, belief: Beliefs
    ) -> tuple[Colours, Beliefs]:
        rendering, lit = self.surface.rendering, points.of(self.lit)
        normals = unit_vectors(points.of(rendering.vertex_normals))
        terms = shading_terms(
            points.of(rendering.vertices),
            normals,
            light=replace(self.light, surroundings=None),
            body_centre=self.body_centre,
            specular_exponent=self.reflectance.specular_exponent,
        )
        luminance = np.maximum(luminance_of(colours[None])[0], _LEAST_LUMINANCE)
        highlight = points.of(self.reflectance.specularity) * terms.specular * lit
        direct = terms.diffuse * lit
        without = np.maximum(1.0 - highlight / luminance, 0.0)
        if self.light.surroundings is None:
            around = self.reflectance.ambient / self.typical
            known = direct
        else:
            around = irradiance(self.light.surroundings, normals)
            known = direct + around
            belief = belief * points.of(self.sharp)
        share = without / np.maximum(direct + around, DIM)
        return colours * share[:, None], belief * smooth_step(known, DIM, LIT)


def _penumbra(
    rendering: Rendering, shadowed: Bool[np.ndarray, " m"], light: Light, body_centre: Vector3
) -> Bool[np.ndarray, " m"]:
    lamp = shading_terms(
        rendering.vertices,
        rendering.vertex_normals,
        light=replace(light, surroundings=None),
        body_centre=body_centre,
        specular_exponent=1.0,
    )
    edges = mesh_topology(rendering.triangles, vertex_count=len(shadowed)).edges
    return penumbra(shadowed, lamp.diffuse > 0.0, edges)


def _surface(
    person: FittedPerson, evaluator: ScapeEvaluator, linear_rgb: Image, mask: Mask | None
) -> SeenSurface:
    require_model(person, evaluator.model)
    height, width = linear_rgb.shape[:2]
    camera = person.camera.scaled(width / person.camera.width, width=width, height=height)
    vertices = evaluator.vertices(person.body)
    return SeenSurface.of(vertices, evaluator.model.triangles, camera, linear_rgb, mask)


def _texture(look: Look, evaluator: ScapeEvaluator, size: int) -> Texture:
    if size not in SIZES:
        raise InvalidInputError(
            code="texture-size",
            field="size",
            reason=f"A texture of {size} texels a side is not made.",
            remedy=f"Ask for one of {', '.join(map(str, SIZES))}.",
        )
    model = evaluator.model
    continued = _continued(look, evaluator)
    atlas = atlas_of(model, size)
    colours, origins = np.empty((len(atlas.triangles), 3)), []
    for first in range(0, len(atlas.triangles), _CHUNK):
        chunk = slice(first, first + _CHUNK)
        corners, weights = model.triangles[atlas.triangles[chunk]], atlas.weights[chunk]
        found, seen, mirrored = _own_or_other_side(look, model.mirror, corners, weights)
        belief = (seen + mirrored)[:, None]
        around = SurfacePoints(corners=corners, weights=weights).of(continued)
        colours[chunk] = belief * found + (1.0 - belief) * around
        origins.append(_origin(seen, mirrored))
    scale = max(1.0, float(np.percentile(colours, 99.5)))
    origin = np.concatenate(origins)
    levels = np.rint(255.0 * display_from_linear(np.clip(colours / scale, 0.0, 1.0)))
    return Texture(
        levels=drawn_on(atlas.inside, levels.astype(np.uint8)),
        coverage=_picture_of(atlas, origin),
        scale=scale,
        seen_share=float(np.mean(origin == TexelOrigin.SEEN)),
        mirrored_share=float(np.mean(origin == TexelOrigin.MIRRORED)),
    )


def _own_or_other_side(
    look: Look,
    mirror: Integer[np.ndarray, " m"],
    corners: Integer[np.ndarray, "k 3"],
    weights: Float[np.ndarray, "k 3"],
) -> tuple[Colours, Beliefs, Beliefs]:
    """Colours of points, how far they are seen, and how far their mirror image is instead.

    The colour is the mean of both, each by its weight; the point itself comes first.
    """
    colours, seen = look(SurfacePoints(corners=corners, weights=weights))
    other, belief = look(SurfacePoints(corners=mirror[corners], weights=weights))
    mirrored = (1.0 - seen) * belief
    total = np.maximum(seen + mirrored, 1e-12)[:, None]
    return (seen[:, None] * colours + mirrored[:, None] * other) / total, seen, mirrored


def _continued(look: Look, evaluator: ScapeEvaluator) -> Float[np.ndarray, "m 3"]:
    """Colours of all vertices, carried on from those that are seen."""
    model = evaluator.model
    count = len(model.mean_vertices)
    corners = np.repeat(np.arange(count)[:, None], 3, axis=1)
    weights = np.tile([1.0, 0.0, 0.0], (count, 1))
    colours, seen, mirrored = _own_or_other_side(look, model.mirror, corners, weights)
    known: Bool[np.ndarray, " m"] = seen + mirrored >= BELIEVED
    if not known.any():
        raise InvalidInputError(
            code="body-not-seen",
            field="fit_id",
            reason="The picture shows nothing of the fitted body clearly enough for a texture.",
            remedy="Look at the fit's overlay; mend the clicks and fit again.",
        )
    edges = mesh_topology(model.triangles, vertex_count=count).edges
    first, second = model.mean_vertices[edges.T]
    lengths = np.linalg.norm(first - second, axis=1)
    hidden = HiddenVertices.of(known, edges, np.maximum(lengths / lengths.mean(), 0.05))
    return np.stack([hidden.filled(colours[:, k]) for k in range(3)], axis=1)


def _origin(seen: Beliefs, mirrored: Beliefs) -> UInt8[np.ndarray, " k"]:
    origin = np.full(len(seen), TexelOrigin.CONTINUED, dtype=np.uint8)
    origin[seen + mirrored >= BELIEVED] = TexelOrigin.MIRRORED
    origin[seen >= BELIEVED] = TexelOrigin.SEEN
    return origin


def _picture_of(atlas: Atlas, values: UInt8[np.ndarray, " t"]) -> UInt8[np.ndarray, "n n"]:
    picture = np.zeros((atlas.size, atlas.size), dtype=np.uint8)
    picture[atlas.inside] = values
    return picture

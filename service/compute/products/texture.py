"""The picture, the albedo found in it or a painted atlas as a texture of the fitted body."""

import numpy as np
from jaxtyping import UInt8

from api_schemas.products.bodies import TextureColours, TextureOptions, TextureResult
from fitter.applications.own_texture import atlas_drawing, painted_texture
from fitter.applications.textured_glb import in_file_axes, textured_glb
from fitter.export.display import png
from fitter.observation.decoding import decode_picture
from service.compute.products import Report
from service.compute.products.finished_fit import FinishedFit, Made
from service.compute.products.pictured_body import picture_on
from service.jobs.inputs import TEXTURE


def make(fit: FinishedFit, options: TextureOptions, report: Report) -> Made[TextureResult]:
    """Put the picture, or a painted atlas, on it; see :class:`service.compute.products.Maker`."""
    laid = _painted if options.colours is TextureColours.OWN else _pictured
    result, levels, coverage = laid(fit, options)
    report(0.8)
    person, model, evaluator = fit.person, fit.operators.model, fit.operators.evaluator
    texture = png(levels)
    return Made(
        result=result,
        files={
            "body_textured.glb": textured_glb(
                in_file_axes(evaluator.vertices(person.body)),
                model,
                texture,
                person=person,
                colour_scale=result.scale,
                is_albedo=options.colours is not TextureColours.PICTURE,
                extras={
                    "colours": options.colours.value,
                    "seen_share": result.seen_share,
                    "mirrored_share": result.mirrored_share,
                },
            ),
            "texture.png": texture,
            "atlas.png": png(atlas_drawing(model, result.size)),
        }
        | ({} if coverage is None else {"coverage.png": png(coverage)}),
    )


_Laid = tuple[TextureResult, UInt8[np.ndarray, "n n 3"], UInt8[np.ndarray, "n n"] | None]
"""A texture's description, its levels, and which of them were seen if that can be said."""


def _pictured(fit: FinishedFit, options: TextureOptions) -> _Laid:
    texture = picture_on(
        fit, without_light=options.colours is TextureColours.ALBEDO, size=options.size
    )
    result = TextureResult(
        colours=options.colours,
        size=options.size,
        seen_share=texture.seen_share,
        mirrored_share=texture.mirrored_share,
        scale=texture.scale,
    )
    return result, texture.levels, texture.coverage


def _painted(fit: FinishedFit, options: TextureOptions) -> _Laid:
    painted = decode_picture(fit.files[TEXTURE], field=TEXTURE, max_pixels=fit.max_pixels)
    levels = painted_texture(painted.pixels, fit.operators.model, field=TEXTURE)
    result = TextureResult(
        colours=options.colours,
        size=len(levels),
        seen_share=0.0,
        mirrored_share=0.0,
        scale=1.0,
    )
    return result, levels, None

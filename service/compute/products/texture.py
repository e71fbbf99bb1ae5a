"""The picture, or the albedo found in it, as a texture of the fitted body."""

from api_schemas.products.base import BodyColours
from api_schemas.products.bodies import TextureOptions, TextureResult
from fitter.export.display import png
from fitter.export.gltf import textured_glb
from fitter.export.gltf_mesh import BodyTexture
from service.compute.products.finished_fit import FinishedFit, Made, Report
from service.compute.products.pictured_body import picture_on


def make(fit: FinishedFit, options: TextureOptions, report: Report) -> Made[TextureResult]:
    """Put the picture on it."""
    is_albedo = options.colours is BodyColours.ALBEDO
    laid = picture_on(fit, without_light=is_albedo, size=options.size)
    report(0.8)
    texture, model = png(laid.levels), fit.operators.model
    shares = {"seen_share": laid.seen_share, "mirrored_share": laid.mirrored_share}
    return Made(
        result=TextureResult(
            colours=options.colours,
            size=options.size,
            scale=laid.scale,
            seen_share=laid.seen_share,
            mirrored_share=laid.mirrored_share,
        ),
        files={
            "body_textured.glb": textured_glb(
                fit.operators.evaluator.vertices(fit.person.body),
                model,
                BodyTexture.of(model, texture, media_type="image/png", is_lit=not is_albedo),
                person=fit.person,
                colour_scale=laid.scale,
                extras={"colours": options.colours.value, **shares},
            ),
            "texture.png": texture,
            "coverage.png": png(laid.coverage),
        },
    )

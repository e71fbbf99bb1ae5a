"""The picture, the albedo found in it or a painted atlas as a texture of the fitted body."""

from collections.abc import Callable

import numpy as np
from jaxtyping import UInt8

from api_schemas.derivation_kinds.texture import TextureColours, TextureOptions, TextureResult
from fitter.applications.own_texture import atlas_drawing, painted_texture
from fitter.applications.textured_glb import in_file_axes, textured_glb
from fitter.energies.fitting_operators import FittingOperators
from fitter.export.display import png
from fitter.observation.decoding import decode_picture
from fitter.person.fitted_person import FittedPerson
from service.jobs.inputs import PERSON, TEXTURE
from service.worker.derived.person import person_and_operators
from service.worker.derived.pictured_body import picture_on
from service.worker.pipeline_port import DerivationInput, DerivationOutput


def derive(
    job: DerivationInput[TextureOptions], observe: Callable[[float], None]
) -> DerivationOutput[TextureResult]:
    """Put the picture, or a painted atlas, on the body.

    See :class:`service.worker.derivers.Deriver`.
    """
    options = job.options
    person, operators = person_and_operators(job.inputs[PERSON], job.models)
    laid = _painted if options.colours is TextureColours.OWN else _pictured
    result, levels, coverage = laid(job, person, operators)
    observe(0.8)
    model, evaluator = operators.model, operators.evaluator
    texture = png(levels)
    return DerivationOutput(
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


def _pictured(
    job: DerivationInput[TextureOptions], person: FittedPerson, body: FittingOperators
) -> _Laid:
    options = job.options
    texture = picture_on(
        person,
        body.evaluator,
        job.inputs,
        without_light=options.colours is TextureColours.ALBEDO,
        size=options.size,
        max_pixels=job.max_pixels,
    )
    result = TextureResult(
        colours=options.colours,
        size=options.size,
        seen_share=texture.seen_share,
        mirrored_share=texture.mirrored_share,
        scale=texture.scale,
        files=(),
    )
    return result, texture.levels, texture.coverage


def _painted(
    job: DerivationInput[TextureOptions], person: FittedPerson, body: FittingOperators
) -> _Laid:
    del person
    painted = decode_picture(job.inputs[TEXTURE], field=TEXTURE, max_pixels=job.max_pixels)
    levels = painted_texture(painted.pixels, body.model, field=TEXTURE)
    result = TextureResult(
        colours=job.options.colours,
        size=len(levels),
        seen_share=0.0,
        mirrored_share=0.0,
        scale=1.0,
        files=(),
    )
    return result, levels, None

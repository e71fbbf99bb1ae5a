"""The picture, or the albedo found in it, as a texture of the fitted body."""

from collections.abc import Callable
from typing import cast

import cv2
import numpy as np

from api_schemas.derivations import (
    DerivationKind,
    TextureColours,
    TextureOptions,
    TextureResult,
)
from fitter.applications.texture import albedo_texture, picture_texture
from fitter.applications.textured_glb import in_file_axes, textured_glb
from fitter.arrays import Mask
from fitter.camera import Camera
from fitter.errors import InvalidInputError
from fitter.export.display import png
from fitter.observation.colour import linear_from_display
from fitter.observation.decoding import decode_coverage, decode_picture
from service.engine.port import Report
from service.inputs import IMAGE, PERSON, SEGMENTATION
from service.worker.derived.person import person_and_instruments
from service.worker.pipeline_port import DerivationInput, DerivationOutput

STAGE = DerivationKind.TEXTURE.value

HALF = 128
"""From this level on the segmentation says that a pixel shows the person."""


def derive(job: DerivationInput, observe: Callable[[Report], None]) -> DerivationOutput:
    """Lay the picture on the body; see :class:`service.worker.derivers.Deriver`."""
    observe(Report(stage=STAGE, progress=0.0))
    options = cast("TextureOptions", job.options)
    person, instruments = person_and_instruments(job.inputs[PERSON], job.models)
    model, evaluator = instruments.model, instruments.evaluator
    picture = decode_picture(job.inputs[IMAGE], field="image", max_pixels=job.max_pixels)
    mask = _person_in(job.inputs[SEGMENTATION], person.camera, max_pixels=job.max_pixels)
    without_light = options.colours is TextureColours.ALBEDO
    if without_light and person.light is None:
        raise _no_light()
    made = albedo_texture if without_light else picture_texture
    texture = made(
        person,
        evaluator,
        linear_from_display(picture.pixels / 255.0),
        mask=mask,
        size=options.size,
    )
    observe(Report(stage=STAGE, progress=0.8))
    levels = png(texture.levels)
    return DerivationOutput(
        result=TextureResult(
            colours=options.colours,
            size=options.size,
            seen_share=texture.seen_share,
            mirrored_share=texture.mirrored_share,
            scale=texture.scale,
            artifacts=(),
        ),
        artifacts={
            "body_textured.glb": textured_glb(
                in_file_axes(evaluator.vertices(person.body)),
                model,
                levels,
                colour_scale=texture.scale,
                lit_as=person if without_light else None,
                extras={
                    "colours": options.colours.value,
                    "seen_share": texture.seen_share,
                    "mirrored_share": texture.mirrored_share,
                },
            ),
            "texture.png": levels,
            "coverage.png": png(texture.coverage),
        },
    )


def _person_in(segmentation: bytes, camera: Camera, *, max_pixels: int) -> Mask:
    """Where the picture shows the person; the fit's own drawing of it may be smaller."""
    levels = decode_coverage(segmentation, field="mask", max_pixels=max_pixels)
    resized = cv2.resize(levels, (camera.width, camera.height), interpolation=cv2.INTER_LINEAR)
    return np.asarray(resized >= HALF)


def _no_light() -> InvalidInputError:
    return InvalidInputError(
        code="no-light",
        field="colours",
        reason="The fit found no light that could be divided out of the picture.",
        remedy="Fit with cues SES, or ask for the colours of the picture.",
    )

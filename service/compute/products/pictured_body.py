"""The colours of a fit's picture on its body, wherever that is to stand."""

from typing import Final

import cv2
import numpy as np

from api_schemas.products.base import BodyColours
from fitter.applications.texture import Texture, albedo_texture, linear_picture, picture_texture
from fitter.arrays import Mask
from fitter.errors import InvalidInputError
from fitter.export.gltf_mesh import BodyTexture
from fitter.observation.decoding import decode_coverage, decode_picture
from service.compute.products.finished_fit import FinishedFit
from service.jobs.inputs import IMAGE, SEGMENTATION, of_view

HALF: Final = 128
"""Level at which the segmentation says that a pixel shows the person."""

SIZE: Final = 1_024
"""Texels a side of bodies in other poses: 2 mm each."""

JPEG_QUALITY: Final = 92
"""0.2 MB where PNG has 1.3: beside 1 MB of mesh the texture of a moving body may be a copy."""


def picture_on(fit: FinishedFit, *, without_light: bool, size: int) -> Texture:
    """The fit's picture as a texture of its body, or the albedo found in it.

    Raises
    ------
    InvalidInputError
        If there is no light to divide out, or the picture shows nothing of the body.
    """
    if without_light and fit.person.light is None:
        raise InvalidInputError(
            code="no-light",
            field="colours",
            reason="The fit found no light that could be divided out of the picture.",
            remedy="Fit with cues SES, or ask for the colours of the picture.",
        )
    image, segmentation = fit.files[of_view(0, IMAGE)], fit.files[of_view(0, SEGMENTATION)]
    picture = decode_picture(image, field="image", max_pixels=fit.max_pixels)
    linear_rgb = linear_picture(picture.pixels)
    made = albedo_texture if without_light else picture_texture
    return made(
        fit.person,
        fit.operators.evaluator,
        linear_rgb,
        mask=_person_in(segmentation, linear_rgb.shape[:2], max_pixels=fit.max_pixels),
        size=size,
    )


def texture_for(colours: BodyColours, fit: FinishedFit) -> BodyTexture | None:
    """Texture of a body in another pose; None for plain colours, or where nothing is seen.

    Raises
    ------
    InvalidInputError
        If albedo is asked for and the fit found no light.
    """
    if colours is BodyColours.PLAIN:
        return None
    without_light = colours is BodyColours.ALBEDO
    try:
        texture = picture_on(fit, without_light=without_light, size=SIZE)
    except InvalidInputError as error:
        if error.code == "body-not-seen":
            return None
        raise
    quality = [cv2.IMWRITE_JPEG_QUALITY, JPEG_QUALITY]
    _, encoded = cv2.imencode(".jpg", texture.levels[..., ::-1], quality)
    return BodyTexture.of(
        fit.operators.model, encoded.tobytes(), media_type="image/jpeg", is_lit=not without_light
    )


def texture_files(texture: BodyTexture | None) -> dict[str, bytes]:
    """The texture beside the mesh, as other formats refer to it."""
    return {} if texture is None else {"texture.jpg": texture.picture}


def _person_in(segmentation: bytes, shape: tuple[int, int], *, max_pixels: int) -> Mask:
    """Mask of the person in a picture of this height and width."""
    levels = decode_coverage(segmentation, field="mask", max_pixels=max_pixels)
    resized = cv2.resize(levels, shape[::-1], interpolation=cv2.INTER_LINEAR)
    return np.asarray(resized >= HALF)

"""What the fit sees: the working picture, its camera, the clicks and the caller's mask."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from fitter.arrays import GreyImage, Image, Mask
from fitter.observation.clicks import check_clicks, side_warnings
from fitter.observation.colour import display_from_linear, luminance_of
from fitter.observation.decoding import decode_picture
from fitter.observation.focal_length import focal_length
from fitter.observation.masks import decode_mask
from fitter.observation.resampling import linear_working_picture, working_size
from fitter.observation.subject import check_subject
from fitter.remarks import Assumption, FitWarning
from fitter.render.camera import Camera, FocalLengthSource
from fitter.request import Click, Clothing, FitRequest


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Observation:
    """One request, decoded and checked, at the working size (h, w).

    Attributes
    ----------
    display
        (h, w, 3) float32 sRGB-coded values in [0, 1]: for edges, GrabCut and people.
    linear_rgb, luminance
        (h, w, 3), (h, w) float32 linear light in [0, 1]: for shading and reflectance.
    camera
        Of the working picture.
    image_camera
        Of the upright original, whose pixels the caller's points and results refer to.
    scale
        Working pixels per original pixel, at most 1.
    clicks
        By name, in continuous pixels of the working picture.
    mask
        (h, w) the caller's foreground, None where none was sent.
    clothing
        How the caller says the clothes lie.
    """

    display: Image
    linear_rgb: Image
    luminance: GreyImage
    camera: Camera
    image_camera: Camera
    focal_length_source: FocalLengthSource
    scale: float
    clicks: Mapping[str, Click]
    mask: Mask | None
    clothing: Clothing
    assumptions: tuple[Assumption, ...]
    warnings: tuple[FitWarning, ...]


def observe(request: FitRequest) -> Observation:
    """Decode and check a request.

    Raises
    ------
    InvalidInputError
        If the picture, the mask, the points, the focal length or the person's data cannot be used.
    """
    check_subject(request)
    picture = decode_picture(request.image, field="image", max_pixels=request.max_pixels)
    height, width = picture.pixels.shape[:2]
    check_clicks(request.clicks, width=width, height=height)
    focal = focal_length(
        request, picture.exif, width=width, height=height, stored_width=picture.stored_width
    )
    size = working_size(width=width, height=height)
    mask = None
    if request.mask is not None:
        mask = decode_mask(
            request.mask, width=width, height=height, size=size, max_pixels=request.max_pixels
        )
    linear_rgb = linear_working_picture(picture.pixels, size)
    image_camera = Camera(
        focal_length_px=focal.pixels,
        centre_x=width / 2,
        centre_y=height / 2,
        width=width,
        height=height,
    )
    return Observation(
        display=display_from_linear(linear_rgb).astype(np.float32),
        linear_rgb=linear_rgb,
        luminance=luminance_of(linear_rgb),
        camera=image_camera.scaled(size.scale, width=size.width, height=size.height),
        image_camera=image_camera,
        focal_length_source=focal.source,
        scale=size.scale,
        clicks={
            name: Click(x=click.x * size.scale, y=click.y * size.scale, occluded=click.occluded)
            for name, click in request.clicks.items()
        },
        mask=mask,
        clothing=request.clothing,
        assumptions=focal.assumptions,
        warnings=picture.warnings + side_warnings(request.clicks),
    )

"""Observation of a fit: the working picture, its camera, the clicks and the caller's mask."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from fitter.arrays import GreyImage, Image, Mask
from fitter.detection.detector import (
    DetectedBody,
    DetectedSlants,
    Detector,
    body_of_clicks,
    is_somebody_at,
)
from fitter.detection.worn_parts import WornShares
from fitter.errors import InvalidInputError
from fitter.observation.clicks import (
    check_clicks,
    check_places,
    completed_clicks,
    proposal_assumptions,
    scaled_clicks,
    side_warnings,
)
from fitter.observation.decoding import decode_coverage, decode_picture
from fitter.observation.focal_length import focal_length
from fitter.observation.pixels import (
    WorkingSize,
    bytes_of_display,
    display_working_picture,
    linear_working_picture,
    luminance_of,
    working_coverage,
    working_size,
)
from fitter.observation.subject import check_light
from fitter.render.camera import Camera
from fitter.request import Click, SaidClothing, View
from fitter.vocabulary.choices import (
    Clothing,
    Posture,
    SegmentationKind,
    ViewKind,
)
from fitter.vocabulary.outcomes import FocalLengthSource
from fitter.vocabulary.remarks import Remark


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Observation:
    """One picture of a request, decoded and checked, at the working size (h, w).

    Attributes
    ----------
    display
        (h, w, 3) float32 sRGB-coded values in [0, 1]: for edges, GrabCut and people.
    linear_rgb, luminance
        (h, w, 3), (h, w) float32 linear light in [0, 1]: for shading and reflectance.
    camera
        Of the working picture.
    image_camera
        Of the upright original, to whose pixels the caller's points and the results refer.
    scale
        Working pixels per original pixel, at most 1.
    clicks
        By name, in continuous pixels of the working picture.
    mask
        (h, w) the caller's foreground, None where none was sent.
    clothing
        How the caller says the clothes lie.
    posture
        What is known of how the person stands.
    seed
        (h, w) probability that a pixel shows the person, by the detector; None if segmentation
        does not use it.
    slants
        How limbs slant, by the detector; None if nothing is known about it.
    detected
        Whether the detector finds a person where the points are; None if it was not asked.
    hides_face
        Whether the detector finds the face of who is seen from the front hidden.
    bodies
        Everybody the detector finds; None if it was not asked.
    worn
        Where skin shows and outer cloth, by the detector; None if it finds nobody, or was not
        asked.
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
    clothing: SaidClothing
    posture: Posture
    seed: GreyImage | None
    slants: DetectedSlants | None
    detected: bool | None
    hides_face: bool
    bodies: tuple[DetectedBody, ...] | None
    worn: WornShares | None
    assumptions: tuple[Remark, ...]
    warnings: tuple[Remark, ...]


def observe(view: View, *, max_pixels: int, detector: Detector | None = None) -> Observation:
    """Decode and check a picture, and run the detector, if any.

    Raises
    ------
    InvalidInputError
        If the picture, the mask, the points, the focal length or the light cannot be used.
    """
    check_light(view.light)
    picture = decode_picture(view.image, field="image", max_pixels=max_pixels)
    height, width = picture.height, picture.width
    if view.complete_clicks:
        check_places(view.clicks, width=width, height=height)
    else:
        check_clicks(view.clicks, width=width, height=height)
    focal = focal_length(
        view, picture.exif, width=width, height=height, stored_width=picture.stored_width
    )
    size = working_size(width=width, height=height)
    mask = None
    if view.mask is not None:
        mask = decode_mask(view.mask, width=width, height=height, size=size, max_pixels=max_pixels)
    linear_rgb = linear_working_picture(picture.pixels, size.from_reduced(picture.reduction))
    display = display_working_picture(linear_rgb)
    given = clicks = scaled_clicks(view.clicks, size.scale)
    shown = bytes_of_display(display)
    bodies = () if detector is None else detector.bodies(shown, view.kind)
    detected = body_of_clicks(bodies, clicks)
    worn = None
    if detector is not None and detected is not None:
        worn = detector.worn(shown, detected.person)
    if view.complete_clicks:
        clicks = completed_clicks(given, detected)
        # Up to one working pixel may be left out at the right and lower border of the original.
        check_clicks(clicks, width=size.width + 1, height=size.height + 1)
    image_camera = Camera(
        focal_length_px=focal.pixels,
        centre_x=width / 2,
        centre_y=height / 2,
        width=width,
        height=height,
    )
    return Observation(
        display=display,
        linear_rgb=linear_rgb,
        luminance=luminance_of(linear_rgb),
        camera=image_camera.scaled(size.scale, width=size.width, height=size.height),
        image_camera=image_camera,
        focal_length_source=focal.source,
        scale=size.scale,
        clicks=clicks,
        mask=mask,
        clothing=_said_by_region(view.clothing),
        posture=_posture(view.kind),
        seed=detected.mask if detected is not None and _is_seeded(view) else None,
        slants=detected.slants if detected is not None and view.slant_hints else None,
        detected=None if detector is None else is_somebody_at(bodies, given),
        hides_face=detected is not None and detected.hides_face,
        bodies=None if detector is None else tuple(bodies),
        worn=worn,
        assumptions=focal.assumptions + proposal_assumptions(given, clicks),
        warnings=picture.warnings + side_warnings(clicks),
    )


def _said_by_region(clothing: Clothing | SaidClothing) -> SaidClothing:
    """Clothes by region; what is worn over a top tells nothing of the legs."""
    if isinstance(clothing, SaidClothing):
        return clothing
    if clothing is Clothing.OUTER:
        return SaidClothing(upper=clothing)
    return SaidClothing(upper=clothing, lower=clothing)


def _posture(kind: ViewKind | None) -> Posture:
    """Posture: who is measured stands as asked; in other pictures people do as they like."""
    return Posture.ANY if kind in (None, ViewKind.OTHER) else Posture.MEASURED


def _is_seeded(view: View) -> bool:
    return view.mask is None and view.segmentation is SegmentationKind.SEEDED_GRABCUT


def decode_mask(
    data: bytes, *, width: int, height: int, size: WorkingSize, max_pixels: int
) -> Mask:
    """The foreground at the working size: pixels more than half of which are white.

    Parameters
    ----------
    width, height
        Size of the upright picture, which the mask must have.

    Raises
    ------
    InvalidInputError
        ``mask-size``, ``mask-without-foreground``, ``mask-without-background``, or as
        :func:`~fitter.observation.decoding.decode_picture` with ``mask-`` for ``image-``.
    """
    coverage = decode_coverage(data, field="mask", max_pixels=max_pixels)
    if coverage.shape != (height, width):
        raise InvalidInputError(
            code="mask-size",
            field="mask",
            reason=(
                f"The mask measures {coverage.shape[1]} x {coverage.shape[0]} pixels, the upright "
                f"picture {width} x {height}."
            ),
            remedy="Send a mask of the picture's size as a browser shows it.",
        )
    mask = working_coverage(np.ascontiguousarray(coverage), size) > 0.5
    if not mask.any():
        raise InvalidInputError(
            code="mask-without-foreground",
            field="mask",
            reason="The mask marks no pixel as the person.",
            remedy="Paint the person white and the rest black.",
        )
    if mask.all():
        raise InvalidInputError(
            code="mask-without-background",
            field="mask",
            reason="The mask marks the whole picture as the person.",
            remedy="Paint the person white and the rest black, or leave the mask out.",
        )
    return mask

"""The cheap checks of a submission, made before anything is stored or decoded.

The API makes them at ``POST``, the command line before it fits. What only a decoder can find out
(a truncated picture, a strange colour space) ends the job with the same kind of problem later.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

from api_schemas.points import AUTO, Point
from api_schemas.problems import FieldProblem
from api_schemas.requests import AskedPicture, FitOptions, FitRequest
from api_schemas.webhooks import WebhookTarget
from fitter.vocabulary.points import PointName
from service.jobs.inputs import IMAGE, MASK
from service.submissions.heic import check_heic
from service.submissions.image_header import (
    HEIC,
    DamagedImageError,
    ImageHeader,
    UnknownImageError,
    read_image_header,
)
from service.submissions.point_rules import checked_points, placed_points
from service.submissions.refusal import refused
from service.submissions.validation import parsed

ACCEPTED_KINDS: Final = "JPEG, PNG, WebP or HEIC"


@dataclass(frozen=True, slots=True, kw_only=True)
class CheckedPicture:
    """Points that are named pixels inside the picture, and the kinds of picture and mask."""

    points: Mapping[PointName, Point]
    media_types: Mapping[str, str]


@dataclass(frozen=True, slots=True, kw_only=True)
class CheckedSubmission:
    """Options whose points are named pixels inside the picture, and the pictures' kinds.

    ``webhook`` is as it was sent: whether a notice may go there is for the service to say.
    """

    options: FitOptions
    label: str | None
    webhook: WebhookTarget | None
    media_types: Mapping[str, str]


def check_submission(
    *, request: bytes, image: bytes, mask: bytes | None, max_pixels: int
) -> CheckedSubmission:
    """Check the parts of a submission against each other.

    Parameters
    ----------
    request
        The JSON text of a :class:`~api_schemas.requests.FitRequest`.
    image, mask
        The encoded pictures.
    max_pixels
        The largest picture accepted.

    Raises
    ------
    RefusedError
        With the problem to answer.
    """
    return check_parts(
        parsed(FitRequest, request, whole="request", called="the part 'request'"),
        image=image,
        mask=mask,
        max_pixels=max_pixels,
    )


def check_parts(
    asked: FitRequest, *, image: bytes, mask: bytes | None, max_pixels: int
) -> CheckedSubmission:
    """Check a request and encoded pictures against each other, as :func:`check_submission` does.

    Raises
    ------
    RefusedError
        With the problem to answer.
    """
    picture = check_image(asked, image=image, mask=mask, max_pixels=max_pixels)
    return CheckedSubmission(
        options=asked.options(picture.points),
        label=asked.label,
        webhook=asked.webhook,
        media_types=picture.media_types,
    )


def check_image(
    asked: AskedPicture, *, image: bytes, mask: bytes | None, max_pixels: int
) -> CheckedPicture:
    """Check what is asked of one encoded picture against it and its mask.

    Raises
    ------
    RefusedError
        With the problem to answer.
    """
    header = check_picture(IMAGE, image, max_pixels=max_pixels)
    media_types = {IMAGE: header.media_type}
    if mask is not None:
        mask_header = check_picture(MASK, mask, max_pixels=max_pixels)
        _check_same_size(header, mask_header)
        media_types[MASK] = mask_header.media_type
    return CheckedPicture(points=_points(asked, header), media_types=media_types)


def _points(asked: AskedPicture, picture: ImageHeader) -> dict[PointName, Point]:
    if asked.points == AUTO:
        return {}
    check = placed_points if asked.complete_points else checked_points
    return check(asked.points, asked.format, width=picture.width, height=picture.height)


def check_picture(field: str, content: bytes, *, max_pixels: int) -> ImageHeader:
    """Check an encoded picture by its header alone; nothing is decoded.

    Raises
    ------
    RefusedError
        If it is empty, of another kind, damaged, animated or larger than ``max_pixels``, or a HEIC
        where none are decoded.
    """
    if not content:
        raise refused(
            FieldProblem(
                field=field,
                code="empty-upload",
                reason="The upload has no content.",
                remedy=f"Send the bytes of a {ACCEPTED_KINDS} file.",
            )
        )
    try:
        header = read_image_header(content)
    except UnknownImageError as error:
        raise refused(
            FieldProblem(
                field=field,
                code="not-an-image",
                reason=f"The upload is not a {ACCEPTED_KINDS} file.",
                remedy=f"Send a {ACCEPTED_KINDS} file.",
            ),
            slug="unsupported-media-type",
        ) from error
    except DamagedImageError as error:
        raise refused(
            FieldProblem(
                field=field,
                code="image-damaged",
                reason=f"The file is damaged: {error}.",
                remedy="Send the whole file, or save the picture anew.",
            )
        ) from error
    if header.media_type == HEIC:
        check_heic(field)
    if header.animated:
        raise refused(
            FieldProblem(
                field=field,
                code="image-animated",
                reason="The file holds an animation.",
                remedy="Send a single picture.",
            )
        )
    if header.width * header.height > max_pixels:
        raise refused(
            FieldProblem(
                field=field,
                code="image-too-large",
                reason=(
                    f"The picture has {header.width} x {header.height} pixels, more than the "
                    f"{max_pixels} this service accepts."
                ),
                remedy="Scale the picture down; 1500 pixels on the longer side are plenty.",
            )
        )
    return header


def _check_same_size(image: ImageHeader, mask: ImageHeader) -> None:
    if (image.width, image.height) != (mask.width, mask.height):
        raise refused(
            FieldProblem(
                field="mask",
                code="mask-size-mismatch",
                reason=(
                    f"The mask has {mask.width} x {mask.height} pixels, the picture "
                    f"{image.width} x {image.height}."
                ),
                remedy="Send a mask of the picture's size as a browser shows it.",
            )
        )

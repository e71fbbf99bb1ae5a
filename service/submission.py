"""The cheap checks of a submission, made before anything is stored or decoded.

The API makes them at ``POST``, the command line before it fits. What only a decoder can find out
(a truncated picture, a strange colour space) ends the job with the same kind of problem later.
"""

from dataclasses import dataclass
from typing import Final

from pydantic import ValidationError
from pydantic_core import PydanticCustomError

from api_schemas.points import Point, PointName, PointsFormat, named_points
from api_schemas.problems import FieldProblem, Problem, field_problem, problem
from api_schemas.requests import FitOptions
from service.image_header import (
    DamagedImageError,
    ImageHeader,
    UnknownImageError,
    read_image_header,
)
from service.validation import field_problems

MIN_POINTS: Final = 4
"""Fewer points cannot tell a body's place, size and lean apart; the fit itself may ask for more."""

ACCEPTED_KINDS: Final = "JPEG, PNG or WebP"


class RefusedError(Exception):
    """A submission that cannot be accepted."""

    def __init__(self, reason: Problem) -> None:
        super().__init__(reason.detail)
        self.problem = reason


@dataclass(frozen=True, slots=True, kw_only=True)
class CheckedSubmission:
    """Options whose points are named pixels inside the picture, and the pictures' kinds."""

    options: FitOptions
    image_media_type: str
    mask_media_type: str | None


def check_submission(
    *, request: bytes, image: bytes, mask: bytes | None, max_pixels: int
) -> CheckedSubmission:
    """Check the parts of a submission against each other.

    Parameters
    ----------
    request
        The JSON text of :class:`~api_schemas.requests.FitOptions`.
    image, mask
        The encoded pictures.
    max_pixels
        The largest picture accepted.

    Raises
    ------
    RefusedError
        With the problem to answer.
    """
    options = _parse(request)
    header = _check_picture("image", image, max_pixels=max_pixels)
    mask_media_type = None
    if mask is not None:
        mask_header = _check_picture("mask", mask, max_pixels=max_pixels)
        _check_same_size(header, mask_header)
        mask_media_type = mask_header.media_type
    try:
        points = named_points(
            options.points, options.format, width=header.width, height=header.height
        )
    except PydanticCustomError as error:
        context = error.context or {}
        raise _refused(
            FieldProblem(
                field=str(context.get("field", "points")),
                code=error.type,
                reason=str(context.get("reason", error.message())),
                remedy=str(context.get("remedy", "")),
            )
        ) from error
    _check_points(points, header)
    return CheckedSubmission(
        options=options.model_copy(update={"points": points, "format": PointsFormat.NAMED}),
        image_media_type=header.media_type,
        mask_media_type=mask_media_type,
    )


def _refused(*errors: FieldProblem, slug: str = "invalid-request") -> RefusedError:
    return RefusedError(field_problem(slug, *errors))


def _parse(request: bytes) -> FitOptions:
    try:
        return FitOptions.model_validate_json(request)
    except ValidationError as error:
        errors = field_problems(error.errors())
        if any(each.code == "invalid-json" for each in errors):
            first = errors[0]
            raise RefusedError(
                problem(
                    "malformed-request",
                    detail=f"The part 'request' is not JSON: {first.reason}",
                    remedy=first.remedy,
                    code=first.code,
                    field="request",
                    errors=errors,
                )
            ) from error
        raise _refused(*errors) from error


def _check_picture(field: str, content: bytes, *, max_pixels: int) -> ImageHeader:
    if not content:
        raise _refused(
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
        raise _refused(
            FieldProblem(
                field=field,
                code="not-an-image",
                reason=f"The upload is not a {ACCEPTED_KINDS} file.",
                remedy=f"Send a {ACCEPTED_KINDS} file.",
            ),
            slug="unsupported-media-type",
        ) from error
    except DamagedImageError as error:
        raise _refused(
            FieldProblem(
                field=field,
                code="image-damaged",
                reason=f"The file is damaged: {error}.",
                remedy="Send the whole file, or save the picture anew.",
            )
        ) from error
    if header.animated:
        raise _refused(
            FieldProblem(
                field=field,
                code="image-animated",
                reason="The file holds an animation.",
                remedy="Send a single picture.",
            )
        )
    if header.width * header.height > max_pixels:
        raise _refused(
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
        raise _refused(
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


def _check_points(points: dict[PointName, Point], header: ImageHeader) -> None:
    outside = tuple(
        FieldProblem(
            field=f"points.{name}",
            code="point-outside-image",
            reason=(
                f"({point.x:g}, {point.y:g}) lies outside the picture of {header.width} x "
                f"{header.height} pixels."
            ),
            remedy="Leave out points that are not in the picture.",
        )
        for name, point in points.items()
        if not (0.0 <= point.x <= header.width and 0.0 <= point.y <= header.height)
    )
    if outside:
        raise _refused(*outside)
    if len(points) < MIN_POINTS:
        raise _refused(
            FieldProblem(
                field="points",
                code="too-few-points",
                reason=f"There are {len(points)} points; a fit needs at least {MIN_POINTS}.",
                remedy="Click more points; shoulders, hips, knees and elbows help most.",
            )
        )

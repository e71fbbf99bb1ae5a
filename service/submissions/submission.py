"""The cheap checks of a submission, made before anything is stored or decoded.

The API makes them at ``POST``, the command line before it fits. What only a decoder can find out
(a truncated picture, a strange colour space) ends the job with the same kind of problem later.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final

from api_schemas.fit import FitRequest
from api_schemas.picture import ViewRequest
from api_schemas.points import AUTO, Point, PointsFormat
from api_schemas.problems import FieldProblem
from api_schemas.questions import PointsRequest
from fitter.observation.heif import NOT_INSTALLED, NOT_INSTALLED_CODE, REMEDY
from fitter.vocabulary.points import PointName
from service.jobs.inputs import IMAGE, MASK, SentPicture, named_pictures
from service.submissions.image_header import (
    DamagedImageError,
    ImageHeader,
    ReadHeader,
    UndecodedHeicError,
    UnknownImageError,
    read_image_header,
)
from service.submissions.point_rules import checked_points, placed_points
from service.submissions.refusal import of_view, refused

ACCEPTED_KINDS: Final = "JPEG, PNG, WebP or HEIC"


@dataclass(frozen=True, slots=True, kw_only=True)
class SentFile:
    """An encoded picture or mask, and its kind."""

    content: bytes
    media_type: str


@dataclass(frozen=True, slots=True, kw_only=True)
class CheckedSubmission:
    """A request whose points are named pixels inside their pictures, and the files by name."""

    request: FitRequest
    files: Mapping[str, SentFile]


def check_submission(
    asked: FitRequest,
    sent: Sequence[SentPicture[bytes]],
    *,
    max_pixels: int,
    read: ReadHeader = read_image_header,
) -> CheckedSubmission:
    """Check a request against its encoded pictures.

    Parameters
    ----------
    max_pixels
        The largest picture accepted.
    read
        Reads the header of a picture.

    Raises
    ------
    RefusedError
        With the problem to answer; fields of a picture begin with ``views.NUMBER``.
    """
    if len(asked.views) != len(sent):
        raise refused(
            FieldProblem(
                field="views",
                code="views-count",
                reason=f"{len(sent)} pictures came, and {len(asked.views)} of `views`.",
                remedy="Send as many `views` as pictures, in their order, each with its `view`.",
            )
        )
    points, files = [], []
    for number, (view, each) in enumerate(zip(asked.views, sent, strict=True)):
        with of_view(number):
            header = check_picture(IMAGE, each.image, max_pixels=max_pixels, read=read)
            mask = None
            if each.mask is not None:
                mask_header = check_picture(MASK, each.mask, max_pixels=max_pixels, read=read)
                _check_same_size(header, mask_header)
                mask = SentFile(content=each.mask, media_type=mask_header.media_type)
            points.append(_points(view, header))
        image = SentFile(content=each.image, media_type=header.media_type)
        files.append(SentPicture(image, mask))
    return CheckedSubmission(request=asked.understood(points), files=named_pictures(files))


def _points(view: ViewRequest, picture: ImageHeader) -> dict[PointName, Point]:
    if view.points == AUTO:
        return {}
    check = placed_points if view.complete_points else checked_points
    return check(view.given_points, view.format, width=picture.width, height=picture.height)


def check_picture(
    field: str, content: bytes, *, max_pixels: int, read: ReadHeader = read_image_header
) -> ImageHeader:
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
        header = read(content)
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
    except UndecodedHeicError as error:
        # Of this machine alone: a fit fails with this code where its worker has no decoder.
        raise refused(
            FieldProblem(field=field, code=NOT_INSTALLED_CODE, reason=NOT_INSTALLED, remedy=REMEDY),
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


def placed_question(
    asked: PointsRequest, image: bytes, *, max_pixels: int, read: ReadHeader = read_image_header
) -> PointsRequest:
    """The request with named points, which lie in the picture; that is not decoded.

    Raises
    ------
    RefusedError
        As :func:`check_picture` and :func:`service.submissions.point_rules.placed_points`.
    """
    header = check_picture("image", image, max_pixels=max_pixels, read=read)
    points = placed_points(asked.points, asked.format, width=header.width, height=header.height)
    return asked.model_copy(update={"points": points, "format": PointsFormat.NAMED})

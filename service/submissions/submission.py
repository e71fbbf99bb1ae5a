"""The cheap checks of a submission, made before anything is stored or decoded.

The API makes them at ``POST``, the command line before it fits. What only a decoder can find out
(a truncated picture, a strange colour space) ends the job with the same kind of problem later.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from api_schemas.fit import FitRequest
from api_schemas.picture import ViewRequest
from api_schemas.points import AUTO, Point, Points, named_points
from api_schemas.problems import FieldProblem, Problem, problem
from api_schemas.questions import PointsRequest
from fitter.detection.weights import INSTALLATION, detector_fault
from fitter.observation import picture_files
from fitter.vocabulary.points import PointFault, PointName, place_faults, shortage
from service.jobs.inputs import IMAGE, MASK, SentPicture, named_pictures
from service.submissions.image_header import (
    DamagedImageError,
    ImageHeader,
    ReadHeader,
    UndecodedHeicError,
    UnknownImageError,
    read_image_header,
)
from service.submissions.refusal import of_view, refused, refused_field

MOST_SCANS: Final = 100
"""Each scan of a JPEG costs a decoder as much time as all its pixels do, however few bytes it has:
800 of 300 bytes took ten seconds."""

ACCEPTED_KINDS: Final = "JPEG, PNG, WebP or HEIC"

DETECTOR_MISSING: Final = "detector-not-installed"
NOT_INSTALLED: Final = "The detector that proposes points is not installed in this service."
REMEDY: Final = f"Click the points, or have the detector installed: {INSTALLATION}."


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
        raise refused_field(
            field="views",
            code="views-count",
            reason=f"{len(sent)} pictures came, and {len(asked.views)} of `views`.",
            remedy="Send as many `views` as pictures, in their order, each with its `view`.",
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
    return check(view.given_points, width=picture.width, height=picture.height)


def check_picture(
    field: str, content: bytes, *, max_pixels: int, read: ReadHeader = read_image_header
) -> ImageHeader:
    """Check an encoded picture by its header alone; nothing is decoded.

    Raises
    ------
    RefusedError
        If it is empty, of another kind, damaged, animated, a HEIC where none are decoded, of more
        scans than ``MOST_SCANS``, or too large: a JPEG may have ``max_pixels``, all else what is
        decoded whole.
    """
    if not content:
        raise refused_field(
            field=field,
            code="empty-upload",
            reason="The upload has no content.",
            remedy=f"Send the bytes of a {ACCEPTED_KINDS} file.",
        )
    try:
        header = read(content)
    except UnknownImageError as error:
        raise refused_field(
            field=field,
            code="not-an-image",
            reason=f"The upload is not a {ACCEPTED_KINDS} file.",
            remedy=f"Send a {ACCEPTED_KINDS} file.",
            slug="unsupported-media-type",
        ) from error
    except UndecodedHeicError as error:
        # Of this machine alone: a fit fails with this code where its worker has no decoder.
        raise refused_field(
            field=field,
            code=picture_files.NOT_INSTALLED_CODE,
            reason=picture_files.NOT_INSTALLED,
            remedy=picture_files.REMEDY,
            slug="unsupported-media-type",
        ) from error
    except DamagedImageError as error:
        raise refused_field(
            field=field,
            code="image-damaged",
            reason=f"The file is damaged: {error}.",
            remedy="Send the whole file, or save the picture anew.",
        ) from error
    if header.animated:
        raise refused_field(
            field=field,
            code="image-animated",
            reason="The file holds an animation.",
            remedy="Send a single picture.",
        )
    if header.scans > MOST_SCANS:
        raise refused(
            FieldProblem(
                field=field,
                code="image-too-many-scans",
                reason=f"The JPEG has {header.scans} scans; {MOST_SCANS} are accepted.",
                remedy="Save the picture anew; a progressive JPEG has about ten.",
            )
        )
    is_reducible = header.media_type == "image/jpeg" and field != MASK
    most = max_pixels if is_reducible else min(max_pixels, picture_files.WHOLE_PIXELS)
    if header.width * header.height > most:
        raise refused(too_many_pixels(field, header.width, header.height, most))
    return header


def too_many_pixels(field: str, width: int, height: int, most: int) -> FieldProblem:
    """Say that a picture is larger than is accepted."""
    return FieldProblem(
        field=field,
        code="image-too-large",
        reason=(
            f"The picture has {width} x {height} pixels, more than the {most} this service accepts."
        ),
        remedy="Scale the picture down; 1500 pixels on the longer side are plenty.",
    )


def _check_same_size(image: ImageHeader, mask: ImageHeader) -> None:
    if (image.width, image.height) != (mask.width, mask.height):
        raise refused_field(
            field="mask",
            code="mask-size-mismatch",
            reason=f"The mask has {mask.width} x {mask.height} pixels, the picture "
            f"{image.width} x {image.height}.",
            remedy="Send a mask of the picture's size as a browser shows it.",
        )


def placed_question(
    asked: PointsRequest, image: bytes, *, max_pixels: int, read: ReadHeader = read_image_header
) -> PointsRequest:
    """The request with named points, which lie in the picture; that is not decoded.

    Raises
    ------
    RefusedError
        As :func:`check_picture` and :func:`placed_points`.
    """
    header = check_picture("image", image, max_pixels=max_pixels, read=read)
    points = placed_points(asked.points, width=header.width, height=header.height)
    return asked.model_copy(update={"points": points})


def checked_points(points: Points, *, width: int, height: int) -> dict[PointName, Point]:
    """Translate the points to named pixels of the upright picture and check them.

    Raises
    ------
    RefusedError
        As :func:`placed_points`, or if they are too few or too close together.
    """
    named = placed_points(points, width=width, height=height)
    fault = shortage(_places(named), width=width, height=height)
    if fault is not None:
        raise refused(_problem(fault))
    return named


def placed_points(points: Points, *, width: int, height: int) -> dict[PointName, Point]:
    """Translate the points and check what can be checked before others are added.

    Raises
    ------
    RefusedError
        If one lies outside the picture.
    """
    named = named_points(points)
    outside = [
        _problem(fault) for fault in place_faults(_places(named), width=width, height=height)
    ]
    if outside:
        raise refused(*outside)
    return named


def _places(points: Mapping[PointName, Point]) -> dict[str, tuple[float, float]]:
    return {name: (point.x, point.y) for name, point in points.items()}


def _problem(fault: PointFault) -> FieldProblem:
    return FieldProblem(
        field=fault.field, code=fault.code, reason=fault.reason, remedy=fault.remedy
    )


def detector_is_installed(folder: Path | None) -> bool:
    """Whether runtime and weights are on this machine, in a folder or their package; loads neither.

    Workers may run elsewhere: if one of them lacks the detector, its fit fails with the same code.
    """
    return detector_fault(folder) is None


def no_detector() -> Problem:
    """Say that there is no detector here, and how to change that."""
    return problem("not-found", code=DETECTOR_MISSING, detail=NOT_INSTALLED, remedy=REMEDY)


def check_detector(asked: FitRequest, folder: Path | None) -> None:
    """Refuse a request that needs the detector if there is none.

    Raises
    ------
    RefusedError
        ``detector-not-installed``, of the field that asks for it.
    """
    for number, view in enumerate(asked.views):
        if view.are_points_completed and not detector_is_installed(folder):
            with of_view(number):
                raise refused_field(
                    field="points" if view.points == AUTO else "complete_points",
                    code=DETECTOR_MISSING,
                    reason=NOT_INSTALLED,
                    remedy=REMEDY,
                )

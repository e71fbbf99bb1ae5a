"""The cheap checks of a scan, made before anything is stored or decoded: those of every view."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from api_schemas.scans import ScanOptions, ScanRequest
from service.jobs.inputs import IMAGE, MASK, image_of, mask_of
from service.submissions.detector import check_detector
from service.submissions.refusal import of_view
from service.submissions.submission import check_image


@dataclass(frozen=True, slots=True, kw_only=True)
class ViewFiles:
    """The encoded picture of one view, and its mask if one was sent."""

    image: bytes
    mask: bytes | None


@dataclass(frozen=True, slots=True, kw_only=True)
class ScanFile:
    """An encoded picture or mask, and its kind."""

    content: bytes
    media_type: str


@dataclass(frozen=True, slots=True, kw_only=True)
class CheckedScan:
    """Options whose points are named pixels inside their pictures, and the files by name."""

    options: ScanOptions
    files: Mapping[str, ScanFile]


def check_scan(
    asked: ScanRequest, sent: Sequence[ViewFiles], *, max_pixels: int, detector: Path | None
) -> CheckedScan:
    """Check a request against the pictures of its views, of which there are as many.

    Raises
    ------
    RefusedError
        With the problem to answer; its fields begin with ``views.NUMBER``.
    """
    views, files = [], {}
    for number, (view, each) in enumerate(zip(asked.views, sent, strict=True)):
        with of_view(number):
            picture = check_image(view, image=each.image, mask=each.mask, max_pixels=max_pixels)
            options = view.options(picture.points)
            check_detector(options, detector)
        views.append(options)
        files[image_of(number)] = ScanFile(
            content=each.image, media_type=picture.media_types[IMAGE]
        )
        if each.mask is not None:
            files[mask_of(number)] = ScanFile(
                content=each.mask, media_type=picture.media_types[MASK]
            )
    return CheckedScan(options=asked.options(views), files=files)

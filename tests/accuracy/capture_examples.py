"""Pictures to measure by, and pictures spoilt in one way each: the examples of MEASURING.md."""

from dataclasses import dataclass, replace

from fitter.capture.checking import check_capture
from fitter.detection.detector import Detector
from fitter.fits.capture_check import CaptureQuestion, capture_of
from fitter.observation.decoding import DecodedPicture, decode_picture
from fitter.observation.picture_files import ExifTags
from fitter.vocabulary.choices import ViewKind
from fitter.vocabulary.remarks import Code
from tests.accuracy.capture_forms import (
    Picture,
    Source,
    beside,
    blurred,
    cropped,
    exposed,
    far_away,
    reduced,
    rolled,
)
from tests.accuracy.cases import CASES
from tests.accuracy.plain_rendering import plain_picture
from tests.accuracy.runs import picture_of
from tests.accuracy.staging import camera_of

MAX_PIXELS = 50_000_000

WITHOUT_EXAMPLE = {
    Code.NOBODY_FOUND,
    Code.SKIN_NOT_FOUND,
    Code.FACE_HIDDEN,
    Code.SQUEEZED,
    Code.COVERED,
    Code.NOT_STANDING,
    Code.CHILD,
    Code.CONTRADICTED,
}
"""Everybody in the suite's pictures is grown up and stands, in colour; no check tells what covers
them, or that a fit is contradicted."""

NEAR_M = 1.2
WIDE_MM = 15
"""A camera too near sees the whole person through a phone's wide lens only."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Example:
    """A picture, what is asked of it, and the code it is an example of; None of a good one."""

    title: str
    code: Code | None
    picture: Picture
    question: CaptureQuestion


def examples() -> list[Example]:
    """Good pictures first, then one of each fault; people of the tuning half alone."""
    woman, man = _source("phone_woman_young_thin_front"), _source("phone_man_old_middling_front")
    plain = _source("phone_man_middle_aged_thin_front")
    old = _source("phone_woman_old_middling_front")

    def fault(title: str, code: Code, picture: Picture, source: Source) -> Example:
        question = replace(source.question, focal_length_px=None)
        return Example(title=title, code=code, picture=picture, question=question)

    return [
        _good("Front", "phone_woman_young_thin_front"),
        _good("Side, arms forward", "phone_woman_young_thin_side"),
        _good("Side, arms hanging", "phone_man_middle_aged_thin_side"),
        fault("Feet cut off", Code.CUT_OFF, cropped(man, bottom=0.96), man),
        fault("Too far away", Code.PERSON_TOO_SMALL, far_away(woman, stature_px=200.0), woman),
        fault("A thumbnail", Code.PICTURE_TOO_SMALL, reduced(old, stature_px=100.0), old),
        _too_near("Too near", "phone_man_middle_aged_middling_front"),
        fault("Tilted camera", Code.CAMERA_ROLLED, rolled(plain, degrees=15.0), plain),
        _taken("Turned half away", Code.OTHER_VIEW, "woman_young_thin_turned"),
        _taken("Arms on the body", Code.ARMS_AGAINST_TRUNK, "man_old_middling_turned"),
        _taken("Loose clothes", Code.CLOTHES_LOOSE, "clothed_man_middle_aged_middling"),
        fault("Blurred", Code.BLURRED, blurred(woman, deviation_px=4.0), woman),
        fault("Too dark", Code.TOO_DARK, exposed(plain, factor=0.025), plain),
        fault("Too bright", Code.TOO_BRIGHT, exposed(old, factor=5.0), old),
        fault("Somebody else", Code.SEVERAL_PEOPLE, beside(man.picture, plain.picture), man),
    ]


def said_of(example: Example, detector: Detector) -> list[str]:
    """The codes that the checks answer for an example, in their order."""
    decoded = DecodedPicture(
        pixels=example.picture,
        width=example.picture.shape[1],
        height=example.picture.shape[0],
        stored_width=example.picture.shape[1],
        exif=ExifTags(),
        warnings=(),
    )
    capture = capture_of(decoded, example.question, detector=detector)
    return [finding.code for finding in check_capture(capture).findings]


def _good(title: str, name: str) -> Example:
    source = _source(name)
    return Example(title=title, code=None, picture=source.picture, question=source.question)


def _taken(title: str, code: Code, name: str) -> Example:
    return replace(_good(title, name), code=code)


def _too_near(title: str, name: str) -> Example:
    """Plainly rendered: nobody of the suite is photographed from so near."""
    source, case = _source(name), CASES[name]
    view = replace(case.view, distance_m=NEAR_M, equivalent_mm=WIDE_MM)
    placed = replace(case, view=view)
    return Example(
        title=title,
        code=Code.CAMERA_TOO_NEAR,
        picture=plain_picture(placed, turned_deg=0.0),
        question=replace(source.question, focal_length_px=camera_of(view).focal_length_px),
    )


def _source(name: str) -> Source:
    picture = picture_of(name)
    decoded = decode_picture(picture.request.views[0].image, field="image", max_pixels=MAX_PIXELS)
    view = ViewKind.SIDE if name.endswith("_side") else ViewKind.FRONT
    return Source(
        picture=decoded.pixels,
        mask=picture.person_mask,
        question=CaptureQuestion(
            view=view,
            gender=picture.request.person.gender,
            height_m=picture.request.person.height_m,
            focal_length_px=picture.focal_length_px,
        ),
    )

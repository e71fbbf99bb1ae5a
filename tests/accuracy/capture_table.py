"""How often each check of a capture finds what is wrong, and what is not."""

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from fitter.capture.capture import Capture
from fitter.capture.checking import check_capture
from fitter.detection.detector import installed_detector
from fitter.fits.capture_check import CaptureQuestion, capture_of
from fitter.observation.decoding import DecodedPicture, decode_picture
from fitter.observation.picture_files import ExifTags
from fitter.vocabulary.choices import ViewKind
from fitter.vocabulary.remarks import Code
from tests.accuracy.capture_forms import Form, Picture, Source, spoilt_forms
from tests.accuracy.capture_truth import variants_of
from tests.accuracy.cases import CASES
from tests.accuracy.drawn_pictures import (
    coded,
    disc,
    dog_picture,
    hills,
    one_shape,
    slab,
    smooth_noise,
)
from tests.accuracy.foreign import foreign_names
from tests.accuracy.plain_rendering import plain_picture
from tests.accuracy.runs import picture_of
from tests.accuracy.scene import Half, Leg
from tests.accuracy.stance_kinds import Kind

MAX_PIXELS = 50_000_000
OF_EACH_KIND = 6

SEEN_AT = {0.0: ViewKind.FRONT, 90.0: ViewKind.SIDE, 180.0: ViewKind.BACK, 270.0: ViewKind.SIDE}
"""From where somebody is seen who is turned by so many degrees."""


_SEATED = Leg(raised=85.0, forward=80.0, bend=85.0, toe_out=0.0)
_CROUCHING = Leg(raised=110.0, forward=70.0, bend=140.0, toe_out=0.0)

POSTURES: dict[str, dict[str, Any]] = {
    "seated": {"left_leg": _SEATED, "right_leg": _SEATED},
    "crouching": {
        "left_leg": _CROUCHING,
        "right_leg": _CROUCHING,
        "pelvis": (10.0, 0.0, 0.0),
        "spine": (20.0, 0.0, 0.0),
    },
    "bent over": {"pelvis": (60.0, 0.0, 0.0), "spine": (15.0, 0.0, 0.0)},
}
"""What differs from how people stand."""


@dataclass(frozen=True, slots=True, kw_only=True)
class JudgedFinding:
    """Whether a code was found in a picture, and whether it should have been."""

    name: str
    form: str
    code: Code
    found: bool
    wrong: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class Judgement:
    """What is to be judged: a picture as it is, and spoilt too if ``other`` names another one.

    Without a ``name`` drawn pictures that show nobody.
    """

    half: Half
    name: str | None = None
    other: str | None = None


def judgements(names: Sequence[str], half: Half) -> list[Judgement]:
    """All pictures as they are; of each person who stands or is foreign, the front spoilt too."""
    spoilt = [
        name
        for name in names
        if name.endswith(f"_{Kind.STANDING.value}")
        or (name in foreign_names(half) and not name.endswith("s"))
    ]
    others = dict(zip(spoilt, [*spoilt[1:], *spoilt[:1]], strict=True))
    made = [Judgement(half=half, name=name, other=others.get(name)) for name in names]
    return [*made, Judgement(half=half)]


def judged_by(judgement: Judgement) -> list[JudgedFinding]:
    """Every finding that is right or wrong."""
    if judgement.name is None:
        return _judged_nobody(judgement.half)
    name, picture = judgement.name, picture_of(judgement.name)
    decoded = _decoded(picture.request.views[0].image)
    question = CaptureQuestion(
        gender=picture.request.person.gender,
        height_m=picture.request.person.height_m,
        focal_length_px=picture.focal_length_px,
    )
    capture = capture_of(decoded, question, detector=installed_detector())
    judged: list[JudgedFinding] = []
    for form, asked, truth in variants_of(capture, picture):
        found = {each.code for each in check_capture(asked).findings}
        judged += _judged(name, form, found, truth)
    if judgement.other is not None:
        source = Source(picture=decoded.pixels, mask=picture.person_mask, question=question)
        other = _decoded(picture_of(judgement.other).request.views[0].image)
        for form in spoilt_forms(source, other.pixels):
            judged += _judged(name, form.name, _found(form), form.truth)
    if name in CASES and judgement.other is not None:
        judged += _judged_turned(name) + _judged_postures(name)
    return judged


def capture_lines(judged: Sequence[JudgedFinding]) -> list[str]:
    """One line a code; then the misses and false alarms by form."""
    lines = [f"{'code':24s}{'found':>12s}{'false alarms':>16s}"]
    for code in Code:
        of_code = [each for each in judged if each.code is code]
        wrong = [each for each in of_code if each.wrong]
        right = [each for each in of_code if not each.wrong]
        lines.append(f"{code.value:24s}{_count(wrong):>12s}{_count(right):>16s}")
    failures = [each for each in judged if each.found is not each.wrong]
    by_form = Counter((each.wrong, each.code, each.form) for each in failures)
    for (wrong, code, form), count in by_form.items():
        lines.append(f"{'missed' if wrong else 'false'} {count}: {code}, {form}")
    return lines


def _count(these: Sequence[JudgedFinding]) -> str:
    return f"{sum(each.found for each in these)} of {len(these)}"


def _judged(
    name: str, form: str, found: set[Code], truth: Mapping[Code, bool]
) -> list[JudgedFinding]:
    return [
        JudgedFinding(name=name, form=form, code=code, found=code in found, wrong=wrong)
        for code, wrong in truth.items()
    ]


def _found(form: Form) -> set[Code]:
    capture = _capture_of(form.picture, form.question)
    return {each.code for each in check_capture(capture).findings}


def _capture_of(picture: Picture, question: CaptureQuestion) -> Capture:
    decoded = DecodedPicture(
        pixels=np.ascontiguousarray(picture),
        width=picture.shape[1],
        height=picture.shape[0],
        stored_width=picture.shape[1],
        exif=ExifTags(),
        warnings=(),
    )
    return capture_of(decoded, question, detector=installed_detector())


def _judged_turned(name: str) -> list[JudgedFinding]:
    """The person plainly rendered from four sides, each said to be seen from all three views."""
    judged: list[JudgedFinding] = []
    for degrees, seen in SEEN_AT.items():
        picture = plain_picture(CASES[name], turned_deg=degrees)
        capture = _capture_of(picture, CaptureQuestion())
        for view in (ViewKind.FRONT, ViewKind.SIDE, ViewKind.BACK):
            found = {each.code for each in check_capture(replace(capture, view=view)).findings}
            truth = {Code.OTHER_VIEW: view is not seen}
            judged += _judged(name, f"seen from the {seen}, said {view}", found, truth)
    return judged


def _judged_postures(name: str) -> list[JudgedFinding]:
    """The person plainly rendered who sits, crouches, bends over or lies."""
    judged: list[JudgedFinding] = []
    for posture, legs in POSTURES.items():
        stance = replace(CASES[name].stance, **legs)
        for degrees in (0.0, 40.0):
            picture = plain_picture(replace(CASES[name], stance=stance), turned_deg=degrees)
            found = {each.code for each in check_capture(_posed(picture)).findings}
            judged += _judged(name, posture, found, {Code.NOT_STANDING: True})
    lying = np.ascontiguousarray(np.rot90(plain_picture(CASES[name], turned_deg=0.0)))
    found = {each.code for each in check_capture(_posed(lying)).findings}
    return judged + _judged(name, "lying", found, {Code.NOT_STANDING: True})


def _posed(picture: Picture) -> Capture:
    return _capture_of(picture, CaptureQuestion(height_m=1.7))


def _judged_nobody(half: Half) -> list[JudgedFinding]:
    judged: list[JudgedFinding] = []
    for kind, picture in _nobody(half):
        truth = {Code.NOBODY_FOUND: True}
        form = Form(name=kind, picture=picture, question=CaptureQuestion(), truth=truth)
        judged += _judged(kind, kind, _found(form), truth)
    return judged


def _decoded(image: bytes) -> DecodedPicture:
    return decode_picture(image, field="image", max_pixels=MAX_PIXELS)


def _nobody(half: Half) -> Iterator[tuple[str, Picture]]:
    for number in range(OF_EACH_KIND):
        rng = np.random.default_rng([5, number, half is Half.TUNING])
        yield "hills", hills(rng)
        yield "a disc", one_shape(rng, disc)[0]
        yield "a slab", one_shape(rng, slab)[0]
        yield "a dog", dog_picture(rng)[0]
        yield (
            "noise",
            coded(128.0 + 45.0 * np.stack([smooth_noise(rng, 3.0) for _ in range(3)], axis=-1)),
        )

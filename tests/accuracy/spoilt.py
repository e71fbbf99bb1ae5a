"""People in spoilt pictures: things in the way, cropped, told wrongly, blurred, dark, seated.

One picture of each person who stands, spoilt in one way each. The camera's focal length is told, so
that it is not a fault of its own. What hides a point makes a click there a guess.
"""

import io
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from PIL import Image as PillowImage

from fitter.errors import FitterError
from fitter.fits.pipeline import fit
from fitter.observation.decoding import decode_picture
from fitter.request import Click, FitRequest, KnownMeasurement
from fitter.vocabulary.choices import Cues
from fitter.vocabulary.measurements import STATURE
from fitter.vocabulary.remarks import Severity
from tests.accuracy.cases import CASES
from tests.accuracy.clicks import noisy_clicks
from tests.accuracy.people import load_person
from tests.accuracy.people_table import PEOPLE
from tests.accuracy.runs import picture_of
from tests.accuracy.scene import Leg
from tests.accuracy.scoring import errors_of, standard_errors_of
from tests.accuracy.spoiling import (
    Occlude,
    Picture,
    Scene,
    arm_across_the_waist,
    bag_beside_the_trunk,
    blurred,
    box_before_the_hips,
    cropped,
    exposed,
    neighbour_behind,
    neighbour_in_front,
    table_before_the_legs,
)
from tests.accuracy.staging import camera_of, plain_picture, rendering, stage
from tests.accuracy.table import MEASUREMENTS, error_heading, error_line
from tests.accuracy.true_picture import VISIBLE, TruePicture
from tests.one_picture import changed

MAX_PIXELS = 50_000_000
QUALITY, POOR_QUALITY = 92, 40

AS_THEY_ARE = "as they are"

OCCLUDED: Mapping[str, Occlude] = {
    "box before the hips": box_before_the_hips,
    "table before the legs": table_before_the_legs,
    "bag beside the trunk": bag_beside_the_trunk,
    "arm across the waist": arm_across_the_waist,
    "neighbour behind": neighbour_behind,
    "neighbour in front": neighbour_in_front,
}

BESIDE_ANOTHER = ("neighbour behind", "neighbour in front")

CROPPED: Mapping[str, float] = {
    "without the feet": 0.93,
    "without the shins": 0.72,
    "without the legs": 0.52,
}
"""The share of the person's height that is left."""

TAKEN: Mapping[str, Callable[[Picture], Picture]] = {
    "a twentieth of the light": lambda it: exposed(it, factor=0.05),
    "five times the light": lambda it: exposed(it, factor=5.0),
    "blurred by 4 px": lambda it: blurred(it, deviation_px=4.0),
}

TOLD: Mapping[str, Callable[[FitRequest], FitRequest]] = {
    "lens 25 % too short": lambda request: _with_lens(request, 0.75),
    "lens 25 % too long": lambda request: _with_lens(request, 1.25),
    "height 3 cm too low": lambda request: _with_height(request, -0.03),
    "height 3 cm too high": lambda request: _with_height(request, +0.03),
    "height 3 cm too low, ± 2": lambda request: _with_doubtful_height(request, -0.03, 2.0),
}
"""What is told wrongly, of the pictures as they are."""

JPEG, SEATED = f"JPEG {POOR_QUALITY}", "seated"

KINDS = (AS_THEY_ARE, *OCCLUDED, *CROPPED, *TOLD, JPEG, *TAKEN, SEATED)

SEATED_LEG = Leg(raised=85.0, forward=80.0, bend=85.0, toe_out=0.0)

COMPARED = [each for each in MEASUREMENTS if each[0] != "navel"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Asked:
    """A picture by name, how it is spoilt, whose picture stands beside, and its points."""

    picture: str
    other: str
    kind: str
    proposed: bool
    seed: int


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Measured:
    """What came of a spoilt picture; ``errors`` are empty where it was refused.

    ``findings`` are codes of what harms or blocks; ``withheld`` says whether the verdict withholds
    the measurements, which are shown here all the same.
    """

    asked: Asked
    person: str
    errors: Mapping[str, float]
    standard_errors: Mapping[str, float]
    findings: tuple[str, ...]
    withheld: bool


def asked_spoilt(names: Sequence[str], kinds: Sequence[str]) -> list[Asked]:
    """Every picture in every way, with clicks and with proposals."""
    others = [*names[1:], *names[:1]]
    return [
        Asked(picture=name, other=other, kind=kind, proposed=proposed, seed=seed)
        for kind in kinds
        for proposed in (False, True)
        for seed, (name, other) in enumerate(zip(names, others, strict=True))
    ]


def measured(asked: Asked) -> Measured:
    """Fit a spoilt picture with shading."""
    picture = picture_of(asked.picture)
    request = changed(spoilt_request(picture, asked), cues=Cues.SES, force=True)
    if asked.proposed:
        # Where there are two, the caller has to say who is meant.
        told = {"nose"} if asked.kind in BESIDE_ANOTHER else set[str]()
        clicks = request.views[0].clicks
        kept = {name: clicks[name] for name in told & clicks.keys()}
        request = changed(request, clicks=kept, complete_clicks=True)
    try:
        result = fit(request)
    except FitterError as error:
        return Measured(
            asked=asked,
            person=picture.person,
            errors={},
            standard_errors={},
            findings=(str(getattr(error, "code", "refused")),),
            withheld=True,
        )
    return Measured(
        asked=asked,
        person=picture.person,
        errors=errors_of(result, picture.truth),
        standard_errors=standard_errors_of(result),
        findings=tuple(
            each.code
            for each in result.found.findings
            if each.severity in (Severity.HARMS, Severity.BLOCKS)
        ),
        withheld=not result.found.is_plausible,
    )


def spoilt_request(picture: TruePicture, asked: Asked) -> FitRequest:
    """The request of a picture spoilt in one way."""
    request = changed(
        picture.request, focal_length_px=picture.focal_length_px, focal_length_35mm=None
    )
    if asked.kind == AS_THEY_ARE:
        return request
    if asked.kind in TOLD:
        return TOLD[asked.kind](request)
    if asked.kind == SEATED:
        return _seated(request, asked.picture)
    pixels = _pixels(picture)
    if asked.kind == JPEG:
        return changed(request, image=_coded(pixels, POOR_QUALITY))
    if asked.kind in OCCLUDED:
        return _occluded(request, picture, asked)
    if asked.kind in TAKEN:
        return changed(request, image=_coded(TAKEN[asked.kind](pixels), QUALITY))
    made = cropped(pixels, picture.person_mask, bottom=CROPPED[asked.kind])
    kept = {name: each for name, each in request.views[0].clicks.items() if each.y < len(made)}
    return changed(request, image=_coded(made, QUALITY), clicks=kept)


def _occluded(request: FitRequest, picture: TruePicture, asked: Asked) -> FitRequest:
    other = picture_of(asked.other)
    spoilt = OCCLUDED[asked.kind](
        Scene(
            pixels=_pixels(picture),
            true=picture,
            other_pixels=_pixels(other),
            other=other,
            seed=asked.seed,
        )
    )
    rows, columns = spoilt.hidden.shape
    clicks = {
        name: replace(
            each,
            occluded=each.occluded
            or bool(spoilt.hidden[min(int(each.y), rows - 1), min(int(each.x), columns - 1)]),
        )
        for name, each in request.views[0].clicks.items()
    }
    return changed(request, image=_coded(spoilt.pixels, QUALITY), clicks=clicks)


def _seated(request: FitRequest, name: str) -> FitRequest:
    """Rendered plainly, with points as they would be clicked there."""
    case = CASES[name]
    case = replace(case, stance=replace(case.stance, left_leg=SEATED_LEG, right_leg=SEATED_LEG))
    staged = stage(load_person(PEOPLE[case.person]), case)
    points = noisy_clicks(staged, rendering(staged), np.random.default_rng(case.seed))
    return changed(
        request,
        image=_coded(plain_picture(case, turned_deg=0.0), QUALITY),
        focal_length_px=camera_of(case.view).focal_length_px,
        clicks={
            name: Click(x=each["x"], y=each["y"], occluded=each["visibility"] < VISIBLE)
            for name, each in points.items()
        },
    )


def _pixels(picture: TruePicture) -> np.ndarray:
    image = picture.request.views[0].image
    return decode_picture(image, field="image", max_pixels=MAX_PIXELS).pixels


def _coded(pixels: np.ndarray, quality: int) -> bytes:
    stream = io.BytesIO()
    PillowImage.fromarray(pixels).save(stream, "JPEG", quality=quality)
    return stream.getvalue()


def _with_lens(request: FitRequest, factor: float) -> FitRequest:
    focal = request.views[0].focal_length_px
    assert focal is not None
    return changed(request, focal_length_px=factor * focal)


def _with_doubtful_height(request: FitRequest, metres: float, error_cm: float) -> FitRequest:
    """With the height as a measurement that has a standard error, as MEASURING.md advises."""
    height = request.person.height_m
    assert height is not None
    stature = KnownMeasurement(value=round(100.0 * (height + metres), 1), standard_error=error_cm)
    return changed(request, height_m=None, measurements={STATURE: stature})


def _with_height(request: FitRequest, metres: float) -> FitRequest:
    height = request.person.height_m
    assert height is not None
    return changed(request, height_m=round(height + metres, 3))


def spoilt_heading() -> str:
    """The heading above :func:`spoilt_lines`."""
    return f"{error_heading('kind', COMPARED)}{'withheld':>9s}  findings"


def spoilt_lines(found: Sequence[Measured]) -> list[str]:
    """One line a kind, with clicks and with proposals; of what is withheld nothing counts."""
    rows: dict[str, list[Measured]] = {}
    for each in found:
        points = "proposed" if each.asked.proposed else "clicked"
        rows.setdefault(f"{each.asked.kind:26s}{points}", []).append(each)
    lines: list[str] = []
    for row, these in rows.items():
        shown = [each for each in these if not each.withheld]
        counts = Counter(code for each in these for code in each.findings)
        said = ", ".join(f"{code} {count}" for code, count in counts.most_common())
        line = error_line(row, shown, places=1, measurements=COMPARED)
        lines.append(f"{line}{len(these) - len(shown):9d}  {said}".rstrip())
    return lines

"""Small pictures that were once measured wrongly, beside the repository in ../shared/data/cases."""

import io
import json
from functools import cache

import pytest
from PIL import Image as PillowImage

from fitter.capture.checking import check_capture
from fitter.detection.detector import installed_detector
from fitter.fits.capture_check import CaptureQuestion, capture_of
from fitter.fits.pipeline import fit
from fitter.fits.reporting import turned_deg
from fitter.observation.decoding import decode_picture
from fitter.result import FitResult
from fitter.vocabulary.choices import Cues, Gender
from fitter.vocabulary.outcomes import Verdict
from fitter.vocabulary.remarks import Code, Severity
from service.demo_data.sample import load_sample
from tests.one_picture import one_picture
from tests.shared_data import SHARED_DATA, needs_shared

CASES, DRESSED = SHARED_DATA / "cases", SHARED_DATA / "dressed"

pytestmark = [pytest.mark.slow, needs_shared(CASES), needs_shared(DRESSED)]


@cache
def measured(name: str, person: str | None) -> FitResult:
    """Fit of a picture by the points that are proposed, of a dressed person or of a woman."""
    said = {"gender": "female"}
    if person is not None:
        said = json.loads((DRESSED / person / "request.json").read_text())
    known = {key: said.get(key) for key in ("height_m", "focal_length_px", "focal_length_35mm")}
    return fit(
        one_picture(
            image=(CASES / name).read_bytes(),
            clicks={},
            complete_clicks=True,
            cues=Cues.SE,
            gender=Gender(said["gender"]),
            **known,
        )
    )


def asked(name: str) -> dict[Code, Severity]:
    """What is said of the picture before a fit."""
    picture = decode_picture((CASES / name).read_bytes(), field="image", max_pixels=10**7)
    checked = check_capture(capture_of(picture, CaptureQuestion(), detector=installed_detector()))
    return {each.code: each.severity for each in checked.findings}


def found(result: FitResult) -> dict[Code, Severity]:
    return {each.code: each.severity for each in result.views[0].findings}


@pytest.mark.parametrize("hidden_by", ["black", "emoji", "phone", "white"])
def test_a_hidden_face_turns_nobody_round_and_is_told(hidden_by):
    name = f"face_hidden/dr_v01_{hidden_by}.jpg"
    result = measured(name, "v01")
    assert turned_deg(result.found.person.body) < 45.0
    assert Code.FACE_HIDDEN in found(result)
    assert Code.FACE_HIDDEN in asked(name)
    truth = json.loads((DRESSED / "v01" / "truth.json").read_text())["measurements"]
    each = next(each for each in result.measurements if each.name == "weight")
    assert each.standard_error is not None
    assert abs(each.value - truth["weight_kg"]["value"]) < 1.96 * each.standard_error


def test_the_telephone_of_a_mirror_selfie_does_neither():
    result = measured("face_hidden/v_phone_before_face.jpg", None)
    assert turned_deg(result.found.person.body) < 45.0
    assert Code.FACE_HIDDEN in found(result)
    assert Code.FACE_HIDDEN not in asked("face_hidden/v_base.jpg")


def test_who_is_cut_off_at_the_thighs_is_no_child_before_a_fit_or_after():
    name = "child_half_length/childr_26_1.0_1.18.jpg"
    result = measured(name, None)
    assert result.found.verdict is Verdict.PLAUSIBLE
    for each in (asked(name), found(result)):
        assert Code.CHILD not in each
        assert each[Code.CUT_OFF] is Severity.HARMS


@pytest.mark.parametrize(("height", "is_told"), [(1.3, True), (1.0, False), (0.75, True)])
def test_a_squeezed_or_stretched_picture_is_told_and_its_errors_are_wider(height, is_told):
    sample = load_sample()
    picture = PillowImage.open(io.BytesIO(sample.image)).convert("RGB")
    squeezed = io.BytesIO()
    picture.resize((picture.width, round(height * picture.height))).save(squeezed, "PNG")
    said = json.loads(sample.request)
    result = fit(
        one_picture(
            image=squeezed.getvalue(),
            clicks={},
            complete_clicks=True,
            cues=Cues.SE,
            gender=Gender(said["gender"]),
            height_m=said["height_m"],
            force=True,
        )
    )
    assert (Code.SQUEEZED in found(result)) == is_told
    weight = next(each for each in result.measurements if each.name == "weight")
    assert weight.standard_error is not None
    assert (weight.standard_error > 10.0) == is_told


@pytest.mark.parametrize(
    ("couple", "person"),
    [("v01v02_0.55", "v01"), ("v03v06_0.55", "v03"), ("v03v06_0.55_stone", "v03")],
)
def test_two_people_of_whom_one_is_half_behind_the_other_are_not_measured_as_one(couple, person):
    name = f"couple_half_length/couple_{couple}_thigh.jpg"
    result = measured(name, person)
    assert result.measurements == ()
    for each in (asked(name), found(result)):
        assert each[Code.SEVERAL_PEOPLE] is Severity.BLOCKS

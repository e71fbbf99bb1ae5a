"""How findings are counted, and what spoils pictures."""

import numpy as np
import pytest

from fitter.fits.capture_check import CaptureQuestion
from fitter.observation.pixels import linear_from_display
from fitter.vocabulary.remarks import Code
from tests.accuracy.capture_forms import (
    Source,
    cropped,
    cropped_aside,
    exposed,
    far_away,
    reduced,
    rolled,
    shaken,
    spoilt_forms,
)
from tests.accuracy.capture_table import JudgedFinding, capture_lines


def source() -> Source:
    """A bright person of 200 x 50 pixels in a picture of 300 x 200."""
    mask = np.zeros((300, 200), bool)
    mask[40:240, 80:130] = True
    picture = np.where(mask[..., None], 180, 60).repeat(3, axis=2).astype(np.uint8)
    return Source(picture=picture, mask=mask, question=CaptureQuestion(focal_length_px=900.0))


def judged(code: Code, *, found: bool, wrong: bool, form: str = "as it is") -> JudgedFinding:
    return JudgedFinding(name="somebody", form=form, code=code, found=found, wrong=wrong)


def test_found_and_false_alarms_are_counted_apart_and_failures_by_form():
    lines = capture_lines(
        [
            judged(Code.BLURRED, found=True, wrong=True),
            judged(Code.BLURRED, found=False, wrong=True, form="shaken"),
            judged(Code.BLURRED, found=False, wrong=True, form="shaken"),
            judged(Code.BLURRED, found=True, wrong=False),
            judged(Code.BLURRED, found=False, wrong=False),
        ]
    )
    (row,) = [line for line in lines if line.startswith("blurred")]
    assert row.split() == ["blurred", "1", "of", "3", "1", "of", "2"]
    assert lines[-2:] == ["missed 2: blurred, shaken", "false 1: blurred, as it is"]


def test_every_form_says_what_is_to_be_found_and_no_form_knows_the_lens():
    forms = spoilt_forms(source(), source().picture)
    assert len({form.name for form in forms}) == len(forms)
    for form in forms:
        assert len(form.truth) == 1
        assert form.question.focal_length_px is None


def test_crops_cut_through_the_person():
    whole = source()
    assert len(cropped(whole, top=0.1)) == 300 - 60
    assert len(cropped(whole, bottom=0.75)) == 40 + 150
    assert cropped_aside(whole).shape[1] == 200 - 88


def test_a_person_becomes_as_small_as_was_said():
    assert reduced(source(), stature_px=100.0).shape[:2] == (150, 100)
    far = far_away(source(), stature_px=100.0)
    rows = np.flatnonzero((far[..., 0] > 120).any(axis=1))
    assert len(rows) == pytest.approx(100, abs=2)
    assert far.shape[0] == far.shape[1] > 600


def test_light_is_scaled_as_light():
    wall = linear_from_display(exposed(source(), factor=0.2)[:30] / 255.0)
    assert wall.mean() == pytest.approx(0.2 * linear_from_display(np.array(60 / 255.0)), rel=0.05)
    assert exposed(source(), factor=20.0).max() == 255


def test_a_roll_turns_clockwise_or_not_and_a_shake_smears_along_its_way():
    turned = rolled(source(), degrees=15.0)
    top, bottom = (np.flatnonzero(turned[row, :, 0] > 120).mean() for row in (90, 210))
    assert abs(top - bottom) > 20
    sideways, upright = (shaken(source(), length_px=9, sideways=each) for each in (True, False))
    assert 60 < sideways[140, 82, 0] < 180
    assert upright[140, 82, 0] == 180

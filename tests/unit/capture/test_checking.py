"""All checks together."""

from dataclasses import replace

import cv2
import numpy as np

from fitter.capture.checking import check_capture
from fitter.vocabulary.choices import ViewKind
from fitter.vocabulary.outcomes import SeenFrom
from fitter.vocabulary.remarks import Code, Severity
from tests.unit.capture.made_up import by_points_alone, capture, of_nobody, person


def test_nothing_is_wrong_with_a_good_picture_and_everything_was_checked():
    checked = check_capture(capture(view=ViewKind.FRONT))
    assert (checked.findings, checked.unchecked, checked.usable) == ((), (), True)
    assert checked.seen is SeenFrom.FRONT
    assert checked.box is not None
    # The head's top is drawn at 44, in a working picture of half the size.
    assert checked.box[1] == 2 * 44.0


def test_what_blocks_comes_first_and_makes_a_picture_useless():
    dark = (0.05 * capture().picture).astype(np.uint8)
    checked = check_capture(capture(view=ViewKind.SIDE, picture=dark))
    assert [each.severity for each in checked.findings] == [Severity.BLOCKS, Severity.HARMS]
    assert [each.code for each in checked.findings] == [Code.OTHER_VIEW, Code.TOO_DARK]
    assert not checked.usable


def test_what_only_harms_leaves_a_picture_usable():
    blurred = cv2.GaussianBlur(capture().picture, (0, 0), 2.5)
    checked = check_capture(capture(picture=blurred))
    assert [each.code for each in checked.findings] == [Code.BLURRED]
    assert checked.usable


def test_every_check_is_made_or_said_not_to_be():
    """By points alone, and of somebody of whom nothing but the face is known; not of nobody."""
    face = {name: at for name, at in by_points_alone().points.items() if "eye" in name}
    for nothing, expected in (
        (by_points_alone(), {Code.NOBODY_FOUND, Code.SEVERAL_PEOPLE, Code.ARMS_AGAINST_TRUNK,
                             Code.FACE_HIDDEN, Code.CLOTHES_LOOSE, Code.NOT_STANDING, Code.CHILD}),
        (of_nobody(view=ViewKind.FRONT), set()),
        (by_points_alone(view=ViewKind.FRONT, points=face),
         {Code.NOBODY_FOUND, Code.SEVERAL_PEOPLE, Code.ARMS_AGAINST_TRUNK, Code.CLOTHES_LOOSE,
          Code.NOT_STANDING, Code.CHILD, Code.FACE_HIDDEN,
          Code.PERSON_TOO_SMALL, Code.OTHER_VIEW, Code.CAMERA_ROLLED, Code.CAMERA_TOO_NEAR}),
    ):  # fmt: skip
        unchecked = check_capture(nothing).unchecked
        assert {each.code for each in unchecked} == expected
        assert all(each.reason.endswith(".") for each in unchecked)


def test_of_nobody_only_what_is_wrong_with_the_picture_is_found():
    checked = check_capture(of_nobody())
    assert [each.code for each in checked.findings] == [Code.NOBODY_FOUND]
    assert (checked.box, checked.seen, checked.lean_deg, checked.distance_m) == (None,) * 4
    black = of_nobody(picture=np.zeros_like(capture().picture))
    assert {each.code for each in check_capture(black).findings} == {
        Code.NOBODY_FOUND,
        Code.TOO_DARK,
    }


def test_every_finding_says_what_was_measured_and_what_to_do():
    spoilt = replace(
        capture(person(), person(), view=ViewKind.BACK, focal_length_px=300.0),
        picture=cv2.GaussianBlur((0.1 * capture().picture).astype(np.uint8), (0, 0), 3.0),
    )
    findings = check_capture(spoilt).findings
    assert {each.code for each in findings} >= {
        Code.SEVERAL_PEOPLE,
        Code.OTHER_VIEW,
        Code.CAMERA_TOO_NEAR,
        Code.TOO_DARK,
    }
    for found in findings:
        assert any(sign.isdigit() for sign in found.reason), found.code
        assert found.reason.endswith(".")
        assert found.remedy.endswith(".")

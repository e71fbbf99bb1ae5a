"""Nobody, one or several people."""

from dataclasses import replace

import numpy as np
import pytest

from fitter.capture.people import face, nobody_else, proportions, somebody
from fitter.detection.person_detector import DetectedFace
from fitter.request import Click
from fitter.vocabulary.remarks import Code, Severity
from tests.unit.capture.made_up import by_points_alone, capture, is_unchecked, of_nobody, person


def test_one_person_is_what_is_wanted():
    assert somebody(capture()) is None
    assert nobody_else(capture()) is None


def test_a_picture_of_nobody_blocks():
    found = somebody(of_nobody())
    assert found is not None
    assert (found.code, found.severity) == (Code.NOBODY_FOUND, Severity.BLOCKS)
    assert nobody_else(of_nobody()) is None


def test_somebody_who_is_not_where_the_points_lie_is_nobody():
    elsewhere = capture(points={"nose": Click(x=1.0, y=1.0)}, body=None)
    found = somebody(elsewhere)
    assert found is not None
    assert "where the points lie" in found.reason


def test_in_a_fit_of_clicked_points_nobody_else_has_to_see_a_person():
    elsewhere = capture(points={"nose": Click(x=1.0, y=1.0)}, body=None)
    assert not elsewhere.shows_somebody
    fitted = replace(elsewhere, directions={})
    found = somebody(fitted)
    assert found is not None
    assert (found.code, found.severity) == (Code.NOBODY_FOUND, Severity.HARMS)
    assert fitted.shows_somebody


def test_another_person_is_told_with_their_place_unless_the_caller_chose():
    two = capture(person(), person())
    found = nobody_else(two)
    assert found is not None
    assert (found.code, found.severity) == (Code.SEVERAL_PEOPLE, Severity.HARMS)
    assert found.reason.startswith("2 people")
    assert nobody_else(replace(two, is_chosen=True)) is None


def test_who_cannot_be_told_from_somebody_else_is_not_measured_by_proposals():
    alone = person()
    mask = alone.mask.copy()
    seen = np.flatnonzero(mask.any(axis=1))
    mask[seen[0] : seen[len(seen) // 2]] *= 0.5
    muddled = capture(replace(alone, mask=mask), points={"nose": Click(x=1.0, y=1.0)})
    found = nobody_else(muddled)
    assert found is not None
    assert (found.code, found.severity) == (Code.SEVERAL_PEOPLE, Severity.BLOCKS)
    assert nobody_else(replace(muddled, is_clicked=True)) is None


def test_without_a_detector_neither_is_known():
    for check in (somebody, nobody_else):
        assert is_unchecked(check(by_points_alone()))


def test_two_faces_where_one_person_is_found_are_two_people():
    faces = tuple(DetectedFace(score=0.9, middle=np.array([x, 76.0])) for x in (200.0, 250.0))
    found = nobody_else(capture(replace(person(), faces=faces)))
    assert found is not None
    assert (found.code, found.severity) == (Code.SEVERAL_PEOPLE, Severity.BLOCKS)
    assert nobody_else(capture(replace(person(), faces=faces), is_clicked=True)) is None
    # The other face is that of somebody who was found beside them, and the caller has chosen.
    beside = person(nose=(250.0, 76.0))
    assert nobody_else(capture(replace(person(), faces=faces), beside, is_chosen=True)) is None


def test_a_hidden_face_is_told():
    assert face(capture()) is None
    found = face(capture(replace(person(), hides_face=True)))
    assert found is not None
    assert (found.code, found.severity) == (Code.FACE_HIDDEN, Severity.HARMS)


def test_eyes_far_apart_are_a_child_s_where_the_stature_is_seen():
    apart = person(left_eye=(216.0, 72.0), right_eye=(184.0, 72.0))
    found = proportions(capture(apart))
    assert found is not None
    assert (found.code, found.severity) == (Code.CHILD, Severity.BLOCKS)


@pytest.mark.parametrize("guessed", [("left_ankle", "right_ankle"), ("left_eye",)])
def test_of_a_stature_or_eyes_that_are_guessed_nothing_is_said_before_a_fit_or_after(guessed):
    apart = person(left_eye=(216.0, 72.0), right_eye=(184.0, 72.0))
    points = {name: replace(each, occluded=name in guessed) for name, each in apart.points.items()}
    hidden = capture(replace(apart, points=points))
    upright = {"trunk": np.array([0.0, -1.0, 0.0])}
    upright |= {
        f"{side}_{limb}": np.array([0.0, 1.0, 0.0])
        for side in ("left", "right")
        for limb in ("thigh", "shin")
    }
    for each in (hidden, replace(hidden, directions=upright)):
        assert is_unchecked(proportions(each))

"""How a person stands in the picture, and from where it was taken."""

import math

import cv2
import numpy as np
import pytest

from fitter.capture.framing import (
    BLOCKING_STATURE_PX,
    LEAST_STATURE_PX,
    MOST_ROLLED_DEG,
    NEAREST_M,
    camera_distance_m,
    distance,
    lean_deg,
    picture_size,
    roll,
    size,
    wholeness,
)
from fitter.vocabulary.remarks import Code, Severity
from tests.unit.capture.made_up import (
    FRONT,
    STATURE_PX,
    by_points_alone,
    capture,
    is_finding,
    is_unchecked,
    person,
)


def test_somebody_whole_is_not_cut_off():
    assert wholeness(capture()) is None
    assert wholeness(by_points_alone()) is None


@pytest.mark.parametrize(
    ("missing", "parts", "severity"),
    [
        (("left_toe",), "left foot", Severity.HARMS),
        (("nose", "left_eye", "right_eye", "left_ear", "right_ear"), "head", Severity.HARMS),
        (("right_wrist",), "right arm", Severity.HARMS),
        (("left_ankle", "left_toe"), "left leg, left foot", Severity.HARMS),
        (("left_shoulder",), "trunk", Severity.BLOCKS),
        (("left_hip", "right_hip"), "trunk", Severity.BLOCKS),
    ],
)
def test_parts_that_are_not_in_the_picture_are_named(missing, parts, severity):
    found = person()
    for name in missing:
        found.points.pop(name)
    told = wholeness(capture(found))
    assert told is not None
    assert told.reason.endswith(f": {parts}.")
    assert (told.severity, set(told.where)) == (severity, set(missing))


@pytest.mark.parametrize(
    ("rows", "columns", "part"),
    [
        (slice(0, 60), slice(180, 220), "head"),
        (slice(570, 640), slice(240, 250), "left foot"),
        (slice(280, 300), slice(0, 60), "right arm"),
        (slice(280, 300), slice(340, 400), "left arm"),
    ],
)
def test_where_the_outline_reaches_the_border_the_nearest_part_is_cut_off(rows, columns, part):
    found = person()
    found.mask[rows, columns] = 1.0
    told = wholeness(capture(found))
    assert told is not None
    assert told.reason.endswith(f": {part}.")


def test_points_that_were_not_clicked_are_not_cut_off_but_points_at_the_border_are():
    some = {name: at for name, at in by_points_alone().points.items() if "left" in name}
    assert wholeness(by_points_alone(points=some)) is None
    at_border = by_points_alone(points=some | {"nose": some["left_eye"].__class__(x=5.0, y=0.5)})
    assert is_finding(wholeness(at_border))


@pytest.mark.parametrize(
    ("stature_px", "severity"),
    [
        (LEAST_STATURE_PX + 1, None),
        (LEAST_STATURE_PX - 1, Severity.HARMS),
        (BLOCKING_STATURE_PX + 1, Severity.HARMS),
        (BLOCKING_STATURE_PX - 1, Severity.BLOCKS),
    ],
)
def test_a_person_is_too_small_below_so_many_pixels(stature_px, severity):
    shrink = stature_px / STATURE_PX
    small = person()
    for name, click in list(small.points.items()):
        small.points[name] = click.__class__(x=200 + shrink * (click.x - 200), y=shrink * click.y)
    told = size(capture(small))
    if severity is None:
        assert told is None
        return
    assert told is not None
    assert (told.code, told.severity) == (Code.PERSON_TOO_SMALL, severity)
    # In pixels of the original, which is twice as large.
    assert f"{2 * stature_px:.0f} pixels tall" in told.reason


def test_where_the_picture_itself_is_too_small_that_is_told_instead():
    whole = capture()
    small = cv2.resize(whole.picture, (150, 240), interpolation=cv2.INTER_AREA)
    shrunk = person(**{name: (0.375 * x, 0.375 * y) for name, (x, y) in _places().items()})
    tiny = capture(shrunk, picture=small, width=150, height=240, scale=1.0)
    assert size(tiny) is None
    told = picture_size(tiny)
    assert told is not None
    assert told.code == Code.PICTURE_TOO_SMALL
    assert "150 x 240" in told.reason
    assert picture_size(whole) is None


def test_of_a_face_alone_the_stature_is_not_known():
    face = {name: at for name, at in by_points_alone().points.items() if "eye" in name}
    assert is_unchecked(size(by_points_alone(points=face)))


def _places() -> dict[str, tuple[float, float]]:
    return {name: (click.x, click.y) for name, click in person().points.items()}


def test_without_legs_the_stature_is_that_of_the_detector_s_circle():
    trunk = person()
    for name in [each for each in trunk.points if "ankle" in each]:
        trunk.points.pop(name)
    tall = capture(trunk).stature_px
    assert tall == pytest.approx(290.0 / 0.54)
    assert capture().stature_px == pytest.approx(STATURE_PX, rel=0.01)
    assert np.isfinite(tall)


def rolled(degrees: float) -> dict[str, tuple[float, float]]:
    """The person's points turned clockwise about the hips."""
    angle = math.radians(degrees)
    cosine, sine = math.cos(angle), math.sin(angle)
    return {
        name: (
            200 + cosine * (x - 200) - sine * (y - 290),
            290 + sine * (x - 200) + cosine * (y - 290),
        )
        for name, (x, y) in FRONT.items()
    }


@pytest.mark.parametrize("degrees", [-170.0, -20.0, 0.0, 5.0, 12.0, 90.0])
def test_a_roll_of_the_camera_leans_whoever_stands(degrees):
    assert lean_deg(capture(person(**rolled(degrees)))) == pytest.approx(degrees, abs=0.01)


def test_more_than_so_many_degrees_are_told_with_their_side():
    within, beyond = MOST_ROLLED_DEG - 0.5, MOST_ROLLED_DEG + 1.0
    assert roll(capture(person(**rolled(within)))) is None
    found = roll(capture(person(**rolled(beyond))))
    assert found is not None
    assert (found.code, "to the right" in found.reason) == (Code.CAMERA_ROLLED, True)
    other = roll(capture(person(**rolled(-beyond))))
    assert other is not None
    assert "to the left" in other.reason


def test_whoever_bends_or_sits_tells_nothing_of_the_camera():
    bent = {name: (x + 120, y) for name, (x, y) in FRONT.items() if "shoulder" in name}
    assert is_unchecked(roll(capture(person(**bent))))


def test_the_distance_follows_from_lens_and_stature():
    """By similar triangles: f / distance = pixels / metres."""
    assert camera_distance_m(capture()) == pytest.approx(900.0 * 1.7 / STATURE_PX, rel=0.01)
    near = 0.9 * NEAREST_M * STATURE_PX / 1.7
    for make in (capture, by_points_alone):
        assert distance(make()) is None
        found = distance(make(focal_length_px=near))
        assert found is not None
        assert (found.code, "1.4 m from" in found.reason) == (Code.CAMERA_TOO_NEAR, True)


def test_without_a_focal_length_or_a_stature_nobody_knows_the_distance():
    for unknown in (
        capture(focal_length_px=None),
        by_points_alone(points={"nose": person().points["nose"]}),
    ):
        told = distance(unknown)
        assert is_unchecked(told)
        assert told.code == Code.CAMERA_TOO_NEAR
    assert np.isfinite(NEAREST_M)

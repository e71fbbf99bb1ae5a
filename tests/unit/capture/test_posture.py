"""Posture: standing, turned, arms at the trunk; and loose clothes."""

import math
from dataclasses import replace

import cv2
import numpy as np
import pytest

from fitter.capture.clothes import clothes, clothing_guess
from fitter.capture.people import proportions
from fitter.capture.posture import (
    announced_view,
    arms,
    detected_directions,
    facing,
    free_share,
    posture,
    seen_from,
)
from fitter.detection.detector import DetectedBody, LimbSlant
from fitter.vocabulary.choices import BodyRegion, Clothing, Covering, ViewKind
from fitter.vocabulary.outcomes import SeenFrom, WornRegion
from fitter.vocabulary.remarks import Code, Severity
from tests.unit.capture.made_up import (
    FRONT,
    by_points_alone,
    capture,
    is_finding,
    is_unchecked,
    person,
)

UP, DOWN, AWAY = np.array([[0.0, -1.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0]])
ACROSS = np.array([1.0, 0.0, 0.0])


def posed(trunk: np.ndarray, thighs: np.ndarray, shins: np.ndarray) -> dict[str, np.ndarray]:
    limbs = {"thigh": thighs, "shin": shins}
    sided = {f"{side}_{limb}": at for side in ("left", "right") for limb, at in limbs.items()}
    return {"trunk": trunk, **sided}


def tilted(degrees: float) -> np.ndarray:
    """From downward toward the camera."""
    angle = np.radians(degrees)
    return np.cos(angle) * DOWN + np.sin(angle) * AWAY


@pytest.mark.parametrize(
    ("directions", "severity", "said"),
    [
        (posed(UP, tilted(85.0), DOWN), Severity.BLOCKS, "sits or crouches"),
        (posed(UP, tilted(85.0), tilted(80.0)), Severity.BLOCKS, "sits or bends the hips"),
        (posed(ACROSS, DOWN, DOWN), Severity.BLOCKS, "bends over"),
        (posed(UP, DOWN, tilted(-90.0)), Severity.BLOCKS, "kneels"),
        (posed(ACROSS, -ACROSS, -ACROSS), Severity.BLOCKS, "lies"),
        (posed(UP, tilted(42.0), tilted(40.0)), Severity.HARMS, "sits or bends the hips"),
        (posed(UP, tilted(25.0), tilted(7.0)), Severity.HARMS, "sits or crouches"),
        (posed(UP, tilted(31.0), tilted(6.0)), Severity.BLOCKS, "sits or crouches"),
    ],
)
def test_who_does_not_stand_is_told(directions, severity, said):
    told = posture(capture(directions=directions))
    assert told is not None
    assert (told.code, told.severity) == (Code.NOT_STANDING, severity)
    assert said in told.reason
    assert told.remedy


def test_who_stands_or_lifts_one_leg_stands():
    straight = posed(UP, DOWN, DOWN)
    assert posture(capture(directions=straight)) is None
    assert posture(capture(directions=posed(UP, tilted(15.0), tilted(-5.0)))) is None
    assert posture(capture(directions={**straight, "left_thigh": tilted(90.0)})) is None


def seen(sine: float) -> DetectedBody:
    """The person with thighs that slant so far from the picture, as a detector tells it."""
    body = person()
    limbs = {f"{side}_thigh": LimbSlant(sine=sine, sigma=0.1) for side in ("left", "right")}
    return replace(body, slants=replace(body.slants, limbs=limbs))


def test_before_a_fit_the_detectors_slants_tell():
    assert posture(capture(seen(0.1))) is None
    told = posture(capture(seen(-0.95)))
    assert told is not None
    assert told.severity is Severity.BLOCKS
    for direction in detected_directions(capture(seen(-0.95))).values():
        assert np.linalg.norm(direction) == pytest.approx(1.0)


def test_of_a_fit_the_detector_is_asked_too():
    """A body would rather stand than sit toward the camera."""
    told = posture(capture(seen(-0.95), directions=posed(UP, DOWN, DOWN)))
    assert told is not None
    assert told.severity is Severity.BLOCKS
    bent = posture(capture(seen(0.1), directions=posed(UP, tilted(42.0), tilted(40.0))))
    assert bent is not None
    assert bent.severity is Severity.HARMS


def test_a_thigh_that_looks_short_points_at_the_camera_whatever_its_slant():
    """The made-up trunk is 150 pixels long, thighs of 40 less than a half of the least."""
    short = {f"{side}_knee": (x, 330.0) for side, x in (("left", 230.0), ("right", 170.0))}
    body = replace(seen(-0.2), points=person(**short).points)
    told = posture(capture(body))
    assert told is not None
    assert told.severity is Severity.BLOCKS
    assert detected_directions(capture(body))["left_thigh"][2] < -0.8


def test_a_trunk_that_looks_short_is_bent_toward_the_camera():
    low = {f"{side}_shoulder": (x, 240.0) for side, x in (("left", 254.0), ("right", 146.0))}
    told = posture(capture(replace(seen(0.0), points=person(**low).points)))
    assert told is not None
    assert "bends over" in told.reason


@pytest.mark.parametrize(
    ("nose_y", "severity"), [(120.0, Severity.HARMS), (160.0, Severity.BLOCKS)]
)
def test_whose_head_hangs_bends_over(nose_y, severity):
    """The made-up shoulders are at 140, and the person 540 pixels tall."""
    low = replace(seen(0.0), points=person(nose=(200.0, nose_y)).points)
    assert posture(capture(low)) is None
    assert posture(capture(replace(seen(0.0), leaning_deg=60.0))) is None
    hanging = replace(low, leaning_deg=60.0)
    told = posture(capture(hanging))
    assert told is not None
    assert (told.code, told.severity) == (Code.NOT_STANDING, severity)
    assert "bends over" in told.reason
    assert posture(capture(hanging, directions=posed(UP, DOWN, DOWN))) == told


def with_the_left_leg_alone(body: DetectedBody) -> DetectedBody:
    """As from the side, where it hides the other."""
    limbs = {name: slant for name, slant in body.slants.limbs.items() if "left" in name}
    return replace(body, slants=replace(body.slants, limbs=limbs))


def test_of_who_is_seen_from_the_side_one_leg_tells():
    assert posture(capture(with_the_left_leg_alone(seen(0.1)))) is None
    told = posture(capture(with_the_left_leg_alone(seen(-0.95))))
    assert told is not None
    assert told.severity is Severity.BLOCKS


def test_without_thighs_nothing_is_told_of_the_posture():
    assert is_unchecked(posture(by_points_alone()))
    assert is_unchecked(proportions(by_points_alone()))


def test_children_are_told_by_their_eyes():
    assert proportions(capture(seen(0.0))) is None
    places = {"left_eye": (218.0, 72.0), "right_eye": (182.0, 72.0)}
    small = replace(seen(0.0), points=person(**places).points)
    told = proportions(capture(small))
    assert told is not None
    assert (told.code, told.severity) == (Code.CHILD, Severity.BLOCKS)
    assert "The eyes are 6." in told.reason


def test_of_who_sits_proportions_are_not_told():
    assert is_unchecked(proportions(capture(seen(-0.95))))


def turned(degrees: float) -> dict[str, tuple[float, float]]:
    """Shoulders and hips of the person who faces the camera, turned about the upright axis."""
    shrink = math.cos(math.radians(degrees))
    return {
        name: (200 + shrink * (x - 200), y)
        for name, (x, y) in FRONT.items()
        if "shoulder" in name or "hip" in name
    }


@pytest.mark.parametrize("degrees", [20.0, 45.0, 70.0, 90.0, 110.0, 150.0, 180.0])
def test_how_far_a_trunk_is_turned_is_found_from_its_breadth(degrees):
    cosine = facing(capture(person(**turned(degrees))))
    assert cosine is not None
    assert math.degrees(math.acos(cosine)) == pytest.approx(degrees, abs=8.0)


def test_a_roll_of_the_camera_turns_nobody():
    rolled = {name: (640.0 - y, x) for name, (x, y) in FRONT.items()}
    assert facing(capture(person(**rolled))) == pytest.approx(facing(capture()))


@pytest.mark.parametrize(
    ("degrees", "seen"),
    [
        (0.0, SeenFrom.FRONT),
        (35.0, SeenFrom.FRONT),
        (58.0, SeenFrom.BETWEEN),
        (80.0, SeenFrom.SIDE),
        (100.0, SeenFrom.SIDE),
        (122.0, SeenFrom.BETWEEN),
        (150.0, SeenFrom.BACK),
    ],
)
def test_views_have_names(degrees, seen):
    assert seen_from(math.cos(math.radians(degrees))) is seen


@pytest.mark.parametrize(
    ("view", "degrees", "severity"),
    [
        (ViewKind.FRONT, 10.0, None),
        (ViewKind.SIDE, 85.0, None),
        (ViewKind.BACK, 175.0, None),
        (ViewKind.OTHER, 60.0, None),
        (None, 60.0, None),
        (ViewKind.FRONT, 60.0, Severity.HARMS),
        (ViewKind.FRONT, 90.0, Severity.BLOCKS),
        (ViewKind.FRONT, 180.0, Severity.BLOCKS),
        (ViewKind.SIDE, 0.0, Severity.BLOCKS),
        (ViewKind.BACK, 0.0, Severity.BLOCKS),
    ],
)
def test_a_view_other_than_was_said_is_told(view, degrees, severity):
    found = announced_view(capture(person(**turned(degrees)), view=view))
    if severity is None:
        assert found is None
        return
    assert found is not None
    assert (found.code, found.severity) == (Code.OTHER_VIEW, severity)


def test_points_alone_tell_the_view_and_half_a_trunk_does_not():
    assert is_finding(announced_view(by_points_alone(view=ViewKind.SIDE)))
    half = {name: at for name, at in by_points_alone().points.items() if "left" in name}
    assert is_unchecked(announced_view(by_points_alone(view=ViewKind.SIDE, points=half)))


HANGING = {"left_elbow": (258.0, 220.0), "left_wrist": (255.0, 285.0)}
SIDEWAYS = {
    f"{side}_{joint}": (200.0, y)
    for joint, y in (("shoulder", 140.0), ("hip", 290.0))
    for side in ("left", "right")
}


def test_arms_held_away_are_free():
    whole = capture()
    assert whole.mask is not None
    assert arms(whole) is None
    for side in ("left", "right"):
        assert free_share(whole, whole.mask, side) == 1.0


def test_an_arm_that_hangs_along_the_trunk_is_told_by_its_side():
    found = person(**HANGING)
    cv2.line(found.mask, (240, 150), (240, 285), 1.0, 40)
    told = arms(capture(found))
    assert told is not None
    assert (told.code, told.where) == (Code.ARMS_AGAINST_TRUNK, ("left_elbow", "left_wrist"))
    assert "0 % of the left arm" in told.reason


def test_arms_are_looked_at_from_the_front_and_from_behind_alone_and_with_an_outline():
    mirrored = {name: (400.0 - x, y) for name, (x, y) in _places().items()}
    assert arms(capture(person(**mirrored))) is None
    assert is_unchecked(arms(capture(person(**SIDEWAYS))))
    assert is_unchecked(arms(by_points_alone()))


def worn(**kinds: Covering) -> tuple[WornRegion, ...]:
    return tuple(
        WornRegion(
            region=BodyRegion(region),
            kind=kind,
            probability=0.8,
            ease_cm=None,
            ease_standard_error_cm=None,
        )
        for region, kind in kinds.items()
    )


@pytest.mark.parametrize(
    ("kinds", "said"),
    [
        ({"upper": Covering.LOOSE, "lower": Covering.CLOSE}, "cover the upper body (80 %): "),
        ({"upper": Covering.BARE, "lower": Covering.LOOSE, "legs": Covering.LOOSE},
         "cover the thighs (80 %) and the lower legs (80 %): "),
    ],
)  # fmt: skip
def test_loose_clothes_are_told_by_the_regions_that_they_cover(kinds, said):
    told = clothes(capture(clothing=worn(**kinds)))
    assert told is not None
    assert (told.code, told.severity) == (Code.CLOTHES_LOOSE, Severity.HARMS)
    assert said in told.reason
    assert ("left_shoulder" in told.where) is (kinds["upper"] is Covering.LOOSE)


def test_close_clothes_sleeves_and_shoes_are_no_fault():
    close = worn(upper=Covering.CLOSE, lower=Covering.BARE, arms=Covering.LOOSE)
    assert clothes(capture(clothing=close)) is None


def test_without_an_outline_clothes_are_not_checked():
    assert is_unchecked(clothes(by_points_alone()))
    assert clothing_guess(by_points_alone()) is None


@pytest.mark.parametrize(
    ("seen", "over_top", "kind", "because"),
    [
        (worn(upper=Covering.CLOSE, lower=Covering.BARE), 0.2, Clothing.TIGHT, "skin"),
        (worn(upper=Covering.LOOSE), 0.2, Clothing.LOOSE, "the upper body"),
        (None, None, Clothing.LOOSE, "Neither face nor hands"),
        (worn(upper=Covering.LOOSE), 0.8, Clothing.OUTER, "80 %"),
        (worn(upper=Covering.BARE), 0.8, Clothing.TIGHT, "skin"),
    ],
)
def test_clothes_are_guessed_in_a_word_of_requests_with_its_reason(seen, over_top, kind, because):
    guess = clothing_guess(capture(clothing=seen, over_top=over_top))
    assert guess is not None
    assert (guess.kind, because in guess.reason) == (kind, True)


def test_without_the_skins_colour_it_is_said_that_clothes_cannot_be_seen():
    told = clothes(capture(clothing=None))
    assert told is not None
    assert (told.code, told.severity) == (Code.SKIN_NOT_FOUND, Severity.HARMS)


def _places() -> dict[str, tuple[float, float]]:
    return {name: (click.x, click.y) for name, click in person().points.items()}

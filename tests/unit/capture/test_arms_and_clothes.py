"""What the outline says beside the bones: arms at the trunk, clothes off the legs."""

import cv2
import pytest

from fitter.capture.arms import arms, free_share
from fitter.capture.clothes import LEVELS, clothes, outward_share
from fitter.capture.finding import Code, Finding, Unchecked
from tests.unit.capture.made_up import STATURE_PX, by_points_alone, capture, person

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
    assert isinstance(told, Finding)
    assert (told.code, told.points) == (Code.ARMS_AGAINST_TRUNK, ("left_elbow", "left_wrist"))
    assert "0 % of the left arm" in told.reason


def test_arms_are_looked_at_from_the_front_and_from_behind_alone_and_with_an_outline():
    mirrored = {name: (400.0 - x, y) for name, (x, y) in _places().items()}
    assert arms(capture(person(**mirrored))) is None
    assert isinstance(arms(capture(person(**SIDEWAYS))), Unchecked)
    assert isinstance(arms(by_points_alone()), Unchecked)


def test_how_far_an_outline_is_off_the_bones_is_found():
    """Limbs are drawn 50 and 28 pixels broad."""
    whole = capture()
    assert whole.mask is not None
    found = {level.name: outward_share(whole, whole.mask, STATURE_PX, level) for level in LEVELS}
    assert found["thighs"] == pytest.approx(25.0 / STATURE_PX, abs=2.0 / STATURE_PX)
    assert found["lower shins"] == pytest.approx(14.0 / STATURE_PX, abs=2.0 / STATURE_PX)
    assert clothes(whole) is None


@pytest.mark.parametrize(
    ("drawn", "level"),
    [
        (((160, 420), (160, 545), (240, 420), (240, 545)), "lower shins"),
        (((172, 330), (160, 420), (228, 330), (240, 420)), "knees"),
    ],
    ids=["trousers", "a skirt"],
)
def test_trousers_and_skirts_stand_off_the_legs(drawn, level):
    found = person()
    for start, end in (drawn[:2], drawn[2:]):
        cv2.line(found.mask, start, end, 1.0, 90)
    told = clothes(capture(found))
    assert isinstance(told, Finding)
    assert told.code is Code.CLOTHES_LOOSE
    assert told.reason.startswith(f"At the {level} the outline is ")


def test_legs_that_cross_or_are_seen_from_the_side_are_not_judged():
    crossed = {"left_knee": (165.0, 420.0), "right_knee": (235.0, 420.0),
               "left_ankle": (162.0, 545.0), "right_ankle": (238.0, 545.0),
               "left_hip": (201.0, 290.0), "right_hip": (199.0, 290.0)}  # fmt: skip
    assert isinstance(clothes(capture(person(**crossed))), Unchecked)
    assert isinstance(clothes(capture(person(**SIDEWAYS))), Unchecked)
    assert isinstance(clothes(by_points_alone()), Unchecked)


def _places() -> dict[str, tuple[float, float]]:
    return {name: (click.x, click.y) for name, click in person().points.items()}

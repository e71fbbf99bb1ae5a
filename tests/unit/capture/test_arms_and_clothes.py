"""What the outline says beside the bones: arms at the trunk, clothes off the legs."""

import cv2
import pytest

from fitter.capture.clothes import clothes
from fitter.capture.posture import arms, free_share
from fitter.vocabulary.choices import BodyRegion, Covering
from fitter.vocabulary.outcomes import WornRegion
from fitter.vocabulary.remarks import Code, Severity
from tests.unit.capture.made_up import by_points_alone, capture, is_unchecked, person

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
        ({"upper": Covering.LOOSE, "lower": Covering.CLOSE}, "cover the upper body, with"),
        ({"upper": Covering.BARE, "lower": Covering.LOOSE, "legs": Covering.LOOSE},
         "cover the thighs and the lower legs, with a probability of 80 %"),
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


def test_without_the_skins_colour_it_is_said_that_clothes_cannot_be_seen():
    told = clothes(capture(clothing=None))
    assert told is not None
    assert (told.code, told.severity) == (Code.SKIN_NOT_FOUND, Severity.HARMS)


def _places() -> dict[str, tuple[float, float]]:
    return {name: (click.x, click.y) for name, click in person().points.items()}

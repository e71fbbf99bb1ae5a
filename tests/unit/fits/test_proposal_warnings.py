"""Warnings of proposals, of people made up for it."""

from dataclasses import replace

import numpy as np
import pytest

from fitter.detection.detector import DetectedBody, DetectedSlants
from fitter.detection.person_detector import DetectedPerson
from fitter.fits.proposal_warnings import proposal_warnings
from fitter.request import Click

FRONT = {
    "nose": (100, 30),
    "left_eye": (105, 25), "right_eye": (95, 25), "left_ear": (110, 27), "right_ear": (90, 27),
    "left_shoulder": (130, 60), "right_shoulder": (70, 60),
    "left_elbow": (145, 110), "right_elbow": (55, 110),
    "left_wrist": (150, 150), "right_wrist": (50, 150),
    "left_hip": (115, 150), "right_hip": (85, 150),
    "left_knee": (117, 210), "right_knee": (83, 210),
    "left_ankle": (118, 270), "right_ankle": (82, 270),
    "left_heel": (117, 278), "right_heel": (83, 278),
    "left_toe": (122, 285), "right_toe": (78, 285),
}  # fmt: skip


def person(**moved: tuple[float, float]) -> DetectedBody:
    """Somebody who stands upright before the camera in a picture of 200 x 320 pixels."""
    mask = np.zeros((320, 200), dtype=np.float32)
    mask[15:290, 45:155] = 1.0
    return DetectedBody(
        person=DetectedPerson(
            score=0.9, middle=np.array([100.0, 150.0]), rim=np.array([100.0, 5.0])
        ),
        points={name: Click(x=x, y=y) for name, (x, y) in (FRONT | moved).items()},
        visibility=dict.fromkeys(FRONT, 1.0),
        slants=DetectedSlants(limbs={}, middle=np.array([100.0, 150.0])),
        leaning_deg=0.0,
        mask=mask,
    )


def codes(*bodies: DetectedBody, chosen: int | None = 0, was_chosen: bool = False) -> list[str]:
    return [each.code for each in proposal_warnings(bodies, chosen, was_chosen=was_chosen)]


def test_there_is_nothing_to_say_of_somebody_upright_and_whole():
    assert codes(person()) == []


def test_nobody_is_told():
    assert codes(chosen=None) == ["nobody-found"]


def test_several_people_are_told_to_whom_did_not_choose():
    assert codes(person(), person()) == ["several-people"]
    assert codes(person(), person(), chosen=1, was_chosen=True) == []


def test_somebody_who_goes_on_beyond_the_picture_is_cut_off():
    whole = person()
    without_toe = {name: each for name, each in whole.points.items() if name != "left_toe"}
    assert codes(replace(whole, points=without_toe)) == ["cut-off"]
    assert codes(person(left_toe=(122, 319.5))) == ["cut-off"]
    whole.mask[-1, 80:120] = 1.0
    assert codes(whole) == ["cut-off"]


@pytest.mark.parametrize(("shrink", "told"), [(0.88, ["person-too-small"]), (0.91, [])])
def test_a_person_of_less_than_250_pixels_is_small(shrink, told):
    """Shoulders to ankles are 210 pixels, three quarters of the stature."""
    smaller = {name: (x, shrink * y) for name, (x, y) in FRONT.items()}
    assert codes(person(**smaller)) == told


def test_a_back_is_told_from_a_front_by_the_face():
    mirrored = {name: (200 - x, y) for name, (x, y) in FRONT.items()}
    facing = person(**mirrored)
    assert "seen-from-behind" not in codes(facing)
    hidden = {
        name: replace(facing.points[name], occluded=True)
        for name in ("nose", "left_eye", "right_eye")
    }
    assert codes(replace(facing, points={**facing.points, **hidden})) == ["seen-from-behind"]
    assert codes(replace(person(), points={**person().points, **hidden})) == []


@pytest.mark.parametrize(
    "moved",
    [
        {"left_wrist": (70, 140), "right_wrist": (130, 140)},
        {"left_ankle": (85, 270), "right_ankle": (117, 270)},
        {"right_wrist": (150, 90)},
    ],
    ids=["wrists", "ankles", "a forearm over the other arm"],
)
def test_limbs_that_cross_are_told(moved):
    assert codes(person(**moved)) == ["limbs-crossed"]


def test_a_hand_on_the_other_hip_crosses_nothing():
    assert codes(person(left_wrist=(90, 148))) == []

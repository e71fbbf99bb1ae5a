"""Warnings of proposals, of people made up for it."""

from collections.abc import Mapping
from dataclasses import replace

import pytest

from fitter.fits.proposal import proposal_warnings
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


def person(**moved: tuple[float, float]) -> dict[str, Click]:
    """Somebody who stands upright before the camera."""
    return {name: Click(x=x, y=y) for name, (x, y) in (FRONT | moved).items()}


def codes(points: Mapping[str, Click]) -> list[str]:
    return [each.code for each in proposal_warnings(points)]


def test_there_is_nothing_to_say_of_somebody_upright_and_whole():
    assert codes(person()) == []


def test_a_back_is_told_from_a_front_by_the_face():
    mirrored = {name: (200 - x, y) for name, (x, y) in FRONT.items()}
    facing = person(**mirrored)
    assert "seen-from-behind" not in codes(facing)
    hidden = {
        name: replace(facing[name], occluded=True) for name in ("nose", "left_eye", "right_eye")
    }
    assert codes(facing | hidden) == ["seen-from-behind"]
    assert codes(person() | hidden) == []


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

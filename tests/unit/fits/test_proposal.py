"""Points that are proposed, and what is said of them."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pytest
from PIL import Image as PillowImage

from fitter.detection.detector import installed_detector
from fitter.errors import InvalidInputError
from fitter.fits.capture_check import CaptureQuestion
from fitter.fits.proposal import Proposal, proposal_warnings, propose
from fitter.observation.observation import observe
from fitter.request import Click, View
from tests.accuracy.files import PICTURES_FOLDER
from tests.unit.observation.pictures import encode, noise

CASE = "man_young_thin_standing"


def proposed(image: bytes, *, person: int | None = None, with_mask: bool = False) -> Proposal:
    return propose(
        image,
        CaptureQuestion(person=person),
        detector=installed_detector(),
        max_pixels=50_000_000,
        with_mask=with_mask,
    )


def two_people() -> bytes:
    """A smaller copy of the person to the left of the person."""
    person = np.asarray(PillowImage.open(PICTURES_FOLDER / f"{CASE}.jpg"))
    height, width = person.shape[:2]
    smaller = np.asarray(PillowImage.fromarray(person).resize((3 * width // 4, 3 * height // 4)))
    beside = np.pad(smaller, ((height - len(smaller), 0), (0, 0), (0, 0)), mode="edge")
    return encode(PillowImage.fromarray(np.concatenate([beside, person], axis=1)))


def codes(proposal: Proposal) -> list[str]:
    findings = [each.code for each in proposal.checked.findings]
    return findings + [each.code for each in proposal.warnings]


def test_the_points_are_those_a_fit_proposes_to_itself():
    large = encode(PillowImage.open(PICTURES_FOLDER / f"{CASE}.jpg").resize((1501, 2003)))
    observation = observe(
        View(image=large, clicks={}, complete_clicks=True),
        max_pixels=10_000_000,
        detector=installed_detector(),
    )
    points = proposed(large).points
    assert points.keys() == observation.clicks.keys()
    for name, point in points.items():
        inside = observation.clicks[name]
        assert point.click.x * observation.scale == pytest.approx(inside.x)
        assert point.click.y * observation.scale == pytest.approx(inside.y)
        assert (point.click.spread_m, point.click.occluded) == (inside.spread_m, inside.occluded)


def test_the_mask_has_the_picture_s_size_and_covers_the_person():
    true = PillowImage.open(PICTURES_FOLDER / f"{CASE}_person.png").convert("L")
    size = (1501, 2003)
    large = encode(PillowImage.open(PICTURES_FOLDER / f"{CASE}.jpg").resize(size))
    proposal = proposed(large, with_mask=True)
    assert proposal.mask is not None
    assert proposal.mask.shape == (proposal.height, proposal.width) == size[::-1]
    found, truth = proposal.mask > 127, np.asarray(true.resize(size)) > 127
    assert (found & truth).sum() > 0.93 * (found | truth).sum()
    assert proposed(large).mask is None


def test_nobody_is_no_error():
    proposal = proposed(encode(PillowImage.fromarray(noise())), with_mask=True)
    assert (proposal.persons, proposal.person, proposal.points) == ((), None, {})
    assert proposal.mask is None
    assert "nobody-found" in codes(proposal)


def test_of_several_people_the_largest_or_the_one_asked_for_is_proposed():
    image = two_people()
    largest, smaller = proposed(image), proposed(image, person=1)
    assert len(largest.persons) == 2
    assert (largest.person, smaller.person) == (0, 1)
    assert largest.points["nose"].click.x > 0.5 * largest.width > smaller.points["nose"].click.x
    assert "several-people" in codes(largest)
    assert "several-people" not in codes(smaller)
    with pytest.raises(InvalidInputError) as raised:
        proposed(image, person=2)
    assert (raised.value.field, raised.value.code) == ("person", "person-unknown")


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


def codes_of(points: Mapping[str, Click]) -> list[str]:
    return [each.code for each in proposal_warnings(points)]


def test_there_is_nothing_to_say_of_somebody_upright_and_whole():
    assert codes_of(person()) == []


def test_a_back_is_told_from_a_front_by_the_face():
    mirrored = {name: (200 - x, y) for name, (x, y) in FRONT.items()}
    facing = person(**mirrored)
    assert "seen-from-behind" not in codes_of(facing)
    hidden = {
        name: replace(facing[name], occluded=True) for name in ("nose", "left_eye", "right_eye")
    }
    assert codes_of(facing | hidden) == ["seen-from-behind"]
    assert codes_of(person() | hidden) == []


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
    assert codes_of(person(**moved)) == ["limbs-crossed"]


def test_a_hand_on_the_other_hip_crosses_nothing():
    assert codes_of(person(left_wrist=(90, 148))) == []

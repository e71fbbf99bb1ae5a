"""Points that the detector proposes where nobody clicked."""

import json
from typing import Any

import numpy as np
import pytest
from PIL import Image as PillowImage

from fitter.detection.detector import installed_detector
from fitter.errors import InvalidInputError
from fitter.observation.observation import Observation, observe
from fitter.request import Click, View
from fitter.vocabulary.choices import SegmentationKind
from tests.accuracy.files import PICTURES_FOLDER
from tests.unit.observation.pictures import encode, noise

CASE = "man_young_thin_standing"


def completed(image: bytes, clicks: dict[str, Click], **changes: Any) -> View:
    return View(image=image, clicks=clicks, complete_clicks=True, **changes)


def picture() -> bytes:
    return (PICTURES_FOLDER / f"{CASE}.jpg").read_bytes()


def clicks() -> dict[str, Click]:
    points = json.loads((PICTURES_FOLDER / f"{CASE}.json").read_text())["request"]["points"]
    return {name: Click(x=each["x"], y=each["y"]) for name, each in points.items()}


def observed(view: View) -> Observation:
    return observe(view, max_pixels=10_000_000, detector=installed_detector())


def test_without_a_click_all_points_are_proposed_and_said_to_be():
    observation = observed(completed(picture(), {}))
    assert len(observation.clicks) == 21
    assert all(click.spread_m is not None for click in observation.clicks.values())
    (assumed,) = [each for each in observation.assumptions if each.code == "points-proposed"]
    assert "left_knee" in assumed.where


def test_clicks_stay_and_the_others_are_proposed():
    given = {name: clicks()[name] for name in ("left_knee", "neck")}
    observation = observed(completed(picture(), given))
    for name, click in given.items():
        found = observation.clicks[name]
        assert found.spread_m is None
        assert found.x == pytest.approx(observation.scale * click.x)
        assert found.y == pytest.approx(observation.scale * click.y)
    assert observation.clicks["right_knee"].spread_m is not None
    (assumed,) = [each for each in observation.assumptions if each.code == "points-proposed"]
    assert "left_knee" not in assumed.where


def test_proposals_are_scaled_with_the_working_picture():
    large = PillowImage.open(PICTURES_FOLDER / f"{CASE}.jpg").resize((1440, 1920))
    observation = observed(completed(encode(large), {}))
    assert observation.scale < 1.0
    small = observed(completed(picture(), {}))
    for name in ("nose", "left_ankle"):
        share = observation.clicks[name].x / observation.camera.width
        assert share == pytest.approx(small.clicks[name].x / small.camera.width, abs=0.01)


def test_nobody_found_is_said():
    blank = encode(PillowImage.fromarray(noise()))
    with pytest.raises(InvalidInputError) as raised:
        observed(completed(blank, {}))
    assert raised.value.code == "person-not-found"


def test_clicks_beside_everybody_are_not_completed_by_somebody_else():
    with pytest.raises(InvalidInputError) as raised:
        observed(completed(picture(), {"left_knee": Click(x=5.0, y=5.0)}))
    assert raised.value.code == "person-not-found"


def test_seed_and_slants_can_be_switched_off():
    both = observed(View(image=picture(), clicks=clicks()))
    assert both.seed is not None
    assert both.seed.shape == (both.camera.height, both.camera.width)
    assert both.slants is not None
    neither = observed(
        View(
            image=picture(),
            clicks=clicks(),
            segmentation=SegmentationKind.GRABCUT,
            slant_hints=False,
        )
    )
    assert neither.seed is None
    assert neither.slants is None


def test_of_several_people_the_largest_is_taken():
    person = np.asarray(PillowImage.open(PICTURES_FOLDER / f"{CASE}.jpg"))
    height, width = person.shape[:2]
    smaller = np.asarray(PillowImage.fromarray(person).resize((3 * width // 4, 3 * height // 4)))
    beside = np.pad(smaller, ((height - len(smaller), 0), (0, 0), (0, 0)), mode="edge")
    both = encode(PillowImage.fromarray(np.concatenate([beside, person], axis=1)))
    observation = observed(completed(both, {}))
    assert observation.bodies is not None
    assert len(observation.bodies) == 2
    assert observation.clicks["nose"].x > observation.camera.width / 2

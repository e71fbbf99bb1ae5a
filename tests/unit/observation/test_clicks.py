"""Clicks, and points that complete them."""

import json
import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from PIL import Image as PillowImage

from fitter.detection.detector import installed_detector
from fitter.errors import InvalidInputError
from fitter.observation.clicks import check_clicks, side_warnings
from fitter.observation.observation import Observation, observe
from fitter.request import Click, View
from fitter.vocabulary.choices import SegmentationKind
from fitter.vocabulary.points import POINT_NAMES
from tests.accuracy.files import PICTURES_FOLDER
from tests.unit.observation.pictures import HEIGHT, WIDTH, encode, noise, standing_clicks


def problem_of(clicks: dict[str, Click]) -> InvalidInputError:
    with pytest.raises(InvalidInputError) as caught:
        check_clicks(clicks, width=WIDTH, height=HEIGHT)
    return caught.value


def only(*names: str) -> dict[str, Click]:
    return {name: standing_clicks()[name] for name in names}


def swapped(clicks: dict[str, Click], *pairs: str) -> dict[str, Click]:
    result = dict(clicks)
    for pair in pairs:
        left, right = f"left_{pair}", f"right_{pair}"
        result[left], result[right] = clicks[right], clicks[left]
    return result


def turned(clicks: dict[str, Click], degrees: float) -> dict[str, Click]:
    cosine, sine = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return {
        name: replace(
            click, x=cosine * click.x - sine * click.y, y=sine * click.x + cosine * click.y
        )
        for name, click in clicks.items()
    }


def warning_codes(clicks: dict[str, Click]) -> list[str]:
    return [warning.code for warning in side_warnings(clicks)]


BODY_PAIRS = ("shoulder", "elbow", "wrist", "hip", "knee", "ankle")


def test_a_standing_person_is_accepted_without_warnings():
    check_clicks(standing_clicks(), width=WIDTH, height=HEIGHT)
    assert side_warnings(standing_clicks()) == ()


def test_coco_and_further_points_are_known_once_each():
    assert len(POINT_NAMES) == len(set(POINT_NAMES)) == 24


def test_a_half_figure_without_hips_is_enough():
    check_clicks(
        only("left_shoulder", "right_shoulder", "left_elbow", "right_elbow", "left_wrist",
             "right_wrist"),
        width=WIDTH, height=HEIGHT,
    )  # fmt: skip


@pytest.mark.parametrize(
    "names",
    [
        (),
        ("left_shoulder", "right_shoulder", "left_elbow"),
        ("left_knee", "right_knee", "left_elbow", "right_elbow", "left_wrist", "right_wrist"),
        ("left_shoulder", "left_knee", "right_knee", "left_elbow", "right_elbow", "left_wrist",
         "nose", "left_eye"),
    ],
)  # fmt: skip
def test_too_few_points_are_refused_and_the_least_set_is_named(names: tuple[str, ...]):
    problem = problem_of(only(*names))
    assert problem.code == "too-few-points"
    assert "4" in problem.remedy
    assert "shoulders or hips" in problem.remedy


@pytest.mark.parametrize("place", [(-0.1, 5), (5, -0.1), (WIDTH + 0.1, 5), (5, HEIGHT + 0.1)])
def test_a_point_outside_the_picture_is_refused_by_name(place: tuple[float, float]):
    problem = problem_of(standing_clicks() | {"left_knee": Click(x=place[0], y=place[1])})
    assert (problem.code, problem.field) == ("point-outside-image", "points.left_knee")


def test_points_on_the_border_are_inside():
    clicks = standing_clicks() | {"left_knee": Click(x=WIDTH, y=HEIGHT), "nose": Click(x=0, y=0)}
    check_clicks(clicks, width=WIDTH, height=HEIGHT)


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
def test_a_coordinate_that_is_no_number_is_refused_by_name(value: float):
    problem = problem_of(standing_clicks() | {"right_hip": Click(x=value, y=5)})
    assert (problem.code, problem.field) == ("point-not-finite", "points.right_hip")


def test_an_unknown_point_is_refused():
    problem = problem_of(standing_clicks() | {"left_antenna": Click(x=5, y=5)})
    assert (problem.code, problem.field) == ("point-unknown", "points.left_antenna")


def test_points_as_shares_of_the_picture_are_refused():
    shares = {
        name: Click(x=click.x / WIDTH, y=click.y / HEIGHT)
        for name, click in standing_clicks().items()
    }
    assert problem_of(shares).code == "points-too-close"


def test_a_person_seen_from_behind_gives_no_warning():
    clicks = swapped(standing_clicks(), *BODY_PAIRS)
    without_face = {
        name: click for name, click in clicks.items() if "eye" not in name and name != "nose"
    }
    assert side_warnings(without_face) == ()
    hidden_face = without_face | {
        name: replace(standing_clicks()[name], occluded=True) for name in ("left_eye", "right_eye")
    }
    assert side_warnings(hidden_face) == ()
    eyes = {name: replace(clicks[name], spread_m=0.01) for name in ("left_eye", "right_eye")}
    assert side_warnings(clicks | eyes) == (), "a detector proposes those of a look back, too"


def test_swapped_hips_are_warned_of():
    assert warning_codes(swapped(standing_clicks(), "hip")) == ["shoulders-and-hips-disagree"]


@pytest.mark.parametrize("pairs", [BODY_PAIRS, (*BODY_PAIRS, "eye"), ("eye",)])
def test_left_and_right_swapped_under_a_visible_face_are_warned_of(pairs: tuple[str, ...]):
    clicks = swapped(standing_clicks(), *pairs)
    assert warning_codes(clicks) == ["left-and-right-may-be-swapped"]


@pytest.mark.parametrize("degrees", [0, 90, 180, 250])
def test_lying_down_or_standing_on_the_head_changes_no_verdict(degrees: float):
    assert warning_codes(turned(standing_clicks(), degrees)) == []
    swapped_hips = turned(swapped(standing_clicks(), "hip"), degrees)
    assert warning_codes(swapped_hips) == ["shoulders-and-hips-disagree"]


def test_of_a_trunk_in_profile_the_order_of_the_eyes_tells_nothing():
    clicks = swapped(standing_clicks(), "eye")
    for pair in ("shoulder", "hip"):
        left, right = clicks[f"left_{pair}"], clicks[f"right_{pair}"]
        clicks[f"left_{pair}"] = clicks[f"right_{pair}"] = replace(left, x=0.5 * (left.x + right.x))
    assert warning_codes(clicks) == []


def test_crossed_legs_give_no_warning():
    assert warning_codes(swapped(standing_clicks(), "knee", "ankle")) == []


def test_a_profile_decides_nothing_by_a_few_pixels():
    clicks = standing_clicks()
    clicks["left_hip"], clicks["right_hip"] = Click(x=59, y=82), Click(x=61, y=82)
    assert warning_codes(clicks) == []


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

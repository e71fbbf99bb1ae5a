"""Checks of encoded pictures with the real detector: the sample, good and spoilt."""

import io

import cv2
import numpy as np
import pytest
from PIL import Image as PillowImage

from fitter.detection.detector import installed_detector
from fitter.errors import InvalidInputError
from fitter.fits.capture_check import CaptureQuestion
from fitter.fits.proposal import Proposal, propose
from fitter.request import Click
from fitter.vocabulary.choices import Gender, ViewKind
from fitter.vocabulary.outcomes import SeenFrom
from fitter.vocabulary.remarks import Severity
from service.demo_data.sample import load_sample
from tests.unit.observation.pictures import encode, noise

ROLLED_DEG = 15.0


def sample() -> np.ndarray:
    """(960, 720, 3) a man who stands upright, whole and alone."""
    return np.asarray(PillowImage.open(io.BytesIO(load_sample().image)).convert("RGB"))


def checked(picture: np.ndarray, **said: object) -> Proposal:
    return propose(
        encode(PillowImage.fromarray(np.ascontiguousarray(picture))),
        CaptureQuestion(**said),
        detector=installed_detector(),
        max_pixels=50_000_000,
    )


def codes(check: Proposal) -> list[str]:
    return [each.code for each in check.checked.findings]


def spoilt(how: str) -> np.ndarray:
    picture = sample()
    height, width = picture.shape[:2]
    turn = cv2.getRotationMatrix2D((width / 2, height / 2), ROLLED_DEG, 0.8)
    made = {
        "blurred": cv2.GaussianBlur(picture, (0, 0), 4.0),
        "dark": (0.12 * picture).astype(np.uint8),
        "rolled": cv2.warpAffine(picture, turn, (width, height), borderMode=cv2.BORDER_REPLICATE),
        "without feet": picture[:820],
        "without a head": picture[150:],
        "two": np.concatenate([picture, picture], axis=1),
        "nobody": cv2.resize(noise(), (480, 640)),
        "a thumbnail": cv2.resize(picture, (150, 200), interpolation=cv2.INTER_AREA),
        "far away": np.pad(
            cv2.resize(picture, (225, 300), interpolation=cv2.INTER_AREA),
            ((180, 180), (220, 220), (0, 0)),
            mode="edge",
        ),
    }
    return made[how]


def test_nothing_is_found_in_a_good_picture():
    assert codes(checked(sample(), view=ViewKind.FRONT)) == []


@pytest.mark.parametrize(
    ("how", "code", "severity"),
    [
        ("blurred", "blurred", Severity.HARMS),
        ("dark", "too-dark", Severity.HARMS),
        ("rolled", "camera-rolled", Severity.HARMS),
        ("without feet", "cut-off", Severity.HARMS),
        ("without a head", "cut-off", Severity.HARMS),
        ("two", "several-people", Severity.HARMS),
        ("nobody", "nobody-found", Severity.BLOCKS),
        ("far away", "person-too-small", Severity.HARMS),
        ("a thumbnail", "picture-too-small", Severity.HARMS),
    ],
)
def test_what_is_done_to_a_good_picture_is_found(how, code, severity):
    check = checked(spoilt(how))
    found = {each.code: each for each in check.checked.findings}
    assert code in found
    assert found[code].severity is severity
    assert check.checked.usable is (severity is not Severity.BLOCKS)


def test_places_are_in_the_pixels_of_the_original_whatever_its_size():
    small = checked(sample()).checked.box
    large = checked(cv2.resize(sample(), (1440, 1920))).checked.box
    assert small is not None
    assert large is not None
    assert np.array(large) == pytest.approx(2.0 * np.array(small), abs=10.0)


def test_the_distance_is_by_the_lens_in_the_file_the_given_one_or_none():
    in_file = propose(
        load_sample().image,
        CaptureQuestion(height_m=1.804),
        detector=installed_detector(),
        max_pixels=50_000_000,
    )
    assert in_file.checked.distance_m == pytest.approx(3.0, rel=0.05)
    assert in_file.assumptions == ()
    # Encoded anew it has lost its EXIF data.
    assert checked(sample()).checked.distance_m is None
    given = checked(sample(), focal_length_35mm=50.0)
    assert given.checked.distance_m == pytest.approx(2.83, rel=0.05)
    assert ["1.70 m" in each.reason for each in given.assumptions] == [True]
    woman = checked(sample(), gender=Gender.FEMALE)
    assert ["1.65 m" in each.reason for each in woman.assumptions] == [True]


def test_one_of_two_can_be_meant_by_their_place_or_a_point():
    two = spoilt("two")
    left_nose, right_nose = Click(x=343.0, y=105.0), Click(x=343.0 + 720.0, y=105.0)
    boxes = [checked(two, person=person).checked.box for person in (0, 1)]
    for nose in (left_nose, right_nose):
        check = checked(two, points={"nose": nose})
        assert codes(check) == []
        assert check.checked.box in boxes
        assert check.checked.box is not None
        assert check.checked.box[0] < nose.x < check.checked.box[2]
    with pytest.raises(InvalidInputError) as caught:
        checked(two, person=2)
    assert caught.value.code == "person-unknown"


def test_without_a_detector_points_tell_their_part():
    points = {
        "left_shoulder": Click(x=438, y=220), "right_shoulder": Click(x=251, y=225),
        "left_hip": Click(x=390, y=466), "right_hip": Click(x=301, y=462),
        "left_knee": Click(x=408, y=675), "right_knee": Click(x=295, y=658),
        "left_ankle": Click(x=398, y=822), "right_ankle": Click(x=296, y=830),
    }  # fmt: skip
    check = propose(
        load_sample().image,
        CaptureQuestion(points=points, view=ViewKind.BACK, height_m=1.804),
        detector=None,
        max_pixels=50_000_000,
    )
    assert codes(check) == ["other-view"]
    assert (check.checked.seen, check.checked.box) == (SeenFrom.FRONT, None)
    assert check.checked.distance_m == pytest.approx(3.0, rel=0.05)


@pytest.mark.parametrize(
    ("said", "code"),
    [
        ({"height_m": 17.0}, "out-of-range"),
        ({"points": {"nose": Click(x=721.0, y=5.0)}}, "point-outside-image"),
        ({"focal_length_px": 90.0, "focal_length_35mm": 50.0}, "focal-length-twice"),
        ({"focal_length_35mm": 1.0}, "focal-length-invalid"),
    ],
)
def test_what_cannot_be_is_refused(said, code):
    with pytest.raises(InvalidInputError) as caught:
        checked(sample(), **said)
    assert caught.value.code == code

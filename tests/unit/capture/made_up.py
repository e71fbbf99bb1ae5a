"""A person made up for the checks: upright, whole, arms away, in a picture with sharp edges."""

from dataclasses import replace

import cv2
import numpy as np

from fitter.capture.capture import Capture
from fitter.detection.detector import DetectedBody, DetectedSlants, LimbSlant
from fitter.detection.person_detector import DetectedPerson
from fitter.request import Click
from fitter.vocabulary.remarks import Remark, Severity

WIDTH, HEIGHT = 400, 640

FRONT = {
    "nose": (200, 80),
    "left_eye": (208, 72), "right_eye": (192, 72), "left_ear": (218, 76), "right_ear": (182, 76),
    "left_shoulder": (262, 140), "right_shoulder": (138, 140),
    "left_elbow": (310, 220), "right_elbow": (90, 220),
    "left_wrist": (340, 290), "right_wrist": (60, 290),
    "left_hip": (234, 290), "right_hip": (166, 290),
    "left_knee": (235, 420), "right_knee": (165, 420),
    "left_ankle": (238, 545), "right_ankle": (162, 545),
    "left_heel": (236, 555), "right_heel": (164, 555),
    "left_toe": (246, 570), "right_toe": (154, 570),
}  # fmt: skip
"""Faces the camera; 540 pixels tall by trunk and legs."""

STATURE_PX = 540.0

_BONES = (
    ("left_shoulder", "left_elbow", 24), ("left_elbow", "left_wrist", 20),
    ("right_shoulder", "right_elbow", 24), ("right_elbow", "right_wrist", 20),
    ("left_hip", "left_knee", 50), ("left_knee", "left_ankle", 28), ("left_heel", "left_toe", 20),
    ("right_hip", "right_knee", 50), ("right_knee", "right_ankle", 28),
    ("right_heel", "right_toe", 20),
)  # fmt: skip


def person(**moved: tuple[float, float]) -> DetectedBody:
    """The person, some points elsewhere; limbs and trunk are where the points are."""
    places = FRONT | moved
    middle = np.array([200.0, 290.0])
    return DetectedBody(
        person=DetectedPerson(score=0.9, middle=middle, rim=middle - np.array([0.0, 290.0])),
        points={name: Click(x=float(x), y=float(y)) for name, (x, y) in places.items()},
        visibility=dict.fromkeys(places, 1.0),
        slants=DetectedSlants(
            limbs={
                f"{side}_{limb}": LimbSlant(sine=0.0, sigma=0.1)
                for side in ("left", "right")
                for limb in ("thigh", "shin")
            },
            middle=middle,
        ),
        leaning_deg=0.0,
        mask=outline(places).astype(np.float32),
    )


def outline(places: dict[str, tuple[float, float]]) -> np.ndarray:
    """(h, w) 0 or 1: a head, a trunk and limbs of a thin person."""
    drawn = np.zeros((HEIGHT, WIDTH), np.uint8)
    trunk = ("left_shoulder", "left_hip", "right_hip", "right_shoulder")
    cv2.fillPoly(drawn, [np.array([places[name] for name in trunk], np.int32)], 1)
    nose = places["nose"]
    cv2.ellipse(drawn, (round(nose[0]), round(nose[1])), (26, 36), 0, 0, 360, 1, -1)
    cv2.line(drawn, _whole(nose), (round(nose[0]), round(nose[1]) + 65), 1, 24)
    for start, end, breadth in _BONES:
        cv2.line(drawn, _whole(places[start]), _whole(places[end]), 1, breadth)
    return drawn


def _whole(place: tuple[float, float]) -> tuple[int, int]:
    return round(place[0]), round(place[1])


def capture(*bodies: DetectedBody, **changes: object) -> Capture:
    """What there is to check of a picture that shows these people; the first one is meant."""
    found = bodies or (person(),)
    made = Capture(
        picture=picture_of(found[0].mask),
        width=2 * WIDTH,
        height=2 * HEIGHT,
        scale=0.5,
        bodies=found,
        body=found[0],
        points={},
        is_chosen=False,
        view=None,
        focal_length_px=900.0,
        height_m=1.7,
        clothing=(),
    )
    return replace(made, **changes)


def by_points_alone(**changes: object) -> Capture:
    """The same person's points, without a detector."""
    points = {name: Click(x=float(x), y=float(y)) for name, (x, y) in FRONT.items()}
    return replace(capture(), **{"bodies": None, "body": None, "points": points} | changes)


def of_nobody(**changes: object) -> Capture:
    """A picture in which a detector found nobody."""
    return replace(capture(), **{"bodies": (), "body": None} | changes)


def picture_of(mask: np.ndarray) -> np.ndarray:
    """(h, w, 3) somebody of skin colour before a grey wall."""
    shown = np.where(mask[..., None] > 0.5, np.array([190, 140, 110]), np.array([70, 80, 90]))
    return shown.astype(np.uint8)


def is_finding(said: Remark | None) -> bool:
    return said is not None and said.is_finding


def is_unchecked(said: Remark | None) -> bool:
    return said is not None and said.severity is Severity.UNCHECKED

"""The networks that look for people and for faces: where each is, and how large."""

from dataclasses import dataclass, replace
from functools import cache
from typing import NamedTuple

import numpy as np
from jaxtyping import Float, UInt8

from fitter.detection.network import PictureNetwork, SquareCrop, logistic

INPUT_SIZE = 224
STRIDES = (8, 16, 32, 32, 32)
ANCHORS_A_STRIDE = 2
KEYPOINTS = 4
"""Key points of a detection: the middle of the hips, a point on the circle around the whole body,
and two more for the upper body alone."""

SURE = 0.5
"""Score at which something is taken for a person."""

SAME_PERSON = 0.3
"""Boxes that overlap by more than this (intersection over union) belong to one person."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class DetectedPerson:
    """A person as the first network finds them.

    Attributes
    ----------
    score
        0 to 1, how certain it is.
    middle, rim
        (2,) middle of the hips, and a point on the circle about it that holds the whole body,
        above the head of an upright person; continuous pixels.
    """

    score: float
    middle: Float[np.ndarray, "2"]
    rim: Float[np.ndarray, "2"]

    @property
    def radius(self) -> float:
        """Radius of the circle, pixels."""
        return float(np.linalg.norm(self.rim - self.middle))

    @property
    def is_head_down(self) -> bool:
        """Whether the person seems to stand on their hands."""
        return bool(self.rim[1] > self.middle[1])

    def share_within(self, width: int, height: int) -> float:
        """Share of the line from head to foot that lies in a picture of this size."""
        along = np.linspace(-1.0, 1.0, 41)[:, None] * (self.rim - self.middle)
        places = self.middle + along
        return float(np.mean(np.all((places >= 0.0) & (places <= [width, height]), axis=1)))

    def upright(self) -> "DetectedPerson":
        """The same person, taken to stand upright."""
        return replace(self, rim=self.middle - np.array([0.0, self.radius]))


class PersonDetector:
    """Finds people; ``network`` is that of :data:`fitter.detection.weights.PERSON_DETECTOR`."""

    def __init__(self, network: PictureNetwork) -> None:
        self._network = network

    def persons(self, picture: UInt8[np.ndarray, "h w 3"]) -> tuple[DetectedPerson, ...]:
        """People in a picture (sRGB), the whole, nearest and most certain first."""
        height, width = picture.shape[:2]
        crop = SquareCrop(
            centre=np.array([width / 2, height / 2]),
            side=float(max(width, height)),
            angle=0.0,
            size=INPUT_SIZE,
        )
        found = [
            DetectedPerson(score=each.score, middle=each.key_points[0], rim=each.key_points[1])
            for each in _sightings(self._network, picture, crop, STRIDES, KEYPOINTS)
        ]

        def importance(person: DetectedPerson) -> float:
            return person.score * person.radius * person.share_within(width, height) ** 2

        return tuple(sorted(found, key=importance, reverse=True))


FACE_INPUT_SIZE = 128
FACE_STRIDES = (8, 16, 16, 16)
FACE_KEYPOINTS, NOSE_TIP = 6, 2

FACE_CROPS = (0.65, 1.0)
"""Sides of the squares about a head in which faces are looked for, of the radius of the circle
around the person: a third of the stature for their own; in half of it faces beside them fit too."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class DetectedFace:
    """A face: 0 to 1, how certain that is, and the tip of its nose (2,), continuous pixels."""

    score: float
    middle: Float[np.ndarray, "2"]


class FaceDetector:
    """Finds faces; ``network`` is that of :data:`fitter.detection.weights.FACE_DETECTOR`."""

    def __init__(self, network: PictureNetwork) -> None:
        self._network = network

    def faces(
        self,
        picture: UInt8[np.ndarray, "h w 3"],
        head: Float[np.ndarray, "2"],
        side: float,
    ) -> tuple[DetectedFace, ...]:
        """Faces in a square about a head in a picture (sRGB), the most certain first."""
        crop = SquareCrop(centre=head, side=side, angle=0.0, size=FACE_INPUT_SIZE)
        found = _sightings(self._network, picture, crop, FACE_STRIDES, FACE_KEYPOINTS)
        return tuple(
            DetectedFace(score=each.score, middle=each.key_points[NOSE_TIP]) for each in found
        )


class _Sighting(NamedTuple):
    """Finding of a network: its certainty, and key points in pixels of the picture."""

    score: float
    key_points: Float[np.ndarray, "k 2"]


def _sightings(
    network: PictureNetwork,
    picture: UInt8[np.ndarray, "h w 3"],
    crop: SquareCrop,
    strides: tuple[int, ...],
    keypoints: int,
) -> list[_Sighting]:
    """Everything that a network is sure of in a crop, the most certain first."""
    outputs = network.outputs(crop.cut_from(picture).astype(np.float32) / 127.5 - 1.0)
    anchors = _anchors(crop.size, strides)
    scores = logistic(outputs[len(anchors), 1][:, 0])
    sure = np.flatnonzero(scores > SURE)
    values = outputs[len(anchors), 4 + 2 * keypoints][sure].astype(np.float64) / crop.size
    anchors, scores = anchors[sure], scores[sure]
    middles, halves = anchors + values[:, :2], 0.5 * values[:, 2:4]
    boxes = np.concatenate([middles - halves, middles + halves], axis=1)
    places = values[:, 4:].reshape(-1, keypoints, 2) + anchors[:, None]
    # Detections of one person are merged: their mean, weighted by score.
    return [
        _Sighting(
            float(scores[group].max()),
            crop.in_picture(crop.size * np.average(places[group], axis=0, weights=scores[group])),
        )
        for group in _groups(boxes, scores)
    ]


def _groups(boxes: Float[np.ndarray, "b 4"], scores: Float[np.ndarray, " b"]) -> list[np.ndarray]:
    """Non-maximum suppression: indices that overlap with the highest score left, group by group."""
    groups: list[np.ndarray] = []
    left = np.argsort(-scores, kind="stable")
    while len(left):
        overlaps = _overlaps(boxes[left[0]], boxes[left]) > SAME_PERSON
        overlaps[0] = True
        groups.append(left[overlaps])
        left = left[~overlaps]
    return groups


def _overlaps(box: Float[np.ndarray, "4"], others: Float[np.ndarray, "b 4"]) -> np.ndarray:
    """Intersection over union of a box with others; corners x0, y0, x1, y1."""
    sides = np.minimum(box[2:], others[:, 2:]) - np.maximum(box[:2], others[:, :2])
    shared = np.maximum(sides, 0.0).prod(axis=1)
    areas = (box[2:] - box[:2]).prod() + (others[:, 2:] - others[:, :2]).prod(axis=1)
    return shared / np.maximum(areas - shared, np.finfo(np.float64).tiny)


@cache
def _anchors(input_size: int, strides: tuple[int, ...]) -> Float[np.ndarray, "a 2"]:
    """Centres of a network's anchors as shares of its input, (x, y), in the network's order.

    Anchors of the same stride share a grid.
    """
    grids: list[np.ndarray] = []
    for stride in dict.fromkeys(strides):
        cells = -(-input_size // stride)
        rows, columns = np.divmod(np.arange(cells * cells), cells)
        centres = (np.column_stack([columns, rows]) + 0.5) / cells
        grids.append(np.repeat(centres, ANCHORS_A_STRIDE * strides.count(stride), axis=0))
    return np.concatenate(grids)

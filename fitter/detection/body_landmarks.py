"""The second network: a person's landmarks, in the picture and in space, and their mask."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, NamedTuple

import numpy as np
from jaxtyping import Float, UInt8

from fitter.arrays import GreyImage
from fitter.detection.network import PictureNetwork, SquareCrop, logistic
from fitter.detection.person_detector import (
    FACE_CROPS,
    DetectedFace,
    DetectedPerson,
    FaceDetector,
)

INPUT_SIZE = 256
HEAT_MAP_SIZE = 64
LANDMARKS = 33
OUTPUT_LANDMARKS = 39
"""Six more than are documented: two of them say where to look in the next frame of a video."""

CROP_MARGIN = 1.25
"""Side of the crop over the diameter of the circle around the person."""

MIRRORED = np.array(
    [0, 4, 5, 6, 1, 2, 3, 8, 7, 10, 9]
    + [index + (1 if index % 2 else -1) for index in range(11, LANDMARKS)]
)
"""The landmark each becomes in a mirror image; after the face, left ones have odd numbers."""

SHOULDERS, HIPS = [11, 12], [23, 24]
FACE: Final = slice(0, 9)
"""Nose, eyes and ears."""

FRONTAL_BREADTHS: Final = (0.83, 0.46)
"""Breadth of shoulders and hips facing the camera, of the trunk's length."""

CLEARLY_TURNED: Final = 0.4
"""Cosine up to which a person is seen from the side: within 24 degrees of profile."""

PRESENT: Final = 0.5
"""Presence at which the network is taken to confirm that there is a person."""

FACE_NEARBY: Final = 0.15
"""A face is the person's within so much of the circle's radius of where their head is: a twelfth of
the stature."""

FACE_SEEN: Final = 0.75
"""Certainty of a face that is seen. Of 84 people from the front (tuning half, bodies by another
maker) it is 0.82 at least, of twelve people from behind 0.68 at most."""

FACE_CERTAIN: Final = 0.65
"""Certainty from which a face counts where it may be somebody else's. In 338 pictures of one
person, whole or to the thighs, there is one such face at most; from 0.5 on a chest was another. Of
80 couples that passed for one person seven are told by the larger square."""

CUT_AT: Final = (-0.12, 0.85)
"""Heights at which the picture is cut off, so that the head is out of it, then the trunk too:
shares of the way from the shoulders to the hips."""

_REACH = 3
"""Pixels of the heat map on either side of a landmark that are used to refine it."""

_LEAST_HEAT = 0.5


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class BodyLandmarks:
    """One person, as the network sees them.

    Attributes
    ----------
    presence
        0 to 1, how likely it is that there is a person.
    pixels
        (33, 2) continuous pixels.
    visibility
        (33,) 0 to 1, how likely a landmark is seen: neither hidden nor outside the picture.
    world_m
        (33, 3) metres from the middle of the hips, on a person of average size; the axes are those
        of the camera turned toward it: x right, y down, z away.
    mask
        (h, w) probability that a pixel shows the person, 0 to 1.
    faces
        Seen for certain about the head, the most certain first.
    face
        0 to 1, how certain it is that the person's own is seen.
    turned
        Whether left and right were exchanged: then how limbs slant is not known.
    """

    presence: float
    pixels: Float[np.ndarray, "33 2"]
    visibility: Float[np.ndarray, "33"]
    world_m: Float[np.ndarray, "33 3"]
    mask: GreyImage
    faces: tuple[DetectedFace, ...] = ()
    face: float = 1.0
    turned: bool = False


class LandmarkNetwork:
    """Finds one person's landmarks, with :data:`fitter.detection.weights.BODY_LANDMARKS`.

    Each person is evaluated twice, as seen and mirrored, and the mean is returned: the network
    treats left and right a little differently. Whether somebody is seen from behind it knows by the
    face, and where that is hidden it turns people round.
    """

    def __init__(self, network: PictureNetwork, faces: FaceDetector) -> None:
        self._network = network
        self._faces = faces

    def landmarks(
        self,
        picture: UInt8[np.ndarray, "h w 3"],
        person: DetectedPerson,
        *,
        from_behind: bool = False,
    ) -> BodyLandmarks:
        """A detected person's landmarks in a picture (sRGB).

        ``from_behind`` is that the person is said to be seen so.
        """
        crop = crop_about(person)
        cut = crop.cut_from(picture).astype(np.float32) / 255.0
        looks = self._both_ways(cut)
        head = crop.in_picture(_mean([each.pixels[FACE] for each in looks])).mean(axis=0)
        around = [self._faces.faces(picture, head, side * person.radius) for side in FACE_CROPS]
        certain = [tuple(each for each in some if each.score > FACE_CERTAIN) for some in around]
        face = _own(around[0], head, person)
        if _contradict(looks):
            looks = [max(looks, key=lambda each: each.facing)]
        turned = (
            not from_behind
            and face < FACE_SEEN
            and max(each.facing for each in looks) < -CLEARLY_TURNED
            and self._is_front(cut, looks)
        )
        if turned:
            looks = [each.turned_round() for each in looks]
        world = _mean([each.world_m for each in looks])
        world[:, :2] = world[:, :2] @ crop.rotation.T
        mask = _mean([each.mask for each in looks])
        height, width = picture.shape[:2]
        return BodyLandmarks(
            presence=float(np.mean([each.presence for each in looks])),
            pixels=crop.in_picture(_mean([each.pixels for each in looks])),
            visibility=_mean([each.visibility for each in looks]),
            world_m=world,
            mask=crop.put_back(mask.astype(np.float32), width=width, height=height),
            faces=max(certain, key=len),
            face=face,
            turned=turned,
        )

    def _both_ways(self, cut: Float[np.ndarray, "s s 3"]) -> list["_Look"]:
        mirrored = self._look_at(np.ascontiguousarray(cut[:, ::-1]))
        return [self._look_at(cut), _unmirrored(mirrored)]

    def _is_front(self, cut: Float[np.ndarray, "s s 3"], looks: Sequence["_Look"]) -> bool:
        """Whether trunk and legs, or legs alone, are taken to be seen from the front.

        Of 45 people from behind three are, and of 60 from the front with hidden faces all but one
        (tuning half).
        """
        pixels = _mean([each.pixels for each in looks])
        shoulders, hips = (pixels[pair, 1].mean() for pair in (SHOULDERS, HIPS))
        for share in CUT_AT:
            below = cut.copy()
            below[: max(round(shoulders + share * (hips - shoulders)), 0)] = 0.0
            if any(
                each.presence >= PRESENT and each.facing > 0.0 for each in self._both_ways(below)
            ):
                return True
        return False

    def _look_at(self, cut: Float[np.ndarray, "s s 3"]) -> "_Look":
        outputs = self._network.outputs(cut)
        landmarks = outputs[(5 * OUTPUT_LANDMARKS,)].reshape(-1, 5)[:LANDMARKS].astype(np.float64)
        heat = logistic(outputs[HEAT_MAP_SIZE, HEAT_MAP_SIZE, OUTPUT_LANDMARKS][..., :LANDMARKS])
        return _Look(
            _refined(landmarks[:, :2], heat),
            logistic(landmarks[:, 3]),
            outputs[(3 * OUTPUT_LANDMARKS,)].reshape(-1, 3)[:LANDMARKS].astype(np.float64),
            logistic(outputs[INPUT_SIZE, INPUT_SIZE, 1][..., 0]),
            float(outputs[(1,)][0]),
        )


class _Look(NamedTuple):
    """One answer of the network, in pixels of the crop."""

    pixels: Float[np.ndarray, "33 2"]
    visibility: Float[np.ndarray, "33"]
    world_m: Float[np.ndarray, "33 3"]
    mask: GreyImage
    presence: float

    @property
    def facing(self) -> float:
        """Cosine of how far the trunk is turned from the camera; 0 where it cannot be told."""
        return trunk_facing(*self.pixels[[*SHOULDERS, *HIPS]]) or 0.0

    def turned_round(self) -> "_Look":
        """The other reading of the same picture: what was near is far, and left is right."""
        world = self.world_m[MIRRORED] * [1.0, 1.0, -1.0]
        return self._replace(
            pixels=self.pixels[MIRRORED], visibility=self.visibility[MIRRORED], world_m=world
        )


def trunk_facing(
    left_shoulder: Float[np.ndarray, "2"],
    right_shoulder: Float[np.ndarray, "2"],
    left_hip: Float[np.ndarray, "2"],
    right_hip: Float[np.ndarray, "2"],
) -> float | None:
    """Cosine of how far a trunk is turned from the camera, in [-1, 1]; None if it has no length.

    1 faces the camera, 0 is seen from the side, -1 from behind.
    """
    down = left_hip + right_hip - left_shoulder - right_shoulder
    length = float(np.linalg.norm(down))
    if length == 0.0:
        return None
    to_left = np.array([down[1], -down[0]]) / length
    breadths = left_shoulder - right_shoulder, left_hip - right_hip
    cosines = [
        2.0 * float(across @ to_left) / length / frontal
        for across, frontal in zip(breadths, FRONTAL_BREADTHS, strict=True)
    ]
    return max(-1.0, min(1.0, sum(cosines) / len(cosines)))


def _contradict(looks: Sequence[_Look]) -> bool:
    """Whether a picture and its mirror image are taken to show the person from other sides."""
    facings = [each.facing for each in looks]
    return max(facings) - min(facings) > CLEARLY_TURNED


def _own(
    faces: Sequence[DetectedFace], head: Float[np.ndarray, "2"], person: DetectedPerson
) -> float:
    """Certainty of the face at a person's head."""
    near = FACE_NEARBY * person.radius
    return max(
        (each.score for each in faces if np.linalg.norm(each.middle - head) < near), default=0.0
    )


def _mean(values: Sequence[np.ndarray]) -> np.ndarray:
    return np.mean(values, axis=0)


def crop_about(person: DetectedPerson) -> SquareCrop:
    """The square that shows a person upright."""
    along = person.rim - person.middle
    return SquareCrop(
        centre=person.middle,
        side=2.0 * CROP_MARGIN * person.radius,
        angle=float(np.arctan2(along[0], -along[1])),
        size=INPUT_SIZE,
    )


def _unmirrored(look: _Look) -> _Look:
    """An answer about the mirror image, turned into one about the person."""
    pixels, world = look.pixels[MIRRORED], look.world_m[MIRRORED]
    pixels[:, 0] = INPUT_SIZE - pixels[:, 0]
    world[:, 0] = -world[:, 0]
    return _Look(pixels, look.visibility[MIRRORED], world, look.mask[:, ::-1], look.presence)


def _refined(
    places: Float[np.ndarray, "33 2"], heat: Float[np.ndarray, "s s 33"]
) -> Float[np.ndarray, "33 2"]:
    """Move each landmark to the centroid of the heat map around where the network puts it.

    Unrefined, the median landmark is off by half as much again. Where the heat is low or a
    landmark lies outside the crop, it stays where it was.
    """
    step = INPUT_SIZE / HEAT_MAP_SIZE
    refined = places.copy()
    for index, (column, row) in enumerate(np.floor(places / step).astype(int)):
        if not (0 <= column < HEAT_MAP_SIZE and 0 <= row < HEAT_MAP_SIZE):
            continue
        top, left = max(0, row - _REACH), max(0, column - _REACH)
        near = heat[top : row + _REACH + 1, left : column + _REACH + 1, index]
        if near.max() < _LEAST_HEAT:
            continue
        rows, columns = np.indices(near.shape)
        total = near.sum()
        refined[index, 0] = step * (left + (columns * near).sum() / total)
        refined[index, 1] = step * (top + (rows * near).sum() / total)
    return refined

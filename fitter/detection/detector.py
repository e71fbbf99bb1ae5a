"""All networks together: who is in a picture, and what is proposed for each person."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
from jaxtyping import Float, UInt8

from fitter.arrays import GreyImage
from fitter.detection.body_landmarks import (
    CLEARLY_TURNED,
    FACE_SEEN,
    PRESENT,
    BodyLandmarks,
    LandmarkNetwork,
    trunk_facing,
)
from fitter.detection.landmark_meanings import (
    HIPS,
    INDEX_OF_POINT,
    LIMB_ENDS,
    SEEN,
    SHOULDERS,
    SLANTS,
    own_pixels,
    spread_m,
)
from fitter.detection.network import Network
from fitter.detection.person_detector import (
    DetectedFace,
    DetectedPerson,
    FaceDetector,
    PersonDetector,
)
from fitter.detection.weights import checked_weights
from fitter.detection.worn_parts import (
    WornPart,
    WornParts,
    WornShares,
    installed_worn_parts,
)
from fitter.request import Click
from fitter.vocabulary.choices import ViewKind

MOST_PERSONS = 8
"""In a crowd, only the largest are looked at."""

MATCHING_SHARE = 0.15
"""Clicks belong to a person if their mean distance from the landmarks is within this share of the
radius of the person's circle."""

FACE_POINTS = frozenset({"nose", "left_eye", "right_eye"})

FACE_HIDDEN = 0.55
"""Certainty of a face below which it is not seen: it is 0.82 at least of 84 people from the front,
and less than this of 56 of 60 from whom boxes, discs, telephones or blur hide it (tuning half). Of
who is seen from behind a face counts from :data:`FACE_SEEN` on: hair looks like one."""

HIDDEN = 0.25
"""Visibility of points of a face that is not seen: the network calls those visible too."""

NEARBY_SHARE = 0.3
"""Nobody is where the clicks are if all landmarks are farther away than this share. People half
hidden by a table are off by 0.16, points of another picture by 0.24 and more (tuning halves)."""


@dataclass(frozen=True, slots=True, kw_only=True)
class LimbSlant:
    """Slant of a limb: the sine of its angle to the plane perpendicular to the view.

    Positive where its far end is farther from the camera; ``sigma`` is the standard deviation.
    """

    sine: float
    sigma: float


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class DetectedSlants:
    """Slants of a person's limbs.

    Attributes
    ----------
    limbs
        By name (``left_thigh`` ...), for limbs whose ends are seen.
    middle
        (2,) middle of the hips, pixels: the view direction is the ray through it.
    """

    limbs: Mapping[str, LimbSlant]
    middle: Float[np.ndarray, "2"]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class DetectedBody:
    """Proposals for one person.

    Attributes
    ----------
    person
        Where they were found.
    points
        By canonical name, in pixels of the picture, each with its own spread. ``occluded`` ones are
        guesses. Points outside the picture are left out.
    visibility
        0 to 1, for each point.
    slants
        How the limbs slant.
    leaning_deg
        How far the trunk leans from the picture's vertical, in space.
    mask
        (h, w) probability that a pixel shows the person.
    faces
        Seen for certain about the head, the most certain first.
    hides_face
        Whether the person is seen from the front, and their face is not, for something covers it.
    """

    person: DetectedPerson
    points: Mapping[str, Click]
    visibility: Mapping[str, float]
    slants: DetectedSlants
    leaning_deg: float
    mask: GreyImage
    faces: tuple[DetectedFace, ...] = ()
    hides_face: bool = False


class Detector:
    """Finds people in pictures; not thread-safe."""

    def __init__(
        self, persons: PersonDetector, landmarks: LandmarkNetwork, worn: WornParts | None = None
    ) -> None:
        self._persons = persons
        self._landmarks = landmarks
        self._worn = worn

    def bodies(
        self, picture: UInt8[np.ndarray, "h w 3"], view: ViewKind | None = None
    ) -> tuple[DetectedBody, ...]:
        """Everybody in a picture (sRGB), the largest and most certain first.

        ``view`` is from where people are said to be seen.
        """
        from_behind = view is ViewKind.BACK
        found: list[DetectedBody] = []
        for person in self._persons.persons(picture)[:MOST_PERSONS]:
            landmarks = self._landmarks.landmarks(picture, person, from_behind=from_behind)
            if person.is_head_down:
                # Raised arms are easily taken for legs; the right way up, more is visible.
                upright = self._landmarks.landmarks(
                    picture, person.upright(), from_behind=from_behind
                )
                if upright.visibility.mean() > landmarks.visibility.mean():
                    person, landmarks = person.upright(), upright
            if landmarks.presence >= PRESENT:
                found.append(_proposed(person, landmarks))
        return tuple(found)

    def worn(
        self, picture: UInt8[np.ndarray, "h w 3"], person: DetectedPerson
    ) -> WornShares | None:
        """What a person's pixels show. None without the network of parts worn."""
        if self._worn is None:
            return None
        maps = self._worn.maps(picture, person)
        shown = np.maximum(1.0 - maps[..., WornPart.BACKGROUND], 0.01)
        return WornShares(
            skin=maps[..., WornPart.SKIN] / shown, outer=maps[..., WornPart.OUTER] / shown
        )


@cache
def installed_detector(folder: Path | None = None) -> Detector:
    """The detector with the installed weights or those of a folder; loaded once per process.

    Raises
    ------
    DetectorUnavailableError
        If it is not installed, or its weights are not the ones it was evaluated with.
    """
    weights = checked_weights(folder)
    return Detector(
        PersonDetector(Network(weights.person_detector)),
        LandmarkNetwork(
            Network(weights.body_landmarks), FaceDetector(Network(weights.face_detector))
        ),
        installed_worn_parts(folder),
    )


def body_of_clicks(
    bodies: Sequence[DetectedBody], clicks: Mapping[str, Click]
) -> DetectedBody | None:
    """The detected person the clicks belong to; None if they match nobody.

    Without clicks, the first person.
    """
    if not clicks:
        return bodies[0] if bodies else None
    distances = [_distance(body, clicks) for body in bodies]
    nearest = int(np.argmin(distances)) if distances else 0
    if not distances or distances[nearest] > MATCHING_SHARE * bodies[nearest].person.radius:
        return None
    return bodies[nearest]


def is_somebody_at(bodies: Sequence[DetectedBody], clicks: Mapping[str, Click]) -> bool:
    """Whether any detected person is where the clicks are; without clicks, whether there is one."""
    if not clicks:
        return bool(bodies)
    return any(_distance(body, clicks) <= NEARBY_SHARE * body.person.radius for body in bodies)


def _distance(body: DetectedBody, clicks: Mapping[str, Click]) -> float:
    """Mean distance of clicks from the person's points of the same names, pixels."""
    apart = [
        np.hypot(click.x - body.points[name].x, click.y - body.points[name].y)
        for name, click in clicks.items()
        if name in body.points
    ]
    return float(np.mean(apart)) if apart else float("inf")


def _proposed(person: DetectedPerson, landmarks: BodyLandmarks) -> DetectedBody:
    height, width = landmarks.mask.shape
    pixels = own_pixels(landmarks)
    facing = trunk_facing(*pixels[[INDEX_OF_POINT[name] for name in (*SHOULDERS, *HIPS)]]) or 0.0
    least = FACE_HIDDEN if facing > 0.0 else FACE_SEEN
    is_faceless = abs(facing) > CLEARLY_TURNED and landmarks.face < least
    points: dict[str, Click] = {}
    visibility: dict[str, float] = {}
    for name, index in INDEX_OF_POINT.items():
        x, y = pixels[index].tolist()
        if not (0.0 <= x <= width and 0.0 <= y <= height):
            continue
        seen = float(landmarks.visibility[index])
        if is_faceless and name in FACE_POINTS:
            seen = min(seen, HIDDEN)
        visibility[name] = seen
        points[name] = Click(x=x, y=y, occluded=seen < SEEN, spread_m=spread_m(name, seen))
    hides_face = is_faceless and facing > 0.0 and points.keys() >= FACE_POINTS
    return DetectedBody(
        person=person,
        points=points,
        visibility=visibility,
        slants=DetectedSlants(
            limbs={} if landmarks.turned else _slants(landmarks, points),
            middle=landmarks.pixels[[INDEX_OF_POINT[hip] for hip in HIPS]].mean(axis=0),
        ),
        leaning_deg=_leaning_deg(landmarks),
        mask=landmarks.mask,
        faces=landmarks.faces,
        hides_face=hides_face,
    )


def _leaning_deg(landmarks: BodyLandmarks) -> float:
    shoulders, hips = (
        landmarks.world_m[[INDEX_OF_POINT[each] for each in pair]].mean(axis=0)
        for pair in (SHOULDERS, HIPS)
    )
    up = shoulders - hips
    return float(np.degrees(np.arctan2(np.hypot(up[0], up[2]), -up[1])))


def _slants(landmarks: BodyLandmarks, points: Mapping[str, Click]) -> dict[str, LimbSlant]:
    slants: dict[str, LimbSlant] = {}
    for limb, (near, far) in LIMB_ENDS.items():
        for side in ("left", "right"):
            ends = f"{side}_{near}", f"{side}_{far}"
            if any(end not in points or points[end].occluded for end in ends):
                continue
            start, end = (landmarks.world_m[INDEX_OF_POINT[each]] for each in ends)
            along = (end - start) / np.linalg.norm(end - start)
            known = SLANTS[limb]
            sine = np.clip(known.gain * along[2] + known.offset, -1.0, 1.0)
            slants[f"{side}_{limb}"] = LimbSlant(sine=float(sine), sigma=known.sigma)
    return slants

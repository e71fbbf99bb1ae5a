"""The second network: a person's landmarks, in the picture and in space, and their mask."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from jaxtyping import Float, UInt8

from fitter.arrays import GreyImage
from fitter.detection.network import PictureNetwork, SquareCrop
from fitter.detection.person_detector import DetectedPerson

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
    """

    presence: float
    pixels: Float[np.ndarray, "33 2"]
    visibility: Float[np.ndarray, "33"]
    world_m: Float[np.ndarray, "33 3"]
    mask: GreyImage


class LandmarkNetwork:
    """Finds one person's landmarks, with :data:`fitter.detection.weights.BODY_LANDMARKS`.

    Each person is evaluated twice, as seen and mirrored, and the mean is returned: the network
    treats left and right a little differently.
    """

    def __init__(self, network: PictureNetwork) -> None:
        self._network = network

    def landmarks(
        self, picture: UInt8[np.ndarray, "h w 3"], person: DetectedPerson
    ) -> BodyLandmarks:
        """A detected person's landmarks in a picture (sRGB)."""
        crop = _crop_about(person)
        cut = crop.cut_from(picture).astype(np.float32) / 255.0
        seen = self._look_at(cut)
        mirrored = _unmirrored(self._look_at(np.ascontiguousarray(cut[:, ::-1])))
        pixels = 0.5 * (seen.pixels + mirrored.pixels)
        world = 0.5 * (seen.world_m + mirrored.world_m)
        world[:, :2] = world[:, :2] @ crop.rotation.T
        mask = 0.5 * (seen.mask + mirrored.mask)
        height, width = picture.shape[:2]
        return BodyLandmarks(
            presence=0.5 * (seen.presence + mirrored.presence),
            pixels=crop.in_picture(pixels),
            visibility=0.5 * (seen.visibility + mirrored.visibility),
            world_m=world,
            mask=crop.put_back(mask.astype(np.float32), width=width, height=height),
        )

    def _look_at(self, cut: Float[np.ndarray, "s s 3"]) -> "_Look":
        outputs = self._network.outputs(cut)
        landmarks = outputs[(5 * OUTPUT_LANDMARKS,)].reshape(-1, 5)[:LANDMARKS].astype(np.float64)
        heat = _logistic(outputs[HEAT_MAP_SIZE, HEAT_MAP_SIZE, OUTPUT_LANDMARKS][..., :LANDMARKS])
        return _Look(
            _refined(landmarks[:, :2], heat),
            _logistic(landmarks[:, 3]),
            outputs[(3 * OUTPUT_LANDMARKS,)].reshape(-1, 3)[:LANDMARKS].astype(np.float64),
            _logistic(outputs[INPUT_SIZE, INPUT_SIZE, 1][..., 0]),
            float(outputs[(1,)][0]),
        )


class _Look(NamedTuple):
    """One answer of the network, in pixels of the crop."""

    pixels: Float[np.ndarray, "33 2"]
    visibility: Float[np.ndarray, "33"]
    world_m: Float[np.ndarray, "33 3"]
    mask: GreyImage
    presence: float


def _crop_about(person: DetectedPerson) -> SquareCrop:
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


def _logistic(values: np.ndarray) -> np.ndarray:
    return 1.0 / (1.0 + np.exp(-np.clip(values.astype(np.float64), -50.0, 50.0)))

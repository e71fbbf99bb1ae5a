"""Background, skin, hair, shoes, cloth and outer cloth, told pixel by pixel on a person's crop.

A small perceptron reads, at each pixel, what the landmark network computed there on its way, at
strides 2 to 32 (a hypercolumn; Hariharan et al., CVPR 2015), beside colour, colour against that of
the face and of the hands, the colours around, and the landmarks' places. The landmark network has
seen real people; the perceptron learns from drawn ones (:mod:`fitter.training.dressed`). Its first
layer is linear, so each map is multiplied at its own size and then enlarged.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from enum import IntEnum
from functools import cache
from pathlib import Path
from typing import Final

import cv2
import numpy as np
from jaxtyping import Float, Float32, UInt8

from fitter.arrays import GreyImage
from fitter.detection.body_landmarks import INPUT_SIZE, crop_about
from fitter.detection.network import ActivationNetwork
from fitter.detection.person_detector import DetectedPerson
from fitter.detection.weights import checked_weights

HEAD_FILE: Final = Path(__file__).parent / "data" / "worn_parts.npz"


class WornPart(IntEnum):
    """Channels of the maps; shoes are with socks, outer cloth is worn over other cloth."""

    BACKGROUND = 0
    SKIN = 1
    HAIR = 2
    SHOES = 3
    CLOTH = 4
    OUTER = 5


ACTIVATIONS: Final[Mapping[int, tuple[int, ...]]] = {
    128: (206, 209, 286),
    64: (216, 219, 279, 298),
    32: (226, 277),
    16: (251, 275),
    8: (269,),
}
"""Tensors of :data:`fitter.detection.weights.BODY_LANDMARKS` by the side of their maps: narrow ends
of the encoder's blocks, sums of the decoder, heat maps of landmarks."""

LANDMARKS: Final = 337
"""The tensor with 39 landmarks of five numbers, x and y first, pixels of the crop."""

FACE, HANDS, EARS = (0, 9, 10), (15, 16, 17, 18, 19, 20), (7, 8)
"""Nose and corners of the mouth; wrists, small and index fingers."""

PLACED: Final = (0, 7, 8, 9, 10, *range(11, 17), 19, 20, *range(23, 33))
"""Landmarks whose nearness is told."""

SIZE: Final = INPUT_SIZE // 2
"""Side of the maps: colours are read, and parts told, at half the size of the crop."""

NEAR_PX: Final = (3.0, 9.0)
AROUND_PX: Final = (1.0, 2.0, 5.0)
ROUGH_PX: Final = (1.0, 2.5)
"""Reach of landmarks, of the colours around, and of their spread: pixels of the maps."""

DARKEST: Final = 0.01
"""Added to linear light before its logarithm."""

LOG_LIGHT: Final = np.log((np.arange(256) / 255.0) ** 2.2 + DARKEST).astype(np.float32)
"""By display value."""

Maps = Float32[np.ndarray, "_ _ _"]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Hypercolumns:
    """Inputs of the perceptron at each pixel of a crop, in the order of its first layer's rows.

    Attributes
    ----------
    activations
        By the side of their maps, the largest first.
    colours
        (SIZE, SIZE, 40) as :func:`colour_maps`.
    places
        (SIZE / 2, SIZE / 2, 48) as :func:`place_maps`.
    """

    activations: Mapping[int, Maps]
    colours: Maps
    places: Maps

    @property
    def maps(self) -> list[Maps]:
        """All of them."""
        return [*self.activations.values(), self.colours, self.places]

    def at(self, rows: np.ndarray, columns: np.ndarray) -> Float[np.ndarray, "k r"]:
        """Every input at some pixels; maps that are smaller are interpolated."""
        return np.concatenate([_interpolated(maps, rows, columns) for maps in self.maps], axis=1)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class WornHead:
    """Weights (in, out) and biases of the perceptron's three layers."""

    weights: tuple[Float32[np.ndarray, "_ _"], ...]
    biases: tuple[Float32[np.ndarray, " _"], ...]

    def probabilities(self, seen: Hypercolumns) -> Float32[np.ndarray, "t t 6"]:
        """Shares of the six parts, a pixel for each four of the crop."""
        first, start = self.weights[0], 0
        values = np.tile(self.biases[0], (SIZE * SIZE, 1))
        for maps in seen.maps:
            side, channels = len(maps), maps.shape[2]
            products = maps.reshape(-1, channels) @ first[start : start + channels]
            values += _enlarged(products.reshape(side, side, -1)).reshape(values.shape)
            start += channels
        for weights, biases in zip(self.weights[1:], self.biases[1:], strict=True):
            values = np.maximum(values, 0.0, out=values) @ weights
            values += biases
        powers = np.exp(values - values.max(axis=1, keepdims=True))
        return (powers / powers.sum(axis=1, keepdims=True)).reshape(SIZE, SIZE, -1)


def hypercolumns(network: ActivationNetwork, crop: UInt8[np.ndarray, "s s 3"]) -> Hypercolumns:
    """Everything the perceptron reads of a crop (sRGB)."""
    wanted = [*(each for some in ACTIVATIONS.values() for each in some), LANDMARKS]
    found = network.activations(crop.astype(np.float32) / 255.0, wanted)
    landmarks = found[LANDMARKS].reshape(39, 5)
    half = cv2.resize(crop, (SIZE, SIZE), interpolation=cv2.INTER_AREA)
    return Hypercolumns(
        activations={
            side: np.concatenate([found[each] for each in some], axis=2)
            for side, some in ACTIVATIONS.items()
        },
        colours=colour_maps(half, 0.5 * landmarks),
        places=place_maps(0.5 * landmarks),
    )


def colour_maps(half: UInt8[np.ndarray, "s s 3"], landmarks: Float[np.ndarray, "39 5"]) -> Maps:
    """(s, s, 40): nine colours, as they are and at three breadths around, their spread, edges.

    The nine are sRGB, and log light over that about the face and over that of the hands. Landmarks
    are in pixels of what is read.
    """
    light = LOG_LIGHT[half]
    ears = landmarks[EARS, :2]
    face = _median(light, landmarks[FACE, :2], float(np.linalg.norm(ears[0] - ears[1])) / 4.0)
    hands = _median(light, landmarks[HANDS, :2], 1.0)
    against = [np.clip(light - each, -2.0, 2.0) / 2.0 for each in (face, hands)]
    shown = half.astype(np.float32) / 127.5 - 1.0
    colours = np.concatenate([shown, *against], axis=2)
    around = [cv2.GaussianBlur(colours, (0, 0), reach) for reach in AROUND_PX]
    grey = shown.mean(axis=2)
    spreads: list[np.ndarray] = []
    for reach in ROUGH_PX:
        mean = cv2.GaussianBlur(grey, (0, 0), reach)
        variance = cv2.GaussianBlur(grey * grey, (0, 0), reach) - mean * mean
        spreads.append(3.0 * np.sqrt(np.maximum(variance, 0.0))[..., None])
    slopes = [np.abs(cv2.Sobel(grey, cv2.CV_32F, *axis)) for axis in ((1, 0), (0, 1))]
    edges = cv2.GaussianBlur(np.stack(slopes, axis=2), (0, 0), ROUGH_PX[0])
    return np.concatenate([colours, *around, *spreads, edges], axis=2)


def place_maps(landmarks: Float[np.ndarray, "39 5"]) -> Float32[np.ndarray, "s s 48"]:
    """Nearness to landmarks, within either reach, and where in the crop."""
    middles = np.arange(1.0, SIZE, 2.0, dtype=np.float32)
    away = [(middles[:, None] - landmarks[PLACED, axis].astype(np.float32)) ** 2 for axis in (0, 1)]
    near = [[np.exp(-0.5 * each / reach**2) for each in away] for reach in NEAR_PX]
    beside = [down[:, None] * across[None] for across, down in near]
    where = np.stack(np.meshgrid(middles, middles), axis=-1) / (0.5 * SIZE) - 1.0
    return np.concatenate([*beside, where], axis=-1)


def _median(light: Maps, places: Float[np.ndarray, "p 2"], radius: float) -> np.ndarray:
    """(3,) median in squares about some places, which are moved into the picture."""
    reach, size = max(int(radius), 1), len(light)
    found: list[np.ndarray] = []
    for x, y in np.clip(places, 1, size - 2).astype(int).tolist():
        rows, columns = (slice(max(at - reach, 0), at + reach + 1) for at in (y, x))
        found.append(light[rows, columns].reshape(-1, 3))
    return np.median(np.concatenate(found), axis=0)


def _enlarged(maps: Maps) -> Maps:
    if len(maps) == SIZE:
        return maps
    return cv2.resize(maps, (SIZE, SIZE), interpolation=cv2.INTER_LINEAR)


def _interpolated(maps: Maps, rows: np.ndarray, columns: np.ndarray) -> Float[np.ndarray, "k c"]:
    """Some pixels of the enlarged maps."""
    side = len(maps)
    places = [np.clip((each + 0.5) * side / SIZE - 0.5, 0, side - 1) for each in (rows, columns)]
    row, column = (np.minimum(each.astype(int), side - 2) for each in places)
    down, across = ((places[0] - row)[:, None], (places[1] - column)[:, None])
    above, below = (
        maps[each, column] * (1.0 - across) + maps[each, column + 1] * across
        for each in (row, row + 1)
    )
    return above * (1.0 - down) + below * down


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class WornShares:
    """Probabilities (h, w) of skin and of outer cloth where a pixel shows the person."""

    skin: GreyImage
    outer: GreyImage


class WornParts:
    """The landmark network's activations and the perceptron on them; not thread-safe."""

    def __init__(self, network: ActivationNetwork, head: WornHead) -> None:
        self._network, self._head = network, head

    def maps(
        self, picture: UInt8[np.ndarray, "h w 3"], person: DetectedPerson
    ) -> Float32[np.ndarray, "h w 6"]:
        """Probability of each :class:`WornPart` at each pixel of a picture (sRGB).

        The mean over the crop and its mirror image. Beyond the crop all is background.
        """
        crop = crop_about(person)
        cut = crop.cut_from(picture)
        mirrored = self._of_crop(np.ascontiguousarray(cut[:, ::-1]))[:, ::-1]
        found = 0.5 * (self._of_crop(cut) + mirrored)
        height, width = picture.shape[:2]
        found_in = replace(crop, size=len(found))
        maps = [
            found_in.put_back(np.ascontiguousarray(found[:, :, part]), width=width, height=height)
            for part in WornPart
        ]
        maps[WornPart.BACKGROUND] = 1.0 - np.sum(maps[WornPart.SKIN :], axis=0)
        return np.stack(maps, axis=2)

    def _of_crop(self, crop: UInt8[np.ndarray, "s s 3"]) -> Float32[np.ndarray, "t t 6"]:
        return self._head.probabilities(hypercolumns(self._network, crop))


def load_head(file: Path = HEAD_FILE) -> WornHead:
    """Read the weights that ``python -m fitter.training.dressed`` writes."""
    with np.load(file, allow_pickle=False) as archive:
        layers = range(len(archive.files) // 2)
        return WornHead(
            weights=tuple(archive[f"weights_{each}"].astype(np.float32) for each in layers),
            biases=tuple(archive[f"biases_{each}"].astype(np.float32) for each in layers),
        )


@cache
def installed_worn_parts(folder: Path | None = None) -> WornParts:
    """The packaged perceptron on the installed detector's network; loaded once per process.

    Raises
    ------
    DetectorUnavailableError
        If the detector is not installed, or its weights are not the ones it was evaluated with.
    """
    return WornParts(ActivationNetwork(checked_weights(folder).body_landmarks), load_head())

"""What people wear, by pixel: the perceptron, and the packaged weights on drawn people."""

from collections.abc import Mapping, Sequence
from itertools import pairwise

import cv2
import numpy as np
import pytest

from fitter.detection.network import ActivationNetwork, Network
from fitter.detection.person_detector import DetectedPerson
from fitter.detection.weights import checked_weights
from fitter.detection.worn_parts import (
    ACTIVATIONS,
    LANDMARKS,
    WornHead,
    WornPart,
    WornParts,
    hypercolumns,
    installed_worn_parts,
)
from fitter.errors import DetectorUnavailableError
from fitter.training.dressed.pictures import SIZE, dressed_picture

CHANNELS = 3


@pytest.fixture
def rng() -> np.random.Generator:
    return np.random.default_rng(20261127)


class FakeActivations(ActivationNetwork):
    """Maps that are drawn from the picture's mean, and landmarks in the crop."""

    def __init__(self) -> None:
        pass

    def activations(self, picture: np.ndarray, wanted: Sequence[int]) -> Mapping[int, np.ndarray]:
        rng = np.random.default_rng(int(1000 * picture.mean()))
        sides = {each: side for side, some in ACTIVATIONS.items() for each in some}
        return {
            each: rng.uniform(20.0, 230.0, 195).astype(np.float32)
            if each == LANDMARKS
            else rng.normal(size=(sides[each], sides[each], CHANNELS)).astype(np.float32)
            for each in wanted
        }


def in_the_middle() -> DetectedPerson:
    """Somebody whose crop is a picture of the crop's size."""
    middle = np.array([SIZE / 2, SIZE / 2])
    return DetectedPerson(score=1.0, middle=middle, rim=middle - np.array([0.0, SIZE / 2.5]))


@pytest.fixture
def head(rng: np.random.Generator) -> WornHead:
    inputs = 12 * CHANNELS + 40 + 48
    sizes = (inputs, 8, 7, len(WornPart))
    return WornHead(
        weights=tuple(rng.normal(0.0, 0.3, size).astype(np.float32) for size in pairwise(sizes)),
        biases=tuple(rng.normal(size=size).astype(np.float32) for size in sizes[1:]),
    )


def crop(rng: np.random.Generator) -> np.ndarray:
    return rng.integers(0, 256, (SIZE, SIZE, 3)).astype(np.uint8)


def test_maps_are_what_the_perceptron_says_of_enlarged_maps(
    head: WornHead, rng: np.random.Generator
):
    seen = hypercolumns(FakeActivations(), crop(rng))
    size = (SIZE // 2, SIZE // 2)
    values = np.concatenate([cv2.resize(each, size) for each in seen.maps], axis=2)
    rows, columns = np.indices(size)
    read = seen.at(rows.ravel(), columns.ravel())
    np.testing.assert_allclose(read.reshape(values.shape), values, atol=1e-5)
    for number, (weights, biases) in enumerate(zip(head.weights, head.biases, strict=True)):
        values = (np.maximum(values, 0.0) if number else values) @ weights + biases
    shares = np.exp(values) / np.exp(values).sum(axis=2, keepdims=True)
    np.testing.assert_allclose(head.probabilities(seen), shares, atol=1e-4)


def test_probabilities_add_up_and_all_beyond_the_crop_is_background(
    head: WornHead, rng: np.random.Generator
):
    picture = np.zeros((300, 500, 3), np.uint8)
    picture[:SIZE, :SIZE] = crop(rng)
    maps = WornParts(FakeActivations(), head).maps(picture, in_the_middle())
    assert maps.shape == (300, 500, len(WornPart))
    assert maps.min() > -1e-5
    assert maps.sum(axis=2) == pytest.approx(1.0, abs=1e-5)
    assert maps[:, SIZE + 2 :, WornPart.BACKGROUND] == pytest.approx(1.0)


def test_a_mirrored_picture_has_mirrored_maps(head: WornHead, rng: np.random.Generator):
    parts, picture = WornParts(FakeActivations(), head), crop(rng)
    maps = parts.maps(picture, in_the_middle())
    mirrored = parts.maps(np.ascontiguousarray(picture[:, ::-1]), in_the_middle())
    assert maps == pytest.approx(mirrored[:, ::-1], abs=1e-5)


def test_activations_end_in_the_networks_outputs():
    file, picture = checked_weights().body_landmarks, dressed_picture(1).picture / 255.0
    outputs = Network(file).outputs(picture.astype(np.float32))
    found = ActivationNetwork(file).activations(picture.astype(np.float32), [LANDMARKS, 298])
    assert found[LANDMARKS] == pytest.approx(outputs[195,], abs=1e-4)
    assert found[298] == pytest.approx(outputs[64, 64, 39], abs=1e-4)


@pytest.mark.slow
def test_drawn_people_that_were_not_learned_from_are_told_by_pixel():
    same = {part: [0, 0] for part in (WornPart.SKIN, WornPart.CLOTH)}
    for seed in range(8):
        picture, labels = dressed_picture(seed)
        found = installed_worn_parts().maps(picture, in_the_middle()).argmax(axis=2)
        for part, counts in same.items():
            either = (found == part) | (labels == part)
            counts[0] += int(((found == part) & (labels == part)).sum())
            counts[1] += int(either.sum())
    assert all(both > 0.5 * either for both, either in same.values())


def test_without_the_detector_nothing_is_told(tmp_path):
    with pytest.raises(DetectorUnavailableError):
        installed_worn_parts(tmp_path)

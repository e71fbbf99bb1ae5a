"""The perceptron's training: derivatives, and what it can learn."""

import numpy as np
import pytest

from fitter.detection.worn_parts import WornPart, load_head
from fitter.training.dressed.learning import learned, loss_and_slopes, write_head
from fitter.training.dressed.samples import Samples


@pytest.fixture
def rng() -> np.random.Generator:
    return np.random.default_rng(20261127)


def layers(rng: np.random.Generator) -> list[np.ndarray]:
    shapes = (5, 4), (4,), (4, 3), (3,), (3, 6), (6,)
    return [rng.normal(size=shape) for shape in shapes]


def test_slopes_are_finite_differences_of_the_loss(rng: np.random.Generator):
    at, read = layers(rng), rng.normal(size=(7, 5))
    labels = rng.integers(0, 6, 7)
    _, slopes = loss_and_slopes(at, read, labels)
    for number, each in enumerate(at):
        direction = rng.normal(size=each.shape)
        losses = []
        for step in (-1e-6, 1e-6):
            moved = [*at]
            moved[number] = each + step * direction
            losses.append(loss_and_slopes(moved, read, labels)[0])
        slope = (losses[1] - losses[0]) / 2e-6
        assert (slopes[number] * direction).sum() == pytest.approx(slope, rel=1e-5, abs=1e-8)


def test_what_a_plane_tells_apart_is_learned(rng: np.random.Generator, tmp_path):
    read = rng.normal(3.0, 2.0, (12_000, 8))
    labels = np.where(read[:, 0] > 3.0, WornPart.SKIN, WornPart.CLOTH).astype(np.int64)
    *_, (_, head) = learned(Samples(read.astype(np.float16), labels, np.ones(12_000)), 30, rng)
    write_head(tmp_path / "head.npz", head)
    stored = load_head(tmp_path / "head.npz")
    values = read
    for number, (weights, biases) in enumerate(zip(stored.weights, stored.biases, strict=True)):
        values = (np.maximum(values, 0.0) if number else values) @ weights + biases
    assert (values.argmax(axis=1) == labels).mean() > 0.97

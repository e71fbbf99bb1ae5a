"""A perceptron learned from samples: Adam (Kingma and Ba 2015) with decoupled weight decay."""

from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path
from typing import Final

import numpy as np
from jaxtyping import Float, Integer

from fitter.detection.worn_parts import WornHead, WornPart
from fitter.training.dressed.samples import Samples

HIDDEN: Final = (96, 48)
BATCH: Final = 1024
RATE, LAST_RATE = 2e-3, 1e-5
DECAY: Final = 2e-2
DROPPED, NOISE = 0.1, 0.05
"""Share of the inputs that a sample lacks, and the deviation of noise added to the others."""

SMOOTHING: Final = 0.02
MOMENTS: Final = (0.9, 0.999)
LEAST_DEVIATION: Final = 0.05

Layers = list[Float[np.ndarray, "..."]]
"""Weights and biases in turn."""


def learned(
    found: Samples, epochs: int, rng: np.random.Generator
) -> Iterator[tuple[str, WornHead]]:
    """The perceptron after each epoch, with a line that says how well it does."""
    some = found.read[::7].astype(np.float32)
    mean, deviation = some.mean(axis=0), some.std(axis=0) + LEAST_DEVIATION
    sizes = (found.read.shape[1], *HIDDEN, len(WornPart))
    layers: Layers = []
    for before, after in pairwise(sizes):
        bound = np.sqrt(6.0 / before) / (1.0 if after in HIDDEN else 2.0)
        layers += [rng.uniform(-bound, bound, (before, after)).astype(np.float32)]
        layers += [np.zeros(after, np.float32)]
    moments = [[np.zeros_like(each) for each in layers] for _ in MOMENTS]
    batches = len(found.labels) // BATCH
    for epoch in range(epochs):
        order, losses = rng.permutation(len(found.labels)), 0.0
        for number in range(batches):
            step = epoch * batches + number
            chosen = order[number * BATCH : (number + 1) * BATCH]
            read = (found.read[chosen].astype(np.float32) - mean) / deviation
            read *= (rng.random(read.shape, np.float32) > DROPPED) / np.float32(1.0 - DROPPED)
            read += NOISE * rng.standard_normal(read.shape, np.float32)
            loss, slopes = loss_and_slopes(layers, read, found.labels[chosen])
            share = step / (epochs * batches)
            rate = LAST_RATE + RATE * 0.5 * (1.0 + np.cos(np.pi * share))
            _descend(layers, slopes, moments, rate, step + 1)
            losses += loss
        line = f"epoch {epoch + 1} of {epochs}: {losses / batches:.3f} nats"
        yield line, _head(layers, mean, deviation, _nats_of_parts(found))


def loss_and_slopes(
    layers: Layers, read: Float[np.ndarray, "k r"], labels: Integer[np.ndarray, " k"]
) -> tuple[float, Layers]:
    """Mean cross-entropy with smoothed labels, nats, and its derivative by weights and biases."""
    weights, biases = layers[::2], layers[1::2]
    inputs, values = [read], read @ weights[0] + biases[0]
    for each, bias in zip(weights[1:], biases[1:], strict=True):
        inputs.append(np.maximum(values, 0.0))
        values = inputs[-1] @ each + bias
    values = values - values.max(axis=1, keepdims=True)
    logs = values - np.log(np.exp(values).sum(axis=1, keepdims=True))
    wanted = np.full_like(logs, SMOOTHING / logs.shape[1])
    wanted[np.arange(len(labels)), labels] += 1.0 - SMOOTHING
    slope = (np.exp(logs) - wanted) / len(labels)
    slopes: Layers = []
    for number in reversed(range(len(weights))):
        slopes = [inputs[number].T @ slope, slope.sum(axis=0), *slopes]
        slope = (slope @ weights[number].T) * (inputs[number] > 0.0)
    return float(-(wanted * logs).sum(axis=1).mean()), slopes


def _descend(layers: Layers, slopes: Layers, moments: list[Layers], rate: float, step: int) -> None:
    for number, slope in enumerate(slopes):
        for moment, kept, value in zip(moments, MOMENTS, (slope, slope * slope), strict=True):
            moment[number] *= kept
            moment[number] += (1.0 - kept) * value
        first, second = (
            moment[number] / (1.0 - kept**step)
            for moment, kept in zip(moments, MOMENTS, strict=True)
        )
        if layers[number].ndim == 2:
            layers[number] *= 1.0 - rate * DECAY
        layers[number] -= rate * first / (np.sqrt(second) + 1e-8)


def _nats_of_parts(found: Samples) -> Float[np.ndarray, "6"]:
    """Log of how many pixels a sample of each part stands for, about a mean of zero."""
    nats = np.array([np.log(_mean(found.stands_for[found.labels == part])) for part in WornPart])
    return nats - nats.mean()


def _mean(values: np.ndarray) -> float:
    return float(values.mean()) if len(values) else 1.0


def _head(
    layers: Layers, mean: np.ndarray, deviation: np.ndarray, nats: Float[np.ndarray, "6"]
) -> WornHead:
    """The perceptron on inputs as they are, for parts as frequent as they are.

    The inputs' scale goes into the first layer. Parts are sampled alike often; the last biases take
    that back.
    """
    # Rounded as it is stored, so that the bias takes back what rounding adds on average.
    first = (layers[0] / deviation[:, None]).astype(np.float16).astype(np.float32)
    biases = [layers[1] - mean @ first, *layers[3:-1:2], layers[-1] + nats]
    return WornHead(
        weights=(first, *layers[2::2]),
        biases=tuple(each.astype(np.float32) for each in biases),
    )


def write_head(file: Path, head: WornHead) -> None:
    """Write what :func:`fitter.detection.worn_parts.load_head` reads, in half precision."""
    file.parent.mkdir(parents=True, exist_ok=True)
    named = {f"weights_{number}": each for number, each in enumerate(head.weights)}
    named |= {f"biases_{number}": each for number, each in enumerate(head.biases)}
    np.savez(
        file, allow_pickle=False, **{name: each.astype(np.float16) for name, each in named.items()}
    )

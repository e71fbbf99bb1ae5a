"""The samples shipped with the package: pictures, their clicks, the truth one was rendered from."""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Final

FOLDER: Final = Path(__file__).parent


@dataclass(frozen=True, slots=True, kw_only=True)
class Sample:
    """A picture, its request as JSON text, and its true measurements by name."""

    image: bytes
    request: bytes
    truth: Mapping[str, float]


def load_sample(folder: Path = FOLDER) -> Sample:
    """Read ``sample.jpg``, ``request.json`` and ``truth.json``."""
    truth = json.loads((folder / "truth.json").read_text())
    return Sample(
        image=(folder / "sample.jpg").read_bytes(),
        request=(folder / "request.json").read_bytes(),
        truth={name: float(value) for name, value in truth["measurements"].items()},
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class PictureSample:
    """A picture, and its request as JSON text."""

    image: bytes
    request: bytes


@dataclass(frozen=True, slots=True, kw_only=True)
class SubjectSample:
    """Somebody whose body is known, in several poses.

    Attributes
    ----------
    pictures
        By the pose's name.
    measurements
        The true ones by name, centimetres and kilograms.
    bodies
        An ``npz`` of true vertices as whole numbers of ``step_m``: ``canonical`` at rest, and of
        each pose under its name, in the camera frame.
    """

    pictures: Mapping[str, PictureSample]
    measurements: Mapping[str, float]
    bodies: bytes


def load_subject(folder: Path = FOLDER / "subject") -> SubjectSample:
    """Read ``subject.json``, ``bodies.npz`` and the pictures."""
    document = json.loads((folder / "subject.json").read_text())
    return SubjectSample(
        pictures={
            name: PictureSample(
                image=(folder / f"{name}.jpg").read_bytes(),
                request=json.dumps(request).encode(),
            )
            for name, request in document["requests"].items()
        },
        measurements=document["measurements"],
        bodies=(folder / "bodies.npz").read_bytes(),
    )

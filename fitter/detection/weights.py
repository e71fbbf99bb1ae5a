"""Place of the networks' weights: a package that is never imported, or a folder."""

import hashlib
import importlib.util
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from fitter.errors import DetectorUnavailableError

CARRIER: Final = "mediapipe"
CARRIER_REQUIREMENT: Final = "mediapipe==0.10.21"
"""The last version whose wheel holds the files; it is installed without its dependencies."""

RUNTIME: Final = "ai_edge_litert"

INSTALLATION: Final = (
    f"pip install 'maquette[detector]' && pip install --no-deps {CARRIER_REQUIREMENT}"
)
REMEDY: Final = f"Install it with: {INSTALLATION}."


@dataclass(frozen=True, slots=True, kw_only=True)
class WeightFile:
    """A network's file: its folder within the package, its name, and what it must contain."""

    folder: str
    name: str
    sha256: str


PERSON_DETECTOR: Final = WeightFile(
    folder="modules/pose_detection",
    name="pose_detection.tflite",
    sha256="9ba9dd3d42efaaba86b4ff0122b06f29c4122e756b329d89dca1e297fd8f866c",
)
BODY_LANDMARKS: Final = WeightFile(
    folder="modules/pose_landmark",
    name="pose_landmark_full.tflite",
    sha256="e9a5c5cb17f736fafd4c2ec1da3b3d331d6edbe8a0d32395855aeb2cdfd64b9f",
)


FACE_DETECTOR: Final = WeightFile(
    folder="modules/face_detection",
    name="face_detection_short_range.tflite",
    sha256="bbff11cebd1eb27a1e004cae0b0e63ec8c551cbf34a4451148b4908b8db3eca8",
)

FILES: Final = (PERSON_DETECTOR, BODY_LANDMARKS, FACE_DETECTOR)


@dataclass(frozen=True, slots=True, kw_only=True)
class DetectorWeights:
    """The files, each what it must be."""

    person_detector: Path
    body_landmarks: Path
    face_detector: Path


def detector_fault(folder: Path | None = None) -> str | None:
    """Why there is no detector here, as a sentence; None if there seems to be one.

    Checks that the files and the runtime exist, without reading or loading them.
    """
    if importlib.util.find_spec(RUNTIME) is None:
        return "The package ai-edge-litert, which runs the detector, is not installed."
    for each in FILES:
        path = _path(each, folder)
        if path is None or not path.is_file():
            where = f"the package {CARRIER}" if folder is None else str(folder)
            return f"The detector's weights, {each.name}, are not in {where}."
    return None


def checked_weights(folder: Path | None = None) -> DetectorWeights:
    """Check the files of the package, or of a folder that holds them side by side.

    Raises
    ------
    DetectorUnavailableError
        If the detector is not installed, or a file is not the one it was evaluated with.
    """
    fault = detector_fault(folder)
    if fault is not None:
        raise DetectorUnavailableError(reason=fault, remedy=REMEDY)
    return DetectorWeights(
        person_detector=_checked(PERSON_DETECTOR, folder),
        body_landmarks=_checked(BODY_LANDMARKS, folder),
        face_detector=_checked(FACE_DETECTOR, folder),
    )


def _checked(file: WeightFile, folder: Path | None) -> Path:
    path = _path(file, folder)
    assert path is not None, "the caller has looked for faults"
    with path.open("rb") as content:
        digest = hashlib.file_digest(content, "sha256").hexdigest()
    if digest != file.sha256:
        reason = f"{file.name} is another file than that of {CARRIER_REQUIREMENT}."
        raise DetectorUnavailableError(reason=reason, remedy=REMEDY)
    return path


def _path(file: WeightFile, folder: Path | None) -> Path | None:
    """Expected path of a file; None if the package is not installed."""
    if folder is not None:
        return folder / file.name
    # Finding a package does not import it.
    package = importlib.util.find_spec(CARRIER)
    if package is None or package.origin is None:
        return None
    return Path(package.origin).parent / file.folder / file.name

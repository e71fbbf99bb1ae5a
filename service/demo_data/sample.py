"""The sample shipped with the package: a picture, its clicks, the truth it was rendered from."""

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

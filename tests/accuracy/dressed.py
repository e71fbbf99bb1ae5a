"""Dressed pictures of bodies by another maker, with truth: beside the repository, and not in it."""

import json
from dataclasses import replace

import numpy as np
from PIL import Image as PillowImage

from tests.accuracy.files import read_labels
from tests.accuracy.foreign import foreign_picture
from tests.accuracy.scene import Series
from tests.accuracy.true_picture import TruePicture
from tests.shared_data import NOT_SHIPPED, SHARED_DATA

FOLDER = SHARED_DATA / "dressed"

MISSING = f"no dressed pictures: they need ../shared/data/dressed, {NOT_SHIPPED}"


def dressed_names() -> list[str]:
    """The pictures; none where they are not beside the repository."""
    return sorted(path.name for path in FOLDER.glob("v*"))


def dressed_picture(name: str) -> TruePicture:
    """Read a picture of this name; its body's own silhouette is without clothes."""
    body = np.asarray(PillowImage.open(FOLDER / name / "body_mask.png").convert("L")) > 127
    return replace(
        foreign_picture(name, FOLDER),
        series=Series.DRESSED,
        body_mask=body,
        outfit=garments(name),
        labels=read_labels(FOLDER / name / "labels.png"),
    )


def garments(name: str) -> str:
    """What the person wears, in words."""
    return json.loads((FOLDER / name / "truth.json").read_text())["dress"]["class"]

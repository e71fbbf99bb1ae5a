"""Dressed pictures of bodies by another maker, with truth: beside the repository, and not in it."""

import json
from dataclasses import replace

import numpy as np
from PIL import Image as PillowImage

from fitter.fits.pipeline import PACKAGED
from fitter.population.body_estimate import estimate_body
from fitter.request import KnownMeasurement
from tests.evaluation.files import read_labels
from tests.evaluation.foreign import foreign_picture
from tests.evaluation.scene import Series
from tests.evaluation.table import MEASUREMENTS
from tests.evaluation.true_picture import TruePicture
from tests.shared_data import NOT_SHIPPED, SHARED_DATA

FOLDER = SHARED_DATA / "dressed"

MISSING = f"no dressed pictures: they need ../shared/data/dressed, {NOT_SHIPPED}"

NULLS: dict[str, tuple[str, ...]] = {
    "null: height": ("stature",),
    "null: height and weight": ("stature", "weight"),
}
"""What is known where no picture is looked at."""


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


def null_errors(picture: TruePicture, known: tuple[str, ...]) -> dict[str, float]:
    """Errors of the most probable body, without a picture."""
    person, truth = picture.request.person, picture.truth
    assert person.height_m is not None
    true = {"stature": 100.0 * person.height_m, **truth.measurements}
    told = {name: KnownMeasurement(value=true[name]) for name in known}
    found = {
        each.measurement.name: each.measurement.value
        for each in estimate_body(PACKAGED.model(person.gender).population, told).measurements
    }
    return {key: found[key] - truth.measurements[key] for _, key, _ in MEASUREMENTS}

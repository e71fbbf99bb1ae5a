"""Fit pictures whose truth is known, and compare."""

import time
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from fitter.arrays import Mask
from fitter.body.model import regress
from fitter.fits.pipeline import fit
from fitter.parameters import Light
from fitter.render.rasterizer import render
from fitter.render.reflectance import direction_to_light
from fitter.result import FitResult
from fitter.vocabulary.choices import Cues
from tests.accuracy.people import packaged_model
from tests.accuracy.scene import Half, Series
from tests.accuracy.true_picture import Told, TruePicture, told_request
from tests.accuracy.truth import TrueBody, joint_error_mm, wrong_limbs
from tests.one_picture import changed

MILLIMETRES = 1000.0

LEAST_OVERLAP = 0.9
"""A fit that covers less of the true body has failed."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Fitted:
    """One fit of a picture."""

    picture: TruePicture
    cues: Cues
    result: FitResult
    seconds: float


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Scored:
    """The figures of one fit.

    Attributes
    ----------
    outcome
        How the fit says it ended.
    bmi
        The true person's weight over squared stature, kilograms per square metre.
    errors
        Measured minus true by measurement, centimetres and kilograms.
    standard_errors
        What the fit says of these errors; what was given and what has none are left out.
    vertex_mm
        Mean distance of vertices in the canonical pose with both bodies' centres together; None for
        a body of another mesh.
    joint_mm
        Mean distance of joints in the camera frame with both root joints together.
    overlap
        Intersection over union with the true body's mask, without hair and clothes.
    mask_overlap
        The same of the segmentation the fit made, with the mask of the person as seen.
    light_degrees
        Angle between found and true direction to the light; None without shading.
    wrong_limbs
        Limbs that slant toward the camera instead of away from it, or the other way.
    """

    name: str
    person: str
    series: Series
    half: Half
    cues: Cues
    outcome: str
    bmi: float
    errors: Mapping[str, float]
    standard_errors: Mapping[str, float]
    vertex_mm: float | None
    joint_mm: float
    overlap: float
    mask_overlap: float
    light_degrees: float | None
    wrong_limbs: tuple[str, ...]
    seconds: float

    @property
    def failed(self) -> bool:
        """Whether the pose is wrong, so that girths mean little."""
        return self.overlap < LEAST_OVERLAP or bool(self.wrong_limbs)


def fit_picture(picture: TruePicture, cues: Cues, told: Told) -> Fitted:
    """Fit one picture with some cues."""
    request = changed(told_request(picture, told), cues=cues)
    started = time.perf_counter()
    result = fit(request)
    return Fitted(picture=picture, cues=cues, result=result, seconds=time.perf_counter() - started)


def score(fitted: Fitted) -> Scored:
    """Compare a fit with the truth."""
    result, picture, truth = fitted.result, fitted.picture, fitted.picture.truth
    model = packaged_model(result.person.gender)
    joints = regress(model.joint_regressor, result.found.posed_vertices)
    shown = render(result.found.posed_vertices, model.triangles, result.person.camera).silhouette
    cut = resampled(
        result.views[0].pictures.segmentation, working_scale(result), picture.person_mask.shape
    )
    return Scored(
        name=picture.name,
        person=picture.person,
        series=picture.series,
        half=picture.half,
        cues=fitted.cues,
        outcome=result.found.outcome.value,
        bmi=truth.bmi,
        errors=errors_of(result, truth),
        standard_errors=standard_errors_of(result),
        vertex_mm=_vertex_error_mm(result.canonical_vertices, truth),
        joint_mm=joint_error_mm(joints, picture.joints),
        overlap=overlap(shown, picture.body_mask),
        mask_overlap=overlap(cut, picture.person_mask),
        light_degrees=light_error(result.person.light, picture.light),
        wrong_limbs=wrong_limbs(joints, picture.joints),
        seconds=fitted.seconds,
    )


def errors_of(result: FitResult, truth: TrueBody) -> dict[str, float]:
    """Measured minus true, by measurement, centimetres and kilograms."""
    found = {each.name: each.value for each in result.measurements}
    return {name: found[name] - value for name, value in truth.measurements.items()}


def standard_errors_of(result: FitResult) -> dict[str, float]:
    """What a fit states of these errors; what was given and what has none are left out."""
    return {
        each.name: each.standard_error
        for each in result.measurements
        if each.standard_error is not None and each.name not in result.given
    }


def _vertex_error_mm(found: Float[np.ndarray, "m 3"], truth: TrueBody) -> float | None:
    true = truth.canonical
    if len(found) != len(true):
        return None
    difference = (found - found.mean(axis=0)) - (true - true.mean(axis=0))
    return MILLIMETRES * float(np.linalg.norm(difference, axis=1).mean())


def working_scale(result: FitResult) -> float:
    """Working pixels a pixel of the picture as it was sent."""
    return result.views[0].camera.focal_length_px / result.person.camera.focal_length_px


def resampled(mask: Mask, scale: float, shape: tuple[int, ...]) -> Mask:
    """The nearest pixels of a mask ``scale`` times as large as a picture of a shape."""
    row, column = (
        np.minimum((scale * (np.arange(count) + 0.5)).astype(int), limit - 1)
        for count, limit in zip(shape, mask.shape, strict=True)
    )
    return mask[np.ix_(row, column)]


def overlap(first: Mask, second: Mask) -> float:
    """Intersection over union."""
    return float((first & second).sum() / (first | second).sum())


def light_error(found: Light | None, true: Light | None) -> float | None:
    """Degrees between the directions to two lights; None where one is not known."""
    if found is None or true is None:
        return None
    cosine = float(direction_to_light(found) @ direction_to_light(true))
    return float(np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0))))

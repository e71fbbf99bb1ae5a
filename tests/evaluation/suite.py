"""Fit the suite's pictures and compare with the truth."""

import time
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from fitter.arrays import Mask
from fitter.body.skeleton import regress
from fitter.parameters import Light
from fitter.pipeline import fit
from fitter.render.light import direction_to_light
from fitter.render.rasterizer import render
from fitter.request import Click, Cues, FitRequest, Gender
from fitter.result import FitResult
from tests.evaluation.cases import PEOPLE
from tests.evaluation.files import CaseFiles, encoded_mask, light_from_document, read_case
from tests.evaluation.landmark_points import packaged_model
from tests.evaluation.people import load_person
from tests.evaluation.scene import Case, Half
from tests.evaluation.truth import TrueBody, true_body

VISIBLE = 2
MILLIMETRES = 1000.0


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Scored:
    """One fit beside the truth.

    Attributes
    ----------
    errors
        Measured minus true by measurement, centimetres and kilograms.
    vertex_mm, joint_mm
        Mean distances: of vertices in the canonical pose with both bodies' centres together, of
        joints in the camera frame with both root joints together.
    overlap
        Intersection over union with the true body's mask, without hair and clothes.
    mask_overlap
        The same of the segmentation the fit made, with the mask of the person as seen.
    light_degrees
        Angle between found and true direction to the light; None without shading.
    """

    case: Case
    half: Half
    cues: Cues
    outcome: str
    errors: Mapping[str, float]
    vertex_mm: float
    joint_mm: float
    overlap: float
    mask_overlap: float
    light_degrees: float | None
    seconds: float
    result: FitResult
    truth: TrueBody


def score_case(case: Case, cues: Cues, *, true_mask: bool = False) -> Scored:
    """Fit one picture with some cues; ``true_mask`` tells how much the segmentation costs."""
    files = read_case(case)
    source = PEOPLE[case.person]
    request = fit_request(files, cues)
    if true_mask:
        request = replace(request, mask=encoded_mask(files.person_mask))
    started = time.perf_counter()
    result = fit(request)
    seconds = time.perf_counter() - started
    truth = true_body(load_person(source))
    found = {each.name: each.value for each in result.measurements}
    scene = files.document["scene"]
    assert isinstance(scene, dict)
    return Scored(
        case=case,
        half=source.half,
        cues=cues,
        outcome=result.outcome.value,
        errors={name: found[name] - value for name, value in truth.measurements.items()},
        vertex_mm=_vertex_error_mm(result.canonical_vertices, truth.canonical),
        joint_mm=_joint_error_mm(result, np.array(scene["joints_m"])),
        overlap=_overlap(_silhouette(result), files.body_mask),
        mask_overlap=_overlap(
            resampled(result.pictures.segmentation, working_scale(result), files.body_mask.shape),
            files.person_mask,
        ),
        light_degrees=_light_error(result.light, light_from_document(scene["light"])),
        seconds=seconds,
        result=result,
        truth=truth,
    )


def fit_request(files: CaseFiles, cues: Cues) -> FitRequest:
    """The request a case's file holds."""
    options = files.document["request"]
    assert isinstance(options, dict)
    return FitRequest(
        image=files.image,
        clicks={
            name: Click(x=point["x"], y=point["y"], occluded=point["visibility"] < VISIBLE)
            for name, point in options["points"].items()
        },
        gender=Gender(options["gender"]),
        height_m=options["height_m"],
        focal_length_px=options.get("focal_length_px"),
        cues=cues,
    )


def _vertex_error_mm(found: np.ndarray, true: np.ndarray) -> float:
    difference = (found - found.mean(axis=0)) - (true - true.mean(axis=0))
    return MILLIMETRES * float(np.linalg.norm(difference, axis=1).mean())


def _joint_error_mm(result: FitResult, true: np.ndarray) -> float:
    found = regress(packaged_model(result.gender).joint_regressor, result.posed_vertices)
    difference = (found - found[0]) - (true - true[0])
    return MILLIMETRES * float(np.linalg.norm(difference, axis=1).mean())


def _silhouette(result: FitResult) -> Mask:
    """The fitted body's silhouette on the picture as it was sent."""
    triangles = packaged_model(result.gender).triangles
    return render(result.posed_vertices, triangles, result.image_camera).silhouette


def working_scale(result: FitResult) -> float:
    """Working pixels a pixel of the picture as it was sent."""
    return result.camera.focal_length_px / result.image_camera.focal_length_px


def resampled(mask: Mask, scale: float, shape: tuple[int, ...]) -> Mask:
    """The nearest pixels of a mask ``scale`` times as large as a picture of a shape."""
    row, column = (
        np.minimum((scale * (np.arange(count) + 0.5)).astype(int), limit - 1)
        for count, limit in zip(shape, mask.shape, strict=True)
    )
    return mask[np.ix_(row, column)]


def _overlap(first: Mask, second: Mask) -> float:
    return float((first & second).sum() / (first | second).sum())


def _light_error(found: Light | None, true: Light) -> float | None:
    if found is None:
        return None
    cosine = float(direction_to_light(found) @ direction_to_light(true))
    return float(np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0))))

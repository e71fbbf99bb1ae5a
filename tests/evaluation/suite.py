"""Fit the suite's pictures and compare with the truth."""

import time
from collections.abc import Mapping
from contextlib import nullcontext
from dataclasses import dataclass, replace

import numpy as np

from fitter.arrays import Mask
from fitter.body.skeleton import regress
from fitter.fits.pipeline import fit
from fitter.parameters import Light
from fitter.render.light import direction_to_light
from fitter.render.rasterizer import render
from fitter.request import (
    Click,
    Clothing,
    Cues,
    FitRequest,
    Gender,
    KnownMeasurement,
    LightGuess,
    OutlineKind,
    SurroundingsKind,
)
from fitter.result import FitResult
from tests.evaluation.files import CaseFiles, encoded_mask, light_from_document, read_case
from tests.evaluation.held_pose import held_at_true_pose
from tests.evaluation.landmark_points import packaged_model
from tests.evaluation.limbs_in_depth import wrong_limbs
from tests.evaluation.people import load_person
from tests.evaluation.people_table import PEOPLE
from tests.evaluation.scene import Case, Half
from tests.evaluation.truth import TrueBody, true_body

VISIBLE = 2
MILLIMETRES = 1000.0

LEAST_OVERLAP = 0.9
"""A fit that covers less of the true body has failed."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Told:
    """What a fit is told beyond its request: what the errors would be without that difficulty.

    ``mask`` the person as seen, in place of segmentation; ``light`` where the search for the light
    begins; ``focal_length`` in pixels, where the picture does not give it; ``pose`` is held;
    ``measurements`` are named and given as the caller of the service may give them; ``outline`` is
    what the contour is to meet, in place of the default; ``clothing`` how clothes are said to lie.
    """

    mask: bool = False
    light: bool = False
    focal_length: bool = False
    pose: bool = False
    measurements: tuple[str, ...] = ()
    outline: OutlineKind | None = None
    surroundings: SurroundingsKind = SurroundingsKind.UNIFORM
    clothing: Clothing = Clothing.TIGHT


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Fitted:
    """One fit, its files and the true body."""

    case: Case
    cues: Cues
    files: CaseFiles
    result: FitResult
    truth: TrueBody
    seconds: float


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Scored:
    """The figures of one fit.

    Attributes
    ----------
    errors
        Measured minus true by measurement, centimetres and kilograms.
    standard_errors
        What the fit says of these errors; what was given and what has none are left out.
    vertex_mm, joint_mm
        Mean distances: of vertices in the canonical pose with both bodies' centres together, of
        joints in the camera frame with both root joints together.
    overlap
        Intersection over union with the true body's mask, without hair and clothes.
    mask_overlap
        The same of the segmentation the fit made, with the mask of the person as seen.
    light_degrees
        Angle between found and true direction to the light; None without shading.
    wrong_limbs
        Limbs that slant toward the camera instead of away from it, or the other way.
    """

    case: Case
    half: Half
    cues: Cues
    outcome: str
    errors: Mapping[str, float]
    standard_errors: Mapping[str, float]
    vertex_mm: float
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


def fit_case(case: Case, cues: Cues, told: Told) -> Fitted:
    """Fit one picture with some cues."""
    files = read_case(case)
    truth = true_body_of(case)
    request = told_request(files, fit_request(files, cues), told)
    if told.measurements:
        known = {
            name: KnownMeasurement(value=truth.measurements[name]) for name in told.measurements
        }
        request = replace(request, measurements=known)
    with held_at_true_pose(case) if told.pose else nullcontext():
        started = time.perf_counter()
        result = fit(request)
        seconds = time.perf_counter() - started
    return Fitted(case=case, cues=cues, files=files, result=result, truth=truth, seconds=seconds)


def true_body_of(case: Case) -> TrueBody:
    """The measured person of a case."""
    return true_body(load_person(PEOPLE[case.person]))


def score(fitted: Fitted) -> Scored:
    """Compare a fit with the truth."""
    result, files, truth = fitted.result, fitted.files, fitted.truth
    scene = files.scene
    found = {each.name: each for each in result.measurements}
    joints, true_joints = _joints(result), np.array(scene["joints_m"])
    return Scored(
        case=fitted.case,
        half=PEOPLE[fitted.case.person].half,
        cues=fitted.cues,
        outcome=result.found.outcome.value,
        errors={name: found[name].value - value for name, value in truth.measurements.items()},
        standard_errors={
            name: each.standard_error
            for name, each in found.items()
            if each.standard_error is not None and name not in result.given
        },
        vertex_mm=_vertex_error_mm(result.canonical_vertices, truth.canonical),
        joint_mm=joint_error_mm(joints, true_joints),
        overlap=overlap(_silhouette(result), files.body_mask),
        mask_overlap=overlap(
            resampled(result.pictures.segmentation, working_scale(result), files.body_mask.shape),
            files.person_mask,
        ),
        light_degrees=light_error(result.person.light, light_from_document(scene["light"])),
        wrong_limbs=wrong_limbs(joints, true_joints),
        seconds=fitted.seconds,
    )


def fit_request(files: CaseFiles, cues: Cues) -> FitRequest:
    """The request a case's file holds."""
    options = files.request
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


def told_request(files: CaseFiles, request: FitRequest, told: Told) -> FitRequest:
    """A request with what is told beside."""
    if told.mask:
        request = replace(request, mask=encoded_mask(files.person_mask))
    request = replace(request, clothing=told.clothing)
    if told.outline is not None:
        request = replace(request, outline=told.outline)
    if told.focal_length:
        request = replace(request, focal_length_px=files.scene["focal_length_px"])
    if told.light:
        light = light_from_document(files.scene["light"])
        guess = LightGuess(
            kind=light.kind,
            azimuth=light.azimuth,
            elevation=light.elevation,
            distance=light.distance,
        )
        request = replace(request, light=guess)
    return replace(request, light=replace(request.light, surroundings=told.surroundings))


def _vertex_error_mm(found: np.ndarray, true: np.ndarray) -> float:
    difference = (found - found.mean(axis=0)) - (true - true.mean(axis=0))
    return MILLIMETRES * float(np.linalg.norm(difference, axis=1).mean())


def _joints(result: FitResult) -> np.ndarray:
    return regress(
        packaged_model(result.person.gender).joint_regressor, result.found.posed_vertices
    )


def joint_error_mm(found: np.ndarray, true: np.ndarray) -> float:
    """Mean distance of joints in the camera frame with both root joints together."""
    difference = (found - found[0]) - (true - true[0])
    return MILLIMETRES * float(np.linalg.norm(difference, axis=1).mean())


def _silhouette(result: FitResult) -> Mask:
    """The fitted body's silhouette on the picture as it was sent."""
    triangles = packaged_model(result.person.gender).triangles
    return render(result.found.posed_vertices, triangles, result.person.camera).silhouette


def working_scale(result: FitResult) -> float:
    """Working pixels a pixel of the picture as it was sent."""
    return result.camera.focal_length_px / result.person.camera.focal_length_px


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


def light_error(found: Light | None, true: Light) -> float | None:
    """Degrees between the directions to two lights."""
    if found is None:
        return None
    cosine = float(direction_to_light(found) @ direction_to_light(true))
    return float(np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0))))

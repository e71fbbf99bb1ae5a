"""The paper on one page: from a picture and clicks to a measured, posed and lit body."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from fitter.arrays import GreyImage
from fitter.body.skeleton import regress
from fitter.energies.attributes import KnownAttributes
from fitter.energies.clicks import click_evidence
from fitter.energies.objective import Candidate, Objective, PictureEvidence
from fitter.energies.scales import FAR_BOUNDARY_ETA_M, NEAR_BOUNDARY_ETA_M, scales_at
from fitter.estimate.known_person import known_person
from fitter.evidence.edge_cost import edge_cost_map
from fitter.evidence.intensity import intensity_map
from fitter.evidence.outline_confidence import outline_confidence
from fitter.evidence.silhouette_evidence import silhouette_evidence
from fitter.fittable import FittableBody, fittable_body
from fitter.measurement.anthropometry import measure
from fitter.observation.observation import Observation, observe
from fitter.optimizer.albedo_colour import albedo_rgb
from fitter.optimizer.alternation import ShadedFit, fit_shading
from fitter.optimizer.hypotheses import try_hypotheses
from fitter.optimizer.light_solve import guessed_lights
from fitter.optimizer.renewed_lines import renewing_lines, with_lines_about
from fitter.optimizer.search import body_search, limits_of
from fitter.optimizer.uncertainty import shape_covariance
from fitter.parameters import BodyParameters
from fitter.pose_init.initial_pose import InitialPose, initialize_pose
from fitter.pose_init.points import clicked_points
from fitter.progress import Observer, Stage, ignore_progress
from fitter.remarks import FitWarning
from fitter.render.rasterizer import render
from fitter.reporting import fit_warnings, limb_facings, outcome_of
from fitter.request import Cues, FitRequest, OutlineKind
from fitter.result import FitResult, Pictures, StageBody
from fitter.segmentation.bones import clicked_bones, foot_bones
from fitter.segmentation.grabcut import Segmentation, border_warnings, segment
from fitter.segmentation.trimap import Trimap, first_band, trimap
from fitter.stage_clock import StageClock

RESEGMENTED_BAND = 0.5
"""Share of the first band's width in which the picture is cut again round the body found from the
first cut (section 7 names this as future work): what the first cut took for the person far from
any body, such as ground of the skin's colour, can no longer be taken."""

DOUBTFUL_PARTS = ("head", "left_hand", "right_hand")
"""Parts whose outline says little of the body: hair, and hands in a pose of their own."""

_DOUBTFUL_MARGIN_M = 0.05

_EDGE_THRESHOLD_M = 0.03
"""How far from a model edge an image edge may lie and still attract it."""


def fit(
    request: FitRequest, *, models: Path | None = None, observer: Observer = ignore_progress
) -> FitResult:
    """Fit a body to one picture, with the packaged models or with those of a folder.

    Raises
    ------
    InvalidInputError
        If the request cannot be used; the message names the field and the remedy.
    ModelFileError
        If the body model is missing or damaged, or lacks something a fit needs.
    """
    clock = StageClock(observer)
    with clock.stage(Stage.OBSERVATION):
        observation = observe(request)
        body = fittable_body(request.gender, models=models)
        person = known_person(request, body.population, body.instruments.evaluator)
    with clock.stage(Stage.INITIAL_POSE):
        initial = initialize_pose(
            body.instruments.evaluator,
            camera=observation.camera,
            clicks=clicked_points(observation.clicks),
            shape=person.shape,
            limb_facing=request.limb_facing,
        )
    limits = limits_of(request.optimizer)
    meets_lines = request.outline is OutlineKind.LINES and observation.mask is None
    with clock.stage(Stage.SEGMENTATION) as report:
        labels, segmentation = _segmented(observation, body, initial.parameters, 1.0)
        coarse = _silhouette_and_edges(observation, body, initial, segmentation, person.attributes)
        nearer = body_search(request.optimizer, limits.first, report)(coarse, initial.parameters)
        labels, segmentation = _segmented(
            observation, body, nearer.candidate.parameters, RESEGMENTED_BAND
        )
    with clock.stage(Stage.SILHOUETTE_AND_EDGES) as report:
        hypotheses = initial.hypotheses[: limits.hypotheses]
        far = _with_silhouette(coarse, segmentation)
        objective = replace(
            far,
            scales=scales_at(
                observation.camera, initial.root_depth_m, boundary_eta_m=NEAR_BOUNDARY_ETA_M
            ),
        )
        tried = try_hypotheses(
            far,
            objective,
            [hypothesis.parameters for hypothesis in hypotheses],
            trial=body_search(request.optimizer, limits.trial, report),
            contenders=limits.contenders,
            contest=body_search(request.optimizer, limits.contest, report),
        )
        search = body_search(request.optimizer, limits.silhouette_and_edges, report)
        if meets_lines:
            settle = body_search(request.optimizer, limits.contest, report)
            search = renewing_lines([settle, search], observation.display)
        se = search(objective, tried.ends[tried.best].parameters)
    intensity = intensity_map(observation.luminance, observation.display, segmentation.mask)
    shaded: ShadedFit | None = None
    with clock.stage(Stage.SHADING) as report:
        if request.cues is Cues.SES:
            search = body_search(request.optimizer, limits.shading_round, report)
            if meets_lines:
                search = renewing_lines([search], observation.display)
            shaded = fit_shading(
                objective,
                se.candidate,
                intensity,
                guessed_lights(request.light),
                search=search,
            )
    final = se if shaded is None else shaded.minimum
    with clock.stage(Stage.MEASUREMENT):
        if meets_lines:
            objective = with_lines_about(objective, final.candidate.parameters, observation.display)
        overlap = objective.overlap(final.candidate)
        covariance = shape_covariance(
            objective if shaded is None else objective.with_shading(shaded.evidence),
            final.candidate,
            height_variance=person.height_variance,
        )
        measurements = measure(
            body.measuring,
            final.candidate.parameters.shape,
            shape_covariance=covariance,
            given=person.given,
            held=person.held,
        )
        first = objective.evaluate(hypotheses[0].parameters)
        stages = [_stage(body, objective, "initial", first)]
        stages.append(_stage(body, objective, "SE", se.candidate))
        if shaded is not None:
            stages.append(_stage(body, objective, "SES", shaded.minimum.candidate))
    facings = limb_facings(hypotheses, tried, request.limb_facing)
    shading_missing = request.cues is Cues.SES and shaded is None
    return FitResult(
        gender=request.gender,
        height_m=person.height_m,
        given=person.given,
        cues=request.cues,
        optimizer=request.optimizer,
        outcome=outcome_of(converged=final.converged, overlap=overlap),
        camera=observation.camera,
        image_camera=observation.image_camera,
        focal_length_source=observation.focal_length_source,
        body=final.candidate.parameters,
        shape_covariance=covariance,
        posed_vertices=final.candidate.vertices,
        canonical_vertices=body.measuring.canonical.at(final.candidate.parameters.shape),
        light=None if shaded is None else shaded.light,
        reflectance=None if shaded is None else shaded.reflectance,
        albedo_rgb=None
        if shaded is None
        else albedo_rgb(
            final.candidate,
            shaded.reflectance.albedo,
            observation.linear_rgb,
            intensity,
            shaded.hidden,
        ),
        energies=final.candidate.energies,
        evaluations=nearer.evaluations
        + tried.evaluations
        + se.evaluations
        + (0 if shaded is None else shaded.evaluations),
        silhouette_overlap=overlap,
        stages=tuple(stages),
        measurements=measurements,
        limb_facing=facings,
        assumptions=observation.assumptions + person.assumptions,
        warnings=observation.warnings
        + segmentation.warnings
        + fit_warnings(overlap, facings)
        + (_SHADING_MISSING if shading_missing else ()),
        stage_seconds=clock.seconds,
        pictures=Pictures(
            image=observation.display,
            trimap=labels,
            segmentation=segmentation.mask,
        ),
    )


_SHADING_MISSING = (
    FitWarning(
        code="shading-not-used",
        message=(
            "Too little of the body is visible, unclipped and away from its outline for shading to "
            "say anything; the result is that of silhouette and edges."
        ),
    ),
)


def _segmented(
    observation: Observation, body: FittableBody, parameters: BodyParameters, narrowing: float
) -> tuple[Trimap | None, Segmentation]:
    """The caller's mask, or GrabCut from the tri-map round a body (section 3.2)."""
    if observation.mask is not None:
        return None, Segmentation(mask=observation.mask, warnings=border_warnings(observation.mask))
    vertices = body.instruments.evaluator.vertices(parameters)
    silhouette = render(vertices, body.instruments.model.triangles, observation.camera).silhouette
    landmarks = body.instruments.model.landmarks
    points = observation.camera.project(regress(landmarks, vertices))
    seen = dict(zip(landmarks.names, points, strict=True))
    bones = np.concatenate(
        [clicked_bones(observation.clicks), foot_bones(observation.clicks, seen)]
    )
    labels = trimap(silhouette, bones, band=narrowing * first_band(silhouette, bones))
    return labels, segment(observation.display, labels)


def _silhouette_and_edges(
    observation: Observation,
    body: FittableBody,
    initial: InitialPose,
    segmentation: Segmentation,
    attributes: KnownAttributes,
) -> Objective:
    """E1 of this picture, with a boundary that pulls from afar."""
    depth = initial.root_depth_m
    pixels_per_metre = observation.camera.focal_length_px / depth
    confidence = _outline_confidence(observation, body, initial.parameters, pixels_per_metre)
    return Objective(
        instruments=body.instruments,
        evidence=PictureEvidence(
            camera=observation.camera,
            clicks=click_evidence(body.instruments.model.landmarks, observation.clicks),
            silhouette=silhouette_evidence(segmentation.mask, confidence),
            edges=edge_cost_map(
                observation.display, threshold_px=_EDGE_THRESHOLD_M * pixels_per_metre
            ),
            shading=None,
        ),
        scales=scales_at(observation.camera, depth, boundary_eta_m=FAR_BOUNDARY_ETA_M),
        attributes=attributes,
    )


def _with_silhouette(objective: Objective, segmentation: Segmentation) -> Objective:
    """The same picture with the person cut out anew."""
    evidence = objective.evidence
    silhouette = silhouette_evidence(segmentation.mask, evidence.silhouette.confidence)
    return replace(objective, evidence=replace(evidence, silhouette=silhouette))


def _outline_confidence(
    observation: Observation,
    body: FittableBody,
    initial: BodyParameters,
    pixels_per_metre: float,
) -> GreyImage:
    """Little where the initial body has its head and hands."""
    model = body.instruments.model
    projected = observation.camera.project(body.instruments.evaluator.vertices(initial))
    corners = [
        model.triangles[model.part_of_triangle == model.part_names.index(part)]
        for part in DOUBTFUL_PARTS
    ]
    return outline_confidence(
        observation.camera.height,
        observation.camera.width,
        [projected[np.unique(triangles)] for triangles in corners],
        margin_px=_DOUBTFUL_MARGIN_M * pixels_per_metre,
    )


def _stage(body: FittableBody, objective: Objective, name: str, candidate: Candidate) -> StageBody:
    return StageBody(
        name=name,
        body=candidate.parameters,
        posed_vertices=candidate.vertices,
        canonical_vertices=body.measuring.canonical.at(candidate.parameters.shape),
        energies=candidate.energies,
        silhouette_overlap=objective.overlap(candidate),
        measurements=measure(body.measuring, candidate.parameters.shape),
    )

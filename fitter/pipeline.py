"""The paper on one page: from a picture and clicks to a measured, posed and lit body."""

from dataclasses import replace
from pathlib import Path

from fitter.energies.objective import Candidate, Objective
from fitter.energies.scales import FAR_BOUNDARY_ETA_M, NEAR_BOUNDARY_ETA_M, scales_at
from fitter.estimate.known_person import known_person
from fitter.evidence.intensity import intensity_map
from fitter.fittable import FittableBody, fittable_body
from fitter.measurement.anthropometry import measure
from fitter.observation.observation import observe
from fitter.optimizer.albedo_colour import albedo_rgb
from fitter.optimizer.alternation import ShadedFit
from fitter.optimizer.hypotheses import try_hypotheses
from fitter.optimizer.light_solve import guessed_lights
from fitter.optimizer.uncertainty import shape_covariance
from fitter.pose_init.initial_pose import initialize_pose
from fitter.pose_init.points import clicked_points
from fitter.progress import Observer, Stage, ignore_progress
from fitter.remarks import FitWarning
from fitter.reporting import fit_warnings, limb_facings, outcome_of
from fitter.request import Cues, FitRequest, SurroundingsKind
from fitter.result import FitResult, Pictures, StageBody
from fitter.stage_clock import StageClock
from fitter.stages.clothing import clothing_remarks, where_bare
from fitter.stages.cut_out import (
    RESEGMENTED_BAND,
    segmented,
    silhouette_and_edges,
    with_silhouette,
)
from fitter.stages.descents import descents


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
    searches = descents(request, observation)
    limits = searches.limits
    with clock.stage(Stage.SEGMENTATION) as report:
        labels, segmentation = segmented(observation, body, initial.parameters, 1.0)
        coarse = silhouette_and_edges(
            observation,
            body,
            initial.parameters,
            segmentation,
            person.attributes,
            boundary_eta_m=FAR_BOUNDARY_ETA_M,
        )
        nearer = searches.search(limits.first, report)(coarse, initial.parameters)
        labels, segmentation = segmented(
            observation, body, nearer.candidate.parameters, RESEGMENTED_BAND
        )
    with clock.stage(Stage.SILHOUETTE_AND_EDGES) as report:
        hypotheses = initial.hypotheses[: limits.hypotheses]
        far = with_silhouette(coarse, segmentation, observation, body, nearer.candidate.parameters)
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
            trial=searches.search(limits.trial, report),
            contenders=limits.contenders,
            contest=searches.search(limits.contest, report),
        )
        se = searches.silhouette_and_edges(objective, tried.ends[tried.best].parameters, report)
    intensity = intensity_map(observation.luminance, observation.display, segmentation.mask)
    shaded: ShadedFit | None = None
    with clock.stage(Stage.SHADING) as report:
        if request.cues is Cues.SES:
            objective, intensity = where_bare(objective, se.candidate, intensity)
            lights = guessed_lights(request.light)
            shaded = searches.shading(objective, se.candidate, intensity, lights, report)
    final = se if shaded is None else shaded.minimum
    with clock.stage(Stage.MEASUREMENT):
        objective = searches.about(objective, final.candidate.parameters)
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
    clothing_assumptions, clothing_warnings = clothing_remarks(objective)
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
        assumptions=observation.assumptions + person.assumptions + clothing_assumptions,
        warnings=observation.warnings
        + segmentation.warnings
        + clothing_warnings
        + fit_warnings(overlap, facings)
        + (_SHADING_MISSING if shading_missing else ())
        + _surroundings_missing(request, shaded),
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


_SURROUNDINGS_MISSING = FitWarning(
    code="surroundings-not-found",
    message=(
        "Too little bare surface is visible to tell the light from all round from the lamp: the "
        "light is that of Eq. 1, a lamp and a constant."
    ),
)


def _surroundings_missing(request: FitRequest, shaded: ShadedFit | None) -> tuple[FitWarning, ...]:
    wanted = request.light.surroundings is SurroundingsKind.SPHERICAL_HARMONICS
    missing = wanted and shaded is not None and shaded.light.surroundings is None
    return (_SURROUNDINGS_MISSING,) if missing else ()


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

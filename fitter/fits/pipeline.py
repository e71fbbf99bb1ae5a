"""The paper on one page: from a picture and clicks to a measured, posed and lit body."""

from dataclasses import replace
from pathlib import Path

from fitter.arrays import Vertices
from fitter.energies.objective import Candidate
from fitter.energies.scales import FAR_BOUNDARY_ETA_M, NEAR_BOUNDARY_ETA_M, scales_at
from fitter.fits.clothing import clothing_remarks
from fitter.fits.descents import descents
from fitter.fits.detecting import detector_for
from fitter.fits.picture_objective import (
    segmented,
    silhouette_and_edges,
    with_silhouette,
)
from fitter.fits.prepared_model import prepared_model
from fitter.fits.progress import Observer, Stage, ignore_progress
from fitter.fits.reporting import (
    fit_warnings,
    insistence_warnings,
    limb_facings,
    shading_warnings,
)
from fitter.fits.settling import settle, shade
from fitter.fits.stage_clock import StageClock
from fitter.measurement.anthropometry import measure
from fitter.measurement.quantity import Measurement
from fitter.observation.observation import observe
from fitter.optimizer.hypotheses import try_hypotheses
from fitter.population.known_person import known_person
from fitter.pose_init.initial_pose import initialize_pose
from fitter.pose_init.points import clicked_points
from fitter.request import FitRequest
from fitter.result import FitResult, Pictures, StageBody


def fit(
    request: FitRequest,
    *,
    models: Path | None = None,
    detector_weights: Path | None = None,
    observer: Observer = ignore_progress,
) -> FitResult:
    """Fit a body to one picture.

    The body models and the detector's weights come from their packages unless a folder is given.

    Raises
    ------
    InvalidInputError
        If the request cannot be used; the message names the field and the remedy.
    ModelFileError
        If the body model is missing or damaged, or lacks something a fit needs.
    DetectorUnavailableError
        If points are to be proposed and the detector is not installed.

    Examples
    --------
    >>> from fitter import Click, FitRequest, Gender, fit
    >>> points = {name: Click(x=x, y=y) for name, (x, y) in clicks.items()}
    >>> asked = FitRequest(image=picture, clicks=points, gender=Gender(gender), height_m=height_m)
    >>> result = fit(asked)
    >>> result.found.outcome.value, result.found.silhouette_overlap > 0.9
    ('converged', True)
    """
    clock = StageClock(observer)
    with clock.stage(Stage.OBSERVATION):
        observation = observe(request, detector_for(request, detector_weights))
        prepared = prepared_model(request.gender, models=models)
        person = known_person(request, prepared.population, prepared.operators.evaluator)
    with clock.stage(Stage.INITIAL_POSE):
        initial = initialize_pose(
            prepared.operators.evaluator,
            camera=observation.camera,
            clicks=clicked_points(observation.clicks),
            shape=person.shape,
            limb_facing=request.limb_facing,
            slants=observation.slants,
        )
    searches = descents(request, observation)
    limits = searches.limits
    with clock.stage(Stage.SEGMENTATION) as report:
        labels, segmentation = segmented(observation, prepared, initial.parameters, fitted=False)
        coarse = silhouette_and_edges(
            observation,
            prepared,
            initial.parameters,
            segmentation,
            person.attributes,
            boundary_eta_m=FAR_BOUNDARY_ETA_M,
        )
        nearer = searches.search(limits.first, report)(coarse, initial.parameters)
        labels, segmentation = segmented(
            observation, prepared, nearer.candidate.parameters, fitted=True
        )
    with clock.stage(Stage.SILHOUETTE_AND_EDGES) as report:
        hypotheses = initial.hypotheses[: limits.hypotheses]
        far = with_silhouette(
            coarse, segmentation, observation, prepared, nearer.candidate.parameters
        )
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
    with clock.stage(Stage.SHADING) as report:
        shaded = shade(request, observation, segmentation, searches, objective, se, report)
    final = shaded.minimum.candidate
    with clock.stage(Stage.MEASUREMENT):
        found, objective = settle(
            request,
            observation,
            prepared.operators.model,
            searches,
            shaded,
            height_m=person.height_m,
            height_variance=person.height_variance,
        )
        measurements = measure(
            prepared.measuring,
            final.parameters.shape,
            shape_covariance=found.person.shape_covariance,
            given=person.given,
            held=person.held,
        )
        canonical = prepared.measuring.canonical.at(final.parameters.shape)
        before = {"initial": objective.evaluate(hypotheses[0].parameters)}
        if shaded.shading is not None:
            before["SE"] = se.candidate
        stages = [
            _stage(
                name,
                candidate,
                prepared.measuring.canonical.at(candidate.parameters.shape),
                silhouette_overlap=objective.overlap(candidate),
                measurements=measure(prepared.measuring, candidate.parameters.shape),
            )
            for name, candidate in before.items()
        ]
        stages.append(
            _stage(
                "SE" if shaded.shading is None else "SES",
                final,
                canonical,
                silhouette_overlap=found.silhouette_overlap,
                measurements=tuple(replace(each, standard_error=None) for each in measurements),
            )
        )
    if not (found.is_plausible or request.force):
        measurements = ()
        stages = [replace(stage, measurements=()) for stage in stages]
    facings = limb_facings(hypotheses, tried, request.limb_facing)
    clothing_assumptions, clothing_warnings = clothing_remarks(objective)
    return FitResult(
        found=found,
        given=person.given,
        optimizer=request.optimizer,
        camera=observation.camera,
        focal_length_source=observation.focal_length_source,
        canonical_vertices=canonical,
        energies=final.energies,
        evaluations=nearer.evaluations
        + tried.evaluations
        + se.evaluations
        + (0 if shaded.shading is None else shaded.shading.evaluations),
        stages=tuple(stages),
        measurements=measurements,
        limb_facing=facings,
        assumptions=observation.assumptions + person.assumptions + clothing_assumptions,
        warnings=observation.warnings
        + segmentation.warnings
        + clothing_warnings
        + fit_warnings(found.silhouette_overlap, facings)
        + shading_warnings(request, found)
        + insistence_warnings(request, found),
        stage_seconds=clock.seconds,
        pictures=Pictures(
            image=observation.display,
            trimap=labels,
            segmentation=segmentation.mask,
        ),
    )


def _stage(
    name: str,
    candidate: Candidate,
    canonical_vertices: Vertices,
    *,
    silhouette_overlap: float,
    measurements: tuple[Measurement, ...],
) -> StageBody:
    return StageBody(
        name=name,
        body=candidate.parameters,
        posed_vertices=candidate.vertices,
        canonical_vertices=canonical_vertices,
        energies=candidate.energies,
        silhouette_overlap=silhouette_overlap,
        measurements=measurements,
    )

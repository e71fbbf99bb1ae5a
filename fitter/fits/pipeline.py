"""The paper on one page: from a picture and clicks to a measured, posed and lit body."""

from dataclasses import replace
from pathlib import Path

from fitter.arrays import Vertices
from fitter.energies.objective import Candidate
from fitter.fits.clothing import clothing_remarks
from fitter.fits.outlined import outlined
from fitter.fits.progress import Observer, Stage, ignore_progress
from fitter.fits.reporting import (
    fit_warnings,
    insistence_warnings,
    limb_facings,
    shading_warnings,
)
from fitter.fits.settling import compared_with, settle, shade
from fitter.fits.stage_clock import StageClock
from fitter.measurement.anthropometry import measure
from fitter.measurement.quantity import Measurement
from fitter.optimizer.uncertainty import certainty
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
    view = outlined(request, clock, models=models, detector_weights=detector_weights)
    observation, known, prepared, se = view.observation, view.known, view.prepared, view.minimum
    with clock.stage(Stage.SHADING) as report:
        shaded = shade(
            request, observation, view.segmentation, view.searches, view.objective, se, report
        )
    final = shaded.minimum.candidate
    with clock.stage(Stage.MEASUREMENT):
        objective = compared_with(view.searches, shaded)
        found = settle(
            request,
            observation,
            prepared.operators.model,
            shaded,
            certainty(shaded.with_shading(objective), final),
            height_m=known.height_m,
            height_variance=known.height_variance,
        )
        measurements = measure(
            prepared.measuring,
            final.parameters.shape,
            shape_covariance=found.person.shape_covariance,
            given=known.given,
            held=known.held,
        )
        canonical = prepared.measuring.canonical.at(final.parameters.shape)
        before = {"initial": objective.evaluate(view.hypotheses[0].parameters)}
        if shaded.shading is not None:
            before["SE"] = se.candidate
        stages = [
            _stage(
                name,
                candidate,
                prepared.operators.evaluator.vertices(candidate.parameters),
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
                found.posed_vertices,
                canonical,
                silhouette_overlap=found.silhouette_overlap,
                measurements=tuple(replace(each, standard_error=None) for each in measurements),
            )
        )
    if not (found.is_plausible or request.force):
        measurements = ()
        stages = [replace(stage, measurements=()) for stage in stages]
    facings = limb_facings(view.hypotheses, view.tried, request.limb_facing)
    clothing_assumptions, clothing_warnings = clothing_remarks(objective)
    return FitResult(
        found=found,
        given=known.given,
        optimizer=request.optimizer,
        camera=observation.camera,
        focal_length_source=observation.focal_length_source,
        canonical_vertices=canonical,
        energies=final.energies,
        evaluations=view.evaluations
        + (0 if shaded.shading is None else shaded.shading.evaluations),
        stages=tuple(stages),
        measurements=measurements,
        limb_facing=facings,
        assumptions=observation.assumptions + known.assumptions + clothing_assumptions,
        warnings=observation.warnings
        + known.warnings
        + view.segmentation.warnings
        + clothing_warnings
        + fit_warnings(found.silhouette_overlap, facings)
        + shading_warnings(request, found)
        + insistence_warnings(request, found),
        stage_seconds=clock.seconds,
        pictures=Pictures(
            image=observation.display,
            trimap=view.trimap,
            segmentation=view.segmentation.mask,
        ),
    )


def _stage(
    name: str,
    candidate: Candidate,
    posed_vertices: Vertices,
    canonical_vertices: Vertices,
    *,
    silhouette_overlap: float,
    measurements: tuple[Measurement, ...],
) -> StageBody:
    return StageBody(
        name=name,
        body=candidate.parameters,
        posed_vertices=posed_vertices,
        canonical_vertices=canonical_vertices,
        energies=candidate.energies,
        silhouette_overlap=silhouette_overlap,
        measurements=measurements,
    )

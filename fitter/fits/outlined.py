"""One picture by itself, to the minimum of E1 or near it: what every fit and scan begins with."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from fitter.energies.objective import Objective
from fitter.energies.scales import FAR_BOUNDARY_ETA_M, NEAR_BOUNDARY_ETA_M, scales_at
from fitter.fits.descents import Descents, descents
from fitter.fits.detecting import detector_for
from fitter.fits.picture_objective import segmented, silhouette_and_edges, with_silhouette
from fitter.fits.prepared_model import PreparedModel, prepared_model
from fitter.fits.progress import Stage
from fitter.fits.stage_clock import StageClock
from fitter.observation.observation import Observation, observe
from fitter.optimizer.gauss_newton import Minimum
from fitter.optimizer.hypotheses import TriedHypotheses, try_hypotheses
from fitter.population.known_person import KnownPerson, known_person
from fitter.pose_init.initial_pose import PoseHypothesis, initialize_pose
from fitter.pose_init.points import clicked_points
from fitter.request import FitRequest
from fitter.segmentation.grabcut import Segmentation
from fitter.segmentation.trimap import Trimap


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Outlined:
    """A picture with the body that its points, silhouette and edges tell.

    Attributes
    ----------
    request, observation
        What was asked, and the picture as it was read.
    prepared, known
        The body model, and what the caller knows of the person.
    searches
        How this picture is searched.
    hypotheses, tried
        The readings of the clicks that were tried, and how they ended.
    trimap, segmentation
        Of the second cut; no tri-map where the caller sent a mask.
    objective, minimum
        E1 and its minimum, or a body near that for one of several pictures.
    evaluations
        True energies computed so far.
    """

    request: FitRequest
    observation: Observation
    prepared: PreparedModel
    known: KnownPerson
    searches: Descents
    hypotheses: Sequence[PoseHypothesis]
    tried: TriedHypotheses
    trimap: Trimap | None
    segmentation: Segmentation
    objective: Objective
    minimum: Minimum
    evaluations: int


def outlined(
    request: FitRequest,
    clock: StageClock,
    *,
    models: Path | None = None,
    detector_weights: Path | None = None,
    one_of_several: bool = False,
) -> Outlined:
    """Sections 3.1 to 3.3: pose from points, the person cut out twice, the minimum of E1.

    ``one_of_several`` says that a search of several pictures goes on from here, so that a few steps
    towards the minimum are enough.

    Raises
    ------
    InvalidInputError
        If the request cannot be used; the message names the field and the remedy.
    ModelFileError
        If the body model is missing or damaged, or lacks something a fit needs.
    DetectorUnavailableError
        If points are to be proposed and the detector is not installed.
    """
    with clock.stage(Stage.OBSERVATION):
        observation = observe(request, detector_for(request, detector_weights))
        prepared = prepared_model(request.gender, models=models)
        known = known_person(request, prepared.population, prepared.operators.evaluator)
    with clock.stage(Stage.INITIAL_POSE):
        initial = initialize_pose(
            prepared.searched.evaluator,
            camera=observation.camera,
            clicks=clicked_points(observation.clicks),
            shape=known.shape,
            limb_facing=request.limb_facing,
            slants=observation.slants,
        )
    searches = descents(request, observation)
    limits = searches.limits
    with clock.stage(Stage.SEGMENTATION) as report:
        _, segmentation = segmented(observation, prepared, initial.parameters, fitted=False)
        coarse = silhouette_and_edges(
            observation,
            prepared,
            initial.parameters,
            segmentation,
            known.attributes,
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
            # The first reading goes on from where the first search ended.
            [nearer.candidate, *(each.parameters for each in hypotheses[1:])],
            trial=searches.search(limits.trial, report),
            contenders=limits.contenders,
            hopeless_nats=limits.hopeless_nats,
            contest=searches.search(limits.contest, report),
        )
        descend = searches.first_steps if one_of_several else searches.silhouette_and_edges
        minimum = descend(objective, tried.winner, report)
    return Outlined(
        request=request,
        observation=observation,
        prepared=prepared,
        known=known,
        searches=searches,
        hypotheses=hypotheses,
        tried=tried,
        trimap=labels,
        segmentation=segmentation,
        objective=objective,
        minimum=minimum,
        evaluations=nearer.evaluations + tried.evaluations + minimum.evaluations,
    )

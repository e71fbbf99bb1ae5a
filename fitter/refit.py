"""A fitted picture once more: from its body, with what else is known of the person's shape."""

from dataclasses import replace

from fitter.energies.attributes import whole_shape
from fitter.energies.priors import ShapePrior
from fitter.energies.scales import NEAR_BOUNDARY_ETA_M
from fitter.estimate.known_person import known_person
from fitter.evidence.intensity import intensity_map
from fitter.fittable import FittableBody
from fitter.observation.observation import observe
from fitter.optimizer.albedo_colour import albedo_rgb
from fitter.optimizer.alternation import ShadedFit
from fitter.optimizer.gauss_newton import EnergyObserver
from fitter.optimizer.light_solve import guessed_lights
from fitter.optimizer.uncertainty import shape_covariance
from fitter.parameters import BodyParameters
from fitter.reporting import outcome_of
from fitter.request import Cues, FitRequest
from fitter.result import LitBody
from fitter.stages.clothing import where_bare
from fitter.stages.cut_out import RESEGMENTED_BAND, segmented, silhouette_and_edges
from fitter.stages.descents import descents


def refit(
    request: FitRequest,
    body: FittableBody,
    start: BodyParameters,
    *,
    prior: ShapePrior,
    hold_shape: bool,
    report: EnergyObserver,
) -> LitBody:
    """From a body near the person to the minimum of E2 (of E1 for SE), under a prior on the shape.

    The readings of the clicks are not tried again: limbs face as they do in ``start``, which has
    the height and all else that the request holds. With ``hold_shape`` it keeps its whole shape.
    The covariance is that among people of one height, under the prior.

    Raises
    ------
    InvalidInputError
        If the request cannot be used.
    """
    observation = observe(request)
    person = known_person(request, body.population, body.instruments.evaluator)
    _, segmentation = segmented(observation, body, start, RESEGMENTED_BAND)
    objective = replace(
        silhouette_and_edges(
            observation,
            body,
            start,
            segmentation,
            whole_shape(start.shape) if hold_shape else person.attributes,
            boundary_eta_m=NEAR_BOUNDARY_ETA_M,
        ),
        shape_prior=prior,
    )
    searches = descents(request, observation)
    intensity = intensity_map(observation.luminance, observation.display, segmentation.mask)
    se = searches.silhouette_and_edges(objective, start, report)
    shaded: ShadedFit | None = None
    if request.cues is Cues.SES:
        objective, intensity = where_bare(objective, se.candidate, intensity)
        lights = guessed_lights(request.light)
        shaded = searches.shading(objective, se.candidate, intensity, lights, report)
    minimum = se if shaded is None else shaded.minimum
    found = minimum.candidate
    objective = searches.about(objective, found.parameters)
    overlap = objective.overlap(found)
    return LitBody(
        gender=request.gender,
        height_m=person.height_m,
        cues=request.cues,
        outcome=outcome_of(converged=minimum.converged, overlap=overlap),
        image_camera=observation.image_camera,
        body=found.parameters,
        shape_covariance=shape_covariance(
            objective if shaded is None else objective.with_shading(shaded.evidence),
            found,
            height_variance=0.0,
        ),
        posed_vertices=found.vertices,
        light=None if shaded is None else shaded.light,
        reflectance=None if shaded is None else shaded.reflectance,
        albedo_rgb=None
        if shaded is None
        else albedo_rgb(
            found,
            shaded.reflectance.albedo,
            observation.linear_rgb,
            intensity,
            shaded.hidden,
        ),
        silhouette_overlap=overlap,
    )

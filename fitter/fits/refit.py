"""Fit a picture again, from its fitted body, with what else is now known of the person's shape."""

from dataclasses import replace
from pathlib import Path

from fitter.energies.attributes import whole_shape
from fitter.energies.priors import ShapePrior
from fitter.energies.scales import NEAR_BOUNDARY_ETA_M
from fitter.fits.descents import descents
from fitter.fits.detecting import detector_for
from fitter.fits.picture_objective import segmented, silhouette_and_edges
from fitter.fits.prepared_model import PreparedModel
from fitter.fits.settling import settle, shade
from fitter.observation.observation import observe
from fitter.optimizer.gauss_newton import EnergyObserver
from fitter.parameters import BodyParameters
from fitter.population.known_person import known_person
from fitter.request import FitRequest
from fitter.result import PictureFit


def refit(
    request: FitRequest,
    prepared: PreparedModel,
    start: BodyParameters,
    *,
    prior: ShapePrior,
    hold_shape: bool,
    report: EnergyObserver,
    detector_weights: Path | None = None,
) -> PictureFit:
    """From a body near the person to the minimum of E2 (of E1 for SE), under a prior on the shape.

    The readings of the clicks are not tried again: limbs face as they do in ``start``, which has
    the height and all else that the request holds. With ``hold_shape`` it keeps its whole shape.
    The covariance is that among people of the same height, under the prior.

    Raises
    ------
    InvalidInputError
        If the request cannot be used.
    """
    observation = observe(request, detector_for(request, detector_weights))
    person = known_person(request, prepared.population, prepared.operators.evaluator)
    _, segmentation = segmented(observation, prepared, start, fitted=True)
    objective = replace(
        silhouette_and_edges(
            observation,
            prepared,
            start,
            segmentation,
            whole_shape(start.shape) if hold_shape else person.attributes,
            boundary_eta_m=NEAR_BOUNDARY_ETA_M,
        ),
        shape_prior=prior,
    )
    searches = descents(request, observation)
    outlined = searches.silhouette_and_edges(objective, start, report)
    shaded = shade(request, observation, segmentation, searches, objective, outlined, report)
    found, _ = settle(
        request,
        observation,
        prepared.operators.model,
        searches,
        shaded,
        height_m=person.height_m,
        height_variance=0.0,
    )
    return found

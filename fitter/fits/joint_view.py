"""One of several pictures of a person, ready to be searched with the others."""

from dataclasses import dataclass, replace

from fitter.energies.joint_objective import without_knowledge
from fitter.energies.objective import Objective
from fitter.energies.scales import NEAR_BOUNDARY_ETA_M, scan_scales
from fitter.fits.descents import Descents, descents
from fitter.fits.outlined import Outlined
from fitter.fits.picture_objective import segmented, silhouette_and_edges
from fitter.fits.prepared_model import PreparedModel
from fitter.observation.observation import Observation
from fitter.parameters import BodyParameters
from fitter.population.known_person import KnownPerson
from fitter.request import FitRequest
from fitter.segmentation.grabcut import Segmentation


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class JointView:
    """A picture and a body near the person in it.

    Attributes
    ----------
    objective
        E1 of this picture alone: nothing in it knows about shapes.
    body
        Near the person; its shape is this picture's own.
    """

    request: FitRequest
    observation: Observation
    segmentation: Segmentation
    searches: Descents
    objective: Objective
    body: BodyParameters


def view_of(picture: Outlined) -> JointView:
    """A picture that was searched by itself until near the minimum of E1."""
    return JointView(
        request=picture.request,
        observation=picture.observation,
        segmentation=picture.segmentation,
        searches=picture.searches,
        objective=_one_of_several(picture.objective),
        body=picture.minimum.candidate.parameters,
    )


def view_around(
    request: FitRequest,
    observation: Observation,
    prepared: PreparedModel,
    known: KnownPerson,
    body: BodyParameters,
) -> JointView:
    """A picture in which a body was found before."""
    _, segmentation = segmented(observation, prepared, body, fitted=True)
    objective = silhouette_and_edges(
        observation,
        prepared,
        body,
        segmentation,
        known.attributes,
        boundary_eta_m=NEAR_BOUNDARY_ETA_M,
    )
    return JointView(
        request=request,
        observation=observation,
        segmentation=segmentation,
        searches=descents(request, observation),
        objective=_one_of_several(objective),
        body=body,
    )


def _one_of_several(objective: Objective) -> Objective:
    """What a picture says beside others, which say the rest."""
    return replace(without_knowledge(objective), scales=scan_scales(objective.scales))

"""How every fit ends: from the minimum of silhouette and edges to a person with light."""

from dataclasses import dataclass, replace

from fitter.body.model import BodyModel
from fitter.energies.objective import EnergyObserver, Objective
from fitter.evidence.intensity import IntensityMap, intensity_map
from fitter.fits.clothing import where_bare
from fitter.fits.contradiction import contradiction
from fitter.fits.descents import Descents
from fitter.fits.plausibility import plausibility
from fitter.fits.reporting import outcome_of
from fitter.observation.observation import Observation
from fitter.optimizer.albedo_colour import albedo_rgb
from fitter.optimizer.alternation import ShadedFit
from fitter.optimizer.gauss_newton import Minimum
from fitter.optimizer.light_solve import guessed_lights
from fitter.optimizer.uncertainty import Certainty, camera_tilt, shape_covariance
from fitter.person.fitted_person import FittedPerson
from fitter.request import Cues, FitRequest
from fitter.result import PictureFit
from fitter.segmentation.grabcut import Segmentation


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Shaded:
    """A picture searched to the end.

    Attributes
    ----------
    objective
        E1 of the picture, as in the last search.
    intensity
        The intensities that shading was compared with.
    minimum
        The minimum of E2, or of E1 where there is no ``shading``.
    shading
        None for SE, and where shading tells nothing.
    """

    objective: Objective
    intensity: IntensityMap
    minimum: Minimum
    shading: ShadedFit | None

    def with_shading(self, objective: Objective) -> Objective:
        """E1 with the shading that was found: E2."""
        return objective if self.shading is None else objective.with_shading(self.shading.evidence)


def shade(
    request: FitRequest,
    observation: Observation,
    segmentation: Segmentation,
    searches: Descents,
    objective: Objective,
    outlined: Minimum,
    report: EnergyObserver,
) -> Shaded:
    """From the minimum of E1, ``outlined``, on to that of E2 (section 5) if the cues say so."""
    intensity = intensity_map(observation.luminance, observation.display, segmentation.mask)
    shading: ShadedFit | None = None
    if request.cues is Cues.SES:
        objective, intensity = where_bare(objective, outlined.candidate, intensity)
        lights = guessed_lights(request.light)
        shading = searches.shading(objective, outlined.candidate, intensity, lights, report)
    return Shaded(
        objective=objective,
        intensity=intensity,
        minimum=outlined if shading is None else shading.minimum,
        shading=shading,
    )


def compared_with(searches: Descents, shaded: Shaded) -> Objective:
    """E1 with the outline found from the final body: other bodies can be compared with it."""
    return searches.about(shaded.objective, shaded.minimum.candidate)


def settle(
    request: FitRequest,
    observation: Observation,
    model: BodyModel,
    shaded: Shaded,
    certain: Certainty,
    *,
    height_m: float,
    height_variance: float,
) -> PictureFit:
    """The person that the searches found, with light, reflectance and the shape's covariance.

    ``certain`` is how certain the final body is, ``height_variance`` the variance of the shape's
    first coefficient.
    """
    candidate, shading = shaded.minimum.candidate, shaded.shading
    objective = certain.objective
    overlap = objective.overlap(candidate)
    person = FittedPerson(
        gender=request.gender,
        model_checksum=model.checksum,
        body=candidate.parameters,
        camera=observation.image_camera,
        light=None,
        reflectance=None,
        albedo_rgb=None,
        shape_covariance=shape_covariance(certain, height_variance=height_variance),
        tilt=camera_tilt(certain),
    )
    if shading is not None:
        colours = albedo_rgb(
            shading.body,
            shading.reflectance.albedo,
            observation.linear_rgb,
            shaded.intensity,
            shading.hidden,
        )
        person = replace(
            person, light=shading.light, reflectance=shading.reflectance, albedo_rgb=colours
        )
    figures = plausibility(observation, objective, candidate, overlap)
    contradicted = contradiction(figures)
    return PictureFit(
        person=person,
        height_m=height_m,
        cues=request.cues,
        outcome=outcome_of(
            converged=shaded.minimum.converged, overlap=overlap, verdict=contradicted.verdict
        ),
        posed_vertices=objective.operators.whole_vertices(candidate.parameters),
        silhouette_overlap=overlap,
        verdict=contradicted.verdict,
        contradictions=contradicted.sentences,
    )

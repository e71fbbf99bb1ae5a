"""One of several pictures of a person, with its light as far as it is known."""

from dataclasses import dataclass, replace

from fitter.energies.objective import Candidate, Objective
from fitter.energies.shading import ShadingEvidence
from fitter.evidence.intensity import IntensityMap, intensity_map
from fitter.fits.clothing import where_bare
from fitter.fits.joint_view import JointView
from fitter.fits.settling import Shaded
from fitter.optimizer.alternation import first_shading, next_shading, shaded_fit
from fitter.optimizer.gauss_newton import Minimum
from fitter.optimizer.light_solve import guessed_lights
from fitter.request import Cues


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class LitView:
    """E1 of a picture, and its light; no ``shading`` for SE, and where shading tells nothing."""

    objective: Objective
    intensity: IntensityMap
    shading: ShadingEvidence | None

    @property
    def energy(self) -> Objective:
        """E2, or E1 without shading."""
        return self.objective if self.shading is None else self.objective.with_shading(self.shading)

    def next(self, seen: Candidate, round_index: int) -> "LitView":
        """With light, shadows and reflectance found again for a body, as a round begins."""
        if self.shading is None:
            return self
        shading = next_shading(self.objective, seen, self.shading, round_index)
        return replace(self, shading=shading)

    def settled(self, minimum: Minimum) -> Shaded:
        """At the end of the search."""
        return Shaded(
            objective=self.objective,
            intensity=self.intensity,
            minimum=minimum,
            shading=None
            if self.shading is None
            else shaded_fit(self.objective, minimum, self.shading, evaluations=minimum.evaluations),
        )


def first_lit(view: JointView, seen: Candidate) -> LitView:
    """The first light of a picture, at the minimum of E1."""
    observation, request = view.observation, view.request
    objective = view.objective
    intensity = intensity_map(observation.luminance, observation.display, view.segmentation.mask)
    shading: ShadingEvidence | None = None
    if request.cues is Cues.SES:
        objective, intensity = where_bare(objective, seen, intensity)
        shading = first_shading(
            objective, seen, intensity, guessed_lights(request.light), request.light.surroundings
        )
    return LitView(objective=objective, intensity=intensity, shading=shading)

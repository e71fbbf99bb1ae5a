"""The searches a request asks for in one picture: to the minimum of E1, then to that of E2."""

from collections.abc import Sequence
from dataclasses import dataclass

from fitter.arrays import Image
from fitter.energies.objective import Body, Candidate, EnergyObserver, Objective
from fitter.evidence.intensity import IntensityMap
from fitter.observation.observation import Observation
from fitter.optimizer.alternation import ROUND_TOLERANCES, BodySearch, ShadedFit, fit_shading
from fitter.optimizer.gauss_newton import SETTLED_NATS, Minimum
from fitter.optimizer.renewed_lines import renewing_lines, with_lines_about
from fitter.optimizer.search import SearchLimits, body_search, limits_of
from fitter.parameters import Light
from fitter.request import FitRequest, OptimizerKind, OutlineKind, SurroundingsKind


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Descents:
    """How the body is searched for in one picture.

    Attributes
    ----------
    optimizer, limits
        Which search, and for how long.
    display
        (h, w, 3) the picture's display values in [0, 1].
    meets_lines
        Whether the contour is to meet correspondence lines, once a body is near.
    surroundings
        How the light is described.
    """

    optimizer: OptimizerKind
    limits: SearchLimits
    display: Image
    meets_lines: bool
    surroundings: SurroundingsKind

    def search(
        self, max_evaluations: int, report: EnergyObserver, settled_nats: float = SETTLED_NATS
    ) -> BodySearch:
        """One search, against the outline its objective already has."""
        return body_search(self.optimizer, max_evaluations, report, settled_nats)

    def silhouette_and_edges(
        self, objective: Objective, start: Body, report: EnergyObserver
    ) -> Minimum:
        """From a body near the person to the minimum of E1."""
        settle = self.search(self.limits.contest, report)
        descend = self.search(self.limits.silhouette_and_edges, report)
        searches = [settle, descend] if self.meets_lines else [descend]
        return self._renewing(searches)(objective, start)

    def first_steps(self, objective: Objective, start: Body, report: EnergyObserver) -> Minimum:
        """The same as far as a search of several pictures needs it to go on from."""
        return self._renewing([self.search(self.limits.contest, report)])(objective, start)

    def shading(
        self,
        objective: Objective,
        start: Candidate,
        intensity: IntensityMap,
        lights: tuple[Light, ...],
        report: EnergyObserver,
    ) -> ShadedFit | None:
        """From the minimum of E1 to that of E2; None where shading tells nothing."""
        searches = [
            self._renewing([self.search(self.limits.shading_round, report, settled_nats)])
            for settled_nats in ROUND_TOLERANCES
        ]
        return fit_shading(
            objective, start, intensity, lights, searches=searches, surroundings=self.surroundings
        )

    def about(self, objective: Objective, body: Body) -> Objective:
        """The objective with the outline that a search from this body would be fitted to."""
        if not self.meets_lines:
            return objective
        return with_lines_about(objective, body, self.display)

    def _renewing(self, searches: Sequence[BodySearch]) -> BodySearch:
        if self.meets_lines:
            return renewing_lines(searches, self.display)
        (search,) = searches
        return search


def descents(request: FitRequest, observation: Observation) -> Descents:
    """The searches of a request; a mask sent by the caller is used as it is."""
    return Descents(
        optimizer=request.optimizer,
        limits=limits_of(request.optimizer),
        display=observation.display,
        meets_lines=request.outline is OutlineKind.LINES and observation.mask is None,
        surroundings=request.light.surroundings,
    )

"""One shape for all pictures of a person: to the minimum of E1, then to that of E2 (section 5).

Outlines are found again before each search, and light and reflectance of every picture in turn with
the bodies in all of them (:mod:`fitter.optimizer.alternation`).
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

from fitter.arrays import Shape
from fitter.energies.objective import Body, Candidate, EnergyObserver, JointObjective, Objective
from fitter.energies.scales import scales_of_several
from fitter.energies.shading import IntensityMap, ShadingEvidence, intensity_map
from fitter.fits.clothing import where_bare
from fitter.fits.outline_search import PictureSearch
from fitter.fits.picture_objective import of_person
from fitter.fits.progress import Stage, StageClock
from fitter.optimizer.alternation import (
    SMOOTHNESS_SCHEDULE,
    ShadedFit,
    first_shading,
    fit_shading,
    shaded_fit,
    with_shading,
)
from fitter.optimizer.light_solve import guessed_lights
from fitter.optimizer.search import (
    FIRMLY_SETTLED_NATS,
    NEARLY_SETTLED_NATS,
    SETTLED_NATS,
    BodySearch,
    Minimum,
    body_search,
    limits_of,
)
from fitter.population.known_person import KnownPerson
from fitter.request import Choices
from fitter.vocabulary.choices import Cues


@dataclass(frozen=True, slots=True, kw_only=True)
class Schedule:
    """Schedule of the search of all pictures together.

    Attributes
    ----------
    outline_nats
        Gain below which the search for the minimum of E1 ends.
    rounds
        Of the alternation: λ₁ = λ₂, and the gain below which the search for the bodies ends.
    unlit_nats
        The same of a second search of E1 where no picture tells anything by its shading; None for
        none.
    """

    outline_nats: float
    rounds: tuple[tuple[float, float], ...]
    unlit_nats: float | None


_FIRST, _SECOND, _LAST = SMOOTHNESS_SCHEDULE

OF_ONE = Schedule(
    outline_nats=SETTLED_NATS,
    rounds=(
        (_FIRST, NEARLY_SETTLED_NATS),
        (_SECOND, NEARLY_SETTLED_NATS),
        (_LAST, FIRMLY_SETTLED_NATS),
    ),
    unlit_nats=None,
)
OF_SEVERAL = Schedule(outline_nats=0.5, rounds=((_FIRST, 0.5), (_LAST, 0.1)), unlit_nats=0.1)
"""Searches of several pictures end earlier, for two pictures are about twice as rough, and take
fewer rounds, for where several views tell the depth shading has less left to tell."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class LitView:
    """A picture searched to the end.

    Attributes
    ----------
    intensity
        The intensities that shading was compared with.
    shading
        None for SE, and where shading tells nothing.
    """

    intensity: IntensityMap
    shading: ShadedFit | None


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Found:
    """One person in all pictures.

    Attributes
    ----------
    objective
        E1, with the outlines that the final bodies are to meet: other bodies can be compared by it.
    outline, minimum
        The minima of E1 and of E2; the same where no picture has ``shading``.
    views
        In the order given.
    evaluations
        True energies computed.
    """

    objective: JointObjective
    outline: Minimum
    minimum: Minimum
    views: tuple[LitView, ...]
    evaluations: int

    @property
    def is_lit(self) -> bool:
        """Whether shading took part."""
        return any(view.shading is not None for view in self.views)

    @property
    def energy(self) -> JointObjective:
        """The energy that was minimised: E2, or E1 where no picture has shading."""
        return with_shading(
            self.objective, [view.shading and view.shading.evidence for view in self.views]
        )


def search(
    pictures: Sequence[PictureSearch],
    known: KnownPerson,
    shape: Shape,
    choices: Choices,
    clock: StageClock,
) -> Found:
    """From bodies near the person to the minimum over one shape, and pose and place in each.

    ``shape`` is what all bodies begin with, and has what is held. Pictures that are not to be
    compared by their shading take part with E1.
    """
    several = len(pictures) > 1
    schedule = OF_SEVERAL if several else OF_ONE
    limits = limits_of(choices.optimizer)

    def searching(most: int, settled_nats: float, report: EnergyObserver) -> BodySearch:
        """Against outlines that are found anew along the bodies it starts from."""
        plain = body_search(choices.optimizer, most, report, settled_nats)

        def renewed(objective: JointObjective, bodies: Sequence[Body]) -> Minimum:
            seen = [view.see(body) for view, body in zip(objective.views, bodies, strict=True)]
            return plain(_about(pictures, objective, seen), seen)

        return renewed

    objective = of_person(
        known,
        [
            replace(each.objective, scales=scales_of_several(each.objective.scales))
            if several
            else each.objective
            for each in pictures
        ],
    )
    with clock.stage(Stage.SILHOUETTE_AND_EDGES) as report:
        outline = searching(limits.silhouette_and_edges, schedule.outline_nats, report)(
            objective, [each.with_shape(shape) for each in pictures]
        )
    with clock.stage(Stage.SHADING) as report:
        first = [
            _first_light(picture, view, seen)
            for picture, view, seen in zip(
                pictures, objective.views, outline.candidate.views, strict=True
            )
        ]
        objective = objective.with_views([each.objective for each in first])
        states = [each.state for each in first]
        minimum, evaluations = outline, outline.evaluations
        if any(state is not None for state in states):
            lit = fit_shading(
                objective,
                outline.candidate,
                states,
                [
                    (smoothness, searching(limits.shading_round, settled_nats, report))
                    for smoothness, settled_nats in schedule.rounds
                ],
            )
            minimum, states = lit.minimum, lit.states
            evaluations += lit.evaluations
        elif schedule.unlit_nats is not None:
            again = searching(limits.silhouette_and_edges, schedule.unlit_nats, report)
            minimum = again(objective, outline.candidate.views)
            evaluations += minimum.evaluations
        final = minimum.candidate.views
        views = tuple(
            LitView(
                intensity=each.intensity,
                shading=None if state is None else shaded_fit(each.objective, seen, state),
            )
            for each, seen, state in zip(first, final, states, strict=True)
        )
    return Found(
        objective=_about(pictures, objective, final),
        outline=outline,
        minimum=minimum,
        views=views,
        evaluations=evaluations,
    )


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _FirstLight:
    """E1 of a picture, and its light at the minimum of E1 if it tells anything."""

    objective: Objective
    intensity: IntensityMap
    state: ShadingEvidence | None


def _first_light(picture: PictureSearch, objective: Objective, seen: Candidate) -> _FirstLight:
    observation, asked = picture.observation, picture.view
    intensity = intensity_map(
        observation.luminance, observation.display, picture.segmentation.mask
    ).without(objective.evidence.silhouette.doubtful)
    state: ShadingEvidence | None = None
    if asked.cues is Cues.SES:
        objective, intensity = where_bare(objective, seen, intensity)
        lights = guessed_lights(asked.light)
        state = first_shading(objective, seen, intensity, lights)
    return _FirstLight(objective=objective, intensity=intensity, state=state)


def _about(
    pictures: Sequence[PictureSearch], objective: JointObjective, bodies: Sequence[Body]
) -> JointObjective:
    return objective.with_views(
        [
            picture.about(view, body)
            for picture, view, body in zip(pictures, objective.views, bodies, strict=True)
        ]
    )

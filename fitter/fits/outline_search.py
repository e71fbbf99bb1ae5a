"""One picture by itself, to a body near its outline: what every fit begins with."""

from dataclasses import dataclass, replace

from fitter.arrays import Image, Shape
from fitter.detection.detector import Detector
from fitter.energies.objective import Body, Objective
from fitter.energies.scales import FAR_BOUNDARY_ETA_M, NEAR_BOUNDARY_ETA_M, scales_at
from fitter.energies.terms import SeenBody
from fitter.evidence.doubtful_outline import doubtful_outline
from fitter.fits.equipment import PreparedModel
from fitter.fits.picture_objective import (
    of_person,
    segmented,
    silhouette_and_edges,
    with_silhouette,
)
from fitter.fits.progress import Stage, ViewClock
from fitter.fits.reporting import limb_facings
from fitter.observation.observation import Observation, observe
from fitter.optimizer.search import body_search, limits_of, try_hypotheses, with_lines_about
from fitter.parameters import BodyParameters
from fitter.population.known_person import KnownPerson
from fitter.pose_init.click_problem import clicked_points
from fitter.pose_init.initial_pose import initialize_pose
from fitter.request import Choices, View
from fitter.segmentation.grabcut import Segmentation
from fitter.segmentation.trimap import Trimap
from fitter.vocabulary.outcomes import LimbFacing


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Subject:
    """Whom the pictures show: the body model, and what the caller knows of the person."""

    prepared: PreparedModel
    known: KnownPerson


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class PictureSearch:
    """A picture with a body near the minimum of E1.

    Attributes
    ----------
    view, observation
        What was asked, and the picture as it was read.
    trimap, segmentation
        Of the last cut; no tri-map where the caller sent a mask.
    objective
        E1 of this picture.
    initial, body
        Where the search began, and a body near the person.
    limb_facing
        How each limb's depth ambiguity was resolved; empty where a body was there to begin with.
    lines_on
        (h, w, 3) the display values on which the outline is found again about each body; None where
        it stays that of the segmentation.
    evaluations
        True energies computed so far.
    """

    view: View
    observation: Observation
    trimap: Trimap | None
    segmentation: Segmentation
    objective: Objective
    initial: BodyParameters
    body: SeenBody
    limb_facing: tuple[LimbFacing, ...]
    lines_on: Image | None
    evaluations: int

    def with_shape(self, shape: Shape) -> Body:
        """The body with another shape; as it was seen where that is its own."""
        own = self.body.parameters
        return self.body if shape is own.shape else replace(own, shape=shape)

    def about(self, objective: Objective, body: Body) -> Objective:
        """An objective of this picture with the outline that a body there is to meet."""
        return _about(objective, body, self.lines_on)


def search_outline(
    view: View,
    subject: Subject,
    choices: Choices,
    detector: Detector | None,
    clock: ViewClock,
    *,
    is_only: bool,
) -> PictureSearch:
    """Sections 3.1 to 3.3: pose from points, the person cut out twice, first steps towards E1.

    ``is_only`` says that there is no other picture.

    Raises
    ------
    InvalidInputError
        If the picture cannot be used; the message names the field and the remedy.
    """
    prepared, known = subject.prepared, subject.known
    with clock.stage(Stage.OBSERVATION):
        observation = observe(view, max_pixels=choices.max_pixels, detector=detector)
    # A mask that the caller sent is met as it is.
    lines_on = observation.display if observation.mask is None else None
    with clock.stage(Stage.INITIAL_POSE):
        initial = initialize_pose(
            prepared.searched.evaluator,
            camera=observation.camera,
            clicks=clicked_points(observation.clicks),
            shape=known.shape,
            limb_facing=view.limb_facing,
            slants=observation.slants,
        )
    kind = choices.optimizer
    limits = limits_of(kind)
    with clock.stage(Stage.SEGMENTATION) as report:
        _, segmentation = segmented(observation, prepared, initial.parameters, fitted=False)
        coarse = silhouette_and_edges(
            observation,
            prepared,
            initial.parameters,
            segmentation,
            boundary_eta_m=FAR_BOUNDARY_ETA_M,
        )
        first = body_search(kind, limits.first, report)
        nearer = first(of_person(known, [coarse]), [initial.parameters])
        (near,) = nearer.candidate.views
        labels, segmentation = segmented(
            observation,
            prepared,
            near.parameters,
            fitted=True,
            loosely_dressed=is_loosely_dressed(coarse),
        )
    with clock.stage(Stage.SILHOUETTE_AND_EDGES) as report:
        hypotheses = initial.hypotheses[: limits.hypotheses]
        far = with_silhouette(coarse, segmentation, observation, prepared, near.parameters)
        objective = replace(
            far,
            scales=scales_at(
                observation.camera, initial.root_depth_m, boundary_eta_m=NEAR_BOUNDARY_ETA_M
            ),
        )
        contest = body_search(kind, limits.contest, report)
        tried = try_hypotheses(
            of_person(known, [far]),
            of_person(known, [objective]),
            # The first reading goes on from where the first search ended.
            [near, *(each.parameters for each in hypotheses[1:])],
            trial=body_search(kind, limits.trial, report),
            contenders=limits.contenders,
            hopeless_nats=limits.hopeless_nats,
            contest=contest,
        )
        body: SeenBody = tried.winner
        evaluations = nearer.evaluations + tried.evaluations
        doubtful = doubtful_outline(
            objective.evidence.silhouette, body.rendering, observation.display
        )
        if doubtful.any() and not is_loosely_dressed(objective):
            further = contest(of_person(known, [far]), [body])
            (reaching,) = further.candidate.views
            evaluations += further.evaluations
            still = doubtful_outline(
                objective.evidence.silhouette, reaching.rendering, observation.display
            )
            if not still.any():
                # It was the person's own, such as a belly that no search had reached.
                doubtful, body = still, reaching
        objective = objective.doubting(doubtful)
        # Against a region that stays as it is, one search is enough.
        if lines_on is not None or doubtful.any() or not is_only:
            lined = _about(objective, body, lines_on)
            steps = contest(of_person(known, [lined]), [body])
            (body,) = steps.candidate.views
            evaluations += steps.evaluations
    return PictureSearch(
        view=view,
        observation=observation,
        trimap=labels,
        segmentation=segmentation,
        objective=objective,
        initial=hypotheses[0].parameters,
        body=body,
        limb_facing=limb_facings(hypotheses, tried, view.limb_facing),
        lines_on=lines_on,
        evaluations=evaluations,
    )


def is_loosely_dressed(objective: Objective) -> bool:
    """Whether the outline is taken to bound the body from outside, somewhere."""
    return objective.evidence.clothes is not None


def _about(objective: Objective, body: Body, lines_on: Image | None) -> Objective:
    return objective if lines_on is None else with_lines_about(objective, body, lines_on)

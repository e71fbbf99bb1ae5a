"""The paper's own method, step by step over the package's pieces, without what was added to it.

The mean person of the height is posed by the clicks (3.1), cut out by GrabCut in the tri-map around
that body (3.2), and moved to the minimum of

    E1 = E_Si + E_Eg + E_Pn    and of    E2 = E1 + E_Sh    (section 6)

and of nothing else: clicks, pose, stance and shape cost nothing once the search runs. Bodies have
what is known exactly (section 4); what is given with a standard error sets the first body alone.
For E2 light, reflectance and body alternate from the first body on, λ falling, until the body stays
where it is (section 5). Any of the four terms may be left out.

The verdict, the findings and the camera's tilt come of the final body under the priors and limits
of ordinary fits, but of less evidence: clothes count as tight, and no detector looks unless points
are to be proposed. Where all are clicked, nothing is found by it, such as that the picture shows
nobody at the points, or several people. The paper states no errors, and neither does a fit by its
method.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from fitter.body.shape_space import height_of_shape
from fitter.energies.objective import Candidate, JointObjective, Objective
from fitter.energies.scales import FAR_BOUNDARY_ETA_M
from fitter.energies.shading import IntensityMap, intensity_map
from fitter.energies.shape_terms import NOTHING_KNOWN, no_prior
from fitter.evidence.silhouette_evidence import silhouette_evidence
from fitter.fits.equipment import Equipment, PreparedModel
from fitter.fits.outline_search import PictureSearch, Subject
from fitter.fits.picture_objective import of_person, silhouette_and_edges
from fitter.fits.progress import Stage, StageClock, ViewClock
from fitter.fits.search import Found, LitView
from fitter.observation.observation import Observation, observe
from fitter.optimizer.alternation import (
    SMOOTHNESS_SCHEDULE,
    first_shading,
    next_shading,
    shaded_fit,
    with_shading,
)
from fitter.optimizer.light_solve import guessed_lights
from fitter.optimizer.search import FIRMLY_SETTLED_NATS, BodySearch, body_search
from fitter.parameters import BodyParameters
from fitter.pose_init.click_problem import clicked_points
from fitter.pose_init.initial_pose import InitialPose, initialize_pose
from fitter.render.rasterizer import render
from fitter.request import Choices, Paper, View
from fitter.result import PictureFit
from fitter.segmentation.grabcut import Segmentation, border_warnings, segment
from fitter.segmentation.trimap import Trimap, first_band, trimap
from fitter.vocabulary.choices import (
    Clothing,
    Cues,
    OptimizerKind,
    PaperEnergy,
    SegmentationKind,
)
from fitter.vocabulary.measurements import STATURE
from fitter.vocabulary.outcomes import FacingSource, LimbFacing

MOST_ROUNDS: Final = 12
"""Most rounds of light, reflectance and body; the last of λ holds from the third on."""

STILL_M: Final = 1e-3
"""The alternation ends with a round that moves the body's vertices by less, on average."""

_MOST_ENERGIES: Final = {OptimizerKind.GAUSS_NEWTON: 500, OptimizerKind.SIMPLEX: 60_000}
"""Most evaluations in a search of the body; a simplex in 74 dimensions needs tens of thousands."""

_SHADING_NATS: Final = 130.0
"""Energy E_Sh, nats, where nothing is explained. The paper leaves its size open; this pulls as much
as the package's own does where a seventh is left unexplained, which is usual."""

_LARGE: Final = 1e6
"""L₀ so large that n/2 log(1 + L/L₀) is linear in L, and so Eq. 2's mean itself."""

_NO_BONES: Final = np.zeros((0, 2, 2))

_DIFFERENCES: Final = (
    "The body models are learned from MakeHuman's bodies, not from laser scans.",
    "Shapes are compared by vertices and four measurements, not by triangles' deformations.",
    "The search moves 4,800 to 4,900 of 12,440 vertices, and compares 3,800 to 3,900 by shading.",
    "The best reading of the clicks by joint limits is refined on the clicks before the search.",
    "The tri-map's band is 5 % of the picture's width, within 4 to 8 % of the person's size.",
    "GrabCut learns its first colours from the pixels that the tri-map is sure of.",
    "Terms are divided by the expected size of their residuals; the paper leaves weights open.",
    "The silhouette's distance counts less beyond 6 cm; the paper does not write its function.",
    "Edges and shading count by their means, lest a body gain by hiding, not by their sums.",
    "The specular exponent is 12, not estimated, and ambient light no more than the darkest skin.",
    "A weak prior takes the lamp to be 3 m away, and cast shadows take no part.",
    "Without a first light of the caller's, six are tried.",
    "Measurements given with a standard error set the first body, and count no more in the search.",
    "Reflectance is found by reweighted least squares, not by gradient descent.",
)
_BY_GRADIENT: Final = (
    "The body is searched for by Gauss-Newton; the optimizer `simplex` is the paper's search."
)
_BY_SIMPLEX: Final = "A search by the simplex ends after 60,000 energies if it has not converged."


def differences(choices: Choices) -> tuple[str, ...]:
    """Differences from the paper of a fit by its method, as plain sentences."""
    simplex = choices.optimizer is OptimizerKind.SIMPLEX
    return (*_DIFFERENCES, _BY_SIMPLEX if simplex else _BY_GRADIENT)


def paper_picture(
    view: View, subject: Subject, choices: Choices, equipment: Equipment, clock: StageClock
) -> PictureSearch:
    """Sections 3.1 to 3.3: the first body, the person cut out around it, and the picture's terms.

    Raises
    ------
    InvalidInputError
        If the picture cannot be used; the message names the field and the remedy.
    """
    of_view, prepared = ViewClock(clock=clock, view=0), subject.prepared
    view = replace(
        view,
        clothing=Clothing.TIGHT,
        segmentation=SegmentationKind.GRABCUT,
        slant_hints=False,
    )
    with of_view.stage(Stage.OBSERVATION):
        observation = observe(
            view, max_pixels=choices.max_pixels, detector=equipment.detector_for(view)
        )
    with of_view.stage(Stage.INITIAL_POSE):
        initial = initialize_pose(
            prepared.searched.evaluator,
            camera=observation.camera,
            clicks=clicked_points(observation.clicks),
            shape=subject.known.shape,
            limb_facing=view.limb_facing,
        )
    with of_view.stage(Stage.SEGMENTATION):
        labels, segmentation = _segmented(observation, prepared, initial.parameters)
        objective = _terms(observation, prepared, initial.parameters, segmentation)
    return PictureSearch(
        view=view,
        observation=observation,
        trimap=labels,
        segmentation=segmentation,
        objective=objective,
        initial=initial.parameters,
        body=objective.see(initial.parameters),
        limb_facing=_limb_facing(initial, view),
        lines_on=None,
        evaluations=0,
    )


def paper_search(
    picture: PictureSearch,
    subject: Subject,
    paper: Paper,
    optimizer: OptimizerKind,
    clock: StageClock,
) -> Found:
    """The minimum of E1, and that of E2 where shading counts, each from the first body."""
    counted = {each.value for each in paper.energies} - {PaperEnergy.SHADING.value}
    objective = _energy(picture, subject, paper, frozenset(counted))
    intensity = intensity_map(
        picture.observation.luminance, picture.observation.display, picture.segmentation.mask
    )
    with clock.stage(Stage.SILHOUETTE_AND_EDGES) as report:
        search = body_search(
            optimizer, _MOST_ENERGIES[optimizer], report, settled_nats=FIRMLY_SETTLED_NATS
        )
        outline = search(objective, [picture.body])
    found = Found(
        objective=objective,
        outline=outline,
        minimum=outline,
        views=(LitView(intensity=intensity, shading=None),),
        evaluations=outline.evaluations,
    )
    if PaperEnergy.SHADING not in paper.energies or picture.view.cues is not Cues.SES:
        return found
    with clock.stage(Stage.SHADING) as report:
        search = body_search(
            optimizer, _MOST_ENERGIES[optimizer], report, settled_nats=FIRMLY_SETTLED_NATS
        )
        shaded = _energy(picture, subject, paper, frozenset({*counted, PaperEnergy.SHADING.value}))
        return _with_shading(found, picture, shaded, intensity, search)


def _with_shading(
    found: Found,
    picture: PictureSearch,
    objective: JointObjective,
    intensity: IntensityMap,
    search: BodySearch,
) -> Found:
    """Section 5: light, reflectance and body in turn, until the body stays where it is."""
    (view,) = objective.views
    first = view.evaluate(picture.body)
    state = first_shading(view, first, intensity, guessed_lights(picture.view.light))
    if state is None:
        return found
    now, evaluations, still = first, found.evaluations, False
    minimum = found.minimum
    last = len(SMOOTHNESS_SCHEDULE) - 1
    for number in range(MOST_ROUNDS):
        state = next_shading(
            view,
            now,
            state,
            smoothness=SMOOTHNESS_SCHEDULE[min(number, last)],
            light_is_new=number == 0,
        )
        minimum = search(with_shading(objective, [state]), [now])
        evaluations += minimum.evaluations
        before, (now,) = now, minimum.candidate.views
        still = _moved_m(before, now) < STILL_M
        if still and number >= last:
            break
    return replace(
        found,
        objective=objective,
        minimum=replace(minimum, converged=minimum.converged and still),
        views=(LitView(intensity=intensity, shading=shaded_fit(view, now, state)),),
        evaluations=evaluations,
    )


def with_all_terms(subject: Subject, found: Found) -> Found:
    """The same bodies under all terms of an ordinary fit that the picture has evidence for."""
    everything = of_person(
        subject.known, [replace(view, counted=None) for view in found.objective.views]
    )
    judged = replace(found, objective=everything)
    candidate = judged.energy.evaluate(found.minimum.candidate.views)
    return replace(judged, minimum=replace(found.minimum, candidate=candidate))


def with_height_found(subject: Subject, paper: Paper, found: Found) -> Subject:
    """The subject with the height that was found, where it was free."""
    if not paper.free_height:
        return subject
    known = subject.known
    height_m = height_of_shape(subject.prepared.operators.evaluator, found.minimum.candidate.shape)
    return replace(
        subject,
        known=replace(
            known,
            height_m=height_m,
            given=tuple(each for each in known.given if each != STATURE),
            held=tuple(each for each in known.held if each != STATURE),
            assumptions=(),
        ),
    )


def without_standard_errors(people: Sequence[PictureFit]) -> tuple[PictureFit, ...]:
    """The same; nothing is said of how certain the shape is."""
    return tuple(
        replace(each, person=replace(each.person, shape_covariance=None)) for each in people
    )


def _segmented(
    observation: Observation, prepared: PreparedModel, first: BodyParameters
) -> tuple[Trimap | None, Segmentation]:
    """The caller's mask, or GrabCut in the tri-map of the first body and of nothing else (3.2)."""
    if observation.mask is not None:
        return None, Segmentation(mask=observation.mask, warnings=border_warnings(observation.mask))
    vertices = prepared.searched.evaluator.vertices(first)
    silhouette = render(vertices, prepared.searched.model.triangles, observation.camera).silhouette
    labels = trimap(silhouette, _NO_BONES, band=first_band(silhouette, _NO_BONES))
    return labels, segment(observation.display, labels)


def _terms(
    observation: Observation,
    prepared: PreparedModel,
    first: BodyParameters,
    segmentation: Segmentation,
) -> Objective:
    """The picture's terms: every pixel of the outline counts alike, and E_Sh is Eq. 2's mean."""
    objective = silhouette_and_edges(
        observation, prepared, first, segmentation, boundary_eta_m=FAR_BOUNDARY_ETA_M
    )
    return replace(
        objective,
        evidence=replace(objective.evidence, silhouette=silhouette_evidence(segmentation.mask)),
        scales=replace(
            objective.scales, shading_weight=_LARGE * _SHADING_NATS, shading_floor=_LARGE
        ),
    )


def _energy(
    picture: PictureSearch, subject: Subject, paper: Paper, counted: frozenset[str]
) -> JointObjective:
    """The sum of these terms, over bodies that have what is held."""
    held = replace(subject.known.attributes.held, with_height=not paper.free_height)
    return replace(
        of_person(subject.known, [replace(picture.objective, counted=counted)]),
        shape_prior=no_prior(len(subject.known.shape)),
        attributes=replace(NOTHING_KNOWN, held=held),
    )


def _limb_facing(initial: InitialPose, view: View) -> tuple[LimbFacing, ...]:
    """As the best reading has it: no other is tried on the picture, so that none is close."""
    return tuple(
        LimbFacing(
            limb=limb,
            facing=facing,
            source=FacingSource.CALLER if limb in view.limb_facing else FacingSource.PRIOR,
            ambiguous=False,
            alternative_nats=None,
        )
        for limb, facing in initial.hypotheses[0].facing.items()
    )


def _moved_m(before: Candidate, after: Candidate) -> float:
    """Mean distance that the vertices have moved, metres."""
    return float(np.linalg.norm(after.vertices - before.vertices, axis=1).mean())

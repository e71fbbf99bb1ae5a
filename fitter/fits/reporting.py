"""Reports of a fit about itself: its end, the facing of limbs, and warnings.

That pictures show different people, others than announced or a given measurement that is wrong, is
found by residuals: what one picture says of the shape against the others, how a fitted body is
turned against the view that was announced, and what all pictures say of a measurement against what
was given.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from fitter.energies.objective import JointCandidate, JointObjective
from fitter.energies.shape_terms import NOTHING_KNOWN
from fitter.measurement.definitions import INTERVAL_SD
from fitter.numerics.rotations import rotation_matrices
from fitter.optimizer.free_space import free_space
from fitter.optimizer.joint_equations import joint_equations
from fitter.optimizer.search import TriedHypotheses
from fitter.parameters import BodyParameters
from fitter.person.several_pictures import CombinedShape
from fitter.population.known_person import KnownPerson
from fitter.pose_init.initial_pose import PoseHypothesis
from fitter.request import Choices, View
from fitter.result import PictureFit
from fitter.vocabulary.choices import Cues, Facing, ViewKind
from fitter.vocabulary.measurements import STATURE
from fitter.vocabulary.outcomes import FacingSource, LimbFacing, Outcome, Verdict
from fitter.vocabulary.remarks import Code, Note, Remark, remark


@dataclass(frozen=True, slots=True, kw_only=True)
class GivenMeasurement:
    """A measurement that was given, and what pictures and population say of it without that.

    In its unit.
    """

    name: str
    given: float
    value: float
    standard_error: float


def predict_given(
    objective: JointObjective, candidate: JointCandidate, known: KnownPerson
) -> tuple[GivenMeasurement, ...]:
    """One Newton step from the minimum with all that was given, without it; the height stays.

    Measurements are so nearly linear in the shape that one step says enough.
    """
    known_attributes = objective.attributes
    given = [name for name in known.given if name != STATURE]
    names = [name for name in given if name in known.held]
    names += [name for name in given if name not in known.held]
    if not names:
        return ()
    shape = candidate.shape
    without = replace(objective, attributes=NOTHING_KNOWN)
    equations = joint_equations(without, candidate, free_space(NOTHING_KNOWN.held, shape))
    both = (known_attributes.held, known_attributes.uncertain)
    slopes = np.concatenate([each.jacobian(shape) for each in both]) @ equations.directions
    values = np.concatenate([each.measure(shape) for each in both])
    values = values + slopes @ equations.step(0.0).shape
    information = equations.shape_information()
    errors = np.sqrt((slopes * np.linalg.solve(information, slopes.T).T).sum(axis=1))
    return tuple(
        GivenMeasurement(
            name=name, given=float(value), value=float(found), standard_error=float(error)
        )
        for name, value, found, error in zip(
            names,
            np.concatenate([each.values for each in both]),
            values,
            errors,
            strict=True,
        )
    )


POOR_OVERLAP = 0.85
"""A fit with less intersection over union than this is called poor: half an arm is about 4 %."""

AMBIGUOUS_NATS = 6.0
"""A limb is ambiguous if facing the other way is within this energy of the best: odds of 400 to 1,
generous because the spreads of clicks and joints behind the energies are themselves guesses."""


MOST_TURNED_DEG = 50.0
"""From the announced view; half way to the next, and a little."""

MOST_DEVIATIONS = 3.0
"""Standard errors by which what was given may differ from what pictures say of it."""

_ANNOUNCED_DEG = {ViewKind.FRONT: 0.0, ViewKind.SIDE: 90.0, ViewKind.BACK: 180.0}
_SAID = {ViewKind.FRONT: "the front", ViewKind.SIDE: "the side", ViewKind.BACK: "behind"}


def outcome_of(*, converged: bool, overlap: float, verdict: Verdict) -> Outcome:
    """Outcome of the search."""
    if overlap < POOR_OVERLAP or verdict is not Verdict.PLAUSIBLE:
        return Outcome.POOR_FIT
    return Outcome.CONVERGED if converged else Outcome.EVALUATION_LIMIT


def limb_facings(
    hypotheses: Sequence[PoseHypothesis],
    tried: TriedHypotheses,
    said: Mapping[str, Facing],
) -> tuple[LimbFacing, ...]:
    """Resolution of each limb's depth ambiguity (section 3.1)."""
    chosen = hypotheses[tried.best]
    energy = tried.totals[tried.best]
    facings: list[LimbFacing] = []
    for limb, facing in chosen.facing.items():
        others = [
            total
            for hypothesis, total in zip(hypotheses, tried.totals, strict=True)
            if hypothesis.facing.get(limb) not in (None, facing)
        ]
        source = FacingSource.ENERGY if others else FacingSource.PRIOR
        if limb in said:
            source = FacingSource.CALLER
        facings.append(
            LimbFacing(
                limb=limb,
                facing=facing,
                source=source,
                ambiguous=bool(others) and min(others) - energy < AMBIGUOUS_NATS,
                alternative_nats=round(min(others) - energy, 2) if others else None,
            )
        )
    return tuple(facings)


def fit_warnings(overlap: float, facings: Sequence[LimbFacing]) -> tuple[Remark, ...]:
    """Warnings of what the caller should look at."""
    warnings: list[Remark] = []
    if overlap < POOR_OVERLAP:
        warnings.append(
            remark(
                Note.LOW_OVERLAP,
                f"The body covers the segmented person with an overlap of {overlap:.2f} only.",
            )
        )
    unsure = [facing.limb for facing in facings if facing.ambiguous]
    if unsure:
        warnings.append(
            remark(
                Note.AMBIGUOUS_FACING,
                f"{', '.join(unsure)}: the picture fits about as well facing the other way.",
            )
        )
    return tuple(warnings)


def insistence_warnings(choices: Choices, found: PictureFit) -> tuple[Remark, ...]:
    """Warnings of measurements that are given because the request insists."""
    if found.is_plausible or not choices.force:
        return ()
    return (
        remark(
            Note(found.verdict.value.replace("_", "-")),
            "Measurements are given because the request forces them, and may be those of "
            f"nobody. {found.outcome_explanation}",
        ),
    )


def shading_warnings(view: View, found: PictureFit) -> tuple[Remark, ...]:
    """Warnings of what was asked for about the light but could not be found."""
    if view.cues is not Cues.SES:
        return ()
    return (_SHADING_NOT_USED,) if found.person.light is None else ()


def person_warnings(
    alone: CombinedShape | None,
    given: Sequence[GivenMeasurement],
    units: Mapping[str, str],
    views: Sequence[ViewKind | None],
    bodies: Sequence[BodyParameters],
) -> tuple[Remark, ...]:
    """Warnings of what the caller should look at in the fit as a whole.

    ``alone`` is what several pictures say of the shape, each by itself; ``units`` are by
    measurement. A warning about one of several pictures names it by its place.
    """
    several = len(views) > 1
    warnings = [
        warning
        for number, (view, body) in enumerate(zip(views, bodies, strict=True))
        if (warning := _other_view(f"views.{number}" if several else "The picture", view, body))
    ]
    who = "the pictures" if several else "the picture"
    warnings += [
        warning for each in given if (warning := _contradicted(each, units[each.name], who))
    ]
    if alone is not None and alone.doubtful:
        warnings.append(_different_people(alone))
    return tuple(warnings)


def turned_deg(body: BodyParameters) -> float:
    """Turn of a body from facing the camera, degrees in [0, 180]."""
    forward = rotation_matrices(body.pose[:1])[0][:, 2]
    return float(np.degrees(np.arctan2(np.hypot(forward[0], forward[1]), forward[2])))


def _other_view(place: str, view: ViewKind | None, body: BodyParameters) -> Remark | None:
    if view in (None, ViewKind.OTHER):
        return None
    found = turned_deg(body)
    if abs(found - _ANNOUNCED_DEG[view]) <= MOST_TURNED_DEG:
        return None
    return remark(
        Code.OTHER_VIEW,
        f"{place} is said to be from {_SAID[view]}, but the body found in it is turned "
        f"by {found:.0f} degrees from facing the camera.",
    )


def _contradicted(said: GivenMeasurement, unit: str, who: str) -> Remark | None:
    if abs(said.given - said.value) <= MOST_DEVIATIONS * said.standard_error:
        return None
    return remark(
        Note.GIVEN_CONTRADICTED,
        f"{said.name} was given as {said.given:.1f} {unit}, but by {who} and the "
        f"height it is {said.value:.0f} ± {INTERVAL_SD * said.standard_error:.0f} {unit}.",
    )


def _different_people(alone: CombinedShape) -> Remark:
    return remark(
        Note.DIFFERENT_PEOPLE,
        f"The pictures seem to show different people: the body in views.{alone.differing} "
        "differs from that in the others as pictures of one person hardly do.",
    )


_SHADING_NOT_USED = remark(
    Note.SHADING_NOT_USED,
    "Too little of the body is visible, unclipped and away from its outline for shading to "
    "say anything; the result is that of silhouette and edges.",
)

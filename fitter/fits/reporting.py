"""What a fit says about itself: how it ended, which way limbs face, what to look at."""

from collections.abc import Mapping, Sequence

from fitter.optimizer.hypotheses import TriedHypotheses
from fitter.pose_init.initial_pose import PoseHypothesis
from fitter.remarks import FitWarning
from fitter.request import Choices, Cues, Facing, SurroundingsKind, View
from fitter.result import FacingSource, LimbFacing, Outcome, PictureFit, Verdict

POOR_OVERLAP = 0.85
"""A fit with less intersection over union than this is called poor: half an arm is about 4 %."""

AMBIGUOUS_NATS = 6.0
"""A limb is ambiguous if facing the other way is within this energy of the best: odds of 400 to 1,
generous because the spreads of clicks and joints behind the energies are themselves guesses."""


def outcome_of(*, converged: bool, overlap: float, verdict: Verdict) -> Outcome:
    """How the search ended."""
    if overlap < POOR_OVERLAP or verdict is not Verdict.PLAUSIBLE:
        return Outcome.POOR_FIT
    return Outcome.CONVERGED if converged else Outcome.EVALUATION_LIMIT


def limb_facings(
    hypotheses: Sequence[PoseHypothesis],
    tried: TriedHypotheses,
    said: Mapping[str, Facing],
) -> tuple[LimbFacing, ...]:
    """How each limb's depth ambiguity was resolved (section 3.1)."""
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
                alternative_energy=min(others) if others else None,
            )
        )
    return tuple(facings)


def fit_warnings(overlap: float, facings: Sequence[LimbFacing]) -> tuple[FitWarning, ...]:
    """What the caller should look at."""
    warnings: list[FitWarning] = []
    if overlap < POOR_OVERLAP:
        warnings.append(
            FitWarning(
                code="low-silhouette-overlap",
                message=(
                    f"The body covers the segmented person with an overlap of {overlap:.2f} only. "
                    "Check the points and left and right, or send a mask."
                ),
            )
        )
    unsure = [facing.limb for facing in facings if facing.ambiguous]
    if unsure:
        warnings.append(
            FitWarning(
                code="ambiguous-limb-facing",
                message=(
                    f"{', '.join(unsure)}: the picture fits about as well facing the other way. "
                    "Say which in limb_facing."
                ),
            )
        )
    return tuple(warnings)


def insistence_warnings(choices: Choices, found: PictureFit) -> tuple[FitWarning, ...]:
    """What measurements are worth that are given because the request insists."""
    if found.is_plausible or not choices.force:
        return ()
    return (
        FitWarning(
            code=found.verdict.value.replace("_", "-"),
            message=(
                "Measurements are given because the request forces them, and may be those of "
                f"nobody. {found.outcome_explanation}"
            ),
        ),
    )


def shading_warnings(view: View, found: PictureFit) -> tuple[FitWarning, ...]:
    """What was asked for about the light but could not be found."""
    if view.cues is not Cues.SES:
        return ()
    light = found.person.light
    if light is None:
        return (_SHADING_NOT_USED,)
    wanted = view.light.surroundings is SurroundingsKind.SPHERICAL_HARMONICS
    return (_SURROUNDINGS_NOT_FOUND,) if wanted and light.surroundings is None else ()


_SHADING_NOT_USED = FitWarning(
    code="shading-not-used",
    message=(
        "Too little of the body is visible, unclipped and away from its outline for shading to "
        "say anything; the result is that of silhouette and edges."
    ),
)

_SURROUNDINGS_NOT_FOUND = FitWarning(
    code="surroundings-not-found",
    message=(
        "Too little bare surface is visible to tell the light from all round from the lamp: the "
        "light is that of Eq. 1, a lamp and a constant."
    ),
)

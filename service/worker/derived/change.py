"""What changed between two fits of one person."""

from collections.abc import Callable
from dataclasses import asdict, replace

from api_schemas.derivation_kinds.change import ChangeOptions, ChangeResult, MeasurementChange
from api_schemas.results import FitWarning
from fitter.applications.change import SIGNIFICANCE, Change, changes
from fitter.errors import InvalidInputError
from fitter.vocabulary.measurements import STATURE
from service.representation.csv_tables import models_csv
from service.worker.derived.measured import measured_person
from service.worker.pipeline_port import DerivationInput, DerivationOutput

_SAME_HEIGHT_CM = 0.5
"""Heights that differ by less are one height, as people are measured in the morning and evening."""


def derive(
    job: DerivationInput[ChangeOptions], observe: Callable[[float], None]
) -> DerivationOutput[ChangeResult]:
    """Compare; see :class:`service.worker.derivers.Deriver`."""
    options = job.options
    after = measured_person(job.inputs, job.models, field="kind")
    observe(0.4)
    before = measured_person(job.others[0], job.models, field="since")
    observe(0.8)
    if before.person.gender is not after.person.gender:
        raise InvalidInputError(
            code="fits-unusable",
            field="since",
            reason=f"That fit is of a {before.person.gender.value} body, this one of a "
            f"{after.person.gender.value} body.",
            remedy="Name a fit of the same person, with the same gender.",
        )
    names = options.measurements or before.measured.names
    found = changes(before.measured.of(names), after.measured.of(names))
    stature = changes(before.measured.of([STATURE]), after.measured.of([STATURE]))[0]
    rows = tuple(MeasurementChange(**asdict(_rounded(each))) for each in found)
    return DerivationOutput(
        result=ChangeResult(
            since=options.since,
            significance=SIGNIFICANCE,
            changes=rows,
            warnings=_warnings(stature),
            artifacts=(),
        ),
        artifacts={"changes.csv": models_csv(rows, MeasurementChange.model_fields)},
    )


def _rounded(change: Change) -> Change:
    return replace(
        change,
        before=round(change.before, 3),
        after=round(change.after, 3),
        difference=round(change.difference, 3),
        standard_error=round(change.standard_error, 3),
        least=round(change.least, 3),
    )


def _warnings(stature: Change) -> tuple[FitWarning, ...]:
    if abs(stature.difference) < _SAME_HEIGHT_CM:
        return ()
    return (
        FitWarning(
            code="heights-differ",
            message=(
                f"The fits have heights of {stature.before:.1f} and {stature.after:.1f} cm. A "
                "picture says nothing of size: all other measurements follow the height, and "
                "differ with it. Fit both pictures with the same height."
            ),
        ),
    )

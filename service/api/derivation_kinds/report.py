"""The report, for people: made of what the fit found and of its pictures."""

from typing import Final

from api_schemas.derivation_kinds import DerivationKind
from api_schemas.derivation_kinds.report import ReportOptions, ReportResult
from service.api.derivation_kinds.definition import DerivationKindDefinition, Needs
from service.api.examples.files import files
from service.jobs.inputs import ALBEDO, OTHER_OVERLAYS, OVERLAY, PERSON, RESULT, SHADING, TAPES

KIND: Final = DerivationKindDefinition(
    kind=DerivationKind.REPORT,
    options=ReportOptions,
    result=ReportResult,
    needs=lambda _: Needs(
        of_fit=(RESULT, PERSON, OVERLAY, TAPES, ALBEDO, SHADING, *OTHER_OVERLAYS)
    ),
    requests={"report": {"kind": "report"}},
    answer={
        "artifacts": files(report__html=653350, report__pdf=786326),
        "kind": "report",
    },
)

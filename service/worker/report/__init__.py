"""The report of a fit: one page for people, as HTML and as PDF."""

from collections.abc import Callable
from typing import Final

from api_schemas.derivation_kinds import DerivationKind
from api_schemas.derivation_kinds.report import ReportResult
from api_schemas.results import FitResult
from service.engine.port import Report
from service.jobs.inputs import RESULT
from service.worker.pipeline_port import DerivationInput, DerivationOutput
from service.worker.report.content import report_content
from service.worker.report.page_html import report_html
from service.worker.report.page_pdf import report_pdf
from service.worker.report.pictures import report_pictures

STAGE: Final = DerivationKind.REPORT.value


def derive(job: DerivationInput, observe: Callable[[Report], None]) -> DerivationOutput:
    """Write the report; see :class:`service.worker.derivers.Deriver`."""
    observe(Report(stage=STAGE, progress=0.0))
    content = report_content(FitResult.model_validate_json(job.inputs[RESULT]))
    pictures = report_pictures(job.inputs, models=job.models)
    observe(Report(stage=STAGE, progress=0.5))
    return DerivationOutput(
        result=ReportResult(artifacts=()),
        artifacts={
            "report.html": report_html(content, pictures),
            "report.pdf": report_pdf(content, pictures),
        },
    )

"""The report of a fit or scan: one page for people to read, as HTML and as PDF."""

from collections.abc import Callable

from api_schemas.derivation_kinds.report import ReportOptions, ReportResult
from api_schemas.scans import ScanResult
from service.jobs.inputs import RESULT
from service.worker.derived.person import read_result
from service.worker.derived.report.content import NO_NUMBERS, report_content
from service.worker.derived.report.page_html import report_html
from service.worker.derived.report.page_pdf import report_pdf
from service.worker.derived.report.pictures import report_pictures
from service.worker.derived.report.scan_content import scan_content
from service.worker.derived.report.tape_drawing import tape_drawing
from service.worker.pipeline_port import DerivationInput, DerivationOutput


def derive(
    job: DerivationInput[ReportOptions], observe: Callable[[float], None]
) -> DerivationOutput[ReportResult]:
    """Write the report; see :class:`service.worker.derivers.Deriver`."""
    result = read_result(job.inputs[RESULT])
    drawing = tape_drawing(job.inputs, models=job.models) if result.measurements else None
    numbers = NO_NUMBERS if drawing is None else drawing.numbers
    content = (
        scan_content(result, job.options, numbers=numbers)
        if isinstance(result, ScanResult)
        else report_content(result, job.options, numbers=numbers)
    )
    pictures = report_pictures(
        job.inputs, drawing, words=content.wording.pictures, models=job.models
    )
    observe(0.5)
    return DerivationOutput(
        result=ReportResult(artifacts=()),
        artifacts={
            "report.html": report_html(content, pictures),
            "report.pdf": report_pdf(content, pictures),
        },
    )

"""What the report of a scan says, in words: that of a fit, with a paragraph for every view."""

from collections.abc import Mapping

from api_schemas.derivation_kinds.report import ReportOptions
from api_schemas.scans import ScannedView, ScanResult
from service.worker.derived.report.content import (
    DEFAULTS,
    NO_NUMBERS,
    ReportContent,
    Section,
    about,
    assumed,
    chief_rows,
    figure_rows,
    further_groups,
    how_it_ended,
    lens,
    warned,
)
from service.worker.derived.report.wording import Wording
from service.worker.derived.report.wordings import WORDINGS


def scan_content(
    result: ScanResult,
    options: ReportOptions = DEFAULTS,
    *,
    numbers: Mapping[str, int] = NO_NUMBERS,
) -> ReportContent:
    """Put a result into words; ``numbers`` are those of tapes, by the measurements' names."""
    wording = WORDINGS[options.language]
    views, remarks = result.views, [*result.warnings]
    assumptions = [*result.assumptions]
    findings = [found for view in views for found in view.findings]
    for view in views:
        remarks += view.warnings
        assumptions += view.assumptions
    return ReportContent(
        wording=wording,
        title=wording.scan_title,
        subtitle=wording.scan_subtitle.format(
            about=about(result.gender, result.height_m, options),
            count=len(views),
        ),
        figures=figure_rows(result.measurements, options),
        measurements=chief_rows(result.measurements, options, numbers),
        further=further_groups(result.measurements, options),
        sections=(
            Section(
                heading=wording.fit.pictures,
                facts=tuple(_view(view, wording) for view in views),
            ),
            Section(
                heading=wording.fit.scan,
                facts=(
                    (wording.fit.how_it_ended, _ended(result, wording)),
                    (wording.fit.agreement, _agreement(result.agreement, wording)),
                ),
            ),
            assumed(dict.fromkeys(assumptions), options),
            warned(dict.fromkeys(findings), dict.fromkeys(remarks), wording),
        ),
    )


def _ended(result: ScanResult, wording: Wording) -> str:
    first = result.views[0]
    return how_it_ended(result.verdict, first.outcome, result.outcome_explanation, wording)


def _view(view: ScannedView, wording: Wording) -> tuple[str, str]:
    said, camera = wording.fit, view.image_camera
    percent = wording.figures.number(100.0 * view.silhouette_overlap, ".1f")
    told = (
        said.outcomes[view.outcome],
        said.overlap_in_view.format(percent=percent),
        said.pixels.format(width=camera.width, height=camera.height),
        lens(camera, view.focal_length_source, wording),
    )
    return said.views[view.view], ", ".join(told)


def _agreement(share: float, wording: Wording) -> str:
    percent = 100.0 * share
    shown = wording.figures.number(percent, ".0f" if percent >= 1.0 else ".1g")
    return wording.fit.agreement_of.format(percent=shown)

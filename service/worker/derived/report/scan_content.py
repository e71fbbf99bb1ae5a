"""What the report of a scan says, in words: that of a fit, with a paragraph for every view."""

from typing import Final

from api_schemas.scans import ScannedView, ScanResult
from service.worker.derived.report.content import (
    CUES,
    ReportContent,
    Section,
    assumed,
    chief_rows,
    further_groups,
    lens,
    warned,
    words,
)

TITLE: Final = "Body and measurements from several pictures"


def scan_content(result: ScanResult) -> ReportContent:
    """Put a result into words."""
    views, remarks = result.views, [*result.warnings]
    assumptions = [*result.assumptions]
    for view in views:
        remarks += view.warnings
        assumptions += view.assumptions
    return ReportContent(
        title=TITLE,
        subtitle=f"{result.gender.capitalize()}, {result.height_m:.3f} m, from {len(views)} "
        f"pictures by {CUES[result.cues]}",
        measurements=chief_rows(result.measurements),
        further=further_groups(result.measurements),
        sections=(
            Section(heading="The pictures", facts=tuple(map(_view, views))),
            Section(
                heading="The scan",
                facts=(
                    ("Outcome", f"{words(result.verdict)}. {result.outcome_explanation}"),
                    ("Agreement", _agreement(result.agreement)),
                ),
            ),
            assumed(dict.fromkeys(assumptions)),
            warned(dict.fromkeys(remarks)),
        ),
    )


def _view(view: ScannedView) -> tuple[str, str]:
    camera = view.image_camera
    overlap = f"{words(view.outcome)}, overlap {100.0 * view.silhouette_overlap:.1f} %"
    size = f"{camera.width} × {camera.height} pixels"
    return view.view.capitalize(), f"{overlap}, {size}, {lens(camera, view.focal_length_source)}"


def _agreement(share: float) -> str:
    percent = 100.0 * share
    shown = f"{percent:.0f}" if percent >= 1.0 else f"{percent:.1g}"
    return f"Pictures of one person differ as much as these in {shown} % of cases."

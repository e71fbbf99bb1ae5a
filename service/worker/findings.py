"""Findings of the checks of a picture, translated to the wire."""

from collections.abc import Sequence
from typing import cast

from api_schemas import checks as wire
from fitter.capture.finding import Box, Finding
from fitter.vocabulary.points import PointName


def finding_results(findings: Sequence[Finding]) -> tuple[wire.Finding, ...]:
    """Translate what was found; boxes to a hundredth of a pixel."""
    return tuple(
        wire.Finding(
            code=found.code.value,
            severity=found.severity,
            reason=found.reason,
            remedy=found.remedy,
            points=tuple(cast("PointName", name) for name in found.points),
            box=rounded_box(found.box),
        )
        for found in findings
    )


def rounded_box(box: Box | None) -> Box | None:
    """A box to a hundredth of a pixel."""
    if box is None:
        return None
    left, top, right, bottom = (round(each, 2) for each in box)
    return left, top, right, bottom

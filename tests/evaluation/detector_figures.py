"""What each thing that the detector tells is worth, on the suite and on foreign pictures."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from enum import StrEnum

import numpy as np

from fitter.fits.pipeline import fit
from fitter.request import Cues, FitRequest, SegmentationKind
from tests.evaluation.foreign import (
    TRUE_NAMES,
    foreign_joint_mm,
    foreign_overlaps,
    foreign_request,
    read_foreign,
)
from tests.evaluation.scene import Case
from tests.evaluation.suite import Fitted, fit_request, read_case, score, true_body_of

DEVIATIONS_95 = 1.96

UNITS: Mapping[str, str] = {
    "chest_girth": "chest cm",
    "waist_girth_smallest": "waist cm",
    "hip_girth": "hip cm",
    "weight": "weight kg",
}


class Hints(StrEnum):
    """What of the detector a fit uses.

    ``ALL`` is the default: mask and slants; ``PROPOSED`` takes its points, too, in place of clicks.
    """

    NONE = "none"
    MASK = "mask"
    SLANTS = "slants"
    ALL = "all"
    PROPOSED = "proposed"


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class DetectorFigures:
    """Figures of one fit; errors are measured minus true."""

    picture: str
    hints: Hints
    cues: Cues
    errors: Mapping[str, float]
    standard_errors: Mapping[str, float]
    joint_mm: float
    overlap: float
    mask_overlap: float


def suite_figures(case: Case) -> list[DetectorFigures]:
    """SE and SES of a case of the suite, with each kind of hints."""
    files, truth = read_case(case), true_body_of(case)
    figures: list[DetectorFigures] = []
    for hints in Hints:
        for cues in Cues:
            result = fit(hinted(fit_request(files, cues), hints))
            scored = score(
                Fitted(case=case, cues=cues, files=files, result=result, truth=truth, seconds=0.0)
            )
            figures.append(
                DetectorFigures(
                    picture=case.name,
                    hints=hints,
                    cues=cues,
                    errors={name: scored.errors[name] for name in UNITS},
                    standard_errors=scored.standard_errors,
                    joint_mm=scored.joint_mm,
                    overlap=scored.overlap,
                    mask_overlap=scored.mask_overlap,
                )
            )
    return figures


def foreign_figures(name: str) -> list[DetectorFigures]:
    """SE and SES of a foreign picture, with each kind of hints."""
    picture = read_foreign(name)
    figures: list[DetectorFigures] = []
    for hints in Hints:
        for cues in Cues:
            result = fit(hinted(foreign_request(picture, cues), hints))
            found = {each.name: each for each in result.measurements}
            body, mask = foreign_overlaps(picture, result)
            figures.append(
                DetectorFigures(
                    picture=name,
                    hints=hints,
                    cues=cues,
                    errors={
                        each: found[each].value - picture.measurements[each] for each in TRUE_NAMES
                    },
                    standard_errors={
                        each: found[each].standard_error or 0.0 for each in TRUE_NAMES
                    },
                    joint_mm=foreign_joint_mm(picture, result),
                    overlap=body,
                    mask_overlap=mask,
                )
            )
    return figures


def hinted(request: FitRequest, hints: Hints) -> FitRequest:
    """The request with so much of the detector."""
    seeded = hints not in (Hints.NONE, Hints.SLANTS)
    request = replace(
        request,
        segmentation=SegmentationKind.SEEDED_GRABCUT if seeded else SegmentationKind.GRABCUT,
        slant_hints=hints not in (Hints.NONE, Hints.MASK),
    )
    if hints is Hints.PROPOSED:
        return replace(request, clicks={}, complete_clicks=True)
    return request


def detector_lines(figures: Sequence[DetectorFigures]) -> list[str]:
    """Mean absolute errors, in brackets their mean; coverage; joints; masks, mean and worst."""
    heading = f"{'hints':10s}{'cues':5s}" + "".join(f"{unit:>16s}" for unit in UNITS.values())
    lines = [
        f"{heading}{'95 % hold':>11s}{'joints mm':>11s}{'overlap':>9s}{'mask':>7s}{'worst':>7s}"
    ]
    for hints in Hints:
        for cues in Cues:
            these = [each for each in figures if each.hints is hints and each.cues is cues]
            if these:
                lines.append(_line(hints, cues, these))
    return lines


def _line(hints: Hints, cues: Cues, these: Sequence[DetectorFigures]) -> str:
    line = f"{hints.value:10s}{cues.value:5s}"
    within: list[bool] = []
    for name in UNITS:
        errors = np.array([each.errors[name] for each in these])
        certain = np.array([each.standard_errors[name] for each in these])
        line += f"{f'{np.abs(errors).mean():.2f} ({errors.mean():+.2f})':>16s}"
        within += list(np.abs(errors) <= DEVIATIONS_95 * certain)
    masks = [each.mask_overlap for each in these]
    return (
        f"{line}{100.0 * np.mean(within):10.0f}%{np.mean([each.joint_mm for each in these]):11.1f}"
        f"{np.mean([each.overlap for each in these]):9.3f}{np.mean(masks):7.3f}{min(masks):7.3f}"
    )

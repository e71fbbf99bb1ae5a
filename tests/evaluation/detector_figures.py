"""What each thing that the detector tells is worth, on the suite and on foreign pictures."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from enum import StrEnum

import numpy as np

from fitter.request import FitRequest
from fitter.vocabulary.choices import Cues, SegmentationKind
from tests.evaluation.runs import picture_of
from tests.evaluation.scoring import Scored, fit_picture, score
from tests.evaluation.true_picture import Told
from tests.one_picture import changed

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
class HintedFit:
    """A fit with so much of the detector."""

    hints: Hints
    scored: Scored


def hinted_fits(name: str) -> list[HintedFit]:
    """SE and SES of a picture, with each kind of hints."""
    picture = picture_of(name)
    return [
        HintedFit(hints=hints, scored=score(fit_picture(asked, cues, Told())))
        for hints in Hints
        for asked in [replace(picture, request=hinted(picture.request, hints))]
        for cues in Cues
    ]


def hinted(request: FitRequest, hints: Hints) -> FitRequest:
    """The request with so much of the detector."""
    seeded = hints not in (Hints.NONE, Hints.SLANTS)
    request = changed(
        request,
        segmentation=SegmentationKind.SEEDED_GRABCUT if seeded else SegmentationKind.GRABCUT,
        slant_hints=hints not in (Hints.NONE, Hints.MASK),
    )
    if hints is Hints.PROPOSED:
        return changed(request, clicks={}, complete_clicks=True)
    return request


def detector_lines(fits: Sequence[HintedFit]) -> list[str]:
    """Mean absolute errors, in brackets their mean; coverage; joints; masks, mean and worst."""
    heading = f"{'hints':10s}{'cues':5s}" + "".join(f"{unit:>16s}" for unit in UNITS.values())
    lines = [
        f"{heading}{'95 % hold':>11s}{'joints mm':>11s}{'overlap':>9s}{'mask':>7s}{'worst':>7s}"
    ]
    for hints in Hints:
        for cues in Cues:
            these = [
                each.scored for each in fits if each.hints is hints and each.scored.cues is cues
            ]
            if these:
                lines.append(_line(hints, cues, these))
    return lines


def _line(hints: Hints, cues: Cues, these: Sequence[Scored]) -> str:
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

from typing import Any

import numpy as np

from fitter.request import Cues
from tests.evaluation.cases import DEMO
from tests.evaluation.scene import Half
from tests.evaluation.suite import Scored, resampled
from tests.evaluation.table import MEASUREMENTS, case_lines, summary_lines

NOTHING: Any = None


def _scored(cues: Cues, error: float) -> Scored:
    return Scored(
        case=DEMO,
        half=Half.TUNING,
        cues=cues,
        outcome="converged",
        errors={key: error for _, key, _ in MEASUREMENTS},
        vertex_mm=10.0,
        joint_mm=20.0,
        overlap=0.95,
        mask_overlap=0.97,
        light_degrees=None if cues is Cues.SE else 12.0,
        seconds=1.0,
        result=NOTHING,
        truth=NOTHING,
    )


def test_the_summary_averages_absolute_errors_of_each_kind_of_fit():
    scored = [_scored(Cues.SE, error) for error in (-3.0, 1.0, 5.0)]
    scored += [_scored(Cues.SES, error) for error in (-1.0, 1.0, 4.0)]
    chest = next(line for line in summary_lines(scored) if line.startswith("chest"))
    mean_se, median_se, _, mean_ses, median_ses, _ = map(float, chest.split()[2:])
    assert (mean_se, median_se, mean_ses, median_ses) == (3.0, 3.0, 2.0, 1.0)


def test_the_lines_of_cases_keep_the_errors_signs():
    _, line = case_lines([_scored(Cues.SES, -2.5)])
    assert line.count("-2.5") == len(MEASUREMENTS)
    assert "12.0" in line


def test_one_kind_of_fit_alone_can_be_summed_up():
    assert all("nan" not in line for line in summary_lines([_scored(Cues.SE, 1.0)]))


def test_a_mask_at_half_size_covers_the_same_share_at_full_size():
    half = np.zeros((10, 8), dtype=bool)
    half[3:7, 2:6] = True
    full = resampled(half, 0.5, (20, 16))
    assert full.shape == (20, 16)
    assert full.mean() == half.mean()
    assert full[6:14, 4:12].all()

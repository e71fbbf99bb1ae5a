import numpy as np

from fitter.vocabulary.choices import Cues
from tests.accuracy.body_tables import bmi_class, bmi_lines
from tests.accuracy.cases import CASES, DEMO
from tests.accuracy.scene import Case, Half
from tests.accuracy.scoring import Scored, resampled
from tests.accuracy.table import MEASUREMENTS, case_lines, cue_lines, summary_lines, worst_lines


def scored_picture(
    cues: Cues,
    error: float,
    *,
    case: Case = DEMO,
    person: str | None = None,
    bmi: float = 22.0,
    wrong_limbs: tuple[str, ...] = (),
) -> Scored:
    """Every figure errs alike."""
    return Scored(
        name=case.name,
        person=person or case.person,
        series=case.series,
        half=Half.TUNING,
        cues=cues,
        outcome="converged",
        bmi=bmi,
        errors={key: error for _, key, _ in MEASUREMENTS},
        standard_errors={key: 2.0 for _, key, _ in MEASUREMENTS},
        vertex_mm=10.0,
        joint_mm=20.0,
        overlap=0.95,
        mask_overlap=0.97,
        light_degrees=None if cues is Cues.SE else 12.0,
        wrong_limbs=wrong_limbs,
        seconds=1.0,
    )


def test_the_summary_has_absolute_errors_and_their_bias_of_each_kind_of_fit():
    scored = [scored_picture(Cues.SE, error) for error in (-3.0, 1.0, 5.0)]
    scored += [scored_picture(Cues.SES, error) for error in (-1.0, 1.0, 4.0)]
    chest = next(line for line in summary_lines(scored) if line.startswith("chest"))
    mean_se, bias_se, median_se, _, width_se, *ses = map(float, chest.split()[2:])
    assert (mean_se, bias_se, median_se, width_se) == (3.0, 1.0, 3.0, 7.84)
    assert ses[:3] == [2.0, 1.33, 1.0]


def test_the_lines_of_cases_keep_the_errors_signs():
    _, line = case_lines([scored_picture(Cues.SES, -2.5)])
    assert line.count("-2.5") == len(MEASUREMENTS)
    assert "12.0" in line


def _line(scored: list[Scored], start: str) -> str:
    return next(line for line in summary_lines(scored) if line.startswith(start))


def test_intervals_hold_the_truth_within_their_standard_errors():
    scored = [scored_picture(Cues.SE, error) for error in (-1.0, 1.9, 3.0, 5.0)]
    assert "10/20  50%" in _line(scored, "truth in 68 %")
    assert "15/20  75%" in _line(scored, "truth in 95 %")
    assert "2/4  50%" in _line(scored, "  waist in 68 %")


def test_a_fit_fails_by_a_limb_that_faces_the_wrong_way():
    scored = [
        scored_picture(Cues.SES, 1.0),
        scored_picture(Cues.SES, 1.0, wrong_limbs=("left_forearm",)),
    ]
    assert "1/2  50%" in _line(scored, "failures")
    assert [each.failed for each in scored] == [False, True]
    assert case_lines(scored)[2].endswith("left_forearm")


def test_ses_is_compared_with_se_on_the_same_picture():
    other = next(case for case in CASES.values() if case is not DEMO)
    scored = [scored_picture(Cues.SE, 3.0), scored_picture(Cues.SES, -1.0)]
    scored += [scored_picture(Cues.SE, -2.0, case=other), scored_picture(Cues.SES, 6.0, case=other)]
    _, *lines = cue_lines(scored)
    assert len(lines) == len(MEASUREMENTS)
    assert all(line.split()[2:] == ["1/2", "50%", "+1.00", "±3.00", "worse"] for line in lines)
    assert "worse" not in "".join(cue_lines(scored[:2]))


def test_people_are_told_apart_by_body_mass_index():
    assert [bmi_class(bmi) for bmi in (17.9, 18.5, 24.9, 25.0, 34.0, 35.0, 48.0)] == [
        "< 18.5", "18.5-25", "18.5-25", "25-30", "30-35", ">= 35", ">= 35",
    ]  # fmt: skip


def test_errors_are_summed_up_by_class_of_body_mass_index():
    scored = [
        scored_picture(Cues.SES, 1.0),
        scored_picture(Cues.SES, -3.0),
        scored_picture(Cues.SES, 5.0, bmi=40.0),
    ]
    _, slim, heavy = bmi_lines(scored)
    assert slim.split()[:5] == ["18.5-25", "SES", "2", "2.00", "(-1.00)"]
    assert heavy.split()[:6] == [">=", "35", "SES", "1", "5.00", "(+5.00)"]


def test_one_kind_of_fit_alone_can_be_summed_up():
    assert all("nan" not in line for line in summary_lines([scored_picture(Cues.SE, 1.0)]))


def test_a_mask_at_half_size_covers_the_same_share_at_full_size():
    half = np.zeros((10, 8), dtype=bool)
    half[3:7, 2:6] = True
    full = resampled(half, 0.5, (20, 16))
    assert full.shape == (20, 16)
    assert full.mean() == half.mean()
    assert full[6:14, 4:12].all()


def test_the_worst_fits_by_ses_are_named_worst_first():
    scored = [scored_picture(Cues.SE, 9.0)]
    scored += [scored_picture(Cues.SES, error) for error in (1.0, -6.0, 3.0)]
    title, *lines = worst_lines(scored, count=2)
    assert title == "worst"
    assert ["-6.0" in lines[0], "+3.0" in lines[1], len(lines)] == [True, True, 2]

"""Sums, their standard errors over people, and shares of intervals, by hand."""

from dataclasses import replace

from fitter.vocabulary.choices import Cues, Gender
from tests.accuracy.cases import CASES, DEMO
from tests.accuracy.clothing_table import clothing_lines, underwear_lines
from tests.accuracy.dressed_scores import NOTHING_SAID, DressedScore
from tests.accuracy.real_outfits import Dressed, outfit_lines
from tests.accuracy.scans import Scanned, Views, scan_lines
from tests.accuracy.scene import Case, Half
from tests.accuracy.scoring import Scored
from tests.accuracy.seen_labels import CLASSES
from tests.accuracy.spoilt import AS_THEY_ARE, Asked, Measured, spoilt_lines
from tests.accuracy.table import (
    MEASUREMENTS,
    bmi_class,
    case_lines,
    cue_lines,
    error_line,
    spread,
    summary_lines,
)

KEYS = [key for _, key, _ in MEASUREMENTS]
SHIRT, CLOSE = "shirt hanging out, trousers", "close-fitting T-shirt, leggings"


def scored_picture(
    cues: Cues,
    error: float,
    *,
    case: Case = DEMO,
    person: str | None = None,
    wrong_limbs: tuple[str, ...] = (),
) -> Scored:
    """Every figure errs alike; standard errors are 2."""
    return Scored(
        name=case.name,
        person=person or case.person,
        series=case.series,
        half=Half.TUNING,
        cues=cues,
        outcome="converged",
        bmi=22.0,
        errors=dict.fromkeys(KEYS, error),
        standard_errors=dict.fromkeys(KEYS, 2.0),
        vertex_mm=10.0,
        joint_mm=20.0,
        overlap=0.95,
        mask_overlap=0.97,
        light_degrees=None if cues is Cues.SE else 12.0,
        wrong_limbs=wrong_limbs,
        seconds=1.0,
    )


def of_person(person: str, error: float) -> Scored:
    return scored_picture(Cues.SES, error, person=person)


def line_of(lines: list[str], start: str) -> str:
    (line,) = [line for line in lines if line.startswith(start)]
    return line


def test_an_error_has_its_standard_error_over_people_its_bias_its_width_and_who_holds():
    line = error_line("row", [of_person("a", 1.0), of_person("b", -5.0)], places=2)
    title, people, *cells = line.split()
    assert (title, people) == ("row", "2")
    assert cells[:4] == ["3.00", "±2.00", "(-2.00)", "7.8"]
    assert cells[-3:] == ["50", "±50", "%"]


def test_pictures_of_one_person_count_once_in_a_standard_error():
    # People have 4 and 2.
    assert spread(["a", "a", "b"], [4.0, 4.0, 2.0], 2) == " ±1.00"
    assert spread(["a", "a"], [4.0, 2.0], 2) == ""


def test_the_summary_has_absolute_errors_and_their_bias_of_each_kind_of_fit():
    scored = [scored_picture(Cues.SE, error) for error in (-3.0, 1.0, 5.0)]
    scored += [scored_picture(Cues.SES, error) for error in (-1.0, 1.0, 4.0)]
    chest = line_of(summary_lines(scored), "chest")
    mean_se, bias_se, median_se, _, width_se, *ses = map(float, chest.split()[2:])
    assert (mean_se, bias_se, median_se, width_se) == (3.0, 1.0, 3.0, 7.84)
    assert ses[:3] == [2.0, 1.33, 1.0]


def test_intervals_hold_the_truth_within_their_standard_errors():
    scored = [scored_picture(Cues.SE, error) for error in (-1.0, 1.9, 3.0, 5.0)]
    lines = summary_lines(scored)
    assert "10/20  50%" in line_of(lines, "truth in 68 %")
    assert "15/20  75%" in line_of(lines, "truth in 95 %")
    assert "2/4  50%" in line_of(lines, "  waist in 68 %")


def test_a_fit_fails_by_a_limb_that_faces_the_wrong_way():
    scored = [of_person("a", 1.0), scored_picture(Cues.SES, 1.0, wrong_limbs=("left_forearm",))]
    assert "1/2  50%" in line_of(summary_lines(scored), "failures")
    assert case_lines(scored)[2].endswith("left_forearm")


def test_ses_is_compared_with_se_on_the_same_picture():
    other = next(case for case in CASES.values() if case is not DEMO)
    scored = [scored_picture(Cues.SE, 3.0), scored_picture(Cues.SES, -1.0)]
    scored += [scored_picture(Cues.SE, -2.0, case=other), scored_picture(Cues.SES, 6.0, case=other)]
    _, *lines = cue_lines(scored)
    assert all(line.split()[2:] == ["1/2", "50%", "+1.00", "±3.00", "worse"] for line in lines)


def test_classes_of_body_mass_begin_at_their_lower_bounds():
    assert [bmi_class(bmi) for bmi in (18.5, 24.9, 35.0)] == ["18.5-25", "18.5-25", ">= 35"]


def test_views_are_rows_and_a_weight_that_was_given_has_no_interval():
    def scan(row: str, person: str, error: float, *known: str) -> Scanned:
        return Scanned(
            row=row,
            person=person,
            errors=dict.fromkeys(KEYS, error),
            standard_errors=dict.fromkeys(known, 1.0),
            joint_mm=20.0 * abs(error),
            overlap=0.95,
        )

    given = [key for key in KEYS if key != "weight"]
    lines = scan_lines(
        [
            scan(Views.BOTH, "a", 1.0, *KEYS),
            scan(Views.BOTH, "b", -2.0, *KEYS),
            scan(f"{Views.BOTH}, weight", "a", 1.0, *given),
        ]
    )
    both = lines[1].removeprefix(Views.BOTH).split()
    assert both[:5] == ["2", "1.50", "±0.50", "(-0.50)", "3.9"]
    assert both[-5:] == ["50", "±50", "%", "30.0", "0.950"]
    assert lines[2].split().count("-") == 1
    assert [line.split()[0] for line in lines[-2:]] == ["b", "a"]


def test_of_spoilt_pictures_that_are_withheld_nothing_counts_but_what_was_found():
    asked = Asked(picture="a", other="b", kind=AS_THEY_ARE, proposed=False, seed=0)

    def measured(person: str, error: float, code: str, *, withheld: bool = False) -> Measured:
        return Measured(
            asked=asked,
            person=person,
            errors=dict.fromkeys(KEYS, error),
            standard_errors=dict.fromkeys(KEYS, 1.0),
            findings=(code,) if code else (),
            withheld=withheld,
        )

    (line,) = spoilt_lines(
        [
            measured("a", 1.0, ""),
            measured("b", -3.0, "cut-off"),
            measured("c", 30.0, "cut-off", withheld=True),
        ]
    )
    assert "2.0 ±1.0 (-1.0)" in line
    assert "50 ±50 %" in line
    assert line.endswith("1  cut-off 2")


def dressed(
    person: str, error: float, *, outfit: str = SHIRT, skin: float | None = None
) -> DressedScore:
    overlaps = {} if skin is None else dict.fromkeys(CLASSES, skin)
    return DressedScore(
        said=NOTHING_SAID, outfit=outfit, scored=of_person(person, error), overlaps=overlaps
    )


def test_dressed_people_are_summed_up_together_by_garment_and_beside_themselves_in_underwear():
    scores = [dressed("a", 1.0, skin=0.9), dressed("b", -5.0, outfit=CLOSE, skin=0.7)]
    lines = clothing_lines(scores)
    assert line_of(lines, f"{NOTHING_SAID} ").split()[1:4] == ["2", "3.0", "±2.0"]
    assert line_of(lines, f"{NOTHING_SAID} ").split()[-3:] == ["50", "±50", "%"]
    assert "1.0 (+1.0)" in line_of(lines, SHIRT)
    assert line_of(lines, "skin").split()[1:] == ["2", "0.80", "±0.10", "least", "0.70"]
    undressed = [of_person("a", 1.0), of_person("b", 2.0)]
    assert "1.5 ±0.5" in line_of(underwear_lines(scores, undressed), "the same people in underwear")
    assert "2.0 (+2.0)" in line_of(underwear_lines(scores, undressed), "they in underwear")


def test_a_jacket_that_moves_the_body_is_told():
    inner = Dressed(
        person="a",
        gender=Gender.MALE,
        outfit="Inner",
        values={key: 80.0 for _, key, _ in MEASUREMENTS},
        errors={key: 3.0 for _, key, _ in MEASUREMENTS},
        findings=(),
        overlaps=dict.fromkeys(CLASSES, 0.5),
    )
    other = replace(inner, person="b", values={key: 90.0 for _, key, _ in MEASUREMENTS})
    outer = [
        replace(each, outfit="Outer", values={k: v + added for k, v in each.values.items()})
        for each, added in ((inner, 4.0), (other, 12.0))
    ]
    lines = outfit_lines([inner, outer[0], other, outer[1]])
    (waist,) = (line for line in lines if line.startswith("waist cm"))
    assert "mean  +8.0, absolute  8.0, worst  12" in waist
    assert "within 1.96 stated 50%" in waist
    assert "correlation within sex 1.00; stated 3.0, 3.0" in waist
    assert any("skin 0.50" in line for line in lines)

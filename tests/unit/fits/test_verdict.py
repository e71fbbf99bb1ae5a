"""Findings of a fit: contradictions, obstructions, squeezed pictures, and what harms."""

import re
from dataclasses import replace

import numpy as np
import pytest

from fitter.evidence.silhouette_evidence import silhouette_evidence
from fitter.fits.equipment import prepared_model
from fitter.fits.error_widening import HARM, widened_covariance
from fitter.fits.plausibility import Plausibility
from fitter.fits.verdict import (
    BROAD_HEAD,
    FAR_EARS,
    LEAST_OFF_M2,
    NARROW_DRESSED,
    NARROW_HEAD,
    NEAR_EARS,
    contradiction,
    nearest_parts,
    obstruction,
    squeezed,
)
from fitter.measurement.anthropometry import measure
from fitter.measurement.joint_measurements import joint_measurements
from fitter.vocabulary.choices import Gender
from fitter.vocabulary.outcomes import Verdict
from fitter.vocabulary.remarks import Code, Remark, Severity, remark
from tests.unit.capture.made_up import STATURE_PX, capture, person
from tests.unit.evidence.drawn_pictures import HEIGHT, PIXELS_PER_METRE, WIDTH, boxes

PERSON = Plausibility(
    overlap=0.94,
    boundary=0.93,
    beyond=0.0,
    outgrown_m=0.0,
    click_deviations=0.6,
    strain=6.0,
    clothed=False,
    detected=None,
)
LANDSCAPE = replace(PERSON, overlap=0.8, boundary=0.09)
LANDSCAPE_AS_CLOTHES = replace(PERSON, overlap=0.89, boundary=0.12, clothed=True)
DOG = replace(PERSON, overlap=0.82, boundary=0.7, click_deviations=2.2, strain=34.0)
TWO_IN_ONE_MASK = replace(PERSON, overlap=0.5, beyond=0.84)
PERMUTED = replace(PERSON, overlap=0.83, boundary=0.4, click_deviations=4.6)


@pytest.mark.parametrize(
    "changes",
    [
        {},
        {"overlap": 0.87, "boundary": 0.17},
        {"overlap": 0.68, "boundary": 0.56},
        {"overlap": 0.81, "boundary": 0.35},
        {"click_deviations": 3.3, "strain": 11.0, "overlap": 0.83},
        {"strain": 26.0, "overlap": 0.88, "boundary": 0.67},
    ],
    ids=["usual", "in the dark", "behind a table", "in grain", "careless points", "athlete"],
)
@pytest.mark.parametrize("detected", [None, True])
def test_hard_pictures_of_people_contradict_nobody(changes, detected):
    assert contradiction(replace(PERSON, detected=detected, **changes)).verdict is Verdict.PLAUSIBLE


def test_that_the_detector_finds_nobody_decides_nothing_alone():
    dark = replace(PERSON, overlap=0.92, boundary=0.17, detected=False)
    table = replace(PERSON, overlap=0.75, boundary=0.57, detected=False)
    verdicts = [contradiction(each).verdict for each in (dark, table)]
    assert verdicts == [Verdict.PLAUSIBLE, Verdict.PLAUSIBLE]


@pytest.mark.parametrize("detected", [None, False])
def test_where_neither_silhouette_nor_outline_are_a_person_s_there_is_none(detected):
    found = contradiction(replace(LANDSCAPE, detected=detected))
    assert found.verdict is Verdict.NO_PERSON
    (finding,) = found.findings
    assert "9%" in finding.reason
    assert "80%" in finding.reason


def test_a_person_whom_the_detector_sees_is_never_nobody():
    for each in (LANDSCAPE, LANDSCAPE_AS_CLOTHES, DOG, TWO_IN_ONE_MASK, PERMUTED):
        verdict = contradiction(replace(each, detected=True)).verdict
        assert verdict is not Verdict.NO_PERSON
    assert contradiction(replace(LANDSCAPE_AS_CLOTHES, detected=True)).verdict is Verdict.PLAUSIBLE
    assert contradiction(replace(LANDSCAPE, detected=True)).verdict is Verdict.PLAUSIBLE


@pytest.mark.parametrize(
    ("found", "said"),
    [
        (DOG, "that people hardly have"),
        (TWO_IN_ONE_MASK, "84% of its size"),
        (PERMUTED, "4.6 standard deviations"),
        (replace(PERSON, overlap=0.13), "overlap by 13%"),
    ],
    ids=["dog", "two in one mask", "permuted", "another mask"],
)
def test_a_body_that_is_contradicted_is_implausible_and_told_by_what(found, said):
    judged = contradiction(found)
    assert judged.verdict is Verdict.IMPLAUSIBLE
    (finding,) = judged.findings
    assert (finding.code, finding.severity) == (Code.CONTRADICTED, Severity.BLOCKS)
    assert said in finding.reason
    assert finding.remedy


def test_the_detector_tells_noise_of_good_outline_from_a_person():
    noise = replace(PERSON, overlap=0.84, boundary=0.4)
    verdicts = [contradiction(replace(noise, detected=each)).verdict for each in (None, False)]
    assert verdicts == [Verdict.PLAUSIBLE, Verdict.NO_PERSON]


def test_clothes_that_fit_any_outline_are_no_person_s_where_the_detector_finds_nobody():
    circle = replace(PERSON, overlap=0.9, boundary=0.26, clothed=True)
    verdicts = [contradiction(replace(circle, detected=each)).verdict for each in (True, False)]
    assert verdicts == [Verdict.PLAUSIBLE, Verdict.NO_PERSON]


def test_an_unusual_person_is_no_covered_one_and_is_not_measured():
    found = contradiction(replace(PERSON, outgrown_m=0.085))
    assert found.verdict is Verdict.IMPLAUSIBLE
    (finding,) = found.findings
    assert finding.severity is Severity.BLOCKS
    assert "8 cm outside" in finding.reason
    assert "tape" in finding.remedy


@pytest.mark.parametrize("reached_m", [0.0, 0.015, 0.035])
def test_what_the_model_hardly_misses_contradicts_nobody(reached_m):
    assert contradiction(replace(PERSON, outgrown_m=reached_m)).verdict is Verdict.PLAUSIBLE


LEFT, RIGHT = 130, 190
RENDERING, _ = boxes((LEFT, RIGHT))
BODY = RENDERING.silhouette
PART_NAMES = ("head", "chest", "pelvis", "left_thigh", "left_shin", "left_foot", "left_forearm")
BORDERS = (40, 60, 100, 120, 160, 180, 201)
"""Rows at which the body's parts begin, from head to foot."""

rows, columns = np.indices((HEIGHT, WIDTH))


def block(top: int, bottom: int, left: int, right: int) -> np.ndarray:
    return (rows >= top) & (rows < bottom) & (columns >= left) & (columns < right)


def part_of_triangle(*, arms: bool = False) -> np.ndarray:
    """By the rows of the triangles; with ``arms`` the whole box is one."""
    if arms:
        return np.full(len(RENDERING.triangles), PART_NAMES.index("left_forearm"))
    middles = RENDERING.projected[RENDERING.triangles][..., 1].mean(axis=1)
    return np.clip(np.searchsorted(BORDERS, middles, side="right") - 1, 0, len(BORDERS) - 2)


def told(mask: np.ndarray, doubted: np.ndarray, *, arms: bool = False) -> Remark | None:
    found = obstruction(
        silhouette_evidence(mask).doubting(doubted),
        RENDERING,
        nearest_parts(RENDERING, part_of_triangle(arms=arms), PART_NAMES),
    )
    assert len(found) <= 1
    return found[0] if found else None


def shares(finding: Remark | None) -> dict[str, int]:
    assert finding is not None
    return {part: int(share) for share, part in re.findall(r"(\d+) % at the (\w+)", finding.reason)}


def test_of_an_outline_that_is_not_doubted_nothing_is_told():
    thing = block(80, 140, 100, 220)
    assert told(BODY | thing, np.zeros_like(BODY)) is None


def test_a_thing_before_the_hips_is_told_with_the_parts_that_it_hides():
    thing = block(90, 125, 100, 220)
    finding = told(BODY | thing, block(90, 125, 90, 230))
    assert finding is not None
    assert (finding.code, finding.severity) == (Code.COVERED, Severity.HARMS)
    assert "before the person or beside them" in finding.remedy
    found = shares(finding)
    assert found.keys() == {"trunk", "hips", "thighs"}
    assert found["hips"] == 100
    assert found["trunk"] == pytest.approx(25, abs=2)
    assert found["thighs"] == pytest.approx(12, abs=2)


def test_what_sticks_out_less_than_the_bound_is_not_told():
    least_px = LEAST_OFF_M2 * PIXELS_PER_METRE**2
    broad = 20
    tall = int(least_px / broad)
    doubted = block(60, 180, 90, 230)
    for rows_more, is_told in ((-4, False), (4, True)):
        # The first 4 columns are within what a body may be off.
        thing = block(80, 80 + tall + rows_more, RIGHT, RIGHT + 4 + broad)
        assert (told(BODY | thing, doubted) is not None) is is_told


def test_doubt_that_spread_from_a_shadow_at_the_feet_is_not_told():
    shadow = block(185, 200, 60, 260)
    assert told(BODY | shadow, block(60, 200, 60, 260)) is None


def test_what_hides_a_leg_is_told_and_an_arm_where_none_is_seen_is_not():
    gap = block(120, 160, 120, 170)
    doubted = block(110, 170, 110, 200)
    assert "thighs" in shares(told(BODY & ~gap, doubted))
    assert told(BODY & ~gap, doubted, arms=True) is None


def test_a_part_of_whose_outline_hardly_anything_is_doubted_is_not_named():
    thing = block(118, 160, 100, 220)
    assert shares(told(BODY | thing, block(119, 160, 90, 230))).keys() == {"thighs", "hips"}
    assert shares(told(BODY | thing, block(120, 160, 90, 230))).keys() == {"thighs"}


BROAD, NARROW = 1.05 * FAR_EARS * STATURE_PX, 0.95 * NEAR_EARS * STATURE_PX


def squeeze(
    breadth: float | None, ears_px: float, *, shoulder_px: float = 124.0, dressed: bool = False
) -> str | None:
    half = 0.5 * ears_px
    shown = person(
        left_ear=(200.0 + half, 76.0),
        right_ear=(200.0 - half, 76.0),
        left_shoulder=(200.0 + 0.5 * shoulder_px, 140.0),
        right_shoulder=(200.0 - 0.5 * shoulder_px, 140.0),
    )
    found = squeezed(capture(shown), breadth, dressed=dressed)
    assert all((each.code, each.severity) == (Code.SQUEEZED, Severity.HARMS) for each in found)
    return found[0].reason if found else None


def test_head_and_ears_that_are_both_too_broad_or_both_too_narrow_are_told():
    assert "squeezed" in (squeeze(BROAD_HEAD + 0.01, BROAD) or "")
    for dressed, narrowest in ((False, NARROW_HEAD), (True, NARROW_DRESSED * STATURE_PX / NARROW)):
        assert "stretched" in (squeeze(narrowest - 0.01, NARROW, dressed=dressed) or "")
        assert squeeze(narrowest + 0.01, NARROW, dressed=dressed) is None


@pytest.mark.parametrize(
    ("breadth", "ears_px"),
    [
        (1.0, BROAD),
        # Long hair, and a mask that misses a part of the head.
        (BROAD_HEAD + 0.1, NARROW),
        (NARROW_HEAD - 0.1, BROAD),
        (1.0, 0.8 * NARROW),  # The head is turned.
        (None, BROAD),
        (0.0, NARROW),
    ],
)
def test_one_of_them_alone_is_not(breadth, ears_px):
    assert squeeze(breadth, ears_px) is None
    assert squeeze(breadth, ears_px, dressed=True) is None


@pytest.mark.parametrize("shoulder_px", [4.0, -124.0], ids=["side", "back"])
def test_of_who_does_not_face_the_camera_nothing_is_said(shoulder_px):
    assert squeeze(BROAD_HEAD + 0.1, BROAD, shoulder_px=shoulder_px) is None


MEASURING = prepared_model(Gender.FEMALE).measuring
SIZE = len(MEASURING.canonical.derivative)
SHAPE = np.zeros(SIZE)
COVARIANCE = np.diag([0.0, *np.linspace(0.1, 0.3, SIZE - 1)])


def found(code: Code, severity: Severity = Severity.HARMS) -> Remark:
    return remark(code, "It is.", severity=severity)


def covariance(*pictures: list[Remark], given: tuple[str, ...] = ()) -> np.ndarray:
    return widened_covariance(COVARIANCE, MEASURING, SHAPE, pictures, given)


def grown(*pictures: list[Remark], given: tuple[str, ...] = ()) -> dict[str, float]:
    """Standard errors as shares of those without findings."""
    before, after = (
        joint_measurements(MEASURING, SHAPE, shape_covariance=each, given=given)
        for each in (COVARIANCE, covariance(*pictures, given=given))
    )
    free = before.standard_errors > 0.0
    shares = after.standard_errors[free] / before.standard_errors[free]
    return dict(zip(np.array(before.names)[free].tolist(), shares.tolist(), strict=True))


def test_four_measurements_are_wider_by_the_table_and_others_along_with_them():
    dark = HARM[Code.TOO_DARK]
    said = grown([found(Code.TOO_DARK)])
    assert said["chest_girth"] == pytest.approx(dark.chest, rel=1e-6)
    assert said["waist_girth_smallest"] == pytest.approx(dark.waist, rel=1e-6)
    assert said["hip_girth"] == pytest.approx(dark.hip, rel=1e-6)
    assert said["weight"] == pytest.approx(dark.weight, rel=1e-6)
    assert 1.3 < said["abdomen_girth"] < dark.waist
    assert 1.0 <= said["arm_length"] < 1.1


def test_a_body_measured_later_has_the_errors_of_the_fit():
    wider = covariance([found(Code.TOO_DARK)])
    at_once = measure(MEASURING, SHAPE, shape_covariance=wider)
    later = joint_measurements(MEASURING, SHAPE, shape_covariance=wider)
    errors = np.array([each.standard_error for each in at_once], dtype=float)
    np.testing.assert_allclose(errors, later.standard_errors, rtol=1e-3)


def test_of_several_findings_the_worst_counts_and_of_several_pictures_the_least():
    both = [found(Code.TOO_DARK), found(Code.NOT_STANDING)]
    worst, least = HARM[Code.NOT_STANDING].waist, HARM[Code.TOO_DARK].waist
    assert grown(both)["waist_girth_smallest"] == pytest.approx(worst, rel=1e-6)
    one = grown(both, [found(Code.TOO_DARK)])
    assert one["waist_girth_smallest"] == pytest.approx(least, rel=1e-6)
    assert grown(both, [])["waist_girth_smallest"] == 1.0


def test_what_was_given_and_the_height_stay():
    said = grown([found(Code.TOO_DARK)], given=("weight", "waist_girth_navel"))
    assert said["weight"] == pytest.approx(1.0, rel=1e-6)
    assert said["waist_girth_navel"] == pytest.approx(1.0, rel=1e-6)
    wider = covariance([found(Code.TOO_DARK)])
    np.testing.assert_allclose(wider[0], 0.0, atol=1e-9)
    assert (np.linalg.eigvalsh(wider) > -1e-9).all()


def test_what_no_finding_harms_stays():
    for nothing in ([], [found(Code.CAMERA_ROLLED)], [found(Code.BLURRED, Severity.BLOCKS)]):
        assert covariance(nothing) is COVARIANCE

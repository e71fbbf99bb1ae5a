"""What findings do to standard errors."""

import pytest

from fitter.capture.finding import Code, Finding
from fitter.fits.harm import HARM, widened
from fitter.measurement.definition_file import load_definitions
from fitter.measurement.quantity import Measurement
from fitter.vocabulary.outcomes import Severity

DEFINED = load_definitions()


def found(code: Code, severity: Severity = Severity.HARMS) -> Finding:
    return Finding(code=code, severity=severity, reason="It is.", remedy="Do.")


def errors(*pictures: list[Finding], given: tuple[str, ...] = ()) -> dict[str, float | None]:
    measurements = [
        Measurement(
            name=each.about.name,
            value=90.0,
            unit="cm",
            standard_error=2.0,
            definition="",
            source="",
        )
        for each in DEFINED
    ]
    return {each.name: each.standard_error for each in widened(measurements, pictures, given)}


def test_exactly_what_is_harmed_is_wider():
    dark = HARM[Code.TOO_DARK]
    said = errors([found(Code.TOO_DARK)])
    assert said["chest_girth"] == pytest.approx(2.0 * dark.chest)
    assert said["waist_girth_smallest"] == pytest.approx(2.0 * dark.waist)
    assert said["calf_girth"] == pytest.approx(2.0 * dark.hip)
    assert said["weight"] == pytest.approx(2.0 * dark.weight)
    assert said["arm_length"] == 2.0


def test_of_several_findings_the_worst_counts_and_of_several_pictures_the_least():
    both = [found(Code.TOO_DARK), found(Code.NOT_STANDING)]
    worst = 2.0 * HARM[Code.NOT_STANDING].waist
    assert errors(both)["waist_girth_smallest"] == pytest.approx(worst)
    least = 2.0 * HARM[Code.TOO_DARK].waist
    one = errors(both, [found(Code.TOO_DARK)])
    assert one["waist_girth_smallest"] == pytest.approx(least)
    assert errors(both, [])["waist_girth_smallest"] == 2.0


def test_what_was_given_and_what_no_finding_harms_stays():
    assert errors([found(Code.TOO_DARK)], given=("weight",))["weight"] == 2.0
    for nothing in ([], [found(Code.CAMERA_ROLLED)], [found(Code.BLURRED, Severity.BLOCKS)]):
        assert set(errors(nothing).values()) == {2.0}

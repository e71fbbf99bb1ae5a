"""What findings do to standard errors."""

import numpy as np
import pytest

from fitter.fits.equipment import prepared_model
from fitter.fits.error_widening import HARM, widened_covariance
from fitter.measurement.anthropometry import measure
from fitter.measurement.joint_measurements import joint_measurements
from fitter.vocabulary.choices import Gender
from fitter.vocabulary.remarks import Code, Remark, Severity, remark

BODY = prepared_model(Gender.FEMALE).measuring
SIZE = len(BODY.canonical.derivative)
SHAPE = np.zeros(SIZE)
COVARIANCE = np.diag([0.0, *np.linspace(0.1, 0.3, SIZE - 1)])


def found(code: Code, severity: Severity = Severity.HARMS) -> Remark:
    return remark(code, "It is.", severity=severity)


def covariance(*pictures: list[Remark], given: tuple[str, ...] = ()) -> np.ndarray:
    return widened_covariance(COVARIANCE, BODY, SHAPE, pictures, given)


def grown(*pictures: list[Remark], given: tuple[str, ...] = ()) -> dict[str, float]:
    """Standard errors as shares of those without findings."""
    before, after = (
        joint_measurements(BODY, SHAPE, shape_covariance=each, given=given)
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
    at_once = measure(BODY, SHAPE, shape_covariance=wider)
    later = joint_measurements(BODY, SHAPE, shape_covariance=wider)
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

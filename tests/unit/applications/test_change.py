from dataclasses import replace
from math import erfc, sqrt

import numpy as np
import pytest

from fitter.applications.change import SIGNIFICANCE, changed, changes, holm
from fitter.measurement.joint_measurements import JointMeasurements
from fitter.person.several_pictures import SHARED_ERROR

NAMES = ("waist", "hip", "weight", "stature")


def measured(values, errors, given=()):
    return JointMeasurements(
        names=NAMES[: len(values)],
        units=("cm", "cm", "kg", "cm")[: len(values)],
        values=np.array(values, dtype=float),
        covariance=np.diag(np.array(errors, dtype=float) ** 2),
        given=given,
    )


def test_one_measurement_has_the_error_and_the_probability_of_a_normal_difference():
    (waist,) = changes(measured([90.0], [2.0]), measured([86.0], [1.5]))
    assert waist.difference == -4.0
    expected = np.sqrt(4.0 + 2.25 - 2.0 * SHARED_ERROR * 3.0)
    assert waist.standard_error == pytest.approx(expected)
    assert waist.p_value == pytest.approx(erfc(4.0 / expected / sqrt(2.0)))
    assert waist.is_change
    assert waist.least == pytest.approx(1.959964 * expected)


def test_a_difference_that_is_one_among_many_has_to_be_larger():
    before = measured([90.0, 100.0, 80.0], [2.0, 2.0, 2.0])
    after = measured([86.0, 100.0, 80.0], [1.5, 2.0, 2.0])
    found = changes(before, after)
    assert [each.is_change for each in found] == [False] * 3
    assert found[0].p_value == pytest.approx(3 * erfc(4.0 / found[0].standard_error / sqrt(2.0)))
    assert found[0].least == pytest.approx(2.3940 * found[0].standard_error, rel=1e-4)


def test_values_given_exactly_differ_exactly_and_are_not_tested():
    before = measured([90.0, 100.0, 80.0, 180.0], [2.0, 2.0, 0.0, 0.0], ("weight", "stature"))
    after = replace(before, values=np.array([90.0, 100.0, 79.9, 180.0]))
    found = {each.name: each for each in changes(before, after)}
    assert found["weight"].is_change
    assert found["weight"].p_value is None
    assert found["weight"].standard_error == 0.0
    assert not found["stature"].is_change
    assert [each.name for each in changed(tuple(found.values()))] == ["weight"]
    held_again = replace(before, values=before.values + np.array([0.0, 0.0, 0.002, 0.0]))
    assert not {each.name: each for each in changes(before, held_again)}["weight"].is_change
    # Two are left to be tested.
    assert found["waist"].least == pytest.approx(2.2414 * found["waist"].standard_error, rel=1e-4)


def test_nothing_is_shared_where_a_measurement_was_given():
    waist, hip = changes(
        measured([90.0, 100.0], [2.0, 2.0], ("waist",)), measured([90.0, 100.0], [2.0, 2.0])
    )
    assert waist.standard_error == pytest.approx(np.sqrt(8.0))
    assert hip.standard_error == pytest.approx(np.sqrt(8.0 * (1.0 - SHARED_ERROR)))


def test_holm_multiplies_the_smallest_by_all_and_the_largest_by_one():
    np.testing.assert_allclose(holm(np.array([0.04, 0.01, 0.03])), [0.06, 0.03, 0.06])
    np.testing.assert_allclose(holm(np.array([0.9, 0.8])), [1.0, 1.0])
    assert len(holm(np.array([]))) == 0


def test_without_any_change_few_comparisons_name_one():
    """With errors that are shared as assumed, about one in twenty comparisons names some."""
    generator = np.random.default_rng(7)
    comparisons, named = 2000, 0
    for _ in range(comparisons):
        shared = np.sqrt(SHARED_ERROR) * generator.normal(size=4)
        one, other = (
            measured(shared + np.sqrt(1.0 - SHARED_ERROR) * generator.normal(size=4), [1.0] * 4)
            for _ in range(2)
        )
        named += bool(changed(changes(one, other)))
    assert 0.6 * SIGNIFICANCE < named / comparisons < 1.4 * SIGNIFICANCE

import numpy as np
import pytest

from fitter.population.conditional_shape import (
    HELD_WITHIN,
    Conditions,
    MeasuredShapes,
    condition_shape,
)

SLOPES = np.array([[6.0, 0.0, 0.0], [4.0, 10.0, 1.0], [0.0, 8.0, -3.0]])
MEAN = np.array([165.0, 70.0, 90.0])
BEND = np.array([[0.0, 0.0, 0.0], [0.0, 0.4, 0.0], [0.0, 0.0, 0.3]])


def shapes(*, bend: float = 0.0) -> MeasuredShapes:
    """Three measurements, quadratic in three coefficients."""

    def measure(shape, rows):
        return (MEAN + SLOPES @ shape + bend * BEND @ shape**2)[list(rows)]

    return MeasuredShapes(
        measure=measure,
        jacobian=lambda shape: SLOPES + 2.0 * bend * BEND * shape,
        mean=MEAN,
        jacobian_at_mean=SLOPES,
    )


def conditions(rows, values, errors=None) -> Conditions:
    variances = np.zeros(len(rows)) if errors is None else np.square(errors)
    return Conditions(rows=rows, values=np.array(values, dtype=float), variances=variances)


def test_nothing_known_leaves_the_population_as_it_is():
    conditioned = condition_shape(shapes(), conditions([], []))
    assert conditioned.met
    assert np.array_equal(conditioned.shape, np.zeros(3))
    assert np.array_equal(conditioned.covariance, np.eye(3))
    assert conditioned.squared_distance == 0.0


def test_one_exact_measurement_moves_along_its_own_slope_only():
    conditioned = condition_shape(shapes(), conditions([1], [90.0]))
    slope = SLOPES[1]
    assert conditioned.shape == pytest.approx(20.0 * slope / (slope @ slope))
    assert conditioned.squared_distance == pytest.approx(20.0**2 / (slope @ slope))
    assert slope @ conditioned.covariance @ slope == pytest.approx(0.0, abs=1e-9)


def test_the_conditional_normal_distribution_in_closed_form():
    # The textbook formula in the space of measurements, against ours in the space of shapes.
    joint = SLOPES @ SLOPES.T
    known, other = [0, 1], 2
    errors = np.array([0.0, 3.0])
    weights = joint[other, known] @ np.linalg.inv(joint[np.ix_(known, known)] + np.diag(errors**2))
    conditioned = condition_shape(shapes(), conditions(known, [180.0, 95.0], errors))
    assert MEAN[other] + SLOPES[other] @ conditioned.shape == pytest.approx(
        MEAN[other] + weights @ (np.array([180.0, 95.0]) - MEAN[known])
    )
    variance = SLOPES[other] @ conditioned.covariance @ SLOPES[other]
    assert variance == pytest.approx(joint[other, other] - weights @ joint[known, other])


def test_bent_measurements_are_met_and_the_shape_is_the_nearest_that_meets_them():
    bent = shapes(bend=1.0)
    wanted = np.array([172.0, 100.0])
    conditioned = condition_shape(bent, conditions([0, 1], wanted))
    assert conditioned.met
    assert bent.measure(conditioned.shape, [0, 1]) == pytest.approx(wanted, abs=HELD_WITHIN)
    # Nearest: what is left is a combination of the constraints' slopes there.
    slopes = bent.jacobian(conditioned.shape)[[0, 1]]
    left = conditioned.shape - slopes.T @ np.linalg.lstsq(slopes.T, conditioned.shape)[0]
    assert np.abs(left).max() < 0.01


def test_an_uncertain_measurement_is_met_as_far_as_it_is_certain():
    moves = [
        condition_shape(shapes(), conditions([1], [90.0], [error])).shape @ SLOPES[1]
        for error in (0.0, 1.0, 10.0, 1000.0)
    ]
    assert moves[0] == pytest.approx(20.0)
    assert moves == sorted(moves, reverse=True)
    assert moves[-1] == pytest.approx(0.0, abs=0.01)


def test_the_same_said_twice_is_as_good_as_once():
    once = condition_shape(shapes(), conditions([1], [90.0]))
    twice = condition_shape(shapes(), conditions([1, 1], [90.0, 90.0]))
    assert twice.met
    assert twice.shape == pytest.approx(once.shape)


def test_the_same_said_differently_is_not_met():
    assert not condition_shape(shapes(), conditions([1, 1], [90.0, 95.0])).met


def test_what_cannot_be_measured_is_not_met():
    broken = MeasuredShapes(
        measure=lambda shape, rows: np.full(len(rows), np.nan),
        jacobian=lambda shape: SLOPES,
        mean=MEAN,
        jacobian_at_mean=SLOPES,
    )
    assert not condition_shape(broken, conditions([1], [80.0])).met


def test_distances_of_the_populations_own_people_follow_chi_squared():
    rng = np.random.default_rng(3)
    measured = MEAN + rng.standard_normal((400, 3)) @ SLOPES.T
    distances = [
        condition_shape(shapes(), conditions([0, 2], values[[0, 2]])).squared_distance
        for values in measured
    ]
    # The mean of chi-squared with two degrees of freedom is 2, its standard error here 0.1.
    assert np.mean(distances) == pytest.approx(2.0, abs=0.35)

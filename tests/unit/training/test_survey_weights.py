import numpy as np
import pytest

from fitter.training.surveys.survey_weights import (
    Target,
    TooFewPeopleError,
    effective_count,
    matching_weights,
    weighted_moments,
)

TARGET = Target(mean=np.array([0.5, -0.2]), covariance=np.array([[0.5, 0.1], [0.1, 0.4]]))


def people(count: int = 4000) -> np.ndarray:
    return np.random.default_rng(0).multivariate_normal([0.0, 0.0], [[1.0, 0.3], [0.3, 1.0]], count)


def test_weighted_people_have_exactly_the_targets_mean_and_covariance():
    weights = matching_weights(people(), TARGET)
    mean, covariance = weighted_moments(people(), weights)
    np.testing.assert_allclose(mean, TARGET.mean, atol=1e-8)
    np.testing.assert_allclose(covariance, TARGET.covariance, atol=1e-8)
    assert weights.sum() == pytest.approx(1.0)
    assert weights.min() > 0.0


def test_of_gaussian_people_the_weights_are_the_quotient_of_densities():
    given = people(40_000)
    weights = matching_weights(given, TARGET)

    def log_density(mean, covariance):
        offsets = given - mean
        return -0.5 * np.einsum("si,ij,sj->s", offsets, np.linalg.inv(covariance), offsets)

    quotient = log_density(TARGET.mean, TARGET.covariance) - log_density(
        np.zeros(2), np.array([[1.0, 0.3], [0.3, 1.0]])
    )
    difference = np.log(weights) - quotient
    assert difference.std() < 0.05


def test_people_who_are_the_target_already_keep_equal_weights():
    given = people()
    own = Target(mean=given.mean(axis=0), covariance=np.cov(given.T, bias=True))
    weights = matching_weights(given, own)
    np.testing.assert_allclose(weights, 1.0 / len(given), rtol=1e-6)
    assert effective_count(weights) == pytest.approx(len(given))


def test_what_goes_with_the_given_follows_their_weights():
    given = people()
    follower = given @ [2.0, 1.0] + np.random.default_rng(1).normal(size=len(given))
    mean, covariance = weighted_moments(follower[:, None], matching_weights(given, TARGET))
    slope = np.array([2.0, 1.0])
    assert mean[0] == pytest.approx(slope @ TARGET.mean, abs=0.05)
    assert covariance[0, 0] == pytest.approx(slope @ TARGET.covariance @ slope + 1.0, rel=0.05)


def test_people_out_of_reach_of_the_target_are_refused():
    far = Target(mean=np.array([50.0, 0.0]), covariance=0.1 * np.eye(2))
    with pytest.raises(TooFewPeopleError, match="No weights give these 4000 people"):
        matching_weights(people(), far)

import numpy as np
import pytest

from fitter.energies.shape_terms import POPULATION_PRECISION
from fitter.person.several_pictures import (
    SAME_PERSON_PROBABILITY,
    SHARED_ERROR,
    CombinedShape,
    combined_shape,
)

N = 6


def fit_of(shape, told, prior=POPULATION_PRECISION):
    """Shape and covariance of a fit of someone by a picture that says so much along each axis.

    Its minimum is where prior and picture balance.
    """
    told = np.asarray(told, dtype=float)
    found = np.concatenate([[0.3], told * shape[1:] / (told + prior)])
    return found, np.diag([0.0, *(1.0 / (told + prior))])


def combined(*fits, prior=POPULATION_PRECISION) -> CombinedShape:
    shapes, covariances = zip(*fits, strict=True)
    return combined_shape(shapes, covariances, prior=prior)


SHAPE = np.array([0.3, 1.5, -0.8, 0.4, -2.0, 0.7])
FRONT, SIDE = [8.0, 8.0, 0.0, 0.0, 1.0], [0.0, 0.0, 9.0, 9.0, 1.0]


@pytest.mark.parametrize("prior", [POPULATION_PRECISION, 1.0])
def test_what_one_picture_does_not_tell_comes_from_the_other(prior):
    both = combined(fit_of(SHAPE, FRONT, prior), fit_of(SHAPE, SIDE, prior), prior=prior)
    told = (np.array(FRONT) + SIDE) / (1.0 + SHARED_ERROR)
    np.testing.assert_allclose(both.shape[1:], told * SHAPE[1:] / (told + prior))
    assert both.shape[0] == 0.3


def test_the_order_of_pictures_changes_nothing():
    fits = [fit_of(SHAPE + 0.1 * k, [4.0, k + 1.0, 2.0, 1.0, 5.0]) for k in range(3)]
    one, other = combined(*fits), combined(*fits[::-1])
    np.testing.assert_allclose(one.shape, other.shape, atol=1e-12)
    assert one.agreement == pytest.approx(other.agreement)


def test_a_picture_that_says_nothing_contradicts_nothing():
    assert not combined(fit_of(SHAPE, FRONT), fit_of(SHAPE, [0.0] * 5)).doubtful


def test_pictures_of_different_people_are_noticed_and_the_odd_one_named():
    told = [20.0] * 5
    other = SHAPE + [0.0, 2.5, -2.0, 2.0, 2.5, -2.0]
    assert not combined(*(fit_of(SHAPE, told) for _ in range(3))).doubtful
    mixed = combined(fit_of(SHAPE, told), fit_of(other, told), fit_of(SHAPE, told))
    assert mixed.doubtful
    assert mixed.differing == 1


def drawn_fits(rng: np.random.Generator, told, count: int):
    """Fits of one person of the population, whose errors correlate as those of pictures do."""
    shape = np.concatenate([[0.3], rng.standard_normal(N - 1)])
    common = rng.standard_normal(N - 1)
    for own in rng.standard_normal((count, N - 1)):
        error = np.sqrt(SHARED_ERROR) * common + np.sqrt(1.0 - SHARED_ERROR) * own
        noise = np.where(told > 0.0, error / np.sqrt(np.maximum(told, 1e-9)), 0.0)
        yield fit_of(shape + np.concatenate([[0.0], noise]), told)


@pytest.mark.parametrize("count", [2, 4])
def test_pictures_of_one_person_are_doubted_no_more_often_than_the_agreement_says(count):
    rng, told = np.random.default_rng(7), np.array([9.0, 4.0, 2.0, 1.0, 25.0])
    agreements = [combined(*drawn_fits(rng, told, count)).agreement for _ in range(400)]
    for share in (0.05, SAME_PERSON_PROBABILITY, 0.3):
        assert np.mean(np.array(agreements) < share) < share
    assert np.mean(np.array(agreements) < 0.3) > 0.01


def test_people_who_differ_only_where_both_pictures_are_sure_are_told_apart():
    told = np.array([400.0, 0.5, 0.5, 0.5, 0.5])
    assert not combined(fit_of(SHAPE, told), fit_of(SHAPE + 0.02, told)).doubtful
    heavier = SHAPE + np.array([0.0, 1.0, 0.0, 0.0, 0.0, 0.0])
    assert combined(fit_of(SHAPE, told), fit_of(heavier, told)).doubtful

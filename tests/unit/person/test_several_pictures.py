from dataclasses import replace

import numpy as np
import pytest

from fitter.energies.shape_terms import POPULATION_PRECISION
from fitter.errors import InvalidInputError
from fitter.parameters import BodyParameters
from fitter.person.fitted_person import FittedPerson
from fitter.person.several_pictures import SAME_PERSON_PROBABILITY, SHARED_ERROR, combined_shape
from fitter.render.camera import Camera
from fitter.vocabulary.choices import Gender

N = 6
CAMERA = Camera(focal_length_px=700.0, centre_x=20.0, centre_y=30.0, width=40, height=60)


def fit_of(shape, told, *, height=0.3):
    """A fit of someone of this shape by a picture that says so much along each axis.

    Its minimum is where prior and picture balance.
    """
    told = np.asarray(told, dtype=float)
    found = np.concatenate([[height], told * shape[1:] / (told + POPULATION_PRECISION)])
    return FittedPerson(
        gender=Gender.FEMALE,
        model_checksum="one",
        body=BodyParameters(pose=np.zeros((1, 3)), translation=np.ones(3), shape=found),
        camera=CAMERA,
        light=None,
        reflectance=None,
        albedo_rgb=None,
        shape_covariance=np.diag([0.0, *(1.0 / (told + POPULATION_PRECISION))]),
    )


SHAPE = np.array([0.3, 1.5, -0.8, 0.4, -2.0, 0.7])
FRONT, SIDE = [8.0, 8.0, 0.0, 0.0, 1.0], [0.0, 0.0, 9.0, 9.0, 1.0]


def test_what_one_picture_does_not_tell_comes_from_the_other():
    front, side = fit_of(SHAPE, FRONT), fit_of(SHAPE, SIDE)
    both = combined_shape([front, side])
    weight = 1.0 / (1.0 + SHARED_ERROR)
    told = weight * (np.array(FRONT) + SIDE)
    np.testing.assert_allclose(both.shape[1:], told * SHAPE[1:] / (told + POPULATION_PRECISION))
    np.testing.assert_allclose(np.diag(both.covariance)[1:], 1.0 / (told + POPULATION_PRECISION))
    assert both.shape[0] == 0.3
    assert np.abs(both.covariance[0]).max() == 0.0


def test_the_order_of_pictures_changes_nothing():
    fits = [fit_of(SHAPE + 0.1 * k, [4.0, k + 1.0, 2.0, 1.0, 5.0]) for k in range(3)]
    one, other = combined_shape(fits), combined_shape(fits[::-1])
    np.testing.assert_allclose(one.shape, other.shape, atol=1e-12)
    np.testing.assert_allclose(one.covariance, other.covariance, atol=1e-12)
    assert one.agreement == pytest.approx(other.agreement)


def test_a_picture_that_says_nothing_widens_only_by_the_shared_error():
    told, untold = fit_of(SHAPE, FRONT), fit_of(SHAPE, [0.0] * 5)
    found = combined_shape([told, untold])
    assert not found.doubtful
    alone = np.diag(told.shape_covariance)[1:]
    assert (np.diag(found.covariance)[1:] >= alone - 1e-12).all()


def test_more_pictures_make_it_more_certain():
    def spread(count):
        fits = [fit_of(SHAPE, [5.0] * 5) for _ in range(count)]
        return np.trace(combined_shape(fits).covariance)

    assert spread(12) < spread(4) < spread(2) < np.trace(fit_of(SHAPE, [5.0] * 5).shape_covariance)


def test_pictures_of_different_people_are_noticed_and_the_odd_one_named():
    told = [20.0] * 5
    other = SHAPE + [0.0, 2.5, -2.0, 2.0, 2.5, -2.0]
    same = combined_shape([fit_of(SHAPE, told) for _ in range(3)])
    assert not same.doubtful
    mixed = combined_shape([fit_of(SHAPE, told), fit_of(other, told), fit_of(SHAPE, told)])
    assert mixed.doubtful
    assert mixed.differing == 1


def drawn_fits(rng: np.random.Generator, told, count: int) -> list[FittedPerson]:
    """Fits of one person of the population, whose errors correlate as those of pictures do."""
    shape = np.concatenate([[0.3], rng.standard_normal(N - 1)])
    common = rng.standard_normal(N - 1)
    fits: list[FittedPerson] = []
    for own in rng.standard_normal((count, N - 1)):
        error = np.sqrt(SHARED_ERROR) * common + np.sqrt(1.0 - SHARED_ERROR) * own
        noise = np.where(told > 0.0, error / np.sqrt(np.maximum(told, 1e-9)), 0.0)
        fits.append(fit_of(shape + np.concatenate([[0.0], noise]), told))
    return fits


@pytest.mark.parametrize("count", [2, 4])
def test_pictures_of_one_person_are_doubted_no_more_often_than_the_agreement_says(count):
    rng, told = np.random.default_rng(7), np.array([9.0, 4.0, 2.0, 1.0, 25.0])
    agreements = [combined_shape(drawn_fits(rng, told, count)).agreement for _ in range(400)]
    for share in (0.05, SAME_PERSON_PROBABILITY, 0.3):
        assert np.mean(np.array(agreements) < share) < share
    assert np.mean(np.array(agreements) < 0.3) > 0.01


@pytest.mark.parametrize(
    ("change", "field", "says"),
    [
        ({"gender": Gender.MALE}, "fits.0", "different body models"),
        ({"model_checksum": "two"}, "fits.0", "different body models"),
        ({"shape_covariance": None}, "fits.0", "how certain"),
    ],
)
def test_fits_that_cannot_be_combined_are_refused_by_number(change, field, says):
    fits = [fit_of(SHAPE, FRONT), replace(fit_of(SHAPE, SIDE), **change)]
    with pytest.raises(InvalidInputError, match=says) as caught:
        combined_shape(fits)
    assert (caught.value.code, caught.value.field) == ("fits-unusable", field)


def test_other_heights_are_other_people():
    with pytest.raises(InvalidInputError, match="different heights"):
        combined_shape([fit_of(SHAPE, FRONT), fit_of(SHAPE, SIDE, height=0.5)])


@pytest.mark.parametrize("count", [0, 1, 13])
def test_one_picture_is_not_several(count):
    with pytest.raises(InvalidInputError, match=f"not from {count}"):
        combined_shape([fit_of(SHAPE, FRONT)] * count)


def test_people_who_differ_only_where_both_pictures_are_sure_are_told_apart():
    told = np.array([400.0, 0.5, 0.5, 0.5, 0.5])
    same = combined_shape([fit_of(SHAPE, told), fit_of(SHAPE + 0.02, told)])
    assert not same.doubtful
    heavier = SHAPE + np.array([0.0, 1.0, 0.0, 0.0, 0.0, 0.0])
    other = combined_shape([fit_of(SHAPE, told), fit_of(heavier, told)])
    assert other.doubtful

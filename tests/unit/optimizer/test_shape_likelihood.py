"""What pictures say of the shape, apart from the prior: in closed form, and of a rendered scene."""

from dataclasses import replace

import numpy as np
import pytest

from fitter.energies.attributes import NOTHING_KNOWN, Attributes, KnownAttributes, whole_shape
from fitter.energies.priors import ShapePrior, population_prior
from fitter.optimizer.free_space import free_space, kept_directions
from fitter.optimizer.gauss_newton import minimize_gauss_newton
from fitter.optimizer.normal_equations import normal_equations
from fitter.optimizer.shape_likelihood import (
    ShapeLikelihood,
    most_probable_shape,
    prior_with,
    shape_likelihood,
)
from fitter.optimizer.simplex import minimize_simplex
from fitter.optimizer.uncertainty import certainty, shape_covariance
from tests.unit.optimizer.rendered_scene import RenderedScene, rendered_scene

N = 6
HEIGHT = 0.7


def ignore(_):
    return None


def said(seed: int) -> ShapeLikelihood:
    """What a picture may say; of the height it says nothing."""
    rng = np.random.default_rng(seed)
    root = rng.standard_normal((N, N))
    root[0] = 0.0
    return ShapeLikelihood(information=root @ root.T, pull=root @ rng.standard_normal(N))


def linear(rows: np.ndarray, values: np.ndarray) -> Attributes:
    return Attributes(
        measure=lambda shape: rows @ shape, jacobian=lambda _: rows.copy(), values=values
    )


ROWS = np.random.default_rng(5).standard_normal((2, N))
UNCERTAIN = replace(
    NOTHING_KNOWN,
    uncertain=linear(ROWS, np.array([1.0, -0.5])),
    standard_errors=np.array([0.5, 2.0]),
)
HELD = replace(NOTHING_KNOWN, held=linear(ROWS[:1], np.array([0.4])))


def minimum(prior: ShapePrior, known: KnownAttributes, picture: ShapeLikelihood):
    """Where a fit of such a picture ends, and how certain it is, from a shape with the height."""
    start = np.eye(N)[0] * HEIGHT
    row = ROWS[0, 1:]
    if len(known.held.values):
        start[1:] = row * (0.4 - ROWS[0, 0] * HEIGHT) / (row @ row)
    return most_probable_shape(prior_with(prior, [picture]), known, start)


@pytest.mark.parametrize("known", [NOTHING_KNOWN, UNCERTAIN, HELD])
def test_what_a_picture_says_does_not_depend_on_the_prior_it_was_fitted_with(known):
    picture = said(0)
    found = []
    for prior in (population_prior(N), prior_with(population_prior(N), [said(1), said(2)])):
        shape, covariance = minimum(prior, known, picture)
        found.append(shape_likelihood(shape, covariance, prior=prior, attributes=known))
    kept = kept_directions(known.held, np.zeros(N))
    across = kept @ kept.T
    for each in found:
        np.testing.assert_allclose(each.information, across @ picture.information @ across)
    both = [minimum(population_prior(N), known, each)[0] for each in (*found, picture)]
    np.testing.assert_allclose(both[0], both[2], atol=1e-9)
    np.testing.assert_allclose(both[1], both[2], atol=1e-9)


def test_an_unknown_height_says_nothing_of_the_picture():
    prior = population_prior(N)
    shape, covariance = minimum(prior, NOTHING_KNOWN, said(0))
    response = np.linspace(1.0, 0.2, N)
    unknown = covariance + 0.6 * np.outer(response, response)
    one, other = (
        shape_likelihood(shape, each, prior=prior, attributes=NOTHING_KNOWN)
        for each in (covariance, unknown)
    )
    np.testing.assert_allclose(one.information, other.information, atol=1e-8)
    np.testing.assert_allclose(one.pull, other.pull, atol=1e-8)


def test_pictures_and_prior_add_up_whatever_their_order():
    prior = population_prior(N)
    one, other = said(0), said(1)
    both, turned = prior_with(prior, [one, other]), prior_with(prior_with(prior, [other]), [one])
    np.testing.assert_allclose(both.mean, turned.mean)
    np.testing.assert_allclose(both.precision, turned.precision)
    shape = np.linspace(-1.0, 1.0, N)
    np.testing.assert_allclose(
        both.slope(shape),
        prior.slope(shape) + sum(e.information @ shape - e.pull for e in (one, other)),
        atol=1e-9,
    )


def test_the_most_probable_shape_has_what_is_held_and_the_height():
    shape, covariance = minimum(population_prior(N), HELD, said(0))
    assert shape[0] == HEIGHT
    assert ROWS[0] @ shape == pytest.approx(0.4, abs=1e-3)
    np.testing.assert_allclose(covariance @ np.append(0.0, ROWS[0, 1:]), 0.0, atol=1e-9)


@pytest.fixture(scope="module")
def scene() -> RenderedScene:
    return rendered_scene(0)


def told(scene: RenderedScene) -> ShapePrior:
    """Somebody a standard deviation off along every axis, with a correlation."""
    n = len(scene.start.shape)
    precision = 20.0 * population_prior(n).precision
    precision[1, 2] = precision[2, 1] = 5.0
    return ShapePrior(mean=np.append(0.0, np.ones(n - 1)), precision=precision)


def test_gradient_and_matrix_hold_the_prior_s_own(scene):
    other = replace(scene.objective, shape_prior=told(scene))
    shape = scene.start.shape
    (matrix, gradient), (plain, plainer) = (
        normal_equations(each, each.evaluate(scene.start)) for each in (other, scene.objective)
    )
    more, fewer = other.shape_prior, scene.objective.shape_prior
    n = len(shape)
    np.testing.assert_allclose(
        (matrix - plain)[-n:, -n:], more.precision - fewer.precision, atol=1e-9
    )
    np.testing.assert_allclose(
        (gradient - plainer)[-n:], more.slope(shape) - fewer.slope(shape), atol=1e-9
    )


def test_both_optimisers_lower_the_energy_of_the_prior(scene):
    other = replace(scene.objective, shape_prior=told(scene))
    begin = other.evaluate(scene.start).energies["shape_prior"]
    newton = minimize_gauss_newton(other, scene.start, max_evaluations=60, on_energies=ignore)
    assert newton.candidate.energies["shape_prior"] < 0.2 * begin
    assert np.abs(newton.candidate.parameters.shape[1:] - 1.0).mean() < 0.4
    simplex = minimize_simplex(other, scene.start, max_evaluations=300, on_energies=ignore)
    assert simplex.candidate.energies["shape_prior"] < begin


def test_the_covariance_is_what_prior_and_picture_say_together(scene):
    candidate = scene.objective.evaluate(scene.truth)
    n = len(scene.start.shape)
    found = []
    for prior in (population_prior(n), told(scene)):
        objective = replace(scene.objective, shape_prior=prior)
        covariance = shape_covariance(certainty(objective, candidate), height_variance=0.3)
        assert covariance[0, 0] == pytest.approx(0.3)
        found.append(
            shape_likelihood(
                candidate.parameters.shape, covariance, prior=prior, attributes=NOTHING_KNOWN
            ).information
        )
    assert np.trace(found[0]) > n
    # The ridge of the inverse, and what is cut off below zero.
    np.testing.assert_allclose(found[1], found[0], atol=1e-3 * np.trace(found[0]))


def test_a_shape_that_is_held_leaves_pose_and_place_free(scene):
    space = free_space(whole_shape(scene.start.shape).held, scene.start)
    others = scene.start.pose.size + 3
    np.testing.assert_array_equal(space.directions[:others], np.eye(others))
    assert not space.directions[others:].any()
    held = replace(scene.objective, attributes=whole_shape(scene.truth.shape))
    start = replace(scene.start, shape=scene.truth.shape)
    found = minimize_gauss_newton(held, start, max_evaluations=60, on_energies=ignore)
    np.testing.assert_array_equal(found.candidate.parameters.shape, scene.truth.shape)
    assert held.overlap(found.candidate) > 0.96
    covariance = shape_covariance(certainty(held, found.candidate), height_variance=0.0)
    np.testing.assert_array_equal(covariance, np.zeros_like(covariance))
